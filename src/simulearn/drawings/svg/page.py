"""The page of an SVG file and its unit: what one of its numbers is in mm, and what says so."""

import math
import re
from dataclasses import dataclass, replace

from simulearn.drawings.drawing import Unit
from simulearn.drawings.svg.curves import Matrix
from simulearn.drawings.svg.lengths import (
    IDENTITY,
    INCH,
    PHYSICAL,
    Viewport,
    after,
    fitted,
    shift,
    view_box,
)
from simulearn.drawings.svg.tree import INKSCAPE, SERIF, SODIPODI, Document

_NAMES = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": INCH, "pt": INCH / 72, "px": INCH / 96}


@dataclass(frozen=True)
class Density:
    """How many px a program writes to an inch.

    Attributes:
        per_inch: the number; None where what the file shows of its program is not enough.
        reason: what says so, in words.
        guess: the likeliest number where `per_inch` is None.
        known: whether the program is known by its own mark, so that px have a length even where
            the file says no size.
    """

    per_inch: float | None
    reason: str
    guess: float = 96.0
    known: bool = False


def density(document: Document) -> Density:
    """Return how many px the program that wrote a file counts to an inch."""
    root = document.root.attributes
    version = root.get(f"{INKSCAPE} version") or root.get(f"{SODIPODI} version")
    adobe = any("Adobe Illustrator" in text for text in document.comments) or any(
        "ns.adobe.com/AdobeIllustrator" in uri for uri in document.namespaces
    )
    if adobe and version:
        return Density(
            None,
            "px, 72 per inch as Adobe Illustrator writes them; but the file was saved by "
            "Inkscape since, which counts 96",
            guess=72.0,
        )
    if adobe:
        return Density(72.0, "px, 72 per inch as Adobe Illustrator writes them", known=True)
    if version:
        numbers = re.match(r"(\d+)\.(\d+)", version)
        old = bool(numbers) and (int(numbers[1]), int(numbers[2])) < (0, 92)  # type: ignore[index]
        old = old or f"{INKSCAPE} version" not in root
        words = "before 0.92" if old else version.split()[0]
        return Density(
            90.0 if old else 96.0,
            f"px, {90 if old else 96} per inch as Inkscape {words} writes them",
            known=True,
        )
    if any(
        element.tag == "title" and "OpenSCAD Model" in element.text
        for element in document.elements[:5]
    ):
        return Density(INCH, "numbers without a unit, mm as OpenSCAD writes them", known=True)
    if SERIF in document.namespaces:
        return Density(
            None,
            "Affinity writes px of the density chosen at its export, 72 per inch unless changed",
            guess=72.0,
        )
    if any("data-name" in element.attributes for element in document.elements):
        return Density(
            None,
            "names in data-name are written by Adobe Illustrator, which counts 72 px to an inch; "
            "other programs count 96",
            guess=72.0,
        )
    return Density(96.0, "px, 96 per inch by the SVG standard")


@dataclass(frozen=True)
class Page:
    """The outermost `svg`: its unit, and how its numbers become those of the drawing.

    Attributes:
        unit: of the drawing's numbers; None where the file does not say it.
        guess: where `unit` is None, what speaks for one.
        matrix: from user units to the drawing: y up, the lower left corner of the page at 0.
        viewport: what lengths in it go by.
        corner: x and y of the page's upper right corner in the drawing; None without a page.
    """

    unit: Unit | None
    guess: Unit | None
    matrix: Matrix
    viewport: Viewport
    corner: tuple[float, float] | None

    def placed(self, turn: Matrix) -> Matrix:
        """Return the matrix after the transform of the outermost `svg`, about the page's middle."""
        if turn == IDENTITY:
            return self.matrix
        a, _, _, d, e, f = self.matrix
        x, y = self.corner or (-2.0 * e, 2.0 * f)
        x, y = (x / 2.0 - e) / a, (y / 2.0 - f) / d
        return after(self.matrix, after(after(shift(x, y), turn), shift(-x, -y)))


def page_of(document: Document, declared: dict[str, str]) -> Page:
    """Return the page of a file, by the width, height and viewBox of its outermost `svg`."""
    px = density(document)
    per_inch = px.per_inch or px.guess
    window = Viewport(math.nan, math.nan, per_inch)
    texts = [declared.get("width"), declared.get("height")]
    width, height = (_size(window, text) for text in texts)
    box = view_box(document.root.attributes.get("viewBox"))
    unit: Unit | None = None
    guess: Unit | None = None
    scale = (1.0, 1.0)
    mm = INCH / per_inch
    given = [
        (name, text.strip())
        for name, text, value in zip(("width", "height"), texts, (width, height), strict=True)
        if text and math.isfinite(value)
    ]
    written = " and ".join(f"{name}={text}" for name, text in given)
    physical = all(text.lower().endswith(tuple(PHYSICAL)) for _, text in given)
    if box is None:
        area = (0.0, 0.0, width, height)
        if (written and (physical or "px" in written)) or px.known:
            unit = _unit(mm, px.reason)
    else:
        area = box
        both = math.isfinite(width) and math.isfinite(height)
        fit = fitted(
            box,
            width if math.isfinite(width) else height / box[3] * box[2],
            height if math.isfinite(height) else width / box[2] * box[3],
            document.root.attributes.get("preserveAspectRatio") if both else None,
        )
        if written:
            source = f"{written} for a viewBox of {box[2]:g} x {box[3]:g}"
            if not physical:
                source += f"; {px.reason}"
            if abs(fit[0] / fit[3] - 1.0) < 1e-9:
                unit = _unit(mm * fit[0], source)
            else:  # stretched: the drawing is given in mm
                scale = (mm * fit[0], mm * fit[3])
                unit = Unit(1.0, "mm", source + ", stretched (preserveAspectRatio=none)")
        elif px.known:
            unit = _unit(mm, px.reason)
    if px.per_inch is None and not (written and physical and box):
        unit, guess = None, replace(unit or _unit(mm, px.reason), source=px.reason)
    x, y, across, down = area
    known = math.isfinite(across) and math.isfinite(down)
    bottom = y + (down if math.isfinite(down) else 0.0)
    return Page(
        unit,
        guess,
        (scale[0], 0.0, 0.0, -scale[1], -x * scale[0], bottom * scale[1]),
        Viewport(across, down, per_inch),
        (across * scale[0], down * scale[1]) if known else None,
    )


def _size(window: Viewport, text: str | None) -> float:
    """Return a width or height in px; NaN where it is none, such as a percentage."""
    value = window.length(text) if text and "%" not in text else math.nan
    return value if value > 0.0 else math.nan


def _unit(mm: float, source: str) -> Unit:
    """Return a unit with its name, where its length has one."""
    for name, length in _NAMES.items():
        if abs(mm / length - 1.0) < 1e-4:
            return Unit(mm, name, source)
    return Unit(mm, "px" if "px, " in source else "unit", source)


def guessed(extent: float) -> Unit | None:
    """Return the likeliest unit of numbers without one, by how wide the drawing is (units)."""
    for name in ("mm", "cm", "in", "m", "px"):
        width = extent * _NAMES[name]
        if 20.0 <= width <= 1000.0:
            return Unit(
                _NAMES[name],
                name,
                f"the file says no size; in {name} the drawing would be {width:.4g} mm wide",
            )
    return None
