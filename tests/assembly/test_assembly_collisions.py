"""What runs into what in an assembly: when, how deep, and what touches on purpose."""

import dataclasses
import threading

import numpy as np
import pytest
import trimesh

import assembling
import synthetic
from simulearn.assembly import Assembly, Obstacle, Part, Step, checked, simulate_assembly, simulated
from simulearn.errors import CancelledError
from simulearn.rigid import Place
from simulearn.simulate.colliding import with_collisions

THICK = 4.0  # mm, of the beams


def still(points, share):
    """Leave points of the flat grid where they are."""
    return points


def flat(*parts, **more):
    return simulate_assembly(Assembly(parts, **more), assembling.Rolling(still))


def part(name, *at):
    return Part(name, assembling.SQUARE, assembling.at(*at))


def box(folder, size, at, name="box"):
    trimesh.creation.box(size).export(folder / f"{name}.stl")
    return Obstacle(name, folder / f"{name}.stl", assembling.at(*at))


def test_parts_apart_do_not_collide_and_parts_in_each_other_do():
    assert flat(part("a"), part("b", 0, 0, THICK + 0.5)).collisions == ()
    found = flat(part("a"), part("b", 0, 0, THICK - 1.5)).collisions
    assert {one.names for one in found} == {("a", "b")}
    assert found[0].depth_mm == pytest.approx(1.5, abs=0.05)
    assert found[0].step == 0
    assert "a (" in found[0].words
    assert "by 1.5 mm in step 1" in found[0].words


def test_joined_parts_may_touch_but_not_deeper_than_said():
    two = part("a"), part("b", 0, 0, THICK - 1.5)
    assert flat(*two, joined=(("b", "a"),), joined_mm=1.6).collisions == ()
    assert flat(*two, joined=(("b", "a"),), joined_mm=1.4).collisions
    third = part("c", 0, 0, -THICK + 1.5)
    names = {one.names for one in flat(*two, third, joined=(("b", "a"),)).collisions}
    assert names == {("a", "c")}


def test_what_a_slide_passes_through_is_found_at_its_time():
    # A plate that is thin against the slide stands across it, halfway.
    gate = part("gate", 0, 0, 30)
    steps = (Step(("gate",)), Step(("mover",), 2.0, {"mover": (0.0, 0.0, 60.0)}))
    found = flat(gate, part("mover"), steps=steps).collisions
    assert {one.names for one in found} == {("gate", "mover")}
    assert {one.step for one in found} == {1}
    assert [one.time for one in found] == pytest.approx([2.0] * len(found), abs=0.1)
    assert found[0].place[2] == pytest.approx(30, abs=2.5)


def test_a_part_that_waits_is_not_there_yet():
    # One slides down through the place where another waits, before that one sets out upwards.
    early = Step((), 1.0, {"early": (0.0, 0.0, 200.0)})
    late = Step((), 1.0, {"late": (0.0, 0.0, -100.0)})
    parts = part("early"), part("late", 0, 0, 200)
    assert flat(*parts, steps=(early, late)).collisions == ()
    there = part("early"), part("late", 0, 0, 100)
    assert flat(*there, steps=(early,)).collisions


def test_an_obstacle_is_met_in_the_frame_that_reaches_it(tmp_path):
    # The sides of a grid that rolls up come down on a block; its middle never moves.
    high = assembling.Rolling().simulate([assembling.SQUARE])[0]
    top = float(high.joints[-1, ..., 2].max())
    block = box(tmp_path, (400.0, 400.0, 10.0), (0, 0, top / 2 + 5))
    parts = (Part("a", assembling.SQUARE),)
    found = simulate_assembly(Assembly(parts, obstacles=(block,)), assembling.Rolling()).collisions
    assert {one.names for one in found} == {("a", "box")}
    assert {one.where[1] for one in found} == {"obstacle"}
    rims = {one.where[0] for one in found if one.where[0].startswith("joint")}
    assert rims == {f"joint {k}" for k in (0, 2, 3, 5, 6, 8)}
    clear = dataclasses.replace(block, place=assembling.at(0, 0, top + 6))
    assembled = simulate_assembly(Assembly(parts, obstacles=(clear,)), assembling.Rolling())
    assert assembled.collisions == ()


def test_an_obstacle_that_is_not_closed_is_told(tmp_path):
    block = box(tmp_path, (400.0, 400.0, 10.0), (0, 0, 300))
    assembly = Assembly((Part("a", assembling.SQUARE),), obstacles=(block,))
    assert simulate_assembly(assembly, assembling.Rolling()).warnings == ()
    mesh = trimesh.load(block.file)
    mesh.update_faces(np.arange(len(mesh.faces)) > 0)
    mesh.export(block.file)
    (message,) = simulate_assembly(assembly, assembling.Rolling()).warnings
    assert message.code == "surface-open"
    assert "obstacle box is no closed body" in message.message


def test_what_stands_still_is_compared_once_and_named_rightly():
    # Two pairs that stand still, and a part that comes last and runs into the second pair.
    parts = [part("a"), part("b", 500), part("c", 0, 0, 3), part("late", 500, 0, 3)]
    steps = (Step(("a", "b", "c")), Step(("late",), 1.0, {"late": (0.0, 0.0, 40.0)}))
    found = flat(*parts, steps=steps).collisions
    assert {(one.names, one.step) for one in found} == {(("a", "c"), 0), (("b", "late"), 1)}
    for one in found:
        if one.names == ("b", "late"):
            assert one.where[0].split()[0] in ("beam", "joint")
            assert one.place[0] > 300


def test_progress_counts_steps_and_a_token_stops():
    made = simulated(Assembly((part("a"), part("b", 0, 0, 90))), assembling.Rolling(still))
    assert made.collisions == ()
    seen = []
    checked(made, lambda *numbers: seen.append(numbers))
    assert seen == [(0, 1), (1, 1)]
    token = threading.Event()
    token.set()
    with pytest.raises(CancelledError):
        checked(made, cancel=token)


def test_a_place_turns_what_is_compared():
    turned = Place(np.diag([-1.0, 1.0, -1.0]), np.array([0, 0, THICK - 1.5]))  # on its head
    found = flat(part("a"), Part("b", assembling.SQUARE, turned)).collisions
    assert found[0].depth_mm == pytest.approx(1.5, abs=0.05)
    away = Place(turned.turn, np.array([0, 0, THICK + 0.5]))
    assert flat(part("a"), Part("b", assembling.SQUARE, away)).collisions == ()


def test_a_part_that_runs_into_itself_is_said_once_in_its_step():
    class Coiling(assembling.Rolling):
        """An engine that rolls grids up so far that their ends pass each other."""

        def simulate(self, grids, progress=None, cancel=None):
            results = super().simulate(grids)
            return [with_collisions(one) for one in results]

    coil = Coiling(lambda points, share: synthetic.cylinder(points, share, 0.055))
    grid = synthetic.square_grid((3, 1))
    parts = (Part("one", grid), Part("two", grid, assembling.at(0, 0, 500), copy_of="one"))
    steps = (Step(("two",), 1.0), Step(("one",), 1.0))
    found = simulate_assembly(Assembly(parts, steps), coil).collisions
    assert {(one.names, one.step) for one in found} == {(("one", "one"), 1)}
    assert 1.5 < found[0].time <= 2.0
    assert "one with itself" in found[0].words
