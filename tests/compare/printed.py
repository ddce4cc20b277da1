"""Prints without an engine: a grid bent along formulas whose numbers are a material's."""

import dataclasses

import numpy as np
from scipy.spatial.transform import Rotation

import synthetic
from simulearn.material import Scatter, load_material
from simulearn.simulate import skin
from simulearn.simulate.members import Prints

BASE = load_material("pla-hot-water").model_copy(update={"scatter": Scatter()})
NAMES = ("strain", "passive", "joint", "shell", "curl", "weight", "creep")


def grid(cells=(2, 2), length=45.0):
    return synthetic.square_grid(cells, length)


def numbers(material):
    """Return what a material differs by from the base, one number for each parameter."""
    s, b = material.shrinkage, BASE.shrinkage
    return {
        "strain": s.active / b.active - 1,
        "passive": (s.stress_passive - b.stress_passive) / b.stress_active,
        "joint": (s.stress_joint - b.stress_joint) / b.stress_active,
        "shell": s.shell / s.active - b.shell / b.active,
        "curl": s.curl / b.active,
        "weight": material.gravity.density / BASE.gravity.density - 1,
        "creep": material.creep.amplitude - BASE.creep.amplitude,
    }


def bend(material=BASE):
    """Return the motion of points (N, 3) of the flat grid; no symmetry brings it onto itself."""
    d = numbers(material)
    k = 1.0 + d["strain"] + 0.5 * d["creep"]
    xx = 4.0e-3 * k - 4.0e-3 * d["passive"] + 8e-3 * d["curl"]
    yy = -3.0e-3 * k + 6.0e-3 * d["shell"] + 8e-3 * d["curl"] + 4e-4 * d["creep"]
    xy = 3.0e-3 * k + 3e-3 * d["weight"]
    xxx = 1.0e-4 * k + 5e-5 * d["joint"]

    def move(p, s):
        x, y, z = p.T
        f = s * (xx * x**2 + yy * y**2 + xy * x * y + xxx * x**3)
        fx = s * (2 * xx * x + xy * y + 3 * xxx * x**2)
        fy = s * (2 * yy * y + xy * x)
        normal = np.stack([-fx, -fy, np.ones_like(x)], axis=-1)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        return np.stack([x, y, f], axis=-1) + z[:, None] * normal

    return move


def shape(material=BASE, design=None):
    """Return the result of a grid of a material."""
    of = synthetic.result(design or grid(), bend(material), solid=False)
    return dataclasses.replace(of, engine="fea")


def last_frames(design, materials, factors, model=None):
    """Stand in for `simulearn.simulate.members.last_frames`."""
    found = [shape(material, design) for material in materials]
    joints, beams = (np.stack([getattr(r, k)[-1] for r in found]) for k in ("joints", "beams"))
    return Prints(joints, beams, np.ones(len(found), bool))


class Simulator:
    """Answers by the formula."""

    name = "fea"

    def simulate(self, grids, progress=None, cancel=None):
        return [shape(design=one) for one in grids]


def material(**changes):
    """Return the base material with parameters changed."""
    from simulearn.compare.changes import parameters

    changed = BASE
    for parameter in parameters(BASE):
        if parameter.name in changes:
            changed = parameter.apply(changed, changes[parameter.name])
    return changed


def motion(seed):
    """Return a random rotation (3, 3) and place (3,)."""
    turn = Rotation.random(random_state=seed).as_matrix()
    return turn, np.random.default_rng(seed).uniform(-300, 300, 3)


def moved(points, seed):
    turn, place = motion(seed)
    return points @ turn.T + place


def surface(result, count=15_000, noise=0.15, hole=None, seed=0):
    """Return points of the last frame's surface and their normals, as a scanner sees them.

    Args:
        result: the shape.
        count: of points.
        noise: mm, standard deviation along the normal.
        hole: (place (3,), radius) that the scanner did not see.
        seed: of the noise.
    """
    rng = np.random.default_rng(seed)
    skinned = skin(result)
    q = skinned.vertices[-1][skinned.quads]
    across = np.cross(q[:, 2] - q[:, 0], q[:, 3] - q[:, 1])
    area = np.linalg.norm(across, axis=1)
    at = rng.choice(len(q), count, p=area / area.sum())
    u, v = rng.random((2, count, 1))
    points = (1 - u) * ((1 - v) * q[at, 0] + v * q[at, 3]) + u * ((1 - v) * q[at, 1] + v * q[at, 2])
    normals = across[at] / area[at, None]
    points = points + noise * rng.normal(size=(count, 1)) * normals
    if hole is not None:
        keep = np.linalg.norm(points - hole[0], axis=1) > hole[1]
        points, normals = points[keep], normals[keep]
    return points, normals


def table(points, rng, height=-1.0):
    """Return points and normals of a table beneath points, and strays around them."""
    low, high = points.min(axis=0), points.max(axis=0)
    count = 2 * len(points)
    flat = rng.uniform(low[:2] - 50, high[:2] + 50, (count, 2))
    plane = np.c_[flat, low[2] + height + 0.1 * rng.normal(size=count)]
    strays = rng.uniform(low - 20, high + 20, (300, 3))
    return np.r_[plane, strays]
