"""What a drawing holds before it is a grid: lines in space, in the unit of its file."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Line:
    """A polyline as the file draws it, seen as on the screen: y up, z towards the viewer.

    Attributes:
        points: (n, 3), n at least 2, in the unit of the file; transforms of blocks and groups are
            applied. A closed one ends where it begins.
        layer: full name of its layer or group, levels joined by `::`; empty where it has none.
        colour: "#rrggbb" as it is seen, that of the layer where the line has none; None where the
            file says nothing.
        where: what the file calls it, for messages: "LINE 2F", "path3021", "row 4".
    """

    points: Points
    layer: str = ""
    colour: str | None = None
    where: str = ""


@dataclass(frozen=True, eq=False)
class Curve:
    """A curve, which beams cannot follow: it becomes lines only where the person asks for it.

    Attributes:
        kind: in the words of its format: "ARC", "SPLINE", "cubic Bezier", "NURBS curve".
        flatten: returns its points (n, 3) for a largest distance between curve and chord, both in
            the unit of the file.
        layer: as in `Line`.
        colour: as in `Line`.
        where: as in `Line`.
    """

    kind: str
    flatten: Callable[[float], Points]
    layer: str = ""
    colour: str | None = None
    where: str = ""


@dataclass(frozen=True)
class LeftOut:
    """Things of one kind on one layer that are not read, and why.

    Attributes:
        kind: in the words of the format: "TEXT", "HATCH", "mesh".
        count: how many.
        layer: full name of their layer; empty where they have none.
        reason: "is no line", "is hidden", "its layer is frozen", "is in paper space".
    """

    kind: str
    count: int
    layer: str
    reason: str


@dataclass(frozen=True)
class Unit:
    """The unit of a file.

    Attributes:
        mm: length of one unit, mm.
        name: of the unit: "mm", "cm", "m", "in", "ft", "pt", "px".
        source: what says so: "$INSUNITS of the file is 1", "width=130mm of the file".
    """

    mm: float
    name: str
    source: str


@dataclass(frozen=True, eq=False)
class Drawing:
    """A drawing as a reader returns it; nothing is mended yet.

    Attributes:
        format: "DXF", "SVG", "Rhino (.3dm)", "JSON lines", "CSV", "OBJ".
        lines: all that is visible and straight.
        curves: all that is visible and curved.
        left_out: all else, counted.
        unit: what the file says, or None.
        guess: the likeliest unit where the file says none, with the reason; None where nothing
            speaks for one.
        plain: whether the format knows no units, so that its numbers are mm by convention, as in
            lists of points.
        messages: remarks of the reader in plain sentences, such as a damaged part left out.
    """

    format: str
    lines: list[Line]
    curves: list[Curve] = field(default_factory=list)
    left_out: list[LeftOut] = field(default_factory=list)
    unit: Unit | None = None
    guess: Unit | None = None
    plain: bool = False
    messages: list[str] = field(default_factory=list)
