"""Rhino files: layers, names and closed shapes, as rhino3dm reads them."""

from collections import Counter

import bent
import numpy as np
import pytest
import rhino3dm

import synthetic
from simulearn.drawings.importing import imported
from simulearn.errors import InputError
from simulearn.fabricate import load_printer, prepare
from simulearn.fabricate.toolpath import ROLES
from simulearn.interop import write_3dm, write_job_3dm
from simulearn.inverse.goals import Goals, Vertex

SQUARE = synthetic.square_grid((1, 2), actuators=[0.25, -1, 0, 1, -0.75, 0.5, 0.25])
RESULT = bent.result(SQUARE)


def read(path):
    """Return the document, and its objects by the full names of their layers."""
    model = rhino3dm.File3dm.Read(str(path))
    objects = {}
    for one in model.Objects:
        layer = model.Layers[one.Attributes.LayerIndex].FullPath
        objects.setdefault(layer, []).append((one.Attributes.Name, one.Geometry, one.Attributes))
    return model, objects


def written(tmp_path, *args, **more):
    path = tmp_path / "a.3dm"
    write_3dm(*args, path, **more)
    return read(path)


def points(curve):
    """Return the corners (n, 3) of a polyline or line."""
    if isinstance(curve, rhino3dm.LineCurve):
        ends = curve.PointAtStart, curve.PointAtEnd
    else:
        ends = curve.ToPolyline() if hasattr(curve, "ToPolyline") else curve.TryGetPolyline()
    return np.array([[p.X, p.Y, p.Z] for p in ends])


def test_the_skeleton_has_a_layer_for_each_ratio(tmp_path):
    model, objects = written(tmp_path, RESULT)
    assert model.Settings.ModelUnitSystem == rhino3dm.UnitSystem.Millimeters
    layers = {layer.FullPath: layer for layer in model.Layers}
    words = {0.25: "top 0.25", -1: "bottom 1", 0: "passive", 1: "top 1", -0.75: "bottom 0.75",
             0.5: "top 0.5"}  # fmt: skip
    grid = RESULT.grid
    found = {}
    for name, of in objects.items():
        if name.startswith("skeleton::"):
            found |= {title: (name, points(curve)) for title, curve, _ in of}
    assert len(found) == len(grid.beams)
    for b, (ends, ratio) in enumerate(zip(grid.beams, grid.actuators, strict=True)):
        layer, places = found[f"beam {b}"]
        assert layer == f"skeleton::{words[ratio]}"
        np.testing.assert_allclose(places[:, :2], grid.joints[ends], atol=1e-9)
        assert not places[:, 2].any()
    tints = {"top 0.25": "e7a46f", "bottom 0.75": "2586bd", "passive": "dcdcdc", "top 1": "d55e00"}
    for word, tint in tints.items():
        colour = layers[f"skeleton::{word}"].Color[:3]
        np.testing.assert_allclose(colour, [*bytes.fromhex(tint)], atol=1)


def area(places):
    x, y = places[:-1, :2].T
    return abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


def test_outlines_and_actuators_are_closed_and_flat(tmp_path):
    _, objects = written(tmp_path, RESULT)
    outlines = {name: curve for name, curve, _ in objects["outlines"]}
    count = len(RESULT.grid.joints) + len(RESULT.grid.beams)
    assert len(outlines) == len(objects["outlines"]) == count
    for name, curve in outlines.items():
        assert curve.IsClosed
        places = points(curve)
        assert not places[:, 2].any()
        assert area(places) == pytest.approx(7.2 * (57.8 if "beam" in name else 7.2))
    shapes = {}
    for layer, of in objects.items():
        if layer.startswith("actuators::"):
            shapes |= {name: (layer, curve) for name, curve, _ in of}
    ratios = RESULT.grid.actuators
    assert set(shapes) == {f"beam {b}" for b in np.flatnonzero(ratios)}
    for name, (layer, curve) in shapes.items():
        ratio = ratios[int(name.split()[1])]
        assert curve.IsClosed
        assert area(points(curve)) == pytest.approx(7.2 * 57.8 * abs(ratio))
        assert layer.split("::")[1] == f"{'top' if ratio > 0 else 'bottom'} {abs(ratio):g}"


def test_frames_are_closed_meshes_of_which_the_last_shows(tmp_path):
    model, objects = written(tmp_path, RESULT)
    visible = {layer.FullPath: layer.Visible for layer in model.Layers}
    for frame in range(12):
        layer = f"frames::frame {frame:02d}"
        ((name, mesh, attributes),) = objects[layer]
        assert name == f"frame {frame:02d}"
        assert visible[layer] == (frame == 11)
        assert mesh.IsClosed
        assert mesh.IsValid
        seen = np.array([[v.X, v.Y, v.Z] for v in mesh.Vertices])
        corners = np.concatenate(
            [RESULT.joints[frame].reshape(-1, 3), RESULT.beams[frame].reshape(-1, 3)]
        )
        away = np.linalg.norm(corners[:, None] - seen, axis=2).min(axis=1)
        assert away.max() < 1e-3
        assert attributes.GetUserString("released") == f"{min(frame, 10) / 10:g}"
        assert attributes.GetUserString("engine") == "none"
    facts = dict(model.Strings[k] for k in range(len(model.Strings)))
    assert facts["stable"] == "yes"
    assert facts["bound"] == "not known"
    assert facts["material"].startswith("pla-hot-water")
    assert set(facts) >= {"engine", "model", "snaps", "warnings"}


def test_targets_are_points_with_their_names(tmp_path):
    vertices = [Vertex("joint", 3), Vertex("beam", 1, 2, 1)]
    goals = Goals.of(vertices, np.array([[1.0, 2, 3], [4, 5, 6]]))
    _, objects = written(tmp_path, RESULT, goals=goals)
    kinds = Counter(type(geometry).__name__ for _, geometry, _ in objects["targets"])
    assert kinds == {"Point": 2, "TextDot": 2}
    names = {name: g for name, g, _ in objects["targets"] if isinstance(g, rhino3dm.Point)}
    assert set(names) == {"joint 3, centre", "beam 1, middle, corner 2"}
    place = names["joint 3, centre"].Location
    assert (place.X, place.Y, place.Z) == (1, 2, 3)
    texts = {g.Text for _, g, _ in objects["targets"] if isinstance(g, rhino3dm.TextDot)}
    assert texts == set(names)


def of_roles(objects):
    return {layer: of for layer, of in objects.items() if layer.startswith("toolpath::")}


def test_the_toolpath_lies_on_the_flat_grid_whichever_side_was_printed_first(tmp_path):
    long = bent.result(synthetic.square_grid((1, 5), length=45, actuators=[0.5, -1.0] * 8))
    for result in (RESULT, long):  # the long one is turned on the bed of this printer
        job = prepare([result.grid], load_printer("makerbot-2x"))
        _, objects = written(tmp_path, result, job=job)
        roles = of_roles(objects)
        used = {bead.role for layer in job.path.layers for bead in layer.beads}
        assert used >= set(ROLES) - {"skirt"}  # there is room for one only beside the long one
        assert set(roles) == {f"toolpath::{role}" for role in used}
        beads = sum(len(layer.beads) for layer in job.path.layers)
        assert sum(map(len, roles.values())) == beads
        flat = result.joints[0].reshape(-1, 3)
        places = np.concatenate([points(curve) for _, curve, _ in roles["toolpath::shell"]])
        assert (places.min(0) >= flat.min(0) - 1e-6).all()
        assert (places.max(0) <= flat.max(0) + 1e-6).all()
        np.testing.assert_allclose(
            np.ptp(places[:, :2], axis=0), np.ptp(flat[:, :2], axis=0), atol=1
        )
        # Beads of a beam lie between its joints.
        for name, curve, _ in roles["toolpath::active"]:
            ends = result.grid.joints[result.grid.beams[int(name.split()[1])]]
            low, high = ends.min(0) - 3.6, ends.max(0) + 3.6
            assert ((points(curve)[:, :2] >= low) & (points(curve)[:, :2] <= high)).all()


def test_the_print_of_another_grid_is_refused(tmp_path):
    job = prepare([synthetic.square_grid()], load_printer("makerbot-2x"))
    with pytest.raises(InputError, match="another grid"):
        write_3dm(RESULT, tmp_path / "a.3dm", job=job)
    assert not [*tmp_path.iterdir()]


def test_a_print_alone_lies_on_the_bed(tmp_path):
    grids = [SQUARE, synthetic.square_grid((1, 1))]
    job = prepare(grids, load_printer("makerbot-2x"), ["one", "two"])
    path = tmp_path / "a.3dm"
    write_job_3dm(job, path)
    model, objects = read(path)
    names = {name for of in objects.values() for name, _, _ in of}
    assert {"one: beam 6", "two: joint 3"} <= names
    places = np.concatenate([points(c) for of in of_roles(objects).values() for _, c, _ in of])
    np.testing.assert_allclose(places[:, :2].min(0), job.path.bounds[0], atol=1e-9)
    np.testing.assert_allclose(np.unique(places[:, 2]), [layer.z for layer in job.path.layers])
    assert "printer" in dict(model.Strings[k] for k in range(len(model.Strings)))


def test_what_is_written_can_be_read_as_a_drawing(tmp_path):
    path = tmp_path / "a.3dm"
    write_3dm(RESULT, path, Goals.centres(RESULT.centres[-1]))
    back = imported(path.read_bytes(), path.name).grid
    offset = back.joints.min(axis=0) - RESULT.grid.joints.min(axis=0)

    def beams(grid, shift):
        return {
            (*sorted(map(tuple, (grid.joints[ends] + shift).round(3).tolist())), ratio)
            for ends, ratio in zip(grid.beams, grid.actuators.tolist(), strict=True)
        }

    assert beams(back, 0.0) == beams(RESULT.grid, offset)


def test_the_command_gcode_writes_the_toolpath_for_rhino(tmp_path, run):
    path = tmp_path / "print.3DM"
    code, _, _ = run("gcode", "twist", "--printer", "ender-3", "-o", path)
    assert code == 0
    _, objects = read(path)
    assert {"skeleton::top 1", "outlines", "toolpath::active"} <= set(objects)
