"""The default model on native kernels: the reference's networks, batches, smoothness, snaps."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import jax
import numpy as np
import pytest
from conformance import designs_like

from simulearn.fea.bar import bar
from simulearn.grid import Rules, draw_valid, read_grid
from simulearn.grid.outline import corner_topology
from simulearn.learn.common.bundle import bundle_of
from simulearn.learn.common.model import Designs
from simulearn.learn.equilibrium import corrector, native
from simulearn.learn.equilibrium.kernels.network import outputs
from simulearn.learn.equilibrium.kernels.stress import stress_in_space
from simulearn.learn.equilibrium.printed import prints_of
from simulearn.material import Family, draw_member, load_material
from simulearn.mechanics.forces import BeamState
from simulearn.mechanics.kernels.geometry import set_corners, set_geometry
from simulearn.mechanics.kernels.path import follow
from simulearn.mechanics.model import REFERENCE_WIDTH
from simulearn.mechanics.path import grid_of, schedule_frames, trace
from simulearn.mechanics.poses import Pose
from simulearn.mechanics.topology import Topology, flat_geometry, topologies
from simulearn.native import on_compile

SNAPS = Path(__file__).parent.parent / "data" / "snaps.json"


@pytest.fixture(scope="module")
def model():
    return bundle_of("equilibrium").model


def of(*grids) -> Designs:
    grids = [grid.centred for grid in grids]
    flat, ratios = np.stack([g.joints for g in grids]), np.stack([g.actuators for g in grids])
    return Designs(grids[0].beams, grids[0].fixed, flat, ratios)


def member(seed: int):
    """A random material of the family, its own curl not none."""
    return draw_member(Family(), load_material("pla-hot-water"), np.random.default_rng(seed).random)


@pytest.mark.parametrize("rules", [Rules(), Rules(cells=(2, 3)), Rules(removed=(2, 2))])
def test_networks_are_those_of_the_reference(model, rules):
    designs, frame = of(draw_valid(rules, 5, 1)[0]), 9
    designs = replace(designs, material=member(3))
    corners = tuple(x[0] for x in corner_topology(designs.beams, designs.flat))
    networks = native.networks_of(model.parameters)
    (printed,) = prints_of(model.parameters.law, designs, 1.0)
    p = printed.properties
    scale = p.width / REFERENCE_WIDTH
    grid = grid_of(
        designs.beams, designs.fixed, designs.flat[0], designs.actuators[0], corners,
        printed.section, p,
    )  # fmt: skip
    frames = schedule_frames(len(designs.beams), p.creep)
    path = trace(grid, frames)
    count = designs.flat.shape[1]
    valence = np.bincount(designs.beams.ravel(), minlength=count).astype(float)

    def ours(layers):
        out = np.zeros((12, 2, len(designs.beams), len(layers.size)))
        outputs(
            layers, grid.geometry, grid.layout.ends, grid.layout.fixed, grid.ratio, valence,
            path.R, path.twists, frames.released, frames.gravity, scale, printed.signs,
            printed.strain, 1, out,
        )  # fmt: skip
        return out[frame]

    with jax.enable_x64(True):
        many = topologies(designs.beams, designs.fixed, designs.flat)
        topology = Topology(*(x[0] for x in many))
        geometry = flat_geometry(topology, designs.flat[0], p)
        R, at = path.R[frame].reshape(-1, 3, 3), path.p[frame]
        state = BeamState(Pose(R[:count], at[:count]), Pose(R[count:], at[count:]))
        features = corrector.features_of(
            topology, geometry, designs.actuators[0], state, path.twists[frame],
            frames.released[frame], frames.gravity[frame], p,
        )  # fmt: skip
        parameters = model.parameters
        theirs = corrector.corrections(parameters.network, topology, features)
        stress = corrector.stresses(parameters.stress, topology, features)
        both = [np.asarray(x).reshape(2, len(designs.beams), -1) for x in theirs]
    lengths = np.where(native.LENGTHS, scale, 1.0)
    np.testing.assert_allclose(
        ours(networks.corrections) * lengths, np.concatenate(both, -1), atol=2e-6
    )
    np.testing.assert_allclose(
        ours(networks.stress), np.asarray(stress).reshape(2, len(designs.beams), -1), atol=2e-7
    )


def test_a_design_does_not_depend_on_its_batch(model):
    designs = designs_like(Rules(), 9)
    many, one = model.rollout(designs), model.rollout(designs.take([7]))
    for a, b in ((many.joints, one.joints), (many.sections, one.sections)):
        np.testing.assert_array_equal(a[7], b[0])
    np.testing.assert_array_equal(many.stress[7], one.stress[0])
    np.testing.assert_array_equal(
        model.last(designs).joints[7], model.last(designs.take([7])).joints[0]
    )


def test_a_joint_moved_moves_the_shape_smoothly(model):
    grid = draw_valid(Rules(), 7, 3)[0].centred
    designs = of(*[grid] * 9)
    designs.flat[:, 8] += 0.1 * np.arange(9)[:, None] * [0.6, 0.8]
    for shape in (model.rollout(designs).joints[:, -1], model.last(designs).joints):
        kinks = np.diff(shape, n=4, axis=0)  # what is smooth has next to no fourth difference
        assert np.abs(np.diff(shape, axis=0)).max() > 0.01
        assert np.abs(kinks).max() < 1e-3


def test_a_topology_never_met_compiles_nothing(model):
    model.rollout(designs_like(Rules(), 1))
    model.last(designs_like(Rules(), 1))
    compiled = []
    with on_compile(lambda: compiled.append(True)):
        frames = model.rollout(of(draw_valid(Rules(cells=(4, 1), length=(30, 40)), 3, 0)[0]))
        model.last(of(draw_valid(Rules(cells=(3, 2)), 3, 0)[0]))
    assert frames.converged.all()
    assert not compiled


def test_kernels_are_compiled_for_one_type_of_arrays(model):
    """Whether arrays may be written, and whether there is one beam or many, is nothing to them."""
    designs, strip = designs_like(Rules(), 1), of(bar(50.0, 0.5, load_material("pla-hot-water")))
    written = replace(designs, beams=designs.beams.copy(), flat=designs.flat.copy())
    written.flat.flags.writeable = False
    for some in (designs, written, strip):
        for one in (model, bundle_of("beams").model):
            assert one.rollout(some).converged.all()
    for kernel in (set_geometry, follow, outputs, set_corners, stress_in_space):
        assert len(kernel.signatures) == 1


def test_a_snap_is_followed_and_recorded(model):
    """By the default mesh it snaps at .944, by the fine one while it creeps (finite elements)."""
    for mesh, frame, released in ((0.0, 10, 0.944), (1.0, 11, 1.0)):
        frames = model.rollout(replace(of(read_grid(SNAPS)), mesh=mesh))
        assert frames.converged.all()
        assert frames.stable.all()
        first = frames.snaps[0][0]
        assert first.frame == frame
        assert first.released == pytest.approx(released, abs=0.03)
        places = frames.joints[0].mean(axis=2)
        steps = np.linalg.norm(np.diff(places, axis=0), axis=-1).max(axis=-1)
        assert steps[9] > 3 * steps[8]
        assert steps.argmax() == 10


def test_it_answers_without_jax():
    code = (
        "import sys, numpy as np\n"
        "from simulearn.grid import make\n"
        "from simulearn.learn.common.bundle import bundle_of\n"
        "from simulearn.learn.common.model import Designs, last_frame\n"
        "g = make('cone')\n"
        "d = Designs(g.beams, g.fixed, g.joints[None], g.actuators[None])\n"
        "model = bundle_of('default').model\n"
        "assert model.rollout(d).converged.all() and last_frame(model, d).converged.all()\n"
        "assert 'jax' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=300)
