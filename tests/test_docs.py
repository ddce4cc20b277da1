"""The documentation: links lead somewhere, commands and code are right, nothing is left out."""

import ast
import importlib.util
import json
import re
import shlex
import sys
from pathlib import Path
from types import ModuleType

import pytest
import yaml

from simulearn import validate
from simulearn.drawings.mending import MENDS
from simulearn.grid import grid_from_dict
from simulearn.inverse import task_from_dict

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
SITE = DOCS / "site"


def script(name: str) -> ModuleType:
    """Return one of the scripts that make the site."""
    spec = importlib.util.spec_from_file_location(f"docs_{name}", SITE / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


stage, commands, codes, python, tour = map(script, ("stage", "commands", "codes", "python", "tour"))
PAGES = stage.pages()
MADE = {commands.GENERATED, "measured/index.md", *python.pages()}  # pages without a file
TEXTS = {page: path.read_text(encoding="utf-8") for page, path in PAGES.items()}
BLOCK = re.compile(r"^( *)```(\w+)[^\n]*\n(.*?)^\1```", re.M | re.S)
BLOCKS = [
    (page, language, re.sub(f"^{indent}", "", text, flags=re.M))
    for page, whole in TEXTS.items()
    for indent, language, text in BLOCK.findall(whole)
]
COMMANDS = [
    (page, line.removeprefix("$ "))
    for page, language, text in BLOCKS
    if language in ("console", "bash")
    for line in text.splitlines()
    if re.match(r"(\$ )?(\S*/)?simulearn ", line)
]


@pytest.mark.parametrize("page", PAGES)
def test_links_and_pictures_of_a_page_exist(page: str) -> None:
    source = PAGES[page]
    for link in stage.links(TEXTS[page]):
        path, _, anchor = link.partition("#")
        file = (source.parent / path).resolve() if path else source
        made = file.is_relative_to(DOCS) and file.relative_to(DOCS).as_posix() in MADE
        assert made or file.exists(), f"{source.relative_to(ROOT)} links to {link}"
        if anchor and file.suffix == ".md" and not made:
            assert anchor in anchors(file.read_text(encoding="utf-8")), link


def anchors(text: str) -> set[str]:
    titles = re.findall(r"^#+ (.*)$", text, re.M)
    return {re.sub(r"[^\w\- ]", "", title.lower()).strip().replace(" ", "-") for title in titles}


def test_dead_links_and_anchors_are_seen() -> None:
    assert stage.links("[a](b.md#c) `[no](x.md)`\n```\n[no](y.md)\n```\n![p](q.png)") == [
        "b.md#c",
        "x.md",
        "q.png",
    ]
    assert anchors("# What is done\n## In Python") == {"what-is-done", "in-python"}


def test_links_out_of_the_docs_are_led_to_copies() -> None:
    copies: dict[str, Path] = {}
    text = (
        "[a](../../src/simulearn/errors.py) [b](../../README.md) [c](../measured) [d](../api.md#x)"
    )
    source = DOCS / "howto" / "draw.md"
    assert stage.staged(text, "howto/draw.md", source, copies) == (
        "[a](../files/src/simulearn/errors.py) [b](../index.md) "
        "[c](../measured/index.md) [d](../api.md#x)"
    )
    assert copies == {"files/src/simulearn/errors.py": ROOT / "src/simulearn/errors.py"}


def test_the_navigation_lists_every_page() -> None:
    settings = yaml.safe_load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))
    listed = list(navigated(settings["nav"]))
    assert len(listed) == len(set(listed))
    # Measured figures have a list of their own, which is made from their folder.
    expected = {page for page in {*PAGES, *MADE} if not re.match(r"measured/(?!index)", page)}
    assert set(listed) == expected


def navigated(entry: object) -> list[str]:
    if isinstance(entry, str):
        return [entry]
    parts = entry.values() if isinstance(entry, dict) else entry
    return [page for part in parts for page in navigated(part)]


@pytest.mark.parametrize(("page", "line"), COMMANDS, ids=[f"{p}: {c}" for p, c in COMMANDS])
def test_commands_are_ones_of_the_program(page: str, line: str) -> None:
    for part in re.split(r" && | \| | & |;", line.split(" #")[0].rstrip(" &")):
        arguments = shlex.split(part, comments=True)
        if arguments and Path(arguments[0]).name == "simulearn":
            parsed(commands.program(), arguments[1:])


def parsed(command: object, arguments: list[str]) -> None:
    """Parse a command with its options, without running it."""
    name, above = "simulearn", None
    while True:
        context = command.make_context(name, list(arguments), parent=above)
        if not hasattr(command, "commands"):
            return
        name, command, arguments = command.resolve_command(
            context, [*context._protected_args, *context.args]
        )
        above = context


def test_wrong_commands_are_seen() -> None:
    for wrong in ("simulate", "simulate a.json --flaten 1", "nothing a.json", "dataset pack"):
        with pytest.raises(Exception, match=r"(?i)missing|no such"):
            parsed(commands.program(), wrong.split())
    assert len(COMMANDS) > 60


@pytest.mark.parametrize(
    ("page", "text"), [(page, text) for page, language, text in BLOCKS if language == "python"]
)
def test_code_compiles_and_imports_what_there_is(page: str, text: str) -> None:
    tree = compile(text, page, "exec", flags=ast.PyCF_ONLY_AST)
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("simulearn"):
            module = importlib.import_module(node.module)
            for name in node.names:
                assert hasattr(module, name.name), f"{page}: {ast.unparse(node)}"


def test_the_grids_and_the_task_of_the_tour_are_valid() -> None:
    files = tour.files(TEXTS["tour.md"])
    grid = grid_from_dict(_json(files["own.json"]))
    report = validate(grid)
    assert report.valid
    assert report.warnings == ()
    assert (task_from_dict(_json(files["task.json"])).start.joints == grid.centred.joints).all()
    assert [line[0] for line in tour.commands(TEXTS["tour.md"])].count("simulate") == 3


def _json(text: str) -> object:
    return json.loads(text)


def explained() -> set[str]:
    """Return the codes that the page of messages has an entry for."""
    rows = re.findall(r"^\| (`[^|]*) \| [a-z ]* \|", TEXTS["troubleshooting.md"], re.M)
    return {code for row in rows for code in re.findall(r"`([^`]+)`", row)}


def test_every_code_is_explained() -> None:
    given = codes.codes()
    missing = {code: sorted(files) for code, files in given.items() if code not in explained()}
    assert not missing
    assert len(given) > 140


def test_every_hint_has_a_code_that_is_explained() -> None:
    from simulearn.cli.program import HINTS

    assert set(HINTS) <= explained()


def test_no_code_is_explained_that_the_program_does_not_give() -> None:
    sources = [*codes.SOURCE.rglob("*.py"), *codes.SOURCE.rglob("*.js")]
    text = "\n".join(path.read_text(encoding="utf-8") for path in sources)
    assert {code for code in explained() if f'"{code}"' not in text} == set()


def test_codes_that_are_not_plain_texts_are_found_or_refused() -> None:
    found = codes._of_module(
        ast.parse(
            "PAIR = ('of-pair', 'x')\n"
            "def say(code, text):\n    return Message(code, 'grid', text)\n"
            "def f(a):\n"
            "    code, text = ('one', 't') if a else ('two', 't')\n"
            "    code = 'three' if a else 'four'\n"
            "    say('five', '')\n"
            "    raise InputError(text, *PAIR)\n"
        ),
        "x.py",
    )
    assert set(found) >= {"three", "four", "five", "of-pair"}
    with pytest.raises(ValueError, match="no code is known"):
        list(codes._of_module(ast.parse("Message(f(x), 'grid', 'text')"), "x.py"))


def test_every_mend_is_explained() -> None:
    assert all(f"| `{code}` |" in TEXTS["drawings.md"] for code in MENDS)


def test_every_command_and_option_is_on_the_page_of_commands() -> None:
    text = commands.text()
    every = commands.commands(commands.program(), "simulearn")
    assert len(every) > 12
    for name, command in every:
        section = text.partition(f"\n## {name}\n")[2].partition("\n## ")[0]
        for option in command.params:
            if option.param_type_name == "option":
                assert option.opts[-1] == "--help" or f"`{option.opts[-1]}`" in section
