import io
import math
from itertools import pairwise

import ezdxf
import numpy as np
import pytest
from cad import beams, broken, expected, left_out, sagitta, segments
from ezdxf import xclip
from ezdxf.document import Drawing as Document

from simulearn.drawings import collecting
from simulearn.drawings.drawing import Drawing
from simulearn.drawings.dxf import read_dxf
from simulearn.errors import InputError

VERSIONS = ["R12", "R2000", "R2004", "R2007", "R2010", "R2013", "R2018"]


def new(version: str = "R2010", units: int = 4) -> Document:
    return ezdxf.new(version, units=units)


def grid(version: str = "R2010", units: int = 4, scale: float = 1.0) -> Document:
    document = new(version, units)
    for start, end in beams():
        document.modelspace().add_line(np.array(start) * scale, np.array(end) * scale)
    return document


def written(document: Document, binary: bool = False) -> bytes:
    if binary:
        found = io.BytesIO()
        document.write(found, fmt="bin")
        return found.getvalue()
    text = io.StringIO()
    document.write(text)
    return text.getvalue().encode(document.output_encoding, errors="dxfreplace")


def read(document: Document) -> Drawing:
    return read_dxf(written(document))


def ends(drawing: Drawing) -> list[list[float]]:
    return [line.points.round(6).tolist() for line in drawing.lines]


@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("version", VERSIONS)
def test_all_versions_are_read(version: str, binary: bool) -> None:
    drawing = read_dxf(written(grid(version), binary))
    assert drawing.format == "DXF"
    assert segments(drawing) == expected()
    assert not drawing.left_out
    assert not drawing.messages


def test_line_ends_and_comments_do_not_matter() -> None:
    data = b"999\r\na remark\r\n" + written(grid()).replace(b"\n", b"\r\n")
    assert segments(read_dxf(data)) == expected()


def test_a_file_of_entities_alone_is_read() -> None:
    text = (
        "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\nA\n10\n0\n20\n0\n11\n65\n21\n1\n0\nENDSEC\n0\nEOF\n"
    )
    drawing = read_dxf(text.encode())
    assert ends(drawing) == [[[0, 0, 0], [65, 1, 0]]]
    assert drawing.lines[0].layer == "A"
    assert drawing.unit is None


@pytest.mark.parametrize(
    ("version", "codepage", "encoding"),
    [
        ("R2000", "ANSI_1252", "cp1252"),
        ("R2000", "ANSI_1251", "cp1251"),
        ("R2000", "ANSI_932", "cp932"),
        ("R12", "ANSI_1252", "utf-8"),
        ("R2010", "ANSI_1252", "utf-8"),
        ("R2010", "ANSI_1252", "utf-8-sig"),
        ("R2010", "ANSI_1252", "cp1252"),
    ],
)
def test_names_come_out_in_any_encoding(version: str, codepage: str, encoding: str) -> None:
    name = {"cp1251": "Балка", "cp932": "梁ソ"}.get(encoding, "Träger")
    document = new(version)
    document.layers.add("TRAEGER")
    document.modelspace().add_line((0, 0), (65, 0), dxfattribs={"layer": "TRAEGER"})
    text = written(document).decode().replace("TRAEGER", name).replace("ANSI_1252", codepage)
    assert read_dxf(text.encode(encoding)).lines[0].layer == name


def test_escaped_letters_are_read() -> None:
    document = new()
    document.modelspace().add_line((0, 0), (65, 0), dxfattribs={"layer": "TRAEGER"})
    data = written(document).replace(b"TRAEGER", rb"Tr\U+00E4ger")
    assert read_dxf(data).lines[0].layer == "Träger"


def bare(entities: str, version: str = "") -> bytes:
    """Return a file as small programs write it: no marks, no handles, no tables."""
    head = f"0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\n{version}\n0\nENDSEC\n" if version else ""
    return f"{head}0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n".encode()


@pytest.mark.parametrize("version", ["", "AC1009", "AC1015", "AC1027"])
def test_files_of_small_programs_are_read(version: str) -> None:
    layer = "8\nA\n62\n1\n"
    points = "10\n0\n20\n0\n10\n10\n20\n10\n10\n20\n20\n0\n"
    knots = "40\n0\n40\n0\n40\n0\n40\n1\n40\n1\n40\n1\n"
    drawing = read_dxf(
        bare(
            f"0\nLINE\n{layer}10\n0\n20\n0\n11\n65\n21\n0\n"
            f"0\nLWPOLYLINE\n{layer}90\n3\n70\n1\n{points}"
            f"0\nSPLINE\n{layer}70\n8\n71\n2\n72\n6\n73\n3\n{knots}{points}"
            f"0\nMTEXT\n{layer}10\n0\n20\n0\n1\nabc\n"
            f"0\nARC\n{layer}10\n0\n20\n0\n40\n5\n50\n0\n51\n90\n",
            version,
        )
    )
    assert ends(drawing) == [
        [[0, 0, 0], [65, 0, 0]],
        [[0, 0, 0], [10, 10, 0], [20, 0, 0], [0, 0, 0]],
    ]
    assert {(line.layer, line.colour) for line in drawing.lines} == {("A", "#ff0000")}
    assert [curve.kind for curve in drawing.curves] == ["SPLINE", "ARC"]
    assert left_out(drawing) == {("MTEXT", "A", "is text"): 1}
    assert not drawing.messages


def test_a_file_of_r12_may_hold_later_things() -> None:
    document = grid("R12")
    document.blocks.new("B").add_line((0, 0), (0, 9))
    space = document.modelspace()
    space.add_blockref("B", (200, 0))
    space.add_polyline2d([(0, 0), (9, 9)], close=True)
    document.paperspace().add_line((0, 0), (4, 4))
    text = written(document).decode()
    place = text.index("  0\nENDSEC", text.index("ENTITIES"))
    later = "0\nLWPOLYLINE\n100\nAcDbPolyline\n8\nA\n90\n2\n70\n1\n10\n5\n20\n5\n10\n7\n20\n7\n"
    drawing = read_dxf((text[:place] + later + text[place:]).encode())
    assert segments(drawing) >= expected()
    assert ends(drawing)[-3:] == [
        [[200, 0, 0], [200, 9, 0]],
        [[0, 0, 0], [9, 9, 0], [0, 0, 0]],
        [[5, 5, 0], [7, 7, 0], [5, 5, 0]],
    ]
    assert drawing.lines[-1].layer == "A"
    assert left_out(drawing) == {("LINE", "0", "is in paper space"): 1}


def test_a_line_says_where_it_is() -> None:
    document = new()
    line = document.modelspace().add_line((0, 0, 3), (65, 0, 4))
    drawing = read(document)
    assert drawing.lines[0].where == f"LINE {line.dxf.handle}"
    assert ends(drawing) == [[[0, 0, 3], [65, 0, 4]]]


def test_polylines_are_lines_and_closed_ones_end_where_they_begin() -> None:
    document = new()
    space = document.modelspace()
    space.add_lwpolyline([(0, 0), (65, 0), (65, 65)], close=True, dxfattribs={"elevation": 2})
    space.add_polyline2d([(0, 0), (65, 0), (65, 65)], close=True)
    space.add_polyline3d([(0, 0, 1), (65, 0, 2), (65, 65, 3)])
    assert ends(read(document)) == [
        [[0, 0, 2], [65, 0, 2], [65, 65, 2], [0, 0, 2]],
        [[0, 0, 0], [65, 0, 0], [65, 65, 0], [0, 0, 0]],
        [[0, 0, 1], [65, 0, 2], [65, 65, 3]],
    ]


@pytest.mark.parametrize("kind", ["LWPOLYLINE", "POLYLINE"])
@pytest.mark.parametrize(
    ("bulge", "centre_y"), [(1.0, 0.0), (-1.0, 0.0), (math.tan(math.pi / 8), 10.0)]
)
def test_bulges_are_curves_between_straight_parts(kind: str, bulge: float, centre_y: float) -> None:
    document = new()
    corners = [(0, 0, 0), (40, 0, bulge), (60, 0, 0), (100, 0, 0), (100, 50, 0)]
    add = document.modelspace()
    if kind == "LWPOLYLINE":
        add.add_lwpolyline(corners, format="xyb")
    else:
        add.add_polyline2d(corners, format="xyb")
    drawing = read(document)
    assert ends(drawing) == [[[0, 0, 0], [40, 0, 0]], [[60, 0, 0], [100, 0, 0], [100, 50, 0]]]
    (curve,) = drawing.curves
    assert curve.kind == f"arc of {kind}"
    points = curve.flatten(0.05)
    assert sagitta(points, (50, centre_y), math.hypot(10, centre_y)) <= 0.05
    assert (points[:, 1].min() < -1) == (bulge > 0)  # a positive bulge turns left: the arc is below
    np.testing.assert_allclose(sorted(points[[0, -1], 0]), [40, 60])


def test_a_spline_fit_polyline_is_a_curve() -> None:
    document = new()
    polyline = document.modelspace().add_polyline2d([(0, 0), (10, 5), (20, 0), (30, 9)])
    polyline.dxf.flags |= polyline.SPLINE_FIT_VERTICES_ADDED
    polyline.vertices[1].dxf.flags |= 16
    drawing = read(document)
    assert not drawing.lines
    assert drawing.curves[0].flatten(0.1).tolist() == [[0, 0, 0], [20, 0, 0], [30, 9, 0]]


def test_arcs_circles_and_ellipses_are_curves_as_fine_as_requested() -> None:
    document = new()
    space = document.modelspace()
    space.add_arc((10, 20, 5), 30, 350, 80)
    space.add_circle((10, 20), 30)
    space.add_ellipse((0, 0), (40, 0), 0.5)
    arc, circle, ellipse = (curve.flatten(0.1) for curve in read(document).curves)
    assert sagitta(arc, (10, 20), 30) <= 0.1
    assert (arc[:, 2] == 5).all()
    assert sagitta(circle, (10, 20), 30) <= 0.1
    np.testing.assert_allclose(circle[0], circle[-1], atol=1e-9)
    np.testing.assert_allclose((ellipse[:, 0] / 40) ** 2 + (ellipse[:, 1] / 20) ** 2, 1)


@pytest.mark.parametrize("distance", [0.0, 1e-12, 1e9])
def test_the_number_of_chords_is_bounded(distance: float) -> None:
    document = new()
    space = document.modelspace()
    space.add_circle((0, 0), 30)
    space.add_ellipse((0, 0), (40, 0), 0.5)
    space.add_lwpolyline([(0, 0, 1), (10, 0, 0)], format="xyb")
    space.add_spline([(0, 0), (10, 5), (20, 0), (30, 9)])
    for curve in read(document).curves:
        assert 2 <= len(curve.flatten(distance)) <= 20_001
        if curve.kind in ("CIRCLE", "ELLIPSE"):
            assert len(curve.flatten(distance)) >= 4


def test_straight_splines_are_lines() -> None:
    document = new()
    space = document.modelspace()
    space.add_open_spline([(0, 0), (20, 0), (40, 0), (65, 0)], degree=3)
    space.add_open_spline([(0, 0), (20, 9), (40, 0), (65, 7)], degree=1)
    space.add_spline([(0, 0), (30, 30), (65, 65)])
    # A cubic whose knots are full in the middle, straight on both sides.
    knots = [0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2]
    corner = [(0, 0), (20, 0), (40, 0), (65, 0), (65, 20), (65, 40), (65, 65)]
    space.add_open_spline(corner, degree=3, knots=knots)
    drawing = read(document)
    assert not drawing.curves
    assert ends(drawing) == [
        [[0, 0, 0], [65, 0, 0]],
        [[0, 0, 0], [20, 9, 0], [40, 0, 0], [65, 7, 0]],
        [[0, 0, 0], [65, 65, 0]],
        [[0, 0, 0], [65, 0, 0], [65, 65, 0]],
    ]


def test_curved_splines_are_curves() -> None:
    document = new()
    space = document.modelspace()
    space.add_open_spline([(0, 0), (20, 9), (40, 0), (65, 7)], degree=3)
    space.add_rational_spline([(10, 0), (10, 10), (0, 10)], [1, math.sqrt(0.5), 1], degree=2)
    space.add_open_spline([(0, 0), (80, 0), (-20, 0), (65, 0)], degree=3)  # runs back on its line
    space.add_spline().set_closed([(0, 0, 0), (20, 0, 0), (20, 20, 0), (0, 20, 0)])
    free, arc, back, closed = read(document).curves
    assert free.kind == "SPLINE"
    chords, fine = free.flatten(0.1), free.flatten(1e-4)
    gaps = [min(_distance(p, a, b) for a, b in pairwise(chords)) for p in fine]
    assert max(gaps) <= 0.1
    assert sagitta(arc.flatten(0.01), (0, 0), 10) <= 0.01
    assert np.ptp(back.flatten(0.1)[:, 0]) >= 65
    np.testing.assert_allclose(closed.flatten(0.1)[0], closed.flatten(0.1)[-1], atol=1e-9)


def _distance(point: np.ndarray, start: np.ndarray, end: np.ndarray) -> float:
    along = np.clip((point - start) @ (end - start) / ((end - start) @ (end - start)), 0, 1)
    return float(np.linalg.norm(point - start - along * (end - start)))


def test_entities_drawn_from_behind_are_mirrored() -> None:
    document = new()
    space = document.modelspace()
    behind = {"extrusion": (0, 0, -1)}
    space.add_lwpolyline([(0, 0), (65, 0), (65, 30)], dxfattribs={**behind, "elevation": 4})
    space.add_polyline2d([(0, 0), (65, 0)], dxfattribs=behind)
    space.add_arc((10, 0, 2), 5, 0, 90, dxfattribs=behind)
    space.add_lwpolyline([(0, 0, 1), (10, 0, 0)], format="xyb", dxfattribs=behind)
    block = document.blocks.new("B", base_point=(1, 0))
    block.add_line((1, 0), (11, 5))
    space.add_blockref("B", (100, 0, 3), dxfattribs={**behind, "rotation": 90})
    drawing = read(document)
    assert ends(drawing) == [
        [[0, 0, -4], [-65, 0, -4], [-65, 30, -4]],
        [[0, 0, 0], [-65, 0, 0]],
        [[-100, 0, -3], [-95, 10, -3]],
    ]
    arc, bulge = (curve.flatten(0.01) for curve in drawing.curves)
    np.testing.assert_allclose([arc[0], arc[-1]], [[-15, 0, -2], [-10, 5, -2]], atol=1e-9)
    assert (bulge[:, 0] <= 1e-9).all()
    assert bulge[:, 1].min() == pytest.approx(-5, abs=0.1)


def test_blocks_are_placed_by_base_point_scale_turn_and_mirror() -> None:
    document = new()
    edge = document.blocks.new("EDGE", base_point=(5, 5))
    edge.add_line((5, 5), (70, 5))
    cell = document.blocks.new("CELL")
    for place, turn in [((0, 0), 0), ((65, 0), 90), ((0, 65), 0), ((0, 0), 90)]:
        cell.add_blockref("EDGE", place, dxfattribs={"rotation": turn})
    space = document.modelspace()
    space.add_blockref("cell", (0, 0))  # names of blocks have no upper and lower case
    space.add_blockref("CELL", (130, 0), dxfattribs={"xscale": -1})
    space.add_blockref("CELL", (0, 130), dxfattribs={"yscale": -1})
    assert segments(read(document)) == expected()
    assert read(document).lines[0].where.endswith("in block EDGE")


def test_unequal_scales_make_ellipses_of_circles() -> None:
    document = new()
    block = document.blocks.new("B")
    block.add_circle((0, 0), 10)
    block.add_lwpolyline([(0, 0), (10, 10)])
    scales = {"xscale": 3, "yscale": 1, "rotation": 90}
    document.modelspace().add_blockref("B", (5, 5), dxfattribs=scales)
    drawing = read(document)
    assert ends(drawing) == [[[5, 5, 0], [-5, 35, 0]]]
    x, y, _z = (drawing.curves[0].flatten(0.01) - [5, 5, 0]).T
    np.testing.assert_allclose((x / 10) ** 2 + (y / 30) ** 2, 1)
    middles = np.column_stack((x[1:] + x[:-1], y[1:] + y[:-1])) / 2
    assert (1 - np.hypot(middles[:, 0] / 10, middles[:, 1] / 30)).max() * 30 <= 0.0101


def test_rows_and_columns_of_a_reference() -> None:
    document = new()
    document.blocks.new("B").add_line((0, 0), (5, 0))
    reference = document.modelspace().add_blockref(
        "B", (100, 0), dxfattribs={"rotation": 90, "xscale": 2}
    )
    reference.grid(size=(2, 3), spacing=(10, 20))  # rows, columns; not scaled with the block
    found = {(line[0][0], line[0][1]) for line in ends(read(document))}
    assert found == {(100 - y, x) for x in (0, 20, 40) for y in (0, 10)}
    assert ends(read(document))[0] == [[100, 0, 0], [100, 10, 0]]


def test_layer_and_colour_are_inherited_from_the_reference() -> None:
    document = new()
    document.layers.add("RED", color=1)
    document.layers.add("GREEN", true_color=0x00AA11)
    block = document.blocks.new("B")
    block.add_line((0, 0), (1, 0), dxfattribs={"layer": "0", "color": 256})
    block.add_line((0, 0), (2, 0), dxfattribs={"layer": "GREEN", "color": 256})
    block.add_line((0, 0), (3, 0), dxfattribs={"layer": "GREEN", "color": 0})
    block.add_line((0, 0), (4, 0), dxfattribs={"layer": "0", "true_color": 0x123456})
    block.add_line((0, 0), (5, 0), dxfattribs={"layer": "0", "color": 4})
    outer = document.blocks.new("OUTER")
    outer.add_blockref("B", (0, 0), dxfattribs={"layer": "0", "color": 0})
    document.modelspace().add_blockref("OUTER", (0, 0), dxfattribs={"layer": "RED", "color": 5})
    document.modelspace().add_line((0, 0), (6, 0))
    found = [(line.layer, line.colour) for line in read(document).lines]
    assert found == [
        ("RED", "#ff0000"),
        ("GREEN", "#00aa11"),
        ("GREEN", "#0000ff"),
        ("RED", "#123456"),
        ("RED", "#00ffff"),
        ("0", "#000000"),
    ]


def test_what_is_not_seen_is_counted() -> None:
    document = grid()
    document.layers.add("OFF").off()
    document.layers.add("FROZEN").freeze()
    document.layers.add("LOCKED").lock()
    space = document.modelspace()
    space.add_line((0, 0), (1, 1), dxfattribs={"layer": "off"})
    space.add_line((0, 0), (1, 1), dxfattribs={"layer": "FROZEN"})
    space.add_line((0, 0), (1, 1), dxfattribs={"invisible": 1})
    space.add_line((0, 0), (7, 7), dxfattribs={"layer": "LOCKED"})
    block = document.blocks.new("B")
    block.add_line((0, 0), (8, 8), dxfattribs={"layer": "LOCKED"})
    block.add_line((0, 0), (9, 9), dxfattribs={"layer": "0"})
    space.add_blockref("B", (0, 0), dxfattribs={"layer": "OFF"})
    space.add_blockref("B", (0, 0), dxfattribs={"layer": "FROZEN"})
    space.add_blockref("B", (0, 0), dxfattribs={"invisible": 1})
    document.blocks.new("UNUSED").add_line((0, 0), (3, 3))
    document.paperspace().add_line((0, 0), (4, 4))
    document.layouts.new("Second").add_text("title", dxfattribs={"layer": "T"})
    drawing = read(document)
    extra = {frozenset({(0, 0, 0), (7, 7, 0)}), frozenset({(0, 0, 0), (8, 8, 0)})}
    assert segments(drawing) == expected() | extra
    assert left_out(drawing) == {
        ("LINE", "off", "its layer is off"): 1,
        ("LINE", "OFF", "its layer is off"): 1,
        ("LINE", "FROZEN", "its layer is frozen"): 1,
        ("LINE", "0", "is hidden"): 1,
        ("INSERT", "FROZEN", "its layer is frozen"): 1,
        ("INSERT", "0", "is hidden"): 1,
        ("LINE", "0", "is in paper space"): 1,
        ("TEXT", "T", "is in paper space"): 1,
    }


def test_paper_space_of_r12_is_counted() -> None:
    document = grid("R12")
    document.paperspace().add_line((0, 0), (4, 4))
    drawing = read(document)
    assert segments(drawing) == expected()
    assert left_out(drawing) == {("LINE", "0", "is in paper space"): 1}


def test_everything_else_is_counted_by_kind_and_layer() -> None:
    document = grid()
    space = document.modelspace()
    notes = {"layer": "NOTES"}
    space.add_text("a", dxfattribs=notes)
    space.add_text("b", dxfattribs=notes)
    space.add_mtext("c", dxfattribs=notes)
    space.add_point((1, 1))
    space.add_3dface([(0, 0), (1, 0), (1, 1)])
    space.add_solid([(0, 0), (1, 0), (1, 1)])
    with space.add_mesh().edit_data() as mesh:
        mesh.add_face([(0, 0, 0), (1, 0, 0), (1, 1, 0)])
    space.add_xline((0, 0), (1, 1))
    space.add_ray((0, 0), (1, 1))
    space.add_hatch().paths.add_polyline_path([(0, 0), (1, 0), (1, 1)])
    space.add_leader([(0, 0), (1, 1)])
    space.add_linear_dim((0, -9), (0, 0), (65, 0), dxfattribs=notes).render()
    space.add_mline([(0, 0), (65, 65)])
    space.add_polymesh((2, 2))
    image = document.add_image_def("a.png", (10, 10))
    space.add_image(image, (0, 0), (5, 5))
    drawing = read(document)
    assert segments(drawing) == expected()
    counts = {(kind, layer): n for (kind, layer, _), n in left_out(drawing).items()}
    assert counts == {
        ("TEXT", "NOTES"): 2,
        ("MTEXT", "NOTES"): 1,
        ("DIMENSION", "NOTES"): 1,
        **{
            (kind, "0"): 1
            for kind in (
                *("POINT", "3DFACE", "SOLID", "MESH", "XLINE", "RAY", "HATCH", "LEADER", "MLINE"),
                *("POLYLINE", "IMAGE"),
            )
        },
    }
    reasons = {kind: reason for kind, _, reason in left_out(drawing)}
    assert reasons["XLINE"] == "is an endless construction line"
    assert reasons["POLYLINE"] == "is a mesh; its edges are not read"
    assert reasons["MLINE"].startswith("is a bundle of parallel lines")


def test_unknown_entities_are_counted() -> None:
    text = written(grid()).decode()
    proxy = "  0\nACAD_PROXY_ENTITY\n  5\nFF1\n100\nAcDbEntity\n  8\nP\n100\nAcDbProxyEntity\n"
    other = "  0\nFANCY_GADGET\n  5\nFF2\n100\nAcDbEntity\n  8\nG\n100\nAcDbFancy\n 40\n1.0\n"
    place = text.index("  0\nENDSEC", text.index("ENTITIES"))
    drawing = read_dxf((text[:place] + proxy + other + text[place:]).encode())
    assert segments(drawing) == expected()
    assert {(thing.kind, thing.layer) for thing in drawing.left_out} == {
        ("ACAD_PROXY_ENTITY", "P"),
        ("FANCY_GADGET", "G"),
    }


def test_attributes_of_blocks_are_text() -> None:
    document = new()
    block = document.blocks.new("B")
    block.add_line((0, 0), (65, 0))
    block.add_attdef("NAME", (0, 0))
    document.modelspace().add_blockref("B", (0, 0)).add_auto_attribs({"NAME": "x"})
    drawing = read(document)
    assert left_out(drawing) == {("ATTRIB", "0", "is text"): 1}
    assert len(drawing.lines) == 1


def test_references_that_lead_nowhere_are_reported() -> None:
    document = grid()
    space = document.modelspace()
    document.add_xref_def("other/site.dxf", "SITE")
    space.add_blockref("SITE", (0, 0))
    loop = document.blocks.new("LOOP")
    loop.add_line((200, 0), (265, 0))
    loop.add_blockref("TURN", (0, 0))
    document.blocks.new("TURN").add_blockref("loop", (0, 0))
    space.add_blockref("LOOP", (0, 0))
    data = written(document).replace(b"AAAMISSING", b"X")
    drawing = read_dxf(data)
    assert segments(drawing) == expected() | {frozenset({(200, 0, 0), (265, 0, 0)})}
    assert left_out(drawing) == {
        ("INSERT", "0", "its block SITE is another file (XREF): other/site.dxf"): 1,
        ("INSERT", "0", "its block loop contains itself"): 1,
    }


def test_a_reference_without_block_is_reported() -> None:
    document = grid()
    document.blocks.new("GONE_A")
    document.modelspace().add_blockref("GONE_B", (0, 0))
    drawing = read(document)
    assert segments(drawing) == expected()
    assert left_out(drawing) == {("INSERT", "0", "its block GONE_B is not in the file"): 1}


def test_a_clipped_block_is_read_as_a_whole_and_reported() -> None:
    document = new()
    document.blocks.new("B").add_line((0, 0), (65, 0))
    reference = document.modelspace().add_blockref("B", (0, 0))
    xclip.XClip(reference).set_block_clipping_path([(0, 0), (10, 10)])
    drawing = read(document)
    assert len(drawing.lines) == 1
    assert drawing.messages == ["Block B is clipped in the drawing; all of it is read."]


def test_deep_nesting_is_bounded() -> None:
    document = new()
    document.blocks.new("B0").add_line((0, 0), (65, 0))
    for level in range(1, 200):
        document.blocks.new(f"B{level}").add_blockref(f"B{level - 1}", (0, 0))
    document.modelspace().add_blockref("B199", (0, 0))
    document.modelspace().add_blockref("B40", (0, 0))
    drawing = read(document)
    assert len(drawing.lines) == 1
    assert left_out(drawing) == {("INSERT", "0", "is nested more than 64 blocks deep"): 1}


def test_blocks_that_multiply_are_refused() -> None:
    document = new()
    document.blocks.new("B0").add_line((0, 0), (65, 0))
    for level in range(1, 20):
        block = document.blocks.new(f"B{level}")
        for place in range(10):
            block.add_blockref(f"B{level - 1}", (place, 0))
    document.modelspace().add_blockref("B19", (0, 0))
    with pytest.raises(InputError, match="objects") as caught:
        read(document)
    assert caught.value.code == "too-large"


def test_rows_of_a_reference_are_refused_before_they_are_read() -> None:
    document = new()
    document.blocks.new("B")
    document.modelspace().add_blockref("B", (0, 0)).grid((30_000, 30_000), (1, 1))
    with pytest.raises(InputError, match="objects"):
        read(document)


def test_too_many_things_are_refused_before_they_are_read() -> None:
    with pytest.raises(InputError, match="too many things") as caught:
        read_dxf(bare("0\nTEXT\n" * 1_000_000))
    assert caught.value.code == "too-large"


def test_too_many_lines_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(collecting, "MAX_SEGMENTS", 9)
    with pytest.raises(InputError, match="more than 9 line segments"):
        read(grid())


UNITS = {
    1: 25.4,
    2: 304.8,
    3: 1609344,
    4: 1,
    5: 10,
    6: 1e3,
    7: 1e6,
    8: 25.4e-6,
    9: 0.0254,
    10: 914.4,
    11: 1e-7,
    12: 1e-6,
    13: 1e-3,
    14: 100,
    15: 1e4,
    16: 1e5,
    17: 1e12,
    18: 149597870700e3,
    19: 9.4607304725808e18,
    20: 3.0856775814913673e19,
    21: 304.8006096012192,
    22: 25.4000508001016,
    23: 914.4018288036576,
    24: 1609347.218694437,
}


@pytest.mark.parametrize("number", sorted(UNITS))
def test_units_of_the_file(number: int) -> None:
    drawing = read(grid(units=number))
    assert drawing.unit is not None
    assert drawing.unit.mm == pytest.approx(UNITS[number], rel=1e-12)
    assert drawing.unit.source == f"$INSUNITS of the file is {number}"
    assert drawing.guess is None


def test_inches_stay_in_the_unit_of_the_file() -> None:
    drawing = read(grid(units=1, scale=1 / 25.4))
    assert segments(drawing) == expected(1 / 25.4)


@pytest.mark.parametrize(
    ("measurement", "scale", "name"),
    [(1, 1.0, "mm"), (1, 0.1, "cm"), (1, 0.001, "m"), (0, 1 / 25.4, "in"), (0, 1 / 304.8, "ft")],
)
def test_a_file_without_unit_has_a_guess(measurement: int, scale: float, name: str) -> None:
    document = grid(units=0, scale=scale)
    document.header["$MEASUREMENT"] = measurement
    drawing = read(document)
    assert drawing.unit is None
    assert drawing.guess is not None
    assert drawing.guess.name == name
    assert f"$MEASUREMENT of the file is {measurement}" in drawing.guess.source
    assert "65 mm long" in drawing.guess.source


def test_a_file_that_says_nothing_has_no_guess() -> None:
    drawing = read_dxf(bare("0\nLINE\n8\nA\n10\n0\n20\n0\n11\n65\n21\n0\n"))
    assert drawing.unit is None
    assert drawing.guess is None


def test_an_unknown_number_of_a_unit_is_reported() -> None:
    data = written(grid()).replace(b"$INSUNITS\n 70\n4\n", b"$INSUNITS\n 70\n99\n")
    drawing = read_dxf(data)
    assert drawing.unit is None
    assert drawing.messages == ["$INSUNITS of the file is 99, which is no unit."]


def test_things_without_length_or_number_are_left_out() -> None:
    document = grid()
    space = document.modelspace()
    space.add_lwpolyline([(0, 0)])
    space.add_circle((0, 0), 0)
    space.add_line((0, 0), (math.inf, 0))
    space.add_arc((math.inf, 0), 5, 0, 90)
    document.blocks.new("B").add_line((0, 0), (65, 0))
    space.add_blockref("B", (math.nan, 0))
    drawing = read(document)
    assert segments(drawing) == expected()
    assert left_out(drawing) == {
        ("LWPOLYLINE", "0", "has no length"): 1,
        ("CIRCLE", "0", "has no length"): 1,
        ("LINE", "0", "has coordinates that are no numbers"): 2,
        ("ARC", "0", "has coordinates that are no numbers"): 1,
    }


@pytest.mark.parametrize("binary", [False, True])
def test_a_file_cut_off_keeps_what_was_read_and_says_so(binary: bool) -> None:
    data = written(grid("R2000"), binary)
    mark = data.rindex(b"AcDbLine")
    drawing = read_dxf(data[: mark - 60])
    assert len(segments(drawing) & expected()) >= 8
    assert drawing.messages[0].startswith("The file is damaged (")


def test_a_curve_that_cannot_be_flattened_is_an_error() -> None:
    def flatten(distance: float) -> np.ndarray:
        raise ZeroDivisionError

    found = collecting.Collected()
    found.curve(flatten, np.eye(4), "ELLIPSE", "0", None, "ELLIPSE 2F")
    with pytest.raises(InputError, match="ELLIPSE 2F is a curve that cannot") as caught:
        found.curves[0].flatten(1.0)
    assert caught.value.where == "ELLIPSE 2F"


def test_a_missing_end_of_a_section_is_repaired_and_reported() -> None:
    end = b"  0\nENDSEC\n  0\nSECTION\n  2\nENTITIES"
    data = written(grid())
    assert end in data
    drawing = read_dxf(data.replace(end, end.partition(b"ENDSEC\n")[2]))
    assert segments(drawing) == expected()
    assert drawing.messages == [
        "The file is damaged (missing ENDSEC tag); what could be repaired is read."
    ]


def test_half_a_line_is_left_out() -> None:
    data = written(grid())
    mark = data.index(b" 11\n", data.index(b"AcDbLine"))  # the end of the first line
    drawing = read_dxf(data[:mark] + data[data.index(b"  0\n", mark) :])
    assert len(drawing.lines) == 9
    assert left_out(drawing) == {("LINE", "0", "is damaged"): 1}


def test_a_spline_of_impossible_numbers_is_left_out() -> None:
    document = grid()
    spline = document.modelspace().add_rational_spline(
        [(10, 0), (10, 10), (0, 10)], [1, 1, 1], degree=2
    )
    spline.weights = [1, 0, 1]
    drawing = read(document)
    assert segments(drawing) == expected()
    assert not drawing.curves
    assert left_out(drawing) == {("SPLINE", "", "is damaged"): 1}


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "no DXF file"),
        (b"\x00" * 100, "no DXF file"),
        (b"<svg/>", "no DXF file"),
        (b"\n" * 200_000, "no DXF file"),
        (b"0\nSECTION\n" + b"\n" * 200_000, "damaged"),
        (b"0\nSECTION\n2\nENTITIES\n" + b" " * 200_000, "damaged"),
        (b"AC1027\x00\x00\x00", "DWG"),
        (b"AutoCAD Binary DXF\r\n\x1a\x00", "damaged|no DXF file"),
        (b"0\nSECTION\n", "damaged|no DXF"),
    ],
)
def test_other_files_are_refused(data: bytes, words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        read_dxf(data)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("binary", [False, True])
def test_broken_files_give_a_drawing_or_one_line(binary: bool) -> None:
    document = grid("R2004")
    document.layers.add("RED", color=1)
    block = document.blocks.new("B")
    block.add_circle((0, 0), 10)
    block.add_lwpolyline([(0, 0, 1), (10, 10, 0), (5, 5, 0)], format="xyb")
    space = document.modelspace()
    space.add_blockref("B", (5, 5), dxfattribs={"layer": "RED", "xscale": 2}).grid((2, 2), (9, 9))
    space.add_spline([(0, 0), (10, 5), (20, 0), (30, 9)])
    space.add_text("a")
    data = written(document, binary)
    refused = []
    for case in broken(data, 60, seed=14):
        try:
            drawing = read_dxf(case)
        except InputError as error:
            refused.append(str(error))
            continue
        for curve in drawing.curves:
            assert len(curve.flatten(0.1)) <= 20_001
    assert 0 < len(refused) < 60
    assert not any("\n" in text for text in refused)


def test_all_of_3000_lines_are_read() -> None:
    document = new()
    for number in range(3000):
        document.modelspace().add_line((number, 0), (number, 65))
    data = written(document)
    drawing = read_dxf(data)
    assert len(drawing.lines) == 3000
