"""The rules of a design: what cannot be printed and simulated, and what is unusual.

Errors forbid: the grid has no sound outline, or parts of it collide, or an actuator is too short
to work. Warnings do not: a length is unusual, or something dangles and is removed. A grid without
errors can be meshed. The rules themselves are in `grid.structure` and `grid.checks`.

Rules and limits: Yang et al., SimuLearn, UIST 2020, Figure 15, and the authors' published tool.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.display import Displayed
from simulearn.errors import Message
from simulearn.grid.checks import (
    ONE_PLACE,
    SHORTEST_EDGE,
    Connections,
    Lengths,
    TrainingRange,
    check_designs,
    coincident,
    collisions,
    connections,
    lengths,
    outside,
    too_short,
    unusual,
    usual_length,
)
from simulearn.grid.cleaning import fixed_removed, warnings_of
from simulearn.grid.grid import Grid
from simulearn.grid.joining import missing_joints
from simulearn.grid.outline import Outlines, outlines
from simulearn.grid.size import size_message
from simulearn.grid.structure import structure_errors
from simulearn.material import Material
from simulearn.material.material import Limits

Mask = NDArray[np.bool_]

# Of joints at one place, and of parts that overlap, no more are named.
MOST_NAMED = 1000


@dataclass(frozen=True)
class Validation(Displayed):
    """The errors and warnings about a design.

    Attributes:
        errors: what forbids it.
        warnings: what does not.
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
        training: the grids that the model that will answer was trained on; its limits replace
            the material's.
    """
    if wrong := structure_errors(grid):
        return Validation(tuple(wrong), ())
    report = _validated(grid, material, limits or material.limits, training)
    counted = _counted_from_one(grid, report, material, limits, training)
    if counted is None:
        return report
    if report.errors:
        return replace(report, errors=(counted, *report.errors))
    return replace(report, warnings=(counted, *report.warnings))


def _validated(
    grid: Grid, material: Material, limits: Limits, training: TrainingRange | None
) -> Validation:
    """Return all errors and warnings about a grid whose numbers and indices are right."""
    at = connections(grid)
    size, wrong_size = size_message(grid, material, usual_length(limits, training)[1])
    removed = warnings_of(grid, at.joints, at.beams)
    if size is not None and wrong_size:  # all else that is wrong of its beams follows from it
        return Validation((size, *_layout(grid, at)), tuple(removed))
    joints = grid.joints[None]
    coinciding = coincident(joints, MOST_NAMED)[:MOST_NAMED, 1:].tolist()
    errors = [*_coincidences(grid, coinciding), *_layout(grid, at)]
    shape = outlines(grid.beams, joints, material.section.width, at.beams)
    for k in np.flatnonzero(at.joints & ~shape.sound[0]).tolist():
        code = "joint-valence" if shape.valence[k] > 4 else "joint-outline"
        errors.append(Message(code, f"joint {k}", shape.fault(0, k)))
    measured = lengths(grid.beams, joints, shape)
    faced = at.beams & shape.sound[0, grid.beams].all(axis=1)  # with an outline at both ends
    crowded = faced & (measured.edge[0] < SHORTEST_EDGE)
    errors += _beam_errors(grid, measured, faced, crowded, limits)
    warnings = [] if size is None else [size]
    warnings += removed
    if size is None:
        warnings += _beam_warnings(measured, faced, limits, training)
    if not coinciding:
        parted = _parted(grid, shape, faced & ~crowded, material.section.width, at)
        errors = [*parted.errors, *errors, *parted.overlaps]
        warnings = [*parted.warnings, *warnings]
        if training is not None and at.beams.any() and size is None:
            warnings += _size(grid, at, training)
    net = {b: float(measured.net[0, b]) for b in np.flatnonzero(faced).tolist()}
    return Validation(tuple(errors), tuple(warnings), net)


def errors_of(grids: Sequence[Grid], materials: Sequence[Material]) -> list[tuple[Message, ...]]:
    """Return the errors of each of many grids, as `validate` gives them; none where it is valid.

    Grids of one topology and material are checked together, which takes a tenth of the time.

    Args:
        grids: the designs.
        materials: the material system of each.
    """
    alike: dict[tuple[object, ...], list[int]] = {}
    for k, (grid, material) in enumerate(zip(grids, materials, strict=True)):
        key = (grid.joints.shape, grid.actuators.shape, grid.beams.tobytes(), grid.fixed)
        alike.setdefault((*key, material.digest), []).append(k)
    valid = np.zeros(len(grids), bool)
    for numbers in alike.values():
        first, material = grids[numbers[0]], materials[numbers[0]]
        if len(numbers) > 1 and not structure_errors(first):
            joints = np.stack([grids[k].joints for k in numbers])
            actuators = np.stack([grids[k].actuators for k in numbers])
            checks = check_designs(first.beams, first.fixed, joints, actuators, material)
            valid[numbers] = checks.valid
    return [() if valid[k] else validate(grid, materials[k]).errors for k, grid in enumerate(grids)]


def _coincidences(grid: Grid, pairs: list[list[int]]) -> Iterator[Message]:
    """Yield an error for each two joints at one place."""
    for i, j in pairs:
        apart = np.linalg.norm(grid.joints[i] - grid.joints[j])
        yield Message(
            "joints-coincide",
            f"joint {j}",
            f"joint {j} lies where joint {i} lies, {apart:.3g} mm apart; "
            f"joints lie at least {ONE_PLACE:g} mm apart",
        )


def _layout(grid: Grid, at: Connections) -> Iterator[Message]:
    """Yield errors of the connections of a grid."""
    if not len(grid.beams):
        yield Message("no-beams", "grid", "the grid has 0 beams; it needs some that close a loop")
        return
    if not at.beams.any():
        yield Message(
            "no-beams",
            "grid",
            f"none of the {len(grid.beams)} beams closes a loop, "
            "so all of them dangle and are removed",
        )
        return
    if not at.joints[grid.fixed]:
        yield Message("fixed-removed", f"joint {grid.fixed}", fixed_removed(grid))
    if len(at.parts) > 1:
        others = ", ".join(str(k) for k in sorted(set().union(*at.parts[1:])))
        yield Message(
            "disconnected",
            "grid",
            f"the grid is in {len(at.parts)} parts; no beam leads to joints {others}",
        )


def _beam_errors(
    grid: Grid, measured: Lengths, faced: Mask, crowded: Mask, limits: Limits
) -> Iterator[Message]:
    """Yield errors of beams: no room between the joints, or too short an actuator.

    Args:
        grid: the design.
        measured: lengths of its beams.
        faced: (B,) the beams with an outline at both ends.
        crowded: (B,) those of them without room between their joints.
        limits: least and most lengths.
    """
    short = faced & too_short(grid.actuators, measured.net[0], limits)
    for b in np.flatnonzero(crowded | short).tolist():
        net, ratio = measured.net[0, b], abs(grid.actuators[b])
        if crowded[b]:
            i, j = grid.beams[b]
            yield Message(
                "joints-too-close",
                f"beam {b}",
                f"beam {b} is left an edge of {measured.edge[0, b]:.2f} mm between joints "
                f"{i} and {j}; each edge needs at least {SHORTEST_EDGE:g} mm",
            )
        else:
            yield Message(
                "actuator-short",
                f"beam {b}",
                f"the actuator of beam {b} is {ratio * net:.2f} mm long (ratio {ratio:g} of "
                f"{net:.2f} mm); an actuator is at least {limits.actuator_length:g} mm, or 0",
            )


def _beam_warnings(
    measured: Lengths, faced: Mask, limits: Limits, training: TrainingRange | None
) -> Iterator[Message]:
    """Yield warnings of unusual lengths of the beams that have an outline at both ends (B,)."""
    long, short, net_short = (mask[0] & faced for mask in unusual(measured, limits, training))
    least, most = usual_length(limits, training)
    for b in np.flatnonzero(long | short | net_short).tolist():
        where, length, net = f"beam {b}", measured.full[0, b], measured.net[0, b]
        if long[b]:
            text = f"{where} is {length:.2f} mm long; the limit is {most:g} mm"
            yield Message("beam-long", where, text)
        if short[b]:
            text = f"{where} is {length:.2f} mm long; at least {least:g} mm is usual"
            yield Message("beam-short", where, text)
        if net_short[b]:
            text = (
                f"{where} is {net:.2f} mm long between its joints; "
                f"at least {limits.beam_net_length:g} mm is usual"
            )
            yield Message("beam-short", where, text)


@dataclass(frozen=True)
class _Parted:
    """What is to be said of parts that meet and are not joined."""

    errors: list[Message]
    warnings: list[Message]
    overlaps: list[Message]


def _parted(grid: Grid, shape: Outlines, roomy: Mask, width: float, at: Connections) -> _Parted:
    """Return messages about missing joints, and about other parts that overlap.

    A missing joint is an error where the grid is not valid for it: where all its parts stay, they
    overlap; a part that no beam leads to is an error of its own. Else a beam dangles for want of
    it, which is a warning.

    Args:
        grid: no two of its joints are at one place.
        shape: its outline.
        roomy: (B,) the beams with an outline and room between their joints.
        width: of the beams, mm.
        at: its connections.
    """
    two = collisions(shape, roomy[None], MOST_NAMED)[:, 1:].tolist()
    if not two and len(at.parts) < 2 and at.beams.all():
        return _Parted([], [], [])
    count = len(shape.valence)
    said: set[tuple[int, int]] = set()  # pairs of parts, numbered as collisions are
    errors: list[Message] = []
    warnings: list[Message] = []
    for missing in missing_joints(grid, width, MOST_NAMED):
        beams = list(missing.beams)
        if missing.joint is None:
            said.add((count + min(beams), count + max(beams)))
        else:
            there = np.flatnonzero((grid.beams == missing.joint).any(axis=1)).tolist()
            said |= {(count + min(b, *beams), count + max(b, *beams)) for b in there}
            said.add((missing.joint, count + beams[0]))
            beams += there
        wrong = bool(at.beams[beams].all()) or len(at.parts) > 1
        message = Message("joint-missing", f"beam {missing.beams[-1]}", missing.text)
        (errors if wrong else warnings).append(message)
    overlaps = []
    for pair in two:
        if tuple(pair) in said:
            continue
        a, b = (f"joint {k}" if k < count else f"beam {k - count}" for k in pair)
        text = f"{a} and {b} overlap; parts of a grid meet only end to end"
        overlaps.append(Message("overlap", b, text))
    return _Parted(errors, warnings, overlaps)


def _counted_from_one(
    grid: Grid,
    report: Validation,
    material: Material,
    limits: Limits | None,
    training: TrainingRange | None,
) -> Message | None:
    """Return a message where a grid makes more sense with its indices counted from 1."""
    unused = {message.where for message in report.warnings if message.code == "unused-joint"}
    if "joint 0" not in unused or not len(grid.beams) or grid.beams.min() < 1 or grid.fixed < 1:
        return None
    meant = Grid(grid.joints, grid.beams - 1, grid.actuators, grid.fixed - 1, grid.material)
    other = _validated(meant, material, limits or material.limits, training)
    counts = [(len(it.errors), len(it.warnings)) for it in (report, other)]
    if other.errors or counts[1] >= counts[0]:
        return None
    return Message(
        "counted-from-one",
        "grid",
        "the indices of joints seem to count from 1: no beam meets joint 0, and with 1 subtracted "
        f"from every index the grid {'is valid' if report.errors else 'has fewer warnings'}; "
        "joints count from 0",
    )


def _size(grid: Grid, at: Connections, training: TrainingRange) -> Iterator[Message]:
    """Yield a warning when the grid is smaller or larger than the model's training data."""
    away = np.linalg.norm(grid.joints[at.joints] - grid.joints[grid.fixed], axis=1).max()
    least, most = training.dimension
    if outside(away, training):
        yield Message(
            "grid-size",
            "grid",
            f"the grid reaches {away:.2f} mm from its fixed joint; "
            f"the model was trained from {least:g} to {most:g} mm",
        )
