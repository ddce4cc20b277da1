"""Surfaces from heights over a rectangle: an expression in x and y, or a table.

An expression is read as Python would read it and then computed piece by piece, so that it can hold
nothing but numbers, x, y and the functions named here.
"""

import ast
import operator
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.surfaces.surface import Surface

Array = NDArray[np.float64]

MOST_LETTERS = 1000  # of an expression
MOST_POINTS = 700  # along a side
USUAL_POINTS = 201  # along a side
FUNCTIONS: dict[str, tuple[Callable[..., Any], int]] = {  # and how many arguments
    **{name: (getattr(np, name), 1) for name in ("sin", "cos", "tan", "sinh", "cosh", "tanh")},
    **{name: (getattr(np, f"arc{name[1:]}"), 1) for name in ("asin", "acos", "atan")},
    **{name: (getattr(np, name), 1) for name in ("sqrt", "exp", "log", "abs", "sign", "floor")},
    "atan2": (np.arctan2, 2),
    "hypot": (np.hypot, 2),
    "min": (np.minimum, 2),
    "max": (np.maximum, 2),
}
CONSTANTS = {"pi": np.pi, "e": np.e}
OPERATORS: dict[type, Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
}
KNOWN = f"it may hold numbers, x, y, pi, + - * / **, and {', '.join(FUNCTIONS)}"


def surface_of_heights(
    heights: str | Sequence[Sequence[float]] | Array,
    x: tuple[float, float],
    y: tuple[float, float],
    step: float | None = None,
) -> Surface:
    """Return the surface z = f(x, y) over a rectangle, seen from above its outside.

    Args:
        heights: an expression such as "20*sin(x/30)", in mm, or a table (rows of y, columns of x),
            whose first row is at the least y.
        x: from where to where the rectangle reaches, mm.
        y: likewise.
        step: of the points between which an expression is straight, mm; a 200th of the longer side
            if not given.

    Raises:
        InputError: the expression cannot be computed, a height is no finite number, or the
            rectangle is none.
    """
    for name, (low, high) in (("x", x), ("y", y)):
        if not low < high:
            text = f"{name} reaches from {low:g} to {high:g}; the second is the larger one"
            raise InputError(text, "surface-heights", name)
    if not isinstance(heights, str):
        rows, columns = _table(heights).shape
    else:
        longer = max(x[1] - x[0], y[1] - y[0])
        step = step or longer / (USUAL_POINTS - 1)
        columns, rows = (max(2, round((high - low) / step) + 1) for low, high in (x, y))
        if max(rows, columns) > MOST_POINTS:
            text = f"step is {step:g}; a side has at most {MOST_POINTS} points"
            raise InputError(text, "surface-heights", "step")
    u, v = np.meshgrid(np.linspace(*x, columns), np.linspace(*y, rows))
    z = computed(heights, u, v) if isinstance(heights, str) else _table(heights)
    k = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = k[:-1, :-1], k[:-1, 1:], k[1:, 1:], k[1:, :-1]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    return Surface(np.stack([u, v, z], axis=-1).reshape(-1, 3), faces)


def computed(expression: str, x: Array, y: Array) -> Array:
    """Return an expression at places x, y (...).

    Raises:
        InputError: it cannot be read or holds what it may not, or has no finite value somewhere.
    """
    if len(expression) > MOST_LETTERS:
        text = f"heights have {len(expression)} letters; at most {MOST_LETTERS} are read"
        raise InputError(text, "surface-heights", "heights")
    try:
        tree = ast.parse(expression.strip(), mode="eval")
        with np.errstate(all="ignore"):
            z = np.broadcast_to(_value(tree.body, {"x": x, "y": y} | CONSTANTS), x.shape)
    except SyntaxError as error:
        text = f'heights are "{expression[:60]}", which cannot be read: {error.msg}'
        raise InputError(text, "surface-heights", "heights") from error
    except (ValueError, RecursionError, MemoryError) as error:
        if isinstance(error, InputError):
            raise
        text = "heights cannot be read: the expression is nested too deeply or holds odd letters"
        raise InputError(text, "surface-heights", "heights") from error
    wrong = ~np.isfinite(z)
    if wrong.any():
        k = int(wrong.argmax())
        place = f"x = {x.flat[k]:g}, y = {y.flat[k]:g}"
        text = f'heights "{expression[:60]}" have no finite value at {place}'
        raise InputError(text, "surface-heights", "heights")
    return z.astype(np.float64)


def _value(node: ast.expr, names: dict[str, Any]) -> Any:
    match node:
        case ast.Constant(value=float() | int() as number) if not isinstance(number, bool):
            return np.float64(min(number, 1e300) if isinstance(number, int) else number)
        case ast.Name(id=name) if name in names:
            return names[name]
        case ast.BinOp(op=op) if type(op) in OPERATORS:
            return OPERATORS[type(op)](_value(node.left, names), _value(node.right, names))
        case ast.UnaryOp(op=op) if type(op) in OPERATORS:
            return OPERATORS[type(op)](_value(node.operand, names))
        case ast.Call(func=ast.Name(id=name), keywords=[]) if name in FUNCTIONS:
            function, many = FUNCTIONS[name]
            if len(node.args) == many:
                return function(*(_value(part, names) for part in node.args))
            what = f"{name} with {len(node.args)} arguments; it takes {many}"
            raise InputError(f"heights hold {what}", "surface-heights", "heights")
    what = ast.unparse(node)[:40]
    hint = "; a power is written **" if isinstance(getattr(node, "op", None), ast.BitXor) else ""
    raise InputError(f'heights hold "{what}"{hint}; {KNOWN}', "surface-heights", "heights")


def _table(heights: Any) -> Array:
    try:
        table = np.array(heights, np.float64)
    except (ValueError, TypeError) as error:
        text = "heights are no table; each row has as many numbers as the others"
        raise InputError(text, "surface-heights", "heights") from error
    if table.ndim != 2 or min(table.shape) < 2 or max(table.shape) > MOST_POINTS:
        text = f"heights are a table of 2 to {MOST_POINTS} rows and columns"
        raise InputError(text, "surface-heights", "heights")
    if not np.isfinite(table).all():
        row, column = np.argwhere(~np.isfinite(table))[0]
        text = f"heights[{row}][{column}] is no finite number"
        raise InputError(text, "surface-heights", f"heights[{row}][{column}]")
    return table
