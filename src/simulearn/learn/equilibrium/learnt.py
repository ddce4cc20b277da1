"""Which materials and meshes a model has learnt, and how far another material is beyond them."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.material import Material, Member, member_of

FAR = 0.5  # widths of a range beyond it, from which on there is no answer
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

    def wrong(self, material: Material, base: Material) -> str | None:
        """Return why there is no answer for a material, None where there may be one.

        Args:
            material: the material system.
            base: the one whose family was learnt.
        """
        if form_of(material) != form_of(base):
            return "its law is of another form (kind, Poisson ratio, or stress over modulus)"
        far = {k: v for k, v in self.beyond(material).items() if not v[3] <= FAR}
        return _listed(far) if far else None

    def remark(self, material: Material) -> str | None:
        """Return which numbers of a material are outside what was learnt, None where none is."""
        beyond = self.beyond(material)
        return _listed(beyond) if beyond else None

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


def form_of(material: Material) -> tuple[Any, ...]:
    """Return the form of a material's law: what is left of it in units of its modulus."""
    law = material.law
    table = getattr(law, "table", ())
    rows = tuple((round(e, 9), round(stress / law.modulus, 9)) for e, stress in table)
    return law.kind, round(law.poisson, 6), rows


def _listed(numbers: Mapping[str, tuple[float, float, float, float]]) -> str:
    return "; ".join(
        f"its {WORDS[name]} is {value:.4g}, learnt "
        + (f"{least:.4g}" if least == most else f"{least:.4g} to {most:.4g}")
        for name, (value, least, most, _) in numbers.items()
    )


def learnt_of(materials: Iterable[Material], finest: float) -> Learnt:
    """Return the ranges of some materials."""
    members = np.array([member_of(material) for material in materials])
    return Learnt(np.stack([members.min(axis=0), members.max(axis=0)]), finest)
