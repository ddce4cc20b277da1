"""Quad meshes: read, turned alike, smooth between their corners, joints shared."""

import struct

import numpy as np
import pytest

from simulearn.errors import InputError
from simulearn.tile import from_quads, read_tiling
from simulearn.tile.quadfile import read_quads

FLAT = [[0, 0, 0], [90, 0, 0], [180, 0, 0], [0, 90, 0], [90, 90, 0], [180, 90, 0]]
PAIR = [[0, 1, 4, 3], [1, 2, 5, 4]]


def obj(path, vertices, faces):
    lines = ["v {} {} {}".format(*v) for v in vertices]
    lines += ["f " + " ".join(str(k + 1) for k in face) for face in faces]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_each_quad_is_a_module_and_neighbours_share_joints(tmp_path):
    tiling = read_tiling(obj(tmp_path / "two.obj", FLAT, PAIR))
    assert tiling.modules.shape == (2, 9)
    assert len(tiling.points) == 15
    assert tiling.touching == ((0, 1),)
    np.testing.assert_allclose(tiling.points[:, 2], 0, atol=1e-12)
    np.testing.assert_allclose(tiling.targets[0, 4], [45, 45, 0], atol=1e-9)
    finer = from_quads(np.array(FLAT, float), np.array(PAIR), (3, 3))
    assert len(finer.points) == 2 * 16 - 4


def test_quads_that_are_turned_over_are_turned_back_and_it_is_said():
    tiling = from_quads(np.array(FLAT, float), np.array([PAIR[0], PAIR[1][::-1]]))
    assert (tiling.normals[:, 2] > 0.99).all()
    assert [message.code for message in tiling.warnings] == ["quads-turned"]
    assert len(tiling.points) == 15


def test_between_corners_on_a_sphere_the_surface_is_nearly_the_sphere():
    angles = np.radians([-50, -25, 0, 25, 50])
    x, y = np.meshgrid(np.tan(angles), np.tan(angles))
    points = np.stack([x, y, np.ones_like(x)], axis=-1).reshape(-1, 3)
    points = 200 * points / np.linalg.norm(points, axis=1, keepdims=True)
    k = np.arange(25).reshape(5, 5)
    quads = np.stack([k[:-1, :-1], k[:-1, 1:], k[1:, 1:], k[1:, :-1]], axis=-1).reshape(-1, 4)
    tiling = from_quads(points, quads)
    inner = tiling.modules[[5, 6, 9, 10]]  # normals at the rim are of one side only
    radius = np.linalg.norm(tiling.points[inner], axis=-1)
    chords = np.linalg.norm(points[quads[5]].mean(axis=0))
    assert np.abs(radius - 200).max() < 0.15 * (200 - chords)


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_ply_is_read_in_its_forms(tmp_path, form):
    head = (
        f"ply\nformat {form} 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
        "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
    )
    if form == "ascii":
        rows = [*FLAT, *([4, *face] for face in PAIR)]
        body = "\n".join(" ".join(map(str, row)) for row in rows).encode()
    else:
        order = "<" if "little" in form else ">"
        body = b"".join(struct.pack(order + "3f", *v) for v in FLAT)
        body += b"".join(struct.pack(order + "B4i", 4, *face) for face in PAIR)
    path = tmp_path / "two.ply"
    path.write_bytes(head.encode() + body)
    vertices, quads = read_quads(path)
    np.testing.assert_allclose(vertices[quads[1]], np.array(FLAT)[PAIR[1]])


CORNERS = "v 0 0 0\nv 60 0 0\nv 60 60 0\nv 0 60 5\n"
# A strip of twelve quads around a circle that turns by half a turn on its way.
AROUND = 2 * np.pi * np.arange(12) / 12
STRIP = "".join(
    f"v {(150 + s * np.cos(a / 2)) * np.cos(a):f} {(150 + s * np.cos(a / 2)) * np.sin(a):f} "
    f"{s * np.sin(a / 2):f}\n"
    for a in AROUND
    for s in (-40, 40)
)
STRIP += "".join(f"f {k} {k + 1} {k + 3} {k + 2}\n" for k in range(1, 23, 2)) + "f 23 24 1 2\n"


def test_quads_there_twice_and_apart_are_told(tmp_path):
    path = tmp_path / "drawn.obj"
    beside = "v 60.01 0 0\nv 120 0 0\nv 120 60 0\nv 60.01 60 0\n"  # but for a hundredth
    path.write_text(CORNERS + beside + "f 1 2 3 4\nf 4 3 2 1\nf 5 6 7 8\n", encoding="utf-8")
    tiling = read_tiling(path)
    assert len(tiling.modules) == 2
    assert np.isfinite(tiling.normals).all()
    assert [message.code for message in tiling.warnings] == ["quads-twice", "quads-pieces"]


def test_a_large_mesh_is_not_taken_for_one_drawn_by_hand(tmp_path):
    path = tmp_path / "scan.obj"
    path.write_text("v 0 0 0\n" + "f 1 1 1\n" * 100_002, encoding="utf-8")
    assert read_quads(path) is None
    path = tmp_path / "scan.ply"
    path.write_text("ply\nformat ascii 1.0\nelement face 200000\n"
                    "property list uchar int vertex_indices\nend_header\n")  # fmt: skip
    assert read_quads(path) is None


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("v 0 0 0\nf 1 2 3 4\n", "is damaged, or no mesh file"),
        ("v 0 0 zero\n", "is damaged, or no mesh file"),
        ("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 3\n", "1 quads and 1 other faces"),
        ("v 0 0 0\nv 10 0 0\nv 20 0 0\nv 30 0 0\nf 1 2 3 4\n", "quad 1 has no area"),
        (CORNERS + "f 1 2 3 3\n", "quad 1 has two corners at one place"),
        (CORNERS + "f 1 3 2 4\n", "quad 1 crosses itself or is bent inwards"),
        (CORNERS + "v 40 20 0\nf 1 2 3 5\n", "quad 1 crosses itself or is bent inwards"),
        (CORNERS + "v 1e300 0 0\nf 1 2 3 5\n", "no number below 1e+09"),
        ("v 0 0 0\nv .1 0 0\nv .1 .1 0\nv 0 .1 0\nf 1 2 3 4\n", "say --unit m or --unit in"),
        (STRIP, "the quads have one side only"),
    ],
)
def test_what_is_no_quad_mesh_is_one_line(tmp_path, text, words):
    path = tmp_path / "wrong.obj"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as error:
        read_tiling(path)
    assert words in str(error.value)
    assert "\n" not in str(error.value)
