"""Layers that are read, and what their names and colours say about actuators."""

import pytest
from messy import drawing, l_grid

from simulearn.drawings.convention import near_layer, ratio_of_colour, ratio_of_layer
from simulearn.drawings.drawing import Drawing, LeftOut, Line
from simulearn.drawings.importing import Options, grid_of
from simulearn.errors import InputError

BEAMS = l_grid()


@pytest.mark.parametrize(
    ("name", "ratio"),
    [
        ("top 0.5", 0.5),
        ("bottom 75%", -0.75),
        ("top-25", 0.25),
        ("Bottom_1", -1),
        ("TOP", 1),
        ("bottom", -1),
        ("passive", 0),
        ("top 0,5", 0.5),
        ("top:0.5", 0.5),
        ("top=.5", 0.5),
        ("skeleton::top 0.5", 0.5),
        ("top0.25", 0.25),
        ("bottom 0", 0),
        ("top 5", None),
        ("top 150", None),
        ("tpo 0.5", None),
        ("topology", None),
        ("0", None),
        ("", None),
    ],
)
def test_the_ratio_that_a_layer_names(name, ratio):
    assert ratio_of_layer(name) == ratio


@pytest.mark.parametrize(
    ("name", "near"),
    [
        ("tpo 0.5", True),
        ("top 5", True),
        ("botom 1", True),
        ("top view", True),
        ("pasive", True),
        ("walls", False),
        ("0", False),
        ("Layer 12", False),
        ("stop", False),
    ],
)
def test_near_misses(name, near):
    assert near_layer(name) == near


def coloured(colours):
    spatial = drawing(BEAMS).lines
    return Drawing(
        "test",
        [Line(line.points, "beams", c) for line, c in zip(spatial, colours, strict=True)],
        plain=True,
    )


def codes(result):
    return {message.code: message.message for message in result.messages}


def test_layers_choose_actuators_and_that_is_reported():
    names = ["top 0.5"] * 2 + ["Bottom_1"] * 3 + ["passive"] * 5
    result = grid_of(drawing(BEAMS, names))
    assert result.grid.actuators.tolist() == [0.5] * 2 + [-1] * 3 + [0] * 5
    words = 'actuators by layer: "top 0.5" is top 0.5 (2 lines); "Bottom_1" is bottom 1 (3 lines)'
    assert words in codes(result)["actuators"]
    assert [layer.ratio for layer in result.layers] == [0.5, -1, 0]
    none = grid_of(drawing(BEAMS, names), Options(actuators="none"))
    assert not none.grid.actuators.any()


def test_a_near_miss_is_reported_and_not_taken():
    result = grid_of(drawing(BEAMS, ["tpo 0.5"] * 10))
    assert not result.grid.actuators.any()
    assert codes(result)["actuator-near-miss"].startswith('the layer "tpo 0.5" was not read')


def test_colours_choose_where_no_layer_does():
    result = grid_of(coloured(["#ff0000", "#0072b2", "#E18D4A", "#d65f01", *["#000000"] * 6]))
    assert result.grid.actuators.tolist() == [1, -1, 0.5, 1, *[0] * 6]
    alike = grid_of(coloured(["#ff0000"] * 10))
    assert not alike.grid.actuators.any()
    result = grid_of(coloured(["#ff0000"] * 10), Options(actuators="colours"))
    assert result.grid.actuators.tolist() == [1] * 10


def test_a_colour_nearly_of_the_convention_is_reported_and_not_taken():
    result = grid_of(coloured(["#f50a0a", *["#000000"] * 9]))
    assert not result.grid.actuators.any()
    assert codes(result)["actuator-near-miss"] == (
        "the colour #f50a0a was not read as an actuator; #ff0000 is one of those that are read"
    )
    assert ratio_of_colour("red") is None


def test_only_the_layers_that_are_named_are_read():
    lines = [*BEAMS, [[0, 0], [130, 130]], [[0, 200], [500, 200]]]
    names = ["Beams"] * 10 + ["Notes", "plan::frame"]
    result = grid_of(drawing(lines, names), Options(layers=("beam*",)))
    assert len(result.grid.beams) == 10
    assert [layer.taken for layer in result.layers] == [True, False, False]
    texts = [message.message for message in result.messages]
    assert '1 line on the layer "Notes" left out: it is not among those to read' in texts
    both = grid_of(drawing(lines, names), Options(layers=("BEAMS, frame", "plan")))
    assert [layer.taken for layer in both.layers] == [True, False, True]
    with pytest.raises(
        InputError, match=r'no layer "walls" with lines; .* "Beams", "Notes"'
    ) as error:
        grid_of(drawing(lines, names), Options(layers=("walls",)))
    assert error.value.code == "layers-unknown"


def test_of_our_own_drawings_the_axes_alone_are_read():
    lines = [*BEAMS, [[0, 3], [130, 3]]]
    result = grid_of(drawing(lines, ["skeleton::top 0.5"] * 10 + ["outlines"]))
    assert result.grid.actuators.tolist() == [0.5] * 10


def test_an_actuator_drawn_over_a_beam_counts():
    lines = [*BEAMS, BEAMS[0] * 0.5 + BEAMS[0].mean(axis=0) * 0.5]
    result = grid_of(drawing(lines, ["passive"] * 10 + ["top 0.5"]))
    assert result.grid.actuators.tolist() == [0.5, *[0] * 9]
    both = grid_of(drawing([*BEAMS, BEAMS[0]], ["bottom 1"] * 10 + ["top 0.5"]))
    assert both.grid.actuators.tolist() == [-1] * 10
    assert codes(both)["actuators-mixed"].startswith("1 beam")


def test_what_the_reader_left_out_is_reported():
    left = [LeftOut("TEXT", 3, "notes", "is no line")]
    result = grid_of(drawing(BEAMS, left_out=left, messages=["a block is damaged"]))
    assert codes(result)["left-out"] == '3 x TEXT on the layer "notes" left out: is no line'
    assert codes(result)["reader"] == "a block is damaged"
