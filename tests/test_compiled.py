"""Kernels in memory make room for others before the system refuses more."""

import sys
from pathlib import Path

import jax
import jax.numpy as jnp
import pytest

from simulearn import compiled


def maps() -> int:
    return len(Path("/proc/self/maps").read_text().splitlines())


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux has such a limit")
def test_many_kernels_are_forgotten_and_made_again(monkeypatch: pytest.MonkeyPatch) -> None:
    jax.clear_caches()
    times = [jax.jit(lambda x, k=k: x * k) for k in range(2 * compiled.AFTER)]
    answers = [float(f(jnp.array(3.0))) for f in times]
    many = maps()
    compiled.make_room()
    assert maps() == many  # there is room
    monkeypatch.setattr(compiled, "MAPS", many - 1)
    compiled.make_room()
    assert maps() == many  # nothing was made since: not even counted
    for f in times:
        f(jnp.ones(5))
    compiled.make_room()
    assert maps() < many
    assert [float(f(jnp.array(3.0))) for f in times] == answers


def test_other_events_are_not_kernels() -> None:
    made = compiled._Made()
    made("/jax/core/compile/backend_compile_duration", 0.1)
    made("/jax/core/compile/jaxpr_trace_duration", 0.1, fun_name="f")
    assert made.kernels == 1
