"""Results for ParaView: one frame as .vtu, all of them as a .pvd series."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.files import replacing
from simulearn.simulate import FRAMES, Result

# Places of the 20 nodes of a quadratic hexahedron in the order of VTK, twice the coordinates.
# fmt: off
VTK20 = np.array([
    [0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2], [0, 2, 2],
    [1, 0, 0], [2, 1, 0], [1, 2, 0], [0, 1, 0], [1, 0, 2], [2, 1, 2], [1, 2, 2], [0, 1, 2],
    [0, 0, 1], [2, 0, 1], [2, 2, 1], [0, 2, 1],
])
# fmt: on


def write_vtu(result: Result, path: Path | str, frame: int = -1) -> None:
    """Write one frame as an unstructured VTK grid, mm.

    It is the solid mesh of quadratic bricks with its displacements where the engine has one, else
    one linear brick a joint and two a beam.

    Raises:
        InputError: meshio is not installed, or the file cannot be written.
    """
    mesh = _mesh(result, frame)
    with replacing(path) as temporary:
        mesh.write(temporary, file_format="vtu")


def write_pvd(result: Result, path: Path | str) -> None:
    """Write all frames: `NAME.pvd`, which names the files of the folder `NAME_frames` beside it.

    The frames are written elsewhere and moved when all of them are there.

    Raises:
        InputError: meshio is not installed, or a file cannot be written.
    """
    path = Path(path)
    folder = path.with_name(f"{path.stem}_frames")
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{path}: its frames go to the folder {folder}, which is a file")
    names = [f"frame_{frame:02d}.vtu" for frame in range(FRAMES)]
    rows = [
        f'    <DataSet timestep="{frame}" file={quoteattr(f"{folder.name}/{name}")}/>'
        for frame, name in enumerate(names)
    ]
    lines = [
        '<?xml version="1.0"?>',
        '<VTKFile type="Collection" version="0.1">',
        "  <Collection>",
        *rows,
        "  </Collection>",
        "</VTKFile>",
    ]
    with replacing(path) as index, TemporaryDirectory(prefix=".", dir=path.parent) as elsewhere:
        index.write_text("\n".join(lines) + "\n", encoding="utf-8")
        for frame, name in enumerate(names):
            write_vtu(result, Path(elsewhere) / name, frame)
        folder.mkdir(exist_ok=True)
        for name in names:
            (Path(elsewhere) / name).replace(folder / name)


def _mesh(result: Result, frame: int) -> Any:
    try:
        import meshio
    except ImportError as error:
        raise InputError("VTK files need a package: pip install 'simulearn[vtk]'") from error
    if result.solid is not None and result.displacements is not None:
        solid, u = result.solid, result.displacements[frame]
        return meshio.Mesh(
            solid.nodes + u,
            [("hexahedron20", solid.bricks[:, vtk_order()])],
            point_data={"displacement": u},
            cell_data={"beam": [solid.parts[:, 0]]},
        )
    points, bricks = _blocks(result, frame)
    flat, _ = _blocks(result, 0)
    return meshio.Mesh(points, [("hexahedron", bricks)], point_data={"displacement": points - flat})


def vtk_order() -> NDArray[np.int64]:
    """Return for each node of VTK's quadratic hexahedron its number in scikit-fem's brick."""
    from skfem import ElementHexS2

    ours = (2 * np.asarray(ElementHexS2.doflocs)).round().astype(int).tolist()
    return np.array([ours.index(place) for place in VTK20.tolist()])


def _blocks(result: Result, frame: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return corners (P, 3) and linear bricks (E, 8): the joints, then both halves of the beams."""
    joints = result.joints[frame].reshape(-1, 3)
    # A section's corners are right-bottom, left-bottom, right-top, left-top.
    beams = result.beams[frame].reshape(-1, 3)
    first = len(joints) + 4 * np.arange(len(beams) // 4).reshape(-1, 3)
    start, end = first[:, :2].reshape(-1, 1), first[:, 1:].reshape(-1, 1)
    ring = np.concatenate([start, end, end + 1, start + 1], axis=1)
    bricks = np.concatenate([ring, ring + 2], axis=1)
    of_joints = np.arange(len(joints)).reshape(-1, 8)
    return np.concatenate([joints, beams]), np.concatenate([of_joints, bricks])
