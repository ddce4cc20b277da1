"""A coarse trial guides a fine one to the same equilibria, and lets go where it cannot."""

import threading

import numpy as np
import pytest

import ladder
from simulearn.errors import CancelledError
from simulearn.fea import COARSE, FINE, Layout, Trial, mesh, simulate_grid, trial
from simulearn.fea.guide import Guide, interpolation
from simulearn.fea.laws import law_of
from simulearn.fea.layout import breaks_of
from simulearn.fea.path import Path
from simulearn.fea.problem import EquilibriumProblem
from simulearn.grid import Grid, make, outline
from simulearn.material import Material

PLA = ladder.PLA
SKEWED = Grid(
    [[0, 0], [60, 5], [65, 60], [-5, 55]],
    [[0, 1], [1, 2], [3, 2], [3, 0]],
    [0.3, -0.62, 1, 0],
    2,
)
STRIP = Grid([[0, 0], [40, 0], [70, 20], [110, 20]], [[0, 1], [1, 2], [2, 3]], [0.5, -0.4, 1], 0)
LITTLE_FINER = Layout(slabs=10)


def curled(curl: float) -> Material:
    """PLA whose top shrinks more than its bottom."""
    shrinkage = PLA.shrinkage.model_copy(update={"curl": curl})
    return PLA.model_copy(update={"shrinkage": shrinkage})


def unguided(grid: Grid, material: Material, layout: Layout, patch: pytest.MonkeyPatch) -> Trial:
    """A trial whose guide knows nothing."""
    with patch.context() as context:
        context.setattr(trial, "guide_of", lambda *_: Guide({}, {}))
        return simulate_grid(grid, material, layout)


@pytest.mark.parametrize("layout", [FINE, Layout(slabs=10, layers=2)], ids=["fine", "odd"])
def test_a_field_that_bricks_can_have_is_interpolated_exactly(layout: Layout) -> None:
    grid = SKEWED.centred
    shape = outline(grid, PLA.section)
    coarse, fine = mesh(grid, PLA), mesh(grid, PLA, layout)
    weights = interpolation(
        coarse,
        breaks_of(grid, shape, PLA.section, COARSE),
        fine,
        breaks_of(grid, shape, PLA.section, layout),
    )
    np.testing.assert_allclose(weights @ coarse.nodes, fine.nodes, atol=1e-10)
    x, _, z = coarse.nodes.T
    at_x, _, at_z = fine.nodes.T
    np.testing.assert_allclose(weights @ (z * x), at_z * at_x, atol=1e-9)
    np.testing.assert_allclose(weights @ (z * z), at_z**2, atol=1e-9)


@pytest.mark.parametrize(
    ("grid", "material"),
    [(SKEWED, PLA), (SKEWED, curled(0.006)), (STRIP, PLA)],
    ids=["odd ratios", "own curl", "open strip"],
)
def test_it_ends_where_the_plain_path_does_in_fewer_iterations(
    grid: Grid, material: Material, monkeypatch: pytest.MonkeyPatch
) -> None:
    guided = simulate_grid(grid, material, FINE)
    plain = unguided(grid, material, FINE, monkeypatch)
    np.testing.assert_allclose(guided.displacements, plain.displacements, atol=1e-5)
    np.testing.assert_allclose(guided.stress, plain.stress, atol=1e-5)
    assert guided.stable
    assert guided.warnings == plain.warnings
    assert guided.record["guide"]["steps"] == 12
    assert guided.record["guide"]["ended"] == ""
    assert sum(guided.record["iterations"]) < 0.8 * sum(plain.record["iterations"])


def test_the_factors_of_beams_reach_the_guide() -> None:
    factors = np.array([1.3, 0.8, 1.1, 1.0])
    steps = simulate_grid(SKEWED, PLA, LITTLE_FINER, factors=factors).record["guide"]["steps"]
    assert steps == 12


def test_an_unstable_balance_is_left_by_the_plain_path(monkeypatch: pytest.MonkeyPatch) -> None:
    guided = simulate_grid(make("dome"), PLA, LITTLE_FINER)
    plain = unguided(make("dome"), PLA, LITTLE_FINER, monkeypatch)
    assert guided.record["guide"]["ended"] == "unstable-balance"
    assert 0 < guided.record["guide"]["steps"] < 12
    assert guided.stable
    assert [message.code for message in guided.warnings] == ["unstable-balance"]
    assert guided.warnings == plain.warnings
    np.testing.assert_allclose(guided.joints, plain.joints, atol=1e-4)


def test_a_guide_that_leads_astray_is_not_followed() -> None:
    problem = EquilibriumProblem(mesh(SKEWED, PLA), law_of(PLA.law), PLA.gravity.body_force)
    right = Path(problem).advance(0.0, 1.0)
    rough = np.random.default_rng(0).normal(scale=2.0, size=right.u.shape)
    moved = right.u + 0.05 * problem.size
    for wrong in (rough, moved):
        path = Path(problem, guide={(0.0, 0.0): np.zeros_like(right.u), (0.0, 1.0): wrong})
        np.testing.assert_allclose(path.advance(0.0, 1.0).u, right.u, atol=1e-5)
        assert path.guided == 0
    path = Path(problem, guide={(0.0, 0.0): np.zeros_like(right.u), (0.0, 1.0): right.u})
    path.advance(0.0, 1.0)
    assert path.guided == 1


def test_only_finer_meshes_have_a_guide() -> None:
    assert FINE.finer(COARSE)
    assert Layout(layers=2).finer(COARSE)
    for other in (COARSE, Layout(slabs=4), Layout(core=2, slabs=6)):
        assert not other.finer(COARSE)
    assert "guide" not in simulate_grid(make("flat", (1, 1)), PLA).record


def test_frames_of_the_guide_are_reported_and_can_be_cancelled() -> None:
    grid = make("flat", (1, 1))
    heard: list[tuple[int, int]] = []
    simulate_grid(grid, PLA, LITTLE_FINER, progress=lambda k, n: heard.append((k, n)))
    assert heard == [(k, 24) for k in range(1, 25)]
    for most in (3, 15):
        stop, count = threading.Event(), 0

        def report(done: int, _: int, most: int = most, stop: threading.Event = stop) -> None:
            nonlocal count
            count = done
            if done == most:
                stop.set()

        with pytest.raises(CancelledError):
            simulate_grid(grid, PLA, LITTLE_FINER, progress=report, cancel=stop)
        assert count == most
