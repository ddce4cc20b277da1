"""One model for many materials and kinds of grids: ranges, prints, trials that are filled up."""

from dataclasses import replace

import jax
import numpy as np
import pytest

from simulearn.compiled import double_precision
from simulearn.errors import InputError
from simulearn.fea.bar import bar
from simulearn.grid import make
from simulearn.learn.common.bundle import bundle_of
from simulearn.learn.common.metrics import Errors
from simulearn.learn.common.trials import fingerprint
from simulearn.learn.equilibrium import corrector
from simulearn.learn.equilibrium.examples import first_shapes
from simulearn.learn.equilibrium.first_order import first_order_errors, loss
from simulearn.learn.equilibrium.learnt import Learnt, learnt_of
from simulearn.learn.equilibrium.parameters import Parameters
from simulearn.learn.equilibrium.reference import bucket_of, buckets, filled, trial_poses
from simulearn.learn.paper.train import train as train_paper
from simulearn.material import Family, draw_member, load_material, member_of
from simulearn.mechanics.model import section_of, unfitted
from simulearn.mechanics.properties import properties_of, stacked
from simulearn.simulate.members import last_frames

PLA = load_material("pla-hot-water")


def member(seed: int, **ranges):
    return draw_member(Family(**ranges), PLA, np.random.default_rng(seed).random)


def shrinking(factor: float, **values):
    old = PLA.shrinkage
    changes = {"active": factor * old.active, "shell": factor * old.shell, **values}
    return PLA.model_copy(update={"shrinkage": old.model_copy(update=changes)})


def test_sections_of_many_materials_at_once_are_those_of_each():
    materials = [member(k) for k in range(4)]
    each = [properties_of(m) for m in materials]
    random = np.random.default_rng(0)
    law = type(unfitted())(*(x + 0.01 * random.normal(size=x.shape) for x in unfitted()))
    many = section_of(law, stacked(each))
    for t, p in enumerate(each):
        for one, all_ in zip(section_of(law, p), many, strict=True):
            np.testing.assert_allclose(all_[..., t], one, rtol=1e-12)


def test_an_unfitted_section_curls_as_a_layered_beam_does():
    section = section_of(unfitted(), properties_of(PLA))
    strain = 0.09261 * (1 + 0.406 * 0.118 / 0.158)
    assert section.curvature[0] == pytest.approx(1.5 * 0.75 * strain / 4)
    curled = shrinking(1.0, curl=0.02)
    assert section_of(unfitted(), properties_of(curled)).own[0, 0] == pytest.approx(0.02 / 4)


def test_sizes_to_fill_up_to_have_room_for_all():
    sizes = [(2, 1), (5, 4), (8, 8), (9, 12), (9, 12), (16, 24), (21, 35), (13, 15)]
    rooms = buckets(sizes, 3)
    assert len(rooms) <= 3
    for joints, beams in sizes:
        room = rooms[bucket_of((joints, beams), rooms)]
        assert room[0] > joints
        assert room[1] - beams >= room[0] - joints
    assert buckets([(9, 12)] * 5) == [(9, 12)]
    with pytest.raises(ValueError, match="no room"):
        bucket_of((40, 60), rooms)


def test_what_fills_up_a_trial_changes_nothing(sample):
    """Errors, losses and features of a trial are the same in a larger size."""
    batch = sample.batches[0].take(slice(0, 2))
    law = unfitted()
    trials = trial_poses(batch)
    begun, twist, ended = first_shapes(batch, trials, law)
    assert ended.all()
    weights = corrector.initial_weights(jax.random.key(0), width=8, message=2, rounds=1)
    noise = jax.random.normal(jax.random.key(1), weights.decode[1][0].shape) * 0.1
    weights.decode[1] = (noise.astype(np.float32), weights.decode[1][1])
    whole = filled(trials, 12, 16)
    first = filled(trials._replace(state=begun), 12, 16).state
    wide = np.pad(twist, [(0, 0)] * 3 + [(0, 4), (0, 0)])

    @double_precision
    def found(trial, begun, twist):
        off = first_order_errors(Parameters(law, weights), trial, 9, begun, twist)
        counts = trial.real, trial.topology.real
        return (*off, loss(*off, trial.size, 1.0, counts))

    @double_precision
    def of(trials, begun, twist):
        return jax.jit(jax.vmap(found))(trials, jax.tree.map(lambda x: x[:, 9], begun), twist[:, 9])

    plain, grown = of(trials, begun, twist), of(whole, first, wide)
    np.testing.assert_allclose(grown[0][:, :9], plain[0], atol=1e-5)
    np.testing.assert_allclose(grown[1][:, :12], plain[1], atol=1e-5)
    np.testing.assert_allclose(grown[2], plain[2], rtol=1e-5)


def test_what_was_learnt_says_how_far_a_material_is_beyond():
    learnt = learnt_of([PLA, shrinking(1.4), shrinking(0.6)], 1.0)
    assert learnt.beyond(PLA) == {}
    near, far = shrinking(1.5), shrinking(3.0)
    assert set(learnt.beyond(near)) == {"strain"}
    assert learnt.beyond(near)["strain"][3] == pytest.approx(0.125)
    assert learnt.wrong(near, PLA) is None
    assert "strain of the active half is 0.1389" in learnt.remark(near)
    assert "strain" in learnt.wrong(far, PLA)
    again = Learnt.from_arrays(learnt.to_arrays())
    np.testing.assert_array_equal(again.ranges, learnt.ranges)
    with pytest.raises(InputError, match=r"learnt\.ranges"):
        Learnt.from_arrays({})


def test_the_paper_model_refuses_trials_of_several_materials(small, sample):
    (batch,) = sample.batches
    materials = (PLA, *[shrinking(1.1)] * (len(batch) - 1))
    mixed = replace(sample, batches=[replace(batch, materials=materials)])
    with pytest.raises(InputError, match="of several materials"):
        train_paper(small, mixed)


def test_a_run_is_another_one_with_other_trials_by_the_fine_mesh(small, sample):
    other = replace(sample, sha256="other")
    prints = {fingerprint(small, *sets) for sets in ([sample], [sample, sample], [sample, other])}
    assert len(prints) == 3


def test_a_model_of_one_material_knows_no_other():
    learnt = learnt_of([PLA], 0.0)
    assert learnt.wrong(shrinking(1.01), PLA) is not None
    assert learnt.wrong(PLA, PLA) is None


def test_a_law_of_another_form_is_refused_and_a_stiffer_one_is_not():
    learnt = bundle_of("default").model.learnt
    stiff = PLA.model_copy(update={"law": PLA.law.model_copy(update={"scale": 2.0})})
    other = PLA.model_copy(update={"law": PLA.law.model_copy(update={"poisson": 0.3})})
    assert learnt.wrong(stiff, PLA) is None
    assert "its law is of another form" in learnt.wrong(other, PLA)


def test_prints_of_many_materials_are_those_of_each():
    grid = make("saddle", (1, 1), 50.0)
    materials = [member(k, slender=(1.8, 1.8), rim=(0.125, 0.125)) for k in range(5)]
    prints = last_frames(grid, materials)
    assert prints.converged.all()
    alone = last_frames(grid, [materials[3]])
    np.testing.assert_allclose(prints.joints[3], alone.joints[0], atol=1e-6)
    assert np.ptp(prints.centres[:, 1, 2]) > 0.1


def test_the_strain_of_one_beam_alone_may_differ():
    grid = make("dome", (1, 1), 50.0)
    factors = np.array([[1.0, 1.0, 1.0, 1.0], [1.3, 1.0, 1.0, 1.0], [1.3, 1.3, 1.3, 1.3]])
    prints = last_frames(grid, [PLA] * 3, factors)
    moved = np.linalg.norm(prints.centres - prints.centres[0], axis=-1).mean(axis=1)
    assert 0 < moved[1] < moved[2]


def test_a_strip_with_open_ends_has_an_answer_and_curls_of_its_own():
    none = {"acceleration": 0.0}
    up, down = (
        m.model_copy(update={"gravity": m.gravity.model_copy(update=none)})
        for m in (shrinking(1.0, curl=0.01), shrinking(1.0, curl=-0.01))
    )
    prints = last_frames(bar(50.0, 0.0, up), [up, down])
    first, second = prints.centres[:, 1, 2]
    # An arc of curvature curl / thickness over the beam and half of each joint; the held joint
    # tilts both alike.
    assert (first - second) / 2 == pytest.approx(57.2**2 / 2 * 0.01 / 4, rel=0.15)


def test_errors_are_summed_by_kind_and_by_member():
    count = 12
    members = np.array([member_of(member(k)) for k in range(count)])
    errors = Errors(
        np.arange(count), np.full(count, 100.0), np.ones((count, 12)), np.zeros((count, 12)),
        np.zeros((count, 12)), np.ones(count), np.linspace(0.5, 2.0, count),
        np.ones(count, bool), tuple("ab" * 6), members,
    )  # fmt: skip
    figures = errors.summary()
    assert set(figures["kinds"]) == {"a", "b"}
    assert figures["kinds"]["a"]["trials"] == 6
    assert figures["kinds"]["a"]["mean_percent"] == pytest.approx(1.0)
    assert 0 < figures["below_bound_percent"] < 100
    assert set(figures["members"]) == set(member_of(PLA)._fields)
    assert figures["members"]["weight"]["low"]["trials"] == 4
    plain = replace(errors, kinds=(), members=None, bound=None).summary()
    assert "kinds" not in plain
    assert "members" not in plain
