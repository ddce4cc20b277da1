"""The space of designs: what of a grid may change, as coordinates of its own.

A design is a point (x, a). Each of the P numbers x slides one joint, or a pair of partners, along a
direction (mm from where the grid began); each of the Q numbers a is the ratio of one actuator, or
of a pair. Symmetry is thus never lost, and methods of search see plain vectors.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.grid import Checks, Grid, TrainingRange, check_designs, validate
from simulearn.inverse.task import Free
from simulearn.learn.common.model import Designs
from simulearn.material import Material, load_material

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

FLIPS = {"x": (-1.0, 1.0), "y": (1.0, -1.0), "xy": (-1.0, -1.0), "none": (1.0, 1.0)}
CLOSE = 1e-9  # of ratios and lengths that are the same
ROUNDING = 1e-6  # mm, of sizes at their limits, as in validation


@dataclass(frozen=True)
class Unit:
    """Joints that move together.

    Attributes:
        joints: one, or two partners.
        slides: the coordinates x that move them: two, or one on a line of symmetry.
    """

    joints: tuple[int, ...]
    slides: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Space:
    """What may change about a grid.

    Attributes:
        grid: the design at x = 0, its fixed joint at the origin.
        motions: (P, J, 2) how a coordinate moves the joints, mm per mm.
        units: the joints that move together.
        groups: beams that have the same ratio.
        move: step of a joint, mm.
        ratio: step of a ratio.
        training: sizes that the engine has learnt; designs outside are not valid here.
    """

    grid: Grid
    motions: Array
    units: tuple[Unit, ...]
    groups: tuple[tuple[int, ...], ...]
    move: float
    ratio: float
    training: TrainingRange | None = None

    @classmethod
    def of(cls, grid: Grid, free: Free, training: TrainingRange | None = None) -> "Space":
        """Return the space of a grid.

        Args:
            grid: valid, without dangling beams.
            free: what may change.
            training: sizes that the engine has learnt; they confine the space unless the grid
                itself is outside.

        Raises:
            InputError: the grid is not valid, or nothing may change.
        """
        grid = grid.centred
        material = load_material(grid.material)
        report = validate(grid, material)
        for error in report.errors:
            raise InputError(
                f"the design to begin with: {error.message}", error.code, error.where, report.errors
            )
        motions, units = _motions(grid, free)
        own = free.actuators
        beams = range(len(grid.beams)) if own is None else sorted(set(own))
        groups = _paired(list(beams), free.pairs.actuators)
        for group in groups:
            if len({float(grid.actuators[b]) for b in group}) > 1:
                b, c = group
                raise InputError(
                    f"free.pairs.actuators has [{b}, {c}], whose ratios differ in the grid; "
                    "partners have the same"
                )
        if not (units or groups):
            raise InputError("free lets nothing change; name joints or actuators")
        if training is not None:
            training = training.of(material)
        if training is not None and outside(grid.joints[None], grid, training)[0]:
            training = None
        return cls(grid, motions, units, groups, free.move, free.ratio, training)

    @property
    def start(self) -> tuple[Array, Array]:
        """The point (P,), (Q,) of the grid itself."""
        return np.zeros(len(self.motions)), self.grid.actuators[[g[0] for g in self.groups]]

    def point(self, grid: Grid) -> tuple[Array, Array]:
        """Return the point (P,), (Q,) of a grid of this space."""
        away = grid.centred.joints - self.grid.joints
        size = (self.motions**2).sum(axis=(1, 2))
        x = np.einsum("pjc,jc->p", self.motions, away) / size
        return x, grid.actuators[[g[0] for g in self.groups]]

    def designs(self, x: Array, a: Array) -> Designs:
        """Return the designs of points (T, P), (T, Q)."""
        grid = self.grid
        flat = grid.joints + np.einsum("tp,pjc->tjc", x, self.motions)
        ratios = np.repeat(grid.actuators[None], len(a), axis=0)
        for q, group in enumerate(self.groups):
            ratios[:, group] = a[:, q, None]
        return Designs(grid.beams, grid.fixed, flat, ratios, self._material, grid.material)

    def grid_at(self, x: Array, a: Array) -> Grid:
        """Return the grid of a point (P,), (Q,)."""
        one = self.designs(x[None], a[None])
        return Grid(one.flat[0], one.beams, one.actuators[0], one.fixed, one.reference)

    def valid(self, x: Array, a: Array) -> Mask:
        """Return which of the points (T, P), (T, Q) are valid grids."""
        designs = self.designs(x, a)
        checks = self._checks(designs.flat, designs.actuators)
        valid: Mask = checks.valid & ~self._outside(designs.flat)
        return valid

    def nets(self, x: Array) -> Array:
        """Return the net lengths (T, B) mm of the beams; NaN where the joints lie impossibly."""
        flat = self.designs(x, np.zeros((len(x), len(self.groups)))).flat
        checks = self._checks(flat, np.zeros((len(x), len(self.grid.beams))))
        possible = checks.valid & ~self._outside(flat)
        return np.where(possible[:, None], checks.net_lengths, np.nan)

    def net(self, x: Array) -> Array | None:
        """Return the net lengths (B,) mm of the beams, or None if the joints lie impossibly."""
        net = self.nets(x[None])[0]
        return net if np.isfinite(net).all() else None

    def options(self, x: Array) -> list[Array]:
        """Return for each actuator the steps that are long enough at joints x (P,)."""
        count = int(1 / self.ratio + CLOSE)
        steps: Array = self.ratio * np.arange(-count, count + 1, dtype=float)
        net = self.net(x)
        if net is None:
            return [steps for _ in self.groups]
        least = [float(self._shortest / net[list(group)].min()) for group in self.groups]
        return [steps[(steps == 0) | (np.abs(steps) >= some - CLOSE)] for some in least]

    def nearest(self, x: Array, a: Array) -> Array:
        """Return the ratios (Q,) nearest to a that an actuator may have at joints x (P,)."""
        pairs = zip(self.options(x), a, strict=True)
        return np.array([some[np.abs(some - ratio).argmin()] for some, ratio in pairs], dtype=float)

    @cached_property
    def _material(self) -> Material:
        return load_material(self.grid.material)

    @property
    def _shortest(self) -> float:
        return self._material.limits.actuator_length

    def _checks(self, joints: Array, actuators: Array) -> Checks:
        grid = self.grid
        return check_designs(grid.beams, grid.fixed, joints, actuators, self._material)

    def _outside(self, joints: Array) -> Mask:
        """Return which layouts (T, J, 2) mm are beyond the sizes that confine the space."""
        if self.training is None:
            return np.zeros(len(joints), dtype=bool)
        return outside(joints, self.grid, self.training)


def outside(joints: Array, grid: Grid, training: TrainingRange) -> Mask:
    """Return which layouts of joints (T, J, 2) mm are beyond the sizes that were learnt.

    Args:
        joints: of designs with the topology of a grid.
        grid: whose beams and fixed joint count.
        training: the sizes.
    """
    start, end = joints[:, grid.beams[:, 0]], joints[:, grid.beams[:, 1]]
    lengths = np.linalg.norm(end - start, axis=-1)
    size = np.linalg.norm(joints - joints[:, [grid.fixed]], axis=-1).max(axis=1)
    mask: Mask = np.zeros(len(joints), dtype=bool)
    for values, (least, most) in (
        (lengths, training.beam_length),
        (size[:, None], training.dimension),
    ):
        mask |= ((values < least - ROUNDING) | (values > most + ROUNDING)).any(axis=1)
    return mask


def _motions(grid: Grid, free: Free) -> tuple[Array, tuple[Unit, ...]]:
    """Return how coordinates move the joints, and which coordinates belong together."""
    own = free.joints
    joints = range(len(grid.joints)) if own is None else sorted(set(own))
    flip = np.array(FLIPS[free.pairs.flip])
    alone = {pair[0] for pair in free.pairs.joints if pair[0] == pair[1]}
    motions: list[Array] = []
    units = []
    for group in _paired([k for k in joints if k != grid.fixed], free.pairs.joints):
        slides = []
        for axis in np.eye(2):
            if group[0] in alone and flip @ axis < 0:
                continue  # it would leave the line of symmetry
            slides.append(len(motions))
            motion = np.zeros((len(grid.joints), 2))
            motion[group[0]] = axis
            if len(group) > 1:
                motion[group[1]] = flip * axis
            motions.append(motion)
        if slides:
            units.append(Unit(group, tuple(slides)))
    return np.array(motions).reshape(-1, len(grid.joints), 2), tuple(units)


def _paired(members: list[int], pairs: list[list[int]]) -> tuple[tuple[int, ...], ...]:
    """Return the members in groups, partners together, in the order of their first."""
    partner = {k: tuple(dict.fromkeys(pair)) for pair in pairs for k in pair}
    groups = [partner.get(k, (k,)) for k in members]
    return tuple(dict.fromkeys(groups))
