"""Style sheets of SVG: what is declared for an element, by attribute, rule or its own style."""

import re
from collections.abc import Iterable
from functools import lru_cache
from typing import Any, NamedTuple

import tinycss2

from simulearn.drawings.svg.tree import Element
from simulearn.errors import InputError

PROPERTIES = frozenset(
    (
        "clip-path",
        "color",
        "cx",
        "cy",
        "display",
        "fill",
        "fill-opacity",
        "font-size",
        "height",
        "mask",
        "opacity",
        "r",
        "rx",
        "ry",
        "stroke",
        "stroke-opacity",
        "stroke-width",
        "transform",
        "transform-origin",
        "visibility",
        "width",
        "x",
        "y",
    )
)
# Those of a style that change what is drawn, too, but are not read: they are reported.
UNREAD = frozenset(("rotate", "scale", "translate", "transform-box", "d", "offset-path", "zoom"))
LARGEST_SHEETS = 2**20  # characters
MOST_CHECKS = 300_000  # of a rule with an element
MOST_PARTS = 20  # of a selector

LONGEST_STYLE = 100_000  # characters of a `style` attribute

_HEEDED = PROPERTIES | UNREAD
_PLAIN = re.compile(r"[\w\s:;#.,%+-]*")
_SCREEN = ("", "all", "screen")
_NEVER = {"hover", "focus", "active", "visited"}  # states of a screen that a drawing has not


class Declaration(NamedTuple):
    """One `name: value` of a style."""

    name: str
    value: str
    important: bool


class Compound(NamedTuple):
    """One part of a selector: what an element itself must be."""

    tag: str | None
    identity: str | None
    classes: tuple[str, ...]

    def holds(self, element: Element) -> bool:
        """Return whether an element is such a one."""
        attributes = element.attributes
        return (
            (self.tag is None or self.tag == element.tag)
            and (self.identity is None or self.identity == attributes.get("id"))
            and (not self.classes or set(self.classes) <= set(attributes.get("class", "").split()))
        )


class Rule(NamedTuple):
    """One selector with what it declares; parts from the outer to the inner element.

    `close[i]` says that part i is the parent of part i + 1, not just around it.
    """

    parts: tuple[Compound, ...]
    close: tuple[bool, ...]
    declarations: tuple[Declaration, ...]

    @property
    def weight(self) -> tuple[int, int, int]:
        """How specific it is, as CSS counts: ids, classes, names."""
        return (
            sum(part.identity is not None for part in self.parts),
            sum(len(part.classes) for part in self.parts),
            sum(part.tag is not None for part in self.parts),
        )

    def holds(self, element: Element) -> bool:
        """Return whether the rule is for an element."""
        if not self.parts[-1].holds(element):
            return False
        around: list[Element] = []
        while element.parent is not None:
            element = element.parent
            around.append(element)
        places = [-1]  # where in `around` the part before may stand; -1 is the element itself
        for part, close in zip(self.parts[-2::-1], self.close[::-1], strict=True):
            tried = [k + 1 for k in places] if close else range(places[0] + 1, len(around))
            places = [k for k in tried if k < len(around) and part.holds(around[k])]
            if not places:
                return False
        return True


class StyleSheet:
    """The style sheets of a file."""

    def __init__(self, elements: Iterable[Element]) -> None:
        self._unread: list[str] = []
        self._checks = 0
        self._rules: dict[str, list[tuple[int, Rule]]] = {}
        self._count = 0
        size = 0
        for element in elements:
            if element.tag == "style" and element.attributes.get("media", "") in _SCREEN:
                size += len(element.text)
                if size > LARGEST_SHEETS:
                    raise InputError("its style sheets are larger than 1 MiB", "too-large")
                self._add(tinycss2.parse_stylesheet(element.text, True, True))

    def declared(self, element: Element) -> dict[str, str]:
        """Return what is declared for an element itself: attributes, sheets, its own style."""
        attributes = element.attributes
        values = {name: value for name, value in attributes.items() if name in PROPERTIES}
        found: list[tuple[tuple[int, ...], Declaration]] = []
        if self._count:
            keys = [f".{name}" for name in attributes.get("class", "").split()]
            keys += [f"#{attributes.get('id')}", element.tag, "*"]
            for key in dict.fromkeys(keys):
                rules = self._rules.get(key, ())
                self._checks += len(rules)
                if self._checks > MOST_CHECKS:
                    raise InputError("has too many style rules for its elements", "too-large")
                for order, rule in rules:
                    if rule.holds(element):
                        rank = (*rule.weight, order)
                        found += [((item.important, 0, *rank), item) for item in rule.declarations]
        if "style" in attributes:
            for item in declarations(attributes["style"]):
                found.append(((item.important, 1, 0, 0, 0, 0), item))
        for _, item in sorted(found, key=lambda pair: pair[0]):
            values[item.name] = item.value
        return values

    def messages(self) -> list[str]:
        """Return what of the style sheets is not understood, in plain sentences."""
        return [f"The style for {text} is of a kind that is not read." for text in self._unread[:5]]

    def _add(self, nodes: list[Any]) -> None:
        for node in nodes:
            if node.type == "qualified-rule":
                self._add_rule(node)
            elif node.type == "at-rule" and node.lower_at_keyword == "media":
                media = tinycss2.serialize(node.prelude).strip().lower()
                if media in _SCREEN and node.content is not None:
                    self._add(tinycss2.parse_rule_list(node.content, True, True))
            elif node.type == "at-rule" and node.lower_at_keyword == "import":
                self._tell("@import")

    def _add_rule(self, node: Any) -> None:
        items = _declarations(node.content)
        if not items:
            return
        for tokens in _split(node.prelude):
            selector = _selector(tokens)
            if selector is None:
                text = tinycss2.serialize(tokens).strip()
                if not any(f":{state}" in text for state in _NEVER):
                    self._tell(text[:60])
                continue
            rule = Rule(*selector, items)
            last = rule.parts[-1]
            key = (
                f"#{last.identity}"
                if last.identity is not None
                else f".{last.classes[0]}"
                if last.classes
                else last.tag or "*"
            )
            self._rules.setdefault(key, []).append((self._count, rule))
            self._count += 1

    def _tell(self, text: str) -> None:
        if text not in self._unread:
            self._unread.append(text)


@lru_cache(maxsize=4096)
def declarations(style: str) -> tuple[Declaration, ...]:
    """Return the declarations of a `style` attribute that bear on a drawing."""
    if _PLAIN.fullmatch(style):  # almost every one; many times faster
        pairs = (part.partition(":") for part in style.split(";"))
        named = ((name.strip().lower(), value.strip()) for name, _, value in pairs)
        return tuple(
            Declaration(name, value, False) for name, value in named if name in _HEEDED and value
        )
    return _declarations(style[:LONGEST_STYLE])


def _declarations(content: Any) -> tuple[Declaration, ...]:
    nodes = tinycss2.parse_blocks_contents(content, skip_comments=True, skip_whitespace=True)
    return tuple(
        Declaration(node.lower_name, tinycss2.serialize(node.value).strip(), node.important)
        for node in nodes
        if node.type == "declaration" and node.lower_name in _HEEDED
    )


def _split(tokens: list[Any]) -> list[list[Any]]:
    groups: list[list[Any]] = [[]]
    for token in tokens:
        if token == ",":
            groups.append([])
        else:
            groups[-1].append(token)
    return groups


def _selector(tokens: list[Any]) -> tuple[tuple[Compound, ...], tuple[bool, ...]] | None:
    """Return the parts of a selector, or None where it is of a kind not read here."""
    parts: list[Compound] = []
    close: list[bool] = []
    open_part = False
    child = False
    after_dot = False
    for token in tokens:
        if after_dot:
            if token.type != "ident":
                return None
            parts[-1] = parts[-1]._replace(classes=(*parts[-1].classes, token.value))
            after_dot = False
            continue
        if token.type == "whitespace":
            open_part = False
            continue
        if token == ">":
            open_part, child = False, True
            continue
        if not open_part:
            if parts:
                close.append(child)
            parts.append(Compound(None, None, ()))
            open_part, child = True, False
        if token.type == "ident":
            parts[-1] = parts[-1]._replace(tag=token.value)
        elif token.type == "hash":
            parts[-1] = parts[-1]._replace(identity=token.value)
        elif token == ".":
            after_dot = True
        elif token != "*":
            return None
    whole = 0 < len(parts) <= MOST_PARTS and not after_dot and not child
    return (tuple(parts), tuple(close)) if whole else None
