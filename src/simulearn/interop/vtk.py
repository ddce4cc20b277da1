"""Results for ParaView: one frame as .vtu, all of them as a .pvd series.

Displacements are mm, stresses MPa: what is still locked in and the Cauchy stress of the elastic
deformation, in global axes and in the order that VTK gives to six numbers of a tensor.
"""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.extras import require
from simulearn.files import replacing
from simulearn.material import Material, load_material
from simulearn.schedule import SCHEDULE
from simulearn.simulate import FRAMES, Result

if TYPE_CHECKING:
    from simulearn.fea import Solid

# Places of the 20 nodes of a quadratic hexahedron in the order of VTK, twice the coordinates.
# fmt: off
VTK20 = np.array([
    [0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2], [0, 2, 2],
    [1, 0, 0], [2, 1, 0], [1, 2, 0], [0, 1, 0], [1, 0, 2], [2, 1, 2], [1, 2, 2], [0, 1, 2],
    [0, 0, 1], [2, 0, 1], [2, 2, 1], [0, 2, 1],
])
# fmt: on
VTK_TENSOR = [0, 1, 2, 3, 5, 4]  # xx yy zz xy yz xz


def write_vtu(result: Result, path: Path | str, frame: int = -1) -> None:
    """Write one frame as an unstructured VTK grid, mm.

    It is the solid mesh of quadratic bricks where the engine has one, with the mean stress of each
    brick; else one linear brick a joint and two a beam, with the stress at the beams' corners. A
    solid mesh whose material is no longer known by its name is written as linear bricks, too,
    since the stress of its own bricks cannot be computed.

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
    require("VTK files need", "meshio")
    import meshio

    material = _material(result)
    known = result.stress is None or material is not None
    if result.solid is not None and result.displacements is not None and known:
        solid, u = result.solid, result.displacements[frame]
        cells: dict[str, Any] = {"beam": solid.parts[:, 0]}
        if result.stress is not None and material is not None:
            cells |= _with_mises(_of_bricks(solid, material, u, frame % FRAMES))
        return meshio.Mesh(
            solid.nodes + u,
            [("hexahedron20", solid.bricks[:, vtk_order()])],
            point_data={"displacement": u},
            cell_data={name: [values] for name, values in cells.items()},
        )
    points, bricks = _blocks(result, frame)
    flat, _ = _blocks(result, 0)
    data = {"displacement": points - flat}
    if result.stress is not None:
        data |= _with_mises(_at_corners(result, frame))
    return meshio.Mesh(points, [("hexahedron", bricks)], point_data=data)


def _material(result: Result) -> Material | None:
    """Return the material of which the stress of a solid's bricks follows, if there is one.

    There is none for a solid that is only a mesh, and where the name no longer means the same.
    """
    if result.solid is None or result.solid.weights.size == 0:
        return None
    try:
        material = load_material(result.grid.material)
    except InputError:
        return None
    return material if material.identity == result.material else None


def _of_bricks(
    solid: "Solid", material: Material, u: NDArray[np.float64], frame: int
) -> NDArray[np.float64]:
    """Return the stress (E, 6) MPa of a solid's bricks."""
    from simulearn.fea.laws import law_of
    from simulearn.fea.stress import brick_stress

    softening = 1 + material.creep.amplitude if frame == FRAMES - 1 else 1.0
    return brick_stress(solid, law_of(material.law), u, SCHEDULE.released[frame], softening)


def _at_corners(result: Result, frame: int) -> NDArray[np.float64]:
    """Return the stress (P, 6) MPa at the points of `_blocks`; not a number at the joints."""
    assert result.stress is not None
    stress = result.stress[frame]
    middle = stress[:, 1:3].mean(axis=1, keepdims=True)
    of_beams = np.concatenate([stress[:, :1], middle, stress[:, 3:]], axis=1).reshape(-1, 6)
    of_joints = np.full((result.joints[frame].size // 3, 6), np.nan)
    return np.concatenate([of_joints, of_beams])


def _with_mises(stress: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Return stresses (n, 6), 11 22 33 12 13 23, as arrays of VTK, with their von Mises values."""
    xx, yy, zz, xy, xz, yz = stress.T
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    mises = np.sqrt(normal / 2 + 3 * (xy**2 + xz**2 + yz**2))
    return {"stress": stress[:, VTK_TENSOR], "von Mises stress": mises}


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
