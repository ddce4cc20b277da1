"""Lines in JSON: lists of points, objects with ends, GeoJSON, and graphs of nodes and edges.

What a list or object is follows from what it holds; names of keys count in any case.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

from simulearn.drawings.drawing import Drawing, LeftOut, Line, Unit
from simulearn.drawings.graphs import edges_of, is_graph
from simulearn.drawings.points import MOST_SEGMENTS, Points, is_point, too_many
from simulearn.drawings.units import unit_named
from simulearn.errors import InputError
from simulearn.files import parse_json
from simulearn.grid.arrays import shown

MOST_LEVELS = 12
UNIT_KEYS = ("unit", "units", "lengthunit", "length_unit", "modelunit", "modelunits")
# Two ends of a line, by the names that programs give them.
ENDS = (("from", "to"), ("start", "end"), ("a", "b"), ("p1", "p2"), ("p0", "p1"), ("begin", "end"))
FLAT = (("x1", "y1", "z1"), ("x2", "y2", "z2"))
POINTS = ("points", "coordinates", "polyline", "pts", "vertices")
LINES = ("lines", "polylines", "curves", "segments", "edges", "features", "geometries", "geometry")
WRAPPERS = ("items", "objects", "elements", "innertree", "value", "values", "data")
LOOKED_FOR = (
    'looked for: a list of lines [[x, y, z], [x, y, z]] or of polylines; "lines" with From and To, '
    'or start and end; "nodes" with "edges" or "links"; "vertices" with "edges" or "faces"; GeoJSON'
)


def read_json_lines(value: Any) -> Drawing:
    """Return the lines of parsed JSON that is no file of ours.

    Args:
        value: as `simulearn.files.parse_json` returns it.

    Raises:
        InputError: it holds no lines, or a coordinate is no finite number; one line says where.
    """
    return _Reader().drawing(value)


class _Reader:
    """Collects lines from the levels of one value."""

    def __init__(self) -> None:
        self.points = Points()
        self.lines: list[Line] = []
        self.left_out: dict[str, int] = {}
        self.messages: list[str] = []
        self.format = "JSON lines"
        self.segments = 0

    def drawing(self, value: Any) -> Drawing:
        self.read(value, "", "", 0)
        if not self.lines:
            rest = ", ".join(f"{count} x {kind}" for kind, count in self.left_out.items())
            text = f"holds no lines{rest and f' ({rest})'}; {LOOKED_FOR}"
            raise InputError(text, "no-lines", "lines")
        unit = _unit(value)
        return Drawing(
            self.format,
            self.lines,
            left_out=[LeftOut(kind, n, "", "is no line") for kind, n in self.left_out.items()],
            unit=unit,
            plain=unit is None,
            messages=[*dict.fromkeys(self.messages), *self.points.remarks()],
        )

    def read(self, value: Any, where: str, layer: str, level: int) -> None:
        """Read a value: a line, a list of what holds lines, or an object that names some."""
        if level > MOST_LEVELS:
            raise InputError(f"{where[:40]}... is nested too deeply for lines", "format", "lines")
        if isinstance(value, dict):
            self._read_object(value, where, layer, level)
        elif isinstance(value, list):
            self._read_list(value, where, layer, level)
        elif isinstance(value, str) and value.lstrip()[:1] in ("{", "["):  # JSON within JSON
            self.read(parse_json(value), where, layer, level + 1)
        elif value is not None:
            text = f"{where or 'it'} is {shown(value)} where a line would be; {LOOKED_FOR}"
            raise InputError(text, "format", where)

    def _read_list(self, value: list[Any], where: str, layer: str, level: int) -> None:
        if value and all(map(is_point, value)):
            self._add(value, where, layer)
        elif value and all(isinstance(part, (int, float)) for part in value):
            if len(value) not in (4, 6):
                text = f"{where or 'it'} has {len(value)} numbers; a line has 4 or 6"
                raise InputError(f"{text}; {LOOKED_FOR}", "format", where)
            half = len(value) // 2
            self._add([value[:half], value[half:]], where, layer)
        else:
            for k, part in enumerate(value):
                self.read(part, f"{where}[{k}]", layer, level + 1)

    def _read_object(self, value: dict[str, Any], where: str, layer: str, level: int) -> None:
        keys = {str(key).casefold(): key for key in value}
        parts = {name: value[key] for name, key in keys.items()}
        layer = _layer(parts, layer)
        inside = f"{where}." if where else ""
        kind = parts.get("type")
        if is_point(value):
            self.left_out["point"] = self.left_out.get("point", 0) + 1
        elif (ends := _ends(parts)) is not None:
            self._add(ends, where, layer, _colour(parts))
        elif is_graph(parts):
            self.format = "JSON graph"
            for pair, place in edges_of(parts, self.points, self.messages, inside):
                self._line(pair, f"{inside}{place}", layer, None)
        elif isinstance(kind, str) and "coordinates" in parts:
            self._read_geometry(kind, parts["coordinates"], f"{inside}coordinates", layer, level)
        elif (name := _first(parts, LINES)) is not None:
            if kind in ("FeatureCollection", "GeometryCollection"):
                self.format = "GeoJSON"
            for name in LINES:
                if parts.get(name):
                    self.read(parts[name], f"{inside}{keys[name]}", layer, level + 1)
        elif (name := next((n for n in POINTS if _is_polyline(parts.get(n))), None)) is not None:
            points = parts[name] + (parts[name][:1] if parts.get("closed") is True else [])
            self._add(points, f"{inside}{keys[name]}", layer, _colour(parts))
        elif (name := _first(parts, WRAPPERS)) is not None:
            for name in WRAPPERS:
                if isinstance(parts.get(name), (list, dict, str)):
                    self.read(parts[name], f"{inside}{keys[name]}", layer, level + 1)
        elif value and all(isinstance(part, (list, dict)) for part in value.values()):
            for name, part in value.items():  # lists of lines by layer
                self.read(part, f"{inside}{name}", layer or name, level + 1)
        else:
            what = str(kind or parts.get("dtype") or "object")[:40]
            self.left_out[what] = self.left_out.get(what, 0) + 1

    def _read_geometry(self, kind: str, value: Any, where: str, layer: str, level: int) -> None:
        """Read a geometry of GeoJSON: only its lines."""
        self.format = "GeoJSON"
        if kind in ("LineString", "MultiLineString"):
            self.read(value, where, layer, level + 1)
        else:
            self.left_out[kind] = self.left_out.get(kind, 0) + 1

    def _add(self, points: list[Any], where: str, layer: str, colour: str | None = None) -> None:
        """Add a line of values that are points."""
        where = where or "it"
        wrong = next((k for k, point in enumerate(points) if not is_point(point)), None)
        if wrong is not None:
            text = f"{where}: end {wrong} is no point; a point is [x, y], [x, y, z] or has x and y"
            raise InputError(text, "point", where)
        read = [self.points.point(point, f"{where}[{k}]") for k, point in enumerate(points)]
        self._line(read, where, layer, colour)

    def _line(
        self,
        points: list[tuple[float, float, float]],
        where: str,
        layer: str,
        colour: str | None,
    ) -> None:
        if len(points) < 2:
            self.left_out["point"] = self.left_out.get("point", 0) + len(points)
            return
        self.segments += len(points) - 1
        if self.segments > MOST_SEGMENTS:
            raise too_many()
        self.lines.append(Line(np.array(points, np.float64), layer, colour, where))


def _first(parts: dict[str, Any], names: tuple[str, ...]) -> str | None:
    """Return the first of some names under which an object holds something to read."""
    return next((n for n in names if parts.get(n) and not isinstance(parts[n], (int, float))), None)


def _is_polyline(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(map(is_point, value))


def _ends(parts: dict[str, Any]) -> list[Any] | None:
    """Return the two ends of an object that is a line; None where it is none."""
    for names in ENDS:
        if all(isinstance(parts.get(name), (list, dict)) for name in names):
            ends = [parts[name] for name in names]
            # In graphs, edges have ends that are names.
            if any(map(is_point, ends)):
                return ends
    if all(name in parts for names in FLAT for name in names[:2]):
        return [[parts[name] for name in names if name in parts] for names in FLAT]
    return None


def _layer(parts: dict[str, Any], layer: str) -> str:
    """Return the layer that an object or its properties name, else that of what it is in."""
    for holder in (parts, parts.get("properties"), parts.get("attributes")):
        if isinstance(holder, dict):
            name = next((v for k, v in holder.items() if str(k).casefold() == "layer"), None)
            if isinstance(name, str):
                return name[:200]
    return layer


def _colour(parts: dict[str, Any]) -> str | None:
    """Return the colour of an object where it is written as "#rrggbb"."""
    for name in ("colour", "color", "stroke"):
        value = parts.get(name)
        if isinstance(value, str) and len(value) == 7 and value.startswith("#"):
            return value.lower()
    return None


def _unit(value: Any) -> Unit | None:
    """Return the unit that the outermost object or a part of it names.

    Raises:
        InputError: it names one that is none.
    """
    for holder, inside in _holders(value):
        for key, name in holder.items():
            if str(key).casefold() in UNIT_KEYS and isinstance(name, str):
                return unit_named(name, f'"{inside}{key}": "{name[:40]}" of the file')
    return None


def _holders(value: Any) -> Iterator[tuple[dict[str, Any], str]]:
    """Yield the objects that may name the unit, and the path to each."""
    if not isinstance(value, dict):
        return
    yield value, ""
    for key in ("data", "attributes", "properties", "metadata", "settings", "graph"):
        if isinstance(value.get(key), dict):
            yield value[key], f"{key}."
