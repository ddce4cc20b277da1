"""What stands around the moves of a print whatever the profile says: modes, heating, an end."""

from collections.abc import Iterator

from simulearn.fabricate.printer import Printer
from simulearn.fabricate.settings import Settings


def modes(printer: Printer) -> Iterator[str]:
    """Yield what sets millimetres, absolute coordinates and how E is counted."""
    yield "; SimuLearn: units and modes"
    yield "G21"
    yield "G90"
    yield "M83" if printer.extruder.extrusion == "relative" else "M82"


def before(settings: Settings, printer: Printer) -> Iterator[str]:
    """Yield what stands between the start code and the first move."""
    yield from modes(printer)  # again, since the start code may have set others
    yield "G92 E0"
    if settings.bed > 0:
        yield f"M190 S{settings.bed:g}"
    yield f"M109 S{settings.temperature:g}"
    yield "M106 S255" if settings.fan_first_layer else "M107"
    yield ";LAYER_COUNT:" + str(settings.layers)


def after(printer: Printer) -> Iterator[str]:
    """Yield what stands between the last move and the end code."""
    if printer.code.progress:
        yield "M73 P100 R0"
    yield "; SimuLearn: fan and heaters off"
    yield "M107"
    yield "M104 S0"
    yield "M140 S0"
