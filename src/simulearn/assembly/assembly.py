"""An assembly: grids in their places, the order in which they morph, and what stands around them.

Steps come one after another. The parts that a step names morph in it, from flat to their last
frame; before their step they are flat, and a part that no step names has morphed beforehand. A
part may come to its place on a straight line, before it morphs, while it does, or in a step of its
own; until then it waits where the line begins. Without any step all parts morph at once.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Literal

import numpy as np

from simulearn.errors import InputError
from simulearn.grid import Grid
from simulearn.grid.arrays import shown
from simulearn.rigid import Place

Slide = tuple[float, float, float]

JOINED_MM = 4.0  # how deep joined parts may be in each other: once a beam's usual thickness
NAMED = 3  # parts, in the title of a step


@dataclass(frozen=True, eq=False)
class Part:
    """A grid in its place.

    Attributes:
        name: of the part.
        grid: the design.
        place: of the fixed joint's frame, from which results are seen.
        copy_of: the part that it is a copy of; equal grids are simulated once anyway, so that this
            only says in a file what is printed again.
        file: that the grid is in; None: the assembly's own file holds it.
    """

    name: str
    grid: Grid
    place: Place = field(default_factory=Place)
    copy_of: str | None = None
    file: Path | None = None


@dataclass(frozen=True)
class Step:
    """What happens at a time.

    Attributes:
        parts: that morph.
        seconds: that the morphing is shown for, and a slide before it as long again.
        slide: by the part's name, from where it comes: mm from its place.
        sliding: whether slides come before the morphing or go with it.
        name: of the step; empty: its parts name it.
    """

    parts: tuple[str, ...] = ()
    seconds: float = 1.0
    slide: Mapping[str, Slide] = field(default_factory=dict)
    sliding: Literal["before", "during"] = "before"
    name: str = ""

    @property
    def title(self) -> str:
        """Name of the step, or of its parts."""
        if self.name:
            return self.name
        names = list(dict.fromkeys([*self.parts, *self.slide]))
        return ", ".join(names) if len(names) <= NAMED else f"{len(names)} parts"


@dataclass(frozen=True, eq=False)
class Obstacle:
    """A body that the parts must not run into.

    Attributes:
        name: of the obstacle.
        file: its surface.
        place: of the file's frame.
        unit: of the file; None: what the file says.
    """

    name: str
    file: Path
    place: Place = field(default_factory=Place)
    unit: str | None = None


@dataclass(frozen=True, eq=False)
class Assembly:
    """Parts put together.

    Attributes:
        parts: at least one.
        steps: in their order.
        obstacles: around the parts.
        joined: pairs of parts that lie on each other on purpose.
        joined_mm: how deep these may be in each other.
        name: of the assembly.

    Raises:
        InputError: a name is missing, occurs twice or belongs to no part; a part morphs or slides
            twice. The message says where.
    """

    parts: tuple[Part, ...]
    steps: tuple[Step, ...] = ()
    obstacles: tuple[Obstacle, ...] = ()
    joined: tuple[tuple[str, str], ...] = ()
    joined_mm: float = JOINED_MM
    name: str = ""

    def __post_init__(self) -> None:
        if not self.parts:
            raise wrong("parts", "is empty; an assembly has at least one part")
        _once([part.name for part in self.parts], "parts", ".name")
        _once([one.name for one in self.obstacles], "obstacles", ".name")
        for k, obstacle in enumerate(self.obstacles):
            if obstacle.name in self.places_of:
                raise wrong(f"obstacles[{k}].name", f"is {shown(obstacle.name)}, as that of a part")
        for k, part in enumerate(self.parts):
            self._check_copy(part, f"parts[{k}].copy_of")
        morphed: dict[str, str] = {}
        slid: dict[str, str] = {}
        for k, step in enumerate(self.steps):
            for m, name in enumerate(step.parts):
                self._known(name, f"steps[{k}].parts[{m}]")
                _first(morphed, name, f"steps[{k}].parts[{m}]", "morphs")
            for name in step.slide:
                self._known(name, f"steps[{k}].slide")
                _first(slid, name, f"steps[{k}].slide.{name}", "slides")
            if not step.parts and not step.slide:
                raise wrong(f"steps[{k}]", "names no part; a step has parts or slide")
        for k, pair in enumerate(self.joined):
            for m, name in enumerate(pair):
                self._known(name, f"joined[{k}][{m}]")
            if pair[0] == pair[1]:
                raise wrong(f"joined[{k}]", f"is {shown(list(pair))}; a pair is two parts")

    @property
    def order(self) -> tuple[Step, ...]:
        """The steps; without any, one in which all parts morph."""
        return self.steps or (Step(tuple(part.name for part in self.parts)),)

    @cached_property
    def places_of(self) -> dict[str, int]:
        """By the name of a part, which one it is."""
        return {part.name: k for k, part in enumerate(self.parts)}

    @property
    def distinct(self) -> tuple[int, ...]:
        """For each part, the first part that has the same grid."""
        first: dict[str, int] = {}
        return tuple(first.setdefault(p.grid.digest, k) for k, p in enumerate(self.parts))

    def _check_copy(self, part: Part, where: str) -> None:
        """Raise where a part is a copy of what is no part, a copy itself, or another grid."""
        if part.copy_of is None:
            return
        self._known(part.copy_of, where)
        source = self.parts[self.places_of[part.copy_of]]
        if source.copy_of is not None:
            raise wrong(where, f"is {shown(part.copy_of)}, a copy itself; name what it copies")
        if source.grid.digest != part.grid.digest:
            raise wrong(where, f"is {shown(part.copy_of)}, whose grid is another one")

    def _known(self, name: str, where: str) -> None:
        if name not in self.places_of:
            names = ", ".join(part.name for part in self.parts[:8])
            dots = ", ..." if len(self.parts) > 8 else ""
            raise wrong(where, f"is {shown(name)}; the parts are {names}{dots}")


def wrong(where: str, text: str) -> InputError:
    """Return the error that says what is wrong at a place of an assembly."""
    return InputError(f"{where} {text}", "assembly", where)


def rotation(turn: Sequence[Sequence[float]], where: str) -> np.ndarray:
    """Return the rotation (3, 3) that rounded numbers mean.

    Raises:
        InputError: they are farther from every rotation than rounding comes.
    """
    matrix = np.asarray(turn, dtype=np.float64)
    u, _, v = np.linalg.svd(matrix)
    nearest: np.ndarray = u @ v
    if np.linalg.det(matrix) <= 0 or np.abs(nearest - matrix).max() > 1e-4:
        text = "is no rotation; its rows are three unit vectors square to each other, right-handed"
        raise wrong(where, text)
    return nearest


def _once(names: Sequence[str], where: str, key: str) -> None:
    """Raise where a name occurs twice."""
    for k, name in enumerate(names):
        if not name:
            raise wrong(f"{where}[{k}]{key}", "is empty; it is a name")
        if name in names[:k]:
            raise wrong(f"{where}[{k}]{key}", f"is {shown(name)} again; a name belongs to one")


def _first(seen: dict[str, str], name: str, where: str, what: str) -> None:
    """Raise where a part does again what it does once."""
    if name in seen:
        raise wrong(where, f"is {shown(name)} again, after {seen[name]}; a part {what} once")
    seen[name] = where
