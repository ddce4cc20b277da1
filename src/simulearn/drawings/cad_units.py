"""Units of CAD files: how long each is, and which one a file without a unit most likely means."""

import numpy as np

from simulearn.drawings.drawing import Line, Unit

_SURVEY_FOOT = 1200e3 / 3937  # mm; the definition of the United States' survey foot

MM = {
    "angstrom": 1e-7,
    "nm": 1e-6,
    "um": 1e-3,
    "mm": 1.0,
    "cm": 10.0,
    "dm": 100.0,
    "m": 1e3,
    "dam": 1e4,
    "hm": 1e5,
    "km": 1e6,
    "Mm": 1e9,
    "Gm": 1e12,
    "microinch": 25.4e-6,
    "mil": 25.4e-3,
    "in": 25.4,
    "ft": 304.8,
    "yd": 914.4,
    "mi": 1609344.0,
    "pt": 25.4 / 72,
    "pica": 25.4 / 6,
    "nautical mile": 1852e3,
    "US survey in": _SURVEY_FOOT / 12,
    "US survey ft": _SURVEY_FOOT,
    "US survey yd": _SURVEY_FOOT * 3,
    "US survey mi": _SURVEY_FOOT * 5280,
    "astronomical unit": 149597870700e3,
    "light year": 9460730472580800e3,
    "parsec": 149597870700e3 * 648000 / np.pi,
}

# Beams of a grid that can be printed are about as long as this, mm.
_BEAMS = (8.0, 400.0)


def unit(name: str, source: str) -> Unit:
    """Return a unit by its name.

    Args:
        name: a key of `MM`.
        source: what says so.
    """
    return Unit(MM[name], name, source)


def likely_unit(lines: list[Line], names: tuple[str, ...], reason: str) -> Unit | None:
    """Return the unit in which the lines are as long as beams that can be printed.

    Args:
        lines: in the unit of the file.
        names: of the units that come into question, the likeliest first.
        reason: what made them come into question; "" where nothing did.

    Returns:
        The first unit whose median segment is as long as beams are; else the first one, if there
        is a reason for it; else None.
    """
    because = f"{reason}; " if reason else ""
    pieces = [np.linalg.norm(np.diff(line.points, axis=0), axis=1) for line in lines]
    lengths = np.concatenate(pieces) if pieces else np.empty(0)
    lengths = lengths[lengths > 0]
    if len(lengths):
        median = float(np.median(lengths))
        for name in names:
            if _BEAMS[0] <= median * MM[name] <= _BEAMS[1]:
                size = f"{median * MM[name]:.3g} mm"
                return unit(name, f"{because}the middle one of its segments would be {size} long")
    return unit(names[0], reason) if reason else None
