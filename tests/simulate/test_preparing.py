"""Kernels are prepared once, by two processes where that helps, and by one where it cannot be."""

import subprocess
import sys

import numpy as np
import pytest

from simulearn.learn.equilibrium.native import predict, unsolved
from simulearn.native import is_kept
from simulearn.simulate import engine, preparing


class Model:
    """Counts its rollouts."""

    def __init__(self):
        self.rollouts = 0

    def rollout(self, designs):
        self.rollouts += len(designs)


@pytest.fixture
def model(monkeypatch):
    own = Model()
    monkeypatch.setattr(preparing, "_model", lambda: own)
    monkeypatch.setattr(preparing, "_small", lambda: [0])
    monkeypatch.setattr(preparing, "_all_kept", lambda: False)
    preparing._prepare.cache_clear()
    yield own
    preparing._prepare.cache_clear()


def test_other_models_need_no_kernels(model):
    preparing.prepare(model)
    assert model.rollouts == 0


def test_nothing_is_begun_where_all_is_kept(model, monkeypatch):
    monkeypatch.setattr(preparing, "_all_kept", lambda: True)
    monkeypatch.setattr(preparing, "_begun", lambda: pytest.fail("begun"))
    preparing._prepare()
    assert model.rollouts == 0


def test_it_waits_for_the_other_process(model, monkeypatch, tmp_path):
    mark = tmp_path / "mark"
    program = f"import time, pathlib; time.sleep(0.3); pathlib.Path({str(mark)!r}).touch()"
    other = subprocess.Popen([sys.executable, "-c", program])
    monkeypatch.setattr(preparing, "_begun", lambda: other)
    preparing._prepare()
    preparing._prepare()
    assert model.rollouts == 1
    assert mark.exists()


def test_it_does_not_wait_for_ever(model, monkeypatch):
    other = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])
    monkeypatch.setattr(preparing, "_begun", lambda: other)
    monkeypatch.setattr(preparing, "LONGEST", 0.1)
    preparing._prepare()
    assert other.poll() is not None


def test_an_interrupt_ends_the_other_process(model, monkeypatch):
    other = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])

    def interrupted(designs):
        raise KeyboardInterrupt

    monkeypatch.setattr(preparing, "_begun", lambda: other)
    monkeypatch.setattr(model, "rollout", interrupted)
    with pytest.raises(KeyboardInterrupt):
        preparing._prepare()
    assert other.poll() is not None


def test_one_process_does_where_there_is_no_other(model, monkeypatch):
    def refused(*_, **__):
        raise OSError

    monkeypatch.setattr(preparing, "cores", lambda: 2)
    monkeypatch.setattr(preparing.subprocess, "Popen", refused)
    preparing._prepare()
    assert model.rollouts == 1


def test_no_other_program_is_started_in_place_of_python(monkeypatch):
    monkeypatch.setattr(preparing, "cores", lambda: 2)
    monkeypatch.setattr(preparing.subprocess, "Popen", lambda *_, **__: pytest.fail("started"))
    for name in ("C:/Program Files/Rhino 8/Rhino.exe", "", None):
        monkeypatch.setattr(sys, "executable", name)
        assert preparing._begun() is None
    monkeypatch.setattr(sys, "executable", "/usr/bin/python3")
    monkeypatch.setattr(preparing, "cores", lambda: 1)
    assert preparing._begun() is None


def test_the_rest_needs_no_equilibrium():
    preparing.rest()
    small = preparing._small()
    frames = predict(preparing._model().parameters, small, solve=unsolved)
    assert np.ptp(frames.joints[0, ..., 2], axis=(1, 2)).max() < 4.5  # flat in all frames


def test_what_a_process_compiled_is_kept():
    from simulearn.mechanics.kernels.path import follow

    engine("learned").warm()
    assert is_kept(follow)
