"""A print beside its simulation: from a grid and a measurement to what differs, and why it may."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from simulearn.compare.aligning import aligned, ambiguous, mirrored, rms, spread
from simulearn.compare.deviation import Deviation, deviation_of
from simulearn.compare.doubts import alone, exchanged, few, flat, plausible
from simulearn.compare.explaining import Explanation, explanations, simulated_by
from simulearn.compare.matching import matches
from simulearn.compare.measurement import (
    Indices,
    JointPlaces,
    Measurement,
    Numbers,
    Scan,
    size,
)
from simulearn.compare.scanned import place_scan
from simulearn.compare.scatter import Scatter, scatter_of
from simulearn.compare.simulated import stations_of
from simulearn.compare.unit import in_millimetres
from simulearn.errors import Cancel, InputError, Message, stop_if
from simulearn.grid import Grid
from simulearn.grid.cleaning import kept
from simulearn.material import Material, load_material
from simulearn.simulate import Result, Simulator, one

At = Literal["centre", "top", "bottom"]
Progress = Callable[[int, int], None]

FEWEST = 4  # joints: three lie on every grid with such distances
FLAT = 0.05  # of the dimension, the least spread of joints across their line
STAGES = 6  # of a comparison: simulation, pose, four of the explanation


@dataclass(frozen=True, eq=False)
class Comparison:
    """A print beside its simulation.

    Attributes:
        result: the simulation.
        material: what it was simulated with.
        deviation: of joints and beams, in the frame of the simulation.
        explanations: what one change of the material would explain, the best first.
        scatter: how much prints of one design differ.
        residual: mm, root of the mean squared distance of the joints.
        noise: mm, roughness of the scan about the fitted shape; None for joints.
        scanned: whether a scan was measured.
        points: (N, 3) points of the scan in the frame of the simulation, some of them.
        messages: what is to be known about measurement and pose.
        joint_numbers, beam_numbers: (J,) and (B,) which joints and beams of the design those of
            the simulated grid are, which has none that dangle.
    """

    result: Result
    material: Material
    deviation: Deviation
    explanations: tuple[Explanation, ...]
    scatter: Scatter
    residual: float
    noise: float | None
    scanned: bool
    points: Numbers
    messages: tuple[Message, ...]
    joint_numbers: Indices
    beam_numbers: Indices


def compare(
    grid: Grid,
    measured: Measurement,
    simulator: Simulator,
    *,
    unit: str | None = None,
    at: At = "centre",
    explain: bool = True,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> Comparison:
    """Return how a print differs from its simulation.

    Args:
        grid: the design.
        measured: on the print; see `read_measurement`.
        simulator: simulates the design.
        unit: of the measurement, if a person says so.
        at: where joints were measured: the middle of the joint, or of its top or bottom face.
        explain: whether to look for a change of the material that explains the deviation.
        progress: called with the stages done and all.
        cancel: stops the work.

    Raises:
        InputError: the grid is not valid, or the measurement does not fit it.
        ComputationError: the grid has no answer.
        CancelledError: the token was set.
    """
    progress = progress or _nothing
    result = one(simulator.simulate([grid], None, cancel)[0])
    material = load_material(result.grid.material)
    progress(1, STAGES)
    stop_if(cancel)
    corners = {"centre": slice(0, 8), "bottom": slice(0, 4), "top": slice(4, 8)}[at]
    simulated = result.joints[-1][:, corners].mean(axis=1)
    expected = size(result.joints[-1].reshape(-1, 3))
    measured, messages = in_millimetres(measured, expected, unit)
    messages = [*measured.messages, *messages]
    noise, points, scanned = None, np.zeros((0, 3)), isinstance(measured, Scan)
    stations = stations_of(result)
    along = np.full((len(result.grid.beams), 3, 3), np.nan)
    if isinstance(measured, Scan):
        found = place_scan(measured, result, material.section.width, cancel)
        joints, along, noise, points = found.joints, found.stations, found.noise, found.points
        messages += found.messages
        if at != "centre":
            text = (
                f"a scan is compared by its whole surface; that its joints are at {at} says nothing"
            )
            messages.append(Message("measurement-at", "measurement", text))
        simulated = result.centres[-1]
    else:
        joints, more = _placed(measured, simulated, grid, result)
        messages += more
    stay = kept(grid.beams, len(grid.joints))
    names, beam_names = (np.flatnonzero(some) for some in stay)
    progress(2, STAGES)
    many = len(simulated)
    deviation = deviation_of(
        joints,
        simulated,
        result.grid.beams,
        along,
        *(
            part[many:].reshape(-1, 3, 3)
            for part in (stations.centres, stations.along, stations.up)
        ),
    )
    seen = deviation.measured
    residual = rms(joints[seen], simulated[seen])
    here = joints[seen], simulated[seen]
    if not scanned and not any(m.code == "joints-exchanged" for m in messages):
        messages += alone(*here, result.grid.dimension, names[seen])
    messages += flat(*here, result.grid.joints[seen])
    messages += plausible(residual, result.grid, scanned, messages)
    messages += _missing(names[~seen], scanned)

    def later(done: int, total: int) -> None:
        progress(2 + done, STAGES)

    simulate = simulated_by(result.grid)
    found_causes = (
        explanations(deviation, material, simulate, later, cancel)
        if explain and residual > 0
        else []
    )
    stop_if(cancel)
    scatter = scatter_of(result.grid, material, cancel)
    progress(STAGES, STAGES)
    return Comparison(
        result, material, deviation, tuple(found_causes), scatter, residual, noise, scanned,
        points, tuple(messages), names, beam_names,
    )  # fmt: skip


def _placed(
    measured: JointPlaces, simulated: Numbers, grid: Grid, result: Result
) -> tuple[Numbers, list[Message]]:
    """Return the measured places (J, 3) in the frame of the simulation, NaN where there is none."""
    places, numbers = measured.places, measured.numbers
    messages: list[Message] = []
    if numbers is not None:
        numbers, places, messages = _numbered(numbers, places, grid)
    _enough(places, result.grid)
    if numbers is None:
        found = matches(places, simulated)
        numbers = found[0].joints
        if len(found) > 1:
            messages.append(ambiguous(len(found), "assignments of points to joints"))
    pose = aligned(places, simulated[numbers])
    if pose.mirrored:
        messages.append(mirrored())
    joints = np.full_like(simulated, np.nan)
    joints[numbers] = pose(places)
    if measured.numbers is not None:
        names = np.flatnonzero(kept(grid.beams, len(grid.joints))[0])
        messages += exchanged(joints[numbers], simulated, numbers, result.grid.dimension, names)
    return joints, messages


def _numbered(
    numbers: np.ndarray, places: Numbers, grid: Grid
) -> tuple[np.ndarray, Numbers, list[Message]]:
    """Return joints by the numbers that they have in the simulated grid, which is cleaned."""
    count = len(grid.joints)
    beyond = numbers[numbers >= count]
    if len(beyond):
        text = f"joint {beyond[0]} is not in the grid; its joints are numbered 0 to {count - 1}"
        if beyond.tolist() == [count] and numbers.min() == 1:
            text += "; these count from 1: subtract 1 from every number"
        raise InputError(text, "measurement-joint", f"joint {beyond[0]}")
    stay, _ = kept(grid.beams, count)
    lost = numbers[~stay[numbers]]
    messages = []
    if len(lost):
        text = f"joints {few(lost)} have no beam that bears anything, and are not compared"
        messages.append(Message("measurement-unused", "measurement", text))
    here = stay[numbers]
    return (np.cumsum(stay) - 1)[numbers[here]], places[here], messages


def _enough(places: Numbers, grid: Grid) -> None:
    if len(places) < FEWEST:
        text = (
            f"{len(places)} joints are measured; at least {FEWEST} are needed, since any three "
            "fit about"
        )
        raise InputError(text, "measurement-few", "measurement")
    if spread(places) < FLAT * grid.dimension:
        text = "the measured joints lie on a line, which leaves the print free to turn about it"
        raise InputError(text, "measurement-line", "measurement")


def _missing(lost: Indices, scanned: bool) -> list[Message]:
    if not len(lost):
        return []
    what = "were not found in the scan" if scanned else "were not measured"
    text = f"joints {few(lost)} {what}, and are left out"
    return [Message("joints-missing", "measurement", text)]


def _nothing(done: int, total: int) -> None:
    pass
