"""The surface of a morphed grid: GLB for viewers and renderers; STL, OBJ and PLY for all else.

GLB follows glTF: metres, +y up, colours in linear light, and one mesh for each tone, so that a
renderer can give each its own material. The others hold one closed body in millimetres, +z up.
"""

from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray
from trimesh.visual.material import PBRMaterial

from simulearn.files import replacing
from simulearn.interop.body import body, triangles
from simulearn.schedule import SCHEDULE
from simulearn.show.style import colours
from simulearn.simulate import Result, Skin, skin
from simulearn.simulate.resultfile import qualities

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

METRE = 1e-3  # of a millimetre
Y_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])  # turns +z up into +y up
GHOST = [0.8, 0.8, 0.8, 0.35]  # red, green, blue, opacity of the flat grid
ROUGHNESS = 0.8


def write_surface(result: Result, path: Path | str, frame: int = -1) -> None:
    """Write the surface of one frame, as .glb, .stl, .obj or .ply by the ending of the path.

    GLB: the grid coloured as in the pictures, and the flat grid as a ghost, in metres with +y up.
    STL, OBJ, PLY: the grid alone as one closed body, in mm with +z up.

    Args:
        result: what to write.
        path: the file.
        frame: which frame; the last by default.

    Raises:
        InputError: the file cannot be written.
    """
    ending = Path(path).suffix.lower().removeprefix(".")
    shape = _scene(result, skin(result), frame) if ending == "glb" else _body(result, frame)
    more = {"header": f"engine {result.engine}, mm"} if ending == "obj" else {}
    data = shape.export(file_type=ending, **more)
    with replacing(path) as temporary:
        temporary.write_bytes(data if isinstance(data, bytes) else data.encode("utf-8"))


def facts(result: Result) -> dict[str, Any]:
    """Return what a file says about an answer: the engine, and what qualifies it."""
    return {
        "engine": result.engine,
        **qualities(result),
        "frames": list(SCHEDULE.names),
        "fixed": result.grid.fixed,
    }


def tones(result: Result, surface: Skin) -> dict[str, tuple[NDArray[np.bool_], Array]]:
    """Return what wears which colour: by its name, the quadrilaterals (Q,) and the colour (3,)."""
    fixed = result.grid.fixed
    active = [f"{'top' if r > 0 else 'bottom'} {abs(r):g}" for r in surface.ratio]
    names = np.where(surface.ratio == 0, "passive", active)
    names = np.where(surface.joint >= 0, "joint", names)
    names = np.where(surface.joint == fixed, "fixed joint", names)
    rgb = colours(surface.ratio, surface.joint, fixed)
    return {
        name: (names == name, rgb[(names == name).argmax()])
        for name in dict.fromkeys(names.tolist())
    }


def linear(rgb: Array) -> Array:
    """Return colours in linear light, as glTF stores them, of sRGB ones (IEC 61966-2-1)."""
    return np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)


def smooth(vertices: Array, quads: Indices) -> tuple[Indices, Indices, Array]:
    """Return a part of a surface by itself, its normals smooth along each strip.

    Args:
        vertices: (..., V, 3) of the whole surface.
        quads: (Q, 4) of the part.

    Returns:
        the vertices (n,) that it uses, its quadrilaterals (Q, 4) counted among them, and unit
        normals (..., n, 3).
    """
    used, index = np.unique(quads, return_inverse=True)
    index = index.reshape(quads.shape)
    corners = vertices[..., quads, :]
    # The cross product of a face's diagonals weighs its normal by its area.
    face = np.cross(
        corners[..., 2, :] - corners[..., 0, :], corners[..., 3, :] - corners[..., 1, :]
    )
    normals = np.zeros((len(used), *face.shape[:-2], 3))
    np.add.at(normals, index, np.moveaxis(face, -2, 0)[:, None])
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return used, index, np.moveaxis(normals, 0, -2)


def _body(result: Result, frame: int) -> Any:
    shape = body(result)
    return trimesh.Trimesh(shape.vertices[frame], shape.triangles, process=False)


def _scene(result: Result, surface: Skin, frame: int) -> Any:
    scene = trimesh.Scene(metadata=facts(result))
    for name, (mine, rgb) in tones(result, surface).items():
        mesh = _mesh(surface.vertices[frame], surface.quads[mine], _paint(name, [*rgb, 1.0]))
        scene.add_geometry(mesh, node_name=name, geom_name=name)
    flat = _mesh(surface.vertices[0], surface.quads, _paint("flat", GHOST))
    scene.add_geometry(flat, node_name="flat", geom_name="flat")
    return scene


def _paint(name: str, rgba: list[float]) -> PBRMaterial:
    """Return matt paint."""
    return PBRMaterial(
        name=name,
        baseColorFactor=[*linear(np.array(rgba[:3])), rgba[3]],
        metallicFactor=0.0,
        roughnessFactor=ROUGHNESS,
        alphaMode="BLEND" if rgba[3] < 1 else "OPAQUE",
    )


def _mesh(vertices: Array, quads: Indices, paint: PBRMaterial) -> trimesh.Trimesh:
    """Return quadrilaterals as triangles for glTF."""
    used, index, normals = smooth(vertices, quads)
    return trimesh.Trimesh(
        METRE * vertices[used] @ Y_UP.T,
        triangles(index),
        vertex_normals=normals @ Y_UP.T,
        visual=trimesh.visual.TextureVisuals(material=paint),
        process=False,
    )
