"""Suggestions, searches and checks: shown, stopped, taken, and found again after a reload."""

import re

import pytest
from playwright.sync_api import expect

import gestures as do

SLOW = 60_000  # ms; kernels may have to be compiled


@pytest.fixture
def aimed(page, studio):
    """The tab Goals of a twist with a corner that should be 20 mm higher than the fixed joint."""
    do.opened(page, studio.url)
    goals = do.tab(page, "Goals")
    goals.get_by_label("Point to add").select_option("Joint 2, centre")
    do.button(goals, "Add").click()
    goals.get_by_label("z of the target of Joint 2, centre").fill("20")
    page.keyboard.press("Enter")
    expect(goals.get_by_role("list", name="Suggestions")).to_be_visible(timeout=SLOW)
    return goals


def search(goals, seconds=20):
    """Begin a search for what cannot be reached, and wait for its first steps."""
    goals.get_by_label("z of the target of Joint 2, centre").fill("90")
    goals.page.keyboard.press("Enter")
    do.simulated(goals.page)
    limit = goals.get_by_label("Time limit")
    limit.fill(str(seconds))
    limit.press("Enter")
    do.button(goals, "Search").click()
    expect(goals.get_by_text("best so far, mean distance")).to_be_visible(timeout=SLOW)


def test_a_suggestion_is_shown_under_the_pointer_only(aimed, page):
    cards = aimed.get_by_role("list", name="Suggestions").get_by_role("button")
    expect(cards).to_have_count(5)
    expect(cards.first.locator("img")).to_be_visible()
    before = do.document(page)
    cards.first.hover()
    label = (
        do.shape(page)
        .locator(".shape-label, .shape-preview")
        .or_(do.shape(page).get_by_text(re.compile("^(Move joint|Actuator)")))
    )
    expect(label.first).to_be_visible()
    aimed.get_by_role("heading", name="Suggestions").hover()
    expect(label.first).to_be_hidden()
    assert do.document(page) == before


def test_a_search_tells_its_error_is_stopped_and_stepped_through(aimed, page):
    search(aimed, 300)
    before = do.document(page)
    expect(aimed.get_by_text("designs tried")).to_be_visible()
    # After so many designs there are steps to go through, however busy the machine is.
    many = re.compile(r"\d{3}\s*designs tried")
    expect(aimed.locator(".search-facts")).to_contain_text(many, timeout=SLOW)
    do.button(aimed, "Stop, keep the best").click()
    found = aimed.get_by_role("group", name="Found")
    expect(found).to_be_visible(timeout=SLOW)
    step = found.get_by_role("slider", name="Steps")
    last = step.get_attribute("aria-valuetext")
    do.button(found, "Step back").click()
    expect(step).not_to_have_attribute("aria-valuetext", last)
    expect(do.shape(page).get_by_text(re.compile(r"^Step \d+ of \d+$"))).to_be_visible()
    assert do.document(page) == before
    expect(do.button(found, "Take this step")).to_be_enabled()
    do.button(found, "Step on").click()
    expect(step).to_have_attribute("aria-valuetext", last)
    do.button(found, "Take it").click()
    do.simulated(page)
    assert do.document(page)["grid"] != before["grid"]
    do.button(page, re.compile("^Undo: search")).click()
    assert do.document(page) == before


def test_a_search_goes_on_through_a_reload(aimed, page):
    search(aimed, 25)
    do.saved(page)
    page.reload()
    goals = do.tab(page, "Goals")
    expect(goals.get_by_text("best so far, mean distance")).to_be_visible(timeout=SLOW)
    expect(goals.get_by_text("belongs to the earlier one")).to_be_hidden()
    do.button(goals, "Stop, keep the best").click()
    found = goals.get_by_role("group", name="Found")
    expect(found).to_be_visible(timeout=SLOW)
    page.reload()  # what was found is there until it is taken or discarded
    goals = do.tab(page, "Goals")
    expect(found).to_be_visible(timeout=SLOW)
    do.button(found, "Take it").click()
    do.simulated(page)
    page.reload()
    do.tab(page, "Goals")
    expect(do.button(page, re.compile("^Undo: search"))).to_be_enabled()
    expect(found).to_be_hidden()


def test_a_check_goes_on_through_a_reload(page, studio):
    do.opened(page, studio.url)
    check = do.tab(page, "Check")
    do.button(check, "Check with finite elements").click()
    apart = check.get_by_text("mean distance between model and finite elements")
    # The server has taken it; on a fast machine it is done already.
    expect(check.get_by_text(re.compile(r"^\d+ of \d+ frames$")).or_(apart)).to_be_visible()
    page.reload()
    do.simulated(page)
    check = do.tab(page, "Check")
    expect(apart).to_be_visible(timeout=SLOW)
    expect(check.get_by_role("switch", name="Colour by deviation")).to_be_enabled()


def test_a_check_is_cancelled_and_belongs_to_its_design(page, studio):
    do.opened(page, studio.url)
    check = do.tab(page, "Check")
    do.button(check, "Check with finite elements").click()
    do.button(check, "Cancel").click()
    expect(do.button(check, "Check with finite elements")).to_be_enabled()
    do.button(check, "Check with finite elements").click()
    expect(do.fact(check, "Time, finite elements")).to_be_visible(timeout=SLOW)
    do.click(page, (32, 65))
    page.keyboard.press("-")
    expect(check.get_by_text("This check belongs to the earlier one.")).to_be_visible()
    expect(check.get_by_role("switch", name="Show both shapes")).to_be_hidden()


def test_a_job_of_another_design_is_left_alone(aimed, page, studio):
    search(aimed, 20)
    page.goto(studio.url)
    do.simulated(page)
    goals = do.tab(page, "Goals")
    expect(goals.get_by_text("best so far, mean distance")).to_be_hidden()
    expect(goals.get_by_role("group", name="Found")).to_be_hidden()
