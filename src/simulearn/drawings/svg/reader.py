"""Reads SVG: walks the tree as a program does that shows it, and keeps the lines and curves."""

import math
from dataclasses import replace
from typing import NamedTuple

from simulearn.drawings.drawing import Drawing
from simulearn.drawings.svg.curves import Matrix
from simulearn.drawings.svg.layers import Layers
from simulearn.drawings.svg.lengths import IDENTITY, Viewport, after, fitted, shift, view_box
from simulearn.drawings.svg.page import page_of
from simulearn.drawings.svg.result import Collected
from simulearn.drawings.svg.shapes import runs_of
from simulearn.drawings.svg.sheet import UNREAD, StyleSheet
from simulearn.drawings.svg.style import Style, inherited, is_hidden, is_zero, painted
from simulearn.drawings.svg.tree import DEEPEST, XLINK, Document, Element, read_tree
from simulearn.errors import InputError

MOST_VISITS = 250_000  # elements drawn, those of a `use` each time

_SHAPES = frozenset(("line", "polyline", "polygon", "rect", "circle", "ellipse", "path"))
_GROUPS = frozenset(("g", "a", "svg", "switch", "use"))
_NO_LINES = frozenset(("text", "image", "foreignObject", "video", "audio", "canvas", "flowRoot"))
_MOVING = frozenset(("animate", "animateTransform", "animateMotion", "set", "script"))
_NOT_DRAWN = frozenset(
    (
        "defs",
        "symbol",
        "clipPath",
        "mask",
        "marker",
        "pattern",
        "filter",
        "style",
        "linearGradient",
        "radialGradient",
        "meshgradient",
        "hatch",
        "solidcolor",
        "metadata",
        "title",
        "desc",
        "view",
        "cursor",
        "font",
        "font-face",
        "color-profile",
    )
)


def read_svg(data: bytes) -> Drawing:
    """Return what an SVG file draws.

    Args:
        data: the file, plain or compressed (SVGZ).

    Returns:
        Lines and curves in user units of the outermost `svg`, y up, the lower left corner of its
        page at the origin.

    Raises:
        InputError: the file is no SVG, broken, or too large.
    """
    try:
        return _Reader(read_tree(data)).drawing()
    except RecursionError:  # of brackets within brackets in a style
        raise InputError("is nested too deeply to be read", "too-large") from None


class _Place(NamedTuple):
    """Where an element stands: what the elements around it hand on.

    Attributes:
        matrix: from its coordinates to those of the drawing.
        style: what it inherits.
        viewport: what its lengths go by.
        layer: full name of its layer.
        hidden: why it is not seen; empty where it is.
        used: what the `use` elements around it refer to.
        depth: how many elements are around it.
    """

    matrix: Matrix
    style: Style
    viewport: Viewport
    layer: str = ""
    hidden: str = ""
    used: tuple[Element, ...] = ()
    depth: int = 0


class _Reader:
    """One walk through one file."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self.sheet = StyleSheet(document.elements)
        self.layers = Layers(document)
        self.ids: dict[str, Element] = {}
        for element in document.elements:
            self.ids.setdefault(element.attributes.get("id", ""), element)
        self.found = Collected()
        self.visits = 0

    def drawing(self) -> Drawing:
        root = self.document.root
        declared = self.sheet.declared(root)
        page = page_of(self.document, declared)
        place = self.entered(
            root, declared, _Place(IDENTITY, Style(), page.viewport, self.layers.root_name())
        )
        self.children(root, place._replace(matrix=page.matrix(place.matrix)))
        messages = self.document.messages + self.sheet.messages()
        return self.found.drawing(page, messages)

    def children(self, element: Element, place: _Place) -> None:
        place = self.deeper(place)
        for child in _chosen(element) if element.tag == "switch" else element.children:
            self.visit(child, place)

    def deeper(self, place: _Place) -> _Place:
        if place.depth >= DEEPEST:
            raise InputError(f"its elements are nested more than {DEEPEST} deep", "too-large")
        return place._replace(depth=place.depth + 1)

    def visit(self, element: Element, place: _Place) -> None:
        self.visits += 1
        if self.visits > MOST_VISITS:
            raise InputError(
                f"draws more than {MOST_VISITS:,} elements, those of `use` counted each time",
                "too-large",
            )
        tag = element.tag
        if tag in _MOVING:
            self.found.tell("Scripts and animations are not run.")
        elif tag in _SHAPES or tag in _GROUPS or tag in _NO_LINES:
            self.seen(element, place)
        elif tag not in _NOT_DRAWN:
            self.found.leave_out(tag, place.layer, "is no element of SVG known here")

    def seen(self, element: Element, place: _Place) -> None:
        declared = self.sheet.declared(element)
        place = self.entered(element, declared, place)
        if element.tag in _NO_LINES:
            self.found.leave_out(element.tag, place.layer, place.hidden or "is no line")
        elif element.tag in _SHAPES:
            self.shape(element, declared, place)
        elif element.tag == "use":
            self.use(element, declared, place)
        elif element.tag == "svg":
            self.window(element, declared, place)
        else:
            self.children(element, place)

    def entered(self, element: Element, declared: dict[str, str], place: _Place) -> _Place:
        """Return the place with what the element itself says added."""
        style = inherited(place.style, declared)
        if "font-size" in declared:
            size = place.viewport.font_size(declared["font-size"], place.style.font_size)
            style = replace(style, font_size=size)
        layer, hidden = place.layer, place.hidden
        name = self.layers.name(element) if element.tag == "g" and not place.used else ""
        if name:
            layer = f"{layer}::{name}" if layer else name
        if not hidden and is_hidden(declared):
            hidden = "its layer is hidden" if name else "is hidden"
        for edge in ("clip-path", "mask"):
            if declared.get(edge, "none") != "none" and not hidden:
                self.found.tell("{} clipped or masked; what the edge hides is read, too.")
        for property_ in sorted(UNREAD & declared.keys()):
            self.found.tell(f"The CSS property {property_} is not read.")
        matrix = place.matrix
        if turn := self.transform(element, declared, place.viewport, style.font_size):
            matrix = after(matrix, turn)
        return place._replace(matrix=matrix, style=style, layer=layer, hidden=hidden)

    def transform(
        self, element: Element, declared: dict[str, str], viewport: Viewport, font_size: float
    ) -> Matrix | None:
        text = declared.get("transform")
        if text is None:
            return None
        matrix = viewport.transform(text, font_size)
        if matrix is None:
            self.found.problem(f"The transform of {element.name} cannot be read: {text[:40]}")
        elif "transform-origin" in declared and element.parent is not None:
            x, y = viewport.origin(declared["transform-origin"], font_size)
            matrix = after(after(shift(x, y), matrix), shift(-x, -y))
        return matrix

    def use(self, element: Element, declared: dict[str, str], place: _Place) -> None:
        reference = element.attributes.get("href", element.attributes.get(f"{XLINK} href", ""))
        target = self.ids.get(reference[1:]) if len(reference) > 1 else None
        reason = place.hidden
        if not reason and reference and not reference.startswith("#"):
            reason = "refers to another file"
        elif not reason and target is None:
            reason = "refers to nothing in the file"
        elif not reason and (target in place.used or _is_around(target, element)):
            reason = "refers to itself"
        if reason or target is None:
            self.found.leave_out("use", place.layer, reason)
            return
        x, y = (
            place.viewport.length(declared.get(name), name, place.style.font_size)
            for name in ("x", "y")
        )
        matrix = after(
            place.matrix, shift(*(0.0 if math.isnan(value) else value for value in (x, y)))
        )
        place = self.deeper(place)._replace(matrix=matrix, used=(*place.used, target))
        if target.tag not in ("symbol", "svg"):
            self.visit(target, place)
            return
        own = self.sheet.declared(target)
        size = {name: declared[name] for name in ("width", "height") if name in declared}
        self.window(target, own | size, self.entered(target, own, place))

    def window(self, element: Element, declared: dict[str, str], place: _Place) -> None:
        """Draw an inner `svg` or a `symbol` in use into its window."""
        viewport, font_size = place.viewport, place.style.font_size

        def length(name: str, direction: str, default: str) -> float:
            value = viewport.length(declared.get(name), direction, font_size)
            return viewport.length(default, direction) if math.isnan(value) else value

        matrix = place.matrix
        if element.tag == "svg":
            matrix = after(matrix, shift(length("x", "x", "0"), length("y", "y", "0")))
        width, height = length("width", "x", "100%"), length("height", "y", "100%")
        if width <= 0.0 or height <= 0.0:
            self.found.leave_out(element.tag, place.layer, "has a width or height of 0")
            return
        box = view_box(element.attributes.get("viewBox"))
        if box is not None:
            if math.isnan(width) or math.isnan(height):
                width, height = box[2], box[3]
            aspect = element.attributes.get("preserveAspectRatio")
            matrix = after(matrix, fitted(box, width, height, aspect))
            width, height = box[2], box[3]
        inner = Viewport(width, height, viewport.per_inch)
        self.children(element, place._replace(matrix=matrix, viewport=inner))

    def shape(self, element: Element, declared: dict[str, str], place: _Place) -> None:
        tag, style, layer = element.tag, place.style, place.layer
        if place.hidden or not style.visible:
            self.found.leave_out(tag, layer, place.hidden or "is hidden")
            return

        def length(name: str, direction: str) -> float:
            text = declared.get(name, element.attributes.get(name))
            return place.viewport.length(text, direction, style.font_size)

        runs, problem = runs_of(element, length)
        if problem:
            self.found.problem(f"The data of {element.name} {problem}.")
        if not runs:
            return
        drawn, colour = painted(style.stroke, style.stroke_opacity, style.color, self.ids)
        if drawn and not is_zero(style.stroke_width):
            self.found.add(runs, element, place.matrix, layer, colour)
            return
        filled, _ = painted(style.fill, style.fill_opacity, style.color, self.ids)
        reason = "is filled and has no stroke" if filled and tag != "line" else "has no stroke"
        self.found.leave_out(tag, layer, reason)


def _is_around(target: Element | None, element: Element) -> bool:
    outer: Element | None = element
    while outer is not None and outer is not target:
        outer = outer.parent
    return outer is not None


def _chosen(switch: Element) -> list[Element]:
    """Return the one child of a `switch` that is shown."""
    for child in switch.children:
        attributes = child.attributes
        languages = attributes.get("systemLanguage", "en").replace(",", " ").split()
        if not attributes.get("requiredExtensions") and any(
            language.lower().startswith("en") for language in languages
        ):
            return [child]
    return []
