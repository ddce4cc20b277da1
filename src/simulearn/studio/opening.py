"""Files that a person opens: a grid, a task, a result or a document, known by what they hold."""

import codecs
from dataclasses import asdict
from pathlib import PurePath, PureWindowsPath
from typing import Any

from simulearn.errors import InputError, Message
from simulearn.files import parse_json
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

MARKS = {  # of text that is not UTF-8 (or marked as such)
    codecs.BOM_UTF8: "utf-8-sig",
    codecs.BOM_UTF16_LE: "utf-16",
    codecs.BOM_UTF16_BE: "utf-16",
}
OTHERS = (  # how files of other kinds begin, and what they are
    (b"PK", "a ZIP archive (such as an .npz file)"),
    (b"\x89PNG", "a picture"),
    (b"\xff\xd8\xff", "a picture"),
    (b"GIF8", "a picture"),
    (b"%PDF", "a PDF"),
    (b"glTF", "a surface (.glb)"),
    (b"solid ", "a surface (.stl)"),
    (b";", "a print (.gcode)"),
    (b"<", "XML (such as .svg or .vtu)"),
    (b"\x1f\x8b", "compressed"),
)
OPENED = "the studio opens grids, tasks, results and documents in JSON"
# What a search begins from may not have; it is no error in a drawing.
REMOVABLE = ("dangling-beam", "unused-joint")


def opened(data: bytes, name: str) -> dict[str, Any]:
    """Return the parts of a document that a file holds.

    Args:
        data: contents of the file.
        name: of the file; it names a design that has no name of its own.

    Returns:
        kind (grid, task, result or document), name, grid, goals, printer (None if the file names
        none), and messages about what was not taken over.

    Raises:
        InputError: the file holds nothing that can be opened; the message says what and where.
    """
    stem = _stem(name)
    try:
        parts = _parts(parse_json(_text(data)))
    except InputError as error:
        file = stem or "the file"
        raise InputError(f"{file}: {error}", error.code, error.where, error.messages) from error
    check_document({"schema": DOCUMENT, "grid": parts["grid"], "goals": parts["goals"]})
    messages = [asdict(message) for message in parts["messages"]]
    return {**parts, "name": parts["name"] or stem, "messages": messages}


def _text(data: bytes) -> str:
    """Return the text of a file."""
    if not data.strip():
        raise InputError(f"is empty; {OPENED}", "empty", "file")
    encoding = next((e for mark, e in MARKS.items() if data.startswith(mark)), "utf-8")
    for start, what in OTHERS:
        if data.startswith(start):
            raise InputError(f"is {what}; {OPENED}", "file-kind", "file")
    try:
        return data.decode(encoding)
    except UnicodeDecodeError as error:
        text = f"is not text in UTF-8 (byte {error.start}); {OPENED}"
        raise InputError(text, "file-kind", f"byte {error.start}") from error


def _parts(data: Any) -> dict[str, Any]:
    """Return what a file's JSON holds, by its schema."""
    schema = data.get("schema") if isinstance(data, dict) else None
    kind = schema.partition("/")[0] if isinstance(schema, str) else None
    readers = {of.partition("/")[0]: (of, read) for of, read in READERS.items()}
    if kind not in readers:
        if isinstance(data, dict) and {"joints", "beams"} <= data.keys():
            return _of_grid(data)  # whose reader says what is wrong
        other = f'has the schema "{schema}"' if isinstance(schema, str) else "has no schema"
        if schema == FAILURE:
            other = "says why a design has no result; it holds no design"
        raise InputError(f"{other}; {OPENED}", "file-kind", "schema")
    known, read = readers[kind]
    if schema != known:
        text = f'schema is "{schema}"; this version reads "{known}"'
        raise InputError(text, "file-version", "schema")
    parts: dict[str, Any] = {"name": "", "goals": [], "printer": None, "messages": []}
    return parts | read(data)


def _of_grid(data: Any) -> dict[str, Any]:
    return {"kind": "grid", "grid": grid_to_dict(grid_from_dict(data))}


def _of_result(data: Any) -> dict[str, Any]:
    grid = result_from_dict(data).grid
    text = "the file is a result; its design was opened and is simulated again"
    message = Message("opened-result", "file", text)
    return {"kind": "result", "grid": grid_to_dict(grid), "messages": [message]}


def _of_task(data: Any) -> dict[str, Any]:
    try:
        task = task_from_dict(data)
    except InputError as error:
        if error.code not in REMOVABLE:
            raise
        task = Task.model_validate(data)
    messages = []
    if (task.free, task.limits, task.method) != (Free(), Limits(), "default"):
        text = "what the task says about free parts, limits and method is not part of a document"
        messages.append(Message("opened-task", "file", text))
    goals = [goal.model_dump() for goal in task.goals]
    grid = grid_to_dict(grid_from_dict(task.grid))
    return {"kind": "task", "grid": grid, "goals": goals, "messages": messages}


def _of_document(data: Any) -> dict[str, Any]:
    check_document(data)
    optional = {key: data[key] for key in ("name", "printer") if data.get(key)}
    return {
        "kind": "document",
        "grid": data["grid"],
        "goals": [{"weight": 1.0, **goal} for goal in data.get("goals", [])],
        **optional,
    }


READERS = {GRID: _of_grid, TASK: _of_task, RESULT: _of_result, DOCUMENT: _of_document}


def _stem(name: str) -> str:
    """Return the name of a file without folders and ending, as a person would call it."""
    base = PureWindowsPath(PurePath(name).name).name
    stem = base[:-5] if base.lower().endswith(".json") else base
    return " ".join("".join(c if c.isprintable() else " " for c in stem).split())[:200]
