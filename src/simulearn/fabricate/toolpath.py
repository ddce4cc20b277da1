"""A toolpath as plain data: layers of beads, each with its role, width, height and speed.

Nothing here depends on G-code or on a printer. A picture, an estimate and a file are made from the
same beads. A move between two beads is a travel.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

SCHEMA = "simulearn.toolpath/1"

SKIRT, SHELL, ACTIVE, PASSIVE, JOINT = "skirt", "shell", "active", "passive", "joint"
BRIM = "brim"
ROLES = (SKIRT, SHELL, ACTIVE, PASSIVE, JOINT, BRIM)


@dataclass(frozen=True, eq=False)
class Bead:
    """One stroke of the nozzle without a break.

    Attributes:
        role: one of `ROLES`.
        part: what it belongs to, as in "beam 3", "joint 0", "outline", "skirt" or "brim".
        grid: which of the grids on the bed, from 0; -1 for the skirt and for a row of the brim that
            runs around several.
        points: (n, 2) mm on the bed; a closed bead ends where it begins.
        widths: (n - 1,) mm, of the bead between two points.
        speed: mm/min.
        flow: extruded volume over length x width x height.
    """

    role: str
    part: str
    grid: int
    points: NDArray[np.float64]
    widths: NDArray[np.float64]
    speed: float
    flow: float

    @property
    def lengths(self) -> NDArray[np.float64]:
        """(n - 1,) mm, from point to point."""
        steps = np.diff(self.points, axis=0)
        return np.hypot(steps[:, 0], steps[:, 1])

    @property
    def section(self) -> NDArray[np.float64]:
        """(n - 1,) mm2 of plastic across the bead for each mm of its height: width x flow."""
        return self.widths * self.flow


@dataclass(frozen=True)
class Layer:
    """Beads at one height, in printing order.

    Attributes:
        z: height of the nozzle above the bed, mm.
        height: thickness of the layer, mm.
        beads: in the order in which they are printed.
    """

    z: float
    height: float
    beads: tuple[Bead, ...]

    @property
    def volume(self) -> float:
        """Volume extruded, mm3."""
        return float(sum(b.lengths @ b.section for b in self.beads)) * self.height


@dataclass(frozen=True)
class Toolpath:
    """All layers of a print, from the bed up."""

    layers: tuple[Layer, ...]

    @property
    def bounds(self) -> NDArray[np.float64]:
        """[[least x, least y], [most x, most y]] of all beads' paths, mm."""
        points = np.concatenate([b.points for layer in self.layers for b in layer.beads])
        return np.array([points.min(axis=0), points.max(axis=0)])


def toolpath_to_dict(path: Toolpath) -> dict[str, Any]:
    """Return a toolpath as plain lists and numbers, for a browser or another program.

    The beads of all layers lie one after the other: bead b has the points starts[b] to
    starts[b + 1] - 1 and lies on layer layer_of[b]; width w is that from point w to the next.
    """
    beads = [(k, bead) for k, layer in enumerate(path.layers) for bead in layer.beads]
    counts = [len(bead.points) for _, bead in beads]
    return {
        "schema": SCHEMA,
        "roles": list(ROLES),
        "layers": [{"z": round(q.z, 6), "height": q.height} for q in path.layers],
        "layer_of": [k for k, _ in beads],
        "role": [ROLES.index(bead.role) for _, bead in beads],
        "part": [bead.part for _, bead in beads],
        "grid": [bead.grid for _, bead in beads],
        "speed": [bead.speed for _, bead in beads],
        "flow": [bead.flow for _, bead in beads],
        "starts": [0, *np.cumsum(counts).tolist()],
        "points": np.concatenate([bead.points for _, bead in beads]).tolist(),
        # After the last point of a bead nothing is printed: its width is 0.
        "width": np.concatenate([np.append(bead.widths, 0.0) for _, bead in beads]).tolist(),
    }
