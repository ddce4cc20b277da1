"""What prints of one design come to: where its joints are on average, and how far they differ.

The spread of a joint is given for up and for the plane of the flat grid. What nine of ten prints
do is counted, not computed from a standard deviation, since large motions are not normal.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.grid import Grid
from simulearn.material import Scatter
from simulearn.simulate.members import Prints

Numbers = NDArray[np.float64]

RANGE = (5.0, 95.0)  # per cent of the prints
DIGITS = 4
_COLUMNS = {"mean_mm": (3,), "up_mm": (), "plane_mm": (), "up_90_mm": (2,), "plane_90_mm": ()}


@dataclass(frozen=True, eq=False)
class Spread:
    """How prints of one grid differ in the last frame; mm, +z up, J joints.

    Attributes:
        scatter: relative standard deviations of the released strains.
        law: from which they were drawn.
        seed: of the draws.
        engine: that simulated the prints.
        drawn, prints: how many were drawn, and how many of them have an answer.
        beyond: how many were drawn with a beam that curls more or less than any the model has
            learnt, so that its answer is a guess.
        dimension: of the grid.
        mean: (J, 3) mean place of each joint's centre.
        up, plane: (J,) standard deviation of its height, and of its place in the plane (root of the
            sum of both variances).
        up_90: (J, 2) heights between which nine of ten prints lie, by the 5th and 95th percentile.
        plane_90: (J,) distance in the plane from the mean that nine of ten prints stay within.
        overall: mean over all joints but the fixed one of the standard deviation in space.
        lines: (T, B, 3, 3) centres of the beams' sections in each print; None in a spread that was
            read from a file.
        groups: how many prints come to each of several shapes with nothing between; () if all
            come to one that varies.
    """

    scatter: Scatter
    law: str
    seed: int
    engine: str
    drawn: int
    prints: int
    dimension: float
    mean: Numbers
    up: Numbers
    plane: Numbers
    up_90: Numbers
    plane_90: Numbers
    overall: float
    lines: Numbers | None = field(default=None, repr=False)
    beyond: int = 0
    groups: tuple[int, ...] = ()

    @property
    def percent(self) -> float:
        """The overall standard deviation in % of the dimension."""
        return 100 * self.overall / self.dimension

    @property
    def words(self) -> str:
        """The spread in one line."""
        lost = self.drawn - self.prints
        without = f" ({lost} more have no answer)" if lost else ""
        line = (
            f"{self.prints} prints{without} by {self.engine} differ by {self.overall:.2f} mm "
            f"({self.percent:.2f} % of the dimension), the mean standard deviation of joints"
        )
        if self.beyond:
            line += f"; {self.beyond} have a beam beyond what the model has learnt"
        if self.groups:
            line += (
                f"; they come to {len(self.groups)} shapes ({' and '.join(map(str, self.groups))} "
                "prints) with none between, as where a part of them snaps: the mean is none of them"
            )
        return line

    @classmethod
    def of(
        cls, grid: Grid, prints: Prints, scatter: Scatter, *, drawn: int, law: str, seed: int,
        engine: str, beyond: int = 0,
    ) -> Spread:  # fmt: skip
        """Return the spread of prints that all have an answer; see the attributes."""
        from simulearn.simulate.groups import groups_of  # reading a file does without

        centres = prints.centres
        mean = centres.mean(axis=0)
        away = centres - mean
        variance = away.var(axis=0)
        others = np.arange(len(mean)) != grid.fixed
        return cls(
            scatter=scatter,
            law=law,
            seed=seed,
            engine=engine,
            drawn=drawn,
            prints=len(centres),
            dimension=grid.dimension,
            mean=mean,
            up=np.sqrt(variance[:, 2]),
            plane=np.sqrt(variance[:, :2].sum(axis=1)),
            up_90=np.percentile(centres[..., 2], RANGE, axis=0).T,
            plane_90=np.percentile(np.linalg.norm(away[..., :2], axis=-1), 90, axis=0),
            overall=float(np.sqrt(variance.sum(axis=1))[others].mean()),
            lines=prints.sections.mean(axis=3),
            beyond=beyond,
            groups=groups_of(centres, grid.dimension),
        )


def spread_to_dict(spread: Spread) -> dict[str, Any]:
    """Return the machine form of a spread; mm."""
    columns = [
        np.round(array, DIGITS) + 0.0
        for array in (spread.mean, spread.up, spread.plane, spread.up_90, spread.plane_90)
    ]
    return {
        "print": spread.scatter.print,
        "beam": spread.scatter.beam,
        "law": spread.law,
        "seed": spread.seed,
        "engine": spread.engine,
        "drawn": spread.drawn,
        "prints": spread.prints,
        "beyond": spread.beyond,
        "groups": list(spread.groups),
        "overall_mm": round(spread.overall, DIGITS),
        "overall_percent": round(spread.percent, DIGITS),
        "joints": [
            {name: value.tolist() for name, value in zip(_COLUMNS, row, strict=True)}
            for row in zip(*columns, strict=True)
        ],
    }


def spread_from_dict(data: Any, grid: Grid) -> Spread:
    """Return the spread of its machine form; the prints themselves are not part of it.

    Raises:
        InputError: a key is missing or holds the wrong thing; the message names it.
    """

    def wrong(key: str, text: str) -> InputError:
        return InputError(f"scatter.{key}: {text}", "result", f"scatter.{key}")

    if not isinstance(data, Mapping):
        raise InputError("scatter: is not an object", "result", "scatter")
    try:
        rows = [[row[name] for name in _COLUMNS] for row in data["joints"]]
        columns = [np.array(column, dtype=np.float64) for column in zip(*rows, strict=True)]
    except (KeyError, TypeError, ValueError) as error:
        raise wrong("joints", f"are not a list of objects with {', '.join(_COLUMNS)}") from error
    shapes = [(len(grid.joints), *shape) for shape in _COLUMNS.values()]
    if [a.shape for a in columns] != shapes or not all(np.isfinite(a).all() for a in columns):
        raise wrong("joints", f"are not numbers for each of this grid's {len(grid.joints)} joints")
    data = {"beyond": 0, "groups": [], **data}  # which files of earlier versions do not hold
    kinds: dict[str, Any] = {"law": str, "engine": str, "seed": int, "drawn": int, "prints": int,
             "beyond": int, "print": float | int, "beam": float | int,
             "overall_mm": float | int, "groups": list}  # fmt: skip
    for key, kind in kinds.items():
        if isinstance(data.get(key), bool) or not isinstance(data.get(key), kind):
            raise wrong(key, "is missing or of the wrong kind")
    if not all(isinstance(size, int) for size in data["groups"]):
        raise wrong("groups", "are not numbers of prints")
    try:
        scatter = Scatter(print=data["print"], beam=data["beam"])
    except ValueError as error:
        raise wrong("print", "and beam are not from 0 to 0.5") from error
    mean, up, plane, up_90, plane_90 = columns
    return Spread(
        scatter=scatter,
        law=data["law"],
        seed=data["seed"],
        engine=data["engine"],
        drawn=data["drawn"],
        prints=data["prints"],
        dimension=grid.dimension,
        mean=mean,
        up=up,
        plane=plane,
        up_90=up_90,
        plane_90=plane_90,
        overall=float(data["overall_mm"]),
        beyond=data["beyond"],
        groups=tuple(data["groups"]),
    )
