"""Sizes that no print can have, mostly from another unit: every length of a grid is in mm.

Too small: no beam is as long as it is wide, so that nothing is left between the joints. Too large:
beams that cannot carry their own weight. A cantilever of length L, thickness h and modulus E sinks,
by the theory of small motions, by L (L / l)^3 / 8 with l = (E h^2 / (12 q))^(1/3) and the weight q
per volume. In the bath l is 102 mm for PLA: beams of 145 mm sink by a third of their length and
still make a shape; those of three times l are said to sink by more than three times their length,
which means that they hang down like cords, whatever is drawn. Finite elements take minutes to find
that, so it is said before.
"""

from math import inf

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import Message
from simulearn.grid.grid import Grid
from simulearn.material import Material
from simulearn.material.material import Section
from simulearn.units import in_mm

Numbers = NDArray[np.float64]

CORD = 3.0  # times l: beams so long hang like cords
STUBBY = 2.0  # widths: a grid without a longer beam is unusual
LANKY = 2.0  # times the usual limit of a beam: a grid whose beams are longer is unusual
USUAL = (15.0, 160.0)  # mm, of beams
TYPICAL = 60.0  # mm, of beams
UNITS = {  # mm
    **in_mm("m", "ft", "in", "cm", "pt", "px"),
    "tenths of a millimetre": 0.1,
    **in_mm("mil", "um"),
}


def size_message(grid: Grid, material: Material, most: float) -> tuple[Message | None, bool]:
    """Return what to say of a grid's size, None where it is usual, and whether that is an error.

    Args:
        grid: its beams join joints that exist; those without a length do not count.
        material: its material system.
        most: mm, the usual limit of a beam's length.
    """
    lengths = _lengths(grid, grid.beams)
    if not len(lengths):
        return None, False
    width, longest, middle = material.section.width, lengths[-1], _middle(lengths)
    cord, error = cord_length(material), True
    halfway = f"half of its beams are {_mm(middle)} long or longer"
    if longest < STUBBY * width:
        error = bool(longest < width)
        than = "as it is wide" if error else "as two widths"
        text = f"its longest beam is {_mm(longest)} long, not as long {than} ({width:g} mm)"
    elif middle > cord:
        text = (
            f"{halfway}, and beams of more than {cord:.0f} mm cannot carry their own weight in "
            "the bath"
        )
    elif middle > LANKY * most:
        error = False
        text = f"{halfway}, where {most:g} mm is the usual limit"
    else:
        return None, False
    whole = f"the whole grid is {_wide(grid)} and lengths are in mm"
    return Message("size", "grid", f"{whole}; {text}{unit_remark(grid)}"), error


def impossible(lengths: Numbers, material: Material) -> NDArray[np.bool_]:
    """Return which designs (T,) `size_message` gives an error for.

    Args:
        lengths: (T, B) mm, of their beams.
        material: their material system.
    """
    if not lengths.shape[1]:
        return np.zeros(len(lengths), bool)
    most, cord = lengths.max(axis=1), cord_length(material)
    wrong: NDArray[np.bool_] = most < material.section.width
    if (most > cord).any():  # else no median is, either
        wrong |= np.median(lengths, axis=1) > cord
    return wrong


def cord_length(material: Material) -> float:
    """Return the length (mm) from which on a beam hangs like a cord; infinite without weight."""
    return CORD * _bending_length(
        material.section, material.law.stiffness, material.gravity.body_force
    )


def _bending_length(section: Section, modulus: float, weight: float) -> float:
    """Return l (mm); see the head of this module."""
    if not weight:
        return inf
    return float((modulus * section.thickness**2 / (12 * weight)) ** (1 / 3))


def unit_remark(grid: Grid) -> str:
    """Return in which other unit a grid would have usual beams, to be added to a message."""
    there = ((grid.beams >= 0) & (grid.beams < len(grid.joints))).all(axis=1)
    lengths = _lengths(grid, grid.beams[there])
    middle = _middle(lengths) if len(lengths) else 0.0
    if not middle or USUAL[0] <= middle <= USUAL[1]:
        return ""
    likely = {
        name: abs(np.log(middle * mm / TYPICAL))
        for name, mm in UNITS.items()
        if USUAL[0] <= middle * mm <= USUAL[1]
    }
    if not likely:
        return ""
    name = min(likely, key=lambda one: likely[one])
    mm = UNITS[name]
    return (
        f"; read as {name}, half of the beams would be {_mm(middle * mm)} long or longer: "
        f"multiply all coordinates by {mm:.4g}"
    )


def _lengths(grid: Grid, beams: NDArray[np.int64]) -> Numbers:
    """Return the rising lengths (mm) of those beams that have one; all their joints exist."""
    x, y = (grid.joints[beams[:, 1]] - grid.joints[beams[:, 0]]).T
    lengths: Numbers = np.sort(np.hypot(x, y))
    return lengths[np.searchsorted(lengths, 0.0, side="right") :]


def _middle(rising: Numbers) -> float:
    """Return the median; NumPy's takes a while to begin."""
    n = len(rising)
    return float(rising[(n - 1) // 2] + rising[n // 2]) / 2


def _wide(grid: Grid) -> str:
    used = np.unique(grid.beams)
    joints = grid.joints[used[(used >= 0) & (used < len(grid.joints))]]
    x, y = np.ptp(joints, axis=0)
    return f"{_mm(x)[:-3]} by {_mm(y)} wide,"


def _mm(length: float) -> str:
    return f"{length:,.0f} mm" if length >= 1000 else f"{length:.3g} mm"
