"""Constitutive laws: derivatives of their energies, and true to the test they come from."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import ladder
from simulearn.fea.laws import Law, Marlow, NeoHookean, StVenantKirchhoff, law_of
from simulearn.material import ElasticData

LAWS = [law_of(ladder.PLA.law), NeoHookean(0.78, 3.9), StVenantKirchhoff(3.4, 0.78)]
NAMES = [type(law).__name__ for law in LAWS]


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_stress_and_moduli_are_derivatives_of_the_energy(law: Law) -> None:
    F = jnp.eye(3)[:, :, None] + 0.15 * jax.random.normal(jax.random.key(0), (3, 3, 20))
    P, A = law.response(F)
    for k in range(F.shape[-1]):
        energy = lambda f: law.energy(f[:, :, None])[0]  # noqa: E731
        np.testing.assert_allclose(P[..., k], jax.grad(energy)(F[..., k]), atol=1e-13)
        np.testing.assert_allclose(A[..., k], jax.hessian(energy)(F[..., k]), atol=1e-12)


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_at_rest_there_is_no_stress(law: Law) -> None:
    P, _ = law.response(jnp.eye(3)[:, :, None])
    assert abs(P).max() < 1e-15


@pytest.mark.parametrize(
    "kind", ["neo-hookean", "st-venant-kirchhoff"], ids=["neo-Hookean", "St Venant-Kirchhoff"]
)
def test_small_tension_follows_young_and_poisson(kind: str) -> None:
    law = law_of(ElasticData(kind=kind, modulus=2.2, poisson=0.406))
    e = 1e-6
    F = jnp.diag(jnp.array([1 + e, 1 - 0.406 * e, 1 - 0.406 * e]))[:, :, None]
    P, _ = law.response(F)
    assert P[0, 0, 0] == pytest.approx(2.2 * e, rel=1e-4)
    assert abs(P[1, 1, 0]) < 1e-4 * 2.2 * e


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
    law = Marlow.fit(data)
    assert ladder.brick(law, 1.005) == pytest.approx(0.011, rel=2e-3)
