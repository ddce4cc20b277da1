"""Graphs: lengths and places of features, adjacency, and what a turn does to them."""

import numpy as np
import pytest
import trials

from simulearn.dataset import features
from simulearn.dataset.augment import mirrored, turned
from simulearn.dataset.features import (
    adjacency,
    edge_features,
    end_modes,
    node_features,
    one_hot,
    sides,
)


def test_features_have_the_lengths_of_the_paper():
    batch = trials.batch()
    assert edge_features(batch).shape == (2, 12, 4, features.EDGE) == (2, 12, 4, 139)
    assert edge_features(batch, stress=False).shape == (2, 12, 4, features.EDGE_PLAIN)
    assert node_features(batch).shape == (2, 12, 4, features.NODE) == (2, 12, 4, 31)


def test_the_parts_lie_where_they_are_said_to():
    batch = trials.batch()
    edges, nodes = edge_features(batch), node_features(batch)
    sections = edges[..., features.SECTIONS].reshape(batch.sections.shape)
    np.testing.assert_array_equal(sections, batch.sections)
    stress = edges[..., features.STRESS].reshape(batch.stress.shape)
    np.testing.assert_array_equal(stress, batch.stress)
    np.testing.assert_array_equal(edges[:, 5, :, 135], batch.actuators)
    corners = nodes[..., features.CORNERS].reshape(batch.joints.shape)
    np.testing.assert_array_equal(corners, batch.joints)
    plain = edge_features(batch, stress=False)
    np.testing.assert_array_equal(plain[..., :39], edges[..., :39])
    np.testing.assert_array_equal(plain[..., 39:], edges[..., 135:])


def test_vectors_lead_to_the_fixed_joint_and_only_it_is_flagged():
    batch = trials.batch()
    nodes, edges = node_features(batch), edge_features(batch)
    held = nodes[:, :, batch.fixed, features.CENTRE]
    for graph in (nodes, edges):
        reached = graph[..., features.CENTRE] + graph[..., -3:]
        np.testing.assert_allclose(reached, held[:, :, None] + 0 * reached, atol=1e-12)
    flags = nodes[..., features.FIXED]
    np.testing.assert_array_equal(np.flatnonzero(flags[0, 3]), [batch.fixed])
    assert flags.sum() == flags.shape[0] * flags.shape[1]


def test_without_stresses_the_first_stage_has_no_features():
    from dataclasses import replace

    with pytest.raises(ValueError, match="needs stresses"):
        edge_features(replace(trials.batch(), stress=None))


def test_a_mode_names_side_end_and_hand():
    batch = trials.batch()
    modes, side = end_modes(batch), sides(batch)
    np.testing.assert_array_equal((modes - 1) // 4, side)
    np.testing.assert_array_equal((modes - 1) // 2 % 2, [[[0, 1]] * 4] * 2)
    corners, sections = batch.joints[:, 0], batch.sections[:, 0]
    for t in range(2):
        for b, ends in enumerate(batch.beams):
            for end, joint in enumerate(ends):
                mode = modes[t, b, end] - 1
                first = corners[t, joint, mode // 4]
                meets = sections[t, b, 2 * end, mode % 2]  # right-bottom or left-bottom
                np.testing.assert_allclose(first, meets, atol=1e-9)


def test_adjacency_is_zero_where_nothing_meets():
    batch = trials.batch()
    whole = adjacency(batch)
    assert whole.shape == (2, 4, 4)
    assert ((whole > 0).sum(axis=2) == 2).all()
    assert whole.max() <= features.MODES
    assert (np.take_along_axis(whole, batch.beams[None], axis=2) == end_modes(batch)).all()


def test_every_mode_has_its_own_place_in_the_one_hot_vector():
    vectors = one_hot(np.arange(17))
    np.testing.assert_array_equal(vectors[0], 0)
    np.testing.assert_array_equal(vectors[1:], np.eye(16))


@pytest.mark.parametrize("change", ["turn", "mirror"])
def test_features_of_a_turned_trial_turn(change):
    batch = trials.batch()
    if change == "turn":
        c, s = np.cos(0.8), np.sin(0.8)
        other, matrix = turned(batch, 0.8), np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        swap = [0, 1, 2, 3]
    else:
        other, matrix, swap = mirrored(batch), np.diag([-1.0, 1, 1]), [1, 0, 3, 2]
    before, after = edge_features(batch), edge_features(other)
    for part in (features.CENTRE, slice(-3, None)):
        np.testing.assert_allclose(after[..., part], before[..., part] @ matrix.T, atol=1e-9)
    sections = before[..., features.SECTIONS].reshape(batch.sections.shape)[:, :, :, :, swap]
    np.testing.assert_allclose(
        after[..., features.SECTIONS].reshape(batch.sections.shape), sections @ matrix.T, atol=1e-9
    )
    nodes, theirs = node_features(batch), node_features(other)
    np.testing.assert_allclose(
        theirs[..., features.CENTRE], nodes[..., features.CENTRE] @ matrix.T, atol=1e-9
    )
    # Corners have other numbers; the one that a beam's start meets is still the one it meets.
    # Mirrored, it is the other corner of the side.
    hand = 0 if change == "turn" else 1
    np.testing.assert_allclose(met(other, theirs, hand), met(batch, nodes, 0) @ matrix.T, atol=1e-9)


def met(batch, nodes, hand):
    """A corner (T, B, 3) of the side that each beam's start meets, in frame 7."""
    corner = (sides(batch)[:, :, 0] + hand) % 4
    corners = nodes[..., features.CORNERS].reshape(batch.joints.shape)
    return corners[np.arange(len(batch))[:, None], 7, batch.beams[None, :, 0], corner]
