"""The frames of a grid by native beam mechanics, through snaps where there are any.

Frame after frame is solved by `kernels.path.follow`. Where one is not plain (no equilibrium is
near, it is unstable, or far from where the path leads) it is followed in small steps from the frame
before. Where a small step finds no stable equilibrium near, the grid descends to the next one under
the same load, as it would in the viscous bath: a snap. An unstable equilibrium is left along its
softest mode.
"""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulearn.mechanics.kernels.assembly import Layout
from simulearn.mechanics.kernels.geometry import Geometry, set_geometry
from simulearn.mechanics.kernels.path import (
    ASTRAY,
    INFO,
    MOTION,
    MOVED,
    NEGATIVE,
    WIDEST,
    Frames,
    follow,
)
from simulearn.mechanics.model import SECTION_SHAPES, SectionModel
from simulearn.mechanics.ordering import layout_of
from simulearn.mechanics.properties import Properties
from simulearn.schedule import SCHEDULE, Snap

Numbers = NDArray[np.float64]
Indices = NDArray[np.int64]

TOLERANCE = 1e-6  # mm, of the last motion of an iteration
LOOSE = 1e-2  # mm, the same in frames that only lead to the last
MOST = 60  # factorisations in a frame
DESCENT = 600  # the same in a descent
# Shares of the grid's dimension
EXPECTED = 0.04  # from where the path leads, beyond which a frame is followed in small steps
JUMP = 0.2  # the same where the path does not lead on: at first, and where gravity changes
WIDER = 2.5  # times as much where only some of the frames are reached
SMALLEST = 1 / 32  # of a frame, the smallest step
ALLOWED = 1.0  # mm that a small step may move more than twice what the step before did
SNAP = 0.03  # of the grid's dimension: the least motion that is a snap
SHOVE = 0.1  # mm along the softest mode
COEFFICIENTS = sum(int(np.prod(shape)) for shape in SECTION_SHAPES)  # of a section
TURN = 3.0  # rad, by which a half-beam bends at most


class Grid(NamedTuple):
    """A grid as the kernels take it.

    Attributes:
        layout: its topology.
        geometry: the flat grid in numbers.
        side: (2, B) side of its joint that each half leaves.
        ratio: (B,) signed actuator ratios.
        section: (B + 1, coefficients) of the beams, and of joints.
        load: body force N/mm3, section mm2, thickness mm.
    """

    layout: Layout
    geometry: Geometry
    side: Indices
    ratio: Numbers
    section: Numbers
    load: Numbers

    @property
    def nodes(self) -> int:
        """Number of joints and middles."""
        return len(self.geometry.area) + len(self.ratio)

    @property
    def dimension(self) -> float:
        """Largest distance of a joint from the fixed one, mm."""
        away = self.geometry.centre - self.geometry.centre[self.layout.fixed]
        return float(np.linalg.norm(away, axis=1).max())


@dataclass
class Path:
    """The states of all frames.

    Attributes:
        R, p: (F, J + B, 9), (F, J + B, 3) poses of joints, then middles; frame 0 is flat.
        info: (F, INFO) see `kernels.path`.
        twists: (F, 2, B, 6) of halves from the rest that the section model has.
        snaps: in the order in which they happen.
        left_balance: whether an unstable equilibrium was left, so that a mirrored shape exists.
        ended: whether every frame has a stable equilibrium.
        plain: whether no frame had to be followed in small steps.
        tight: whether the frames before the last are as accurate as the last.
        jumped: (F,) whether a frame is beyond a snap that the frame before is not.
    """

    R: Numbers
    p: Numbers
    info: Numbers
    twists: Numbers
    snaps: list[Snap] = field(default_factory=list)
    left_balance: bool = False
    ended: bool = True
    plain: bool = True
    tight: bool = True
    jumped: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, np.bool_))

    @property
    def motion(self) -> float:
        """The last motion of an iteration, largest of all frames, mm."""
        return float(self.info[1:, MOTION].max()) if self.ended else np.inf


def coefficients(section_model: SectionModel) -> Numbers:
    """Return the coefficients of a section model in one array, as the kernels take them.

    One of many materials, whose axis is the last, gives (coefficients, T).
    """
    flat = [
        np.reshape(np.asarray(x, np.float64), (int(np.prod(shape)), *np.shape(x)[len(shape) :]))
        for x, shape in zip(section_model, SECTION_SHAPES, strict=True)
    ]
    return np.concatenate(flat)


def load_of(p: Properties) -> Numbers:
    """Return body force N/mm3, section mm2 and thickness mm."""
    return np.array([p.body, p.width * p.thickness, p.thickness], np.float64)


def grid_of(
    beams: Indices,
    fixed: int,
    joints: Numbers,
    ratio: Numbers,
    corners: tuple[Indices, ...],
    section: Numbers,
    p: Properties,
) -> Grid:
    """Return a design as the kernels take it.

    Args:
        beams: (B, 2) joint indices.
        fixed: index of the fixed joint.
        joints: (J, 2) mm.
        ratio: (B,) signed actuator ratios.
        corners: before, after, parts, part (J, 4) and side (2, B); see `grid.outline`.
        section: (B + 1, coefficients), or (coefficients,) the same for all; see `coefficients`.
        p: numbers of the material.
    """
    layout = layout_of(beams, fixed, len(joints))
    count, many = len(joints), len(beams)
    geometry = Geometry(
        np.zeros((count, 3)), np.zeros((count, 8, 3)), np.zeros(count), np.zeros((2, many, 3)),
        np.zeros((2, many, 9)), np.zeros((2, many)), np.zeros((2, many)), np.zeros(many),
        np.zeros((many, 3)), np.zeros((many, 4, 3)),
    )  # fmt: skip
    # All are copies: what is read-only has another type, for which kernels are compiled once more.
    own = [np.array(x, np.int64, order="C") for x in corners]
    places = np.array(joints, np.float64, order="C")
    set_geometry(geometry, places, layout.ends, *own, p.width, p.thickness)
    rows = np.array(np.broadcast_to(section, (many + 1, section.shape[-1])), order="C")
    return Grid(layout, geometry, own[4], np.array(ratio, np.float64), rows, load_of(p))


def schedule_frames(
    beams: int, creep: float, corrections: Numbers | None = None, which: Any = slice(None)
) -> Frames:
    """Return what acts in the frames of a simulation, or in some of them.

    Args:
        beams: how many there are.
        creep: creep strain over elastic strain.
        corrections: (F, 2, B, 12) see `kernels.path.Frames`.
        which: index over the twelve frames, the flat one first.
    """
    released = np.array(SCHEDULE.released)[which]
    gravity = np.array(SCHEDULE.gravity(creep))[which]
    count = len(released)
    order = np.clip(np.arange(count) - 2, 0, 2)
    order[-1] = 0
    if corrections is None:
        return Frames(released, gravity, order, np.zeros((count, 2, beams, 12)), False)
    return Frames(released, gravity, order, corrections, True)


def flat_path(grid: Grid, count: int) -> Path:
    """Return a path of so many frames in each of which the grid is flat."""
    nodes, joints = grid.nodes, len(grid.geometry.area)
    path = Path(
        np.empty((count, nodes, 9)),
        np.empty((count, nodes, 3)),
        np.zeros((count, INFO)),
        np.zeros((count, 2, len(grid.ratio), 6)),
        jumped=np.zeros(count, np.bool_),
    )
    path.R[:, :joints] = np.eye(3).ravel()
    path.R[:, joints:] = grid.geometry.frame[0]
    path.p[:, :joints], path.p[:, joints:] = grid.geometry.centre, grid.geometry.middle
    return path


def trace(
    grid: Grid,
    frames: Frames,
    guide: Path | None = None,
    small_steps: bool = True,
    tolerance: float = TOLERANCE,
) -> Path:
    """Return the states of frames.

    Args:
        grid: the design.
        frames: what acts in each.
        guide: states near which those of the frames are expected, where it has no snap.
        small_steps: whether a frame that is not plain is followed in small steps; if not, the path
            ends there.
        tolerance: of the last motion of an iteration, mm.
    """
    count = len(frames.released)
    path = flat_path(grid, count)
    path.tight = small_steps
    order = frames.order.copy()
    guided = np.zeros(count, np.bool_)
    if guide is not None:
        guided[:] = ~guide.jumped
        guided[1:] &= ~guide.jumped[:-1]
    far = grid.dimension * np.where(guided | (order > 0), EXPECTED, JUMP)
    if not small_steps:
        far *= WIDER
    if len(far) > 1:
        far[1] = np.inf  # a grid that hangs down may go far at once
    k = 1
    while k < count:
        k = _follow(grid, frames._replace(order=order), guide, guided, k, far, path, tolerance)
        if k == count:
            break
        path.plain = False
        if not small_steps or not _small_steps(grid, frames, k, path, tolerance):
            path.ended = False
            break
        if path.jumped[k]:  # what follows does not continue the path before
            order[k + 1 : k + 4] = np.minimum(order[k + 1 : k + 4], [0, 1, 2][: count - k - 1])
            guided[k + 1 : k + 3] = False
            far[k + 1 : k + 2] = JUMP * grid.dimension
        k += 1
    if path.ended and not path.info[1:, WIDEST].max() < TURN**2:
        path.ended = False
    return path


def _follow(
    grid: Grid,
    frames: Frames,
    guide: Path | None,
    guided: NDArray[np.bool_],
    begin: int,
    far: Numbers,
    path: Path,
    tolerance: float,
    near: bool = False,
    descend: bool = False,
    shove: float = 0.0,
) -> int:
    """Call the kernel; return the first frame that is not plain."""
    along = path if guide is None else guide
    tolerances = np.full(len(frames.released), tolerance if path.tight else max(tolerance, LOOSE))
    tolerances[-1] = tolerance
    return int(
        follow(
            grid.layout, grid.geometry, grid.section, grid.load, grid.ratio, frames,
            along.R, along.p, guided, begin, near, descend, shove, tolerances,
            DESCENT if descend else MOST, far, path.R, path.p, path.info, path.twists,
        )
    )  # fmt: skip


def _small_steps(grid: Grid, frames: Frames, k: int, path: Path, tolerance: float) -> bool:
    """Follow a frame in small steps from the one before; return whether it was reached."""
    before = path.info[k - 1, MOVED] if k > 1 else np.inf
    rate = before if np.isfinite(before) else 0.0  # mm per frame
    at, step, goes_on = 0.0, 0.25, False
    short = Path(
        np.stack([path.R[k - 1]] * 2),
        np.stack([path.p[k - 1]] * 2),
        np.zeros((2, INFO)),
        np.zeros((2, 2, len(grid.ratio), 6)),
    )
    unguided, anywhere = np.zeros(2, np.bool_), np.full(2, np.inf)
    while at < 1:
        to = min(1.0, at + step)
        now = _between(frames, k, to)
        near = k > 1 or at > 0

        def find(
            descend: bool = False, shove: float = 0.0, now: Any = now, near: Any = near
        ) -> bool:
            done = _follow(
                grid, now, None, unguided, 1, anywhere, short, tolerance, near, descend, shove
            )
            return done == 2

        reached = find()
        moved = float(short.info[1, MOVED])
        allowed = ALLOWED + 2 * rate * (to - at)
        if not reached or not moved <= allowed:
            if step > SMALLEST:
                step /= 2
                continue
            # No equilibrium that is stable is near: along the softest mode, and down.
            unstable = short.info[1, MOTION] <= tolerance and short.info[1, NEGATIVE] > 0
            balanced = bool(unstable and moved <= allowed)
            if balanced:
                short.R[0], short.p[0] = short.R[1], short.p[1]
            tries = (SHOVE, 10 * SHOVE) if balanced else (0.0, SHOVE)
            if not any(find(True, shove) for shove in tries):
                if not balanced or to == 1:
                    return False
                at, step = to, SMALLEST  # so nearly neutral that it is left where it is less so
                continue
            path.left_balance |= balanced
            path.jumped[k] = True
            moved = float(short.info[1, MOVED])
            snapped = not balanced and moved > SNAP * grid.dimension
            begun = float(_between(frames, k, at).released[1])
            if snapped and not goes_on and (k > 1 or begun > 0):
                path.snaps.append(Snap(begun, k))
            goes_on = snapped
            moved = 0.0
        else:
            goes_on = False
        rate = moved / (to - at) if moved > 0 else rate
        short.R[0], short.p[0] = short.R[1], short.p[1]
        at, step = to, min(2 * step, 0.25)
    path.R[k], path.p[k] = short.R[1], short.p[1]
    path.info[k], path.twists[k] = short.info[1], short.twists[1]
    path.info[k, MOVED] = np.linalg.norm(path.p[k] - path.p[k - 1], axis=1).max()
    path.info[k, ASTRAY] = 0.0
    return True


def _between(frames: Frames, k: int, part: float) -> Frames:
    """Return what acts between two frames, all linear in between, as the second of two frames.

    From the flat frame on, gravity comes first, then the release.
    """
    heavy = min(1.0, 2 * part) if k == 1 else part
    release = max(0.0, 2 * part - 1) if k == 1 else part

    def mixed(x: Numbers, part: float) -> Numbers:
        return np.stack([x[k - 1], (1 - part) * x[k - 1] + part * x[k]])

    return Frames(
        mixed(frames.released, release),
        mixed(frames.gravity, heavy),
        np.zeros(2, np.int64),
        mixed(frames.corrections, part),
        frames.corrected,
    )
