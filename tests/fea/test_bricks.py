"""The bricks obey the laws that any finite element must obey."""

import numpy as np
import pytest
from test_laws import LAWS, NAMES

import ladder
from simulearn.fea.kernels import entries
from simulearn.fea.kernels.law import ConstitutiveLaw
from simulearn.fea.points import bricks_of


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_patch(law: ConstitutiveLaw) -> None:
    """Distorted bricks in homogeneous deformation have no inner forces."""
    assert ladder.patch(law) < 1e-12


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_turning_a_growing_body_turns_its_forces(law: ConstitutiveLaw) -> None:
    assert ladder.rigid(law) < 1e-12


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_tangent_is_the_derivative_of_the_forces(law: ConstitutiveLaw) -> None:
    assert ladder.tangent(law) < 1e-8


def test_carried_stress_only_changes_the_geometric_stiffness() -> None:
    solid = ladder.unit_brick()
    u = np.random.default_rng(0).normal(scale=0.02, size=(20, 3))
    stress = entries.internal(LAWS[0], bricks_of(solid)[0], u, 0.0)[1]
    newton = ladder.stiffness_of(solid, LAWS[0], u)
    same = ladder.stiffness_of(solid, LAWS[0], u, carried=stress)
    other = ladder.stiffness_of(solid, LAWS[0], u, carried=stress + np.array([1, 1, 1, 0, 0, 0]))
    np.testing.assert_allclose(same, newton, atol=1e-12)
    change = (other - newton)[0].reshape(20, 3, 20, 3)
    # A unit carried stress adds the same scalar matrix to each displacement component.
    np.testing.assert_allclose(change[:, 0, :, 1], 0, atol=1e-12)
    np.testing.assert_allclose(change[:, 0, :, 0], change[:, 2, :, 2], atol=1e-12)
    assert abs(change[:, 0, :, 0]).max() > 0.1


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_the_carried_stress_is_that_of_the_next_state_to_first_order(law: ConstitutiveLaw) -> None:
    solid = ladder.unit_brick()
    bricks = bricks_of(solid)[0]
    rng = np.random.default_rng(0)
    u, step = rng.normal(scale=0.02, size=(2, 20, 3))
    errors = [
        abs(
            entries.carry(law, bricks, u, h * step, 0.0)
            - entries.internal(law, bricks, u + h * step, 0.0)[1]
        ).max()
        for h in (1e-2, 1e-3)
    ]
    assert errors[1] < errors[0] / 50


def test_volumes_add_up() -> None:
    bricks, load, mass = bricks_of(ladder.distorted())
    for volumes in (bricks.volumes, load, mass):
        assert volumes.sum() == pytest.approx(1.0, rel=1e-12)
    assert (mass > 0).all()
