"""Files that a person opens: grids, tasks, results, pages, documents; drawings, surfaces of others.

All are known by what they hold, not by their names.
"""

from dataclasses import asdict
from functools import partial
from pathlib import PurePath, PureWindowsPath
from typing import Any, Literal

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
from simulearn.studio.surfacefile import surface_of
from simulearn.studio.taskfile import goals_in

LOOK = 2**12  # bytes in which JSON begins
OWN = "simulearn."  # the beginning of our schemas
OPENED = "the studio opens grids, tasks, results, documents, drawings and surfaces"
# What is left out of a design's name.
ENDINGS = (".json", ".dxf", ".svg", ".3dm", ".csv", ".txt", ".obj", ".html", ".stl", ".ply", ".glb")
# What a search begins from may not have; it is no error in a drawing.
REMOVABLE = ("dangling-beam", "unused-joint")
FILES = "surface-path"  # a goal on a surface that only the command line can read


def opened(
    data: bytes,
    name: str,
    options: Options | None = None,
    meant: Literal["surface", "drawing"] | None = None,
) -> dict[str, Any]:
    """Return the parts of a document that a file holds.

    Args:
        data: contents of the file.
        name: of the file; it names a design that has no name of its own.
        options: how a drawing is to be read; its unit is that of a surface, too.
        meant: what a file is to be taken for that holds lines and triangles.

    Returns:
        kind (grid, task, result, document or drawing), name, grid, goals, surfaces, pose, printer
        (None if the file names none), texts of own materials, messages about what was not taken
        over, and what is to be reported of a drawing: format, unit, layers and mends (None for
        other files). Of a surface: kind, name, and what `surface_of` says.

    Raises:
        InputError: the file holds nothing that can be opened; the message says what and where.
        UnitError: the unit of a drawing is not known.
    """
    stem = _stem(name)
    named = partial("{}: {}".format, stem or "the file")
    try:
        unit = options.unit if options else None
        surface = meant != "drawing" and surface_of(data, name, unit, meant=meant == "surface")
        if surface:
            return {"kind": "surface", "name": stem or "surface", "surface": surface}
        parts = _parts(data, name, options)
    except UnitError as error:
        raise UnitError(named(error), error.guess, error.size) from error
    except InputError as error:
        raise InputError(named(error), error.code, error.where, error.messages) from error
    wanted = {key: parts[key] for key in ("goals", "surfaces", "pose")}
    check_document({"schema": DOCUMENT, "grid": parts["grid"], **wanted})
    messages = [asdict(message) for message in parts["messages"]]
    return {**parts, "name": parts["name"] or stem, "messages": messages}


def _parts(data: bytes, name: str, options: Options | None) -> dict[str, Any]:
    """Return what a file holds: what is ours by its schema, else a drawing."""
    parts: dict[str, Any] = {
        "name": "",
        "goals": [],
        "surfaces": [],
        "pose": "fixed",
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
    if (task.free, task.limits, task.method, task.robust) != (Free(), Limits(), "default", False):
        text = (
            "what the task says about free parts, limits, method and robust is not part of a "
            "document"
        )
        messages.append(Message("opened-task", "file", text))
    goals, surfaces, lost = goals_in(task)
    if lost:
        text = (
            f"{len(lost)} goals name files ({', '.join(lost)[:200]}), which cannot be read from "
            "here; drop the surface on the page"
        )
        messages.append(Message("opened-goals", "file", text))
    grid = grid_to_dict(grid_from_dict(task.grid))
    parts = {"goals": goals, "surfaces": surfaces, "pose": task.pose}
    return {"kind": "task", "grid": grid, "messages": messages, **parts}


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
    names = ("name", "printer", "materials", "surfaces", "pose")
    optional = {key: data[key] for key in names if data.get(key)}
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
