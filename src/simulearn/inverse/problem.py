"""What a method of search is given: points of a space go in, errors come out.

The best design is remembered here, whatever the method does with the errors, so a search can be
stopped at any moment and nothing is lost. No design that is not valid is ever scored.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from time import monotonic

import numpy as np
from numpy.typing import NDArray

from simulearn.grid import Grid
from simulearn.inverse.goals import Goals
from simulearn.inverse.scoring import Places
from simulearn.inverse.space import Space

Array = NDArray[np.float64]


class OutOfTime(Exception):  # noqa: N818  (no error: the best so far is kept)
    """The time for searching is over."""


@dataclass(frozen=True, eq=False)
class Found:
    """A design that was scored.

    Attributes:
        x, a: its point in the space, (P,) and (Q,).
        points: (G, 3) mm, where the goals' vertices come to.
        error: mm.
    """

    x: Array
    a: Array
    points: Array
    error: float


@dataclass(eq=False)
class Problem:
    """Goals in a space of designs, and the best of those that were scored.

    Attributes:
        space: what may change.
        goals: what is wanted.
        places: where vertices come to; see `scoring`.
        until: when to stop, by `now`.
        best: so far.
        designs: how many were scored.
    """

    space: Space
    goals: Goals
    places: Places
    until: float = np.inf
    now: Callable[[], float] = monotonic
    best: Found | None = None
    designs: int = field(default=0)

    def points(self, x: Array, a: Array) -> Array:
        """Return where the vertices of points (T, P), (T, Q) come to: (T, G, 3) mm.

        NaN where a design is not valid or has no answer.

        Raises:
            OutOfTime: before anything is computed.
        """
        self.going()
        told = np.full((len(x), len(self.goals), 3), np.nan)
        valid = np.flatnonzero(self.space.valid(x, a))
        if len(valid):
            told[valid] = self.places(self.space.designs(x[valid], a[valid]))
        self.designs += len(valid)
        errors = self.error(told)
        k = int(errors.argmin()) if len(errors) else 0
        if len(errors) and errors[k] < (np.inf if self.best is None else self.best.error):
            self.best = Found(x[k].copy(), a[k].copy(), told[k], float(errors[k]))
        return told

    def error(self, points: Array) -> Array:
        """Return the errors (T,) mm of points (T, G, 3); infinite where there are none."""
        return np.nan_to_num(self.goals.error(points), nan=np.inf)

    def errors(self, x: Array, a: Array) -> Array:
        """Return the errors (T,) mm of points (T, P), (T, Q); see `points`."""
        return self.error(self.points(x, a))

    def found(self, x: Array, a: Array) -> Found:
        """Return a single point (P,), (Q,) with what it comes to."""
        told = self.points(x[None], a[None])
        return Found(x, a, told[0], float(self.error(told)[0]))

    def grid(self, found: Found) -> Grid:
        """Return the grid of a design."""
        return self.space.grid_at(found.x, found.a)

    def going(self) -> None:
        """Raise OutOfTime when it is."""
        if self.now() > self.until:
            raise OutOfTime
