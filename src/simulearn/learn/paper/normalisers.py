"""Normalisers fitted to a data set: what each network will see, over trials, frames and turns."""

from collections.abc import Sequence
from typing import Any

import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import NDArray

from simulearn.dataset import Batch
from simulearn.dataset.augment import turned
from simulearn.dataset.features import edge_features, node_features
from simulearn.learn.paper.graph import Pairs, graph_of
from simulearn.learn.paper.network import Normalisers
from simulearn.learn.paper.normaliser import fit, placed
from simulearn.schedule import SCHEDULE

STEPS_HELD = 0.99999  # of the variance of increments, by their components
MOST = 200  # trials that suffice: each has tens of pairs in ten frames

Features = NDArray[Any]


def normalisers(
    batches: Sequence[Batch], variance: Sequence[float], seed: int, aligned: bool = False
) -> tuple[Normalisers, Normalisers]:
    """Return the normalisers of stage 1 and of stage 2.

    Args:
        batches: trials to learn from, of any topologies.
        variance: the part of it that components hold, of geometry and of stress.
        seed: of the trials that are looked at, and of their turns.
        aligned: whether trials are aligned and are turned by quarters only.
    """
    rng = np.random.default_rng(seed)
    share = min(1.0, MOST / sum(map(len, batches)))
    drawn = []
    for batch in batches:
        count = max(1, round(share * len(batch)))
        few = batch.take(np.sort(rng.permutation(len(batch))[:count]))
        angles = rng.uniform(0, 2 * np.pi, count)
        drawn.append(turned(few, np.round(angles / (np.pi / 2)) * np.pi / 2 if aligned else angles))
    return _stage(drawn, slice(0, SCHEDULE.steps + 1), True, variance), _stage(
        drawn, slice(SCHEDULE.steps, SCHEDULE.frames), False, variance
    )


def _stage(
    batches: Sequence[Batch], frames: slice, stress: bool, variance: Sequence[float]
) -> Normalisers:
    """Return the normalisers of a stage; its last frame is only stepped to."""
    examples: list[list[Features]] = [[], [], [], []]
    steps: tuple[list[Features], list[Features]] = ([], [])
    for batch in batches:
        shape = graph_of(batch.beams, batch.flat.shape[1], batch.fixed)
        # (T, F, N, n) with elements first
        joints = np.moveaxis(node_features(batch)[:, frames], 2, 0)
        beams = np.moveaxis(edge_features(batch, stress)[:, frames], 2, 0)
        steps[0].append(_steps(joints)[..., 3:27].reshape(-1, 24))
        moved = _steps(beams)[..., 3 : 135 if stress else 39]
        steps[1].append(moved.reshape(-1, moved.shape[-1]))
        now = joints[:, :, :-1], beams[:, :, :-1]
        examples[0].append(_moved(shape.beams, now[1], now[0]))
        examples[1].append(_moved(shape.joints, now[0], now[1]))
        for k, x in zip((2, 3), now, strict=True):
            local = x - x[..., :3] @ placed(x.shape[-1]).astype(x.dtype)
            examples[k].append(local.reshape(-1, x.shape[-1]))
    node, edge = (examples[k][0].shape[-1] for k in (2, 3))
    lengths = ((edge, node, edge), (node, edge, node), (node,), (edge,))
    pairs, through_beam, joint, beam = (
        fit(np.concatenate(x), n, variance) for x, n in zip(examples, lengths, strict=True)
    )
    moves = [np.concatenate(x).astype(np.float64) for x in steps]
    unit = [np.sqrt((x**2).mean()) if x.size else 1.0 for x in (moves[1][:, :36], moves[1][:, 36:])]
    return Normalisers(
        pairs,
        through_beam,
        joint,
        beam,
        _spread(moves[0]),
        _spread(moves[1]),
        jnp.asarray(unit, jnp.float32),
    )


def _steps(x: Features) -> Features:
    return np.diff(x, axis=2)


def _moved(pairs: Pairs, outer: Features, inner: Features) -> Features:
    """Return pairs moved to the centres of their conduits, as (P T F, n)."""
    sender, conduit, receiver = (np.asarray(m).argmax(axis=1) for m in pairs)
    origin = inner[conduit][..., :3]
    parts = [
        x - origin @ placed(x.shape[-1]).astype(x.dtype)
        for x in (outer[sender], inner[conduit], outer[receiver])
    ]
    joined = np.concatenate(parts, axis=-1)
    return joined.reshape(-1, joined.shape[-1])


def _spread(moves: NDArray[np.float64]) -> Array:
    """Return the principal components of increments (M, n), those of positions and stress apart.

    Rotations of a joint move its corners by a tenth of what its translation does; given as
    components, they are answered as precisely.
    """
    rows = []
    for group in (slice(0, 36), slice(36, None)):
        part = moves[:, group]
        if not part.shape[1]:
            continue
        values, vectors = np.linalg.eigh(part.T @ part / len(part))
        values, vectors = values[::-1].clip(0), vectors[:, ::-1]
        count = 1 + int(np.searchsorted(np.cumsum(values) / values.sum(), STEPS_HELD))
        components = np.zeros((min(count, len(values)), moves.shape[1]))
        components[:, group] = (vectors * np.sqrt(values)).T[:count]
        rows.append(components)
    return jnp.asarray(np.concatenate(rows), jnp.float32)
