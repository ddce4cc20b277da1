"""Dangling beams bear nothing and close no loop: they are taken off before a grid is simulated."""

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError, Message
from simulearn.grid.grid import Grid


def kept(grid: Grid) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return which joints (J,) and beams (B,) stay when dangling beams are taken off.

    A beam dangles when one of its joints has no other beam; taking it off may leave another.
    """
    beams = np.ones(len(grid.beams), dtype=bool)
    while True:
        valence = np.bincount(grid.beams[beams].ravel(), minlength=len(grid.joints))
        dangling = beams & (valence[grid.beams] == 1).any(axis=1)
        if not dangling.any():
            return valence > 0, beams
        beams &= ~dangling


def removals(grid: Grid) -> list[Message]:
    """Return a warning for each beam and joint that `clean` takes off."""
    beams = kept(grid)[1]
    # Joints without a beam from the start; those that lose theirs go without saying.
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

    The joints and beams that stay keep their order and are numbered anew.

    Raises:
        InputError: the fixed joint is among those removed.
    """
    joints, beams = kept(grid)
    if not joints[grid.fixed]:
        raise InputError(fixed_removed(grid))
    number = np.cumsum(joints) - 1
    return (
        Grid(
            grid.joints[joints],
            number[grid.beams[beams]],
            grid.actuators[beams],
            number[grid.fixed],
            grid.material,
        ),
        removals(grid),
    )


def fixed_removed(grid: Grid) -> str:
    """Return what to say when the fixed joint is removed."""
    return (
        f"joint {grid.fixed} is fixed but is removed, as no beam that stays meets it; "
        f"fix a joint of the grid that stays"
    )
