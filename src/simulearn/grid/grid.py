"""A grid: what a designer draws. Joints in the plane, beams between them, actuators on the beams.

A grid holds numbers only; its shape is in `outline`, its rules in `validation`, its file in
`gridfile`.
"""

import hashlib
import os
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from simulearn.display import Displayed
from simulearn.errors import InputError
from simulearn.grid.arrays import KEYS, index, indices, numbers, places, shown
from simulearn.material.material import Material


@dataclass(frozen=True)
class Support:
    """The part of a grid that is held in place.

    Attributes:
        joint: index of the joint.
        lower: where the held part begins, in thicknesses above the middle plane.
        upper: where it ends: at 0, the lower half is held.
    """

    joint: int
    lower: float = -0.5
    upper: float = 0.0


@dataclass(frozen=True, eq=False)
class Grid(Displayed):
    """A flat grid of printed beams.

    Attributes:
        joints: (J, 2) mm, where the beams' axes meet.
        beams: (B, 2) joint indices, start and end.
        actuators: (B,) signed ratio in [-1, 1] of actuator length to the beam's net length;
            + puts the active part on the top half, - on the bottom half.
        fixed: index of the joint whose lower half is held.
        material: name of the material system, the path of its TOML file, or the material itself.

    Raises:
        InputError: an array has another shape or holds what is not a finite number; joints are not
            in the plane (z is dropped where it is 0); an index is no integer (1.0 counts as one).
            The message names the entry.
            Indices that do not exist and ratios out of range are left to `validate`.
    """

    joints: NDArray[np.float64]
    beams: NDArray[np.int64]
    actuators: NDArray[np.float64]
    fixed: int
    material: str | Material = "pla-hot-water"

    def __init__(
        self,
        joints: ArrayLike,
        beams: ArrayLike,
        actuators: ArrayLike,
        fixed: int,
        material: str | os.PathLike[str] | Material = "pla-hot-water",
    ) -> None:
        if not isinstance(material, (str, os.PathLike, Material)) or not str(material):
            text = f"material is {shown(material)}; {KEYS['material']}"
            raise InputError(text, "material", "material")
        own = self.__dict__  # the class is frozen
        own["joints"] = places(joints)
        own["beams"] = indices(beams, "beams")
        own["actuators"] = numbers(actuators, "actuators")
        own["fixed"] = index(fixed, "fixed")
        own["material"] = material if isinstance(material, Material) else str(material)
        for array in (self.joints, self.beams, self.actuators):
            array.flags.writeable = False

    @property
    def centred(self) -> "Grid":
        """The same grid moved so that its fixed joint is the origin."""
        return self._moved if self.joints[self.fixed].any() else self

    @cached_property
    def _moved(self) -> "Grid":
        joints = self.joints - self.joints[self.fixed]
        return Grid(joints, self.beams, self.actuators, self.fixed, self.material)

    @property
    def dimension(self) -> float:
        """Largest distance from the fixed joint to another joint, mm."""
        return float(np.linalg.norm(self.joints - self.joints[self.fixed], axis=1).max())

    @property
    def support(self) -> Support:
        """What is held in place: the lower half of the fixed joint."""
        return Support(self.fixed)

    @cached_property
    def digest(self) -> str:
        """SHA-256 of all that the grid holds, in hexadecimal digits.

        A material counts by its name; one that the grid holds itself by its contents, too.
        """
        material = self.material
        if isinstance(material, Material):
            material = f"{material.name} {material.digest}"
        text = f"simulearn.grid/1 {len(self.joints)} {len(self.beams)} {self.fixed} {material}"
        digest = hashlib.sha256(text.encode("utf-8", "surrogatepass"))
        # Adding 0.0 makes 0.0 of -0.0.
        digest.update((self.joints + 0.0).astype("<f8").tobytes())
        digest.update(self.beams.astype("<i8").tobytes())
        digest.update((self.actuators + 0.0).astype("<f8").tobytes())
        return digest.hexdigest()
