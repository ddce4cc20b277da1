"""Solving the linear system of a grid by block elimination along its own structure.

Inside a beam only neighbouring slabs know each other, so all slabs of all beams are eliminated
together, level by level: first the nodes inside each slab, then every second face, until a beam is
one dense block between its two joints. What is left couples joints along the beams; they are
eliminated one by one, those with the fewest neighbours first. Everything is small dense algebra in
batches: no sparse solver, and no symbolic analysis to keep.
"""

from itertools import pairwise
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.lax.linalg import triangular_solve
from numpy.linalg import LinAlgError
from scipy.linalg import cho_factor, cho_solve

from simulearn.fea.structure import Skeleton, Structure


class Level(NamedTuple):
    """Unknowns that were eliminated: factor^T x = f - X (what they are coupled to).

    Attributes:
        factor: lower Cholesky factor; None where x = f - X (...) itself.
        X: the coupling, divided by the factor (or by the whole matrix).
        f: their forces, divided likewise.
    """

    factor: Array | None
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


def condense(s: Structure, entries: Array, load: Array, definite: bool) -> Condensed:
    """Eliminate everything but the joints.

    Args:
        s: structure of the solid.
        entries: (E, 6, 20, 20) stiffness of the bricks for PAIRS of components, joints first.
        load: (N, 3) N.
        definite: whether the matrices are positive definite. That is faster; where they are not,
            the result is not finite.
    """
    beams, slabs, _ = s.insides.shape
    face = 3 * s.faces.shape[2]
    blocks = _gather(entries[: s.joint_bricks], s.joint, len(s.blocks))
    K = _gather(entries[s.joint_bricks :], s.slab, beams * slabs)
    K = K.reshape(beams, slabs, *K.shape[1:])

    outer, inner = slice(0, 2 * face), slice(2 * face, None)
    f = load[s.insides].reshape(beams, slabs, -1)
    level, change, r = _eliminate(K[..., inner, inner], K[..., inner, outer], f, definite)
    K = K[..., outer, outer] - change
    levels = [level]
    left, right = slice(0, face), slice(face, None)
    for middle, _, _ in _rounds(slabs):
        odd = 2 * len(middle)
        a, b, ra, rb = K[:, :odd:2], K[:, 1:odd:2], r[:, :odd:2], r[:, 1:odd:2]
        f = load[s.faces[:, middle]].reshape(beams, len(middle), face)
        level, change, rest = _eliminate(
            a[..., right, right] + b[..., left, left],
            jnp.concatenate([a[..., right, left], b[..., left, right]], axis=-1),
            f + ra[..., right] + rb[..., left],
            definite,
        )
        merged = (-change).at[..., left, left].add(a[..., left, left])
        merged = merged.at[..., right, right].add(b[..., right, right])
        rest += jnp.concatenate([ra[..., left], rb[..., right]], axis=-1)
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
        x = _resolve(level, ends.reshape(*level.f.shape[:2], -1))
        u = u.at[s.faces[:, middle]].set(x.reshape(beams, len(middle), -1, 3))
    ends = jnp.concatenate([u[s.faces[:, :-1]], u[s.faces[:, 1:]]], axis=2)
    x = _resolve(levels[0], ends.reshape(beams, slabs, -1))
    return u.at[s.insides].set(x.reshape(*s.insides.shape, 3))


def solve_joints(
    s: Skeleton, blocks: np.ndarray, beams: np.ndarray, rest: np.ndarray, load: np.ndarray
) -> tuple[np.ndarray, bool]:
    """Solve for the joints' nodes; the held ones stay.

    Args:
        s: the skeleton.
        blocks: (J, 3 n, 3 n) stiffness of the joints alone; overwritten.
        beams: (B, 6 f, 6 f) stiffness of the beams on their end faces.
        rest: (B, 6 f) forces of the beams on their end faces.
        load: (J, 3 n) forces on the joints' nodes; overwritten.

    Returns:
        displacements (J, n, 3), and whether the system is positive definite.

    Raises:
        numpy.linalg.LinAlgError: the stiffness is singular.
    """
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
    definite = True
    left = set(s.order)
    for i in s.order:
        left.discard(i)
        near = [j for j in left if (i, j) in between]
        # Beams touch only the nodes of a face.
        touched = [np.flatnonzero(between[i, j].any(axis=0)) for j in near]
        wide = [between[i, j][:, t] for j, t in zip(near, touched, strict=True)]
        all_ = np.concatenate([*wide, load[i][:, None]], axis=1)
        try:
            X = cho_solve(cho_factor(blocks[i], lower=True, check_finite=False), all_)
        except LinAlgError:
            definite = False
            X = np.linalg.solve(blocks[i], all_)
        done.append((i, near, touched, X))
        change = all_[:, :-1].T @ X
        cuts = np.cumsum([0, *map(len, touched)])
        rows = [slice(*pair) for pair in pairwise(cuts)]
        for a, j in enumerate(near):
            load[j, touched[a]] -= change[rows[a], -1]
            blocks[j][np.ix_(touched[a], touched[a])] -= change[rows[a], rows[a]]
            for c, k in enumerate(near[:a]):
                if (j, k) not in between:
                    between[j, k] = np.zeros((size, size))
                    between[k, j] = between[j, k].T  # a view: both change together
                between[j, k][np.ix_(touched[a], touched[c])] -= change[rows[a], rows[c]]
    u = np.zeros((len(blocks), size))
    for i, near, touched, X in reversed(done):
        others = [u[j, t] for j, t in zip(near, touched, strict=True)]
        u[i] = X[:, -1] - X[:, :-1] @ np.concatenate([*others, []])
    return u.reshape(len(blocks), -1, 3), definite


def _rounds(slabs: int) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Return, round by round, the faces that are eliminated and those before and after each."""
    rounds = []
    faces = np.arange(slabs + 1)
    while len(faces) > 2:
        odd = 2 * ((len(faces) - 1) // 2)
        rounds.append((faces[1:odd:2], faces[:odd:2], faces[2 : odd + 1 : 2]))
        faces = np.concatenate([faces[: odd + 1 : 2], faces[odd + 1 :]])
    return rounds


def _gather(entries: Array, table: np.ndarray, parts: int) -> Array:
    flat = entries.reshape(parts, -1)
    flat = jnp.concatenate([flat, jnp.zeros((parts, 1))], axis=1)
    total = jnp.zeros((parts, *table.shape[1:]))
    for places in table:
        total += flat.at[:, places].get(mode="promise_in_bounds")
    return total


def _eliminate(K: Array, coupling: Array, f: Array, definite: bool) -> tuple[Level, Array, Array]:
    """Eliminate unknowns with matrices K, coupling to others, and forces f.

    Returns:
        the level, what to subtract from the others' matrices, and what to add to their forces.
    """
    both = jnp.concatenate([coupling, f[..., None]], axis=-1)
    if definite:
        factor = jnp.linalg.cholesky(K, symmetrize_input=False)
        both = triangular_solve(factor, both, left_side=True, lower=True)
        level = Level(factor, both[..., :-1], both[..., -1])
        coupling = level.X
    else:
        both = jnp.linalg.solve(K, both)
        level = Level(None, both[..., :-1], both[..., -1])
    change = coupling.swapaxes(-1, -2) @ both
    return level, change[..., :-1], -change[..., -1]


def _resolve(level: Level, others: Array) -> Array:
    """Return the eliminated unknowns from those that they are coupled to."""
    x = level.f - jnp.einsum("...ij,...j->...i", level.X, others)
    if level.factor is None:
        return x
    return triangular_solve(
        level.factor, x[..., None], left_side=True, lower=True, transpose_a=True
    )[..., 0]
