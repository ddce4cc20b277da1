"""Lengths and transforms of SVG, and how a drawing is fitted into a window."""

import math
import re
from dataclasses import dataclass

import svgelements

from simulearn.drawings.svg.curves import Matrix
from simulearn.units import INCH, LENGTHS

PHYSICAL = {**{unit: LENGTHS[unit] for unit in ("mm", "cm", "in", "pt", "pc")}, "q": 0.25}
_LENGTH = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*([a-z%]*)\s*", re.I)
_ARGUMENT = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)([a-z%]*)", re.I)
_FUNCTION = re.compile(r"\s*,?\s*(\w+)\s*\(([^()]*)\)")
_TRANSFORMS = {  # how many numbers each may have
    "matrix": (6,),
    "translate": (1, 2),
    "translatex": (1,),
    "translatey": (1,),
    "scale": (1, 2),
    "scalex": (1,),
    "scaley": (1,),
    "rotate": (1, 3),
    "skewx": (1,),
    "skewy": (1,),
    "skew": (1, 2),
}
IDENTITY: Matrix = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Viewport:
    """What lengths go by.

    Attributes:
        width: of the nearest `svg`, user units; NaN where there is none.
        height: as width.
        per_inch: px to an inch.
    """

    width: float
    height: float
    per_inch: float

    def length(self, text: str | None, direction: str = "", font_size: float = 16.0) -> float:
        """Return a length in user units, NaN where it is none.

        Args:
            text: as written.
            direction: "x", "y" or "" (neither), which percentages go by.
            font_size: user units.
        """
        match = _LENGTH.fullmatch(text or "")
        if not match:
            return math.nan
        amount, unit = float(match[1]), match[2].lower()
        if unit in ("", "px"):
            return amount
        if unit in PHYSICAL:
            return amount * PHYSICAL[unit] * self.per_inch / INCH
        if unit == "%":
            diagonal = math.hypot(self.width, self.height) / math.sqrt(2.0)
            return amount / 100.0 * {"x": self.width, "y": self.height}.get(direction, diagonal)
        relative = {"em": font_size, "ex": font_size / 2, "ch": font_size / 2, "rem": 16.0}
        relative |= {"vw": self.width / 100, "vh": self.height / 100}
        return amount * relative.get(unit, math.nan)

    def font_size(self, text: str, outer: float) -> float:
        """Return a font size (user units) as written within one of another size."""
        value = self.length(text, "", outer)
        if text.strip().endswith("%"):
            value = outer * self.length(text.strip().rstrip("%")) / 100.0
        return value if 0.0 < value < math.inf else outer

    def origin(self, text: str, font_size: float) -> tuple[float, float]:
        """Return a `transform-origin` (user units)."""
        words = text.lower().split()
        if words and words[0] in ("top", "bottom"):
            words = [words[1] if len(words) > 1 else "center", words[0]]
        shares = {"left": "0%", "top": "0%", "center": "50%", "right": "100%", "bottom": "100%"}
        words = [shares.get(word, word) for word in words] + ["50%"]
        x, y = (self.length(word, axis, font_size) for word, axis in zip(words, "xy", strict=False))
        return (0.0 if math.isnan(x) else x), (0.0 if math.isnan(y) else y)

    def transform(self, text: str, font_size: float = 16.0) -> Matrix | None:
        """Return a list of transforms as one matrix, or None where it cannot be read."""
        if text.strip().lower() in ("", "none"):
            return IDENTITY
        functions: list[str] = []
        place = 0
        while match := _FUNCTION.match(text, place):
            place = match.end()
            name, numbers = match[1].lower(), self._arguments(match[1].lower(), match[2], font_size)
            if len(numbers) not in _TRANSFORMS.get(name, ()):
                return None
            if name == "skew" and len(numbers) == 1:
                numbers.append("0")
            functions.append(f"{name}({','.join(numbers)})")
        if text[place:].strip(" \t\r\n,;"):
            return None
        try:
            matrix = svgelements.Matrix(" ".join(functions))
            values = [float(matrix[k]) for k in range(6)]
        except (ArithmeticError, IndexError, TypeError, ValueError):
            return None
        a, b, c, d, e, f = values
        return (a, b, c, d, e, f) if all(map(math.isfinite, values)) else None

    def _arguments(self, name: str, text: str, font_size: float) -> list[str]:
        """Return the numbers of a transform, lengths in user units; empty where one is wrong."""
        numbers: list[str] = []
        place = 0
        for match in _ARGUMENT.finditer(text):
            if text[place : match.start()].strip(" \t\r\n") not in ("", ","):
                return []
            place = match.end()
            unit = match[2].lower()
            if unit in ("deg", "grad", "rad", "turn") and name[:2] in ("ro", "sk"):
                numbers.append(match[0])
            elif unit in ("", "px"):
                numbers.append(match[1])
            elif name.startswith("translate") and unit != "%":
                numbers.append(f"{self.length(match[0], '', font_size):.17g}")
            else:
                return []
        return [] if text[place:].strip() else numbers


def after(outer: Matrix, inner: Matrix) -> Matrix:
    """Return the transform that does `inner` first, then `outer`."""
    a, b, c, d, e, f = outer
    g, h, i, j, k, m = inner
    return (
        a * g + c * h,
        b * g + d * h,
        a * i + c * j,
        b * i + d * j,
        a * k + c * m + e,
        b * k + d * m + f,
    )


def shift(x: float, y: float) -> Matrix:
    """Return the transform that moves all."""
    return 1.0, 0.0, 0.0, 1.0, x, y


def view_box(text: str | None) -> tuple[float, float, float, float] | None:
    """Return x, y, width and height of a `viewBox`; None where it is none or has no area."""
    parts = re.split(r"[\s,]+", (text or "").strip())
    try:
        x, y, width, height = (float(part) for part in parts)
    except ValueError:
        return None
    if not all(map(math.isfinite, (x, y, width, height))) or width <= 0.0 or height <= 0.0:
        return None
    return x, y, width, height


def fitted(
    box: tuple[float, float, float, float], width: float, height: float, aspect: str | None
) -> Matrix:
    """Return the transform from a `viewBox` to a window of a size at the origin.

    Source: SVG 2, 8.2, equivalent transform of an SVG viewport.
    """
    x, y, box_width, box_height = box
    sx, sy = width / box_width, height / box_height
    words = (aspect or "").split()
    align = words[0] if words else "xMidYMid"
    if align != "none":
        sx = sy = max(sx, sy) if "slice" in words else min(sx, sy)
    share = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}
    left = share.get(align[1:4], 0.5) * (width - box_width * sx)
    top = share.get(align[5:8], 0.5) * (height - box_height * sy)
    if align == "none":
        left = top = 0.0
    return sx, 0.0, 0.0, sy, left - x * sx, top - y * sy
