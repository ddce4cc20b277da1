"""A target that is dragged in space by its handles."""

import pytest
from playwright.sync_api import expect

ADD = """async () => {
  const { edit, select } = await import("/page/store.js");
  const { addGoal } = await import("/page/document/goals.js");
  edit((d) => addGoal(d, ["joint", 0, "centre"], [-60, -60, -10]), { label: "goal" });
  select({ goal: 0 });
}"""
TARGET = "async () => (await import('/page/store.js')).state.document.goals[0].target"


def pressed(page):
    """Press the button of the mouse on the tip of the z axis of a target; return where."""
    page.get_by_role("tab", name="Goals").click()
    page.evaluate(ADD)
    handle = page.locator("g.note-dot.note-handle.z")
    expect(handle).to_be_visible()
    box = handle.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    return x, y


@pytest.fixture
def ready(page, studio):
    """The page with a shape."""
    page.goto(studio.url)
    expect(page.get_by_role("slider", name="From flat to morphed")).to_be_enabled()
    return page


def test_a_handle_drags_a_target_along_its_axis(ready):
    page = ready
    x, y = pressed(page)
    page.mouse.move(x, y - 40, steps=5)
    page.mouse.up()
    moved = page.evaluate(TARGET)
    assert moved[:2] == [-60, -60]
    assert moved[2] > 0
    page.get_by_role("button", name="Undo: ", exact=False).click()
    assert page.evaluate(TARGET) == [-60, -60, -10]


def test_a_target_follows_the_hand_though_the_view_changes_its_size(ready):
    page = ready
    x, y = pressed(page)
    page.mouse.move(x, y - 20)
    halfway = page.evaluate(TARGET)[2]
    shape = page.get_by_role("application", name="Shape in space")
    high = shape.bounding_box()["height"]
    page.get_by_role("button", name="Do not show this hint again").evaluate("(e) => e.click()")
    assert shape.bounding_box()["height"] > high
    page.evaluate("() => new Promise((done) => requestAnimationFrame(() => setTimeout(done)))")
    page.mouse.move(x, y - 40)
    page.mouse.up()
    end = page.evaluate(TARGET)[2]
    assert end - halfway == pytest.approx(halfway + 10, rel=0.15)
