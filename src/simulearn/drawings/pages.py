"""The page that plays a result: an HTML file of ours, which also holds the design."""

import re

SCHEMA = "simulearn.page/1"
CONTENTS = re.compile(rb'<script type="application/json" id="simulearn-result">([^<]*)</script>')
BEGIN = re.compile(rb"(?:\xef\xbb\xbf)?\s*<!doctype html", re.IGNORECASE)


def page_contents(data: bytes) -> str | None:
    """Return the JSON that a page of ours holds: grid, engine and what qualifies the answer.

    Args:
        data: contents of a file.

    Returns:
        The text, or None where the file is no such page.
    """
    found = CONTENTS.search(data) if BEGIN.match(data) else None
    return None if found is None else found[1].decode("utf-8", "replace")
