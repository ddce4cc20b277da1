"""The laws of all models, over the ones that come with SimuLearn and a small one."""

import numpy as np
import pytest
from conformance import LAWS, designs_like, mirrored_error, name_of, turned_error

from simulearn.grid import Rules
from simulearn.learn.common.bundle import bundle_of, shipped

EXACT = {"beams", "equilibrium"}  # kinds that turn exactly with the design


@pytest.fixture(scope="module", params=["small", *shipped()])
def each_model(request):
    if request.param == "small":
        return request.getfixturevalue("model")
    return bundle_of(request.param).model


@pytest.mark.parametrize("law", LAWS, ids=name_of)
def test_it_conforms(law, each_model, designs):
    law(each_model, designs)


def test_it_answers_for_another_topology(each_model):
    designs = designs_like(Rules(cells=(1, 2)), 2)
    for law in LAWS[:3]:
        law(each_model, designs)


@pytest.mark.parametrize("name", shipped())
def test_it_turns_with_the_design(name, designs):
    bundle = bundle_of(name)
    exact = bundle.card.kind in EXACT
    most = 1e-4 if exact else 0.02 * float(np.mean(designs.dimensions))
    assert turned_error(bundle.model, designs) < most
    assert mirrored_error(bundle.model, designs) < most
    if not exact:  # or the words about it in its card would be wrong
        assert turned_error(bundle.model, designs) > 1e-4
