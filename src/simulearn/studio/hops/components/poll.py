"""Poll: how far a search is, and its best design so far."""

import json
from typing import Any

from simulearn.errors import ComputationError, InputError
from simulearn.grid import grid_from_dict
from simulearn.studio.hops import meshes
from simulearn.studio.hops.components.shared import (
    AXES,
    GRID,
    LAST,
    MESHES,
    MESSAGES,
    RATIOS,
    mended,
    qualities,
    simulated,
)
from simulearn.studio.hops.parameters import NUMBER, TEXT, Component, Input, Output
from simulearn.studio.hops.searches import Searches
from simulearn.studio.hops.solving import Context, Outputs
from simulearn.studio.hops.values import Inputs
from simulearn.studio.jobs import Job, Jobs
from simulearn.studio.problems import Problem

JOB = Input("Job", "J", "The name of a search, from Optimise.", TEXT)


def run(inputs: Inputs, context: Context) -> Outputs:
    """Return the state of a search and its best design."""
    name = inputs.text(JOB.name)
    jobs: Jobs = context.app.state.jobs
    searches: Searches = context.app.state.searches
    start = searches.design(name)
    job = jobs.get(name)
    finished, state, problem = job.finished, job.state, job.problem
    best = _best(job)
    values: dict[str, Any] = {one.name: [] for one in COMPONENT.outputs}
    values |= {"State": [state], "Progress": [1.0 if finished else _share(job)]}
    warnings: list[str] = []
    if best is not None:
        design = start.changed(grid_from_dict(best["grid"]))
        values["Error"] = [design.placement.length(best["error_mm"])]
        values |= mended(design)
        warnings += [one["message"] for one in best.get("warnings", ())]
        if best.get("why_no_fea"):
            warnings.append(f"not checked by finite elements: {best['why_no_fea']}")
        try:
            settings = context.app.state.settings
            (result,) = simulated([design.grid], "learned", settings, context.cancel)
        except (InputError, ComputationError) as error:
            warnings.append(f"no mesh: {error}")
        else:
            values["Mesh"] = [meshes.mesh(meshes.surface(result, LAST), LAST, design)]
            warnings += qualities(result)
    values["Messages"] = list(dict.fromkeys(warnings))
    errors = [_why(problem)] if problem is not None else []
    return Outputs(values, values["Messages"], errors, finished)


def _best(job: Job) -> dict[str, Any] | None:
    """Return the best design so far, in the words of its step or of the result."""
    answer, steps = job.answer, job.steps
    if answer is not None:
        return dict(json.loads(answer.result))
    return dict(json.loads(steps[-1])) if steps else None


def _share(job: Job) -> float:
    done, total = job.progress or (0, 1)
    return done / total


def _why(problem: Problem) -> str:
    return str(problem.detail)


COMPONENT = Component(
    "poll",
    "Poll",
    "How far a search is, and its best grid so far. Recompute it, or attach a timer.",
    (JOB,),
    (
        Output("State", "S", "queued, running, done, failed or cancelled.", TEXT),
        Output("Progress", "P", "0 to 1.", NUMBER),
        Output("Error", "E", "How far the points are from their targets.", NUMBER),
        AXES,
        RATIOS,
        MESHES,
        MESSAGES,
        GRID,
    ),
    run,
)
