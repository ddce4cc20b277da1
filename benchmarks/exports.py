"""Size of each format and the time to write it; when a page that plays offline has drawn its shape.

python benchmarks/exports.py
"""

import gzip
import statistics
import tempfile
import time
from pathlib import Path

from browsing import chromium
from report import Report
from simulearn import outputs, simulate
from simulearn.grid import make, read_grid
from simulearn.simulate import Result

EXAMPLE = Path(__file__).parent.parent / "examples" / "twist.json"
OPENINGS = 5
DRAWN = "() => new Promise((done) => requestAnimationFrame(() => setTimeout(done)))"
CANVAS = ".shape-canvas canvas"


def main() -> None:
    """Measure and write the page."""
    report = Report("exports", "Formats: size and time")
    large = make("wave", (10, 9))
    results = [simulate(read_grid(EXAMPLE), "learned"), simulate(large, "learned")]
    heads = [f"{len(result.grid.beams)} beams" for result in results]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rows = []
        for ending in outputs.WRITERS:
            cells = [cell for result in results for cell in written(result, folder, ending)]
            rows.append([f"`{ending}`", *cells])
        report.say(
            "Results of the learned model. Seconds are of one process, the second of two runs in "
            "it; `.pvd` counts its folder of frames."
        )
        report.table(["format", *(f"{head}, {x}" for head in heads for x in ("kB", "s"))], rows)
        rows = [opened(result, head, folder) for result, head in zip(results, heads, strict=True)]
    report.say(
        "The page in a headless Chromium without a graphics card and without a network, from its "
        f"address to its first drawing, of {OPENINGS} openings, each with an empty cache."
    )
    report.table(["page", "kB", "kB, gzip", "median, s", "worst, s"], rows)
    report.save()


def written(result: Result, folder: Path, ending: str) -> tuple[str, str]:
    """Return the size of a file, kB, and the time to write it, s."""
    path = folder / f"shape{ending}"
    spent = []
    for _ in range(2):  # the first one loads what the format needs
        begun = time.perf_counter()
        outputs.write(result, path)
        spent.append(time.perf_counter() - begun)
    files = [path, *folder.glob("shape_frames/*")] if ending == ".pvd" else [path]
    return f"{sum(file.stat().st_size for file in files) / 1000:.0f}", f"{spent[1]:.2f}"


def opened(result: Result, head: str, folder: Path) -> list[str]:
    """Return the size of a page and how long its first drawing takes."""
    path = folder / "shape.html"
    outputs.write(result, path)
    spent = []
    with chromium() as browser:
        for _ in range(OPENINGS):
            context = browser.new_context(offline=True)
            page = context.new_page()
            begun = time.perf_counter()
            page.goto(path.as_uri())
            page.locator(CANVAS).first.wait_for()
            page.evaluate(DRAWN)
            spent.append(time.perf_counter() - begun)
            context.close()
    data = path.read_bytes()
    sizes = [f"{len(data) / 1000:.0f}", f"{len(gzip.compress(data)) / 1000:.0f}"]
    return [head, *sizes, f"{statistics.median(spent):.2f}", f"{max(spent):.2f}"]


if __name__ == "__main__":
    main()
