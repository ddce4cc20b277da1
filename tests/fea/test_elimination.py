"""Block elimination solves the same system as a sparse solver."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

import ladder
from simulearn.fea import COARSE, Layout, mesh
from simulearn.fea.elimination import condense, expand, solve_joints
from simulearn.fea.kernel import points_of, respond
from simulearn.fea.laws import law_of
from simulearn.fea.structure import structure_of
from simulearn.grid import Grid, drop_beams, make

CASES = {
    "2x2": (make("saddle"), COARSE, True),
    "2x2 by LU": (make("saddle"), COARSE, False),
    "1x2, six slabs": (make("dome", (1, 2)), Layout(slabs=6), True),
    "1x1, three across": (make("dome", (1, 1)), Layout(core=1, slabs=4), False),
    "two beams missing": (drop_beams(make("twist"), [0, 10]), COARSE, True),
}


@pytest.mark.parametrize(("grid", "layout", "definite"), CASES.values(), ids=CASES)
def test_against_a_sparse_solver(grid: Grid, layout: Layout, definite: bool) -> None:
    solid = mesh(grid, ladder.PLA, layout)
    points, (structure, skeleton) = points_of(solid), structure_of(solid)
    u = np.zeros((len(solid.bricks), 20, 3))
    entries = jax.jit(respond)(law_of(ladder.PLA.law), points, u, 0.1, None).entries
    load = np.random.default_rng(0).normal(size=solid.nodes.shape)

    c = jax.jit(condense, static_argnums=3)(structure, entries, jnp.asarray(load), definite)
    joints, stable = solve_joints(
        skeleton,
        np.array(c.blocks),
        np.asarray(c.beams),
        np.asarray(c.rest),
        load[structure.blocks].reshape(len(structure.blocks), -1),
    )
    found = np.asarray(expand(structure, c.levels, joints, len(load)))

    dofs = (3 * solid.bricks[:, :, None] + np.arange(3)).reshape(-1, 60)
    rows, columns = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
    K = coo_matrix((ladder.full(np.asarray(entries)).ravel(), (rows.ravel(), columns.ravel())))
    free = np.setdiff1d(np.arange(load.size), (3 * solid.fixed[:, None] + np.arange(3)).ravel())
    exact = np.zeros(load.size)
    exact[free] = spsolve(K.tocsc()[free][:, free], load.ravel()[free])
    np.testing.assert_allclose(found.ravel(), exact, atol=1e-8 * abs(exact).max())
    assert stable
