"""Rhino files (.3dm): their lines, curves, blocks, layers and unit."""

from typing import Any

import numpy as np

from simulearn.drawings.cad_units import rhino_unit
from simulearn.drawings.collecting import MAX_DEPTH, Collected, Matrix, exploded
from simulearn.drawings.drawing import Drawing, Points
from simulearn.drawings.nurbs import Nurbs
from simulearn.drawings.rhino_file import contents
from simulearn.drawings.rhino_layers import RhinoLayers, kind_of


def read_3dm(data: bytes) -> Drawing:
    """Read a file of Rhino.

    Read is what is seen in the model: lines, polylines and curves, blocks as they are placed. All
    else is counted.

    Args:
        data: the file.

    Returns:
        The drawing, in the unit of the file.

    Raises:
        InputError: it is no .3dm file, damaged or too large.
    """
    model = contents(data)
    walk = _Walk(model)
    with np.errstate(all="ignore"):  # numbers that are none are reported
        walk.run()
    system = model["unit"]
    named = rhino_unit(system, f"the file's unit is {system}")
    if model["lost"]:
        walk.found.say(f"The file is damaged: {model['lost']} of its objects could not be read.")
    if system == "CustomUnits":
        walk.found.say("The file has a custom unit, whose length cannot be read.")
    return Drawing(
        "Rhino (.3dm)",
        walk.found.lines,
        walk.found.curves,
        walk.found.left_out,
        unit=named,
        messages=walk.found.messages,
    )


class _Walk:
    """Walks through a model, and through its blocks as they are placed."""

    def __init__(self, model: dict[str, Any]) -> None:
        self.found = Collected()
        self._objects = {item["id"]: item for item in model["objects"]}
        self._all = model["objects"]
        self._blocks = {block["id"]: block for block in model["blocks"]}
        self._layers = RhinoLayers(model["layers"])
        self._tolerance = abs(model["tolerance"])

    def run(self) -> None:
        """Read all that is placed in the model."""
        members = {member for block in self._blocks.values() for member in block["objects"]}
        placed = [
            item
            for item in self._all
            if item["mode"] != "InstanceDefinitionObject" and item["id"] not in members
        ]
        sizes: dict[str, int] = {}
        blocks = [item["block"] for item in placed if "block" in item]
        self.found.refuse_above(sum(exploded(name, self._contents, sizes) for name in blocks))
        for item in placed:
            self._thing(item, np.eye(4), None, ())

    def _contents(self, block: str) -> tuple[int, list[tuple[str, int]]]:
        """Count what a block holds, for `exploded`."""
        members = self._blocks[block]["objects"] if block in self._blocks else []
        things = [self._objects[member] for member in members if member in self._objects]
        return len(things), [(thing["block"], 1) for thing in things if "block" in thing]

    def _thing(
        self, item: dict[str, Any], matrix: Matrix, parent: str | None, inside: tuple[str, ...]
    ) -> None:
        """Read an object.

        Args:
            item: as `rhino_process` writes it.
            matrix: (4, 4) that places it, for points as rows.
            parent: colour of the block instance that it belongs to.
            inside: ids of the blocks that are being read, the outermost first.
        """
        self.found.visit()
        kind, reason = kind_of(item)
        layer = self._layers.name(item["layer"])
        hidden = self._layers.hidden(item["layer"])
        if item["page"]:
            reason = "is on a page of the layout"
        elif not item["visible"] or item["mode"] == "Hidden":
            reason = "is hidden"
        elif hidden:
            reason = hidden
        elif "broken" in item:
            reason = "is damaged"
        if reason:
            self.found.leave(kind, layer, reason)
            return
        colour = self._layers.colour(item, parent)
        if "block" in item:
            self._reference(item, matrix, colour, inside)
            return
        place = f" in block {self._blocks[inside[-1]]['name']}" if inside else ""
        where = f"{kind} {item['name'] or item['id'][:8]}{place}"
        try:
            parts = self._parts(item["parts"])
        except ValueError:
            self.found.leave(kind, layer, "is damaged")
            return
        for name, part in parts:
            if isinstance(part, Nurbs):
                self.found.curve(part.flatten, matrix, name, layer, colour, where)
            else:
                self.found.line(part, matrix, kind, layer, colour, where)

    def _parts(self, parts: list[dict[str, Any]]) -> list[tuple[str, Nurbs | Points]]:
        """Return a curve's parts, straight ones that follow each other joined.

        Args:
            parts: as `rhino_process` writes them.

        Returns:
            What each is called, and its points or the curve that it is.
        """
        found: list[tuple[str, Nurbs | Points]] = []
        for part in parts:
            new: Nurbs | Points | None
            if "points" in part:
                new = np.array(part["points"], dtype=float).reshape(-1, 3)
            else:
                curve = Nurbs(part["degree"], np.array(part["knots"]), np.array(part["control"]))
                new = curve.straight(self._tolerance)
                if new is None:
                    found.append((kind_of(part)[0], curve))
                    continue
            last = found[-1][1] if found else None
            if isinstance(last, np.ndarray) and np.allclose(
                last[-1:], new[:1], rtol=0, atol=self._tolerance
            ):
                found[-1] = ("", np.vstack((last, new[1:])))
            else:
                found.append(("", new))
        return found

    def _reference(
        self, item: dict[str, Any], matrix: Matrix, colour: str | None, inside: tuple[str, ...]
    ) -> None:
        """Read a block where an instance places it."""
        kind, layer = kind_of(item)[0], self._layers.name(item["layer"])
        block = self._blocks.get(item["block"])
        if block is None or not block["objects"]:
            name = block["name"] if block else ""
            self.found.leave(kind, layer, f"its block {name} is not in the file".replace("  ", " "))
        elif block["id"] in inside:
            self.found.leave(kind, layer, f"its block {block['name']} contains itself")
        elif len(inside) >= MAX_DEPTH:
            self.found.leave(kind, layer, f"is nested more than {MAX_DEPTH} blocks deep")
        else:
            own = np.array(item["matrix"], dtype=float).reshape(4, 4).T
            for member in block["objects"]:
                if member in self._objects:
                    thing = self._objects[member]
                    self._thing(thing, own @ matrix, colour, (*inside, block["id"]))
