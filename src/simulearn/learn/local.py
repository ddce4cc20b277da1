"""What the solid knows and a beam does not: a small network on the halves of beams.

A half sees itself (length, actuator, ends, how it is strained, where down is) and, through joints,
the halves around it. It answers how its rest and its stiffness differ from the fitted section's,
and how its sections warp. Everything is said in the half's own axes, upside down where its
actuator is at the bottom, and is averaged over the mirror image: turning, mirroring and reversing
a design turn, mirror and reverse the answer exactly.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from simulearn.mechanics.forces import FLIP, State
from simulearn.mechanics.poses import Array
from simulearn.mechanics.skeleton import Flat, Skeleton

TWIST_MIRROR = np.array([1, -1, 1, -1, 1, -1.0])
TWIST_FLIP = np.array([1, 1, -1, -1, -1, 1.0])
TWIST_SIZE = np.array([1, 1, 1, 0.2, 0.2, 0.1])  # mm, rad: what is usual


class Heads(NamedTuple):
    """How a vector of outputs is mirrored and put upside down: new = old[order] * sign.

    Attributes:
        mirror, flip: (order (O,), sign (O,)).
        size: (O,) what is usual.
    """

    mirror: tuple[np.ndarray, np.ndarray]
    flip: tuple[np.ndarray, np.ndarray]
    size: np.ndarray


def signed(mirror: np.ndarray, flip: np.ndarray, size: np.ndarray) -> Heads:
    """Return heads that change their signs only."""
    order = np.arange(len(size))
    return Heads((order, mirror), (order, flip), size)


def _at_corners(mirror: list[int], flip: list[int], size: float) -> Heads:
    """Return the heads of something at the corners right-bottom, left-bottom, right-top, left-top.

    Args:
        mirror: sign of each of its components when right and left change places.
        flip: the same for bottom and top.
        size: what is usual.
    """
    count = len(mirror)
    order = lambda q: (np.array(q)[:, None] * count + np.arange(count)).ravel()  # noqa: E731
    return Heads(
        (order([1, 0, 3, 2]), np.tile(np.array(mirror, float), 4)),
        (order([2, 3, 0, 1]), np.tile(np.array(flip, float), 4)),
        np.full(4 * count, size),
    )


def joined(*heads: Heads) -> Heads:
    """Return heads one after the other."""
    starts = np.cumsum([0, *(len(h.size) for h in heads)])
    join = lambda pairs: (  # noqa: E731
        np.concatenate([order + at for (order, _), at in zip(pairs, starts, strict=False)]),
        np.concatenate([sign for _, sign in pairs]),
    )
    return Heads(
        join([h.mirror for h in heads]),
        join([h.flip for h in heads]),
        np.concatenate([h.size for h in heads]),
    )


_VECTOR = _at_corners([1, -1, 1], [1, 1, -1], 0.2)  # mm
_TENSOR = _at_corners([1, 1, 1, -1, 1, -1], [1, 1, 1, 1, -1, -1], 0.01)  # MPa; 11 22 33 12 13 23
CORRECTIONS = joined(
    signed(TWIST_MIRROR, TWIST_FLIP, 0.3 * TWIST_SIZE),  # of the rest
    signed(np.ones(6), np.ones(6), np.full(6, 0.5)),  # of the stiffness
    _VECTOR,  # warping at the face
    _VECTOR,  # and at the middle
)
STRESSES = joined(_TENSOR, _TENSOR)  # near the face and near the middle
REST, STIFF, FACE, MIDDLE = slice(0, 6), slice(6, 12), slice(12, 24), slice(24, 36)


class Answer(NamedTuple):
    """What the network says of each half (2, B), in its own axes.

    Attributes:
        rest: (..., 6) twist by which its middle lies elsewhere at rest, mm and rad.
        stiff: (..., 6) log of the factors on its stiffness.
        face: (..., 4, 3) warping of the corners at its joint, mm.
        middle: (..., 4, 3) warping of the corners of its middle section, mm.
    """

    rest: Array
    stiff: Array
    face: Array
    middle: Array


class Seen(NamedTuple):
    """What the network is told of each half.

    Attributes:
        values: (2, B, F) features of usual size one, in canonical axes.
        angle: (2, B) direction of the half in the plane, rad.
        sign: (2, B) -1 where its actuator is at the bottom, else 1.
    """

    values: Array
    angle: Array
    sign: Array


ODD = ("skew", "far skew")
PLAIN = (
    "length", "ratio", "idle", "passive", "active", "reach", "skew", "far reach", "far skew",
    "held", "held over", "far held", "far held over", "area", "valence", "released", "creep",
)  # fmt: skip
VALUES_MIRROR = np.concatenate(
    [
        np.array([-1.0 if name in ODD else 1.0 for name in PLAIN]),
        TWIST_MIRROR,
        TWIST_MIRROR,
        [1, -1, 1],
        [1, -1, 1],
    ]
)
FEATURES = len(VALUES_MIRROR)


def look(
    bones: Skeleton, plan: Flat, ratio: Array, state: State, twist: Array, s: Array, gravity: Array
) -> Seen:
    """Return what the network is told of a grid in a state of the fitted mechanics.

    Args:
        bones: how the grid hangs together.
        plan: the flat grid.
        ratio: (B,) signed actuator ratios.
        state: its poses.
        twist: (2, B, 6) how far the halves are from rest there.
        s: released fraction.
        gravity: multiple of gravity.
    """
    size, sign = jnp.abs(ratio), jnp.where(ratio < 0, -1.0, 1.0)
    both = lambda x: jnp.stack([x, x])  # noqa: E731
    held = (bones.ends == bones.fixed).astype(twist.dtype)
    valence = jnp.zeros(len(plan.area)).at[bones.ends].add(1.0)
    one = jnp.ones_like(twist[..., 0])
    plain = {
        "length": both(plan.length / 50 - 1),
        "ratio": both(size),
        "idle": both((size == 0).astype(twist.dtype)),
        "passive": both((1 - size) * plan.length / 40 - 0.5),
        "active": both(size * plan.length / 40 - 0.5),
        "reach": plan.reach / 2 - 2,
        "skew": plan.skew / 3,
        "far reach": plan.reach[::-1] / 2 - 2,
        "far skew": plan.skew[::-1] / 3,
        "held": held,
        "held over": held * sign,
        "far held": held[::-1],
        "far held over": held[::-1] * sign,
        "area": plan.area[bones.ends] / 30 - 2,
        "valence": valence[bones.ends] - 3,
        "released": one * (2 * s - 1),
        "creep": one * (gravity - 1) * 8,
    }
    flip = jnp.where(sign[:, None] < 0, TWIST_FLIP, 1.0)
    own = twist / TWIST_SIZE * flip
    above = state.joints.R[bones.ends][..., 2, :]
    above = jnp.einsum("hbji,hbj->hbi", plan.frame, above)
    middle = jnp.einsum("hij,bj->hbi", FLIP, state.middles.R[:, 2, :])
    down = jnp.where(sign[:, None] < 0, jnp.array([1.0, 1.0, -1.0]), 1.0)
    values = jnp.concatenate(
        [
            jnp.stack([plain[name] for name in PLAIN], -1),
            own,
            own[::-1],
            above * down,
            middle * down,
        ],
        -1,
    )
    angle = jnp.arctan2(plan.frame[..., 1, 0], plan.frame[..., 0, 0])
    return Seen(values, angle, both(sign))


class Weights(NamedTuple):
    """Weights of the network, (in, out) matrices and biases."""

    encode: list[tuple[Array, Array]]
    rounds: list[list[tuple[Array, Array]]]
    decode: list[tuple[Array, Array]]


HARMONICS = 2
CHANNELS = 2 * (1 + 2 * HARMONICS)


def weights(
    key: Array, heads: Heads = CORRECTIONS, width: int = 64, message: int = 16, rounds: int = 2
) -> Weights:
    """Return fresh weights; the last layer is zero, so that the answer is the plain section."""
    keys = iter(jax.random.split(key, 4 + 2 * rounds))

    def layer(inner: int, outer: int, scale: float = 1.0) -> tuple[Array, Array]:
        spread = float(scale / np.sqrt(inner))  # a NumPy scalar would make it double precision
        values = jax.random.normal(next(keys), (inner, outer), jnp.float32) * spread
        return values, jnp.zeros(outer, jnp.float32)

    encode = [layer(FEATURES, width), layer(width, width)]
    passing = [
        [layer(width, message), layer(2 * width + CHANNELS * message, width)] for _ in range(rounds)
    ]
    decode = [layer(width, width), layer(width, len(heads.size), 0.0)]
    return Weights(encode, passing, decode)


def answer(weights: Weights, bones: Skeleton, seen: Seen) -> Answer:
    """Return the corrections of each half."""
    out = spoken(weights, bones, seen, CORRECTIONS)
    shape = (*out.shape[:-1], 4, 3)
    face, middle = out[..., FACE].reshape(shape), out[..., MIDDLE].reshape(shape)
    return Answer(out[..., REST], out[..., STIFF], face, middle)


def stresses(weights: Weights, bones: Skeleton, seen: Seen) -> Array:
    """Return the elastic stress of each half near its face and its middle: (2, B, 2, 4, 6) MPa."""
    out = spoken(weights, bones, seen, STRESSES)
    return out.reshape(*out.shape[:-1], 2, 4, 6)


def spoken(weights: Weights, bones: Skeleton, seen: Seen, heads: Heads) -> Array:
    """Return what the network says: the mean over a design and its mirror image."""
    values = seen.values.astype(jnp.float32)
    angle, sign = seen.angle.astype(jnp.float32), seen.sign.astype(jnp.float32)
    here = _network(weights, bones, values, angle, sign)
    there = _network(weights, bones, values * VALUES_MIRROR.astype(np.float32), -angle, sign)
    order, signs = heads.mirror
    out = (here + there[..., order] * signs.astype(np.float32)) / 2
    order, signs = heads.flip
    out = jnp.where(sign[..., None] < 0, out[..., order] * signs.astype(np.float32), out)
    return out.astype(jnp.float64) * heads.size


def _network(weights: Weights, bones: Skeleton, values: Array, angle: Array, sign: Array) -> Array:
    act = jax.nn.silu
    x = values
    for matrix, bias in weights.encode:
        x = act(x @ matrix + bias)
    for (into, shift), (matrix, bias) in weights.rounds:
        told = act(x @ into + shift)
        heard = jnp.concatenate([x, x[::-1], _around(bones, told, angle, sign)], -1)
        x = x + act(heard @ matrix + bias)
    (matrix, bias), (last, end) = weights.decode
    return act(x @ matrix + bias) @ last + end


def _around(bones: Skeleton, told: Array, angle: Array, sign: Array) -> Array:
    """Return what the other halves at the same joint tell, by harmonics of the angle to them.

    Sums over a joint in fixed axes, turned into each half's, less its own part.
    """
    waves = [jnp.ones_like(angle)]
    for k in range(1, HARMONICS + 1):
        waves += [jnp.cos(k * angle), jnp.sin(k * angle)]
    wave = jnp.stack(waves, -1)  # (2, B, 1 + 2 H)
    both = jnp.stack([jnp.ones_like(sign), sign], -1)
    spoken = told[..., None, None, :] * wave[..., :, None, None] * both[..., None, :, None]
    joints = bones.before.shape[0]
    total = jnp.zeros((joints, *spoken.shape[2:]), told.dtype).at[bones.ends].add(spoken)
    others = (total[bones.ends] - spoken) * both[..., None, :, None]
    parts = [others[..., 0, :, :]]
    for k in range(1, HARMONICS + 1):
        c, s = others[..., 2 * k - 1, :, :], others[..., 2 * k, :, :]
        cos, sin = (wave[..., 2 * k - 1 + i, None, None] for i in (0, 1))
        parts += [cos * c + sin * s, cos * s - sin * c]
    heard = jnp.concatenate([part.reshape(*angle.shape, -1) for part in parts], -1)
    return heard / 2
