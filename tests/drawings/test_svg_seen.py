"""SVG: what is seen of it, on which layer and in which colour."""

import pytest
from svgs import ILLUSTRATOR, LINE, PAGE, PX, left, read, svg


@pytest.mark.parametrize(
    "body",
    [
        '<g display="none">{}</g>',
        '<g style="display:none">{}</g>',
        '<g class="off">{}</g>',
        '<g id="away">{}</g>',
        '<g display="none"><g display="inline">{}</g></g>',
        '<g visibility="hidden">{}</g>',
        '<g style="visibility: collapse">{}</g>',
        '<g opacity="0">{}</g>',
        '<g opacity="0"><g opacity="1">{}</g></g>',
        '<g style="opacity:0%">{}</g>',
    ],
)
def test_hidden_things_are_counted(body):
    sheet = "<style>.off{display:none} #away{visibility:hidden}</style>"
    drawing = read(svg(sheet + body.format(LINE + "<text>abc</text>")))
    assert not drawing.lines
    assert sum(left(drawing).values()) == 2
    assert all("hidden" in why for kind, _, why in left(drawing) if kind == "line")


def test_visible_things_in_hidden_groups_are_seen():
    body = f'<g visibility="hidden">{LINE}<g style="visibility:visible">{LINE}</g></g>'
    drawing = read(svg(body))
    assert len(drawing.lines) == 1
    assert left(drawing) == {("line", "", "is hidden"): 1}


def test_a_hidden_layer_is_named():
    body = (
        '<g inkscape:groupmode="layer" inkscape:label="Guides" style="display:none">'
        f"{LINE}{LINE}<path d='M0 0h9'/></g>"
    )
    assert left(read(svg(body))) == {
        ("line", "Guides", "its layer is hidden"): 2,
        ("path", "Guides", "its layer is hidden"): 1,
    }


@pytest.mark.parametrize(
    "stroke",
    [
        'stroke="none"',
        'style="stroke:none"',
        'stroke-width="0"',
        'style="stroke-width:0px"',
        'stroke-opacity="0"',
        'stroke="transparent"',
        'stroke="rgba(1,2,3,0)"',
        'stroke="url(#no)"',
    ],
)
def test_a_line_without_a_stroke_to_be_seen_is_counted(stroke):
    drawing = read(svg(f'<line x2="9" {stroke}/>' + LINE))
    assert len(drawing.lines) == 1
    assert left(drawing) == {("line", "", "has no stroke"): 1}


def test_filled_shapes_without_a_stroke_are_counted_with_a_hint():
    body = '<path d="M0 0h50v2h-50z"/><rect width="5" height="50"/><circle r="3"/>'
    drawing = read(svg(body, style=""))
    assert not drawing.lines
    assert sum(left(drawing).values()) == 3
    assert all(why == "is filled and has no stroke" for _, _, why in left(drawing))
    assert any("outlines" in message for message in drawing.messages)


def test_a_stroke_and_a_fill_are_a_line():
    assert (
        len(read(svg('<rect width="9" height="9"/>', style='fill="red" stroke="blue"')).lines) == 1
    )


def test_text_and_pictures_are_counted():
    body = (
        '<text x="1">a<tspan>b</tspan></text><text>c</text><image href="a.png" width="9" '
        'height="9"/><foreignObject><div xmlns="http://www.w3.org/1999/xhtml"/></foreignObject>'
    )
    assert left(read(svg(body))) == {
        ("text", "", "is no line"): 2,
        ("image", "", "is no line"): 1,
        ("foreignObject", "", "is no line"): 1,
    }


def test_what_is_not_heeded_is_reported():
    body = (
        f'<g clip-path="url(#c)">{LINE}</g><line x2="9" mask="url(#m)"/><script>x()</script>'
        '<line x2="7" style="rotate:30deg"/><animate attributeName="x2"/>'
        "<style>@import 'a.css'; a:first-child{stroke:red} a:hover{stroke:red}</style>"
    )
    messages = read(svg(body, before='<?xml-stylesheet href="a.css"?>')).messages
    assert any("2 things are clipped or masked" in m for m in messages)
    assert any("first-child" in m for m in messages)
    assert any("@import" in m for m in messages)
    assert any("another file" in m for m in messages)
    assert any("animations" in m for m in messages)
    assert any("property rotate" in m for m in messages)
    assert not any("hover" in m for m in messages)


def test_lines_off_the_page_are_read_and_reported():
    drawing = read(svg(LINE + '<line x1="150" x2="190"/><line x1="-5" x2="190"/>'))
    assert len(drawing.lines) == 3
    assert drawing.messages == ["1 line is outside of the page, but read all the same."]


# Style sheets and colours


@pytest.mark.parametrize(
    ("attributes", "colour"),
    [
        ('stroke="#d55e00"', "#d55e00"),
        ('stroke="#F00"', "#ff0000"),
        ('stroke="red"', "#ff0000"),
        ('stroke="AliceBlue"', "#f0f8ff"),
        ('stroke="rgb(0, 114, 178)"', "#0072b2"),
        ('stroke="rgb(0 114 178 / 50%)"', "#0072b2"),
        ('stroke="rgb(100%,0%,0%)"', "#ff0000"),
        ('stroke="hsl(120, 100%, 50%)"', "#00ff00"),
        ('stroke="#CD853F icc-color(acmecmyk, 0.11, 0.48, 0.83, 0.00)"', "#cd853f"),
        ('stroke="currentColor" color="lime"', "#00ff00"),
        ('stroke="CurrentColor"', "#123456"),
        ('stroke="inherit"', "#abcdef"),
        ('stroke="nonsense"', "#abcdef"),
        ("", "#abcdef"),
        ('stroke="var(--stroke-0, #0072B2)"', "#0072b2"),
        ('stroke="url(#paint)"', None),
        ('stroke="url(#paint) red"', None),
        ('stroke="url(#none) red"', "#ff0000"),
        ('stroke="red" style="stroke:#00f"', "#0000ff"),
        ('class="a"', "#00aa00"),
        ('class="b a"', "#00aa00"),
        ('class="a" stroke="red"', "#00aa00"),
        ('class="a" style="stroke:red"', "#ff0000"),
        ('class="strong" style="stroke:red"', "#0000aa"),
        ('class="strong" style="stroke:red!important"', "#ff0000"),
        ('id="one" class="a"', "#aa0000"),
        ('class="in"', "#00aaaa"),
        ('class="deep"', "#aaaa00"),
        ('class="a x"', "#00aa00"),
        ('class="print"', "#abcdef"),
        ('class="screen"', "#111111"),
        ('class="both"', "#222222"),
    ],
)
def test_colours(attributes, colour):
    sheet = """<style type="text/css"><![CDATA[
        /* a comment { } */ .a, .both{stroke:#0a0;stroke-width:1}
        #one{stroke:#a00} line.x{} .strong{stroke:#00a !important}
        .outer > .in{stroke:#f0f} g .in{stroke:#0aa} svg g g line.deep{stroke:#aa0}
        @media print{.print{stroke:red}} @media screen{.screen{stroke:#111}}
        .both{stroke:#222}
        @font-face{font-family:x;src:url("data:;{}")}
    ]]></style><linearGradient id="paint"/>"""
    body = f'<g color="#123456" stroke="#abcdef"><g><line x2="9" {attributes}/></g></g>'
    assert read(svg(sheet + body, style='class="outer"')).lines[0].colour == colour


def test_a_style_sheet_after_the_drawing_holds_too():
    assert read(svg('<line class="a" x2="9"/><style>.a{stroke:red}</style>', style="")).lines


# Layers


@pytest.mark.parametrize(
    ("body", "layer"),
    [
        (
            f'<g inkscape:groupmode="layer" inkscape:label="top 0.5" id="layer1">{LINE}</g>',
            "top 0.5",
        ),
        (
            '<g inkscape:groupmode="layer" inkscape:label="skeleton"><g inkscape:groupmode="layer" '
            f'inkscape:label="top 1"><g id="g1024">{LINE}</g></g></g>',
            "skeleton::top 1",
        ),
        (
            '<g inkscape:groupmode="layer" inkscape:label="L"><g id="g5" inkscape:label="top 1">'
            f"{LINE}</g></g>",
            "L::top 1",
        ),
        (f'<g id="top_0.5">{LINE}</g>', "top_0.5"),
        (f'<g id="top_0.5_1_">{LINE}</g>', "top_0.5"),
        (f'<g id="bottom_x20_75_x25_">{LINE}</g>', "bottom 75%"),
        (f'<g id="bottom-75" data-name="bottom 75%">{LINE}</g>', "bottom 75%"),
        (
            f'<g id="top-0.51" serif:id="top 0.5" xmlns:serif="http://www.serif.com/">{LINE}</g>',
            "top 0.5",
        ),
        (f'<g id="Frame 1"><g id="top 0.5">{LINE}</g></g>', "Frame 1::top 0.5"),
        (f'<g id="top 0.5"><g id="Group 12"><g id="g7">{LINE}</g></g></g>', "top 0.5"),
        (f'<g data-name="&lt;Group&gt;" id="_Group_"><g id="passive">{LINE}</g></g>', "passive"),
        (f"<g><g>{LINE}</g></g>", ""),
        (f'<g id="a"><use href="#r"/></g><defs><g id="r">{LINE}</g></defs>', "a"),
    ],
)
def test_layers(body, layer):
    assert [line.layer for line in read(svg(body)).lines] == [layer]


def test_figma_numbers_a_name_used_before():
    body = "".join(f'<g id="{name}">{LINE}</g>' for name in ("top 0.5", "top 0.5_2", "top_25"))
    assert [line.layer for line in read(svg(body)).lines] == ["top 0.5", "top 0.5", "top_25"]


def test_the_only_layer_of_illustrator_is_the_outermost_svg():
    text = svg(LINE, PX + ' id="top_0.5"', ILLUSTRATOR)
    assert read(text).lines[0].layer == "top_0.5"
    text = svg(LINE + f'<g id="passive">{LINE}</g>', PX + ' id="Layer_1"', ILLUSTRATOR)
    assert [line.layer for line in read(text).lines] == ["", "passive"]
    assert read(svg(LINE, PAGE + ' id="svg8"')).lines[0].layer == ""


def test_a_line_is_called_by_its_id_or_its_place():
    drawing = read(svg(f'<line id="path3021" x2="9"/>\n\n{LINE}'))
    assert [line.where for line in drawing.lines] == ["path3021", "line in line 3"]
