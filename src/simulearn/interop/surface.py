"""The skin of a morphed grid as triangles: GLB for viewers and renderers, STL for everything else.

GLB follows glTF: metres, +y up, colours in linear light, and one mesh for each tone, so that a
renderer can give each its own material. STL holds one closed body in millimetres, +z up.
"""

from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray
from trimesh.visual.material import PBRMaterial

from simulearn.files import replacing
from simulearn.show.style import colours
from simulearn.simulate import Result, Skin, skin

METRE = 1e-3  # of a millimetre
Y_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])  # turns +z up into +y up
GHOST = [0.8, 0.8, 0.8, 0.35]  # red, green, blue, opacity of the flat grid


def write_surface(result: Result, path: Path | str, frame: int = -1) -> None:
    """Write the surface of one frame, as .glb or .stl by the ending of the path.

    GLB: the grid coloured as in the pictures, and the flat grid as a ghost, in metres with +y up.
    STL: the grid alone, in mm with +z up.

    Args:
        result: what to write.
        path: the file.
        frame: which frame; the last by default.

    Raises:
        InputError: the file cannot be written.
    """
    surface = skin(result)
    ending = Path(path).suffix.lower().removeprefix(".")
    shape = _body(surface, frame) if ending == "stl" else _scene(result, surface, frame)
    data = shape.export(file_type=ending)
    with replacing(path) as temporary:
        temporary.write_bytes(data)


def _body(surface: Skin, frame: int) -> Any:
    body = trimesh.Trimesh(surface.vertices[frame], _triangles(surface.quads), process=False)
    # Strips share places, not indices, and close only when these become one.
    body.merge_vertices(digits_vertex=6)
    return body


def _scene(result: Result, surface: Skin, frame: int) -> Any:
    scene = trimesh.Scene()
    names = _names(surface, result.grid.fixed)
    rgb = colours(surface.ratio, surface.joint, result.grid.fixed)
    for name in dict.fromkeys(names.tolist()):
        mine = names == name
        paint = _paint(name, [*rgb[mine.argmax()], 1.0])
        mesh = _mesh(surface.vertices[frame], surface.quads[mine], paint)
        scene.add_geometry(mesh, node_name=name, geom_name=name)
    flat = _mesh(surface.vertices[0], surface.quads, _paint("flat", GHOST))
    scene.add_geometry(flat, node_name="flat", geom_name="flat")
    return scene


def _names(surface: Skin, fixed: int) -> NDArray[np.str_]:
    """Return what each quadrilateral is, in words."""
    active = [f"{'top' if r > 0 else 'bottom'} {abs(r):g}" for r in surface.ratio]
    names = np.where(surface.ratio == 0, "passive", active)
    names = np.where(surface.joint >= 0, "joint", names)
    return np.where(surface.joint == fixed, "fixed joint", names)


def _paint(name: str, rgba: list[float]) -> PBRMaterial:
    """Return matt paint; glTF stores linear light, not sRGB (IEC 61966-2-1)."""
    rgb = np.array(rgba[:3])
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return PBRMaterial(
        name=name,
        baseColorFactor=[*linear, rgba[3]],
        metallicFactor=0.0,
        roughnessFactor=0.8,
        alphaMode="BLEND" if rgba[3] < 1 else "OPAQUE",
    )


def _mesh(
    vertices: NDArray[np.float64], quads: NDArray[np.int64], paint: PBRMaterial
) -> trimesh.Trimesh:
    """Return quadrilaterals as triangles for glTF, their normals smooth along each strip."""
    used, index = np.unique(quads, return_inverse=True)
    index = index.reshape(quads.shape)
    corners = vertices[quads]
    # The cross product of a face's diagonals weighs its normal by its area.
    face = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normals = np.zeros((len(used), 3))
    np.add.at(normals, index, face[:, None])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return trimesh.Trimesh(
        METRE * vertices[used] @ Y_UP.T,
        _triangles(index),
        vertex_normals=normals @ Y_UP.T,
        visual=trimesh.visual.TextureVisuals(material=paint),
        process=False,
    )


def _triangles(quads: NDArray[np.int64]) -> NDArray[np.int64]:
    return quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
