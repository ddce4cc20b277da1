"""Rotations and poses (SO3, SE3) in JAX, smooth wherever beams get to.

A pose is (R, p): R (..., 3, 3) turns body axes into space, p (..., 3) mm is where the body is. A
twist is (..., 6): translation, then rotation vector, in body axes. Series in the squared angle have
no division by zero at the unturned state, and derivatives of any order.

Formulas: J. Sola, J. Deray, D. Atchuthan, A micro Lie theory for state estimation in robotics,
2018.
"""

from collections.abc import Sequence
from fractions import Fraction
from math import comb, factorial
from typing import NamedTuple

import jax
import jax.numpy as jnp

Array = jax.Array

TERMS = 9  # of the series of sine and cosine: exact to 1e-9 up to two radians
WIDEST = 3.0  # rad; logarithms are right up to here (an element's ends turn by less than half)


class Pose(NamedTuple):
    """Rotation (..., 3, 3) and position (..., 3) mm."""

    R: Array
    p: Array

    def __matmul__(self, other: "Pose") -> "Pose":
        """Return the pose of a body that has pose `other` as seen from this one."""
        return Pose(self.R @ other.R, jnp.einsum("...ij,...j->...i", self.R, other.p) + self.p)

    @property
    def inverse(self) -> "Pose":
        """The pose of space as seen from the body."""
        turn = jnp.swapaxes(self.R, -1, -2)
        return Pose(turn, -jnp.einsum("...ij,...j->...i", turn, self.p))


def hat(w: Array) -> Array:
    """Return the matrices (..., 3, 3) of the cross products with vectors (..., 3)."""
    x, y, z = w[..., 0], w[..., 1], w[..., 2]
    o = jnp.zeros_like(x)
    rows = [jnp.stack(row, -1) for row in ([o, -z, y], [z, o, -x], [-y, x, o])]
    return jnp.stack(rows, -2)


def _series(first: int) -> tuple[float, ...]:
    return tuple((-1) ** n / factorial(2 * n + first) for n in range(TERMS))


SINE, COSINE, CUBIC = _series(1), _series(2), _series(3)  # sin t/t, (1-cos t)/t2, (t-sin t)/t3


def _bernoulli(most: int) -> list[Fraction]:
    """Return Bernoulli's numbers B(0) to B(most)."""
    numbers = [Fraction(1)]
    for m in range(1, most + 1):
        total = sum((comb(m + 1, k) * b for k, b in enumerate(numbers)), Fraction(0))
        numbers.append(-total / (m + 1))
    return numbers


# (1 - t sin t / (2 (1 - cos t))) / t2 as a function of t2: sum of |B(2 n)| x^(n - 1) / (2 n)!
INVERSE = tuple(
    float(abs(number) / factorial(2 * n)) for n, number in enumerate(_bernoulli(36)[::2]) if n > 0
)
INVERSE_SLOPE = tuple(n * c for n, c in enumerate(INVERSE))[1:]
# t / sin t as a function of x = (1 - cos t) / 2, where x is small
LOGARITHM = tuple(4.0**n * factorial(n) ** 2 / factorial(2 * n + 1) for n in range(12))
SMALL = 0.02


def polynomial(coefficients: Sequence[float], x: Array) -> Array:
    """Return a polynomial at x, its coefficients beginning with the constant."""
    value = jnp.full_like(x, coefficients[-1])
    for c in coefficients[-2::-1]:
        value = value * x + c
    return value


def _angle_over_sine(x: Array) -> Array:
    """Return t / sin t as a function of x = (1 - cos t) / 2."""
    safe = jnp.where(x < SMALL, 0.5, x)  # its root has no slope at 0
    sine = 2 * jnp.sqrt(safe * (1 - safe))
    far = jnp.arctan2(sine, 1 - 2 * safe) / sine
    return jnp.where(x < SMALL, polynomial(LOGARITHM, jnp.minimum(x, SMALL)), far)


def exp_so3(w: Array) -> Array:
    """Return the rotations (..., 3, 3) of rotation vectors (..., 3)."""
    square = (w * w).sum(-1)[..., None, None]
    h = hat(w)
    return jnp.eye(3) + polynomial(SINE, square) * h + polynomial(COSINE, square) * (h @ h)


def exp_se3(x: Array) -> Pose:
    """Return the poses that constant twists (..., 6) lead to."""
    u, w = x[..., :3], x[..., 3:]
    square = (w * w).sum(-1)[..., None, None]
    h = hat(w)
    hh = h @ h
    a, b, c = (polynomial(k, square) for k in (SINE, COSINE, CUBIC))
    left = jnp.eye(3) + b * h + c * hh
    return Pose(jnp.eye(3) + a * h + b * hh, jnp.einsum("...ij,...j->...i", left, u))


def log_se3(pose: Pose) -> Array:
    """Return the constant twists (..., 6) that lead to poses turned by less than `WIDEST`."""
    R, p = pose
    x = (3 - jnp.trace(R, axis1=-2, axis2=-1)) / 4
    axis = jnp.stack(
        [R[..., 2, 1] - R[..., 1, 2], R[..., 0, 2] - R[..., 2, 0], R[..., 1, 0] - R[..., 0, 1]], -1
    )
    w = axis / 2 * _angle_over_sine(x)[..., None]
    h = hat(w)
    square = (w * w).sum(-1)[..., None, None]
    inverse = jnp.eye(3) - h / 2 + polynomial(INVERSE, square) * (h @ h)
    return jnp.concatenate([jnp.einsum("...ij,...j->...i", inverse, p), w], -1)


def adjoint(pose: Pose) -> Array:
    """Return the matrices (..., 6, 6) that take twists in the body to twists in space."""
    R, p = pose
    zero = jnp.zeros_like(R)
    top = jnp.concatenate([R, hat(p) @ R], -1)
    return jnp.concatenate([top, jnp.concatenate([zero, R], -1)], -2)


def inverse_right(x: Array) -> tuple[Array, Array]:
    """Return how the logarithm (..., 6) changes with a twist at its end, as blocks (..., 3, 3).

    The whole is [[J, D], [0, J]]: J is that of the rotation, D its derivative along the
    translation. With W, U the cross products with w, u: J = I + W/2 + k(w.w) W W.
    """
    u, w = x[..., :3], x[..., 3:]
    square, both = (w * w).sum(-1)[..., None, None], (u * w).sum(-1)[..., None, None]
    k, slope = polynomial(INVERSE, square), polynomial(INVERSE_SLOPE, square)
    mixed = w[..., :, None] * u[..., None, :]
    twice = w[..., :, None] * w[..., None, :] - square * jnp.eye(3)  # W W
    crossed = mixed + jnp.swapaxes(mixed, -1, -2) - 2 * both * jnp.eye(3)  # W U + U W
    return (
        jnp.eye(3) + hat(w) / 2 + k * twice,
        hat(u) / 2 + k * crossed + 2 * both * slope * twice,
    )
