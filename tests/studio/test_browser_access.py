"""What axe-core finds of barriers for people with disabilities: nothing, in every state."""

import pytest
from drawn import without_unit
from playwright.sync_api import expect

import gestures as do


def looks(**more):
    """Return the options of a page of each theme; nothing moves in it."""
    still = {"reduced_motion": "reduce"} | more
    return [still | {"color_scheme": theme} for theme in ("light", "dark")]


@pytest.mark.parametrize("page", looks(), indirect=True, ids=["light", "dark"])
def test_tabs(page, studio, axe):
    do.opened(page, studio.url)
    assert axe(page) == []
    do.click(page, (32, 65))
    assert axe(page) == []
    ratio = page.get_by_label("Ratio in percent")
    ratio.fill("5")
    ratio.press("Enter")
    expect(page.get_by_role("region", name="Errors")).to_be_visible()
    assert axe(page) == []
    do.button(page, "Undo: actuator of beam 11").click()
    do.simulated(page)
    goals = do.tab(page, "Goals")
    assert axe(page) == []
    goals.get_by_label("Point to add").select_option("Joint 0, centre")
    do.button(goals, "Add").click()
    goals.get_by_label("z of the target of Joint 0, centre").fill("10")
    page.keyboard.press("Enter")
    expect(goals.get_by_role("list", name="Suggestions")).to_be_visible()
    assert axe(page) == []
    do.tab(page, "Check")
    assert axe(page) == []
    printing = do.tab(page, "Print")
    expect(do.button(printing, "Download G-code")).to_be_enabled()
    assert axe(page) == []


@pytest.mark.parametrize("page", looks(), indirect=True, ids=["light", "dark"])
def test_dialogs_and_menus(page, studio, axe):
    do.opened(page, studio.url)
    do.button(page, "Library").click()
    expect(page.get_by_role("dialog", name="Library").locator("img")).to_have_count(10)
    assert axe(page) == []
    page.keyboard.press("Escape")
    do.choose(page, "File", "Export…")
    expect(page.get_by_role("dialog", name="Export")).to_be_visible()
    assert axe(page) == []
    page.keyboard.press("Escape")
    page.keyboard.press("?")
    expect(page.get_by_role("dialog", name="Keyboard help")).to_be_visible()
    assert axe(page) == []
    page.keyboard.press("Escape")
    do.button(page, "Settings").click()
    assert axe(page) == []
    page.keyboard.press("Escape")
    do.click(page, (32, 65), button="right")
    expect(page.get_by_role("menuitem", name="Delete")).to_be_visible()
    assert axe(page) == []


@pytest.mark.parametrize("page", looks(), indirect=True, ids=["light", "dark"])
def test_drawings(page, studio, axe, forgiven):
    forgiven.append("status of 422")
    do.opened(page, studio.url)
    do.open_file(page, "cell.svg", without_unit())
    size = page.get_by_role("dialog", name="How large is cell.svg?")
    size.get_by_role("radio", name="Another width").check()
    assert axe(page) == []
    do.button(size, "Open at this size").click()
    panel = page.locator(".drawing-panel")
    panel.get_by_role("switch", name="1 gap closed").click()
    expect(panel.get_by_text("Not done")).to_be_visible()
    do.button(panel, "Ends past 1 joint cut").click()
    assert axe(page) == []


SMALL = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}


@pytest.mark.parametrize("page", looks(**SMALL)[:1], indirect=True, ids=["light"])
def test_phone(page, studio, axe):
    page.goto(studio.url)
    do.simulated(page)
    assert axe(page) == []
    page.get_by_role("radio", name="Plan").click()
    expect(do.joints(page)).to_have_count(9)
    assert axe(page) == []
    do.tab(page, "Design")
    assert axe(page) == []
