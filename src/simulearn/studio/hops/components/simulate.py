"""Simulate: the shape that a grid takes in hot water."""

import numpy as np
from numpy.typing import NDArray

from simulearn.simulate import Result, collision_place, collision_text
from simulearn.studio.hops import meshes
from simulearn.studio.hops.components.shared import (
    ENGINE,
    GRID,
    LAST,
    MESHES,
    MESSAGES,
    RATIOS,
    as_json,
    frame_of,
    qualities,
    simulated,
)
from simulearn.studio.hops.design import DRAWN, design_of
from simulearn.studio.hops.material import MATERIAL
from simulearn.studio.hops.parameters import (
    BOOLEAN,
    CURVE,
    INTEGER,
    MESH,
    NUMBER,
    POINT,
    TEXT,
    Component,
    Input,
    Output,
)
from simulearn.studio.hops.solving import Context, Outputs
from simulearn.studio.hops.values import Inputs

FRAME = Input(
    "Frame",
    "Fr",
    f"0 is flat, {LAST} the shape at the end.",
    INTEGER,
    default=LAST,
    minimum=0,
    maximum=LAST,
)


def run(inputs: Inputs, context: Context) -> Outputs:
    """Return a frame of a grid's simulation as geometry."""
    settings = context.app.state.settings
    frame = frame_of(inputs, FRAME.name)
    design = design_of(inputs, context.modelunits, settings)
    engine = inputs.text(ENGINE.name, "learned")
    (result,) = simulated([design.grid], engine, settings, context.cancel)
    warnings = qualities(result)
    bound = result.bound_mm
    return Outputs(
        {
            "Mesh": [meshes.mesh(meshes.surface(result, frame), frame, design)],
            "Flat": [meshes.mesh(meshes.surface(result, 0), 0, design, coloured=False)],
            "Joints": design.outside(result.centres[frame]),
            "Axes": meshes.axes(result, frame, design),
            "Ratios": result.grid.actuators.tolist(),
            "Bound": [] if bound is None else [design.placement.length(bound)],
            "Stable": [result.stable],
            "Collisions": [collision_text(one) for one in result.collisions],
            "Contacts": design.outside(_places(result, frame)),
            "Messages": [*warnings, *design.texts],
            "Grid": [as_json(design.grid)],
        },
        warnings=[*warnings, *design.warnings],
    )


def _places(result: Result, frame: int) -> NDArray[np.float64]:
    """Return where parts collide in a frame, (N, 3) mm."""
    met = [collision_place(result, one, frame) for one in result.collisions if one.first <= frame]
    return np.array(met).reshape(-1, 3)


COMPONENT = Component(
    "simulate",
    "Simulate",
    "The shape that a grid takes in hot water.",
    (*DRAWN, ENGINE, FRAME, MATERIAL),
    (
        MESHES,
        Output("Flat", "F", "The flat grid, pale.", MESH),
        Output("Joints", "J", "The centres of the joints in the frame.", POINT),
        Output("Axes", "X", "The axes of the beams in the frame.", CURVE),
        RATIOS,
        Output("Bound", "B", "Nine of ten such answers are less far off at the end.", NUMBER),
        Output("Stable", "S", "Whether every frame is a stable balance.", BOOLEAN),
        MESSAGES,
        GRID,
        Output("Collisions", "C", "Parts that run through each other, the deepest first.", TEXT),
        Output("Contacts", "Cp", "Where they do, those that have met by the frame.", POINT),
    ),
    run,
)
