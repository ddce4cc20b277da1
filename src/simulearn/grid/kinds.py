"""Random designs of many kinds of grids, in any material, to learn from and to test on.

A design begins with a plain net (see `nets`), which is sized, its joints moved about, and given
actuators. A draw depends on the seed and its number only.
"""

from math import cos, pi, sin, sqrt
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from simulearn.errors import InputError
from simulearn.grid.cleaning import clean
from simulearn.grid.designs import MOST_REDRAWS, Rules, Uniform, drawn_ratios, lengthened, source
from simulearn.grid.grid import Grid
from simulearn.grid.nets import NETS
from simulearn.grid.outline import outline
from simulearn.grid.validation import validate
from simulearn.material import Family, Material, draw_member

OPEN = ("chain",)  # kinds that are all open ends, which validation takes off


class Kinds(BaseModel):
    """How designs of several kinds are drawn.

    Attributes:
        shares: how often each kind is drawn, in parts of the sum.
        length: least and most length of the beams of the plain net, mm.
        widths: a beam of the plain net is at least as many widths of the section long.
        extent: largest distance from the fixed joint, mm; longer nets are scaled down.
        jitter: a joint moves by U(0, jitter) sqrt(U(0, 1)) lengths at a uniform angle.
        family: ranges of the materials.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    shares: dict[str, Annotated[float, Field(gt=0)]]
    length: tuple[float, float] = (20.0, 95.0)
    widths: float = 2.6
    extent: float = 150.0
    jitter: Annotated[float, Field(ge=0, le=1)] = 0.35
    family: Family = Family()

    def model_post_init(self, _: object) -> None:
        """Raise where a kind is not known."""
        for kind in self.shares:
            if kind not in NETS:
                raise ValueError(f'kind "{kind}" is not known; known are {", ".join(NETS)}')


class KindDesign(NamedTuple):
    """A random design: its grid, its material, the name of its kind, how often it was redrawn."""

    grid: Grid
    material: Material
    kind: str
    redraws: int


def draw_kind(kinds: Kinds, rules: Rules, base: Material, seed: int, k: int) -> KindDesign:
    """Return design k of a seed, drawn again until it is valid.

    Args:
        kinds: what kinds there are.
        rules: how actuators are drawn.
        base: the material whose family is drawn from.
        seed: names the set of designs.
        k: number of the design in the set.

    Raises:
        InputError: the rules hardly ever give a valid design.
    """
    # Kind and material stay when a design is redrawn, so that none is drawn more seldom.
    uniform = source(seed, k, MOST_REDRAWS + 1)
    material = draw_member(kinds.family, base, uniform)
    names, shares = list(kinds.shares), np.cumsum(list(kinds.shares.values()))
    kind = names[min(int(np.searchsorted(shares, uniform() * shares[-1])), len(names) - 1)]
    for redraw in range(MOST_REDRAWS + 1):
        grid = _draw(kind, kinds, rules, material, source(seed, k, redraw))
        if grid is not None:
            return KindDesign(grid, material, kind, redraw)
    raise InputError(f"the rules gave no valid {kind} in {MOST_REDRAWS} redraws ({kinds})")


def _draw(
    kind: str, kinds: Kinds, rules: Rules, material: Material, uniform: Uniform
) -> Grid | None:
    """Return a design of a kind, None where it is not valid."""
    section = material.section
    net = NETS[kind](uniform)
    joints, beams = net.joints, np.array(net.beams)
    middle = joints.mean(axis=0)
    fixed = 0 if kind in OPEN else int(np.argmin(((joints - middle) ** 2).sum(axis=1).round(6)))
    joints = joints - joints[fixed]
    least = max(kinds.length[0], kinds.widths * section.width)
    length = least + (max(kinds.length[1], least) - least) * uniform()
    far = float(np.linalg.norm(joints, axis=1).max())
    if far * length > kinds.extent:
        length = max(least, kinds.extent / far * (0.6 + 0.4 * uniform()))
    joints = joints * length
    for joint in joints:
        radius = kinds.jitter * length * uniform() * sqrt(uniform())
        angle = 2 * pi * uniform()
        joint += radius * cos(angle), radius * sin(angle)
    joints = (joints - joints[fixed]).round(6)
    ratios = drawn_ratios(rules, len(beams), uniform)
    try:
        grid = Grid(joints, beams, ratios, fixed, rules.material)
        if kind not in OPEN:
            grid = clean(grid)[0]
            if not validate(grid, material).valid:
                return None
        outline(grid, material.section)
        grid = lengthened(grid, rules, material)
    except InputError:
        return None
    ends = grid.joints[grid.beams]
    spans = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=-1)
    sound = kinds.length[0] <= spans.min() and spans.max() <= 100.0
    return grid.centred if sound else None
