"""Jobs: searches and checks by finite elements, which are begun, asked about, and cancelled."""

import json
from dataclasses import replace
from functools import partial
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Path, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from simulearn.errors import InputError
from simulearn.grid import Grid, grid_from_dict, grid_to_dict
from simulearn.grid.gridfile import GridFile
from simulearn.interop import frames
from simulearn.inverse import SearchResult, Step, Task, optimize, search_figures, task_from_dict
from simulearn.inverse.methods import method
from simulearn.inverse.space import Space
from simulearn.material import materials_of
from simulearn.simulate import Failure, Outcome, Result, outcome_to_dict
from simulearn.studio.bodies import (
    GridBody,
    JsonRoute,
    OwnMaterials,
    TaskBody,
    json_response,
    parted,
)
from simulearn.studio.jobs import Answer, Job, Jobs
from simulearn.studio.problems import Problem, ProblemBody
from simulearn.studio.routes.designs import check_size
from simulearn.studio.settings import Settings
from simulearn.studio.simulations import Simulations, engine_of

MOST_GRIDS = 16  # of a check, whose stresses stay in memory until all are done
MOST_ITERATIONS = 10_000  # of a search, whose steps are all kept
MOST_STEPS = 1000  # in one answer
QUICK = ("learned", "beams")  # engines that can simulate a design once more in a moment
BUSY: dict[int | str, Any] = {429: {"description": "Too many jobs are waiting; see Retry-After."}}
UNKNOWN: dict[int | str, Any] = {404: {"description": "There is no such job, or none any more."}}

JobName = Annotated[str, Path(description="as the beginning of the job answered", max_length=64)]

router = APIRouter(route_class=JsonRoute, tags=["jobs"])


class FeaBody(BaseModel):
    """Designs to simulate by finite elements."""

    model_config = ConfigDict(strict=True, extra="forbid")

    grids: Annotated[list[GridBody], Field(min_length=1, max_length=MOST_GRIDS)]
    materials: OwnMaterials = []


class JobBegun(BaseModel):
    """The name of a job."""

    job: str


class JobProgress(BaseModel):
    """How far a job is: frames of a check, per cent of the limits of a search."""

    done: int
    total: int


class JobStep(BaseModel):
    """A step of a search and the best design so far; mm, s."""

    iteration: int
    phase: int
    seconds: float
    designs: int
    error_mm: float
    words: str
    grid: GridFile


class JobAnswer(BaseModel):
    """How far a job is, and what came of it."""

    job: str
    kind: Literal["optimize", "fea"]
    state: Literal["queued", "running", "done", "failed", "cancelled"]
    progress: JobProgress | None
    steps: list[JobStep]
    seconds: float
    result: Annotated[dict[str, Any] | None, Field(description="once the job is finished")]
    problem: Annotated[ProblemBody | None, Field(description="why the job failed")]


@router.post("/api/optimize", status_code=202, response_model=JobBegun, responses=BUSY)
def optimize_(task: TaskBody, request: Request) -> Response:
    """Begin a search for a design that comes where it is wanted, as `simulearn optimize`."""
    state = request.app.state
    data, materials = parted(task)
    wanted = checked(task_from_dict(data, materials=materials), state.settings)
    return _begun(state.jobs.start("optimize", partial(search, wanted, state.simulations)))


@router.post("/api/fea", status_code=202, response_model=JobBegun, responses=BUSY)
def fea(body: FeaBody, request: Request) -> Response:
    """Begin to simulate designs by finite elements."""
    state = request.app.state
    materials = materials_of(body.materials)
    grids = []
    for k, entry in enumerate(body.grids):
        try:
            grids.append(grid_from_dict(entry, materials=materials))
            check_size(grids[k], state.settings)
        except InputError as error:
            where = f"grids[{k}]" + (f", {error.where}" if error.where else "")
            raise InputError(f"grids[{k}]: {error}", error.code, where, error.messages) from error
    return _begun(state.jobs.start("fea", partial(_simulate, grids)))


@router.get("/api/jobs/{name}", response_model=JobAnswer, responses=UNKNOWN)
def job(
    name: JobName,
    request: Request,
    since: Annotated[int, Query(ge=0, description="how many steps are known already")] = 0,
) -> Response:
    """Return how far a job is, the steps that are new, and its result once it is finished."""
    jobs: Jobs = request.app.state.jobs
    return _described(jobs.get(name), since)


@router.delete("/api/jobs/{name}", response_model=JobAnswer, responses=UNKNOWN)
def cancel(name: JobName, request: Request) -> Response:
    """Stop a job; a search then has its best design so far as its result."""
    jobs: Jobs = request.app.state.jobs
    stopped = jobs.cancel(name)
    return _described(stopped, len(stopped.steps))


@router.get(
    "/api/jobs/{name}/frames",
    responses=UNKNOWN | frames.IN_RESPONSES | {409: {"description": "There are none yet."}},
    response_class=Response,
)
def job_frames(name: JobName, request: Request) -> Response:
    """Return the shapes of a job as binary numbers.

    Those of a check are its designs' in their order; those of a search are of its best design, by
    the engine and by finite elements.
    """
    jobs: Jobs = request.app.state.jobs
    answer = jobs.get(name).answer
    if answer is None or answer.frames is None:
        raise Problem(409, "no-frames", "the job has no shapes, or none yet", "id")
    return Response(answer.frames, media_type=frames.MEDIA_TYPE)


def _begun(job: Job) -> Response:
    response = json_response({"job": job.id})
    response.status_code = 202
    response.headers["Location"] = f"/api/jobs/{job.id}"
    return response


def _described(job: Job, since: int) -> Response:
    """Return a job as JSON, put together from parts that are JSON already."""
    state = job.state  # first: what a final state promises is there before it
    progress = job.progress
    head = {
        "job": job.id,
        "kind": job.kind,
        "state": state,
        "progress": progress and {"done": progress[0], "total": progress[1]},
        "seconds": round(job.took, 3),
        "problem": job.problem and json.loads(bytes(job.problem.response().body)),
    }
    steps = b", ".join(job.steps[since : since + MOST_STEPS])
    result = job.answer.result if job.answer is not None and job.finished else b"null"
    content = json.dumps(head, allow_nan=False).encode()[:-1]
    content += b', "steps": [' + steps + b'], "result": ' + result + b"}"
    return Response(content, media_type="application/json", headers={"Cache-Control": "no-store"})


def checked(task: Task, settings: Settings) -> Task:
    """Return a task that can be searched for here.

    Raises:
        InputError: its design is not valid or too large, nothing may change, its method or engine
            is not known, or its limits are beyond the server's.
    """
    check_size(task.start, settings)
    engine_of(task.engine)
    method(task.method)
    Space.of(task.start, task.free)
    limits = task.limits
    most = {"seconds": settings.job_seconds, "iterations": MOST_ITERATIONS}
    most["seconds"] *= limits.seconds / limits.seconds_in_all
    for name, limit in most.items():
        given = getattr(limits, name)
        if given > limit:
            text = f"limits.{name} is {given:g}; at most {limit:g} can be had here"
            raise InputError(text, "task", f"limits.{name}")
    return task


def search(task: Task, simulations: Simulations, job: Job) -> Answer:
    """Search, and describe what was found."""
    start, limits = task.start, task.limits

    def note(step: Step) -> None:
        job.add_step({**step.row(), "grid": grid_to_dict(step.grid(start))})
        counted = 0.0 if limits.answers > 1 else step.iteration / limits.iterations
        share = max(counted, step.seconds / limits.seconds_in_all)
        job.report(min(100, round(100 * share)), 100)

    simulations.warm()
    engine = engine_of(task.engine)
    found = optimize(task, engine, progress=note, cancel=job)
    result = {"grid": grid_to_dict(found.grid), **search_figures(task, found)}
    outcomes = _shapes(task, found)
    return Answer(
        result=json.dumps(result, allow_nan=False).encode(),
        frames=frames.to_bytes([found.grid] * 2, outcomes),
        partial=found.interrupted,
    )


def _shapes(task: Task, found: SearchResult) -> list[Outcome]:
    """Return the best design's shapes, by the engine and by finite elements."""
    check, grid = found.check, found.grid
    why = "the search was stopped before its best design was simulated by finite elements"
    if check is not None and check.error_fea_mm is None:
        why = check.why
    no_fea = Failure(grid, "not-checked", "", why)
    own: Outcome | None = check.result if check is not None else None
    if own is None and task.engine in QUICK:
        (own,) = engine_of(task.engine).simulate([grid])
    fea: Outcome | None = check.fea if check is not None else None
    return [own or Failure(grid, "no-shape", "", "the engine's shape is not known"), fea or no_fea]


def _simulate(grids: list[Grid], job: Job) -> Answer:
    """Simulate designs by finite elements, and describe the outcomes."""
    outcomes: dict[int, Outcome] = {}
    for k, outcome in engine_of("fea").stream(grids, job.report, job):
        if isinstance(outcome, Result):  # its mesh is not part of the answer
            outcome = replace(outcome, solid=None, displacements=None)
        outcomes[k] = outcome
    in_place = [outcomes[k] for k in range(len(grids))]
    result = {"results": [outcome_to_dict(outcome) for outcome in in_place]}
    return Answer(json.dumps(result, allow_nan=False).encode(), frames.to_bytes(grids, in_place))
