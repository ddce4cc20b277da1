"""Borders: versions of shared joints come closer, and their targets stay on the surface."""

import numpy as np
from modules import ring

from simulearn.tile import alike
from simulearn.tile.borders import fit, gaps, weights


def test_modules_that_fit_have_no_gaps():
    tiling = ring()
    kinds, members = alike(tiling.targets, tiling.lattice, 0.1)
    found = fit(tiling, members, kinds, tiling.points)
    assert found.gap_mm < 0.05  # the surface is triangles
    assert found.error_mm < 0.05


def test_moved_targets_bring_versions_closer_and_stay_on_the_surface():
    tiling = ring(cells=(2, 2))
    kinds, members = alike(tiling.targets, tiling.lattice, 0.1)
    source = np.random.default_rng(1)
    bent = kinds + source.normal(0, 0.5, kinds.shape)
    found = fit(tiling, members, bent, tiling.points)
    before = np.array(
        [p(m.shape(bent[m.kind])) for p, m in zip(found.places, members, strict=True)]
    )
    np.testing.assert_allclose(gaps(tiling, before), found.gaps, atol=1e-12)
    moved = np.linalg.norm(found.targets - tiling.points, axis=1)
    assert moved[tiling.shared].max() > 0.1
    assert moved[~tiling.shared].max() == 0
    assert tiling.surface.distance(found.targets[tiling.shared]).max() < 1e-9
    alone = fit(tiling, members, bent, found.targets)
    assert (alone.away**2).sum() <= (found.away**2).sum() + 1e-6


def test_shared_joints_count_more():
    tiling = ring(cells=(2, 2))
    members = alike(tiling.targets, tiling.lattice, 0.1)[1]
    counts = weights(tiling, members, 1)[0]
    np.testing.assert_array_equal(counts, [2, 1, 2, 2, 1, 2, 2, 1, 2])
