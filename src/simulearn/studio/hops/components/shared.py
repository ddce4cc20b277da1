"""Inputs and outputs that several components have, and how they are filled."""

import json
from collections.abc import Sequence
from time import monotonic
from typing import Any

from simulearn.errors import Cancel, InputError, Message
from simulearn.grid import Grid, grid_to_dict
from simulearn.simulate import FRAMES, Result, one, remarks
from simulearn.studio.hops import meshes
from simulearn.studio.hops.design import Design
from simulearn.studio.hops.parameters import CURVE, MESH, NUMBER, POINT, TEXT, Input, Output
from simulearn.studio.hops.values import Inputs
from simulearn.studio.problems import Problem
from simulearn.studio.routes.designs import check_fea
from simulearn.studio.settings import Settings
from simulearn.studio.simulations import engine_of

LAST = FRAMES - 1
PATIENCE = 60.0  # s of one request; Hops waits for 100

ENGINE = Input(
    "Engine",
    "E",
    "learned (the model, milliseconds), beams (a beam theory) or fea (finite elements, small grids "
    "only).",
    TEXT,
    default="learned",
)
MESSAGES = Output("Messages", "M", "All errors, warnings, mends and what was left out.", TEXT)
JOINTS = Output("Joints", "J", "The joints, after mending.", POINT)
AXES = Output("Axes", "X", "The axes of the beams, after mending.", CURVE)
RATIOS = Output("Ratios", "R", "The actuator of each of the axes.", NUMBER)
GRID = Output(
    "Grid", "G", "The grid as JSON, in mm, as the studio and the command line open it.", TEXT
)
MESHES = Output("Mesh", "M", "The grid in its frame, coloured by its actuators.", MESH)


class Deadline:
    """A token that is also set when the time of a request is over.

    Args:
        cancel: the request's own.
        begun: when it came, by the monotonic clock.
    """

    def __init__(self, cancel: Cancel, begun: float) -> None:
        self._cancel, self._end = cancel, begun + PATIENCE

    @property
    def overdue(self) -> bool:
        """Whether the time is over."""
        return monotonic() > self._end

    def is_set(self) -> bool:
        """Return whether the computation shall stop."""
        return self._cancel.is_set() or self.overdue

    def problem(self) -> Problem:
        """Return what is said when the time is over."""
        text = f"that takes longer than the {PATIENCE:g} s that Grasshopper should wait"
        return Problem(422, "time-over", text)


def mended(design: Design) -> dict[str, Sequence[Any]]:
    """Return what a design is after mending: its axes, their ratios, and the grid."""
    return {
        "Axes": meshes.flat_axes(design),
        "Ratios": design.grid.actuators.tolist(),
        "Grid": [as_json(design.grid)],
    }


def as_json(grid: Grid) -> str:
    """Return the text of a grid's file."""
    return json.dumps(grid_to_dict(grid))


def texts(messages: Sequence[Message]) -> list[str]:
    """Return messages as a balloon shows them."""
    return [message.message for message in messages]


def qualities(result: Result) -> list[str]:
    """Return what qualifies a result."""
    return [*texts(result.warnings), *remarks(result)]


def simulated(grids: Sequence[Grid], name: str, settings: Settings, cancel: Cancel) -> list[Result]:
    """Return the results of grids.

    Raises:
        InputError: an engine is not known, or a grid is not valid or too large for it.
        ComputationError: a grid has no answer.
        Problem: it takes too long.
        CancelledError: the request was cancelled.
    """
    engine = engine_of(name)
    if name == "fea":
        check_fea(grids, settings)
    return [one(outcome) for outcome in engine.simulate(grids, cancel=cancel)]


def frame_of(inputs: Inputs, name: str) -> int:
    """Return the number of a frame.

    Raises:
        InputError: there is none of that number.
    """
    given = inputs.number(name, LAST)
    if given != int(given) or not 0 <= given <= LAST:
        text = f"{name} is {given:g}; frames are 0 (flat) to {LAST} (at the end)"
        raise InputError(text, "frame", name)
    return int(given)
