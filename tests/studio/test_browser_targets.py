"""A target that is dragged in space by its handles, and moved by keys."""

from playwright.sync_api import expect

ADD = """async () => {
  const { edit, select } = await import("/page/store.js");
  const { addGoal } = await import("/page/document/goals.js");
  edit((d) => addGoal(d, ["joint", 0, "centre"], [-60, -60, -10]), { label: "goal" });
  select({ goal: 0 });
}"""
TARGET = "async () => (await import('/page/store.js')).state.document.goals[0].target"


def test_a_handle_drags_a_target_along_its_axis(page, studio):
    page.goto(studio.url)
    expect(page.get_by_role("slider", name="From flat to morphed")).to_be_enabled()
    page.get_by_role("tab", name="Goals").click()
    page.evaluate(ADD)
    handle = page.locator("g.note-dot.note-handle.z")
    expect(handle).to_be_visible()
    page.wait_for_function("() => document.querySelectorAll('.note-handle').length > 5")
    box = handle.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x, y - 40, steps=5)
    page.mouse.up()
    moved = page.evaluate(TARGET)
    assert moved[:2] == [-60, -60]
    assert moved[2] > 0
    page.get_by_role("button", name="Undo: ", exact=False).click()
    assert page.evaluate(TARGET) == [-60, -60, -10]
