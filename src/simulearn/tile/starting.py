"""What a patch's own curvature asks of its beams: their actuators, and how their middles rise.

How far a beam turns by its ratio is measured once by the engine, on a grid whose beams along x are
all alike: gravity, creep and the beams across are then in it. So is how far the middle of a beam
rises above its chord, which is more than on a circle, since the actuator lies in the middle.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import ComputationError
from simulearn.grid import Grid, lattice
from simulearn.material import Material
from simulearn.simulate import Result
from simulearn.simulate import engine as engine_of
from simulearn.tile.flatten import arcs, flattened, turns

Array = NDArray[np.float64]

RATIOS = np.linspace(-1.0, 1.0, 9)


@dataclass(frozen=True, eq=False)
class Bending:
    """How beams bend by their ratio.

    Attributes:
        own: (R,) ratios, rising.
        turns: (R,) rad per mm, rising.
        lengths: (R,) length over flat length.
        rises: (R,) of the middle above the chord, over the length.
    """

    own: Array
    turns: Array
    lengths: Array
    rises: Array

    def ratios(self, turn: Array, length: Array) -> Array:
        """Return the ratios (B,) of beams of some length (mm) that turn by so much (rad)."""
        return np.interp(turn / length, self.turns, self.own)

    def rise(self, turn: Array, length: Array) -> Array:
        """Return how far (B,) mm the middles of such beams are above their chords."""
        return length * np.interp(turn / length, self.turns, self.rises)

    def flat(self, ratios: Array, length: Array) -> Array:
        """Return how long (B,) mm beams are flat that shall be so long (mm)."""
        longer: Array = length / np.interp(ratios, self.own, self.lengths)
        return longer


@lru_cache(maxsize=16)
def measured(engine: str, model: str | None, length: float, material: Material) -> Bending:
    """Return how beams of a material bend.

    Args:
        engine: its name.
        model: of it; None: its default.
        length: of the beams, mm.
        material: of the beams.

    Raises:
        InputError: the engine does not know the material.
        ComputationError: it has no answer.
    """
    plain = lattice((2, 2), length)
    along = np.ptp(plain.joints[plain.beams][..., 1], axis=1) == 0
    grids = [
        Grid(plain.joints, plain.beams, np.where(along, r, 0.0), plain.fixed, material)
        for r in RATIOS
    ]
    answers = engine_of(engine, model).simulate(grids)
    # Short beams have no short actuators.
    known = [k for k, answer in enumerate(answers) if isinstance(answer, Result)]
    if len(known) < 3:
        raise next(answer.error for answer in answers if not isinstance(answer, Result))
    results = [answer for answer in answers if isinstance(answer, Result)]
    centres = np.array([result.centres[-1] for result in results])
    corners = np.array([result.joints[-1] for result in results])
    up = corners[:, :, 4:].mean(axis=2) - corners[:, :, :4].mean(axis=2)
    up /= np.linalg.norm(up, axis=-1, keepdims=True)
    beams = plain.beams[along]
    turn = turns(centres, up, beams).mean(axis=1) / length
    longer = arcs(centres, up, beams).mean(axis=1) / length
    middles = np.array([result.beams[-1][along, 1].mean(axis=1) for result in results])
    above = middles - centres[:, beams].mean(axis=2)
    rise = (above * up[:, beams].mean(axis=2)).sum(axis=-1).mean(axis=1) / length
    if not (np.diff(turn) > 0).all():
        raise ComputationError("longer actuators do not bend beams further", "start", "material")
    return Bending(RATIOS[known], turn, longer, rise)


@dataclass(frozen=True, eq=False)
class Start:
    """What a patch's curvature asks for.

    Attributes:
        joints: (K, 2) mm, of the flat grid.
        ratios: (B,) of its actuators.
        middles: (B, 3) mm, where the middles of the beams are then.
    """

    joints: Array
    ratios: Array
    middles: Array


def start(
    targets: Array, normals: Array, grid: Grid, material: Material, engine: str, model: str | None
) -> Start:
    """Return what a patch's search begins with.

    Args:
        targets: (K, 3) mm, of the patch's joints.
        normals: (K, 3) unit, of the surface there.
        grid: the lattice whose joints they are.
        material: of the beams.
        engine: its name.
        model: of it; None: its default.
    """
    length, turn = arcs(targets, normals, grid.beams), turns(targets, normals, grid.beams)
    bending = measured(engine, model, round(float(length.mean())), material)
    ratios = bending.ratios(turn, length)
    longer = float((bending.flat(ratios, length) / length).mean())
    up = normals[grid.beams].mean(axis=1)
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    rise = bending.rise(turn, length)[:, None] * up
    middles = targets[grid.beams].mean(axis=1) + rise
    return Start(longer * flattened(targets, normals, grid), ratios, middles)
