"""Surfaces as files of other programs have them."""

import numpy as np
import trimesh


def sheet(count=12, size=160.0):
    """Return a dish of so many squares a side."""
    x, y = np.meshgrid(*[np.linspace(-size / 2, size / 2, count + 1)] * 2)
    vertices = np.c_[x.ravel(), y.ravel(), 20 * np.cos(x.ravel() / size * 3)]
    k = np.arange((count + 1) ** 2).reshape(count + 1, count + 1)
    a, b, c, d = k[:-1, :-1], k[:-1, 1:], k[1:, 1:], k[1:, :-1]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    return trimesh.Trimesh(vertices, faces, process=False)


def broken(mesh):
    """Return the mesh with two triangles left out of its middle and one turned."""
    faces = np.delete(mesh.faces, [130, 131], axis=0)
    faces[50] = faces[50, ::-1]
    return trimesh.Trimesh(mesh.vertices, faces, process=False)


def exported(mesh, kind):
    """Return a mesh as the contents of a file."""
    data = mesh.export(file_type=kind)
    return data if isinstance(data, bytes) else data.encode()
