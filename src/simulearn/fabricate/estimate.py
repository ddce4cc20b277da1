"""How long a print takes and how much filament it needs.

Each move speeds up and slows down evenly (a trapezoid of speed over time). What speed it keeps at
the corner to the next move depends on the angle, and two sweeps over all moves, one forwards and
one backwards, see to it that every corner speed can be reached. Both sweeps are running minima.

Corners: the firmware's junction rule, v2 = a r, with r the radius of the circle that touches both
moves and passes the corner at a distance such that a right angle is taken at the speed that the
profile names (S. Jeon, "Improving Grbl: Cornering Algorithm", 2011; Klipper's "square corner
velocity").
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.fabricate.moves import PRINT, TRAVEL, Moves
from simulearn.fabricate.printer import Printer
from simulearn.fabricate.settings import Settings

Array = NDArray[np.float64]
ROOM = 20.0  # C


@dataclass(frozen=True)
class Estimate:
    """What a print takes.

    Attributes:
        seconds: from the first move to the last.
        heating_seconds: before that, from room temperature.
        filament_mm: length of filament that stays in the print.
        filament_cm3: its volume.
        filament_g: its mass.
    """

    seconds: float
    heating_seconds: float
    filament_mm: float
    filament_cm3: float
    filament_g: float


def estimate(
    moves: Moves, settings: Settings, printer: Printer, durations: Array | None = None
) -> Estimate:
    """Return what a print takes.

    Args:
        moves: of the print.
        settings: filament, density, temperatures and accelerations in the plane.
        printer: how it lifts, retracts and heats.
        durations: of each move (s), if they are known already.
    """
    seconds = durations_of(moves, settings, printer) if durations is None else durations
    length = float(moves.filament[moves.kind == PRINT].sum())
    volume = length * settings.filament_area
    return Estimate(
        seconds=float(seconds.sum()),
        heating_seconds=max(0.0, settings.temperature - ROOM) / printer.heating.nozzle
        + max(0.0, settings.bed - ROOM) / printer.heating.bed,
        filament_mm=length,
        filament_cm3=volume / 1000,
        filament_g=volume * settings.density,
    )


def durations_of(moves: Moves, settings: Settings, printer: Printer) -> Array:
    """Return how long each move takes, (m,) s."""
    motion = printer.motion
    steps = np.diff(moves.places, axis=0, prepend=moves.start[None])
    distance = np.linalg.norm(steps, axis=1)
    still = distance == 0
    plane = (moves.kind == PRINT) | (moves.kind == TRAVEL)
    acceleration = np.select(
        [moves.kind == PRINT, moves.kind == TRAVEL, still],
        [settings.acceleration, settings.acceleration_travel, motion.acceleration_e],
        motion.acceleration_z,
    )
    length = np.where(still, np.abs(moves.filament), distance)
    fastest = np.where(plane, np.minimum(moves.speeds, motion.speed), moves.speeds) / 60
    corner = _corners(steps, distance, plane, settings.corner_speed)
    return _times(length, fastest, acceleration, corner)


def _corners(steps: Array, distance: Array, plane: NDArray[np.bool_], square: float) -> Array:
    """Return the speed at which each move may begin, (m,) mm/s; 0 but from plane to plane."""
    along = steps / np.maximum(distance, 1e-12)[:, None]
    turn = np.clip(np.sum(along[1:] * along[:-1], axis=1), -1.0, 1.0)
    # Half the angle between the moves: 90 degrees going straight on, 0 turning back.
    sine = np.sqrt((1 + turn) / 2)
    speed = square * np.sqrt((np.sqrt(2) - 1) * sine / np.maximum(1 - sine, 1e-9))
    # Printing and travelling differ in what the extruder does: the machine stops between them.
    both = plane[1:] & plane[:-1] & (distance[1:] > 0) & (distance[:-1] > 0)
    return np.append(0.0, np.where(both, speed, 0.0))


def _times(length: Array, fastest: Array, acceleration: Array, corner: Array) -> Array:
    """Return the times (m,) s of moves with trapezoids of speed.

    Args:
        length: (m,) mm.
        fastest: (m,) mm/s.
        acceleration: (m,) mm/s2.
        corner: (m,) mm/s, at most, where a move begins; after the last one it stands still.
    """
    limit = np.append(np.minimum(corner, np.minimum(fastest, np.append(0, fastest[:-1]))), 0.0) ** 2
    gain = 2 * acceleration * length
    reached = np.append(0.0, np.cumsum(gain))
    # v2 at a corner is at most v2 at any earlier one plus what is gained between.
    square = np.minimum.accumulate(limit - reached) + reached
    back = reached[-1] - reached
    square = (np.minimum.accumulate((square - back)[::-1]) + back[::-1])[::-1]
    square = np.clip(square, 0.0, limit)
    begin, end = square[:-1], square[1:]
    top = np.minimum(fastest**2, (gain + begin + end) / 2)
    peak = np.sqrt(top)
    ramps = (2 * peak - np.sqrt(begin) - np.sqrt(end)) / acceleration
    flat = length - (2 * top - begin - end) / (2 * acceleration)
    times: Array = ramps + np.maximum(flat, 0) / np.maximum(peak, 1e-9)
    return np.where(length > 0, times, 0.0)
