"""Meshes for other programs: GLB for viewers and browsers, STL for whatever prints or measures."""

from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from simulearn.files import replacing
from simulearn.show.style import GHOST_LINE, colours
from simulearn.simulate import Result, Skin, skin

METRE = 1e-3  # glTF counts in metres
# glTF has y up: (x, y, z) -> (x, z, -y).
UPRIGHT = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]], dtype=float)


def write_glb(result: Result, path: Path | str) -> None:
    """Write the last frame, coloured, and the flat grid as a second mesh, as binary glTF.

    Lengths are metres and y is up, as glTF has it: a grid of 130 mm is 0.13 wide.
    """
    surface = skin(result)
    rgb = colours(surface.ratio, surface.joint, result.grid.fixed)
    grey = np.tile(to_rgb(GHOST_LINE), (len(rgb), 1))
    scene = trimesh.Scene()
    scene.add_geometry(_coloured(surface, -1, rgb), geom_name="deformed", node_name="deformed")
    scene.add_geometry(_coloured(surface, 0, grey), geom_name="flat", node_name="flat")
    with replacing(path) as temporary:
        temporary.write_bytes(scene.export(file_type="glb"))


def write_stl(result: Result, path: Path | str) -> None:
    """Write the last frame as a closed surface, mm, z up, as binary STL."""
    surface = skin(result)
    body = trimesh.Trimesh(surface.vertices[-1], _triangles(surface), process=False)
    with replacing(path) as temporary:
        temporary.write_bytes(body.export(file_type="stl"))


def _coloured(surface: Skin, frame: int, rgb: NDArray[np.float64]) -> Any:
    """Return a mesh whose colours sit at vertices: patches of one colour share no vertex."""
    colour = np.zeros((surface.vertices.shape[1], 3))
    colour[surface.quads] = rgb[:, None]
    return trimesh.Trimesh(
        surface.vertices[frame] @ UPRIGHT.T * METRE,
        _triangles(surface),
        vertex_colors=np.round(255 * np.c_[colour, np.ones(len(colour))]).astype(np.uint8),
        process=False,
    )


def _triangles(surface: Skin) -> NDArray[np.int64]:
    return np.concatenate([surface.quads[:, [0, 1, 2]], surface.quads[:, [0, 2, 3]]])
