"""Several answers in the search panel: listed, shown in the scene, and taken."""

import re

from playwright.sync_api import expect

import gestures as do

SLOW = 120_000  # ms; kernels may have to be compiled


def test_several_answers_are_listed_shown_and_taken(page, studio):
    do.opened(page, studio.url)
    goals = do.tab(page, "Goals")
    goals.get_by_label("Point to add").select_option("Joint 2, centre")
    do.button(goals, "Add").click()
    goals.get_by_label("z of the target of Joint 2, centre").fill("20")
    page.keyboard.press("Enter")
    do.simulated(page)
    for name, value in (("Time limit", "5"), ("Answers", "3")):
        field = goals.get_by_label(name, exact=True)
        field.fill(value)
        field.press("Enter")
    expect(goals.get_by_text("up to three times the time limit")).to_be_visible()
    do.button(goals, "Search").click()
    answers = goals.get_by_role("list", name="Answers that differ").get_by_role("button")
    expect(answers.first).to_be_visible(timeout=SLOW)
    assert 1 < answers.count() <= 3
    before = do.document(page)
    answers.nth(1).hover()
    expect(do.shape(page).get_by_text("Answer 2", exact=True)).to_be_visible()
    assert do.document(page) == before
    expect(answers.nth(1)).to_have_accessible_name(
        re.compile(r"^Take answer 2: .* mm, \d+ actuators of \d+ mm in all, printed in .* min$")
    )
    answers.nth(1).click()
    expect(page.get_by_text("The found design was taken.")).to_be_visible()
    assert do.document(page)["grid"] != before["grid"]
