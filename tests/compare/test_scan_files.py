"""Scans in STL, PLY and OBJ, sound and damaged."""

import numpy as np
import pytest
import trimesh

from simulearn.compare import read_measurement
from simulearn.errors import InputError

BOX = trimesh.creation.box((40.0, 30.0, 4.0))


def on_box(points, normals):
    side = np.array([20.0, 15.0, 2.0])
    gap = abs(abs(points) - side)
    assert (gap.min(axis=1) < 1e-4).all()
    k = gap.argmin(axis=1)
    rows = np.arange(len(points))
    assert (normals[rows, k] * np.sign(points[rows, k]) > 0.99).all()


@pytest.mark.parametrize("ending", ["stl", "ascii.stl", "ply", "obj"])
def test_meshes_are_sampled_evenly_with_normals(tmp_path, ending):
    path = tmp_path / f"box.{ending}"
    kind = "stl_ascii" if ending == "ascii.stl" else ending
    data = BOX.export(file_type=kind)
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    scan = read_measurement(path, 9)
    on_box(scan.points, scan.normals)
    top = (scan.points[:, 2] > 1.9999).mean()
    assert top == pytest.approx(40 * 30 / BOX.area, abs=0.01)
    again = read_measurement(path, 9)
    assert (again.points == scan.points).all()


def test_a_cloud_keeps_its_normals_and_loses_what_is_not_finite(tmp_path):
    header = (
        "ply\nformat ascii 1.0\nelement vertex 4\n"
        + "".join(f"property float {n}\n" for n in ("x", "y", "z", "nx", "ny", "nz"))
        + "end_header\n"
    )
    path = tmp_path / "cloud.ply"
    path.write_text(header + "0 0 0 0 0 2\n1 0 0 0 0 1\nnan 0 0 0 0 1\n0 1 0 0 0 1\n")
    scan = read_measurement(path, 9)
    assert scan.points.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    assert scan.normals == pytest.approx(np.tile([0, 0, 1], (3, 1)))
    assert scan.messages[0].message.startswith("1 of 4 points have coordinates")


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("a.stl", b"", "is damaged|holds no surface"),
        ("a.stl", b"solid of nothing\nendsolid\n", "is damaged|holds no surface"),
        ("a.stl", b"\0" * 84, "holds no surface"),
        ("a.stl", b"\0" * 80 + b"\xff\xff\0\0" + b"\0" * 50, "is damaged|holds no surface"),
        ("a.ply", b"hello", "is damaged"),
        ("a.obj", b"# nothing\n", "is damaged|holds no surface"),
        ("a.stl", b"glTF" + b"\0" * 200, "is a GLB file by its contents"),
        ("a.stl", b"PK\3\4" + b"\0" * 200, "is a 3MF or ZIP file"),
        ("a.stl", b"# by hand\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "is an OBJ file"),
        ("a.obj", b"ply\nformat ascii 1.0\n", "is a PLY file"),
        ("a.stl", BOX.export(file_type="stl")[:400], "has 12 triangles, and has 6"),
        ("a.stl", BOX.export(file_type="stl_ascii")[:900].encode(), "is cut off"),
        ("a.stl", b"version https://git-lfs.github.com/spec/v1\n", "pointer of Git LFS"),
    ],
)
def test_damaged_scans_are_refused_in_one_sentence(tmp_path, name, data, words):
    path = tmp_path / name
    path.write_bytes(data)
    with pytest.raises(InputError, match=words):
        read_measurement(path, 9)
