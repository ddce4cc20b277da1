"""Goals of a task as a document has them: each surface once, by a name, as triangles."""

from pathlib import PurePath
from typing import Any

import numpy as np

from simulearn.inverse import Task
from simulearn.inverse.goalfile import CurveFile, Goal, SurfaceFile
from simulearn.inverse.wanting import Shapes
from simulearn.studio.surfacefile import small
from simulearn.surfaces import Curve

ON = ("surface", "away_from")


def goals_in(task: Task) -> tuple[list[dict[str, Any]], list[dict[str, Any]], list[str]]:
    """Return the goals and surfaces of a task, and the files that goals name and nobody can read.

    Goals of those files are left out. What is placed in the task is at its place in the document.

    Raises:
        InputError: a surface or curve cannot be made.
    """
    shapes = Shapes()
    goals: list[dict[str, Any]] = []
    surfaces: list[dict[str, Any]] = []
    names: dict[str, str] = {}  # of surfaces, by what the task says of them
    lost: list[str] = []
    for k, goal in enumerate(task.goals):
        said = _said(goal)
        if said is not None and said.file is not None:
            lost.append(PurePath(said.file).name)
            continue
        data = goal.model_dump()
        if data.get("tolerance") is None and task.tolerance is not None:
            data["tolerance"] = task.tolerance
        for key in ON:
            if isinstance(surface := getattr(goal, key), SurfaceFile):
                text = surface.model_dump_json()
                if text not in names:
                    names[text] = f"surface {len(names) + 1}"
                    mesh, _ = small(shapes.surface(surface, f"goals[{k}].{key}"))
                    surfaces.append({"name": names[text], **mesh})
                data[key] = names[text]
        if goal.curve is not None:
            curve = shapes.curve(goal.curve, f"goals[{k}].curve")
            data["curve"] = {"points": _points(curve)}
        goals.append(data)
    return goals, surfaces, lost


def _said(goal: Goal) -> SurfaceFile | CurveFile | None:
    """Return what a goal says of its surface or curve."""
    away = goal.away_from
    return goal.surface or goal.curve or (away if isinstance(away, SurfaceFile) else None)


def _points(curve: Curve) -> list[list[float]]:
    points: list[list[float]] = np.asarray(curve.points).round(4).tolist()
    return points
