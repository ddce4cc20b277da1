"""The fit: it finds a hidden material, its intervals cover it, and what it cannot know it says."""

import arcs
import numpy as np
import pytest

import simulearn.calibrate.model as strips_model
from simulearn.calibrate import Form, fit
from simulearn.calibrate.measuring import simulated
from simulearn.calibrate.parameters import base_values, check_base, material_with, values_of
from simulearn.calibrate.plate import records
from simulearn.errors import InputError
from simulearn.material import load_material
from simulearn.material.family import Family, draw_member

BASE = load_material("pla-hot-water")
SAME_SECTION = Family(slender=(1.8, 1.8), rim=(0.125, 0.125))


@pytest.fixture
def by_formula(monkeypatch):
    monkeypatch.setattr(strips_model, "simulated", arcs.simulated)


def hidden(seed):
    return draw_member(SAME_SECTION, BASE, np.random.default_rng(seed).uniform)


def test_numbers_and_material_are_one():
    values = np.array([0.8, 0.6, 0.9, 1.1, -0.2, 1.7])
    assert values_of(material_with(BASE, values), BASE) == pytest.approx(values)
    assert material_with(BASE, base_values(BASE)).physics == BASE.physics


def test_exact_readings_give_the_hidden_material_by_formula(by_formula):
    secret = hidden(3)
    found = fit(arcs.filled(BASE, secret), BASE)
    values = {one.name: one.value for one in found.estimates}
    for name, meant in zip(values, values_of(secret, BASE), strict=True):
        tolerance = {"strain": 0.03, "curl": 0.02, "load": 0.05}.get(name, 0.2)
        assert values[name] == pytest.approx(meant, abs=tolerance), name
    assert all(abs(one.difference) < 0.1 for one in found.differences)


def test_simulated_strips_give_the_hidden_material():
    """Two strips tell strain and curl; what they do not tell stays the base's."""
    values = base_values(BASE)
    values[0], values[4] = 0.85, 0.15
    secret = material_with(BASE, values)
    strips = {}
    for name in ("top", "bottom"):
        record = records(BASE, 1)[name]
        chord, rise = simulated(record, [secret], name == "top")[0].tolist()
        update = {"before": (record.length(7.2),), "chord": (chord,), "rise": (rise,)}
        strips[name] = record.model_copy(update=update)
    found = fit(Form(strips=strips), BASE)
    got = {one.name: one for one in found.estimates}
    assert got["strain"].value == pytest.approx(0.85, abs=0.04)
    assert got["curl"].value == pytest.approx(0.15, abs=0.02)
    assert got["joint"].determined == "not"
    assert got["joint"].value == got["joint"].base
    assert any(m.code == "calibration-untold" for m in found.messages)


def test_intervals_cover(by_formula):
    count = 8
    inside = 0
    for seed in range(count):
        secret = hidden(seed)
        found = fit(arcs.filled(BASE, secret, noise=0.3, seed=seed), BASE)
        meant = values_of(secret, BASE)
        inside += sum(e.low <= v <= e.high for e, v in zip(found.estimates, meant, strict=True))
    # 90 % of 48, more or less two standard deviations of numbers that are not independent.
    assert 0.8 <= inside / (6 * count) <= 0.99


def test_scatter_and_size_are_reported(by_formula):
    calm = fit(arcs.filled(BASE, BASE, noise=0.1, seed=1), BASE)
    form = arcs.filled(BASE, BASE, noise=0.1, seed=1, repeats=6, scatter=0.06, size=1.01)
    wild = fit(form, BASE)
    assert calm.noise.low < 0.002
    assert calm.noise.scatter < 0.02
    assert 0.03 < wild.noise.scatter < 0.1
    assert wild.noise.low > 0.01
    low, high = wild.size[1:]
    assert low < 1.01 < high
    assert high - low < 0.01


def test_noise_of_readings_is_reported(by_formula):
    noisy = fit(arcs.filled(BASE, BASE, noise=0.9, seed=2, repeats=6), BASE)
    quiet = fit(arcs.filled(BASE, BASE, noise=0.1, seed=2, repeats=6), BASE)
    assert noisy.noise.reading == pytest.approx(0.9, rel=0.25)
    assert quiet.noise.reading == pytest.approx(0.1, rel=0.25)
    width = [found.estimates[-1].high - found.estimates[-1].low for found in (noisy, quiet)]
    assert width[0] > 2 * width[1]  # the model's own error stays


def test_a_strip_that_no_material_explains_is_said(by_formula):
    form = arcs.filled(BASE, BASE, noise=0.1)
    for k in range(3):
        form = form.with_reading("half", k, rise=form.strips["half"].rise[k] * 0.6)
    found = fit(form, BASE)
    codes = {m.code for m in found.messages}
    assert "calibration-misfit" in codes
    assert found.spread > 2
    assert "of strip half" in next(m.message for m in found.messages if "misfit" in m.code)
    assert found.estimates[3].determined != "well"


def test_forgotten_signs_are_said(by_formula):
    form = arcs.filled(BASE, BASE, noise=0.1)
    for k in range(3):
        form = form.with_reading("long", k, rise=-form.strips["long"].rise[k])
    said = {m.where: m.message for m in fit(form, BASE).messages if m.code == "calibration-sign"}
    assert "is its sign right?" in said["strip long"]


@pytest.mark.parametrize(("part", "key"), [("gravity", "acceleration"), ("shrinkage", "active")])
def test_a_base_without_what_is_fitted_is_refused(part, key):
    none = getattr(BASE, part).model_copy(update={key: 0.0})
    with pytest.raises(InputError, match=f"{part}.{key} = 0") as caught:
        fit(arcs.filled(BASE, BASE), BASE.model_copy(update={part: none}))
    assert caught.value.code == "calibration-base"
    with pytest.raises(InputError, match=f"{part}.{key} = 0"):  # before hours of printing
        check_base(BASE.model_copy(update={part: none}))


def test_a_material_beyond_the_family_is_said(by_formula):
    values = base_values(BASE)
    values[0] = 1.8
    found = fit(arcs.filled(BASE, material_with(BASE, values)), BASE)
    assert any(m.code == "calibration-edge" and m.where == "strain" for m in found.messages)


def test_an_empty_form():
    with pytest.raises(InputError, match="no chord and no rise") as caught:
        fit(Form(strips=records(BASE, 3)), BASE)
    assert caught.value.code == "calibration-empty"
