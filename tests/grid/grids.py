"""Grids for the tests: random ones by hypothesis, and stars of beams around one joint."""

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

from simulearn.errors import InputError
from simulearn.grid import Grid, Rules, clean, draw, drop_beams, outline, validate
from simulearn.material import load_material

MATERIAL = load_material("pla-hot-water")
SECTION = MATERIAL.section
HALF = SECTION.width / 2


@st.composite
def drawn(draw_, most_dropped=3):
    """Random designs of 1 to 3 cells along each axis, some beams dropped; valid or not."""
    rules = Rules(
        cells=(draw_(st.integers(1, 3)), draw_(st.integers(1, 3))),
        jitter=draw_(st.sampled_from([0.0, 10.0, 30.0, 60.0])),
    )
    grid = draw(rules, draw_(st.integers(0, 10**6)), 0)
    dropped = draw_(st.sets(st.integers(0, len(grid.beams) - 1), max_size=most_dropped))
    return drop_beams(grid, dropped)


@st.composite
def outlined(draw_):
    """Random designs whose joints all have an outline."""
    try:
        grid, _ = clean(draw_(drawn()))
        outline(grid, SECTION)
    except InputError:
        assume(False)
    return grid


@st.composite
def valid(draw_):
    """Random designs that validate, cleaned."""
    grid = draw_(drawn())
    assume(validate(grid, MATERIAL).valid)
    return clean(grid)[0]


def star(*angles, length=60.0, turn=0.0):
    """Return a joint at the origin with a beam at each angle (degrees)."""
    a = np.radians(np.array(angles) + turn)
    joints = np.r_[[[0, 0]], length * np.c_[np.cos(a), np.sin(a)]]
    return Grid(joints, [(0, k + 1) for k in range(len(a))], np.zeros(len(a)), 0)


def moved(grid, joints=None, beams=None, actuators=None, fixed=None):
    """Return the grid with some of it replaced."""
    return Grid(
        grid.joints if joints is None else joints,
        grid.beams if beams is None else beams,
        grid.actuators if actuators is None else actuators,
        grid.fixed if fixed is None else fixed,
        grid.material,
    )


def cross(a, b):
    """Return the z component of a x b."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def corner_turns(quads):
    """Return by how much (mm2) quadrilaterals (..., 4, 2) turn left at each corner."""
    before = quads - np.roll(quads, 1, axis=-2)
    after = np.roll(quads, -1, axis=-2) - quads
    return cross(before, after)


def around(beams):
    """Return the corners (B, 4, 2) of beam outlines counter-clockwise."""
    return beams[:, [0, 1, 1, 0], [0, 0, 1, 1]]
