"""Generating as a user does it: killed, interrupted, out of disk, on a cluster; nothing is lost."""

import json
import os
import random
import signal
import sys
import time
from pathlib import Path

import psutil
import pytest
from running import command

from simulearn.dataset import Config, cluster_workers, generate, local_workers, pack
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


def test_a_run_killed_five_times_packs_to_the_same_bytes(folder, small_file, tmp_path):
    moments = random.Random(3)
    kills = 0
    for _ in range(5):
        process = command("dataset", "generate", small_file, "-o", tmp_path / "killed")
        seen = len(trials(tmp_path / "killed"))
        if seen < 10:  # at a random moment after something was finished
            wait_for(seen + 1, tmp_path / "killed")
        time.sleep(moments.uniform(0, 0.3))
        process.kill()
        process.communicate()
        kills += process.returncode == -signal.SIGKILL
    assert kills == 5
    assert 5 <= len(trials(tmp_path / "killed")) <= 12
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
    told = json.loads(process.communicate()[0])
    assert (told["new"], told["failed"]) == (12, 0)
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


def test_no_scheduler_is_told_in_a_line(small, tmp_path):
    with pytest.raises(InputError, match="no Dask scheduler answers there"):
        generate(small, tmp_path / "set", cluster_workers("tcp://127.0.0.1:9"))


def test_the_key_depends_on_all_that_the_answer_depends_on(small: Config):
    def key(config: Config, k: int = 0) -> str:
        return TrialJob.of(config.design(k)[0], config).key

    finer = small.model_copy(update={"solver": small.solver.model_copy(update={"layers": 2})})
    more = small.model_copy(update={"trials": 99, "test_every": 0, "name": "other"})
    assert key(small) == key(more)
    assert len({key(small), key(small, 1), key(finer)}) == 3
    job = TrialJob.of(small.design(0)[0], small)
    heavier = json.loads(json.dumps(job.material))
    heavier["gravity"]["density"] = 1.0
    assert TrialJob(job.grid, heavier, job.solver).key != job.key


def test_a_broken_answer_is_an_answer(small: Config):
    job = TrialJob.of(small.design(0)[0], small)
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


def test_no_room_for_an_answer_is_told_with_what_is_kept(small, tmp_path, monkeypatch):
    def full(*_):
        raise InputError("x.npz: cannot be written (No space left on device)")

    monkeypatch.setattr(Folder, "keep", full)
    with pytest.raises(ComputationError, match=r"No space left on device.*0 trials are there"):
        generate(small, tmp_path / "set", local_workers(1))


def test_answers_travel(small: Config):
    import pickle

    job = TrialJob.of(small.design(0)[0], small)
    assert pickle.loads(pickle.dumps(job)) == job
    assert pickle.loads(pickle.dumps(TrialOutcome("failed", reason="so"))).reason == "so"
