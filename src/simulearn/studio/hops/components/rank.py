"""Rank: five single changes that bring a grid closest to where it is wanted."""

from simulearn.errors import InputError
from simulearn.inverse import rank, task_from_dict
from simulearn.studio.hops import meshes
from simulearn.studio.hops.components.shared import (
    LAST,
    as_json,
    qualities,
    simulated,
)
from simulearn.studio.hops.design import DRAWN, design_of
from simulearn.studio.hops.goals import GOALS, task_of
from simulearn.studio.hops.material import MATERIAL, held_by
from simulearn.studio.hops.parameters import CURVE, MESH, NUMBER, TEXT, Component, Output
from simulearn.studio.hops.solving import Context, Outputs
from simulearn.studio.hops.values import Inputs
from simulearn.studio.simulations import engine_of


def run(inputs: Inputs, context: Context) -> Outputs:
    """Return the best changes of a design, each with the design and shape it leads to."""
    settings = context.app.state.settings
    design = design_of(inputs, context.modelunits, settings)
    if len(design.grid.beams) > settings.rank_beams:
        text = (
            f"the grid has {len(design.grid.beams)} beams; "
            f"at most {settings.rank_beams} can be ranked here"
        )
        raise InputError(text, "too-large", "Curves")
    task = task_from_dict(task_of(inputs, design), materials=held_by(design.grid))
    ranking = rank(task, engine_of(task.engine), cancel=context.cancel)
    best = [design.changed(one.grid) for one in ranking.best]
    results = simulated([one.grid for one in best], task.engine, settings, context.cancel)
    shapes = [
        meshes.mesh(meshes.surface(r, LAST), LAST, d) for r, d in zip(results, best, strict=True)
    ]
    remarks = list(dict.fromkeys(text for result in results for text in qualities(result)))
    length = design.placement.length
    return Outputs(
        {
            "Error": [length(ranking.error_mm)],
            "Changes": [one.change.words for one in ranking.best],
            "Errors": [length(one.error_mm) for one in ranking.best],
            "Axes": {k: meshes.flat_axes(one) for k, one in enumerate(best)},
            "Ratios": {k: one.grid.actuators.tolist() for k, one in enumerate(best)},
            "Meshes": shapes,
            "Grids": [as_json(one.grid) for one in best],
            "Messages": [*design.texts, *remarks],
        },
        warnings=design.warnings,
    )


COMPONENT = Component(
    "rank",
    "Rank",
    "Five single changes that bring points of a grid closest to their targets.",
    (*DRAWN, *GOALS, MATERIAL),
    (
        Output("Error", "E", "How far the points are from their targets as it is.", NUMBER),
        Output("Changes", "C", "The suggestions in words, the best first.", TEXT),
        Output("Errors", "Es", "How far the points will be after each.", NUMBER),
        Output("Axes", "X", "The axes of each suggestion's beams, a branch for each.", CURVE),
        Output("Ratios", "R", "The actuators of these axes, a branch for each.", NUMBER),
        Output("Meshes", "M", "The shape of each suggestion.", MESH),
        Output("Grids", "G", "Each suggestion as JSON, in mm.", TEXT),
        Output("Messages", "Me", "All warnings, mends and what was left out.", TEXT),
    ),
    run,
)
