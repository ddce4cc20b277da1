"""The models that solve for equilibrium: `beams`, mechanics alone, and `equilibrium`, the default.

What they predict is a minimum of the energy of a grid of half-beams between joints; see
`prediction`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.learn.common.model import Designs, Frames, Last
from simulearn.learn.equilibrium.bound import ErrorBound
from simulearn.learn.equilibrium.learnt import Learnt
from simulearn.learn.equilibrium.native import Networks, networks_of, predict
from simulearn.learn.equilibrium.parameters import (
    Parameters,
    Prediction,
    named_arrays,
    parameters_of,
    shapes_by_name,
)
from simulearn.material import Material

BOUND = "trust."  # before the names of the arrays of a bound in the files of bundles
LEARNT = "learnt."  # the same of the ranges
CONVERGED = 0.1  # mm, the last motion of an iteration at most
LARGE = 1000  # designs from which on a GPU is worth its compilation


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A model that solves for equilibrium; without a network it is mechanics alone.

    Attributes:
        parameters: fitted.
        material: that they were fitted to, or the one whose family they were fitted to.
        learnt: ranges of the materials and meshes that they were fitted to.
        sizes: width, message and rounds of the networks.
        bound: the error estimate, or None.
        kind: "equilibrium" or "beams".
    """

    parameters: Parameters
    material: Material
    learnt: Learnt
    sizes: tuple[int, int, int] = (64, 16, 2)
    bound: ErrorBound | None = None
    kind: str = "equilibrium"

    def rollout(self, designs: Designs) -> Frames:
        """Return the twelve frames of designs of one topology; see `learn.common.model.Model`."""
        return self.frames(designs, self.predict(designs))

    def frames(self, designs: Designs, prediction: Prediction) -> Frames:
        """Return the twelve frames of designs of one topology from their prediction."""
        bound = None if self.bound is None else self.bound.bound(designs, prediction, self.learnt)
        return Frames(
            np.asarray(prediction.joints),
            np.asarray(prediction.sections),
            None if prediction.stress is None else np.asarray(prediction.stress),
            bound,
            converged(prediction),
            prediction.stable,
            prediction.snaps,
            prediction.left_balance,
        )

    def last(self, designs: Designs) -> Last:
        """Return the last frame; see `learn.common.model.last_frame`."""
        prediction = self.predict(designs, last=True)
        joints, sections = prediction.joints[:, -1], prediction.sections[:, -1]
        return Last(np.asarray(joints), np.asarray(sections), converged(prediction))

    def predict(self, designs: Designs, last: bool = False) -> Prediction:
        """Return the prediction of all frames of each design, or of the last."""
        if len(designs) >= LARGE and has_gpu():
            from simulearn.learn.equilibrium.compiled import predict as on_gpu

            return on_gpu(self.parameters, designs, self.mesh_of(designs), last)
        mesh = self.mesh_of(designs)
        return predict(self.parameters, designs, last, networks=self._networks, mesh=mesh)

    def mesh_of(self, designs: Designs) -> float:
        """Return which mesh answers are to be as of: 0 the default one, 1 the fine one."""
        return self.learnt.finest if designs.mesh is None else designs.mesh

    @cached_property
    def _networks(self) -> Networks:
        return networks_of(self.parameters)

    def config(self) -> dict[str, Any]:
        """Return the architecture."""
        width, message, rounds = self.sizes
        return {"width": width, "message": message, "rounds": rounds}

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """Return law of sections, networks, what was learnt and error estimate by name."""
        arrays = named_arrays(self.parameters)
        arrays |= {f"{LEARNT}{key}": value for key, value in self.learnt.to_arrays().items()}
        if self.bound is not None:
            arrays |= {f"{BOUND}{key}": value for key, value in self.bound.to_arrays().items()}
        return arrays

    @classmethod
    def from_arrays(
        cls, config: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]], material: Material
    ) -> "Equilibrium":
        """Return the model of a bundle.

        Raises:
            InputError: the architecture is not one, or a weight is missing, too many, or has the
                wrong shape.
        """
        try:
            sizes = tuple(int(config[key]) for key in ("width", "message", "rounds"))
        except (KeyError, TypeError, ValueError) as error:
            raise InputError(f"the architecture has no number {error}") from error
        if not all(0 < size <= LARGEST for size in sizes):
            raise InputError(f"the architecture {dict(config)} has a size outside 1 to {LARGEST}")
        width, message, rounds = sizes
        network = any(name.startswith("network.") for name in arrays)
        stress = any(name.startswith("stress.") for name in arrays)
        expected = shapes_by_name(network, stress, (width, message, rounds))
        for name, (shape, _) in expected.items():
            if name not in arrays:
                raise InputError(f"weight {name} is missing")
            if arrays[name].shape != shape:
                raise InputError(f"weight {name} has the shape {arrays[name].shape}, not {shape}")
        others = {part: _part(arrays, part) for part in (BOUND, LEARNT)}
        if extra := {
            name for name in arrays.keys() - expected.keys() if not name.startswith((BOUND, LEARNT))
        }:
            raise InputError(f"weight {min(extra)} does not belong to this architecture")
        typed = {name: np.asarray(arrays[name], dtype) for name, (_, dtype) in expected.items()}
        return cls(
            parameters_of(typed, rounds),
            material,
            Learnt.from_arrays(others[LEARNT]),
            (width, message, rounds),
            ErrorBound.from_arrays(others[BOUND]) if others[BOUND] else None,
            "equilibrium" if network else "beams",
        )


def _part(arrays: Mapping[str, NDArray[Any]], begin: str) -> dict[str, NDArray[Any]]:
    """Return the arrays whose names begin so, by the rest of their names."""
    return {k.removeprefix(begin): v for k, v in arrays.items() if k.startswith(begin)}


LARGEST = 4096  # width, message length or rounds of a network


@cache
def has_gpu() -> bool:
    """Return whether JAX computes on a GPU here."""
    try:
        import jax
    except ImportError:
        return False
    return bool(jax.default_backend() == "gpu")


def converged(prediction: Prediction) -> NDArray[np.bool_]:
    """Return which designs (T,) of a prediction have an equilibrium in every frame."""
    motion = np.asarray(prediction.motion)
    finite = [
        np.isfinite(x).reshape(len(motion), -1).all(axis=1)
        for x in (prediction.joints, prediction.sections)
    ]
    return np.asarray((motion < CONVERGED) & np.all(finite, axis=0))
