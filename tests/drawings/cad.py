"""What the tests of CAD readers share: a grid as lines, and how to compare and to break files."""

import random
from collections.abc import Iterator

import numpy as np

from simulearn.drawings.drawing import Drawing, Points

# Joints and beams of an L of three square cells; the cell at the upper right is missing, so that a
# mirrored, turned or wrongly scaled reading differs.
JOINTS = [(0, 0), (65, 0), (130, 0), (0, 65), (65, 65), (130, 65), (0, 130), (65, 130)]
BEAMS = [(0, 1), (1, 2), (3, 4), (4, 5), (6, 7), (0, 3), (3, 6), (1, 4), (4, 7), (2, 5)]


def beams() -> list[tuple[tuple[float, float, float], tuple[float, float, float]]]:
    """Return the ends of the beams, mm."""
    return [((*JOINTS[a], 0.0), (*JOINTS[b], 0.0)) for a, b in BEAMS]


def segments(drawing: Drawing) -> set[frozenset[tuple[float, ...]]]:
    """Return the segments of a drawing without their direction, to 1e-6 of a unit."""
    return {
        frozenset((tuple(np.round(a, 6) + 0.0), tuple(np.round(b, 6) + 0.0)))
        for line in drawing.lines
        for a, b in zip(line.points, line.points[1:], strict=False)
    }


def expected(scale: float = 1.0) -> set[frozenset[tuple[float, ...]]]:
    """Return the segments of the grid, mm times scale."""
    return {
        frozenset(tuple(round(c * scale, 6) + 0.0 for c in end) for end in ends) for ends in beams()
    }


def left_out(drawing: Drawing) -> dict[tuple[str, str, str], int]:
    """Return what is left out, by kind, layer and reason."""
    return {(thing.kind, thing.layer, thing.reason): thing.count for thing in drawing.left_out}


def sagitta(points: Points, centre: tuple[float, float], radius: float) -> float:
    """Return the largest distance between an arc and its chords; corners lie on the arc."""
    corners = np.linalg.norm(points[:, :2] - centre, axis=1)
    np.testing.assert_allclose(corners, radius, rtol=0, atol=1e-6)
    middles = (points[:-1, :2] + points[1:, :2]) / 2
    return float(np.max(radius - np.linalg.norm(middles - centre, axis=1)))


def broken(data: bytes, count: int, seed: int) -> Iterator[bytes]:
    """Return a file broken in several ways: cut off, bytes flipped, lost or swapped, or noise."""
    rng = random.Random(seed)
    for number in range(count):
        found = bytearray(data)
        match number % 5:
            case 0:
                del found[rng.randrange(len(data)) :]
            case 1:
                for _ in range(rng.choice((1, 5, 50))):
                    found[rng.randrange(len(found))] = rng.randrange(256)
            case 2:
                start = rng.randrange(len(data))
                del found[start : start + rng.randrange(1, 300)]
            case 3:
                a, b = sorted(rng.sample(range(len(data) - 100), 2))
                found[a : a + 60], found[b : b + 60] = found[b : b + 60], found[a : a + 60]
            case _:
                found[rng.randrange(50) :] = rng.randbytes(rng.randrange(4000))
        yield bytes(found)
