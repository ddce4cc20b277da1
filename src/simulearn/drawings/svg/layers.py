"""Which groups of an SVG file are layers, and their names: each program writes them its own way."""

import re

from simulearn.drawings.svg.tree import INKSCAPE, SERIF, Document, Element

# Names that programs give to groups by themselves: "g1024", "Group 12", "<Group>", "axes_1".
_AUTOMATIC = re.compile(
    r"(g|group|svg|path|use|surface|figure|axes|line2d|patch|_?<?group>?_?)[-_ ]?\d*([-_]\d+)*",
    re.I,
)


class Layers:
    """The names of the layers of one file.

    A file with layers of Inkscape has those and the groups that a person has labelled; in others
    each group with a name is one.
    """

    def __init__(self, document: Document) -> None:
        self._root = document.root
        self._names: dict[Element, str] = {}
        self._illustrator = any("Adobe Illustrator" in text for text in document.comments)
        groups = [element for element in document.elements if element.tag == "g"]
        self._ids = {group.attributes.get("id") for group in groups}
        self._inkscape = any(map(_is_inkscape_layer, groups))
        self._grouped = any(map(self.name, groups))

    def name(self, group: Element) -> str:
        """Return the name of the layer that a group is, empty where it is none."""
        if not group.attributes:
            return ""
        if group not in self._names:
            self._names[group] = self._name(group)
        return self._names[group]

    def _name(self, group: Element) -> str:
        attributes = group.attributes
        name = attributes.get(f"{INKSCAPE} label", "")
        if _is_inkscape_layer(group):
            return name or attributes.get("id", "")
        if not name and not self._inkscape:
            name = attributes.get("data-name") or attributes.get(f"{SERIF} id") or ""
            name = name or _decoded(self._without_count(attributes.get("id", "")))
        return _by_a_person(name)

    def _without_count(self, identity: str) -> str:
        """Return an id without the number that Figma adds to a name used before: `top 0.5_2`."""
        first = re.sub(r"_\d+$", "", identity)
        return first if " " in first and first in self._ids else identity

    def root_name(self) -> str:
        """Return the name of the only layer, which Illustrator writes on the outermost `svg`."""
        if self._grouped:
            return ""
        attributes = self._root.attributes
        name = attributes.get("data-name", "")
        if not name and self._illustrator:
            name = _decoded(attributes.get("id", ""))
        return _by_a_person(name)


def _is_inkscape_layer(element: Element) -> bool:
    return element.attributes.get(f"{INKSCAPE} groupmode") == "layer"


def _by_a_person(name: str) -> str:
    return "" if _AUTOMATIC.fullmatch(name.strip()) else name.strip()


def _decoded(identity: str) -> str:
    """Return a name from an id as Illustrator and CorelDRAW write it: `_x25_` for %, `_1_` last."""
    plain = re.sub(
        r"_x([0-9A-Fa-f]{2,5})_",
        lambda match: chr(int(match[1], 16)),
        re.sub(r"(?<=[^_])_\d+_$", "", identity),
    )
    return " ".join(plain.split())
