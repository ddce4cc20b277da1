"""The material points of a solid's bricks, as the kernels take them."""

import numpy as np
from numpy.typing import NDArray
from skfem import Basis, ElementHexS2, MeshHex

from simulearn.fea.kernels.brick import Bricks
from simulearn.fea.solid import Solid

Array = NDArray[np.float64]


def bricks_of(solid: Solid) -> tuple[Bricks, Array, Array]:
    """Return the bricks of a solid, and two shares (N,) of its volume for each node, mm3.

    The first is the integral of the node's shape function, for weights; it is negative at the
    corners of 20-node bricks. The second is a lumped mass, in proportion to the integral of the
    function's square (Hinton, Rock, Zienkiewicz 1976), and positive.
    """
    in_joint = solid.parts[:, 0] < 0
    many, points = len(solid.bricks), len(solid.weights)
    gradients = np.empty((many, points, 3, 20))
    volumes, shares = np.empty((many, points)), np.empty((2, many, 20))
    for chosen, rule in (
        (~in_joint, (solid.points, solid.weights)),
        (in_joint, (solid.joint_points, solid.joint_weights)),
    ):
        if chosen.any():
            basis = _basis(solid.nodes, solid.bricks[chosen], rule)
            gradients[chosen] = np.stack([n[0].grad for n in basis.basis]).transpose(2, 3, 1, 0)
            volumes[chosen] = basis.dx
            shape = np.stack([np.asarray(n[0]) for n in basis.basis], axis=1)
            shares[0, chosen] = np.einsum("enq,eq->en", shape, basis.dx)
            shares[1, chosen] = np.einsum("enq,enq,eq->en", shape, shape, basis.dx)
    shares[1] *= (volumes.sum(axis=1) / shares[1].sum(axis=1))[:, None]
    weight, mass = (
        np.bincount(solid.bricks.ravel(), x.ravel(), len(solid.nodes)).astype(np.float64)
        for x in shares
    )
    bricks = Bricks(
        nodes=np.array(solid.bricks, dtype=np.int64, order="C"),
        gradients=gradients,
        volumes=volumes,
        axis=np.stack([np.cos(solid.angle), np.sin(solid.angle)], axis=1),
        growth=np.array(solid.growth, dtype=np.float64, order="C"),
    )
    return bricks, weight, mass


def _basis(nodes: Array, bricks: NDArray[np.int64], rule: tuple[Array, Array]) -> Basis:
    """Return the shape functions of bricks at their integration points."""
    vertices, corners = np.unique(bricks[:, :8], return_inverse=True)
    mesh = MeshHex(
        np.ascontiguousarray(nodes[vertices].T), np.ascontiguousarray(corners.reshape(-1, 8).T)
    )
    return Basis(mesh, ElementHexS2(), quadrature=rule)
