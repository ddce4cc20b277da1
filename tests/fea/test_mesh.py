"""The mesh fills the outlines, and its faces lie on the ends of every actuator."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from simulearn.errors import InputError
from simulearn.fea import COARSE, THREE_ACROSS, Layout, mesh
from simulearn.fea.bar import bar
from simulearn.fea.layout import cuts
from simulearn.fea.points import bricks_of
from simulearn.fea.printing import actuator_reaches_end
from simulearn.grid import Grid, Rules, draw_valid, drop_beams, make, outline
from simulearn.material import load_material

PLA = load_material("pla-hot-water")
LAYOUTS = [COARSE, THREE_ACROSS, Layout(core=2, slabs=12, layers=2)]


def area(corners: np.ndarray) -> np.ndarray:
    x, y = np.moveaxis(corners, -1, 0)
    return (x * np.roll(y, -1, -1) - y * np.roll(x, -1, -1)).sum(-1) / 2


@pytest.mark.parametrize("layout", LAYOUTS, ids=str)
def test_volume_is_that_of_the_outlines(layout: Layout) -> None:
    grid, _ = draw_valid(Rules(), 5, 0)
    shape = outline(grid, PLA.section)
    beams = shape.beams[:, [0, 1, 1, 0], [0, 0, 1, 1]]
    flat = area(shape.joints).sum() + abs(area(beams)).sum()
    points = bricks_of(mesh(grid, PLA, layout))[0]
    assert float(points.volumes.sum()) == pytest.approx(4.0 * flat, rel=1e-12)
    assert (np.asarray(points.volumes) > 0).all()


@pytest.mark.parametrize("layout", LAYOUTS, ids=str)
def test_corners_are_those_of_the_outline(layout: Layout) -> None:
    grid = draw_valid(Rules(), 5, 1)[0].centred
    shape, solid = outline(grid, PLA.section), mesh(grid, PLA, layout)
    joints = solid.nodes[solid.joints].reshape(-1, 2, 4, 3)
    np.testing.assert_allclose(joints[:, 0, :, :2], shape.joints, atol=1e-12)
    np.testing.assert_allclose(joints[:, 1, :, :2], shape.joints, atol=1e-12)
    assert set(joints[:, 0, :, 2].ravel()) == {-2.0}
    beams = solid.nodes[solid.beams]  # right-bottom, left-bottom, right-top, left-top
    np.testing.assert_allclose(beams[:, [0, 2], :2, :2], shape.beams, atol=1e-12)
    np.testing.assert_allclose(beams[:, 1], (beams[:, 0] + beams[:, 2]) / 2, atol=1e-12)
    np.testing.assert_allclose(beams[:, :, 2:] - beams[:, :, :2], [[[[0, 0, 4.0]] * 2] * 3] * 12)
    angles = np.arctan2(*(shape.joints - grid.joints[:, None]).transpose(2, 0, 1)[::-1])
    first = np.mod(angles + 1e-9, 2 * np.pi)
    assert (first.argmin(axis=1) == 0).all()


def test_parts_share_their_faces_and_nothing_else() -> None:
    """Every node lies in one place: no two coincide, none is unused."""
    solid = mesh(make("dome", (2, 3)), PLA)
    assert len(np.unique(solid.nodes.round(6), axis=0)) == len(solid.nodes)
    assert set(solid.bricks.ravel()) == set(range(len(solid.nodes)))
    bricks = np.bincount(solid.parts[solid.parts[:, 0] < 0, 1])
    assert (bricks == 2).all()


def test_the_lower_half_of_the_fixed_joint_is_held() -> None:
    grid = make("flat")
    solid = mesh(grid, PLA)
    held = solid.nodes[solid.fixed]
    assert len(held) == 20
    assert held[:, 2].max() == 0
    assert abs(held[:, :2]).max() == pytest.approx(3.6)


@given(ratio=st.floats(0.05, 0.99), slabs=st.sampled_from([4, 8, 12, 16]))
def test_brick_faces_lie_on_the_ends_of_the_actuator(ratio: float, slabs: int) -> None:
    places = cuts(ratio, slabs)
    assert len(places) == slabs + 1
    assert (np.diff(places) > 0).all()
    for end in ((1 - ratio) / 2, (1 + ratio) / 2, 0.0, 0.5, 1.0):
        assert abs(places - end).min() < 1e-12


@pytest.mark.parametrize("ratio", [0, 0.25, 0.5, 0.75, 1])
def test_quarters_need_no_uneven_slabs(ratio: float) -> None:
    np.testing.assert_allclose(cuts(ratio, 8), np.linspace(0, 1, 9), atol=1e-15)


@pytest.mark.parametrize(("rest", "faces"), [(0.44, 0), (0.46, 1)])
def test_an_end_shorter_than_half_a_printed_row_is_none(rest: float, faces: int) -> None:
    """Length counts, not ratio: no sliver is meshed, and none is left out that is printed."""
    for length in (20.0, 90.0):
        ratio = 1 - 2 * rest / length
        assert actuator_reaches_end(ratio, length) == (faces == 0)
        solid = mesh(bar(length, ratio, PLA), PLA)
        x = np.unique(solid.nodes[:, 0].round(6)) - 3.6
        assert np.isclose(x, rest, atol=1e-6).sum() == faces


def test_growth_follows_the_printing() -> None:
    grid = make("flat")
    actuators = np.zeros(12)
    actuators[0], actuators[1] = 0.5, -1.0
    grid = Grid(grid.joints, grid.beams, actuators, grid.fixed)
    solid = mesh(grid, PLA, THREE_ACROSS)
    e, nu = PLA.shrinkage, PLA.law.poisson
    growth = solid.growth[:, 0].reshape(-1, 3)
    beams = growth[9 * 18 :].reshape(12, 8, 3, 2, 3)  # beam, slab, across, layer
    active, passive = np.array([-1, nu, nu]) * e.active, np.array([nu, -1, nu]) * e.passive
    np.testing.assert_allclose(beams[0, 2:6, 1, 1], [active] * 4)
    np.testing.assert_allclose(beams[0, [0, 1, 6, 7], 1, 1], [passive] * 4)
    np.testing.assert_allclose(beams[0, :, 1, 0], [passive] * 8)
    np.testing.assert_allclose(beams[1, :, 1, 0], [active] * 8)
    np.testing.assert_allclose(beams[1, :, 1, 1], [passive] * 8)
    np.testing.assert_allclose(
        beams[:, :, [0, 2]], np.array([-1, nu, nu]) * e.shell + 0 * beams[:, :, [0, 2]]
    )
    joint = np.array([nu - 1, nu - 1, 2 * nu]) * e.joint
    np.testing.assert_allclose(growth[: 9 * 18], joint + 0 * growth[: 9 * 18])


def test_grids_with_missing_beams_are_meshed() -> None:
    solid = mesh(drop_beams(make("saddle"), [0]), PLA)
    assert len(solid.bricks) == 9 * 2 + 11 * 16


@pytest.mark.parametrize("wrong", [{"slabs": 7}, {"slabs": 2}, {"layers": 0}, {"core": -1}])
def test_impossible_layouts_are_refused(wrong: dict[str, int]) -> None:
    with pytest.raises(InputError, match="slabs"):
        Layout(**wrong)
