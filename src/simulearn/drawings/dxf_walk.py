"""Walking through the model space of a DXF document, and through its blocks as they are placed."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from simulearn.drawings import dxf_shapes
from simulearn.drawings.collecting import MAX_DEPTH, Collected, Matrix, exploded
from simulearn.drawings.drawing import Points
from simulearn.drawings.dxf_layers import Inherited, Layers, layer_of, plain
from simulearn.errors import InputError


class Walk:
    """Collects the lines of a document.

    Args:
        document: of ezdxf.

    Attributes:
        found: what it collected.
    """

    def __init__(self, document: Any) -> None:
        self.found = Collected()
        self._document = document
        self._layers = Layers(document)

    def run(self) -> None:
        """Read the model space; count what is in paper space."""
        self.found.refuse_above(exploded("*Model_Space", self._contents, {}))
        self._layout(self._document.modelspace(), np.eye(4), Inherited(), ())
        for layout in self._document.layouts:
            if layout.is_any_paperspace:
                for entity in layout:
                    if entity.dxftype() != "VIEWPORT":
                        self._leave(entity, layer_of(entity), "is in paper space")

    def _contents(self, name: str) -> tuple[int, list[tuple[str, int]]]:
        """Count what a block holds, for `exploded`."""
        block = self._document.blocks.get(name)
        inserts = [e for e in block or () if e.dxftype() == "INSERT" and e.dxf.hasattr("name")]
        placed = [(e.dxf.name.lower(), _rows(e) * _columns(e)) for e in inserts]
        return len(block or ()), placed

    def _layout(
        self, layout: Any, matrix: Matrix, inherited: Inherited, inside: tuple[str, ...]
    ) -> None:
        """Read the entities of the model space or of a block.

        Args:
            layout: of ezdxf.
            matrix: that places it, (4, 4), for points as rows.
            inherited: by its entities.
            inside: names of the blocks that are being read, the outermost first.
        """
        for entity in layout:
            self.found.visit()
            try:
                self._entity(entity, matrix, inherited, inside)
            except InputError:
                raise
            except dxf_shapes.LeftOutError as error:
                self._leave(entity, self._layers.seen(entity, inherited).layer, str(error))
            except Exception:  # a broken entity fails in the library in any way
                self._leave(entity, "", "is damaged")

    def _entity(
        self, entity: Any, matrix: Matrix, inherited: Inherited, inside: tuple[str, ...]
    ) -> None:
        seen = self._layers.seen(entity, inherited)
        state = self._layers.state(seen.layer)
        kind = entity.dxftype()
        if entity.dxf.hasattr("invisible") and entity.dxf.invisible:
            self._leave(entity, seen.layer, "is hidden")
        elif kind == "INSERT" and not state.frozen:
            # A layer that is off hides its own entities only, not what blocks on it hold.
            self._reference(entity, matrix, seen, inside)
        elif state.hidden:
            self._leave(entity, seen.layer, state.hidden)
        elif kind in dxf_shapes.READERS:
            place = f" in block {inside[-1]}" if inside else ""
            where = f"{kind} {entity.dxf.get('handle', '')}".rstrip() + place
            for part in dxf_shapes.parts(entity):
                self._part(part, kind, matrix, seen, where)
        elif not (kind == "VIEWPORT" or (kind == "ATTDEF" and inside)):
            self._leave(entity, seen.layer, dxf_shapes.REASONS.get(kind, "is no line"))

    def _part(
        self, part: dxf_shapes.Part, kind: str, matrix: Matrix, seen: Inherited, where: str
    ) -> None:
        if part.flatten is not None:
            self.found.curve(part.flatten, matrix, part.kind, seen.layer, seen.colour, where)
        elif part.points is not None:
            self.found.line(part.points, matrix, kind, seen.layer, seen.colour, where)

    def _reference(
        self, insert: Any, matrix: Matrix, seen: Inherited, inside: tuple[str, ...]
    ) -> None:
        """Read a block where a reference places it, once for each row and column."""
        for attribute in insert.attribs:
            self._leave(attribute, seen.layer, dxf_shapes.REASONS["ATTRIB"])
        name, block = plain(str(insert.dxf.name)), insert.block()
        if block is None:
            self._leave(insert, seen.layer, f"its block {name} is not in the file")
        elif insert.is_xref():
            path = block.block.dxf.get("xref_path", "")
            self._leave(insert, seen.layer, f"its block {name} is another file (XREF): {path}")
        elif name.lower() in map(str.lower, inside):
            self._leave(insert, seen.layer, f"its block {name} contains itself")
        elif len(inside) >= MAX_DEPTH:
            self._leave(insert, seen.layer, f"is nested more than {MAX_DEPTH} blocks deep")
        else:
            self._remark_clipping(insert, name)
            own = np.array(list(insert.matrix44()), dtype=float).reshape(4, 4)
            for offset in self._offsets(insert):
                moved = own.copy()
                moved[3, :3] += offset
                self._layout(block, moved @ matrix, seen, (*inside, name))

    def _offsets(self, insert: Any) -> Iterator[Points]:
        """Offsets of a reference's rows and columns, which are turned with it but not scaled."""
        dxf = insert.dxf
        turn = np.radians(dxf.rotation)
        along = np.array([np.cos(turn), np.sin(turn)]) * dxf.column_spacing
        across = np.array([-np.sin(turn), np.cos(turn)]) * dxf.row_spacing
        to_world = insert.ocs().to_wcs
        for row in range(_rows(insert)):
            for column in range(_columns(insert)):
                x, y = row * across + column * along
                yield np.array(tuple(to_world((float(x), float(y), 0.0))))

    def _remark_clipping(self, insert: Any, name: str) -> None:
        if insert.has_extension_dict:
            from ezdxf.xclip import XClip

            if XClip(insert).has_clipping_path:
                self.found.say(f"Block {name} is clipped in the drawing; all of it is read.")

    def _leave(self, entity: Any, layer: str, reason: str) -> None:
        self.found.leave(entity.dxftype(), layer, reason)


def _rows(insert: Any) -> int:
    return int(insert.dxf.row_count) if insert.dxf.row_spacing else 1


def _columns(insert: Any) -> int:
    return int(insert.dxf.column_count) if insert.dxf.column_spacing else 1
