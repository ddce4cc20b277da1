"""Designs made ready for an engine: valid, without dangling beams, fixed joint at the origin."""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from simulearn.errors import InputError, Message
from simulearn.grid import Grid, TrainingRange, check_designs, clean, validate
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

    Grids of one topology and material are checked together. Only those with something to say about
    are checked again one by one, for the messages.

    Args:
        grids: the designs.
        training: sizes that the answering model has learnt; designs outside are warned of.
    """
    materials: dict[str | Material, Material | InputError] = {}
    groups: dict[Any, list[int]] = defaultdict(list)
    for k, grid in enumerate(grids):
        counts = len(grid.joints), len(grid.actuators)
        groups[(grid.material, grid.fixed, grid.beams.tobytes(), *counts)].append(k)
    outcomes: list[Checked | Failure | None] = [None] * len(grids)
    for members in groups.values():
        material = _material(grids[members[0]].material, materials)
        if isinstance(material, InputError):
            for k in members:
                outcomes[k] = Failure.of(grids[k], material)
            continue
        sizes = None if training is None else training.of(material)
        for k, usual in zip(members, _usual(grids, members, material, sizes), strict=True):
            grid = grids[k]
            if usual:
                outcomes[k] = Checked(grid, grid.centred, material)
            else:
                outcomes[k] = _check(grid, material, sizes)
    return [outcome for outcome in outcomes if outcome is not None]


def _usual(
    grids: Sequence[Grid], members: list[int], material: Material, training: TrainingRange | None
) -> Sequence[bool]:
    """Return which grids of one topology are valid and without any warning."""
    if len(members) == 1:
        return [False]  # alone it is checked with messages at once
    first = grids[members[0]]
    joints = np.stack([grids[k].joints for k in members])
    actuators = np.stack([grids[k].actuators for k in members])
    try:
        checks = check_designs(
            first.beams, first.fixed, joints, actuators, material, training=training
        )
    except (InputError, ValueError):  # such as beams of joints that do not exist
        return [False] * len(members)
    return checks.usual.tolist()


def _material(
    name: str | Material, known: dict[str | Material, Material | InputError]
) -> Material | InputError:
    """Return a material, each read once, or why there is none."""
    if name not in known:
        try:
            known[name] = load_material(name)
        except InputError as error:
            known[name] = error
    return known[name]


def _check(grid: Grid, material: Material, training: TrainingRange | None) -> Checked | Failure:
    report = validate(grid, material, training=training)
    if report.errors:
        first, *others = report.errors
        more = f" (and {len(others)} more errors)" if others else ""
        text = first.message + more
        return Failure(grid, first.code, first.where, text, invalid=tuple(report.errors))
    return Checked(grid, clean(grid)[0].centred, material, tuple(report.warnings))
