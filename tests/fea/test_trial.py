"""A trial as a whole: its frames, its symmetry, its stress, and how it fails."""

import numpy as np
import pytest

import ladder
from simulearn.errors import ComputationError
from simulearn.fea import Control, Trial, simulate_grid
from simulearn.grid import Grid, drop_beams, make

PLA = ladder.PLA


@pytest.fixture(scope="module")
def saddle() -> Trial:
    return simulate_grid(make("saddle"), PLA)


def test_shapes_and_the_flat_frame(saddle: Trial) -> None:
    assert saddle.joints.shape == (12, 9, 8, 3)
    assert saddle.beams.shape == (12, 12, 3, 4, 3)
    assert saddle.stress.shape == (12, 12, 4, 4, 6)
    centres = saddle.joints[0].mean(axis=1)
    np.testing.assert_allclose(centres[:, :2], make("saddle").centred.joints, atol=1e-12)
    np.testing.assert_allclose(centres[:, 2], 0, atol=1e-12)


def test_the_fixed_joint_stays(saddle: Trial) -> None:
    bottom = saddle.joints[:, 4, :4]
    np.testing.assert_array_equal(bottom, np.broadcast_to(bottom[0], bottom.shape))


def test_it_morphs_step_by_step_and_creeps_a_little(saddle: Trial) -> None:
    steps = np.linalg.norm(np.diff(saddle.joints.mean(axis=2), axis=0), axis=-1).mean(axis=1)
    assert (steps > 0.05).all()
    assert steps[-1] < 0.2 * steps[:-1].sum()
    # The columns curl down at full, the rows up a little.
    assert saddle.joints[11, 7].mean(axis=0)[2] < -20


def test_stress_begins_as_printed_and_is_released(saddle: Trial) -> None:
    e = PLA.shrinkage
    # Beam 1 runs along y with its lower half active; beam 0 along x, upper half active a quarter.
    np.testing.assert_allclose(saddle.stress[0, 1, :, :2, 1], e.stress_active, atol=1e-12)
    np.testing.assert_allclose(saddle.stress[0, 1, :, 2:, 0], e.stress_passive, atol=1e-12)
    np.testing.assert_allclose(saddle.stress[0, 0, 1:3, 2:, 0], e.stress_active, atol=1e-12)
    np.testing.assert_allclose(saddle.stress[0, 0, [0, 3], 2:, 1], e.stress_passive, atol=1e-12)
    assert abs(saddle.stress[0, :, :, :, 2:]).max() < 1e-12
    assert abs(saddle.stress[10]).max() < 0.1
    size = np.linalg.norm(saddle.stress, axis=-1).mean(axis=(1, 2, 3))
    assert (np.diff(size[1:11]) < 0).all()


def test_symmetry() -> None:
    """Turned, mirrored and flipped designs give turned, mirrored and flipped results."""
    for title, error in ladder.symmetry().items():
        assert error < 1e-6, title


def test_the_mixed_iteration_changes_the_cost_and_not_the_answer() -> None:
    grid = make("cone")
    tight = Control(tolerance=1e-8, iterations=40)
    plain = Control(tolerance=1e-8, iterations=40, mixed=False)
    mixed, newton = simulate_grid(grid, PLA, control=tight), simulate_grid(grid, PLA, control=plain)
    np.testing.assert_allclose(mixed.joints, newton.joints, atol=1e-6)
    assert sum(mixed.record["iterations"]) < 0.7 * sum(newton.record["iterations"])


def test_the_default_tolerance_is_tight_enough(saddle: Trial) -> None:
    tight = simulate_grid(make("saddle"), PLA, control=Control(tolerance=1e-9))
    assert abs(tight.joints - saddle.joints).max() < 1e-5


def test_an_increment_that_does_not_converge_is_halved(saddle: Trial) -> None:
    hurried = simulate_grid(make("saddle"), PLA, control=Control(iterations=3))
    assert hurried.record["halved"] > 0
    assert abs(hurried.joints - saddle.joints).max() < 1e-4


def test_failure_names_the_frame_and_the_reason() -> None:
    with pytest.raises(ComputationError, match=r"frame 1 of 11: .* at 0.0 % of the stress") as info:
        simulate_grid(make("saddle"), PLA, control=Control(iterations=0, halvings=2))
    assert info.value.code == "no-equilibrium"
    assert info.value.where == "frame 1"
    assert info.value.hint


def test_progress_is_reported_frame_by_frame() -> None:
    steps: list[tuple[int, int]] = []
    simulate_grid(make("flat", (1, 1)), PLA, progress=lambda k, n: steps.append((k, n)))
    assert steps == [(k, 12) for k in range(1, 13)]


@pytest.mark.parametrize(
    "grid",
    [
        make("dome", (2, 3), 50.0),
        drop_beams(make("wave"), [0, 5]),
        Grid(
            [[0, 0], [60, 5], [65, 60], [-5, 55]],
            [[0, 1], [1, 2], [3, 2], [3, 0]],
            [0.3, -0.62, 1, 0],
            2,
        ),
    ],
    ids=["2x3", "beams missing", "one skewed cell, odd ratios"],
)
def test_other_topologies(grid: Grid) -> None:
    trial = simulate_grid(grid, PLA)
    assert np.isfinite(trial.joints).all()
    assert trial.stable
    assert trial.joints.shape[1] == len(grid.joints)
    # Beams stay attached: a section's corners are corners of joints at both ends.
    ends = trial.beams[-1][:, [0, 2]].reshape(-1, 3)
    corners = trial.joints[-1].reshape(-1, 3)
    away = np.linalg.norm(ends[:, None] - corners, axis=-1).min(axis=1)
    assert away.max() < 1e-12
