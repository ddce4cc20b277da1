"""Results without an engine: square grids bent along formulas, for tests of what shows them."""

import dataclasses

import numpy as np
from skfem import ElementHexS2

from simulearn.fea.solid import Solid
from simulearn.grid import Grid
from simulearn.material import load_material
from simulearn.simulate.result import FRAMES, Result

HALF_WIDTH, HALF_THICKNESS = 3.6, 2.0
SLABS = 8


def square_grid(cells=(2, 2), length=65.0, actuators=None, fixed=None):
    """Beams in row order, at each joint the one along +x before the one along +y."""
    nx, ny = cells[0] + 1, cells[1] + 1
    joints = [[i * length, j * length] for j in range(ny) for i in range(nx)]
    beams = []
    for j in range(ny):
        for i in range(nx):
            k = j * nx + i
            beams += [[k, k + 1]] if i + 1 < nx else []
            beams += [[k, k + nx]] if j + 1 < ny else []
    if actuators is None:
        actuators = [0.25 if a + 1 == b else -1.0 for a, b in beams]  # the library's saddle
    fixed = (ny // 2) * nx + nx // 2 if fixed is None else fixed
    return Grid(joints, beams, actuators, fixed).centred


def saddle(p, s, height=2.2e-3):
    """Move points (N, 3) of the flat grid onto z = s height (x^2 - y^2), normals kept straight."""
    x, y, z = p.T
    mid = np.stack([x, y, s * height * (x**2 - y**2)], axis=-1)
    normal = np.stack([-2 * s * height * x, 2 * s * height * y, np.ones_like(x)], axis=-1)
    return mid + z[:, None] * normal / np.linalg.norm(normal, axis=1, keepdims=True)


def cylinder(p, s, curvature=0.017):
    """Roll points (N, 3) of the flat grid up around the y axis."""
    x, y, z = p.T
    k = max(s * curvature, 1e-12)
    radius = 1 / k - z
    return np.stack([radius * np.sin(k * x), y, 1 / k - radius * np.cos(k * x)], axis=-1)


def result(grid=None, bend=saddle, solid=True):
    """Return a Result whose last frames are `bend` of the flat grid."""
    grid = square_grid() if grid is None else grid
    joints, beams = _joints(grid), _beams(grid)
    shares = [*np.linspace(0, 1, FRAMES - 1), 1.05]

    def move(p):
        return np.array([bend(p.reshape(-1, 3), s).reshape(p.shape) for s in shares])

    mesh = _solid(grid, joints, beams) if solid else None
    rng = np.random.default_rng(0)
    return Result(
        grid=grid,
        engine="synthetic",
        joints=move(joints),
        beams=move(beams),
        stress=rng.normal(size=(FRAMES, len(beams), 4, 4, 6)),
        seconds=1.25,
        material=load_material("pla-hot-water").identity,
        record={"iterations": [0] + [3] * (FRAMES - 1)},
        solid=mesh,
        displacements=move(mesh.nodes) - mesh.nodes if mesh else None,
    )


def _joints(grid):
    square = HALF_WIDTH * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    flat = grid.joints[:, None] + square
    return np.stack([_lift(flat, -1), _lift(flat, 1)], axis=1).reshape(len(flat), 8, 3)


def _beams(grid):
    start, end = grid.joints[grid.beams[:, 0]], grid.joints[grid.beams[:, 1]]
    along = (end - start) / np.linalg.norm(end - start, axis=1, keepdims=True)
    left = HALF_WIDTH * np.stack([-along[:, 1], along[:, 0]], axis=-1)
    a, b = start + HALF_WIDTH * along, end - HALF_WIDTH * along
    axis = np.stack([a, (a + b) / 2, b], axis=1)  # (B, 3, 2)
    sides = np.stack([axis - left[:, None], axis + left[:, None]], axis=2)  # (B, 3, [right, left])
    return np.concatenate([_lift(sides, -1), _lift(sides, 1)], axis=2)


def _lift(flat, sign):
    return np.concatenate([flat, np.full((*flat.shape[:-1], 1), sign * HALF_THICKNESS)], axis=-1)


def _solid(grid, joints, beams):
    local = np.array(ElementHexS2.doflocs)
    bricks = []
    for corners in joints:
        bricks.append(_block(corners[[0, 1, 3, 2, 4, 5, 7, 6]], local))
    for sections in beams:
        for k in range(SLABS):
            a, b = ((1 - u) * sections[0] + u * sections[2] for u in (k / SLABS, (k + 1) / SLABS))
            bricks.append(_block(np.array([a[0], b[0], a[1], b[1], a[2], b[2], a[3], b[3]]), local))
    every = np.concatenate(bricks)
    _, first, index = np.unique(np.round(every, 6), axis=0, return_index=True, return_inverse=True)
    nodes = every[first]

    def number(p):
        return np.linalg.norm(nodes - p[..., None, :], axis=-1).argmin(axis=-1)

    known = {
        "nodes": nodes,
        "bricks": index.reshape(-1, 20),
        "parts": np.array(
            [(-1, j) for j in range(len(joints))]
            + [(b, k) for b in range(len(beams)) for k in range(SLABS)]
        ),
        "fixed": np.array([0]),
        "joints": number(joints),
        "beams": number(beams),
        "slabs": SLABS,
    }
    # What only a solver reads stays empty.
    empty = {f.name: np.zeros((len(bricks), 0)) for f in dataclasses.fields(Solid)}
    return Solid(**{**empty, **known})


def _block(c, local):
    """Trilinear places of local coordinates; corners c with x fastest, then y, then z."""
    x, y, z = local.T[..., None]
    bottom = (1 - y) * ((1 - x) * c[0] + x * c[1]) + y * ((1 - x) * c[2] + x * c[3])
    top = (1 - y) * ((1 - x) * c[4] + x * c[5]) + y * ((1 - x) * c[6] + x * c[7])
    return (1 - z) * bottom + z * top
