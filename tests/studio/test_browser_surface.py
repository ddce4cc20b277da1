"""A surface on the page: dropped, lain on, told, changed, taken back, given to the command line."""

import base64
import json
import re

import pytest
from playwright.sync_api import expect
from sheets import broken, exported, sheet

import gestures as do
from simulearn.grid import grid_to_dict, make
from simulearn.inverse import read_task

SLOW = 60_000  # ms; kernels may have to be compiled
DROP = """
([name, data]) => {
  const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
  const dataTransfer = new DataTransfer();
  dataTransfer.items.add(new File([bytes], name));
  document.querySelector(".page").dispatchEvent(
    new DragEvent("drop", { bubbles: true, cancelable: true, dataTransfer }));
}
"""
PLACE = "async () => (await import('/page/store.js')).state.measured.shapes[0].place.shift"


def drop(page, name, data):
    page.evaluate(DROP, [name, base64.b64encode(data).decode()])


def goals(page):
    return page.get_by_role("tabpanel", name="Goals")


def mean(panel):
    """Wait until goals are compared with the shape, and return the mean distance in mm."""
    value = panel.locator(".measure-value")
    expect(value).to_have_text(re.compile(r"\d mm$"), timeout=SLOW)
    expect(panel.locator(".measure.old")).to_have_count(0)
    return float(value.inner_text().removesuffix(" mm"))


def assert_another_unit(page, panel):
    """The unit is changed, and that is taken back."""
    expect(do.fact(panel, "Size")).to_have_text("160 × 160 × 18.6 mm")
    do.button(panel, "Unit: Change…").click()
    dialog = page.get_by_role("dialog", name="How large is hood.stl?")
    expect(dialog.get_by_role("radio", name="Millimetres")).to_be_checked()
    dialog.get_by_role("radio", name="Inches").check()
    do.button(dialog, "Take this size").click()
    expect(do.fact(panel, "Size")).to_have_text("4064 × 4064 × 472 mm")
    expect(do.fact(panel, "Unit")).to_have_text("Inches, as chosen")
    do.button(page, "Undo: unit of hood: in").click()
    expect(do.fact(panel, "Unit")).to_have_text("Millimetres: the file does not say")


def test_a_dropped_surface_becomes_a_goal_that_tells_itself_and_can_be_changed(page, studio, axe):
    do.opened(page, studio.url)
    before = do.document(page)
    drop(page, "hood.stl", exported(broken(sheet()), "stl"))
    panel = goals(page)
    expect(panel.get_by_role("heading", name="All joints on hood")).to_be_visible()
    all_joints = mean(panel)
    assert 5 < all_joints < 50
    expect(panel).to_contain_text(re.compile(r"Worst: Joint \d, centre, \d+\.\d mm"))
    expect(do.shape(page).locator(".note-line.note-goal")).to_have_count(9)
    # What was mended, and where.
    expect(do.fact(panel, "Unit")).to_have_text("Millimetres: the file does not say")
    hole = do.button(panel, re.compile("^Holes"))
    hole.focus()
    expect(do.shape(page).locator(".note-ring.note-collision")).to_have_count(1)
    assert axe(page) == []
    hole.blur()
    assert_another_unit(page, panel)
    expect(do.shape(page).locator(".note-ring.note-collision")).to_have_count(0)
    # Only one joint, which may not slide and has a tolerance.
    do.joint(page, 2).click()
    panel.get_by_label("Points on hood").select_option("Selected in the plan (1)")
    expect(panel.get_by_role("heading", name="Joint 2, centre on hood")).to_be_visible()
    assert mean(panel) != all_joints
    panel.get_by_label("Points may slide on hood").uncheck()
    panel.get_by_label("Tolerance of hood").fill("0.5")
    page.keyboard.press("Enter")
    document = do.document(page)
    goal = {"surface": "hood", "weight": 1, "vertices": [["joint", 2, "centre"]]}
    assert document["goals"] == [goal | {"slide": False, "tolerance": 0.5}]
    assert len(document["surfaces"][0]["faces"]) == 286
    # A point goal beside it, and one by one back to the beginning.
    panel.get_by_label("Point to add").select_option("Joint 6, centre")
    do.button(panel, "Add").click()
    expect(panel.get_by_role("listitem").filter(has_text="Joint 6, centre")).to_be_visible()
    expect(panel.get_by_role("list", name="Suggestions")).to_be_visible(timeout=SLOW)
    do.button(panel, "Remove the goal Joint 2, centre on hood").click()
    assert do.document(page)["surfaces"] == []
    for step in ["remove goal", "add goal", "tolerance", "sliding", "points on", "surface"]:
        do.button(page, re.compile(f"^Undo: {step}")).click()
    assert do.document(page) == before


def test_a_surface_elsewhere_is_searched_for_and_saved_as_a_task(page, studio, tmp_path, forgiven):
    forgiven.append("status of 422")  # the server asks what it is
    do.opened(page, studio.url)
    far = sheet(40)
    far.apply_translation([500, 0, 100])
    drop(page, "roof.obj", exported(far, "obj") + b"\nl 1 41\n")
    do.button(page, "A surface to lie on").click()
    panel = goals(page)
    expect(page.get_by_text("lies elsewhere than the grid")).to_be_visible()
    expect(panel.get_by_label("The shape may be placed anywhere")).to_be_checked()
    # It is asked of another grid, too.
    do.button(page, "Library").click()
    page.get_by_role("dialog").get_by_role("button", name=re.compile("^saddle")).click()
    expect(page.get_by_label("Name of the design")).to_have_value("saddle")
    expect(panel.get_by_role("heading", name="All joints on roof")).to_be_visible()
    start = mean(panel)
    assert start < 20
    assert page.evaluate(PLACE)[0] > 400
    panel.get_by_label("Time limit").fill("10")
    page.keyboard.press("Enter")
    do.button(panel, "Search").click()
    found = panel.get_by_role("group", name="Found")
    expect(found).to_be_visible(timeout=SLOW)
    do.button(found, "Take it").click()
    do.simulated(page)
    assert mean(panel) < start
    with page.expect_download() as waiting:
        do.choose(page, "File", "Save as task")
    path = tmp_path / "roof.json"
    waiting.value.save_as(path)
    task = read_task(path)
    assert (len(task.aims), task.pose, set(task.aims.kinds)) == (9, "free", {"surface"})
    do.choose(page, "File", "Copy link")
    expect(page.get_by_role("dialog")).to_contain_text(re.compile(r"\d{4,} characters long"))
    page.keyboard.press("Escape")
    do.saved(page)
    page.reload()  # the browser's copy has it, too
    do.simulated(page)
    assert mean(do.tab(page, "Goals")) < start


@pytest.mark.parametrize(
    "page",
    [{"viewport": {"width": 390, "height": 844}, "locale": "de-DE", "has_touch": True}],
    indirect=True,
)
def test_other_goals_of_a_task_are_listed_and_removed_on_a_phone_in_german(page, studio):
    page.goto(studio.url)
    expect(page.get_by_role("slider", name="Von flach bis verformt")).to_be_enabled(timeout=SLOW)
    wanted = [
        {
            "vertices": "joints",
            "surface": {"heights": "10", "x": [-90, 90], "y": [-90, 90], "step": 20},
        },
        {"face": ["joint", 8, "top"], "direction": [0.5, 0, 1]},
        {"vertices": [["joint", 0, "centre"], ["joint", 8, "centre"]], "distance": 150},
        {"away_from": "itself", "clearance": 1},
    ]
    task = {"schema": "simulearn.task/1", "grid": grid_to_dict(make("saddle")), "goals": wanted}
    drop(page, "haube.json", json.dumps(task).encode())
    page.locator(".notice").get_by_role("button", name="Schließen").click()
    page.get_by_role("tab", name="Ziele").click()
    panel = page.get_by_role("tabpanel", name="Ziele")
    items = panel.locator(".goal")
    expect(items).to_have_count(4)
    expect(items.nth(0)).to_contain_text("Alle Knoten auf surface 1")
    expect(items.nth(1)).to_contain_text("Oberseite von Knoten 8 in Richtung 0,5, 0, 1")
    expect(items.nth(2)).to_contain_text("150 mm Abstand")
    expect(items.nth(3)).to_contain_text("Alle Stäbe 1,0 mm entfernt von einander")
    expect(items.nth(2).locator(".goal-error")).to_have_text(re.compile(r"\d mm$"), timeout=SLOW)
    expect(items.nth(2).get_by_role("textbox")).to_have_count(0)
    items.nth(2).get_by_role("button").click()
    expect(items).to_have_count(3)
    assert not do.scrolls_sideways(page)
