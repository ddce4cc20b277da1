"""What layers and colours say about actuators.

A layer's last name is `top 0.5`, `bottom 75%`, `top-25`, `Bottom_1`, `top` (all of the beam) or
`passive`. Colours are those of our pictures, at quarter steps, and plain red and blue.
"""

import re
from difflib import SequenceMatcher

SIGNS = {"top": 1.0, "bottom": -1.0}
PASSIVE = "passive"
COLOURS = {
    "#e7a46f": 0.25,
    "#e18d4a": 0.5,
    "#db7525": 0.75,
    "#d55e00": 1.0,
    "#6fafd3": -0.25,
    "#4a9bc8": -0.5,
    "#2586bd": -0.75,
    "#0072b2": -1.0,
    "#dcdcdc": 0.0,
    "#ff0000": 1.0,
    "#0000ff": -1.0,
}
# Steps of 0 to 255 in a channel: what rounding may change, and what is a near miss.
SAME_COLOUR, NEAR_COLOUR = 2, 24
# How alike a word is to one of the convention's, at most 1, to be a slip of the pen.
SLIP = 0.65
FORM = re.compile(
    r"(?P<side>top|bottom)(?:[\s_:=-]*(?P<value>\d*[.,]\d+|\d+[.,]?)\s*(?P<percent>%?))?",
    re.IGNORECASE,
)


def last_name(layer: str) -> str:
    """Return the last level of a layer's name."""
    return layer.rsplit("::", 1)[-1].strip()


def ratio_of_layer(layer: str) -> float | None:
    """Return the signed ratio that a layer's name stands for; None where it stands for none."""
    name = last_name(layer)
    if name.casefold() == PASSIVE:
        return 0.0
    match = FORM.fullmatch(name)
    if match is None:
        return None
    sign = SIGNS[match["side"].casefold()]
    if match["value"] is None:
        return sign
    value = float(match["value"].replace(",", "."))
    if match["percent"] or ("." not in match["value"] and 10 <= value <= 100):
        value /= 100
    return sign * value + 0.0 if value <= 1 else None


def near_layer(layer: str) -> bool:
    """Return whether a layer's name, which stands for no ratio, nearly does."""
    name = last_name(layer).casefold()
    words = re.findall(r"[^\W\d_]+", name)
    if not words or len(words) > 3:
        return False
    if words[0] in SIGNS or (words[-1] in SIGNS and len(words) <= 2):
        return True
    number = any(mark.isdigit() for mark in name)
    if not number and len(words[0]) < 5:
        return False
    return any(
        SequenceMatcher(None, words[0], word).ratio() >= SLIP and abs(len(words[0]) - len(word)) < 2
        for word in (*SIGNS, PASSIVE)
    )


def ratio_of_colour(colour: str | None) -> float | None:
    """Return the signed ratio that a colour "#rrggbb" stands for; None where it stands for none."""
    near = _nearest(colour)
    return COLOURS[near[0]] if near and near[1] <= SAME_COLOUR else None


def near_colour(colour: str | None) -> str | None:
    """Return the colour of the convention that a colour, which is none of them, nearly is."""
    near = _nearest(colour)
    if near is None or not SAME_COLOUR < near[1] <= NEAR_COLOUR or not COLOURS[near[0]]:
        return None
    return near[0]


def _nearest(colour: str | None) -> tuple[str, int] | None:
    """Return the nearest colour of the convention and how far it is in the channel that differs."""
    if colour is None or not re.fullmatch("#[0-9a-fA-F]{6}", colour):
        return None
    channels = _channels(colour)
    far = {
        other: max(abs(a - b) for a, b in zip(channels, _channels(other), strict=True))
        for other in COLOURS
    }
    best = min(far, key=lambda other: far[other])
    return best, far[best]


def _channels(colour: str) -> tuple[int, ...]:
    return tuple(bytes.fromhex(colour[1:]))
