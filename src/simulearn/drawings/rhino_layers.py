"""Layers and colours of Rhino, and what its things are called."""

from typing import Any

_SOLID = "is a surface or solid; its edges are not read"
_ANNOTATION = "is an annotation"

# What a thing is called and why it is left out ("" for what is read), by the name of its class.
_NAMES = {
    "LineCurve": ("line", ""),
    "PolylineCurve": ("polyline", ""),
    "PolyCurve": ("polycurve", ""),
    "NurbsCurve": ("NURBS curve", ""),
    "Arc": ("arc", ""),
    "Circle": ("circle", ""),
    "InstanceReference": ("block instance", ""),
    "Mesh": ("mesh", "is a mesh; its edges are not read"),
    "Brep": ("polysurface", _SOLID),
    "Extrusion": ("extrusion", _SOLID),
    "SubD": ("SubD", _SOLID),
    "Point": ("point", "is a point"),
    "PointCloud": ("point cloud", "is a point cloud"),
    "TextDot": ("text dot", "is text"),
    "Text": ("text", "is text"),
    "Leader": ("leader", _ANNOTATION),
    "Centermark": ("centre mark", _ANNOTATION),
    "AnnotationBase": ("annotation", _ANNOTATION),
    "Annotation": ("annotation", _ANNOTATION),
    "Hatch": ("hatch", "is an area"),
    "Light": ("light", "is a light"),
}


def kind_of(item: dict[str, Any]) -> tuple[str, str]:
    """Return what a thing is called, and why it is left out: "" for what is read.

    Args:
        item: as `rhino_process` writes it.
    """
    name = item.get("kind", "object")
    if name in _NAMES:
        return _NAMES[name]
    if name.startswith("Dim"):
        return "dimension", _ANNOTATION
    if name.endswith("Surface"):
        return "surface", _SOLID
    return ("curve", "") if "parts" in item else (name, "is no line")


class RhinoLayers:
    """The layer table of a model.

    Args:
        layers: as `rhino_process` writes them.
    """

    def __init__(self, layers: list[dict[str, Any]]) -> None:
        by_id = {layer["id"]: layer for layer in layers}
        self._paths = {layer["index"]: _path(layer, by_id) for layer in layers}

    def name(self, index: int) -> str:
        """Return a layer's full name, its levels joined by `::`; empty where there is none."""
        return "::".join(layer["name"] for layer in self._paths.get(index, []))

    def hidden(self, index: int) -> str:
        """Return why the things on a layer are not seen; empty where they are."""
        path = self._paths.get(index, [])
        if path and not path[-1]["visible"]:
            return "its layer is off"
        if not all(layer["visible"] for layer in path):
            return "a layer above its layer is off"
        return ""

    def colour(self, item: dict[str, Any], parent: str | None) -> str | None:
        """Return the colour that a thing is seen with, "#rrggbb".

        Args:
            item: as `rhino_process` writes it.
            parent: colour of the block instance that it belongs to; None outside of blocks.
        """
        if item["source"] == "ColorFromObject":
            return _hex(item["colour"])
        if item["source"] == "ColorFromParent" and parent:
            return parent
        path = self._paths.get(item["layer"], [])
        return _hex(path[-1]["colour"]) if path else None


def _path(layer: dict[str, Any], by_id: dict[str, dict[str, Any]]) -> list[dict[str, Any]]:
    """Return a layer and those above it, the outermost first."""
    path = [layer]
    while (above := by_id.get(path[0]["parent"])) is not None and above not in path:
        path.insert(0, above)
    return path


def _hex(rgb: list[int]) -> str:
    return "#{:02x}{:02x}{:02x}".format(*rgb)
