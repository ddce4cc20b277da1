"""What an element of SVG hands on to those in it, and how strokes and fills are painted."""

from collections.abc import Container
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, NamedTuple

from tinycss2.color4 import parse_color


@dataclass(frozen=True, slots=True)
class Style:
    """What an element hands on to the elements in it.

    Attributes:
        stroke, fill, color: as written.
        visible: of `visibility`.
        stroke_width, stroke_opacity, fill_opacity: as written.
        font_size: px.
    """

    stroke: str = "none"
    fill: str = "black"
    color: str = "black"
    visible: bool = True
    stroke_width: str = "1"
    stroke_opacity: str = "1"
    fill_opacity: str = "1"
    font_size: float = 16.0


_INHERITED = {
    "stroke": "stroke",
    "fill": "fill",
    "color": "color",
    "stroke-width": "stroke_width",
    "stroke-opacity": "stroke_opacity",
    "fill-opacity": "fill_opacity",
    "visibility": "visible",
}


def inherited(style: Style, declared: dict[str, str]) -> Style:
    """Return the style of an element from that of the element around it."""
    changes: dict[str, Any] = {}
    for name, value in declared.items():
        attribute = _INHERITED.get(name)
        if attribute is None or value in ("inherit", "unset"):
            continue
        if value == "initial":
            changes[attribute] = getattr(_START, attribute)
        elif name == "visibility":
            if value.lower() in ("visible", "hidden", "collapse"):
                changes[attribute] = value.lower() == "visible"
        elif name not in ("stroke", "fill", "color") or paint(value) is not None:
            changes[attribute] = value
    return replace(style, **changes) if changes else style


_START = Style()


class Paint(NamedTuple):
    """How a stroke or a fill is painted.

    `drawn` is None for a reference to a gradient or pattern, which must exist to be drawn;
    `fallback` is painted where it does not.
    """

    drawn: bool | None
    colour: str | None = None
    reference: str = ""
    fallback: str = "none"


@lru_cache(maxsize=4096)
def paint(value: str) -> Paint | None:
    """Return what a paint as written means, or None where it is none."""
    text = value.strip()[:1000]
    lower = text.lower()
    if lower == "none":
        return Paint(False)
    if lower.startswith("url("):
        reference, _, rest = text[4:].partition(")")
        return Paint(None, None, reference.strip(" \t\n\"'").lstrip("#"), rest.strip() or "none")
    if lower in ("context-stroke", "context-fill"):
        return Paint(True)
    if lower == "currentcolor":
        return Paint(True, "currentcolor")
    if lower.startswith("var("):  # a variable of the page around it; what follows it is its default
        default = text[4:].rpartition(")")[0].partition(",")[2]
        return paint(default) if default.strip() else Paint(True)
    colour: Any = parse_color(lower.partition(" icc-color")[0])
    if colour is None:
        return None
    if colour.alpha == 0:
        return Paint(False)
    try:
        channels = colour.to("srgb").coordinates
    except NotImplementedError:
        return Paint(True)
    digits = [round(255 * min(max(channel or 0.0, 0.0), 1.0)) for channel in channels]
    return Paint(True, "#{:02x}{:02x}{:02x}".format(*digits))


def painted(value: str, opacity: str, color: str, known: Container[str]) -> tuple[bool, str | None]:
    """Return whether a stroke or fill is drawn, and its colour "#rrggbb" where it has one.

    Args:
        value: of `stroke` or `fill`, as written.
        opacity: of it, as written.
        color: what `currentColor` stands for, as written.
        known: ids of the elements of the file.
    """
    if is_zero(opacity):
        return False, None
    result = paint(value)
    if result is not None and result.drawn is None:
        if result.reference in known:
            return True, None
        result = paint(result.fallback)
    if result is not None and result.colour == "currentcolor":
        result = paint(color) if color.lower() != "currentcolor" else Paint(True, "#000000")
    if result is None:
        return False, None
    return bool(result.drawn), result.colour


def is_zero(text: str) -> bool:
    """Return whether an opacity or width as written is none at all."""
    number = text.strip().rstrip("%abcdefghijklmnopqrstuvwxyz")
    try:
        return float(number) <= 0.0
    except ValueError:
        return False


def is_hidden(declared: dict[str, str]) -> bool:
    """Return whether an element hides itself and all that is in it."""
    return declared.get("display", "").lower() == "none" or is_zero(declared.get("opacity", "1"))
