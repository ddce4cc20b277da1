"""Files, links, pasted text and the library: designs that come and go."""

import json
import re

from playwright.sync_api import expect

import gestures as do
from simulearn.grid import grid_to_dict, make

ARCH = grid_to_dict(make("saddle", (2, 1), 60.0))
GOAL = {"vertex": ["joint", 0, "centre"], "target": [-60, -60, 12], "weight": 1}
CLIPBOARD = ["clipboard-read", "clipboard-write"]


def test_files_good_and_bad(page, studio, forgiven):
    do.opened(page, studio.url)
    forgiven.append("status of 4")
    do.open_file(page, "broken.json", b'{"joints": [')
    dialog = page.get_by_role("dialog", name="broken.json cannot be opened")
    expect(dialog).to_contain_text("JSON")
    page.keyboard.press("Escape")
    do.open_file(page, "odd.json", ARCH | {"fixed": 99})
    dialog = page.get_by_role("dialog", name="odd.json cannot be opened")
    expect(dialog).to_contain_text("99")
    do.button(dialog, "Close").last.click()
    expect(do.joints(page)).to_have_count(9)
    expect(do.button(page, "Nothing to undo")).to_be_disabled()

    do.open_file(page, "long saddle.json", ARCH)
    expect(page.get_by_label("Name of the design")).to_have_value("long saddle")
    expect(do.joints(page)).to_have_count(6)
    do.simulated(page)
    assert do.document(page)["grid"] == ARCH

    do.open_file(page, "task.json", {"schema": "simulearn.task/1", "grid": ARCH, "goals": [GOAL]})
    goals = do.tab(page, "Goals")
    expect(goals.get_by_label("z of the target of Joint 0, centre")).to_have_value("12")
    do.button(page, "Undo: open task.json").click()
    do.button(page, "Undo: open long saddle.json").click()
    expect(do.joints(page)).to_have_count(9)


def test_a_saved_file_opens_as_the_same_design(page, studio):
    do.opened(page, studio.url)
    do.click(page, (32, 65))
    page.keyboard.press("-")
    mine = do.document(page)
    with page.expect_download() as waiting:
        do.choose(page, "File", "Save the grid only")
    assert waiting.value.suggested_filename == "twist.grid.json"
    assert json.loads(do.downloaded(waiting.value)) == mine["grid"]
    do.choose(page, "File", "New")
    do.says(page, "No beams yet")
    do.open_file(page, "twist.json", mine)
    do.simulated(page)
    assert do.document(page) == mine


def test_a_link_holds_the_whole_design(visit, studio):
    page = do.opened(visit(permissions=CLIPBOARD), studio.url)
    do.open_file(page, "task.json", {"schema": "simulearn.task/1", "grid": ARCH, "goals": [GOAL]})
    do.choose(page, "File", "Copy link")
    expect(page.get_by_text("Link copied.")).to_be_visible()
    link = page.evaluate("() => navigator.clipboard.readText()")
    other = do.opened(visit(), link)
    expect(do.joints(other)).to_have_count(6)
    expect(other).to_have_url(re.compile("/d/"))  # its own from now on
    assert do.document(other) == do.document(page)
    broken = visit()
    broken.goto(link[:-40])
    expect(broken.get_by_role("dialog", name="The link cannot be opened")).to_be_visible()
    broken.keyboard.press("Escape")
    do.simulated(broken)


def test_a_design_is_pasted(visit, studio):
    page = do.opened(visit(permissions=CLIPBOARD), studio.url)
    page.evaluate("(text) => navigator.clipboard.writeText(text)", json.dumps(ARCH))
    page.keyboard.press("Control+v")
    expect(do.joints(page)).to_have_count(6)
    do.simulated(page)


def test_the_library(page, studio):
    do.opened(page, studio.url)
    do.button(page, "Library").click()
    library = page.get_by_role("dialog", name="Library")
    expect(library.get_by_role("listitem")).to_have_count(10)
    expect(library.locator("img")).to_have_count(10)
    library.get_by_role("button", name=re.compile("^dome")).click()
    expect(library).to_be_hidden()
    expect(page.get_by_label("Name of the design")).to_have_value("dome")
    do.simulated(page)
    do.button(page, "Undo: take “dome” from the library").click()
    expect(page.get_by_label("Name of the design")).to_have_value("twist")


def test_an_address_that_nobody_knows(page, studio, forgiven):
    forgiven.append("status of 404")
    page.goto(f"{studio.url}/d/{'A' * 22}")
    expect(page.get_by_role("dialog", name="No design at this address")).to_be_visible()
    page.keyboard.press("Escape")
    do.says(page, "No beams yet")
