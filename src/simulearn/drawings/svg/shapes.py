"""The shapes of SVG as runs of straight lines and runs of curves."""

import math
from collections.abc import Callable

from simulearn.drawings.svg.curves import Arc
from simulearn.drawings.svg.path import Pen, Run, Straight, numbers_of, path
from simulearn.drawings.svg.tree import Element


def runs_of(element: Element, length: Callable[[str, str], float]) -> tuple[list[Run], str]:
    """Return what a shape draws, and what is wrong with it.

    Args:
        element: a `line`, `polyline`, `polygon`, `rect`, `circle`, `ellipse` or `path`.
        length: returns the length of an attribute in user units, by its name and the direction
            ("x", "y" or "") that percentages go by; NaN where it is not given or `auto`.
    """
    if element.tag == "path":
        return path(element.attributes.get("d", ""))
    if element.tag in ("polyline", "polygon"):
        return _poly(element)
    pen = Pen()
    if element.tag == "line":
        x1, y1, x2, y2 = (_given(length(name, name[0])) for name in ("x1", "y1", "x2", "y2"))
        pen.move((x1, y1))
        pen.line((x2, y2))
    elif element.tag == "rect":
        _rect(pen, length)
    else:
        _ellipse(pen, element.tag, length)
    return pen.runs, ""


def _given(value: float) -> float:
    return 0.0 if math.isnan(value) else value


def _poly(element: Element) -> tuple[list[Run], str]:
    numbers, junk = numbers_of(element.attributes.get("points", ""))
    points = list(zip(numbers[::2], numbers[1::2], strict=False))
    problem = f"cannot be read from {junk[:12]!r} on" if junk else ""
    if len(numbers) % 2 and not junk:
        problem = "has an odd count of coordinates"
    if len(points) < 2:
        return [], problem
    if element.tag == "polygon" and points[-1] != points[0]:
        points.append(points[0])
    return [Straight(points)], problem


def _rect(pen: Pen, length: Callable[[str, str], float]) -> None:
    x, y = _given(length("x", "x")), _given(length("y", "y"))
    width, height = _given(length("width", "x")), _given(length("height", "y"))
    if width <= 0.0 or height <= 0.0:
        return  # as the standard says: it is not drawn
    rx, ry = length("rx", "x"), length("ry", "y")
    rx, ry = (ry if math.isnan(rx) else rx), (rx if math.isnan(ry) else ry)
    rx, ry = min(max(_given(rx), 0.0), width / 2), min(max(_given(ry), 0.0), height / 2)
    right, top = x + width, y + height
    if rx == 0.0 or ry == 0.0:
        pen.runs.append(Straight([(x, y), (right, y), (right, top), (x, top), (x, y)]))
        return
    pen.move((x + rx, y))
    corners = [((right, y), (1, 0)), ((right, top), (0, 1)), ((x, top), (-1, 0)), ((x, y), (0, -1))]
    for (cx, cy), (dx, dy) in corners:
        to = (cx - dx * rx, cy - dy * ry)
        if to != pen.at:
            pen.line(to)
        end = (cx - dy * rx, cy + dx * ry)
        centre = (to[0] - dy * rx, to[1] + dx * ry)
        u, v = (dy * rx, -dx * ry), (dx * rx, dy * ry)
        pen.curve(Arc("rounded corner", centre, u, v, 0.0, math.pi / 2, end))


def _ellipse(pen: Pen, tag: str, length: Callable[[str, str], float]) -> None:
    centre = (_given(length("cx", "x")), _given(length("cy", "y")))
    if tag == "circle":
        rx = ry = _given(length("r", ""))
    else:
        rx, ry = length("rx", "x"), length("ry", "y")
        rx, ry = _given(ry if math.isnan(rx) else rx), _given(rx if math.isnan(ry) else ry)
    if rx > 0.0 and ry > 0.0:
        end = (centre[0] + rx, centre[1])
        pen.curve(Arc(tag, centre, (rx, 0.0), (0.0, ry), 0.0, 2.0 * math.pi, end))
