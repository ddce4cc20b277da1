"""Snaps are followed, unstable balances are left, and who asks can stop it."""

import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

import ladder
from simulearn.errors import CancelledError
from simulearn.fea import Control, Layout, Trial, mesh, simulate_grid
from simulearn.fea.flow import flow, leave
from simulearn.fea.kernels import entries
from simulearn.fea.laws import law_of
from simulearn.fea.path import Path
from simulearn.fea.problem import EquilibriumProblem, SolidState
from simulearn.grid import Grid, drop_beams, make
from simulearn.native import on_compile

PLA = ladder.PLA

# A valid design that snaps at 94.4 % of the release.
SNAPPING = Grid(
    [
        [-64.708413, -69.488394],
        [-58.779535, 5.786435],
        [-67.733607, 66.678654],
        [6.016547, -79.274291],
        [0.0, 0.0],
        [0.479429, 59.237663],
        [68.418083, -68.461258],
        [69.487591, -5.885741],
        [55.671676, 60.698255],
    ],
    [
        [0, 3], [1, 4], [2, 5], [3, 6], [4, 7], [5, 8],
        [0, 1], [1, 2], [3, 4], [4, 5], [6, 7], [7, 8],
    ],
    [-0.25, 0.5, 0.0, -0.5, 0.0, -1.0, 0.5, 0.5, 0.0, 0.25, 1.0, 0.75],
    4,
)  # fmt: skip


@pytest.fixture(scope="module")
def snapping() -> Trial:
    return simulate_grid(SNAPPING, PLA)


@pytest.fixture(scope="module")
def dome() -> Trial:
    return simulate_grid(make("dome"), PLA)


def balanced(trial: Trial, frame: int, released: float, gravity: float) -> float:
    """The force out of balance in a frame, over the forces of the bricks."""
    problem = EquilibriumProblem(trial.solid, law_of(PLA.law), PLA.gravity.body_force)
    u = trial.displacements[frame]
    forces, _, _, _, scale = entries.internal(problem.law, problem.bricks, u, released)
    out = gravity * problem.load - forces
    out[trial.solid.fixed] = 0
    return float(np.linalg.norm(out) / scale)


def test_a_snap_is_followed_to_a_stable_equilibrium(snapping: Trial) -> None:
    assert snapping.stable
    first = snapping.snaps[0]
    assert first.frame == 10
    assert first.released == pytest.approx(0.944, abs=0.01)
    assert balanced(snapping, 10, 1.0, 1.0) < 1e-6
    assert balanced(snapping, 11, 1.0, 1 + PLA.creep.amplitude) < 1e-6
    warning = snapping.warnings[0]
    assert (warning.code, warning.where) == ("snap", "grid")
    assert "94.4 %" in warning.message
    assert "frame 10" in warning.message


def test_a_snap_moves_the_grid_much_further_than_the_release_does(snapping: Trial) -> None:
    steps = abs(np.diff(snapping.displacements, axis=0)).max(axis=(1, 2))
    assert steps[9] > 3 * steps[5:8].max()


def test_the_dome_leaves_its_balance_and_says_so(dome: Trial) -> None:
    assert dome.stable
    assert not dome.snaps
    [warning] = dome.warnings
    assert warning.code == "unstable-balance"
    assert "the mirrored shape" in warning.message
    # Symmetric before, buckled to one side after.
    centres = dome.joints.mean(axis=2).reshape(12, 3, 3, 3)
    away = abs(centres[:, :, ::-1] * [-1, 1, 1] - centres).max(axis=(1, 2, 3))
    turned = abs(centres.swapaxes(1, 2)[..., [1, 0, 2]] - centres).max(axis=(1, 2, 3))
    assert max(away[3], turned[3]) < 1e-3
    assert max(away[11], turned[11]) > 1


def test_both_sides_of_a_balance_are_mirror_images() -> None:
    """A straight column under its own growth between two held ends buckles to either side."""
    material = ladder.elastic(2.2, 0.0, 7.2, 4.0)
    solid = ladder.cantilever(material, 60.0, Layout(slabs=4))
    held = np.flatnonzero(abs(solid.nodes[:, 0] - 30) > 29.9)
    growth = np.zeros_like(solid.growth)
    growth[..., 0] = 0.05
    solid = replace(solid, growth=growth, fixed=held)
    problem = EquilibriumProblem(solid, law_of(material.law), 0.0)
    path = Path(problem)
    balance = problem.equilibrium(replace(problem.flat(), released=1.0))
    assert balance.negative > 0
    assert abs(balance.u[:, 2]).max() < 0.1  # straight
    departure = leave(problem, balance)
    assert departure.mirrored
    assert departure.state.stable
    assert abs(departure.state.u[:, 2]).max() > 2
    path.advance(1.0, 0.0)
    assert path.last[-1].stable
    assert path.messages[0].code == "unstable-balance"


def test_the_flow_ends_where_plain_increments_lead() -> None:
    solid = mesh(make("saddle"), PLA)
    problem = EquilibriumProblem(solid, law_of(PLA.law), PLA.gravity.body_force)
    flat = problem.flat()
    plain = problem.equilibrium(replace(flat, gravity=1.0))
    flowed = flow(problem, SolidState(0.0, 1.0, flat.u, flat.carried))
    np.testing.assert_allclose(flowed.u, plain.u, atol=1e-5)


def test_a_long_strip_hangs_down_before_anything_is_released() -> None:
    joints = [[100.0 * k, 0.0] for k in range(5)] + [[100.0 * k, 100.0] for k in range(5)]
    rows = [[k, k + 1] for k in range(4)]
    beams = rows + [[5 + i, 5 + j] for i, j in rows] + [[k, k + 5] for k in range(5)]
    solid = mesh(Grid(joints, beams, np.zeros(13), 0), PLA, Layout(slabs=4))
    problem = EquilibriumProblem(solid, law_of(PLA.law), PLA.gravity.body_force)
    path = Path(problem)
    state = path.advance(0.0, 1.0, 1)
    assert state.stable
    assert state.gravity == 1
    assert not path.snaps
    assert [message.code for message in path.messages] == ["hangs"]
    assert state.u[:, 2].min() < -200


def test_calls_of_several_threads_give_the_same_answers(dome: Trial) -> None:
    grids = [make("saddle"), drop_beams(make("wave"), [0, 5]), make("cone", (1, 2)), make("dome")]
    alone = [simulate_grid(grid, PLA).displacements for grid in grids[:-1]]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda grid: simulate_grid(grid, PLA).displacements, grids))
    for one, other in zip([*alone, dome.displacements], together, strict=True):
        np.testing.assert_array_equal(one, other)


class After:
    """A token that is set when it was asked a number of times."""

    def __init__(self, times: int) -> None:
        self.times = times

    def is_set(self) -> bool:
        self.times -= 1
        return self.times < 0


@pytest.mark.parametrize("times", [0, 1, 7])
def test_a_cancelled_simulation_stops_within_an_iteration(times: int) -> None:
    token = After(times)
    with pytest.raises(CancelledError):
        simulate_grid(make("saddle"), PLA, cancel=token)
    assert token.times == -1  # not asked again


def test_an_event_cancels_between_frames() -> None:
    event, done = threading.Event(), []

    def progress(frame: int, frames: int) -> None:
        done.append(frame)
        if frame == 4:
            event.set()

    with pytest.raises(CancelledError):
        simulate_grid(make("flat", (1, 1)), PLA, progress=progress, cancel=event)
    assert done == [1, 2, 3, 4]


def test_no_topology_layout_or_law_compiles_anew() -> None:
    simulate_grid(make("flat", (1, 1)), PLA)
    simulate_grid(make("dome", (1, 1)), PLA, control=Control(mixed=False, iterations=40))
    compiled = []
    with on_compile(lambda: compiled.append(1)):
        simulate_grid(drop_beams(make("twist", (2, 1)), [0]), PLA)
        simulate_grid(make("cone", (1, 2)), PLA, Layout(core=1, slabs=4))
        ladder.bilayer(1, layers=1)
    assert not compiled
    for kernel in (entries.factor, entries.solve, entries.internal, entries.carry):
        assert len(kernel.signatures) == 1


def test_a_simulation_does_not_load_jax() -> None:
    code = (
        "import sys\n"
        "from simulearn.fea import simulate_grid\n"
        "from simulearn.grid import make\n"
        "from simulearn.material import load_material\n"
        "simulate_grid(make('flat', (1, 1)), load_material('pla-hot-water'))\n"
        "import simulearn.fea.calculix\n"
        "assert 'jax' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def arch(control: Control) -> tuple[Path, np.ndarray]:
    """A shallow arch between held ends under a load that pushes it through, and its middle."""
    material = ladder.elastic(2.2, 0.0, 7.2, 2.0)
    solid = ladder.cantilever(material, 60.0, Layout(slabs=8))
    x = np.clip(solid.nodes[:, 0], 0, 60)
    nodes = solid.nodes + np.outer(1.5 * (1 - np.cos(2 * np.pi * x / 60)), [0, 0, 1])
    held = np.flatnonzero(abs(solid.nodes[:, 0] - 30) > 29.9)
    middle = np.flatnonzero(abs(solid.nodes[:, 0] - 30) < 3)
    forces = np.zeros_like(nodes)
    forces[middle, 2] = -0.3 / len(middle)
    solid = replace(solid, nodes=nodes, fixed=held)
    problem = EquilibriumProblem(solid, law_of(material.law), 0.0, forces, control)
    return Path(problem, [replace(problem.flat(), released=1.0)]), middle


@pytest.mark.parametrize("steps", [10, 3, 1])
@pytest.mark.parametrize("iterations", [15, 60])
def test_no_increment_jumps_over_a_snap_unseen(steps: int, iterations: int) -> None:
    """However long the increments and patient the iteration: one snap, and the same shape."""
    path, middle = arch(Control(iterations=iterations))
    for k in range(steps):
        path.advance(1.0, (k + 1) / steps, 1)
    assert len(path.snaps) == 1
    assert path.last[-1].stable
    assert path.last[-1].u[middle, 2].mean() == pytest.approx(-8.686, abs=1e-3)
