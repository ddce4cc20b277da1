"""Whole tilings of files, by the learned engine: a quad mesh, a NURBS patch, a tube."""

import numpy as np
import pytest
import rhino3dm
import trimesh
from modules import here

from simulearn.errors import InputError
from simulearn.tile import Settings, read_tiling, tile

SMALL = Settings(rounds=1)


def height(x, y):
    return 8 * np.cos(x / 70) * np.cos(y / 60)


def lattice(nx, ny, wide, deep):
    """Return places (N, 3) mm on a bump, and squares (M, 4) between them."""
    u, v = np.meshgrid(
        np.linspace(-wide / 2, wide / 2, nx + 1), np.linspace(-deep / 2, deep / 2, ny + 1)
    )
    k = np.arange(u.size).reshape(u.shape)
    squares = np.stack([k[:-1, :-1], k[:-1, 1:], k[1:, 1:], k[1:, :-1]], axis=-1)
    return np.stack([u, v, height(u, v)], axis=-1).reshape(-1, 3), squares.reshape(-1, 4)


def drawn(path):
    """Write four quads."""
    places, squares = lattice(2, 2, 110.0, 110.0)
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in places]
    lines += ["f " + " ".join(map(str, square + 1)) for square in squares]
    path.write_text("\n".join(lines), encoding="utf-8")
    return read_tiling(path, cells=(1, 1))


def patch(path):
    """Write a NURBS surface of 60 mm in inches, as Rhino does."""
    count, side = 6, 60.0 / 25.4
    surface = rhino3dm.NurbsSurface.Create(3, False, 4, 4, count, count)
    for knots in (surface.KnotsU, surface.KnotsV):
        for k in range(len(knots)):
            knots[k] = float(np.clip(k - 2, 0, count - 3))
    line = np.linspace(-side / 2, side / 2, count)
    for i, x in enumerate(line):
        for j, y in enumerate(line):
            z = height(25.4 * x, 25.4 * y) / 25.4
            surface.Points[i, j] = rhino3dm.Point4d(x, y, z, 1.0)
    model = rhino3dm.File3dm()
    model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Inches
    model.Objects.AddSurface(surface)
    model.Write(str(path), 7)
    return read_tiling(path, (1, 1), cells=(1, 1))


def test_a_face_that_is_taken_whole_is_named_where_it_cannot_be_tiled(tmp_path):
    model = rhino3dm.File3dm()
    circle = rhino3dm.Circle(rhino3dm.Point3d(0, 0, 0), 30.0)
    model.Objects.AddBrep(
        rhino3dm.Brep.CreateFromCylinder(rhino3dm.Cylinder(circle, 80.0), True, True)
    )
    model.Write(str(tmp_path / "can.3dm"), 7)
    with pytest.raises(InputError, match=r"can.3dm: .*3 trimmed faces have no render mesh"):
        read_tiling(tmp_path / "can.3dm", size=60.0)


def tube(path):
    """Write a tube of triangles, open at both ends."""
    around = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    rows = [np.c_[80 * np.cos(around), 80 * np.sin(around), np.full(60, z)] for z in (0, 25, 50)]
    k = np.arange(60)
    n = (k + 1) % 60
    ring = np.concatenate([np.stack([k, n, n + 60], 1), np.stack([k, n + 60, k + 60], 1)])
    faces = np.concatenate([ring, ring + 60])
    trimesh.Trimesh(np.concatenate(rows), faces, process=False).export(path)
    return read_tiling(path, (10, 1), cells=(1, 1))


@pytest.mark.parametrize(
    ("write", "name", "modules", "kinds"),
    [(drawn, "drawn.obj", 4, 1), (patch, "patch.3dm", 1, 1), (tube, "tube.ply", 10, 1)],
)
def test_a_file_is_tiled(write, name, modules, kinds, tmp_path):
    tiling = write(tmp_path / name)
    tiled = tile(tiling, SMALL, None, here())
    assert len(tiled.members) == modules
    assert len(tiled.grids) == kinds
    assert all(answer.checked for answer in tiled.answers)
    assert tiled.fit.error_mm < 1.0
    assert tiled.fit.gap_mm < 1.0
    assert tiling.surface.distance(tiled.fit.versions.reshape(-1, 3)).max() < 1.0
