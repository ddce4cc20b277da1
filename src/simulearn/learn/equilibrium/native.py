"""Predictions by native kernels: any topology without compilation, a design after the other.

Many designs are shared among threads in small portions, so that a core that is busy otherwise
takes fewer of them. What a design gives does not depend on the others.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulearn.files import cores
from simulearn.grid.outline import corner_topology
from simulearn.learn.common.model import Designs
from simulearn.learn.equilibrium.kernels.network import Layers, outputs
from simulearn.learn.equilibrium.kernels.stress import stress_in_space
from simulearn.learn.equilibrium.parameters import (
    CORRECTIONS,
    FACE,
    MIDDLE,
    REST,
    SEEN,
    STRESSES,
    TWIST_FLIP,
    TWIST_SIZE,
    VALUES_MIRROR,
    Heads,
    NetworkWeights,
    Parameters,
    Prediction,
)
from simulearn.learn.equilibrium.printed import Known, Print, prints_of
from simulearn.mechanics.kernels.geometry import set_corners
from simulearn.mechanics.model import REFERENCE_WIDTH
from simulearn.mechanics.path import (
    COEFFICIENTS,
    TOLERANCE,
    Grid,
    Path,
    flat_path,
    grid_of,
    schedule_frames,
    trace,
)
from simulearn.mechanics.properties import (
    REFERENCE_STIFFNESS,
    properties_of,
)
from simulearn.schedule import FRAMES

Numbers = NDArray[np.float64]
Solve = Callable[..., Path]  # see `mechanics.path.trace`

STOPS = np.array([0, 2, 4, 6, 8, 10, 11])  # frames on the way to the last alone
LENGTHS = np.zeros(len(CORRECTIONS.size), np.bool_)  # which outputs are lengths
LENGTHS[REST][:3] = LENGTHS[FACE] = LENGTHS[MIDDLE] = True
PORTIONS = 8  # that each core's share of a batch is divided into, at least


class Networks(NamedTuple):
    """A model's networks as the kernels take them; one for all designs and materials.

    Attributes:
        corrections: the network that corrects the law of sections, if there is one.
        stress: the one for stresses, if there is one.
        known: what materials met lately give, by their digest and the mesh; see `prints_of`.
    """

    corrections: Layers | None
    stress: Layers | None
    known: Known


def networks_of(parameters: Parameters) -> Networks:
    """Return a model's networks as the kernels take them."""
    corrections, stress = parameters.network, parameters.stress
    return Networks(
        None if corrections is None else _layers(corrections, CORRECTIONS),
        None if stress is None else _layers(stress, STRESSES),
        {},
    )


def _layers(weights: NetworkWeights, heads: Heads) -> Layers:
    def stacked(k: int, part: int) -> NDArray[np.float32]:
        return np.stack([np.asarray(layers[k][part], np.float32) for layers in weights.rounds])

    def single(x: Any) -> NDArray[np.float32]:
        return np.array(x, np.float32, order="C")  # a copy: read-only arrays have another type

    (first, second), (third, last) = weights.encode, weights.decode
    width = len(second[1])
    own, other, around = np.split(stacked(1, 0), [width, 2 * width], axis=1)
    arrays: list[Any] = [
        *map(single, (*first, *second)),
        stacked(0, 0), stacked(0, 1), *map(single, (own, other, around)), stacked(1, 1),
        *map(single, (*third, *last)),
        single(VALUES_MIRROR),
        heads.mirror[0].astype(np.int64), single(heads.mirror[1]),
        heads.flip[0].astype(np.int64), single(heads.flip[1]),
        np.asarray(heads.size, np.float64),
        TWIST_SIZE.astype(np.float64),
        np.asarray(TWIST_FLIP, np.float64),
    ]  # fmt: skip
    return Layers(*arrays)


def predict(
    parameters: Parameters,
    designs: Designs,
    last: bool = False,
    tolerance: float = TOLERANCE,
    networks: Networks | None = None,
    mesh: float = 1.0,
    solve: Solve = trace,
) -> Prediction:
    """Return all twelve frames of designs of one topology, stacked along T, or the last alone.

    Args:
        parameters: fitted.
        designs: T of them.
        last: whether only the last frame is needed.
        tolerance: of the last motion of an iteration, mm.
        networks: the parameters as the kernels take them, where they are at hand.
        mesh: 0 for answers as of the default mesh, 1 for those of the fine one.
        solve: finds the equilibria of a path's frames.
    """
    networks = networks or networks_of(parameters)
    prints = prints_of(parameters.law, designs, mesh, networks.known)
    count, joints, beams = len(designs), designs.flat.shape[1], len(designs.beams)
    stress = networks.stress is not None and not last
    out = _blank(count, 1 if last else FRAMES, joints, beams, stress)
    corners = corner_topology(designs.beams, designs.flat)

    def run(some: range) -> None:
        for t in some:
            own = tuple(x[t] for x in corners)
            grid = grid_of(
                designs.beams, designs.fixed, designs.flat[t], designs.actuators[t], own,
                prints[t].section, prints[t].properties,
            )  # fmt: skip
            _predict(networks, prints[t], grid, last, tolerance, out, t, solve)

    size = max(1, count // (PORTIONS * cores()))
    parts = [range(a, min(a + size, count)) for a in range(0, count, size)]
    if len(parts) > 1 and cores() > 1:
        with ThreadPoolExecutor(min(cores(), len(parts))) as pool:
            list(pool.map(run, parts))
    else:
        for part in parts:
            run(part)
    return out


def unsolved(grid: Grid, frames: Any, *_: Any, **__: Any) -> Path:
    """Return a path that stays flat, for those who need only what is done with a path."""
    return flat_path(grid, len(frames.released))


def _blank(count: int, frames: int, joints: int, beams: int, stress: bool) -> Prediction:
    """Return the prediction of designs none of which has an equilibrium yet."""
    return Prediction(
        np.full((count, frames, joints, 8, 3), np.nan),
        np.full((count, frames, beams, 3, 4, 3), np.nan),
        np.full((count, frames, beams, 4, 4, 6), np.nan) if stress else None,
        motion=np.full(count, np.inf),
        apart=np.full(count, np.inf),
        sag=np.full(count, np.inf),
        strain=np.full(count, np.inf),
        stable=np.zeros(count, np.bool_),
        left_balance=np.zeros(count, np.bool_),
        snaps=[() for _ in range(count)],
        seen=np.zeros((count, 2 * beams, SEEN)),
    )


def _predict(
    networks: Networks,
    printed: Print,
    grid: Grid,
    last: bool,
    tolerance: float,
    out: Prediction,
    t: int,
    solve: Solve,
) -> None:
    """Set the prediction of a design."""
    beams, p = len(grid.ratio), printed.properties
    scale = p.width / REFERENCE_WIDTH
    which = STOPS if last else slice(None)
    frames = schedule_frames(beams, p.creep, which=which)
    first = solve(grid, frames, small_steps=not last, tolerance=tolerance)
    final, warping = first, np.zeros((len(frames.released), 2, beams, 24))
    begin = len(frames.released) - 1 if last else 1
    valence = np.bincount(grid.layout.ends.ravel(), minlength=len(grid.geometry.area)).astype(float)

    def output(layers: Layers, path: Path, begin: int, size: Any) -> Numbers:
        values = np.zeros((len(frames.released), 2, beams, len(layers.size)))
        outputs(
            layers, grid.geometry, grid.layout.ends, grid.layout.fixed, grid.ratio, valence, path.R,
            path.twists, frames.released, frames.gravity, scale, printed.signs, printed.strain,
            begin, values,
        )  # fmt: skip
        return values * size

    if networks.corrections is not None and first.ended:
        values = output(networks.corrections, first, begin, np.where(LENGTHS, scale, 1.0))
        corrections = np.ascontiguousarray(values[..., :12])
        warping = np.ascontiguousarray(values[..., 12:])
        if last:
            final = _last_corrected(grid, frames, corrections, first, tolerance, solve)
        else:
            corrected = frames._replace(corrections=corrections, corrected=True)
            final = solve(grid, corrected, first, tolerance=tolerance)
    if last and not (first.ended and final.ended):  # frame by frame more converge
        rollout = _blank(1, FRAMES, len(grid.geometry.area), beams, False)
        _predict(networks, printed, grid, False, tolerance, rollout, 0, solve)
        for to, value in zip(out, rollout, strict=True):
            if value is not None:
                to[t] = value[0][-1:] if np.ndim(value[0]) > 1 else value[0]
        return
    joints = np.empty((len(frames.released), *out.joints.shape[2:]))
    sections = np.empty((len(frames.released), *out.sections.shape[2:]))
    if not (first.ended and final.ended):
        return
    set_corners(
        grid.geometry, grid.section, grid.layout.ends, grid.layout.fixed, grid.side,
        frames.released, warping, final.R, final.p, begin if last else 0, joints, sections,
    )  # fmt: skip
    out.joints[t], out.sections[t] = (x[-1:] if last else x for x in (joints, sections))
    if out.stress is not None and networks.stress is not None:
        stiff = p.stiffness / REFERENCE_STIFFNESS
        stress_in_space(
            output(networks.stress, final, 1, stiff), grid.geometry, grid.layout.ends, grid.ratio,
            final.R, frames.released, p.along, p.across, 0, out.stress[t],
        )  # fmt: skip
    many = len(grid.geometry.area)
    apart = final.p[-1, :many] - first.p[-1, :many]
    sag = first.p[-1, :many] - first.p[-2, :many]
    out.motion[t] = max(first.motion, final.motion)
    out.apart[t] = np.linalg.norm(apart, axis=-1).mean()
    out.sag[t] = np.linalg.norm(sag, axis=-1).mean()
    out.strain[t] = np.sqrt((first.twists[-1, ..., 3:] ** 2).sum(-1).mean())
    out.stable[t] = True
    out.left_balance[t] = first.left_balance or final.left_balance
    out.snaps[t] = tuple(final.snaps)
    out.seen[t] = seen_halves(grid, valence, scale)


def seen_in(designs: Designs) -> Numbers:
    """Return what is seen of the halves of flat designs: (T, 2 B, SEEN)."""
    corners, none = corner_topology(designs.beams, designs.flat), np.zeros(COEFFICIENTS)
    rows = []
    for t in range(len(designs)):
        p = properties_of(designs.material_of(t))
        own = tuple(x[t] for x in corners)
        grid = grid_of(
            designs.beams, designs.fixed, designs.flat[t], designs.actuators[t], own, none, p
        )
        valence = np.bincount(designs.beams.ravel(), minlength=len(designs.flat[t])).astype(float)
        rows.append(seen_halves(grid, valence, p.width / REFERENCE_WIDTH))
    return np.stack(rows)


def seen_halves(grid: Grid, valence: Numbers, scale: float) -> Numbers:
    """Return what is seen of a flat grid's halves: (2 B, SEEN); see `parameters.Prediction`."""
    g, ends = grid.geometry, grid.layout.ends
    size, length = np.abs(grid.ratio), g.length / scale
    rows = [
        np.stack([length] * 2), np.stack([size * length] * 2), g.reach / scale, g.skew / scale,
        g.reach[::-1] / scale, g.skew[::-1] / scale, g.area[ends] / scale**2, valence[ends],
    ]  # fmt: skip
    return np.stack(rows, axis=-1).reshape(-1, SEEN)


def _last_corrected(
    grid: Grid, frames: Any, corrections: Numbers, first: Path, tolerance: float, solve: Solve
) -> Path:
    """Return the path whose last frame is in corrected equilibrium, near the first shape's."""
    ends = np.array([0, len(frames.released) - 1])
    two = frames._replace(
        released=frames.released[ends],
        gravity=frames.gravity[ends],
        order=np.zeros(2, np.int64),
        corrections=np.ascontiguousarray(corrections[ends]),
        corrected=True,
    )
    guide = Path(
        first.R[ends],
        first.p[ends],
        first.info[ends],
        first.twists[ends],
        jumped=np.zeros(2, np.bool_),
    )
    short = solve(grid, two, guide, small_steps=False, tolerance=tolerance)

    def spread(x: Any, y: Any) -> Any:
        full = x.copy()
        full[-1] = y[-1]
        return full

    return Path(
        spread(first.R, short.R),
        spread(first.p, short.p),
        spread(first.info, short.info),
        spread(first.twists, short.twists),
        ended=short.ended,
    )
