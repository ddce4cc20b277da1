"""Random designs: the same everywhere, and as the rules say."""

import hashlib

import numpy as np
import pytest
from grids import MATERIAL, SECTION

from simulearn.errors import InputError
from simulearn.grid import Rules, draw, draw_valid, outline, validate

RULES = Rules()
MANY = [draw(RULES, 1, k) for k in range(400)]


def test_a_design_is_the_same_on_every_machine():
    digest = hashlib.sha256()
    for k in range(20):
        grid = draw(RULES, 5, k)
        digest.update(grid.joints.astype("<f8").tobytes() + grid.actuators.astype("<f8").tobytes())
    assert digest.hexdigest() == "48826c21c1de3a5d0e0ecc77f9c51fb1c293ef007da9d59e5a5998da066ec317"


def test_a_design_depends_on_seed_and_number_and_redraw():
    drawn = [draw(RULES, *key).joints.tobytes() for key in [(0, 0), (0, 1), (1, 0), (0, 0, 1)]]
    assert len(set(drawn)) == 4
    assert draw(RULES, 0, 0).joints.tobytes() == drawn[0]


def test_joints_and_beams_are_those_of_the_rules():
    for grid in MANY[:20]:
        assert (len(grid.joints), len(grid.beams), grid.fixed) == (9, 12, 4)
        np.testing.assert_array_equal(grid.joints[4], 0)
    grid = draw(Rules(cells=(3, 2)), 0, 0)
    assert (len(grid.joints), len(grid.beams)) == (12, 17)


def test_without_jitter_a_design_is_a_lattice():
    grid = draw(Rules(jitter=0.0, length=(50.0, 50.0)), 0, 0)
    np.testing.assert_array_equal(grid.joints[8], [50, 50])


def test_ratios_are_drawn_as_the_rules_say():
    ratios = np.concatenate([grid.actuators for grid in MANY])
    n = len(ratios)
    deviation = 4 * np.sqrt(0.33 * 0.67 / n)
    assert abs((ratios == 0).mean() - 0.33) < deviation + 0.005
    assert abs((ratios > 0).sum() / (ratios != 0).sum() - 0.5) < deviation
    assert set(abs(ratios)) == {0, 0.25, 0.5, 0.75, 1}
    # Short actuators were raised to the next quarter.
    assert 0.1 < (abs(ratios) == 0.25).mean() < (abs(ratios) == 0.5).mean() < 0.25


def test_actuators_are_long_enough():
    for grid in MANY:
        assert "actuator-short" not in [e.code for e in validate(grid, MATERIAL).errors]


def test_a_short_actuator_is_raised_to_the_next_quarter():
    def ratios(net, **options):
        width = SECTION.width
        rules = Rules(jitter=0.0, length=(net + width,) * 2, inactive=0.0, **options)
        return {abs(r) for k in range(5) for r in draw(rules, 0, k).actuators}

    assert ratios(41.0) == {0.25, 0.5, 0.75, 1.0}
    assert ratios(39.0) == {0.5, 0.75, 1.0}
    assert ratios(11.0) == {1.0}
    assert ratios(9.0) == {0.0}
    assert ratios(9.0, shortest=5.0) == {0.75, 1.0}


def test_valid_designs_are_valid_and_their_redraws_counted():
    redraws = 0
    for k in range(150):
        grid, n = draw_valid(RULES, 1, k)
        assert validate(grid, MATERIAL).valid
        np.testing.assert_array_equal(grid.joints, draw(RULES, 1, k, n).joints)
        outline(grid, SECTION)
        redraws += n
    assert redraws < 10


def test_rules_that_give_no_valid_design_say_so():
    with pytest.raises(InputError, match="gave no valid design in 1000 redraws; of the last"):
        draw_valid(Rules(length=(5.0, 5.0), cells=(1, 1), jitter=0.0), 0, 0)
