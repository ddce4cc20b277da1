"""Changing a grid in the plan: actuators, joints, errors that are mended by a button."""

import re

import pytest
from playwright.sync_api import expect

import gestures as do


@pytest.fixture
def twist(page, studio):
    """The page with the design that a new visitor sees: 2 by 2 cells of 65 mm around the origin."""
    return do.opened(page, studio.url)


def test_the_wheel_changes_the_selected_beam(twist):
    do.click(twist, (32, 65))
    expect(do.beam(twist, 11)).to_have_accessible_name(re.compile("100 % top, selected$"))
    twist.mouse.wheel(0, 100)
    expect(do.beam(twist, 11)).to_have_accessible_name(re.compile("75 % top, selected$"))


def test_a_box_selects_and_a_drag_moves_it_all(twist):
    do.drag(twist, (-90, -90), (10, 90))
    expect(twist.get_by_role("heading", name="6 joints, 7 beams")).to_be_visible()
    do.drag(twist, (-65, -65), (-75, -65))
    do.placed(do.joint(twist, 0), -75, -65)
    do.placed(do.joint(twist, 6), -75, 65)
    do.button(twist, "Undo: Move").click()
    do.placed(do.joint(twist, 6), -65, 65)


def test_a_joint_dropped_on_another_joins_it(twist):
    do.drag(twist, (65, 65), (1, 64))
    expect(do.joints(twist)).to_have_count(8)
    expect(do.beams(twist)).to_have_count(11)
    do.button(twist, "Undo: Move joint").click()
    expect(do.joints(twist)).to_have_count(9)


def test_escape_takes_a_drag_back(twist):
    twist.mouse.move(*do.at(twist, (65, 65)))
    twist.mouse.down()
    twist.mouse.move(*do.at(twist, (40, 40)), steps=4)
    do.placed(do.joint(twist, 8), 40, 40)
    twist.keyboard.press("Escape")
    do.placed(do.joint(twist, 8), 65, 65)
    twist.mouse.up()
    expect(do.button(twist, "Nothing to undo")).to_be_disabled()


def test_joints_too_close_are_merged(twist):
    do.click(twist, (65, 65))
    for _ in range(6):
        twist.keyboard.press("Shift+ArrowLeft")
    do.says(twist, re.compile(r"^\d+ errors?: not simulated$"))
    expect(do.shape(twist).get_by_text("last valid design")).to_be_visible()
    wrong = twist.get_by_role("region", name="Errors")
    do.button(wrong, "Merge joints 7 and 8").click()
    do.simulated(twist)
    expect(do.joints(twist)).to_have_count(8)


def test_beams_that_cross_get_a_joint(twist):
    do.click(twist, (65, -65))
    for axis, value in (("x", "40"), ("y", "30")):
        twist.get_by_label(f"{axis} of joint 2").fill(value)
        twist.keyboard.press("Enter")
    do.says(twist, re.compile(r"^\d+ errors?: not simulated$"))
    wrong = twist.get_by_role("region", name="Errors")
    do.button(wrong, re.compile("^Add a joint where beams")).click()
    do.simulated(twist)
    expect(do.joints(twist)).to_have_count(10)
    expect(do.beams(twist)).to_have_count(14)


def test_a_beam_is_split_and_another_joint_fixed(twist):
    do.use(twist, "Split")
    do.click(twist, (33, 65))
    do.placed(do.joint(twist, 9), 32.5, 65)
    do.use(twist, "Fix a joint")
    do.click(twist, (64, 64))
    expect(do.joint(twist, 8)).to_have_accessible_name(re.compile("^Joint 8, fixed, 65"))
    do.simulated(twist)


def test_lengths_and_angles_are_typed_while_drawing(twist):
    do.use(twist, "Draw")
    do.click(twist, (64, 66))
    twist.keyboard.type("50")
    twist.keyboard.press("Tab")
    twist.keyboard.type("30")
    twist.keyboard.press("Enter")
    twist.keyboard.press("Enter")
    do.placed(do.beam(twist, 12), 50)
    do.placed(do.joint(twist, 9), 108.3, 90)


def test_the_menu_of_a_part(twist):
    do.click(twist, (32, 65), button="right")
    twist.get_by_role("menuitem", name="Exchange top and bottom").click()
    expect(do.beam(twist, 11)).to_have_accessible_name(re.compile("100 % bottom"))


def test_numbers_are_typed_and_what_is_none_is_refused(twist):
    do.click(twist, (65, 65))
    x = twist.get_by_label("x of joint 8")
    x.fill("70.5")
    x.press("Enter")
    do.placed(do.joint(twist, 8), 70.5, 65)
    x.fill("seventy")
    x.press("Enter")
    expect(twist.get_by_role("alert")).to_have_text("Type a number.")
    do.placed(do.joint(twist, 8), 70.5, 65)
    x.press("Escape")
    expect(x).to_have_value("70.5")


def test_the_shape_and_the_list_select_too(twist):
    do.parts(twist).get_by_role("option", name=re.compile("^Beam 3,")).click()
    expect(twist.get_by_role("heading", name="Beam 3")).to_be_visible()
    do.button(twist, "From above").click()
    do.shape(twist).get_by_role("application").focus()
    do.parts(twist).get_by_role("option", name=re.compile("^Joint 2,")).click(modifiers=["Control"])
    expect(twist.get_by_role("heading", name="1 joint, 1 beam")).to_be_visible()


def test_shift_selects_more_and_keys_change_all(twist):
    do.click(twist, (32, 65))
    twist.keyboard.down("Shift")
    do.click(twist, (65, 32))
    twist.keyboard.up("Shift")
    expect(twist.get_by_role("heading", name="2 beams")).to_be_visible()
    twist.keyboard.press("-")
    for number in (9, 11):
        expect(do.beam(twist, number)).to_have_accessible_name(re.compile("75 % top"))
    do.button(twist, re.compile("^Undo: Change actuator")).click()
    expect(do.beam(twist, 9)).to_have_accessible_name(re.compile("100 % top"))


def test_a_grid_is_mirrored_turned_and_scaled(twist):
    def joints():
        return do.document(twist)["grid"]["joints"]

    before = joints()
    twist.keyboard.press("Escape")
    do.use(twist, "Mirror left and right")
    assert joints() == [[-x, y] for x, y in before]
    do.plan(twist).get_by_role("option").first.focus()
    twist.keyboard.press("m")
    assert joints() == before
    twist.keyboard.press("r")
    assert joints() == [[-y, x] for x, y in before]
    twist.keyboard.press("Control+z")
    factor = twist.get_by_label("Factor")
    factor.fill("80")
    factor.press("Enter")
    do.button(twist, "Scale").click()
    assert joints() == [[0.8 * x, 0.8 * y] for x, y in before]


def test_numbers_stand_at_the_pointer(twist):
    twist.mouse.move(*do.at(twist, (32, 65)))
    for words in ("Beam 11 · 100 % top", "65.0 mm", "Net 57.8 mm"):
        expect(twist.locator(".plan-readout").get_by_text(words, exact=False).first).to_be_visible()


def test_the_pointer_snaps_to_beams_and_touches_become_joints(twist):
    do.use(twist, "Draw")
    do.click(twist, (-64, 66))  # near a joint
    twist.mouse.move(*do.at(twist, (33, -63.5)), steps=5)
    readout = twist.locator(".plan-readout")
    expect(readout.get_by_text("on beam")).to_be_visible()
    twist.mouse.click(*do.at(twist, (33, -63.5)))
    twist.keyboard.press("Enter")
    expect(do.joints(twist)).to_have_count(12)  # on a side, and where two beams are crossed
    do.placed(do.joint(twist, 9), 32.5, -65)
    do.simulated(twist)


def test_many_short_actuators_are_mended_at_once(twist):
    twist.keyboard.press("Control+a")
    ratio = twist.get_by_label("Ratio in percent")
    ratio.fill("5")
    ratio.press("Enter")
    wrong = twist.get_by_role("region", name="Errors")
    expect(do.button(wrong, "Set beam 0 to 25 %")).to_be_visible()
    expect(do.button(wrong, "Set beam 1 to 25 %")).to_be_visible()
    do.button(wrong, "Mend all 12 actuators").click()
    do.simulated(twist)
    assert do.document(twist)["grid"]["actuators"] == [0.25] * 12
    do.button(twist, "Undo: Mend all 12 actuators").click()
    expect(wrong).to_be_visible()


def test_the_shape_is_coloured_by_what_it_is_like(twist):
    choice = do.shape(twist).get_by_label("Colour")
    for name, unit in (
        ("Stress (von Mises)", "MPa"),
        ("Stretch of beams' edges", "%"),
        ("Height", "mm"),
    ):
        choice.select_option(name)
        expect(
            do.shape(twist).locator(".shape-legend").get_by_text(unit, exact=True)
        ).to_be_visible()
