"""An assembly that morphs, as one glTF file: a node for each part, one animation for all.

Each part has its place, its weights of the morph targets and its motion. Parts with equal grids
share all arrays, but not the mesh that names them: viewers keep weights by mesh (Blender) or find
what moves by its name (three.js), and would move only one of them. Keys on a straight line between
their neighbours are left out.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from simulearn.assembly import Assembled
from simulearn.errors import Cancel, stop_if
from simulearn.files import replacing
from simulearn.interop.gltf import VERTICES, GltfFile, paint
from simulearn.interop.morphing import PAUSE, SPACING, primitives
from simulearn.interop.surface import METRE, Y_UP
from simulearn.schedule import FRAMES, SCHEDULE
from simulearn.show import style
from simulearn.simulate import Result, skin

Array = NDArray[np.float64]

STRAIGHT = 1e-9  # of values between two keys


def write_assembled(assembled: Assembled, path: Path | str, cancel: Cancel | None = None) -> None:
    """Write an assembly that morphs in its order, as .glb: metres, +y up, as in the pictures.

    Args:
        assembled: what to write; parts without a result are left out.
        path: the file.
        cancel: stops it between two parts.

    Raises:
        InputError: the file cannot be written.
        CancelledError: the token was set.
    """
    data = scene_of(assembled, cancel)
    with replacing(path) as temporary:
        temporary.write_bytes(data)


def scene_of(assembled: Assembled, cancel: Cancel | None = None) -> bytes:
    """Return an assembly that morphs as glTF; see `write_assembled`."""
    assembled.require()
    file = GltfFile()
    materials: dict[str, dict[str, Any]] = {}
    meshes: list[dict[str, Any]] = []
    shapes: dict[int, list[dict[str, Any]]] = {}
    nodes: list[dict[str, Any]] = []
    tracks = _Tracks(file, assembled.timeline.times)
    moments = assembled.timeline
    for k, part, result in assembled.present:
        stop_if(cancel)
        if id(result) not in shapes:
            shapes[id(result)] = _shapes(file, result, materials)
        names = {"targetNames": list(SCHEDULE.names[1:])}
        meshes.append({"name": part.name, "primitives": shapes[id(result)], "extras": names})
        turn = Rotation.from_matrix(Y_UP @ part.place.turn @ Y_UP.T).as_quat()
        shift = METRE * (part.place.shift + moments.shifts[:, k]) @ Y_UP.T
        weights = _weights(moments.frames[:, k])
        node = {
            "name": part.name,
            "mesh": len(meshes) - 1,
            "rotation": turn.tolist(),
            "translation": shift[0].tolist(),
            "weights": weights[0].tolist(),
        }
        # Not every viewer takes the weights of a node, but all play those of an animation.
        if weights.any():
            tracks.add(len(nodes), "weights", weights)
        if (shift != shift[0]).any():
            tracks.add(len(nodes), "translation", shift)
        nodes.append(node)
    for name, surface in assembled.obstacles.items():
        nodes.append({"name": name, "mesh": len(meshes)})
        meshes.append(_obstacle(file, name, surface, materials))
    scene: dict[str, Any] = {
        "asset": {"extras": _facts(assembled)},
        "scene": 0,
        "scenes": [{"name": "assembly", "nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "meshes": meshes,
        "materials": list(materials.values()),
    }
    motion = {"name": "assembly", "samplers": tracks.samplers, "channels": tracks.channels}
    return file.bytes(scene | {"animations": [motion]})


class _Tracks:
    """The samplers and channels of an animation; equal samplers are one."""

    def __init__(self, file: GltfFile, times: Array) -> None:
        self.file = file
        self.times = PAUSE + np.concatenate([[-PAUSE], times, [times[-1] + PAUSE]])
        self.samplers: list[dict[str, Any]] = []
        self.channels: list[dict[str, Any]] = []
        self.known: dict[tuple[str, bytes], int] = {}

    def add(self, node: int, path: str, values: Array) -> None:
        """Let a node's property have values (M, n) at the moments."""
        data = np.concatenate([values[:1], values, values[-1:]])
        key = path, data.tobytes()
        if key not in self.known:
            self.known[key] = len(self.samplers)
            kept = _kinks(self.times, data)
            vectors = path == "translation"
            numbers = data[kept].astype("<f4")
            self.samplers.append(
                {
                    "input": self.file.accessor(
                        self.times[kept].astype("<f4"), "SCALAR", bounds=True
                    ),
                    "output": self.file.accessor(
                        numbers if vectors else numbers.ravel(), "VEC3" if vectors else "SCALAR"
                    ),
                    "interpolation": "LINEAR",
                }
            )
        target = {"node": node, "path": path}
        self.channels.append({"sampler": self.known[key], "target": target})


def _kinks(times: Array, values: Array) -> NDArray[np.bool_]:
    """Return which of values (M, n) at times (M,) are not on the line between their neighbours."""
    slopes = np.diff(values, axis=0) / np.diff(times)[:, None]
    bent = (np.abs(np.diff(slopes, axis=0)) > STRAIGHT).any(axis=1)
    return np.concatenate([[True], bent, [True]])


def _weights(frames: Array) -> Array:
    """Return the weights (M, FRAMES - 1) of the targets in frames (M,), also between two."""
    near: Array = 1 - np.abs(frames[:, None] - np.arange(1, FRAMES))
    return np.maximum(near, 0.0)


def _shapes(
    file: GltfFile, result: Result, materials: dict[str, dict[str, Any]]
) -> list[dict[str, Any]]:
    """Return the primitives of a grid, one for each tone, and add their materials."""
    shapes = []
    for primitive, material in primitives(file, result, skin(result, SPACING)):
        materials.setdefault(material["name"], material)
        shapes.append(primitive | {"material": list(materials).index(material["name"])})
    return shapes


def _obstacle(
    file: GltfFile, name: str, surface: Any, materials: dict[str, dict[str, Any]]
) -> dict[str, Any]:
    corners = METRE * surface.vertices[surface.faces] @ Y_UP.T
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1)
    there = length > 0
    unit = np.repeat(normals[there] / length[there, None], 3, axis=0)
    places = corners[there].reshape(-1, 3)
    material = paint("obstacle", np.array(to_rgb(style.SOLID))) | {"doubleSided": True}
    materials.setdefault("obstacle", material)
    attributes = {
        "POSITION": file.accessor(places.astype("<f4"), "VEC3", VERTICES, bounds=True),
        "NORMAL": file.accessor(unit.astype("<f4"), "VEC3", VERTICES),
    }
    kind = list(materials).index("obstacle")
    return {"name": name, "primitives": [{"attributes": attributes, "material": kind}]}


def _facts(assembled: Assembled) -> Mapping[str, Any]:
    """Return what a file says about an assembly."""
    return {
        "engine": assembled.engine,
        "name": assembled.assembly.name,
        "steps": [step.title for step in assembled.assembly.order],
        "collisions": [one.words for one in assembled.collisions],
        "without": sorted(assembled.failures),
        "frames": list(SCHEDULE.names),
    }
