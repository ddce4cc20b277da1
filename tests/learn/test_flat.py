"""The first frame is known: that of the design is that of its trial."""

import numpy as np

from simulearn.dataset.features import end_modes
from simulearn.learn.common.first_frame import designs_of, first_frame


def test_corners_are_those_of_the_trial(sample):
    for batch in sample.batches:
        first = first_frame(designs_of(batch))
        np.testing.assert_allclose(first.joints, batch.joints[:, 0], atol=0.003)
        np.testing.assert_allclose(first.sections, batch.sections[:, 0], atol=0.003)


def test_the_printed_stress_is_that_of_the_trial(sample):
    for batch in sample.batches:
        np.testing.assert_allclose(
            first_frame(designs_of(batch)).stress, batch.stress[:, 0], atol=1e-5
        )


def test_modes_are_those_of_the_features(sample):
    for batch in sample.batches:
        np.testing.assert_array_equal(first_frame(designs_of(batch)).modes, end_modes(batch))
