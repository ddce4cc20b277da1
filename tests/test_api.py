"""The package as a program uses it: names, typing, and no trace in the host process."""

import subprocess
import sys
import threading
from importlib.resources import files

import numpy as np
import pytest

import simulearn
import synthetic
from simulearn import Failure, Grid, InputError, Result, make, simulate, validate
from simulearn.simulate import ENGINES
from simulearn.simulate.engines import Engine


@pytest.fixture
def solved(monkeypatch):
    """Let a formula stand in for finite elements; return the grids that it simulated."""
    grids = []

    def solver(grid, material, progress, cancel):
        grids.append(grid)
        return synthetic.result(grid)

    monkeypatch.setitem(ENGINES, "fea", lambda: Engine("fea", solver))
    return grids


def python(code):
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.usefixtures("solved")
def test_one_grid_has_a_result_and_many_have_outcomes():
    assert isinstance(simulate(make("saddle")), Result)
    small = make("saddle", length=10.0)
    good, bad = simulate([make("saddle"), small])
    assert isinstance(good, Result)
    assert isinstance(bad, Failure)
    with pytest.raises(InputError) as error:
        simulate(small)
    assert error.value.code == bad.code
    assert error.value.messages == validate(small).errors


def test_names_are_there_whatever_was_imported_before():
    names = "Grid, simulate, validate, rank, optimize, warm, Result, Failure"
    for first in ("", "import simulearn.simulate", "from simulearn.simulate import engine"):
        out = python(f"{first}\nfrom simulearn import {names}\nprint(callable(simulate))")
        assert out == "True\n"
    assert set(simulearn.__all__) <= set(dir(simulearn))
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        simulearn.nothing  # noqa: B018


def test_importing_changes_nothing_in_the_host():
    code = """
import os, signal, sys, threading, warnings
import numpy as np, matplotlib as mpl, jax, scipy.special, scipy.sparse
def state():
    umask = os.umask(0); os.umask(umask)
    return (dict(os.environ), umask, dict(mpl.rcParams), np.geterr(), np.get_printoptions(),
            jax.config.jax_enable_x64, jax.config.jax_compilation_cache_dir, len(warnings.filters),
            threading.active_count(), signal.getsignal(signal.SIGINT))
before = state()
from simulearn import Grid, Result, optimize, rank, simulate, validate, warm
import simulearn.simulate.learned, simulearn.fea, simulearn.show, simulearn.interop
assert state() == before
"""
    python(code)
    quick = "import sys, simulearn; print(len({'numpy', 'jax', 'pydantic'} & set(sys.modules)))"
    assert python(quick) == "0\n"


def test_engines_may_be_called_from_several_threads(solved):
    grids = [make("saddle"), make("cone"), make("flat", (1, 1)), make("flat", (1, 2))]
    answers, barrier = {}, threading.Barrier(4)

    def call(k):
        barrier.wait()
        answers[k] = simulate([*grids[k:], *grids[:k]])

    threads = [threading.Thread(target=call, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(solved) == 16
    for k, outcomes in answers.items():
        for grid, outcome in zip([*grids[k:], *grids[:k]], outcomes, strict=True):
            np.testing.assert_array_equal(outcome.grid.joints, grid.centred.joints)


def test_the_package_is_typed():
    assert (files("simulearn") / "py.typed").is_file()
    assert Grid is simulearn.Grid
