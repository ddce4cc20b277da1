"""What a model is fitted to: the poses of joints and middles in finite-element trials.

Trials of any topology are stacked by filling up: with joints and beams that count for nothing, each
such joint hanging on the fixed one by a straight beam of its own.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import jax
import numpy as np

from simulearn.dataset import Batch
from simulearn.grid.outline import corner_topology
from simulearn.mechanics.forces import BeamState
from simulearn.mechanics.model import REFERENCE_WIDTH
from simulearn.mechanics.path import COEFFICIENTS, grid_of
from simulearn.mechanics.poses import Pose
from simulearn.mechanics.properties import Properties, properties_of, stacked
from simulearn.mechanics.topology import FlatGeometry, Topology, topologies
from simulearn.rigid import fit_rotation

FILLING = 40.0  # mm, the length of a beam that fills up


class TrialPoses(NamedTuple):
    """Trials, T of them, frames 1 to 11.

    Attributes:
        topology, geometry: (T, ...) the flat grids.
        ratio: (T, B) signed actuator ratios.
        size: (T,) grid dimension, mm.
        real: (T, J) 1 where a joint counts, 0 where it only fills up; of beams the topology has it.
        state: (T, 11, ...) poses of joints and middles.
        joints: (T, 11, J, 8, 3) corners in the joints' own axes, mm.
        middles: (T, 11, B, 4, 3) corners of the middle sections in theirs, mm.
        properties: (T,) numbers of the materials.
    """

    topology: Topology
    geometry: FlatGeometry
    ratio: Any
    size: Any
    real: Any
    state: BeamState
    joints: Any
    middles: Any
    properties: Properties


def trial_poses(batch: Batch) -> TrialPoses:
    """Return trials of one topology as mechanics sees them; numbers are NumPy's."""
    topology = topologies(batch.beams, batch.fixed, batch.flat)
    materials = batch.materials or (batch.material,) * len(batch)
    each = [properties_of(m, batch.mesh) for m in materials]
    geometry = _flat(batch, each)
    joints, sections = (
        batch.joints[:, 1:].astype(np.float64),
        batch.sections[:, 1:, :, 1].astype(np.float64),
    )
    R: Any
    p: Any
    R, p = fit_rotation(joints, np.asarray(geometry.corners)[:, None])
    # The fixed joint stays; what of it moves is its warping.
    R[:, :, batch.fixed] = np.eye(3)
    p[:, :, batch.fixed] = geometry.centre[:, None, batch.fixed]
    Rm: Any
    pm: Any
    Rm, pm = fit_rotation(sections, np.asarray(geometry.section)[:, None])

    def own(R: Any, p: Any, x: Any) -> Any:
        return np.einsum("tfjik,tfjci->tfjck", R, x - p[:, :, :, None])

    return TrialPoses(
        topology,
        geometry,
        np.asarray(batch.actuators),
        np.asarray(batch.dimensions),
        np.ones(batch.flat.shape[:2]),
        BeamState(Pose(R, p), Pose(Rm, pm)),
        own(R, p, joints),
        own(Rm, pm, sections),
        stacked(each),
    )


def _flat(batch: Batch, each: Sequence[Properties]) -> FlatGeometry:
    """Return the flat grids of trials; natively, so that no topology needs a compilation."""
    corners = corner_topology(batch.beams, batch.flat)
    none = np.zeros(COEFFICIENTS)
    rows = []
    for t, p in enumerate(each):
        own = tuple(x[t] for x in corners)
        grid = grid_of(batch.beams, batch.fixed, batch.flat[t], batch.actuators[t], own, none, p)
        rows.append(grid.geometry)
    stacks = {name: np.stack([getattr(row, name) for row in rows]) for name in rows[0]._fields}
    stacks["frame"] = stacks["frame"].reshape(len(rows), 2, -1, 3, 3)
    return FlatGeometry(**stacks, scale=np.array([p.width for p in each]) / REFERENCE_WIDTH)


def filled(trials: TrialPoses, joints: int, beams: int) -> TrialPoses:
    """Return trials filled up to some numbers of joints and beams.

    There must be a joint to fill with wherever there is a beam to fill with.
    """
    count, here, many = len(trials.ratio), trials.real.shape[1], trials.ratio.shape[1]
    more, extra = joints - here, beams - many
    if more == extra == 0:
        return trials
    if not 1 <= more <= extra:
        raise ValueError(f"{here} joints and {many} beams do not fill up to {joints} and {beams}")
    new = here + np.arange(extra) % more
    topology, geometry = trials.topology, trials.geometry
    fixed = np.repeat(topology.fixed[:, None], extra, axis=1)
    ends = np.stack([fixed, np.broadcast_to(new, fixed.shape)], axis=1)

    def grown(x: Any, axis: int, by: int, value: Any) -> Any:
        shape = list(np.shape(x))
        shape[axis] = by
        return np.concatenate([x, np.broadcast_to(value, shape).astype(x.dtype)], axis=axis)

    corner = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1.0]]) * 3.6
    block = np.concatenate([np.c_[corner, np.full(4, -2.0)], np.c_[corner, np.full(4, 2.0)]])
    section = np.array([[0, -3.6, -2], [0, 3.6, -2], [0, -3.6, 2], [0, 3.6, 2.0]])
    away = geometry.centre[np.arange(count), topology.fixed] + [FILLING + 7.2, 0, 0]
    halfway = away - [FILLING / 2 + 3.6, 0, 0]
    face = np.array([[3.6, 0, 0], [-3.6, 0, 0]])[:, None]
    frame = np.stack([np.eye(3), np.diag([-1.0, -1.0, 1.0])])[:, None]
    frames = trials.joints.shape[1]

    def extended(pose: Pose, at: Any, by: int) -> Pose:
        turn: Any = np.broadcast_to(np.eye(3), (count, frames, by, 3, 3))
        place: Any = np.broadcast_to(at[:, None, None], (count, frames, by, 3))
        return Pose(*(_behind(a, b) for a, b in zip(pose, (turn, place), strict=True)))

    return trials._replace(
        topology=topology._replace(
            ends=np.concatenate([topology.ends, ends], axis=2),
            before=grown(topology.before, 1, more, 0),
            after=grown(topology.after, 1, more, 0),
            parts=grown(topology.parts, 1, more, 1),
            part=grown(topology.part, 1, more, 0),
            side=grown(topology.side, 2, extra, 0),
            real=grown(topology.real, 1, extra, 0.0),
        ),
        geometry=FlatGeometry(
            centre=np.concatenate(
                [geometry.centre, np.broadcast_to(away[:, None], (count, more, 3))], axis=1
            ),
            corners=grown(geometry.corners, 1, more, block),
            area=grown(geometry.area, 1, more, 7.2**2),
            face=grown(geometry.face, 2, extra, face),
            frame=grown(geometry.frame, 2, extra, frame),
            reach=grown(geometry.reach, 2, extra, 3.6),
            skew=grown(geometry.skew, 2, extra, 0.0),
            length=grown(geometry.length, 1, extra, FILLING),
            middle=np.concatenate(
                [geometry.middle, np.broadcast_to(halfway[:, None], (count, extra, 3))], axis=1
            ),
            section=grown(geometry.section, 1, extra, section),
            scale=geometry.scale,
        ),
        ratio=grown(trials.ratio, 1, extra, 0.0),
        real=grown(trials.real, 1, more, 0.0),
        state=BeamState(
            extended(trials.state.joints, away, more),
            extended(trials.state.middles, halfway, extra),
        ),
        joints=grown(trials.joints, 2, more, block),
        middles=grown(trials.middles, 2, extra, section),
    )


def _behind(a: Any, b: Any) -> Any:
    """Return arrays joined along the axis of joints or beams."""
    return np.concatenate([a, b], axis=2)


def joined(parts: Sequence[Any]) -> Any:
    """Return trees of arrays with the same shapes, joined along T."""
    return jax.tree.map(lambda *x: np.concatenate(x), *parts)


def buckets(sizes: Sequence[tuple[int, int]], most: int = 5) -> list[tuple[int, int]]:
    """Return the sizes (joints, beams) to which trials of some sizes are filled up.

    A trial belongs to the first that has room for it: see `bucket_of`.

    Args:
        sizes: joints and beams of each topology.
        most: how many there are at most.
    """
    if len(set(sizes)) == 1:
        return [sizes[0]]
    beams = np.array([b for _, b in sizes])
    parts = np.quantile(beams, np.arange(1, most + 1) / most, method="higher")
    limits = sorted({int(x) for x in parts})
    rooms, low = [], 0
    for limit in limits:
        inside = [(j, b) for j, b in sizes if low < b <= limit]
        joints = max(j for j, _ in inside) + 1
        # As many beams to fill with as joints, at least.
        extra = max(limit + 1, max(b + joints - j for j, b in inside))
        rooms.append((joints, extra))
        low = limit
    return rooms


def bucket_of(size: tuple[int, int], rooms: Sequence[tuple[int, int]]) -> int:
    """Return the number of the first size that has room for a trial."""
    joints, beams = size
    for k, (j, b) in enumerate(rooms):
        if size == (j, b) or (j > joints and b - beams >= j - joints):
            return k
    raise ValueError(f"no room for {joints} joints and {beams} beams in {list(rooms)}")
