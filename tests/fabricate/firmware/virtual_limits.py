"""What a machine can do, as plain numbers: of a profile, and of real machines by their sources."""

from dataclasses import dataclass, field

MARLIN_COLD = 170.0  # C: EXTRUDE_MINTEMP of Marlin, min_extrude_temp of Klipper
REPRAP_COLD = 160.0  # C: DefaultMinExtrusionTemperature of RepRapFirmware


@dataclass(frozen=True)
class Limits:
    """A machine's limits, mm and C.

    Attributes:
        firmware: which firmware reads the file.
        reach: ((x, x), (y, y), (z, z)) between which the nozzle moves.
        bed: ((x, y), (x, y)) on which beads lie.
        round_bed: whether the bed is the circle in that square.
        excluded: rectangles ((x, y), (x, y)) in which no bead lies.
        nozzle_most: hottest nozzle.
        bed_most: hottest bed.
        nozzle: width of the opening.
        filament: diameter.
        printing: temperature at which it is printed.
    """

    firmware: str
    reach: tuple[tuple[float, float], ...]
    bed: tuple[tuple[float, float], tuple[float, float]]
    round_bed: bool = False
    excluded: tuple = field(default=())
    nozzle_most: float = 300.0
    bed_most: float = 120.0
    nozzle: float = 0.6
    filament: float = 1.75
    printing: float = 205.0

    @property
    def cold(self) -> float:
        """Below this temperature (C) filament is not moved."""
        return REPRAP_COLD if self.firmware == "reprap" else MARLIN_COLD


def of_profile(printer, printing: float = 205.0) -> Limits:
    """Return what a profile says of its machine."""
    bed, reach = printer.bed, printer.reach
    (x0, y0), (x1, y1) = bed.low, bed.high
    return Limits(
        printer.firmware,
        (_both((x0, x1), reach.x), _both((y0, y1), reach.y), _both((0.0, bed.height), reach.z)),
        ((x0, y0), (x1, y1)),
        bed.shape == "round",
        tuple(bed.excluded),
        printer.temperature.nozzle_most,
        printer.temperature.bed_most,
        float(printer.print.get("nozzle", 0.6)),
        printer.extruder.filament,
        float(printer.print.get("temperature", printing)),
    )


def _both(bed: tuple[float, float], reach: tuple[float, float] | None) -> tuple[float, float]:
    """Return the span of the bed with that by which the machine reaches beyond it."""
    return bed if reach is None else (min(bed[0], reach[0]), max(bed[1], reach[1]))
