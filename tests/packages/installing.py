"""What is installed far from the checkout, and for which Pythons.

SIMULEARN_PYTHONS names the Pythons, separated by spaces; without it, this one.
"""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
PYTHONS = os.environ.get("SIMULEARN_PYTHONS", sys.executable).split()
PATIENCE = 300  # s, for one command on a busy machine


class Installed:
    """An environment with the wheel in it, and the folder in which its commands run.

    Args:
        place: an empty folder but for `env`, the environment.
        uv: runs uv.
        wheel: to install.
    """

    def __init__(self, place: Path, uv: Callable[..., None], wheel: Path) -> None:
        self.bin, self.folder = place / "env/bin", place / "work"
        self.folder.mkdir()
        self._uv, self._wheel = uv, wheel
        self.extra()

    def extra(self, name: str = "", dry_run: bool = False) -> None:
        """Install the wheel with extras or none, and take off all else; or only try to find all."""
        pinned = ["--constraint", ROOT / "requirements.lock"]
        wanted = f"{self._wheel}[{name}]" if name else self._wheel
        python = ["--python", self.bin / "python", *(["--dry-run"] if dry_run else [])]
        self._uv("pip", "install", "--exact", *python, *pinned, wanted, cwd=self.folder)

    def write(self, name: str, value: Any) -> None:
        """Write a JSON file for the commands to read."""
        (self.folder / name).write_text(json.dumps(value), "utf-8")

    def environment(self) -> dict[str, str]:
        """Return the variables of a user, who has no checkout on any path."""
        return {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "SIMULEARN"))}

    def run(self, program: str, *words: object) -> subprocess.CompletedProcess[str]:
        """Run a program of the environment as a user does."""
        command = [str(self.bin / program), *map(str, words)]
        return subprocess.run(
            command,
            cwd=self.folder,
            env=self.environment(),
            capture_output=True,
            text=True,
            timeout=PATIENCE,
        )

    def __call__(self, *words: object) -> str:
        """Run simulearn, which must succeed, and return what it printed."""
        done = self.run("simulearn", *words)
        assert done.returncode == 0, done.stderr
        assert "Traceback" not in done.stderr
        return done.stdout

    def refused(self, *words: object) -> str:
        """Run simulearn, which must refuse with one line, and return the line."""
        done = self.run("simulearn", *words)
        assert done.returncode == 1, (words, done.stdout, done.stderr)
        (line,) = done.stderr.splitlines()
        return line
