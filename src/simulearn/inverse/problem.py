"""What a method of search works on: points of a space go in, errors come out.

The best design is remembered here, whatever the method does with the errors, so a search can be
stopped at any moment and nothing is lost. No design that is not valid is ever scored.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from time import monotonic
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import Cancel, stop_if
from simulearn.grid import Grid
from simulearn.inverse.goals import Goals
from simulearn.inverse.scoring import Places
from simulearn.inverse.space import Space
from simulearn.learn.common.model import Designs

Array = NDArray[np.float64]

LOOKED_AT = 3  # designs of a batch that are looked at for collisions, at most


class OutOfTime(Exception):  # noqa: N818  (no error: the best so far is kept)
    """The time for searching is over."""


@dataclass(frozen=True)
class Advance:
    """What a method has just done.

    Attributes:
        words: for people.
        complete: whether that was an iteration, or only a part of one.
    """

    words: str
    complete: bool = True


@dataclass(frozen=True, eq=False)
class Scored:
    """A design that was scored.

    Attributes:
        x, a: its point in the space, (P,) and (Q,).
        points: (V, 3) mm, where the goals' vertices come to.
        error: mm.
        collides: whether parts of it run through each other, as far as that was looked at.
    """

    x: Array
    a: Array
    points: Array
    error: float
    collides: bool = False


@dataclass(eq=False)
class Problem:
    """Goals in a space of designs, and the best of those that were scored.

    Attributes:
        space: what may change.
        goals: what is wanted.
        places: where vertices come to; see `scoring`.
        model: the learned simulator behind `places`, for methods that differentiate it.
        source: of what is drawn at random.
        until: when to stop, by `now`.
        cancel: stops the search.
        best: so far.
        designs: how many were scored.
        collides: whether parts of a design run through each other; None: nobody looks. Of a batch
            only designs that would become the best are looked at, the best of them first.
    """

    space: Space
    goals: Goals
    places: Places
    model: Any = None
    source: np.random.Generator = field(default_factory=lambda: drawing(0))
    until: float = np.inf
    now: Callable[[], float] = monotonic
    cancel: Cancel | None = None
    best: Scored | None = None
    designs: int = field(default=0)
    collides: Callable[[Designs], bool] | None = None

    def points(self, x: Array, a: Array) -> Array:
        """Return where the vertices of points (T, P), (T, Q) come to: (T, V, 3) mm.

        NaN where a design is not valid or has no answer.

        Raises:
            OutOfTime: before anything is computed.
        """
        self.going()
        points = np.full((len(x), len(self.goals.vertices), 3), np.nan)
        valid = np.flatnonzero(self.space.valid(x, a))
        if len(valid):
            points[valid] = self.places(self.space.designs(x[valid], a[valid]))
        self.designs += len(valid)
        errors = self.error(points)
        self._remember(x, a, points, errors)
        return points

    def _remember(self, x: Array, a: Array, points: Array, errors: Array) -> None:
        """Keep the best design so far; one that collides only for want of others."""
        for k in np.argsort(errors)[:LOOKED_AT]:
            best = self.best
            if not errors[k] < (np.inf if best is None or best.collides else best.error):
                return
            collides = self.looked_at(x[k], a[k])
            if best is None or (collides, errors[k]) < (best.collides, best.error):
                self.best = Scored(x[k].copy(), a[k].copy(), points[k], float(errors[k]), collides)
            if not collides:
                return

    def looked_at(self, x: Array, a: Array) -> bool:
        """Return whether parts of a design (P,), (Q,) run through each other; looks at it anew."""
        return self.collides is not None and self.collides(self.space.designs(x[None], a[None]))

    def loose(self, x: Array, a: Array) -> Array:
        """Return where vertices come to when ratios are not multiples of the step: (T, V, 3) mm.

        Such points are no designs, and not remembered; only learned engines answer.

        Raises:
            OutOfTime: before anything is computed.
        """
        self.going()
        points = np.full((len(x), len(self.goals.vertices), 3), np.nan)
        sound = np.flatnonzero(np.isfinite(self.space.nets(x)).all(axis=1))
        if len(sound):
            points[sound] = self.places(self.space.designs(x[sound], a[sound]))
        self.designs += len(sound)
        return points

    def error(self, points: Array) -> Array:
        """Return the errors (T,) mm of points (T, V, 3); infinite where there are none."""
        return np.nan_to_num(self.goals.error(points), nan=np.inf)

    def errors(self, x: Array, a: Array) -> Array:
        """Return the errors (T,) mm of points (T, P), (T, Q); see `points`."""
        return self.error(self.points(x, a))

    def scored(self, x: Array, a: Array) -> Scored:
        """Return a single point (P,), (Q,) with what it comes to."""
        points = self.points(x[None], a[None])
        best = self.best
        known = best is not None and np.array_equal(best.x, x) and np.array_equal(best.a, a)
        collides = best is not None and known and best.collides
        return Scored(x, a, points[0], float(self.error(points)[0]), collides)

    def grid(self, design: Scored) -> Grid:
        """Return the grid of a design."""
        return self.space.grid_at(design.x, design.a)

    def going(self) -> None:
        """Raise OutOfTime or CancelledError when the search is to stop."""
        stop_if(self.cancel)
        if self.now() > self.until:
            raise OutOfTime


@dataclass(frozen=True)
class Until:
    """A token that is set when the time is over, or when another one is.

    Attributes:
        cancel: the other one.
        deadline: by `time.monotonic`.
    """

    cancel: Cancel | None
    deadline: float

    def is_set(self) -> bool:
        """Return whether it is."""
        return monotonic() > self.deadline or (self.cancel is not None and self.cancel.is_set())


def drawing(seed: int) -> np.random.Generator:
    """Return a source of random numbers that are the same on every machine."""
    return np.random.Generator(np.random.Philox(seed))


def residual(problem: Problem, points: Array) -> Array:
    """Return how far goals are from being met (..., N) mm at points (..., V, 3)."""
    return problem.goals.residual(points)
