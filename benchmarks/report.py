"""What a benchmark measured, as a page of docs/measured that other pages quote."""

import os
import platform
from collections.abc import Sequence
from datetime import date
from pathlib import Path

FOLDER = Path(__file__).parent.parent / "docs" / "measured"


class Report:
    """A short Markdown page: sentences and tables, printed and saved."""

    def __init__(self, name: str, title: str) -> None:
        self.path = FOLDER / f"{name}.md"
        self.lines = [
            f"# {title}",
            "",
            f"Made by `python benchmarks/{name}.py`, {date.today()}, "
            f"{os.cpu_count()} cores ({processor()}).",
            "",
        ]

    def say(self, text: str) -> None:
        """Add a paragraph."""
        self.lines += [text, ""]

    def table(self, head: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
        """Add a table."""
        for row in (head, ["---"] * len(head), *rows):
            self.lines.append("| " + " | ".join(map(str, row)) + " |")
        self.lines.append("")

    def save(self) -> None:
        """Print the page and write it."""
        text = "\n".join(self.lines)
        print(text)
        FOLDER.mkdir(parents=True, exist_ok=True)
        self.path.write_text(text, encoding="utf-8")


def processor() -> str:
    """Return the name of this machine's processor."""
    try:
        info = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.split(":")[1].strip() for line in info.splitlines() if "model name" in line]
    return names[0] if names else platform.machine()
