import math
import uuid
from pathlib import Path

import numpy as np
import pytest
import rhino3dm
from cad import beams, broken, expected, left_out, sagitta, segments
from rhino3dm import Point3d, Vector3d

from simulearn.drawings import collecting, rhino_file
from simulearn.drawings.drawing import Drawing
from simulearn.drawings.rhino import read_3dm
from simulearn.errors import InputError


def new(unit: str = "Millimeters") -> rhino3dm.File3dm:
    model = rhino3dm.File3dm()
    model.Settings.ModelUnitSystem = getattr(rhino3dm.UnitSystem, unit)
    return model


def grid(unit: str = "Millimeters", scale: float = 1.0) -> rhino3dm.File3dm:
    model = new(unit)
    for start, end in beams():
        add(model, line(np.array(start) * scale, np.array(end) * scale))
    return model


def line(start, end) -> rhino3dm.LineCurve:
    return rhino3dm.LineCurve(point(start), point(end))


def point(place) -> Point3d:
    x, y, z = (*map(float, place), 0.0)[:3]
    return Point3d(x, y, z)


def layer(
    model, name: str, colour=(0, 0, 0), parent: int | None = None, visible: bool = True
) -> int:
    new_layer = rhino3dm.Layer()
    new_layer.Name, new_layer.Color, new_layer.Visible = name, (*colour, 255), visible
    if parent is not None:
        new_layer.ParentLayerId = model.Layers[parent].Id
    return model.Layers.Add(new_layer)


def attributes(on: int = -1, **values) -> rhino3dm.ObjectAttributes:
    found = rhino3dm.ObjectAttributes()
    found.LayerIndex = on
    for name, value in values.items():
        setattr(found, name, value)
    return found


def add(model, geometry, with_attributes=None) -> None:
    model.Objects.Add(geometry, with_attributes or attributes())


def block(model, name: str, things, *with_attributes) -> object:
    given = with_attributes or tuple(attributes() for _ in things)
    number = model.InstanceDefinitions.Add(
        name, "", "", "", Point3d(0, 0, 0), tuple(things), tuple(given)
    )
    return model.InstanceDefinitions.FindIndex(number).Id


def place(model, id_of_block, transform=None, with_attributes=None) -> None:
    transform = transform or rhino3dm.Transform.Identity()
    reference = rhino3dm.InstanceReference(id_of_block, transform)
    model.Objects.AddInstanceObject(reference, with_attributes or attributes())


@pytest.fixture
def written(tmp_path: Path):
    def write(model, version: int = 8) -> bytes:
        path = tmp_path / "drawing.3dm"
        assert model.Write(str(path), version)
        return path.read_bytes()

    return write


@pytest.fixture
def read(written):
    return lambda model: read_3dm(written(model))


def ends(drawing: Drawing) -> list[list[float]]:
    return [found.points.round(6).tolist() for found in drawing.lines]


@pytest.mark.parametrize("version", [4, 5, 6, 7, 8])
def test_all_versions_are_read(written, version: int) -> None:
    drawing = read_3dm(written(grid(), version))
    assert drawing.format == "Rhino (.3dm)"
    assert segments(drawing) == expected()
    assert not drawing.left_out
    assert not drawing.messages


def test_a_line_says_where_it_is(read) -> None:
    model = new()
    beams_layer = layer(model, "beams")
    add(model, line((0, 0, 3), (65, 0, 4)), attributes(beams_layer, Name="edge"))
    add(model, line((0, 0), (65, 0)), attributes(beams_layer))
    named, plain = read(model).lines
    assert named.where == "line edge"
    assert plain.where.startswith("line ")
    assert len(plain.where) == len("line ") + 8
    assert named.points.tolist() == [[0, 0, 3], [65, 0, 4]]
    assert named.layer == "beams"


def test_straight_curves_of_every_kind_are_lines(read) -> None:
    model = new()
    corners = [point(p) for p in [(0, 0), (65, 0), (65, 65), (0, 0)]]
    add(model, rhino3dm.Polyline.CreateFromPoints(corners).ToPolylineCurve())
    joined = rhino3dm.PolyCurve()
    joined.Append(rhino3dm.Line(point((0, 0)), point((65, 0))))
    joined.Append(rhino3dm.Line(point((65, 0)), point((65, 65))))
    add(model, joined)
    add(model, rhino3dm.NurbsCurve.CreateFromLine(rhino3dm.Line(point((0, 0)), point((65, 9)))))
    add(model, rhino3dm.NurbsCurve.Create(False, 1, [point(p) for p in [(0, 0), (9, 9), (65, 0)]]))
    cubic = [point(p) for p in [(0, 0), (20, 0.0004), (40, 0), (65, 0)]]
    add(model, rhino3dm.NurbsCurve.Create(False, 3, cubic))
    drawing = read(model)
    assert not drawing.curves
    assert ends(drawing) == [
        [[0, 0, 0], [65, 0, 0], [65, 65, 0], [0, 0, 0]],
        [[0, 0, 0], [65, 0, 0], [65, 65, 0]],
        [[0, 0, 0], [65, 9, 0]],
        [[0, 0, 0], [9, 9, 0], [65, 0, 0]],
        [[0, 0, 0], [65, 0, 0]],
    ]


def test_curves_are_curves_as_fine_as_requested(read) -> None:
    model = new()
    circle = rhino3dm.Circle(point((10, 20)), 30)
    add(model, rhino3dm.ArcCurve.CreateFromArc(rhino3dm.Arc(circle, math.pi / 2)))
    add(model, rhino3dm.ArcCurve.CreateFromCircle(circle))
    free = [point(p) for p in [(0, 0), (20, 9), (40, 0), (65, 7)]]
    add(model, rhino3dm.NurbsCurve.Create(False, 3, free))
    add(model, rhino3dm.NurbsCurve.Create(True, 3, free))
    arc, whole, spline, periodic = read(model).curves
    assert [c.kind for c in (arc, whole, spline)] == ["arc", "circle", "NURBS curve"]
    assert sagitta(arc.flatten(0.1), (10, 20), 30) <= 0.1
    np.testing.assert_allclose(arc.flatten(0.1)[[0, -1]], [[40, 20, 0], [10, 50, 0]], atol=1e-9)
    assert sagitta(whole.flatten(0.1), (10, 20), 30) <= 0.1
    np.testing.assert_allclose(spline.flatten(0.1)[[0, -1]], [[0, 0, 0], [65, 7, 0]])
    original = rhino3dm.NurbsCurve.Create(True, 3, free)
    np.testing.assert_allclose(
        periodic.flatten(0.1)[0], [original.PointAtStart.X, original.PointAtStart.Y, 0], atol=1e-9
    )
    np.testing.assert_allclose(periodic.flatten(0.1)[0], periodic.flatten(0.1)[-1], atol=1e-9)
    for curve in (arc, whole, spline, periodic):
        assert len(curve.flatten(0)) <= 40_000


def test_a_mixed_polycurve_gives_lines_and_curves(read) -> None:
    model = new()
    mixed = rhino3dm.PolyCurve()
    mixed.Append(rhino3dm.Line(point((0, 0)), point((65, 0))))
    mixed.Append(rhino3dm.Arc(point((65, 0)), Vector3d(1, 0, 0), point((75, 10))))
    mixed.Append(rhino3dm.Line(point((75, 10)), point((75, 65))))
    add(model, mixed)
    drawing = read(model)
    assert ends(drawing) == [[[0, 0, 0], [65, 0, 0]], [[75, 10, 0], [75, 65, 0]]]
    assert [curve.kind for curve in drawing.curves] == ["arc"]


def test_blocks_are_placed_nested_and_mirrored(read) -> None:
    model = new()
    edge = block(model, "EDGE", [line((0, 0), (65, 0))])
    transform = rhino3dm.Transform
    up = transform.Rotation(math.pi / 2, Vector3d(0, 0, 1), Point3d(0, 0, 0))
    four = [
        transform.Identity(),
        transform.Translation(0, 65, 0),
        up,
        transform.Multiply(transform.Translation(65, 0, 0), up),
    ]
    cell = block(model, "CELL", [rhino3dm.InstanceReference(edge, t) for t in four])
    place(model, cell)
    place(model, cell, transform.Translation(65, 0, 0))
    place(model, cell, transform.Mirror(Point3d(0, 65, 0), Vector3d(0, 1, 0)))
    drawing = read(model)
    assert segments(drawing) == expected()
    assert len(drawing.lines) == 12  # and none of the blocks' own contents
    assert drawing.lines[0].where.endswith(" in block EDGE")


def test_unequal_scales_hold_for_curves_too(read) -> None:
    model = new()
    ring = block(
        model, "R", [rhino3dm.ArcCurve.CreateFromCircle(rhino3dm.Circle(Point3d(0, 0, 0), 10))]
    )
    plane = rhino3dm.Plane.WorldXY()
    place(model, ring, rhino3dm.Transform.Scale(plane, 3, 1, 1))
    points = read(model).curves[0].flatten(0.01)
    np.testing.assert_allclose((points[:, 0] / 30) ** 2 + (points[:, 1] / 10) ** 2, 1)


def test_unused_blocks_are_not_read(read) -> None:
    model = grid()
    block(model, "UNUSED", [line((0, 0), (500, 0))])
    assert segments(read(model)) == expected()


def test_blocks_that_multiply_are_refused(read) -> None:
    model = new()
    inner = block(model, "B0", [line((0, 0), (1, 0))])
    for level in range(1, 12):
        identity = rhino3dm.Transform.Identity()
        tens = [rhino3dm.InstanceReference(inner, identity) for _ in range(10)]
        inner = block(model, f"B{level}", tens)
    place(model, inner)
    with pytest.raises(InputError, match="objects") as caught:
        read(model)
    assert caught.value.code == "too-large"


def test_a_block_that_is_not_in_the_file_is_reported(read) -> None:
    model = grid()
    place(model, uuid.uuid4())
    drawing = read(model)
    assert segments(drawing) == expected()
    assert left_out(drawing) == {("block instance", "", "its block is not in the file"): 1}


def test_layers_have_full_names_and_colours_are_inherited(read) -> None:
    model = new()
    source = rhino3dm.ObjectColorSource
    outer = layer(model, "skeleton", (1, 2, 3))
    inner = layer(model, "top 0.5", (255, 0, 0), parent=outer)
    own = attributes(inner, ColorSource=source.ColorFromObject, ObjectColor=(0, 0, 255, 255))
    parent = attributes(inner, ColorSource=source.ColorFromParent)
    add(model, line((0, 0), (1, 0)), attributes(inner))
    add(model, line((0, 0), (2, 0)), own)
    part = block(
        model, "B", [line((0, 0), (3, 0)), line((0, 0), (4, 0))], parent, attributes(outer)
    )
    place(model, part, None, own)
    found = [(item.layer, item.colour) for item in read(model).lines]
    assert found == [
        ("skeleton::top 0.5", "#ff0000"),
        ("skeleton::top 0.5", "#0000ff"),
        ("skeleton::top 0.5", "#0000ff"),
        ("skeleton", "#010203"),
    ]


def test_what_is_not_seen_is_counted(read) -> None:
    model = grid()
    off = layer(model, "off", visible=False)
    below = layer(model, "below", parent=off)
    shown = layer(model, "shown")
    diagonal = line((0, 0), (130, 130))
    mode = rhino3dm.ObjectMode
    add(model, diagonal, attributes(off))
    add(model, diagonal, attributes(below))
    add(model, diagonal, attributes(shown, Visible=False))
    add(model, diagonal, attributes(shown, Mode=mode.Hidden))
    add(model, diagonal, attributes(shown, ActiveSpace=rhino3dm.ActiveSpace.PageSpace))
    add(model, line((0, 0), (7, 7)), attributes(shown, Mode=mode.Locked))
    inside = block(model, "B", [diagonal], attributes(off))
    place(model, inside, None, attributes(shown))
    place(model, inside, None, attributes(off))
    drawing = read(model)
    assert segments(drawing) == expected() | {frozenset({(0, 0, 0), (7, 7, 0)})}
    assert left_out(drawing) == {
        ("line", "off", "its layer is off"): 2,
        ("line", "off::below", "a layer above its layer is off"): 1,
        ("line", "shown", "is hidden"): 2,
        ("line", "shown", "is on a page of the layout"): 1,
        ("block instance", "off", "its layer is off"): 1,
    }


def test_everything_else_is_counted_by_kind_and_layer(read) -> None:
    model = grid()
    notes = layer(model, "notes")
    on_notes = attributes(notes)
    mesh = rhino3dm.Mesh()
    for corner in [(0, 0, 0), (1, 0, 0), (1, 1, 0)]:
        mesh.Vertices.Add(*corner)
    mesh.Faces.AddFace(0, 1, 2)
    sphere = rhino3dm.Sphere(Point3d(0, 0, 0), 3)
    add(model, rhino3dm.TextDot("a", Point3d(0, 0, 0)), on_notes)
    add(model, rhino3dm.TextDot("b", Point3d(0, 0, 0)), on_notes)
    add(model, rhino3dm.Point(Point3d(0, 0, 0)), on_notes)
    add(model, rhino3dm.PointCloud([Point3d(0, 0, 0)]), on_notes)
    add(model, mesh, on_notes)
    add(model, rhino3dm.Brep.CreateFromSphere(sphere), on_notes)
    add(model, rhino3dm.NurbsSurface.CreateFromSphere(sphere), on_notes)
    circle = rhino3dm.ArcCurve.CreateFromCircle(rhino3dm.Circle(Point3d(0, 0, 0), 1))
    add(model, rhino3dm.Extrusion.Create(circle, 5, True), on_notes)
    drawing = read(model)
    assert segments(drawing) == expected()
    counts = {(kind, on): n for (kind, on, _), n in left_out(drawing).items()}
    assert counts == {
        ("text dot", "notes"): 2,
        ("point", "notes"): 1,
        ("point cloud", "notes"): 1,
        ("mesh", "notes"): 1,
        ("polysurface", "notes"): 1,
        ("surface", "notes"): 1,
        ("extrusion", "notes"): 1,
    }


UNITS = {
    "Angstroms": 1e-7,
    "Nanometers": 1e-6,
    "Microns": 1e-3,
    "Millimeters": 1,
    "Centimeters": 10,
    "Decimeters": 100,
    "Meters": 1e3,
    "Dekameters": 1e4,
    "Hectometers": 1e5,
    "Kilometers": 1e6,
    "Megameters": 1e9,
    "Gigameters": 1e12,
    "Microinches": 25.4e-6,
    "Mils": 0.0254,
    "Inches": 25.4,
    "Feet": 304.8,
    "Yards": 914.4,
    "Miles": 1609344,
    "PrinterPoints": 25.4 / 72,
    "PrinterPicas": 25.4 / 6,
    "NauticalMiles": 1852e3,
    "AstronomicalUnits": 1.495978707e14,
    "LightYears": 9.4607304725808e18,
    "Parsecs": 3.0856775814913673e19,
}


def test_units_of_the_file(read) -> None:
    named = set(rhino3dm.UnitSystem.__members__) - {"None", "CustomUnits", "Unset"}
    assert named == set(UNITS)
    for name, length in UNITS.items():
        drawing = read(grid(name))
        assert drawing.unit is not None
        assert drawing.unit.mm == pytest.approx(length, rel=1e-9)
        assert drawing.unit.source == f"the file's unit is {name}"


@pytest.mark.parametrize("system", ["None", "Unset", "CustomUnits"])
def test_a_file_can_be_without_unit(read, system: str) -> None:
    drawing = read(grid(system, scale=0.001))
    assert drawing.unit is None
    assert bool(drawing.messages) == (system == "CustomUnits")


@pytest.mark.parametrize(
    "data",
    [b"", b"\x00" * 100, b"0\nSECTION\n", b"3D Geometry File Format        8", b"PK\x03\x04"],
)
def test_other_files_are_refused(data: bytes) -> None:
    with pytest.raises(InputError, match=r"no Rhino file|damaged") as caught:
        read_3dm(data)
    assert caught.value.code == "3dm-broken"
    assert "\n" not in str(caught.value)


def test_objects_that_are_damaged_are_reported(written) -> None:
    data = bytearray(written(grid()))
    record = (0x20008070).to_bytes(4, "little")  # begins every object
    fourth = -1
    for _ in range(4):
        fourth = data.index(record, fourth + 1)
    data[fourth + 36] ^= 1  # what says that the class of the object follows
    drawing = read_3dm(bytes(data))
    assert len(drawing.lines) == 3
    assert drawing.messages == ["The file is damaged: 7 of its objects could not be read."]


def test_a_process_that_does_not_end_is_stopped(
    read, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "rhino_process.py").write_text("while True: pass")
    monkeypatch.setattr(rhino_file, "TIMEOUT", 0.5)
    monkeypatch.setattr(rhino_file, "__file__", str(tmp_path / "rhino_file.py"))
    with pytest.raises(InputError, match="could not be read in"):
        read(grid())


def test_a_process_that_crashes_is_reported(
    read, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "rhino_process.py").write_text("import os; os.abort()")
    monkeypatch.setattr(rhino_file, "__file__", str(tmp_path / "rhino_file.py"))
    with pytest.raises(InputError, match="damaged"):
        read(grid())


def test_too_many_lines_are_refused(read, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(collecting, "MAX_SEGMENTS", 9)
    with pytest.raises(InputError, match="more than 9 line segments"):
        read(grid())


def test_broken_files_give_a_drawing_or_one_line(written, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rhino_file, "TIMEOUT", 5.0)
    model = grid()
    part = block(model, "B", [line((0, 0), (1, 0))])
    place(model, part, rhino3dm.Transform.Translation(3, 4, 0), attributes(layer(model, "x")))
    add(model, rhino3dm.ArcCurve.CreateFromCircle(rhino3dm.Circle(Point3d(0, 0, 0), 10)))
    refused = []
    for case in broken(written(model), 100, seed=14):
        try:
            drawing = read_3dm(case)
        except InputError as error:
            refused.append(str(error))
            continue
        for curve in drawing.curves:
            curve.flatten(0.1)
    assert 0 < len(refused) <= 100
    assert not any("\n" in text for text in refused)


def test_all_of_3000_lines_are_read(written) -> None:
    model = new()
    for number in range(3000):
        add(model, line((number, 0), (number, 65)))
    data = written(model)
    drawing = read_3dm(data)
    assert len(drawing.lines) == 3000
