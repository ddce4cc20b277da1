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
from simulearn.material import materials_of
from simulearn.material.material import is_name
from simulearn.studio.bodies import OwnMaterials
from simulearn.studio.problems import place_of

SCHEMA = "simulearn.document/1"
MOST_GOALS = 1000
SECTIONS = ("start", "middle", "end")
NAMED, OWN = "a name", "a profile"  # kinds of a printer, in places of pydantic

Coordinate = Annotated[float, Field(ge=-FARTHEST, le=FARTHEST)]
Point = Annotated[list[Coordinate], Field(min_length=2, max_length=2)]
Target = Annotated[list[Coordinate], Field(min_length=3, max_length=3)]
Index = Annotated[int, Field(ge=0, lt=MOST_JOINTS)]
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


class DocumentGoal(_Strict):
    """A vertex, the point where it is wanted (mm), and how much it counts."""

    vertex: Annotated[list[int | str], Field(min_length=3, max_length=4)]
    target: Target
    weight: Annotated[float, Field(ge=0, le=1e6)] = 1.0


class OwnPrinter(_Strict):
    """A printer by the text of its profile, so that a document can be printed anywhere."""

    profile: Annotated[str, Field(max_length=MOST_TEXT)]


DocumentPrinter = Annotated[
    Annotated[str, Field(max_length=80), Tag(NAMED)] | Annotated[OwnPrinter, Tag(OWN)],
    Discriminator(lambda value: OWN if isinstance(value, dict) else NAMED),
]


class DocumentFile(_Strict):
    """A design, its goals, what it is to be printed on (a name, or a profile), own materials."""

    schema_: Annotated[Literal["simulearn.document/1"], Field(alias="schema")]
    name: Annotated[str, Field(max_length=200)] = ""
    grid: Drawing
    goals: Annotated[list[DocumentGoal], Field(max_length=MOST_GOALS)] = []
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
    for k, goal in enumerate(document.goals):
        if not is_vertex(goal.vertex, joints, beams):
            where = f"goals[{k}].vertex"
            text = f"{where} is {shown(goal.vertex)}; the grid has no such vertex"
            raise InputError(text, "document", where)


def is_vertex(vertex: list[Any], joints: int, beams: int) -> bool:
    """Return whether a grid of so many joints and beams has a vertex, as a task names it."""

    def within(k: Any, count: int) -> bool:
        return isinstance(k, int) and not isinstance(k, bool) and 0 <= k < count

    match vertex:
        case ["joint", k, corner]:
            return within(k, joints) and (corner == "centre" or within(corner, 8))
        case ["beam", b, section, corner]:
            return (
                within(b, beams)
                and (section in SECTIONS or within(section, len(SECTIONS)))
                and (corner == "centre" or within(corner, 4))
            )
    return False


def _wrong(error: ValidationError) -> InputError:
    """Return the first of pydantic's errors in our words."""
    first = error.errors(include_url=False)[0]
    where = place_of(part for part in first["loc"] if part not in (NAMED, OWN))
    if first["type"] == "missing":
        text = f"{where} is missing"
    elif first["type"] == "extra_forbidden":
        text = f"{where} is not a key of a document"
    else:
        reason = first["msg"][:1].lower() + first["msg"][1:]
        text = f"{where or 'the document'} is {shown(first['input'])}; {reason}"
    return InputError(text, "document", where)
