"""When each part of an assembly is where: the moments of its steps, and what lies between.

A step shows the twelve frames of the parts that morph in it; a slide is cut into pieces that are
short against a beam, so that nothing can be passed through unseen between two moments.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.assembly.assembly import Assembly, Step
from simulearn.schedule import FRAMES

Array = NDArray[np.float64]

PIECE = 2.0  # mm of a slide between two moments


@dataclass(frozen=True, eq=False)
class Timeline:
    """Where P parts are in M moments.

    Attributes:
        times: (M,) s, growing.
        steps: (M,) the step that leads to each moment; of the first one the first.
        frames: (M, P) frame of each part; between two frames vertices move on straight lines.
        shifts: (M, P, 3) how far each part is from its place, mm.
        waiting: (M, P) whether a part has not yet set out for its place.
    """

    times: Array
    steps: NDArray[np.int64]
    frames: Array
    shifts: Array
    waiting: NDArray[np.bool_]

    @property
    def seconds(self) -> float:
        """Length of the timeline, s."""
        return float(self.times[-1])

    def at(self, time: float) -> tuple[int, Array, Array]:
        """Return the step, the frames (P,) and the shifts (P, 3) mm at a time (s)."""
        after = int(np.clip(np.searchsorted(self.times, time), 1, len(self.times) - 1))
        begin, end = self.times[after - 1], self.times[after]
        share = float(np.clip((time - begin) / (end - begin), 0, 1))

        def between(values: Array) -> Array:
            return (1 - share) * values[after - 1] + share * values[after]

        return int(self.steps[after]), between(self.frames), between(self.shifts)

    def of_step(self, step: int) -> NDArray[np.int64]:
        """Return the moments of a step, with the one in which it begins."""
        own = np.flatnonzero(self.steps[1:] == step) + 1
        return np.concatenate([own[:1] - 1, own])


def timeline(assembly: Assembly) -> Timeline:
    """Return the moments of all steps of an assembly, one after another."""
    places, count = assembly.places_of, len(assembly.parts)
    last = FRAMES - 1.0
    frames, shifts = np.full(count, last), np.zeros((count, 3))
    waiting = np.zeros(count, bool)
    for step in assembly.order:
        frames[[places[name] for name in step.parts]] = 0.0
        for name, offset in step.slide.items():
            shifts[places[name]] = offset
            waiting[places[name]] = bool(np.any(offset))
    rows = [(0.0, 0, frames, shifts, waiting)]
    for k, step in enumerate(assembly.order):
        morphing = [places[name] for name in step.parts]
        sliding = [places[name] for name in step.slide]
        waiting = waiting.copy()
        waiting[sliding] = False
        for slid, morphed, part in _shares(step):
            now = shifts.copy()
            now[sliding] *= 1 - slid
            stage = frames.copy()
            stage[morphing] = last * morphed
            rows.append((rows[-1][0] + part, k, stage, now, waiting))
        frames, shifts = rows[-1][2], rows[-1][3]
    times, steps, *others = (np.array(column) for column in zip(*rows, strict=True))
    return Timeline(times, steps, *others)


def _shares(step: Step) -> list[tuple[float, float, float]]:
    """Return the moments of a step: shares of its slide and its morphing, and s since the last."""
    length = max((float(np.linalg.norm(offset)) for offset in step.slide.values()), default=0.0)
    pieces = int(np.ceil(length / PIECE))
    steps = FRAMES - 1
    if step.sliding == "during" and step.parts:
        count = steps * max(1, -(-pieces // steps))
        shares = np.arange(1, count + 1) / count
        return [(share, share, step.seconds / count) for share in shares.tolist()]
    slide = [((n + 1) / pieces, 0.0, step.seconds / pieces) for n in range(pieces)]
    if not step.parts:
        return slide or [(1.0, 0.0, step.seconds)]
    return slide + [(1.0, (n + 1) / steps, step.seconds / steps) for n in range(steps)]
