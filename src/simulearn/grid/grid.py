"""A grid: what a designer draws. Joints in the plane, beams between them, actuators on the beams.

A grid holds numbers only; its shape is in `outline`, its rules in `validation`, its file in
`gridfile`.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True, eq=False)
class Grid:
    """A flat grid of printed beams.

    Attributes:
        joints: (J, 2) mm, where the beams' axes meet.
        beams: (B, 2) joint indices, start and end.
        actuators: (B,) signed ratio in [-1, 1] of actuator length to the beam's net length;
            + puts the active part on the top half, - on the bottom half.
        fixed: index of the joint whose lower half is held.
        material: name of the material system, or the path of its TOML file.
    """

    joints: NDArray[np.float64]
    beams: NDArray[np.int64]
    actuators: NDArray[np.float64]
    fixed: int
    material: str = "pla-hot-water"

    def __init__(
        self,
        joints: ArrayLike,
        beams: ArrayLike,
        actuators: ArrayLike,
        fixed: int,
        material: str = "pla-hot-water",
    ) -> None:
        put = lambda name, value: object.__setattr__(self, name, value)  # noqa: E731
        put("joints", np.array(joints, dtype=np.float64).reshape(-1, 2))
        put("beams", np.array(beams, dtype=np.int64).reshape(-1, 2))
        put("actuators", np.array(actuators, dtype=np.float64).reshape(-1))
        put("fixed", int(fixed))
        put("material", str(material))
        for array in (self.joints, self.beams, self.actuators):
            array.flags.writeable = False

    @cached_property
    def centred(self) -> "Grid":
        """The same grid moved so that its fixed joint is the origin."""
        joints = self.joints - self.joints[self.fixed]
        return Grid(joints, self.beams, self.actuators, self.fixed, self.material)

    @property
    def dimension(self) -> float:
        """Largest distance from the fixed joint to another joint, mm."""
        return float(np.linalg.norm(self.joints - self.joints[self.fixed], axis=1).max())
