"""The paper's simulator: one engine ten times for the release of stress, another for creep.

Yang et al., SimuLearn, UIST 2020, Figure 6.
"""

from collections.abc import Mapping
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import NDArray

from simulearn.compiled import double_precision, make_room
from simulearn.errors import InputError
from simulearn.learn.common.first_frame import first_frame
from simulearn.learn.common.model import Designs, Frames
from simulearn.learn.paper.aligning import aligned, turned_back
from simulearn.learn.paper.graph import Graph, Meetings, graph_of, meetings
from simulearn.learn.paper.network import DoubleInteraction, Sizes, blank
from simulearn.learn.paper.state import GraphState, state_of
from simulearn.material import Material
from simulearn.schedule import SCHEDULE

STEPS = SCHEDULE.steps  # of stage 1
NAMES = ("release", "creep")  # of the engines


class Paper(eqx.Module):
    """A double interaction network for each of the two stages.

    Attributes:
        release: the engine of stage 1.
        creep: the engine of stage 2.
        sizes: widths of both.
        aligned: whether designs are turned to a common direction first.
    """

    release: DoubleInteraction
    creep: DoubleInteraction
    sizes: tuple[Sizes, Sizes] = eqx.field(static=True)
    aligned: bool = eqx.field(static=True, default=False)
    kind: str = eqx.field(static=True, default="paper")

    @double_precision
    def rollout(self, designs: Designs) -> Frames:
        """Return the twelve frames of designs of one topology; see `learn.common.model.Model`."""
        if not self.aligned:
            return self._rollout(designs)
        straight, angle = aligned(designs)
        answer = turned_back(self._rollout(straight), angle, first := first_frame(designs).joints)
        answer.joints[:, 0] = first
        return answer

    def _rollout(self, designs: Designs) -> Frames:
        make_room()
        count = len(designs)
        first = first_frame(designs)
        # Numbers of designs are rounded up, so that few shapes are compiled.
        padded = designs.take(np.arange(_rounded(count)) % count) if count else designs
        which = np.arange(len(padded)) % max(count, 1)
        joints, sections = _corners(
            self,
            state_of(first.joints[which], first.sections[which], first.stress[which]),
            jnp.asarray(padded.actuators.T[..., None], jnp.float32),
            graph_of(designs.beams, designs.flat.shape[1], designs.fixed),
            meetings(designs.beams, first.modes[which]),
        )
        joints, sections = (
            np.asarray(x, np.float64).transpose(2, 0, 1, 3)[:count] for x in (joints, sections)
        )
        # Positions of the first frame are known to double precision.
        joints = joints.reshape(*joints.shape[:3], 8, 3)
        sections = sections.reshape(*sections.shape[:3], 3, 4, 3)
        # What is known is known to double precision: the first frame, and the held corners.
        joints[:, 0], sections[:, 0] = first.joints, first.sections
        joints[:, :, designs.fixed, :4] = first.joints[:, None, designs.fixed, :4]
        return Frames(joints, sections, None, None, np.ones(count, bool))

    def config(self) -> dict[str, Any]:
        """Return the architecture: widths, and how many components each normaliser keeps."""
        engines = {
            name: {**_plain(sizes), "components": engine.normalisers.sizes}
            for name, engine, sizes in zip(
                NAMES, (self.release, self.creep), self.sizes, strict=True
            )
        }
        return {"aligned": self.aligned, **engines}

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """Return all weights and normalisers by name, single precision."""
        return {name: np.asarray(leaf) for name, leaf in _leaves(self).items()}

    @classmethod
    @double_precision
    def from_arrays(
        cls, config: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]], material: Material
    ) -> "Paper":
        """Return the model of a config and arrays; the material comes with each design.

        Raises:
            InputError: they do not belong together; the message names the first wrong array.
        """
        engines, sizes = [], []
        for name in NAMES:
            try:
                engine = dict(config[name])
                a, b, c, d, *steps = engine["components"]
                size = Sizes(
                    tuple(engine["hidden"]),
                    tuple(engine["interaction"]),
                    tuple(engine["latent"]),
                    engine["activation"],
                )
                engines.append(blank(size, (a, b, c, d), (steps[0], steps[1]), name == "release"))
            except (KeyError, TypeError, ValueError) as error:
                raise InputError(f"the architecture of {name} is not one: {error!r}") from error
            sizes.append(size)
        empty = cls(engines[0], engines[1], (sizes[0], sizes[1]), bool(config.get("aligned")))
        wanted = _leaves(empty)
        if wrong := sorted(wanted.keys() ^ arrays.keys()):
            what = "is missing" if wrong[0] in wanted else "does not belong to it"
            raise InputError(f"array {wrong[0]} {what}")
        for name, leaf in wanted.items():
            if arrays[name].shape != leaf.shape or not np.isfinite(arrays[name]).all():
                raise InputError(
                    f"array {name} has shape {arrays[name].shape}, not {leaf.shape}"
                    if arrays[name].shape != leaf.shape
                    else f"array {name} holds numbers that are not finite"
                )
        leaves = [jnp.asarray(arrays[name], jnp.float32) for name in wanted]
        model: Paper = jax.tree.unflatten(jax.tree.structure(empty), leaves)
        return model


def roll(
    engine: DoubleInteraction,
    state: GraphState,
    steps: int,
    ratio: Array,
    shape: Graph,
    meet: Meetings,
) -> GraphState:
    """Return the frames after a state, each array (steps, N, T, n)."""

    def step(now: GraphState, _: None) -> tuple[GraphState, GraphState]:
        after = engine(now, ratio, shape, meet)
        return after, after

    return jax.lax.scan(step, state, None, length=steps)[1]


def frames_after(
    model: Paper, first: GraphState, ratio: Array, shape: Graph, meet: Meetings
) -> tuple[GraphState, GraphState]:
    """Return the frames of stage 1, each array (10, N, T, n), and the one after creep."""
    frames = roll(model.release, first, STEPS, ratio, shape, meet)
    last = jax.tree.map(lambda x: x[-1], frames).plain
    return frames, model.creep(last, ratio, shape, meet)


@eqx.filter_jit
@jax.default_matmul_precision("float32")
def _corners(
    model: Paper, first: GraphState, ratio: Array, shape: Graph, meet: Meetings
) -> tuple[Array, Array]:
    """Return the corners of all frames: joints (12, J, T, 24), sections (12, B, T, 36)."""
    frames, crept = frames_after(model, first, ratio, shape, meet)
    return (
        jnp.concatenate([first.joints[None], frames.joints, crept.joints[None]]),
        jnp.concatenate([first.sections[None], frames.sections, crept.sections[None]]),
    )


def _rounded(count: int) -> int:
    """Return the next of 1, 2, 4, 6, 8, 12, 16, 24, ..."""
    if count <= 2:
        return count
    power = 1 << (count - 1).bit_length()
    return power * 3 // 4 if count <= power * 3 // 4 else power


def _plain(sizes: Sizes) -> dict[str, Any]:
    return {k: list(v) if isinstance(v, tuple) else v for k, v in sizes._asdict().items()}


def _leaves(model: Paper) -> dict[str, Any]:
    """Return the arrays of a model by name, as release.first.joint.weights.0."""
    named, _ = jax.tree_util.tree_flatten_with_path(eqx.filter(model, eqx.is_array))
    return {jax.tree_util.keystr(path, simple=True, separator="."): leaf for path, leaf in named}
