"""Goals as a task file has them: whose they are, what is wanted, how much it counts."""

from typing import Annotated, Any, Literal

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    SerializerFunctionWrapHandler,
    Tag,
    model_serializer,
)

from simulearn.grid.arrays import whole

MOST = 1e6  # mm, or whatever a number is of; squares and sums of such numbers are finite

Number = Annotated[float, Field(ge=-MOST, le=MOST)]
Positive = Annotated[float, Field(gt=0, le=MOST)]
NotNegative = Annotated[float, Field(ge=0, le=MOST)]
Point = Annotated[list[Number], Field(min_length=3, max_length=3)]
Range = Annotated[list[Number], Field(min_length=2, max_length=2)]
Corner = Annotated[int, BeforeValidator(whole), Field(ge=0, lt=2**31)]
Corners = Annotated[list[Corner], Field(min_length=3, max_length=3)]

# What a goal may want, and what it is wanted of.
OF = {
    "target": ("vertex", "vertices"),
    "surface": ("vertex", "vertices"),
    "curve": ("vertex", "vertices"),
    "plane": ("vertex", "vertices"),
    "direction": ("face", "faces"),
    "distance": ("vertices",),
    "angle": ("faces",),
    "away_from": (),
}
# Left out of a file where they say nothing, so that files without them stay as they were.
SILENT: dict[str, Any] = {
    "tolerance": None,
    "robust": False,
    "pose": "fixed",
    "slide": True,
    "answers": 1,
}


def _plain_words(words: Any) -> Any:
    """Return a vertex as it is kept: "center" as "centre", 2.0 as 2."""
    if not isinstance(words, list):
        return words
    return ["centre" if word == "center" else whole(word) for word in words]


def _plain_list(words: Any) -> Any:
    return [_plain_words(one) for one in words] if isinstance(words, list) else words


# Kinds of a value, in places of pydantic.
WORDS, OBJECT = "a text", "a list or object"


def _kind(value: Any) -> str:
    return WORDS if isinstance(value, str) else OBJECT


Words = Annotated[list[Any], BeforeValidator(_plain_words)]
ManyWords = Annotated[list[Words], BeforeValidator(_plain_list), Field(min_length=1)]


class FilePart(BaseModel):
    """A part of a task file."""

    model_config = ConfigDict(frozen=True, strict=True, extra="forbid", allow_inf_nan=False)

    @model_serializer(mode="wrap")
    def _written(self, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Leave out what says nothing."""
        return {
            key: value
            for key, value in write(self).items()
            if not (key in SILENT and value == SILENT[key])
        }


class _Spoken(FilePart):
    """A part that is written without what it does not say."""

    @model_serializer(mode="wrap")
    def _written(self, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
        return {
            key: value
            for key, value in write(self).items()
            if value is not None and not (key in SILENT and value == SILENT[key])
        }


class Motion(_Spoken):
    """A rigid motion: first turned, then shifted.

    Attributes:
        turn: rows of a rotation.
        shift: mm.
    """

    turn: Annotated[list[Point], Field(min_length=3, max_length=3)] | None = None
    shift: Point | None = None


class SurfaceFile(_Spoken):
    """A surface: in a file, by heights, or by its triangles.

    Attributes:
        file: .stl, .obj, .ply, .glb or .3dm, seen from the folder of the task.
        unit: of the file.
        heights: an expression in x and y, or a table; mm.
        x, y: from where to where heights reach, mm.
        step: of points between which an expression is straight, mm.
        vertices, faces: of triangles.
        place: where it goes.
    """

    file: str | None = None
    unit: str | None = None
    heights: (
        Annotated[
            Annotated[str, Tag(WORDS)] | Annotated[list[list[Number]], Tag(OBJECT)],
            Discriminator(_kind),
        ]
        | None
    ) = None
    x: Range | None = None
    y: Range | None = None
    step: Positive | None = None
    vertices: list[Point] | None = None
    faces: list[Corners] | None = None
    place: Motion | None = None


class CurveFile(_Spoken):
    """A curve: in a file, or by its points.

    Attributes:
        file: .csv, .3dm, .dxf or .svg, seen from the folder of the task.
        unit: of the file.
        points: of a polyline, mm.
        place: where it goes.
    """

    file: str | None = None
    unit: str | None = None
    points: Annotated[list[Point], Field(min_length=2)] | None = None
    place: Motion | None = None


class PlaneFile(_Spoken):
    """A plane.

    Attributes:
        point: on it, mm.
        normal: across it, of any length.
    """

    point: Point
    normal: Point


class Goal(_Spoken):
    """What is wanted, of what, and how much it counts; of what may be wanted one thing.

    Attributes:
        vertex: ["joint", k, "centre"], ["joint", k, corner] or ["beam", b, section, corner].
        vertices: several of them; "joints" are the centres of all joints, "beams" the centres of
            the beams' middles.
        face: ["joint", k, "top" or side], ["beam", b], ["beam", b, section] or the same and "top".
        faces: several of them.
        target: [x, y, z] mm, seen from the fixed joint.
        surface: on which vertices are wanted.
        curve: on which they are wanted.
        plane: on which they are wanted.
        direction: [x, y, z] of a face.
        distance: between two vertices, mm.
        angle: between two faces, degrees.
        away_from: a surface of a body, or "itself".
        slide: whether a vertex may come to any point of a surface, curve or plane; if not, to the
            one that is closest at the beginning.
        clearance: that is left between the beams and what they are away from, mm.
        weight: not negative; of each vertex.
        tolerance: distance that a print may have, mm; None: that of the task.
    """

    vertex: Words | None = None
    vertices: (
        Annotated[
            Annotated[Literal["joints", "beams"], Tag(WORDS)] | Annotated[ManyWords, Tag(OBJECT)],
            Discriminator(_kind),
        ]
        | None
    ) = None
    face: Words | None = None
    faces: ManyWords | None = None
    target: Point | None = None
    surface: SurfaceFile | None = None
    curve: CurveFile | None = None
    plane: PlaneFile | None = None
    direction: Point | None = None
    distance: Positive | None = None
    angle: Annotated[float, Field(ge=0, le=180)] | None = None
    away_from: (
        Annotated[
            Annotated[Literal["itself"], Tag(WORDS)] | Annotated[SurfaceFile, Tag(OBJECT)],
            Discriminator(_kind),
        ]
        | None
    ) = None
    slide: bool = True
    clearance: NotNegative | None = None
    weight: NotNegative = 1.0
    tolerance: Positive | None = None

    @property
    def wanted(self) -> str:
        """The key that says what is wanted; "" where none or several do."""
        found = [key for key in OF if getattr(self, key) is not None]
        return found[0] if len(found) == 1 else ""
