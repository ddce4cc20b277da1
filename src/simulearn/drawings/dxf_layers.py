"""Layers and colours of DXF: what an entity inherits from its layer and from its block."""

from dataclasses import dataclass
from typing import Any

_BY_BLOCK, _BY_LAYER = 0, 256
_PEN = "#000000"  # colour 7: black on paper, white on a dark screen


@dataclass(frozen=True)
class LayerState:
    """A layer as it is seen.

    Attributes:
        colour: "#rrggbb".
        hidden: why its entities are not seen; empty where they are.
        frozen: whether block references on it are hidden with all that they hold.
    """

    colour: str = _PEN
    hidden: str = ""
    frozen: bool = False


@dataclass(frozen=True)
class Inherited:
    """What the entities of a block take over from the reference.

    Attributes:
        layer: of entities on layer 0.
        colour: of entities with the colour "by block".
    """

    layer: str = "0"
    colour: str = _PEN


class Layers:
    """The layer table of a document.

    Args:
        document: of ezdxf.
    """

    def __init__(self, document: Any) -> None:
        self._states: dict[str, LayerState] = {}
        for layer in document.layers:
            frozen, off = layer.is_frozen(), layer.is_off()
            hidden = "its layer is frozen" if frozen else "its layer is off" if off else ""
            colour = _hex(layer.rgb) if layer.rgb else _indexed(abs(layer.dxf.color)) or _PEN
            self._states[plain(layer.dxf.name).lower()] = LayerState(colour, hidden, frozen)

    def state(self, name: str) -> LayerState:
        """Return a layer's state; one that is missing in the table is seen, in black."""
        return self._states.get(name.lower(), LayerState())

    def seen(self, entity: Any, inherited: Inherited) -> Inherited:
        """Return the layer and colour that an entity is seen with.

        Args:
            entity: of ezdxf.
            inherited: from the block reference that it belongs to.
        """
        layer = layer_of(entity)
        layer = inherited.layer if layer == "0" else layer
        if entity.dxf.hasattr("true_color"):
            return Inherited(layer, _hex(entity.rgb))
        index = entity.dxf.color if entity.dxf.hasattr("color") else _BY_LAYER
        if index == _BY_BLOCK:
            return Inherited(layer, inherited.colour)
        return Inherited(layer, _indexed(index) or self.state(layer).colour)


def plain(name: str) -> str:
    """Return a name with its escapes for letters replaced by the letters."""
    from ezdxf.lldxf.encoding import decode_dxf_unicode, decode_mif_to_unicode

    if "\\" in name:
        name = decode_mif_to_unicode(decode_dxf_unicode(name))
    return name.encode("utf-8", "replace").decode("utf-8")


def layer_of(entity: Any) -> str:
    """Return the name of the layer that an entity names itself."""
    if not entity.dxf.hasattr("layer"):  # of a kind that ezdxf does not know
        return plain(str(entity.graphic_properties().get("layer", "0")))
    return plain(str(entity.dxf.layer))


def _indexed(index: int) -> str | None:
    """Return a colour by its index (1 to 255), or None."""
    from ezdxf.colors import aci2rgb

    if index == 7:
        return _PEN
    return _hex(aci2rgb(index)) if 1 <= index <= 255 else None


def _hex(rgb: tuple[int, int, int]) -> str:
    return "#{:02x}{:02x}{:02x}".format(*rgb)
