"""Stress at the sampling points of beams, in the axes of their halves and in space.

A half has two of a beam's four sampling sections: near its face and near the middle. Stress is what
was printed in and is not released yet, plus what the network says.
"""

import jax.numpy as jnp
import numpy as np

from simulearn.grid.sampled import outer_is_active
from simulearn.mechanics.forces import FLIP, BeamState
from simulearn.mechanics.poses import Array
from simulearn.mechanics.properties import Properties
from simulearn.mechanics.topology import FlatGeometry, Topology

TENSOR = np.array([[0, 3, 4], [3, 1, 5], [4, 5, 2]])  # where a component lies in 11 22 33 12 13 23
VECTOR = (np.array([0, 1, 2, 0, 0, 1]), np.array([0, 1, 2, 1, 2, 2]))
SWAP = np.array([1, 0, 3, 2])  # right and left of a beam as its second half sees them


def printed(p: Properties, geometry: FlatGeometry, ratio: Array) -> Array:
    """Return the printed-in stress of each half: (2, B, [face, middle], 4, 6) MPa, in its axes."""
    idle = p.across * jnp.array([0.0, 1, 0, 0, 0, 0])
    busy = p.along * jnp.array([1.0, 0, 0, 0, 0, 0])
    active = jnp.stack(
        [outer_is_active(ratio, geometry.length), ratio != 0], -1
    )  # (B, [face, middle])
    top = jnp.array([False, False, True, True])
    here = active[..., None] & (top == (ratio > 0)[:, None, None])  # (B, 2, 4)
    return jnp.broadcast_to(jnp.where(here[..., None], busy, idle), (2, len(ratio), 2, 4, 6))


def _axes(topology: Topology, geometry: FlatGeometry, state: BeamState) -> Array:
    """Return the axes of each half at its face and middle: (2, B, 2, 3, 3)."""
    face = state.joints.R[topology.ends] @ geometry.frame
    return jnp.stack([face, state.middles.R @ FLIP[:, None]], 2)


def in_space(topology: Topology, geometry: FlatGeometry, state: BeamState, own: Array) -> Array:
    """Return stresses (2, B, 2, 4, 6) of halves as a Result has them: (B, 4, 4, 6), global axes."""
    turn = _axes(topology, geometry, state)
    tensor = jnp.einsum("hbsij,hbscjk,hbslk->hbscil", turn, own[..., TENSOR], turn)
    out = tensor[..., VECTOR[0], VECTOR[1]]
    second = out[1][:, :, SWAP]
    return jnp.stack([out[0][:, 0], out[0][:, 1], second[:, 1], second[:, 0]], 1)


def in_halves(topology: Topology, geometry: FlatGeometry, state: BeamState, stress: Array) -> Array:
    """Return stresses (B, 4, 4, 6) of a Result as the halves see them: (2, B, 2, 4, 6)."""
    second = stress[:, :, SWAP]
    own = jnp.stack([stress[:, :2], jnp.stack([second[:, 3], second[:, 2]], 1)])
    turn = _axes(topology, geometry, state)
    tensor = jnp.einsum("hbsji,hbscjk,hbskl->hbscil", turn, own[..., TENSOR], turn)
    return tensor[..., VECTOR[0], VECTOR[1]]
