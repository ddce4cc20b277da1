"""Batches on several threads."""

import subprocess
import sys

import numpy as np
from conformance import designs_like

from simulearn.grid import Rules
from simulearn.learn.common.bundle import bundle_of
from simulearn.learn.equilibrium import native

FACTORS = """
from concurrent.futures import ThreadPoolExecutor
import jax
import jax.numpy as jnp
from simulearn.mechanics.stiffness import cholesky

matrices = 60 * jnp.eye(54) + jnp.ones((16, 54, 54))
many = jax.jit(lambda x: jax.lax.fori_loop(0, 200, lambda _, y: x + 0 * jax.vmap(cholesky)(y), x))
with ThreadPoolExecutor(2) as pool:
    roots = list(pool.map(lambda _: many(matrices).block_until_ready(), range(20)))
assert all((x == matrices).all() for x in roots)
"""


def test_they_are_those_of_one(monkeypatch):
    model, designs = bundle_of("equilibrium").model, designs_like(Rules(), 22)
    frames = []
    for threads in (1, 3):
        monkeypatch.setattr(native, "cores", lambda n=threads: n)
        frames.append(model.rollout(designs))
    assert frames[0].converged.all()
    np.testing.assert_array_equal(frames[0].joints, frames[1].joints)
    np.testing.assert_array_equal(frames[0].stress, frames[1].stress)
    one = model.rollout(designs.take([17]))
    np.testing.assert_array_equal(one.joints[0], frames[0].joints[17])


def test_factors_of_many_do_not_wait_for_each_other():
    """Two batches of LAPACK's, each shared among JAX's threads, would for ever."""
    subprocess.run([sys.executable, "-c", FACTORS], check=True, timeout=120)
