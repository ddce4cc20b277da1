"""The document that the page edits and the server keeps: `simulearn.document/1`, read strictly.

Its grid may be a design that is not valid, or none yet: people save drawings halfway. What it must
be is well-formed: finite numbers within bounds, beams between joints that exist.
"""

import json
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag, ValidationError

from simulearn.errors import InputError
from simulearn.fabricate.profiles import MOST_TEXT
from simulearn.grid.arrays import shown
from simulearn.grid.structure import FARTHEST, MOST_BEAMS, MOST_JOINTS
from simulearn.inverse.goalfile import OBJECT, WORDS, CurveFile, Goal
from simulearn.inverse.wanting import agree
from simulearn.material import materials_of
from simulearn.material.reading import is_name
from simulearn.studio.bodies import OwnMaterials
from simulearn.studio.problems import place_of
from simulearn.studio.surfacefile import MOST_TRIANGLES

SCHEMA = "simulearn.document/1"
MOST_GOALS = 1000
MOST_SURFACES = 4
ITSELF = "itself"  # what beams can be away from besides surfaces
SECTIONS = ("start", "middle", "end")
NAMED, OWN = "a name", "a profile"  # kinds of a printer, in places of pydantic

Coordinate = Annotated[float, Field(ge=-FARTHEST, le=FARTHEST)]
Point = Annotated[list[Coordinate], Field(min_length=2, max_length=2)]
Target = Annotated[list[Coordinate], Field(min_length=3, max_length=3)]
Index = Annotated[int, Field(ge=0, lt=MOST_JOINTS)]
Corner = Annotated[int, Field(ge=0, lt=3 * MOST_TRIANGLES)]
Corners = Annotated[list[Corner], Field(min_length=3, max_length=3)]
Pair = Annotated[list[Index], Field(min_length=2, max_length=2)]
Ratio = Annotated[float, Field(ge=-1, le=1)]


class _Strict(BaseModel):
    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)


class Drawing(_Strict):
    """The grid of a document; mm, indices counted from 0, ratios in [-1, 1]."""

    schema_: Annotated[Literal["simulearn.grid/1"], Field(alias="schema")]
    joints: Annotated[list[Point], Field(max_length=MOST_JOINTS)]
    beams: Annotated[list[Pair], Field(max_length=MOST_BEAMS)]
    actuators: Annotated[list[Ratio], Field(max_length=MOST_BEAMS)]
    fixed: Index
    material: Annotated[str, Field(min_length=1, max_length=80)]


class DocumentSurface(_Strict):
    """A surface that goals name: triangles, mm from the fixed joint."""

    name: Annotated[str, Field(min_length=1, max_length=100)]
    vertices: Annotated[list[Target], Field(min_length=3, max_length=3 * MOST_TRIANGLES)]
    faces: Annotated[list[Corners], Field(min_length=1, max_length=MOST_TRIANGLES)]


class DocumentGoal(Goal):
    """A goal as in a task, whose surface is the name of one of the document's."""

    target: Target | None = None
    surface: Annotated[str, Field(max_length=100)] | None = None  # type: ignore[assignment]
    away_from: Annotated[str, Field(max_length=100)] | None = None  # type: ignore[assignment]
    weight: Annotated[float, Field(ge=0, le=1e6)] = 1.0


class OwnPrinter(_Strict):
    """A printer by the text of its profile, so that a document can be printed anywhere."""

    profile: Annotated[str, Field(max_length=MOST_TEXT)]


DocumentPrinter = Annotated[
    Annotated[str, Field(max_length=80), Tag(NAMED)] | Annotated[OwnPrinter, Tag(OWN)],
    Discriminator(lambda value: OWN if isinstance(value, dict) else NAMED),
]


class DocumentFile(_Strict):
    """A design, its goals with surfaces, what it is to be printed on, own materials.

    The printer is a name, or a profile. With the pose "free" the shape may be placed anywhere.
    """

    schema_: Annotated[Literal["simulearn.document/1"], Field(alias="schema")]
    name: Annotated[str, Field(max_length=200)] = ""
    grid: Drawing
    goals: Annotated[list[DocumentGoal], Field(max_length=MOST_GOALS)] = []
    surfaces: Annotated[list[DocumentSurface], Field(max_length=MOST_SURFACES)] = []
    pose: Literal["fixed", "free"] = "fixed"
    printer: DocumentPrinter = ""
    materials: OwnMaterials = []


def check_document(data: Any) -> None:
    """Make sure that data is a document.

    Raises:
        InputError: a key, type, length, index, number or own material is wrong; one line says
            which.
    """
    try:
        document = DocumentFile.model_validate(data)
        json.dumps(data, ensure_ascii=False).encode()
    except ValidationError as error:
        raise _wrong(error) from error
    except UnicodeEncodeError as error:
        raise InputError("the document holds half a character", "document", "name") from error
    _check_indices(document)
    _check_surfaces(document)
    _check_goals(document)
    materials_of(document.materials)


def _check_indices(document: DocumentFile) -> None:
    grid = document.grid
    if not (is_name(grid.material) and grid.material.isprintable()):
        text = f"grid.material is {shown(grid.material)}; it is the name of a material system"
        raise InputError(text, "document", "grid.material")
    joints, beams = len(grid.joints), len(grid.beams)
    if len(grid.actuators) != beams:
        text = f"grid.actuators has {len(grid.actuators)} ratios for {beams} beams"
        raise InputError(f"{text}; there is one for each beam", "document", "grid.actuators")
    for k, pair in enumerate(grid.beams):
        if max(pair) >= joints:
            text = f"grid.beams[{k}] is {pair}; the grid has {joints} joints, numbered from 0"
            raise InputError(text, "document", f"grid.beams[{k}]")
    if grid.fixed >= max(joints, 1):
        text = f"grid.fixed is {grid.fixed}; the grid has {joints} joints, numbered from 0"
        raise InputError(text, "document", "grid.fixed")


def _check_surfaces(document: DocumentFile) -> None:
    names: set[str] = set()
    for k, surface in enumerate(document.surfaces):
        where = f"surfaces[{k}]"
        if surface.name in (*names, ITSELF):
            text = f"{where}.name is {shown(surface.name)}, which another has; names differ"
            raise InputError(text, "document", f"{where}.name")
        names.add(surface.name)
        count = len(surface.vertices)
        for n, face in enumerate(surface.faces):
            if max(face) >= count:
                text = f"{where}.faces[{n}] is {face}; the surface has {count} vertices, from 0 on"
                raise InputError(text, "document", f"{where}.faces[{n}]")


def _check_goals(document: DocumentFile) -> None:
    joints, beams = len(document.grid.joints), len(document.grid.beams)
    names = [surface.name for surface in document.surfaces]
    for k, goal in enumerate(document.goals):
        where = f"goals[{k}]"
        try:
            agree(goal, where)
        except InputError as error:
            raise InputError(str(error), "document", error.where) from error
        if isinstance(goal.curve, CurveFile) and goal.curve.points is None:
            text = f"{where}.curve has points; files are not read here"
            raise InputError(text, "document", f"{where}.curve")
        for key, known in (("surface", names), ("away_from", [*names, ITSELF])):
            named = getattr(goal, key)
            if named is not None and named not in known:
                text = f"{where}.{key} is {shown(named)}; the document has no such surface"
                raise InputError(text, "document", f"{where}.{key}")
        for key, fits in WHOSE.items():
            value = getattr(goal, key)
            if value is None or isinstance(value, str):
                continue
            for one in value if key in ("vertices", "faces") else [value]:
                if not fits(one, joints, beams):
                    what = "vertex" if key.startswith("vert") else "face"
                    text = f"{where}.{key} is {shown(one)}; the grid has no such {what}"
                    raise InputError(text, "document", f"{where}.{key}")


def is_vertex(vertex: list[Any], joints: int, beams: int) -> bool:
    """Return whether a grid of so many joints and beams has a vertex, as a task names it."""
    match vertex:
        case ["joint", k, corner]:
            return _within(k, joints) and (corner == "centre" or _within(corner, 8))
        case ["beam", b, section, corner]:
            return (
                _within(b, beams)
                and _is_section(section)
                and (corner == "centre" or _within(corner, 4))
            )
    return False


def is_face(face: list[Any], joints: int, beams: int) -> bool:
    """Return whether a grid of so many joints and beams has a face, as a task names it."""
    match face:
        case ["joint", k, side]:
            return _within(k, joints) and (side == "top" or _within(side, 4))
        case ["beam", b]:
            return _within(b, beams)
        case ["beam", b, section] | ["beam", b, section, "top"]:
            return _within(b, beams) and _is_section(section)
    return False


# What names parts of the grid in a goal, and what a name has to be.
WHOSE = {"vertex": is_vertex, "vertices": is_vertex, "face": is_face, "faces": is_face}


def _within(k: Any, count: int) -> bool:
    return isinstance(k, int) and not isinstance(k, bool) and 0 <= k < count


def _is_section(section: Any) -> bool:
    return section in SECTIONS or _within(section, len(SECTIONS))


def _wrong(error: ValidationError) -> InputError:
    """Return the first of pydantic's errors in our words."""
    first = error.errors(include_url=False)[0]
    where = place_of(part for part in first["loc"] if part not in (NAMED, OWN, WORDS, OBJECT))
    if first["type"] == "missing":
        text = f"{where} is missing"
    elif first["type"] == "extra_forbidden":
        text = f"{where} is not a key of a document"
    else:
        reason = first["msg"][:1].lower() + first["msg"][1:]
        text = f"{where or 'the document'} is {shown(first['input'])}; {reason}"
    return InputError(text, "document", where)
