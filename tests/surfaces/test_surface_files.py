"""Files of surfaces and curves: sound ones in their units, broken ones mended or refused."""

import os

import numpy as np
import pytest
import rhino3dm
import trimesh

from simulearn.errors import InputError
from simulearn.surfaces import Surface, mended, read_curve, read_surface, surface_of_heights

BALL = trimesh.creation.icosphere(3, 20.0)


def written(mesh, path):
    data = mesh.export(file_type="stl_ascii" if path.name.startswith("ascii") else path.suffix[1:])
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return path


def codes(surface):
    return {message.code.removeprefix("surface-") for message in surface.warnings}


@pytest.mark.parametrize("name", ["a.stl", "ascii.stl", "a.ply", "a.obj"])
def test_meshes_are_read_in_mm(tmp_path, name):
    surface = read_surface(written(BALL, tmp_path / name))
    assert surface.closed
    assert surface.warnings == ()
    assert len(surface.faces) == len(BALL.faces)
    assert len(surface.vertices) == len(BALL.vertices)  # those of an STL are made one
    assert surface.signed_distance(np.zeros((1, 3)))[0] == pytest.approx(-19.9, abs=0.1)


def test_a_glb_is_in_metres_with_y_up(tmp_path):
    high = BALL.copy()
    high.apply_scale(1e-3)
    high.apply_translation([0, 0.1, 0])
    surface = read_surface(written(high, tmp_path / "a.glb"))
    np.testing.assert_allclose(surface.box, [[-20, -20, 80], [20, 20, 120]], atol=0.1)


def test_a_unit_may_be_given_and_an_odd_size_is_reported(tmp_path):
    small = BALL.copy()
    small.apply_scale(1e-3)
    path = written(small, tmp_path / "a.stl")
    odd = read_surface(path)
    assert codes(odd) == {"unit"}
    assert '"unit": "m"' in odd.warnings[0].message
    np.testing.assert_allclose(read_surface(path, "m").size, BALL.scale, rtol=1e-5)
    np.testing.assert_allclose(read_surface(path, "inches").size, 25.4e-3 * BALL.scale, rtol=1e-5)
    with pytest.raises(InputError, match="is no unit of length"):
        read_surface(path, "parrots")


def test_a_broken_mesh_is_mended_and_what_was_done_is_reported():
    vertices = np.vstack([BALL.vertices, [[np.nan, 0, 0]]])
    faces = BALL.faces.copy()
    faces[::7] = faces[::7, ::-1]
    last = len(BALL.vertices)
    bad = [[0, 0, 1], [2, 3, last], [0, 1, last + 50]]
    vertices, faces, messages = mended(vertices, np.vstack([faces, faces[:4], bad]))
    surface = Surface(vertices, faces)
    assert surface.closed
    assert surface.signed_distance(np.zeros((1, 3)))[0] < 0
    found = {message.code: message.message for message in messages}
    assert found["surface-not-finite"].startswith("1 of ")
    assert found["surface-not-there"].startswith("1 of ")
    assert found["surface-degenerate"].startswith("1 of ")
    assert found["surface-duplicates"].startswith("4 of ")
    assert found["surface-flipped"].startswith(f"{len(BALL.faces[::7]):,} of ")


@pytest.mark.parametrize("ending", ["obj", "stl"])
def test_a_byte_order_mark_and_ends_of_lines_of_windows_change_nothing(tmp_path, ending):
    text = BALL.export(file_type="obj" if ending == "obj" else "stl_ascii")
    if ending == "obj":  # its first line is a vertex
        text = "\n".join(line for line in text.splitlines() if line[:2] in ("v ", "f "))
    path = tmp_path / f"ein Mal Fläche.{ending}"
    path.write_bytes(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())
    assert read_surface(path).closed


def test_what_is_drawn_in_mm_and_saved_as_metres_is_told(tmp_path):
    surface = read_surface(written(BALL, tmp_path / "a.glb"))
    assert codes(surface) == {"unit"}
    assert 'if it was drawn in mm, say "unit": "mm"' in surface.warnings[0].message
    assert codes(read_surface(tmp_path / "a.glb", "mm")) == set()


def test_bodies_are_turned_outwards_and_hollows_stay():
    small = trimesh.creation.icosphere(1, 5.0)
    apart = small.copy()
    apart.apply_translation([50, 0, 0])
    small.invert()
    turned = BALL.copy()
    turned.invert()
    centre = np.zeros((1, 3))
    for mesh, inside, turns in (
        (turned, True, True),
        (trimesh.util.concatenate([BALL, small]), False, False),
        (trimesh.util.concatenate([BALL, apart]), True, False),
    ):
        vertices, faces, messages = mended(mesh.vertices, mesh.faces)
        assert Surface(vertices, faces).inside(centre)[0] == inside
        assert ("surface-flipped" in {m.code for m in messages}) == turns
    assert "surface-pieces" in {m.code for m in messages}


def test_patches_that_meet_but_for_rounding_are_one():
    side = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    other = side + np.array([1 + 1e-12, 0, 0])
    quad = np.array([[0, 1, 2], [0, 2, 3]])
    vertices, _, messages = mended(np.vstack([side, other]), np.vstack([quad, quad + 4]))
    assert len(vertices) == 6
    assert not messages


def test_a_strip_with_one_side_is_reported():
    t = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    half = np.stack([np.cos(t / 2) * np.cos(t), np.cos(t / 2) * np.sin(t), np.sin(t / 2)], axis=1)
    middle = 4 * np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    k, n = np.arange(40), np.roll(np.arange(40), -1)
    a, b, c, d = k, k + 40, n + 40, n
    c, d = np.where(n == 0, 0, c), np.where(n == 0, 40, d)
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    _, kept, messages = mended(np.vstack([middle - half, middle + half]), faces)
    assert len(kept) == 80
    assert [message.code for message in messages] == ["surface-one-sided"]


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("a.stl", b"", "is damaged or holds nothing"),
        ("a.stl", b"no mesh at all", "is damaged"),
        ("a.stl", b"\0" * 84, "is damaged or holds nothing"),
        ("a.ply", b"hello", "is damaged, or no PLY file"),
        ("a.glb", b"glTF", "is damaged, or no GLB file"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "is damaged|holds"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "has no triangle that can be used"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "has the vertex 0; OBJ counts from 1"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 1 0/3/4\n", "has the vertex 0"),
        ("a.3dm", b"hello", "no Rhino file"),
        ("a.step", b"ISO-10303-21", "the ending is not one of .stl"),
        ("a.stl", b"version https://git-lfs.github.com/spec/v1\n", "pointer of Git LFS"),
    ],
)
def test_what_is_no_surface_is_refused_in_one_line(tmp_path, name, data, words):
    path = tmp_path / name
    path.write_bytes(data)
    with pytest.raises(InputError, match=words) as error:
        read_surface(path)
    assert "\n" not in str(error.value)
    assert str(error.value).startswith(str(path))


def test_no_file_and_a_folder_are_refused(tmp_path):
    with pytest.raises(InputError, match="there is no such file"):
        read_surface(tmp_path / "none.stl")
    with pytest.raises(InputError, match="cannot be read"):
        read_surface(tmp_path)
    with pytest.raises(InputError, match="is not the name of a file"):
        read_surface(tmp_path / "a\0.stl")
    with pytest.raises(InputError, match="an address on the web is no file"):
        read_surface("https://example.org/a.stl")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes have names on POSIX systems only")
def test_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "a.stl")
    with pytest.raises(InputError, match="is a device or a pipe"):
        read_surface(tmp_path / "a.stl")


def test_surfaces_of_rhino_are_tessellated_in_their_unit(tmp_path):
    model = rhino3dm.File3dm()
    model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Centimeters
    ball = rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 2.0)
    model.Objects.AddBrep(rhino3dm.Brep.CreateFromSphere(ball))
    model.Objects.AddLine(rhino3dm.Point3d(0, 0, 0), rhino3dm.Point3d(9, 0, 0))
    model.Write(str(tmp_path / "a.3dm"), 7)
    surface = read_surface(tmp_path / "a.3dm")
    assert surface.closed
    assert surface.inside(np.zeros((1, 3)))[0]
    middles = surface.vertices[surface.faces].mean(axis=1)
    assert np.abs(np.linalg.norm(middles, axis=1) - 20).max() < 0.01
    assert "1 LineCurve" in surface.warnings[0].message
    curve = read_curve(tmp_path / "a.3dm")
    np.testing.assert_allclose(curve.points, [[0, 0, 0], [90, 0, 0]])


def test_meshes_and_blocks_of_rhino(tmp_path):
    model = rhino3dm.File3dm()
    model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Millimeters
    mesh = rhino3dm.Mesh()
    for x, y in ((0, 0), (10, 0), (10, 10), (0, 10)):
        mesh.Vertices.Add(x, y, 3)
    mesh.Faces.AddFace(0, 1, 2, 3)
    model.Objects.AddMesh(mesh)
    hidden = rhino3dm.ObjectAttributes()
    hidden.Visible = False
    model.Objects.AddMesh(mesh, hidden)
    off, below = rhino3dm.Layer(), rhino3dm.Layer()
    off.Name, below.Name, off.Visible = "off", "below", False
    below.ParentLayerId = model.Layers[model.Layers.Add(off)].Id
    unseen = rhino3dm.ObjectAttributes()
    unseen.LayerIndex = model.Layers.Add(below)
    model.Objects.AddMesh(mesh, unseen)
    model.Write(str(tmp_path / "a.3dm"), 7)
    surface = read_surface(tmp_path / "a.3dm")
    assert len(surface.faces) == 2
    assert surface.vertices[:, 2].tolist() == [3.0] * 4
    assert "2 hidden objects" in surface.warnings[0].message


def test_heights_by_an_expression_and_by_a_table():
    surface = surface_of_heights("20*sin(x/30) + max(y, 0)", (-50, 50), (-30, 30), 1.0)
    x, y, z = surface.vertices.T
    np.testing.assert_allclose(z, 20 * np.sin(x / 30) + np.maximum(y, 0))
    assert surface.normals[:, 2].min() > 0
    assert (np.ptp(x), np.ptp(y)) == (100, 60)
    table = surface_of_heights([[0, 0, 1], [0, 2, 3]], (0, 2), (0, 1))
    near, _, _ = table.closest([[2.0, 0.0, 9.0], [1.0, 1.0, 9.0]])
    np.testing.assert_allclose(near[:, 2], [1, 2], atol=2)


@pytest.mark.parametrize(
    ("heights", "words"),
    [
        ("x^2", r"a power is written \*\*"),
        ("sin(x", "cannot be read"),
        ("1/x", "no finite value at x = 0"),
        ("9**9**9", "no finite value"),
        ("__import__('os').system('ls')", "heights hold"),
        ("x.real", "heights hold"),
        ("[x for y in x]", "heights hold"),
        ("sin(x, y)", "sin with 2 arguments; it takes 1"),
        ("(" * 300 + "x" + ")" * 300, "cannot be read"),
        ("x" * 2000, "at most 1000"),
        ("", "cannot be read"),
        ([[1, 2]], "a table of 2 to"),
        ([[1, 2], [3]], "no table"),
        ([[1, 2], [3, np.nan]], r"heights\[1\]\[1\] is no finite number"),
    ],
)
def test_heights_hold_nothing_but_numbers(heights, words):
    with pytest.raises(InputError, match=words):
        surface_of_heights(heights, (-50, 50), (-50, 50))


def test_a_rectangle_has_sides_and_few_points():
    with pytest.raises(InputError, match="the second is the larger one"):
        surface_of_heights("x", (5, 5), (0, 1))
    with pytest.raises(InputError, match="a side has at most"):
        surface_of_heights("x", (0, 1000), (0, 1000), 0.01)


def test_curves_of_tables_and_drawings(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("x [cm], y [cm], z [cm]\n0,0,0\n1,0,0\n1,0,0\n1,2,3\n")
    np.testing.assert_allclose(read_curve(path).points, [[0, 0, 0], [10, 0, 0], [10, 20, 30]])
    path.write_text("0,0,0,5,0,0\n9,4,0,5,0,0\n")  # two lines that meet
    np.testing.assert_allclose(read_curve(path, "mm").points, [[0, 0, 0], [5, 0, 0], [9, 4, 0]])
    path.write_text("0,0,0,5,0,0\n9,4,0,7,0,0\n")
    with pytest.raises(InputError, match=r"2 separate curves.*there are two or three columns"):
        read_curve(path)
    svg = tmp_path / "a.svg"
    svg.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="80mm" height="80mm" viewBox="0 0 80 80">'
        '<path fill="none" stroke="black" d="M0 40 A40 40 0 0 1 80 40"/></svg>'
    )
    curve = read_curve(svg)
    centre = curve.points[[0, -1]].mean(axis=0)
    np.testing.assert_allclose(np.linalg.norm(curve.points - centre, axis=1), 40, atol=0.05)
