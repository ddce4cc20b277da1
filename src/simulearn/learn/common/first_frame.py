"""The first frame of a design: corners of the flat grid and the stress it was printed with.

It is known without simulating, so every model begins with it exactly.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.dataset import Batch
from simulearn.grid import Grid, outline
from simulearn.grid.sampled import outer_is_active
from simulearn.learn.common.model import Designs
from simulearn.material import Material

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FirstFrame:
    """The flat grids of T designs; mm, MPa.

    Attributes:
        joints: (T, J, 8, 3) corners.
        sections: (T, B, 3, 4, 3) corners.
        stress: (T, B, 4, 4, 6) printed-in stress at the sampling points.
        modes: (T, B, 2) adjacency modes of the beams' ends; see `dataset.features.end_modes`.
    """

    joints: Array
    sections: Array
    stress: Array
    modes: NDArray[np.int64]


def first_frame(designs: Designs) -> FirstFrame:
    """Return the first frame of designs.

    Raises:
        InputError: a joint has no sound outline.
    """
    material = designs.material
    shapes = [
        outline(Grid(joints, designs.beams, ratios, designs.fixed), material.section)
        for joints, ratios in zip(designs.flat, designs.actuators, strict=True)
    ]
    joints = np.array([shape.joints for shape in shapes])
    ends = np.array([shape.beams for shape in shapes])  # (T, B, [start, end], [right, left], xy)
    side = np.array([shape.sides for shape in shapes])
    half = material.section.thickness / 2
    axes = ends.mean(axis=3)
    lengths = np.linalg.norm(axes[:, :, 1] - axes[:, :, 0], axis=-1)  # (T, B) between faces
    sections = np.stack([ends[:, :, 0], ends.mean(axis=2), ends[:, :, 1]], axis=2)
    return FirstFrame(
        joints=np.concatenate([_at(joints, -half), _at(joints, half)], axis=2),
        sections=np.concatenate([_at(sections, -half), _at(sections, half)], axis=3),
        stress=_printed(designs, material, lengths),
        # A start's right corner is the side's first, an end's its second: hand = end.
        modes=1 + 4 * side + 3 * np.arange(2),
    )


def designs_of(batch: Batch) -> Designs:
    """Return the designs of trials."""
    return Designs(
        batch.beams, batch.fixed, batch.flat, batch.actuators, batch.material, batch.reference,
        batch.materials, mesh=batch.mesh,
    )  # fmt: skip


def _at(points: Array, z: float) -> Array:
    return np.concatenate([points, np.full((*points.shape[:-1], 1), z)], axis=-1)


def _printed(designs: Designs, material: Material, lengths: Array) -> Array:
    """Return the printed-in stress; the sampled sections lie just inside ends and middle.

    The active half is stressed along the beam, the other across it.
    """
    ends = designs.flat[:, designs.beams]
    along = (ends[:, :, 1] - ends[:, :, 0]) / np.linalg.norm(
        ends[:, :, 1] - ends[:, :, 0], axis=-1, keepdims=True
    )
    c, s = along[..., 0], along[..., 1]
    none = np.zeros_like(c)
    lengthwise = np.stack([c * c, s * s, none, c * s, none, none], axis=-1)
    crosswise = np.stack([s * s, c * c, none, -c * s, none, none], axis=-1)
    ratio = designs.actuators[:, :, None, None]
    outer = outer_is_active(ratio, lengths[:, :, None, None])
    reaches = np.where([[True], [False], [False], [True]], outer, ratio != 0)
    active = reaches & (np.sign(ratio) == np.array([-1, -1, 1, 1]))

    def tensor(kind: str) -> Array:
        along, across, _ = material.shrinkage.printed[kind]
        return (along * lengthwise + across * crosswise)[:, :, None, None]

    return np.where(active[..., None], tensor("active"), tensor("passive"))
