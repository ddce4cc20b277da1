"""The network's arithmetic against plain loops over Algorithm 1, and its normalisers."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from conformance import gradient_is_that_of_finite_differences

from simulearn.dataset.features import edge_features, end_modes, node_features, one_hot
from simulearn.learn.common.first_frame import first_frame
from simulearn.learn.paper.graph import graph_of, meetings
from simulearn.learn.paper.model import frames_after
from simulearn.learn.paper.normaliser import fit, placed
from simulearn.learn.paper.normalisers import normalisers
from simulearn.learn.paper.state import features, state_of


@pytest.fixture(scope="module")
def batch(sample):
    return sample.batches[0].take(slice(0, 2))


def pieces(batch, frame):
    state = state_of(batch.joints[:, frame], batch.sections[:, frame], batch.stress[:, frame])
    ratio = jnp.asarray(batch.actuators.T[..., None], jnp.float32)
    shape = graph_of(batch.beams, batch.flat.shape[1], batch.fixed)
    return state, ratio, shape, meetings(batch.beams, end_modes(batch))


def test_features_are_those_of_the_data_set(batch):
    state, ratio, shape, _ = pieces(batch, 6)
    joints, beams = features(state, ratio, shape)
    np.testing.assert_allclose(joints.swapaxes(0, 1), node_features(batch)[:, 6], atol=1e-4)
    np.testing.assert_allclose(beams.swapaxes(0, 1), edge_features(batch)[:, 6], atol=1e-4)
    plain = features(state.plain, ratio, shape)[1]
    expected = edge_features(batch, stress=False)[:, 6]
    np.testing.assert_allclose(plain.swapaxes(0, 1), expected, atol=1e-4)


def test_an_engine_is_algorithm_1_twice(batch, model):
    """Loops over designs, pairs and elements, as the paper writes them."""
    engine = jax.tree.map(np.asarray, model.release)
    state, ratio, shape, meet = pieces(batch, 4)
    after = model.release(state, ratio, shape, meet)
    joints, beams = node_features(batch)[:, 4], edge_features(batch)[:, 4]
    modes = one_hot(end_modes(batch))
    norm = engine.normalisers

    def network(mlp, *parts):
        x = np.concatenate(parts)
        for k, (weight, bias) in enumerate(zip(mlp.weights, mlp.biases, strict=True)):
            x = (x / (1 + np.exp(-x)) if k else x) @ weight + bias  # SiLU
        return x

    def seen(normaliser, elements, origin):
        moved = [x - origin @ placed(len(x)) for x in elements]
        return np.concatenate(moved) @ normaliser.matrix + normaliser.offset

    def interact(net, t, latent_joints, latent_beams):
        on_beams = np.zeros((len(batch.beams), len(net.through_joint.biases[-1])))
        on_joints = np.zeros((len(joints[t]), len(net.through_beam.biases[-1])))
        ends = [(b, e) for b in range(len(batch.beams)) for e in range(2)]
        for i, e in ends:
            for k, f in ends:
                j = batch.beams[i, e]
                if i == k or batch.beams[k, f] != j:
                    continue
                triple = (beams[t, i], joints[t, j], beams[t, k])
                on_beams[k] += network(
                    net.through_joint,
                    seen(norm.through_joint, triple, joints[t, j, :3]),
                    modes[t, i, e],
                    modes[t, k, f],
                    latent_beams[i],
                    latent_joints[j],
                    latent_beams[k],
                )
        for b, e in ends:
            i, k = batch.beams[b, e], batch.beams[b, 1 - e]
            triple = (joints[t, i], beams[t, b], joints[t, k])
            on_joints[k] += network(
                net.through_beam,
                seen(norm.through_beam, triple, beams[t, b, :3]),
                modes[t, b, e],
                modes[t, b, 1 - e],
                latent_joints[i],
                latent_beams[b],
                latent_joints[k],
            )
        return (
            np.array(
                [
                    network(
                        net.joint, seen(norm.joint, (x,), x[:3]), latent_joints[j], on_joints[j]
                    )
                    for j, x in enumerate(joints[t])
                ]
            ),
            np.array(
                [
                    network(net.beam, seen(norm.beam, (x,), x[:3]), latent_beams[b], on_beams[b])
                    for b, x in enumerate(beams[t])
                ]
            ),
        )

    for t in range(len(batch)):
        nothing = np.zeros((len(joints[t]), 0)), np.zeros((len(beams[t]), 0))
        latent = interact(engine.first, t, *nothing)
        steps = interact(engine.second, t, *latent)
        moved = steps[0] @ norm.joint_step
        moved[batch.fixed, :12] = 0  # the lower corners of the fixed joint are held
        np.testing.assert_allclose(
            np.asarray(after.joints)[:, t], joints[t, :, 3:27] + moved, atol=2e-3
        )
        increments = steps[1] @ norm.beam_step
        np.testing.assert_allclose(
            np.asarray(after.sections)[:, t], beams[t, :, 3:39] + increments[:, :36], atol=2e-3
        )
        np.testing.assert_allclose(
            np.asarray(after.stress)[:, t], beams[t, :, 39:135] + increments[:, 36:], atol=2e-4
        )


def test_components_have_zero_mean_and_unit_variance_and_hold_what_they_should():
    rng = np.random.default_rng(0)
    x = rng.normal(size=(4000, 4)) @ rng.normal(size=(4, 31)) * 20 + 5
    x += 0.3 * rng.normal(size=x.shape)
    normaliser = fit(x, (31,), (0.98, 0.98))
    assert normaliser.size <= 4
    z = x @ np.asarray(normaliser.matrix) + np.asarray(normaliser.offset)
    np.testing.assert_allclose(z.mean(axis=0), 0, atol=1e-3)
    np.testing.assert_allclose(np.cov(z.T), np.eye(normaliser.size), atol=1e-2)
    assert fit(x, (31,), (0.99999, 0.98)).size > 4


def test_constant_features_are_ignored():
    rng = np.random.default_rng(0)
    x = rng.normal(size=(500, 31))
    x[:, 27] = 1.0
    matrix = np.asarray(fit(x, (31,), (0.9999, 0.98)).matrix)
    np.testing.assert_array_equal(matrix[27], 0)
    assert np.isfinite(matrix).all()


def test_moving_a_grid_changes_no_component(sample):
    norm = normalisers(sample.batches, (0.999, 0.98), 0)[0].beam
    x = np.random.default_rng(0).normal(size=(5, 139)).astype(np.float32)
    shift = np.float32([30.0, -20.0, 7.0])
    before = norm.element(x, x[:, :3])
    after = norm.element(x + shift @ placed(139).astype(np.float32), x[:, :3] + shift)
    np.testing.assert_allclose(after, before, atol=1e-3)


def test_increments_are_given_by_their_components(sample):
    norm = normalisers(sample.batches, (0.999, 0.98), 0)[0]
    batch = sample.batches[0]
    moves = np.diff(batch.joints[:, :11].reshape(len(batch), 11, -1, 24), axis=1).reshape(-1, 24)
    basis = np.asarray(norm.joint_step)
    left = moves - moves @ np.linalg.pinv(basis) @ basis
    assert np.linalg.norm(left) < 0.01 * np.linalg.norm(moves)
    sizes = np.linalg.norm(basis, axis=1)
    assert sizes[0] > 5 * sizes[-1]


def test_the_gradient_of_a_rollout_is_that_of_finite_differences(model, designs):
    with jax.enable_x64(True):
        one = designs.take([0])
        first = first_frame(one)
        double = jax.tree.map(lambda x: jnp.asarray(x, jnp.float64), model)
        shape = graph_of(one.beams, one.flat.shape[1], one.fixed)
        meet = meetings(one.beams, first.modes)
        state = state_of(first.joints, first.sections, first.stress)
        state = jax.tree.map(lambda x: jnp.asarray(x, jnp.float64), state)
        ratio = jnp.asarray(one.actuators.T[..., None])

        @jax.jit
        def height(corners):
            frames, crept = frames_after(
                double, state._replace(sections=corners), ratio, shape, meet
            )
            return (crept.joints[..., 2::3] ** 2).mean() + (frames.stress**2).mean()

        gradient_is_that_of_finite_differences(height, state.sections)
