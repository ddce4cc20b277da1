"""What makes a measurement doubtful: another grid, other numbers, one wrong joint, a flat print."""

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.spatial.distance import cdist

from simulearn.compare.aligning import rigid, rms
from simulearn.compare.deviation import brought
from simulearn.compare.matching import matches
from simulearn.compare.measurement import Indices, Numbers
from simulearn.errors import InputError, Message
from simulearn.grid import Grid

FAR = 0.12  # of the dimension, residual that a print hardly has
OTHER = 0.35  # of the dimension, residual of another grid
EXCHANGED = 3.0  # times as well the joints fit with other numbers
ALONE = 3.0  # times as well the joints fit without one of them
FEWEST = 5  # joints, of which four are left
NOTICED = 0.015  # of the dimension, residual from which anyone looks for a wrong joint
FLAT = 4.0  # times as well a measurement fits the flat grid
MOST = 12  # numbers in a message


def plausible(residual: float, grid: Grid, scanned: bool, before: list[Message]) -> list[Message]:
    """Return a warning where a measurement hardly fits.

    Args:
        residual: mm, root of the mean squared distance of the joints.
        grid: the simulated one.
        scanned: whether a scan was measured.
        before: what was found of the measurement, which may be the reason.

    Raises:
        InputError: it does not fit.
    """
    share = residual / grid.dimension
    if share < FAR:
        return []
    what = f"the joints are off by {residual:.1f} mm in the mean of squares, {share:.0%} of the"
    other = "another grid" if scanned else "another grid, or have other numbers"
    if share > OTHER:
        text = f"{what} dimension; no print is so far off, so it must be {other}"
        reasons = ("joints-exchanged", "joint-alone", "measurement-flat")
        text += "".join(f"; {m.message}" for m in before if m.code in reasons)
        raise InputError(text, "measurement-other", "measurement")
    return [Message("measurement-far", "measurement", f"{what} dimension; it may be {other}")]


def exchanged(
    places: Numbers, simulated: Numbers, numbers: Indices, dimension: float, names: Indices
) -> list[Message]:
    """Return a warning where joints fit far better with other numbers.

    Args:
        places: (K, 3) measured, in the frame of the simulation.
        simulated: (J, 3) of all joints.
        numbers: (K,) which joints they are said to be.
        dimension: of the grid, mm.
        names: (J,) numbers of the joints in messages.
    """
    now = simulated[numbers]
    near = numbers
    for _ in range(10):  # two that are exchanged hardly move the others
        moved = rigid(places, simulated[near])(places)
        before, near = near, linear_sum_assignment(cdist(moved, simulated) ** 2)[1]
        if (near == before).all():
            break
    tried = [near]
    if rms(places, now) > FAR / 2 * dimension:
        tried.append(matches(places, simulated)[0].joints)
    other = min(
        tried, key=lambda joints: rms(brought(places, simulated[joints]), simulated[joints])
    )
    changed = other != numbers
    if not changed.any():
        return []
    fitted, there = brought(places, simulated[other]), simulated[other]
    if rms(fitted[changed], there[changed]) * EXCHANGED > rms(places[changed], now[changed]):
        return []
    text = (
        f"with other numbers the joints would fit within {rms(fitted, there):.2f} mm in place of "
        f"{rms(places, now):.2f} mm: as joints {few(names[other[changed]])} for "
        f"{few(names[numbers[changed]])}; look at how they were numbered"
    )
    return [Message("joints-exchanged", "measurement", text)]


def alone(places: Numbers, simulated: Numbers, dimension: float, names: Indices) -> list[Message]:
    """Return a warning where one joint is off and all others fit far better without it.

    Args:
        places: (K, 3) measured, in the frame of the simulation.
        simulated: (K, 3) of the same joints.
        dimension: of the grid, mm.
        names: (K,) numbers of the joints.
    """
    residual = rms(places, simulated)
    if len(places) < FEWEST or residual < NOTICED * dimension:
        return []
    poses, left = [], []
    for k in range(len(places)):
        ours, theirs = np.delete(places, k, axis=0), np.delete(simulated, k, axis=0)
        poses.append(rigid(ours, theirs))
        left.append(rms(poses[k](ours), theirs))
    k = int(np.argmin(left))
    if left[k] * ALONE > residual:
        return []
    off = float(np.linalg.norm(poses[k](places)[k] - simulated[k]))
    text = (
        f"joint {names[k]} alone is off by {off:.1f} mm: the others fit within {left[k]:.2f} mm "
        f"without it, and {residual:.2f} mm with it; look at what was measured there"
    )
    return [Message("joint-alone", f"joint {names[k]}", text)]


def flat(places: Numbers, simulated: Numbers, grid: Numbers) -> list[Message]:
    """Return a warning where a measurement is of the flat grid, which no water has formed.

    Args:
        places: (K, 3) measured.
        simulated: (K, 3) of the same joints.
        grid: (K, 2) of the same joints, flat.
    """
    plane = np.c_[grid, np.zeros(len(grid))]
    off, residual = rms(brought(places, plane), plane), rms(places, simulated)
    if off * FLAT > residual:
        return []
    text = (
        f"the joints fit the flat grid within {off:.2f} mm, and the simulated shape within "
        f"{residual:.2f} mm: this seems to be the print before its bath, or the design itself"
    )
    return [Message("measurement-flat", "measurement", text)]


def few(numbers: Indices) -> str:
    """Return numbers in words, not more than a sentence bears."""
    words = [str(n) for n in numbers[:MOST].tolist()]
    return ", ".join(words) + (", ..." if len(numbers) > MOST else "")
