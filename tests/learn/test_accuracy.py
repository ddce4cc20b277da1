"""The shipped models predict the sample's test trials as accurately as their cards say.

Mechanics, network or geometry could change while the weights stay: then these errors grow.
"""

import numpy as np
import pytest

from simulearn.learn.common.bundle import bundle_of
from simulearn.learn.common.evaluate import evaluate, for_testing

# Mean vertex error of the last frame, % of dimension: the cards' .09, .95 and 1.69 with room for
# few trials.
MOST = {"equilibrium": 0.2, "beams": 1.6, "paper": 3.0}


@pytest.mark.parametrize("name", MOST)
def test_errors_are_those_of_the_card(name, sample):
    errors = evaluate(bundle_of(name).model, for_testing(sample)).errors
    assert errors.converged.all()
    assert errors.percent[:, -1].mean() < MOST[name]
    assert errors.percent[:, 1:].mean() < MOST[name]


def test_frame_zero_is_the_design(sample):
    errors = evaluate(bundle_of("equilibrium").model, for_testing(sample)).errors
    np.testing.assert_allclose(errors.vertex[:, 0], 0, atol=5e-3)  # the steps of packing
