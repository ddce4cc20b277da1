"""Pictures of toolpaths: colours as they mean, to scale, nothing cut off."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb

from simulearn.fabricate import load_printer, prepare
from simulearn.grid import make
from simulearn.show import style, toolpath

JOB = prepare([make("saddle")], load_printer("modix-big60"))


def pixels(figure):
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3] / 255.0


def near(picture, colour, within=0.04):
    return (abs(picture - to_rgb(colour)) < within).all(axis=-1)


def test_active_beads_have_the_colour_of_their_half():
    for number, colour, other in ((0, style.BOTTOM, style.TOP), (15, style.TOP, style.BOTTOM)):
        picture = pixels(toolpath.layer(JOB.path, number))
        body = picture[: int(0.85 * len(picture))]
        assert near(body, colour).mean() > 0.005
        assert not near(body, other).any()
        assert near(body, toolpath.TRAVEL).any()


def test_all_layers_are_shown_from_the_bed_up():
    figure = toolpath.layers(JOB.path, "words")
    words = [text.get_text() for text in figure.texts]
    assert words[:2] == ["layer 1, z 0.25 mm", "layer 2, z 0.50 mm"]
    assert words[15] == "layer 16, z 4.00 mm"
    assert "words" in words
    picture = pixels(figure)
    half = picture[: len(picture) // 2 - 40], picture[len(picture) // 2 : int(0.9 * len(picture))]
    assert near(half[0], style.BOTTOM, 0.3).mean() > 3 * near(half[0], style.TOP, 0.3).mean()
    assert near(half[1], style.TOP, 0.3).mean() > 3 * near(half[1], style.BOTTOM, 0.3).mean()


@pytest.mark.parametrize("draw", [toolpath.layers, lambda path: toolpath.layer(path, 0)])
def test_pictures_leave_a_white_rim_and_are_to_scale(draw):
    figure = draw(JOB.path)
    picture = pixels(figure)
    for rim in (picture[:4], picture[-4:], picture[:, :4], picture[:, -4:]):
        assert (rim == 1).all()
    ax = next(a for a in figure.axes if a.collections)
    (x0, y0), (x1, y1) = ax.transData.transform([(0, 0), (10, 10)])
    assert x1 - x0 == pytest.approx(y1 - y0, rel=1e-3)


def test_beads_are_drawn_as_wide_as_they_are():
    figure = toolpath.layer(JOB.path, 0)
    (ax,) = (a for a in figure.axes if any(isinstance(c, LineCollection) for c in a.collections))
    FigureCanvasAgg(figure).draw()
    (x0, _), (x1, _) = ax.transData.transform([(0, 0), (1, 0)])
    point = (x1 - x0) * 72 / figure.dpi  # a mm
    widths = [np.median(c.get_linewidths()) for c in ax.collections[:-1]]
    np.testing.assert_allclose(widths, 0.6 * toolpath.PART * point, rtol=0.02)
