"""A request to compute: one run for each branch of the first input, and an answer of all."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from fastapi import FastAPI

from simulearn.errors import Cancel, CancelledError, ComputationError, InputError
from simulearn.studio.hops import archives
from simulearn.studio.hops.parameters import Component
from simulearn.studio.hops.schemas import Solve, solved
from simulearn.studio.hops.values import Inputs, Path, branches, path_text, tree
from simulearn.studio.problems import Problem

MOST_MESSAGES = 20  # messages of one kind in a balloon


@dataclass(frozen=True)
class Context:
    """What a run knows besides its inputs.

    Attributes:
        app: the studio.
        modelunits: name of the model's unit in Rhino; None where an old version says none.
        cancel: set when the run shall end.
    """

    app: FastAPI
    modelunits: str | None
    cancel: Cancel


@dataclass(frozen=True)
class Outputs:
    """What a run gives.

    Attributes:
        values: by name of the output: a list, or lists by number, each a branch of its own.
        warnings: for the component's balloon.
        errors: the same, where there are values all the same.
        finished: whether the same inputs will always give the same.
    """

    values: Mapping[str, Any]
    warnings: Sequence[str] = ()
    errors: Sequence[str] = ()
    finished: bool = True


@dataclass
class Answer:
    """An answer, and its status in HTTP."""

    status: int
    body: dict[str, Any]


@dataclass
class _Sum:
    """What the runs have come to."""

    outputs: dict[Path, Outputs] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)
    problem: Problem | None = None


def solve(component: Component, request: Solve, app: FastAPI, cancel: Cancel) -> Answer:
    """Return the answer to a request.

    Hops keeps an answer with status 200 and does not ask again; so one that may change, such as
    the state of a search, has another one.

    Raises:
        Problem: no run has an answer.
        CancelledError: the token was set.
    """
    archives.library()  # nothing can be answered without it
    context = Context(app, request.modelunits, cancel)
    runs = branches(request.values, component.inputs[0].name)
    most = app.state.settings.grids
    if len(runs) > most:
        text = f"{component.inputs[0].name} has {len(runs)} branches; at most {most} are taken"
        raise Problem(422, "too-many-branches", text, component.inputs[0].name)
    done = _Sum(warnings=_unknown(component, request))
    for path, inputs in runs.items():
        _run(
            component, path, inputs, context, done, f"{path_text(path)}: " if len(runs) > 1 else ""
        )
    if done.problem is not None and not done.outputs:
        problem, texts = done.problem, bounded(done.errors)
        raise Problem(
            problem.status_code,
            problem.code,
            problem.detail,
            problem.where,
            more={"messages": texts},
        )
    values = [tree(one.name, _tree(one.name, done.outputs), one.kind) for one in component.outputs]
    settled = all(one.finished for one in done.outputs.values()) and done.problem is None
    body = solved(request, values, bounded(done.warnings), bounded(done.errors))
    return Answer(200 if settled else 202, body)


def _unknown(component: Component, request: Solve) -> list[str]:
    """Return what is said of values that no input takes."""
    names = [one.name for one in component.inputs]
    return [
        f"{component.name} has no input {one.name[:40]}; its inputs are {', '.join(names)}"
        for one in request.values
        if one.name not in names
    ]


def bounded(messages: Sequence[str]) -> list[str]:
    """Return messages without repetitions, the first of many."""
    different = list(dict.fromkeys(messages))
    left = len(different) - MOST_MESSAGES
    return different[:MOST_MESSAGES] + ([f"and {left} more"] if left > 0 else [])


def _run(
    component: Component, path: Path, inputs: Inputs, context: Context, done: _Sum, head: str
) -> None:
    try:
        outputs = component.run(inputs, context)
    except CancelledError:
        raise
    except (InputError, ComputationError) as error:
        done.problem = Problem.of(error)
    except Problem as problem:
        done.problem = problem
    else:
        done.outputs[path] = outputs
        done.warnings += [head + text for text in outputs.warnings]
        done.errors += [head + text for text in outputs.errors]
        return
    texts = [one.message for one in done.problem.errors] or [str(done.problem.detail)]
    done.errors += [head + text for text in texts]


def _tree(name: str, runs: Mapping[Path, Outputs]) -> dict[Path, Sequence[Any]]:
    """Return the values of an output by the paths of its branches."""
    found: dict[Path, Sequence[Any]] = {}
    for path, outputs in runs.items():
        values = outputs.values[name]
        if isinstance(values, Mapping):
            found |= {(*path, k): part for k, part in values.items()}
        else:
            found[path] = values
    return found
