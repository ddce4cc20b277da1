"""The last frame alone, reached in fewer steps, is the last of twelve."""

import numpy as np
import pytest

from simulearn.grid import Rules, draw_valid
from simulearn.learn.common.bundle import bundle_of
from simulearn.learn.common.model import Designs, last_frame
from simulearn.learn.equilibrium import native

NEAR = 1e-5  # mm


@pytest.fixture(scope="module")
def designs() -> Designs:
    grids = [draw_valid(Rules(), 31, k)[0].centred for k in range(5)]
    flat, ratios = np.stack([g.joints for g in grids]), np.stack([g.actuators for g in grids])
    return Designs(grids[0].beams, grids[0].fixed, flat, ratios)


def test_it_is_that_of_a_rollout(designs):
    model = bundle_of("equilibrium").model
    frames, last = model.rollout(designs), last_frame(model, designs)
    assert last.converged.all()
    assert np.abs(frames.joints[:, -1] - frames.joints[:, 0]).max() > 10
    np.testing.assert_allclose(last.joints, frames.joints[:, -1], atol=NEAR)
    np.testing.assert_allclose(last.sections, frames.sections[:, -1], atol=NEAR)


def test_what_does_not_converge_in_few_steps_is_solved_frame_by_frame(designs, monkeypatch):
    model, correct, calls = bundle_of("equilibrium").model, native._last_corrected, []

    def failing(*parts):
        path = correct(*parts)
        calls.append(path)
        if len(calls) == 2:
            path.ended = False
        return path

    monkeypatch.setattr(native, "cores", lambda: 1)
    frames = model.rollout(designs)
    monkeypatch.setattr(native, "_last_corrected", failing)
    last = last_frame(model, designs)
    assert len(calls) == 5
    assert last.converged.all()
    np.testing.assert_array_equal(last.joints[1], frames.joints[1, -1])
