"""Grids of every kind, and results without an engine: any valid grid bent along a formula."""

from itertools import pairwise

import numpy as np

from simulearn.fea.mesh import mesh
from simulearn.grid import Grid, library, make, outline, validate
from simulearn.grid.designs import Rules, draw_valid
from simulearn.grid.lattice import drop_beams
from simulearn.material import load_material
from simulearn.schedule import FRAMES
from simulearn.simulate import Result

MATERIAL = load_material("pla-hot-water")
SHARES = [*np.linspace(0, 1, FRAMES - 1), 1.05]


def bowed(p, s):
    """Move points (N, 3) of the flat grid along a curve that bends and twists them smoothly."""
    x, y, z = p.T
    w = 12 * s * np.sin(x / 45) * np.cos(y / 60) + 2e-3 * s * x * y
    moved = np.stack([x - 2e-4 * s * w * x, y + 0.02 * s * w, w], axis=-1)
    slope = np.stack([-s * np.cos(x / 45) / 4, s * np.sin(y / 60) / 5, np.ones_like(x)], axis=-1)
    return moved + z[:, None] * slope / np.linalg.norm(slope, axis=1, keepdims=True)


def result(grid, solid=False, bend=bowed):
    """Return a result of a grid whose last frames are `bend` of it; if wanted, with a solid."""
    grid = grid.centred
    flat = outline(grid, MATERIAL.section)
    up = MATERIAL.section.thickness / 2
    axis = (flat.beams[:, :1] + flat.beams[:, 1:]) / 2
    ends = np.concatenate([flat.beams[:, :1], axis, flat.beams[:, 1:]], axis=1)
    joints = np.concatenate([_lifted(flat.joints, -up), _lifted(flat.joints, up)], axis=1)
    beams = np.concatenate([_lifted(ends, -up), _lifted(ends, up)], axis=2)

    def move(p):
        return np.array([bend(p.reshape(-1, 3), s).reshape(p.shape) for s in SHARES])

    more = {}
    if solid:
        bricks = mesh(grid, MATERIAL)
        more = {"solid": bricks, "displacements": move(bricks.nodes) - bricks.nodes}
        joints, beams = bricks.nodes[bricks.joints], bricks.nodes[bricks.beams]
    return Result(
        grid=grid,
        engine="none",
        joints=move(joints),
        beams=move(beams),
        stress=None,
        seconds=0.0,
        material=MATERIAL.identity,
        **more,
    )


def kinds():
    """Return grids by name: of the library, honeycombs, rings, triangles, and random ones."""
    grids = {name: make(name) for name in library()}
    grids |= {"honeycomb": _honeycomb(), "hexagon": _ring(6, 60.0), "triangle": _ring(3, 90.0)}
    grids |= {"strip of triangles": _triangles(), "star": _star()}
    for k in range(18):
        grids[f"random {k}"] = draw_valid(Rules(), 7, k)[0]
    for k in range(18):
        rules = Rules(cells=(2 + k % 3, 3), jitter=20.0, removed=(1, 3), ratios=(0.3, 0.97, 1.0))
        grids[f"with gaps {k}"] = draw_valid(rules, 8, k)[0]
    for name, grid in grids.items():
        assert validate(grid, MATERIAL).valid, (name, validate(grid, MATERIAL).errors)
    return grids


def _lifted(flat, z):
    return np.concatenate([flat, np.full((*flat.shape[:-1], 1), z)], axis=-1)


def _ratios(count):
    return [(-1.0, -0.62, 0.0, 0.4, 0.999, 1.0)[k % 6] for k in range(count)]


def _ring(sides, radius):
    angle = 2 * np.pi * np.arange(sides) / sides + 0.3
    joints = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    beams = [[k, (k + 1) % sides] for k in range(sides)]
    return Grid(joints, beams, _ratios(sides), 0)


def _star():
    ring = _ring(6, 70.0)
    # Every other joint of the ring is tied to the middle: three beams meet there.
    beams = [*ring.beams.tolist(), [0, 6], [6, 2], [4, 6]]
    return Grid([*ring.joints.tolist(), [0, 0]], beams, _ratios(9), 6)


def _triangles():
    joints = [[40 * k, 70 * (k % 2)] for k in range(6)]
    beams = [[k, k + 1] for k in range(5)] + [[k, k + 2] for k in range(4)]
    return Grid(joints, beams, _ratios(9), 2)


def _honeycomb(side=45.0):
    places, beams = [], []

    def number(p):
        for k, q in enumerate(places):
            if np.hypot(*(p - q)) < 1e-6:
                return k
        places.append(p)
        return len(places) - 1

    for i, j in np.ndindex(2, 2):
        middle = side * np.array([np.sqrt(3) * (i + j / 2), 1.5 * j])
        angle = np.pi / 6 + np.pi / 3 * np.arange(7)
        corners = middle + side * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        numbers = [number(p) for p in corners]
        for a, b in pairwise(numbers):
            if [b, a] not in beams and [a, b] not in beams:
                beams.append([a, b])
    return drop_beams(Grid(places, beams, _ratios(len(beams)), 3), [])
