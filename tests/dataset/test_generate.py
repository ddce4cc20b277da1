"""Generating as a user does it: killed, interrupted, out of disk, on a cluster; nothing is lost."""

import io
import json
import os
import random
import signal
import subprocess
import sys
import time
from concurrent.futures import Future
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import psutil
import pytest
from running import command

from simulearn.dataset import Config, cluster_workers, generate, local_workers, pack, workers
from simulearn.dataset.generate import Folder
from simulearn.dataset.trial import TrialJob, TrialOutcome, read_trial, run
from simulearn.errors import ComputationError, InputError

linux = pytest.mark.skipif(sys.platform != "linux", reason="sends signals as Linux has them")


def trials(path: Path) -> set[str]:
    """Return the finished ones; a file under way has a name that begins with a dot."""
    names = (file.name for file in (path / "trials").glob("*.npz"))
    return {name for name in names if not name.startswith(".")}


def wait_for(count: int, path: Path, seconds: float = 120) -> None:
    end = time.monotonic() + seconds
    while len(trials(path)) < count:
        assert time.monotonic() < end, "no trial in time"
        time.sleep(0.02)


def packed(path: Path, to: Path) -> bytes:
    pack(path, to)
    return to.read_bytes()


def test_a_run_killed_three_times_packs_to_the_same_bytes(folder, small_file, tmp_path):
    moments = random.Random(3)
    kills = 0
    for _ in range(3):
        process = command("dataset", "generate", small_file, "-o", tmp_path / "killed")
        seen = len(trials(tmp_path / "killed"))
        if seen < 10:  # at a random moment after something was finished
            wait_for(seen + 1, tmp_path / "killed")
        time.sleep(moments.uniform(0, 0.3))
        process.kill()
        process.communicate()
        kills += process.returncode == -signal.SIGKILL
    assert kills == 3
    assert 3 <= len(trials(tmp_path / "killed")) <= 12
    out = command("dataset", "generate", small_file, "-o", tmp_path / "killed").communicate()[0]
    assert "12 trials, 0 failed" in out
    assert not list((tmp_path / "killed").glob("*/.*"))
    assert packed(tmp_path / "killed", tmp_path / "a.h5") == packed(folder, tmp_path / "b.h5")


@linux
def test_workers_end_when_the_run_is_killed(small_file, tmp_path):
    process = command("dataset", "generate", small_file, "-o", tmp_path / "set")
    wait_for(1, tmp_path / "set")
    children = psutil.Process(process.pid).children(recursive=True)
    assert len(children) >= 2
    process.kill()
    process.communicate()
    assert psutil.wait_procs(children, timeout=10)[1] == []


@linux
def test_a_killed_worker_is_replaced_and_its_trial_done_again(folder, small_file, tmp_path):
    process = command("dataset", "generate", small_file, "-o", tmp_path / "set", "--json")
    wait_for(2, tmp_path / "set")
    workers = [
        child
        for child in psutil.Process(process.pid).children()
        if "spawn_main" in " ".join(child.cmdline())
    ]
    workers[0].kill()
    result = json.loads(process.communicate()[0])
    assert (result["new"], result["failed"]) == (12, 0)
    assert trials(tmp_path / "set") == trials(folder)


@linux
def test_ctrl_c_keeps_what_is_finished(small_file, tmp_path):
    process = command("dataset", "generate", small_file, "-o", tmp_path / "set")
    wait_for(1, tmp_path / "set")
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "the same command goes on" in err
    assert "Traceback" not in err
    assert trials(tmp_path / "set")


@linux
def test_a_full_disk_stops_the_run_and_loses_nothing(folder, small_file, tmp_path):
    sizes = sorted(file.stat().st_size for file in (folder / "trials").glob("*.npz"))
    between = (sizes[len(sizes) // 2] + sizes[-1]) // 2  # some trials fit, some do not

    words = ("dataset", "generate", small_file, "-o", tmp_path / "set")
    # A cache of compiled kernels has no room either, and is done without.
    process = command(*words)
    psutil.Process(process.pid).rlimit(psutil.RLIMIT_FSIZE, (between, between))
    _, err = process.communicate(timeout=120)
    assert process.returncode == 3, err
    assert "cannot be written (File too large)" in err
    assert "the same command goes on" in err
    kept = trials(tmp_path / "set")
    assert len(kept) < 12
    assert not list((tmp_path / "set").glob("*/.*"))
    assert not list((tmp_path / "set" / "failures").iterdir())
    for name in kept:
        read_trial(tmp_path / "set" / "trials" / name)
    assert "12 trials, 0 failed" in command(*words).communicate()[0]
    assert trials(tmp_path / "set") == trials(folder)


def test_failures_are_recorded_and_do_not_stop_the_run(small: Config, tmp_path):
    """With one iteration no increment converges, not even along the flow."""
    update = {"iterations": 1, "halvings": 0}
    hasty = small.model_copy(update={"solver": small.solver.model_copy(update=update), "trials": 3})
    tally = generate(hasty, tmp_path / "set", local_workers(2))
    assert (tally.done, tally.failed) == (0, 3)
    assert all("frame" in reason for reason in tally.reasons)
    records = [json.loads(f.read_text()) for f in (tmp_path / "set" / "failures").iterdir()]
    assert {f"trial {f['trial']}: {f['reason']}" for f in records} == set(tally.reasons)
    again = generate(hasty, tmp_path / "set", local_workers(2))
    assert (again.present, again.done, again.failed) == (3, 0, 3)


def test_a_hanging_trial_is_given_up(small: Config, tmp_path):
    two = small.model_copy(update={"trials": 2})
    tally = generate(two, tmp_path / "set", local_workers(2, longest=0.05))
    assert tally.failed == 2
    assert "took too long" in tally.reasons[0]
    # It is no fault of the designs: the next run tries again.
    assert generate(two, tmp_path / "set", local_workers(2)).done == 2


def test_a_cluster_of_which_a_worker_is_killed_makes_the_same_files(folder, small, tmp_path):
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster:
        pids = [worker.pid for worker in cluster.workers.values()]
        killed = []

        def kill_one(tally):
            if tally.done == 3 and not killed:
                child = psutil.Process(pids[0])
                child.kill()
                killed.append(child.pid)

        team = cluster_workers(cluster.scheduler_address)
        tally = generate(small, tmp_path / "set", team, kill_one)
    assert killed
    assert (tally.done, tally.failed) == (12, 0)
    assert trials(tmp_path / "set") == trials(folder)
    assert packed(tmp_path / "set", tmp_path / "a.h5") == packed(folder, tmp_path / "b.h5")


def test_no_scheduler_is_reported_in_a_line(small, tmp_path):
    with pytest.raises(InputError, match="no Dask scheduler answers there"):
        generate(small, tmp_path / "set", cluster_workers("tcp://127.0.0.1:9"))


@pytest.mark.parametrize(
    "address", ["", "foo", "tcp://", "127.0.0.1", "tcp://127.0.0.1:port", "tcp://nohost.invalid:1"]
)
def test_an_address_that_is_none_is_reported_in_a_line(address):
    with (
        pytest.raises(InputError, match="an address is as tcp://host:8786"),
        cluster_workers(address),
    ):
        pass


class Client:
    """Stands in for that of a scheduler."""

    status = "running"

    def __init__(self, *_args, **_more):
        self.threads = {"a": 1}
        self.versions = {"a": workers._version()()}

    def get_executor(self, pure):
        return self

    def nthreads(self):
        return self.threads

    def run(self, version, on_error):
        return self.versions

    def close(self, timeout):
        pass


@pytest.fixture
def client(monkeypatch):
    distributed = pytest.importorskip("distributed")
    client = Client()
    monkeypatch.setattr(distributed, "Client", lambda *_, **__: client)
    monkeypatch.setattr(workers, "_knock", lambda address: None)
    return client


def message(waiting=0.0):
    with pytest.raises(ComputationError) as error, cluster_workers("tcp://here:1", waiting) as team:
        team.check()
    return f"{error.value}; {error.value.hint}"


def test_a_scheduler_without_workers_is_not_waited_for_without_end(client):
    client.threads = {}
    assert "has had no workers for 0 s; start some: dask worker tcp://here:1" in message()


def test_workers_that_leave_are_not_waited_for_without_end(client):
    with cluster_workers("tcp://here:1", 0.0) as team:
        assert team.count() == 1
        client.threads = {}
        with pytest.raises(ComputationError, match="has had no workers"):
            team.check()


@pytest.mark.parametrize(
    ("version", "words"),
    [
        ("0.0.9, solver 1", "0.0.9, solver 1; this machine has"),
        (ModuleNotFoundError("no"), "no SimuLearn"),
    ],
)
def test_workers_of_another_version_are_reported(client, version, words):
    client.versions["b"] = version
    assert "the worker b has " in (line := message())
    assert words in line


def test_a_scheduler_that_dies_is_reported(client, small, tmp_path, monkeypatch):
    monkeypatch.setattr(workers, "run", None)

    def submit(*_):
        client.status = "closed"
        future = Future()
        future.cancel()
        return future

    client.submit = submit
    with pytest.raises(ComputationError, match="answers no more") as error:
        generate(small, tmp_path / "set", cluster_workers("tcp://here:1"))
    assert "the same command goes on" in error.value.hint


@pytest.mark.parametrize("words", [[], ["-"]])
def test_a_script_without_a_guard_generates(tmp_path, small_file, words):
    script = tmp_path / "script.py"
    lines = (
        "from simulearn.dataset import generate, local_workers, read_config",
        f"config = read_config({str(small_file)!r}).model_copy(update={{'trials': 1}})",
        "print('begun')",
        "print(generate(config, 'set', local_workers(1)).done)",
    )
    script.write_text("\n".join(lines), "utf-8")
    done = subprocess.run(
        [sys.executable, *(words or [str(script)])],
        input=script.read_text("utf-8") if words else "",
        capture_output=True, text=True, cwd=tmp_path, timeout=120, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stdout, done.stderr) == (0, "begun\n1\n", "")


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), OSError("odd")])
def test_processes_that_cannot_be_started_are_reported(monkeypatch, error):
    import pebble

    def refuse(*_args, **_more):
        raise error

    monkeypatch.setattr(pebble, "ProcessPool", refuse)
    with pytest.raises(ComputationError, match="worker processes cannot be started"):
        local_workers(2).__enter__()


def test_the_command_uses_the_processors_that_it_may(run, monkeypatch, tmp_path, small_file):
    counts = []

    def team(count):
        counts.append(count)
        raise ComputationError("enough")

    monkeypatch.setattr("simulearn.cli.dataset.cores", lambda: 1)
    monkeypatch.setattr("simulearn.dataset.local_workers", team)
    run("dataset", "generate", small_file, "-o", tmp_path / "set")
    assert counts == [1]


def answering(job):
    """Return what a worker would, without computing."""
    buffer = io.BytesIO()
    numbers = {name: np.float64(0) for name in ("joints", "beams", "stress", "seconds")}
    np.savez(buffer, grid=json.dumps(job.grid), record="{}", **numbers)
    future = Future()
    future.set_result(TrialOutcome("done", buffer.getvalue()))
    return future


@contextmanager
def team():
    yield workers.Workers(answering, lambda: 1)


@pytest.mark.parametrize("cut", [0, 100, -1])
def test_a_torn_trial_is_made_anew_and_reported(small, tmp_path, cut):
    generate(small, tmp_path / "set", team())
    path = min((tmp_path / "set" / "trials").glob("*.npz"))
    whole = path.read_bytes()
    path.write_bytes(whole[:cut])
    with pytest.raises(InputError, match="1 of 12 trials are not there yet, or are torn"):
        pack(tmp_path / "set", tmp_path / "set.h5")
    tally = generate(small, tmp_path / "set", team())
    assert (tally.present, tally.done, tally.torn) == (11, 1, 1)
    assert path.read_bytes() == whole


@pytest.mark.parametrize("content", ["", "{", "[1]", "{}", "null"])
def test_an_odd_file_among_the_failures_is_made_anew_and_reported(small, tmp_path, content):
    folder = Folder(tmp_path / "set", small)
    key = TrialJob.of(small.design(3), small).key
    folder.failure(key).write_text(content, "utf-8")
    (tmp_path / "set" / "failures" / "notes.json").write_text(content, "utf-8")
    folder.forget_failures()
    tally = generate(small, tmp_path / "set", team())
    assert (tally.done, tally.torn) == (12, 1)
    assert (tmp_path / "set" / "failures" / "notes.json").exists()


def test_a_torn_description_says_how_to_go_on(small, tmp_path):
    generate(small, tmp_path / "set", team())
    (tmp_path / "set" / "config.json").write_text("", "utf-8")
    with pytest.raises(InputError, match=r"config\.json: is damaged .*; delete it"):
        generate(small, tmp_path / "set", team())


def test_the_key_depends_on_all_that_the_answer_depends_on(small: Config):
    def key(config: Config, k: int = 0) -> str:
        return TrialJob.of(config.design(k), config).key

    finer = small.model_copy(update={"solver": small.solver.model_copy(update={"layers": 2})})
    more = small.model_copy(update={"trials": 99, "test_every": 0, "name": "other"})
    assert key(small) == key(more)
    assert len({key(small), key(small, 1), key(finer)}) == 3
    job = TrialJob.of(small.design(0), small)
    heavier = json.loads(json.dumps(job.material))
    heavier["gravity"]["density"] = 1.0
    assert TrialJob(job.grid, heavier, job.solver).key != job.key


def test_a_broken_answer_is_an_answer(small: Config):
    job = TrialJob.of(small.design(0), small)
    answer = run(TrialJob(job.grid, {}, job.solver))
    assert answer.outcome == "broken"
    assert "ValidationError" in answer.reason


def test_another_set_is_not_written_into_a_folder(small: Config, tmp_path):
    Folder(tmp_path, small)
    other = small.model_copy(update={"seed": 8})
    with pytest.raises(InputError, match=r"holds another data set \(seed is 8, was 7\)"):
        Folder(tmp_path, other)
    Folder(tmp_path, small.model_copy(update={"trials": 20}))  # more of the same goes on


def test_a_folder_that_cannot_be_made(small: Config, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be made"):
        Folder(tmp_path / "file" / "set", small)


def test_no_room_for_an_answer_is_reported_with_what_is_kept(small, tmp_path, monkeypatch):
    def full(*_):
        raise InputError("x.npz: cannot be written (No space left on device)")

    monkeypatch.setattr(Folder, "keep", full)
    with pytest.raises(ComputationError, match=r"No space left on device.*0 trials are there"):
        generate(small, tmp_path / "set", local_workers(1))


def test_answers_travel(small: Config):
    import pickle

    job = TrialJob.of(small.design(0), small)
    assert pickle.loads(pickle.dumps(job)) == job
    assert pickle.loads(pickle.dumps(TrialOutcome("failed", reason="so"))).reason == "so"
