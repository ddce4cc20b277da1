"""Other beginnings of a search: with ratios drawn anew, or with one actuator less."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from simulearn.grid import Grid
from simulearn.inverse.archive import Archive
from simulearn.inverse.problem import Problem, Scored
from simulearn.inverse.space import Space
from simulearn.inverse.task import Free
from simulearn.learn.common.model import Designs

Mask = NDArray[np.bool_]

DRAWS = 5  # of ratios, until a design has an answer


def drawn_anew(problem: Problem) -> Scored:
    """Return the design to begin with, its ratios drawn anew; as it is if none has an answer."""
    space = problem.space
    x, a = space.start
    for _ in range(DRAWS):
        start = problem.scored(x, space.nearest(x, 2 * problem.source.random(len(a)) - 1))
        if np.isfinite(start.error):
            return start
    return problem.scored(x, a)


def with_less(problem: Problem, archive: Archive, good: Mask, place: int) -> Grid:
    """Return the good design with the least actuators, without one of them.

    Args:
        problem: that scores designs.
        archive: of designs.
        good: (K,) which of them are good; one is.
        place: 0 to leave out the actuator without which the design is closest to the goals, 1 the
            one without which it is second closest, and so on.
    """
    space = problem.space
    some = np.flatnonzero(good)
    k = some[np.abs(archive.ratios[some]).sum(axis=1).argmin()]
    grid = archive.grids(space.grid)[k]
    x, a = space.point(grid)
    active = np.flatnonzero(a)
    if not len(active):
        return grid
    less = np.repeat(a[None], len(active), axis=0)
    less[np.arange(len(active)), active] = 0.0
    errors = problem.errors(np.repeat(x[None], len(active), axis=0), less)
    return space.grid_at(x, less[np.argsort(errors, kind="stable")[place % len(active)]])


def narrowed(space: Space, start: Grid, free: Free) -> Space:
    """Return the space around a design of another in which passive beams stay passive.

    Args:
        space: of the design.
        start: the design.
        free: what may change in that space.
    """
    active = [group for group in space.groups if start.actuators[list(group)].any()]
    beams = sorted(beam for group in active for beam in group)
    if not beams and not len(space.motions):
        return space  # nothing could change
    own = Space.of(start, free.model_copy(update={"actuators": beams}))
    return replace(own, training=space.training)


def elsewhere(archive: Archive, grids: Sequence[Grid], away: float) -> Callable[[Designs], Mask]:
    """Return the function that says which designs are away from some.

    Args:
        archive: whose distances count.
        grids: from which they are to be away.
        away: how far, in least distances of the archive.
    """
    joints = np.array([grid.joints for grid in grids])
    ratios = np.array([grid.actuators for grid in grids])

    def allowed(designs: Designs) -> Mask:
        distances = archive.distance(designs.flat, designs.actuators, joints, ratios)
        return np.asarray(distances.min(axis=1) >= away * archive.least)

    return allowed
