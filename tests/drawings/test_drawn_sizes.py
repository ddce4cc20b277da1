"""Units, sizes, planes: what is taken, what is asked, what is refused."""

import numpy as np
import pytest
from messy import drawing, l_grid, same

from simulearn.drawings.drawing import Curve, Line, Unit
from simulearn.drawings.importing import Options, grid_of
from simulearn.drawings.units import UnitError, guessed, unit_named
from simulearn.errors import InputError
from simulearn.units import LENGTHS


def scaled(factor):
    return [line * factor for line in l_grid()]


def codes(result):
    return {message.code: message.message for message in result.messages}


@pytest.mark.parametrize(
    ("name", "mm"),
    [("mm", 1), ("Meters", 1000), ("INCHES", 25.4), ("inch", 25.4), ("Feet", 304.8), ("µm", 0.001),
     ("Millimetre", 1), ("pt", 25.4 / 72), ("px", 25.4 / 96), (" cm ", 10), ('"', 25.4)],
)  # fmt: skip
def test_units_by_name(name, mm):
    assert unit_named(name, "").mm == pytest.approx(mm)


def test_a_unit_that_is_none():
    with pytest.raises(InputError, match='"furlong" is no unit of length; units are mm, cm'):
        unit_named("furlong", "")


@pytest.mark.parametrize("name", ["mm", "cm", "m", "in", "px", "pt", "um"])
def test_the_unit_of_beams_of_65_mm_is_guessed(name):
    guess = guessed(65 / LENGTHS[name])
    assert guess is not None
    assert guess.name == name


def test_no_unit_fits_beams_of_a_millionth():
    assert guessed(1e-6) is None


@pytest.mark.parametrize("name", ["m", "in", "um", "cm"])
def test_the_unit_of_the_file_is_taken_and_reported(name):
    unit = Unit(LENGTHS[name], name, "the header")
    result = grid_of(drawing(scaled(1 / unit.mm), plain=False, unit=unit))
    assert same(result.grid, l_grid())
    assert codes(result)["unit"] == f"the unit is {name} (the header); the drawing is 130 x 130 mm"


def test_a_drawing_without_a_unit_is_a_question():
    with pytest.raises(UnitError, match="does not say its unit") as error:
        grid_of(drawing(scaled(1 / 25.4), plain=False))
    assert error.value.code == "unit-unknown"
    assert error.value.guess.name == "in"
    assert error.value.size == pytest.approx((5.118, 5.118), abs=1e-3)
    known = grid_of(drawing(scaled(1 / 25.4), plain=False), Options(unit="in"))
    assert same(known.grid, l_grid())


@pytest.mark.parametrize("factor", [1 / 25.4, 1e-3, 1e3])
def test_a_unit_that_makes_an_odd_size_is_a_question(factor):
    unit = Unit(1.0, "mm", "the header")
    with pytest.raises(UnitError, match="the header, but in mm the middle beam would be"):
        grid_of(drawing(scaled(factor), plain=False, unit=unit))
    forced = grid_of(drawing(scaled(1 / 25.4), plain=False, unit=unit), Options(unit="mm"))
    assert len(forced.grid.beams) == 10


def test_plain_numbers_of_an_odd_size_are_mm_with_a_warning():
    result = grid_of(drawing(scaled(1e-3)))
    assert same(result.grid, scaled(1e-3), 1e-6)
    assert 'the likely unit is "m", with which it is 130 x 130 mm' in codes(result)["size-odd"]


def test_the_width_goes_before_every_unit():
    result = grid_of(drawing(scaled(0.37), plain=False), Options(width=130, unit="in"))
    assert same(result.grid, l_grid())
    with pytest.raises(InputError, match="the width is 0 mm; it is more than 0"):
        grid_of(drawing(l_grid()), Options(width=0))


def test_the_lower_left_corner_becomes_the_origin_and_that_is_reported():
    far = [line + np.array([5e5, -3e6]) for line in l_grid()]
    result = grid_of(drawing(far))
    np.testing.assert_allclose(result.grid.joints.min(axis=0), 0, atol=1e-9)
    assert same(result.grid, l_grid())
    assert codes(result)["moved"].startswith("moved by [-500000, 3e+06] mm")
    # The same where it would stay, since such coordinates are none of a grid.
    assert "moved" in codes(grid_of(drawing(far), Options(place="drawn")))


def test_a_grid_can_stay_where_it_is_drawn():
    lines = [line + np.array([30, -40]) for line in l_grid()]
    result = grid_of(drawing(lines), Options(place="drawn"))
    np.testing.assert_allclose(result.grid.joints.min(axis=0), [30, -40])
    assert "moved" not in codes(result)
    moved = grid_of(drawing(lines))
    assert codes(moved)["moved"] == (
        "moved by [-30, 40] mm, so that its lower left corner is the origin"
    )


# The rest is about planes.


def in_space(x_axis, y_axis, lines=None, **more):
    spatial = [line @ np.array([x_axis, y_axis], float) for line in lines or l_grid()]
    found = drawing([], **more)
    return found.__class__("test", [Line(points) for points in spatial], plain=True)


@pytest.mark.parametrize(
    ("x", "y"),
    [
        ((1, 0, 0), (0, 1, 0)),  # from above
        ((1, 0, 0), (0, 0, 1)),  # from the front
        ((0, 1, 0), (0, 0, 1)),  # from the right
        ((0.8, 0, 0.6), (0, 1, 0)),  # tilted about y
        ((1, 0, 0), (0, 0.8, 0.6)),  # tilted about x
        ((1, 0, 0), (0, 0.6, 0.8)),  # steep, seen from the front
        ((0.6, -0.8, 0), (0, 0, 1)),  # upright and askew
    ],
)
def test_lines_in_any_plane_are_seen_upright(x, y):
    result = grid_of(in_space(x, y))
    assert same(result.grid, l_grid())
    assert ("plane" in {mend.code for mend in result.mends}) == (x[2] != 0 or y[2] != 0)


def test_noise_in_the_height_is_nothing():
    lines = in_space((1, 0, 0), (0, 1, 0)).lines
    random = np.random.default_rng(3)
    noisy = [Line(line.points + random.uniform(-1, 1, (2, 3)) * [0, 0, 1e-6]) for line in lines]
    result = grid_of(drawing([]).__class__("test", noisy, plain=True))
    assert same(result.grid, l_grid())
    assert not result.mends


def test_lines_that_are_not_flat_are_refused_with_the_place():
    lines = in_space((1, 0, 0), (0, 1, 0)).lines
    lines[3] = Line(lines[3].points + np.array([[0, 0, 0], [0, 0, 30]]))
    bent = drawing([]).__class__("test", lines, plain=True)
    with pytest.raises(InputError, match=r"do not lie in one plane: at \[.*\] mm one is") as error:
        grid_of(bent)
    assert error.value.code == "not-flat"
    assert same(grid_of(bent, Options(without=frozenset({"plane"}))).grid, l_grid())


# And about curves.


def arc(step):
    angle = np.linspace(0, np.pi, max(2, int(np.pi / (2 * np.arccos(1 - min(step, 40) / 50))) + 1))
    return np.stack([50 * np.cos(angle), 50 * np.sin(angle), 0 * angle], axis=1)


def test_curves_become_chords_only_on_request():
    chord = drawing([[[-50, 0], [50, 0]]], curves=[Curve("ARC", arc, "shapes")])
    assert "1 x ARC" in codes(grid_of(chord))["curves"]
    result = grid_of(chord, Options(flatten=2))
    assert len(result.grid.beams) == len(arc(2))
    assert {mend.code: mend.count for mend in result.mends} == {"flattened": 1}
    with pytest.raises(InputError, match=r"only curves .1 x ARC. and no straight lines") as error:
        grid_of(drawing([], curves=[Curve("ARC", arc)]))
    assert error.value.code == "curves-only"


def test_no_lines_at_all():
    with pytest.raises(InputError, match="the drawing has no lines") as error:
        grid_of(drawing([]))
    assert error.value.code == "no-lines"
    with pytest.raises(InputError, match="all lines are shorter than the tolerance of 1 mm"):
        grid_of(drawing(scaled(1e-3)), Options(unit="mm"))


def test_the_chords_of_a_small_curve_do_not_make_the_size_odd():
    def circle(chord):
        angles = np.linspace(0, 2 * np.pi, 33)
        return np.stack([65 + 4 * np.cos(angles), 65 + 4 * np.sin(angles), 0 * angles], axis=1)

    unit = Unit(1.0, "mm", "the test")
    found = drawing(l_grid(), plain=False, unit=unit, curves=[Curve("CIRCLE", circle)])
    assert {mend.code for mend in grid_of(found, Options(flatten=0.5)).mends} >= {"flattened"}


@pytest.mark.parametrize("option", ["tolerance", "flatten"])
def test_options_that_make_no_sense(option):
    for value in (0, -1, float("nan"), float("inf")):
        with pytest.raises(InputError, match=f"the {option} is .* mm; it is more than 0"):
            grid_of(drawing(l_grid()), Options(**{option: value}))


@pytest.mark.parametrize("value", [float("nan"), float("inf"), 1e300])
def test_a_coordinate_that_makes_no_sense(value):
    with pytest.raises(InputError, match=r"a line has a point at \[.*, 0, 0\]; coordinates are"):
        grid_of(drawing([*l_grid(), [[0, 0], [value, 0]]]))


def test_lines_of_no_length():
    with pytest.raises(InputError, match="all lines have the length 0") as error:
        grid_of(drawing([[[0, 0], [0, 0]], [[5, 5], [5, 5]]]))
    assert error.value.code == "no-lines"


def test_what_is_always_mended_is_reported():
    result = grid_of(drawing([*l_grid(), l_grid()[0]]), Options(without=frozenset({"double"})))
    assert same(result.grid, l_grid())
    assert codes(result)["mend-needed"].startswith("double: a grid has one beam between two")
