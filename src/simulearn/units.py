"""Units of length: how long each is, and what people and files call it."""

INCH = 25.4
# Lengths of units in mm, their names in messages, and their other names.
LENGTHS = {
    "mm": 1.0,
    "cm": 10.0,
    "dm": 100.0,
    "m": 1000.0,
    "km": 1e6,
    "um": 1e-3,
    "nm": 1e-6,
    "in": INCH,
    "mil": INCH / 1000,
    "ft": 12 * INCH,
    "yd": 36 * INCH,
    "pt": INCH / 72,
    "pc": INCH / 6,
    "px": INCH / 96,
}
PLURALS = {
    "mm": "millimetres",
    "cm": "centimetres",
    "m": "metres",
    "um": "micrometres",
    "in": "inches",
    "mil": "thousandths of an inch",
    "ft": "feet",
    "pt": "points",
    "px": "pixels",
}
NAMES = {
    "mm": ("millimeter", "millimetre"),
    "cm": ("centimeter", "centimetre"),
    "dm": ("decimeter", "decimetre"),
    "m": ("meter", "metre"),
    "km": ("kilometer", "kilometre"),
    "um": ("µm", "μm", "micron", "micrometer", "micrometre"),
    "nm": ("nanometer", "nanometre"),
    "in": ("inch", "inche", '"', "″", "”"),
    "mil": ("thou",),
    "ft": ("foot", "feet", "'"),
    "yd": ("yard",),
    "pt": ("point",),
    "pc": ("pica",),
    "px": ("pixel",),
}


def length_named(name: str) -> str | None:
    """Return the key in LENGTHS of a unit by any of its names, None where there is no such unit.

    Args:
        name: such as "mm", "Meters" or "inch", in any case; in the plural, too.
    """
    word = " ".join(name.split()).casefold()
    words = {word, word.removesuffix("s")}
    return next((short for short in LENGTHS if words & {short, *NAMES[short]}), None)


def in_mm(*units: str) -> dict[str, float]:
    """Return lengths (mm) of units of LENGTHS by their names in messages."""
    return {PLURALS[unit]: LENGTHS[unit] for unit in units}
