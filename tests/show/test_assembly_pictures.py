"""Pictures of assemblies: obstacles, rings around collisions, the sequence in a strip and a GIF."""

import dataclasses
import threading

import numpy as np
import pytest
import trimesh
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from PIL import Image

import assembling
from simulearn.assembly import Obstacle, PartCollision, simulate_assembly
from simulearn.errors import CancelledError
from simulearn.show import Camera, style
from simulearn.show.assembly import animate_assembly, assembled_picture, strip
from simulearn.show.solids import solid


@pytest.fixture(scope="module")
def assembled(tmp_path_factory):
    wall = tmp_path_factory.mktemp("wall") / "wall.stl"
    trimesh.creation.box((300, 5, 120)).export(wall)
    around = (Obstacle("wall", wall, assembling.at(0, 290, 40)),)
    return simulate_assembly(assembling.three(obstacles=around), assembling.Rolling())


def colliding(assembled):
    place = (0.0, 280.0, 10.0)
    hit = PartCollision(("second", "wall"), ("beam 3", "obstacle"), 2.0, 1, 3.25, place)
    return dataclasses.replace(assembled, collisions=(hit,))


def pixels(figure):
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3] / 255.0


def near(picture, colour, within=0.02):
    return (abs(picture - to_rgb(colour)) < within).all(axis=-1)


def test_the_end_shows_obstacles_and_rings_where_parts_collide(assembled):
    plain = pixels(assembled_picture(assembled))
    ringed = pixels(assembled_picture(colliding(assembled)))
    assert not near(plain, style.COLLISION).any()
    assert near(ringed, style.COLLISION).sum() > 50
    texts = [t.get_text() for t in assembled_picture(colliding(assembled)).texts]
    assert any(
        "1 collision, the deepest second (beam 3) with wall by 3.2 mm in step 2" in text
        for text in texts
    )
    wooden = np.abs(np.diff(plain / plain.sum(axis=-1, keepdims=True), axis=-1)).max(axis=-1)
    assert (wooden > 0.01).mean() > 0.1  # what is not grey: the wall and actuators


def test_a_strip_has_the_start_and_the_end_of_each_step(assembled):
    (ax,) = [a for a in strip(assembled).axes if a.child_axes]
    assert len(ax.child_axes) == 3
    assert [text.get_text() for text in ax.texts][-3:] == [
        "start",
        "step 1 of 2: first",
        "step 2 of 2: in",
    ]
    (ax,) = [a for a in strip(assembled, 4).axes if a.child_axes]
    assert len(ax.child_axes) == 4


def test_the_sequence_moves_and_can_be_stopped(assembled, tmp_path):
    path, seen = tmp_path / "a.gif", []
    quick = simulate_assembly(assembling.three(pace=0.25), assembling.Rolling())
    animate_assembly(quick, path, width=2.5, dpi=60, progress=lambda *n: seen.append(n))
    with Image.open(path) as film:
        frames = []
        for k in range(film.n_frames):
            film.seek(k)
            frames.append(np.asarray(film.convert("L")).astype(float))
    assert seen[-1] == (len(seen), len(seen))
    assert len(frames) > 15
    third = len(frames) // 3
    for a, b in ((0, third), (third, -1)):
        assert np.abs(frames[a] - frames[b]).mean() > 0.5
    token = threading.Event()
    token.set()
    with pytest.raises(CancelledError):
        animate_assembly(assembled, tmp_path / "b.gif", cancel=token)
    assert not (tmp_path / "b.gif").exists()


def test_a_solid_is_cut_into_small_triangles_of_the_same_surface():
    box = trimesh.creation.box((40, 10, 10))
    cut = solid(np.asarray(box.vertices), np.asarray(box.faces), 5.0)
    corners = cut.vertices[0][cut.quads]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    assert area.sum() / 2 == pytest.approx(box.area)
    edges = corners - np.roll(corners, -1, axis=1)
    assert np.linalg.norm(edges, axis=2).max() <= 5.0 + 1e-9
    # The twelve edges of the box, once from either side, and no diagonal.
    drawn = np.linalg.norm(edges, axis=2)[cut.sharp].sum()
    assert drawn == pytest.approx(2 * 4 * (40 + 10 + 10))


def test_an_obstacle_far_off_does_not_make_the_parts_small(assembled, tmp_path):
    floor = tmp_path / "floor.stl"
    trimesh.creation.box((5000, 5000, 1)).export(floor)
    around = (Obstacle("floor", floor, assembling.at(0, 0, -60)),)
    large = simulate_assembly(assembling.three(obstacles=around), assembling.Rolling())
    camera = Camera(-60, 40)
    spans = []
    for one in (assembled, large):
        (ax,) = [a for a in assembled_picture(one, camera).axes if a.collections]
        spans.append(np.ptp(ax.get_xlim()))
    assert spans[1] < 2.2 * spans[0]
