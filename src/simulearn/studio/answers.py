"""What the API answers, for its description: types of the JSON that the routes return."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from simulearn.grid.gridfile import GridFile
from simulearn.material import Identity
from simulearn.studio.problems import MessageBody

Point = Annotated[list[float], Field(min_length=3, max_length=3)]
Corners = Annotated[list[Point], Field(min_length=8, max_length=8)]
Section = Annotated[list[Point], Field(min_length=4, max_length=4)]
Interval = Annotated[list[float], Field(min_length=2, max_length=2)]
Box = Annotated[list[Interval], Field(min_length=2, max_length=2)]
Sections = Annotated[list[Section], Field(min_length=3, max_length=3)]


class _Answer(BaseModel):
    model_config = ConfigDict(extra="forbid")


class GridsInOneRequest(_Answer):
    """How much a request may hold."""

    grids: int
    joints: int
    beams: int
    beams_in_all: int
    body_bytes: int


class Version(_Answer):
    """The program, and what it offers."""

    version: str
    api: int
    ready: Annotated[bool, Field(description="false while kernels compile the first time")]
    engines: list[str]
    model: Identity
    formats: Annotated[list[str], Field(description="endings of files of a result")]
    limits: GridsInOneRequest


class LibraryDesign(_Answer):
    """A grid that morphs into a shape with a name."""

    name: str
    description: str
    grid: GridFile


class Library(_Answer):
    """The library of grids."""

    designs: list[LibraryDesign]


class SectionSize(_Answer):
    """Cross-section of a beam, mm."""

    width: float
    thickness: float
    shell: float


class DesignLimits(_Answer):
    """Limits of a design, mm."""

    beam_length: float
    beam_net_length: float
    actuator_length: float


class ScatterFacts(_Answer):
    """Relative standard deviations of the strain from print to print and from beam to beam."""

    print: float
    beam: float


class LearnedFacts(_Answer):
    """Whether the default model answers for a material, and what there is to say about that."""

    knows: Annotated[
        Literal["inside", "outside", "no"],
        Field(description="outside: with a wider bound; no: finite elements do"),
    ]
    message: str


class MaterialFacts(_Answer):
    """A material system."""

    name: str
    title: str
    section: SectionSize
    limits: DesignLimits
    strain: Annotated[float, Field(description="released by an active half")]
    curl: Annotated[float, Field(description="by so much more the top shrinks than the bottom")]
    scatter: ScatterFacts
    learned: LearnedFacts


class Materials(_Answer):
    """The material systems by name."""

    materials: list[MaterialFacts]


class BedFacts(_Answer):
    """What can be printed on, mm."""

    width: float
    depth: float
    height: float
    origin: Literal["corner", "centre"]
    shape: Annotated[
        Literal["rectangle", "round"] | None, Field(description="null where it is not known")
    ]
    excluded: Annotated[list[Box], Field(description="rectangles in which nothing is printed")]


class ReachFacts(_Answer):
    """Where start and end code may move, from and to, mm; null: as far as the bed."""

    x: Interval | None
    y: Interval | None
    z: Interval | None


class PrinterFacts(_Answer):
    """A printer; mm and degrees Celsius."""

    name: str
    title: str
    firmware: str
    sources: Annotated[list[str], Field(description="what the profile follows")]
    tried: Annotated[str, Field(description="who has printed with the profile; empty: nobody")]
    formats: Annotated[list[str], Field(description="files that it takes, the best first")]
    bed: BedFacts
    reach: ReachFacts
    nozzle: float
    filament: float
    nozzle_most: float
    bed_most: float


class Printers(_Answer):
    """The printers by name."""

    printers: list[PrinterFacts]


class ValidationAnswer(_Answer):
    """What forbids a design, and what is unusual about it."""

    errors: list[MessageBody]
    warnings: list[MessageBody]


class SnapFacts(_Answer):
    """A sudden motion to another equilibrium."""

    released: float
    frame: int


class CollisionFacts(_Answer):
    """Two parts of a grid that run through each other, at their worst moment."""

    parts: Annotated[list[str], Field(description="such as beam 3 and joint 7")]
    frame: Annotated[int, Field(description="the worst, or the one before the worst moment")]
    share: Annotated[float, Field(description="of the time to the next frame; 0 in a frame")]
    first: Annotated[int, Field(description="first frame after contact has begun")]
    depth_mm: float
    place: Point


class JointSpread(_Answer):
    """How prints differ at a joint, mm; `simulearn.simulate.spread` says more."""

    mean_mm: Point
    up_mm: float
    plane_mm: float
    up_90_mm: Interval
    plane_90_mm: float


class SpreadAnswer(_Answer):
    """How prints of the design differ in the last frame."""

    print: float
    beam: float
    law: str
    seed: int
    engine: str
    drawn: int
    prints: int
    beyond: Annotated[
        int, Field(description="drawn with a beam beyond what the model has learnt; guesses")
    ]
    groups: Annotated[
        list[int],
        Field(description="prints of each of several shapes with none between; none if it is one"),
    ]
    overall_mm: float
    overall_percent: float
    joints: list[JointSpread]


class ResultAnswer(_Answer):
    """The twelve frames of a morphing grid; mm, s, +z up."""

    schema_: Annotated[Literal["simulearn.result/1"], Field(alias="schema")]
    grid: GridFile
    engine: str
    joints: Annotated[list[list[Corners]], Field(description="frame, joint, corner, xyz")]
    beams: Annotated[list[list[Sections]], Field(description="frame, beam, section, corner, xyz")]
    seconds: float
    stable: bool
    bound_mm: float | None
    snaps: list[SnapFacts]
    warnings: list[MessageBody]
    collisions: Annotated[
        list[CollisionFacts], Field(description="the deepest first; no engine knows of contact")
    ]
    material: Identity
    model: Identity | None
    scatter: Annotated[
        SpreadAnswer | None, Field(description="only where prints were asked for")
    ] = None


class FailureAnswer(_Answer):
    """Why a design has no result."""

    schema_: Annotated[Literal["simulearn.failure/1"], Field(alias="schema")]
    code: str
    where: str
    message: str
    hint: str


class SimulateAnswer(_Answer):
    """The outcome of each design, in their order."""

    results: list[ResultAnswer | FailureAnswer]


class GoalName(_Answer):
    """One of the goals that the entries of a task stand for."""

    entry: Annotated[int, Field(description="of the task's goals, from 0 on")]
    name: str
    kind: str


class Motion(_Answer):
    """First turned, then shifted, mm."""

    turn: list[Point]
    shift: Point


class ShapeMeasured(_Answer):
    """A shape against the goals, in their order; mm, degrees."""

    error_mm: float
    distances_mm: list[float]
    degrees: list[float | None]
    lines: Annotated[
        list[list[Point]], Field(description="to where it should be, of goals that are no points")
    ]
    place: Annotated[Motion, Field(description="brings the shape to where it is compared")]


class MeasureAnswer(_Answer):
    """How far shapes are from goals."""

    goals: list[GoalName]
    shapes: list[ShapeMeasured]


class Modification(_Answer):
    """A single change of a design and what it leads to."""

    words: str
    part: Literal["joint", "actuator"]
    indices: list[int]
    error_mm: float
    moved_mm: float


class Suggestion(Modification):
    """One of the best modifications that differ."""

    grid: GridFile
    points: Annotated[list[Point], Field(description="where the goals' vertices come to")]


class RankAnswer(_Answer):
    """All modifications of a design, the best first."""

    material: Identity
    error_mm: float
    points: Annotated[list[Point], Field(description="where the goals' vertices are")]
    best: list[Suggestion]
    suggestions: list[Modification]
