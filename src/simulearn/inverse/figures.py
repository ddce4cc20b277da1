"""A search in figures, for programs: what it came to, and every step on the way."""

from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.inverse.found import SearchResult
from simulearn.inverse.task import Task
from simulearn.material import load_material


def search_figures(task: Task, result: SearchResult) -> dict[str, Any]:
    """Return the figures of a search as plain data: errors in mm, times in s."""
    check = result.check
    return {
        "method": task.method,
        "engine": task.engine,
        "material": load_material(task.start.material).identity.model_dump(),
        "error_mm": result.error_mm,
        "error_fea_mm": check.error_fea_mm if check else None,
        "why_no_fea": check.why if check and check.error_fea_mm is None else None,
        "apart_mm": check.apart_mm if check else None,
        "bound_mm": check.bound_mm if check else None,
        "agrees": check.agrees if check else None,
        "start_mm": result.steps[0].error_mm,
        "designs": result.designs,
        "iterations": result.iterations,
        "corrections": max(0, *(step.phase for step in result.steps)),
        "seconds": round(result.seconds, 3),
        "interrupted": result.interrupted,
        "warnings": [asdict(message) for message in result.warnings],
        **_of_prints(result),
        **({"answers": [one.to_dict() for one in result.answers]} if result.answers else {}),
        **_pose(result),
        "goals": _goals(result),
        "history": [step.row() for step in result.steps],
    }


def _of_prints(result: SearchResult) -> dict[str, Any]:
    """Return how often prints meet the goals, where the task asks for it."""
    parts = {"probability": result.probability, "nominal_probability": result.nominal}
    return {name: part.to_dict() for name, part in parts.items() if part is not None}


def _goals(result: SearchResult) -> list[dict[str, Any]]:
    """Return how far each goal is from being met, by finite elements where they answered."""
    points, goals = _points(result), result.goals
    if points is None:
        return []
    rows = zip(
        goals.names, goals.kinds, goals.distances(points), goals.degrees(points), strict=True
    )
    return [
        {"vertex": name, "kind": kind, "distance_mm": float(distance)}
        | ({} if angle is None else {"angle_deg": float(angle)})
        for name, kind, distance, angle in rows
    ]


def _pose(result: SearchResult) -> dict[str, Any]:
    """Return where the shape is placed, where that is free."""
    points = _points(result)
    if points is None or result.goals.pose is None:
        return {}
    place = result.goals.place(points)
    return {"place": {"turn": place.turn.tolist(), "shift": place.shift.tolist()}}


def _points(result: SearchResult) -> NDArray[np.float64] | None:
    shape = None if result.check is None else result.check.shape
    return None if shape is None else result.goals.points(shape.joints[-1], shape.beams[-1])
