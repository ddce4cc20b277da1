"""The steps of an analysis: gravity, release, creep."""

from dataclasses import dataclass

from simulearn.material import Material
from simulearn.schedule import SCHEDULE


@dataclass(frozen=True)
class Step:
    """State at the end of a step.

    Attributes:
        release: released fraction s.
        load: body force towards -z, N/mm3.
        frame: the frame that this state is, or None.
    """

    release: float
    load: float
    frame: int | None


def schedule(material: Material, parts: int = 1) -> list[Step]:
    """Return the steps that lead to frames 1 to 11.

    Gravity comes first, in a step of its own: CalculiX raises a load little by little, but lets a
    strain act at once, and both together converge badly. Creep multiplies gravity by
    1 + amplitude, which is dividing all elastic energy by it: the quasi-elastic solution.

    Args:
        material: material system.
        parts: steps per tenth of release; more help where one tenth at once does not converge.
    """
    load = material.gravity.body_force
    steps = [Step(0.0, load, None)] if load else []
    count = SCHEDULE.steps * parts
    for k in range(1, count + 1):
        frame, rest = divmod(k, parts)
        steps.append(Step(k / count, load, None if rest else frame))
    return [*steps, Step(1.0, load * (1 + material.creep.amplitude), SCHEDULE.steps + 1)]
