"""A glTF file: its arrays one after another, the scene that names them, paint and shapes.

glTF 2.0, no extensions.
"""

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn import __version__
from simulearn.interop.surface import ROUGHNESS, linear

# Numbers of the glTF 2.0 specification.
MAGIC, VERSION, JSON, BINARY = 0x46546C67, 2, 0x4E4F534A, 0x004E4942
FLOAT, UINT = 5126, 5125
VERTICES, INDICES = 34962, 34963


class GltfFile:
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
        asset = {"version": "2.0", "generator": f"SimuLearn {__version__}"}
        scene = scene | {
            "asset": asset | scene.get("asset", {}),
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


def morphing_shape(
    file: GltfFile, places: NDArray[np.float64], normals: NDArray[np.float64]
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


def paint(name: str, rgb: NDArray[np.float64]) -> dict[str, Any]:
    """Return matt paint of a colour (3,) as on screens."""
    return {
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [*linear(rgb).tolist(), 1.0],
            "metallicFactor": 0.0,
            "roughnessFactor": ROUGHNESS,
        },
    }
