"""What is to be tiled, by its file: a chart, a quad mesh, or triangles that are unrolled."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.surfaces import Surface, read_surface
from simulearn.tile.chartfile import read_chart
from simulearn.tile.patches import Cells, Tiling, counted, from_chart
from simulearn.tile.quadfile import read_quads
from simulearn.tile.quads import from_quads
from simulearn.tile.unrolling import unrolled

Array = NDArray[np.float64]

LEAST, MOST = 20.0, 100_000.0  # mm across: less than a beam, more than all modules


def read_tiling(
    path: Path | str,
    modules: tuple[int, int] | None = None,
    size: float | None = None,
    cells: Cells = (2, 2),
    unit: str | None = None,
    onto: Path | str | None = None,
) -> Tiling:
    """Return the patches of the surface in a file.

    Args:
        path: .json of a chart; .obj or .ply of a quad mesh; or any mesh file or .3dm.
        modules: how many along the surface; a quad mesh has its own.
        size: of a module, mm, in their place.
        cells: of each module.
        unit: of a mesh file.
        onto: file of a surface onto which the joints of a quad mesh are put.

    Raises:
        InputError: the file cannot be read, or neither modules nor a size is given where one must
            be.
    """
    path = Path(path)
    if modules is not None and size is not None:
        raise InputError("give modules or a size, not both", "modules", "modules")
    quads = read_quads(path) if modules is None and size is None else None
    if quads is not None:
        scale = 1.0 if unit is None else _mm(unit)
        _sized(path, quads[0] * scale, unit)
        tiling = from_quads(quads[0] * scale, quads[1], cells)
        return tiling if onto is None else _onto(tiling, read_surface(onto, unit))
    if onto is not None:
        text = "only the joints of a quad mesh are put onto another surface"
        raise InputError(text, "modules", "onto")
    if modules is None and size is None:
        text = (
            f"{path}: say how many modules (as 5x3) or of what size, mm; only a quad mesh says it"
        )
        raise InputError(text, "modules", "modules")
    surface = None
    if path.suffix.lower() == ".json":
        chart = read_chart(path)
    else:
        surface = read_surface(path, unit)
        _sized(path, surface.vertices, unit)
        try:
            chart = unrolled(surface)
        except InputError as error:  # a face that is taken whole is likely why
            why = [m.message for m in surface.warnings if m.code == "surface-untrimmed"]
            text = "; ".join([f"{path}: {error}", *why])
            raise InputError(text, error.code, error.where) from error
    count = modules or counted(chart, size or 0.0)
    tiling = from_chart(chart, count, cells, surface)
    return tiling if surface is None else tiling.warned(*surface.warnings)


def _sized(path: Path, points: Array, unit: str | None) -> None:
    """Raise InputError where a surface is of a size that no modules have."""
    across = float(np.linalg.norm(np.ptp(points, axis=0)))
    if LEAST <= across <= MOST:
        return
    other = "m or --unit in" if across < LEAST else "mm"
    hint = f"; if that is not meant, say --unit {other}" if unit is None else ""
    text = f"{path}: is {across:.3g} mm across; from {LEAST:g} to {MOST:g} mm can be tiled{hint}"
    raise InputError(text, "surface-unit", str(path))


def _mm(unit: str) -> float:
    from simulearn.drawings.units import unit_named

    return unit_named(unit, "as given").mm


def _onto(tiling: Tiling, surface: Surface) -> Tiling:
    """Return a tiling with its joints at the closest points of a surface."""
    points, normals, _ = surface.closest(tiling.points)
    sides = (normals * tiling.normals).sum(axis=1, keepdims=True)
    turned = normals * (1.0 if sides.mean() > 0 else -1.0)
    return replace(tiling, points=points, normals=turned, surface=surface).warned(*surface.warnings)
