"""The compiled bricks obey the laws that any finite element must obey."""

import jax.numpy as jnp
import numpy as np
import pytest
from test_laws import LAWS, NAMES

import ladder
from simulearn.fea.kernel import points_of, respond
from simulearn.fea.laws import Law


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_patch(law: Law) -> None:
    """Distorted bricks in homogeneous deformation have no inner forces."""
    assert ladder.patch(law) < 1e-12


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_turning_a_growing_body_turns_its_forces(law: Law) -> None:
    assert ladder.rigid(law) < 1e-12


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_tangent_is_the_derivative_of_the_forces(law: Law) -> None:
    assert ladder.tangent(law) < 1e-8


def test_carried_stress_only_changes_the_geometric_stiffness() -> None:
    solid = ladder.unit_brick()
    points = points_of(solid)
    u = np.random.default_rng(0).normal(scale=0.02, size=(1, 20, 3))
    newton = respond(LAWS[0], points, u, 0.0, None)
    same = respond(LAWS[0], points, u, 0.0, newton.stress)
    other = respond(LAWS[0], points, u, 0.0, newton.stress + jnp.eye(3)[:, :, None])
    np.testing.assert_allclose(same.entries, newton.entries, atol=1e-12)
    np.testing.assert_array_equal(other.residual, newton.residual)
    change = ladder.full(np.asarray(other.entries - newton.entries))[0].reshape(20, 3, 20, 3)
    # A unit carried stress adds the same scalar matrix to each displacement component.
    np.testing.assert_allclose(change[:, 0, :, 1], 0, atol=1e-12)
    np.testing.assert_allclose(change[:, 0, :, 0], change[:, 2, :, 2], atol=1e-12)
    assert abs(change[:, 0, :, 0]).max() > 0.1


def test_volume_and_load_add_up() -> None:
    points = points_of(ladder.distorted())
    assert float(points.volumes.sum()) == pytest.approx(1.0, rel=1e-12)
    assert float(points.load.sum()) == pytest.approx(1.0, rel=1e-12)
