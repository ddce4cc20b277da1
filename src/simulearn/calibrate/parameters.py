"""What is fitted: numbers of the family, what is held likely before a print, and their material.

Shapes tell weight over stiffness only, not each alone; the fitted material has the base's density
and a law that is scaled. In the last frame creep by phi is the same as 1 + phi times the weight
(see `fea.trial`), so creep stays the base's, and `load` stands for both.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.material import Family, Material
from simulearn.material.family import member_of
from simulearn.material.material import Laid

Numbers = NDArray[np.float64]


class Parameter(NamedTuple):
    """A number that is fitted.

    Attributes:
        name: what it is called.
        low, high: range that the family has, and the fit keeps to.
        sd: how far materials of the family lie from one another, as a standard deviation.
        step: for finite differences.
        words: what it is.
    """

    name: str
    low: float
    high: float
    sd: float
    step: float
    words: str


WORDS = {
    "strain": "released strain of the active half, over the base's",
    "passive": "that of the passive half over the active one's",
    "joint": "that of the joints over the active one's",
    "shell": "that of the shells over the active one's",
    "curl": "own curl: what the top shrinks more than the bottom, over the active strain",
    "load": "weight over stiffness, with creep, over the base's",
}
STEPS = {"strain": 0.02, "passive": 0.04, "joint": 0.04, "shell": 0.04, "curl": 0.02, "load": 0.05}
FAMILY = Family()
LEAST_LOAD = 0.02  # a law cannot be infinitely stiff


def parameters(base: Material, family: Family = FAMILY) -> tuple[Parameter, ...]:
    """Return what is fitted to a plate of a base material.

    Args:
        base: a material; numbers of strain and load are over its own.
        family: how much materials differ; a range's standard deviation is that of a uniform draw.
    """
    creep = 1 + member_of(base).creep
    most = family.weight[1] * (1 + family.creep[1]) / creep
    ranges = {name: getattr(family, name) for name in WORDS if name != "load"}
    ranges["load"] = (LEAST_LOAD, most)
    values = base_values(base)
    found = []
    for k, (name, (low, high)) in enumerate(ranges.items()):
        low, high = min(low, values[k]), max(high, values[k])
        sd = (high - low) / 12**0.5
        found.append(Parameter(name, low, high, sd, STEPS[name], WORDS[name]))
    return tuple(found)


def check_base(base: Material) -> None:
    """Make sure that numbers can be fitted as parts of the base's own.

    Raises:
        InputError: the base has no strain or no weight.
    """
    for key, value in (
        ("shrinkage.active", base.shrinkage.active),
        ("gravity.acceleration", base.gravity.acceleration),
    ):
        if not value:
            raise InputError(
                f"the base material {base.name} has {key} = 0, and what is fitted is how many "
                "times as large it is; take a base that strains and weighs something",
                "calibration-base",
                key,
            )


def base_values(base: Material) -> Numbers:
    """Return the numbers (P,) of the base material itself."""
    member = member_of(base)
    return np.array([1.0, member.passive, member.joint, member.shell, member.curl, 1.0])


def values_of(material: Material, base: Material) -> Numbers:
    """Return the numbers (P,) of any material over those of a base."""
    one, other = member_of(material), member_of(base)
    load = one.weight * (1 + one.creep) / (other.weight * (1 + other.creep))
    return np.array([one.strain / other.strain, *one[1:5], load])


def material_with(base: Material, values: Numbers) -> Material:
    """Return the base material with other numbers (P,)."""
    strain, passive, joint, shell, curl, load = map(float, values)
    old = base.shrinkage
    active = old.active * strain
    return base.model_copy(
        update={
            "shrinkage": old.model_copy(
                update={
                    "active": active,
                    "shell": active * shell,
                    "stress_passive": old.stress_active * passive,
                    "stress_joint": old.stress_active * joint,
                    "curl": active * curl,
                }
            ),
            "law": base.law.model_copy(update={"scale": base.law.scale / load}),
        }
    )


def with_section(base: Material, width: float | None, thickness: float | None) -> Material:
    """Return the base material with the section that was measured, mm; None keeps the base's.

    Prints of it are laid as those of the base, which came out with this section.

    Raises:
        InputError: the shells are too wide for it.
    """
    values = {"width": width, "thickness": thickness}
    update = {key: value for key, value in values.items() if value is not None}
    section = base.section.model_copy(update=update)
    if 2 * section.shell >= section.width:
        text = f"section.width is {width:g} mm; two shells of {section.shell:g} mm leave no core"
        raise InputError(text, "calibration-value", "section.width")
    if not update:
        return base
    laid = base.laid or Laid(width=base.section.width, thickness=base.section.thickness)
    return base.model_copy(update={"section": section, "laid": laid})
