"""Time the import of large drawings, and what messy drawings become.

python benchmarks/drawings.py [--drawings 400] [--seed 7000]
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import ezdxf
import ezdxf.units
import numpy as np
import rhino3dm

from report import Report
from simulearn.drawings.drawing import Drawing, Line
from simulearn.drawings.importing import Options, grid_of

SIDE = 65.0


def net(cells: int) -> list[np.ndarray]:
    """Return the beams (2, 2) mm of a square net, one line for each."""
    places = range(cells + 1)
    rows = [[(i, j), (i + 1, j)] for j in places for i in range(cells)]
    columns = [[(i, j), (i, j + 1)] for j in range(cells) for i in places]
    return [SIDE * np.array(pair, float) for pair in rows + columns]


def crossing(lines: int) -> list[np.ndarray]:
    """Return half of the lines along x and half along y, all crossing in their middles."""
    half = lines // 2
    reach = SIDE * half
    places = SIDE * (np.arange(half) + 0.5)
    return [np.array([[0, y], [reach, y]]) for y in places] + [
        np.array([[x, 0], [x, reach]]) for x in places
    ]


def messy(lines: list[np.ndarray], random: np.random.Generator) -> list[np.ndarray]:
    """Return lines with ends moved along their axes by up to .6 mm, and a fifth drawn twice."""
    found = []
    for a, b in lines:
        direction = (b - a) / np.hypot(*(b - a))
        first, last = random.uniform(-0.6, 0.6, 2)
        found.append(np.array([a + first * direction, b + last * direction]))
        if random.random() < 0.2:
            found.append(found[-1][::-1])
    return found


def write_json(path: Path, lines: list[np.ndarray]) -> None:
    """Write lines as pairs of points."""
    path.write_text(json.dumps([line.tolist() for line in lines]))


def write_svg(path: Path, lines: list[np.ndarray]) -> None:
    """Write lines as paths with styles, in mm, as drawing programs do."""
    paths = "".join(
        f'<path style="fill:none;stroke:#000;stroke-width:1" d="M {a[0]},{a[1]} {b[0]},{b[1]}"/>'
        for a, b in lines
    )
    size = float(np.max(np.abs(lines)))
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{size}mm" viewBox="0 0 {size} {size}">'
    path.write_text(f"{head}{paths}</svg>")


def write_dxf(path: Path, lines: list[np.ndarray]) -> None:
    """Write lines in mm as a DXF file of today."""
    document = ezdxf.new(units=ezdxf.units.MM)
    for line in lines:
        document.modelspace().add_line(*line.tolist())
    document.saveas(path)


def write_3dm(path: Path, lines: list[np.ndarray]) -> None:
    """Write lines in mm as a file of Rhino 8."""
    model = rhino3dm.File3dm()
    model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Millimeters
    for line in lines:
        ends = [rhino3dm.Point3d(*end, 0.0) for end in line.tolist()]
        model.Objects.AddLine(*ends)
    model.Write(str(path), 8)


WRITERS = {"json": write_json, "svg": write_svg, "dxf": write_dxf, "3dm": write_3dm}


def timed(
    lines: list[np.ndarray], ending: str = "json", repeats: int = 3
) -> tuple[float, float, int, str]:
    """Return what the whole command takes and says, for lines in a file of one of WRITERS.

    Returns:
        The least seconds and processor seconds of some runs, its exit code, and the first line
        that it prints.
    """
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"lines.{ending}"
        WRITERS[ending](file, lines)
        command = [sys.executable, "-m", "simulearn.cli", "import", str(file)]
        best = least = np.inf
        for _ in range(repeats):
            begun, used = time.perf_counter(), processor_seconds()
            done = subprocess.run(
                [*command, "-o", str(Path(folder) / "grid.json")],
                capture_output=True,
                text=True,
                check=False,
                env={**os.environ, "COLUMNS": "200"},
            )
            best = min(best, time.perf_counter() - begun)
            least = min(least, processor_seconds() - used)
    said = (done.stdout or done.stderr).split("\n")[0].replace(str(file), "FILE")
    return best, least, done.returncode, said


def processor_seconds() -> float:
    """Return the processor time of all children so far, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def restored(count: int, seed: int) -> tuple[int, float]:
    """Return how many messy nets become the clean one, and the largest distance of a joint, mm."""
    clean = net(3)
    places = np.unique(np.concatenate(clean), axis=0)
    random = np.random.default_rng(seed)
    good, worst = 0, 0.0
    for _ in range(count):
        angle = random.uniform(0, 2 * np.pi)
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        lines = [line @ turn.T for line in messy(clean, random)]
        spatial = [Line(np.column_stack([line, np.zeros(2)])) for line in lines]
        grid = grid_of(Drawing("benchmark", spatial, plain=True), Options(place="drawn")).grid
        away = np.linalg.norm(grid.joints[:, None] - (places @ turn.T)[None], axis=2).min(axis=1)
        if len(grid.joints) == len(places) and len(grid.beams) == len(clean):
            good += away.max() < 0.01
            worst = max(worst, float(away.max()))
    return int(good), worst


def main() -> None:
    """Measure and report."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--drawings", type=int, default=400)
    parser.add_argument("--seed", type=int, default=7000)
    given = parser.parse_args()
    random = np.random.default_rng(given.seed)
    fan = [
        np.array([[800 * np.cos(a), 800 * np.sin(a)], [-800 * np.cos(a), -800 * np.sin(a)]])
        for a in np.linspace(0, 3, 3000)
    ]
    kinds = {
        "3,120 beams of a net, a line each": (net(39), "json"),
        "the same as SVG": (net(39), "svg"),
        "the same as DXF": (net(39), "dxf"),
        "the same as 3dm": (net(39), "3dm"),
        "the same, messy": (messy(net(39), random), "json"),
        "256 lines that cross at 16,384 places": (crossing(256), "json"),
        "3,000 lines that cross at 2,250,000 places": (crossing(3000), "json"),
        "3,000 lines through one point": (fan, "json"),
    }
    rows = []
    for name, (lines, ending) in kinds.items():
        seconds, used, code, said = timed(lines, ending)
        shown = said if len(said) <= 90 else f"{said[:87]}..."
        rows.append((name, len(lines), f"{seconds:.2f}", f"{used:.2f}", code, shown))
        print(*rows[-1], flush=True)
    report = Report("drawings", "Drawings become grids")
    load = os.getloadavg()[0]
    report.say(
        "The whole command `simulearn import`, from start to exit, the best of three runs. "
        f"Other programs shared the machine (load {load:.1f}); processor seconds are its own."
    )
    report.table(["drawing", "lines", "s", "processor s", "exit code", "says"], rows)
    good, worst = restored(given.drawings, given.seed)
    report.say(
        f"Messy drawings of a net of 3 x 3 cells (each end moved along its axis by up to .6 mm, a "
        f"fifth of the lines drawn twice, turned by any angle): {good} of {given.drawings} become "
        f"the clean grid within .01 mm; the largest distance of a joint is {worst:.1e} mm."
    )
    report.save()


if __name__ == "__main__":
    main()
