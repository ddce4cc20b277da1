"""The small pictures in a file: their encoding, and what is seen in them."""

import base64
import io
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from PIL import Image, ImageColor
from several import job_of

from simulearn.fabricate import prepare, qoi
from simulearn.fabricate.thumbnail import draw, png, thumbnails
from simulearn.grid import Grid, make
from simulearn.palette import BEADS, BOTTOM, TOP

NEAR = st.sampled_from([0, 1, 2, 7, 30, 33, 128, 254, 255])  # steps of every size that QOI knows


def decoded(data):
    with Image.open(io.BytesIO(data)) as picture:
        assert picture.format == "QOI"
        return np.asarray(picture.convert("RGBA"))


@given(
    arrays.arrays(
        np.uint8,
        st.tuples(st.integers(1, 40), st.integers(1, 40), st.just(4)),
        elements=NEAR,
        fill=NEAR,
    )
)
@settings(max_examples=150, deadline=None)
def test_qoi_is_read_back_by_pillow(pixels):
    np.testing.assert_array_equal(decoded(qoi.encode(pixels)), pixels)


@pytest.mark.parametrize("first", [(0, 0, 0, 255), (0, 0, 0, 0), (1, 2, 3, 255)])
@pytest.mark.parametrize("length", [1, 61, 62, 63, 64, 124, 125, 400])
def test_qoi_of_runs(first, length):
    pixels = np.tile(np.array(first, dtype=np.uint8), (1, length, 1))
    pixels = np.concatenate([pixels, np.full((1, 1, 4), 9, np.uint8), pixels], axis=1)
    np.testing.assert_array_equal(decoded(qoi.encode(pixels)), pixels)


def colour_at(picture, place):
    x, y = np.clip(np.round(place).astype(int), 0, np.array(picture.size) - 1)
    return picture.getpixel((int(x), int(y)))


@pytest.mark.parametrize("size", [(32, 32), (48, 48), (300, 300), (313, 173)])
def test_beams_have_the_colours_of_their_halves(size):
    beams = [[0, 1], [1, 2], [3, 2], [0, 3]]
    grid = Grid([[0, 0], [60, 0], [60, 60], [0, 60]], beams, [1, -1, 0, 0], 0)
    job = prepare([grid], job_of("voron", "cone").printer)
    picture = draw(job.path, size)
    joints = job.grids[0].joints
    low, high = joints.min(axis=0), joints.max(axis=0)
    middle = (low + high) / 2
    scale = 0.8 * min(size) / 60  # more than a beam nearer to the middle does no harm

    def seen(place):
        away = (np.array(place) - middle) * scale
        return colour_at(picture, np.array(size) / 2 + away * [1, -1])

    assert picture.size == size
    for colour, place in (
        (TOP, (middle[0], low[1] - 1)),
        (BOTTOM, (high[0] + 1, middle[1])),
        (BEADS["passive"], (middle[0], high[1] + 1)),
        (BEADS["passive"], (low[0] - 1, middle[1])),
    ):
        found = np.array(seen(place))
        wanted = np.array([*ImageColor.getrgb(colour), 255])
        assert np.abs(found - wanted).max() < 40, (colour, found)
    assert seen(middle)[3] == 0  # the cell is transparent
    assert picture.getpixel((0, 0))[3] == 0


@pytest.mark.parametrize("name", ["cone", "twist", "wave", "two"])
def test_a_picture_fills_its_place_and_touches_no_edge(name):
    for size in ((32, 32), (300, 300), (440, 240)):
        solid = np.asarray(draw(job_of("prusa-mk4", name).path, size))[..., 3] > 127
        across, up = (
            np.ptp(np.nonzero(solid.any(axis=0))[0]),
            np.ptp(np.nonzero(solid.any(axis=1))[0]),
        )
        assert max((across + 1) / size[0], (up + 1) / size[1]) > 0.85
        assert not solid[[0, -1]].any()
        assert not solid[:, [0, -1]].any()


def test_pictures_in_the_file_are_whole():
    path = job_of("prusa-mk4", "cone").path
    text = "\n".join(thumbnails(path, "prusa")) + "\n"
    blocks = re.findall(
        r"^; thumbnail(?:_QOI)? begin (\d+)x(\d+) (\d+)\n((?:; \S{1,78}\n)+); thumbnail", text, re.M
    )
    assert len(blocks) == 6
    for width, height, letters, block in blocks:
        data = "".join(line[2:] for line in block.splitlines())
        assert len(data) == int(letters)
        with Image.open(io.BytesIO(base64.b64decode(data, validate=True))) as picture:
            assert picture.size == (int(width), int(height))
            expected = np.asarray(draw(path, picture.size))
            np.testing.assert_array_equal(np.asarray(picture.convert("RGBA")), expected)
    assert list(thumbnails(path, "bambu")) == []


def test_a_picture_is_the_same_twice():
    path = job_of("prusa-mk4", "wave").path
    assert png(draw(path, (300, 300))) == png(draw(path, (300, 300)))


def test_a_print_without_actuators_has_a_picture():
    job = prepare([make("flat", (1, 1), 30.0)], job_of("voron", "cone").printer)
    assert np.asarray(draw(job.path, (32, 32)))[..., 3].any()
