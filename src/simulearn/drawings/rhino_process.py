"""A program of its own that reads a .3dm file and writes what it holds as JSON.

rhino3dm is native code: broken bytes can make it run for ever or take the process down with it,
so it runs in a process that can be stopped. It imports nothing of SimuLearn, to start quickly.
"""

import json
import sys
from pathlib import Path
from typing import Any

import rhino3dm

MAX_POINTS = 500_000
MAX_OBJECTS = 200_000
MAX_BYTES = 3 << 30
MAX_NESTING = 32


class TooLargeError(Exception):
    """The file holds more points than a drawing of beams can need."""


def main(source: Path, target: Path) -> None:
    """Read a file and write its contents.

    Args:
        source: the .3dm file.
        target: the JSON file to write; it is not written where the file cannot be read.
    """
    _limit_memory()
    model = rhino3dm.File3dm.Read(str(source))
    if model is None:
        return
    try:
        found = _contents(model)
    except TooLargeError:
        found = {"too_large": True}
    target.write_text(json.dumps(found), encoding="utf-8")


def _limit_memory() -> None:
    try:
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MAX_BYTES, MAX_BYTES))
    except (ImportError, ValueError, OSError):  # Windows has no such limit, macOS may refuse it
        pass


def _contents(model: Any) -> dict[str, Any]:
    reader = _Reader()
    if len(model.Objects) > MAX_OBJECTS:
        raise TooLargeError
    return {
        "unit": model.Settings.ModelUnitSystem.name,
        "tolerance": model.Settings.ModelAbsoluteTolerance,
        "layers": [_layer(layer) for layer in model.Layers],
        "blocks": [_block(block) for block in model.InstanceDefinitions],
        "objects": [reader.thing(item) for item in model.Objects],
    }


def _layer(layer: Any) -> dict[str, Any]:
    return {
        "index": layer.Index,
        "id": str(layer.Id),
        "parent": str(layer.ParentLayerId),
        "name": layer.Name,
        "visible": layer.Visible,
        "colour": layer.Color[:3],
    }


def _block(block: Any) -> dict[str, Any]:
    return {
        "id": str(block.Id),
        "name": block.Name,
        "source": block.SourceArchive,
        "objects": [str(member) for member in block.GetObjectIds()],
    }


class _Reader:
    def __init__(self) -> None:
        self._points = 0

    def thing(self, item: Any) -> dict[str, Any]:
        """Return an object of the model: its attributes and what its geometry is."""
        attributes = item.Attributes
        found = {
            "id": str(attributes.Id),
            "name": attributes.Name,
            "layer": attributes.LayerIndex,
            "visible": attributes.Visible,
            "mode": attributes.Mode.name,
            "page": attributes.ActiveSpace.name == "PageSpace",
            "source": attributes.ColorSource.name,
            "colour": attributes.ObjectColor[:3],
        }
        try:
            geometry = item.Geometry
            found["kind"] = _kind(geometry)
            if found["kind"] == "InstanceReference":
                found["block"] = str(geometry.ParentIdefId)
                found["matrix"] = geometry.Xform.ToFloatArray(True)
            elif isinstance(geometry, rhino3dm.Curve):
                found["parts"] = self._parts(geometry, 0)
        except TooLargeError:
            raise
        except Exception:  # a broken object fails in the library in any way
            found["broken"] = True
        return found

    def _parts(self, curve: Any, depth: int) -> list[dict[str, Any]]:
        if isinstance(curve, rhino3dm.PolyCurve) and depth < MAX_NESTING:
            segments = (curve.SegmentCurve(i) for i in range(curve.SegmentCount))
            return [part for segment in segments for part in self._parts(segment, depth + 1)]
        if isinstance(curve, rhino3dm.LineCurve):
            return [{"points": self._counted([_xyz(curve.PointAtStart), _xyz(curve.PointAtEnd)])}]
        if isinstance(curve, rhino3dm.PolylineCurve):
            points = (_xyz(curve.Point(i)) for i in range(curve.PointCount))
            return [{"points": self._counted(points)}]
        return [self._spline(curve)]

    def _spline(self, curve: Any) -> dict[str, Any]:
        nurbs = curve.ToNurbsCurve()
        count, knots = len(nurbs.Points), nurbs.Knots
        points = (nurbs.Points[i] for i in range(count))
        inner = [knots[i] for i in range(len(knots))]
        return {
            "kind": _kind(curve),
            "degree": nurbs.Degree,
            # Rhino leaves out the first and the last knot, which no curve depends on.
            "knots": [inner[0], *inner, inner[-1]],
            "control": self._counted([p.X, p.Y, p.Z, p.W] for p in points),
        }

    def _counted(self, points: Any) -> list[list[float]]:
        found = []
        for point in points:
            self._points += 1
            if self._points > MAX_POINTS:
                raise TooLargeError
            found.append(point)
        return found


def _xyz(point: Any) -> list[float]:
    return [point.X, point.Y, point.Z]


def _kind(geometry: Any) -> str:
    """Return what a geometry is: the name of its class, or of its type where it has none."""
    name = type(geometry).__name__
    if isinstance(geometry, rhino3dm.ArcCurve):
        return "Circle" if geometry.IsCompleteCircle else "Arc"
    if name == "GeometryBase":
        return str(geometry.ObjectType.name)
    return name


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
