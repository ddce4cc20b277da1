"""What a component takes and gives, in the words of Grasshopper."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

MOST = 2**31 - 1  # of an int in C#; a list that may be any length


@dataclass(frozen=True)
class Kind:
    """A kind of value.

    Attributes:
        parameter: its name in Grasshopper.
        type: the name of its class in .NET.
    """

    parameter: str
    type: str


BOOLEAN = Kind("Boolean", "System.Boolean")
CURVE = Kind("Curve", "Rhino.Geometry.PolylineCurve")
INTEGER = Kind("Integer", "System.Int32")
MESH = Kind("Mesh", "Rhino.Geometry.Mesh")
NUMBER = Kind("Number", "System.Double")
POINT = Kind("Point", "Rhino.Geometry.Point3d")
TEXT = Kind("Text", "System.String")


@dataclass(frozen=True)
class Input:
    """An input of a component.

    Attributes:
        name: of the input.
        nickname: short name, which the component shows.
        description: for people.
        kind: of its values.
        least: how many values it takes; 0 makes it optional.
        most: how many at most; 1 and 1 is a single value, all else a list.
        default: of a single value.
        minimum: of a number.
        maximum: of a number.
    """

    name: str
    nickname: str
    description: str
    kind: Kind
    least: int = 1
    most: int = 1
    default: float | str | None = None
    minimum: float | None = None
    maximum: float | None = None


@dataclass(frozen=True)
class Output:
    """An output of a component: its names, what it is, and the kind of its values."""

    name: str
    nickname: str
    description: str
    kind: Kind


@dataclass(frozen=True, eq=False)
class Component:
    """A component that Hops can show.

    Attributes:
        path: below the address of all components.
        name: for people.
        description: for people.
        inputs: what it takes; one run is made for each branch of the first.
        outputs: what it gives.
        run: computes the outputs of one branch; see `solving`.
    """

    path: str
    name: str
    description: str
    inputs: tuple[Input, ...]
    outputs: tuple[Output, ...]
    run: Callable[..., Any]
