"""Forces and tangent stiffness of one 20-node brick.

Total Lagrangian with growth: F_e = F F_g^-1, F_g = I + s diag(growth) in the printing frame. With
gradients taken in the grown state, dN_g = dN F_g^-1, that is F_e = F_g^-1 + u dN_g, and everything
else is standard: r = sum P dN_g w J_g, K = sum dN_g A dN_g w J_g.

Mixed integration point Newton (Magisano, Leonetti, Garcea 2017, doi:10.1002/nme.5348): the second
Piola-Kirchhoff stress S~ at the points is carried along as an own unknown. It replaces the stress
in the geometric stiffness only; the residual keeps the stress of the displacements, so that the
solution is the same and slender, turning beams need less than half of Newton's iterations.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulearn.fea.kernels.law import FUSED, respond
from simulearn.native import native

NODES = 20
PAIRS = 6  # of displacement components: 11 12 13 22 23 33
# Components of a symmetric tensor, 11 22 33 12 13 23.
ROW = (0, 1, 2, 0, 0, 1)
COLUMN = (0, 1, 2, 1, 2, 2)


class Bricks(NamedTuple):
    """The material points of E bricks with Q points each, M = E Q.

    Attributes:
        nodes: (E, 20) indices.
        gradients: (E, Q, 3, 20) of the shape functions in the flat grid, 1/mm.
        volumes: (E, Q) mm3.
        axis: (E, 2) cosine and sine of the printing frame's first axis from +x.
        growth: (E, Q, 3) released strains along the frame's axes at full release.
    """

    nodes: NDArray[np.int64]
    gradients: NDArray[np.float64]
    volumes: NDArray[np.float64]
    axis: NDArray[np.float64]
    growth: NDArray[np.float64]


@native(entry=False, fastmath=FUSED)
def grow(bricks, e, q, s, grown):
    """Write the gradients (3, 20) of a point in its grown state; return F_g^-1 and its volume.

    Returns:
        entries 11, 22, 12 and 33 of F_g^-1, and the grown volume.
    """
    c, d = bricks.axis[e, 0], bricks.axis[e, 1]
    x = 1 + s * bricks.growth[e, q, 0]
    y = 1 + s * bricks.growth[e, q, 1]
    z = 1 + s * bricks.growth[e, q, 2]
    xx, yy, xy = c * c / x + d * d / y, d * d / x + c * c / y, c * d * (1 / x - 1 / y)
    for n in range(NODES):
        a, b = bricks.gradients[e, q, 0, n], bricks.gradients[e, q, 1, n]
        grown[0, n] = xx * a + xy * b
        grown[1, n] = xy * a + yy * b
        grown[2, n] = bricks.gradients[e, q, 2, n] / z
    return xx, yy, xy, 1 / z, bricks.volumes[e, q] * x * y * z


@native(entry=False, fastmath=FUSED)
def deform(u, grown, F):
    """Write u dN_g (3, 3) of displacements u (20, 3)."""
    for i in range(3):
        a = b = c = 0.0
        for n in range(NODES):
            a += u[n, 0] * grown[i, n]
            b += u[n, 1] * grown[i, n]
            c += u[n, 2] * grown[i, n]
        F[0, i], F[1, i], F[2, i] = a, b, c


@native(entry=False, fastmath=FUSED)
def elastic(bricks, e, q, s, u, grown, F):
    """Write the elastic deformation gradient F_e (3, 3) at a point; return its grown volume."""
    xx, yy, xy, zz, volume = grow(bricks, e, q, s, grown)
    deform(u, grown, F)
    F[0, 0] += xx
    F[1, 1] += yy
    F[0, 1] += xy
    F[1, 0] += xy
    F[2, 2] += zz
    return volume


@native(entry=False, fastmath=FUSED)
def add_forces(P, volume, grown, forces):
    """Add the nodal forces of a point with stress P to `forces` (3, 20), N."""
    for k in range(3):
        a, b, c = volume * P[k, 0], volume * P[k, 1], volume * P[k, 2]
        for n in range(NODES):
            forces[k, n] += a * grown[0, n] + b * grown[1, n] + c * grown[2, n]


@native(entry=False, fastmath=FUSED)
def tangent(law, bricks, e, u, s, carried, mixed, stiffness, forces, work):
    """Write tangent stiffness and internal forces of a brick.

    Args:
        law: `ConstitutiveLaw`.
        bricks: `Bricks`.
        e: the brick.
        u: (20, 3) displacements of its nodes, mm.
        s: released fraction.
        carried: (M, 6) stress S~ of the geometric stiffness, MPa.
        mixed: whether to use it; otherwise it is plain Newton.
        stiffness: (20, 120) entries [a, 20 p + b] of nodes a, b and pair p, N/mm; written.
        forces: (3, 20) N; written.
        work: of `workspace`.
    """
    grown, right, F, P, S, A = work
    points = bricks.volumes.shape[1]
    stiffness[:] = 0.0
    forces[:] = 0.0
    for first in range(0, points, 2):
        many = min(2, points - first)
        if many == 1:
            right[3:] = 0.0
            grown[3:] = 0.0
        for half in range(many):
            q = first + half
            here = grown[3 * half : 3 * half + 3]
            volume = elastic(bricks, e, q, s, u, here, F)
            respond(law, F, P, S, A, True)
            if mixed:
                at = e * points + q
                for m in range(6):
                    i, j = ROW[m], COLUMN[m]
                    change = carried[at, m] - S[i, j]
                    for k in range(3):
                        A[k, k, i, j] += change
                        if i != j:
                            A[k, k, j, i] += change
            add_forces(P, volume, here, forces)
            pair = 0
            for k in range(3):
                for l in range(k, 3):  # noqa: E741
                    for i in range(3):
                        x = volume * A[k, l, i, 0]
                        y = volume * A[k, l, i, 1]
                        z = volume * A[k, l, i, 2]
                        for n in range(NODES):
                            right[3 * half + i, NODES * pair + n] = (
                                x * here[0, n] + y * here[1, n] + z * here[2, n]
                            )
                    pair += 1
        for a in range(NODES):
            g0, g1, g2 = grown[0, a], grown[1, a], grown[2, a]
            g3, g4, g5 = grown[3, a], grown[4, a], grown[5, a]
            for b in range(PAIRS * NODES):
                stiffness[a, b] += (
                    g0 * right[0, b]
                    + g1 * right[1, b]
                    + g2 * right[2, b]
                    + g3 * right[3, b]
                    + g4 * right[4, b]
                    + g5 * right[5, b]
                )


@native(entry=False)
def workspace():
    """Return arrays that `tangent` works in."""
    return (
        np.zeros((6, NODES)),
        np.zeros((6, PAIRS * NODES)),
        np.zeros((3, 3)),
        np.zeros((3, 3)),
        np.zeros((3, 3)),
        np.zeros((3, 3, 3, 3)),
    )


@native(entry=False)
def gather(u, nodes, e, here):
    """Write the displacements (20, 3) of a brick's nodes."""
    for n in range(NODES):
        for k in range(3):
            here[n, k] = u[nodes[e, n], k]
