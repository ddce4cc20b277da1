"""From a drawing to a grid: layers, unit, plane, mends and actuators; every step is reported."""

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from simulearn.drawings.drawing import Curve, Drawing, Line, Unit
from simulearn.drawings.layers import LayerUse, layers_of, ratios_of
from simulearn.drawings.mending import MENDS, Mended, mended
from simulearn.drawings.plane import flattened, in_plane
from simulearn.drawings.reading import own_grid, read_drawing
from simulearn.drawings.report import Mend, curves_left_out, left_out, mend
from simulearn.drawings.scaling import Size, given_unit, likely, size_warning, unit_error
from simulearn.drawings.units import odd
from simulearn.errors import InputError, Message
from simulearn.grid import Grid
from simulearn.grid.sketch import middle_joint
from simulearn.grid.structure import FARTHEST, structure_errors

Numbers = NDArray[np.float64]

# For a first look at a drawing without a unit: the tolerance as a part of its size.
COARSE = 1 / 300
# Coordinates beyond this, in any unit, are damaged.
BEYOND = 1e12
# A move by less is not worth a word, mm.
SHIFT = 0.01
# What is mended whatever a person chooses, and why.
ALWAYS = {
    "crumb": "what is shorter than the tolerance has no place in a grid",
    "double": "a grid has one beam between two joints",
}
# Where beams are oddly short the tolerance is at most this part of one.
FINE = 0.1


@dataclass(frozen=True)
class Options:
    """What a person chooses about an import.

    Attributes:
        unit: name of the drawing's unit; goes before what the file says.
        width: mm that the whole drawing is wide; goes before the unit.
        layers: names or patterns of the layers to read, in any case; empty: all.
        flatten: largest distance of chords from curves, mm; None: curves are left out.
        actuators: what says the actuators: layers where one's name does, else colours ("auto").
        tolerance: how far lines may miss each other, mm.
        without: codes of mends that are not done.
        material: name of the material system.
        place: where the grid lies: its lower left "corner" at the origin, or as "drawn".
    """

    unit: str | None = None
    width: float | None = None
    layers: tuple[str, ...] = ()
    flatten: float | None = None
    actuators: Literal["auto", "layers", "colours", "none"] = "auto"
    tolerance: float = 1.0
    without: frozenset[str] = frozenset()
    material: str = "pla-hot-water"
    place: Literal["corner", "drawn"] = "corner"


@dataclass(frozen=True, eq=False)
class Imported:
    """A grid from a drawing, and a report of every step to it.

    Attributes:
        grid: without dangling beams, unless nothing else is left or they were to stay.
        format: of the drawing.
        unit: that was taken.
        layers: of the drawing.
        mends: what was done.
        messages: what was taken, guessed and left out.
    """

    grid: Grid
    format: str
    unit: Unit
    layers: tuple[LayerUse, ...]
    mends: tuple[Mend, ...]
    messages: tuple[Message, ...]


def imported(data: bytes, name: str, options: Options | None = None) -> Imported:
    """Return the grid in the contents of a file: a drawing, or a grid, result or task of ours.

    Args:
        data: the contents.
        name: of the file, for what its contents do not say.
        options: what a person chooses; a grid of ours is taken as it is.

    Raises:
        InputError: the file cannot be read, or holds no lines; the text has no file name.
        UnitError: its unit is not known, or makes no sense.
    """
    grid = own_grid(data)
    if grid is not None:
        return Imported(grid, "SimuLearn", Unit(1.0, "mm", "grids are in mm"), (), (), ())
    return grid_of(read_drawing(data, name), options)


def grid_of(drawing: Drawing, options: Options | None = None) -> Imported:
    """Return the grid that a drawing shows.

    Args:
        drawing: as its reader returns it.
        options: what a person chooses.

    Raises:
        InputError: there are no lines, they are not flat, a layer or unit is unknown, an option
            makes no sense, or the grid is too large.
        UnitError: the unit is not known, or makes no sense.
    """
    options = options or Options()
    _check(options)
    layers = layers_of(drawing, options.layers)
    taken = {layer.name for layer in layers if layer.taken}
    lines = [line for line in drawing.lines if line.layer in taken]
    curves = [curve for curve in drawing.curves if curve.layer in taken]
    messages = [*_remarks(drawing, layers)]
    flatten = None if "flattened" in options.without else options.flatten
    if flatten is None:
        messages += curves_left_out(curves)
        if not lines:
            raise _nothing(drawing, curves)
        curves = []
    if not lines and not curves:
        raise _nothing(drawing, curves)
    ratios, ratio_messages = ratios_of([*lines, *curves], options.actuators)
    size = measured(_polylines(lines, curves, None))
    if lines and curves:  # chords of curves are no beams to judge a size by
        size = replace(size, beam=measured(_polylines(lines, [], None)).beam)
    unit, tolerance, odd_size = _unit(drawing, size, options)
    messages = [_unit_message(unit, size), *odd_size, *messages, *ratio_messages]
    chords = None if flatten is None else flatten / unit.mm
    points = [unit.mm * points for points in _polylines(lines, curves, chords)]
    plane, turned = _in_plane(points, tolerance, options.without)
    meant = np.arange(len(points)) >= len(lines)
    result = mended(plane, np.array(ratios), meant, tolerance, options.without)
    if not len(result.net.beams):
        text = f"all lines are shorter than the tolerance of {tolerance:g} mm"
        raise InputError(f"{text}; it can be less", "no-lines", "tolerance")
    messages += [_always(code) for code in ALWAYS if code in options.without & set(result.places)]
    result.places.update(turned)
    if curves:
        result.places["flattened"] = np.stack([line[0] for line in plane[len(lines) :]])
    return _imported(result, drawing, unit, layers, messages, options)


def _always(code: str) -> Message:
    text = f"{code}: {ALWAYS[code]}, so this is done nevertheless"
    return Message("mend-needed", code, text)


def _check(options: Options) -> None:
    """Raise InputError if an option makes no sense."""
    for name in ("tolerance", "flatten"):
        value = getattr(options, name)
        if value is not None and not 0 < value < float("inf"):
            raise InputError(f"the {name} is {value:g} mm; it is more than 0", name, name)
    for code in sorted(options.without):
        if code not in MENDS:
            text = f'"{code}" is none of the mends; they are {", ".join(MENDS)}'
            raise InputError(text, "mend-unknown", code)


def _remarks(drawing: Drawing, layers: Sequence[LayerUse]) -> Iterator[Message]:
    """Yield what the reader says, and what was not read."""
    for text in drawing.messages:
        yield Message("reader", "", text)
    for layer in layers:
        if not layer.taken:
            count = "1 line" if layer.lines == 1 else f"{layer.lines} lines"
            text = f'{count} on the layer "{layer.name}" left out: it is not among those to read'
            yield Message("left-out", layer.name, text)
    yield from left_out(drawing)


def _nothing(drawing: Drawing, curves: Sequence[Curve]) -> InputError:
    """Return the error of a drawing without lines."""
    if curves:
        kinds = Counter(curve.kind for curve in curves)
        names = ", ".join(f"{count} x {kind}" for kind, count in kinds.items())
        text = (
            f"the drawing has only curves ({names}) and no straight lines; curves become straight "
            "pieces for a largest distance that is given"
        )
        return InputError(text, "curves-only", "curves")
    rest = "; ".join(message.message for message in left_out(drawing))
    return InputError(f"the drawing has no lines{rest and f' ({rest})'}", "no-lines", "lines")


def _polylines(
    lines: Sequence[Line], curves: Sequence[Curve], chords: float | None
) -> list[Numbers]:
    """Return all polylines, each (n, 3) in the unit of the file.

    Args:
        lines: straight as they are.
        curves: made of chords.
        chords: their largest distance from the curve, in the unit of the file; None: by the size
            of the curves.
    """
    if chords is None and curves:
        rough = np.concatenate([curve.flatten(1.0) for curve in curves])
        chords = max(1e-12, float(np.ptp(rough, axis=0).max()) * COARSE)
    return [line.points for line in lines] + [curve.flatten(chords or 1.0) for curve in curves]


def measured(lines: Sequence[Numbers]) -> Size:
    """Return the size of polylines, each (n, 3), and the length of the middle beam in them.

    Raises:
        InputError: a coordinate makes no sense, or all lines have no length.
    """
    points = np.concatenate(lines)
    offsets = np.cumsum([0, *map(len, lines)])
    far = ~(abs(points) < BEYOND).all(axis=1)
    if far.any():
        place = ", ".join(f"{value:g}" for value in points[far.argmax()])
        text = f"a line has a point at [{place}]; coordinates are numbers below {BEYOND:g}"
        raise InputError(text, "point", f"[{place}]")
    whole = float(np.linalg.norm(np.ptp(points, axis=0)))
    plane = in_plane(points, COARSE * whole).points
    step = np.hypot(*np.diff(plane, axis=0).T)
    step = np.delete(step, offsets[1:-1] - 1)
    if not step.any():
        raise InputError("all lines have the length 0", "no-lines", "lines")
    usual = float(np.median(step[step > 0]))
    tolerance = min(COARSE * whole, usual / 20)
    parts = np.split(plane, offsets[1:-1])
    none = np.zeros(len(parts))
    net = mended(parts, none, none > 0, tolerance, {"stub", "leaf"}).net
    width, height = np.ptp(plane, axis=0).tolist()
    return Size(width, height, float(np.median(net.lengths)) if len(net.beams) else usual)


def _unit(drawing: Drawing, size: Size, options: Options) -> tuple[Unit, float, list[Message]]:
    """Return the unit, the tolerance in mm that fits the size, and a warning about an odd one."""
    unit = given_unit(drawing, options.unit, options.width, size)
    if unit is None:
        raise unit_error(drawing, size)
    beam = unit.mm * size.beam
    if not odd(beam) or options.unit is not None or options.width is not None:
        return unit, options.tolerance, []
    if not drawing.plain:
        raise unit_error(drawing, size)
    warnings = [size_warning(size, likely(drawing, size))]
    tolerance = min(options.tolerance, FINE * beam)
    if tolerance < options.tolerance:
        text = f"the tolerance is {tolerance:.3g} mm, a tenth of the middle beam, not"
        warnings.append(Message("tolerance", "tolerance", f"{text} {options.tolerance:g} mm"))
    return unit, tolerance, warnings


def _unit_message(unit: Unit, size: Size) -> Message:
    width, height = unit.mm * size.width, unit.mm * size.height
    text = f"the unit is {unit.mm:.6g} mm" if unit.name == "unit" else f"the unit is {unit.name}"
    measure = f"the drawing is {width:.4g} x {height:.4g} mm"
    return Message("unit", "unit", f"{text} ({unit.source}); {measure}")


def _in_plane(
    lines: Sequence[Numbers], tolerance: float, without: Collection[str]
) -> tuple[list[Numbers], dict[str, Numbers]]:
    """Return lines (n, 2) mm as seen in their plane, and the mend if that is not x and y."""
    points = np.concatenate(lines)
    offsets = np.cumsum([len(line) for line in lines])[:-1]
    if "plane" in without:  # seen from above
        return np.split(points[:, :2], offsets), {}
    plane = flattened(points, tolerance)
    parts = np.split(plane.points, offsets)
    return parts, {"plane": np.stack([part[0] for part in parts])} if plane.turned else {}


def _imported(
    result: Mended,
    drawing: Drawing,
    unit: Unit,
    layers: Sequence[LayerUse],
    messages: list[Message],
    options: Options,
) -> Imported:
    """Return the import that a mended drawing gives."""
    net, places = result.net, result.places
    joints = net.joints
    if options.place == "corner" or (abs(joints) > FARTHEST).any():
        corner = joints.min(axis=0)
        joints = joints - corner
        places = {code: spots - corner for code, spots in places.items()}
        if (abs(corner) > SHIFT).any():
            move = ", ".join(f"{value + 0.0:.6g}" for value in -corner)
            text = f"moved by [{move}] mm, so that its lower left corner is the origin"
            messages.append(Message("moved", "grid", text))
    fixed = middle_joint(joints)
    grid = Grid(joints, net.beams, net.ratio, fixed, options.material)
    for wrong in structure_errors(grid):
        raise InputError(wrong.message, wrong.code, wrong.where)
    place = ", ".join(f"{value:g}" for value in joints[fixed])
    text = f"joint {fixed} at [{place}] mm is fixed, the nearest to the middle"
    messages.append(Message("fixed", f"joint {fixed}", text))
    if len(result.mixed):
        text = (
            f"{len(result.mixed)} beams are drawn with several actuators; the longest line counts"
        )
        messages.append(Message("actuators-mixed", "grid", text))
    mends = [
        mend(code, places[code], f"; {len(net.beams)} beams stay" if code == "leaf" else "")
        for code in MENDS
        if code in places
    ]
    return Imported(grid, drawing.format, unit, tuple(layers), tuple(mends), tuple(messages))
