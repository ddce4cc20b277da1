"""The tab Print: what is known of a printer, a profile of one's own, layers and the file."""

import io
import re
from zipfile import ZipFile

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

import gestures as do

OWN = b"""
base = "voron"
name = "mine"
title = "My printer"
tried = ""
sources = ["its manual, https://example.org/manual"]
[bed]
shape = "round"
width = 260.0
depth = 260.0
origin = "centre"
excluded = [[[-130.0, -130.0], [-90.0, -90.0]]]
"""


def open_profile(panel, content, name="mine.toml"):
    """Open a profile with the panel's button."""
    with panel.page.expect_file_chooser() as choosing:
        do.button(panel, "Open a profile…").click()
    file = {"name": name, "mimeType": "application/toml", "buffer": content}
    choosing.value.set_files(file)


@pytest.fixture
def printing(page, studio):
    """The tab with a print that is laid out."""
    do.opened(page, studio.url)
    panel = do.tab(page, "Print")
    expect(do.button(panel, "Download G-code")).to_be_enabled()
    return panel


def test_a_printer_that_nobody_has_tried_says_so_and_what_to_do_first(printing):
    printing.get_by_label("Printer", exact=True).select_option("prusa-mk4")
    expect(printing.get_by_text("Bed 250 × 210 mm, nozzle")).to_be_visible()
    expect(printing.get_by_text("Nobody has run this profile on the machine yet.")).to_have_count(1)
    expect(printing.get_by_text("Look at the file in your slicer's viewer.")).to_be_visible()
    do.button(printing.page, re.compile("^Undo: printer: .*MK4")).click()
    expect(printing.get_by_label("Printer", exact=True)).to_have_value("ender-3")


def test_a_profile_of_ones_own_is_used_saved_and_shared(printing, page, visit, studio):
    open_profile(printing, OWN)
    chosen = printing.get_by_label("Printer", exact=True)
    expect(chosen.locator("option:checked")).to_have_text("My printer (own profile)")
    expect(printing.get_by_text("Round bed 260 mm, nozzle 0.4 mm, ")).to_be_visible()
    expect(printing.get_by_text("One zone of the bed stays empty.")).to_be_visible()
    printing.get_by_text("What the profile follows (1)").click()
    link = printing.get_by_role("link", name="https://example.org/manual")
    expect(link).to_have_attribute("rel", "noopener noreferrer")
    with page.expect_download() as waiting:
        do.button(printing, "Download G-code").click()
    assert "mine" in do.downloaded(waiting.value)
    with page.expect_download() as waiting:
        do.button(printing, "Save profile").click()
    assert waiting.value.suggested_filename == "mine.toml"
    assert do.downloaded(waiting.value).encode() == OWN

    mine = do.document(page)
    assert mine["printer"] == {"profile": OWN.decode()}
    do.saved(page)
    page.reload()
    printing = do.tab(page, "Print")
    expect(printing.get_by_text("Round bed 260 mm")).to_be_visible()
    other = do.opened(visit(), studio.url)  # somebody else, who is sent the file
    do.open_file(other, "design.json", mine)
    expect(do.tab(other, "Print").get_by_text("Round bed 260 mm")).to_be_visible()
    do.button(page, "Undo: printer: My printer").click()
    expect(printing.get_by_label("Printer", exact=True)).to_have_value("ender-3")


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b'base = "voron"\n[bed]\nwidth = "wide"\n', "bed.width: is 'wide'"),
        (b"name = \n", "line 1"),
        (b'base = "/etc/passwd.toml"\n', "base: is"),
        (b"#" * 300_000, "65536 characters"),
    ],
)
def test_a_profile_that_is_none_says_where(printing, page, forgiven, content, words):
    forgiven.append("status of 422")
    open_profile(printing, content)
    dialog = page.get_by_role("dialog", name="mine.toml cannot be opened")
    expect(dialog).to_contain_text(words)
    do.button(dialog, "Close").last.click()
    expect(printing.get_by_label("Printer", exact=True)).to_have_value("ender-3")
    expect(do.button(page, "Nothing to undo")).to_be_disabled()


def test_a_profile_in_a_file_that_is_none_says_so_in_the_panel(printing, page, forgiven):
    forgiven.append("status of 422")
    bad = do.document(page) | {"printer": {"profile": "bed = 3"}}
    do.open_file(page, "bad.json", bad)
    expect(printing.get_by_text("The profile cannot be used.")).to_be_visible()
    expect(printing.get_by_text("This cannot be printed.")).to_be_visible()
    printing.get_by_label("Printer", exact=True).select_option("voron")
    expect(do.button(printing, "Download G-code")).to_be_enabled()


def test_a_profile_to_begin_from_is_saved(printing, page):
    with page.expect_download() as waiting:
        do.button(printing, "Save profile").click()
    assert waiting.value.suggested_filename == "ender-3.toml"
    text = do.downloaded(waiting.value)
    open_profile(printing, re.sub(r"(?m)^title = .*$", 'title = "Mine"', text).encode())
    chosen = printing.get_by_label("Printer", exact=True).locator("option:checked")
    expect(chosen).to_have_text("Mine (own profile)")


def red(locator):
    """Return the columns of a picture, from 0 to 1, that have the colour of empty zones."""
    picture = Image.open(io.BytesIO(locator.screenshot())).convert("RGB")
    r, g, b = np.moveaxis(np.asarray(picture, float), 2, 0)
    columns = np.flatnonzero(((r - g > 40) & (abs(g - b) < 30)).sum(axis=0) > 5)
    places = columns / picture.width
    return places[places < 0.9]  # beyond is the mark of the axes


def test_a_bed_that_lies_elsewhere_comes_into_view(printing, page):
    view = page.get_by_role("application", name="Shape in space").locator("canvas")
    assert len(red(view)) == 0
    both = OWN.replace(b"[-90.0, -90.0]]]", b"[-90.0, -90.0]], [[90.0, 90.0], [130.0, 130.0]]]")
    open_profile(printing, both)
    expect(printing.get_by_text("2 zones of the bed stay empty.")).to_be_visible()
    expect(do.button(printing, "Download G-code")).to_be_enabled()
    do.button(page.locator(".notice"), "Close").click()
    expect(page.locator(".notice")).to_be_hidden()
    page.wait_for_timeout(1000)  # until the view has come to rest
    columns = red(view)
    assert columns.min() < 0.35  # the zone at the left
    assert columns.max() > 0.6  # and that at the right


def test_layers_and_roles(printing):
    layer = printing.get_by_role("slider", name="Layer")
    layer.fill("1")
    expect(layer).to_have_attribute("aria-valuetext", re.compile("^1 of 16"))
    roles = printing.get_by_role("listitem").filter(has_text="Skirt")
    expect(roles).to_contain_text(re.compile(r"Skirt[\d.,]+ m"))
    printing.get_by_role("switch", name="Show travels").check()
    layer.press("ArrowRight")
    expect(roles).to_contain_text("–")
    expect(printing.get_by_text("with filament drawn back: out of the part")).to_be_visible()
    expect(printing.get_by_text("Cut the brim off before the bath")).to_be_visible()
    expect(printing.get_by_role("listitem").filter(has_text="Brim")).to_be_visible()


def test_a_printer_that_takes_packages_has_a_button_for_them(printing, page):
    printing.get_by_label("Printer", exact=True).select_option("bambu-x1")
    with page.expect_download() as waiting:
        do.button(printing, "Download .gcode.3mf").click()
    assert waiting.value.suggested_filename == "twist.gcode.3mf"
    with ZipFile(waiting.value.path()) as package:
        assert "Metadata/plate_1.gcode" in package.namelist()
    expect(do.button(printing, "Download G-code")).to_be_enabled()
