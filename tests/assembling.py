"""Assemblies without an engine: square grids rolled up along a formula, in their places."""

import numpy as np

import synthetic
from simulearn.assembly import Assembly, Part, Step
from simulearn.rigid import Place
from simulearn.simulate import Failure

SQUARE = synthetic.square_grid()
NARROW = synthetic.square_grid((2, 1), 55.0)
BROKEN = synthetic.square_grid((1, 1), 70.0)


class Rolling:
    """An engine that rolls grids up, and has no answer for one of them."""

    name = "synthetic"

    def __init__(self, bend=synthetic.cylinder):
        self.bend, self.grids = bend, []

    def simulate(self, grids, progress=None, cancel=None):
        self.grids += grids
        return [
            Failure(grid, "no-answer", "frame 3", "there is no answer")
            if len(grid.joints) == len(BROKEN.joints)
            else synthetic.result(grid, self.bend, solid=False)
            for grid in grids
        ]


def at(x=0.0, y=0.0, z=0.0):
    return Place(shift=np.array([x, y, z], dtype=float))


def three(pace=1.0, **more):
    """Three parts, two of them alike; the second slides in before it morphs, the last is ready."""
    parts = (
        Part("first", SQUARE),
        Part("second", SQUARE, Place.about_z(90).after(at(0, 200)), "first"),
        Part("ready", NARROW, at(0, -200)),
    )
    steps = (
        Step(("first",), pace),
        Step(("second",), 2 * pace, {"second": (0.0, 0.0, 50.0)}, name="in"),
    )
    return Assembly(parts, steps, **more)
