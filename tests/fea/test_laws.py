"""Constitutive laws: derivatives of their energies, and true to the test they come from."""

import jax
import numpy as np
import pytest

import ladder
from simulearn.compiled import double_precision
from simulearn.fea.calculix.energy import energy
from simulearn.fea.kernels import checks
from simulearn.fea.kernels.law import ConstitutiveLaw
from simulearn.fea.laws import law_of, marlow, neo_hookean, st_venant_kirchhoff
from simulearn.material import ElasticData

LAWS = [law_of(ladder.PLA.law), neo_hookean(0.78, 3.9), st_venant_kirchhoff(3.4, 0.78)]
NAMES = ["Marlow", "neo-Hookean", "St Venant-Kirchhoff"]


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_stress_and_moduli_are_derivatives_of_the_energy(law: ConstitutiveLaw) -> None:
    """The judge is automatic differentiation of the energy alone."""

    def density(F: jax.Array) -> jax.Array:
        return energy(law, F)

    points = np.eye(3) + 0.15 * np.random.default_rng(0).normal(size=(20, 3, 3))
    P, S, A = checks.respond_at(law, points)
    slope = double_precision(jax.jit(jax.vmap(jax.grad(density))))
    curvature = double_precision(jax.jit(jax.vmap(jax.hessian(density))))
    np.testing.assert_allclose(P, slope(points), atol=1e-13)
    np.testing.assert_allclose(A.transpose(0, 1, 3, 2, 4), curvature(points), atol=1e-12)
    np.testing.assert_allclose(points @ S, P, atol=1e-13)


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_at_rest_there_is_no_stress(law: ConstitutiveLaw) -> None:
    P, _, _ = checks.respond_at(law, np.eye(3)[None])
    assert abs(P).max() < 1e-15


@pytest.mark.parametrize(
    "kind", ["neo-hookean", "st-venant-kirchhoff"], ids=["neo-Hookean", "St Venant-Kirchhoff"]
)
def test_small_tension_follows_young_and_poisson(kind: str) -> None:
    law = law_of(ElasticData(kind=kind, modulus=2.2, poisson=0.406))
    e = 1e-6
    F = np.diag([1 + e, 1 - 0.406 * e, 1 - 0.406 * e])
    P, _, _ = checks.respond_at(law, F[None])
    assert P[0, 0, 0] == pytest.approx(2.2 * e, rel=1e-4)
    assert abs(P[0, 1, 1]) < 1e-4 * 2.2 * e


def test_a_brick_in_tension_reproduces_the_material_table() -> None:
    law = law_of(ladder.PLA.law)
    for strain, stress in ladder.PLA.law.table:
        assert ladder.brick(law, 1 + strain) == pytest.approx(stress, rel=1e-3), strain


def test_marlow_goes_on_beyond_its_table_without_softening_to_nothing() -> None:
    law = law_of(ladder.PLA.law)
    forces = [ladder.brick(law, stretch) for stretch in (1.15, 1.2, 1.3, 1.45)]
    assert np.all(np.diff(forces) > 0)


def test_a_straight_table_gives_a_linear_law() -> None:
    data = ladder.PLA.law.model_copy(update={"table": ((0.01, 0.022), (0.02, 0.044))})
    assert ladder.brick(marlow(data), 1.005) == pytest.approx(0.011, rel=2e-3)
