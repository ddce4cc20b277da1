"""The commands: plate writes print, map and form; fit writes a material that can be used."""

import json
import tomllib

import arcs
import numpy as np
import pytest

import simulearn.calibrate.model as strips_model
from simulearn.calibrate import read_form, write_form
from simulearn.calibrate.form import CaliperSection
from simulearn.calibrate.parameters import base_values, material_with
from simulearn.material import Material, load_material, own_material, read_material

BASE = load_material("pla-hot-water")


@pytest.fixture
def form(tmp_path, monkeypatch):
    monkeypatch.setattr(strips_model, "simulated", arcs.simulated)
    values = base_values(BASE)
    values[0], values[5] = 0.85, 1.6
    filled = arcs.filled(BASE, material_with(BASE, values), noise=0.2, seed=4)
    path = tmp_path / "form.toml"
    write_form(filled.model_copy(update={"measured": "today # [x]\n"}), path)
    return path


def test_plate(run, tmp_path):
    words = ["calibrate", "plate", "--printer", "prusa-mk4", "-o", tmp_path / "p.gcode"]
    code, out, err = run(*words)
    assert code == 0, err
    assert "18 strips" in out
    assert {path.name for path in tmp_path.iterdir()} == {"p.gcode", "p.svg", "p-form.toml"}
    filled = read_form(tmp_path / "p-form.toml")
    assert filled.printer == "prusa-mk4"
    assert "L1" in (tmp_path / "p.gcode").read_text()
    # A form that may be filled in is not replaced by mistake.
    code, _, err = run(*words)
    assert code == 1
    assert "--overwrite" in err
    code, out, _ = run(*words, "--overwrite", "--repeats", 1, "--json")
    assert code == 0
    assert len(json.loads(out)["grids"]) == 6


def test_fit_writes_a_material(run, tmp_path, form):
    target = tmp_path / "my-pla.toml"
    code, out, err = run("calibrate", "fit", form, "-o", target)
    assert code == 0, err
    assert "strain" in out
    assert "difference" in out
    made = read_material(target)
    assert made.name == "my-pla"
    assert str(made.identity) in out
    # The same material wherever it is used: the terminal, the studio and requests, programs.
    assert own_material(target.read_text()).digest == made.digest
    data = json.loads(run("calibrate", "fit", form, "-o", target, "--json")[1])
    assert Material.model_validate(data["material"]) == made
    assert data["digest"] == made.digest
    assert made.shrinkage.active == pytest.approx(0.85 * BASE.shrinkage.active, rel=0.06)
    assert made.law.scale == pytest.approx(1 / 1.6, rel=0.1)
    assert made.print == BASE.print
    assert made.creep == BASE.creep
    assert made.calibration.curvature < BASE.calibration.curvature
    text = target.read_text()
    assert "Intervals" in text or "intervals of 90 %" in text
    assert "form.toml" in text
    assert "# PLA beams printed by fused deposition" in text
    assert tomllib.loads(text)["scatter"]["beam"] >= 0
    # It is a base itself, with the lines in place.
    again = tmp_path / "again.toml"
    write_form(read_form(form).model_copy(update={"material": str(target)}), form)
    code, _, err = run("calibrate", "fit", form, "-o", again)
    assert code == 0, err
    # What is read is not written over, and the names of materials that come along are theirs.
    text = target.read_text()
    assert "is what is read" in run("calibrate", "fit", form, "-o", target)[2]
    assert target.read_text() == text
    other = tmp_path / "pla-hot-water.toml"
    assert "another name" in run("calibrate", "fit", form, "-o", other)[2]
    assert not other.exists()
    assert again.read_text().count("scale =") == 1


def test_what_the_caliper_said_is_simulated_and_laid_as_before(run, tmp_path, form):
    section = CaliperSection(width=7.35, thickness=4.1)
    write_form(read_form(form).model_copy(update={"section": section}), form)
    target = tmp_path / "my-pla.toml"
    code, _, err = run("calibrate", "fit", form, "-o", target)
    assert code == 0, err
    made = read_material(target)
    assert (made.section.width, made.section.thickness) == (7.35, 4.1)
    assert made.as_laid == BASE.section
    printed = run("gcode", "flat", "--printer", "prusa-mk4", "--material", target, "--json")
    assert printed[0] == 0, printed[2]
    same = run("gcode", "flat", "--printer", "prusa-mk4", "--json")
    assert json.loads(printed[1])["filament_mm"] == json.loads(same[1])["filament_mm"]


def test_fit_for_programs(run, form):
    code, out, _ = run("calibrate", "fit", form, "--json")
    assert code == 0
    data = json.loads(out)
    numbers = {one["name"]: one for one in data["numbers"]}
    assert numbers["strain"]["low"] < numbers["strain"]["value"] < numbers["strain"]["high"]
    assert len(data["strips"]) == 12
    assert np.shape(data["covariance"]) == (6, 6)
    assert data["file"] is None


def test_wrong_files(run, tmp_path, form):
    assert run("calibrate", "fit", tmp_path / "none.toml")[0] == 1
    assert run("calibrate", "fit", form, "-o", form)[0] == 1
    text = form.read_text()
    form.write_text(text.replace("[strips.top]", "[strips.top]\nfoo = 1"))
    code, _, err = run("calibrate", "fit", form)
    assert code == 1
    assert "strip top, foo" in err
    form.write_text(text.replace("[strips.top]", '[strips."[/x] top"]'))
    code, out, err = run("calibrate", "fit", form)
    assert code == 0, err
    assert "[/x] top" in out
