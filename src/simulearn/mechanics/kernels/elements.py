"""Half-beams at one released fraction and one multiple of gravity, as `mechanics.section` has them.

The rest of the fitted section is plane: it bends about y and stretches along x; each part lies on
an arc. So its compliance
is that of the plane (x, z, about y) and that across it (y, about x, about z), 3 x 3 each.

Beams may differ in what they are printed of: each has a row of coefficients, joints have the last.
"""

from math import cos, exp, sin, sqrt
from typing import Any

import numpy as np

from simulearn.mechanics.kernels.halves import AT_REST, HALF_BEAM, KAA, KAB, KBB, REST
from simulearn.mechanics.kernels.lanes import LANES
from simulearn.mechanics.kernels.rotations import exponential, matrix_product
from simulearn.native import native

Array = Any
NEAR, BEYOND = 0.5 - 0.5 / sqrt(3.0), 0.5 + 0.5 / sqrt(3.0)  # Gauss points
# Where the section's coefficients lie in one array; each is that of s, then that of s2.
ACTIVE, PASSIVE, CURVATURE, SHORT, TILT = np.array([0, 2, 4, 6, 7])
PLANE, THICKNESS, ACROSS, UP, STIFFNESS, STIFFENED = np.array([9, 11, 13, 15, 17, 35])
OWN_PASSIVE, OWN_ACTIVE, LEAN = np.array([47, 49, 51])


@native(entry=False)
def quadratic(section: Array, k: int, s: float) -> float:
    """Return a quadratic without constant at s."""
    return section[k] * s + section[k + 1] * s * s


@native(entry=False)
def arc(length: float, angle: float) -> Any:
    """Return cosine, sine, x and z of the pose at the end of an arc that turns about y."""
    first, second, _ = exponential(angle * angle)
    return cos(angle), sin(angle), first * length, -second * angle * length


@native(entry=False)
def set_half_beams(
    half_beams: Array, rest: Array, section: Array, ends: Array, fixed: int, length: Array,
    ratio: Array, face: Array, frame: Array, reach: Array, s: float, corrections: Array,
    corrected: bool,
) -> None:  # fmt: skip
    """Set the elements of all half-beams.

    Args:
        half_beams: (chunks, 2, HALF_BEAM, WIDE) to set.
        rest: (2, B, 12) to set: rotation and position of the middle in the axes of the face.
        section: (B + 1, coefficients) of the beams, and of joints.
        ends: (2, B) joint of each half.
        fixed: the fixed joint.
        length: (B,) between the faces, mm.
        ratio: (B,) signed actuator ratios.
        face: (2, B, 3) from the joint's centre to the face of the flat grid, mm.
        frame: (2, B, 9) axes of the half in the joint's.
        reach: (2, B) from where the axes meet to the face, mm.
        s: released fraction.
        corrections: (2, B, 12) twist of the rest, logarithm of factors on the stiffness.
        corrected: whether they count.
    """
    beams = len(length)
    soft = np.empty((2, 6))
    joint = section[beams]
    tilt, plane = quadratic(joint, TILT, s), 1 + quadratic(joint, PLANE, s)
    lean = quadratic(joint, LEAN, s)
    own, turned = np.empty(9), np.empty(9)
    stiff = np.zeros((6, 6))
    factor = np.ones(6)
    for beam in range(beams):
        size, printed = abs(ratio[beam]), section[beam]
        for k in range(6):
            value = printed[STIFFNESS + k]
            value += s * (printed[STIFFNESS + 6 + k] + s * printed[STIFFNESS + 12 + k])
            more = printed[STIFFENED + k] + s * printed[STIFFENED + 6 + k]
            soft[0, k], soft[1, k] = exp(-value), exp(-value - more)
        passive, active = (1 - size) / 2 * length[beam], size / 2 * length[beam]
        bend = quadratic(printed, CURVATURE, s) + printed[SHORT] * s * (1 - size)
        if ratio[beam] < 0:
            bend = -bend
        angle = -(bend + quadratic(printed, OWN_ACTIVE, s)) * active
        before = -quadratic(printed, OWN_PASSIVE, s) * passive
        first = passive * (1 + quadratic(printed, PASSIVE, s))
        second = active * (1 + quadratic(printed, ACTIVE, s))
        c, n, x, z = arc(second, angle)
        c1, n1, x1, z1 = arc(first, before)
        # Compliance at the middle, of the plane (x, z, about y) and across it (y, about x and z).
        a00 = a01 = a02 = a11 = a12 = a22 = 0.0
        b00 = b01 = b02 = b11 = b12 = b22 = 0.0
        for part in range(2):
            weight = (passive if part == 0 else active) / 2
            for point in range(2):
                back = 1 - (NEAR if point == 0 else BEYOND)
                if part == 0:  # the rest of the passive arc, then the active one
                    h, g, px, pz = arc(first * back, before * back)
                    px, pz = px + h * x + g * z, pz - g * x + h * z
                    e, f = h * c - g * n, g * c + h * n
                else:
                    e, f, px, pz = arc(second * back, angle * back)
                # The inverse of the pose onward: its rotation's transpose, its place -R^T p.
                qx, qz = -(e * px - f * pz), -(f * px + e * pz)
                k = soft[part]
                cx, cz, cy = weight * k[0], weight * k[2], weight * k[4]
                # x' = e x - f z - qz y; z' = f x + e z + qx y
                a00 += e * e * cx + f * f * cz + qz * qz * cy
                a01 += e * f * (cx - cz) - qz * qx * cy
                a11 += f * f * cx + e * e * cz + qx * qx * cy
                a02 -= qz * cy
                a12 += qx * cy
                a22 += cy
                cx, cz, cy = weight * k[3], weight * k[5], weight * k[1]
                # wx' = e wx - f wz; wz' = f wx + e wz; y' = y + qz wx' - qx wz'
                tx, tz = qz * e - qx * f, -qz * f - qx * e
                b00 += cy + tx * tx * cx + tz * tz * cz
                b01 += tx * e * cx - tz * f * cz
                b02 += tx * f * cx + tz * e * cz
                b11 += e * e * cx + f * f * cz
                b12 += e * f * (cx - cz)
                b22 += f * f * cx + e * e * cz
        for group in range(2):
            if group == 0:
                p, q, r, t, u, w = a00, a01, a02, a11, a12, a22
            else:
                p, q, r, t, u, w = b00, b01, b02, b11, b12, b22
            d0, d1, d2 = t * w - u * u, r * u - q * w, q * u - r * t
            over = 1.0 / (p * d0 + q * d1 + r * d2)
            i, j, m = (0, 2, 4) if group == 0 else (1, 3, 5)
            stiff[i, i], stiff[i, j], stiff[i, m] = d0 * over, d1 * over, d2 * over
            stiff[j, i], stiff[m, i] = d1 * over, d2 * over
            stiff[j, j], stiff[m, m] = (p * w - r * r) * over, (p * t - q * q) * over
            stiff[j, m] = stiff[m, j] = (q * r - p * u) * over
        for end in range(2):
            turn = (tilt if ends[end, beam] == fixed else 0.0) - lean * reach[end, beam]
            h, g = cos(turn), sin(turn)
            # the turn of the face, the passive arc, the active one
            px, pz = x1 + c1 * x + n1 * z, z1 - n1 * x + c1 * z
            px, pz = h * px + g * pz, -g * px + h * pz
            e, f = c1 * c - n1 * n, n1 * c + c1 * n
            e, f = h * e - g * f, g * e + h * f
            own[0], own[1], own[2] = e, 0.0, f
            own[3], own[4], own[5] = 0.0, 1.0, 0.0
            own[6], own[7], own[8] = -f, 0.0, e
            py = 0.0
            if corrected:
                v = corrections[end, beam]
                a, b, d = v[3], v[4], v[5]
                one, two, three = exponential(a * a + b * b + d * d)
                y0, y1, y2 = b * v[2] - d * v[1], d * v[0] - a * v[2], a * v[1] - b * v[0]
                m0 = v[0] + two * y0 + three * (b * y2 - d * y1)
                m1 = v[1] + two * y1 + three * (d * y0 - a * y2)
                m2 = v[2] + two * y2 + three * (a * y1 - b * y0)
                px, py, pz = px + e * m0 + f * m2, m1, pz - f * m0 + e * m2
                turned[0] = 1 - two * (b * b + d * d)
                turned[4] = 1 - two * (a * a + d * d)
                turned[8] = 1 - two * (a * a + b * b)
                turned[1], turned[3] = two * a * b - one * d, two * a * b + one * d
                turned[2], turned[6] = two * a * d + one * b, two * a * d - one * b
                turned[5], turned[7] = two * b * d - one * a, two * b * d + one * a
                pose = rest[end, beam]
                matrix_product(own, turned, pose[:9])
                for k in range(9):
                    own[k] = pose[k]
                for k in range(6):
                    factor[k] = exp(v[6 + k] / 2)
            pose = rest[end, beam]
            for k in range(9):
                pose[k] = own[k]
            pose[9], pose[10], pose[11] = px, py, pz
            axes, row, lane = frame[end, beam], half_beams[beam // LANES, end], beam % LANES
            matrix_product(axes, own, turned)
            for k in range(9):
                row[REST, LANES * k + lane] = turned[k]
            for k in range(3):
                place = axes[3 * k] * px + axes[3 * k + 1] * py + axes[3 * k + 2] * pz
                row[AT_REST, LANES * k + lane] = plane * face[end, beam, k] + place
                for m in range(3):
                    at, over = LANES * (3 * k + m) + lane, 3 + m
                    row[KAA, at] = stiff[k, m] * factor[k] * factor[m]
                    row[KAB, at] = stiff[k, over] * factor[k] * factor[over]
                    row[KBB, at] = stiff[3 + k, over] * factor[3 + k] * factor[over]
    for beam in range(beams, LANES * len(half_beams)):  # lanes without a beam repeat the last
        for end in range(2):
            for k in range(HALF_BEAM):
                for m in range(9):
                    half_beams[beam // LANES, end, k, LANES * m + beam % LANES] = half_beams[
                        (beams - 1) // LANES, end, k, LANES * m + (beams - 1) % LANES
                    ]
