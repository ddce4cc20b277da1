"""Kernels in memory make room for others before the system refuses more."""

import os
import subprocess
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


def test_where_maps_cannot_be_counted_many_kernels_are_forgotten(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    class Nowhere:
        def __init__(self, path: str) -> None:
            pass

        def open(self, mode: str) -> None:
            raise FileNotFoundError

    cleared = []
    monkeypatch.setattr(compiled, "Path", Nowhere)
    monkeypatch.setattr(compiled.jax, "clear_caches", lambda: cleared.append(True))
    monkeypatch.setattr(compiled._made, "uncounted", 0)
    for made in (compiled.MANY, 1, compiled.AFTER):
        monkeypatch.setattr(compiled._made, "kernels", made)
        compiled.make_room()
    assert cleared == [True]  # after more than MANY, once


def test_importing_leaves_jax_as_it_was() -> None:
    code = (
        "import jax; import simulearn.learn.run, simulearn.learn.equilibrium.slopes; "
        "assert not jax.config.jax_enable_x64; "
        "assert not jax.config.jax_compilation_cache_dir"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120, env=clean())


def clean() -> dict[str, str]:
    return {k: v for k, v in os.environ.items() if not k.startswith("JAX_")}
