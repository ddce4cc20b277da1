"""Parts of what hangs together, against SciPy."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from simulearn.drawings.parts import parts


@given(st.integers(1, 60), st.integers(0, 2**32 - 1), st.floats(0, 3))
def test_parts_are_those_of_scipy(count, seed, often):
    random = np.random.default_rng(seed)
    a, b = random.integers(0, count, (2, int(often * count)))
    graph = coo_array((np.ones(len(a)), (a, b)), shape=(count, count))
    total, expected = connected_components(graph, directed=False)
    found = parts(count, a, b)
    assert len(np.unique(found)) == total
    for part in np.unique(expected):
        assert set(found[expected == part]) == {np.flatnonzero(expected == part)[0]}


def test_a_long_chain_in_any_order():
    order = np.random.default_rng(5).permutation(100_000)
    assert (parts(100_000, order[1:], order[:-1]) == 0).all()
