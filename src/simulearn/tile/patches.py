"""Patches: a surface cut into modules, whose joints are shared on their borders."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError, Message
from simulearn.grid import Grid, lattice
from simulearn.surfaces import Surface
from simulearn.tile.charts import SAMPLES, Chart

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Cells = tuple[int, int]

MOST = 1000  # modules


@dataclass(frozen=True, eq=False)
class Tiling:
    """Modules on a surface.

    Attributes:
        points: (N, 3) mm, where joints are wanted; joints on a shared border are one point.
        normals: (N, 3) of the surface there, to the outside.
        modules: (M, K) the points of each module, in the order of a lattice's joints.
        cells: of each module, along its x and y.
        names: of the modules.
        surface: that they cover.
        warnings: what was mended or guessed.
        inset: (M, K, 3) mm, from the points to where each module has its own joints; see
            `inset.with_inset`.
        tilt: (M, K, 3) difference of the normals there.
        drawn: whether the user drew the modules, as quads.
    """

    points: Array
    normals: Array
    modules: Indices
    cells: Cells
    names: tuple[str, ...]
    surface: Surface
    warnings: tuple[Message, ...] = ()
    inset: Array | float = 0.0
    tilt: Array | float = 0.0
    drawn: bool = False

    @cached_property
    def lattice(self) -> Grid:
        """The plain grid of a module."""
        return lattice(self.cells, 1.0)

    @property
    def targets(self) -> Array:
        """(M, K, 3) mm, where each module's joints are wanted."""
        return self.wanted(self.points)

    def wanted(self, points: Array) -> Array:
        """Return where modules have their joints (M, K, 3) mm, with points (N, 3) that moved."""
        own: Array = points[self.modules] + self.inset
        return own

    @property
    def target_normals(self) -> Array:
        """(M, K, 3) unit, of the surface at the targets."""
        normals = self.normals[self.modules] + self.tilt
        unit: Array = normals / np.linalg.norm(normals, axis=-1, keepdims=True)
        return unit

    @property
    def shared(self) -> NDArray[np.bool_]:
        """(N,) which points belong to several modules."""
        mask: NDArray[np.bool_] = np.bincount(self.modules.ravel(), minlength=len(self.points)) > 1
        return mask

    @cached_property
    def touching(self) -> tuple[tuple[int, int], ...]:
        """Pairs of modules that share a point."""
        held = np.zeros((len(self.modules), len(self.points)), dtype=int)
        np.put_along_axis(held, self.modules, 1, axis=1)
        pairs = np.argwhere(np.triu(held @ held.T, 1))
        return tuple((int(a), int(b)) for a, b in pairs)

    def warned(self, *messages: Message) -> "Tiling":
        """Return the same with more to say."""
        return replace(self, warnings=(*self.warnings, *messages))


def counted(chart: Chart, size: float) -> tuple[int, int]:
    """Return how many modules of about a size (mm) there are along u and v."""
    u, v = chart.lengths
    least = 3 if chart.closed[0] else 1
    return max(least, round(u / size)), max(1, round(v / size))


def from_chart(
    chart: Chart,
    modules: tuple[int, int],
    cells: Cells = (2, 2),
    surface: Surface | None = None,
) -> Tiling:
    """Return the tiling of a surface along its parameters.

    Args:
        chart: the surface; modules are spread evenly along it.
        modules: how many along u and along v.
        cells: of each, along u and v.
        surface: the same as triangles; None samples the chart.

    Raises:
        InputError: there are too many or too few, or the surface is folded where a joint lies.
    """
    (a, b), (nx, ny), even = modules, cells, chart.even()
    if not 1 <= a * b <= MOST:
        text = f"{a}x{b} are {a * b} modules; 1 to {MOST} can be tiled"
        raise InputError(text, "modules", "modules")
    for axis, count in enumerate(modules):
        if even.closed[axis] and count < 2:
            text = f"{a}x{b}: around a closed surface there are at least 2 modules, better 3"
            raise InputError(text, "modules", "modules")
    columns, rows = (a * nx + (not even.closed[0]), b * ny + (not even.closed[1]))
    i, j = np.meshgrid(np.arange(columns), np.arange(rows))
    u, v = i.ravel() / (a * nx), j.ravel() / (b * ny)
    points, normals = even.at(u, v), even.normals(u, v)
    members = [
        [
            (q * ny + y) % rows * columns + (p * nx + x) % columns
            for y in range(ny + 1)
            for x in range(nx + 1)
        ]
        for q in range(b)
        for p in range(a)
    ]
    names = tuple(f"r{q + 1}c{p + 1}" for q in range(b) for p in range(a))
    if not (np.linalg.norm(normals, axis=1) > 0.5).all():
        k = int(np.linalg.norm(normals, axis=1).argmin())
        raise InputError(
            f"the surface is folded to a line at {_place(points[k])}; a patch has four sides there",
            "surface-folded",
            "surface",
        )
    return Tiling(points, normals, np.array(members), cells, names, surface or sampled(even))


def sampled(chart: Chart) -> Surface:
    """Return a chart as triangles."""
    k = np.arange(SAMPLES * SAMPLES).reshape(SAMPLES, SAMPLES)
    a, b, c, d = k[:-1, :-1].ravel(), k[:-1, 1:].ravel(), k[1:, 1:].ravel(), k[1:, :-1].ravel()
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return Surface(chart.sampled.reshape(-1, 3), faces)


def _place(point: Array) -> str:
    return "({:.0f}, {:.0f}, {:.0f}) mm".format(*point)
