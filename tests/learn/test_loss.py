"""The loss by its meaning: nothing for the truth, the penalty for what comes apart."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from simulearn.dataset.features import touching
from simulearn.learn.paper.loss import LossWeights, Prepared, _noisy, dislocation, loss

NOTHING = LossWeights(*(jnp.float32(x) for x in (0.0, 1.0, 1.0)))


@pytest.fixture(scope="module")
def prepared(sample):
    return Prepared.of(sample.batches[0].take(slice(0, 3)))


@pytest.fixture(scope="module")
def examples(prepared):
    return prepared.examples(np.arange(3), 90.0)


def test_touching_corners_lie_together(prepared, examples):
    frames = examples.frames
    for f in (0, 5, 11):
        apart = dislocation(frames.joints[f], frames.sections[f], examples.touch, prepared.ends)
        assert float(abs(apart).max()) < 0.02  # steps of the file
    moved = dislocation(frames.joints[5] + 3.0, frames.sections[5], examples.touch, prepared.ends)
    np.testing.assert_allclose(moved, -3.0, atol=0.02)


def test_touching_names_four_corners_of_one_side(prepared):
    touch = touching(prepared.modes)
    assert touch.shape == (*prepared.modes.shape, 4)
    np.testing.assert_array_equal(touch[..., 2:], touch[..., :2] + 4)
    side = (touch[..., 1] - touch[..., 0]) % 4
    assert set(np.unique(side)) == {1, 3}  # neighbours, counter-clockwise or clockwise


def still(model):
    """The same model, but that it moves nothing."""

    def last(m):
        nets = [n for e in (m.release, m.creep) for n in (e.second.joint, e.second.beam)]
        return [x for net in nets for x in (net.weights[-1], net.biases[-1])]

    return eqx.tree_at(last, model, replace_fn=jnp.zeros_like)


@pytest.mark.parametrize("unroll", [5, 10])
def test_the_loss_of_a_model_that_moves_nothing_is_what_moves(prepared, examples, model, unroll):
    value, parts = jax.jit(loss, static_argnums=5)(
        still(model), examples, prepared.shape, prepared.ends, NOTHING, unroll, jax.random.key(0)
    )
    unit = float(model.release.normalisers.unit[0])
    weight = np.asarray(examples.weight)[:, None]
    expected, creep = 0.0, 0.0
    for x in (np.asarray(examples.frames.joints), np.asarray(examples.frames.sections)):
        off = [x[k + 1] - x[k // unroll * unroll] for k in range(10)]
        expected += float((np.stack(off) ** 2 * weight).mean()) / unit**2
        before = x[0] if unroll == 10 else x[10]
        creep += float(((x[11] - before) ** 2 * weight).mean()) / unit**2
    release, crept, stress, split = map(float, parts)
    assert release == pytest.approx(expected, rel=1e-3)
    assert crept == pytest.approx(creep, rel=1e-3)
    assert split < 1e-3
    assert float(value) == pytest.approx((10 * release + crept) / 11 + stress + split, rel=1e-4)


def test_noise_is_in_proportion_to_what_has_moved(examples):
    states = jax.tree.map(lambda x: x[:10], examples.frames)
    noisy = _noisy(states, examples.frames, jnp.float32(0.1), jax.random.key(3))
    off = np.asarray(noisy.joints - states.joints)
    np.testing.assert_array_equal(off[0], 0)
    motion = np.asarray(states.joints - examples.frames.joints[:1])
    far = abs(motion[9]) > 5
    assert float((off[9][far] / motion[9][far]).std()) == pytest.approx(0.1, rel=0.1)
