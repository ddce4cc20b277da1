"""A tiling and its settings: what is asked for, how far it is, what was found."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import Message
from simulearn.grid import Grid
from simulearn.material import load_material
from simulearn.tile.alike import MIRROR, Member
from simulearn.tile.borders import Fit
from simulearn.tile.patches import Tiling
from simulearn.tile.searching import ModuleAnswer

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Settings:
    """How a surface is tiled.

    Attributes:
        alike_mm: largest distance of targets of modules that are designed as one.
        gap_mm: largest gap between two modules, at which the rounds end.
        inset_mm: how far the axes of modules' beams keep from their patches' borders; None: half
            the width of a beam, so that beams of neighbours lie side by side. With 0 they would
            be in the same place.
        rounds: in which shared borders are brought together, at most.
        seconds: of all of it, at most; None: no limit. What was begun then ends.
        engine: "learned" or "beams".
        model: of the engine; None: its default.
        material: name or path.
        ratio: step of the actuators' ratios.
    """

    alike_mm: float = 0.25
    gap_mm: float = 1.0
    inset_mm: float | None = None
    rounds: int = 3
    seconds: float | None = None
    engine: str = "learned"
    model: str | None = None
    material: str = "pla-hot-water"
    ratio: float = 0.05


DEFAULT = Settings()


@dataclass(frozen=True)
class Stage:
    """How far a tiling is.

    Attributes:
        round: 0 is the first search of every kind.
        done: searches of the round that are finished.
        total: searches of the round.
        gap_mm: largest gap after the last round; None before it.
        error_mm: mean distance of joints from their targets, likewise.
    """

    round: int
    done: int
    total: int
    gap_mm: float | None = None
    error_mm: float | None = None


@dataclass(frozen=True, eq=False)
class Tiled:
    """A surface that is tiled.

    Attributes:
        tiling: the patches.
        settings: how.
        members: how each module is of its kind.
        grids: of the kinds.
        answers: of the kinds.
        fit: the modules in their places.
        rounds: after each round the gap and the error, mm.
        seconds: of this run.
        searching: s of computing, of all searches, earlier runs included.
        warnings: what is to be known.
    """

    tiling: Tiling
    settings: Settings
    members: tuple[Member, ...]
    grids: tuple[Grid, ...]
    answers: tuple[ModuleAnswer, ...]
    fit: Fit
    rounds: tuple[tuple[float, float], ...]
    seconds: float
    searching: float
    warnings: tuple[Message, ...]

    @property
    def width(self) -> float:
        """Width of a beam, mm."""
        return load_material(self.settings.material).section.width

    @property
    def beams(self) -> Array:
        """(M, B, 3) mm, centres of the beams' middle sections in their places."""
        beams = []
        for member, place in zip(self.members, self.fit.places, strict=True):
            middle = np.array(self.answers[member.kind].beams)[:, 1]
            beams.append(place(middle * MIRROR if member.mirrored else middle))
        return np.array(beams)


Progress = Callable[[Stage], None]
