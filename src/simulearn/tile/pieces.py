"""What is printed of a tiling, what is put where, and all figures."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.assembly import Assembly, Part, Step
from simulearn.grid import Grid
from simulearn.tile.tiled import Tiled

Array = NDArray[np.float64]

SCHEMA = "simulearn.tile/1"
APART = 0.5  # of their distance from the middle of all, by which modules are farther off at first
TOUCH = 0.5  # mm, by which beams side by side may be in each other besides the gap


@dataclass(frozen=True, eq=False)
class Piece:
    """A design that is printed once or more.

    Attributes:
        name: of the piece.
        kind: of the modules.
        mirrored: whether it is the kind's mirror image.
        grid: the design.
        modules: that are copies of it.
    """

    name: str
    kind: int
    mirrored: bool
    grid: Grid
    modules: tuple[int, ...]


def pieces(tiled: Tiled) -> tuple[Piece, ...]:
    """Return the pieces to print, in the order of their kinds."""
    digits = len(str(len(tiled.grids)))
    found = []
    for kind, grid in enumerate(tiled.grids):
        for mirrored in (False, True):
            modules = tuple(
                m
                for m, member in enumerate(tiled.members)
                if (member.kind, member.mirrored) == (kind, mirrored)
            )
            if not modules:
                continue
            name = f"k{kind + 1:0{digits}}" + ("-mirrored" if mirrored else "")
            own = _mirrored(grid) if mirrored else grid
            found.append(Piece(name, kind, mirrored, own, modules))
    return tuple(found)


def assembled(tiled: Tiled, files: dict[str, Path] | None = None, name: str = "") -> Assembly:
    """Return the modules, which morph apart from each other and are then put together.

    Args:
        tiled: the tiling.
        files: of the pieces' grids, by the pieces' names; None: the assembly holds the grids.
        name: of the assembly.
    """
    parts: dict[int, Part] = {}
    for piece in pieces(tiled):
        first = tiled.tiling.names[piece.modules[0]]
        for m in piece.modules:
            own = tiled.tiling.names[m]
            parts[m] = Part(
                own,
                piece.grid,
                tiled.fit.places[m],
                None if own == first else first,
                None if files is None else files[piece.name],
            )
    names = tiled.tiling.names
    joined = tuple((names[a], names[b]) for a, b in tiled.tiling.touching)
    apart = 2 * (tiled.settings.inset_mm or 0.0)  # axes of beams on a common border
    deep = tiled.fit.gap_mm + (TOUCH if apart >= tiled.width else 2 * tiled.width)
    return Assembly(
        tuple(parts[m] for m in range(len(names))),
        _steps(tiled),
        joined=joined,
        joined_mm=deep,
        name=name,
    )


def _steps(tiled: Tiled) -> tuple[Step, ...]:
    """Return how modules come together: from everywhere at once, so that none is in the way."""
    names, middles = tiled.tiling.names, tiled.fit.joints.mean(axis=1)
    if len(names) == 1:
        return ()
    away = APART * (middles - middles.mean(axis=0))
    slide = {
        name: (float(x), float(y), float(z))
        for name, (x, y, z) in zip(names, away.round(3), strict=True)
    }
    return (
        Step(tuple(names), name="the modules morph"),
        Step(slide=slide, name="they are put together"),
    )


def tiling_figures(tiled: Tiled) -> dict[str, Any]:
    """Return the figures of a tiling as plain data: mm, s."""
    fit, tiling = tiled.fit, tiled.tiling
    joints, beams = deviations(tiled)
    owner = {m: piece.name for piece in pieces(tiled) for m in piece.modules}
    return {
        "schema": SCHEMA,
        "modules": len(tiling.names),
        "kinds": len(tiled.grids),
        "pieces": len(set(owner.values())),
        "checked": all(answer.checked for answer in tiled.answers),
        "error_mm": fit.error_mm,
        "error_max_mm": float(fit.away.max()),
        "deviation_mm": float(joints.mean()),
        "deviation_max_mm": float(joints.max()),
        "beam_deviation_mm": float(beams.mean()),
        "beam_deviation_max_mm": float(beams.max()),
        "gap_mm": fit.gap_mm,
        "gap_mean_mm": float(fit.gaps[tiling.shared].mean()) if tiling.shared.any() else 0.0,
        "alike_mm": max(member.away_mm for member in tiled.members),
        "rounds": [{"gap_mm": gap, "error_mm": error} for gap, error in tiled.rounds],
        "designs": sum(answer.designs for answer in tiled.answers),
        "seconds": round(tiled.seconds, 3),
        "searching_seconds": round(tiled.searching, 3),
        "settings": asdict(tiled.settings),
        "warnings": [asdict(message) for message in tiled.warnings],
        "by_module": [
            {
                "name": name,
                "piece": owner[m],
                "error_mm": float(fit.away[m].mean()),
                "error_max_mm": float(fit.away[m].max()),
                "deviation_mm": float(joints[m].mean()),
                "gap_mm": float(fit.gaps[tiling.modules[m]].max()),
            }
            for m, name in enumerate(tiling.names)
        ],
    }


def deviations(tiled: Tiled) -> tuple[Array, Array]:
    """Return how far joints (M, K) and middles of beams (M, B) are from the surface, mm."""
    surface = tiled.tiling.surface
    joints, beams = tiled.fit.joints, tiled.beams
    return (
        surface.distance(joints.reshape(-1, 3)).reshape(joints.shape[:2]),
        surface.distance(beams.reshape(-1, 3)).reshape(beams.shape[:2]),
    )


def _mirrored(grid: Grid) -> Grid:
    """Return the mirror image of a grid; an actuator keeps its half."""
    return Grid(grid.joints * [-1.0, 1.0], grid.beams, grid.actuators, grid.fixed, grid.material)
