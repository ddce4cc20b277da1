"""The graph of a trial: the features of its beams, joints and connections.

A beam is an edge: the corners of three sections, the stress at its sampling points, its actuator
and where the fixed joint is. A joint is a node: its eight corners, whether it is the fixed one,
and where the fixed one is. An adjacency mode says how a beam meets a joint.

Features: Yang et al., SimuLearn, UIST 2020, Figure 5.
"""

import numpy as np
from numpy.typing import NDArray

from simulearn.dataset.packed import Batch
from simulearn.grid import outline

Array = NDArray[np.floating]
Indices = NDArray[np.int64]

MODES = 16  # four sides of a joint x two ends of a beam x two hands; 0 is no connection

# Where the parts of a feature vector lie.
CENTRE = slice(0, 3)  # mm
SECTIONS = slice(3, 39)  # mm; section, corner, xyz
STRESS = slice(39, 135)  # MPa; section, corner, component
CORNERS = slice(3, 27)  # mm; of a joint: corner, xyz
FIXED = 27  # 1 for the fixed joint
EDGE, EDGE_PLAIN, NODE = 139, 43, 31  # lengths: beam, beam without stress, joint


def edge_features(batch: Batch, stress: bool = True) -> Array:
    """Return the features of all beams in all frames.

    Args:
        batch: trials of one topology.
        stress: whether stresses are among the features (stage 1) or not (stage 2).

    Returns:
        (T, F, B, 139): centre 3, sections 36, stress 96, signed actuator ratio 1, vector from
        the centre to the centre of the fixed joint 3; (T, F, B, 43) without stress. mm, MPa.
    """
    trials, frames, beams = batch.sections.shape[:3]
    centre = batch.sections.mean(axis=(3, 4))
    many = (trials, frames, beams)
    parts = [centre, batch.sections.reshape(*many, 36)]
    if stress:
        if batch.stress is None:
            raise ValueError("stage 1 needs stresses; read the data set with them")
        parts.append(batch.stress.reshape(*many, 96))
    ratio = np.broadcast_to(batch.actuators[:, None, :, None], (*many, 1))
    parts += [ratio.astype(centre.dtype), _held(batch)[:, :, None] - centre]
    return np.concatenate(parts, axis=-1)


def node_features(batch: Batch) -> Array:
    """Return the features of all joints in all frames.

    Returns:
        (T, F, J, 31): centre 3, corners 24, whether it is the fixed joint 1, vector from the
        centre to the centre of the fixed joint 3. mm.
    """
    trials, frames, joints = batch.joints.shape[:3]
    centre = batch.joints.mean(axis=3)
    fixed = np.zeros((trials, frames, joints, 1), centre.dtype)
    fixed[:, :, batch.fixed] = 1
    corners = batch.joints.reshape(trials, frames, joints, 24)
    return np.concatenate([centre, corners, fixed, _held(batch)[:, :, None] - centre], axis=-1)


def sides(batch: Batch) -> Indices:
    """Return the side of its start and of its end joint that each beam meets: (T, B, 2)."""
    section = batch.material.section
    return np.stack([outline(batch.grid(t), section).sides for t in range(len(batch))])


def end_modes(batch: Batch) -> Indices:
    """Return the adjacency modes of the beams' ends: (T, B, 2), 1 to 16.

    A mode is 1 + 4 side + 2 end + hand: the side of the joint (0 to 3), which end of the beam
    (0 start, 1 end), and whether the side's first corner meets the beam's right edge (0) or
    its left (1). Corners sorted as in `Result` leave two of the four pairs of end and hand.
    """
    side = sides(batch)
    flat = batch.joints[:, 0, :, :4, :2]
    trial = np.arange(len(batch))[:, None, None]
    first = flat[trial, batch.beams[None], side]  # (T, B, 2, xy)
    ends = batch.sections[:, 0, :, [0, 2], :2, :2].transpose(1, 2, 0, 3, 4)
    away = np.linalg.norm(ends - first[..., None, :], axis=-1)  # (T, B, end, [right, left])
    return 1 + 4 * side + 2 * np.arange(2) + away.argmin(axis=-1)


def touching(modes: Indices) -> Indices:
    """Return the joint corners (T, B, 2, 4) that right-bottom ... left-top of beam ends touch."""
    side, hand = (modes - 1) // 4, (modes - 1) % 2
    right, left = (side + hand) % 4, (side + 1 - hand) % 4
    return np.stack([right, left, right + 4, left + 4], axis=-1)


def adjacency(batch: Batch) -> Indices:
    """Return the adjacency matrices: (T, B, J), a mode of 1 to 16, or 0 for no connection."""
    trials, beams = batch.actuators.shape
    modes = np.zeros((trials, beams, batch.flat.shape[1]), np.int64)
    trial, beam = np.arange(trials)[:, None, None], np.arange(beams)[None, :, None]
    modes[trial, beam, batch.beams[None]] = end_modes(batch)
    return modes


def one_hot(modes: Indices) -> NDArray[np.float32]:
    """Return modes (...) as vectors (..., 16); no connection is all zeros."""
    return (modes[..., None] == np.arange(1, MODES + 1)).astype(np.float32)


def _held(batch: Batch) -> Array:
    """Return the centre of the fixed joint: (T, F, 3) mm."""
    return batch.joints[:, :, batch.fixed].mean(axis=2)
