"""Scans of prints in any pose, with a table, strays and holes: the joints are found again."""

from functools import partial

import numpy as np
import printed
import pytest
from scipy.spatial import KDTree

import synthetic
from simulearn.compare import Scan, compare
from simulearn.compare.aligning import rigid
from simulearn.compare.clutter import without_table
from simulearn.compare.deviation import curvature_of
from simulearn.compare.fitting import fitted
from simulearn.compare.normals import estimated
from simulearn.compare.scanned import place_scan
from simulearn.compare.simulated import stations_of, surface_of
from simulearn.errors import InputError

HIDDEN = printed.shape(printed.material(strain=1.15))


def compared(points, normals=None):
    return compare(printed.grid(), Scan(points, normals), printed.Simulator(), explain=False)


def errors(found, result):
    """Return how far joints are from where they are, brought into the comparison's frame, mm."""
    seen = found.deviation.measured
    places = result.centres[-1][seen]
    pose = rigid(places, found.deviation.simulated[seen])
    return np.linalg.norm(found.deviation.joints[seen] - pose(places), axis=1)


def codes(found):
    return {m.code for m in found.messages}


def test_a_scan_on_its_table_with_a_hole_and_strays():
    rng = np.random.default_rng(1)
    points, _ = printed.surface(HIDDEN, hole=(HIDDEN.centres[-1][8], 22.0))
    found = compared(printed.moved(np.r_[points, printed.table(points, rng, -3.0)], 5) / 1000)
    assert codes(found) == {"measurement-unit", "scan-table", "scan-strays", "joints-missing"}
    assert (~found.deviation.measured).nonzero()[0].tolist() == [8]
    assert errors(found, HIDDEN).max() < 0.3
    assert found.noise == pytest.approx(0.15, abs=0.06)


def test_where_joints_were_measured_does_not_matter_for_a_scan():
    points, _ = printed.surface(HIDDEN)
    given = printed.grid(), Scan(printed.moved(points, 5)), printed.Simulator()
    top, centre = (compare(*given, at=at, explain=False) for at in ("top", "centre"))
    assert codes(top) - codes(centre) == {"measurement-at"}
    np.testing.assert_array_equal(top.deviation.joints, centre.deviation.joints)


def test_a_mirrored_scan_with_its_normals_turned_in():
    points, normals = printed.surface(HIDDEN)
    turn, _ = printed.motion(7)
    found = compared(printed.moved(points * [1, 1, -1], 7), -(normals * [1, 1, -1]) @ turn.T)
    assert "pose-mirrored" in codes(found)
    assert errors(found, HIDDEN).max() < 0.3
    true = stations_of(HIDDEN)
    places, up = (part[9:].reshape(-1, 3, 3) for part in (true.centres, true.up))
    bent = curvature_of(places, up[:, 1])
    # 0.1 degrees per mm are a sagitta of 0.07 mm over the 18 mm between the outer stations.
    assert np.degrees(found.deviation.curvature[:, 0]) == pytest.approx(np.degrees(bent), abs=0.1)
    assert abs(np.degrees(bent - found.deviation.curvature[:, 1])).max() > 0.15
    off = np.linalg.norm((found.deviation.stations - found.deviation.expected)[:, 1], axis=-1)
    assert (found.deviation.beams[:, 0] > 0).all()
    assert (found.deviation.beams[:, 1] < 2 * off.max() + 3).all()


def test_a_cloud_that_is_off_by_more_than_a_thickness():
    design = printed.grid(length=80.0)  # so that a station is 3 mm off where its neighbour has it
    base, print_ = (
        synthetic.result(design, partial(synthetic.cylinder, curvature=k), solid=False)
        for k in (0.012, 0.025)
    )
    points, _ = printed.surface(print_, count=25_000)
    found = fitted(Scan(points), surface_of(base), stations_of(base))
    off = np.linalg.norm(print_.centres[-1] - base.centres[-1], axis=1)
    assert off.max() > 30.0
    assert found.seen.all()
    error = np.linalg.norm(found.places[:9] - print_.centres[-1], axis=1)
    assert error.max() < 0.3


def test_the_outside_of_a_cloud_is_known_where_both_faces_are_scanned():
    points, normals = printed.surface(printed.shape(), noise=0.1)
    found, sure = estimated(points, KDTree(points))
    agree = (found * normals).sum(axis=1)
    assert (agree[sure] > 0).mean() > 0.97
    assert sure.mean() > 0.8
    plane = points[:8000] * [1, 1, 0]
    assert not estimated(plane, KDTree(plane))[1].any()


def test_the_table_is_taken_off_and_a_flat_grid_is_none():
    rng = np.random.default_rng(2)
    points, _ = printed.surface(printed.shape())
    flat = points * [1, 1, 1e-3]
    both = np.r_[flat, printed.table(flat, rng, -2.5)]
    kept, messages = without_table(Scan(both), printed.grid(), 7.2)
    assert [m.code for m in messages] == ["scan-table"]
    assert len(kept.points) == pytest.approx(len(flat), rel=0.05)
    assert without_table(Scan(flat), printed.grid(), 7.2)[1] == []


def test_what_is_in_a_scan_besides_the_grid_is_said():
    base = printed.shape()
    points, _ = printed.surface(base, count=8000)
    ball = np.random.default_rng(0).normal(size=(3000, 3))
    ball *= 12 / np.linalg.norm(ball, axis=1, keepdims=True)
    both = Scan(np.r_[points, ball + points.max(axis=0) + [30.0, 0, 0]])
    found = place_scan(both, base, 7.2)
    assert [m.code for m in found.messages] == ["scan-beyond"]
    assert found.messages[0].message.startswith("27%")


def test_scans_that_cannot_be_compared():
    points, _ = printed.surface(printed.shape(), count=1000)
    with pytest.raises(InputError, match="the scan has 1000 points; at least 1500"):
        compared(points)
    ball = np.random.default_rng(0).normal(size=(4000, 3))
    ball *= 55 / np.linalg.norm(ball, axis=1, keepdims=True)
    with pytest.raises(InputError, match="does not fit the grid"):
        compared(ball)
