"""Random designs of many kinds: sound nets, valid designs, the same on every machine."""

import numpy as np
import pytest

from simulearn.errors import InputError
from simulearn.grid import Kinds, Rules, draw_kind, outline, validate
from simulearn.grid.kinds import OPEN
from simulearn.grid.nets import NETS
from simulearn.material import load_material

PLA = load_material("pla-hot-water")


@pytest.mark.parametrize("kind", NETS)
def test_nets_are_connected_of_beams_of_length_one_and_at_most_four_at_a_joint(kind):
    for seed in range(8):
        joints, beams = NETS[kind](np.random.default_rng(seed).random)
        pairs = np.array(beams)
        assert len({tuple(sorted(pair)) for pair in beams}) == len(beams)
        assert np.bincount(pairs.ravel(), minlength=len(joints)).max() <= 4
        length = np.linalg.norm(np.diff(joints[pairs], axis=1)[:, 0], axis=1)
        assert 0.7 < length.min() <= length.max() < 4.1
        reached, before = {0}, 0
        while len(reached) > before:
            before = len(reached)
            reached |= {j for pair in beams if reached & set(pair) for j in pair}
        assert len(reached) == len(joints)


@pytest.mark.parametrize("kind", NETS)
def test_designs_are_valid_in_their_own_section(kind):
    kinds = Kinds(shares={kind: 1.0})
    for k in range(3):
        design = draw_kind(kinds, Rules(), PLA, 5, k)
        assert design.kind == kind
        outline(design.grid, design.material.section)
        if kind not in OPEN:
            assert validate(design.grid, design.material).valid
        ends = design.grid.joints[design.grid.beams]
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        assert 20 <= length.min() <= length.max() <= 100


def test_a_design_is_drawn_again_alone():
    kinds = Kinds(shares={"2x2": 1.0, "polygon": 2.0})
    designs = [draw_kind(kinds, Rules(), PLA, 9, k) for k in range(12)]
    again = draw_kind(kinds, Rules(), PLA, 9, 7)
    np.testing.assert_array_equal(again.grid.joints, designs[7].grid.joints)
    assert again.material == designs[7].material
    assert {design.kind for design in designs} == {"2x2", "polygon"}


def test_a_kind_that_is_not_known_is_refused():
    with pytest.raises(ValueError, match='kind "moebius" is not known'):
        Kinds(shares={"moebius": 1.0})


def test_rules_that_give_no_valid_design_are_said(monkeypatch):
    monkeypatch.setattr("simulearn.grid.kinds.MOST_REDRAWS", 3)
    with pytest.raises(InputError, match="no valid 2x2"):
        draw_kind(Kinds(shares={"2x2": 1.0}, jitter=1.0, length=(99.0, 99.5)), Rules(), PLA, 1, 0)
