"""Collisions of a morphing grid with itself, found in arrays of its corners."""

from functools import partial

import numpy as np

from simulearn.collisions.collision import (
    LEAST,
    Array,
    Collision,
    Indices,
    collision_of,
    deepest_first,
    numbers,
    part_name,
    rows_of,
)


def find(
    joints: Array,
    sections: Array,
    beams: Indices,
    ratios: Array | None = None,
    least: float = LEAST,
) -> tuple[Collision, ...]:
    """Return the collisions of a grid with itself, the deepest first.

    Args:
        joints: (F, J, 8, 3) mm, corners of the joints in each frame; the first frame is flat.
        sections: (F, B, S, 4, 3) mm, corners of S sections along each beam, start to end: three
            (start, middle, end), or so many that the beam is straight between two.
        beams: (B, 2) joints of the beams.
        ratios: (B,) of the actuators, which tell where a beam of three sections is bent; None:
            along all of it.
        least: mm; what is not deeper is no collision.
    """
    given = None if ratios is None else ratios[None]
    return find_all(joints[None], sections[None], beams, given, least)[0]


def find_all(
    joints: Array,
    sections: Array,
    beams: Indices,
    ratios: Array | None = None,
    least: float = LEAST,
) -> list[tuple[Collision, ...]]:
    """Return the collisions of each of T designs of one topology; see `find`.

    Args:
        joints: (T, F, J, 8, 3) mm.
        sections: (T, F, B, S, 4, 3) mm.
        beams: (B, 2).
        ratios: (T, B).
        least: mm.
    """
    from simulearn.collisions.kernels.pairs import find_pairs  # loads the compiler

    count = len(beams)
    if ratios is None:
        ratios = np.ones((len(sections), count))
    kernel = partial(
        find_pairs,
        numbers(joints),
        numbers(sections),
        np.ascontiguousarray(beams, np.int64),
        numbers(ratios),
        np.zeros(count + joints.shape[2], np.int64),
        float(least),
    )
    collisions: list[list[Collision]] = [[] for _ in joints]
    for row in rows_of(kernel):
        a, b = (part_name(int(part), count) for part in row[1:3])
        collisions[int(row[0])].append(collision_of(row, (a, b), (0, 0)))
    return [deepest_first(some) for some in collisions]
