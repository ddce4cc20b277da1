"""The page that a package index shows: README.md with addresses that work elsewhere.

An index shows the text alone, so a picture or page beside it needs the address of the repository at
the tag of this version. Its one place is `Source` of `[project.urls]` in pyproject.toml. While none
is named there, pictures are left out and links are plain text, as they would lead nowhere.
"""

import re
from pathlib import Path
from typing import Any

from hatchling.metadata.plugin.interface import MetadataHookInterface

PICTURE = re.compile(r'<p align="center"><img src="(?!https?:)([^"]+)"([^>]*)></p>\n*')
LINK = re.compile(r"\[([^\]]+)\]\((?!https?:|#)([^)]+)\)")


class Readme(MetadataHookInterface):
    """Sets `readme`."""

    PLUGIN_NAME = "custom"

    def update(self, metadata: dict[str, Any]) -> None:
        """Set the text; see the head of this file."""
        text = Path(self.root, "README.md").read_text("utf-8")
        source = metadata.get("urls", {}).get("Source")
        metadata["readme"] = {
            "content-type": "text/markdown",
            "text": page(text, source, f"v{metadata['version']}"),
        }


def page(text: str, source: str | None, tag: str) -> str:
    """Return the page of an index.

    Args:
        text: of README.md.
        source: address of the repository, or None while there is none.
        tag: of the version.
    """
    if source is None:
        return LINK.sub(r"\1", PICTURE.sub("", text))
    source = source.rstrip("/")
    text = PICTURE.sub(rf'<p align="center"><img src="{source}/raw/{tag}/\1"\2></p>\n\n', text)
    return LINK.sub(rf"[\1]({source}/blob/{tag}/\2)", text)
