"""Grids, results and reports in notebooks: as text, as picture, and as a page that plays."""

import dataclasses
import json
import subprocess
import sys
from base64 import b64decode
from io import BytesIO

import nbclient
import nbformat
import numpy as np
import pytest
from PIL import Image

import synthetic
from simulearn import make, rank, simulate, validate
from simulearn.errors import Message
from simulearn.grid import Grid, Validation
from simulearn.inverse import optimize, task_from_dict
from simulearn.simulate import Failure
from simulearn.simulate.result import Outcomes

ODD = "</iframe><script>alert(1)</script>"


def bundle(item, **options):
    return item._repr_mimebundle_(**options)


@pytest.fixture(scope="module")
def result():
    return synthetic.result(solid=False)


@pytest.fixture
def broken():
    good = make("saddle", (1, 1))
    return Grid(good.joints, good.beams, [0.01, 0, 0, 0], good.fixed)


def test_grid_is_a_plan():
    shown = bundle(make("saddle"))
    assert shown["text/plain"].startswith("Grid of 9 joints and 12 beams")
    assert shown["image/svg+xml"].startswith("<svg")
    assert "data:image/svg+xml;base64," in shown["text/html"]


def test_any_grid_is_shown(broken):
    for grid in (
        broken,
        Grid([], [], [], 0),
        Grid([[0, 0], [0, 0]], [[0, 1], [0, 9]], [3, 0], 7, f"no such {ODD}"),
        Grid([[0, 0], [40, 0], [80, 0]], [[0, 1], [1, 2], [0, 2]], [1, -1, 0], 0),
    ):
        shown = bundle(grid)
        assert shown["image/svg+xml"].endswith("</svg>")
        assert "nan" not in shown["image/svg+xml"]
        assert "<script" not in shown["text/html"]


def test_result_is_text_picture_and_page(result):
    shown = bundle(dataclasses.replace(result, bound_mm=0.4, stable=False))
    assert "0.40 mm" in shown["text/plain"]
    assert "unstable balance" in shown["text/plain"]
    with Image.open(BytesIO(shown["image/png"])) as image:
        assert image.format == "PNG"
        assert min(image.size) > 200
    assert 'sandbox="allow-scripts allow-downloads"' in shown["text/html"]
    assert len(shown["text/html"]) < 700_000


def test_warnings_are_text(result):
    said = (Message("odd", "beam 1", ODD),)
    shown = bundle(dataclasses.replace(result, warnings=said))
    assert "<script" not in shown["text/html"]
    assert ODD in shown["text/plain"]


def test_only_what_is_wanted_is_made(result, monkeypatch):
    monkeypatch.setattr("simulearn.notebook._picture", None)
    assert set(bundle(result, include=["text/plain"])) == {"text/plain"}
    assert set(bundle(result, exclude={"text/html", "image/png"})) == {"text/plain"}


def test_large_results_fall_back_to_the_picture(result, monkeypatch):
    monkeypatch.setattr("simulearn.notebook.MOST_BYTES", 100_000)
    html = bundle(result)["text/html"]
    assert "<iframe" not in html
    assert "write_html" in html
    assert "data:image/png;base64," in html


def test_without_the_libraries_the_picture_stays(result, monkeypatch):
    import simulearn.interop.html as module

    module._program.cache_clear()
    monkeypatch.setattr("simulearn.interop.libraries.find_spec", lambda name: None)
    html = bundle(result)["text/html"]
    assert "<iframe" not in html
    assert "pip install &#x27;simulearn[studio]&#x27;" in html
    assert "data:image/png;base64," in html


def test_failure_says_why_and_where(broken):
    (failure,) = simulate([broken], engine="learned")
    assert isinstance(failure, Failure)
    shown = bundle(failure)
    assert "the actuator of beam 0" in shown["text/plain"]
    assert "beam 0" in shown["text/html"]
    late = bundle(Failure(broken, "stuck", "frame 7", "no equilibrium", "shorten the actuators"))
    assert late["text/plain"] == "No result:\nframe 7: no equilibrium\nshorten the actuators"


def test_outcomes_are_a_list_and_a_table(broken):
    outcomes = simulate([make("saddle"), broken], engine="learned")
    assert isinstance(outcomes, list)
    shown = bundle(outcomes)
    assert shown["text/plain"].splitlines()[0] == "2 outcomes"
    assert repr(outcomes) == shown["text/plain"]
    assert shown["text/html"].count("<tr>") == 3
    assert "no result" in shown["text/html"]
    many = bundle(Outcomes(50 * list(outcomes)))
    assert "and 60 more" in many["text/plain"]
    assert bundle(Outcomes())["text/plain"] == "no outcomes"


def test_validation_is_a_list(broken):
    assert bundle(validate(make("saddle")))["text/plain"] == "Valid: no errors, no warnings"
    shown = bundle(validate(broken))
    assert shown["text/plain"].startswith("Not valid: 1 error, no warnings\n")
    odd = bundle(Validation((Message("odd", ODD, ODD),), ()))
    assert "<script" not in odd["text/html"]


def test_inverse_design_shows_what_it_found():
    grid = make("saddle", (1, 1))
    ranking = bundle(rank(grid))
    assert ranking["text/html"].count("<tr>") == 6
    task = {
        "schema": "simulearn.task/1",
        "grid": {
            "schema": "simulearn.grid/1",
            "joints": grid.joints.tolist(),
            "beams": grid.beams.tolist(),
            "actuators": grid.actuators.tolist(),
            "fixed": grid.fixed,
        },
        "goals": [{"vertex": ["joint", 3, "centre"], "target": [60, 60, 10]}],
        "limits": {"iterations": 1, "seconds": 20},
    }
    shown = bundle(optimize(task_from_dict(task)))
    assert shown["text/plain"].startswith("Best of ")
    assert "<iframe" in shown["text/html"]


HOST = """
import sys
before = set(sys.modules)
import simulearn
added = {name.split(".")[0] for name in set(sys.modules) - before}
assert not added & {"matplotlib", "IPython", "numpy", "jax"}, added
grid = simulearn.make("saddle")
grid._repr_mimebundle_()
assert "matplotlib" not in sys.modules
"""


def test_importing_changes_nothing_and_plans_need_no_matplotlib():
    subprocess.run([sys.executable, "-W", "error", "-c", HOST], check=True)


# What VS Code lets the outputs of a notebook do; a frame's policy is this one and its own.
POLICY = (
    "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval'; style-src 'unsafe-inline'; "
    "img-src https: http: data:; font-src https:; connect-src https:; child-src https: data:"
)


def test_page_plays_under_the_policy_of_its_host_and_one_frame_does_not_end_another(
    tmp_path, visit, result
):
    count = 20  # more canvases than a browser keeps
    file = tmp_path / "host.html"
    meta = f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">'
    body = count * bundle(result)["text/html"]
    file.write_text(f"<!doctype html>{meta}<title>Host</title>{body}", "utf-8")
    tab = visit(offline=True)
    tab.goto(file.as_uri())
    for k in [*range(count), 0]:
        frame = tab.locator("iframe").nth(k)
        frame.scroll_into_view_if_needed()
        inside = frame.content_frame
        inside.locator(".shape-canvas canvas").wait_for()
        assert inside.get_by_role("alert").count() == 0
    inside.get_by_role("slider").press("Home")
    assert inside.get_by_role("slider").input_value() == "0"


CELLS = (
    "import sys\nimport simulearn\ngrid = simulearn.make('saddle')\ngrid",
    "assert 'matplotlib' not in sys.modules\n"
    "result = simulearn.simulate(grid, engine='learned')\nresult",
    "simulearn.simulate([grid, grid], engine='learned')",
)


@pytest.mark.filterwarnings("ignore")  # of Jupyter's own parts
def test_notebook_plays(tmp_path, visit):
    notebook = nbformat.v4.new_notebook()
    notebook.cells = [nbformat.v4.new_code_cell(text) for text in CELLS]
    nbclient.NotebookClient(notebook, timeout=240, kernel_name="python3").execute()
    shown = [cell.outputs[-1]["data"] for cell in notebook.cells]
    assert shown[2]["text/plain"].startswith("2 outcomes")
    assert b64decode(shown[1]["image/png"]).startswith(b"\x89PNG")
    assert len(json.dumps(notebook)) < 1_000_000
    file = tmp_path / "notebook.html"
    body = "".join(data["text/html"] for data in shown)
    file.write_text(f"<!doctype html><title>Notebook</title>{body}", "utf-8")
    tab = visit(offline=True)
    tab.goto(file.as_uri())
    frame = tab.frame_locator("iframe")
    canvas = frame.locator(".shape-canvas canvas")
    canvas.wait_for()

    def seen(moment):
        frame.get_by_role("slider").press(moment)
        tab.wait_for_timeout(600)  # ms, until it is drawn finely
        with Image.open(BytesIO(canvas.screenshot())) as image:
            return np.asarray(image.convert("L"), dtype=float)

    flat, morphed = seen("Home"), seen("End")
    assert flat.std() > 2
    assert np.abs(flat - morphed).mean() > 1
    with tab.expect_download() as waiting:
        frame.get_by_role("button", name="Download grid").click()
    assert json.loads(waiting.value.path().read_text())["schema"] == "simulearn.grid/1"
