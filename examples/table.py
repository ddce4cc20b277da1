"""The cell unit of an aggregated table, by hybrid design (SimuLearn, UIST 2020, Figure 17).

Units stand in a ring and touch at two opposite joints. The lines tangent to a unit there meet at
its contact angle, which decides how many units close the ring: n of them where it is 360 / n
degrees. The designer cannot set the angle; the goals bring the corners of the two joints to where
an arc of that angle ends, and the tool suggests five modifications. The designer picks: here
the one with the best angle, until none brings it closer.

    python examples/table.py [-o out/table] [--units 6] [--engine learned]
"""

import argparse
from pathlib import Path

import numpy as np

from simulearn.grid import grid_to_dict, make
from simulearn.inverse import Task, rank, task_from_dict, write_task
from simulearn.rigid import Place
from simulearn.show.assembly import assembly
from simulearn.show.inverse import cards
from simulearn.simulate import Result, engine, one, results

LENGTH = 60.0  # mm, of the beams
LEFT, RIGHT = 3, 5  # joints where units touch
PICKS = 10  # at most; the paper's designer made seven
CORNERS = [(3.6, 3.6), (-3.6, 3.6), (-3.6, -3.6), (3.6, -3.6)]  # of a joint, mm
PAIRS = {
    "flip": "x",
    "joints": [[0, 2], [3, 5], [6, 8], [1, 1], [7, 7]],
    "actuators": [[0, 2], [1, 4], [5, 7], [6, 9], [10, 11]],
}


def task(units: int) -> Task:
    """Return the task of a unit of a ring of so many."""
    half = np.pi / units  # each end turns by half of the contact angle
    arc = LENGTH - 2.0  # release shortens a beam
    end = np.array([arc * np.sin(half) / half, 0.0, -arc * (1 - np.cos(half)) / half])
    c, s = np.cos(half), np.sin(half)
    corners = np.array([[x, y, z] for z in (-2, 2) for x, y in CORNERS], dtype=float)
    right = end + corners @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T
    left = end * [-1, 1, 1] + corners @ np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]]).T
    return task_from_dict(
        {
            "schema": "simulearn.task/1",
            "grid": grid_to_dict(make("flat", length=LENGTH)),
            "goals": [
                {"vertex": ["joint", joint, k], "target": place}
                for joint, places in ((LEFT, left), (RIGHT, right))
                for k, place in enumerate(places.tolist())
            ],
            "free": {"pairs": PAIRS},
        }
    )


def contact_angle(result: Result) -> float:
    """Return the angle (degrees) between the lines tangent to a unit where it touches others."""
    joints = result.joints[-1]
    bottom, top = joints[[LEFT, RIGHT], :4].mean(axis=1), joints[[LEFT, RIGHT], 4:].mean(axis=1)
    left, right = (top - bottom) / np.linalg.norm(top - bottom, axis=1, keepdims=True)
    return float(np.degrees(np.arccos(np.clip(left @ right, -1, 1))))


def ring(result: Result, units: int) -> list[tuple[Result, Place]]:
    """Return units in a ring about the z axis, each in its place."""
    left, right = result.centres[-1, LEFT], result.centres[-1, RIGHT]
    radius = np.linalg.norm(right - left) / 2 / np.tan(np.pi / units)
    # The unit's x goes around, its y up, its z outwards.
    turn = np.array([[0, 0, 1.0], [1, 0, 0], [0, 1, 0]])
    middle = turn @ (left + right) / 2
    stand = Place(turn, np.array([radius, 0, 0]) - middle)
    return [(result, Place.about_z(360 / units * k).after(stand)) for k in range(units)]


def main(words: list[str] | None = None) -> tuple[float, Result]:
    """Pick suggestions until the contact angle is right; return the angle and the unit."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("-o", "--output", type=Path, default=Path("out/table"))
    parser.add_argument("--units", type=int, default=6)
    parser.add_argument("--picks", type=int, default=PICKS)
    parser.add_argument("--engine", default="learned")
    options = parser.parse_args(words)
    options.output.mkdir(parents=True, exist_ok=True)
    wanted = 360 / options.units
    now, answering = task(options.units), engine(options.engine)
    away = abs(wanted - contact_angle(one(answering.simulate([now.start])[0])))
    for k in range(options.picks):
        ranking = rank(now, answering)
        shapes = results(answering.simulate([option.grid for option in ranking.best]))
        if k == 0:
            cards(ranking, shapes, now.aims).savefig(options.output / "suggestions.png")
        angles = [contact_angle(result) for result in shapes]
        pick = int(np.argmin([abs(wanted - angle) for angle in angles]))
        if abs(wanted - angles[pick]) >= away:
            break
        away, chosen = abs(wanted - angles[pick]), ranking.best[pick]
        now = now.with_grid(chosen.grid)
        words = f"suggestion {pick + 1}, {chosen.change.words}"
        print(f"{k + 1}: {words}: {chosen.error_mm:.2f} mm, {angles[pick]:.1f} degrees")
    write_task(now, options.output / "task.json")
    unit = one(engine("fea").simulate([now.start])[0])
    angle = contact_angle(unit)
    print(f"contact angle by finite elements {angle:.1f} of {wanted:.1f} degrees")
    text = f"{options.units} units, contact angle {angle:.1f} of {wanted:.1f} degrees"
    assembly(ring(unit, options.units), text).savefig(options.output / "ring.png")
    return angle, unit


if __name__ == "__main__":
    main()
