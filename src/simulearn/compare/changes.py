"""Changes of one figure of a material, as a calibration would make them, each within the family."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from simulearn.material import Family, Material

Change = Callable[[Material, float], Material]


@dataclass(frozen=True)
class Parameter:
    """A figure of a material that may be another in a print.

    Attributes:
        name: for programs.
        words: with "{}" for its value, for people.
        value: of a material.
        apply: gives the material with another value.
        range: least and most value within the family of a base material.
        step: of a finite difference.
    """

    name: str
    words: str
    value: Callable[[Material], float]
    apply: Change
    range: tuple[float, float]
    step: float

    def said(self, value: float) -> str:
        """Return a value in words."""
        return self.words.format(value)


def parameters(base: Material, family: Family | None = None) -> list[Parameter]:
    """Return the figures of a base material that one measurement of a shape can tell of.

    Args:
        base: the material; factors are over it.
        family: the ranges.
    """
    family = family or Family()
    active = base.shrinkage.active

    def strain(material: Material, times: float) -> Material:
        old = material.shrinkage
        return _shrinking(material, active=old.active * times, shell=old.shell * times,
                          curl=old.curl * times)  # fmt: skip

    def passive(material: Material, ratio: float) -> Material:
        return _shrinking(material, stress_passive=ratio * material.shrinkage.stress_active)

    def joint(material: Material, ratio: float) -> Material:
        return _shrinking(material, stress_joint=ratio * material.shrinkage.stress_active)

    def shell(material: Material, ratio: float) -> Material:
        return _shrinking(material, shell=ratio * material.shrinkage.active)

    def curl(material: Material, value: float) -> Material:
        return _shrinking(material, curl=value)

    def weight(material: Material, times: float) -> Material:
        gravity = material.gravity
        density = max(gravity.density * times, 1e-15)
        return material.model_copy(
            update={"gravity": gravity.model_copy(update={"density": density})}
        )

    def creep(material: Material, amplitude: float) -> Material:
        return material.model_copy(
            update={"creep": material.creep.model_copy(update={"amplitude": amplitude})}
        )

    every = [
        Parameter("strain", "a strain of {:.2f} times", _one, strain, family.strain, 0.1),
        Parameter("passive", "a passive ratio of {:.2f}", _passive, passive, family.passive, 0.08),
        Parameter("joint", "a joint ratio of {:.2f}", _joint, joint, family.joint, 0.08),
        Parameter("shell", "a shell ratio of {:.2f}", _shell, shell, family.shell, 0.1),
        Parameter("curl", "an own curl of {:+.4f}", _curl, curl,
                  (family.curl[0] * active, family.curl[1] * active), 0.05 * active),
        Parameter("weight", "a weight of {:.2f} times (or the stiffness over it)", _one, weight,
                  family.weight, 0.4),
        Parameter("creep", "a creep of {:.2f}", _creep, creep, family.creep, 0.08),
    ]  # fmt: skip
    if not active:  # ratios over no strain say nothing
        every = [one for one in every if one.name not in ("strain", "passive", "joint", "shell")]
    return every


def steps(parameter: Parameter, base: Material) -> tuple[float, float]:
    """Return two values of a parameter around that of a material, those that it can have."""
    value = parameter.value(base)
    low, high = value - parameter.step, value + parameter.step
    if parameter.name in ("creep", "weight") and low < 0:
        low = 0.0 if value > 0 else high + parameter.step
    return low, high


def possible(parameter: Parameter, value: float) -> float:
    """Return the nearest value that a material may have at all."""
    if parameter.name == "curl":
        return float(np.clip(value, -0.45, 0.45))
    return max(value, 0.05 if parameter.name == "strain" else 0.0)


def _shrinking(material: Material, **values: float) -> Material:
    shrinkage = material.shrinkage.model_copy(update=values)
    return material.model_copy(update={"shrinkage": shrinkage})


def _one(material: Material) -> float:
    return 1.0


def _passive(material: Material) -> float:
    return material.shrinkage.stress_passive / material.shrinkage.stress_active


def _joint(material: Material) -> float:
    return material.shrinkage.stress_joint / material.shrinkage.stress_active


def _shell(material: Material) -> float:
    return material.shrinkage.shell / material.shrinkage.active


def _curl(material: Material) -> float:
    return material.shrinkage.curl


def _creep(material: Material) -> float:
    return material.creep.amplitude
