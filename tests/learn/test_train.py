"""Training: it learns, a stopped run goes on bit for bit, and what is wrong is reported."""

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pytest

from simulearn.errors import ComputationError, InputError
from simulearn.learn.common import checkpoint
from simulearn.learn.common.trials import split
from simulearn.learn.config import config_of, read_config, shipped
from simulearn.learn.paper.config import Phase
from simulearn.learn.paper.train import train


@pytest.fixture(scope="module")
def trained(small, sample):
    return train(small, sample)


class StoppedError(Exception):
    pass


def same(a, b):
    first, second = a.to_arrays(), b.to_arrays()
    assert first.keys() == second.keys()
    for name in first:
        np.testing.assert_array_equal(first[name], second[name])


def test_every_shipped_configuration_can_be_read():
    assert "paper" in shipped()
    for name in shipped():
        assert read_config(name).name == name


def test_the_loss_falls(trained):
    rows = trained[1]
    assert rows[-1].unroll == 10
    assert rows[-1].loss < 0.8 * rows[0].loss
    assert rows[-1].validation_percent < rows[0].validation_percent


def test_a_stopped_run_goes_on_bit_for_bit(trained, small, sample, tmp_path):
    path = tmp_path / "checkpoint.safetensors"

    def stop(row, done, total):
        if row is not None and row.epoch == 2:
            raise StoppedError

    with pytest.raises(StoppedError):
        train(small, sample, path, stop)
    model, rows = train(small, sample, path)
    same(model, trained[0])
    assert [row.loss for row in rows] == [row.loss for row in trained[1]]
    again, _ = train(small, sample, path)  # a finished run has nothing left to do
    same(again, model)


def test_a_checkpoint_of_another_run_is_refused(small, sample, tmp_path):
    path = tmp_path / "checkpoint.safetensors"
    short = small.model_copy(update={"phases": [Phase(epochs=1, unroll=10, batch=6)]})
    train(short, sample, path)
    with pytest.raises(InputError, match="is of another run"):
        train(small, sample, path)
    with pytest.raises(InputError, match="is of another run"):
        train(short, replace(sample, sha256="other"), path)
    path.write_bytes(b"nothing of the kind")
    with pytest.raises(InputError, match="is not a checkpoint"):
        train(short, sample, path)


def test_a_checkpoint_of_other_shapes_is_refused(tmp_path):
    path = tmp_path / "some.safetensors"
    checkpoint.save(path, [np.zeros(3), np.ones((2, 2))], {"note": 1})
    assert checkpoint.header(path) == {"note": 1}
    back = checkpoint.load(path, [np.zeros(3), np.zeros((2, 2))])
    np.testing.assert_array_equal(back[1], 1)
    with pytest.raises(InputError, match="another architecture"):
        checkpoint.load(path, [np.zeros(3), np.zeros((2, 3))])


def test_trials_set_aside_are_not_learnt_from_and_tests_not_looked_at(small, sample):
    learnt, aside = split(small, sample)
    numbers = [set(np.concatenate([b.numbers for b in part]).tolist()) for part in (learnt, aside)]
    assert len(numbers[1]) == small.validation
    assert not numbers[0] & numbers[1]
    tests = {int(n) for b in sample.batches for n in b.numbers[b.test]}
    assert tests
    assert not tests & (numbers[0] | numbers[1])
    fewer = small.model_copy(update={"trials": 10})
    assert sum(len(b) for part in split(fewer, sample) for b in part) == 10


def test_too_few_trials_are_reported(small, sample):
    with pytest.raises(InputError, match="takes at least 80"):
        split(small.model_copy(update={"validation": 40}), sample)


def test_a_loss_that_is_not_finite_is_reported(small, sample):
    wild = small.model_copy(update={"rate": 1e30, "clip": 1e30})
    with pytest.raises(ComputationError, match="lower rate"):
        train(wild, sample)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"rate": 0}, "rate"),
        ({"phases": []}, "phases"),
        ({"colour": 1}, "colour"),
        ({"phases": [{"epochs": 1, "unroll": 3}]}, "phases.0.unroll"),
        ({"kind": "other"}, "kind"),
    ],
)
def test_a_wrong_configuration_names_its_key(small, change, message):
    with pytest.raises(InputError, match=f"here: {message}"):
        config_of({**small.model_dump(mode="json"), **change}, "here")
    with pytest.raises(InputError, match="neither a file nor one of"):
        read_config("nothing")


def test_ctrl_c_leaves_a_run_that_goes_on(small, sample_file, tmp_path):
    settings = small.model_dump(mode="json")
    settings["phases"] = [{"epochs": 500, "unroll": 10, "noise": 0.0, "batch": 6}]
    config, folder = tmp_path / "run.toml", tmp_path / "run"
    config.write_text(toml(settings), encoding="utf-8")
    command = [sys.executable, "-m", "simulearn.cli", "train", str(config), "-o", str(folder)]
    process = subprocess.Popen(
        command, stderr=subprocess.PIPE, text=True, start_new_session=True, env={**os.environ}
    )
    deadline = time.monotonic() + 400  # compiling takes long beside other work
    while not (folder / "loss.csv").exists() and time.monotonic() < deadline:
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    assert "the same command goes on" in process.communicate(timeout=300)[1]
    assert process.returncode == 130
    rows = checkpoint.header(folder / "checkpoint.safetensors")["rows"]
    assert 1 <= len(rows) < 500
    assert not list(folder.glob(".*"))


def toml(data):
    """Plain data as TOML: numbers, texts, lists and tables are all there are."""
    lines = [f"{k} = {json.dumps(v)}" for k, v in data.items() if not tables(v)]
    for key, value in data.items():
        for table in [value] if isinstance(value, dict) else value if tables(value) else []:
            lines.append(f"[{key}]" if isinstance(value, dict) else f"[[{key}]]")
            lines += [f"{k} = {json.dumps(v)}" for k, v in table.items()]
    return "\n".join(lines) + "\n"


def tables(value):
    return isinstance(value, dict) or (isinstance(value, list) and isinstance(value[0], dict))
