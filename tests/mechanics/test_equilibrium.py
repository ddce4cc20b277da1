"""Beams between joints: published tables, convergence, stiffness and derivatives."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from simulearn.grid import Rules, draw_valid
from simulearn.material import load_material
from simulearn.mechanics.equilibrium import iterate
from simulearn.mechanics.forces import Elements, State, forces, halves, moved, twists
from simulearn.mechanics.poses import Pose, exp_so3
from simulearn.mechanics.rollout import every_frame, loads, rollout
from simulearn.mechanics.section import first_guess
from simulearn.mechanics.skeleton import Skeleton, flat, skeletons
from simulearn.mechanics.stiffness import exact_stiffness

PLA = load_material("pla-hot-water")
LOAD = loads(PLA)


def chain(count, length, stiffness, angle=0.0):
    """A beam of `count` pieces along x, or an arc in the plane, between joints without size.

    Args:
        count: pieces.
        length: of all, mm.
        stiffness: (6,) of the section: axial, two of shear, torsion, two of bending.
        angle: rad, that the arc turns in all.
    """
    piece = length / count
    bones = Skeleton(
        np.array([np.arange(count), np.arange(1, count + 1)]),
        np.array(0),
        *(np.zeros((count + 1, 4), np.int64) for _ in range(4)),
        np.zeros((2, count), np.int64),
    )
    turn = lambda a: np.asarray(exp_so3(jnp.stack([0 * a, 0 * a, a], -1)))  # noqa: E731
    at = np.linspace(0, angle, 2 * count + 1)
    radius = length / angle if angle else None
    place = (
        np.stack([radius * np.sin(at), radius * (1 - np.cos(at)), 0 * at], -1)
        if radius
        else np.stack([np.linspace(0, length, 2 * count + 1), 0 * at, 0 * at], -1)
    )
    R = turn(jnp.asarray(at))
    state = State(
        Pose(jnp.asarray(R[::2]), jnp.asarray(place[::2])),
        Pose(jnp.asarray(R[1::2]), jnp.asarray(place[1::2])),
    )
    flip = np.diag([-1.0, -1.0, 1.0])
    frame = jnp.asarray(np.broadcast_to(np.stack([np.eye(3), flip])[:, None], (2, count, 3, 3)))
    here = halves(bones, state)
    face = jnp.zeros((2, count, 3))
    rest = (here.joint @ Pose(frame, face)).inverse @ here.middle
    # The compliance of a straight half, seen from its middle.
    half = piece / 2
    soft = np.zeros((6, 6))
    for x in (0.5 - 0.5 / np.sqrt(3), 0.5 + 0.5 / np.sqrt(3)):
        carry = np.eye(6)
        carry[:3, 3:] = -np.asarray([[0, 0, 0], [0, 0, -half * x], [0, half * x, 0]])
        soft += carry @ np.diag(half / 2 / np.asarray(stiffness)) @ carry.T
    return (
        bones,
        Elements(
            rest,
            jnp.broadcast_to(jnp.linalg.inv(jnp.asarray(soft)), (2, count, 6, 6)),
            face,
            frame,
            jnp.full(count, half),
            jnp.array(0.0),
            jnp.zeros(count + 1),
        ),
        state,
    )


@jax.jit
def newton(bones, el, state):
    """One step of Newton's, of 2 mm at most; how far the joints would go.

    Each body moves straight on and turns about itself, which of the ways to count motions is the
    one by which Newton's steps lead far where pieces are many and short.
    """
    count, beams = len(el.weight), bones.ends.shape[1]

    def after(step):
        go = lambda pose, x: Pose(exp_so3(x[:, 3:]) @ pose.R, pose.p + x[:, :3])  # noqa: E731
        joints, middles = jnp.split(step, [count])
        return State(go(state.joints, joints), go(state.middles, middles))

    def out(step):
        at = after(step.reshape(-1, 6))
        told = jnp.concatenate(forces(bones, el, at)).at[0].set(step[:6])
        place = jnp.concatenate([at.joints.p, at.middles.p]).at[0].set(0.0)
        moment = told[:, 3:] - jnp.cross(place, told[:, :3])
        return jnp.concatenate([told[:, :3], moment], -1).ravel()

    zero = jnp.zeros(6 * (count + beams))
    step = -jnp.linalg.solve(jax.jacfwd(out)(zero), out(zero)).reshape(-1, 6)
    way = jnp.abs(step[:count, :3]).max()
    return after(jnp.minimum(1.0, 2.0 / jnp.maximum(way, 1e-9)) * step), way


def loaded(bones, el, state, steps, lift):
    """Return the states under a force upwards at the last joint that rises to `lift`."""
    out = []
    bones = jax.tree.map(jnp.asarray, bones)
    for step in range(1, steps + 1):
        here = el._replace(weight=el.weight.at[-1].set(-lift * step / steps))
        for _ in range(60):
            state, way = newton(bones, here, state)
            if way < 1e-9:
                break
        assert way < 1e-8
        out.append(state)
    return out


# Sze, Liu, Lo (2004), 3.1: every second load.
SZE = [
    (0.103, 1.309), (0.381, 2.493), (0.763, 3.488), (1.184, 4.292), (1.604, 4.933),
    (2.002, 5.444), (2.370, 5.855), (2.705, 6.190), (3.010, 6.467), (3.286, 6.698),
]  # fmt: skip
STIFF = [1.2e5, 0.5e5, 0.5e5, 20.0, 100.0, 1e4]  # E A, G A, G A, G J, E I weak, E I strong


def test_a_cantilever_with_end_shear_follows_the_table():
    states = loaded(*chain(8, 10.0, STIFF), 10, 4.0)
    for state, (u, w) in zip(states, SZE, strict=True):
        tip = np.asarray(state.joints.p[-1])
        assert 10 - tip[0] == pytest.approx(u, abs=0.01 * 3.286)
        assert tip[2] == pytest.approx(w, rel=0.01)


def test_it_converges_with_the_square_of_the_pieces():
    tips = [
        np.asarray(loaded(*chain(n, 10.0, STIFF), 5, 4.0)[-1].joints.p[-1]) for n in (1, 2, 4, 16)
    ]
    errors = [np.linalg.norm(tip - tips[-1]) for tip in tips[:-1]]
    assert errors[0] / errors[1] > 3
    assert errors[1] / errors[2] > 3
    assert errors[2] < 0.02 * 10


def test_the_bend_of_45_degrees():
    """Bathe and Bolourchi (1979): E 1e7, nu 0, section 1 x 1, radius 100, tip load 600."""
    stiff = [1e7, 5e6, 5e6, 5e6 * 0.1406, 1e7 / 12, 1e7 / 12]
    bones, el, state = chain(8, 100 * np.pi / 4, stiff, np.pi / 4)
    start = np.asarray(state.joints.p[-1])
    tip = np.asarray(loaded(bones, el, state, 6, 600.0)[-1].joints.p[-1]) - start
    # Their axes: x along the radius' end, here y and x change places.
    expected = np.array([-23.5, -13.4, 53.4])
    assert np.linalg.norm(tip - expected) < 0.01 * np.linalg.norm(expected)


def test_a_curved_rest_is_taken_up_at_once():
    """A piece with constant rest strain is exact whatever the angle."""
    bones, el, state = chain(2, 60.0, STIFF, 1.5)
    straight = chain(2, 60.0, STIFF)[2]
    found, way = iterate(bones, el, straight, 1e-10, 80)
    assert way < 1e-10
    np.testing.assert_allclose(found.joints.p, state.joints.p, atol=1e-8)


@pytest.fixture(scope="module")
def grid():
    design = draw_valid(Rules(), 2, 5)[0].centred
    bones = jax.tree.map(lambda x: x[0], skeletons(design.beams, design.fixed, design.joints[None]))
    plan = flat(bones, jnp.asarray(design.joints), PLA.section)
    return design, bones, plan


def test_forces_are_the_slope_of_the_energy(grid):
    """Elastic energy and weight, at a state far from equilibrium."""
    design, bones, plan = grid
    ratio = jnp.asarray(design.actuators)
    el = jax.tree.map(lambda x: x[6], every_frame(first_guess(), bones, plan, ratio, LOAD))
    states, _ = rollout(bones, plan, every_frame(first_guess(), bones, plan, ratio, LOAD))
    state = jax.tree.map(lambda x: x[3], states)

    def energy(joints, middles):
        at = moved(state, joints, middles)
        d = twists(bones, el, at)
        here = halves(bones, at)
        face = here.joint @ Pose(el.frame, el.face)
        lean = face.R[..., 2, 0] - here.middle.R[..., 2, 0]
        height = face.p[..., 2] + here.middle.p[..., 2]
        sag = el.length * el.line / 2 * height + el.length**2 * el.line / 12 * lean
        elastic = jnp.einsum("hbi,hbij,hbj->", d, el.stiffness, d) / 2
        return elastic + sag.sum() + (el.weight * at.joints.p[:, 2]).sum()

    zero = jnp.zeros((len(plan.centre), 6)), jnp.zeros((len(ratio), 6))
    slope = jax.grad(energy, (0, 1))(*zero)
    told = forces(bones, el, state)
    for a, b in zip(told, slope, strict=True):
        np.testing.assert_allclose(a, b, atol=2e-5 * float(jnp.abs(b).max()))


def test_the_exact_stiffness_is_how_forces_change(grid):
    design, bones, plan = grid
    ratio = jnp.asarray(design.actuators)
    every = every_frame(first_guess(), bones, plan, ratio, LOAD)
    states, ways = rollout(bones, plan, every, 1e-9)
    assert ways.max() < 1e-9
    el, state = (jax.tree.map(lambda x: x[8], tree) for tree in (every, states))
    matrix = np.asarray(exact_stiffness(bones, el, state))
    count = 6 * len(plan.centre)
    rng = np.random.default_rng(0)
    step = rng.normal(size=len(matrix)) * 1e-5
    held = 6 * design.fixed + np.arange(6)
    step[held] = 0

    def out(scale):
        at = moved(
            state,
            jnp.asarray(scale * step[:count].reshape(-1, 6)),
            jnp.asarray(scale * step[count:].reshape(-1, 6)),
        )
        joints, middles = forces(bones, el, at)
        return np.concatenate([joints.ravel(), middles.ravel()])

    measured = (out(1.0) - out(-1.0)) / 2
    measured[held] = 0
    np.testing.assert_allclose(matrix @ step, measured, atol=1e-4 * abs(measured).max())


def test_equilibria_are_differentiated_exactly(grid):
    """Through joints' places, actuators and the law, to 1e-6 of central differences."""
    design, bones, _ = grid
    weight = jnp.linspace(0.3, 1.0, 3 * len(design.joints)).reshape(-1, 3)

    @jax.jit
    def value(joints, ratio, law):
        plan = flat(bones, joints, PLA.section)
        states, _ = rollout(bones, plan, every_frame(law, bones, plan, ratio, LOAD), 1e-10, 80)
        return (states.joints.p[-1] * weight).sum() + states.middles.R[4].sum()

    at = jnp.asarray(design.joints), jnp.asarray(design.actuators), first_guess()
    slopes = jax.jit(jax.grad(value, (0, 1, 2)))(*at)
    rng = np.random.default_rng(0)
    busy = np.asarray(at[1]) != 0  # at 0 an actuator changes halves: there is a corner
    ways = (
        jnp.asarray(rng.normal(size=at[0].shape)),
        jnp.asarray(0.1 * rng.normal(size=at[1].shape) * busy),
        jax.tree.map(lambda x: jnp.asarray(0.01 * rng.normal(size=x.shape)), at[2]),
    )
    for k in range(3):

        def ahead(h, k=k):
            there = jax.tree.map(lambda x, w: x + h * w, at[k], ways[k])
            return float(value(*at[:k], there, *at[k + 1 :]))

        measured = (ahead(1e-4) - ahead(-1e-4)) / 2e-4
        pairs = zip(jax.tree.leaves(slopes[k]), jax.tree.leaves(ways[k]), strict=True)
        assert sum(float((a * b).sum()) for a, b in pairs) == pytest.approx(measured, rel=1e-5)
