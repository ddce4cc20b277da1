"""Writing a print as G-code: header, heating, moves layer by layer, progress, and an end.

The dialect is what Marlin, RepRapFirmware, Klipper and their kin agree on: G0 and G1, one command a
line, no arcs. What must not go wrong is not left to the profile: units and modes before its start
code and after it, the wait for a hot nozzle, and heaters off at the end are always written.
"""

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import ComputationError, InputError
from simulearn.fabricate import markers
from simulearn.fabricate.around import after, before, begin, off
from simulearn.fabricate.code import end_code, frame_of, start_code
from simulearn.fabricate.estimate import Estimate
from simulearn.fabricate.header import footer, header
from simulearn.fabricate.moves import DIGITS, PRINT, RESTORE, RETRACT, TRAVEL, Moves
from simulearn.fabricate.printer import Printer
from simulearn.fabricate.settings import Settings
from simulearn.fabricate.thumbnail import thumbnails
from simulearn.fabricate.toolpath import ACTIVE, BRIM, JOINT, PASSIVE, SHELL, SKIRT, Toolpath
from simulearn.fabricate.zones import off_bed
from simulearn.files import replacing
from simulearn.grid import Message
from simulearn.material import Material

Array = NDArray[np.float64]
FEEDS = (PRINT, RETRACT, RESTORE)
# Bambu's bed is off until a file heats it; software that checks files for its printers takes a bed
# that is switched off before the print for a mistake.
BED_OFF = re.compile(r"M1[49]0 S0\b")
HIGHER = re.compile(r"G[01]\b.*Z")  # a move in z
# The names by which viewers colour lines: as Cura writes them, as BambuStudio does.
TYPES = {
    SKIRT: ("SKIRT", "Skirt"),
    BRIM: ("SKIRT", "Brim"),
    SHELL: ("WALL-OUTER", "Outer wall"),
    ACTIVE: ("SKIN", "Internal solid infill"),
    PASSIVE: ("FILL", "Sparse infill"),
    JOINT: ("WALL-INNER", "Inner wall"),
}


def gcode(
    path: Toolpath,
    moves: Moves,
    durations: Array,
    estimated: Estimate,
    settings: Settings,
    printer: Printer,
    material: Material,
    names: Sequence[str] = (),
    notes: Sequence[str] = (),
    warnings: Sequence[Message] = (),
) -> str:
    """Return a print as G-code.

    Args:
        path: the toolpath.
        moves: of the toolpath.
        durations: of the moves, (m,) s.
        estimated: time and filament.
        settings: how it is printed.
        printer: on what.
        material: of what.
        names: of the grids.
        notes: lines for the header: what is printed.
        warnings: lines for the header: what may be wrong with the print.

    Raises:
        InputError: the printer's start or end code is wrong.
        ComputationError: a move leaves the printer's reach.
    """
    check(moves, printer)
    bounds = path.bounds
    frame = frame_of(path, moves)
    firmware = printer.firmware
    body = list(_body(path, moves, durations, settings, printer, names))
    ended = end_code(printer, settings, frame)
    stop, end = list(after(printer)), [*ended.lines, *off(ended.state)]
    if firmware == "reprap":
        # From the end upwards, Duet Web Control takes what stands before a G90 for relative and
        # finds no height; the moves of the print have left the machine in absolute coordinates.
        stop, end = [line for line in stop if line != "G90"], _ended(end)
    started = start_code(printer, settings, frame)
    start = started.lines
    if firmware == "bambu" and not settings.bed:
        start = [line for line in start if not BED_OFF.match(line)]
    lines = [
        *header(path, bounds, estimated, settings, printer, material, names, notes, warnings),
        *thumbnails(path, firmware),
        *begin(printer),
        *markers.definitions(path, names, firmware),
        *start,
        *before(settings, printer, started.state),
        *markers.all_layers(path, firmware),
        *body,
        *stop,
        *end,
        *footer(path, printer),
    ]
    return ("\n".join(lines) + "\n").encode("ascii", "replace").decode()


def write_gcode(text: str, path: Path | str) -> None:
    """Write G-code to a file, completely or not at all.

    Raises:
        InputError: the file cannot be written.
    """
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="ascii", newline="\n")


def check(moves: Moves, printer: Printer) -> None:
    """Make sure that every move is finite, within reach and forwards where it prints.

    Raises:
        ComputationError: one is not; nothing should be printed then.
        InputError: whether the bed is round matters and is not known.
    """
    bed = printer.bed
    least, most = np.array([*bed.low, 0.0]), np.array([*bed.high, bed.height])
    numbers = np.column_stack([moves.places, moves.filament, moves.speeds])
    if not np.isfinite(numbers).all():
        raise ComputationError("a move is not a number; nothing was written")
    if ((moves.places < least - 1e-6) | (moves.places > most + 1e-6)).any():
        raise ComputationError(f"a move leaves the reach of {printer.name}; nothing was written")
    prints = np.flatnonzero(moves.kind == PRINT)
    begins, ends = moves.places[prints - 1, :2], moves.places[prints, :2]
    if off_bed(begins, ends, bed).any():
        raise ComputationError(
            f"a bead leaves the bed of {printer.name} or meets one of its excluded zones; nothing "
            f"was written"
        )
    if bed.shape_unclear and (np.hypot(*(ends - bed.middle).T) > bed.width / 2 + 1e-6).any():
        raise InputError(f"the print is wider than a round bed; {bed.ask_shape()}")
    if (moves.filament[moves.kind == PRINT] < 0).any() or (moves.speeds <= 0).any():
        raise ComputationError("a bead would draw filament back; nothing was written")


def _ended(lines: Sequence[str]) -> list[str]:
    """Return lines after the print with remarks by which RepRapFirmware leaves out their height.

    It takes the last Z in a file for the height of the print, unless a comment there begins with E.
    """
    split = [line.partition(";") for line in lines]
    return [
        f"{code.rstrip()} ; End {comment.strip()}".rstrip() if HIGHER.match(code) else line
        for line, (code, _, comment) in zip(lines, split, strict=True)
    ]


def _body(
    path: Toolpath,
    moves: Moves,
    durations: Array,
    settings: Settings,
    printer: Printer,
    names: Sequence[str],
) -> Iterator[str]:
    """Yield the moves, with comments on layers, beads and progress."""
    firmware = printer.firmware
    relative = printer.extruder.extrusion == "relative"
    beads = [(k, bead) for k, layer in enumerate(path.layers) for bead in layer.beads]
    first = np.searchsorted(moves.bead, np.arange(len(beads) + 1))
    done = np.append(0.0, np.cumsum(durations))
    total = max(float(done[-1]), 1e-9)
    lines = _Lines(moves, relative)
    layer_now, type_now, progress, object_now = -1, "", "", markers.NOTHING
    # Layers of one kind share their beads, and so the text, wherever E has come to the same.
    known: dict[tuple[int, float], tuple[list[str], float]] = {}
    for number, (k, bead) in enumerate(beads):
        begin, end = int(first[number]), int(first[number + 1])
        now = float(done[begin])
        if k != layer_now:
            if k == 1 and settings.fan != settings.fan_first_layer:
                yield "M106 S255" if settings.fan else "M107"
            yield f";LAYER:{k}"
            yield f";Z:{path.layers[k].z:.3f}"
            yield from markers.layer(k, len(path.layers), path.layers[k], firmware)
            if not relative:
                yield "G92 E0"
                lines.fed = 0.0
            layer_now, type_now = k, ""
        here = f"M73 P{int(100 * now / total)} R{round((total - now) / 60)}"
        if printer.code.progress and here != progress:
            progress = here
            yield progress
        if bead.grid != object_now:
            yield from _switch(markers.change(names, firmware, object_now, bead.grid), lines)
            object_now = bead.grid
        if bead.role != type_now:
            type_now = bead.role
            cura, bambu = TYPES[type_now]
            yield f";TYPE:{cura}"
            if firmware == "bambu":
                yield f"; FEATURE: {bambu}"
        yield f"; {bead.role}, {bead.part}" + (f", grid {bead.grid}" if bead.grid > 0 else "")
        prints = end - len(bead.widths)
        yield from lines.write(begin, prints)
        key = (id(bead), 0.0 if relative else lines.fed)
        if key not in known:
            text = list(lines.write(prints, end))
            known[key] = (text, lines.fed)
        text, lines.fed = known[key]
        yield from text
    yield from _switch(markers.change(names, firmware, object_now, markers.NOTHING), lines)
    away = list(lines.write(int(first[-1]), len(moves.kind)))
    yield from _ended(away) if firmware == "reprap" else away


def _switch(change: Iterator[str], lines: "_Lines") -> Iterator[str]:
    """Yield what leads to another object; E then counts from zero.

    Some firmware does not count the absolute E of an object that it leaves out.
    """
    switch = list(change)
    yield from switch
    if switch and not lines.relative:
        yield "G92 E0"
        lines.fed = 0.0


class _Lines:
    """Writes moves, each with what changes, and counts E as the printer does."""

    def __init__(self, moves: Moves, relative: bool) -> None:
        self.moves = moves
        self.relative = relative
        self.fed = 0.0

    def write(self, begin: int, end: int) -> Iterator[str]:
        """Yield the lines of moves, the speed where it changes among them."""
        before = 0.0
        part = slice(begin, end)
        columns = (self.moves.kind, self.moves.places, self.moves.filament, self.moves.speeds)
        rows = zip(*(column[part].tolist() for column in columns), strict=True)
        for kind, (x, y, z), fed, speed in rows:
            text = "G1" if kind in FEEDS else "G0"
            if kind in (PRINT, TRAVEL):
                text += f" X{x:.3f} Y{y:.3f}"
            elif kind not in FEEDS:
                text += f" Z{z:.3f}"
            if kind in FEEDS:
                # To the digits of the file, so that equal layers count to equal numbers.
                self.fed = round(self.fed + fed, DIGITS)
                text += f" E{fed if self.relative else self.fed:.5f}"
            if speed != before:
                text += f" F{speed:g}"
                before = speed
            yield text
