"""A running studio and a Chromium to look at it with, for benchmarks, pictures and tests."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import Browser, sync_playwright

# As on a machine without a graphics card, so that every machine gives the same picture; nothing
# goes out to the network.
OPTIONS = [
    "--no-sandbox",
    "--disable-gpu",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--force-color-profile=srgb",
]
NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
PATIENCE = 120.0  # s until a server must answer; the first start on a machine compiles kernels


def chromium_path() -> str | None:
    """Return where Chromium is installed, or None."""
    found = os.environ.get("SIMULEARN_CHROMIUM") or next(filter(None, map(shutil.which, NAMES)), "")
    return found or None


@dataclass
class Studio:
    """A studio that runs in a process of its own.

    Attributes:
        url: its address.
        seconds: from the command until it said that it answers.
        process: the process.
    """

    url: str
    seconds: float
    process: "subprocess.Popen[str]"

    def stop(self) -> int:
        """End it as Ctrl-C does, and return its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        code = self.process.wait(20)
        if self.process.stdout is not None:
            self.process.stdout.close()
        return code


def start(data: Path, port: int | None = None, *options: str) -> Studio:
    """Start `simulearn studio` and return when it says its address.

    Args:
        data: folder of its documents.
        port: of the server; a free one if not given.
        options: more of the command.
    """
    command = [sys.executable, "-m", "simulearn.cli", "studio", "--no-browser", "--data", str(data)]
    command += ["--port", str(port)] if port is not None else []
    begun = time.perf_counter()
    process = subprocess.Popen(
        [*command, *options],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )
    assert process.stdout is not None
    lines = []
    for line in process.stdout:
        lines.append(line)
        if found := re.search(r"http://[\w.:\[\]-]+", line):
            return Studio(found[0].rstrip("/"), time.perf_counter() - begun, process)
    process.wait(5)
    raise RuntimeError(f"the studio did not start: {''.join(lines)}")


@contextmanager
def running(data: Path, port: int | None = None, *options: str) -> Iterator[Studio]:
    """Yield a studio that runs until the block is left."""
    studio = start(data, port, *options)
    try:
        yield studio
    finally:
        studio.stop()


@contextmanager
def chromium() -> Iterator[Browser]:
    """Yield a headless Chromium.

    Raises:
        RuntimeError: none is installed.
    """
    path = chromium_path()
    if path is None:
        raise RuntimeError("Chromium was not found; install it, or set SIMULEARN_CHROMIUM")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=OPTIONS)
        try:
            yield browser
        finally:
            browser.close()
