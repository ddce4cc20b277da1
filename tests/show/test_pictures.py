"""Pictures: true to scale, near parts before far ones, colours as they mean, nothing cut off."""

import dataclasses
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from PIL import Image, ImageSequence

import synthetic
from simulearn.errors import Message
from simulearn.grid import make
from simulearn.schedule import Snap
from simulearn.show import Camera, animate, combined, deformed, flat, style
from simulearn.show.deformed import draw_skin
from simulearn.simulate import Skin, skin

RESULT = synthetic.result()


def pixels(figure):
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3] / 255.0


def near(picture, colour, within=0.02):
    """Where a picture has a colour."""
    return (abs(picture - to_rgb(colour)) < within).all(axis=-1)


def painted(figure):
    """The picture's axes: the only one that holds polygons."""
    (ax,) = [a for a in figure.axes if any(isinstance(c, PolyCollection) for c in a.collections)]
    return ax


@pytest.mark.parametrize("grid", [make("saddle"), make("wave", (3, 1)), make("cone", (1, 3))])
def test_every_picture_leaves_a_white_rim(grid):
    result = synthetic.result(grid)
    for figure in (flat(grid), deformed(result), combined(result)):
        picture = pixels(figure)
        for rim in (picture[:6], picture[-6:], picture[:, :6], picture[:, -6:]):
            assert (rim == 1).all()


def test_a_millimetre_is_as_long_on_both_axes():
    for figure in (flat(RESULT.grid), deformed(RESULT), combined(RESULT)):
        ax = painted(figure)
        FigureCanvasAgg(figure).draw()
        (x0, y0), (x1, y1) = ax.transData.transform([(0, 0), (10, 10)])
        assert x1 - x0 == pytest.approx(y1 - y0, rel=1e-3)


def test_the_flat_picture_shows_halves_ratios_and_the_fixed_joint():
    picture = pixels(flat(make("saddle")))
    body = picture[: int(0.85 * len(picture))]  # above the legend
    assert near(body, style.BOTTOM).mean() > 0.02  # ratio -1
    assert near(body, style.tint(0.25)).mean() > 0.005
    assert not near(body, style.TOP).any()  # nothing has ratio +1
    assert near(body, style.FIXED).mean() > 0.001
    # An actuator of ratio 1/4 covers a quarter of the length that one of ratio 1 does.
    shares = [near(body, style.tint(r)).sum() for r in (0.25, -1)]
    assert shares[0] / shares[1] == pytest.approx(0.25, rel=0.15)


def test_tints_deepen_with_the_ratio_and_differ_by_half():
    for sign in (1, -1):
        tints = style.tint(sign * np.array([0.25, 0.5, 0.75, 1.0]))
        assert (np.diff(tints.sum(axis=1)) < 0).all()
    np.testing.assert_allclose(
        style.tint([1, -1, 0]), [to_rgb(c) for c in ("#d55e00", "#0072b2", "#dcdcdc")]
    )


def test_numbers_may_be_left_out():

    def words(figure):
        return {t.get_text() for t in painted(figure).texts}

    assert {str(k) for k in range(12)} <= words(flat(RESULT.grid))
    assert not {str(k) for k in range(12)} & words(flat(RESULT.grid, numbers=False))


@pytest.mark.parametrize("upper", [0, 1])
def test_what_is_nearer_hides_what_is_farther(upper):
    # Two squares of short strips, one 5 mm above the other, in either order.
    x = np.linspace(0, 20, 11)
    z = [5.0, 0.0] if upper == 0 else [0.0, 5.0]

    def row(h):
        return np.stack([np.repeat(x, 2), np.tile([20.0, 0.0], 11), np.full(22, h)], axis=-1)

    strip = 2 * np.arange(10)[:, None] + np.array([0, 1, 3, 2])
    ratio = np.repeat([1.0, -1.0], 10)
    surface = Skin(
        np.concatenate([row(h) for h in z])[None],
        np.concatenate([strip, strip + 22]),
        ratio,
        np.full(20, -1),
        np.zeros((20, 4), dtype=bool),
    )
    figure = Figure(figsize=(2, 2))
    ax = figure.add_axes((0, 0, 1, 1))
    draw_skin(ax, surface.vertices[0], surface, 0, Camera(-90, 80))
    ax.set_xlim(4, 16)
    ax.set_ylim(6, 18)
    ax.axis("off")
    red, _, blue = pixels(figure).reshape(-1, 3).T
    assert ((red > blue) == (upper == 0)).all()


def test_the_camera_keeps_lengths_across_its_view():
    camera = Camera()
    np.testing.assert_allclose(camera.axes @ camera.axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(camera.axes) == pytest.approx(1)
    np.testing.assert_allclose(
        Camera(-90, 90).see(np.array([1.0, 2.0, 3.0])), [1, 2, 3], atol=1e-12
    )


def test_a_deformed_picture_has_the_ghost_only_where_the_grid_is_not():
    picture = pixels(deformed(RESULT))
    assert near(picture, style.GHOST, 0.01).mean() > 0.01
    first = pixels(deformed(RESULT, frame=0))
    body = first[: int(0.8 * len(first))]
    assert near(body, style.GHOST, 0.005).mean() < 0.002  # the flat grid covers its ghost


def test_scale_bars_have_round_lengths():
    for span, length in [(20, 5), (39, 5), (81, 20), (130, 20), (200, 50), (999, 200)]:
        assert style.nice_length(span) == length


def test_the_animation_runs_through_all_frames_with_a_still_camera(tmp_path):
    path = tmp_path / "a.gif"
    animate(RESULT, path)
    assert path.stat().st_size < 3e6
    with Image.open(path) as gif:
        assert gif.info["loop"] == 0
        frames = [np.asarray(f.convert("RGB")) / 255.0 for f in ImageSequence.Iterator(gif)]
        durations = [f.info["duration"] for f in ImageSequence.Iterator(gif)]
    assert len(frames) == 34
    assert durations[0] == durations[-1] > 500
    assert max(durations[1:-1]) < 100
    # What stands still is the same in all: scale bar, legend, axes, paper.
    for frame in frames[1:]:
        np.testing.assert_array_equal(frame[-20:], frames[0][-20:])
    assert all((frame[:4] == 1).all() for frame in frames)
    steps = [abs(b - a).mean() for a, b in pairwise(frames)]
    assert min(steps) > 0  # it never stops on the way
    assert max(steps) < 5 * np.median(steps)  # nor jumps


def test_pictures_do_not_alter_the_settings_of_others():
    import matplotlib as mpl

    before = dict(mpl.rcParams)
    combined(RESULT)
    assert dict(mpl.rcParams) == before


def test_pictures_of_several_threads_are_the_same_as_alone():
    results = [synthetic.result(make(name)) for name in ("saddle", "cone", "wave", "flat")]
    alone = [pixels(combined(result)) for result in results]
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda result: pixels(combined(result)), results))
    for one, other in zip(alone, together, strict=True):
        np.testing.assert_array_equal(one, other)


def test_what_qualifies_an_answer_stands_under_its_picture():
    doubtful = dataclasses.replace(
        RESULT, stable=False, bound_mm=0.31, snaps=(Snap(0.944, 10),),
        warnings=(Message("beam-long", "beam 3", "beam 3 is long"),),
    )  # fmt: skip
    for draw in (deformed, combined):
        (line,) = [t.get_text() for t in draw(doubtful).texts if "unstable" in t.get_text()]
        for words in ("unstable balance", "snaps at 94%", "below 0.31 mm", "beam 3 is long"):
            assert words in line
        assert not [t for t in draw(RESULT).texts if "unstable" in t.get_text()]
        assert (pixels(draw(doubtful))[-6:] == 1).all()


def test_the_skin_is_seen_from_outside_only():
    surface = skin(RESULT)
    ax = painted(deformed(RESULT))
    drawn = sum(len(c.get_paths()) for c in ax.collections)
    assert drawn < 3 * len(surface.quads)
