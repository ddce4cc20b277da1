"""Charts and patches: even, shared at borders, outside outwards; wrong input in one line."""

import json

import numpy as np
import pytest

from simulearn.errors import InputError
from simulearn.tile import between, chart_from_dict, from_chart, heights, read_tiling, revolution
from simulearn.tile.patches import counted

CONE = [[90.0, 0.0], [60.0, 200.0]]


def test_modules_around_a_closed_surface_share_their_borders_and_face_outwards():
    tiling = from_chart(revolution(CONE), (5, 3))
    assert tiling.modules.shape == (15, 9)
    assert len(tiling.points) == 10 * 7  # ten meridians, seven rings
    assert tiling.names[5] == "r2c1"
    first, last = tiling.modules[0], tiling.modules[4]
    assert set(first[[0, 3, 6]]) == set(last[[2, 5, 8]])
    radial = tiling.points[:, :2] / np.linalg.norm(tiling.points[:, :2], axis=1, keepdims=True)
    assert ((tiling.normals[:, :2] * radial).sum(axis=1) > 0.9).all()
    assert tiling.shared.sum() == 70 - 15 - 5 * 2 * 1  # all but centres and middles of open rims
    np.testing.assert_allclose(tiling.surface.distance(tiling.points), 0, atol=0.1)


def test_a_profile_that_goes_down_has_the_same_outside():
    up, down = (from_chart(revolution(profile), (5, 3)) for profile in (CONE, CONE[::-1]))
    np.testing.assert_allclose(up.points, down.points, atol=1e-9)


def test_parameters_go_along_the_surface_evenly():
    steep = heights(lambda x, y: 0.004 * x**2, (0.0, 300.0), (0.0, 100.0))
    tiling = from_chart(steep, (4, 1), (1, 1))
    along = np.linalg.norm(np.diff(tiling.points[:5], axis=0), axis=1)
    assert along.max() / along.min() < 1.03  # chords of equal arcs
    assert (tiling.normals[:, 2] > 0).all()
    assert counted(steep, 100.0) == (5, 1)


def test_between_two_edges_it_begins_and_ends_at_them_in_the_given_directions():
    first, second = [[0, 0, 0], [100, 0, 0]], [[100, 200, 30], [0, 200, 30]]
    ruled, led = between(first, second), between(first, second, [0, 100, 100], None)
    u = np.linspace(0, 1, 5)
    for chart in (ruled, led):
        np.testing.assert_allclose(chart.at(u, 0 * u)[:, 0], 100 * u, atol=1e-9)
        np.testing.assert_allclose(chart.at(u, 0 * u + 1), [[100 * t, 200, 30] for t in u])
    middle = ruled.at(np.array([0.5]), np.array([0.5]))[0]
    np.testing.assert_allclose(middle, [50, 100, 15], atol=1e-9)
    step = led.at(np.array([0.5]), np.array([1e-5]))[0] - [50, 0, 0]
    np.testing.assert_allclose(step / 1e-5, [0, 100, 100], atol=0.1)


@pytest.mark.parametrize(
    ("part", "where"),
    [
        ({}, "has none of them; give one of revolution, heights, between"),
        ({"revolution": {"profile": [[1, 2]]}}, "revolution.profile is [[1, 2]]"),
        ({"revolution": {"profile": [[0, 0], [50, 50]]}}, "profile[0] has the radius 0"),
        ({"revolution": {"profile": CONE, "degrees": 400}}, "it is more than 0 and at most 360"),
        (
            {"revolution": {"profile": CONE, "turns": 1}},
            "is not a key here; the keys are profile, degrees",
        ),
        ({"heights": {"z": "x^2", "x": [0, 1], "y": [0, 1]}}, "a power is written **"),
        ({"heights": {"z": "x", "x": [1, 0], "y": [0, 1]}}, "it is [from, to] in mm"),
        ({"heights": {"z": [[1, 2]], "x": [0, 1], "y": [0, 1]}}, "z is 1 x 2 numbers"),
        ({"heights": {"z": [[1, 2], [3]], "x": [0, 1], "y": [0, 1]}}, "z is no table; each row"),
        ({"between": {"first": [[0, 0, 0], [0, 0, 0]], "second": [[0, 1, 0], [1, 1, 0]]}}, "twice"),
        ({"between": {"first": [[0, 0, 0], [1, 0, 0]]}}, "between.second is missing"),
    ],
)
def test_wrong_surfaces_are_reported_by_key(part, where):
    def points():
        chart = chart_from_dict({"schema": "simulearn.chart/1", **part})
        return chart.at(np.zeros(1), np.zeros(1))

    with pytest.raises(InputError) as error:
        points()
    assert where in str(error.value)
    assert "\n" not in str(error.value)


def test_a_table_of_heights_is_smooth_through_its_values():
    x, y = [0, 100, 200, 300], [0, 100, 200, 300]
    table = [[0.001 * a * b for a in x] for b in y]
    chart = chart_from_dict(
        {"schema": "simulearn.chart/1", "heights": {"z": table, "x": x, "y": y}}
    )
    points = chart.at(np.array([1 / 3, 0.5]), np.array([2 / 3, 0.5]))
    np.testing.assert_allclose(points[:, 2], [20.0, 22.5], atol=1e-9)


def test_what_is_missing_or_too_much_is_reported(tmp_path):
    path = tmp_path / "cone.json"
    data = {"schema": "simulearn.chart/1", "revolution": {"profile": CONE}}
    path.write_text(json.dumps(data), encoding="utf-8")
    for words, text in (
        ({}, "say how many modules"),
        ({"modules": (5, 3), "size": 90.0}, "not both"),
        ({"modules": (1, 3)}, "around a closed surface"),
        ({"modules": (500, 3)}, "1 to 1000 can be tiled"),
        ({"modules": (5, 3), "onto": "x.stl"}, "only the joints of a quad mesh"),
    ):
        with pytest.raises(InputError, match=text):
            read_tiling(path, **words)
    assert len(read_tiling(path, size=100.0).names) == 5 * 2
