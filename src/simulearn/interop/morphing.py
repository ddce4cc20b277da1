"""A grid that morphs, as one glTF file: a mesh for each tone, a morph target for each frame.

The mesh itself is the flat grid. A target holds how far each vertex of a frame is from its place
there, and how far its normal has turned; the animation gives each frame in turn the weight one, so
that the vertices move along straight lines from frame to frame. glTF 2.0, no extensions.
"""

from pathlib import Path
from typing import Any

import numpy as np

from simulearn.files import replacing
from simulearn.interop.body import triangles
from simulearn.interop.gltf import INDICES, GltfFile, morphing_shape, paint
from simulearn.interop.surface import METRE, Y_UP, facts, smooth, tones
from simulearn.schedule import FRAMES, SCHEDULE
from simulearn.simulate import Result, Skin, skin

SPACING = 5.0  # mm along a beam; normals make up for the facets
PAUSE, STEP = 1.4, 0.18  # s: still at both ends, and from frame to frame


def write_morph(result: Result, path: Path | str) -> None:
    """Write a grid that morphs, as .glb: metres, +y up, coloured as in the pictures.

    Args:
        result: what to write.
        path: the file.

    Raises:
        InputError: the file cannot be written.
    """
    surface = skin(result, SPACING)
    file = GltfFile()
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
    for k, (primitive, material) in enumerate(primitives(file, result, surface)):
        meshes.append(
            {
                "name": material["name"],
                "primitives": [primitive | {"material": k}],
                "weights": [0.0] * (FRAMES - 1),
                "extras": {"targetNames": list(SCHEDULE.names[1:])},
            }
        )
        materials.append(material)
    nodes = [{"name": mesh["name"], "mesh": k} for k, mesh in enumerate(meshes)]
    channels = [{"sampler": 0, "target": {"node": k, "path": "weights"}} for k in range(len(nodes))]
    data = file.bytes(
        {
            "asset": {"extras": facts(result)},
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


def primitives(
    file: GltfFile, result: Result, surface: Skin
) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    """Add the arrays of a grid that morphs, and return for each tone its primitive and paint."""
    found = []
    for name, (mine, rgb) in tones(result, surface).items():
        used, index, normals = smooth(surface.vertices, surface.quads[mine])
        places = METRE * surface.vertices[:, used] @ Y_UP.T
        primitive = {
            **morphing_shape(file, places, normals @ Y_UP.T),
            "indices": file.accessor(triangles(index).ravel().astype("<u4"), "SCALAR", INDICES),
        }
        found.append((primitive, paint(name, rgb)))
    return found
