"""The last frame alone, reached in fewer steps, is the last of twelve."""

import numpy as np
import pytest

from simulearn.grid import Rules, draw_valid
from simulearn.learn.bundle import bundle_of
from simulearn.learn.equilibrium import Equilibrium
from simulearn.learn.model import Designs, last_frame

NEAR = 0.1  # mm; both are solved to .05


@pytest.fixture(scope="module")
def asked() -> Designs:
    grids = [draw_valid(Rules(), 31, k)[0].centred for k in range(5)]
    flat, ratios = np.stack([g.joints for g in grids]), np.stack([g.actuators for g in grids])
    return Designs(grids[0].beams, grids[0].fixed, flat, ratios)


def test_it_is_that_of_a_rollout(asked):
    model = bundle_of("equilibrium").model
    frames, last = model.rollout(asked), last_frame(model, asked)
    assert last.converged.all()
    assert np.abs(frames.joints[:, -1] - frames.joints[:, 0]).max() > 10
    np.testing.assert_allclose(last.joints, frames.joints[:, -1], atol=NEAR)
    np.testing.assert_allclose(last.sections, frames.sections[:, -1], atol=NEAR)


def test_what_is_not_found_in_few_steps_is_asked_frame_by_frame(asked, monkeypatch):
    model, told, calls = bundle_of("equilibrium").model, Equilibrium.told, []

    def failing(self, designs, last=False):
        calls.append((len(designs), last))
        found = told(self, designs, last)
        lost = np.arange(len(designs)) == 1
        return found._replace(way=np.where(lost & last, np.inf, found.way))

    frames = model.rollout(asked)
    monkeypatch.setattr(Equilibrium, "told", failing)
    last = last_frame(model, asked)
    assert calls == [(5, True), (1, False)]
    assert last.converged.all()
    np.testing.assert_allclose(last.joints[1], frames.joints[1, -1], atol=1e-9)
