"""What is in a scan besides the grid: stray points, and the table that it lies on.

The table is a plane whose points cover clearly more than all beams of the grid could; a flat grid
is a plane, too, but covers its beams only. Planes are found through three points of many trials
(RANSAC: M. Fischler, R. Bolles, Comm. ACM 24, 381, 1981).
"""

import numpy as np
from scipy.spatial import KDTree

from simulearn.compare.measurement import Numbers, Scan
from simulearn.errors import Message
from simulearn.grid import Grid

NEIGHBOURS = 6
STRAY = 4.0  # times as far from them as usual
TRIES = 400
LOOKED_AT = 6000  # points
THICK = 0.8  # mm to either side
CELL = 4.0  # mm, by which covered area is counted
TIMES = 2.0  # the area of the beams, seen from above
MOST = 3  # planes


def without_strays(scan: Scan) -> tuple[Scan, list[Message]]:
    """Return a scan without points that lie far from all others, and how many those are."""
    away, _ = KDTree(scan.points).query(scan.points, k=NEIGHBOURS + 1)
    apart = away[:, -1] > STRAY * np.median(away[:, -1])
    if not apart.any():
        return scan, []
    text = f"{apart.sum()} points of the scan lie apart from all others and are left out"
    return scan.only(~apart), [Message("scan-strays", "measurement", text)]


def without_table(scan: Scan, grid: Grid, width: float) -> tuple[Scan, list[Message]]:
    """Return a scan without its table, and a message about what was left out.

    Args:
        scan: in mm.
        grid: the design.
        width: of its beams, mm.
    """
    ends = grid.joints[grid.beams]
    beams = float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=-1).sum()) * width
    rng = np.random.default_rng(0)
    messages = []
    for _ in range(MOST):
        if len(scan.points) < 100:
            break
        normal, offset = _plane(scan.points, rng)
        on = abs(scan.points @ normal - offset) < THICK
        area = _covered(scan.points[on], normal)
        if area < TIMES * beams:
            break
        text = (
            f"a plane of {area / 100:.0f} cm2 in the scan is taken as its table and left out "
            f"({on.mean():.0%} of the points; the beams of the grid cover {beams / 100:.0f} cm2)"
        )
        messages.append(Message("scan-table", "measurement", text))
        scan = scan.only(~on)
    return scan, messages


def _plane(points: Numbers, rng: np.random.Generator) -> tuple[Numbers, float]:
    """Return the plane (normal (3,), offset) that holds most points."""
    few = points[rng.choice(len(points), min(LOOKED_AT, len(points)), replace=False)]
    a, b, c = few[rng.integers(len(few), size=(3, TRIES))]
    normals = np.cross(b - a, c - a)
    length = np.linalg.norm(normals, axis=1)
    sound = length > 1e-9
    normals, a = normals[sound] / length[sound, None], a[sound]
    held = (abs(few @ normals.T - (a * normals).sum(axis=1)) < THICK).sum(axis=0)
    normal, through = normals[held.argmax()], a[held.argmax()]
    for _ in range(3):  # three of its points say less than all
        on = few[abs((few - through) @ normal) < THICK]
        through = on.mean(axis=0)
        normal = np.linalg.svd(on - through, full_matrices=False)[2][2]
    return normal, float(normal @ through)


def _covered(points: Numbers, normal: Numbers) -> float:
    """Return the area that points of a plane cover, mm2."""
    across = np.linalg.svd(normal[None])[2][1:]
    cells = np.floor(points @ across.T / CELL).astype(np.int64)
    counts = np.unique(cells, axis=0, return_counts=True)[1]
    # A cell with a stray point is not covered.
    return float((counts > 0.1 * np.median(counts)).sum()) * CELL**2
