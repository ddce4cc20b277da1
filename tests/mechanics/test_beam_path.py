"""Native paths of beam mechanics: equilibria of the reference, stability, snaps, balances."""

from math import cos, pi, sin

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from simulearn.grid import Grid, Rules, draw_valid, make, outline
from simulearn.grid.outline import corner_topology
from simulearn.material import load_material
from simulearn.mechanics.forces import BeamState, forces, twists
from simulearn.mechanics.kernels.path import NEGATIVE
from simulearn.mechanics.model import SectionLaw, section_of, unfitted
from simulearn.mechanics.ordering import layout_of
from simulearn.mechanics.path import coefficients, grid_of, schedule_frames, trace
from simulearn.mechanics.poses import Pose
from simulearn.mechanics.properties import properties_of
from simulearn.mechanics.rollout import half_beams_at, loads
from simulearn.mechanics.stiffness import exact_stiffness
from simulearn.mechanics.topology import flat_geometry, topologies
from simulearn.schedule import SCHEDULE

PLA = load_material("pla-hot-water")
CURLED = PLA.model_copy(
    update={
        "shrinkage": PLA.shrinkage.model_copy(update={"curl": 0.02, "stress_joint": 0.1}),
        "section": PLA.section.model_copy(update={"width": 6.0}),
    }
)
MATERIALS = {"PLA": PLA, "curled": CURLED}


def section(material):
    """A section whose coefficients are not all those of a layered beam."""
    random = np.random.default_rng(3)
    law = SectionLaw(*(x + 0.003 * random.normal(size=x.shape) for x in unfitted()))
    return section_of(law, properties_of(material))


def polygon(count: int) -> Grid:
    corners = [(60 * cos(2 * pi * k / count), 60 * sin(2 * pi * k / count)) for k in range(count)]
    beams = [(k, (k + 1) % count) for k in range(count)]
    ratios = [(-1) ** k * 0.5 for k in range(count)]
    return Grid(np.array(corners), np.array(beams), np.array(ratios), 0)


GRIDS = {
    "2 x 2": lambda: draw_valid(Rules(), 7, 0)[0],
    "beams removed": lambda: draw_valid(Rules(removed=(2, 3)), 7, 1)[0],
    "2 x 3": lambda: draw_valid(Rules(cells=(2, 3)), 7, 2)[0],
    "3 x 3": lambda: draw_valid(Rules(cells=(3, 3)), 7, 3)[0],
    "ring": lambda: polygon(5),
    "cross": lambda: make("saddle", (2, 2), 50.0),
}


def native(grid: Grid, material=PLA, **options):
    grid = grid.centred
    corners = tuple(x[0] for x in corner_topology(grid.beams, grid.joints[None]))
    model, p = coefficients(section(material)), properties_of(material)
    design = grid_of(grid.beams, grid.fixed, grid.joints, grid.actuators, corners, model, p)
    return design, trace(design, schedule_frames(len(grid.beams), p.creep), **options)


@jax.jit
def balance(topology, joints, ratio, state, frame, p, model):
    """Return forces, exact stiffness and twists of a state, as the reference in JAX has them."""
    geometry = flat_geometry(topology, joints, p)
    gravity = jnp.asarray(SCHEDULE.gravity(PLA.creep.amplitude))[frame]
    released = jnp.asarray(SCHEDULE.released)[frame]
    half_beams = half_beams_at(model, topology, geometry, ratio, loads(p), released, gravity)
    at = topology, half_beams, state
    return forces(*at), exact_stiffness(*at), twists(*at)


def reference(grid: Grid, path, frame: int, material=PLA):
    """The reference's forces, stiffness and twists where a path is in a frame."""
    grid = grid.centred
    many = topologies(grid.beams, grid.fixed, grid.joints[None])
    topology = jax.tree.map(lambda x: x[0], many)
    count = len(grid.joints)
    R, p = path.R[frame].reshape(-1, 3, 3), path.p[frame]
    state = BeamState(Pose(R[:count], p[:count]), Pose(R[count:], p[count:]))
    p, model = properties_of(material), section(material)
    there = balance(topology, grid.joints, grid.actuators, state, frame, p, model)
    return jax.tree.map(np.asarray, there)


@pytest.mark.parametrize("kind", GRIDS)
@pytest.mark.parametrize("material", MATERIALS)
def test_states_are_equilibria_of_the_reference(kind, material):
    frame = 11
    grid = GRIDS[kind]()
    _, path = native(grid, MATERIALS[material], tolerance=1e-9)
    assert path.ended
    out, stiffness, d = reference(grid, path, frame, MATERIALS[material])
    left = np.concatenate([out.joints.ravel(), out.middles.ravel()])
    left[6 * grid.fixed : 6 * grid.fixed + 6] = 0
    motion = np.linalg.solve(stiffness, left)
    turns = motion.reshape(-1, 6)
    moved = turns[:, :3] + np.cross(turns[:, 3:], path.p[frame])
    assert np.abs(moved).max() < 1e-8  # mm
    np.testing.assert_allclose(path.twists[frame], d, atol=1e-9)


def falling(grid: Grid, path, frame: int) -> int:
    """Number of directions in which the energy falls, by eigenvalues of the dense stiffness."""
    stiffness = reference(grid, path, frame)[1]
    return int((np.linalg.eigvalsh((stiffness + stiffness.T) / 2) < 0).sum())


def test_pivots_count_the_directions_in_which_the_energy_falls():
    grid = make("dome")
    _, path = native(grid, small_steps=False)
    k = int(np.argmax(path.info[:, NEGATIVE] > 0))
    assert k > 1
    assert not path.ended
    assert falling(grid, path, k) == path.info[k, NEGATIVE] > 0
    assert falling(grid, path, k - 1) == 0


def test_a_dome_leaves_its_unstable_balance():
    grid = make("dome")
    _, path = native(grid)
    assert path.ended
    assert path.left_balance
    assert falling(grid, path, 11) == 0
    heights = path.p[11, :9, 2].reshape(3, 3)
    turned = np.abs(heights - np.rot90(heights)).max()
    assert turned > 5  # mm: half the symmetry of the design is lost


def test_joints_are_eliminated_with_few_new_blocks():
    grid = make("flat", (6, 6))
    layout = layout_of(grid.beams, grid.fixed, len(grid.joints))
    assert layout.blocks < 49 * 48 / 2 / 2
    assert sorted(layout.place) == list(range(-1, 48))


def test_logarithms_are_right_beyond_two_radians():
    from simulearn.mechanics.poses import exp_se3, log_se3

    x = jnp.array([[3.0, -2.0, 1.0, 1.9, -1.7, 1.2], [1.0, 2.0, 3.0, 0.01, 0.0, 0.0]])
    np.testing.assert_allclose(jax.jit(lambda y: log_se3(exp_se3(y)))(x), x, atol=1e-6)


def test_outlines_agree_with_the_geometry():
    grid = draw_valid(Rules(), 7, 5)[0].centred
    design, _ = native(grid)
    corners = outline(grid, PLA.section).joints
    here = design.geometry.centre[:, None] + design.geometry.corners
    np.testing.assert_allclose(here[:, :4, :2], corners[..., :2], atol=1e-9)


def test_derivatives_hold_at_small_angles():
    from simulearn.mechanics.poses import exp_se3, log_se3

    x = jnp.array([0.3, 0.1, -0.2, 0.02, 0.1, 0.27])
    slope = jax.jit(jax.jacobian(lambda y: log_se3(exp_se3(y))))(x)
    np.testing.assert_allclose(slope, np.eye(6), atol=1e-8)
