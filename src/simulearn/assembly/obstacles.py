"""The surfaces of an assembly's obstacles, in their places."""

from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.typing import NDArray

from simulearn.assembly.assembly import Assembly


@dataclass(frozen=True)
class Surface:  # TODO: simulearn.surfaces
    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]


def surfaces(assembly: Assembly) -> dict[str, Surface]:
    found = {}
    for one in assembly.obstacles:
        mesh = trimesh.load_mesh(one.file)
        found[one.name] = Surface(one.place(np.asarray(mesh.vertices)), np.asarray(mesh.faces))
    return found
