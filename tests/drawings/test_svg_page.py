"""SVG: the page, its unit and what says so; transforms, windows and uses."""

import numpy as np
import pytest
from svgs import ILLUSTRATOR, LINE, PAGE, PX, drawn, ends, left, read, svg


@pytest.mark.parametrize(
    ("attributes", "mm", "name"),
    [
        ('width="100mm" height="100mm" viewBox="0 0 100 100"', 1.0, "mm"),
        ('width="10cm" height="10cm" viewBox="0 0 100 100"', 1.0, "mm"),
        ('width="100cm" height="100cm" viewBox="0 0 100 100"', 10.0, "cm"),
        ('width="100in" height="100in" viewBox="0 0 100 100"', 25.4, "in"),
        ('width="100pt" height="100pt" viewBox="0 0 100 100"', 25.4 / 72, "pt"),
        ('width="6pc" height="6pc" viewBox="0 0 72 72"', 25.4 / 72, "pt"),
        ('width="400Q" height="400Q" viewBox="0 0 100 100"', 1.0, "mm"),
        ('width="100px" height="100px" viewBox="0 0 100 100"', 25.4 / 96, "px"),
        ('width="100" height="100" viewBox="0 0 100 100"', 25.4 / 96, "px"),
        ('width="100px" height="100px"', 25.4 / 96, "px"),
        ('width="100mm" height="100mm"', 25.4 / 96, "px"),
        ('width="100mm" viewBox="0 0 100 400"', 1.0, "mm"),
        ('height="100mm" viewBox="0 0 400 100"', 1.0, "mm"),
        ('width="70mm" height="100mm" viewBox="0 0 100 100"', 0.7, "unit"),
        (
            'width="70mm" height="100mm" viewBox="0 0 100 100" '
            'preserveAspectRatio="xMidYMid slice"',
            1.0,
            "mm",
        ),
        ('style="width:100mm;height:100mm" viewBox="0,0,100,100"', 1.0, "mm"),
    ],
)
def test_width_height_and_viewbox_say_the_unit(attributes, mm, name):
    drawing = read(svg(LINE, attributes))
    assert drawing.unit.mm == pytest.approx(mm)
    assert drawing.unit.name == name
    assert drawing.unit.source
    assert drawing.guess is None


@pytest.mark.parametrize(
    "attributes",
    [
        "",
        'width="100%" height="100%" viewBox="0 0 200 200"',
        'viewBox="0 0 200 200"',
        'width="200" height="200"',
        'width="auto" height="calc(1mm)" viewBox="0 0 200 200"',
        'width="0" height="-3mm"',
    ],
)
def test_without_a_size_there_is_no_unit(attributes):
    drawing = read(svg('<path d="M10 10h130v65"/>', attributes))
    assert drawing.unit is None
    assert drawing.guess is None
    np.testing.assert_allclose(np.ptp(drawing.lines[0].points, axis=0), [130, 65, 0])


@pytest.mark.parametrize(
    ("before", "attributes", "mm"),
    [
        (ILLUSTRATOR, PX, 25.4 / 72),
        (ILLUSTRATOR, 'viewBox="0 0 368.5 368.5"', 25.4 / 72),
        (ILLUSTRATOR, 'width="130mm" height="130mm" viewBox="0 0 368.5 368.5"', 130 / 368.5),
        ("", PX + ' xmlns:i="http://ns.adobe.com/AdobeIllustrator/10.0/"', 25.4 / 72),
        ("", PX + ' inkscape:version="0.91 r13725"', 25.4 / 90),
        ("", PX + ' inkscape:version="0.48.4 r9939"', 25.4 / 90),
        ("", PX + ' inkscape:version="0.92.4 (5da689c313, 2019-01-14)"', 25.4 / 96),
        ("", PX + ' inkscape:version="1.3 (0e150ed6c4, 2023-07-21)"', 25.4 / 96),
        ("", 'width="744.09448" height="1052.3622" inkscape:version="0.91 r1"', 25.4 / 90),
        ("", 'width="210mm" height="297mm" inkscape:version="0.91 r1"', 25.4 / 90),
        (
            "",
            'width="210mm" height="297mm" viewBox="0 0 744.09448819 1052.3622047" '
            'inkscape:version="0.91 r1"',
            25.4 / 90,
        ),
        (
            "<!-- Creator: CorelDRAW -->",
            'width="210mm" height="297mm" viewBox="0 0 21000 29700"',
            0.01,
        ),
    ],
)
def test_px_are_of_the_length_that_the_program_gives_them(before, attributes, mm):
    assert read(svg(LINE, attributes, before)).unit.mm == pytest.approx(mm, rel=1e-6)


def test_openscad_numbers_are_mm():
    text = svg("<title>OpenSCAD Model</title>" + LINE, 'width="42" height="27"')
    assert read(text).unit.mm == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("before", "attributes", "body"),
    [
        ("", PX, '<g data-name="top 0.5"/>'),
        ("", PX + ' xmlns:serif="http://www.serif.com/"', ""),
        (ILLUSTRATOR, PX + ' inkscape:version="1.3"', ""),
    ],
)
def test_a_program_that_is_not_certain_is_a_guess(before, attributes, body):
    drawing = read(svg(body + LINE, attributes, before))
    assert drawing.unit is None
    assert drawing.guess.mm == pytest.approx(25.4 / 72)
    assert "72" in drawing.guess.source


def test_lengths_with_a_unit_keep_their_size_whatever_a_px_is():
    text = svg('<line x1="10mm" x2="75mm"/>', PX, ILLUSTRATOR)
    assert np.ptp(read(text).lines[0].points[:, 0]) * 25.4 / 72 == pytest.approx(65.0)


def test_y_is_up_and_the_lower_left_corner_of_the_page_is_the_origin():
    assert drawn(LINE) == [(10, 80, 60, 80)]
    assert drawn(LINE, attributes='width="100mm" height="50mm" viewBox="-10 -20 100 50"') == [
        (20, 10, 70, 10)
    ]


def test_a_drawing_is_set_on_its_page_as_preserveaspectratio_says():
    wide = 'width="200mm" height="100mm" viewBox="0 0 100 100"'
    assert drawn(LINE, attributes=wide) == [(60, 80, 110, 80)]
    assert drawn(LINE, attributes=wide + ' preserveAspectRatio="xMinYMin"') == [(10, 80, 60, 80)]
    assert drawn(LINE, attributes=wide + ' preserveAspectRatio="xMaxYMin"') == [(110, 80, 160, 80)]
    assert drawn(LINE, attributes=wide + ' preserveAspectRatio="xMidYMax slice"') == [
        (20, 160, 120, 160)
    ]


def test_a_stretched_drawing_is_in_mm():
    drawing = read(
        svg(
            '<line x1="10" y1="20" x2="60" y2="70"/>',
            'width="200mm" height="50mm" viewBox="0 0 100 100" preserveAspectRatio="none"',
        )
    )
    assert drawing.unit.mm == pytest.approx(1.0)
    assert ends(drawing) == [(20, 40, 120, 15)]


@pytest.mark.parametrize(
    ("transform", "end"),
    [
        ("translate(10)", (20, 20)),
        ("translate(10,5)", (20, 25)),
        ("scale(2)", (20, 40)),
        ("scale(2 -1)", (20, -20)),
        ("rotate(90)", (-20, 10)),
        ("rotate(90 10 0)", (-10, 0)),
        ("rotate(90,10,0)", (-10, 0)),
        ("skewX(45)", (30, 20)),
        ("skewY(45)", (10, 30)),
        ("matrix(0 1 -1 0 3 4)", (-17, 14)),
        ("matrix(.1,0,0,-.1,0,50)", (1, 48)),
        ("translate(10) scale(2)", (30, 40)),
        ("scale(2),translate(10)", (40, 40)),
        (" translate ( 1e1 , -.5e1 ) ", (20, 15)),
        ("translate(10-5)", (20, 15)),
        ("", (10, 20)),
    ],
)
def test_transforms(transform, end):
    page = 'width="100mm" height="0.000001mm" viewBox="0 0 100 .000001"'
    x, y = drawn(f'<line transform="{transform}" x1="900" x2="10" y2="20"/>', attributes=page)[0][
        2:
    ]
    assert (x, -y) == pytest.approx(end, abs=1e-3)


@pytest.mark.parametrize(
    ("css", "end"),
    [
        ("transform: translate(10px, 5px)", (20, 25)),
        ("transform: translateX(1in) translateY(-10px)", (106, 10)),
        ("transform: rotate(.25turn)", (-20, 10)),
        ("transform: rotate(90deg); transform-origin: 10px 0", (-10, 0)),
        ("transform: scale(-1, 1); transform-origin: center", (90, 20)),
        ("transform: scaleY(2) skew(45deg)", (30, 40)),
        ("transform: none", (10, 20)),
    ],
)
def test_css_transforms_go_before_the_attribute(css, end):
    found = drawn(f'<line transform="translate(500)" style="{css}" x1="90" x2="10" y2="20"/>')
    assert (found[0][2], 100 - found[0][3]) == pytest.approx(end, abs=1e-3)


@pytest.mark.parametrize(
    "transform", ["rotate(10", "rotate(1,2)", "spin(4)", "translate(10%)", "matrix(1 0 0 1)", "5"]
)
def test_a_transform_that_cannot_be_read_is_reported(transform):
    drawing = read(svg(f'<g id="g1" transform="{transform}">{LINE}</g>'))
    assert ends(drawing) == [(10, 80, 60, 80)]
    assert "transform of g1" in drawing.messages[0]


def test_transforms_of_groups_add_up_from_the_outside_in():
    body = f'<g transform="translate(50,50)"><g transform="rotate(90)">{LINE}</g></g>'
    assert drawn(body) == [(30, 40, 30, -10)]


def test_the_outermost_svg_turns_about_the_middle_of_its_page():
    assert drawn(LINE, attributes=PAGE + ' transform="scale(1,-1)"') == [(10, 20, 60, 20)]


def test_lengths_in_all_units():
    body = (
        '<line x1="1in" y1="2.54cm" x2="7pc" y2="36pt"/>'
        '<g font-size="10"><line x1="2em" x2="2ex"/>'
        '<g font-size="200%"><line x2="1em"/></g></g>'
        '<line x1="10%" y1="20%" x2="50vw" y2="0"/><circle r="10%"/>'
    )
    drawing = read(svg(body))
    assert ends(drawing) == [
        (96, 4, 112, 52),
        (20, 100, 10, 100),
        (0, 100, 20, 100),
        (10, 80, 50, 100),
    ]
    points = drawing.curves[0].flatten(0.001)
    assert np.ptp(points[:, 0]) == pytest.approx(20.0, abs=0.01)


def test_nested_svg_has_a_window_of_its_own():
    body = (
        '<svg x="10" y="10" width="20" height="40" viewBox="0 0 10 10"><line x2="10"/></svg>'
        '<svg x="50%" width="20" height="40" viewBox="0 0 10 10" preserveAspectRatio="none">'
        '<line x2="100%" y2="100%"/></svg>'
        '<svg x="10" y="50"><line x2="10"/></svg><svg width="0"><line x2="9"/></svg>'
    )
    drawing = read(svg(body))
    assert ends(drawing) == [(10, 80, 30, 80), (50, 100, 70, 60), (10, 50, 20, 50)]
    assert left(drawing) == {("svg", "", "has a width or height of 0"): 1}


def test_use_draws_anew_and_only_what_is_used():
    body = (
        '<defs><g id="a"><line id="l" x2="10"/></g></defs><symbol id="s" viewBox="0 0 10 10">'
        '<line x2="10"/></symbol><symbol id="p"><line x2="50%"/></symbol>'
        '<use href="#a" x="5" y="6"/><use xlink:href="#l" transform="rotate(90)" x="3"/>'
        '<use href="#s" x="10" y="50" width="40" height="40"/><use href="#p" width="30"/>'
    )
    assert drawn(body) == [(5, 94, 15, 94), (0, 97, 0, 87), (10, 50, 50, 50), (0, 100, 15, 100)]


def test_use_hands_its_style_to_what_it_draws():
    body = (
        '<defs><line id="l" x2="10"/><line id="k" x2="10" stroke="#00f"/></defs>'
        '<use href="#l" stroke="red"/><use href="#k" stroke="red"/>'
    )
    drawing = read(svg(body, style=""))
    assert [line.colour for line in drawing.lines] == ["#ff0000", "#0000ff"]


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        ('<g id="a"><use href="#a"/></g>', "refers to itself"),
        ('<g id="a"><use href="#b"/></g><g id="b"><use href="#a"/></g>', "refers to itself"),
        ('<use id="a" href="#a"/>', "refers to itself"),
        ('<use href="#nothing"/>', "refers to nothing in the file"),
        ("<use/>", "refers to nothing in the file"),
        ('<use href="parts.svg#a"/>', "refers to another file"),
        ('<use href="https://example.org/a.svg#a"/>', "refers to another file"),
    ],
)
def test_a_use_that_leads_nowhere_is_counted(body, reason):
    drawing = read(svg(body))
    assert {why for _, _, why in left(drawing)} == {reason}


def test_defs_and_their_kind_are_not_drawn():
    kinds = ("defs", "symbol", "clipPath", "mask", "marker", "pattern", "linearGradient")
    drawing = read(svg("".join(f"<{kind}>{LINE}</{kind}>" for kind in kinds)))
    assert not drawing.lines
    assert not drawing.left_out


def test_a_switch_shows_the_first_that_fits():
    body = (
        '<switch><foreignObject requiredExtensions="&ns_ai;" width="1" height="1"/>'
        f'<g systemLanguage="xx"><line x2="3"/></g><g>{LINE}</g><line x2="7"/></switch>'
    ).replace("&ns_ai;", "http://ns.adobe.com/AdobeIllustrator/10.0/")
    assert drawn(body) == [(10, 80, 60, 80)]
