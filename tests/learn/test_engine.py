"""The engine `learned`: grids in, results out, by any bundle."""

import re

import numpy as np
import pytest

from simulearn.errors import ComputationError, InputError
from simulearn.grid import Rules, draw_valid, make
from simulearn.learn.common.first_frame import first_frame
from simulearn.learn.common.model import Designs
from simulearn.learn.common.saving import save_bundle
from simulearn.simulate import Result, engine, one, read_npz, write_npz
from simulearn.simulate.learned import Learned


@pytest.fixture(scope="module")
def folder(model, sample, tmp_path_factory):
    return save_bundle(tmp_path_factory.mktemp("models") / "tiny", model, "tiny", sample).path


@pytest.fixture(scope="module")
def learned(folder):
    return engine("learned", folder)


def test_results_come_in_the_order_of_the_grids_whatever_their_topologies(learned):
    grids = [make("saddle"), make("cone", (1, 2)), make("dome"), make("flat", (1, 2))]
    reported = []
    results = learned.simulate(grids, lambda done, total: reported.append((done, total)))
    assert reported[-1] == (48, 48)
    for grid, result in zip(grids, results, strict=True):
        assert result.engine == "learned"
        assert result.model.name == "tiny"
        np.testing.assert_array_equal(result.grid.actuators, grid.actuators)
        (alone,) = learned.simulate([grid])
        np.testing.assert_allclose(alone.joints, result.joints, atol=0.02)
        assert result.seconds > 0


def test_the_answer_is_the_models(learned, model):
    grid = draw_valid(Rules(), 3, 0)[0].centred
    (result,) = learned.simulate([grid])
    designs = Designs(grid.beams, grid.fixed, grid.joints[None], grid.actuators[None])
    frames = model.rollout(designs)
    np.testing.assert_array_equal(result.joints, frames.joints[0])
    np.testing.assert_array_equal(result.beams, frames.sections[0])
    np.testing.assert_allclose(result.joints[0], first_frame(designs).joints[0], atol=1e-12)


def test_a_result_without_stress_can_be_kept(learned, tmp_path):
    (result,) = learned.simulate([make("twist")])
    assert result.stress is None
    write_npz(result, tmp_path / "twist.npz")
    back = read_npz(tmp_path / "twist.npz")
    np.testing.assert_array_equal(back.joints, result.joints)
    assert back.stress is None


def test_only_the_learned_engine_takes_a_model(folder):
    with pytest.raises(InputError, match="takes no model"):
        engine("fea", folder)
    with pytest.raises(InputError, match="is not a model"):
        engine("learned", "nowhere")


def test_a_material_is_known_by_its_contents(learned, tmp_path):
    from simulearn.material import load_material
    from simulearn.material.reading import HERE

    text = (HERE / "pla-hot-water.toml").read_text("utf-8")
    path = tmp_path / "other.toml"
    path.write_text(text, encoding="utf-8")
    assert load_material(str(path)).section.width == 7.2
    (same,) = learned.simulate([make("saddle", material=str(path))])
    assert isinstance(same, Result)  # the same contents, whatever they are called
    path.write_text(re.sub(r"\nacceleration = 2[0-9.]+", "\nacceleration = 0.0", text), "utf-8")
    changed = load_material(str(path))
    assert changed.gravity.acceleration == 0
    refused, answered = learned.simulate([make("saddle", material=str(path)), make("saddle")])
    assert isinstance(answered, Result)
    assert refused.code == "material-not-learnt"
    assert changed.digest[:12] in refused.message
    assert learned.material.digest[:12] in refused.message
    assert "finite elements" in refused.hint
    with pytest.raises(InputError, match="has learnt pla-hot-water"):
        one(refused)


def test_an_answer_that_is_none_is_not_given(learned):
    class Broken:
        kind = "paper"

        def rollout(self, designs):
            frames = learned.bundle.model.rollout(designs)
            frames.converged[:] = False
            return frames

    from types import SimpleNamespace

    broken = Learned(SimpleNamespace(card=learned.bundle.card, model=Broken()))
    (failure,) = broken.simulate([make("saddle")])
    assert failure.code == "no-answer"
    with pytest.raises(ComputationError, match="has no answer for this grid"):
        one(failure)


def test_the_training_ranges_are_the_bundles(learned):
    assert learned.training == learned.bundle.card.range
    assert learned.training.dimension[0] < learned.training.dimension[1]
