"""The family of materials: what a material is in numbers without a unit.

Growth is I + s diag(g), so a strain k times as large is the released fraction s running to k. With
lengths in thicknesses h and forces in E h^2, a grid of half the section and half the lengths under
twice the specific weight is the same grid. So two materials with the same numbers here (and a law
of the same form) morph alike, whatever their absolute size and stiffness.
"""

from collections.abc import Callable
from typing import Annotated, NamedTuple

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from simulearn.material.material import Material


class Member(NamedTuple):
    """A material in numbers without a unit.

    Attributes:
        strain: released strain of the active half.
        passive, joint, shell: released strains of passive half, joints and shells, over it.
        curl: what the top shrinks more than the bottom, over it.
        slender: width over thickness.
        rim: width of a shell over that of the section.
        weight: weight of a cube of one thickness over the force E h^2: rho g h / E.
        creep: creep strain over elastic strain.
    """

    strain: float
    passive: float
    joint: float
    shell: float
    curl: float
    slender: float
    rim: float
    weight: float
    creep: float


def member_of(material: Material) -> Member:
    """Return the numbers of a material; ratios of one without active strain are those of PLA."""
    shrinkage, section = material.shrinkage, material.section
    strain = shrinkage.active or 1e-12
    return Member(
        strain=shrinkage.active,
        passive=shrinkage.stress_passive / shrinkage.stress_active,
        joint=shrinkage.stress_joint / shrinkage.stress_active,
        shell=shrinkage.shell / strain,
        curl=shrinkage.curl / strain,
        slender=section.width / section.thickness,
        rim=section.shell / section.width,
        weight=material.gravity.body_force * section.thickness / material.law.stiffness,
        creep=material.creep.amplitude,
    )


def _rising(values: tuple[float, float]) -> tuple[float, float]:
    if values[1] < values[0]:
        raise ValueError("the values must rise")
    return values


_Range = Annotated[tuple[float, float], AfterValidator(_rising)]


class Family(BaseModel):
    """Ranges from which random members are drawn; what is left out has the value given here.

    Attributes:
        nominal: part of the members that are the base material itself.
        strain, weight: over that of the base material.
        passive, joint, shell, curl, slender, rim, creep: see `Member`.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    nominal: Annotated[float, Field(ge=0, le=1)] = 0.0
    strain: _Range = (0.6, 1.4)
    passive: _Range = (0.5, 0.95)
    joint: _Range = (0.5, 0.95)
    shell: _Range = (0.8, 1.2)
    curl: _Range = (-0.3, 0.3)
    slender: _Range = (1.2, 2.6)
    rim: _Range = (0.08, 0.18)
    weight: _Range = (0.0, 2.5)
    creep: _Range = (0.0, 0.4)


def draw_member(family: Family, base: Material, uniform: Callable[[], float]) -> Material:
    """Return a random member of a family.

    Args:
        family: the ranges.
        base: the material whose thickness, law, print settings and limits it has.
        uniform: draws from [0, 1).
    """
    draws = {name: uniform() for name in ("nominal", *Member._fields)}
    if draws["nominal"] < family.nominal:
        return base

    def within(name: str) -> float:
        low, high = getattr(family, name)
        return round(low + (high - low) * draws[name], 6)

    old, section = base.shrinkage, base.section
    active = old.active * within("strain")
    width = section.thickness * within("slender")
    return base.model_copy(
        update={
            "name": f"{base.name} member",
            "section": section.model_copy(
                update={"width": width, "shell": round(width * within("rim"), 6)}
            ),
            "shrinkage": old.model_copy(
                update={
                    "active": active,
                    "shell": active * within("shell"),
                    "stress_passive": old.stress_active * within("passive"),
                    "stress_joint": old.stress_active * within("joint"),
                    "curl": active * within("curl"),
                }
            ),
            "gravity": base.gravity.model_copy(
                update={"density": max(base.gravity.density * within("weight"), 1e-15)}
            ),
            "creep": base.creep.model_copy(update={"amplitude": within("creep")}),
        }
    )
