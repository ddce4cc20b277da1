"""The closest point of triangles, by a tree of boxes, and how often they go around a point."""

from typing import Any

import numpy as np

from simulearn.native import native

Array = Any
FUSED = {"contract"}  # products and sums may be rounded once
NARROW = 1e-12  # of the squared area; a triangle has no inside that can be computed
STACK = 128  # nodes that wait; a tree of 2^60 triangles needs fewer


@native(fastmath=FUSED)
def closest_points(
    points: Array, corners: Array, order: Array, starts: Array, boxes: Array, depth: int
) -> Any:
    """Return the closest points (N, 3) of triangles to points (N, 3), and their faces (N,).

    Args:
        points: any; those that are not finite have no face, -1.
        corners: (T, 3, 3) of the triangles, in the order of the tree.
        order: (T,) the triangles' own numbers.
        starts: (leaves + 1,) the first triangle of each leaf, and T.
        boxes: (nodes, 2, 3) of the tree.
        depth: of the tree.
    """
    places = np.full((len(points), 3), np.nan)
    faces = np.full(len(points), -1, np.int64)
    inner = (1 << depth) - 1
    waiting, away = np.empty(STACK, np.int64), np.empty(STACK)
    for n in range(len(points)):
        x, y, z = points[n, 0], points[n, 1], points[n, 2]
        best = np.inf
        waiting[0], away[0] = 0, _to_box(boxes, 0, x, y, z)
        size = 1
        while size:
            size -= 1
            if not away[size] < best:
                continue
            node = waiting[size]
            while node < inner:  # down to the nearer child, the other one waits
                node = 2 * node + 1
                near, far = _to_box(boxes, node, x, y, z), _to_box(boxes, node + 1, x, y, z)
                other = node + 1
                if far < near:
                    near, far = far, near
                    node, other = other, node
                if far < best:
                    waiting[size], away[size] = other, far
                    size += 1
                if not near < best:
                    node = -1
                    break
            if node < 0:
                continue
            leaf = node - inner
            for i in range(starts[leaf], starts[leaf + 1]):
                square, u, v, w = _to_triangle(corners, i, x, y, z)
                if square < best:
                    best = square
                    faces[n] = order[i]
                    places[n, 0], places[n, 1], places[n, 2] = u, v, w
    return places, faces


@native(entry=False, fastmath=FUSED)
def _to_box(boxes: Array, node: int, x: float, y: float, z: float) -> float:
    """Return the squared distance of a point from a box."""
    u = max(boxes[node, 0, 0] - x, x - boxes[node, 1, 0], 0.0)
    v = max(boxes[node, 0, 1] - y, y - boxes[node, 1, 1], 0.0)
    w = max(boxes[node, 0, 2] - z, z - boxes[node, 1, 2], 0.0)
    return u * u + v * v + w * w


@native(entry=False, fastmath=FUSED)
def _to_triangle(corners: Array, i: int, x: float, y: float, z: float) -> Any:
    """Return the squared distance of a point from a triangle, and the closest point.

    That is the foot of the point if it lies within, else the closest one of three edges: so it is
    right for triangles without width, too.
    """
    ax, ay, az = corners[i, 0, 0], corners[i, 0, 1], corners[i, 0, 2]
    ux, uy, uz = corners[i, 1, 0] - ax, corners[i, 1, 1] - ay, corners[i, 1, 2] - az
    vx, vy, vz = corners[i, 2, 0] - ax, corners[i, 2, 1] - ay, corners[i, 2, 2] - az
    px, py, pz = x - ax, y - ay, z - az
    uu, vv = ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz
    uv = ux * vx + uy * vy + uz * vz
    pu, pv = px * ux + py * uy + pz * uz, px * vx + py * vy + pz * vz
    area = uu * vv - uv * uv
    s, t, within = 0.0, 0.0, False
    if area > NARROW * uu * vv:
        s, t = (vv * pu - uv * pv) / area, (uu * pv - uv * pu) / area
        within = s >= 0 and t >= 0 and s + t <= 1
    if within:
        qx, qy, qz = s * ux + t * vx, s * uy + t * vy, s * uz + t * vz
        square = (px - qx) ** 2 + (py - qy) ** 2 + (pz - qz) ** 2
        return square, ax + qx, ay + qy, az + qz
    share = min(max(pu / uu, 0.0), 1.0) if uu > 0 else 0.0
    qx, qy, qz = share * ux, share * uy, share * uz
    square = (px - qx) ** 2 + (py - qy) ** 2 + (pz - qz) ** 2
    share = min(max(pv / vv, 0.0), 1.0) if vv > 0 else 0.0
    ex, ey, ez = share * vx, share * vy, share * vz
    other = (px - ex) ** 2 + (py - ey) ** 2 + (pz - ez) ** 2
    if other < square:
        square, qx, qy, qz = other, ex, ey, ez
    wx, wy, wz = vx - ux, vy - uy, vz - uz
    ww = wx * wx + wy * wy + wz * wz
    along = (px - ux) * wx + (py - uy) * wy + (pz - uz) * wz
    share = min(max(along / ww, 0.0), 1.0) if ww > 0 else 0.0
    ex, ey, ez = ux + share * wx, uy + share * wy, uz + share * wz
    other = (px - ex) ** 2 + (py - ey) ** 2 + (pz - ez) ** 2
    if other < square:
        square, qx, qy, qz = other, ex, ey, ez
    return square, ax + qx, ay + qy, az + qz


@native()
def windings(points: Array, corners: Array, starts: Array, boxes: Array, depth: int) -> Any:
    """Return how often triangles go around points (N, 3): (N,), 0 outside of closed ones.

    It is counted what a ray upwards passes, from within and from outside. An edge counts for one of
    its two triangles by the same comparison of the same numbers, so that no ray slips through.
    The arguments are those of `closest_points`.
    """
    counts = np.zeros(len(points), np.int64)
    inner = (1 << depth) - 1
    waiting = np.empty(STACK, np.int64)
    for n in range(len(points)):
        x, y, z = points[n, 0], points[n, 1], points[n, 2]
        waiting[0] = 0
        size = 1
        while size:
            size -= 1
            node = waiting[size]
            low, high = boxes[node, 0], boxes[node, 1]
            if not (low[0] <= x <= high[0] and low[1] <= y <= high[1] and z <= high[2]):
                continue
            if node < inner:
                waiting[size], waiting[size + 1] = 2 * node + 1, 2 * node + 2
                size += 2
                continue
            leaf = node - inner
            for i in range(starts[leaf], starts[leaf + 1]):
                counts[n] += _passed(corners[i], x, y, z)
    return counts


@native(entry=False)
def _passed(corners: Array, x: float, y: float, z: float) -> int:
    """Return 1 if a ray upwards leaves through a triangle (3, 3), -1 if it enters, else 0."""
    right = 0
    for k in range(3):
        u, v = corners[k], corners[(k + 1) % 3]
        if (u[1] > y) != (v[1] > y):
            low, high = (u, v) if u[1] < v[1] else (v, u)
            side = (high[0] - low[0]) * (y - low[1]) - (x - low[0]) * (high[1] - low[1])
            right += side > 0
    if right != 1:
        return 0
    a, b, c = corners[0], corners[1], corners[2]
    ab0, ab1, ab2 = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    ac0, ac1, ac2 = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    n0, n1, n2 = ab1 * ac2 - ab2 * ac1, ab2 * ac0 - ab0 * ac2, ab0 * ac1 - ab1 * ac0
    if n2 == 0:
        return 0
    above = (n0 * (a[0] - x) + n1 * (a[1] - y)) / n2 + a[2] - z
    if above <= 0:
        return 0
    return 1 if n2 > 0 else -1
