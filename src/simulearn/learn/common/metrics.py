"""How far an answer is from the finite elements', by the paper's protocol and some more.

The vertex error of a trial is the mean distance over all corners of joints and sections in the
last frame, in % of that trial's grid dimension.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.dataset import Batch
from simulearn.dataset.features import end_modes, touching
from simulearn.learn.common.model import Frames
from simulearn.learn.common.parts import parts_of
from simulearn.material import member_of
from simulearn.rigid import fit_rotation

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Errors:
    """Errors of T trials.

    Attributes:
        numbers: (T,) of the trials in their set.
        dimension: (T,) mm.
        vertex: (T, 12) mean distance of corners, mm.
        rotation: (T, 12) mean angle between joints and true joints, degrees.
        gap: (T, 12) mean distance of joint corners to the beam corners that touch them, mm.
        motion: (T,) mean distance that the corners move from flat to the last frame, mm.
        bound: (T,) the model's own estimate of the last frame's vertex error, mm, or None.
        converged: (T,).
        kinds: (T,) name of each trial's kind of grid, where there are several.
        members: (T, M) numbers of their materials; see `material.Member`.
    """

    numbers: NDArray[np.int64]
    dimension: Array
    vertex: Array
    rotation: Array
    gap: Array
    motion: Array
    bound: Array | None
    converged: NDArray[np.bool_]
    kinds: tuple[str, ...] = ()
    members: Array | None = None

    @property
    def percent(self) -> Array:
        """(T, 12) vertex error in % of the dimension."""
        return 100 * self.vertex / self.dimension[:, None]

    def summary(self) -> dict[str, Any]:
        """Return the figures as plain data."""
        last, mm = self.percent[:, -1], self.vertex[:, -1]
        figures: dict[str, Any] = {"trials": len(last)}
        for unit, x in (("percent", last), ("mm", mm)):
            figures |= {
                f"mean_{unit}": float(x.mean()),
                f"median_{unit}": float(np.median(x)),
                f"p97_{unit}": float(np.percentile(x, 97)),
                f"worst_{unit}": float(x.max()),
            }
        figures |= {
            "worst_trial": int(self.numbers[last.argmax()]),
            "rotation_deg": float(self.rotation[:, -1].mean()),
            "gap_mm": float(self.gap[:, -1].mean()),
            "motion_mm": float(self.motion.mean()),
            **parts_of(self),
            "converged": int(self.converged.sum()),
            "frames": [
                {
                    "frame": f,
                    "mean_percent": float(self.percent[:, f].mean()),
                    "p97_percent": float(np.percentile(self.percent[:, f], 97)),
                    "mean_mm": float(self.vertex[:, f].mean()),
                    "rotation_deg": float(self.rotation[:, f].mean()),
                    "gap_mm": float(self.gap[:, f].mean()),
                }
                for f in range(self.vertex.shape[1])
            ],
        }
        return figures


def errors(frames: Frames, batch: Batch) -> Errors:
    """Return the errors of an answer to the designs of trials."""
    joints, sections = (
        np.linalg.norm(a - b, axis=-1).reshape(*a.shape[:2], -1)
        for a, b in ((frames.joints, batch.joints), (frames.sections, batch.sections))
    )
    moved = np.concatenate(
        [
            np.linalg.norm(x[:, -1] - x[:, 0], axis=-1).reshape(len(batch), -1)
            for x in (batch.joints, batch.sections)
        ],
        axis=1,
    )
    return Errors(
        numbers=batch.numbers,
        dimension=batch.dimensions,
        vertex=np.concatenate([joints, sections], axis=-1).mean(axis=-1),
        rotation=rotations(frames.joints, batch.joints).mean(axis=-1),
        gap=gaps(frames, batch),
        motion=moved.mean(axis=1),
        bound=frames.bound_mm,
        converged=frames.converged,
        kinds=batch.kinds,
        members=np.array([member_of(m) for m in batch.materials or (batch.material,) * len(batch)]),
    )


def together(parts: list[Errors]) -> Errors:
    """Return the errors of several topologies as one."""

    def all_of(name: str) -> Any:
        return np.concatenate([getattr(part, name) for part in parts])

    names = ("numbers", "dimension", "vertex", "rotation", "gap", "motion", "converged", "members")
    bounded = all(part.bound is not None for part in parts)
    return Errors(
        bound=all_of("bound") if bounded else None,
        kinds=tuple(kind for part in parts for kind in part.kinds),
        **{n: all_of(n) for n in names},
    )


def rotations(predicted: NDArray[np.floating], true: NDArray[np.floating]) -> Array:
    """Return the angles (...) between bodies with corners (..., 8, 3), degrees.

    The rotation that fits best (Kabsch 1976); its angle from the trace.
    """
    local = np.asarray(true, np.float64)
    turn, _ = fit_rotation(predicted, local - local.mean(axis=-2, keepdims=True))
    # Twice the sine is the norm of the antisymmetric part; the trace alone is blind near 0.
    axis = [turn[..., i, j] - turn[..., j, i] for i, j in ((2, 1), (0, 2), (1, 0))]
    sine = np.linalg.norm(np.stack(axis), axis=0)
    cosine = np.trace(turn, axis1=-2, axis2=-1) - 1
    return np.asarray(np.degrees(np.arctan2(sine, cosine)))


def gaps(frames: Frames, batch: Batch) -> Array:
    """Return the mean distance (T, F) of joint corners to the beam corners they touch, mm."""
    touch = touching(end_modes(batch))  # (T, B, 2, 4)
    corners = frames.joints[:, :, batch.beams]  # (T, F, B, 2, 8, 3)
    there = np.take_along_axis(corners, touch[:, None, ..., None], axis=4)
    ends = frames.sections[:, :, :, [0, 2]]
    return np.asarray(np.linalg.norm(ends - there, axis=-1).mean(axis=(2, 3, 4)))
