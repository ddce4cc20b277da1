"""Scans: meshes and point clouds in STL, PLY, OBJ, as points of the surface.

The formats are read by Trimesh. A mesh of millions of triangles says no more about a grid than
points on it, so it is sampled evenly by area, the same each time.
"""

from pathlib import Path
from typing import Any

import numpy as np

from simulearn.compare.measurement import Numbers, Scan
from simulearn.errors import InputError, Message
from simulearn.surfaces.meshfile import FORMATS, contents, loaded

SAMPLES = 160_000  # points on a mesh, or kept of a cloud


def read_scan(path: Path) -> Scan:
    """Return the points of a scan.

    Args:
        path: .stl, .ply or .obj, in any unit; a cloud may have normals.

    Raises:
        InputError: the file cannot be read, is damaged, or holds no surface and no points.
    """
    shape = loaded(contents(path, "scan"), FORMATS[path.suffix.lower()], str(path), "scan")
    if shape is None:
        raise InputError(f"{path}: holds no surface and no points", "scan", str(path))
    faces = getattr(shape, "faces", None)
    vertices = np.asarray(shape.vertices, np.float64)
    if faces is not None and len(faces):
        scan = _sampled(vertices, np.asarray(faces))
    else:
        scan = of_points(vertices, _normals(shape, len(vertices)))
    if not len(scan.points):
        raise InputError(f"{path}: no point of it has finite coordinates", "scan", str(path))
    return scan


def of_points(points: Numbers, normals: Numbers | None = None) -> Scan:
    """Return the points of a cloud: finite ones, at most SAMPLES of them."""
    keep = np.isfinite(points).all(axis=1)
    if normals is not None:
        length = np.linalg.norm(normals, axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            normals = normals / length[:, None]
        if not np.isfinite(normals).all():
            normals = None
    messages = _lost(int((~keep).sum()), len(points), "points")
    at = np.flatnonzero(keep)
    if len(at) > SAMPLES:
        messages += (_fewer(len(at), "points"),)
        at = np.sort(np.random.default_rng(0).choice(at, SAMPLES, replace=False))
    return Scan(points[at], None if normals is None else normals[at], messages=messages)


def _sampled(vertices: Numbers, faces: Any) -> Scan:
    """Return points spread evenly over triangles, with the triangles' normals."""
    corners = vertices[faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    double = np.linalg.norm(across, axis=1)
    sound = np.isfinite(double) & (double > 0)
    messages = _lost(int((~np.isfinite(double)).sum()), len(faces), "triangles")
    if not sound.any():
        return Scan(np.zeros((0, 3)))
    corners, across, double = corners[sound], across[sound], double[sound]
    rng = np.random.default_rng(0)
    if len(faces) > 10 * SAMPLES:
        messages += (_fewer(len(faces), "triangles"),)
    share = np.cumsum(double)
    at = np.searchsorted(share, (np.arange(SAMPLES) + rng.random(SAMPLES)) / SAMPLES * share[-1])
    at = np.minimum(at, len(double) - 1)
    u, v = rng.random((2, SAMPLES))
    over = u + v > 1
    u, v = np.where(over, 1 - u, u)[:, None], np.where(over, 1 - v, v)[:, None]
    a, b, c = np.moveaxis(corners[at], 1, 0)
    points = a + u * (b - a) + v * (c - a)
    return Scan(points, across[at] / double[at, None], messages=messages)


def _normals(shape: Any, count: int) -> Numbers | None:
    """Return the normals (N, 3) that a PLY cloud has, if any."""
    try:
        data = shape.metadata["_ply_raw"]["vertex"]["data"]
        normals = np.stack([np.ravel(data[name]) for name in ("nx", "ny", "nz")], axis=1)
    except (KeyError, AttributeError, TypeError, ValueError, IndexError):
        return None
    return normals.astype(np.float64) if normals.shape == (count, 3) else None


def _lost(lost: int, many: int, what: str) -> tuple[Message, ...]:
    if not lost:
        return ()
    text = f"{lost} of {many} {what} have coordinates that are no finite numbers; they are left out"
    return (Message("scan-not-finite", "measurement", text),)


def _fewer(many: int, what: str) -> Message:
    text = f"of {many:,} {what} a sample of {SAMPLES:,} points is compared"
    return Message("scan-sampled", "measurement", text)
