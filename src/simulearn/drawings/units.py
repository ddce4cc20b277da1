"""Units of drawings: sizes that cannot be meant, and the unit that is likely meant."""

from math import inf, log

from simulearn.drawings.drawing import Unit
from simulearn.errors import InputError
from simulearn.units import LENGTHS, length_named

# Beams are usually this long; other lengths of the middle one are odd (mm).
USUAL = (8.0, 400.0)
# A unit is likely where the middle beam is so long, and most likely nearest to TYPICAL (mm).
LIKELY = (20.0, 100.0)
TYPICAL = 65.0
# Those that drawings come in; pt is also the pixel of programs that count 72 to the inch.
GUESSES = ("mm", "cm", "m", "in", "px", "pt", "ft", "um")


class UnitError(InputError):
    """The unit of a drawing or surface is not known, or its size is odd; a person must say.

    Args:
        text: what the file says, and the guess.
        guess: the likely unit; None if none is.
        size: width and height of the drawing (and depth of a surface) in units of the file.
    """

    def __init__(self, text: str, guess: Unit | None, size: tuple[float, ...]) -> None:
        super().__init__(text, "unit-unknown", "unit")
        self.guess, self.size = guess, size


def unit_named(name: str, source: str) -> Unit:
    """Return a unit by its name, such as "mm", "Meters" or "inch".

    Args:
        name: in any case; in the plural, too.
        source: what names it.

    Raises:
        InputError: there is no such unit.
    """
    short = length_named(name)
    if short is not None:
        return Unit(LENGTHS[short], short, source)
    text = f'"{name[:40]}" is no unit of length; units are {", ".join(LENGTHS)}'
    raise InputError(text, "unit-name", "unit")


def odd(beam: float) -> bool:
    """Return whether a length of the middle beam, mm, cannot be meant."""
    return not USUAL[0] <= beam <= USUAL[1]


def guessed(beam: float) -> Unit | None:
    """Return the likely unit of a drawing; mm wherever that is likely.

    Args:
        beam: length of its middle beam in units of the file.
    """
    best, least = None, inf
    for name in GUESSES:
        mm = LENGTHS[name]
        if LIKELY[0] <= mm * beam <= LIKELY[1]:
            far = abs(log(mm * beam / TYPICAL))
            if name == "mm":
                far = -1.0
            if far < least:
                source = f"its beams are then {mm * beam:.3g} mm long"
                best, least = Unit(mm, name, source), far
    return best
