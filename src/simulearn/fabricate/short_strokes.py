"""Whether a machine lays the short strokes of a print as fast as those of the calibration.

Passive halves and joints are filled by strokes of 4 to 7 mm, on which the nozzle hardly reaches its
speed: how fast they are laid depends on acceleration and corner speed. The stress that is printed
in depends on the speed, and the curl of a beam on the stress in its passive half, which was fitted
to beams printed with the material's own settings.
"""

from dataclasses import replace

import numpy as np

from simulearn.fabricate.estimate import durations_of
from simulearn.fabricate.moves import PRINT, Moves
from simulearn.fabricate.printer import Printer
from simulearn.fabricate.settings import Settings
from simulearn.fabricate.toolpath import JOINT, PASSIVE, Toolpath
from simulearn.grid import Message
from simulearn.material import Material

SHORT = (PASSIVE, JOINT)
TOLERANCE = 0.1  # of the speed; a larger difference is warned about


def short_strokes(
    path: Toolpath, moves: Moves, settings: Settings, printer: Printer, material: Material
) -> list[Message]:
    """Return a warning if short strokes are laid faster or slower than those of the calibration.

    Args:
        path: the toolpath.
        moves: of the toolpath.
        settings: how it is printed.
        printer: on what.
        material: whose print settings are those of the calibration.
    """
    here, calibrated = mean_speeds(path, moves, settings, printer, material)
    if not calibrated or abs(here / calibrated - 1) <= TOLERANCE:
        return []
    ours = material.print
    reasons = []
    if settings.acceleration != ours.acceleration:
        reasons.append(f"acceleration {settings.acceleration:g} instead of {ours.acceleration:g}")
    if settings.corner_speed != ours.corner_speed:
        reasons.append(f"corner speed {settings.corner_speed:g} instead of {ours.corner_speed:g}")
    speed = min(settings.speed[PASSIVE], printer.motion.speed)
    if speed != ours.speed_fill:
        reasons.append(f"speed {speed:g} instead of {ours.speed_fill:g}")
    text = (
        f"{printer.title} lays the short strokes of passive halves and joints at {here:.1f} mm/s "
        f"on average; the curl was calibrated with {calibrated:.1f} mm/s ({', '.join(reasons)}). "
        f"A beam may curl more or less than simulated: print and measure one before a large grid"
    )
    return [Message("short-strokes", "printer.motion", text)]


def mean_speeds(
    path: Toolpath, moves: Moves, settings: Settings, printer: Printer, material: Material
) -> tuple[float, float]:
    """Return the mean speed of short strokes (mm/s) as printed, and as in the calibration.

    The first layer, which has a speed of its own, is left out. Both are 0 if there are no such
    strokes.
    """
    short = np.array(
        [
            k > 0 and bead.role in SHORT
            for k, layer in enumerate(path.layers)
            for bead in layer.beads
        ]
    )
    chosen = (moves.kind == PRINT) & np.append(short, False)[moves.bead]
    length = np.linalg.norm(np.diff(moves.places, axis=0, prepend=moves.start[None]), axis=1)
    total = float(length[chosen].sum())
    if not total:
        return 0.0, 0.0

    ours = material.print
    speeds = np.where(chosen, ours.speed_fill, moves.speeds)
    as_calibrated = replace(
        settings, acceleration=ours.acceleration, corner_speed=ours.corner_speed
    )
    able = printer.motion.model_copy(update={"speed": max(printer.motion.speed, ours.speed_fill)})
    seconds = durations_of(moves, settings, printer)[chosen].sum()
    seconds_calibrated = durations_of(
        replace(moves, speeds=speeds),
        as_calibrated,
        printer.model_copy(update={"motion": able}),
    )[chosen].sum()
    return total / float(seconds), total / float(seconds_calibrated)
