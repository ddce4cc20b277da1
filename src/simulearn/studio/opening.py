"""Files that a person opens: grids, tasks, results, pages, documents, and drawings of others.

All are known by what they hold, not by their names.
"""

from dataclasses import asdict
from functools import partial
from pathlib import PurePath, PureWindowsPath
from typing import Any

from simulearn.drawings.importing import Imported, Options, imported
from simulearn.drawings.pages import SCHEMA as PAGE
from simulearn.drawings.pages import page_contents
from simulearn.drawings.units import UnitError
from simulearn.errors import InputError, Message
from simulearn.files import marked_encoding, parse_json
from simulearn.grid import grid_from_dict, grid_to_dict
from simulearn.grid.gridfile import SCHEMA as GRID
from simulearn.inverse import Task, task_from_dict
from simulearn.inverse.task import SCHEMA as TASK
from simulearn.inverse.task import Free, Limits
from simulearn.simulate import result_from_dict
from simulearn.simulate.resultfile import FAILURE
from simulearn.simulate.resultfile import SCHEMA as RESULT
from simulearn.studio.documentfile import SCHEMA as DOCUMENT
from simulearn.studio.documentfile import check_document

LOOK = 2**12  # bytes in which JSON begins
OWN = "simulearn."  # the beginning of our schemas
OPENED = "the studio opens grids, tasks, results, documents and drawings"
# What is left out of a design's name.
ENDINGS = (".json", ".dxf", ".svg", ".3dm", ".csv", ".txt", ".obj", ".html")
# What a search begins from may not have; it is no error in a drawing.
REMOVABLE = ("dangling-beam", "unused-joint")
FILES = "surface-path"  # a goal on a surface that only the command line can read


def opened(data: bytes, name: str, options: Options | None = None) -> dict[str, Any]:
    """Return the parts of a document that a file holds.

    Args:
        data: contents of the file.
        name: of the file; it names a design that has no name of its own.
        options: how a drawing is to be read.

    Returns:
        kind (grid, task, result, document or drawing), name, grid, goals, printer (None if the file
        names none), texts of own materials, messages about what was not taken over, and what is to
        be reported of a drawing: format, unit, layers and mends (None for other files).

    Raises:
        InputError: the file holds nothing that can be opened; the message says what and where.
        UnitError: the unit of a drawing is not known.
    """
    stem = _stem(name)
    named = partial("{}: {}".format, stem or "the file")
    try:
        parts = _parts(data, name, options)
    except UnitError as error:
        raise UnitError(named(error), error.guess, error.size) from error
    except InputError as error:
        raise InputError(named(error), error.code, error.where, error.messages) from error
    check_document({"schema": DOCUMENT, "grid": parts["grid"], "goals": parts["goals"]})
    messages = [asdict(message) for message in parts["messages"]]
    return {**parts, "name": parts["name"] or stem, "messages": messages}


def _parts(data: bytes, name: str, options: Options | None) -> dict[str, Any]:
    """Return what a file holds: what is ours by its schema, else a drawing."""
    parts: dict[str, Any] = {
        "name": "",
        "goals": [],
        "printer": None,
        "materials": [],
        "messages": [],
        "drawing": None,
    }
    if not data.strip():
        raise InputError(f"is empty; {OPENED}", "empty", "file")
    text = page_contents(data) or _json(data)
    ours = None if text is None else _ours(parse_json(text))
    return parts | (_of_drawing(imported(data, name, options)) if ours is None else ours)


def _json(data: bytes) -> str | None:
    """Return the text of a file that begins as JSON does; None for others.

    Raises:
        InputError: it is no text, although it begins so.
    """
    encoding = marked_encoding(data) or "utf-8"
    try:
        start = data[:LOOK].decode(encoding, errors="replace").lstrip()
        return data.decode(encoding) if start.startswith(("{", "[")) else None
    except UnicodeDecodeError as error:
        text = f"is not text in UTF-8 (byte {error.start})"
        raise InputError(text, "file-kind", f"byte {error.start}") from error


def _ours(data: Any) -> dict[str, Any] | None:
    """Return what JSON of ours holds, by its schema; None for that of other programs."""
    schema = data.get("schema") if isinstance(data, dict) else None
    kind = schema.partition("/")[0] if isinstance(schema, str) else ""
    readers = {of.partition("/")[0]: (of, read) for of, read in READERS.items()}
    if kind in readers:
        known, read = readers[kind]
        if schema != known:
            text = f'schema is "{schema}"; this version reads "{known}"'
            raise InputError(text, "file-version", "schema")
        return read(data)
    if kind.startswith(OWN):
        other = f'has the schema "{schema}"'
        if schema == FAILURE:
            other = "says why a design has no result; it holds no design"
        raise InputError(f"{other}; {OPENED}", "file-kind", "schema")
    if isinstance(data, dict) and {"joints", "beams"} <= data.keys():
        return _of_grid(data)  # whose reader says what is wrong
    return None


def _of_grid(data: Any) -> dict[str, Any]:
    return {"kind": "grid", "grid": grid_to_dict(grid_from_dict(data))}


def _of_result(data: Any) -> dict[str, Any]:
    grid = result_from_dict(data).grid
    text = "the file is a result; its design was opened and is simulated again"
    message = Message("opened-result", "file", text)
    return {"kind": "result", "grid": grid_to_dict(grid), "messages": [message]}


def _of_page(data: Any) -> dict[str, Any]:
    text = "the file is a page that plays a result; its design was opened and is simulated again"
    grid = grid_to_dict(grid_from_dict(data.get("grid")))
    return {"kind": "result", "grid": grid, "messages": [Message("opened-result", "file", text)]}


def _of_task(data: Any) -> dict[str, Any]:
    try:
        task = task_from_dict(data)
    except InputError as error:
        if error.code not in (*REMOVABLE, FILES):
            raise
        task = Task.model_validate(data)
    messages = []
    plain = (task.free, task.limits, task.method) == (Free(), Limits(), "default")
    if not plain or task.of_prints:
        text = (
            "what the task says about free parts, limits, method, tolerances and robust is not "
            "part of a document"
        )
        messages.append(Message("opened-task", "file", text))
    kept = [goal for goal in task.goals if goal.target is not None and goal.vertex is not None]
    goals = [goal.model_dump(exclude={"tolerance"}) for goal in kept]
    if len(kept) < len(task.goals) or task.pose != "fixed":
        text = (
            f"{len(task.goals) - len(kept)} goals of the task are no targets of single vertices, "
            "or its pose is free; that is not part of a document"
        )
        messages.append(Message("opened-goals", "file", text))
    grid = grid_to_dict(grid_from_dict(task.grid))
    return {"kind": "task", "grid": grid, "goals": goals, "messages": messages}


def _of_drawing(found: Imported) -> dict[str, Any]:
    drawing = {
        "format": found.format,
        "unit": asdict(found.unit),
        "layers": [asdict(layer) for layer in found.layers],
        "mends": [asdict(mend) for mend in found.mends],
    }
    return {
        "kind": "drawing",
        "grid": grid_to_dict(found.grid),
        "messages": found.messages,
        "drawing": drawing,
    }


def _of_document(data: Any) -> dict[str, Any]:
    check_document(data)
    optional = {key: data[key] for key in ("name", "printer", "materials") if data.get(key)}
    return {
        "kind": "document",
        "grid": data["grid"],
        "goals": [{"weight": 1.0, **goal} for goal in data.get("goals", [])],
        **optional,
    }


READERS = {
    GRID: _of_grid,
    TASK: _of_task,
    RESULT: _of_result,
    PAGE: _of_page,
    DOCUMENT: _of_document,
}


def _stem(name: str) -> str:
    """Return the name of a file without folders and ending, as a person would call it."""
    base = PureWindowsPath(PurePath(name).name).name
    ending = PurePath(base).suffix
    stem = base.removesuffix(ending) if ending.lower() in ENDINGS else base
    return " ".join("".join(c if c.isprintable() else " " for c in stem).split())[:200]
