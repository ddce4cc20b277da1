"""A print from beginning to end: grids and a printer in; toolpath, estimate and G-code out."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.fabricate.bed import place
from simulearn.fabricate.build import build
from simulearn.fabricate.code import code_messages, frame_of
from simulearn.fabricate.estimate import Estimate, durations_of, estimate
from simulearn.fabricate.gcode import gcode
from simulearn.fabricate.moves import Moves, moves_of
from simulearn.fabricate.printer import Printer, untried
from simulearn.fabricate.regions import footprint
from simulearn.fabricate.settings import Settings, settings_of
from simulearn.fabricate.short_strokes import short_strokes
from simulearn.fabricate.toolpath import BRIM, SKIRT, Toolpath
from simulearn.grid import Grid, Message, clean, outline, validate
from simulearn.material import Material, load_material

SKIRT_ROOM = 2.0  # mm beside the brim that a skirt takes at least


@dataclass(frozen=True, eq=False)
class Job:
    """A print.

    Attributes:
        grids: where they lie on the bed.
        names: of the grids.
        material: what they are printed of.
        printer: on what.
        settings: how.
        path: the toolpath.
        moves: what the machine does.
        warnings: what may be wrong with the print.
    """

    grids: tuple[Grid, ...]
    names: tuple[str, ...]
    material: Material
    printer: Printer
    settings: Settings
    path: Toolpath
    moves: Moves
    warnings: tuple[Message, ...]

    @cached_property
    def durations(self) -> NDArray[np.float64]:
        """(m,) s, of each move."""
        return durations_of(self.moves, self.settings, self.printer)

    @cached_property
    def estimate(self) -> Estimate:
        """Time and filament."""
        return estimate(self.moves, self.settings, self.printer, self.durations)

    @property
    def part_g(self) -> float:
        """Mass of the grids, without skirt and brim, g."""
        volume = sum(
            float(bead.lengths @ bead.section) * layer.height
            for layer in self.path.layers
            for bead in layer.beads
            if bead.role not in (SKIRT, BRIM)
        )
        return volume * self.settings.density

    @property
    def brim(self) -> bool:
        """Whether there is a brim, which is cut off before the bath."""
        return any(bead.role == BRIM for bead in self.path.layers[0].beads)

    @property
    def facts(self) -> dict[str, Any]:
        """What machines want to know about the print, as plain data."""
        low, high = self.path.bounds.tolist()
        return {
            "printer": self.printer.name,
            "material": self.material.name,
            "material_digest": self.material.digest,
            "grids": [
                {"name": name, "joints": grid.joints.tolist()}
                for name, grid in zip(self.names, self.grids, strict=True)
            ],
            "layers": len(self.path.layers),
            "bounds_mm": [low, high],
            **asdict(self.estimate),
            "part_g": self.part_g,
            "brim": self.brim,
            "warnings": [asdict(warning) for warning in self.warnings],
        }

    @cached_property
    def gcode(self) -> str:
        """The file's text.

        Raises:
            InputError: the printer's start or end code is wrong.
            ComputationError: a move leaves the printer's reach.
        """
        notes = [f"material = {self.material.identity}"]
        notes += [
            f"grid {k} = {name}, {len(grid.joints)} joints, {len(grid.beams)} beams"
            for k, (name, grid) in enumerate(zip(self.names, self.grids, strict=True))
        ]
        notes.append(f"the grids weigh {self.part_g:.2f} g, without skirt and brim")
        if self.brim:
            notes.append("cut the brim off before the bath")
        return gcode(
            self.path,
            self.moves,
            self.durations,
            self.estimate,
            self.settings,
            self.printer,
            self.material,
            self.names,
            notes,
            self.warnings,
        )


def prepare(
    grids: Sequence[Grid], printer: Printer, names: Sequence[str] = (), dangling: bool = False
) -> Job:
    """Return the print of one or more grids.

    Args:
        grids: designs of one material.
        printer: on what they are printed.
        names: what to call them in messages and in the file.
        dangling: whether beams that dangle are printed too, as strips for a calibration are, else
            they are taken off. Such grids are not validated, and keep off the bed's edge.

    Raises:
        InputError: a grid is not valid or larger than the bed, its material is unknown, or the
            printer cannot print it.
    """
    if not grids:
        raise InputError("there is no grid to print; give one or more")
    names = tuple(names) or tuple(f"grid {k}" for k in range(len(grids)))
    warnings: list[Message] = []
    cleaned = []
    materials = [load_material(grid.material) for grid in grids]
    for grid, material, name in zip(grids, materials, names, strict=True):
        if dangling:
            cleaned.append(grid)
            continue
        prefix = f"{name}: " if len(grids) > 1 else ""
        report = validate(grid, material)
        if not report.valid:
            first, *others = report.errors
            more = f" (and {len(others)} more)" if others else ""
            text = prefix + first.message + more
            raise InputError(text, first.code, first.where, report.errors)
        warnings += [replace(m, message=prefix + m.message) for m in report.warnings]
        cleaned.append(clean(grid)[0])
    for name, material in zip(names, materials, strict=True):
        if material != materials[0]:
            raise InputError(
                f"{names[0]} and {name} are of different materials "
                f"({materials[0].name}, {material.name}); one file prints one material"
            )
    settings, overridden = settings_of(materials[0], printer)
    if settings.layers * settings.layer > printer.bed.height:
        raise InputError(
            f"the print is {settings.layers * settings.layer:g} mm high; {printer.name} reaches "
            f"{printer.bed.height:g} mm"
        )
    section, bed = materials[0].as_laid, printer.bed
    margins = (settings.brim + SKIRT_ROOM, settings.brim) if dangling else ()
    placed = place(cleaned, section, printer, settings.brim, margins)
    path, from_build = build(placed, section, settings, bed)
    part = shapely.union_all([footprint(outline(grid, section)) for grid in placed])
    moves = moves_of(path, part, settings, np.array(bed.low), bed.height)
    warnings += untried(printer)
    warnings += code_messages(printer, settings, frame_of(path, moves))
    warnings += overridden + from_build
    warnings += short_strokes(path, moves, settings, printer, materials[0])
    return Job(tuple(placed), names, materials[0], printer, settings, path, moves, tuple(warnings))
