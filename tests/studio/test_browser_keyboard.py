"""The page without a mouse."""

import re

from playwright.sync_api import expect

import gestures as do


def test_a_grid_is_changed(page, studio):
    do.opened(page, studio.url)
    do.tab_to(page, "Joint 0")
    page.keyboard.press("Control+ArrowRight")
    expect(do.beam(page, 0)).to_be_focused()
    page.keyboard.press("Enter")
    page.keyboard.press("-")
    page.keyboard.press("-")
    expect(do.beam(page, 0)).to_have_accessible_name(re.compile("^Beam 0, .* 50 % top, selected$"))
    page.keyboard.press("Escape")
    page.keyboard.press("Escape")
    page.keyboard.press("Control+ArrowLeft")
    expect(do.joint(page, 0)).to_be_focused()
    page.keyboard.press("Space")
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("Shift+ArrowDown")
    do.placed(do.joint(page, 0), -66, -75)
    do.simulated(page)
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    do.placed(do.joint(page, 0), -65, -65)
    expect(do.beam(page, 0)).to_have_accessible_name(re.compile("actuator 100 % top$"))
    page.keyboard.press("Control+Shift+z")
    page.keyboard.press("Control+Shift+z")
    do.placed(do.joint(page, 0), -66, -75)


def test_a_beam_is_drawn(page, studio):
    do.opened(page, studio.url)
    do.tab_to(page, "Joint 0")
    page.keyboard.press("d")
    page.keyboard.press("Enter")  # begins at the joint
    page.keyboard.type("40")
    page.keyboard.press("Tab")
    page.keyboard.type("180")
    page.keyboard.press("Enter")
    page.keyboard.press("Enter")
    do.placed(do.joint(page, 9), -105, -65)
    do.placed(do.beam(page, 12), 40)


def test_tabs_lists_menus_and_help(page, studio):
    do.opened(page, studio.url)
    do.tab_to(page, "File")
    page.keyboard.press("Enter")
    expect(page.get_by_role("menuitem", name="New")).to_be_focused()
    page.keyboard.press("ArrowDown")
    expect(page.get_by_role("menuitem", name="Open…")).to_be_focused()
    page.keyboard.press("Escape")
    assert do.focused(page).startswith("File")
    do.tab_to(page, "Design")
    page.keyboard.press("ArrowRight")
    expect(page.get_by_role("tabpanel", name="Goals")).to_be_visible()
    page.keyboard.press("ArrowLeft")
    do.tab_to(page, "Joint 0")
    assert page.evaluate("() => document.activeElement.closest('.parts') !== null")
    page.keyboard.press("End")
    page.keyboard.press("Space")
    expect(page.get_by_role("heading", name="Beam 11")).to_be_visible()
    page.keyboard.press("-")
    last = do.parts(page).get_by_role("option", name=re.compile("^Beam 11, .* 75 % top$"))
    expect(last).to_be_focused()
    page.keyboard.press("?")
    help = page.get_by_role("dialog", name="Keyboard help")
    expect(help).to_be_visible()
    page.keyboard.press("Escape")
    expect(help).to_be_hidden()
    expect(last).to_be_focused()


def test_the_shape_is_turned_and_played(page, studio):
    do.opened(page, studio.url)
    do.tab_to(page, "Shape in space")
    page.keyboard.press("7")
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("Space")
    expect(do.button(page, "Pause")).to_be_visible()
    page.keyboard.press("Space")
    expect(do.button(page, "Play")).to_be_visible()
    do.tab_to(page, "From flat to morphed")
    page.keyboard.press("Home")
    expect(do.shape(page).get_by_text("flat", exact=True)).to_be_visible()
    page.keyboard.press("ArrowRight")
    expect(do.shape(page).get_by_text("10 % released", exact=True)).to_be_visible()
