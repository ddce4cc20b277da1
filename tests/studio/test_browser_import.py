"""Drawings of other programs on the page: dropped, asked about, mended, told, taken back."""

import re

import pytest
from drawn import svg, without_unit
from playwright.sync_api import expect

import gestures as do

RING = b"""
<svg xmlns="http://www.w3.org/2000/svg" width="120mm" height="120mm" viewBox="0 0 120 120">
  <circle cx="60" cy="60" r="55" fill="none" stroke="#000"/>
</svg>
"""
DROP = """
([name, text]) => {
  const dataTransfer = new DataTransfer();
  dataTransfer.items.add(new File([text], name));
  const page = document.querySelector(".page");
  for (const kind of ["dragover", "drop"])
    page.dispatchEvent(new DragEvent(kind, { bubbles: true, cancelable: true, dataTransfer }));
}
"""


def drop(page, name, data):
    page.evaluate(DROP, [name, data.decode()])


def panel(page):
    return page.locator(".drawing-panel")


def row(page, text):
    return panel(page).get_by_role("listitem").filter(has_text=text)


def places(page):
    return page.locator(".plan-places circle")


def test_a_dropped_drawing_is_one_step_and_so_are_its_mends(page, studio):
    do.opened(page, studio.url)
    drop(page, "cell.svg", svg())
    expect(page.get_by_label("Name of the design")).to_have_value("cell")
    expect(do.joints(page)).to_have_count(4)
    expect(panel(page)).to_contain_text("SVG")
    expect(panel(page)).to_contain_text("60 × 60 mm")
    expect(do.beam(page, 0).or_(do.beam(page, 1)).first).to_be_visible()
    do.simulated(page)
    row(page, "1 dangling beam removed").get_by_role("switch").click()
    expect(do.joints(page)).to_have_count(5)
    row(page, "1 gap closed").get_by_role("switch").click()
    expect(row(page, "1 gap closed")).to_contain_text("Not done")
    expect(do.joints(page)).to_have_count(6)
    row(page, "1 gap closed").get_by_role("switch").click()
    expect(do.joints(page)).to_have_count(5)
    do.button(page, "Undo: read cell.svg in another way").click()
    expect(do.joints(page)).to_have_count(4)
    expect(row(page, "1 dangling beam removed").get_by_role("switch")).to_be_checked()
    do.button(page, "Undo: open cell.svg").click()
    expect(do.joints(page)).to_have_count(9)
    expect(panel(page)).to_be_hidden()


def test_the_size_is_requested(page, studio, forgiven):
    forgiven.append("status of 422")
    do.opened(page, studio.url)
    do.open_file(page, "odd.svg", without_unit())
    dialog = page.get_by_role("dialog", name="How large is odd.svg?")
    expect(dialog.get_by_role("radio", name="Millimetres 60 × 100 mm likely")).to_be_focused()
    expect(dialog.get_by_role("radio", name="Inches")).to_have_accessible_name(
        re.compile("1524 × 2540 mm")
    )
    page.keyboard.press("Escape")
    expect(do.joints(page)).to_have_count(9)
    do.open_file(page, "odd.svg", without_unit())
    dialog.get_by_role("radio", name="Another width").check()
    dialog.get_by_label("Width", exact=True).fill("120")
    do.button(dialog, "Open at this size").click()
    expect(panel(page)).to_contain_text("120 × 120 mm")
    do.button(panel(page), "Change…").click()
    dialog.get_by_role("radio", name="Millimetres").check()
    do.button(dialog, "Open at this size").click()
    expect(panel(page)).to_contain_text("60 × 60 mm")


def test_a_mend_shows_its_places(page, studio):
    do.opened(page, studio.url)
    drop(page, "cell.svg", svg())
    ends = row(page, "Ends past 1 joint cut").get_by_role("button")
    ends.focus()
    expect(places(page)).to_have_count(1)
    page.keyboard.press("Enter")
    expect(row(page, "Ends past 1 joint cut")).to_contain_text("Place 1 of 1")
    expect(page.locator(".plan-places .current")).to_be_visible()
    box, view = places(page).bounding_box(), do.plan(page).bounding_box()
    assert box["x"] + box["width"] / 2 == pytest.approx(view["x"] + view["width"] / 2, abs=2)
    page.keyboard.press("Tab")
    expect(places(page)).to_have_count(0)


def test_layers_and_curves_are_chosen_and_the_panel_comes_back(page, studio):
    do.opened(page, studio.url)
    drop(page, "cell.svg", svg())
    expect(do.beams(page)).to_have_count(5)
    panel(page).get_by_role("checkbox", name=re.compile("^top 0.5 50 % top · 1 line")).uncheck()
    expect(do.beams(page)).to_have_count(4)
    expect(panel(page).get_by_role("checkbox", name=re.compile("^frame"))).to_be_disabled()
    expect(panel(page)).to_contain_text("text")
    do.button(panel(page), "Done").click()
    expect(panel(page)).to_be_hidden()
    again = do.button(page, "Drawing: cell.svg")
    expect(again).to_be_focused()
    do.click(page, (30, 0))
    page.keyboard.press("+")
    expect(again).to_be_hidden()
    page.keyboard.press("Control+z")
    again.click()
    expect(panel(page)).to_be_visible()


def test_what_no_drawing_is_says_so(page, studio, forgiven):
    forgiven.append("status of 422")
    do.opened(page, studio.url)
    drop(page, "part.stp", b"ISO-10303-21;\nHEADER;\n")
    dialog = page.get_by_role("dialog", name="part.stp cannot be opened")
    expect(dialog).to_contain_text("STEP")
    do.button(dialog, "Close").last.click()
    drop(page, "ring.svg", RING)
    dialog = page.get_by_role("dialog", name="ring.svg has only curves")
    dialog.get_by_label("At most off by").fill("5")
    do.button(dialog, "Make straight pieces of curves").click()
    expect(panel(page)).to_contain_text("110")
    assert do.joints(page).count() > 4


PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}


@pytest.mark.parametrize("page", [PHONE | {"locale": "de-DE"}], indirect=True, ids=["phone"])
def test_a_drawing_on_a_phone_in_german(page, studio, forgiven):
    forgiven.append("status of 422")
    page.goto(studio.url)
    expect(page.locator(".status-main.valid")).to_be_visible()
    drop(page, "cell.svg", without_unit())
    dialog = page.get_by_role("dialog", name="Wie groß ist cell.svg?")
    do.button(dialog, "In dieser Größe öffnen").click()
    expect(panel(page)).to_contain_text("1 Lücke geschlossen")
    expect(do.plan(page)).to_be_visible()
    assert not do.scrolls_sideways(page)
