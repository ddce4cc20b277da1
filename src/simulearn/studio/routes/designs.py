"""What a design is worth: validated, simulated, and its modifications ranked."""

import json
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

from fastapi import APIRouter, Request, Response

from simulearn.errors import Cancel, InputError, Message
from simulearn.grid import Grid, Validation, grid_from_dict, grid_to_dict, validate
from simulearn.interop import frames
from simulearn.inverse import Suggestion, rank, task_from_dict
from simulearn.material import Material, load_material, materials_of
from simulearn.simulate import Failure, Outcome, outcome_to_dict
from simulearn.simulate.engines import in_order
from simulearn.simulate.scatter import prints_source, scattered
from simulearn.simulate.simulator import Simulator
from simulearn.studio.answers import RankAnswer, SimulateAnswer, ValidationAnswer
from simulearn.studio.bodies import (
    GridAlone,
    JsonRoute,
    SimulateBody,
    TaskBody,
    json_response,
    parted,
)
from simulearn.studio.problems import Problem
from simulearn.studio.settings import Settings
from simulearn.studio.simulations import Simulations, engine_of

NO_GRID = Grid([], [], [], 0)  # stands for what could not be read as one
RANKING = ("learned", "beams")  # engines that are quick enough for hundreds of designs
BUSY: dict[int | str, Any] = {429: {"description": "Too many are waiting; see Retry-After."}}

router = APIRouter(route_class=JsonRoute, tags=["designs"])


@router.post("/api/validate", response_model=ValidationAnswer)
def validate_(grid: GridAlone) -> Response:
    """Return what forbids a design and what is unusual about it, as `simulearn validate --json`.

    An object that is no grid has an answer, too: its error says why.
    """
    if not isinstance(grid, dict):
        raise Problem(422, "grid-file", "the body is not an object; it is a grid", "body")
    try:
        data, materials = parted(grid)
        design = grid_from_dict(data, materials=materials)
        report = validate(design, load_material(design.material))
    except InputError as error:
        report = Validation((Message(error.code, error.where or "grid", str(error)),), ())
    return json_response(report.to_dict())


@router.post("/api/simulate", response_model=SimulateAnswer, responses=BUSY | frames.IN_RESPONSES)
async def simulate(body: SimulateBody, request: Request) -> Response:
    """Return the outcome of each design: twelve frames, or why there are none.

    A design that fails, or is no grid at all, does not take others with it. Where the Accept
    header names their media type, the frames come as binary numbers.
    """
    state = request.app.state
    simulations: Simulations = state.simulations
    binary = frames.MEDIA_TYPE in request.headers.get("accept", "")
    work = partial(_simulated, body, state.settings, binary)
    content = await simulations.run(request, work)
    media_type = frames.MEDIA_TYPE if binary else "application/json"
    return Response(content, media_type=media_type, headers={"Vary": "Accept"})


@router.post("/api/rank", response_model=RankAnswer, responses=BUSY)
async def rank_(task: TaskBody, request: Request) -> Response:
    """Return every single modification of a task's design, the best first, and five that differ."""
    state = request.app.state
    simulations: Simulations = state.simulations
    return await simulations.run(request, partial(_ranked, task, state.settings))


def _simulated(body: SimulateBody, settings: Settings, binary: bool, cancel: Cancel) -> str | bytes:
    """Return the answer to a request for simulations."""
    engine = engine_of(body.engine, body.model)
    grids, outcomes = _read(body.grids, settings, materials_of(body.materials))
    left = [k for k in range(len(grids)) if k not in outcomes]
    if sum(len(grids[k].beams) for k in left) > settings.beams_in_all:
        text = f"the grids have more than {settings.beams_in_all} beams in all; send fewer at once"
        raise InputError(text, "too-large", "grids")
    if body.prints and len(grids) > 1:
        raise InputError(
            "prints are drawn of one grid at once; send one", "too-many-grids", "grids"
        )
    if body.engine == "fea" and left:
        check_fea([grids[k] for k in left], settings)
    answers = engine.simulate([grids[k] for k in left], cancel=cancel)
    if body.prints:
        answers = [_spread(one, body.prints, engine, settings, cancel) for one in answers]
    outcomes.update(zip(left, answers, strict=True))
    in_place = in_order(iter(outcomes.items()), len(grids))
    if binary:
        return frames.to_bytes(grids, in_place)
    return json.dumps({"results": [outcome_to_dict(one) for one in in_place]}, allow_nan=False)


def _spread(
    outcome: Outcome, most: int, engine: Simulator, settings: Settings, cancel: Cancel
) -> Outcome:
    """Return a result together with how prints of its design differ; a failure as it is.

    Raises:
        InputError: the material has no scatter, or so many prints take too long.
    """
    if isinstance(outcome, Failure):
        return outcome
    beams = len(outcome.grid.beams)
    if beams > settings.rank_beams:
        text = f"the grid has {beams} beams; prints of at most {settings.rank_beams} are drawn here"
        raise InputError(text, "too-large", "grid")
    source = prints_source(load_material(outcome.grid.material), engine)
    if source.engine != "learned":
        check_fea([outcome.grid], settings)
    return scattered(outcome, min(most, source.count), engine=engine, cancel=cancel)


def _read(
    entries: Sequence[Any], settings: Settings, materials: Mapping[str, Material]
) -> tuple[list[Grid], dict[int, Outcome]]:
    """Return the grids of a request, and the outcome of each that will not be simulated."""
    if len(entries) > settings.grids:
        text = f"grids has {len(entries)} entries; at most {settings.grids} are taken at once"
        raise InputError(text, "too-many-grids", "grids")
    grids: list[Grid] = []
    outcomes: dict[int, Outcome] = {}
    for k, entry in enumerate(entries):
        try:
            grids.append(grid_from_dict(entry, materials=materials))
            check_size(grids[k], settings)
        except InputError as error:
            grids[k:] = [NO_GRID]
            outcomes[k] = Failure.of(NO_GRID, error)
    return grids, outcomes


def check_size(grid: Grid, settings: Settings) -> None:
    """Raise InputError where a grid is larger than a server takes."""
    for what, count, most in (
        ("joints", len(grid.joints), settings.joints),
        ("beams", len(grid.beams), settings.beams),
    ):
        if count > most:
            text = f"the grid has {count} {what}; at most {most} are taken here"
            raise InputError(text, "too-large", "grid")


def check_fea(grids: Sequence[Grid], settings: Settings) -> None:
    """Raise InputError where finite elements take too long for somebody to wait."""
    if len(grids) > 1 or len(grids[0].beams) > settings.fea_beams:
        text = (
            f"finite elements answer one grid of at most {settings.fea_beams} beams at once; "
            "POST /api/fea takes more"
        )
        raise InputError(text, "too-large", "grids")


def _ranked(data: Any, settings: Settings, cancel: Cancel) -> Response:
    """Return the answer to a request for a ranking."""
    data, materials = parted(data)
    task = task_from_dict(data, materials=materials)
    if task.engine not in RANKING:
        text = f'engine "{task.engine}" does not rank here; those that do are {", ".join(RANKING)}'
        raise InputError(text, "engine-unknown", "engine")
    if len(task.start.beams) > settings.rank_beams:
        text = f"the grid has {len(task.start.beams)} beams; at most {settings.rank_beams} can be "
        raise InputError(text + "ranked here", "too-large", "grid")
    ranking = rank(task, engine_of(task.engine), cancel=cancel)
    return json_response(
        {
            "material": load_material(ranking.grid.material).identity.model_dump(),
            "error_mm": ranking.error_mm,
            "points": ranking.points.tolist(),
            "best": [_suggestion(one) for one in ranking.best],
            "suggestions": [_modification(one) for one in ranking.suggestions],
        }
    )


def _modification(one: Suggestion) -> dict[str, Any]:
    return {
        "words": one.change.words,
        "part": one.change.part,
        "indices": list(one.change.indices),
        "error_mm": one.error_mm,
        "moved_mm": one.moved_mm,
    }


def _suggestion(one: Suggestion) -> dict[str, Any]:
    return {
        **_modification(one),
        "grid": grid_to_dict(one.grid),
        "points": one.points.tolist(),
    }
