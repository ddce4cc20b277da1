"""Make the notebooks of the numbered examples from their scripts: python benchmarks/notebooks.py.

A script has a cell behind each line `# %%`; behind `# %% [markdown]` the comment is the text.
"""

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent.parent / "examples"
CELL, TEXT = "# %%", "# %% [markdown]"


def scripts() -> list[Path]:
    """Return the numbered examples, in their order."""
    return sorted(FOLDER.glob("[0-9]_*.py"))


def notebook(text: str) -> str:
    """Return the notebook of a script, without outputs, as the text of its file."""
    cells = [_cell(number, lines) for number, lines in enumerate(_parts(text))]
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    data = {
        "cells": cells,
        "metadata": {"kernelspec": kernel, "language_info": {"name": "python"}},
        "nbformat": 4,
        "nbformat_minor": 5,
    }
    return json.dumps(data, indent=1, ensure_ascii=False) + "\n"


def _parts(text: str) -> Iterator[list[str]]:
    """Yield the lines of each cell, the first being the one that begins it."""
    lines: list[str] = []
    for line in text.splitlines():
        if line in (CELL, TEXT):
            if lines:
                yield lines
            lines = []
        lines.append(line)
    yield lines


def _cell(number: int, lines: list[str]) -> dict[str, Any]:
    head, *body = lines
    markdown = head == TEXT
    if markdown:
        body = [line.removeprefix("#").removeprefix(" ") for line in body]
    else:
        body = [line for line in body if not line.startswith("# ruff:")]
    source = "\n".join(body).strip("\n").splitlines(keepends=True)
    cell: dict[str, Any] = {
        "cell_type": "markdown" if markdown else "code",
        "id": f"cell-{number}",
        "metadata": {},
        "source": source,
    }
    return cell if markdown else cell | {"execution_count": None, "outputs": []}


def main() -> None:
    """Write the notebooks beside their scripts."""
    for script in scripts():
        path = script.with_suffix(".ipynb")
        path.write_text(notebook(script.read_text("utf-8")), "utf-8")
        sys.stdout.write(f"wrote {path}\n")


if __name__ == "__main__":
    main()
