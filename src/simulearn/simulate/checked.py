"""Designs made ready for an engine: valid, without dangling beams, fixed joint at the origin."""

from collections.abc import Sequence
from dataclasses import dataclass

from simulearn.errors import InputError, Message
from simulearn.grid import Grid, TrainingRange, clean, validate
from simulearn.material import Material, load_material
from simulearn.simulate.result import Failure


@dataclass(frozen=True, eq=False)
class Checked:
    """A valid design.

    Attributes:
        given: the design as it was given.
        grid: the same without dangling beams and unused joints, its fixed joint at the origin.
        material: its material system.
        warnings: of its validation.
    """

    given: Grid
    grid: Grid
    material: Material
    warnings: tuple[Message, ...] = ()


def check_all(
    grids: Sequence[Grid], training: TrainingRange | None = None
) -> list[Checked | Failure]:
    """Return for each grid what is simulated, or why it is not valid.

    Args:
        grids: the designs.
        training: sizes that the answering model has learnt; designs outside are warned of.
    """
    materials: dict[str, Material | InputError] = {}
    return [_check(grid, _material(grid.material, materials), training) for grid in grids]


def _material(name: str, known: dict[str, Material | InputError]) -> Material | InputError:
    """Return a material, each read once, or why there is none."""
    if name not in known:
        try:
            known[name] = load_material(name)
        except InputError as error:
            known[name] = error
    return known[name]


def _check(
    grid: Grid, material: Material | InputError, training: TrainingRange | None
) -> Checked | Failure:
    if isinstance(material, InputError):
        return Failure.of(grid, material)
    report = validate(grid, material, training=training)
    if report.errors:
        first, *others = report.errors
        more = f" (and {len(others)} more errors)" if others else ""
        text = first.message + more
        return Failure(grid, first.code, first.where, text, invalid=tuple(report.errors))
    return Checked(grid, clean(grid)[0].centred, material, tuple(report.warnings))
