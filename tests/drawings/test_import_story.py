"""From the SVG files of four programs to the grid that was meant, with all that is reported."""

import json

import pytest

from simulearn.drawings.importing import Options, imported
from simulearn.drawings.units import UnitError

# The grid that all of them draw: three cells of 65 mm, the one at the upper right missing, with
# the ratio of each beam's actuator. Joints are counted by cell from the lower left.
MEANT = {
    ((0, 0), (1, 0)): 0.5,
    ((1, 0), (2, 0)): 0.5,
    ((0, 1), (1, 1)): 0.0,
    ((1, 1), (2, 1)): 0.0,
    ((0, 2), (1, 2)): 0.0,
    ((0, 0), (0, 1)): 0.0,
    ((0, 1), (0, 2)): 0.0,
    ((1, 0), (1, 1)): -0.75,
    ((1, 1), (1, 2)): -0.75,
    ((2, 0), (2, 1)): 0.0,
}


def beams(grid, side=65.0, slack=0.5):
    """Return the beams of a grid as pairs of cells with their ratios, from its lower left joint."""
    places = (grid.joints - grid.joints.min(axis=0)) / side
    cells = places.round()
    assert abs(places - cells).max() * side < slack
    named = [tuple(map(int, cell)) for cell in cells]
    return {
        tuple(sorted((named[i], named[j]))): round(float(ratio), 3)
        for (i, j), ratio in zip(grid.beams, grid.actuators, strict=True)
    }


def said(result, code):
    return [message.message for message in result.messages if message.code == code]


# As Inkscape writes it: mm, y downwards, layers in a moved layer, clones, a hidden layer, words.
# Messy: a gap of .3, an overshoot of .8, a line drawn twice, a crumb, no joint where lines cross.
INKSCAPE = """<?xml version="1.0" encoding="UTF-8" standalone="no"?>
<!-- Created with Inkscape (http://www.inkscape.org/) -->
<svg width="210mm" height="297mm" viewBox="0 0 210 297" version="1.1" id="svg5"
   inkscape:version="1.3.2 (091e20ef0f, 2023-11-25)" sodipodi:docname="träger.svg"
   xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"
   xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd"
   xmlns:xlink="http://www.w3.org/1999/xlink" xmlns="http://www.w3.org/2000/svg">
  <sodipodi:namedview id="namedview7" inkscape:document-units="mm">
    <inkscape:grid type="xygrid" id="grid1"/>
    <sodipodi:guide position="20,60" orientation="0,1" id="guide9"/>
  </sodipodi:namedview>
  <defs id="defs2"><inkscape:path-effect effect="spiro" id="path-effect1"/></defs>
  <g inkscape:groupmode="layer" id="layer0" inkscape:label="grid" transform="translate(30,40)">
    <g inkscape:groupmode="layer" id="layer1" inkscape:label="passive"
       style="fill:none;stroke:#dcdcdc;stroke-width:0.8">
      <path id="path1" d="M 0,65 H 130"/>
      <path id="path2" d="m 0,0 64.7,0" inkscape:connector-curvature="0"/>
      <path id="path3" d="M 0,130.8 V 0"/>
      <path id="path3b" d="M 0,20 V 110"/>
      <use id="use4" xlink:href="#half" x="130" y="65"/>
      <path id="crumb" d="m 65,65 0.2,0.1"/>
    </g>
    <g inkscape:groupmode="layer" id="layer2" inkscape:label="Top 0.5"
       style="fill:none;stroke:#e18d4a">
      <g id="g1024"><path id="path5" d="M 0,130 130,130"/></g>
    </g>
    <g inkscape:groupmode="layer" id="layer3" inkscape:label="bottom 75%"
       style="fill:none;stroke:#2586bd">
      <path id="path6" transform="matrix(0,1,1,0,65,0)" d="M 0,0 C 40,0 90,0 130,0"/>
    </g>
  </g>
  <defs id="defs9"><path id="half" d="M 0,0 V 65"/></defs>
  <g inkscape:groupmode="layer" id="layer4" inkscape:label="notes" style="display:none">
    <path style="stroke:#000" d="M 0,0 210,297"/><path style="stroke:#000" d="M 0,9 9,9"/>
  </g>
  <text x="9" y="9" id="text1"><tspan id="tspan1">Entwurf 3</tspan></text>
</svg>"""


def test_inkscape():
    result = imported(INKSCAPE.encode(), "träger.svg")
    assert beams(result.grid) == MEANT
    assert result.unit.mm == 1.0
    assert [(layer.name, layer.lines, layer.ratio) for layer in result.layers] == [
        ("grid::passive", 6, 0.0),
        ("grid::Top 0.5", 1, 0.5),
        ("grid::bottom 75%", 1, -0.75),
    ]
    assert {mend.code for mend in result.mends} >= {"gap", "overshoot", "crumb", "crossing"}
    assert said(result, "left-out") == [
        '2 x path on the layer "notes" left out: its layer is hidden',
        "1 x text left out: is no line",
    ]


# As Illustrator writes it: points called px, entities, classes, a switch, ids with escapes, lines
# as Beziers; the beams in the middle are one polyline, cut by others.
ILLUSTRATOR = """<?xml version="1.0" encoding="utf-8"?>
<!-- Generator: Adobe Illustrator 26.0.1, SVG Export Plug-In . SVG Version: 6.00 Build 0)  -->
<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd" [
  <!ENTITY ns_svg "http://www.w3.org/2000/svg">
  <!ENTITY ns_ai "http://ns.adobe.com/AdobeIllustrator/10.0/">
]>
<svg version="1.1" xmlns="&ns_svg;" xmlns:i="&ns_ai;" x="0px" y="0px" width="368.504px"
   height="368.504px" viewBox="0 0 368.504 368.504" xml:space="preserve"
   style="enable-background:new 0 0 368.504 368.504;">
<style type="text/css">
  .st0{fill:none;stroke:#000000;stroke-miterlimit:10;}
  .st1{fill:none;stroke:#D55E00;stroke-width:2;}
  .st2{display:none;} .st3{display:inline;fill:none;stroke:#000000;}
</style>
<switch>
  <foreignObject requiredExtensions="&ns_ai;" x="0" y="0" width="1" height="1"/>
  <g i:extraneous="self">
    <g id="passive">
      <polyline class="st0" points="0,0 184.252,0 "/>
      <path class="st0" d="M368.504,184.252c-122.835,0-245.669,0-368.504,0"/>
      <line class="st0" x1="0" y1="368.504" x2="0" y2="0"/>
      <line class="st0" x1="368.504" y1="367.2" x2="368.504" y2="184.252"/>
      <path class="st0" d="M10,10c5,0,9,4,9,9"/>
    </g>
    <g id="top_0.5"><g>
      <line class="st1" x1="368.504" y1="368.504" x2="184.252" y2="368.504"/>
    </g></g>
    <g id="top_0.5_1_"><line class="st1" x1="0" y1="368.504" x2="184.252" y2="368.504"/></g>
    <g id="bottom_x20_75_x25_"><path class="st1" d="M184.252,368.504V0"/></g>
    <g id="construction" class="st2"><line class="st3" x1="0" y1="0" x2="368" y2="368"/></g>
  </g>
</switch>
</svg>"""


def test_illustrator():
    result = imported(ILLUSTRATOR.encode(), "grid.svg")
    assert beams(result.grid) == MEANT
    assert result.unit.name == "pt"
    assert "Adobe Illustrator" in said(result, "unit")[0]
    assert "gap" in {mend.code for mend in result.mends}
    assert "1 x cubic Bezier" in said(result, "curves")[0]
    assert said(result, "left-out") == [
        '1 x line on the layer "construction" left out: its layer is hidden'
    ]


# As Figma writes it: px, everything as paths, ids with spaces, a name used twice; the designer
# has drawn 1 px for 1 mm, which only a person can say.
FIGMA = """<svg width="150" height="150" viewBox="0 0 150 150" fill="none"
 xmlns="http://www.w3.org/2000/svg">
<g id="Frame 1" clip-path="url(#clip0_1_2)">
<rect width="150" height="150" fill="white"/>
<g id="passive">
<path id="Vector 1" d="M10 75L140 75" stroke="#DCDCDC" stroke-width="2"/>
<path id="Vector 2" d="M75 10H10V140.6" stroke="#DCDCDC" stroke-width="2"/>
<line id="Line 1" x1="140" y1="140" x2="140" y2="75.4" stroke="black"/>
</g>
<g id="top 0.5"><line id="Line 2" x1="75" y1="140" x2="10" y2="140" stroke="black"/></g>
<g id="top 0.5_2"><line id="Line 3" x1="75" y1="140" x2="140" y2="140" stroke="black"/></g>
<g id="bottom 75%"><path id="Vector 3" d="M75.0001 139.8L75 10" stroke="black"/></g>
</g>
<defs><clipPath id="clip0_1_2"><rect width="150" height="150" fill="white"/></clipPath></defs>
</svg>"""


@pytest.mark.parametrize("options", [Options(unit="mm"), Options(width=130.0)])
def test_figma(options):
    result = imported(FIGMA.encode(), "Frame 1.svg", options)
    assert beams(result.grid) == MEANT
    messages = " ".join(message.message for message in result.messages)
    assert "clipped" in messages
    assert "filled without a stroke" in messages


def test_figma_by_the_standard():
    result = imported(FIGMA.encode(), "Frame 1.svg")
    assert result.unit.mm == pytest.approx(25.4 / 96)
    assert beams(result.grid, side=65.0 * 25.4 / 96) == MEANT
    assert "96 per inch" in said(result, "unit")[0]


# As Affinity writes it: no size at all; colours alone say the actuators.
AFFINITY = """<?xml version="1.0" encoding="UTF-8" standalone="no"?>
<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">
<svg width="100%" height="100%" viewBox="0 0 369 369" version="1.1"
 xmlns="http://www.w3.org/2000/svg" xmlns:serif="http://www.serif.com/"
 style="fill-rule:evenodd;stroke-linecap:round;">
<g transform="matrix(1,0,0,1,0.248,0.248)">
<path d="M0,184.252L368.504,184.252M0,0L184.252,0" style="fill:none;stroke:black;"/>
<path d="M0,0L0,368.504M368.504,184.252L368.504,368.504" style="fill:none;stroke:black;"/>
<g id="Ebene-2" serif:id="Ebene 2">
<path d="M0,368.504l368.504,-0" style="fill:none;stroke:rgb(225,141,74);"/>
<path d="M184.252,0L184.252,368.504" style="fill:none;stroke:rgb(37,134,189);"/>
</g></g></svg>"""


def test_affinity():
    with pytest.raises(UnitError) as caught:
        imported(AFFINITY.encode(), "a.svg")
    assert caught.value.guess.name == "pt"
    assert "Affinity" in str(caught.value)
    result = imported(AFFINITY.encode(), "a.svg", Options(unit=caught.value.guess.name))
    assert beams(result.grid) == MEANT
    assert "actuators by colour" in said(result, "actuators")[0]


def test_outlines_of_strokes_are_reported_as_such():
    bars = "".join(f'<path d="M0 {y}H130V{y + 8}H0Z"/>' for y in (0, 65, 130))
    text = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="130mm" viewBox="0 0 130 138">{bars}</svg>'
    )
    with pytest.raises(Exception, match="is filled and has no stroke"):
        imported(text.encode(), "bars.svg")


def test_the_command_line(run, tmp_path):
    file = tmp_path / "Träger.svg"
    file.write_text(AFFINITY, encoding="utf-8")
    code, _, error = run("import", file, "-o", tmp_path / "grid.json")
    assert code == 1
    assert "--unit" in error
    assert "Affinity" in " ".join(error.split())
    code, _, _ = run("import", file, "--width", "130", "-o", tmp_path / "grid.json")
    assert code == 0
    grid = json.loads((tmp_path / "grid.json").read_text(encoding="utf-8"))
    assert len(grid["beams"]) == 10
    file.write_text(AFFINITY[:-30], encoding="utf-8")
    code, _, error = run("import", file, "-o", tmp_path / "none.json")
    assert code == 1
    assert "line 11, column" in " ".join(error.split())
    assert not (tmp_path / "none.json").exists()
