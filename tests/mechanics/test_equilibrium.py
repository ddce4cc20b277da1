"""Beams between joints: published tables, convergence, stiffness and derivatives."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from simulearn.grid import Rules, draw_valid
from simulearn.material import load_material
from simulearn.mechanics.equilibrium import iterate
from simulearn.mechanics.forces import BeamState, HalfBeams, forces, halves, moved, twists
from simulearn.mechanics.model import section_of, unfitted
from simulearn.mechanics.poses import Pose, exp_so3
from simulearn.mechanics.properties import properties_of
from simulearn.mechanics.rollout import every_frame, loads, rollout
from simulearn.mechanics.stiffness import exact_stiffness
from simulearn.mechanics.topology import Topology, flat_geometry, topologies

PLA = load_material("pla-hot-water")
with jax.enable_x64(True):
    LOAD = loads(properties_of(PLA))


def chain(count, length, stiffness, angle=0.0):
    """A beam of `count` pieces along x, or an arc in the plane, between joints without size.

    Args:
        count: pieces.
        length: of all, mm.
        stiffness: (6,) of the section: axial, two of shear, torsion, two of bending.
        angle: rad, that the arc turns in all.
    """
    piece = length / count
    topology = Topology(
        np.array([np.arange(count), np.arange(1, count + 1)]),
        np.array(0),
        *(np.zeros((count + 1, 4), np.int64) for _ in range(4)),
        np.zeros((2, count), np.int64),
        np.ones(count),
    )
    at = np.linspace(0, angle, 2 * count + 1)
    radius = length / angle if angle else None
    place = (
        np.stack([radius * np.sin(at), radius * (1 - np.cos(at)), 0 * at], -1)
        if radius
        else np.stack([np.linspace(0, length, 2 * count + 1), 0 * at, 0 * at], -1)
    )
    c, s, o = np.cos(at), np.sin(at), np.zeros_like(at)
    R = np.stack([c, -s, o, s, c, o, o, o, o + 1], -1).reshape(-1, 3, 3)
    state = BeamState(Pose(R[::2], place[::2]), Pose(R[1::2], place[1::2]))
    flip = np.diag([-1.0, -1.0, 1.0])
    frame = np.broadcast_to(np.stack([np.eye(3), flip])[:, None], (2, count, 3, 3))
    face = np.zeros((2, count, 3))
    rest = resting(topology, state, frame, face)
    # The compliance of a straight half, seen from its middle.
    half = piece / 2
    soft = np.zeros((6, 6))
    for x in (0.5 - 0.5 / np.sqrt(3), 0.5 + 0.5 / np.sqrt(3)):
        carry = np.eye(6)
        carry[:3, 3:] = -np.asarray([[0, 0, 0], [0, 0, -half * x], [0, half * x, 0]])
        soft += carry @ np.diag(half / 2 / np.asarray(stiffness)) @ carry.T
    return (
        topology,
        HalfBeams(
            rest,
            np.broadcast_to(np.linalg.inv(soft), (2, count, 6, 6)),
            face,
            frame,
            np.full(count, half),
            np.array(0.0),
            np.zeros(count + 1),
        ),
        state,
    )


@jax.jit
def resting(topology, state, frame, face):
    """Return the poses of the middles seen from the faces."""
    here = halves(topology, state)
    return (here.joint @ Pose(frame, face)).inverse @ here.middle


@jax.jit
def newton(topology, half_beams, state):
    """One step of Newton's, of 2 mm at most; how far the joints would go.

    Each body moves straight on and turns about itself, which of the motions to count motions is the
    one by which Newton's steps lead far where pieces are many and short.
    """
    count, beams = len(half_beams.weight), topology.ends.shape[1]

    def go(pose, x):
        return Pose(exp_so3(x[:, 3:]) @ pose.R, pose.p + x[:, :3])

    def after(step):
        joints, middles = jnp.split(step, [count])
        return BeamState(go(state.joints, joints), go(state.middles, middles))

    def out(step):
        at = after(step.reshape(-1, 6))
        residual = jnp.concatenate(forces(topology, half_beams, at)).at[0].set(step[:6])
        place = jnp.concatenate([at.joints.p, at.middles.p]).at[0].set(0.0)
        moment = residual[:, 3:] - jnp.cross(place, residual[:, :3])
        return jnp.concatenate([residual[:, :3], moment], -1).ravel()

    zero = jnp.zeros(6 * (count + beams))
    step = -jnp.linalg.solve(jax.jacfwd(out)(zero), out(zero)).reshape(-1, 6)
    size = jnp.abs(step[:count, :3]).max()
    return after(jnp.minimum(1.0, 2.0 / jnp.maximum(size, 1e-9)) * step), size


def loaded(topology, half_beams, state, steps, lift):
    """Return the states under a force upwards at the last joint that rises to `lift`."""
    out = []
    for step in range(1, steps + 1):
        weight = half_beams.weight.copy()
        weight[-1] = -lift * step / steps
        here = half_beams._replace(weight=weight)
        for _ in range(60):
            state, size = newton(topology, here, state)
            if size < 1e-9:
                break
        assert size < 1e-8
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
    topology, half_beams, state = chain(8, 100 * np.pi / 4, stiff, np.pi / 4)
    start = np.asarray(state.joints.p[-1])
    tip = np.asarray(loaded(topology, half_beams, state, 6, 600.0)[-1].joints.p[-1]) - start
    # Their axes: x along the radius' end, here y and x change places.
    expected = np.array([-23.5, -13.4, 53.4])
    assert np.linalg.norm(tip - expected) < 0.01 * np.linalg.norm(expected)


def test_a_curved_rest_is_taken_up_at_once():
    """A piece with constant rest strain is exact whatever the angle."""
    topology, half_beams, state = chain(2, 60.0, STIFF, 1.5)
    straight = chain(2, 60.0, STIFF)[2]
    found, size = jax.jit(iterate, static_argnums=(3, 4))(topology, half_beams, straight, 1e-10, 80)
    assert size < 1e-10
    np.testing.assert_allclose(found.joints.p, state.joints.p, atol=1e-8)


@pytest.fixture(scope="module")
def solved():
    """A design, its topology, and a function that rolls it out and differentiates what it finds.

    The function of joints, ratios and section model returns ((value, what it comes from), slopes).
    All tests call the same one, since it takes long to compile.
    """
    design = draw_valid(Rules(), 2, 5)[0].centred
    topology = jax.tree.map(
        lambda x: jnp.asarray(x[0]), topologies(design.beams, design.fixed, design.joints[None])
    )
    weight = jnp.linspace(0.3, 1.0, 3 * len(design.joints)).reshape(-1, 3)

    def value(joints, ratio, section_model):
        geometry = flat_geometry(topology, joints, PLA.section)
        every = every_frame(section_model, topology, geometry, ratio, LOAD)
        states, motions = rollout(topology, geometry, every, 1e-10, 80)
        one = (states.joints.p[-1] * weight).sum() + states.middles.R[4].sum()
        return one, (every, states, motions)

    return design, topology, jax.jit(jax.value_and_grad(value, (0, 1, 2), has_aux=True))


@pytest.fixture(scope="module")
def found(solved):
    """Where it is rolled out, and all that is found there."""
    design, _, function = solved
    at = jax.tree.map(
        np.asarray, (design.joints, design.actuators, section_of(unfitted(), properties_of(PLA)))
    )
    (_, (every, states, motions)), slopes = function(*at)
    assert motions.max() < 1e-9
    return at, every, states, slopes


def test_forces_are_the_slope_of_the_energy(solved, found):
    """Elastic energy and weight, at a state far from equilibrium."""
    topology, (_, every, states, _) = solved[1], found
    half_beams = jax.tree.map(lambda x: x[6], every)
    state = jax.tree.map(lambda x: x[3], states)

    def energy(joints, middles):
        at = moved(state, joints, middles)
        d = twists(topology, half_beams, at)
        here = halves(topology, at)
        face = here.joint @ Pose(half_beams.frame, half_beams.face)
        lean = face.R[..., 2, 0] - here.middle.R[..., 2, 0]
        height = face.p[..., 2] + here.middle.p[..., 2]
        sag = (
            half_beams.length * half_beams.line / 2 * height
            + half_beams.length**2 * half_beams.line / 12 * lean
        )
        elastic = jnp.einsum("hbi,hbij,hbj->", d, half_beams.stiffness, d) / 2
        return elastic + sag.sum() + (half_beams.weight * at.joints.p[:, 2]).sum()

    zero = jax.tree.map(lambda x: jnp.zeros((len(x), 6)), (state.joints.p, state.middles.p))
    slope = jax.jit(jax.grad(energy, (0, 1)))(*zero)
    balance = jax.jit(forces)(topology, half_beams, state)
    for a, b in zip(balance, slope, strict=True):
        np.testing.assert_allclose(a, b, atol=2e-5 * float(jnp.abs(b).max()))


def test_the_exact_stiffness_is_how_forces_change(solved, found):
    design, topology, _ = solved
    half_beams, state = (jax.tree.map(lambda x: x[8], tree) for tree in found[1:3])
    matrix = np.asarray(jax.jit(exact_stiffness)(topology, half_beams, state))
    count = 6 * len(design.joints)
    rng = np.random.default_rng(0)
    step = rng.normal(size=len(matrix)) * 1e-5
    held = 6 * design.fixed + np.arange(6)
    step[held] = 0

    @jax.jit
    def out(scale):
        joints, middles = jnp.split(scale * step, [count])
        at = moved(state, joints.reshape(-1, 6), middles.reshape(-1, 6))
        return jnp.concatenate([x.ravel() for x in forces(topology, half_beams, at)])

    measured = np.asarray(out(1.0) - out(-1.0)) / 2
    measured[held] = 0
    np.testing.assert_allclose(matrix @ step, measured, atol=1e-4 * abs(measured).max())


def test_equilibria_are_differentiated_exactly(solved, found):
    function, (at, _, _, slopes) = solved[2], found
    rng = np.random.default_rng(0)
    busy = np.asarray(at[1]) != 0  # at 0 an actuator changes halves: there is a corner
    motions = (
        jnp.asarray(rng.normal(size=at[0].shape)),
        jnp.asarray(0.1 * rng.normal(size=at[1].shape) * busy),
        jax.tree.map(lambda x: jnp.asarray(0.01 * rng.normal(size=x.shape)), at[2]),
    )
    for k in range(3):

        def ahead(h, k=k):
            there = jax.tree.map(lambda x, w: x + h * w, at[k], motions[k])
            return float(function(*at[:k], there, *at[k + 1 :])[0][0])

        measured = (ahead(1e-4) - ahead(-1e-4)) / 2e-4
        pairs = zip(jax.tree.leaves(slopes[k]), jax.tree.leaves(motions[k]), strict=True)
        assert sum(float((a * b).sum()) for a, b in pairs) == pytest.approx(measured, rel=1e-5)
