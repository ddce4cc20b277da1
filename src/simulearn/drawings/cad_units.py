"""Units of CAD files: how long each is, and which one a file without a unit most likely means."""

import numpy as np

from simulearn.drawings.drawing import Line, Unit
from simulearn.drawings.units import odd
from simulearn.units import LENGTHS

_SURVEY_FOOT = 1200e3 / 3937  # mm; the definition of the United States' survey foot

# Lengths in mm, in the words of messages.
MM = LENGTHS | {
    "angstrom": 1e-7,
    "dam": 1e4,
    "hm": 1e5,
    "Mm": 1e9,
    "Gm": 1e12,
    "microinch": 25.4e-6,
    "mi": 1609344.0,
    "nautical mile": 1852e3,
    "US survey in": _SURVEY_FOOT / 12,
    "US survey ft": _SURVEY_FOOT,
    "US survey yd": _SURVEY_FOOT * 3,
    "US survey mi": _SURVEY_FOOT * 5280,
    "astronomical unit": 149597870700e3,
    "light year": 9460730472580800e3,
    "parsec": 149597870700e3 * 648000 / np.pi,
}
# The names of Rhino's unit systems.
RHINO = {
    "Angstroms": "angstrom",
    "Nanometers": "nm",
    "Microns": "um",
    "Millimeters": "mm",
    "Centimeters": "cm",
    "Decimeters": "dm",
    "Meters": "m",
    "Dekameters": "dam",
    "Hectometers": "hm",
    "Kilometers": "km",
    "Megameters": "Mm",
    "Gigameters": "Gm",
    "Microinches": "microinch",
    "Mils": "mil",
    "Inches": "in",
    "Feet": "ft",
    "Yards": "yd",
    "Miles": "mi",
    "PrinterPoints": "pt",
    "PrinterPicas": "pc",
    "NauticalMiles": "nautical mile",
    "AstronomicalUnits": "astronomical unit",
    "LightYears": "light year",
    "Parsecs": "parsec",
}


def unit(name: str, source: str) -> Unit:
    """Return a unit by its name.

    Args:
        name: a key of `MM`.
        source: what says so.
    """
    return Unit(MM[name], name, source)


def rhino_unit(system: str, source: str) -> Unit | None:
    """Return a unit by the name of its system in Rhino, in any case; None where it has no length.

    Args:
        system: such as "Millimeters".
        source: what says so.
    """
    names = {key.casefold(): name for key, name in RHINO.items()}
    name = names.get(system.casefold())
    return None if name is None else unit(name, source)


def likely_unit(lines: list[Line], names: tuple[str, ...], reason: str) -> Unit:
    """Return that of some units in which the lines are as long as beams usually are.

    Args:
        lines: in the unit of the file.
        names: of the units that come into question, the likeliest first.
        reason: what made them come into question.

    Returns:
        The first unit in which the middle segment is so long; else the first one.
    """
    pieces = [np.linalg.norm(np.diff(line.points, axis=0), axis=1) for line in lines]
    lengths = np.concatenate(pieces) if pieces else np.empty(0)
    lengths = lengths[lengths > 0]
    for name in names if len(lengths) else ():
        length = float(np.median(lengths)) * MM[name]
        if not odd(length):
            return unit(name, f"{reason}, and its beams are then {length:.3g} mm long")
    return unit(names[0], reason)
