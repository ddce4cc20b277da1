"""One visit to the studio from the first look to a printable file, as a person would make it."""

import io
import re

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

import browsing
import gestures as do

SQUARE = [(-65, -65), (65, -65), (65, 65), (-65, 65), (-65, -65)]


@pytest.fixture
def own_studio(tmp_path):
    """A studio that a test may stop and start again, with its documents."""
    one = browsing.start(tmp_path)
    yield one
    one.stop()


def off(points, by=(1.2, -0.9)):
    """Return where a hand clicks that means these points: a little beside them."""
    return [(x + by[0], y + by[1]) for x, y in points]


def orange(locator):
    """Return the part of a picture that has the colour of actuators in the upper half."""
    picture = Image.open(io.BytesIO(locator.screenshot())).convert("RGB")
    r, g, b = np.moveaxis(np.asarray(picture, float), 2, 0)
    return np.mean((r > 150) & (g < 0.7 * r) & (b < 0.45 * r))


def test_a_visit(page, own_studio, forgiven, tmp_path):
    studio = own_studio

    # A new visitor sees a grid that has morphed, and how it got there.
    do.opened(page, studio.url)
    expect(do.joints(page)).to_have_count(9)
    moment = page.get_by_role("slider", name="From flat to morphed")
    expect(moment).to_have_attribute("aria-valuetext", "after creep")
    view = page.get_by_role("application", name="Shape in space")
    expect(view.locator("canvas")).to_be_visible()
    assert orange(view) > 0.002

    # A grid from nothing: a square, a beam that ends on two of its sides, and one that crosses it.
    do.choose(page, "File", "New")
    expect(page.get_by_text("Draw the first beam")).to_be_visible()
    do.says(page, "No beams yet")
    do.draw(page, *off(SQUARE))
    expect(do.beams(page)).to_have_count(4)
    do.draw(page, *off([(0, 65), (0, -65)]))
    expect(do.beams(page)).to_have_count(7)
    do.draw(page, *off([(-65, 0), (65, 0)]))
    expect(do.beams(page)).to_have_count(12)
    page.keyboard.press("v")
    design = page.get_by_role("region", name="Properties")
    expect(do.fact(design, "Joints")).to_have_text("9")
    expect(do.fact(design, "Size")).to_have_text("130 × 130 mm")
    do.simulated(page)
    page.get_by_label("Name of the design").fill("My first grid")

    # An actuator that is too short to be printed, and the button that mends it.
    do.click(page, (32, 65))
    ratio = page.get_by_label("Ratio in percent")
    ratio.fill("5")
    ratio.press("Enter")
    do.says(page, "1 error: not simulated")
    wrong = page.get_by_role("region", name="Errors")
    expect(wrong).to_contain_text("actuator")
    wrong.get_by_role("button", name=re.compile(r"^Set beam \d+ to 25 %$")).click()
    do.simulated(page)
    expect(wrong).to_be_hidden()
    for _ in range(3):
        page.get_by_role("group", name="Actuator: Beam").get_by_role(
            "button", name="A quarter more to the top"
        ).click()
    expect(design.get_by_text("The ends lift.")).to_be_visible()
    expect(ratio).to_have_value("100")
    page.keyboard.press("Escape")
    for point in ((-32, -65), (65, 32), (-65, -32)):
        do.click(page, point)
        page.keyboard.press("4")
    do.simulated(page)

    # From flat to morphed by hand, then by playing.
    moment.fill("4")
    expect(page.get_by_text("40 % released", exact=True)).to_be_visible()
    moment.press("Home")
    expect(moment).to_have_attribute("aria-valuetext", "flat")
    do.button(page, "Play").click()
    expect(moment).not_to_have_attribute("aria-valuetext", "flat")
    do.button(page, "Pause").click()
    moment.press("End")

    # Where points of the shape should be, and a change that brings them there.
    goals = do.tab(page, "Goals")
    do.button(goals, "Pick in the shape").click()
    page.get_by_role("button", name="Centre of joint 2", exact=True).click()
    goals.get_by_label("z of the target of Joint 2, centre").fill("20")
    page.keyboard.press("Enter")
    goals.get_by_label("Point to add").select_option("Joint 1, centre")
    do.button(goals, "Add").click()
    goals.get_by_label("z of the target of Joint 1, centre").fill("20")
    page.keyboard.press("Enter")
    before = do.document(page)
    assert [goal["vertex"] for goal in before["goals"]] == [
        ["joint", 2, "centre"],
        ["joint", 1, "centre"],
    ]
    closer = goals.get_by_role("button", name=re.compile("mm closer$")).first
    distance = goals.get_by_text("mean distance to the targets").locator("..")
    far = distance.inner_text()
    closer.click()
    expect(page.get_by_text("Taken: ").first).to_be_visible()
    do.simulated(page)
    expect(distance).not_to_have_text(far)
    assert do.document(page)["grid"] != before["grid"]
    do.button(page, re.compile("^Undo: suggestion")).click()
    assert do.document(page) == before
    do.simulated(page)

    # Finite elements beside the model.
    check = do.tab(page, "Check")
    do.button(check, "Check with finite elements").click()
    apart = check.get_by_text("mean distance between model and finite elements").locator("..")
    expect(apart).to_have_text(re.compile(r"^[\d.]+ mm"), timeout=60_000)
    for name in ("Time, model", "Time, finite elements"):
        expect(do.fact(check, name)).to_have_text(re.compile(r"\d ?(ms|s)$"))

    # The file for the printer.
    printing = do.tab(page, "Print")
    expect(do.fact(printing, "Layers")).to_have_text("16")
    with page.expect_download() as waiting:
        do.button(printing, "Download G-code").click()
    assert waiting.value.suggested_filename == "my-first-grid.gcode"
    lines = do.downloaded(waiting.value).splitlines()
    assert sum(line.startswith("G1") for line in lines) > 1000
    assert any(line.startswith("M104") or line.startswith("M109") for line in lines)

    # The server goes away while a dialog is open, and comes back: nothing is lost.
    do.saved(page)
    forgiven += ["ERR_CONNECTION_REFUSED", "ERR_CONNECTION_RESET", "ERR_EMPTY_RESPONSE"]
    do.choose(page, "File", "Export…")
    dialog = page.get_by_role("dialog", name="Export")
    dialog.get_by_role("radio", name=re.compile("^STL")).check()
    studio.stop()
    with browsing.running(tmp_path, int(studio.url.rpartition(":")[2])):
        expect(dialog.get_by_role("radio", name=re.compile("^STL"))).to_be_checked()
        with page.expect_download() as waiting:
            do.button(dialog, "Save .stl").click()
        assert waiting.value.suggested_filename == "My-first-grid.stl"
        expect(dialog).to_be_hidden()
        assert do.document(page) == before
        page.get_by_label("Name of the design").fill("My second grid")
        do.saved(page)

        # Another day: the design is there, and so is every step before; the check is not.
        forgiven.append("status of 404")
        page.reload()
        do.simulated(page)
        expect(page.get_by_label("Name of the design")).to_have_value("My second grid")
        assert do.document(page) == before | {"name": "My second grid"}
        for _ in range(20):
            page.keyboard.press("Control+z")
        do.says(page, "No beams yet")
        expect(do.button(page, "Nothing to undo")).to_be_disabled()
