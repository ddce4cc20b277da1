"""The unit of a measurement: what a person or the file says, else what its size makes likely."""

from math import log

import numpy as np

from simulearn.compare.measurement import JointPlaces, Measurement, size
from simulearn.drawings.units import unit_named
from simulearn.errors import InputError, Message
from simulearn.units import LENGTHS

GUESSES = ("mm", "cm", "in", "m")
# A measurement is so many times as large as the simulated grid: parts of it, or with its table.
LIKELY = (0.3, 6.0)
FEWEST = 5  # joints, of which one may be wrong


def in_millimetres(
    measured: Measurement, expected: float, unit: str | None = None
) -> tuple[Measurement, list[Message]]:
    """Return a measurement in mm, and a message where its unit was guessed.

    Args:
        measured: in any unit.
        expected: size of the simulated grid, mm, as `measurement.size` has it.
        unit: its name, where a person says so.

    Raises:
        InputError: there is no such unit, or no unit makes sense of the size.
    """
    if unit is not None:
        return measured.scaled(unit_named(unit, "as given").mm), []
    if measured.unit is not None:
        return measured.scaled(measured.unit), []
    times = measured.extent / expected
    if LIKELY[0] <= times <= LIKELY[1]:
        return measured.scaled(1.0), []
    best = min(GUESSES, key=lambda name: abs(log(max(times, 1e-12) * LENGTHS[name])))
    mm = LENGTHS[best]
    sizes = f"it is {measured.extent:.3g} across, and the simulated grid {expected:.3g} mm"
    if not LIKELY[0] <= times * mm <= LIKELY[1]:
        text = f"{sizes}; no unit makes sense of that, so it may be another grid"
        text += _but_for_one(measured, expected)
        raise InputError(text, "measurement-size", "measurement")
    text = f'{sizes}; so its unit is taken to be "{best}"'
    return measured.scaled(mm), [Message("measurement-unit", "measurement", text)]


def _but_for_one(measured: Measurement, expected: float) -> str:
    """Return which joint alone makes a measurement too large, in words; "" if none does."""
    if not isinstance(measured, JointPlaces) or len(measured.places) < FEWEST:
        return ""
    for k, place in enumerate(measured.places):
        across = size(np.delete(measured.places, k, axis=0))
        if LIKELY[0] <= across / expected <= LIKELY[1]:
            which = "a joint" if measured.numbers is None else f"joint {measured.numbers[k]}"
            x, y, z = place
            return f"; without {which} at ({x:g}, {y:g}, {z:g}) it is {across:.3g} mm: look at that"
    return ""
