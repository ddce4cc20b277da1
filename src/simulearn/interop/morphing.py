"""A grid that morphs, as one glTF file: a mesh for each tone, a morph target for each frame.

The mesh itself is the flat grid. A target holds how far each vertex of a frame is from its place
there, and how far its normal has turned; the animation gives each frame in turn the weight one, so
that the vertices move along straight lines from frame to frame. glTF 2.0, no extensions.
"""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn import __version__
from simulearn.files import replacing
from simulearn.interop.body import triangles
from simulearn.interop.surface import METRE, ROUGHNESS, Y_UP, facts, linear, smooth, tones
from simulearn.schedule import FRAMES, SCHEDULE
from simulearn.simulate import Result, skin

SPACING = 5.0  # mm along a beam; normals make up for the facets
PAUSE, STEP = 1.4, 0.18  # s: still at both ends, and from frame to frame
# Numbers of the glTF 2.0 specification.
MAGIC, VERSION, JSON, BINARY = 0x46546C67, 2, 0x4E4F534A, 0x004E4942
FLOAT, UINT = 5126, 5125
VERTICES, INDICES = 34962, 34963


def write_morph(result: Result, path: Path | str) -> None:
    """Write a grid that morphs, as .glb: metres, +y up, coloured as in the pictures.

    Args:
        result: what to write.
        path: the file.

    Raises:
        InputError: the file cannot be written.
    """
    surface = skin(result, SPACING)
    file = _File()
    times = PAUSE + STEP * np.arange(FRAMES)
    times = np.concatenate([[0], times, [times[-1] + PAUSE]]).astype("<f4")
    frame = np.concatenate([[0], np.arange(FRAMES), [FRAMES - 1]])
    weights = (frame[:, None] == np.arange(1, FRAMES)).astype("<f4")
    sampler = {
        "input": file.accessor(times, "SCALAR", bounds=True),
        "output": file.accessor(weights.ravel(), "SCALAR"),
        "interpolation": "LINEAR",
    }
    meshes, materials = [], []
    for k, (name, (mine, rgb)) in enumerate(tones(result, surface).items()):
        used, index, normals = smooth(surface.vertices, surface.quads[mine])
        places = METRE * surface.vertices[:, used] @ Y_UP.T
        primitive = {
            **_shape(file, places, normals @ Y_UP.T),
            "indices": file.accessor(triangles(index).ravel().astype("<u4"), "SCALAR", INDICES),
            "material": k,
        }
        meshes.append(
            {
                "name": name,
                "primitives": [primitive],
                "weights": [0.0] * (FRAMES - 1),
                "extras": {"targetNames": list(SCHEDULE.names[1:])},
            }
        )
        paint = {
            "baseColorFactor": [*linear(rgb).tolist(), 1.0],
            "metallicFactor": 0.0,
            "roughnessFactor": ROUGHNESS,
        }
        materials.append({"name": name, "pbrMetallicRoughness": paint})
    nodes = [{"name": mesh["name"], "mesh": k} for k, mesh in enumerate(meshes)]
    channels = [{"sampler": 0, "target": {"node": k, "path": "weights"}} for k in range(len(nodes))]
    data = file.bytes(
        {
            "asset": {
                "version": "2.0",
                "generator": f"SimuLearn {__version__}",
                "extras": facts(result),
            },
            "scene": 0,
            "scenes": [{"name": "grid", "nodes": list(range(len(nodes)))}],
            "nodes": nodes,
            "meshes": meshes,
            "materials": materials,
            "animations": [{"name": "morph", "samplers": [sampler], "channels": channels}],
        }
    )
    with replacing(path) as temporary:
        temporary.write_bytes(data)


def _shape(
    file: "_File", places: NDArray[np.float64], normals: NDArray[np.float64]
) -> dict[str, Any]:
    """Return the flat grid's vertices and the targets, from places and normals (F, n, 3)."""

    def attributes(place: NDArray[np.float64], normal: NDArray[np.float64]) -> dict[str, int]:
        return {
            "POSITION": file.accessor(place.astype("<f4"), "VEC3", VERTICES, bounds=True),
            "NORMAL": file.accessor(normal.astype("<f4"), "VEC3", VERTICES),
        }

    pairs = zip(places[1:] - places[0], normals[1:] - normals[0], strict=True)
    return {
        "attributes": attributes(places[0], normals[0]),
        "targets": [attributes(*pair) for pair in pairs],
    }


class _File:
    """The binary part of a glTF file, and where in it each array lies."""

    def __init__(self) -> None:
        self.views: list[dict[str, int]] = []
        self.accessors: list[dict[str, Any]] = []
        self.parts: list[bytes] = []
        self.size = 0

    def accessor(
        self, values: NDArray[Any], kind: str, target: int | None = None, bounds: bool = False
    ) -> int:
        """Add an array and return its number.

        Args:
            values: of four bytes each; (n,) of kind SCALAR, (n, 3) of kind VEC3.
            kind: the glTF type.
            target: what it is to a graphics card; None for animations.
            bounds: whether to write the least and the largest value.
        """
        data = values.tobytes()
        view = {"buffer": 0, "byteOffset": self.size, "byteLength": len(data)}
        self.views.append(view if target is None else view | {"target": target})
        accessor = {
            "bufferView": len(self.views) - 1,
            "componentType": FLOAT if values.dtype.kind == "f" else UINT,
            "count": len(values),
            "type": kind,
        }
        if bounds:
            rows = values.reshape(len(values), -1)
            accessor |= {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        self.accessors.append(accessor)
        self.parts.append(data)
        self.size += len(data)
        return len(self.accessors) - 1

    def bytes(self, scene: dict[str, Any]) -> bytes:
        """Return the file of a scene, which names arrays by their numbers."""
        scene = scene | {
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": self.size}],
        }
        text = json.dumps(scene, separators=(",", ":"), allow_nan=False).encode("ascii")
        text += b" " * (-len(text) % 4)
        size = 12 + 8 + len(text) + 8 + self.size
        return b"".join(
            [
                struct.pack("<III", MAGIC, VERSION, size),
                struct.pack("<II", len(text), JSON),
                text,
                struct.pack("<II", self.size, BINARY),
                *self.parts,
            ]
        )
