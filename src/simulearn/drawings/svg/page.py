"""The page of an SVG file and its unit: what one of its numbers is in mm, and what says so."""

import math
import re
from dataclasses import dataclass, replace

from simulearn.drawings.drawing import Unit
from simulearn.drawings.svg.curves import Matrix
from simulearn.drawings.svg.lengths import (
    IDENTITY,
    PHYSICAL,
    Viewport,
    after,
    fitted,
    shift,
    view_box,
)
from simulearn.drawings.svg.tree import INKSCAPE, SERIF, SODIPODI, Document
from simulearn.units import INCH, LENGTHS

_NAMES = ("mm", "cm", "m", "in", "pt", "px")


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
        old = numbers is not None and (int(numbers[1]), int(numbers[2])) < (0, 92)
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
        fit: from user units to px of the page.
        flip: from px of the page to the drawing: y up, the lower left corner of the page at 0.
        size: width and height of the page, px; NaN where there is none.
        viewport: what lengths in it go by.
    """

    unit: Unit | None
    guess: Unit | None
    fit: Matrix
    flip: Matrix
    size: tuple[float, float]
    viewport: Viewport

    @property
    def corner(self) -> tuple[float, float] | None:
        """The page's upper right corner in the drawing; None without a page."""
        corner = (self.size[0] * self.flip[0], self.size[1] * self.flip[0])
        return corner if all(map(math.isfinite, corner)) else None

    def matrix(self, turn: Matrix) -> Matrix:
        """Return the transform from user units to the drawing.

        Args:
            turn: the transform of the outermost `svg` itself, which is about the page's middle.
        """
        x, y = (0.0 if math.isnan(size) else size / 2.0 for size in self.size)
        return after(self.flip, after(after(after(shift(x, y), turn), shift(-x, -y)), self.fit))


def page_of(document: Document, declared: dict[str, str]) -> Page:
    """Return the page of a file, by the width, height and viewBox of its outermost `svg`."""
    root = document.root.attributes
    px = density(document)
    per_inch = px.per_inch or px.guess
    window = Viewport(math.nan, math.nan, per_inch)
    sizes = {name: declared.get(name, "").strip() for name in ("width", "height")}
    width, height = (_px(window, text) for text in sizes.values())
    sizes = {name: text for name, text in sizes.items() if math.isfinite(_px(window, text))}
    written = " and ".join(f"{name}={text}" for name, text in sizes.items())
    physical = bool(sizes) and all(t.lower().endswith(tuple(PHYSICAL)) for t in sizes.values())
    box = view_box(root.get("viewBox"))
    fit = IDENTITY
    if box is not None:
        if math.isnan(width):
            width = box[2] if math.isnan(height) else height / box[3] * box[2]
        if math.isnan(height):
            height = width / box[2] * box[3]
        fit = fitted(box, width, height, root.get("preserveAspectRatio"))
    known = px.known or (physical and box is not None)
    if written and px.per_inch is not None:
        known = known or box is not None or physical or "px" in written
    words = [written + (f" for a viewBox of {box[2]:g} x {box[3]:g}" if box else "")]
    if not (physical and box is not None):
        words.append(px.reason)
    # The drawing is in user units; where those are stretched, in mm if these are known, else px.
    uniform = abs(fit[0] / fit[3] - 1.0) < 1e-9
    step = 1.0 / fit[0] if uniform else INCH / per_inch if known else 1.0
    if not uniform:
        words.append("stretched (preserveAspectRatio=none)")
    unit = _unit(INCH / per_inch, step, "; ".join(filter(None, words)))
    across, down = box[2:] if box else (width, height)
    return Page(
        unit if known else None,
        None if known or px.per_inch is not None else replace(unit, source=px.reason),
        fit,
        (step, 0.0, 0.0, -step, 0.0, 0.0 if math.isnan(height) else height * step),
        (width, height),
        Viewport(across, down, per_inch),
    )


def _px(window: Viewport, text: str) -> float:
    """Return a width or height in px; NaN where it is none, such as a percentage."""
    value = math.nan if "%" in text else window.length(text)
    return value if value > 0.0 else math.nan


def _unit(px: float, step: float, source: str) -> Unit:
    """Return the unit of which a px (mm) has `step`, with its name, where it has one."""
    length = px / step
    for name, mm in (*((name, LENGTHS[name]) for name in _NAMES), ("px", px)):
        if (wrong := abs(length / mm - 1.0)) < 1e-4:
            return Unit(mm if wrong < 1e-12 else length, name, source)
    return Unit(length, "unit", source)
