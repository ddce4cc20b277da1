"""What stands around the moves of a print whatever the profile says: modes, heating, an end."""

from collections.abc import Iterator

from simulearn.fabricate.code import lift
from simulearn.fabricate.firmware import FACTORS, limits
from simulearn.fabricate.printer import Printer
from simulearn.fabricate.settings import Settings
from simulearn.fabricate.state import State


def modes(printer: Printer) -> Iterator[str]:
    """Yield what sets millimetres, absolute coordinates, how E is counted, and the factors."""
    yield "; SimuLearn: units and modes"
    yield "G21"
    yield "G90"
    yield "M83" if printer.extruder.extrusion == "relative" else "M82"
    yield from FACTORS


def begin(printer: Printer) -> Iterator[str]:
    """Yield what stands before the start code."""
    yield from modes(printer)
    if printer.firmware != "sailfish":  # there it would set the places of all axes
        yield "G92 E0"


def before(settings: Settings, printer: Printer, state: State) -> Iterator[str]:
    """Yield what stands between the start code and the first move.

    Args:
        settings: temperatures, retraction, accelerations.
        printer: in whose dialect.
        state: of the machine after the start code.
    """
    yield from modes(printer)  # again, since the start code may have set others
    yield "G92 E0"
    yield "; SimuLearn: acceleration and corner speed that the print assumes"
    yield from limits(settings, printer)
    if not state.clear:
        yield f"{lift(settings, printer)} ; off the bed before the nozzle is hot"
    if settings.bed > 0:
        yield f"M190 S{settings.bed:g}"
    yield f"M109 S{settings.temperature:g}"
    if drawn := round(state.back if state.back_known else settings.retraction, 5):
        yield "; SimuLearn: the filament that the end of the print before drew back"
        yield f"G1 E{drawn:g} F{settings.retraction_speed:g}"
        yield "G92 E0"
    yield "M106 S255" if settings.fan_first_layer else "M107"
    yield ";LAYER_COUNT:" + str(settings.layers)


def after(printer: Printer) -> Iterator[str]:
    """Yield what stands between the last move and the end code."""
    if printer.code.progress:
        yield "M73 P100 R0"
    yield "; SimuLearn: fan and heaters off; in the end code E counts from its last value"
    yield "M107"
    yield "M104 S0"
    yield "M140 S0"
    yield "G90"
    yield "M83"
    yield "G92 E0"


def off(state: State) -> Iterator[str]:
    """Yield what stands after the end code, in a state in which it leaves the machine."""
    if state.heats:
        yield "; SimuLearn: heaters off, which the end code left on"
        yield "M104 S0"
        yield "M140 S0"
