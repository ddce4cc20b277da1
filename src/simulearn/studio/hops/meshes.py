"""Shapes of a result as geometry of Rhino: meshes in the colours of the pictures, and polylines."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.simulate import Result, Skin, skin
from simulearn.simulate.skin import edges
from simulearn.studio.hops import archives
from simulearn.studio.hops.curves import polyline
from simulearn.studio.hops.design import Design

Points = NDArray[np.float64]

SPACING = 5.0  # mm along a beam; Rhino shows the surface smooth between
STRAIGHT = 1e4  # mm; what is flat needs no points between
ALONG = np.linspace(0, 1, 9)  # of a beam, where the points of its axis are


def surface(result: Result, frame: int) -> Skin:
    """Return the surface that the mesh of a frame is made of."""
    return skin(result, SPACING if frame else STRAIGHT)


def mesh(shape: Skin, frame: int, design: Design, coloured: bool = True) -> Any:
    """Return a frame as a mesh in the model.

    Args:
        shape: of `surface`.
        frame: which one.
        design: where it lies.
        coloured: whether it has the colours of its actuators, else it is pale.
    """
    rhino = archives.library()
    made = rhino.Mesh()
    vertices, faces, paint = made.Vertices, made.Faces, made.VertexColors
    for x, y, z in design.outside(shape.vertices[frame]).tolist():
        vertices.Add(x, y, z)
    for a, b, c, d in shape.quads.tolist():
        faces.AddFace(a, b, c, d)
    for red, green, blue in _colours(shape, design.grid.fixed, coloured):
        paint.Add(red, green, blue)
    made.Normals.ComputeNormals()
    return made


def axes(result: Result, frame: int, design: Design) -> list[Any]:
    """Return the axes of all beams in a frame, from joint to joint, as polylines in the model."""
    centres = result.centres[frame]
    found = []
    for beam, (start, end) in enumerate(result.grid.beams.tolist()):
        middle = edges(result, beam, ALONG)[frame].mean(axis=1)
        points = np.concatenate([centres[[start]], middle, centres[[end]]])
        found.append(polyline(design.outside(points)))
    return found


def flat_axes(design: Design) -> list[Any]:
    """Return the axes of all beams as they are drawn, after mending."""
    ends = design.grid.joints[design.grid.beams]
    return [polyline(design.points([tuple(a), tuple(b)])) for a, b in ends.tolist()]


def _colours(shape: Skin, fixed: int, coloured: bool) -> list[list[int]]:
    """Return the colour of each vertex, which belongs to quadrilaterals of one colour only."""
    from simulearn.show.style import GHOST, colours  # a server starts without matplotlib

    rgb = np.zeros((shape.vertices.shape[1], 3))
    if coloured:
        rgb[shape.quads] = colours(shape.ratio, shape.joint, fixed)[:, None]
    else:
        rgb[:] = [int(GHOST[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    found: list[list[int]] = np.rint(255 * rgb).astype(int).tolist()
    return found
