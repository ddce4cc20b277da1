"""Solving the linear system of a grid by block elimination along its own structure.

Inside a beam only neighbouring slabs know each other, so all slabs of all beams are eliminated
together, level by level: first the nodes inside each slab, then every second face, until a beam is
one dense block between its two joints. What is left couples joints along the beams; they are
eliminated one by one, those with the fewest neighbours first. Everything is small dense algebra in
batches: no sparse solver, and no symbolic analysis to keep.
"""

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array

from simulearn.fea.structure import Skeleton, Structure


class Level(NamedTuple):
    """Unknowns that were eliminated: x = f - X (what they are coupled to)."""

    X: Array
    f: Array


class Condensed(NamedTuple):
    """The system on the joints' nodes, and how to come back to all others.

    Attributes:
        blocks: (J, 3 n, 3 n) stiffness of the joints alone, N/mm.
        beams: (B, 6 f, 6 f) stiffness of the beams on their end faces.
        rest: (B, 6 f) forces of the beams on their end faces, N.
        levels: what was eliminated, insides of slabs first, then faces.
    """

    blocks: Array
    beams: Array
    rest: Array
    levels: list[Level]


def condense(s: Structure, entries: Array, load: Array) -> Condensed:
    """Eliminate everything but the joints.

    Args:
        s: structure of the solid.
        entries: (E, 6, 20, 20) stiffness of the bricks for PAIRS of components, joints first.
        load: (N, 3) N.
    """
    beams, slabs, _ = s.insides.shape
    face = 3 * s.faces.shape[2]
    blocks = _gather(entries[: s.joint_bricks], s.joint, len(s.blocks))
    K = _gather(entries[s.joint_bricks :], s.slab, beams * slabs)
    K = K.reshape(beams, slabs, *K.shape[1:])

    outer, inner = slice(0, 2 * face), slice(2 * face, None)
    f = load[s.insides].reshape(beams, slabs, -1)
    level = _eliminate(K[..., inner, inner], K[..., inner, outer], f)
    K, r = (
        K[..., outer, outer] - K[..., outer, inner] @ level.X,
        -jnp.einsum("bsij,bsj->bsi", K[..., outer, inner], level.f),
    )
    levels = [level]
    left, right = slice(0, face), slice(face, None)
    for middle, _, _ in _rounds(slabs):
        odd = 2 * len(middle)
        a, b, ra, rb = K[:, :odd:2], K[:, 1:odd:2], r[:, :odd:2], r[:, 1:odd:2]
        f = load[s.faces[:, middle]].reshape(beams, len(middle), face)
        coupling = jnp.concatenate([a[..., right, left], b[..., left, right]], axis=-1)
        level = _eliminate(
            a[..., right, right] + b[..., left, left], coupling, f + ra[..., right] + rb[..., left]
        )
        merged = -coupling.swapaxes(-1, -2) @ level.X
        merged = merged.at[..., left, left].add(a[..., left, left])
        merged = merged.at[..., right, right].add(b[..., right, right])
        rest = jnp.concatenate([ra[..., left], rb[..., right]], axis=-1)
        rest -= jnp.einsum("bpij,bpi->bpj", coupling, level.f)
        levels.append(level)
        K = jnp.concatenate([merged, K[:, odd:]], axis=1)
        r = jnp.concatenate([rest, r[:, odd:]], axis=1)
    return Condensed(blocks, K[:, 0], r[:, 0], levels)


def expand(s: Structure, levels: list[Level], joints: Array, nodes: int) -> Array:
    """Return the displacements (N, 3) of all nodes from those of the joints' nodes (J, n, 3)."""
    beams, slabs, _ = s.insides.shape
    u = jnp.zeros((nodes, 3)).at[s.blocks].set(joints)
    rounds = _rounds(slabs)
    for level, (middle, before, after) in zip(levels[:0:-1], rounds[::-1], strict=True):
        ends = jnp.concatenate([u[s.faces[:, before]], u[s.faces[:, after]]], axis=2)
        x = level.f - jnp.einsum("bpij,bpj->bpi", level.X, ends.reshape(*level.f.shape[:2], -1))
        u = u.at[s.faces[:, middle]].set(x.reshape(beams, len(middle), -1, 3))
    ends = jnp.concatenate([u[s.faces[:, :-1]], u[s.faces[:, 1:]]], axis=2)
    x = levels[0].f - jnp.einsum("bsij,bsj->bsi", levels[0].X, ends.reshape(beams, slabs, -1))
    return u.at[s.insides].set(x.reshape(*s.insides.shape, 3))


def solve_joints(
    s: Skeleton, blocks: np.ndarray, condensed: Condensed, load: np.ndarray
) -> np.ndarray:
    """Return the displacements (J, n, 3) of the joints' nodes; the held ones stay.

    Args:
        s: the skeleton.
        blocks: (J, 3 n, 3 n) stiffness of the joints, overwritten.
        condensed: the beams.
        load: (J, 3 n) forces on the joints' nodes, overwritten.
    """
    beams, rest = np.asarray(condensed.beams), np.asarray(condensed.rest)
    size, face = blocks.shape[1], beams.shape[1] // 2
    between: dict[tuple[int, int], np.ndarray] = {}
    for b, (i, j) in enumerate(s.ends):
        p, q = s.seats[b]
        blocks[i][np.ix_(p, p)] += beams[b, :face, :face]
        blocks[j][np.ix_(q, q)] += beams[b, face:, face:]
        load[i, p] += rest[b, :face]
        load[j, q] += rest[b, face:]
        coupling = np.zeros((size, size))
        coupling[np.ix_(p, q)] = beams[b, :face, face:]
        if i == s.fixed:
            coupling[s.held] = 0
        if j == s.fixed:
            coupling[:, s.held] = 0
        between[i, j], between[j, i] = coupling, coupling.T
    blocks[s.fixed][s.held] = 0
    blocks[s.fixed][:, s.held] = 0
    blocks[s.fixed][s.held, s.held] = 1
    load[s.fixed, s.held] = 0

    done = []
    left = set(s.order)
    for i in s.order:
        left.discard(i)
        near = [j for j in left if (i, j) in between]
        wide = np.concatenate([between[i, j] for j in near] + [load[i][:, None]], axis=1)
        X = np.linalg.solve(blocks[i], wide)
        done.append((i, near, X))
        change = wide[:, :-1].T @ X
        for a, j in enumerate(near):
            rows = slice(a * size, (a + 1) * size)
            load[j] -= change[rows, -1]
            blocks[j] -= change[rows, rows]
            for c, k in enumerate(near):
                if j != k:
                    part = change[rows, c * size : (c + 1) * size]
                    between[j, k] = between[j, k] - part if (j, k) in between else -part
    u = np.zeros((len(blocks), size))
    for i, near, X in reversed(done):
        u[i] = X[:, -1] - X[:, :-1] @ u[near].reshape(-1)
    return u.reshape(len(blocks), -1, 3)


def _rounds(slabs: int) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Return, round by round, the faces that are eliminated and those before and after each."""
    rounds = []
    faces = np.arange(slabs + 1)
    while len(faces) > 2:
        odd = 2 * ((len(faces) - 1) // 2)
        rounds.append((faces[1:odd:2], faces[:odd:2], faces[2 : odd + 1 : 2]))
        faces = np.concatenate([faces[: odd + 1 : 2], faces[odd + 1 :]])
    return rounds


def _gather(entries: Array, table: Array, parts: int) -> Array:
    flat = entries.reshape(parts, -1)
    flat = jnp.concatenate([flat, jnp.zeros((parts, 1))], axis=1)
    return flat[:, table].sum(axis=1)


def _eliminate(K: Array, coupling: Array, f: Array) -> Level:
    both = jnp.linalg.solve(K, jnp.concatenate([coupling, f[..., None]], axis=-1))
    return Level(both[..., :-1], both[..., -1])
