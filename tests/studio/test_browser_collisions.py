"""Collisions in the studio: words that name the parts, and rings where they meet."""

import json
import re
from pathlib import Path

from playwright.sync_api import expect

import gestures as do

GRID = json.loads((Path(__file__).parent.parent / "data" / "collides.json").read_text())


def test_collisions_are_named_and_marked(page, studio):
    do.opened(page, studio.url)
    rings = do.shape(page).locator(".note-collision")
    expect(rings).to_have_count(0)
    do.open_file(page, "collides.json", GRID)
    do.simulated(page)
    words = do.shape(page).locator(".shape-note")
    expect(words.first).to_have_text(
        re.compile(r"^Beam 4 and joint 6 run through each other \(after creep, 2\.\d mm deep\)$")
    )
    expect(rings).to_have_count(2)
    expect(rings.first).to_be_visible()
    page.get_by_role("slider", name="From flat to morphed").fill("4")  # before they meet
    expect(rings).to_have_count(0)
