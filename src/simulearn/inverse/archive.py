"""The archive: of all designs that a search scores, the best of each kind.

Two designs are of one kind if they are nearer to each other than a least distance. The distance is
how much their ratios differ, averaged over the actuators that may change, plus how far their joints
lie apart in the flat grid, averaged over the joints that may move, in lengths of a beam. So .2 is a
fifth of each beam active otherwise, or each joint a fifth of a beam elsewhere, or some of both.

A search scores thousands of designs and forgets all but the best. To keep those that differ costs
nothing beside the simulations: each new design is kept where nothing better of its kind is, and
takes the place of what is worse.

Source: the unstructured archive of quality-diversity search; Cully and Demiris, Quality and
Diversity Optimization: A Unifying Modular Framework, IEEE Transactions on Evolutionary Computation
22(2), 2018.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.grid import Grid
from simulearn.inverse.space import Space

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

LEAST = 0.2  # distance between designs of two kinds
MOST = 200  # designs that are kept


@dataclass(frozen=True, eq=False)
class Distance:
    """How far designs of a space are from each other.

    Attributes:
        joints: those that may move.
        beams: those whose ratio may change.
        start: (J, 2) mm, the design to begin with, its fixed joint at the origin.
        length: of a beam of it, on average, mm.
        turned: whether designs that differ by a turn in the plane are the same.
    """

    joints: Indices
    beams: Indices
    start: Array
    length: float
    turned: bool = False

    @classmethod
    def of(cls, space: Space, turned: bool = False) -> "Distance":
        """Return the distance between designs of a space."""
        grid = space.grid
        start, end = grid.joints[grid.beams[:, 0]], grid.joints[grid.beams[:, 1]]
        return cls(
            np.flatnonzero((space.motions != 0).any(axis=(0, 2))),
            np.array(sorted(b for group in space.groups for b in group), dtype=np.int64),
            grid.joints,
            float(np.linalg.norm(end - start, axis=1).mean()),
            turned,
        )

    def __call__(self, joints: Array, ratios: Array, others: Array, their_ratios: Array) -> Array:
        """Return the distances (T, K) of T designs from K others.

        Args:
            joints: (T, J, 2) mm, the fixed joint at the origin.
            ratios: (T, B).
            others: (K, J, 2) mm, joints of the others.
            their_ratios: (K, B).
        """
        away = np.zeros((len(joints), len(others)))
        if len(self.beams):
            a, b = ratios[:, self.beams], their_ratios[:, self.beams]
            away += np.abs(a[:, None] - b).mean(axis=-1)
        if len(self.joints):
            p, q = (self._placed(part)[:, self.joints] for part in (joints, others))
            away += np.linalg.norm(p[:, None] - q, axis=-1).mean(axis=-1) / self.length
        return away

    def _placed(self, joints: Array) -> Array:
        """Return joints (T, J, 2), turned to fit the design to begin with if turns do not count."""
        if not self.turned or not len(joints):
            return joints
        z = joints @ np.array([1, 1j])
        turn = (np.conj(z) * (self.start @ np.array([1, 1j]))).sum(axis=1)
        z *= (turn / np.maximum(np.abs(turn), 1e-12))[:, None]
        return np.stack([z.real, z.imag], axis=-1)

    def between(self, one: Grid, other: Grid) -> float:
        """Return the distance between two grids."""
        a, b = one.centred, other.centred
        given = (a.joints[None], a.actuators[None], b.joints[None], b.actuators[None])
        return float(self(*given)[0, 0])


class Archive:
    """The best designs of each kind so far.

    Args:
        distance: between designs.
        least: distance between any two that are kept.
        most: how many are kept.

    Attributes:
        joints: (K, J, 2) mm of the designs that are kept, the fixed joint at the origin.
        ratios: (K, B) of them.
        errors: (K,) mm, of them.
    """

    def __init__(self, distance: Distance, least: float = LEAST, most: int = MOST) -> None:
        self.distance, self.least, self.most = distance, least, most
        self.joints, self.ratios = np.empty((0, 0, 2)), np.empty((0, 0))
        self.errors = np.empty(0)

    def __len__(self) -> int:
        return len(self.errors)

    def add(self, joints: Array, ratios: Array, errors: Array) -> None:
        """Keep what is the best of its kind.

        Args:
            joints: (T, J, 2) mm, the fixed joint at the origin.
            ratios: (T, B).
            errors: (T,) mm; infinite where a design has no answer.
        """
        if not len(self):
            self.joints, self.ratios = joints[:0], ratios[:0]
        better = np.isfinite(errors)
        if len(self):
            near = self.distance(joints, ratios, self.joints, self.ratios) < self.least
            better &= ~(near & (self.errors <= errors[:, None])).any(axis=1)
        for t in np.flatnonzero(better)[np.argsort(errors[better], kind="stable")]:
            one = slice(t, t + 1)
            far = self.distance(joints[one], ratios[one], self.joints, self.ratios)[0] >= self.least
            if (self.errors[~far] > errors[t]).all():
                self.joints = np.concatenate([self.joints[far], joints[one]])
                self.ratios = np.concatenate([self.ratios[far], ratios[one]])
                self.errors = np.concatenate([self.errors[far], errors[one]])
        if len(self) > self.most:
            self._keep(np.argsort(self.errors, kind="stable")[: self.most])

    def grids(self, like: Grid) -> list[Grid]:
        """Return the designs as grids, all else being as in another."""
        return [
            Grid(joints, like.beams, ratios, like.fixed, like.material)
            for joints, ratios in zip(self.joints, self.ratios, strict=True)
        ]

    def _keep(self, which: Indices) -> None:
        self.joints, self.ratios = self.joints[which], self.ratios[which]
        self.errors = self.errors[which]
