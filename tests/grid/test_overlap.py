"""Overlap of convex pieces, against shapes whose answer is plain."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from simulearn.grid.overlap import overlaps

SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)


@pytest.mark.parametrize(
    ("other", "answer"),
    [
        (SQUARE + 0.5, True),
        (SQUARE + np.array([1, 0]), False),  # side to side
        (SQUARE + 1, False),  # corner to corner
        (SQUARE + np.array([1 - 1e-3, 0]), True),
        (SQUARE * 0.1 + 0.4, True),  # inside
        ((SQUARE - 0.5) @ [[1, 1], [-1, 1]] + [1.6, 1.6], False),  # beside a corner; boxes overlap
        ((SQUARE - 0.5) * [10, 0.1] + 0.5, True),  # across
    ],
)
def test_two_quadrilaterals(other, answer):
    assert len(overlaps(np.stack([SQUARE, other]))) == answer
    assert len(overlaps(np.stack([other, SQUARE]))) == answer


@given(st.lists(st.tuples(st.integers(-3, 3), st.integers(-3, 3)), min_size=1, max_size=6))
def test_squares_on_a_chessboard_overlap_when_they_are_the_same(places):
    result = overlaps(np.stack([SQUARE + place for place in places]))
    n = len(places)
    assert result.tolist() == [
        [a, b] for a in range(n) for b in range(a + 1, n) if places[a] == places[b]
    ]
