"""Which materials and meshes a model has learnt, and how far another material is beyond them."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.material import Material, Member, member_of

WORDS = {
    "strain": "strain of the active half",
    "passive": "strain of the passive half over it",
    "joint": "strain of joints over it",
    "shell": "strain of shells over it",
    "curl": "own curl over it",
    "slender": "width over thickness",
    "rim": "shell over width",
    "weight": "weight over stiffness",
    "creep": "creep",
}
ROUNDING = 1e-6  # of a number's size: what differs by less is the same


@dataclass(frozen=True, eq=False)
class Learnt:
    """Ranges of what was learnt.

    Attributes:
        ranges: (2, M) least and most of each number of `Member`.
        finest: 1 where there were trials by the fine mesh, else 0.
    """

    ranges: NDArray[np.float64]
    finest: float

    def beyond(self, material: Material) -> dict[str, tuple[float, float, float, float]]:
        """Return the numbers of a material that were not learnt: (value, least, most, far).

        How far it is beyond is counted in widths of the range, infinite where that has none.
        """
        out = {}
        for name, value, least, most in zip(
            Member._fields, member_of(material), *self.ranges, strict=True
        ):
            rounding = ROUNDING * max(abs(least), abs(most))
            away = max(least - value, value - most)
            if away > rounding:
                width = most - least
                out[name] = (value, least, most, away / width if width > rounding else np.inf)
        return out

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """Return the ranges by name."""
        return {"ranges": self.ranges, "finest": np.array(self.finest)}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, NDArray[Any]]) -> "Learnt":
        """Return the ranges of a bundle.

        Raises:
            InputError: they are missing or have the wrong shape.
        """
        ranges, finest = arrays.get("ranges"), arrays.get("finest")
        shape = (2, len(Member._fields))
        if ranges is None or finest is None or ranges.shape != shape or finest.size != 1:
            raise InputError("weight learnt.ranges is missing, or does not fit this version")
        return cls(np.asarray(ranges, np.float64), float(finest))


def learnt_of(materials: Iterable[Material], finest: float) -> Learnt:
    """Return the ranges of some materials."""
    members = np.array([member_of(material) for material in materials])
    return Learnt(np.stack([members.min(axis=0), members.max(axis=0)]), finest)
