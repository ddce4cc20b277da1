"""Optimise: begins a search for a design that comes where it is wanted, or finds the one begun."""

from functools import partial

from simulearn.inverse import task_from_dict
from simulearn.studio.hops.design import DRAWN, design_of
from simulearn.studio.hops.goals import GOALS, task_of
from simulearn.studio.hops.material import MATERIAL, held_by
from simulearn.studio.hops.parameters import NUMBER, TEXT, Component, Input, Output
from simulearn.studio.hops.searches import Searches
from simulearn.studio.hops.solving import Context, Outputs
from simulearn.studio.hops.values import Inputs
from simulearn.studio.jobs import Jobs
from simulearn.studio.routes.jobs import checked, search

SECONDS = Input(
    "Seconds",
    "S",
    "How long to search and check.",
    NUMBER,
    default=30.0,
    minimum=1,
    maximum=600,
)


def run(inputs: Inputs, context: Context) -> Outputs:
    """Begin a search, unless the same one was begun before."""
    state = context.app.state
    design = design_of(inputs, context.modelunits, state.settings)
    data = task_of(inputs, design)
    data["limits"] = {"seconds": inputs.number(SECONDS.name, float(SECONDS.default or 0))}
    task = checked(task_from_dict(data, materials=held_by(design.grid)), state.settings)
    jobs: Jobs = state.jobs
    searches: Searches = state.searches
    begin = partial(jobs.start, "optimize", partial(search, task, state.simulations))
    job = searches.start({**data, "design": design.grid.digest}, design, begin)
    values = {"Job": [job.id], "State": [job.state], "Messages": design.texts}
    # The same inputs are asked about again, so that a job that is gone is begun anew.
    return Outputs(values, warnings=design.warnings, finished=False)


COMPONENT = Component(
    "optimise",
    "Optimise",
    "Begins a search for a grid whose points come to their targets. Poll shows how far it is.",
    (*DRAWN, *GOALS, SECONDS, MATERIAL),
    (
        Output("Job", "J", "The name of the search, for Poll.", TEXT),
        Output("State", "S", "queued, running, done, failed or cancelled.", TEXT),
        Output("Messages", "M", "Mends and what was left out.", TEXT),
    ),
    run,
)
