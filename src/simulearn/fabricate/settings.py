"""The settings of a print: the material's, what a profile overrides, and warnings about that.

The curl of a beam was measured with the material's line, speed, flow, temperature and fan. A
printer may need others; a warning then says that the measured curl no longer holds.
"""

from dataclasses import dataclass
from math import floor, pi

from simulearn.errors import InputError
from simulearn.fabricate.printer import Printer
from simulearn.fabricate.toolpath import ACTIVE, BRIM, JOINT, PASSIVE, SHELL, SKIRT
from simulearn.grid import Message
from simulearn.material import Material
from simulearn.material.material import Print

# Settings of the machine rather than of the material: a profile changes them without a warning.
HARMLESS = {"speed_skirt", "speed_travel", "speed_z", "skirt_distance", "retraction"}
HARMLESS |= {"retraction_speed", "brim"}
UNITS = {
    "layer": " mm",
    "line_width": " mm",
    "nozzle": " mm",
    "temperature": " C",
    "bed": " C",
    "speed_fill": " mm/min",
    "speed_shell": " mm/min",
    "acceleration": " mm/s2",
    "corner_speed": " mm/s",
    "first_layer_speed": " mm/min",
    "first_layer_height": " mm",
    "brim": " mm",
}
# What any printer may do; a value beyond is a mistake in writing.
RANGES = {
    "layer": (0.02, 2.0),
    "line_width": (0.1, 4.0),
    "nozzle": (0.1, 4.0),
    "temperature": (1.0, 600.0),
    "bed": (0.0, 300.0),
    "speed_fill": (30.0, 60000.0),
    "speed_shell": (30.0, 60000.0),
    "speed_skirt": (30.0, 60000.0),
    "speed_travel": (30.0, 60000.0),
    "speed_z": (10.0, 60000.0),
    "flow_active": (0.2, 3.0),
    "flow_passive": (0.2, 3.0),
    "flow_joint": (0.2, 3.0),
    "shell_overlap": (0.0, 1.0),
    "infill": (0.05, 1.0),
    "skirt_distance": (0.0, 500.0),
    "retraction": (0.0, 20.0),
    "retraction_speed": (10.0, 60000.0),
    "acceleration": (10.0, 100000.0),
    "corner_speed": (0.1, 1000.0),
    "first_layer_speed": (30.0, 60000.0),
    "first_layer_height": (0.0, 2.0),
    "first_layer_flow": (0.2, 3.0),
    "brim": (0.0, 100.0),
}
WIDEST = 2.0  # a bead wider than so many nozzles tears
ROUNDING = 1e-6


@dataclass(frozen=True)
class Settings:
    """Everything that a toolpath and its file are made with; mm, mm/min, mm/s2, C.

    Attributes:
        layers: number of layers; the lower half of them is the bottom half of a beam.
        layer: thickness of each, but for those of the bottom half if the first has its own.
        heights: thickness of each layer, from the bed up.
        line: width of a row; rows tile the width of a beam.
        shells: how many rows on each side run along the outline.
        overlap: by how much a stroke of the fill reaches beyond its end.
        infill: share of the rows that is filled.
        nozzle: width of the opening.
        filament: diameter.
        temperature: of the nozzle.
        bed: of the bed, 0 being off.
        speed: of the beads, by role.
        flow: extruded volume over that of a rectangular bead, by role.
        first_layer_speed: beads of the first layer are no faster.
        first_layer_flow: flow of the first layer over that of the others.
        acceleration: while printing: the material's, or the machine's where that is lower or the
            file cannot set it.
        corner_speed: at which a right angle is taken, likewise, mm/s.
        travel: speed of travels.
        acceleration_travel: of travels, the machine's, or that of prints where it has one for both.
        speed_z: of lifts.
        lift: how far the nozzle lifts to travel.
        retraction: how much filament is drawn back to travel.
        retraction_speed: how fast.
        skirt_distance: of the skirt from the grids.
        brim: width of the brim around each grid, 0 if there is none.
        fan_first_layer: whether the fan blows on the first layer.
        fan: whether it blows on the others.
        density: of the filament, g/mm3.
    """

    layers: int
    layer: float
    heights: tuple[float, ...]
    line: float
    shells: int
    overlap: float
    infill: float
    nozzle: float
    filament: float
    temperature: float
    bed: float
    speed: dict[str, float]
    flow: dict[str, float]
    first_layer_speed: float
    first_layer_flow: float
    acceleration: float
    corner_speed: float
    travel: float
    acceleration_travel: float
    speed_z: float
    lift: float
    retraction: float
    retraction_speed: float
    skirt_distance: float
    brim: float
    fan_first_layer: bool
    fan: bool
    density: float

    @property
    def filament_area(self) -> float:
        """Section of the filament, mm2."""
        return pi * self.filament**2 / 4


def extrusion(length: float, width: float, height: float, filament: float) -> float:
    """Return how much filament a rectangular bead takes, mm.

    Args:
        length: of the bead, mm.
        width: of the bead, mm.
        height: of the bead, mm.
        filament: diameter, mm.
    """
    return length * width * height / (pi * filament**2 / 4)


def settings_of(material: Material, printer: Printer) -> tuple[Settings, list[Message]]:
    """Return how a material is printed on a printer, and warnings of what departs from it.

    Raises:
        InputError: the printer cannot print this material, or a setting makes no sense.
    """
    overrides = printer.print
    ours = Print.model_validate(material.print.model_dump() | overrides)
    for key, (least, most) in RANGES.items():
        if not least <= getattr(ours, key) <= most:
            raise InputError(
                f"{_where(printer, key)}{key} is {getattr(ours, key):g}{UNITS.get(key, '')}; "
                f"it lies between {least:g} and {most:g}"
            )
    warnings = [
        Message(
            "override",
            f"print.{key}",
            f"{printer.name} prints with {key} {_shown(value)}{UNITS.get(key, '')} instead of "
            f"{_shown(getattr(material.print, key))}; the curl was measured with the latter",
        )
        for key, value in overrides.items()
        if key not in HARMLESS and getattr(material.print, key) != value
    ]
    _temperatures(printer, ours)
    layers = _layers(material, ours)
    rows = round(material.as_laid.width / ours.line_width)
    line = material.as_laid.width / max(rows, 1)
    shells = max(1, floor(material.as_laid.shell / line + ROUNDING))
    if rows < 2 * shells + 2:
        raise InputError(
            f"line_width is {ours.line_width:g} mm; a beam of {material.as_laid.width:g} mm needs "
            f"{2 * shells + 2} rows or more, so a line of at most "
            f"{material.as_laid.width / (2 * shells + 2):.2f} mm"
        )
    if ours.nozzle > line + ROUNDING:
        raise InputError(
            f"the nozzle of {printer.name} is {ours.nozzle:g} mm, wider than a shell row of "
            f"{line:.3g} mm; fit a nozzle of at most {line:.3g} mm and write it under [print]"
        )
    if line > WIDEST * ours.nozzle + ROUNDING:
        raise InputError(
            f"the nozzle of {printer.name} is {ours.nozzle:g} mm, too narrow for a line of "
            f"{line:.3g} mm; fit one of {line / WIDEST:.3g} to {line:.3g} mm"
        )
    heights = _heights(material, ours, layers)
    if max(heights) > ours.nozzle:
        raise InputError(
            f"a layer of {max(heights):g} mm is thicker than the nozzle of {ours.nozzle:g} mm is "
            f"wide; it would not stick to the one below"
        )
    warnings += _too_fast(printer, ours)
    acceleration, corner_speed = printer.motion.acceleration, printer.motion.corner_speed
    if printer.sets_limits:
        acceleration = min(ours.acceleration, acceleration)
        corner_speed = min(ours.corner_speed, corner_speed)
    speed = {SKIRT: ours.speed_skirt, BRIM: ours.speed_skirt, SHELL: ours.speed_shell}
    flow = dict.fromkeys((SKIRT, BRIM, SHELL, ACTIVE), ours.flow_active)
    return (
        Settings(
            layers=layers,
            layer=ours.layer,
            heights=heights,
            line=line,
            shells=shells,
            overlap=ours.shell_overlap * line,
            infill=ours.infill,
            nozzle=ours.nozzle,
            filament=printer.extruder.filament,
            temperature=ours.temperature,
            bed=ours.bed,
            speed=speed | dict.fromkeys((ACTIVE, PASSIVE, JOINT), ours.speed_fill),
            flow=flow | {PASSIVE: ours.flow_passive, JOINT: ours.flow_joint},
            first_layer_speed=ours.first_layer_speed,
            first_layer_flow=ours.first_layer_flow,
            acceleration=acceleration,
            corner_speed=corner_speed,
            travel=min(ours.speed_travel, printer.motion.speed),
            acceleration_travel=acceleration
            if printer.one_acceleration
            else printer.motion.acceleration_travel,
            speed_z=min(ours.speed_z, printer.motion.speed_z),
            lift=printer.extruder.lift,
            retraction=ours.retraction,
            retraction_speed=ours.retraction_speed,
            skirt_distance=ours.skirt_distance,
            brim=ours.brim,
            fan_first_layer=ours.fan_first_layer,
            fan=ours.fan,
            density=material.gravity.density * 1e6,
        ),
        warnings,
    )


def _temperatures(printer: Printer, ours: Print) -> None:
    least, most = printer.temperature.nozzle_least, printer.temperature.nozzle_most
    if not least <= ours.temperature <= most:
        raise InputError(
            f"{_where(printer, 'temperature')}temperature is {ours.temperature:g} C; the nozzle "
            f"of {printer.name} prints at {least:g} to {most:g} C"
        )
    if ours.bed > printer.temperature.bed_most:
        raise InputError(
            f"{_where(printer, 'bed')}bed is {ours.bed:g} C; the bed of {printer.name} reaches "
            f"at most {printer.temperature.bed_most:g} C"
        )


def _layers(material: Material, ours: Print) -> int:
    """Return the number of layers; each half of a beam has an integer number of them."""
    half = material.as_laid.thickness / 2
    count = round(half / ours.layer)
    if not count or abs(count * ours.layer - half) > 1e-3 * half:
        raise InputError(
            f"layers of {ours.layer:g} mm do not fill half a beam of {half:g} mm; "
            f"{half / max(count, 1):.4g} mm would"
        )
    return 2 * count


def _heights(material: Material, ours: Print, layers: int) -> tuple[float, ...]:
    """Return the thickness of each layer; a half is as thick as without a first layer of its own.

    Raises:
        InputError: nothing sensible is left for the other layers of the bottom half.
    """
    first, others = ours.first_layer_height, layers // 2 - 1
    if not first:
        return (ours.layer,) * layers
    half = material.as_laid.thickness / 2
    rest = (half - first) / others if others else half
    least, most = RANGES["layer"]
    if not (least <= first and least <= rest <= most) or (not others and first != half):
        raise InputError(
            f"first_layer_height is {first:g} mm; the other {others} layers of the bottom half, "
            f"which is {half:g} mm thick, would have {(half - first) / max(others, 1):.3g} mm each"
        )
    return (first, *(rest,) * others, *(ours.layer,) * (layers // 2))


def _too_fast(printer: Printer, ours: Print) -> list[Message]:
    return [
        Message(
            "too-fast",
            f"print.{key}",
            f"{printer.name} moves at most {printer.motion.speed:g} mm/min and will print slower "
            f"than {key} {getattr(ours, key):g}; the curl was measured with the latter",
        )
        for key in ("speed_fill", "speed_shell")
        if getattr(ours, key) > printer.motion.speed
    ]


def _where(printer: Printer, key: str) -> str:
    return f"{printer.name}: print." if key in printer.print else "the material's "


def _shown(value: float | bool) -> str:
    return ("off", "on")[value] if isinstance(value, bool) else f"{value:g}"
