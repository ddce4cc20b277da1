"""Stress and moduli of a material point in closed form, for the three constitutive laws.

Marlow and neo-Hookean law are W = w(I1) + K/2 (J - 1)^2 with I1 = J^(-2/3) tr(F^T F): stress and
moduli need only the first two derivatives of w. The St Venant-Kirchhoff law is linear between
Green-Lagrange strain and second Piola-Kirchhoff stress.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from simulearn.native import native

MARLOW, NEO_HOOKEAN, ST_VENANT_KIRCHHOFF = 0, 1, 2

# I1 - 3 is quadratic in the strain: below this (a strain of 6e-5) the Marlow law is linear.
SMALL = 1e-8

# Products and sums may be fused; NaN and infinity keep their meaning.
FUSED = {"contract"}


class ConstitutiveLaw(NamedTuple):
    """A constitutive law in numbers.

    Attributes:
        kind: MARLOW, NEO_HOOKEAN or ST_VENANT_KIRCHHOFF.
        first: bulk modulus K, or for St Venant-Kirchhoff Lame's first constant, MPa.
        shear: shear modulus, MPa; not used by Marlow.
        breaks: (n,) places x = sqrt(I1 - 3) of Marlow's table, beginning with 0.
        pieces: (5, n) coefficients of w between breaks, highest power of (x - break) first.
    """

    kind: int
    first: float
    shear: float
    breaks: NDArray[np.float64]
    pieces: NDArray[np.float64]


@native(entry=False, fastmath=FUSED)
def slopes(law, I1):
    """Return dw/dI1 and d2w/dI1^2 at the isochoric first invariant."""
    if law.kind != MARLOW:
        return law.shear / 2, 0.0
    x = math.sqrt(max(I1 - 3, 0.0) + SMALL)
    low, high = 0, len(law.breaks)
    while high - low > 1:
        middle = (low + high) // 2
        if law.breaks[middle] <= x:
            low = middle
        else:
            high = middle
    t = x - law.breaks[low]
    a, b, c, d = law.pieces[0, low], law.pieces[1, low], law.pieces[2, low], law.pieces[3, low]
    f1 = ((4 * a * t + 3 * b) * t + 2 * c) * t + d
    f2 = (12 * a * t + 6 * b) * t + 2 * c
    return f1 / (2 * x), (f2 - f1 / x) / (4 * x * x)


@native(entry=False, fastmath=FUSED)
def inverse_transpose(F, H):
    """Write F^-T into H (3, 3) and return det F."""
    for k in range(3):
        a, b = (k + 1) % 3, (k + 2) % 3
        for i in range(3):
            p, q = (i + 1) % 3, (i + 2) % 3
            H[k, i] = F[a, p] * F[b, q] - F[a, q] * F[b, p]
    J = F[0, 0] * H[0, 0] + F[0, 1] * H[0, 1] + F[0, 2] * H[0, 2]
    for k in range(3):
        for i in range(3):
            H[k, i] /= J
    return J


@native(entry=False, fastmath=FUSED)
def respond(law, F, P, S, A, moduli):
    """Write the stresses at a material point, and its moduli.

    Args:
        law: `ConstitutiveLaw`.
        F: (3, 3) elastic deformation gradient.
        P: (3, 3) first Piola-Kirchhoff stress dW/dF, written.
        S: (3, 3) second Piola-Kirchhoff stress F^-1 P, written.
        A: (3, 3, 3, 3) moduli dP[k, i] / dF[l, j] as [k, l, i, j], written.
        moduli: whether A is wanted.

    Returns:
        det F.
    """
    H = S  # until the end
    J = inverse_transpose(F, H)
    if law.kind == ST_VENANT_KIRCHHOFF:
        trace = 0.0
        for k in range(3):
            for i in range(3):
                trace += F[k, i] * F[k, i]
        trace = (trace - 3) / 2
        for i in range(3):
            for j in range(3):
                E = F[0, i] * F[0, j] + F[1, i] * F[1, j] + F[2, i] * F[2, j]
                S[i, j] = law.shear * E
            S[i, i] += law.first * trace - law.shear
        for k in range(3):
            for i in range(3):
                P[k, i] = F[k, 0] * S[0, i] + F[k, 1] * S[1, i] + F[k, 2] * S[2, i]
        if moduli:
            for k in range(3):
                for l in range(3):  # noqa: E741
                    FF = F[k, 0] * F[l, 0] + F[k, 1] * F[l, 1] + F[k, 2] * F[l, 2]
                    for i in range(3):
                        for j in range(3):
                            A[k, l, i, j] = (
                                law.first * F[k, i] * F[l, j] + law.shear * F[k, j] * F[l, i]
                            )
                        A[k, l, i, i] += law.shear * FF
                        if k == l:
                            for j in range(3):
                                A[k, l, i, j] += S[i, j]
        return J

    c = 2 * J ** (-2 / 3)
    trace = 0.0
    for k in range(3):
        for i in range(3):
            trace += F[k, i] * F[k, i]
    w1, w2 = slopes(law, c / 2 * trace)
    K = law.first
    third = trace / 3
    volume = K * (J - 1) * J
    for k in range(3):
        for i in range(3):
            P[k, i] = w1 * c * (F[k, i] - third * H[k, i]) + volume * H[k, i]
    if moduli:
        # dI1/dF = G = c (F - trace/3 H), dJ/dF = J H, dH[k, i]/dF[l, j] = -H[k, j] H[l, i]:
        # A = w2 G G + w1 c (1 - 2/3 (F H + H F)) + ... H H, gathered by products of F and H.
        ff = w2 * c * c
        fh = -ff * third - w1 * c * 2 / 3
        hh = ff * third * third + w1 * c * trace * 2 / 9 + K * (2 * J - 1) * J
        swapped = w1 * c * third - volume
        for k in range(3):
            for l in range(3):  # noqa: E741
                for i in range(3):
                    left = ff * F[k, i] + fh * H[k, i]
                    right = fh * F[k, i] + hh * H[k, i]
                    for j in range(3):
                        A[k, l, i, j] = (
                            left * F[l, j] + right * H[l, j] + swapped * H[k, j] * H[l, i]
                        )
                    if k == l:
                        A[k, l, i, i] += w1 * c
    # S = F^-1 P, symmetric by the balance of moments; H is not needed any more.
    s00 = H[0, 0] * P[0, 0] + H[1, 0] * P[1, 0] + H[2, 0] * P[2, 0]
    s11 = H[0, 1] * P[0, 1] + H[1, 1] * P[1, 1] + H[2, 1] * P[2, 1]
    s22 = H[0, 2] * P[0, 2] + H[1, 2] * P[1, 2] + H[2, 2] * P[2, 2]
    s01 = H[0, 0] * P[0, 1] + H[1, 0] * P[1, 1] + H[2, 0] * P[2, 1]
    s02 = H[0, 0] * P[0, 2] + H[1, 0] * P[1, 2] + H[2, 0] * P[2, 2]
    s12 = H[0, 1] * P[0, 2] + H[1, 1] * P[1, 2] + H[2, 1] * P[2, 2]
    S[0, 0], S[1, 1], S[2, 2] = s00, s11, s22
    S[0, 1] = S[1, 0] = s01
    S[0, 2] = S[2, 0] = s02
    S[1, 2] = S[2, 1] = s12
    return J
