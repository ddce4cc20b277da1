"""What is wanted is seen in pictures, however its surface is cut into triangles."""

import numpy as np
import pytest
import trimesh
from matplotlib.figure import Figure

from simulearn.inverse import Goals
from simulearn.inverse.clear import ClearOf, courses
from simulearn.inverse.goals import Part
from simulearn.show.camera import Camera
from simulearn.show.targets import draw_sets, extents
from simulearn.surfaces import Surface

BOX = np.array([[-80.0, -80, -20], [80, 80, 40]])


def of_wall(*size):
    wall = trimesh.creation.box(size)
    wanted = ClearOf(Surface(wall.vertices, wall.faces), 1.0, 4.0)
    return Goals.together([Part(wanted, courses(4), np.ones(1))])


@pytest.mark.parametrize("size", [(30, 10, 30), (400, 10, 300), (1e6, 10, 1e6)])
def test_a_wall_of_large_triangles_is_drawn_where_the_shape_is(size):
    goals, ax = of_wall(*size), Figure().add_subplot()
    draw_sets(ax, goals, BOX, Camera())
    (net,) = ax.collections
    seen = np.concatenate([path.vertices for path in net.get_paths()])
    across = min(size[0], 160.0)
    assert 0.5 * across < np.ptp(seen[:, 0]) < 1.5 * across
    low, high = extents(goals, BOX, Camera())
    assert (high - low).max() < 300
