"""Validate: what forbids a design, what is unusual about it, and where."""

from simulearn.grid import validate
from simulearn.material import load_material
from simulearn.studio.hops.components.shared import (
    AXES,
    GRID,
    JOINTS,
    MESSAGES,
    RATIOS,
    mended,
    texts,
)
from simulearn.studio.hops.design import DRAWN, Remark, design_of
from simulearn.studio.hops.material import MATERIAL
from simulearn.studio.hops.parameters import BOOLEAN, POINT, Component, Output
from simulearn.studio.hops.solving import Context, Outputs
from simulearn.studio.hops.values import Inputs


def run(inputs: Inputs, context: Context) -> Outputs:
    """Return whether a design is valid, with all messages."""
    design = design_of(inputs, context.modelunits, context.app.state.settings, loud=True)
    report = validate(design.grid, load_material(design.grid.material))
    found = [
        Remark(message.message, design.place(message.where))
        for message in (*report.errors, *report.warnings)
    ]
    remarks = [*found, *design.remarks]
    return Outputs(
        {
            "Valid": [report.valid],
            "Messages": [one.text for one in remarks],
            "Places": design.points([one.place for one in remarks]),
            "Joints": design.points(design.grid.joints.tolist()),
            **mended(design),
        },
        warnings=[*texts(report.warnings), *design.warnings],
        errors=texts(report.errors),
    )


COMPONENT = Component(
    "validate",
    "Validate",
    "Says whether a grid can be printed and simulated, and where what is wrong lies.",
    (*DRAWN, MATERIAL),
    (
        Output("Valid", "V", "Whether there is no error.", BOOLEAN),
        MESSAGES,
        Output("Places", "P", "Where each message belongs; else the middle of the grid.", POINT),
        JOINTS,
        AXES,
        RATIOS,
        GRID,
    ),
    run,
)
