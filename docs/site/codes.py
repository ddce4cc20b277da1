"""All codes of messages and errors that the program can give, read from its source.

A code is a text at the place of the parameter `code` of a call: of Message, InputError,
ComputationError, Failure or Problem, or of a function that
makes one of these of its own parameter `code`. Where a name stands
there, the texts that are assigned to it count; codes that are handed on (`error.code`) are found
where they begin. What is none of these is refused, so that no code is overlooked.
"""

import ast
from collections.abc import Iterator
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2] / "src" / "simulearn"
PLACES = {"Message": 0, "InputError": 1, "ComputationError": 1, "Failure": 1, "Problem": 1}
DEFAULTS = {"input", "computation"}  # of InputError and ComputationError
# Names that hold a code from elsewhere: a parameter, or what another error said.
HANDED_ON = {"code", "name"}


def codes() -> dict[str, set[str]]:
    """Return all codes, each with the files that give it.

    Raises:
        ValueError: an expression at the place of a code is of no known form.
    """
    found: dict[str, set[str]] = {code: {"errors.py"} for code in DEFAULTS}
    for path in sorted(SOURCE.rglob("*.py")):
        file = path.relative_to(SOURCE).as_posix()
        for code in _of_module(ast.parse(path.read_text(encoding="utf-8")), file):
            found.setdefault(code, set()).add(file)
    return found


def _of_module(tree: ast.Module, file: str) -> Iterator[str]:
    places = PLACES | dict(_own_functions(tree))
    constants = {
        target.id: node.value
        for node in tree.body
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    assigned = list(_assigned(tree))
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        name = _name(node)
        if name not in places or (name == "Problem" and not file.startswith("studio/")):
            continue
        value = _argument(node, places[name])
        if value is None:
            continue
        if isinstance(value, ast.Starred):
            constant = constants.get(getattr(value.value, "id", ""))
            if not isinstance(constant, ast.Tuple):
                raise ValueError(f"{file}, line {node.lineno}: no code is known of {name}")
            value = constant.elts[0]
        if isinstance(value, ast.Attribute):  # `error.code`, handed on
            continue
        if isinstance(value, ast.Name) and value.id in HANDED_ON:
            yield from (text for names, texts in assigned if value.id in names for text in texts)
            continue
        if isinstance(value, ast.Name) and isinstance(constants.get(value.id), ast.Constant):
            value = constants[value.id]
        texts = list(_texts(value))
        if not texts:
            raise ValueError(f"{file}, line {node.lineno}: no code is known of {name}")
        yield from texts


def _own_functions(tree: ast.Module) -> Iterator[tuple[str, int]]:
    """Yield functions that make a message of their parameter `code`, and its place."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.FunctionDef):
            continue
        names = [one.arg for one in node.args.args if one.arg not in ("self", "cls")]
        if "code" in names and any(_takes_code(one) for one in ast.walk(node)):
            yield node.name, names.index("code")


def _takes_code(node: ast.AST) -> bool:
    if not (isinstance(node, ast.Call) and _name(node) in PLACES):
        return False
    value = _argument(node, PLACES[_name(node)])
    return isinstance(value, ast.Name) and value.id == "code"


def _name(call: ast.Call) -> str:
    return call.func.id if isinstance(call.func, ast.Name) else getattr(call.func, "attr", "")


def _assigned(tree: ast.Module) -> Iterator[tuple[set[str], list[str]]]:
    """Yield names that are assigned to, or looped over, with the texts they may then hold."""
    tables = {
        target.id: node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Dict)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.For):
            target, value = node.target, node.iter
            if isinstance(target, ast.Name) and isinstance(value, ast.Tuple):
                yield {target.id}, [text for one in value.elts for text in _texts(one)]
        if not isinstance(node, ast.Assign):
            continue
        for target in node.targets:
            value = node.value
            if isinstance(target, ast.Name):
                yield {target.id}, list(_texts(value))
            elif isinstance(target, ast.Tuple):
                at = [getattr(one, "id", "") for one in target.elts]
                if isinstance(value, ast.Tuple):
                    for name, one in zip(at, value.elts, strict=False):
                        yield {name}, list(_texts(one))
                elif "code" in at:  # of a table: CODES[key], known.get(status, (...))
                    yield {"code"}, list(_of_table(value, tables, at.index("code")))


def _of_table(value: ast.expr, tables: dict[str, ast.expr], place: int) -> Iterator[str]:
    rows: list[ast.expr] = []
    for node in ast.walk(value):
        if isinstance(node, ast.Name) and isinstance(tables.get(node.id), ast.Dict):
            rows += tables[node.id].values  # type: ignore[attr-defined]
        if isinstance(node, ast.Tuple):
            rows.append(node)
    for row in rows:
        if isinstance(row, ast.Tuple):
            yield from _texts(row.elts[place])


def _texts(value: ast.expr) -> Iterator[str]:
    if isinstance(value, ast.Constant) and isinstance(value.value, str):
        yield value.value
    elif isinstance(value, ast.IfExp):
        yield from _texts(value.body)
        yield from _texts(value.orelse)


def _argument(call: ast.Call, place: int) -> ast.expr | None:
    for keyword in call.keywords:
        if keyword.arg == "code":
            return keyword.value
    for k, one in enumerate(call.args):
        if k == place or isinstance(one, ast.Starred):
            return one
    return None
