"""What Python calls: factor, solve, forces, and the stress that is carried on."""

import math

import numpy as np

from simulearn.fea.kernels.brick import (
    COLUMN,
    NODES,
    PAIRS,
    ROW,
    add_forces,
    deform,
    elastic,
    gather,
    tangent,
    workspace,
)
from simulearn.fea.kernels.front import (
    add_brick,
    add_child,
    back_substitute,
    eliminate,
    forward_substitute,
    scale,
)
from simulearn.fea.kernels.law import FUSED, inverse_transpose, respond
from simulearn.native import native


@native(fastmath=FUSED)
def factor(law, bricks, fronts, u, s, carried, mixed, load, drag, factors, pivots):
    """Factor the tangent stiffness at a state and return the step towards equilibrium.

    Args:
        law: `ConstitutiveLaw`.
        bricks: `Bricks`.
        fronts: `Fronts`.
        u: (N, 3) displacements, mm.
        s: released fraction.
        carried: (M, 6) stress of the geometric stiffness, MPa.
        mixed: whether to use it; otherwise it is plain Newton.
        load: (N, 3) forces on the nodes, N.
        drag: (N,) added to the diagonal of the stiffness, N/mm.
        factors: written, for `solve`.
        pivots: written, for `solve`.

    Returns:
        the step (N, 3) mm, and the number of negative pivots.
    """
    stiffness = np.empty((NODES, PAIRS * NODES))
    forces = np.empty((3, NODES))
    here = np.empty((NODES, 3))
    work = workspace()
    front = np.empty(fronts.space[0])
    waiting = np.empty(fronts.space[1])
    place = np.full(len(u), -1)
    sizes = len(fronts.own)
    stack = np.empty(sizes + 1, dtype=np.int64)  # fronts that wait
    depth, top, negative = 0, 0, 0
    for f in range(sizes):
        first, count = fronts.start[f], fronts.start[f + 1] - fronts.start[f]
        own, rows = 3 * fronts.own[f], 3 * count
        ld = rows + 1
        front[: rows * ld] = 0.0
        for a in range(count):
            place[fronts.nodes[first + a]] = a
        for a in range(fronts.own[f]):
            node = fronts.nodes[first + a]
            for k in range(3):
                row = (3 * a + k) * ld
                front[row + rows] = load[node, k]
                front[row + 3 * a + k] = drag[node]
        for b in range(fronts.first_brick[f], fronts.first_brick[f + 1]):
            e = fronts.bricks[b]
            gather(u, bricks.nodes, e, here)
            tangent(law, bricks, e, here, s, carried, mixed, stiffness, forces, work)
            add_brick(front, ld, place, bricks.nodes, e, stiffness, forces)
        for _ in range(fronts.children[f]):
            depth -= 1
            child = stack[depth]
            begin = fronts.start[child] + fronts.own[child]
            many = fronts.start[child + 1] - begin
            top -= 3 * many * (3 * many + 1)
            add_child(front, ld, place, fronts.nodes, begin, many, waiting, top)
        negative += eliminate(
            front, rows, own, factors, fronts.factors[f], pivots, fronts.pivots[f]
        )
        for r in range(own, rows):
            row, wide = r * ld, rows - own + 1
            scale(front, row + r, 1.0, waiting, top + (r - own) * (wide + 1), ld - r)
        top += (rows - own) * (rows - own + 1)
        stack[depth] = f
        depth += 1
        for a in range(count):
            place[fronts.nodes[first + a]] = -1
    step = np.zeros_like(u)
    back_substitute(fronts, factors, step, np.empty(3 * len(u)))
    return step, negative


@native(fastmath=FUSED)
def solve(fronts, factors, pivots, load):
    """Return the displacements (N, 3) under a load (N, 3), with the factors at hand."""
    local = np.empty(3 * len(load))
    forward_substitute(fronts, factors, pivots, load.copy(), local)
    x = np.zeros_like(load)
    back_substitute(fronts, factors, x, local)
    return x


@native(fastmath=FUSED)
def internal(law, bricks, u, s):
    """Return forces and stresses of the bricks at displacements u (N, 3) mm.

    Returns:
        internal forces (N, 3) N; second Piola-Kirchhoff stress (M, 6) MPa; elastic deformation
        gradient and first Piola-Kirchhoff stress (M, 3, 3); the root of the sum of the squares of
        all bricks' nodal forces, N.
    """
    size = 0.0
    many, points = bricks.volumes.shape
    total = np.zeros_like(u)
    stress = np.empty((many * points, 6))
    gradient = np.empty((many * points, 3, 3))
    first = np.empty((many * points, 3, 3))
    forces, here, grown = np.empty((3, NODES)), np.empty((NODES, 3)), np.empty((3, NODES))
    S, A = np.empty((3, 3)), np.empty((3, 3, 3, 3))
    for e in range(many):
        gather(u, bricks.nodes, e, here)
        forces[:] = 0.0
        for q in range(points):
            m = e * points + q
            volume = elastic(bricks, e, q, s, here, grown, gradient[m])
            respond(law, gradient[m], first[m], S, A, False)
            add_forces(first[m], volume, grown, forces)
            for c in range(6):
                stress[m, c] = S[ROW[c], COLUMN[c]]
        for n in range(NODES):
            for k in range(3):
                total[bricks.nodes[e, n], k] += forces[k, n]
                size += forces[k, n] * forces[k, n]
    return total, stress, gradient, first, math.sqrt(size)


@native(fastmath=FUSED)
def carry(law, bricks, u, step, s):
    """Return the stress S + dS/dE : (F^T dF) (M, 6) that the next iteration carries, MPa.

    Args:
        law: `ConstitutiveLaw`.
        bricks: `Bricks`.
        u: (N, 3) displacements before the step, mm.
        step: (N, 3) change of the displacements, mm.
        s: released fraction.
    """
    many, points = bricks.volumes.shape
    carried = np.empty((many * points, 6))
    here, there, grown = np.empty((NODES, 3)), np.empty((NODES, 3)), np.empty((3, NODES))
    F, D, P, S = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    A, change, H = np.empty((3, 3, 3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for e in range(many):
        gather(u, bricks.nodes, e, here)
        gather(step, bricks.nodes, e, there)
        for q in range(points):
            elastic(bricks, e, q, s, here, grown, F)
            deform(there, grown, D)
            respond(law, F, P, S, A, True)
            inverse_transpose(F, H)
            # dP = A : dF, and dS = F^-1 (dP - dF S).
            for k in range(3):
                for i in range(3):
                    total = 0.0
                    for l in range(3):  # noqa: E741
                        for j in range(3):
                            total += A[k, l, i, j] * D[l, j]
                    change[k, i] = total - (
                        D[k, 0] * S[0, i] + D[k, 1] * S[1, i] + D[k, 2] * S[2, i]
                    )
            for c in range(6):
                i, j = ROW[c], COLUMN[c]
                one = H[0, i] * change[0, j] + H[1, i] * change[1, j] + H[2, i] * change[2, j]
                two = H[0, j] * change[0, i] + H[1, j] * change[1, i] + H[2, j] * change[2, i]
                carried[e * points + q, c] = S[i, j] + (one + two) / 2
    return carried
