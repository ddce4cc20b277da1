"""Charts: surfaces by two parameters from 0 to 1, and how their parameters are spread evenly."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
At = Callable[[Array, Array], Array]  # u (N,), v (N,) -> (N, 3) mm

SAMPLES = 97  # along each parameter, where lengths are measured
SMALL = 1e-4


@dataclass(frozen=True, eq=False)
class Chart:
    """A surface by two parameters; seen from outside, v is to the left of u.

    Attributes:
        at: gives the points (N, 3) mm at u (N,) and v (N,).
        closed: whether it comes back to where it began, along u and along v.
        step: difference of a parameter by which directions are taken.
    """

    at: At
    closed: tuple[bool, bool] = (False, False)
    step: float = SMALL

    @cached_property
    def sampled(self) -> Array:
        """(SAMPLES, SAMPLES, 3) mm, by v and u."""
        line = np.linspace(0.0, 1.0, SAMPLES)
        u, v = np.meshgrid(line, line)
        return self.at(u.ravel(), v.ravel()).reshape(SAMPLES, SAMPLES, 3)

    @cached_property
    def lengths(self) -> tuple[float, float]:
        """Mean lengths along u and along v, mm."""
        along = [float(self._progress(axis)[-1]) for axis in (0, 1)]
        return along[0], along[1]

    def normals(self, u: Array, v: Array) -> Array:
        """Return unit normals (N, 3) to the outside; zero where the surface is folded to a line."""
        across = np.cross(
            self._direction(u, v, (self.step, 0.0)), self._direction(u, v, (0.0, self.step))
        )
        size = np.linalg.norm(across, axis=1, keepdims=True)
        flat = size < 1e-12 * max(float(size.max(initial=0.0)), 1e-300)
        return np.where(flat, 0.0, across / np.where(flat, 1.0, size))

    def even(self) -> "Chart":
        """Return the same surface with parameters that go along it evenly, in the mean."""
        line = np.linspace(0.0, 1.0, SAMPLES)
        shares = [self._progress(axis) / self.lengths[axis] for axis in (0, 1)]

        def at(u: Array, v: Array) -> Array:
            return self.at(np.interp(u, shares[0], line), np.interp(v, shares[1], line))

        return replace(self, at=at)

    def _progress(self, axis: int) -> Array:
        """Return the mean length (SAMPLES,) mm from the beginning, along u (0) or v (1)."""
        steps = np.linalg.norm(np.diff(self.sampled, axis=1 - axis), axis=-1).mean(axis=axis)
        return np.append(0.0, np.cumsum(steps))

    def _direction(self, u: Array, v: Array, step: tuple[float, float]) -> Array:
        high = [np.minimum(x + s, 1.0) for x, s in zip((u, v), step, strict=True)]
        low = [np.maximum(x - s, 0.0) for x, s in zip((u, v), step, strict=True)]
        return self.at(high[0], high[1]) - self.at(low[0], low[1])
