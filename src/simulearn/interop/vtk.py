"""VTU files for ParaView: the solid with its displacements, one frame or all.

Points are where the material is; the field `displacement` (mm) leads there from the flat grid.
With the engine's mesh the cells are 20-node hexahedra, else linear ones from joints and sections.
"""

import os
import shutil
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.files import replacing
from simulearn.simulate import FRAMES, Result

Array = NDArray[np.float64]

# Local coordinates of VTK's quadratic hexahedron (VTK_QUADRATIC_HEXAHEDRON): corners of the lower
# and the upper face, middles of the lower, the upper and the upright edges.
_CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
_TOPS = _CORNERS + np.array([0, 0, 1])
_ROUND = [1, 2, 3, 0]
VTK_HEXAHEDRON_20 = np.concatenate(
    [
        _CORNERS,
        _TOPS,
        (_CORNERS + _CORNERS[_ROUND]) / 2,
        (_TOPS + _TOPS[_ROUND]) / 2,
        (_CORNERS + _TOPS) / 2,
    ]
)
BOTTOM_THEN_TOP = [0, 2, 3, 1]  # of a section's corners rb lb rt lt: rb, rt, lt, lb


def write_vtu(result: Result, path: Path | str, frame: int = -1) -> None:
    """Write one frame, the last by default.

    Raises:
        InputError: meshio is not installed, or the file cannot be written.
    """
    meshio = require_meshio()
    start, now, kind, cells = _body(result, frame)
    mesh = meshio.Mesh(now, [(kind, cells)], point_data={"displacement": now - start})
    with replacing(path) as temporary:
        mesh.write(temporary, file_format="vtu")


def write_pvd(result: Result, path: Path | str) -> None:
    """Write all frames as a time series: a .pvd file and the folder `NAME_frames` beside it.

    The folder is written under another name and moved into place whole, then the .pvd.

    Raises:
        InputError: meshio is not installed, the folder holds other files, or cannot be written.
    """
    path = Path(path)
    require_meshio()
    folder = check_series(path)
    names = [f"frame_{k:02d}.vtu" for k in range(FRAMES)]
    sets = "\n".join(
        f'    <DataSet timestep="{k}" part="0" file="{folder.name}/{name}"/>'
        for k, name in enumerate(names)
    )
    try:
        building = Path(tempfile.mkdtemp(prefix=".", dir=path.parent))
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from error
    try:
        for k, name in enumerate(names):
            write_vtu(result, building / name, k)
        building.chmod(0o777 & ~_umask())
        if folder.exists():
            folder.rename(building / "old")
        building.rename(folder)
        shutil.rmtree(folder / "old", ignore_errors=True)
    finally:
        shutil.rmtree(building, ignore_errors=True)
    with replacing(path) as temporary:
        temporary.write_text(
            '<?xml version="1.0"?>\n'
            '<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">\n'
            f"  <Collection>\n{sets}\n  </Collection>\n</VTKFile>\n",
            encoding="utf-8",
        )


def check_series(path: Path) -> Path:
    """Return the folder that goes with a .pvd file; it may hold nothing but frames.

    Raises:
        InputError: the folder holds something else, which writing would lose.
    """
    folder = path.with_name(f"{path.stem}_frames")
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder}: is a file; {path.name} needs a folder of that name")
    if folder.is_dir():
        for other in folder.iterdir():
            if not (other.name.startswith("frame_") and other.suffix == ".vtu"):
                raise InputError(f"{folder}: holds {other.name}, which is not ours; move it away")
    return folder


def require_meshio() -> Any:
    """Return the meshio package.

    Raises:
        InputError: it is not installed.
    """
    try:
        import meshio
    except ImportError as error:
        raise InputError(
            'VTU files need the package meshio: pip install "simulearn[vtk]"'
        ) from error
    return meshio


def hexahedron_order(local: Array) -> NDArray[np.int64]:
    """Return which of an element's nodes VTK's 20 are: (20,) indices.

    Args:
        local: (20, 3) local coordinates of the element's nodes in the unit cube.
    """
    distance = np.linalg.norm(VTK_HEXAHEDRON_20[:, None] - local[None], axis=2)
    return np.asarray(distance.argmin(axis=1), dtype=np.int64)


def _body(result: Result, frame: int) -> tuple[Array, Array, str, NDArray[np.int64]]:
    """Return points flat and now (N, 3), the kind of cell, and the cells."""
    if result.solid is not None and result.displacements is not None:
        from skfem import ElementHexS2

        start = result.solid.nodes
        cells = result.solid.bricks[:, hexahedron_order(np.asarray(ElementHexS2.doflocs))]
        return start, start + result.displacements[frame], "hexahedron20", cells
    flat, flat_cells = _blocks(result, 0)
    now, _ = _blocks(result, frame)
    return flat, now, "hexahedron", flat_cells


def _blocks(result: Result, frame: int) -> tuple[Array, NDArray[np.int64]]:
    """Return corners (N, 3) and cells of one block a joint and two a beam."""
    joints = result.joints[frame]
    sections = result.beams[frame][:, :, BOTTOM_THEN_TOP]
    beams = np.concatenate([sections[:, :-1], sections[:, 1:]], axis=2)  # (B, 2, 8, 3)
    points = np.concatenate([joints.reshape(-1, 3), beams.reshape(-1, 3)])
    return points, np.arange(len(points)).reshape(-1, 8)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
