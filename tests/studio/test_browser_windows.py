"""Several windows: designs of their own, and one design that is changed in two of them."""

import re

import pytest
from playwright.sync_api import expect

import gestures as do


def name(page):
    """Return the field with the design's name."""
    return page.get_by_label("Name of the design")


def named(page, text):
    """Rename the design and wait until it is saved."""
    name(page).fill(text)
    expect(page).to_have_url(re.compile("/d/"))
    do.saved(page)


def test_two_windows_have_designs_of_their_own(page, studio):
    other = page.context.new_page()
    for window, text in ((page, "One"), (other, "Two")):
        do.opened(window, studio.url)
        named(window, text)
    assert page.url != other.url
    do.click(page, (32, 65))
    page.keyboard.press("-")
    expect(do.beam(page, 11)).to_have_accessible_name(re.compile("75 % top"))
    expect(do.beam(other, 11)).to_have_accessible_name(re.compile("100 % top"))
    do.saved(page)
    other.reload()
    expect(name(other)).to_have_value("Two")
    expect(do.beam(other, 11)).to_have_accessible_name(re.compile("100 % top"))


@pytest.mark.parametrize("choice", ["Keep mine as a copy", "Take the other"])
def test_a_design_that_was_changed_in_another_window(page, studio, forgiven, choice):
    forgiven.append("status of 409")
    do.opened(page, studio.url)
    named(page, "First")
    other = do.opened(page.context.new_page(), page.url)
    named(page, "Second")
    name(other).fill("Third")
    dialog = other.get_by_role("dialog", name="The design was changed elsewhere")
    expect(dialog).to_be_visible()
    do.button(dialog, choice).click()
    expect(other.get_by_text("Saved", exact=True).first).to_be_visible()
    if choice == "Take the other":
        expect(name(other)).to_have_value("Second")
        do.button(other, re.compile("^Undo: ")).click()
        expect(name(other)).to_have_value("Third")
        do.saved(other)
    else:
        expect(name(other)).to_have_value("Third")
        expect(other).not_to_have_url(page.url)
        page.reload()
        expect(name(page)).to_have_value("Second")
