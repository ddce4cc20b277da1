"""Assemblies in their order: who morphs and slides when; equal grids once; failures alone."""

import numpy as np
import pytest

import assembling
from simulearn.assembly import Assembly, Part, Step, assembled_to_dict, simulate_assembly
from simulearn.assembly.timeline import PIECE, timeline
from simulearn.errors import ComputationError
from simulearn.schedule import FRAMES

LAST = FRAMES - 1


def test_parts_morph_in_their_step_and_slide_before_it():
    moments = timeline(assembling.three())
    assert moments.seconds == pytest.approx(1 + 2 + 2)
    step, frames, shifts = moments.at(0)
    assert (step, frames.tolist()) == (0, [0, 0, LAST])  # what no step names is ready
    assert shifts[1].tolist() == [0, 0, 50]
    step, frames, shifts = moments.at(0.5)
    assert (step, frames.tolist()) == (0, [pytest.approx(LAST / 2), 0, LAST])
    step, frames, shifts = moments.at(1 + 0.5)  # a quarter of the slide
    assert (step, frames.tolist()) == (1, [LAST, 0, LAST])
    assert shifts[1] == pytest.approx([0, 0, 37.5])
    step, frames, shifts = moments.at(1 + 2 + 1)  # half of the morphing
    assert frames.tolist() == [LAST, pytest.approx(LAST / 2), LAST]
    assert not shifts.any()
    assert moments.at(99)[1].tolist() == [LAST] * 3
    assert moments.waiting[:, 1].sum() == FRAMES  # until it sets out
    assert not moments.waiting[:, [0, 2]].any()


def test_a_slide_is_cut_into_short_pieces_and_frames_are_all_reached():
    moments = timeline(assembling.three())
    assert np.linalg.norm(np.diff(moments.shifts, axis=0), axis=2).max() <= PIECE + 1e-9
    assert (np.diff(moments.times) > 0).all()
    for part in (0, 1):
        assert set(range(FRAMES)) <= set(moments.frames[:, part].tolist())


def test_a_slide_may_go_with_the_morphing_or_have_a_step_of_its_own():
    part = (Part("a", assembling.SQUARE),)
    along = timeline(Assembly(part, (Step(("a",), 3.0, {"a": (90.0, 0, 0)}, "during"),)))
    assert along.seconds == pytest.approx(3.0)
    _, frames, shifts = along.at(1.0)
    assert frames[0] == pytest.approx(LAST / 3)
    assert shifts[0, 0] == pytest.approx(60.0)
    assert set(range(FRAMES)) <= set(np.round(along.frames[:, 0], 9).tolist())
    steps = (Step(("a",)), Step((), 1.0, {"a": (90.0, 0, 0)}))
    later = timeline(Assembly(part, steps))
    assert later.at(1.0)[2][0, 0] == 90.0  # morphs where it waits
    assert later.at(1.5)[2][0, 0] == pytest.approx(45.0)
    assert later.at(1.5)[1][0] == LAST


def test_equal_grids_are_simulated_once():
    engine = assembling.Rolling()
    assembled = simulate_assembly(assembling.three(), engine)
    assert [len(grid.joints) for grid in engine.grids] == [9, 6]
    assert assembled.outcomes[0] is assembled.outcomes[1]


def test_a_part_without_an_answer_takes_no_other_along():
    parts = (Part("good", assembling.SQUARE), Part("bad", assembling.BROKEN))
    assembled = simulate_assembly(Assembly(parts), assembling.Rolling())
    assert [part.name for _, part, _ in assembled.present] == ["good"]
    assert assembled.failures["bad"].code == "no-answer"
    data = assembled_to_dict(assembled)
    assert [part["ok"] for part in data["parts"]] == [True, False]
    assert data["parts"][1]["message"] == "there is no answer"
    nothing = simulate_assembly(Assembly(parts[1:]), assembling.Rolling())
    with pytest.raises(ComputationError, match="part bad: there is no answer"):
        nothing.require()


def test_the_machine_form_has_places_times_and_shifts():
    assembled = simulate_assembly(assembling.three(), assembling.Rolling())
    data = assembled_to_dict(assembled)
    assert data["schema"] == "simulearn.assembled/1"
    first, second = data["parts"][:2]
    assert second["same_grid_as"] == "first"
    turned = np.array(first["centres"]) @ [[0, 1, 0], [-1, 0, 0], [0, 0, 1]] + [-200, 0, 0]
    np.testing.assert_allclose(second["centres"], turned, atol=1e-3)
    assert (np.array(first["low"]) < np.min(first["centres"], axis=0)).all()
    steps = data["timeline"]["steps"]
    assert [(s["name"], s["begins"], s["ends"]) for s in steps] == [("first", 0, 1), ("in", 1, 5)]
    assert len(data["timeline"]["frames"]) == len(data["timeline"]["times"])
