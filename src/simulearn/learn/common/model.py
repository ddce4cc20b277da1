"""What a learned simulator is: designs in, twelve frames out, and its weights as named arrays.

A kind of model is a class that has `kind`, `rollout`, `to_arrays`,
`config` and `from_arrays`; `KINDS` names them. Everything else (bundles, evaluation, the engine
`learned`, the conformance suite) knows only this.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from importlib import import_module
from typing import Any, NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.extras import require
from simulearn.material import Material, load_material
from simulearn.schedule import Snap


def standard() -> Material:
    """Return the material that designs have unless another is named."""
    return load_material("pla-hot-water")


@dataclass(frozen=True, eq=False)
class Designs:
    """Designs of one topology, T of them.

    Attributes:
        beams: (B, 2) joint indices, start and end.
        fixed: index of the fixed joint.
        flat: (T, J, 2) mm, joints of the flat grids, the fixed joint at the origin.
        actuators: (T, B) signed ratios.
        material: the material system.
        reference: name or path of it, or the material itself, as grids have it.
        materials: (T,) of each design, where they differ.
        factors: (T, B) by which the released strains of beams differ from the material's, or None.
        mesh: 0 for answers as of the default mesh, 1 for those of the fine one; None for the finest
            that a model has learnt.
    """

    beams: NDArray[np.int64]
    fixed: int
    flat: NDArray[np.float64]
    actuators: NDArray[np.float64]
    material: Material = field(default_factory=standard)
    reference: str | Material = "pla-hot-water"
    materials: tuple[Material, ...] = ()
    factors: NDArray[np.float64] | None = None
    mesh: float | None = None

    def __len__(self) -> int:
        return len(self.flat)

    def take(self, which: Any) -> "Designs":
        """Return the designs of an index or mask over T."""
        stay = np.arange(len(self))[which]
        return replace(
            self,
            flat=self.flat[which],
            actuators=self.actuators[which],
            materials=tuple(self.materials[k] for k in stay) if self.materials else (),
            factors=None if self.factors is None else self.factors[which],
        )

    def material_of(self, t: int) -> Material:
        """Return the material of design t."""
        return self.materials[t] if self.materials else self.material

    @property
    def dimensions(self) -> NDArray[np.float64]:
        """(T,) largest distance from the fixed joint to another, mm."""
        return np.linalg.norm(self.flat - self.flat[:, [self.fixed]], axis=-1).max(axis=1)


@dataclass(frozen=True, eq=False)
class Frames:
    """The prediction of a model; mm, MPa, +z up; corners in the order of `simulate.Result`.

    Attributes:
        joints: (T, 12, J, 8, 3) corners of the joints.
        sections: (T, 12, B, 3, 4, 3) corners of the beams' sections.
        stress: (T, 12, B, 4, 4, 6), or None where a model has none.
        bound_mm: (T,) estimate of the mean vertex error of the last frame, or None.
        converged: (T,) whether there is a prediction; a model without iterations always has one.
        stable: (T,) whether the last frame is in stable equilibrium, or None where a model does not
            know.
        snaps: of each design its sudden motions, in their order, or None.
        left_balance: (T,) whether an unstable equilibrium was left, so that the mirrored shape is
            as likely, or None.
    """

    joints: NDArray[np.float64]
    sections: NDArray[np.float64]
    stress: NDArray[np.float64] | None
    bound_mm: NDArray[np.float64] | None
    converged: NDArray[np.bool_]
    stable: NDArray[np.bool_] | None = None
    snaps: Sequence[tuple[Snap, ...]] | None = None
    left_balance: NDArray[np.bool_] | None = None


class Model(Protocol):
    """A learned simulator."""

    @property
    def kind(self) -> str:
        """One of `KINDS`."""
        ...

    def rollout(self, designs: Designs) -> Frames:
        """Return the twelve frames of designs of one topology."""
        ...

    def config(self) -> dict[str, Any]:
        """Return the architecture as plain data, from which `from_arrays` builds it again."""
        ...

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """Return all weights and normalisers by name."""
        ...


class Last(NamedTuple):
    """The last frame alone: corners of joints (T, J, 8, 3) and sections (T, B, 3, 4, 3), mm.

    Attributes:
        converged: (T,) whether there is a prediction.
    """

    joints: NDArray[np.float64]
    sections: NDArray[np.float64]
    converged: NDArray[np.bool_]


def last_frame(model: Model, designs: Designs) -> Last:
    """Return the last frame of designs of one topology; some models need no others for it."""
    if isinstance(model, _Quick):
        return model.last(designs)
    frames = model.rollout(designs)
    return Last(frames.joints[:, -1], frames.sections[:, -1], frames.converged)


@runtime_checkable
class _Quick(Protocol):
    def last(self, designs: Designs) -> Last: ...


Builder = Callable[[Mapping[str, Any], Mapping[str, NDArray[Any]], Material], Model]

KINDS = {  # kind -> module, class
    "paper": ("simulearn.learn.paper.model", "Paper"),
    "beams": ("simulearn.learn.equilibrium.model", "Equilibrium"),
    "equilibrium": ("simulearn.learn.equilibrium.model", "Equilibrium"),
}


def check_kind(kind: str) -> None:
    """Raise InputError where there is no such kind of model."""
    if kind not in KINDS:
        raise InputError(f'a model of kind "{kind}" is not known; known are {", ".join(KINDS)}')


def builder(kind: str) -> Builder:
    """Return `from_arrays` of a kind: it builds a model of its config, arrays and material.

    Raises:
        InputError: there is no such kind, or a package that it needs is missing.
    """
    check_kind(kind)
    if kind == "paper":
        require("models of the kind paper need", "jax", "equinox")
    module, name = KINDS[kind]
    build: Builder = getattr(import_module(module), name).from_arrays
    return build
