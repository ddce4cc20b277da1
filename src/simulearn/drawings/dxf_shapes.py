"""Entities of DXF as straight parts and curves, each in its own block's coordinates."""

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from simulearn.drawings.collecting import TOO_LARGE
from simulearn.drawings.drawing import Points
from simulearn.drawings.nurbs import Nurbs

Flatten = Callable[[float], Points]

# An arc whose bulge is smaller is straight: its middle lies less than a two-millionth of its
# length off the chord.
_NO_BULGE = 1e-6
# Control points of a spline are on a line if they lie nearer to it than this part of its size.
_STRAIGHT = 1e-6

# Why an entity is left out, for a person; all others are "no line".
REASONS = {
    **dict.fromkeys(("XLINE", "RAY"), "is an endless construction line"),
    **dict.fromkeys(("TEXT", "MTEXT", "ATTRIB", "ATTDEF", "ARCALIGNEDTEXT", "RTEXT"), "is text"),
    **dict.fromkeys(
        ("DIMENSION", "ARC_DIMENSION", "LEADER", "MULTILEADER", "MLEADER", "TOLERANCE"),
        "is an annotation",
    ),
    **dict.fromkeys(
        (
            "3DFACE",
            "SOLID",
            "TRACE",
            "MESH",
            "REGION",
            "PLANESURFACE",
            "SURFACE",
            "EXTRUDEDSURFACE",
            "LOFTEDSURFACE",
            "REVOLVEDSURFACE",
            "SWEPTSURFACE",
        ),
        "is a surface; its edges are not read",
    ),
    **dict.fromkeys(("3DSOLID", "BODY"), "is a body; its edges are not read"),
    **dict.fromkeys(("HATCH", "MPOLYGON", "WIPEOUT"), "is an area"),
    **dict.fromkeys(
        ("IMAGE", "OLEFRAME", "OLE2FRAME", "PDFUNDERLAY", "DWFUNDERLAY", "DGNUNDERLAY"),
        "is a picture",
    ),
    "POINT": "is a point",
    "MLINE": "is a bundle of parallel lines: explode it or draw its axis",
    "ACAD_PROXY_ENTITY": "belongs to a program that is not there",
    "ACAD_TABLE": "is a table",
}


@dataclass(frozen=True, eq=False)
class Part:
    """A straight or curved part of an entity.

    Attributes:
        points: (n, 3) of a straight one; None for a curve.
        kind: of a curve, in the words of DXF.
        flatten: of a curve: its points for a largest distance of the chords.
    """

    points: Points | None
    kind: str = ""
    flatten: Flatten | None = None


class LeftOutError(Exception):
    """An entity whose kind is read is no line after all; the text says why."""


def parts(entity: Any) -> list[Part]:
    """Return an entity's parts.

    Args:
        entity: of ezdxf, of a kind in `READERS`.

    Raises:
        LeftOutError: it has none.
    """
    needed = _NEEDED.get(entity.dxftype(), ())
    if not all(entity.dxf.hasattr(name) for name in needed):
        raise LeftOutError("is damaged")
    found = list(READERS[entity.dxftype()](entity))
    if not found:
        raise LeftOutError("has no length")
    return found


def points_of(vertices: Iterable[Any]) -> Points:
    """Return vertices of ezdxf as (n, 3)."""
    found = np.array([(v.x, v.y, v.z) for v in vertices], dtype=float)
    return found.reshape(-1, 3)


def _line(entity: Any) -> Iterator[Part]:
    yield Part(points_of((entity.dxf.start, entity.dxf.end)))


def _rounded(entity: Any) -> Iterator[Part]:
    """ARC, CIRCLE and ELLIPSE, which ezdxf flattens in world coordinates."""
    kind = entity.dxftype()
    radius = entity.dxf.major_axis.magnitude if kind == "ELLIPSE" else abs(entity.dxf.radius)
    if radius == 0:
        raise LeftOutError("has no length")
    if not max(radius, *map(abs, entity.dxf.center)) < TOO_LARGE:
        raise LeftOutError("has coordinates that are no numbers")
    yield Part(None, kind, lambda d: points_of(entity.flattening(_held(d, radius))))


def _lightweight(entity: Any) -> Iterator[Part]:
    z = entity.dxf.elevation
    flat = [(x, y, z, bulge) for x, y, bulge in entity.get_points("xyb")]
    yield from _bulged(entity, flat, entity.closed)


def _polyline(entity: Any) -> Iterator[Part]:
    if entity.is_poly_face_mesh or entity.is_polygon_mesh:
        raise LeftOutError("is a mesh; its edges are not read")
    frame = 16  # flag of a vertex that only controls a spline
    vertices = [v.dxf for v in entity.vertices if not v.dxf.flags & frame]
    if not vertices:
        return
    spatial = entity.is_3d_polyline
    if entity.dxf.flags & entity.SPLINE_FIT_VERTICES_ADDED:
        points = points_of(v.location for v in vertices)
        if entity.is_closed:
            points = np.vstack((points, points[:1]))
        if not spatial:
            points = points_of(entity.ocs().points_to_wcs(_vectors(points)))
        yield Part(None, "spline-fit POLYLINE", lambda distance: points)
    elif spatial:
        points = points_of(v.location for v in vertices)
        yield Part(np.vstack((points, points[:1])) if entity.is_closed else points)
    else:
        z = entity.dxf.elevation.z if entity.dxf.hasattr("elevation") else vertices[0].location.z
        flat = [(v.location.x, v.location.y, z, v.bulge) for v in vertices]
        yield from _bulged(entity, flat, entity.is_closed)


def _vectors(points: Points) -> list[Any]:
    from ezdxf.math import Vec3

    return [Vec3(*point) for point in points]


def _bulged(
    entity: Any, vertices: list[tuple[float, float, float, float]], closed: bool
) -> Iterator[Part]:
    """Straight runs and arcs of a flat polyline.

    Args:
        entity: whose object coordinate system it is.
        vertices: x, y, z and the bulge of the piece that follows.
        closed: whether a piece leads from the last to the first.
    """
    to_world = entity.ocs().points_to_wcs
    corners = points_of(to_world(_vectors(np.array([v[:3] for v in vertices]))))
    places = list(range(len(vertices)))
    if closed and places:
        places.append(0)
    run = places[:1]
    for start, end in pairwise(places):
        bulge = vertices[start][3]
        if abs(bulge) < _NO_BULGE or vertices[start][:2] == vertices[end][:2]:
            run.append(end)
            continue
        if len(run) > 1:
            yield Part(corners[run])
        run = [end]
        yield Part(
            None,
            f"arc of {entity.dxftype()}",
            _arc(vertices[start], vertices[end], lambda p: points_of(to_world(_vectors(p)))),
        )
    if len(run) > 1:
        yield Part(corners[run])


def _arc(
    start: tuple[float, float, float, float],
    end: tuple[float, float, float, float],
    to_world: Callable[[Points], Points],
) -> Flatten:
    from ezdxf.math import ConstructionArc, bulge_to_arc

    centre, first, last, radius = bulge_to_arc(start[:2], end[:2], start[3])
    arc = ConstructionArc(centre, radius, math.degrees(first), math.degrees(last))

    def flatten(distance: float) -> Points:
        flat = np.array([(p.x, p.y, start[2]) for p in arc.flattening(_held(distance, radius))])
        return to_world(flat)

    return flatten


def _held(distance: float, radius: float) -> float:
    """Return a distance for which a curve of this radius has neither too few nor too many chords.

    A circle keeps four chords at least, and has some thousand at most.
    """
    return min(max(distance, 1e-6 * radius), 0.29 * radius)


def _spline(entity: Any) -> Iterator[Part]:
    tool = entity.construction_tool()
    control = points_of(tool.control_points)
    weights = np.array(tool.weights() or np.ones(len(control)))[:, None]
    curve = Nurbs(tool.degree, np.array(tool.knots()), np.hstack((control * weights, weights)))
    straight = curve.straight(_STRAIGHT * float(np.linalg.norm(np.ptp(control, axis=0))))
    if straight is not None:
        yield Part(straight)
    else:
        yield Part(None, entity.dxftype(), curve.flatten)


# Without these ezdxf would take the origin, or one.
_NEEDED = {
    "LINE": ("start", "end"),
    "ARC": ("center", "radius", "start_angle", "end_angle"),
    "CIRCLE": ("center", "radius"),
    "ELLIPSE": ("center", "major_axis"),
}

READERS: dict[str, Callable[[Any], Iterator[Part]]] = {
    "LINE": _line,
    "ARC": _rounded,
    "CIRCLE": _rounded,
    "ELLIPSE": _rounded,
    "LWPOLYLINE": _lightweight,
    "POLYLINE": _polyline,
    "SPLINE": _spline,
    "HELIX": _spline,
}
