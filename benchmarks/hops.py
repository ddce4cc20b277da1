"""How long Grasshopper waits for the studio: whole answers over HTTP, as Hops asks for them.

python benchmarks/hops.py
"""

import json
import statistics
import tempfile
import time
import urllib.error
import urllib.request
from pathlib import Path
from typing import Any

import rhino3dm

from browsing import running
from report import Report
from simulearn.grid import Grid, make

TIMES = 15
ENDURANCE = 100.0  # s that Hops waits


def main() -> None:
    """Measure and write the page."""
    report = Report("hops", "Waiting in Grasshopper")
    small, large = make("saddle", (2, 2)), make("saddle", (5, 5))
    rows = []
    with tempfile.TemporaryDirectory() as folder, running(Path(folder)) as studio:
        url = studio.url
        begun = time.perf_counter()
        while ask(url, "simulate", inputs(small))[0] != 200:
            time.sleep(0.2)
        first = time.perf_counter() - begun
        rows.append(["Simulate, 2x2 grid, the first after the start", f"{first:.2f}", "", 1])
        for words, name, grid, more in (
            ("Validate, 2x2 grid", "validate", small, {}),
            ("Simulate, 2x2 grid", "simulate", small, {}),
            ("Simulate, 5x5 grid", "simulate", large, {}),
            ("Rank, 2x2 grid, 2 goals", "rank", small, goals(small)),
            ("G-code, 2x2 grid", "gcode", small, {}),
            ("Optimise, 2x2 grid: the name of the search", "optimise", small, goals(small)),
        ):
            spent = [timed(url, name, inputs(grid) | more) for _ in range(TIMES)]
            rows.append([words, f"{statistics.median(spent):.2f}", f"{max(spent):.2f}", TIMES])
    report.say(f"Seconds from the request to the whole answer; Hops waits for {ENDURANCE:g} s.")
    report.table(["what", "median, s", "worst, s", "of"], rows)
    report.save()


def timed(url: str, name: str, given: dict[str, Any]) -> float:
    """Return how long a component takes, s."""
    begun = time.perf_counter()
    status, answer = ask(url, name, given)
    spent = time.perf_counter() - begun
    if status not in (200, 202) or answer["errors"]:
        raise RuntimeError(f"{name}: {answer['errors']}")
    return spent


def ask(url: str, name: str, given: dict[str, Any]) -> tuple[int, Any]:
    """Return the status and the answer of a component."""
    values = [{"ParamName": key, "InnerTree": {"{0}": items}} for key, items in given.items()]
    body = {"pointer": f"hops/{name}", "modelunits": "Millimeters", "values": values}
    head = {"Content-Type": "application/json; charset=utf-8"}
    request = urllib.request.Request(f"{url}/solve", json.dumps(body).encode(), head)
    try:
        with urllib.request.urlopen(request, timeout=ENDURANCE) as answer:
            return answer.status, json.loads(answer.read())
    except urllib.error.HTTPError as error:
        return error.code, json.loads(error.read())


def inputs(grid: Grid) -> dict[str, Any]:
    """Return the curves, ratios and fixed point of a grid."""
    joints = [rhino3dm.Point3d(x, y, 0) for x, y in grid.joints.tolist()]
    curves = [rhino3dm.LineCurve(joints[a], joints[b]) for a, b in grid.beams.tolist()]
    return {
        "Curves": [item("Rhino.Geometry.LineCurve", curve.Encode()) for curve in curves],
        "Actuators": [item("System.Double", ratio) for ratio in grid.actuators.tolist()],
        "Fixed": [point(*grid.joints[grid.fixed], 0)],
    }


def goals(grid: Grid) -> dict[str, Any]:
    """Return two corners and where they are wanted."""
    corners = grid.joints[[0, -1]]
    return {
        "Points": [point(x, y, 0) for x, y in corners],
        "Targets": [point(0.95 * x, 0.95 * y, 15) for x, y in corners],
    }


def point(x: float, y: float, z: float) -> dict[str, str]:
    """Return a point as Hops sends it."""
    return item("Rhino.Geometry.Point3d", {"X": float(x), "Y": float(y), "Z": float(z)})


def item(kind: str, data: Any) -> dict[str, str]:
    """Return a value as Hops sends it."""
    return {"type": kind, "data": json.dumps(data)}


if __name__ == "__main__":
    main()
