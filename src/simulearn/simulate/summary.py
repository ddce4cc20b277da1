"""A result in a few numbers, and in words what qualifies it."""

from typing import Any

import numpy as np

from simulearn.schedule import FRAMES
from simulearn.simulate.result import Result
from simulearn.simulate.resultfile import qualities


def summary(result: Result) -> dict[str, Any]:
    """Return the numbers that say at a glance what a grid did, mm and s.

    Returns:
        dimension_mm: largest distance from the fixed joint to another one, flat.
        lowest_mm, highest_mm: z of the lowest and highest corner of the last frame.
        rise_mm: the largest rise (or fall) of a joint centre, joint_risen: which joint.
        moved_mm: the largest distance a joint centre moved, joint_moved: which joint.
        seconds: time the simulation took.
        iterations: iterations of the solver in all, where the engine counts them.
        mesh, bricks: name of the mesh and its number of bricks, where the engine has one.
        stable, bound_mm, snaps, warnings, collisions, material, model: see `Result`.
        scatter: how prints differ, where that was computed.
    """
    flat, last = result.centres[0], result.centres[-1]
    rise, moved = last[:, 2] - flat[:, 2], np.linalg.norm(last - flat, axis=1)
    risen, far = int(np.abs(rise).argmax()), int(moved.argmax())
    z = np.concatenate([result.joints[-1].reshape(-1, 3), result.beams[-1].reshape(-1, 3)])[:, 2]
    numbers: dict[str, Any] = {
        "dimension_mm": result.grid.dimension,
        "lowest_mm": float(z.min()),
        "highest_mm": float(z.max()),
        "rise_mm": float(rise[risen]),
        "joint_risen": risen,
        "moved_mm": float(moved[far]),
        "joint_moved": far,
        "seconds": float(result.seconds),
    }
    iterations = result.record.get("iterations")
    if iterations is not None:
        numbers["iterations"] = int(np.sum(iterations))
    numbers |= {key: result.record[key] for key in ("mesh", "bricks") if key in result.record}
    rounded = {k: round(v, 6) if isinstance(v, float) else v for k, v in numbers.items()}
    return rounded | qualities(result)


def remarks(result: Result) -> list[str]:
    """Return a sentence for each reason for caution that no warning says."""
    lines = []
    if not result.stable:
        lines.append("the shape is in unstable balance and may snap into another")
    if all(message.code != "snap" for message in result.warnings):
        lines += [
            f"the grid snaps while it creeps (frame {snap.frame})"
            if snap.frame == FRAMES - 1
            else f"the grid snaps at {snap.released:.1%} released (frame {snap.frame})"
            for snap in result.snaps
        ]
    return lines
