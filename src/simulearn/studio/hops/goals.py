"""Goals as a modeller sets them: points on the flat grid, and the points where they shall come."""

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.grid import grid_to_dict
from simulearn.studio.hops.design import Design
from simulearn.studio.hops.parameters import MOST, POINT, Input
from simulearn.studio.hops.values import Inputs

Points = NDArray[np.float64]

REACH = 10.0  # mm between a point and the vertex that it stands for

POINTS = Input(
    "Points",
    "P",
    "Points of the flat grid that shall move: at joints, or at the middles of beams.",
    POINT,
    1,
    MOST,
)
TARGETS = Input("Targets", "T", "Where each of the points shall come.", POINT, 1, MOST)
GOALS = (POINTS, TARGETS)


def task_of(inputs: Inputs, design: Design) -> dict[str, object]:
    """Return the task of bringing points of a design to their targets, as in a task file.

    Raises:
        InputError: there are no points, not as many targets, or a point lies on nothing.
    """
    points, targets = inputs.points(POINTS.name), inputs.points(TARGETS.name)
    if not len(points) or len(points) != len(targets):
        text = f"Points has {len(points)} points and Targets {len(targets)}; give one for each"
        raise InputError(text, "goals", TARGETS.name)
    grid = design.grid
    middles = grid.joints[grid.beams].mean(axis=1)
    places = np.concatenate([grid.joints, middles])
    wanted = design.placement.inside(targets) - design.anchor
    goals = []
    for k, point in enumerate(design.placement.inside(points)):
        away = np.linalg.norm(places - point[:2], axis=1)
        nearest = int(away.argmin())
        if away[nearest] > REACH:
            text = (
                f"Points[{k}] is {away[nearest]:.3g} mm from the nearest joint or middle of a beam "
                f"of the flat grid; it may be {REACH:g} mm away"
            )
            raise InputError(text, "goals", POINTS.name)
        joints = len(grid.joints)
        vertex = (
            ["joint", nearest, "centre"]
            if nearest < joints
            else ["beam", nearest - joints, "middle", "centre"]
        )
        goals.append({"vertex": vertex, "target": wanted[k].tolist()})
    return {"schema": "simulearn.task/1", "grid": grid_to_dict(grid), "goals": goals}
