"""Rotations and poses: exponentials, logarithms and their derivatives."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from simulearn.mechanics.poses import (
    Pose,
    adjoint,
    exp_se3,
    exp_so3,
    hat,
    inverse_right,
    log_se3,
)

RNG = np.random.default_rng(0)
TURNS = RNG.normal(size=(50, 3))
TURNS *= (RNG.uniform(0, 2.0, 50) / np.linalg.norm(TURNS, axis=1))[:, None]
with jax.enable_x64(True):
    TWISTS = jnp.asarray(np.concatenate([RNG.normal(size=(50, 3)) * 20, TURNS], axis=1))


def test_rotations_are_those_of_their_vectors():
    theirs = Rotation.from_rotvec(TURNS).as_matrix()
    np.testing.assert_allclose(exp_so3(jnp.asarray(TURNS)), theirs, atol=1e-8)


def test_poses_are_matrix_exponentials():
    for x, R, p in zip(TWISTS, *jax.jit(exp_se3)(TWISTS), strict=True):
        whole = np.zeros((4, 4))
        whole[:3, :3], whole[:3, 3] = hat(x[3:]), x[:3]
        found = expm(whole)
        np.testing.assert_allclose(R, found[:3, :3], atol=1e-8)
        np.testing.assert_allclose(p, found[:3, 3], atol=1e-6)


def test_logarithms_undo_exponentials():
    there_and_back = jax.jit(lambda x: log_se3(exp_se3(x)))
    np.testing.assert_allclose(there_and_back(TWISTS), TWISTS, atol=2e-6)
    np.testing.assert_array_equal(there_and_back(jnp.zeros(6)), 0)


def test_poses_compose_and_invert():
    a, b = exp_se3(TWISTS[:25]), exp_se3(TWISTS[25:])
    back = (a @ b) @ (b.inverse @ a.inverse)
    np.testing.assert_allclose(back.R, np.broadcast_to(np.eye(3), (25, 3, 3)), atol=1e-7)
    np.testing.assert_allclose(back.p, 0, atol=1e-5)


def test_the_adjoint_carries_twists():
    a, x = exp_se3(TWISTS[:25]), TWISTS[25:] * 0.5
    carried = exp_se3(jnp.einsum("kij,kj->ki", adjoint(a), x))
    around = a @ exp_se3(x) @ a.inverse
    np.testing.assert_allclose(carried.R, around.R, atol=1e-7)
    np.testing.assert_allclose(carried.p, around.p, atol=1e-4)


@pytest.mark.parametrize(("largest", "tolerance"), [(1.0, 2e-5), (0.5, 5e-7)])
def test_how_logarithms_change(largest, tolerance):
    small = TWISTS.at[:, 3:].multiply(largest / 2)
    change = jax.jit(jax.vmap(jax.jacfwd(lambda e, x: log_se3(exp_se3(x) @ exp_se3(e)))))
    found = change(jnp.zeros_like(small), small)
    turn, along = inverse_right(small)
    expected = jnp.block([[turn, along], [jnp.zeros_like(turn), turn]])
    np.testing.assert_allclose(expected, found, atol=tolerance * 30)


def test_derivatives_at_rest_are_finite():
    jacobian = jax.jit(jax.jacfwd(log_se3))(Pose(jnp.eye(3), jnp.zeros(3)))
    assert all(np.isfinite(x).all() for x in jax.tree.leaves(jacobian))
    assert np.isfinite(jax.jit(jax.jacfwd(exp_so3))(jnp.zeros(3))).all()
