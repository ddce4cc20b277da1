"""How finely a grid is meshed, and where its bricks begin and end.

A joint and a beam are unit blocks of bricks: along, across and up run from 0 to 1 in each. Both are
divided across by the same breaks, so that they share the nodes of the face where they meet. Breaks
along a beam lie on the ends of its actuator: off-grid ends would shift tips by tens of per cent.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.fea.printing import actuator_reaches_end
from simulearn.grid import Grid, Outline
from simulearn.material import Section

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Layout:
    """How finely a grid is meshed.

    Attributes:
        core: bricks across the core between the shells; with 0 one brick spans the whole
            section and its integration points tell shell from core.
        slabs: slabs along a beam, even, so that the middle is a face.
        layers: bricks through each half.
    """

    core: int = 0
    slabs: int = 8
    layers: int = 1

    def __post_init__(self) -> None:
        if self.core < 0 or self.layers < 1 or self.slabs < 4 or self.slabs % 2:
            raise InputError(f"{self}: core is at least 0, slabs at least 4 and even, layers 1")

    def finer(self, other: "Layout") -> bool:
        """Whether this layout has more bricks some way than another, and fewer no way."""
        mine, theirs = ((one.core, one.slabs, one.layers) for one in (self, other))
        return mine != theirs and all(a >= b for a, b in zip(mine, theirs, strict=True))

    @property
    def name(self) -> str:
        """Name of the layout, or its numbers."""
        for name, layout in MESHES.items():
            if layout == self:
                return name
        return f"core {self.core}, slabs {self.slabs}, layers {self.layers}"

    def across(self, section: Section) -> Array:
        """Return the breaks across a section, 0 to 1."""
        shell = section.shell / section.width
        if self.core == 0:
            return np.array([0.0, 1.0])
        return np.unique(np.r_[0, np.linspace(shell, 1 - shell, self.core + 1), 1])


COARSE = Layout()  # 210 bricks in a 2x2 grid
FINE = Layout(core=1, slabs=16)  # 1,314; how far it is from finer ones: docs/verification.md
THREE_ACROSS = Layout(core=1)  # shell, core, shell: one growth per brick, as CalculiX needs it
MESHES = {"default": COARSE, "fine": FINE}  # those that have a name


class Breaks(NamedTuple):
    """Where bricks begin and end, 0 to 1.

    Attributes:
        along: (B, slabs + 1) along each beam.
        across: (strips + 1,) across a beam, and both ways in the plane of a joint.
        up: (2 layers + 1,) through the thickness.
    """

    along: Array
    across: Array
    up: Array


def breaks_of(grid: Grid, shape: Outline, section: Section, layout: Layout) -> Breaks:
    """Return where the bricks of a grid begin and end.

    Args:
        grid: the design.
        shape: its outline.
        section: of its beams.
        layout: how finely it is meshed.
    """
    # Slivers beyond an actuator's end would only spoil the mesh.
    whole = actuator_reaches_end(grid.actuators, net_lengths(shape))
    ratios = np.where(whole, 1.0, grid.actuators)
    return Breaks(
        along=np.array([cuts(ratio, layout.slabs) for ratio in ratios]),
        across=layout.across(section),
        up=np.linspace(0, 1, 2 * layout.layers + 1),
    )


def net_lengths(shape: Outline) -> Array:
    """Return the net lengths (B,) of the beams of an outline, mm."""
    axis = shape.beams.mean(axis=2)  # (B, [start, end], 2)
    return np.asarray(np.linalg.norm(axis[:, 1] - axis[:, 0], axis=1))


def cuts(ratio: float, slabs: int) -> Array:
    """Return where along a beam its slabs begin and end, 0 to 1, an actuator's ends among them.

    Args:
        ratio: actuator length over the beam's net length; the actuator is centred.
        slabs: number of slabs, even.

    Returns:
        (slabs + 1,) positions; uniform for every ratio that is a multiple of 2 / slabs.
    """
    ratio = abs(ratio)
    if ratio == 0 or ratio >= 1:
        return np.linspace(0, 1, slabs + 1)
    half = int(np.clip(round(ratio * slabs / 2), 1, slabs // 2 - 1))
    first = np.linspace(0, (1 - ratio) / 2, slabs // 2 - half + 1)
    middle = np.linspace((1 - ratio) / 2, (1 + ratio) / 2, 2 * half + 1)
    return np.concatenate([first, middle[1:-1], 1 - first[::-1]])
