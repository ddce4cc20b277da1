"""The rules of a design: what cannot be printed and simulated, and what had better be looked at.

Errors forbid: the grid has no sound outline, or parts of it collide, or an actuator is too short
to work. Warnings tell: a length is unusual, or something dangles and is removed. A grid without
errors can be meshed.

Rules and limits: Yang et al., SimuLearn, UIST 2020, Figure 15, and the authors' published tool.
"""

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from math import hypot
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import Message
from simulearn.grid.cleaning import fixed_removed, kept, removals
from simulearn.grid.grid import Grid
from simulearn.grid.outline import outlines
from simulearn.grid.overlap import overlaps
from simulearn.grid.structure import structure_errors
from simulearn.material import Material
from simulearn.material.material import Limits

# Lengths this close are equal, so that a length at its limit passes whatever rounding did (mm).
ROUNDING = 1e-6
# Joints closer than this are at one place (mm).
ONE_PLACE = 1e-3
# The shorter long edge of a beam must leave something between its joints (mm).
SHORTEST_EDGE = 1.0


@dataclass(frozen=True)
class TrainingRange:
    """What a learned model has seen in training, each as (least, most), mm.

    Attributes:
        dimension: largest distance from the fixed joint to another joint.
        beam_length: length of a beam between the centres of its joints.
    """

    dimension: tuple[float, float]
    beam_length: tuple[float, float]


@dataclass(frozen=True)
class Validation:
    """What validation has to say.

    Attributes:
        errors: that forbid.
        warnings: that do not.
        net_lengths: mm, of the beams that stay and have an outline, by their numbers.
    """

    errors: tuple[Message, ...]
    warnings: tuple[Message, ...]
    net_lengths: Mapping[int, float] = field(default_factory=dict)

    @property
    def valid(self) -> bool:
        """Whether there is no error."""
        return not self.errors

    def to_dict(self) -> dict[str, list[dict[str, Any]]]:
        """Return errors and warnings as plain dicts with code, where and message."""
        return {
            "errors": [asdict(message) for message in self.errors],
            "warnings": [asdict(message) for message in self.warnings],
        }


def validate(
    grid: Grid,
    material: Material,
    limits: Limits | None = None,
    training: TrainingRange | None = None,
) -> Validation:
    """Return all errors and warnings about a design.

    Args:
        grid: the design; joints and beams keep its numbers in the messages.
        material: its material system, for section and limits.
        limits: other limits than the material's.
        training: what the model that will answer has seen; its limits replace the material's.
    """
    if wrong := structure_errors(grid):
        return Validation(tuple(wrong), ())
    limits = limits or material.limits
    joints, beams = kept(grid)
    errors = list(_layout(grid, joints, beams))
    in_place = all(error.code != "joints-coincide" for error in errors)
    shape = outlines(grid.beams, grid.joints[None], material.section.width, beams)
    sound = shape.sound[0]
    for k in np.flatnonzero(joints & ~sound).tolist():
        code = "joint-valence" if shape.valence[k] > 4 else "joint-outline"
        errors.append(Message(code, f"joint {k}", shape.fault(0, k)))
    shapes = {k: shape.joints[0, k] for k in np.flatnonzero(sound).tolist()}
    with_ends = beams & sound[grid.beams].all(axis=1)
    quads = {b: shape.beams[0, b] for b in np.flatnonzero(with_ends).tolist()}
    lengths = {b: _lengths(grid, b, quad) for b, quad in quads.items()}
    warnings = removals(grid)
    for b, measures in lengths.items():
        errors += _beam_errors(grid, b, measures, limits)
        warnings += _beam_warnings(b, measures, limits, training)
    if in_place:
        roomy = {b: q for b, q in quads.items() if lengths[b][2] >= SHORTEST_EDGE}
        errors += _collisions(shapes, roomy)
        if training is not None:
            warnings += _size(grid, joints, training)
    net = {b: measures[1] for b, measures in lengths.items()}
    return Validation(tuple(errors), tuple(warnings), net)


def _layout(grid: Grid, joints: NDArray[np.bool_], beams: NDArray[np.bool_]) -> Iterator[Message]:
    """Yield errors of the grid as a whole: its places and its connections."""
    apart = np.linalg.norm(grid.joints[:, None] - grid.joints[None], axis=2)
    for i, j in np.argwhere(np.triu(apart < ONE_PLACE, k=1)).tolist():
        yield Message(
            "joints-coincide",
            f"joint {j}",
            f"joint {j} lies where joint {i} lies, {apart[i, j]:.3g} mm apart; "
            f"joints lie at least {ONE_PLACE:g} mm apart",
        )
    if not len(grid.beams):
        yield Message("no-beams", "grid", "the grid has 0 beams; it needs some that close a loop")
        return
    if not beams.any():
        yield Message(
            "no-beams",
            "grid",
            f"none of the {len(beams)} beams closes a loop, so all of them dangle and are removed",
        )
        return
    if not joints[grid.fixed]:
        yield Message("fixed-removed", f"joint {grid.fixed}", fixed_removed(grid))
    parts = _parts(grid)
    if len(parts) > 1:
        others = ", ".join(str(k) for k in sorted(set().union(*parts[1:])))
        yield Message(
            "disconnected",
            "grid",
            f"the grid is in {len(parts)} parts; no beam leads to joints {others}",
        )


def _parts(grid: Grid) -> list[set[int]]:
    """Return the sets of joints that beams connect, the fixed joint's first."""
    parts: list[set[int]] = []
    for pair in grid.beams.tolist():
        meeting = [part for part in parts if not part.isdisjoint(pair)]
        parts = [part for part in parts if part.isdisjoint(pair)]
        parts.append(set(pair).union(*meeting))
    return sorted(parts, key=lambda part: (grid.fixed not in part, min(part)))


def _lengths(grid: Grid, beam: int, quad: NDArray[np.float64]) -> tuple[float, float, float]:
    """Return a beam's length centre to centre, its net length and its shorter edge, mm."""
    (x, y), (u, v) = grid.joints[grid.beams[beam]].tolist()
    length = hypot(u - x, v - y)
    right, left = ((quad[1] - quad[0]) @ (u - x, v - y) / length).tolist()
    # The middle of a joint's side lies on the axis.
    return length, (right + left) / 2, min(right, left)


def _beam_errors(
    grid: Grid, beam: int, measures: tuple[float, float, float], limits: Limits
) -> Iterator[Message]:
    """Yield errors of one beam: no room between its joints, or too short an actuator."""
    _, net, edge = measures
    if edge < SHORTEST_EDGE:
        i, j = grid.beams[beam]
        yield Message(
            "joints-too-close",
            f"beam {beam}",
            f"beam {beam} is left an edge of {edge:.2f} mm between joints {i} and {j}; "
            f"each edge needs at least {SHORTEST_EDGE:g} mm",
        )
        return
    ratio = abs(float(grid.actuators[beam]))
    if ratio and ratio * net < limits.actuator_length - ROUNDING:
        yield Message(
            "actuator-short",
            f"beam {beam}",
            f"the actuator of beam {beam} is {ratio * net:.2f} mm long (ratio {ratio:g} of "
            f"{net:.2f} mm); an actuator is at least {limits.actuator_length:g} mm, or 0",
        )


def _beam_warnings(
    beam: int,
    measures: tuple[float, float, float],
    limits: Limits,
    training: TrainingRange | None,
) -> Iterator[Message]:
    """Yield warnings of one beam: an unusual length."""
    length, net, _ = measures
    least, most = training.beam_length if training else (0.0, limits.beam_length)
    where = f"beam {beam}"
    if length > most + ROUNDING:
        yield Message(
            "beam-long", where, f"{where} is {length:.2f} mm long; the limit is {most:g} mm"
        )
    if length < least - ROUNDING:
        yield Message(
            "beam-short", where, f"{where} is {length:.2f} mm long; at least {least:g} mm is usual"
        )
    if net < limits.beam_net_length - ROUNDING:
        yield Message(
            "beam-short",
            where,
            f"{where} is {net:.2f} mm long between its joints; "
            f"at least {limits.beam_net_length:g} mm is usual",
        )


def _collisions(
    shapes: dict[int, NDArray[np.float64]], quads: dict[int, NDArray[np.float64]]
) -> Iterator[Message]:
    """Yield an error for each two parts of the outline that overlap."""
    names = [f"joint {k}" for k in shapes] + [f"beam {b}" for b in quads]
    # Counter-clockwise: start right, end right, end left, start left.
    around = [quad[[0, 1, 1, 0], [0, 0, 1, 1]] for quad in quads.values()]
    pieces = np.array([*shapes.values(), *around])
    for a, b in overlaps(pieces.reshape(-1, 4, 2)).tolist():
        yield Message(
            "overlap",
            names[b],
            f"{names[a]} and {names[b]} overlap; parts of a grid meet only end to end",
        )


def _size(grid: Grid, joints: NDArray[np.bool_], training: TrainingRange) -> Iterator[Message]:
    """Yield a warning when the grid is smaller or larger than the model's training data."""
    away = np.linalg.norm(grid.joints[joints] - grid.joints[grid.fixed], axis=1).max()
    least, most = training.dimension
    if not least - ROUNDING <= away <= most + ROUNDING:
        yield Message(
            "grid-size",
            "grid",
            f"the grid reaches {away:.2f} mm from its fixed joint; "
            f"the model was trained from {least:g} to {most:g} mm",
        )
