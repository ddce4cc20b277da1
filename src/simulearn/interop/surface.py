"""Surfaces for other programs: GLB with colours for viewers, STL for everything else."""

from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray

from simulearn.files import replacing
from simulearn.show.style import GHOST_LINE, colours
from simulearn.simulate import Result, Skin, skin

METRE = 1e-3  # of a millimetre: glTF counts in metres
UPRIGHT = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1.0]])  # glTF has +y up


def write_surface(result: Result, path: Path | str, frame: int = -1) -> None:
    """Write the surface of one frame, as .glb or .stl by the ending of the path.

    GLB: the grid coloured as in the pictures, and the flat grid, in metres with +y up as glTF
    asks. STL: the grid alone, in mm with +z up.

    Raises:
        InputError: the file cannot be written.
    """
    surface = skin(result)
    body = _mesh(surface, frame)
    if Path(path).suffix.lower() == ".stl":
        data: Any = body.export(file_type="stl")
    else:
        rgb = colours(surface.ratio, surface.joint, result.grid.fixed)
        _paint(body, np.repeat(rgb, 2, axis=0))
        flat = _mesh(surface, 0)
        grey = [int(GHOST_LINE[k : k + 2], 16) / 255 for k in (1, 3, 5)]
        _paint(flat, np.tile(grey, (len(flat.faces), 1)))
        scene = trimesh.Scene()
        scene.add_geometry(body, geom_name="morphed")
        scene.add_geometry(flat, geom_name="flat")
        scene.apply_transform(UPRIGHT @ np.diag([METRE, METRE, METRE, 1]))
        data = scene.export(file_type="glb")
    with replacing(path) as temporary:
        temporary.write_bytes(data)


def _mesh(surface: Skin, frame: int) -> trimesh.Trimesh:
    """Return the triangles of a frame, two of each quadrilateral in turn."""
    triangles = surface.quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    return trimesh.Trimesh(surface.vertices[frame], triangles, process=False)


def _paint(mesh: trimesh.Trimesh, rgb: NDArray[np.float64]) -> None:
    """Give each triangle its colour; triangles of different colours share no vertices."""
    mesh.unmerge_vertices()
    colour = np.repeat((255 * rgb).round().astype(np.uint8), 3, axis=0)
    mesh.visual = trimesh.visual.ColorVisuals(mesh, vertex_colors=colour)
