"""The rungs of the verification ladder, each a function that returns a measured figure.

The tests assert them, `verify.py` prints them; the sources stand with each rung.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation
from skfem import Basis, ElementHexS2, MeshHex

from simulearn.fea import Layout, Solid, mesh, simulate_grid
from simulearn.fea.bar import bar, curvature
from simulearn.fea.kernels import checks, entries
from simulearn.fea.kernels.law import ConstitutiveLaw
from simulearn.fea.laws import law_of
from simulearn.fea.path import Path
from simulearn.fea.points import bricks_of
from simulearn.fea.problem import Control, EquilibriumProblem
from simulearn.grid import Grid, Rules, draw_valid, make
from simulearn.material import ElasticData, Material, load_material

Array = NDArray[np.float64]

PLA = load_material("pla-hot-water")
PAIRS = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]  # of displacement components
TIGHT = Control(tolerance=1e-8, iterations=40)

# Sze, Liu, Lo 2004, Finite Elem. Anal. Des. 40, table of 3.1: P/Pmax, -U, W.
END_SHEAR = """.05 .026 .663 | .10 .103 1.309 | .15 .224 1.922 | .20 .381 2.493 | .25 .563 3.015 |
.30 .763 3.488 | .35 .971 3.912 | .40 1.184 4.292 | .45 1.396 4.631 | .50 1.604 4.933 |
.55 1.807 5.202 | .60 2.002 5.444 | .65 2.190 5.660 | .70 2.370 5.855 | .75 2.541 6.031 |
.80 2.705 6.190 | .85 2.861 6.335 | .90 3.010 6.467 | .95 3.151 6.588 | 1.0 3.286 6.698"""


def elastic(modulus: float, poisson: float, width: float, thickness: float) -> Material:
    """Return a St Venant-Kirchhoff material with a plain rectangular section."""
    section = PLA.section.model_copy(
        update={"width": width, "thickness": thickness, "shell": width / 8}
    )
    law = ElasticData(kind="st-venant-kirchhoff", modulus=modulus, poisson=poisson)
    return PLA.model_copy(update={"section": section, "law": law})


def cantilever(material: Material, length: float, layout: Layout) -> Solid:
    """Return a bar along +x, clamped at x = 0 and free at `length`; it grows nowhere.

    Its first joint lies before x = 0 and is held whole; the second is its last piece.
    """
    width = material.section.width
    solid = mesh(bar(length - width, 0.0, material), material, layout)
    nodes = solid.nodes - [width / 2, 0, 0]
    held = np.flatnonzero(nodes[:, 0] < 1e-9 * length)
    return replace(solid, nodes=nodes, fixed=held, growth=np.zeros_like(solid.growth))


def tip(solid: Solid) -> NDArray[np.int64]:
    """Return the nodes of the free end face."""
    return np.flatnonzero(solid.nodes[:, 0] > solid.nodes[:, 0].max() - 1e-9)


def end_shear(layout: Layout = Layout(slabs=16)) -> Array:
    """Return (20, 2) relative errors of -U and W of a cantilever with end shear."""
    table = np.array([[float(x) for x in row.split()] for row in END_SHEAR.split("|")])
    material = elastic(1.2e6, 0.0, 1.0, 0.1)
    solid = cantilever(material, 10.0, layout)
    end = tip(solid)
    forces = np.zeros_like(solid.nodes)
    forces[end, 2] = 4.0 / len(end)
    path = Path(EquilibriumProblem(solid, law_of(material.law), 0.0, forces))
    steps = [path.advance(0.0, float(fraction)) for fraction in table[:, 0]]
    u = np.array([state.u[end].mean(axis=0) for state in steps])
    # Relative to the largest value: the first rows are printed with two digits.
    return np.stack([-u[:, 0] - table[:, 1], u[:, 2] - table[:, 2]], axis=1) / table[-1, 1:]


def end_moment(turns: float = 0.5, layout: Layout = Layout(slabs=24)) -> Array:
    """Return (steps, 2) errors of U and W over L of a cantilever bent by an end moment.

    Exact: R = EI / M, U = R sin(L / R) - L, W = R (1 - cos(L / R)). The couple follows the end
    face: its direction is updated until it stands still.
    """
    length, stiffness = 12.0, 100.0
    material = elastic(1.2e6, 0.0, 1.0, 0.1)
    solid = cantilever(material, length, layout)
    end = tip(solid)
    top, low = (end[solid.nodes[end, 2] * sign > 0.04] for sign in (1, -1))
    problem = EquilibriumProblem(solid, law_of(material.law), 0.0)
    # The load of step k is k times what `problem.load` holds, so that steps can be extrapolated.
    steps, angles, errors = [problem.flat()], [0.0], []
    for step in range(1, round(turns * 24) + 1):
        moment = 2 * np.pi * stiffness / length * step / 24
        angle = 2 * angles[-1] - angles[-2] if step > 1 else 2 * np.pi / 24
        thick, path = 0.1, Path(problem, steps[-3:])
        for _ in range(10):
            along = np.array([np.cos(angle), 0, np.sin(angle)])
            problem.load[low] = moment / thick * along / len(low) / step
            problem.load[top] = -moment / thick * along / len(top) / step
            if path.last[-1].gravity == step:  # the direction has changed: from there
                path = Path(problem, [replace(path.last[-1], gravity=step - 1.0)])
            state = path.advance(0.0, float(step))
            up = (solid.nodes + state.u)[top].mean(axis=0) - (solid.nodes + state.u)[low].mean(
                axis=0
            )
            before, angle = angle, float(np.arctan2(-up[0], up[2])) % (2 * np.pi)
            thick = float(np.linalg.norm(up))
            if abs(angle - before) < 1e-7:
                break
        steps.append(state)
        angles.append(angle)
        radius = stiffness / moment
        exact = np.array(
            [radius * np.sin(length / radius) - length, radius * (1 - np.cos(length / radius))]
        )
        errors.append((state.u[end].mean(axis=0)[[0, 2]] - exact) / length)
    return np.array(errors)


def bend_45(layout: Layout = Layout(slabs=16)) -> Array:
    """Return the tip displacement of the 45 degree bend; published: (-13.4, -23.5, 53.4).

    Bathe and Bolourchi 1979, Int. J. Numer. Meth. Engng 14: R = 100, 1 x 1, E = 1e7, tip load 600
    out of the plane. The beam starts along y and bends towards x.
    """
    radius = 100.0
    material = elastic(1e7, 0.0, 1.0, 1.0)
    solid = cantilever(material, radius * np.pi / 4, layout)
    end = tip(solid)
    x, y, z = solid.nodes.T
    angle = np.maximum(x, 0) / radius
    r = radius + y
    curved = np.stack([radius - r * np.cos(angle), r * np.sin(angle) + np.minimum(x, 0), z], axis=1)
    solid = replace(solid, nodes=curved)
    forces = np.zeros_like(curved)
    forces[end, 2] = 600.0 / len(end)
    path = Path(EquilibriumProblem(solid, law_of(material.law), 0.0, forces))
    for step in range(1, 11):
        path.advance(0.0, step / 10)
    return np.asarray(path.last[-1].u[end].mean(axis=0))


def bilayer(upper: int, layers: int = 2, strain: float = 1e-4) -> float:
    """Return the curvature of a bilayer over Timoshenko's (J. Opt. Soc. Am. 11, 1925).

    Args:
        upper: layers that shrink, of 2 `layers` in all, counted from the top.
        layers: bricks through each half.
        strain: by which they shrink.
    """
    material = elastic(1.0, 0.0, 7.2, 4.0)
    solid = cantilever(material, 60.0, Layout(layers=layers))
    layer = np.arange(len(solid.bricks)) % (2 * layers)  # the fastest index of the bricks
    growth = np.zeros_like(solid.growth)
    growth[layer >= 2 * layers - upper, :, 0] = -strain
    solid = replace(solid, growth=growth)
    path = Path(EquilibriumProblem(solid, law_of(material.law), 0.0, control=TIGHT))
    state = path.advance(1.0, 0.0)
    m = upper / (2 * layers - upper)
    exact = 6 * strain * (1 + m) ** 2 / (4.0 * (3 * (1 + m) ** 2 + (1 + m) * (m**2 + 1 / m)))
    return np.radians(curvature(solid, state.u)) / exact


def brick(law: ConstitutiveLaw, stretch: float) -> float:
    """Return the force (N) that stretches one 1 mm brick whose sides are free."""
    solid = unit_brick()

    def forces(lateral: float) -> Array:
        return residual(solid, law, solid.nodes * (np.array([stretch, lateral, lateral]) - 1))

    x = solid.nodes
    side = x[:, 1] > 0.999
    lateral = brentq(lambda m: forces(m)[side, 1].sum(), 0.5, 1.2, xtol=1e-14)
    return float(forces(lateral)[x[:, 0] > 0.999, 0].sum())


def unit_brick() -> Solid:
    """Return one brick of 1 mm, its integration points those of the default layout."""
    whole = cantilever(elastic(1, 0, 1, 1), 10, Layout())
    basis = Basis(MeshHex(), ElementHexS2())
    none = np.zeros((1, len(whole.weights), 3))
    return replace(
        whole,
        nodes=basis.doflocs.T.copy(),
        bricks=basis.element_dofs.T.copy(),
        parts=np.zeros((1, 2), dtype=int),
        angle=np.zeros(1),
        growth=none,
        stress=none,
    )


def sag(load: float = 0.02) -> float:
    """Return the tip sag of a heavy cantilever over q L^4 / 8 EI + q L^2 / 2 k G A (k = 5/6)."""
    modulus, poisson, length = 2.2, 0.0, 90.0
    material = elastic(modulus, poisson, 7.2, 4.0)
    solid = cantilever(material, length, Layout())
    weight = load * PLA.gravity.body_force
    path = Path(EquilibriumProblem(solid, law_of(material.law), weight, control=TIGHT))
    state = path.advance(0.0, 1.0)
    q, inertia, area = weight * 28.8, 7.2 * 4.0**3 / 12, 28.8
    exact = q * length**4 / (8 * modulus * inertia) + q * length**2 / (
        2 * 5 / 6 * modulus / 2 * area
    )
    return float(-state.u[tip(solid), 2].mean() / exact)


def svk() -> ConstitutiveLaw:
    """Return a St Venant-Kirchhoff law with PLA's constants."""
    return law_of(ElasticData(kind="st-venant-kirchhoff", modulus=2.2, poisson=0.406))


def distorted(seed: int = 0) -> Solid:
    """Return 2 x 2 x 2 bricks whose inner and face vertices are moved at random; none grows."""
    whole = unit_brick()
    box = MeshHex.init_tensor(*3 * [np.linspace(0, 1, 3)])
    inside = (abs(box.p - 0.5) < 0.4).any(axis=0)
    shift = np.random.default_rng(seed).uniform(-0.12, 0.12, box.p.shape) * (abs(box.p - 0.5) < 0.4)
    basis = Basis(MeshHex(box.p + shift * inside, box.t), ElementHexS2())
    none = np.zeros((8, len(whole.weights), 3))
    bricks = np.ascontiguousarray(basis.element_dofs.T)
    return replace(
        whole,
        nodes=np.ascontiguousarray(basis.doflocs.T),
        bricks=bricks,
        parts=np.zeros((8, 2), dtype=int),
        angle=np.zeros(8),
        growth=none,
        stress=none,
    )


def residual(solid: Solid, law: ConstitutiveLaw, u: Array, released: float = 0.0) -> Array:
    """Return the internal forces (N, 3) of a solid."""
    forces = entries.internal(law, bricks_of(solid)[0], np.ascontiguousarray(u), released)[0]
    return np.asarray(forces)


def patch(law: ConstitutiveLaw) -> float:
    """Return the largest inner force of distorted bricks in homogeneous deformation.

    It is relative to the largest force on the boundary.
    """
    solid = distorted()
    gradient = np.array([[0.08, 0.05, -0.03], [0.02, -0.06, 0.04], [-0.01, 0.07, 0.05]])
    forces = residual(solid, law, solid.nodes @ gradient.T)
    inner = (abs(solid.nodes - 0.5) < 0.499).all(axis=1)
    return float(abs(forces[inner]).max() / abs(forces).max())


def rigid(law: ConstitutiveLaw) -> float:
    """Return the change of the forces of growing, deformed bricks when they are turned.

    It is the difference between the forces turned and the forces after turning, relative.
    """
    rng = np.random.default_rng(1)
    solid = distorted()
    solid = replace(solid, growth=rng.uniform(-0.09, 0.04, solid.growth.shape), angle=np.ones(8))
    u = rng.normal(scale=0.01, size=solid.nodes.shape)
    R = Rotation.from_rotvec([1.0, -2.0, 0.5]).as_matrix()
    turned = (solid.nodes + u) @ R.T + [3, 4, 5] - solid.nodes
    before, after = residual(solid, law, u, 0.7), residual(solid, law, turned, 0.7)
    return float(abs(after - before @ R.T).max() / abs(before).max())


def tangent(law: ConstitutiveLaw) -> float:
    """Return the relative difference between tangent and central differences of the forces."""
    rng = np.random.default_rng(2)
    solid = unit_brick()
    solid = replace(solid, growth=rng.uniform(-0.09, 0.04, solid.growth.shape))
    u = rng.normal(scale=0.02, size=(20, 3))
    order = solid.bricks[0]
    moved = np.empty_like(u)
    moved[order] = u
    stiffness = stiffness_of(solid, law, moved, 0.8)[0]
    step, columns = 1e-6, []
    for k in range(60):
        du = np.zeros_like(u)
        du[order[k // 3], k % 3] = step
        ahead, back = (residual(solid, law, moved + d, 0.8) for d in (du, -du))
        columns.append((ahead - back)[order].reshape(60) / (2 * step))
    return float(abs(np.array(columns).T - stiffness).max() / abs(stiffness).max())


def stiffness_of(
    solid: Solid,
    law: ConstitutiveLaw,
    u: Array,
    released: float = 0.0,
    carried: Array | None = None,
) -> Array:
    """Return the stiffness matrices (E, 60, 60) of a solid's bricks at displacements u (N, 3).

    Args:
        solid: the solid.
        law: its law.
        u: (N, 3) mm.
        released: fraction of the stress that is released.
        carried: (M, 6) stress of the geometric stiffness; None for that of the displacements.
    """
    bricks = bricks_of(solid)[0]
    stress = np.zeros((bricks.volumes.size, 6)) if carried is None else carried
    mixed = carried is not None
    stiffness, _ = checks.stiffness_of(law, bricks, u, released, stress, mixed)
    pairs = stiffness.reshape(-1, 20, len(PAIRS), 20)
    blocks = np.empty((len(pairs), 20, 3, 20, 3))
    for pair, (k, l) in enumerate(PAIRS):  # noqa: E741
        blocks[:, :, k, :, l] = pairs[:, :, pair]
        blocks[:, :, l, :, k] = pairs[:, :, pair].swapaxes(1, 2)
    return blocks.reshape(-1, 60, 60)


def creep_of_beam(steps: int = 400, length: float = 90.0) -> tuple[float, float]:
    """Return the tip's creep sag, mm, of a heavy cantilever: quasi-elastic, and step by step.

    A planar elastica, clamped and horizontal, under its effective weight. Step by step: Findley
    creep, the curvature being the hereditary integral of the moment's history, Boltzmann's
    superposition; quasi-elastic: all of the compliance acts on the final moment at once.
    """
    count, creep = 200, PLA.creep
    ds = length / count
    q = PLA.gravity.body_force * 28.8
    stiffness = 2.2 * 7.2 * 4.0**3 / 12

    def moment(angle: Array) -> Array:
        x = np.concatenate([[0], np.cumsum(np.cos(angle) * ds)])
        middle = (x[1:] + x[:-1]) / 2
        # Of all that hangs beyond each place: q sum (x_j - x_i) ds.
        beyond = np.cumsum(middle[::-1])[::-1] - middle * np.arange(count, 0, -1)
        return -q * ds * beyond

    def shape(curvature_of: Callable[[Array], Array]) -> Array:
        angle = np.zeros(count)
        for _ in range(200):
            new = np.cumsum(curvature_of(moment(angle))) * ds
            if abs(new - angle).max() < 1e-12:
                break
            angle = new
        return angle

    def fall(angle: Array) -> float:
        return float(-(np.sin(angle) * ds).sum())

    at_once = shape(lambda m: m / stiffness)
    quasi = shape(lambda m: (1 + creep.amplitude) * m / stiffness)

    time = np.linspace(0, 1, steps + 1)  # in hold times
    history = [moment(at_once)]
    for n in range(1, steps + 1):
        changes = np.diff([np.zeros(count), *history], axis=0)
        since = time[n] - np.concatenate([[0], (time[: n - 1] + time[1:n]) / 2])
        past = (1 + creep.amplitude * since**creep.exponent) @ changes
        fresh = 1 + creep.amplitude * (time[1] / 2) ** creep.exponent
        last = history[-1]
        angle = shape(lambda m, p=past, f=fresh, h=last: (p + f * (m - h)) / stiffness)
        history.append(moment(angle))
    return fall(quasi) - fall(at_once), fall(angle) - fall(at_once)


def symmetry(name: str = "dome") -> dict[str, float]:
    """Return how far results of a turned or mirrored design are from the turned result, mm.

    `self` is the same for the mirror image of a design that is its own mirror image.
    """
    grid, _ = draw_valid(Rules(), 7, 0)
    joints = simulate_grid(grid, PLA).joints.mean(axis=2)
    c, s = np.cos(0.7), np.sin(0.7)
    out = {}
    for title, Q in (("turned", np.array([[c, -s], [s, c]])), ("mirrored", np.diag([1.0, -1.0]))):
        image = Grid(grid.joints @ Q.T, grid.beams, grid.actuators, grid.fixed, grid.material)
        other = simulate_grid(image, PLA).joints.mean(axis=2)
        expected = joints.copy()
        expected[..., :2] = joints[..., :2] @ Q.T
        out[title] = float(abs(other - expected).max())
    symmetric = simulate_grid(make(name), PLA).joints.mean(axis=2).reshape(12, 3, 3, 3)
    out["self"] = float(abs(symmetric[:, :, ::-1] * [-1, 1, 1] - symmetric).max())

    free = PLA.model_copy(update={"gravity": PLA.gravity.model_copy(update={"acceleration": 0.0})})
    tops = [
        _clamped(Grid(grid.joints, grid.beams, sign * grid.actuators, grid.fixed), free)
        for sign in (1, -1)
    ]
    out["flipped"] = float(abs(tops[0] * [1, 1, -1] - tops[1]).max())
    return out


def _clamped(grid: Grid, material: Material) -> Array:
    """Return the joint centres (J, 3) when all of the fixed joint is held, fully released."""
    solid = mesh(grid, material)
    joint = solid.bricks[(solid.parts == [-1, grid.fixed]).all(axis=1)]
    solid = replace(solid, fixed=np.unique(joint))
    path = Path(EquilibriumProblem(solid, law_of(material.law), 0.0))
    for step in range(1, 11):
        path.advance(step / 10, 0.0)
    return np.asarray((solid.nodes + path.last[-1].u)[solid.joints].mean(axis=1))
