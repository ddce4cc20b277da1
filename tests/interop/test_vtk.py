"""VTK files: bricks that fill the grid, displacements that lead back to it, a series that plays."""

from dataclasses import replace
from xml.etree import ElementTree

import meshio
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import synthetic
from simulearn import simulate
from simulearn.errors import InputError
from simulearn.fea.laws import law_of
from simulearn.interop import write_pvd, write_vtu
from simulearn.material import load_material

# Its solid has places and nothing of which a stress could follow.
RESULT = replace(synthetic.result(), stress=None)
PLAIN = synthetic.result(solid=False)
VOLUME = 4.0 * 7.2 * (9 * 7.2 + 12 * (65 - 7.2))  # joints and beams of the flat grid, mm3

# VTK's order: corners, then the middles of the edges below, above and between.
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
CORNERS = np.concatenate([CORNERS, CORNERS + np.array([0, 0, 1])])
EDGES = np.array([*zip(range(4), (1, 2, 3, 0), strict=True)])
EDGES = np.concatenate([EDGES, EDGES + 4, np.stack([np.arange(4), np.arange(4, 8)], axis=1)])
NODES = np.concatenate([CORNERS, CORNERS[EDGES].mean(axis=1)])


def volume(points, bricks):
    """Volume of bricks of 8 or 20 nodes whose shape functions are 1 at their own node."""
    n = bricks.shape[1]
    powers = np.array([p for p in np.ndindex(3, 3, 3) if sum(k for k in p if k > 1) <= 2])
    powers = powers[powers.max(axis=1) < 2] if n == 8 else powers

    def monomials(x):
        return np.prod(x[:, None] ** powers, axis=2)

    inverse = np.linalg.inv(monomials(NODES[:n]))
    x, w = np.polynomial.legendre.leggauss(4)
    at = np.stack(np.meshgrid(*[(x + 1) / 2] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    weight = np.prod(np.stack(np.meshgrid(*[w / 2] * 3, indexing="ij"), axis=-1), axis=-1).ravel()
    step = 1e-6
    slopes = [
        (monomials(at + step * e) - monomials(at - step * e)) / (2 * step) @ inverse
        for e in np.eye(3)
    ]
    jacobian = np.einsum("dqn,enx->eqdx", slopes, points[bricks])
    return np.linalg.det(jacobian) @ weight


def read(tmp_path, result, frame=-1):
    path = tmp_path / "a.vtu"
    write_vtu(result, path, frame)
    mesh = meshio.read(path)
    (cells,) = mesh.cells
    return mesh, cells


def test_bricks_of_twenty_nodes_have_each_middle_between_its_corners(tmp_path):
    mesh, cells = read(tmp_path, RESULT, frame=0)
    assert cells.type == "hexahedron20"
    at = mesh.points[cells.data]
    np.testing.assert_allclose(at[:, 8:], at[:, EDGES].mean(axis=2), atol=1e-9)


@pytest.mark.parametrize("solid", [True, False])
def test_bricks_fill_the_grid(tmp_path, solid):
    result = replace(synthetic.result(bend=synthetic.cylinder, solid=solid), stress=None)
    for frame in (0, -1):
        mesh, cells = read(tmp_path, result, frame)
        filled = volume(mesh.points, cells.data)
        assert (filled > 0).all()
        # Rolling keeps the volume but for what straight edges cut off.
        assert filled.sum() == pytest.approx(VOLUME, rel=1e-6 if frame == 0 else 0.03)


@pytest.mark.parametrize("result", [RESULT, PLAIN])
def test_displacements_lead_back_to_the_flat_grid(tmp_path, result):
    flat, _ = read(tmp_path, result, frame=0)
    mesh, _ = read(tmp_path, result)
    back = mesh.points - mesh.point_data["displacement"]
    np.testing.assert_allclose(back, flat.points, atol=1e-9)
    assert abs(flat.points[:, 2]).max() == pytest.approx(2.0)


def test_corners_of_the_result_are_points(tmp_path):
    for result in (RESULT, PLAIN):
        mesh, _ = read(tmp_path, result)
        corners = np.concatenate(
            [result.joints[-1].reshape(-1, 3), result.beams[-1].reshape(-1, 3)]
        )
        away = np.linalg.norm(corners[:, None] - mesh.points, axis=2).min(axis=1)
        assert away.max() < 1e-9


def test_a_series_names_a_file_for_each_frame(tmp_path):
    path = tmp_path / "my 'grid' & <co>.pvd"
    write_pvd(RESULT, path)
    sets = ElementTree.parse(path).getroot().findall("Collection/DataSet")
    assert [s.get("timestep") for s in sets] == [str(k) for k in range(12)]
    for s, u in zip(sets, RESULT.displacements, strict=True):
        mesh = meshio.read(tmp_path / s.get("file"))
        np.testing.assert_allclose(mesh.point_data["displacement"], u, atol=1e-9)
    assert len([*tmp_path.iterdir()]) == 2


def test_a_series_that_fails_midway_leaves_the_old_one(tmp_path, monkeypatch):
    path = tmp_path / "a.pvd"
    write_pvd(RESULT, path)
    before = {file: file.read_bytes() for file in tmp_path.rglob("*.*")}
    written = []

    def third(mesh, *args, **more):
        written.append(mesh)
        if len(written) == 3:
            raise OSError(28, "No space left on device")

    monkeypatch.setattr(meshio.Mesh, "write", third)
    with pytest.raises(InputError, match="No space left"):
        write_pvd(PLAIN, path)
    assert {file: file.read_bytes() for file in tmp_path.rglob("*.*")} == before


def test_a_file_in_the_place_of_the_folder_is_named(tmp_path):
    (tmp_path / "a_frames").write_text("mine")
    with pytest.raises(InputError, match="a_frames, which is a file"):
        write_pvd(PLAIN, tmp_path / "a.pvd")
    assert (tmp_path / "a_frames").read_text() == "mine"


@pytest.fixture(scope="module")
def simulated():
    return simulate(synthetic.square_grid((1, 1), actuators=[1.0, -0.5, 0.25, 0.0]), "fea")


def mises(stress):
    """Von Mises value of stresses (n, 6) xx yy zz xy yz xz: the norm of the deviator."""
    tensor = tensors(stress)
    deviator = tensor - np.trace(tensor, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)
    return np.sqrt(1.5 * (deviator**2).sum(axis=(1, 2)))


def test_the_flat_grid_has_the_stress_it_was_printed_with(tmp_path, simulated):
    mesh, _ = read(tmp_path, simulated, frame=0)
    solid, stress = simulated.solid, mesh.cell_data["stress"][0]
    along, across, up = np.einsum("eqk,q->ke", solid.stress[solid.parts[:, 0] >= 0], solid.weights)
    c, s = np.cos(solid.angle), np.sin(solid.angle)
    c, s = (x[solid.parts[:, 0] >= 0] for x in (c, s))
    expected = np.stack(
        [along * c**2 + across * s**2, along * s**2 + across * c**2, up,
         (along - across) * c * s, 0 * c, 0 * c], axis=1)  # fmt: skip
    np.testing.assert_allclose(stress[solid.parts[:, 0] >= 0], expected, atol=1e-12)
    assert abs(expected).max() > 0.05


def moved(result, gradient):
    """Return a result whose frames are all the flat grid, with places F x."""
    nodes = result.solid.nodes
    u = nodes @ np.array(gradient).T - nodes
    return replace(result, displacements=np.broadcast_to(u, (12, *u.shape)))


def tensors(stress):
    return stress[:, [0, 3, 5, 3, 1, 4, 5, 4, 2]].reshape(-1, 3, 3)


def test_stress_turns_with_the_grid(tmp_path, simulated):
    turn = Rotation.from_rotvec([0.4, -0.7, 1.1]).as_matrix()
    still, _ = read(tmp_path, moved(simulated, np.eye(3)), frame=0)
    mesh, _ = read(tmp_path, moved(simulated, turn), frame=0)
    before, after = (tensors(m.cell_data["stress"][0]) for m in (still, mesh))
    np.testing.assert_allclose(after, turn @ before @ turn.T, atol=1e-9)
    np.testing.assert_allclose(
        *(m.cell_data["von Mises stress"][0] for m in (still, mesh)), atol=1e-9
    )


def test_a_small_strain_adds_the_stress_of_hooke(tmp_path, simulated):
    strain = 1e-5 * np.array([[3.0, 1, -2], [1, -1, 4], [-2, 4, 2]])
    still, _ = read(tmp_path, moved(simulated, np.eye(3)), frame=0)
    mesh, _ = read(tmp_path, moved(simulated, np.eye(3) + strain), frame=0)
    added = tensors(mesh.cell_data["stress"][0]) - tensors(still.cell_data["stress"][0])
    law = law_of(load_material("pla-hot-water").law)
    deviator = strain - np.trace(strain) / 3 * np.eye(3)
    twice_shear = added[0, 1, 2] / strain[1, 2]
    assert 2 < twice_shear < 3.5  # of a plastic whose first measured modulus is 3.2 MPa
    hooke = twice_shear * deviator + law.first * np.trace(strain) * np.eye(3)
    np.testing.assert_allclose(added, np.broadcast_to(hooke, added.shape), rtol=1e-3, atol=1e-7)


def test_von_mises_is_the_size_of_the_deviator(tmp_path, simulated):
    for frame in (0, 5, -1):
        mesh, _ = read(tmp_path, simulated, frame)
        stress = mesh.cell_data["von Mises stress"][0]
        np.testing.assert_allclose(stress, mises(mesh.cell_data["stress"][0]), atol=1e-12)
        assert stress.max() > 0.01


def test_without_a_solid_the_corners_of_beams_have_the_stress(tmp_path):
    for frame in (0, -1):
        mesh, cells = read(tmp_path, PLAIN, frame)
        assert cells.type == "hexahedron"
        joints = 8 * len(PLAIN.grid.joints)
        assert np.isnan(mesh.point_data["stress"][:joints]).all()
        at = mesh.point_data["stress"][joints:].reshape(-1, 3, 4, 6)[..., [0, 1, 2, 3, 5, 4]]
        given = PLAIN.stress[frame]
        np.testing.assert_allclose(at[:, 0], given[:, 0])
        np.testing.assert_allclose(at[:, 1], (given[:, 1] + given[:, 2]) / 2)
        np.testing.assert_allclose(at[:, 2], given[:, 3])
        seen = mesh.point_data["von Mises stress"][joints:]
        np.testing.assert_allclose(seen, mises(mesh.point_data["stress"][joints:]))


def test_a_solid_of_an_unknown_material_keeps_the_stress_at_its_corners(tmp_path, simulated):
    other = replace(simulated, material=simulated.material.model_copy(update={"digest": "0" * 64}))
    mesh, cells = read(tmp_path, other)
    assert cells.type == "hexahedron"
    assert np.isfinite(mesh.point_data["stress"]).any()
