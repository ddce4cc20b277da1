"""A program of its own that reads the surfaces of a .3dm file and writes them as triangles.

Faces are taken as Rhino has tessellated them; a surface that it has not is evaluated here, finely
enough. rhino3dm is native code, so it runs in a process that can be stopped; see `rhino_process`
beside the reader of drawings.
"""

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import rhino3dm

MAX_BYTES = 6 << 30
MAX_DEPTH = 16
NEAR = 2e-5  # of the size of a surface, its distance from its triangles
FIRST, MOST = 4, 512  # pieces of a span to begin with; points along a side


def main(source: Path, target: Path) -> None:
    """Read a file and write vertices, faces and what was passed over, as an .npz file.

    Args:
        source: the .3dm file.
        target: the file to write; it is not written where the file cannot be read.
    """
    _limit_memory()
    model = rhino3dm.File3dm.Read(str(source))
    if model is None:
        return
    reader = _Reader(model)
    reader.run()
    says = {
        "unit": model.Settings.ModelUnitSystem.name,
        "left_out": reader.left_out,
        "untrimmed": reader.untrimmed,
        "found": len(reader.vertices),
    }
    starts = np.cumsum([0, *(len(part) for part in reader.vertices)])
    faces = [part + start for part, start in zip(reader.faces, starts, strict=False)]
    with target.open("wb") as file:
        np.savez(
            file,
            vertices=np.concatenate([np.zeros((0, 3)), *reader.vertices]),
            faces=np.concatenate([np.zeros((0, 3), np.int64), *faces]),
            says=np.frombuffer(json.dumps(says).encode(), np.uint8),
        )


def _limit_memory() -> None:
    try:
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MAX_BYTES, MAX_BYTES))
    except (ImportError, ValueError, OSError):  # Windows has no such limit, macOS may refuse it
        pass


class _Reader:
    def __init__(self, model: Any) -> None:
        self.vertices: list[Any] = []
        self.faces: list[Any] = []
        self.left_out: dict[str, int] = {}
        self.untrimmed = 0
        self._model = model
        self._hidden = _hidden(list(model.Layers))
        self._objects = {str(item.Attributes.Id): item for item in model.Objects}
        self._blocks = {
            str(block.Id): [str(member) for member in block.GetObjectIds()]
            for block in model.InstanceDefinitions
        }

    def run(self) -> None:
        members = {member for block in self._blocks.values() for member in block}
        for key, item in self._objects.items():
            if key not in members and item.Attributes.Mode.name != "InstanceDefinitionObject":
                self._thing(item, np.eye(4), 0)

    def _thing(self, item: Any, matrix: Any, depth: int) -> None:
        attributes, geometry = item.Attributes, item.Geometry
        if not attributes.Visible or attributes.LayerIndex in self._hidden:
            self._leave("hidden objects")
        elif isinstance(geometry, rhino3dm.InstanceReference):
            if depth < MAX_DEPTH:
                block: Any = geometry
                own = np.array(block.Xform.ToFloatArray(True), float).reshape(4, 4)
                for member in self._blocks.get(str(block.ParentIdefId), ()):
                    if member in self._objects:
                        self._thing(self._objects[member], matrix @ own, depth + 1)
        else:
            try:
                parts = list(self._parts(geometry))
            except Exception:  # a broken object fails in the library in any way
                self._leave("damaged objects")
                return
            for vertices, faces in parts:
                self.vertices.append(vertices @ matrix[:3, :3].T + matrix[:3, 3])
                self.faces.append(faces)

    def _parts(self, geometry: Any) -> Any:
        if isinstance(geometry, rhino3dm.Mesh):
            yield _of_mesh(geometry)
        elif isinstance(geometry, rhino3dm.Extrusion):
            mesh = geometry.GetMesh(rhino3dm.MeshType.Any)
            if mesh is not None:
                yield _of_mesh(mesh)
            else:
                yield from self._parts(geometry.ToBrep(True))
        elif isinstance(geometry, rhino3dm.Brep):
            brep: Any = geometry
            for face in (brep.Faces[k] for k in range(len(brep.Faces))):
                mesh = face.GetMesh(rhino3dm.MeshType.Any)
                self.untrimmed += mesh is None and not brep.IsSurface
                yield _of_surface(face) if mesh is None else _of_mesh(mesh)
        elif isinstance(geometry, rhino3dm.Surface):
            yield _of_surface(geometry)
        else:
            name = type(geometry).__name__
            self._leave(name if name != "GeometryBase" else str(geometry.ObjectType.name))

    def _leave(self, kind: str) -> None:
        self.left_out[kind] = self.left_out.get(kind, 0) + 1


def _hidden(layers: list[Any]) -> set[int]:
    """Return the indices of layers that are off, or below one that is."""
    by_id = {str(layer.Id): layer for layer in layers}
    hidden = set()
    for layer in layers:
        above: Any = layer
        for _ in layers:  # no more levels than layers, should they go around
            if above is None or not above.Visible:
                break
            above = by_id.get(str(above.ParentLayerId))
        if above is not None and not above.Visible:
            hidden.add(layer.Index)
    return hidden


def _of_mesh(mesh: Any) -> tuple[Any, Any]:
    points = [mesh.Vertices[i] for i in range(len(mesh.Vertices))]
    vertices = np.array([(p.X, p.Y, p.Z) for p in points], float).reshape(-1, 3)
    quads = np.array([mesh.Faces[i] for i in range(mesh.Faces.Count)], np.int64).reshape(-1, 4)
    rest = quads[quads[:, 2] != quads[:, 3]]
    return vertices, np.concatenate([quads[:, :3], rest[:, [0, 2, 3]]])


def _of_surface(surface: Any) -> tuple[Any, Any]:
    spans = [np.unique(np.array(surface.GetSpanVector(k), float)) for k in (0, 1)]
    pieces = FIRST
    while True:
        u, v = (_split(span, pieces) for span in spans)
        grid = _at(surface, u, v)
        size = np.linalg.norm(np.ptp(grid.reshape(-1, 3), axis=0))
        between = _at(surface, (u[1:] + u[:-1]) / 2, (v[1:] + v[:-1]) / 2)
        chord = (grid[1:, 1:] + grid[1:, :-1] + grid[:-1, 1:] + grid[:-1, :-1]) / 4
        if np.abs(between - chord).max() < NEAR * size or 2 * max(len(u), len(v)) > MOST:
            break
        pieces *= 2
    k = np.arange(grid.shape[0] * grid.shape[1]).reshape(grid.shape[:2])
    a, b, c, d = k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    corners = grid.reshape(-1, 3)[faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    wide = np.linalg.norm(across, axis=1) > 1e-12 * size**2  # others are those of a pole
    return grid.reshape(-1, 3), faces[wide]


def _split(span: Any, pieces: int) -> Any:
    part = np.linspace(0, 1, pieces, endpoint=False)
    return np.append((span[:-1, None] + np.diff(span)[:, None] * part).ravel(), span[-1])


def _at(surface: Any, u: Any, v: Any) -> Any:
    points = [surface.PointAt(a, b) for a in u for b in v]
    return np.array([(p.X, p.Y, p.Z) for p in points]).reshape(len(u), len(v), 3)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
