"""Interaction networks: Algorithm 1 of the paper, two in sequence to make an engine.

The first gives every joint and beam a latent vector of what all others do to it; the
second sees features and latents together and gives the increments to the next frame.

Yang et al., SimuLearn, UIST 2020, Figures 6 and 7; after Battaglia et al., Interaction networks
for learning about objects, relations and physics, NeurIPS 2016.
"""

from collections.abc import Sequence
from itertools import accumulate
from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from simulearn.dataset.features import EDGE, EDGE_PLAIN, MODES, NODE
from simulearn.learn.paper.graph import Graph, Meetings, Pairs
from simulearn.learn.paper.normaliser import Normaliser
from simulearn.learn.paper.state import GraphState, centres, features

ACTIVATIONS = {"relu": jax.nn.relu, "silu": jax.nn.silu}


class Sizes(NamedTuple):
    """Widths of an engine's networks.

    Attributes:
        hidden: of the hidden layers, falling.
        interaction: of the interaction vectors of beams and of joints.
        latent: of the latent vectors of beams and of joints.
        activation: of the hidden layers, one of ACTIVATIONS.
    """

    hidden: tuple[int, ...]
    interaction: tuple[int, int]
    latent: tuple[int, int]
    activation: str


class Normalisers(NamedTuple):
    """The normalisers of the four networks of an interaction network, and of the increments.

    Attributes:
        through_joint: of a beam, a joint and a beam; through_beam: of a joint, a beam and a joint.
        joint, beam: of single elements.
        joint_step, beam_step: (K, 24), (K, 36 + 96 or 0) principal components of the increments,
            each as long as its standard deviation, so that networks answer with unit variance.
        unit: (2,) root mean square of an increment of position, mm, and of stress, MPa.
    """

    through_joint: Normaliser
    through_beam: Normaliser
    joint: Normaliser
    beam: Normaliser
    joint_step: Array
    beam_step: Array
    unit: Array

    @property
    def sizes(self) -> list[int]:
        """How many components the four normalisers and the increments of both kinds have."""
        return [*(n.size for n in self[:4]), len(self.joint_step), len(self.beam_step)]


class MLP(eqx.Module):
    """A multilayer perceptron on the last axis."""

    weights: list[Array]
    biases: list[Array]
    activation: str = eqx.field(static=True)

    def __init__(self, sizes: Sequence[int], activation: str, key: Array, last: float = 1.0):
        keys = jax.random.split(key, len(sizes) - 1)
        gains = [2.0] * (len(sizes) - 2) + [last]
        self.weights = [
            jnp.sqrt(jnp.float32(gain / a)) * jax.random.normal(k, (a, b), jnp.float32)
            for a, b, k, gain in zip(sizes, sizes[1:], keys, gains, strict=False)
        ]
        self.biases = [jnp.zeros(b, jnp.float32) for b in sizes[1:]]
        self.activation = activation

    def __call__(self, x: Array) -> Array:
        """Return the output of inputs (..., n)."""
        return self.after_first(x @ self.weights[0] + self.biases[0])

    def after_first(self, x: Array) -> Array:
        """Return the output of what the first layer makes before its activation."""
        act = ACTIVATIONS[self.activation]
        for weight, bias in zip(self.weights[1:], self.biases[1:], strict=True):
            x = act(x) @ weight + bias
        return x


class PairInputs(NamedTuple):
    """Normalised pairs, in parts that are still to be added up for each pair.

    Attributes:
        sender, conduit, receiver: (S, T, K) or (C, T, K) what each element contributes.
        away: (P, T, 6) of sender and receiver from the conduit, mm.
        shift: (6, K) what that adds.
        offset: (K,).
    """

    sender: Array
    conduit: Array
    receiver: Array
    away: Array
    shift: Array
    offset: Array


class Interaction(eqx.Module):
    """An interaction network: pairs act through conduits, elements sum what acts on them."""

    through_joint: MLP
    through_beam: MLP
    joint: MLP
    beam: MLP

    def __init__(
        self,
        normalised: tuple[int, int, int, int],
        latent: tuple[int, int],
        out: tuple[int, int],
        sizes: Sizes,
        key: Array,
        last: float,
    ):
        """Draw weights.

        Args:
            normalised: components of the four normalisers, in the order of `Normalisers`.
            latent: of the incoming latents of beams and joints.
            out: of the outgoing vectors of beams and joints.
            sizes: widths.
            key: of the weights.
            last: gain of the last layers.
        """
        keys = jax.random.split(key, 4)
        beam, joint = latent
        for_beams, for_joints = sizes.interaction
        widths = (
            normalised[0] + 2 * MODES + 2 * beam + joint,
            normalised[1] + 2 * MODES + 2 * joint + beam,
            normalised[2] + joint + for_joints,
            normalised[3] + beam + for_beams,
        )
        outputs = (for_beams, for_joints, out[1], out[0])
        gains = (1.0, 1.0, last, last)
        self.through_joint, self.through_beam, self.joint, self.beam = (
            MLP((a, *sizes.hidden, b), sizes.activation, k, gain)
            for a, b, k, gain in zip(widths, outputs, keys, gains, strict=True)
        )

    def __call__(
        self,
        inputs: tuple[PairInputs, PairInputs, Array, Array],
        latent: tuple[Array, Array],
        topology: Graph,
        meetings: Meetings,
    ) -> tuple[Array, Array]:
        """Return the outgoing vectors of beams (B, T, n) and joints (J, T, m).

        Args:
            inputs: normalised pairs through joints, pairs through beams, joints and beams.
            latent: incoming latent vectors of beams and joints.
            topology: the pairs.
            meetings: their adjacency modes.
        """
        beams, joints = latent
        on_beams = _acted(
            self.through_joint, topology.beams, inputs[0], meetings.beams, beams, joints
        )
        on_joints = _acted(
            self.through_beam, topology.joints, inputs[1], meetings.joints, joints, beams
        )
        return (
            self.beam(jnp.concatenate([inputs[3], beams, on_beams], axis=-1)),
            self.joint(jnp.concatenate([inputs[2], joints, on_joints], axis=-1)),
        )


class DoubleInteraction(eqx.Module):
    """Two interaction networks in sequence: a state in, the next one out."""

    first: Interaction
    second: Interaction
    normalisers: Normalisers

    def __init__(self, normalisers: Normalisers, sizes: Sizes, key: Array):
        inputs = tuple(n.size for n in normalisers[:4])
        assert len(inputs) == 4
        a, b = jax.random.split(key)
        out = (len(normalisers.beam_step), len(normalisers.joint_step))
        self.first = Interaction(inputs, (0, 0), sizes.latent, sizes, a, 1.0)
        self.second = Interaction(inputs, sizes.latent, out, sizes, b, 1e-2)
        self.normalisers = normalisers

    def __call__(
        self, state: GraphState, ratio: Array, topology: Graph, meetings: Meetings
    ) -> GraphState:
        """Return the next frame.

        Args:
            state: of T grids; with stress in stage 1, without in stage 2.
            ratio: (B, T, 1) actuators.
            topology: the pairs.
            meetings: their adjacency modes.
        """
        norm = jax.lax.stop_gradient(self.normalisers)
        joints, beams = features(state, ratio, topology)
        where = centres(state.joints), centres(state.sections)
        inputs = (
            _normalised(norm.through_joint, topology.beams, beams, joints, where[1], where[0]),
            _normalised(norm.through_beam, topology.joints, joints, beams, where[0], where[1]),
            norm.joint.element(joints, where[0]),
            norm.beam.element(beams, where[1]),
        )
        none = joints[..., :0], beams[..., :0]
        latent = self.first(inputs, (none[1], none[0]), topology, meetings)
        of_beams, of_joints = self.second(inputs, latent, topology, meetings)
        of_beams, of_joints = of_beams @ norm.beam_step, of_joints @ norm.joint_step
        held = jnp.broadcast_to(topology.moves, (*topology.moves.shape[:3], 3))
        return GraphState(
            state.joints + of_joints * held.reshape(len(held), 1, 24),
            state.sections + of_beams[..., :36],
            state.stress + of_beams[..., 36:],
        )


def _incident(matrix: Array, x: Array) -> Array:
    """Return matrix (P, N) times x (N, T, K): a gather, or a sum."""
    return (matrix @ x.reshape(len(x), -1)).reshape(len(matrix), *x.shape[1:])


def _acted(
    network: MLP, pairs: Pairs, inputs: PairInputs, meeting: Array, outer: Array, inner: Array
) -> Array:
    """Return the sum (S, T, K) of what acts on each receiver.

    The input of the network is [normalised pair, modes, latents of sender, conduit, receiver].
    Its first layer is linear in each of them, so it is applied to the elements, which are fewer
    than the pairs, and gathered afterwards.
    """
    sizes = (x.shape[-1] for x in (inputs.offset, meeting, outer, inner))
    weight, bias = network.weights[0], network.biases[0]
    of_pair, of_mode, *of_latent = jnp.split(weight, list(accumulate(sizes)))
    parts = zip(
        pairs,
        (inputs.sender, inputs.conduit, inputs.receiver),
        (outer, inner, outer),
        of_latent,
        strict=True,
    )
    first = (
        inputs.away @ (inputs.shift @ of_pair)
        + meeting @ of_mode
        + (inputs.offset @ of_pair + bias)
    )
    for incidence, element, latent, of_one in parts:
        first += _incident(incidence, element @ of_pair + latent @ of_one)
    return _incident(pairs.receiver.T, network.after_first(first))


def _normalised(
    norm: Normaliser, pairs: Pairs, outer: Array, inner: Array, outers: Array, inners: Array
) -> PairInputs:
    """Return pairs relative to the centres of their conduits.

    Each element contributes its part of the map from its own centre; the rest is what the
    distances of sender and receiver from the conduit add.
    """
    n, m = outer.shape[-1], inner.shape[-1]
    parts = jnp.split(norm.matrix, [n, n + m])
    shifts = [_shift(part, k) for part, k in zip(parts, (n, m, n), strict=True)]
    sender, conduit, receiver = (
        x @ part - centre @ shift
        for x, centre, part, shift in zip(
            (outer, inner, outer), (outers, inners, outers), parts, shifts, strict=True
        )
    )
    at = _incident(pairs.conduit, inners)
    away = [_incident(pairs.sender, outers) - at, _incident(pairs.receiver, outers) - at]
    return PairInputs(
        sender,
        conduit,
        receiver,
        jnp.concatenate(away, axis=-1),
        jnp.concatenate([shifts[0], shifts[2]]),
        norm.offset,
    )


def _shift(part: Array, length: int) -> Array:
    """Return (3, K): what moving an element by 1 mm along x, y, z adds."""
    points = 3 * (1 + (24 if length == NODE else 36) // 3)
    return part[:points].reshape(-1, 3, part.shape[1]).sum(axis=0)


def blank(
    sizes: Sizes, components: tuple[int, int, int, int], steps: tuple[int, int], stress: bool
) -> DoubleInteraction:
    """Return an engine of zeros with the shapes that its arrays will have."""
    edge = EDGE if stress else EDGE_PLAIN
    lengths = (2 * edge + NODE, 2 * NODE + edge, NODE, edge)

    def zeros(*shape: int) -> Array:
        return jnp.zeros(shape, jnp.float32)

    pairs, beams, joint, beam = (
        Normaliser(zeros(n, k), zeros(k), zeros(3, k))
        for n, k in zip(lengths, components, strict=True)
    )
    normalisers = Normalisers(
        pairs,
        beams,
        joint,
        beam,
        zeros(steps[0], 24),
        zeros(steps[1], 36 + (96 if stress else 0)),
        zeros(2),
    )
    return jax.tree.map(
        lambda x: np.zeros(x.shape, x.dtype),
        eqx.filter_eval_shape(DoubleInteraction, normalisers, sizes, jax.random.key(0)),
    )
