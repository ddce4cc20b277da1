"""One change of the material that explains a deviation: hidden ones are found, others are not."""

import threading
from dataclasses import replace

import numpy as np
import printed
import pytest

import simulearn.simulate.source as source
from simulearn.compare import JointPlaces, compare
from simulearn.compare.changes import parameters, steps
from simulearn.compare.explaining import simulated_by
from simulearn.compare.report import by_chance, verdict
from simulearn.errors import CancelledError
from simulearn.material import Family, Scatter, member_of

EVERY = np.arange(9)
CURL = 0.1 * printed.BASE.shrinkage.active


@pytest.fixture(autouse=True)
def formula(monkeypatch):
    """Let a formula stand in for the simulations; return how many prints each call had."""
    calls = []

    def last_frames(grid, materials, factors, model):
        calls.append(len(materials))
        return printed.last_frames(grid, materials, factors)

    monkeypatch.setattr(source, "last_frames", last_frames)
    return calls


def compared(noise=0.0, seed=1, numbers=EVERY, **changes):
    places = printed.shape(printed.material(**changes)).centres[-1][numbers]
    places = places + noise * np.random.default_rng(seed).normal(size=places.shape)
    return compare(
        printed.grid(), JointPlaces(printed.moved(places, seed), numbers), printed.Simulator()
    )


@pytest.mark.parametrize(
    ("name", "value"),
    [("strain", 1.12), ("strain", 0.7), ("curl", CURL), ("curl", -2 * CURL), ("passive", 0.6)],
)
def test_a_hidden_change_is_found(name, value, formula):
    found = compared(noise=0.02, **{name: value})
    best = found.explanations[0]
    assert best.name == name
    assert best.value == pytest.approx(value, rel=0.03, abs=0.001)
    assert best.explained > 0.98
    assert best.within
    assert f"{best.words} would explain" in verdict(found)
    assert formula[:3] == [1 + 2 * 7, 1 + 7, 1 + 7]


def test_a_change_beyond_the_family_is_called_so():
    found = compared(strain=1.45)
    assert found.explanations[0].name == "strain"
    assert not found.explanations[0].within
    assert "(outside the family)" in verdict(found)


def test_changes_that_cannot_be_distinguished_are_called_so():
    found = compared(strain=1.08)
    best = {one.name: one for one in found.explanations}
    assert best["creep"].explained > 0.95
    assert best["strain"].alike == ("creep",)
    assert "2 of these do equally well: this print cannot tell them apart" in verdict(found)


def test_noise_is_explained_by_nothing():
    found = compared(noise=1.5)
    assert verdict(found).startswith("no one change of the material explains it")


def test_no_deviation_needs_no_explanation():
    assert "there is nothing to explain" in verdict(compared(noise=1e-9))


def test_few_joints_are_explained_by_chance():
    few = compared(noise=1.0, numbers=np.array([0, 2, 6, 8]))
    many = compared(noise=1.0)
    assert by_chance(few) > 0.7
    assert by_chance(many) < 0.35
    share = [max(e.explained for e in compared(noise=1.0, seed=s).explanations) for s in range(4)]
    assert np.mean(np.array(share) < by_chance(many)) >= 0.75


def test_every_step_is_a_material_and_the_ranges_are_the_familys():
    base = printed.BASE
    for one in parameters(base):
        low, high = steps(one, base)
        assert low < high
        for value in (low, high):
            changed = one.apply(base, value)
            assert type(base).model_validate(changed.model_dump()) == changed
            if one.name not in ("strain", "weight"):
                assert one.value(changed) == pytest.approx(value)
    ranges = {one.name: one.range for one in parameters(base)}
    assert ranges["passive"] == Family().passive
    twice = printed.material(strain=2.0)
    assert member_of(twice).strain == pytest.approx(2 * member_of(base).strain)
    assert member_of(twice)[1:] == pytest.approx(member_of(base)[1:])


def test_a_material_that_the_model_has_not_learnt_is_explained_by_finite_elements(monkeypatch):
    counts = []

    def frames(grid, materials, factors):
        counts.append(len(materials))
        return printed.last_frames(grid, materials, factors)

    by_fea = replace(source.BY_FEA, frames=frames)
    monkeypatch.setattr(source, "BY_FEA", by_fea)
    far = printed.material(strain=4.0)
    places, converged = simulated_by(printed.grid())([far, far])
    assert counts == [2]
    assert converged.all()
    assert places.shape[0] == 2


def test_the_scatter_of_the_material_goes_before_the_published_one():
    from simulearn.compare.scatter import PUBLISHED, scatter_of

    grid = printed.grid()
    assert scatter_of(grid, printed.BASE).mm == pytest.approx(PUBLISHED * 90 * 2**0.5)
    own = printed.BASE.model_copy(update={"scatter": Scatter(print=0.05)})
    assert scatter_of(grid, own).words.startswith("by the material: 5.0% from print to print")


def test_a_comparison_can_be_cancelled():
    token = threading.Event()
    token.set()
    places = JointPlaces(printed.shape().centres[-1], EVERY)
    with pytest.raises(CancelledError):
        compare(printed.grid(), places, printed.Simulator(), cancel=token)
