"""Stress at the sampling points of beams in space; see `learn.equilibrium.stresses`."""

from typing import Any

import numpy as np

from simulearn.native import native

Array = Any

INSIDE = 0.9  # mm from a half's end, where stress is sampled


@native()
def stress_in_space(
    elastic: Array, geometry: Any, ends: Array, ratio: Array, R: Array, released: Array,
    along: float, across: float, begin: int, out: Array,
) -> None:  # fmt: skip
    """Set the stress of some frames: what was printed in and is not released yet, plus elastic.

    Args:
        elastic: (F, 2, B, 48) MPa, in the halves' axes: [face, middle], corner, component.
        geometry: the flat grid.
        ends: (2, B) joint of each half.
        ratio: (B,) signed actuator ratios.
        R: (F, J + B, 9) rotations of joints and middles.
        released: (F,) fraction.
        along: MPa, printed in along active material.
        across: MPa, printed in across passive material.
        begin: the first frame that counts.
        out: (F, B, 4, 4, 6) MPa to set, in global axes: 11, 22, 33, 12, 13, 23.
    """
    beams, joints = len(ratio), R.shape[1] - len(ratio)
    axes, tensor, turned = np.zeros((3, 3)), np.zeros((3, 3)), np.zeros((3, 3))
    for f in range(begin, len(released)):
        left = 1 - released[f]
        for b in range(beams):
            for end in range(2):
                joint, frame = ends[end, b], geometry.frame[end, b]
                for spot in range(2):  # near the face, near the middle
                    if spot == 0:
                        active = (1 - abs(ratio[b])) / 2 * geometry.length[b] < INSIDE
                        for i in range(3):
                            for j in range(3):
                                axes[i, j] = 0.0
                                for m in range(3):
                                    axes[i, j] += R[f, joint, 3 * i + m] * frame[3 * m + j]
                    else:
                        active = ratio[b] != 0
                        for i in range(3):
                            for j in range(3):
                                sign = -1.0 if end == 1 and j < 2 else 1.0
                                axes[i, j] = sign * R[f, joints + b, 3 * i + j]
                    section = spot if end == 0 else 3 - spot
                    for corner in range(4):
                        own = elastic[f, end, b]
                        at = 24 * spot + 6 * corner
                        busy = active and (corner >= 2) == (ratio[b] > 0)
                        tensor[0, 0] = own[at] + (left * along if busy else 0.0)
                        tensor[1, 1] = own[at + 1] + (0.0 if busy else left * across)
                        tensor[2, 2] = own[at + 2]
                        tensor[0, 1] = tensor[1, 0] = own[at + 3]
                        tensor[0, 2] = tensor[2, 0] = own[at + 4]
                        tensor[1, 2] = tensor[2, 1] = own[at + 5]
                        for i in range(3):
                            for j in range(3):
                                turned[i, j] = (
                                    axes[i, 0] * tensor[0, j]
                                    + axes[i, 1] * tensor[1, j]
                                    + axes[i, 2] * tensor[2, j]
                                )
                        # Right and left of a beam as its second half has them change places.
                        place = corner if end == 0 else (corner ^ 1)
                        target = out[f, b, section, place]
                        for k in range(6):
                            i = k if k < 3 else (0 if k < 5 else 1)
                            j = k if k < 3 else (1 if k == 3 else 2)
                            target[k] = (
                                turned[i, 0] * axes[j, 0]
                                + turned[i, 1] * axes[j, 1]
                                + turned[i, 2] * axes[j, 2]
                            )
