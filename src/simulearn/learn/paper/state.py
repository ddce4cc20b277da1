"""What changes from frame to frame, and the features of it that the networks see.

The same features as `dataset.features`, in JAX and with elements first: centre and the vector to
the fixed joint are not carried along but follow from the corners, so they can never disagree.
"""

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import NDArray

from simulearn.learn.paper.graph import Graph


class GraphState(NamedTuple):
    """A frame of T grids of one topology.

    Attributes:
        joints: (J, T, 24) corners, mm.
        sections: (B, T, 36) corners, mm.
        stress: (B, T, 96) MPa; no components at all in stage 2.
    """

    joints: Array
    sections: Array
    stress: Array

    @property
    def plain(self) -> "GraphState":
        """The state without stress, as stage 2 has it."""
        return self._replace(stress=self.stress[..., :0])


def state_of(
    joints: NDArray[np.floating], sections: NDArray[np.floating], stress: NDArray[np.floating]
) -> GraphState:
    """Return the state of corners (T, J, 8, 3), (T, B, 3, 4, 3) and stresses (T, B, 4, 4, 6)."""

    def put(x: NDArray[np.floating]) -> Array:
        flat = x.reshape(*x.shape[:2], -1).swapaxes(0, 1)
        return jnp.asarray(np.ascontiguousarray(flat, np.float32))

    return GraphState(put(joints), put(sections), put(stress))


def centres(corners: Array) -> Array:
    """Return the centres (N, T, 3) of elements with corners (N, T, 3 c)."""
    return corners.reshape(*corners.shape[:2], -1, 3).mean(axis=2)


def features(state: GraphState, ratio: Array, topology: Graph) -> tuple[Array, Array]:
    """Return the features of joints (J, T, 31) and beams (B, T, 139 or 43).

    Args:
        state: the frame.
        ratio: (B, T, 1) actuators.
        topology: of the grids.
    """
    of_joints, of_beams = centres(state.joints), centres(state.sections)
    held = jnp.einsum("fj,jtx->ftx", topology.fixed, of_joints)
    flag = jnp.broadcast_to(topology.fixed.T[:, :, None], (*of_joints.shape[:2], 1))
    joints = [of_joints, state.joints, flag, held - of_joints]
    beams = [of_beams, state.sections, state.stress, ratio, held - of_beams]
    return jnp.concatenate(joints, axis=-1), jnp.concatenate(beams, axis=-1)
