"""What runs into what while an assembly morphs: parts, obstacles, and parts that touch on purpose.

Step by step, those parts that move are compared with all that are there; what stands still was
compared when it came to stand. Between two moments corners move along straight lines, as in the
pictures. A part that waits where it will slide in from is not there yet.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.assembly.assembly import Assembly, Part
from simulearn.assembly.timeline import Timeline
from simulearn.collisions import Body, Collision, against, between
from simulearn.errors import Cancel, stop_if
from simulearn.schedule import FRAMES
from simulearn.simulate import Progress, Result
from simulearn.simulate.skin import edges
from simulearn.surfaces import Surface

Array = NDArray[np.float64]
Row = tuple[int, Part, Result]  # which part, the part, its result
Present = Sequence[Row]

ALONG = np.linspace(0, 1, 13)  # of a beam, between which places it is taken as straight


@dataclass(frozen=True, eq=False)
class PartCollision:
    """Where two parts, a part and itself, or a part and an obstacle are in each other.

    Attributes:
        names: of the two; twice the same within a part, an obstacle last.
        where: what of either, as "beam 3" or "joint 7"; "obstacle" of an obstacle.
        time: s, when it is worst.
        step: in which that is.
        depth_mm: how deep.
        place: (3,) mm.
    """

    names: tuple[str, str]
    where: tuple[str, str]
    time: float
    step: int
    depth_mm: float
    place: tuple[float, float, float]

    @property
    def words(self) -> str:
        """What collides, how deep, and when."""
        (a, b), (one, other) = self.names, self.where
        if a == b:
            what = f"{a} with itself ({one} and {other})"
        elif other == "obstacle":
            what = f"{a} ({one}) with {b}"
        else:
            what = f"{a} ({one}) with {b} ({other})"
        return f"{what} by {self.depth_mm:.1f} mm in step {self.step + 1}"


def collisions_of(
    assembly: Assembly,
    present: Present,
    obstacles: Mapping[str, Surface],
    moments: Timeline,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> tuple[PartCollision, ...]:
    """Return all collisions of an assembly, each pair at its worst moment, the deepest first.

    Args:
        assembly: the parts, and which of them are joined.
        present: the parts that have a result.
        obstacles: their surfaces in their places, by name.
        moments: when each part is where.
        progress: called with the steps checked and the steps in all.
        cancel: stops it within a step.

    Raises:
        CancelledError: the token was set.
    """
    joined = {frozenset(pair) for pair in assembly.joined}
    worst: dict[tuple[tuple[str, str], tuple[str, str]], PartCollision] = {}
    for one in _all(assembly, present, obstacles, moments, progress, cancel):
        if frozenset(one.names) in joined and one.depth_mm <= assembly.joined_mm:
            continue
        key = one.names, one.where
        if key not in worst or one.depth_mm > worst[key].depth_mm:
            worst[key] = one
    return tuple(sorted(worst.values(), key=_shallowness))


def _shallowness(one: PartCollision) -> float:
    return -one.depth_mm


def _all(
    assembly: Assembly,
    present: Present,
    obstacles: Mapping[str, Surface],
    moments: Timeline,
    progress: Progress | None,
    cancel: Cancel | None,
) -> Iterator[PartCollision]:
    yield from _within(assembly, present, moments)
    triangles = {name: one.vertices[one.faces] for name, one in obstacles.items()}
    bodies, steps = _Bodies(present, moments), len(assembly.order)
    for step in range(-1, steps):  # first as all stands before the first step
        own = moments.of_step(max(step, 0))[: 1 if step < 0 else None]
        there = [row for row in present if not moments.waiting[own[-1], row[0]]]
        frames, shifts = moments.frames[own], moments.shifts[own]
        moves = (frames != frames[:1]) | (shifts != shifts[:1]).any(axis=2)
        moving = [row for row in there if step < 0 or moves[:, row[0]].any()]
        still = [row for row in there if row not in moving]
        yield from _in_step(moving, still, triangles, bodies, own, cancel)
        if progress is not None:
            progress(step + 1, steps)


def _in_step(
    moving: Present,
    still: Present,
    triangles: Mapping[str, Array],
    bodies: "_Bodies",
    own: NDArray[np.int64],
    cancel: Cancel | None,
) -> Iterator[PartCollision]:
    """Yield the collisions of parts that move, with each other and with all else."""
    moments = bodies.moments

    def timed(one: Collision, names: tuple[str, str], where: tuple[str, str]) -> PartCollision:
        next_one = min(one.frame + 1, len(own) - 1)
        begin, end = moments.times[own[one.frame]], moments.times[own[next_one]]
        time = float(begin + one.share * (end - begin))
        step = int(moments.steps[own[next_one]])
        return PartCollision(names, where, time, step, one.depth_mm, one.place)

    moving_bodies = [bodies.at(row, own) for row in moving]
    for body, (_, part, _) in zip(moving_bodies, moving, strict=True):
        for name, shape in triangles.items():
            stop_if(cancel)
            for one in against(body, shape):
                yield timed(one, (part.name, name), one.parts)
    stop_if(cancel)
    boxes = [_box(body) for body in moving_bodies]
    rows = [(row, body) for row in still if _near(body := bodies.at(row, own[:1]), boxes)]
    still = [row for row, _ in rows]
    # What stands still is one body, since its parts are not compared with each other.
    resting = [bodies.at(row, own) for row in still]
    for one in between([*moving_bodies, *([_merged(resting)] if resting else [])]):
        sides = [
            (moving[k][1].name, what) if k < len(moving) else _part_of(what, still, resting)
            for k, what in zip(one.bodies, one.parts, strict=True)
        ]
        # In the order of the parts, so that a pair is the same in every step.
        order = {part.name: k for k, part, _ in (*moving, *still)}
        sides.sort(key=lambda side: order[side[0]])
        (a, where_a), (b, where_b) = sides
        yield timed(one, (a, b), (where_a, where_b))


class _Bodies:
    """The parts at moments, in their places; their beams as they are drawn, in short pieces."""

    def __init__(self, present: Present, moments: Timeline) -> None:
        self.moments = moments
        sections: dict[int, Array] = {}
        for _, _, result in present:
            if id(result) not in sections:
                beams = range(len(result.grid.beams))
                along = [edges(result, b, ALONG) for b in beams]
                sections[id(result)] = np.stack(along, axis=1)
        self.sections = sections

    def at(self, row: Row, own: NDArray[np.int64]) -> Body:
        """Return a part at some moments."""
        k, part, result = row
        frames, shifts = self.moments.frames[own, k], self.moments.shifts[own, k]
        before = np.minimum(frames.astype(int), FRAMES - 2)

        def placed(corners: Array) -> Array:
            share = (frames - before).reshape(-1, *[1] * (corners.ndim - 1))
            now = (1 - share) * corners[before] + share * corners[before + 1]
            return part.place(now) + shifts.reshape(-1, *[1] * (corners.ndim - 2), 3)

        sections = placed(self.sections[id(result)])
        return Body(placed(result.joints), sections, result.grid.beams)


def _box(body: Body) -> tuple[Array, Array]:
    """Return the lowest and highest corner (3,) of a body over all its frames."""
    both = body.joints.reshape(-1, 3), body.sections.reshape(-1, 3)
    low, high = ([end(points, axis=0) for points in both] for end in (np.min, np.max))
    return np.minimum(*low), np.maximum(*high)


def _near(body: Body, boxes: Sequence[tuple[Array, Array]]) -> bool:
    """Return whether a body's box meets one of others."""
    low, high = _box(body)
    return any(bool(((low < b) & (a < high)).all()) for a, b in boxes)


def _merged(bodies: Sequence[Body]) -> Body:
    """Return bodies as one."""
    starts = np.cumsum([0, *(body.joints.shape[1] for body in bodies)])
    return Body(
        np.concatenate([body.joints for body in bodies], axis=1),
        np.concatenate([body.sections for body in bodies], axis=1),
        np.concatenate([b.beams + k for b, k in zip(bodies, starts, strict=False)]),
    )


def _part_of(what: str, still: Present, bodies: Sequence[Body]) -> tuple[str, str]:
    """Return the name of the part that a beam or joint of the merged body belongs to, and which."""
    kind, number = what.split()
    counts = [len(b.beams) if kind == "beam" else b.joints.shape[1] for b in bodies]
    ends = np.cumsum(counts)
    k = int(np.searchsorted(ends, int(number), side="right"))
    return still[k][1].name, f"{kind} {int(number) - int(ends[k]) + counts[k]}"


def _within(assembly: Assembly, present: Present, moments: Timeline) -> Iterator[PartCollision]:
    """Yield the collisions of parts with themselves, of equal parts once."""
    distinct = assembly.distinct
    for k, part, result in present:
        if distinct[k] != k:
            continue
        for one in result.collisions:
            # The first moment that shows it: before the timeline, of a part that is ready.
            m = int(np.argmax(moments.frames[:, k] >= one.frame + one.share - 1e-9))
            corner = part.place(np.array(one.place)) + moments.shifts[m, k]
            x, y, z = (float(v) for v in corner)
            time, step = float(moments.times[m]), int(moments.steps[m])
            parts = (one.parts[0], one.parts[1])
            yield PartCollision((part.name,) * 2, parts, time, step, one.depth_mm, (x, y, z))
