"""Dangling beams bear nothing and close no loop: they are taken off before a grid is simulated."""

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError, Message
from simulearn.grid.grid import Grid


def kept(beams: NDArray[np.int64], joints: int) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return which joints (J,) and beams (B,) stay when dangling beams are taken off.

    A beam dangles when one of its joints has no other beam; taking it off may leave another.

    Args:
        beams: (B, 2) joint indices.
        joints: J.
    """
    valence = np.bincount(beams.ravel(), minlength=joints)
    stay = np.ones(len(beams), dtype=bool)
    ends = np.flatnonzero(valence == 1).tolist()
    if not ends:
        return valence > 0, stay
    # The exclusive or of the beams at a joint is the last one's number when the others are off.
    last = np.zeros(joints, np.int64)
    np.bitwise_xor.at(last, beams, np.arange(len(beams))[:, None])
    while ends:
        joint = ends.pop()
        if valence[joint] != 1:
            continue
        beam = last[joint]
        stay[beam] = False
        for end in beams[beam]:
            valence[end] -= 1
            last[end] ^= beam
            if valence[end] == 1:
                ends.append(end)
    return valence > 0, stay


def removals(grid: Grid) -> list[Message]:
    """Return a warning for each beam and joint that `clean` takes off."""
    return warnings_of(grid, *kept(grid.beams, len(grid.joints)))


def warnings_of(grid: Grid, joints: NDArray[np.bool_], beams: NDArray[np.bool_]) -> list[Message]:
    """Return a warning for each beam and joint that does not stay; see `kept`.

    Args:
        grid: the design.
        joints: (J,) whether a joint stays.
        beams: (B,) whether a beam stays.
    """
    if beams.all() and joints.all():
        return []
    # Joints without a beam from the start; no message names those that lose theirs.
    unused = np.setdiff1d(np.arange(len(grid.joints)), grid.beams)
    return [
        Message("dangling-beam", f"beam {k}", f"beam {k} dangles at one end and is removed")
        for k in np.flatnonzero(~beams).tolist()
    ] + [
        Message("unused-joint", f"joint {k}", f"joint {k} has no beam and is removed")
        for k in unused.tolist()
    ]


def clean(grid: Grid) -> tuple[Grid, list[Message]]:
    """Return a grid without dangling beams and unused joints, and a warning for each of them.

    The joints and beams that stay keep their order and are numbered anew. A grid without any is
    returned itself.

    Raises:
        InputError: the fixed joint is among those removed.
    """
    joints, beams = kept(grid.beams, len(grid.joints))
    if beams.all() and joints.all():
        return grid, []
    if not joints[grid.fixed]:
        raise InputError(fixed_removed(grid), "fixed-removed", f"joint {grid.fixed}")
    number = np.cumsum(joints) - 1
    return (
        Grid(
            grid.joints[joints],
            number[grid.beams[beams]],
            grid.actuators[beams],
            number[grid.fixed],
            grid.material,
        ),
        warnings_of(grid, joints, beams),
    )


def fixed_removed(grid: Grid) -> str:
    """Return the message for a fixed joint that is removed."""
    return (
        f"joint {grid.fixed} is fixed but is removed, as no beam that stays meets it; "
        f"fix a joint of the grid that stays"
    )
