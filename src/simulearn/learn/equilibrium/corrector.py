"""What the solid knows and a beam does not: a small network on the halves of beams.

A half sees itself (length, actuator, ends, how it is strained, where down is) and, through joints,
the halves around it. It answers how its rest and its stiffness differ from the fitted section's,
and how its sections warp. Everything is said in the half's own axes, upside down where its
actuator is at the bottom, and is averaged over the mirror image: turning, mirroring and reversing
a design turn, mirror and reverse the answer exactly.
"""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from simulearn.learn.equilibrium.parameters import (
    CHANNELS,
    CORRECTIONS,
    FACE,
    FEATURES,
    HARMONICS,
    MIDDLE,
    PLAIN,
    REST,
    STIFF,
    STRESSES,
    TWIST_FLIP,
    TWIST_SIZE,
    VALUES_MIRROR,
    Heads,
    NetworkWeights,
)
from simulearn.mechanics.forces import FLIP, BeamState
from simulearn.mechanics.poses import Array
from simulearn.mechanics.properties import Properties, signs_of
from simulearn.mechanics.topology import FlatGeometry, Topology


class Corrections(NamedTuple):
    """Corrections of each half (2, B), in its own axes.

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


class Features(NamedTuple):
    """The inputs of the network for each half.

    Attributes:
        values: (2, B, F) features of usual size one, in canonical axes.
        angle: (2, B) direction of the half in the plane, rad.
        sign: (2, B) -1 where its actuator is at the bottom, else 1.
        scale: () of lengths; see `FlatGeometry`.
    """

    values: Array
    angle: Array
    sign: Array
    scale: Array


def features_of(
    topology: Topology,
    geometry: FlatGeometry,
    ratio: Array,
    state: BeamState,
    twist: Array,
    s: Array,
    gravity: Array,
    p: Properties,
) -> Features:
    """Return the inputs of the network for a grid in a state of the section model.

    Args:
        topology: how the grid hangs together.
        geometry: the flat grid.
        ratio: (B,) signed actuator ratios.
        state: its poses.
        twist: (2, B, 6) how far the halves are from rest there.
        s: released fraction.
        gravity: multiple of gravity.
        p: numbers of the material.
    """
    size, sign = jnp.abs(ratio), jnp.where(ratio < 0, -1.0, 1.0)

    def both(x: Array) -> Array:
        return jnp.stack([x, x])

    held = (topology.ends == topology.fixed).astype(twist.dtype)
    valence = jnp.zeros(len(geometry.area)).at[topology.ends].add(topology.real)
    one = jnp.ones_like(twist[..., 0])
    # Lengths as in a section of the reference width.
    length, reach = geometry.length / geometry.scale, geometry.reach / geometry.scale
    skew, area = geometry.skew / geometry.scale, geometry.area / geometry.scale**2
    plain = {
        "length": both(length / 50 - 1),
        "ratio": both(size),
        "idle": both((size == 0).astype(twist.dtype)),
        "passive": both((1 - size) * length / 40 - 0.5),
        "active": both(size * length / 40 - 0.5),
        "reach": reach / 2 - 2,
        "skew": skew / 3,
        "far reach": reach[::-1] / 2 - 2,
        "far skew": skew[::-1] / 3,
        "held": held,
        "held over": held * sign,
        "far held": held[::-1],
        "far held over": held[::-1] * sign,
        "area": area[topology.ends] / 30 - 2,
        "valence": valence[topology.ends] - 3,
        "released": one * (2 * s * p.strain - 1),
        "creep": one * (gravity - 1) * 4,
    }
    material = iter(signs_of(p, jnp))
    for name in PLAIN[len(plain) :]:
        value = next(material) * one
        plain[name] = value * sign if name == "curl over" else value
    flip = jnp.where(sign[:, None] < 0, TWIST_FLIP, 1.0)
    own = twist / _scaled(TWIST_SIZE, geometry.scale) * flip
    above = state.joints.R[topology.ends][..., 2, :]
    above = jnp.einsum("hbji,hbj->hbi", geometry.frame, above)
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
    angle = jnp.arctan2(geometry.frame[..., 1, 0], geometry.frame[..., 0, 0])
    return Features(values, angle, both(sign), geometry.scale)


def _scaled(twist: Any, scale: Array) -> Array:
    """Return twists (..., 6) with their translations multiplied by a scale."""
    return twist * jnp.where(jnp.arange(6) < 3, scale, 1.0)


def initial_weights(
    key: Array, heads: Heads = CORRECTIONS, width: int = 64, message: int = 16, rounds: int = 2
) -> NetworkWeights:
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
    return NetworkWeights(encode, passing, decode)


def corrections(weights: NetworkWeights, topology: Topology, features: Features) -> Corrections:
    """Return the corrections of each half."""
    out = outputs(weights, topology, features, CORRECTIONS)
    shape = (*out.shape[:-1], 4, 3)
    face, middle = out[..., FACE].reshape(shape), out[..., MIDDLE].reshape(shape)
    rest = _scaled(out[..., REST], features.scale)
    return Corrections(rest, out[..., STIFF], face * features.scale, middle * features.scale)


def stresses(weights: NetworkWeights, topology: Topology, features: Features) -> Array:
    """Return the elastic stress of each half near its face and its middle: (2, B, 2, 4, 6) MPa."""
    out = outputs(weights, topology, features, STRESSES)
    return out.reshape(*out.shape[:-1], 2, 4, 6)


def outputs(weights: NetworkWeights, topology: Topology, features: Features, heads: Heads) -> Array:
    """Return the outputs of the network: the mean over a design and its mirror image."""
    values = features.values.astype(jnp.float32)
    angle, sign = features.angle.astype(jnp.float32), features.sign.astype(jnp.float32)
    here = _network(weights, topology, values, angle, sign)
    there = _network(weights, topology, values * VALUES_MIRROR.astype(np.float32), -angle, sign)
    order, signs = heads.mirror
    out = (here + there[..., order] * signs.astype(np.float32)) / 2
    order, signs = heads.flip
    out = jnp.where(sign[..., None] < 0, out[..., order] * signs.astype(np.float32), out)
    return out.astype(jnp.float64) * heads.size


def _network(
    weights: NetworkWeights, topology: Topology, values: Array, angle: Array, sign: Array
) -> Array:
    act = jax.nn.silu
    x = values
    for matrix, bias in weights.encode:
        x = act(x @ matrix + bias)
    for (into, shift), (matrix, bias) in weights.rounds:
        messages = act(x @ into + shift)
        inputs = jnp.concatenate([x, x[::-1], _around(topology, messages, angle, sign)], -1)
        x = x + act(inputs @ matrix + bias)
    (matrix, bias), (last, end) = weights.decode
    return act(x @ matrix + bias) @ last + end


def _around(topology: Topology, messages: Array, angle: Array, sign: Array) -> Array:
    """Return the messages of the other halves at the same joint, by harmonics of the angle to them.

    Sums over a joint in fixed axes, turned into each half's, less its own part.
    """
    waves = [jnp.ones_like(angle)]
    for k in range(1, HARMONICS + 1):
        waves += [jnp.cos(k * angle), jnp.sin(k * angle)]
    wave = jnp.stack(waves, -1)  # (2, B, 1 + 2 H)
    both = jnp.stack([jnp.ones_like(sign), sign], -1) * topology.real.astype(sign.dtype)[:, None]
    waves_of = messages[..., None, None, :] * wave[..., :, None, None] * both[..., None, :, None]
    joints = topology.before.shape[0]
    total = jnp.zeros((joints, *waves_of.shape[2:]), messages.dtype).at[topology.ends].add(waves_of)
    others = (total[topology.ends] - waves_of) * both[..., None, :, None]
    parts = [others[..., 0, :, :]]
    for k in range(1, HARMONICS + 1):
        c, s = others[..., 2 * k - 1, :, :], others[..., 2 * k, :, :]
        cos, sin = (wave[..., 2 * k - 1 + i, None, None] for i in (0, 1))
        parts += [cos * c + sin * s, cos * s - sin * c]
    received = jnp.concatenate([part.reshape(*angle.shape, -1) for part in parts], -1)
    return received / 2
