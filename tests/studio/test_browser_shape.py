"""The view of the shape: turned, moved and zoomed by mouse, wheel and fingers; what it says."""

import io
import json
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

import gestures as do

SNAPS = json.loads((Path(__file__).parent.parent / "data" / "snaps.json").read_text())
TABLET = {"viewport": {"width": 820, "height": 1180}, "has_touch": True}
REST = 900  # ms after which the view has come to rest and is drawn finely


@pytest.fixture
def seen(page):
    """A function that returns a picture of the shape once it is at rest."""

    def seen():
        page.wait_for_timeout(REST)
        canvas = page.get_by_role("application", name="Shape in space").locator("canvas")
        return np.asarray(Image.open(io.BytesIO(canvas.screenshot())).convert("L"), float)

    return seen


def differ(one, other):
    """Return whether two pictures show something else."""
    return np.mean(abs(one - other) > 20) > 0.003


@pytest.fixture
def view(page, studio):
    """The middle of the view of the shape, px."""
    do.opened(page, studio.url)
    box = page.get_by_role("application", name="Shape in space").bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def test_mouse_and_wheel(page, view, seen):
    x, y = view
    still = seen()
    assert not differ(still, seen())
    pictures = [still]
    for turn in ("left", "right"):  # turns, moves
        page.mouse.move(x, y)
        page.mouse.down(button=turn)
        page.mouse.move(x + 60, y + 30, steps=4)
        page.mouse.up(button=turn)
        pictures.append(seen())
    page.mouse.wheel(0, -300)  # zooms
    pictures.append(seen())
    for before, after in pairwise(pictures):
        assert differ(before, after)
    page.get_by_role("application", name="Shape in space").dblclick()  # shows all of it
    do.button(page, "From aslant").click()
    assert not differ(still, seen())


@pytest.mark.parametrize("page", [TABLET], indirect=True)
def test_fingers(page, view, seen):
    session = page.context.new_cdp_session(page)

    def touch(kind, *points):
        places = [{"x": x, "y": y} for x, y in points]
        session.send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": places})

    x, y = view
    pictures = [seen()]
    touch("Start", (x, y))
    for by in (15, 30, 45):
        touch("Move", (x + by, y + by / 2))
    touch("End")
    pictures.append(seen())  # turned
    touch("Start", (x - 40, y), (x + 40, y))
    for by in (10, 25, 40):
        touch("Move", (x - 40 - by, y), (x + 40 + by, y))
    touch("End")
    pictures.append(seen())  # nearer
    for before, after in pairwise(pictures):
        assert differ(before, after)


def test_a_snap_is_reported_in_words_and_on_the_timeline(page, studio):
    do.opened(page, studio.url)
    do.open_file(page, "snaps.json", SNAPS)
    do.simulated(page)
    expect(do.shape(page).get_by_text("Snaps while it creeps")).to_be_visible()
    expect(do.shape(page).get_by_title("The grid snaps here").first).to_be_visible()


def test_dimensions_and_heights_on_demand(page, studio):
    do.opened(page, studio.url)
    notes = do.shape(page).locator(".note-text, .shape-notes text, text")
    before = notes.count()
    do.button(page, "Show").click()
    page.get_by_text("Dimensions", exact=True).click()
    page.get_by_text("Heights of joints", exact=True).click()
    expect(notes.nth(before + 3 + 8)).to_be_visible()  # three sides, nine joints
