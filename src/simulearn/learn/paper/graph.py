"""A grid as a graph: which elements act on which, and through what.

Beams act on beams through the joint they share, joints on joints through the beam between them
(the pairs of Algorithm 1). Elements come first in all arrays and designs second, so that gathering
and summing are products with small incidence matrices.
"""

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import NDArray

from simulearn.dataset.features import MODES


class Pairs(NamedTuple):
    """P interactions: a sender acts on a receiver through a conduit.

    Attributes:
        sender: (P, S) incidence of the senders, one 1 in each row.
        conduit: (P, C) of the conduits.
        receiver: (P, S) of the receivers.
    """

    sender: Array
    conduit: Array
    receiver: Array


class Graph(NamedTuple):
    """The pairs of a graph of J joints and B beams.

    Attributes:
        beams: pairs of beams through a joint.
        joints: pairs of joints through a beam.
        moves: (J, 1, 8, 1) 0 for the corners that are held (the fixed joint's lower ones), else 1.
        fixed: (1, J) incidence of the fixed joint.
    """

    beams: Pairs
    joints: Pairs
    moves: Array
    fixed: Array


class Meetings(NamedTuple):
    """How the elements of T designs meet, (P, T, 32): modes of sender and of receiver, one-hot."""

    beams: Array
    joints: Array


def graph_of(beams: NDArray[np.int64], joints: int, fixed: int) -> Graph:
    """Return the topology of a grid.

    Args:
        beams: (B, 2) joint indices.
        joints: how many there are.
        fixed: the fixed one.
    """
    through_joint, through_beam = _triples(beams)
    moves = np.ones((joints, 1, 8, 1), np.float32)
    moves[fixed, :, :4] = 0
    return Graph(
        _pairs([(a, j, b) for (a, _), j, (b, _) in through_joint], len(beams), joints),
        _pairs([(a, b, c) for (b, _), a, c in through_beam], joints, len(beams)),
        jnp.asarray(moves),
        jnp.asarray(np.eye(joints, dtype=np.float32)[[fixed]]),
    )


def meetings(beams: NDArray[np.int64], modes: NDArray[np.int64]) -> Meetings:
    """Return how elements meet.

    Args:
        beams: (B, 2) joint indices.
        modes: (T, B, 2) adjacency modes of the beams' ends.
    """
    through_joint, through_beam = _triples(beams)
    hot = (modes[..., None] == np.arange(1, MODES + 1)).astype(np.float32)

    def both(first: list[tuple[int, int]], second: list[tuple[int, int]]) -> Array:
        a, b = (np.array(ends, np.int64).reshape(-1, 2).T for ends in (first, second))
        pair = np.concatenate([hot[:, a[0], a[1]], hot[:, b[0], b[1]]], axis=-1)
        return jnp.asarray(pair.swapaxes(0, 1))

    return Meetings(
        both([a for a, _, _ in through_joint], [b for _, _, b in through_joint]),
        both(
            [(b, end) for (b, end), _, _ in through_beam],
            [(b, 1 - end) for (b, end), _, _ in through_beam],
        ),
    )


End = tuple[int, int]  # (beam, 0) is the start of a beam, (beam, 1) its end


def _triples(
    beams: NDArray[np.int64],
) -> tuple[list[tuple[End, int, End]], list[tuple[End, int, int]]]:
    """Return (sender, joint, receiver) of beams, and ((beam, end of sender), sender, receiver)."""
    ends = [(b, end) for b in range(len(beams)) for end in range(2)]
    at: dict[int, list[End]] = {}
    for b, end in ends:
        at.setdefault(int(beams[b, end]), []).append((b, end))
    through_joint = [
        (first, joint, second)
        for joint, meeting in sorted(at.items())
        for first in meeting
        for second in meeting
        if first != second
    ]
    through_beam = [((b, end), int(beams[b, end]), int(beams[b, 1 - end])) for b, end in ends]
    return through_joint, through_beam


def _pairs(triples: list[tuple[int, int, int]], elements: int, conduits: int) -> Pairs:
    index = np.array(triples, np.int64).reshape(-1, 3)
    outer, inner = np.eye(elements, dtype=np.float32), np.eye(conduits, dtype=np.float32)
    return Pairs(
        jnp.asarray(outer[index[:, 0]]),
        jnp.asarray(inner[index[:, 1]]),
        jnp.asarray(outer[index[:, 2]]),
    )
