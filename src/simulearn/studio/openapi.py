"""The description of the API at /openapi.json: what each request can be refused for, too."""

from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi

from simulearn import __version__
from simulearn.studio.problems import MEDIA_TYPE, ProblemBody

ALWAYS = {400: "The request is not well-formed, or names another host."}
CHANGING = {403: "A page of another site asks for a change."}
WITH_BODY = {
    413: "The body is too large.",
    415: "The body is not of the type that is read here.",
    422: "The input is wrong, or has no answer; `code`, `where` and `errors` say what and where.",
}
REFERENCE = "#/components/schemas/ProblemBody"


def describe(app: FastAPI) -> dict[str, Any]:
    """Return the description of an application's API (OpenAPI 3.1)."""
    api = get_openapi(
        title="SimuLearn studio",
        version=__version__,
        summary="The shape a flat 4D-printed grid takes in hot water.",
        routes=app.routes,
    )
    schemas = api.setdefault("components", {}).setdefault("schemas", {})
    for unused in ("HTTPValidationError", "ValidationError"):  # of the framework
        schemas.pop(unused, None)
    problem = ProblemBody.model_json_schema(ref_template="#/components/schemas/{model}")
    schemas.update(problem.pop("$defs"))
    schemas["ProblemBody"] = problem
    for path in api["paths"].values():
        for method, operation in path.items():
            _add_problems(method, operation)
    return api


def _add_problems(method: str, operation: dict[str, Any]) -> None:
    """Add to an operation what every one of its kind can be refused for."""
    responses = operation["responses"]
    common = dict(ALWAYS)
    if method in ("post", "put", "patch", "delete"):
        common |= CHANGING
    if "requestBody" in operation:
        common |= WITH_BODY
    for status, words in common.items():
        known = responses.setdefault(str(status), {"description": words})
        if known["description"] == "Validation Error":  # the framework's words
            known["description"] = words
    for status, response in responses.items():
        if int(status) >= 400:
            response["content"] = {MEDIA_TYPE: {"schema": {"$ref": REFERENCE}}}
    operation["responses"] = dict(sorted(responses.items()))
