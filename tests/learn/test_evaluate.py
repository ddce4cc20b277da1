"""Figures of an evaluation: of answers whose errors are known."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from simulearn.errors import InputError
from simulearn.learn.common.evaluate import evaluate, for_testing
from simulearn.learn.common.first_frame import designs_of, first_frame
from simulearn.learn.common.metrics import rotations
from simulearn.learn.common.model import Frames


class Known:
    """Answers with the truth, moved by a vector in the last frame."""

    kind = "known"

    def __init__(self, batches, away=(0.0, 0.0, 0.0), joints_only=False):
        self.batches, self.away, self.joints_only = batches, np.array(away), joints_only

    def rollout(self, designs):
        for batch in self.batches:
            for t in range(len(batch)):
                if np.array_equal(batch.flat[t], designs.flat[0]):
                    part = batch.take(slice(t, t + len(designs)))
        joints, sections = part.joints.astype(float), part.sections.astype(float)
        joints[:, -1] += self.away
        if not self.joints_only:
            sections[:, -1] += self.away
        return Frames(joints, sections, None, None, np.ones(len(part), bool))


def test_the_truth_has_no_error(sample):
    batches = for_testing(sample)
    found = evaluate(Known(batches), batches).errors.summary()
    assert found["mean_percent"] == found["worst_percent"] == 0
    assert found["rotation_deg"] < 1e-3
    assert found["gap_mm"] < 0.01  # steps of the file
    assert found["trials"] == sum(len(b) for b in batches) == 8
    assert found["motion_mm"] > 3


def test_a_known_distance_is_found_in_percent_of_each_dimension(sample):
    batches = for_testing(sample)
    found = evaluate(Known(batches, away=(0.0, 3.0, 4.0)), batches).errors
    np.testing.assert_allclose(found.vertex[:, -1], 5, atol=1e-4)
    np.testing.assert_allclose(found.vertex[:, :-1], 0, atol=1e-6)
    dimensions = np.concatenate([b.dimensions for b in batches])
    figures = found.summary()
    assert figures["mean_percent"] == pytest.approx((500 / dimensions).mean(), rel=1e-4)
    assert figures["p97_percent"] == pytest.approx(np.percentile(500 / dimensions, 97), rel=1e-4)
    assert figures["worst_percent"] == pytest.approx(500 / dimensions.min(), rel=1e-4)
    assert figures["mean_mm"] == pytest.approx(5, abs=1e-4)
    assert [row["frame"] for row in figures["frames"]] == list(range(12))
    assert figures["rotation_deg"] < 1e-3


def test_all_corners_count_alike(sample):
    batches = for_testing(sample)
    found = evaluate(Known(batches, (5.0, 0.0, 0.0), joints_only=True), batches).errors
    joints, beams = 8 * batches[0].flat.shape[1], 12 * len(batches[0].beams)
    np.testing.assert_allclose(found.vertex[:, -1], 5 * joints / (joints + beams), rtol=1e-4)
    np.testing.assert_allclose(found.gap[:, -1], 5, atol=0.02)


def test_only_test_trials_count_and_all_of_a_set_that_is_for_testing(sample):
    assert all(b.test.all() for b in for_testing(sample))
    learnt = [b.take(~b.test) for b in sample.batches]
    with pytest.raises(InputError, match="no trials kept for testing"):
        for_testing(replace(sample, batches=learnt))
    every = [replace(b, test=np.ones(len(b), bool)) for b in sample.batches]
    assert sum(map(len, for_testing(replace(sample, batches=every)))) == len(sample)


def test_the_angle_of_a_known_rotation_is_found():
    rng = np.random.default_rng(0)
    corners = rng.normal(size=(5, 8, 3)) * [4, 4, 2]
    angles = np.array([0.0, 1e-4, 0.5, 40.0, 175.0])
    turns = Rotation.from_rotvec(np.radians(angles)[:, None] * np.array([[0.6, 0, 0.8]]))
    moved = np.einsum("tij,tkj->tki", turns.as_matrix(), corners) + 7
    np.testing.assert_allclose(rotations(moved, corners), angles, atol=1e-6)


def test_examples_are_the_best_and_the_worst(sample, model):
    found = evaluate(model, for_testing(sample))
    last = found.errors.percent[:, -1]
    assert last[found.example(0.0)] == last.min()
    assert last[found.example(1.0)] == last.max()
    for k in range(len(last)):
        batch, frames, t = found.trial(k)
        assert batch.numbers[t] == found.errors.numbers[k]
        np.testing.assert_array_equal(frames.joints[t, 0], first_frame(designs_of(batch)).joints[t])
