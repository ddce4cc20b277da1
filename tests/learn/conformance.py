"""What every learned model must do, whatever its kind: laws, not figures.

`LAWS` are checks of a model and designs; each raises AssertionError where the model fails. A test
module runs them over all bundles and over small models of its own:

    @pytest.mark.parametrize("law", LAWS, ids=name_of)
    def test_it_conforms(law):
        law(model, designs)

Gradients are checked by `gradient_is_that_of_finite_differences`, which takes the function that
a kind differentiates. Rotation and mirror are measured by `turned_error` and `mirrored_error`:
exact models assert that they are nothing, others say how much they are.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from simulearn.grid import Rules, draw_valid
from simulearn.learn.common.first_frame import first_frame
from simulearn.learn.common.model import Designs, Model, builder

Law = Callable[[Model, Designs], None]


def the_first_frame_is_the_design(model, designs):
    frames, first = model.rollout(designs), first_frame(designs)
    np.testing.assert_allclose(frames.joints[:, 0], first.joints, atol=1e-9)
    np.testing.assert_allclose(frames.sections[:, 0], first.sections, atol=1e-9)


def the_fixed_joint_stays(model, designs):
    held = model.rollout(designs).joints[:, :, designs.fixed, :4]
    np.testing.assert_allclose(held, held[:, :1] + 0 * held, atol=1e-9)


def answers_have_the_right_shapes(model, designs):
    frames = model.rollout(designs)
    trials, joints, beams = len(designs), designs.flat.shape[1], len(designs.beams)
    assert frames.joints.shape == (trials, 12, joints, 8, 3)
    assert frames.sections.shape == (trials, 12, beams, 3, 4, 3)
    assert frames.stress is None or frames.stress.shape == (trials, 12, beams, 4, 4, 6)
    assert frames.bound_mm is None or frames.bound_mm.shape == (trials,)
    assert frames.converged.shape == (trials,)
    assert frames.converged.dtype == bool
    assert np.isfinite(frames.joints).all()
    assert np.isfinite(frames.sections).all()


def a_batch_answers_as_its_members(model, designs):
    many = model.rollout(designs)
    for k in range(len(designs)):
        one = model.rollout(designs.take([k]))
        np.testing.assert_allclose(one.joints[0], many.joints[k], atol=1e-2)
        np.testing.assert_allclose(one.sections[0], many.sections[k], atol=1e-2)


def asking_again_gives_the_same_bits(model, designs):
    a, b = model.rollout(designs), model.rollout(designs)
    np.testing.assert_array_equal(a.joints, b.joints)
    np.testing.assert_array_equal(a.sections, b.sections)


def built_again_it_gives_the_same_bits(model, designs):
    again = builder(model.kind)(model.config(), model.to_arrays(), designs.material)
    a, b = model.rollout(designs), again.rollout(designs)
    np.testing.assert_array_equal(a.joints, b.joints)
    np.testing.assert_array_equal(a.sections, b.sections)


def numbering_does_not_matter(model, designs):
    """Beams in another order are the same grid."""
    order = np.random.default_rng(0).permutation(len(designs.beams))
    other = replace(designs, beams=designs.beams[order], actuators=designs.actuators[:, order])
    a, b = model.rollout(designs), model.rollout(other)
    np.testing.assert_allclose(b.joints, a.joints, atol=1e-2)
    np.testing.assert_allclose(b.sections, a.sections[:, :, order], atol=1e-2)


def gradient_is_that_of_finite_differences(function, point, step=1e-4, tolerance=1e-5):
    """A function of an array to a number, in double precision; each kind brings its own."""
    import jax

    slope = np.asarray(jax.grad(function)(point))
    rng = np.random.default_rng(1)
    for _ in range(3):
        along = rng.normal(size=np.shape(point))
        along /= np.linalg.norm(along)
        measured = (function(point + step * along) - function(point - step * along)) / (2 * step)
        expected = float((slope * along).sum())
        assert abs(float(measured) - expected) < tolerance * max(np.linalg.norm(slope), 1e-3)


LAWS: list[Law] = [
    the_first_frame_is_the_design,
    the_fixed_joint_stays,
    answers_have_the_right_shapes,
    a_batch_answers_as_its_members,
    asking_again_gives_the_same_bits,
    built_again_it_gives_the_same_bits,
    numbering_does_not_matter,
]


def name_of(law: Law) -> str:
    return law.__name__


def turned_error(model: Model, designs: Designs, angle: float = 0.9) -> float:
    """Mean distance (mm) of the joints' centres from the turned ones, last frame."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    other = replace(designs, flat=designs.flat @ turn[:2, :2].T)
    return _apart(model.rollout(designs), model.rollout(other), turn)


def mirrored_error(model: Model, designs: Designs) -> float:
    """Mean distance (mm) of the joints' centres from the mirrored ones, last frame."""
    image = np.diag([-1.0, 1.0, 1.0])
    other = replace(designs, flat=designs.flat @ image[:2, :2].T)
    return _apart(model.rollout(designs), model.rollout(other), image)


def _apart(a, b, matrix):
    there, here = (frames.joints[:, -1].mean(axis=2) for frames in (a, b))
    return float(np.linalg.norm(here - there @ matrix.T, axis=-1).mean())


def designs_like(rules: Rules, count: int, seed: int = 11) -> Designs:
    """Random designs of one topology."""
    grids = [draw_valid(rules, seed, k)[0].centred for k in range(count)]
    return Designs(
        grids[0].beams,
        grids[0].fixed,
        np.stack([g.joints for g in grids]),
        np.stack([g.actuators for g in grids]),
    )
