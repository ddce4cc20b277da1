"""SVG: shapes as lines and curves."""

import numpy as np
import pytest
from svgs import LINE, drawn, ends, left, read, svg


@pytest.mark.parametrize(
    ("body", "points"),
    [
        ('<line x2="50" y2="7"/>', [(0, 100), (50, 93)]),
        (
            '<polyline points="0,0 10 0 10-5.5.5 0"/>',
            [(0, 100), (10, 100), (10, 105.5), (0.5, 100)],
        ),
        ('<polygon points="0,0 10,0 10,10"/>', [(0, 100), (10, 100), (10, 90), (0, 100)]),
        ('<polygon points="0,0 10,0 10,10 0,0"/>', [(0, 100), (10, 100), (10, 90), (0, 100)]),
        (
            '<rect x="10" y="20" width="30" height="40"/>',
            [(10, 80), (40, 80), (40, 40), (10, 40), (10, 80)],
        ),
        (
            '<path d="M10,10 20 20L30,30H40V50"/>',
            [(10, 90), (20, 80), (30, 70), (40, 70), (40, 50)],
        ),
        (
            '<path d="m10,10 10 10l10,10h10v20z"/>',
            [(10, 90), (20, 80), (30, 70), (40, 70), (40, 50), (10, 90)],
        ),
        ('<path d="M1e1 1.e1l-.5.5.5-1.5"/>', [(10, 90), (9.5, 89.5), (10, 91)]),
        ('<path d="M0 0A0 5 0 0 1 10 10"/>', [(0, 100), (10, 90)]),
        ('<path d="M0 0C10 10 20 20 30 30"/>', [(0, 100), (30, 70)]),
        ('<path d="M0 0C0 0 30 30 30 30Q40 40 50 50"/>', [(0, 100), (30, 70), (50, 50)]),
        ('<path d="M10 10c3.333,3.334 6.667,6.666 10,10"/>', [(10, 90), (20, 80)]),
    ],
)
def test_straight_shapes_are_lines(body, points):
    drawing = read(svg(body))
    assert len(drawing.lines) == 1
    np.testing.assert_allclose(drawing.lines[0].points[:, :2], points, atol=1e-9)
    assert not drawing.lines[0].points[:, 2].any()
    assert not drawing.curves
    assert not drawing.messages


def test_a_path_goes_on_from_where_it_was_closed():
    assert drawn('<path d="M10 10h10v10zl-10 10m5 5h1M50 50h7"/>') == [
        (10, 90, 10, 90),
        (10, 90, 0, 80),
        (5, 75, 6, 75),
        (50, 50, 57, 50),
    ]


@pytest.mark.parametrize(
    ("body", "kinds"),
    [
        ('<path d="M0 0C0 20 20 20 20 0S40-20 40 0s20 20 20 0"/>', ["cubic Bezier"]),
        ('<path d="M0 0Q10 20 20 0T40 0t20 0"/>', ["quadratic Bezier"]),
        ('<path d="M0 0a10 5 30 0110 10"/>', ["elliptical arc"]),
        ('<circle cx="20" cy="20" r="10"/>', ["circle"]),
        ('<ellipse cx="20" cy="20" rx="10" ry="5"/>', ["ellipse"]),
        ('<rect width="30" height="20" rx="5"/>', ["rounded corner"] * 4),
        (
            '<path d="M0 0C0 20 20 20 20 0Q30 9 40 0A5 5 0 0 1 50 0"/>',
            ["cubic Bezier", "quadratic Bezier", "elliptical arc"],
        ),
        ('<path d="M0 0C10 0 -5 0 5 0"/>', ["cubic Bezier"]),  # straight, but to and fro
        ('<path d="M0 0C20 20 -20 20 0 0"/>', ["cubic Bezier"]),
    ],
)
def test_curves_are_named(body, kinds):
    drawing = read(svg(body))
    assert [curve.kind for curve in drawing.curves] == kinds


def test_lines_between_curves_are_kept():
    drawing = read(svg('<path d="M0 0H10C10 20 20 20 20 0H30V10"/>'))
    assert ends(drawing) == [(0, 100, 10, 100), (20, 100, 30, 90)]
    assert len(drawing.curves) == 1
    rounded = read(svg('<rect x="10" y="10" width="30" height="20" rx="5"/>'))
    assert ends(rounded) == [(15, 90, 35, 90), (40, 85, 40, 75), (35, 70, 15, 70), (10, 75, 10, 85)]
    corner = rounded.curves[0].flatten(0.01)[:, :2]
    np.testing.assert_allclose(np.hypot(*(corner - (35, 85)).T), 5.0, atol=1e-9)
    np.testing.assert_allclose(corner[[0, -1]], [(35, 90), (40, 85)], atol=1e-9)


def farthest(points, chords):
    """Largest distance of points from a polyline."""
    a, b = chords[:-1], chords[1:]
    t = np.clip(
        ((points[:, None] - a) * (b - a)).sum(-1) / np.maximum(((b - a) ** 2).sum(-1), 1e-12), 0, 1
    )
    return np.linalg.norm(points[:, None] - (a + t[..., None] * (b - a)), axis=-1).min(1).max()


@pytest.mark.parametrize("chord", [3.0, 0.3, 0.01])
@pytest.mark.parametrize(
    "data",
    [
        "M0 0C0 90 90 90 60 0",
        "M0 0Q50 90 90 0T120 30",
        "M0 0A40 15 25 1 0 50 10",
        "M0 0A1 1 0 0 1 40 30",
    ],
)
def test_chords_of_a_curve_are_as_near_as_requested(data, chord):
    curve = read(svg(f'<path transform="scale(1.5,.7) skewX(20)" d="{data}"/>')).curves[0]
    chords, fine = curve.flatten(chord), curve.flatten(1e-5)
    assert farthest(fine, chords) <= chord
    assert len(chords) < len(fine)
    np.testing.assert_allclose(chords[[0, -1]], fine[[0, -1]], atol=1e-9)


def test_the_count_of_chords_is_bounded():
    circle = read(svg('<circle r="10"/>')).curves[0]
    for chord in (0.0, -1.0, 1e-300):
        assert len(circle.flatten(chord)) < 10_000


def test_an_arc_too_small_for_its_ends_grows_as_the_standard_says():
    points = read(svg('<path d="M0 0A1 1 0 0 1 40 0"/>')).curves[0].flatten(0.001)[:, :2]
    np.testing.assert_allclose(np.hypot(*(points - (20, 100)).T), 20.0, atol=1e-6)
    assert points[:, 1].max() == pytest.approx(120.0, abs=1e-3)


@pytest.mark.parametrize(
    "body",
    [
        '<rect width="0" height="10"/>',
        '<rect width="5"/>',
        "<circle/>",
        '<ellipse rx="0" ry="3"/>',
        "<path/>",
        '<path d=""/>',
        '<path d="M30,30"/>',
        '<path d="M30,30M40 40z"/>',
        '<polyline points=""/>',
        '<polyline points="3 3"/>',
        '<rect width="-5" height="3"/>',
    ],
)
def test_what_draws_nothing_is_nothing(body):
    drawing = read(svg(body))
    assert not drawing.lines
    assert not drawing.curves
    assert not drawing.left_out


def test_a_line_without_length_is_counted():
    drawing = read(svg('<line x1="5" x2="5"/><path d="M3 3h0"/>'))
    assert left(drawing) == {("line", "", "has no length"): 1, ("path", "", "has no length"): 1}


@pytest.mark.parametrize(
    ("data", "points", "words"),
    [
        ("M0 0L10 0 X 20 0", 2, "X 20 0"),
        ("M0 0L10 0L20", 2, "20"),
        ("M0 0 10 0 10 10 h", 3, "h without numbers"),
        ("L0 0 10 0", 0, "begins with L"),
        ("0 0 L 3 3", 0, "not with M"),
        ("M0 0H9A10 10 0 2 0 50 50", 2, "10 10 0 2"),
        ("M0 0L10 0,,20 0", 2, "20 0"),
    ],
)
def test_broken_path_data_is_drawn_up_to_the_error_and_reported(data, points, words):
    drawing = read(svg(f'<path id="p7" d="{data}"/>'))
    assert sum(len(line.points) for line in drawing.lines) == points
    assert words in drawing.messages[0]
    assert "p7" in drawing.messages[0]


def test_odd_coordinates_are_reported():
    drawing = read(svg('<polyline points="0 0 10 0 10"/>'))
    assert drawn('<polyline points="0 0 10 0 10"/>') == [(0, 100, 10, 100)]
    assert "odd count" in drawing.messages[0]


@pytest.mark.parametrize("value", ["1e999", "1e12", "-1e400"])
def test_a_coordinate_out_of_all_bounds_is_counted(value):
    drawing = read(svg(f'<line x2="{value}"/><path d="M0 0C{value} 3 4 4 {value} 9"/>' + LINE))
    assert len(drawing.lines) == 1
    assert sum(left(drawing).values()) == 2
