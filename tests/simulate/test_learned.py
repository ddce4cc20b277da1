"""The engine `learned` around its model: what qualifies an answer, batches, stopping."""

import threading
from types import SimpleNamespace

import numpy as np
import pytest

import synthetic
from simulearn.errors import CancelledError
from simulearn.grid import Rules, TrainingRange, draw_valid, make
from simulearn.learn.common.model import Designs
from simulearn.material import Identity, load_material
from simulearn.schedule import Snap
from simulearn.simulate import Failure, Result, engine, learned
from simulearn.simulate.learned import Learned

PLA = load_material("pla-hot-water")


class Formula:
    """A model by formula that has learnt grids of four cells."""

    bound = SimpleNamespace(counts=np.array([9.0, 12.0]))

    def __init__(self):
        self.batches = []

    def rollout(self, designs: Designs):
        count = len(designs)
        self.batches.append(count)
        shapes = [synthetic.result(grid, solid=False) for grid in learned_grids(designs)]
        return SimpleNamespace(
            joints=np.array([shape.joints for shape in shapes]),
            sections=np.array([shape.beams for shape in shapes]),
            stress=None,
            bound_mm=np.full(count, 0.3),
            converged=np.arange(count) != 1,  # the second one of a batch has no answer
            stable=np.arange(count) != 2,
            snaps=[(Snap(0.9, 9),) if t == 2 else () for t in range(count)],
            left_balance=np.arange(count) == 2,
        )


def learned_grids(designs):
    from simulearn.inverse.scoring import grids

    return grids(designs)


@pytest.fixture
def simulator():
    card = SimpleNamespace(
        name="formula",
        kind="formula",
        material=PLA,
        range=TrainingRange(dimension=(60.0, 100.0), beam_length=(30.0, 70.0)),
    )
    identity = Identity(name="formula", digest="ab" * 32)
    return Learned(SimpleNamespace(card=card, model=Formula(), identity=identity))


def test_what_the_model_knows_of_its_answer_is_in_the_result(simulator):
    plain, failure, doubtful = simulator.simulate([make("saddle", length=60.0)] * 3)
    assert isinstance(failure, Failure)
    assert failure.code == "no-answer"
    assert (plain.stable, plain.snaps, plain.warnings) == (True, (), ())
    assert (doubtful.stable, doubtful.snaps) == (False, (Snap(0.9, 9),))
    codes = [message.code for message in doubtful.warnings]
    assert codes == ["unstable-balance", "bound-after-snap"]
    assert plain.bound_mm == 0.3
    assert plain.model.name == "formula"


@pytest.mark.parametrize(
    ("grid", "codes"),
    [
        (make("saddle", length=80.0), {"beam-long", "grid-size"}),
        (make("flat", (1, 2), 60.0), set()),
        (make("flat", (2, 3), 65.0), {"grid-size"}),
        (make("saddle", length=60.0), set()),
    ],
)
def test_grids_unlike_those_that_were_learnt_are_warned_of(simulator, grid, codes):
    (result,) = simulator.simulate([grid])
    assert {message.code for message in result.warnings} == codes


def test_one_batch_for_each_topology(simulator):
    grids = [make("saddle", length=60.0), make("cone", (1, 2)), make("cone", length=60.0)] * 3
    outcomes = simulator.simulate(grids)
    assert simulator.bundle.model.batches == [6, 3]
    for grid, outcome in zip(grids, outcomes, strict=True):
        if isinstance(outcome, Result):
            np.testing.assert_array_equal(outcome.grid.actuators, grid.actuators)


def test_large_batches_are_divided_and_a_token_stops_between_them(simulator, monkeypatch):
    monkeypatch.setattr(learned, "BATCH", 2)
    token, done = threading.Event(), []

    def progress(frames, total):
        done.append(frames)
        if len(done) == 2:
            token.set()

    with pytest.raises(CancelledError):
        simulator.simulate([make("saddle", length=60.0)] * 7, progress, token)
    assert simulator.bundle.model.batches == [2, 2]
    assert done == [24, 48]


def test_a_bound_does_not_speak_of_what_follows_a_snap():
    grid, _ = draw_valid(Rules(), 9000, 3876)
    (result,) = engine("learned").simulate([grid])
    assert result.snaps
    assert 0.7 < result.snaps[0].released < 0.95  # finite elements: .84
    assert result.stable
    assert result.bound_mm is None
    assert "bound-after-snap" in [warning.code for warning in result.warnings]
