"""Jobs: how many run and wait, how they end, and what the server answers about them."""

import json
import threading
import time

import pytest
from asking import Client, problem

import synthetic
from simulearn.errors import CancelledError, ComputationError, InputError
from simulearn.grid import grid_from_dict, grid_to_dict, make
from simulearn.inverse import task_from_dict
from simulearn.simulate import ENGINES
from simulearn.simulate.engines import Engine
from simulearn.studio import simulations
from simulearn.studio.jobs import ABANDONED, KEPT_JOBS, KEPT_SECONDS, Answer, Jobs
from simulearn.studio.problems import Problem
from simulearn.studio.settings import Settings

SADDLE = grid_to_dict(make("saddle"))
GOAL = {"vertex": ["joint", 0, "centre"], "target": [-60, -60, 12], "weight": 1}
TASK = {
    "schema": "simulearn.task/1",
    "grid": SADDLE,
    "goals": [GOAL],
    "free": {"joints": []},
    "method": "brute-force",
    "limits": {"iterations": 3, "seconds": 20, "corrections": 0},
}
NOTHING = Answer(b"{}")
NEVER = 10**9
SOON = 20.0  # s, far more than anything here takes


class Clock:
    def __init__(self):
        self.time = 0.0

    def __call__(self):
        return self.time


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def make_jobs(clock):
    """Return a function that makes a service; what runs there is stopped after the test."""
    made = []

    def make_jobs(**limits):
        settings = Settings(**({"job_workers": 1, "jobs_waiting": 2, "job_seconds": 10.0} | limits))
        made.append(Jobs(settings, clock))
        return made[-1]

    yield make_jobs
    for jobs in made:
        for thread in jobs.close():
            thread.join(SOON)
            assert not thread.is_alive()


def until(condition):
    deadline = time.monotonic() + SOON
    while not condition():
        assert time.monotonic() < deadline, "it never came"
        time.sleep(0.005)


class Held:
    """Work that goes on until it is released or stopped."""

    def __init__(self, partial=None):
        self.begun, self.release, self.partial = threading.Event(), threading.Event(), partial

    def __call__(self, job):
        self.begun.set()
        while not self.release.is_set():
            if job.is_set():
                if self.partial is not None:
                    return Answer(self.partial, partial=True)
                raise CancelledError("stopped")
            time.sleep(0.002)
        return NOTHING


def test_so_many_run_so_many_wait_and_more_are_refused(make_jobs):
    jobs, works = make_jobs(), [Held() for _ in range(4)]
    started = [jobs.start("fea", work) for work in works[:3]]
    assert works[0].begun.wait(SOON)
    with pytest.raises(Problem) as refused:
        jobs.start("fea", works[3])
    assert (refused.value.status_code, refused.value.code) == (429, "too-many-jobs")
    assert int(refused.value.headers["Retry-After"]) > 0
    assert [job.state for job in started] == ["running", "queued", "queued"]
    for work in works[:3]:
        work.release.set()
    until(lambda: all(job.state == "done" for job in started))
    again = jobs.start("fea", lambda job: NOTHING)
    until(lambda: again.state == "done")


def test_names_cannot_be_guessed(make_jobs):
    jobs = make_jobs(jobs_waiting=50)
    names = {jobs.start("fea", lambda job: NOTHING).id for _ in range(20)}
    assert len(names) == 20
    assert min(map(len, names)) >= 22
    with pytest.raises(Problem) as unknown:
        jobs.get("a" * 22)
    assert (unknown.value.status_code, unknown.value.code) == (404, "job-unknown")


def test_a_job_is_cancelled_while_it_runs_and_while_it_waits(make_jobs):
    jobs, running = make_jobs(), Held()
    first, second = jobs.start("fea", running), jobs.start("fea", Held())
    assert running.begun.wait(SOON)
    jobs.cancel(second.id)
    assert second.state == "cancelled"
    assert second.took == 0
    jobs.cancel(first.id)
    until(lambda: first.state == "cancelled")
    assert first.answer is None
    assert first.problem is None


def test_a_job_whose_time_is_over_has_failed_unless_it_came_to_something(make_jobs, clock):
    jobs, plain, search = make_jobs(), Held(), Held(partial=b'{"best": 1}')
    job = jobs.start("fea", plain)
    assert plain.begun.wait(SOON)
    clock.time = 10.5
    until(lambda: job.finished)
    assert (job.state, job.problem.code) == ("failed", "time-over")
    assert "10 s" in job.problem.detail
    job = jobs.start("optimize", search)
    assert search.begun.wait(SOON)
    clock.time = 30.0
    until(lambda: job.finished)
    assert (job.state, job.answer.result) == ("done", b'{"best": 1}')


def test_a_search_that_is_cancelled_keeps_its_best(make_jobs):
    jobs, search = make_jobs(), Held(partial=b'{"best": 1}')
    job = jobs.start("optimize", search)
    assert search.begun.wait(SOON)
    jobs.cancel(job.id)
    until(lambda: job.finished)
    assert (job.state, job.answer.result) == ("cancelled", b'{"best": 1}')


def test_a_job_that_nobody_asks_about_is_cancelled(make_jobs, clock):
    jobs, work = make_jobs(job_seconds=1e6), Held()
    job = jobs.start("fea", work)
    assert work.begun.wait(SOON)
    clock.time = 0.9 * ABANDONED
    jobs.get(job.id)
    clock.time = 1.8 * ABANDONED
    assert not job.is_set()
    clock.time = 2.0 * ABANDONED
    until(lambda: job.state == "cancelled")


@pytest.mark.parametrize(
    ("error", "status", "code"),
    [
        (InputError("no such beam", "beam-index", "beam 3"), 422, "beam-index"),
        (ComputationError("no equilibrium", "no-answer", "frame 3"), 422, "no-answer"),
        (ZeroDivisionError("a secret"), 500, "internal"),
    ],
)  # fmt: skip
def test_a_failure_is_a_problem_and_does_not_end_the_others(make_jobs, error, status, code, caplog):
    def work(job):
        raise error

    jobs = make_jobs()
    failed, after = jobs.start("fea", work), jobs.start("fea", lambda job: NOTHING)
    until(lambda: after.state == "done")
    assert (failed.state, failed.problem.status_code, failed.problem.code) == (
        "failed",
        status,
        code,
    )
    assert "secret" not in failed.problem.detail


def test_finished_jobs_are_kept_for_an_hour_and_not_without_end(make_jobs, clock):
    jobs = make_jobs(jobs_waiting=2 * KEPT_JOBS)
    every = [jobs.start("fea", lambda job: NOTHING) for _ in range(KEPT_JOBS + 5)]
    until(lambda: all(job.finished for job in every))
    clock.time = 1.0
    jobs.get(every[-1].id)
    for job in every[:5]:
        with pytest.raises(Problem):
            jobs.get(job.id)
    clock.time = KEPT_SECONDS + 2
    with pytest.raises(Problem):
        jobs.get(every[-1].id)


def test_the_end_of_the_server_stops_all(make_jobs):
    jobs, work = make_jobs(), Held()
    first, second = jobs.start("fea", work), jobs.start("fea", Held())
    assert work.begun.wait(SOON)
    for thread in jobs.close():
        thread.join(SOON)
    assert [first.state, second.state] == ["cancelled", "cancelled"]


class Hold:
    """How many designs the engines solve before they stop at their first frame."""

    solved, most = 0, NEVER


@pytest.fixture
def engines(monkeypatch):
    """Let formulas stand in for the engines; return what holds them up."""
    hold = Hold()

    def solver(grid, material, progress, cancel):
        hold.solved += 1
        for frame in range(12):
            progress(frame + 1, 12)
            while hold.solved > hold.most:
                if cancel is not None and cancel.is_set():
                    raise CancelledError("stopped")
                time.sleep(0.002)
        return synthetic.result(grid)

    for name in ("learned", "fea"):
        monkeypatch.setitem(ENGINES, name, lambda name=name: Engine(name, solver, workers=1))
    fine = Engine("fea", solver, workers=1)  # by which searches are checked
    monkeypatch.setattr("simulearn.simulate.engines._fea", lambda mesh: fine)
    simulations._engine.cache_clear()
    yield hold
    hold.most = NEVER
    simulations._engine.cache_clear()


def finished(client, name):
    """Return the last answer about a job, and all of its steps."""
    steps = []
    deadline = time.monotonic() + 3 * SOON
    while time.monotonic() < deadline:
        answer = client.get(f"/api/jobs/{name}", params={"since": len(steps)}).json()
        steps += answer["steps"]
        if answer["state"] not in ("queued", "running"):
            return answer, steps
        time.sleep(0.02)
    raise AssertionError("the job never ended")


def test_a_check_by_finite_elements(engines):
    client = Client(Settings())
    invalid = SADDLE | {"actuators": [1.0, *SADDLE["actuators"][1:]], "joints": [[0, 0]] * 9}
    begun = client.post("/api/fea", {"grids": [SADDLE, invalid]})
    assert begun.status_code == 202
    name = begun.json()["job"]
    assert begun.headers["location"] == f"/api/jobs/{name}"
    answer, steps = finished(client, name)
    assert (answer["job"], answer["kind"], answer["state"]) == (name, "fea", "done")
    assert (answer["progress"], steps) == ({"done": 12, "total": 12}, [])
    good, bad = answer["result"]["results"]
    assert (good["schema"], good["engine"]) == ("simulearn.result/1", "fea")
    assert (bad["schema"], bad["code"]) == ("simulearn.failure/1", "joints-coincide")
    frames = client.get(f"/api/jobs/{name}/frames")
    assert frames.headers["content-type"] == "application/vnd.simulearn.frames"
    header = json.loads(frames.content[8 : 8 + int.from_bytes(frames.content[4:8], "little")])
    assert [entry["ok"] for entry in header["results"]] == [True, False]
    assert "mises" in header["results"][0]["arrays"]


def test_a_check_tells_how_far_it_is_and_is_cancelled(engines):
    engines.most = 0
    client = Client(Settings())
    name = client.post("/api/fea", {"grids": [SADDLE]}).json()["job"]
    until(lambda: client.get(f"/api/jobs/{name}").json()["progress"] == {"done": 1, "total": 12})
    problem(client.get(f"/api/jobs/{name}/frames"), 409, "no-frames")
    assert client.request("DELETE", f"/api/jobs/{name}").status_code == 200
    answer, _ = finished(client, name)
    assert (answer["state"], answer["result"], answer["problem"]) == ("cancelled", None, None)


def test_a_search_from_the_first_step_to_its_result(engines):
    client = Client(Settings())
    name = client.post("/api/optimize", TASK).json()["job"]
    answer, steps = finished(client, name)
    assert (answer["kind"], answer["state"], answer["problem"]) == ("optimize", "done", None)
    assert [step["iteration"] for step in steps] == sorted(step["iteration"] for step in steps)
    assert steps[0]["words"] == "the design to begin with"
    assert all(grid_from_dict(step["grid"]).joints.shape == (9, 2) for step in steps)
    assert 0 <= answer["progress"]["done"] <= answer["progress"]["total"] == 100
    result = answer["result"]
    expected = {"grid", "error_mm", "error_fea_mm", "apart_mm", "designs", "iterations", "seconds",
                "interrupted", "warnings", "history"}  # fmt: skip
    assert expected <= result.keys()
    assert result["error_fea_mm"] == pytest.approx(result["error_mm"])  # by the same formula
    assert task_from_dict(TASK | {"grid": result["grid"]})
    assert len(result["history"]) == len(steps)
    frames = client.get(f"/api/jobs/{name}/frames").content
    header = json.loads(frames[8 : 8 + int.from_bytes(frames[4:8], "little")])
    assert [entry["engine"] for entry in header["results"]] == ["learned", "fea"]


def test_a_search_for_several_answers_has_them_all_in_its_result(engines, monkeypatch):
    monkeypatch.setattr("simulearn.inverse.answers.SLACK", 1.0)
    client = Client(Settings())
    limits = TASK["limits"] | {"answers": 3, "seconds": 2}
    name = client.post("/api/optimize", TASK | {"limits": limits}).json()["job"]
    answer, steps = finished(client, name)
    assert (answer["state"], answer["progress"]["total"]) == ("done", 100)
    answers = answer["result"]["answers"]
    assert 1 < len(answers) <= 3
    assert answers[0]["grid"] == answer["result"]["grid"]
    assert all(row["print_seconds"] > 60 and row["actuator_mm"] >= 0 for row in answers)
    assert -2 in {step["phase"] for step in steps}
    assert task_from_dict(TASK | {"grid": answers[1]["grid"]})


def test_a_search_that_is_cancelled_before_it_scored_anything_has_no_result(engines):
    engines.most = 0
    client = Client(Settings())
    name = client.post("/api/optimize", TASK).json()["job"]
    until(lambda: client.get(f"/api/jobs/{name}").json()["state"] == "running")
    client.request("DELETE", f"/api/jobs/{name}")
    engines.most = NEVER  # what makes the engine ready cannot be stopped
    answer, _ = finished(client, name)
    assert (answer["state"], answer["result"]) == ("cancelled", None)


def test_a_search_that_is_cancelled_later_has_its_best_design(engines):
    engines.most = 10  # the first and a few of the first step's
    client = Client(Settings())
    name = client.post("/api/optimize", TASK).json()["job"]
    until(lambda: engines.solved > engines.most)
    client.request("DELETE", f"/api/jobs/{name}")
    engines.most = NEVER
    answer, steps = finished(client, name)
    assert answer["state"] == "cancelled"
    result = answer["result"]
    assert result["interrupted"]
    assert result["error_fea_mm"] is None
    assert result["grid"] == steps[-1]["grid"]


@pytest.mark.parametrize(
    ("change", "code", "where"),
    [
        ({"goals": []}, "task", "goals"),
        ({"goals": [GOAL | {"vertex": ["joint", 9, "centre"]}]}, "task", "goals[0].vertex[1]"),
        ({"engine": "calculix"}, "engine-unknown", "engine"),
        ({"method": "luck"}, "method-unknown", "method"),
        ({"limits": {"seconds": 1e5}}, "task", "limits.seconds"),
        ({"limits": {"seconds": 300, "answers": 2}}, "task", "limits.seconds"),
        ({"limits": {"answers": 0}}, "task", "limits.answers"),
        ({"limits": {"iterations": 10**6}}, "task", "limits.iterations"),
        ({"free": {"joints": [], "actuators": []}}, "input", ""),
        ({"grid": SADDLE | {"material": "/etc/passwd"}}, "material-path", "material"),
        ({"grid": SADDLE | {"joints": [[0, 0]] * 9}}, "joints-coincide", "joint 1"),
    ],
)
def test_a_wrong_task_is_refused_before_there_is_a_job(change, code, where):
    client = Client(Settings())
    body = problem(client.post("/api/optimize", TASK | change), 422, code)
    assert body["where"] == where
    assert not client.app.state.jobs._jobs


def test_wrong_checks_are_refused(engines):
    client = Client(Settings(joints=8))
    body = problem(client.post("/api/fea", {"grids": [SADDLE]}), 422, "too-large")
    assert "grids[0]" in body["where"]
    problem(client.post("/api/fea", {"grids": []}), 422)
    problem(client.post("/api/fea", {"grids": [SADDLE] * 100}), 422)
    body = problem(client.post("/api/fea", {"grids": [{"joints": 1}]}), 422, "grid-file")
    problem(client.get("/api/jobs/unknown"), 404, "job-unknown")
    problem(client.get("/api/jobs/unknown/frames"), 404, "job-unknown")
    problem(client.request("DELETE", "/api/jobs/unknown"), 404, "job-unknown")
