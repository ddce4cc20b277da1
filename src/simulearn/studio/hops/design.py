"""From the curves of a request to a grid: unit, plane, mends, actuators, fixed joint."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from simulearn.drawings.drawing import Curve, Drawing, Line
from simulearn.drawings.importing import Options, grid_of
from simulearn.errors import InputError, Message
from simulearn.grid import Grid
from simulearn.studio.hops.curves import curve_of
from simulearn.studio.hops.material import made_of
from simulearn.studio.hops.parameters import CURVE, MOST, NUMBER, POINT, Input
from simulearn.studio.hops.placement import Placement, placement_of, unit_of
from simulearn.studio.hops.values import Inputs
from simulearn.studio.routes.designs import check_size
from simulearn.studio.settings import Settings

Points = NDArray[np.float64]

RATIOS_GIVEN = "actuators"  # code of the message that says which ratios were given
QUIET = ("fixed", "unit", RATIOS_GIVEN)  # what is usual: it belongs in no balloon
STEPS = 1e6  # of a ratio of 1; a layer's name holds no more
FAR = 3.6  # mm, half the width of a beam: nearer is at the joint
MOST_PLACES = 100  # of one mend that are messages

CURVES = Input("Curves", "C", "The beams' axes: lines and polylines in one plane.", CURVE, 1, MOST)
ACTUATORS = Input(
    "Actuators",
    "A",
    "One ratio for each curve, from -1 to 1: + in the top half, - in the bottom half, 0 passive. "
    "If nothing is given, all beams are passive.",
    NUMBER,
    0,
    MOST,
    minimum=-1.0,
    maximum=1.0,
)
FIXED = Input(
    "Fixed",
    "F",
    "A point at the joint that is held. If none is given, it is the one in the middle.",
    POINT,
    0,
    1,
)
DRAWN = (CURVES, ACTUATORS, FIXED)


@dataclass(frozen=True, eq=False)
class Remark:
    """Something to be messages.

    Attributes:
        text: for people.
        place: where in the grid, mm; its middle if nowhere else.
        code: for programs.
        quiet: whether it is usual, and belongs in no balloon.
    """

    text: str
    place: tuple[float, float]
    code: str = ""
    quiet: bool = False


@dataclass(frozen=True, eq=False)
class Design:
    """A grid as it was drawn in a model.

    Attributes:
        grid: in the axes of its plane, mm.
        placement: where it lies in the model.
        remarks: what was taken, mended and left out.
    """

    grid: Grid
    placement: Placement
    remarks: list[Remark] = field(default_factory=list)

    @property
    def texts(self) -> list[str]:
        """All that is to be messages."""
        return [one.text for one in self.remarks]

    @property
    def warnings(self) -> list[str]:
        """What belongs in a balloon."""
        return [one.text for one in self.remarks if not one.quiet]

    @property
    def anchor(self) -> Points:
        """The fixed joint (3,) mm, from which results are seen."""
        return np.array([*self.grid.joints[self.grid.fixed], 0.0])

    def outside(self, points: Points) -> Points:
        """Return points (..., 3) of a result in the model."""
        return self.placement.outside(points + self.anchor)

    def changed(self, grid: Grid) -> "Design":
        """Return the design that a grid, seen from its fixed joint, is in the same place."""
        joints = grid.joints - grid.joints[grid.fixed] + self.anchor[:2]
        moved = Grid(joints, grid.beams, grid.actuators, grid.fixed, grid.material)
        return Design(moved, self.placement)

    def place(self, where: str) -> tuple[float, float]:
        """Return the place of a message, mm: of its joint or beam, else the middle of the grid."""
        word, _, number = where.partition(" ")
        joints = self.grid.joints
        if number.isdigit():
            if word == "joint" and int(number) < len(joints):
                return _pair(joints[int(number)])
            if word == "beam" and int(number) < len(self.grid.beams):
                return _pair(joints[self.grid.beams[int(number)]].mean(axis=0))
        return _pair((joints.min(axis=0) + joints.max(axis=0)) / 2)

    def points(self, places: list[tuple[float, float]]) -> Points:
        """Return places in the grid, mm, as points (n, 3) in the model."""
        flat = np.array(places, float).reshape(-1, 2)
        return self.placement.outside(np.pad(flat, ((0, 0), (0, 1))))


def design_of(
    inputs: Inputs, modelunits: str | None, settings: Settings, loud: bool = False
) -> Design:
    """Return the grid that the curves of a request show.

    Each curve goes on the layer that stands for its ratio. So the mends, which know the line that a
    beam comes from, give each beam its ratio.

    Args:
        inputs: curves, ratios, the fixed point and the material.
        modelunits: name of the model's unit in Rhino.
        settings: how large a grid may be.
        loud: whether a conversion of units belongs in the balloon.

    Raises:
        InputError: the curves, ratios, the fixed point or the material are wrong, or show no grid.
    """
    lines: list[Line | Curve] = []
    ratios = _ratios(inputs)
    for k, (item, ratio) in enumerate(zip(inputs.items[CURVES.name], ratios, strict=True)):
        line = curve_of(item, f"Curves[{k}]")
        lines.append(replace(line, layer=layer_of(ratio)) if isinstance(line, Line) else line)
    design = design_from(lines, inputs.points(FIXED.name), modelunits, settings, loud, "layers")
    # The layers are not the person's own.
    design.remarks[:] = [one for one in design.remarks if one.code != RATIOS_GIVEN]
    return replace(design, grid=made_of(design.grid, inputs))


def design_from(
    lines: Sequence[Line | Curve],
    fixed: Points,
    modelunits: str | None,
    settings: Settings,
    loud: bool = False,
    actuators: Literal["auto", "layers"] = "auto",
) -> Design:
    """Return the grid that lines in a model show.

    Args:
        lines: in the model's unit.
        fixed: (0 or 1, 3) a point at the joint that is held.
        modelunits: name of the model's unit in Rhino.
        settings: how large a grid may be.
        loud: whether a conversion of units is a warning.
        actuators: what says their ratios; layers where one's name does, else colours ("auto").

    Raises:
        InputError: the lines show no grid, or one that is too large.
    """
    unit, messages = unit_of(modelunits)
    straight = [line for line in lines if isinstance(line, Line)]
    placement, plane = placement_of(_all_points(straight or lines, unit.mm), unit)
    drawing = Drawing("Rhino", [], unit=unit, plain=bool(messages))
    for line in lines:
        if isinstance(line, Line):
            drawing.lines.append(replace(line, points=_level(placement, line.points)))
        else:
            drawing.curves.append(line)
    found = grid_of(drawing, Options(actuators=actuators, place="drawn"))
    check_size(found.grid, settings)
    grid, moved = _held(found.grid, fixed, placement)
    design = Design(grid, placement)
    usual = {*QUIET} - ({"unit"} if loud and unit.mm != 1.0 else set())
    for one in (*messages, *plane, *moved, *found.messages):
        if one.code == "fixed" and len(fixed):
            continue
        quiet = one.code in usual and one not in messages
        design.remarks.append(Remark(one.message, design.place(one.where), one.code, quiet))
    for mend in found.mends:
        places = mend.places[:MOST_PLACES] or (design.place("grid"),)
        design.remarks.extend(Remark(mend.message, place, mend.code) for place in places)
    return design


def _ratios(inputs: Inputs) -> list[float]:
    """Return one ratio for each curve."""
    count = len(inputs.items.get(CURVES.name, ()))
    if not count:
        text = "Curves is empty; it is a list of lines or polylines, the beams' axes"
        raise InputError(text, "no-lines", CURVES.name)
    ratios = inputs.numbers(ACTUATORS.name)
    if not ratios:
        return [0.0] * count
    if len(ratios) != count:
        text = f"Actuators has {len(ratios)} ratios for {count} curves; give one for each curve"
        raise InputError(text, "actuators", ACTUATORS.name)
    for k, ratio in enumerate(ratios):
        if not -1 <= ratio <= 1:
            text = f"Actuators[{k}] is {ratio:g}; a ratio lies between -1 (bottom) and 1 (top)"
            raise InputError(text, "actuator-ratio", ACTUATORS.name)
    return ratios


def layer_of(ratio: float) -> str:
    """Return the name of the layer that stands for a ratio."""
    rounded = round(abs(ratio) * STEPS) / STEPS
    return f"{'top' if ratio > 0 else 'bottom'} {rounded:.6f}" if rounded else "passive"


def _all_points(lines: Sequence[Line | Curve], mm: float) -> Points:
    chord = 1.0 / mm
    parts = [one.points if isinstance(one, Line) else one.flatten(chord) for one in lines]
    return np.concatenate(parts)


def _level(placement: Placement, points: Points) -> Points:
    """Return points in the plane's axes, in the model's unit, without a height."""
    inside = placement.inside(points) / placement.unit.mm
    return np.stack([inside[:, 0], inside[:, 1], np.zeros(len(inside))], axis=1)


def _held(grid: Grid, fixed: Points, placement: Placement) -> tuple[Grid, list[Message]]:
    """Return the grid held at the joint nearest to a point, and whether that is far from it."""
    if not len(fixed):
        return grid, []
    away = np.linalg.norm(grid.joints - placement.inside(fixed)[0, :2], axis=1)
    joint = int(away.argmin())
    held = Grid(grid.joints, grid.beams, grid.actuators, joint, grid.material)
    if away[joint] <= FAR:
        return held, []
    text = f"the fixed point is {away[joint]:.3g} mm from the nearest joint, which is held"
    return held, [Message("fixed-far", f"joint {joint}", text)]


def _pair(point: Points) -> tuple[float, float]:
    return float(point[0]), float(point[1])
