"""Elimination front by front solves the same system as a sparse solver."""

import numpy as np
import pytest
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.linalg import spsolve

import ladder
from simulearn.fea import COARSE, Layout, Solid, mesh
from simulearn.fea.kernels import entries
from simulearn.fea.laws import law_of
from simulearn.fea.problem import EquilibriumProblem
from simulearn.grid import Grid, drop_beams, make

LAW = law_of(ladder.PLA.law)
CASES = {
    "2x2": (make("saddle"), COARSE),
    "3x3": (make("dome", (3, 3)), COARSE),
    "1x2, six slabs": (make("dome", (1, 2)), Layout(slabs=6)),
    "1x1, three across": (make("dome", (1, 1)), Layout(core=1, slabs=4)),
    "1x1, two across, two layers": (make("dome", (1, 1)), Layout(core=2, slabs=4, layers=2)),
    "two beams missing": (drop_beams(make("twist"), [0, 10]), COARSE),
}


def assembled(solid: Solid, u: np.ndarray, released: float) -> tuple[csc_matrix, np.ndarray]:
    """The stiffness of the free unknowns and their numbers."""
    dofs = (3 * solid.bricks[:, :, None] + np.arange(3)).reshape(-1, 60)
    rows, columns = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
    stiffness = ladder.stiffness_of(solid, LAW, u, released)
    K = coo_matrix((stiffness.ravel(), (rows.ravel(), columns.ravel()))).tocsc()
    held = (3 * solid.fixed[:, None] + np.arange(3)).ravel()
    free = np.setdiff1d(np.arange(u.size), held)
    return K[free][:, free], free


def factored(
    solid: Solid, u: np.ndarray, released: float, load: np.ndarray, drag: float = 0.0
) -> tuple[EquilibriumProblem, np.ndarray, int]:
    """The problem with its factors, the step and the number of negative pivots."""
    problem = EquilibriumProblem(solid, LAW, 0.0)
    step, negative = problem.factor(u, released, problem.flat().carried, load, drag, mixed=False)
    return problem, step, negative


@pytest.mark.parametrize(("grid", "layout"), CASES.values(), ids=CASES)
def test_against_a_sparse_solver(grid: Grid, layout: Layout) -> None:
    solid = mesh(grid, ladder.PLA, layout)
    rng = np.random.default_rng(0)
    load, other = rng.normal(size=(2, *solid.nodes.shape))
    u = np.zeros_like(load)
    problem, step, negative = factored(solid, u, 0.1, load)
    K, free = assembled(solid, u, 0.1)
    out = load - entries.internal(LAW, problem.bricks, u, 0.1)[0]
    exact = np.zeros((2, load.size))
    exact[0, free] = spsolve(K, out.ravel()[free])
    exact[1, free] = spsolve(K, other.ravel()[free])
    np.testing.assert_allclose(step.ravel(), exact[0], atol=1e-8 * abs(exact[0]).max())
    # The same factors solve for another load.
    again = problem.solve(other)
    np.testing.assert_allclose(again.ravel(), exact[1], atol=1e-8 * abs(exact[1]).max())
    assert negative == 0


def test_negative_pivots_are_negative_eigenvalues() -> None:
    solid = mesh(make("dome", (1, 1)), ladder.PLA)
    u = np.random.default_rng(1).normal(scale=0.1, size=solid.nodes.shape)
    u[solid.fixed] = 0
    K, _ = assembled(solid, u, 0.5)
    below = int((np.linalg.eigvalsh(K.toarray()) < 0).sum())
    assert below > 0
    assert factored(solid, u, 0.5, np.zeros_like(u))[2] == below


def test_softest_modes_against_a_dense_eigenvalue_solver() -> None:
    solid = mesh(make("dome", (1, 1)), ladder.PLA)
    u = np.zeros_like(solid.nodes)
    problem, _, _ = factored(solid, u, 0.3, u)
    K, free = assembled(solid, u, 0.3)
    mass = np.repeat(problem.mass, 3)[free]
    scaled = K.toarray() / np.sqrt(mass[:, None] * mass)
    exact = np.linalg.eigvalsh((scaled + scaled.T) / 2)
    values, modes = problem.soft_modes(2)
    nearest = exact[np.argsort(abs(exact))[:2]]
    np.testing.assert_allclose(values, nearest, rtol=1e-3)
    mode = modes[0].ravel()[free]
    assert np.linalg.norm(K @ mode - values[0] * mass * mode) < 1e-2 * abs(values[0]) * (
        np.linalg.norm(mass * mode)
    )


def test_drag_stands_on_the_diagonal() -> None:
    solid = mesh(make("flat", (1, 1)), ladder.PLA)
    u = np.zeros_like(solid.nodes)
    load = np.random.default_rng(0).normal(size=u.shape)
    problem, step, _ = factored(solid, u, 0.0, load, drag=1e-3)
    K, free = assembled(solid, u, 0.0)
    exact = spsolve(
        K + csc_matrix(np.diag(1e-3 * np.repeat(problem.mass, 3)[free])), load.ravel()[free]
    )
    np.testing.assert_allclose(step.ravel()[free], exact, atol=1e-8 * abs(exact).max())
