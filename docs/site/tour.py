"""Run the commands of the tour as they stand in it, and keep the pictures that they make.

python docs/site/tour.py

Files that the page shows (```json title="NAME") are written first; then every line
`$ simulearn ...` is run in their folder, except the studio, which does not end by itself.
"""

import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

DOCS = Path(__file__).resolve().parents[1]
PAGE = DOCS / "tour.md"
PICTURES = DOCS / "pictures" / "tour"


def files(text: str) -> dict[str, str]:
    """Return the files that a page shows, by their names."""
    return dict(re.findall(r'^```json title="([^"]+)"\n(.*?)^```$', text, re.M | re.S))


def commands(text: str) -> list[list[str]]:
    """Return the arguments of each line `$ simulearn ...` of a page."""
    lines = re.findall(r"^\$ simulearn (.*)$", text, re.M)
    return [shlex.split(line, comments=True) for line in lines]


def main() -> None:
    """Run the tour, and replace its pictures."""
    text = PAGE.read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, content in files(text).items():
            (folder / file).write_text(content, encoding="utf-8")
        for arguments in commands(text):
            if arguments[0] != "studio":
                print("$ simulearn", *arguments, flush=True)
                run = [sys.executable, "-m", "simulearn.cli", *arguments]
                subprocess.run(run, cwd=folder, check=True)
        PICTURES.mkdir(parents=True, exist_ok=True)
        for picture in re.findall(r'"pictures/tour/([^"]+)"', text):
            (made,) = folder.rglob(picture)
            shutil.copyfile(made, PICTURES / picture)


if __name__ == "__main__":
    main()
