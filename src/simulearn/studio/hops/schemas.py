"""The JSON that Hops sends and reads, field by field as its classes have them.

Hops fills its classes from JSON and stops without a word where a list is null or a number is text.
So every field is always there, with a value of its type.
"""

from typing import Any

from pydantic import BaseModel, ConfigDict, Field

from simulearn.studio.hops.parameters import MOST, Component, Input, Output

CATEGORY, SUBCATEGORY = "SimuLearn", "Grids"


class _Schema(BaseModel):
    model_config = ConfigDict(extra="ignore", populate_by_name=True)


class Item(_Schema):
    """A value: the name of its class in .NET, and the value as JSON in a text."""

    type: str = ""
    data: Any


class Tree(_Schema):
    """The values of one parameter: lists by paths such as {0;1}."""

    name: str = Field(alias="ParamName")
    branches: dict[str, list[Item]] | None = Field(alias="InnerTree", default=None)


class Solve(_Schema):
    """A request to compute; older versions of Hops leave fields out."""

    absolutetolerance: float = 0.0
    angletolerance: float = 0.0
    modelunits: str | None = None
    dataversion: int = 7
    algo: str | None = None
    pointer: str | None = None
    cachesolve: bool = False
    recursionlevel: int = 0
    values: list[Tree] = []


def description(component: Component, icon: str) -> dict[str, Any]:
    """Return what Hops reads at the address of a component."""
    return io_schema(
        component.description,
        [_input(one) for one in component.inputs],
        [_output(one) for one in component.outputs],
        icon,
    )


def io_schema(
    text: str,
    inputs: list[dict[str, Any]],
    outputs: list[dict[str, Any]],
    icon: str,
    errors: list[str] | None = None,
) -> dict[str, Any]:
    """Return an IoResponseSchema; with errors, it stands for a component that there is not."""
    return {
        "Description": text,
        "CacheKey": "",
        "InputNames": [one["Name"] for one in inputs],
        "OutputNames": [one["Name"] for one in outputs],
        "Icon": icon,
        "Inputs": inputs,
        "Outputs": outputs,
        "Warnings": [],
        "Errors": errors or [],
    }


def entry(component: Component, icon: str) -> dict[str, Any]:
    """Return a component as Hops lists those of an address."""
    return {
        "Uri": f"/{component.path}",
        "Name": component.name,
        "Nickname": component.name,
        "Description": component.description,
        "Category": CATEGORY,
        "Subcategory": SUBCATEGORY,
        "Inputs": [_listed(one, one.least, one.most) for one in component.inputs],
        "Outputs": [_listed(one, 1, MOST) for one in component.outputs],
        "Icon": icon,
    }


def solved(
    request: Solve, values: list[dict[str, Any]], warnings: list[str], errors: list[str]
) -> dict[str, Any]:
    """Return the answer to a request: its own fields, and what came of it."""
    fields = request.model_dump(exclude={"values"})
    fields["modelunits"] = fields["modelunits"] or "Millimeters"
    for key in ("algo", "pointer"):
        fields[key] = fields[key] or ""
    return {**fields, "values": values, "warnings": warnings, "errors": errors}


def _input(one: Input) -> dict[str, Any]:
    return {
        "Name": one.name,
        "Nickname": one.nickname,
        "ParamType": one.kind.parameter,
        "Description": one.description,
        "AtLeast": one.least,
        "AtMost": one.most,
        "TreeAccess": False,
        "Default": one.default,
        "Minimum": one.minimum,
        "Maximum": one.maximum,
    }


def _output(one: Output) -> dict[str, Any]:
    return {"Name": one.name, "Nickname": one.nickname, "ParamType": one.kind.parameter}


def _listed(one: Input | Output, least: int, most: int) -> dict[str, Any]:
    return {
        "Name": one.name,
        "Nickname": one.nickname,
        "Description": one.description,
        "ParamType": one.kind.parameter,
        "ResultType": one.kind.type,
        "AtLeast": least,
        "AtMost": most,
        "TreeAccess": False,
    }
