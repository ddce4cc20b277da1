"""Collisions of several bodies in one space, and of a body with an obstacle."""

from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

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

OBSTACLE = "obstacle"


class Body(NamedTuple):
    """A morphing grid where it stands in space; see `find.find`.

    Attributes:
        joints: (F, J, 8, 3) mm.
        sections: (F, B, S, 4, 3) mm.
        beams: (B, 2) joints of the beams.
        ratios: (B,) of the actuators, or None.
    """

    joints: Array
    sections: Array
    beams: Indices
    ratios: Array | None = None


def between(bodies: Sequence[Body], least: float = LEAST) -> tuple[Collision, ...]:
    """Return the collisions of bodies with each other, the deepest first.

    Args:
        bodies: all with the same number of frames F and sections S.
        least: mm; what is not deeper is no collision.
    """
    if len(bodies) < 2:
        return ()
    from simulearn.collisions.kernels.pairs import find_pairs  # loads the compiler

    beam_counts = [len(body.beams) for body in bodies]
    joint_counts = [body.joints.shape[1] for body in bodies]
    first_beam, first_joint = (np.cumsum([0, *counts]) for counts in (beam_counts, joint_counts))
    every = np.arange(len(bodies))
    owner = np.concatenate([np.repeat(every, beam_counts), np.repeat(every, joint_counts)])
    kernel = partial(
        find_pairs,
        numbers(np.concatenate([body.joints for body in bodies], axis=1)[None]),
        numbers(np.concatenate([body.sections for body in bodies], axis=1)[None]),
        np.concatenate(
            [
                np.asarray(body.beams, np.int64) + start
                for body, start in zip(bodies, first_joint, strict=False)
            ]
        ),
        numbers(np.concatenate([_ratios(body) for body in bodies])[None]),
        owner,
        float(least),
    )

    def named(part: int) -> tuple[str, int]:
        body = int(owner[part])
        beams = int(first_beam[-1])
        if part < beams:
            return part_name(part - int(first_beam[body]), beams), body
        return f"joint {part - beams - int(first_joint[body])}", body

    collisions = []
    for row in rows_of(kernel):
        (a, of_a), (b, of_b) = sorted((named(int(row[1])), named(int(row[2]))), key=_body)
        collisions.append(collision_of(row, (a, b), (of_a, of_b)))
    return deepest_first(collisions)


def against(body: Body, triangles: Array, least: float = LEAST) -> tuple[Collision, ...]:
    """Return where a body runs into an obstacle in some frame, the deepest first.

    Of a closed obstacle the depth is that of a corner below its surface, else the length of the
    shortest move that separates a piece of the body from a triangle.

    Args:
        body: the grid.
        triangles: (N, 3, 3) mm, of the obstacle.
        least: mm; what is not deeper is no collision.
    """
    triangles = numbers(triangles)
    if not len(triangles):
        return ()
    from simulearn.collisions.kernels.solid import find_in_solid  # loads the compiler

    beams = len(body.beams)
    found = np.empty((beams + body.joints.shape[1], 10))
    count = find_in_solid(
        numbers(body.joints),
        numbers(body.sections),
        numbers(_ratios(body)),
        triangles,
        is_closed(triangles),
        float(least),
        found,
    )
    return deepest_first(
        collision_of(row, (part_name(int(row[1]), beams), OBSTACLE), (0, 0))
        for row in found[:count]
    )


def is_closed(triangles: Array) -> bool:
    """Return whether triangles (N, 3, 3) are the surface of a body: each side is there twice."""
    points = triangles.reshape(-1, 3)
    size = float(np.ptp(points, axis=0).max())
    _, index = np.unique(np.round(points / max(size, 1e-9), 7), axis=0, return_inverse=True)
    index = index.reshape(-1, 3)
    sides = np.sort(np.concatenate([index[:, [0, 1]], index[:, [1, 2]], index[:, [2, 0]]]), axis=1)
    _, counts = np.unique(sides, axis=0, return_counts=True)
    return bool((counts % 2 == 0).all())


def _body(named: tuple[str, int]) -> int:
    return named[1]


def _ratios(body: Body) -> Array:
    return np.ones(len(body.beams)) if body.ratios is None else np.asarray(body.ratios)
