"""How well surfaces are tiled, and how long it takes: the examples, each by one command.

Errors and gaps are those after the check of every design by finite elements on the fine mesh.

    python benchmarks/tiling.py [--out out/tiling] [--again]
    with the environment of the Makefile's ONE_THREAD
"""

import argparse
import json
import os
import resource
import shutil
import subprocess
import sys
import time
from pathlib import Path

from report import Report

ROOT = Path(__file__).parent.parent
PICTURES = ROOT / "docs" / "pictures"
EXAMPLES = {  # name -> modules, further words
    "lampshade": ("5x3", []),
    "shell": ("8x5", []),
    "bridge": ("2x5", []),
}
PRINTER = "prusa-mk4"


def run(name: str, out: Path) -> dict[str, float]:
    """Tile an example in a folder of its own; return the seconds that it took."""
    modules, words = EXAMPLES[name]
    shutil.rmtree(out, ignore_errors=True)
    out.parent.mkdir(parents=True, exist_ok=True)
    source = ROOT / "examples" / "surfaces" / f"{name}.json"
    command = [sys.executable, "-m", "simulearn.cli", "tile", source, "--modules", modules]
    command += ["--printer", PRINTER, "-o", out, *words]
    before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    subprocess.run(list(map(str, command)), check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = {
        "seconds": time.monotonic() - begun,
        "user": after.ru_utime - before.ru_utime,
        "load": os.getloadavg()[1],
    }
    (out / "used.json").write_text(json.dumps(used), encoding="utf-8")
    return used


def main() -> None:
    """Tile what has not been tiled, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, default=Path("out/tiling"))
    parser.add_argument("--again", action="store_true", help="tile all of them anew")
    options = parser.parse_args()
    rows = []
    for name in EXAMPLES:
        folder = options.out / name
        known = folder / "used.json"
        if options.again or not known.exists():
            run(name, folder)
        used = json.loads(known.read_text(encoding="utf-8"))
        data = json.loads((folder / "tile.json").read_text(encoding="utf-8"))
        shutil.copy(folder / "assembly.png", PICTURES / f"tile-{name}.png")
        shutil.copy(folder / "deviation.png", PICTURES / f"tile-{name}-deviation.png")
        rows.append(
            [
                name,
                f"{data['modules']} ({data['kinds']}, {data['pieces']})",
                f"{data['error_mm']:.2f}",
                f"{data['error_max_mm']:.2f}",
                f"{data['deviation_mm']:.2f}",
                f"{data['beam_deviation_mm']:.2f}",
                f"{data['gap_mean_mm']:.2f}",
                f"{data['gap_mm']:.2f}",
                str(len(data["rounds"]) - 1),
                f"{used['user']:.0f}",
                f"{used['seconds']:.0f}",
                f"{used['load']:.0f}",
            ]
        )
    report = Report("tiling", "Tiling surfaces")
    report.say(
        "Three surfaces (`examples/surfaces`), modules of 2x2 cells, the default settings, print "
        f"files for `{PRINTER}` and all pictures included. Every design is checked by finite "
        "elements on the fine mesh, and all figures are by them: error is the distance of joints "
        "from their targets, deviation the distance from the surface, gap the distance between "
        "the places on a border where two neighbours meet. User seconds are of all processes "
        "together; wall-clock seconds are of a machine that others used, too: its load over five "
        "minutes is given."
    )
    report.table(
        [
            "example",
            "modules (kinds, pieces)",
            "error, mm",
            "worst joint",
            "deviation of joints",
            "of beams' middles",
            "gap, mean",
            "gap, largest",
            "rounds",
            "user s",
            "wall s",
            "load",
        ],
        rows,
    )
    for name in EXAMPLES:
        report.say(f"![{name}](../pictures/tile-{name}-deviation.png)")
    report.save()


if __name__ == "__main__":
    main()
