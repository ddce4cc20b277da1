"""train, evaluate, simulate --engine learned and validate --model, as a user types them."""

import csv
import json
from itertools import product

import pytest
from PIL import Image
from test_train import toml
from typer.testing import CliRunner

from simulearn.cli.program import app
from simulearn.grid import make, write_grid
from simulearn.learn.common.bundle import bundle_of
from simulearn.learn.common.saving import save_bundle
from simulearn.learn.paper import search
from simulearn.material import load_material
from simulearn.material.reading import HERE

runner = CliRunner()


def run(*words):
    result = runner.invoke(app, [str(w) for w in words], catch_exceptions=True)
    return result, result.stdout


def width(path):
    with Image.open(path) as picture:
        return picture.size[0]


@pytest.fixture(scope="module")
def folder(model, sample, tmp_path_factory):
    return save_bundle(tmp_path_factory.mktemp("models") / "tiny", model, "tiny", sample).path


def test_train_leaves_a_model_and_a_curve(small, tmp_path):
    settings = small.model_dump(mode="json")
    settings["phases"] = [{"epochs": 2, "unroll": 10, "noise": 0.0, "batch": 6}]
    config = tmp_path / "run.toml"
    config.write_text(toml(settings), encoding="utf-8")
    result, stdout = run("train", config, "-o", tmp_path / "run", "--json")
    assert result.exit_code == 0, result.output
    figures = json.loads(stdout)
    assert figures["epochs"] == 2
    rows = list(csv.DictReader((tmp_path / "run" / "loss.csv").read_text("utf-8").splitlines()))
    assert [row["epoch"] for row in rows] == ["1", "2"]
    assert float(rows[-1]["loss"]) == pytest.approx(figures["loss"], rel=1e-5)
    assert width(tmp_path / "run" / "loss.png") > 1000
    assert bundle_of(figures["model"]).card.training["rate"] == small.rate
    again, stdout = run("train", config, "-o", tmp_path / "run")
    assert "epoch 2" in again.output


def test_train_says_what_is_missing(small, tmp_path):
    config = tmp_path / "run.toml"
    settings = {**small.model_dump(mode="json"), "data": str(tmp_path / "none.h5")}
    config.write_text(toml(settings), encoding="utf-8")
    result, _ = run("train", config, "-o", tmp_path / "run")
    assert "there is no such data set" in str(result.exception)
    assert not (tmp_path / "run").exists()


def test_search_tries_combinations_and_goes_on(small, tmp_path, monkeypatch):
    pytest.importorskip("optuna")
    monkeypatch.setattr(search, "SHARES", (1.0,))  # one kernel for all runs, and for other tests
    settings = small.model_dump(mode="json")
    settings["phases"] = [{"epochs": 1, "unroll": 10, "batch": 6}]
    config = tmp_path / "run.toml"
    config.write_text(toml(settings), encoding="utf-8")
    result, _ = run("train", config, "-o", tmp_path / "s", "--search", 1)
    assert result.exit_code == 0, result.output
    result, stdout = run("train", config, "-o", tmp_path / "s", "--search", 2, "--json")
    figures = json.loads(stdout)
    assert len(figures["runs"]) == 2
    assert figures["best"] in figures["runs"]
    assert set(figures["best"]) == {
        "noise", "penalty", "trials", "validation_percent", "gap_mm",
    }  # fmt: skip
    lines = (tmp_path / "s" / "search.csv").read_text("utf-8").splitlines()
    assert len(lines) == 3
    assert width(tmp_path / "s" / "search.png") > 1000


def test_search_tries_every_combination_once(small, sample, tmp_path, monkeypatch):
    pytest.importorskip("optuna")
    tried = []

    def measured(config, data):
        tried.append((config.phases[0].noise, config.penalty, config.trials))
        return {"validation_percent": 1.0 + config.penalty, "gap_mm": 0.1}

    monkeypatch.setattr(search, "_measured", measured)
    figures = search.search(small, sample, tmp_path, 60)
    sizes = {trials for _, _, trials in tried}
    assert len(sizes) == len(search.SHARES)
    assert sorted(tried) == sorted(product(search.NOISE, search.PENALTY, sizes))
    assert len(figures["runs"]) == 48
    assert figures["best"]["penalty"] == 0.0


def test_evaluate_tells_figures_and_draws(folder, sample_file, tmp_path):
    result, stdout = run("evaluate", folder, sample_file, "-o", tmp_path / "e", "--json")
    assert result.exit_code == 0, result.output
    figures = json.loads(stdout)
    for key in ("mean_percent", "p97_percent", "worst_percent", "median_percent", "mean_mm"):
        assert figures[key] > 0
    assert figures["trials"] == 8
    assert figures["mean_percent"] <= figures["worst_percent"]
    assert len(figures["frames"]) == 12
    assert figures["frames"][0]["mean_percent"] < 0.01
    kept = json.loads((tmp_path / "e" / "figures.json").read_text("utf-8"))
    assert kept == figures
    rows = list(csv.DictReader((tmp_path / "e" / "trials.csv").read_text("utf-8").splitlines()))
    mean = sum(float(row["error_percent"]) for row in rows) / len(rows)
    assert mean == pytest.approx(figures["mean_percent"], abs=1e-3)
    for name in ("errors", "grids"):
        assert width(tmp_path / "e" / f"{name}.png") > 1000


def test_evaluate_prints_a_table_and_can_keep_it_in_the_card(folder, sample_file):
    result, stdout = run("evaluate", folder, sample_file, "--record")
    assert result.exit_code == 0, result.output
    assert "tiny on 8 trials of sample" in stdout
    assert bundle_of(folder).card.metrics["sample"]["trials"] == 8


def test_evaluate_refuses_trials_of_another_material(folder, sample_file, tmp_path):
    text = (HERE / "pla-hot-water.toml").read_text("utf-8")
    same, other = tmp_path / "same.toml", tmp_path / "other.toml"
    same.write_text(text, "utf-8")
    other.write_text(text.replace("acceleration = 2182", "acceleration = 0"), "utf-8")
    assert run("evaluate", folder, sample_file, "--material", same)[0].exit_code == 0
    result, _ = run("evaluate", folder, sample_file, "--material", other)
    for material in (load_material(other), bundle_of(folder).card.material):
        assert material.digest[:12] in str(result.exception)


def test_simulate_asks_the_model_and_warns_outside_its_ranges(folder, tmp_path):
    result, stdout = run("simulate", "saddle", "--engine", "learned", "--model", folder, "--json")
    assert result.exit_code == 0, result.output
    assert json.loads(stdout)["engine"] == "learned"
    write_grid(make("saddle", length=140.0), tmp_path / "large.json")
    result, _ = run("simulate", tmp_path / "large.json", "--engine", "learned", "--model", folder)
    assert result.exit_code == 0, result.output
    most = bundle_of(folder).card.ranges.dimension[1]
    assert "197.99 mm from its fixed joint; the model was trained from" in result.output
    assert f"to {most:g} mm" in result.output


def test_validate_takes_the_limits_of_a_model(folder, tmp_path):
    write_grid(make("saddle", length=98.0), tmp_path / "large.json")
    plain, stdout = run("validate", tmp_path / "large.json", "--json")
    assert json.loads(stdout)["warnings"] == []
    as_json, stdout = run("validate", tmp_path / "large.json", "--model", folder, "--json")
    assert [w["code"] for w in json.loads(stdout)["warnings"]].count("grid-size") == 1
    assert plain.exit_code == as_json.exit_code == 0


def test_what_is_no_model_is_one_line(sample_file):
    result, _ = run("evaluate", "nowhere", sample_file)
    assert "is not a model" in str(result.exception)
    result, _ = run("simulate", "saddle", "--model", "nowhere")
    assert "takes no model" in str(result.exception)
