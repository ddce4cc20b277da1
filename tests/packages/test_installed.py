"""The wheel in a fresh environment outside the checkout: the demo, what is missing, each extra.

An environment is made once for each Python and its extras are put in by turns, because the first
command of a new environment compiles all that it imports. Between the oldest and the newest Python,
extras are only looked for, not tried.
"""

import json
import re
import subprocess
import urllib.request

import pytest

from installing import PATIENCE, PYTHONS, ROOT

EXAMPLES = ROOT / "examples"
GRID = json.loads((EXAMPLES / "twist.json").read_text("utf-8"))
GOAL = {"vertex": ["joint", 0, "centre"], "target": [-60, -60, 20]}
TASK = {"schema": "simulearn.task/1", "grid": GRID, "goals": [GOAL]}
SEARCH = ("optimize", "task.json", "--iterations", 2, "--corrections", 0, "-o")
LEARNED = ("simulate", "twist", "--engine", "learned")

MISSING = {  # command -> the extra that it lacks
    ("studio", "--no-browser"): "studio",
    (*LEARNED, "-o", "out.html"): "studio",
    (*LEARNED, "-o", "out.3dm"): "rhino",
    ("import", EXAMPLES / "leaf.svg", "-o", "leaf.json"): "rhino",
    (*LEARNED, "-o", "out.vtu"): "vtk",
    (*SEARCH, "other", "--method", "cma"): "search",
    (*SEARCH, "other", "--method", "gradient"): "train",
    (*LEARNED, "--model", "paper"): "train",
    ("simulate", "twist", "--engine", "calculix"): "train",
    ("train", "small"): "train",
    ("dataset", "generate", "sample", "-o", "data", "--scheduler", "tcp://localhost:1"): "cluster",
}
WORKERS = """
from distributed import LocalCluster
from simulearn.dataset.workers import cluster_workers
with LocalCluster(1, threads_per_worker=1, processes=False, dashboard_address=None) as cluster:
    with cluster_workers(cluster.scheduler_address) as workers:
        print(workers.count())
"""


@pytest.mark.parametrize("number", range(len(PYTHONS)))
def test_the_demo_and_every_extra(install, number):
    simulearn = install(PYTHONS[number])
    simulearn.write("task.json", TASK)
    demo(simulearn)
    for command, extra in MISSING.items():
        line = simulearn.refused(*command)
        assert line.endswith(f": pip install 'simulearn[{extra}]'"), command
    if 0 < number < len(PYTHONS) - 1:
        simulearn.extra(",".join(EXTRAS), dry_run=True)
        return
    for extra, check in EXTRAS.items():
        simulearn.extra(extra)
        check(simulearn)


def demo(simulearn):
    assert "wrote out.png" in simulearn("simulate", "twist", "-o", "out.json", "-o", "out.png")
    assert len(json.loads((simulearn.folder / "out.json").read_text("utf-8"))["joints"]) == 12
    assert "model equilibrium" in simulearn(*LEARNED)
    assert simulearn("validate", "twist").strip() == "valid"
    simulearn("import", EXAMPLES / "twist.json", "-o", "grid.json")
    cone = ("gcode", EXAMPLES / "cone.json", "--printer", "prusa-mk4")
    assert "wrote cone.gcode" in simulearn(*cone, "-o", "cone.gcode")
    assert "wrote found/best.json" in simulearn(*SEARCH, "found")


def studio(simulearn):
    simulearn(*LEARNED, "-o", "out.html")
    command = [simulearn.bin / "simulearn", "studio", "--no-browser", "--port", "0"]
    with subprocess.Popen(
        [*command, "--data", "kept"],
        cwd=simulearn.folder,
        env=simulearn.environment(),
        stdout=subprocess.PIPE,
        text=True,
    ) as server:
        try:
            address = re.search(r"http://\S+/", server.stdout.readline())[0]

            def ask(place, body=None):
                data = None if body is None else json.dumps(body).encode()
                request = urllib.request.Request(
                    address + place, data, {"content-type": "application/json"}
                )
                with urllib.request.urlopen(request, timeout=PATIENCE) as answer:
                    return answer.read().decode()

            assert "<title>SimuLearn studio</title>" in ask("")
            assert "import" in ask("page/main.js")
            assert ask("libraries/three.js")
            (result,) = json.loads(ask("api/simulate", {"grids": [GRID]}))["results"]
            assert len(result["joints"]) == 12
        finally:
            server.terminate()


def rhino(simulearn):
    simulearn("import", EXAMPLES / "leaf.svg", "-o", "leaf.json")
    simulearn(*LEARNED, "-o", "twist.3dm")
    assert (simulearn.folder / "twist.3dm").read_bytes().startswith(b"3D Geometry File Format")


def vtk(simulearn):
    simulearn(*LEARNED, "-o", "twist.vtu")
    assert "UnstructuredGrid" in (simulearn.folder / "twist.vtu").read_text("latin-1")


def cluster(simulearn):
    done = simulearn.run("python", "-c", WORKERS)
    assert done.stdout.split() == ["1"], done.stderr


def search(simulearn):
    simulearn(*SEARCH, "sampled", "--method", "cma")
    assert simulearn.run("python", "-c", "import optuna").returncode == 0


def train(simulearn):
    assert "model paper" in simulearn(*LEARNED, "--model", "paper")
    modules = "simulearn.learn.run, simulearn.inverse.gradient, simulearn.fea.calculix"
    loaded = simulearn.run("python", "-c", f"import {modules}")
    assert loaded.returncode == 0, loaded.stderr
    assert "there is no such data set" in simulearn.refused("train", "small")


EXTRAS = {
    "studio": studio,
    "rhino": rhino,
    "vtk": vtk,
    "cluster": cluster,
    "search": search,
    "train": train,
}
