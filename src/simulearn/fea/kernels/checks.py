"""What only verification calls: the response of points and bricks one by one."""

import numpy as np

from simulearn.fea.kernels.brick import NODES, PAIRS, gather, tangent, workspace
from simulearn.fea.kernels.law import FUSED, respond
from simulearn.native import native


@native(fastmath=FUSED)
def respond_at(law, F):
    """Return first and second Piola-Kirchhoff stress (M, 3, 3) and moduli (M, 3, 3, 3, 3).

    The moduli dP[k, i] / dF[l, j] stand as [k, l, i, j]; see `law.respond`.
    """
    P, S = np.empty_like(F), np.empty_like(F)
    A = np.empty((len(F), 3, 3, 3, 3))
    for m in range(len(F)):
        respond(law, F[m], P[m], S[m], A[m], True)
    return P, S, A


@native(fastmath=FUSED)
def stiffness_of(law, bricks, u, s, carried, mixed):
    """Return tangent stiffness (E, 20, 120) and forces (E, 3, 20) of all bricks, for verification.

    The entries of a brick are [a, 20 p + b] for nodes a, b and pair p of displacement components.
    """
    many = len(bricks.nodes)
    stiffness = np.empty((many, NODES, PAIRS * NODES))
    forces = np.empty((many, 3, NODES))
    here = np.empty((NODES, 3))
    work = workspace()
    for e in range(many):
        gather(u, bricks.nodes, e, here)
        tangent(law, bricks, e, here, s, carried, mixed, stiffness[e], forces[e], work)
    return stiffness, forces
