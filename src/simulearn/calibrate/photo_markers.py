"""The markers of the sheet in a photo, and the corners of each to a small part of a pixel.

OpenCV finds and identifies them. The corners are then taken where lines through the middle parts of
the sides meet, since blur rounds a corner but shifts no side.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.calibrate.photo_edges import edge_offsets
from simulearn.calibrate.photo_file import Photo
from simulearn.calibrate.photo_sheet import CELLS, DARK, MARKERS
from simulearn.errors import InputError

Array = NDArray[np.float64]

FEWEST = 4
SAMPLES = 24  # of a side
DETECTION = 2000  # pixels of the longer side, of the picture in which markers are looked for first
SHARP = 1e-3  # variance of the Laplacian of a sharp photo of a sheet, at least


def find_markers(photo: Photo) -> tuple[dict[int, Array], bool]:
    """Return the corners (4, 2) in pixels of the markers, by their numbers from 0 to 7.

    Returns:
        The corners, in the order of `photo_sheet.marker_corners`, and whether the sheet is dark.

    Raises:
        InputError: there are fewer than four.
    """
    import cv2

    grey: Any = cv2.cvtColor(photo.pixels, cv2.COLOR_RGB2GRAY)
    found = _detected(grey, DETECTION)
    if len(found) < MARKERS:
        found = _detected(grey, max(photo.size)) | found
    dark = sum(number >= DARK for number in found) > len(found) / 2
    ours = {n % MARKERS: c for n, c in found.items() if (n >= DARK) == dark}
    if len(ours) < FEWEST:
        raise _too_few(photo, grey, len(ours))
    light = photo.light.mean(axis=2)
    refined = {number: _refined(light, corners) for number, corners in sorted(ours.items())}
    return refined, dark


def _detected(grey: Any, longest: int) -> dict[int, Array]:
    """Return the corners of all markers, found in a picture of so many pixels in length."""
    import cv2

    shrunk = max(1.0, max(grey.shape) / longest)
    if shrunk > 1:
        size = round(grey.shape[1] / shrunk), round(grey.shape[0] / shrunk)
        grey = cv2.resize(grey, size, interpolation=cv2.INTER_AREA)
    family = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
    corners, numbers, _ = cv2.aruco.ArucoDetector(family).detectMarkers(grey)
    if numbers is None:
        return {}
    return {
        int(number): (one.reshape(4, 2).astype(float) + 0.5) * shrunk - 0.5
        for number, one in zip(np.ravel(numbers), corners, strict=True)
        if int(number) < DARK + MARKERS
    }


def _refined(light: NDArray[np.float32], corners: Array) -> Array:
    """Return corners as the meeting points of lines through the sides."""
    for _ in range(2):
        middle = corners.mean(axis=0)
        lines = []
        for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            cell = float(np.linalg.norm(end - start)) / CELLS
            part = np.linspace(0.12, 0.88, SAMPLES)[:, None]
            points = start + part * (end - start)
            normal = np.array([end[1] - start[1], start[0] - end[0]]) / (cell * CELLS)
            normal *= np.sign(normal @ (start - middle))
            normals = np.tile(normal, (SAMPLES, 1))
            near, far = 0.25 * cell, 0.75 * cell
            offsets, _width = edge_offsets(light, points, normals, 0.5 * cell, near, far, 0.05)
            good = np.isfinite(offsets)
            if good.sum() < SAMPLES / 2:
                return corners
            lines.append(_line((points + normals * offsets[:, None])[good]))
        corners = np.array([_meeting(lines[k - 1], lines[k]) for k in range(4)])
    return corners


def _line(points: Array) -> tuple[Array, Array]:
    """Return a point and the direction of the line through points, without those far off it."""
    for _ in range(2):
        middle = points.mean(axis=0)
        direction = np.linalg.svd(points - middle)[2][0]
        off = np.abs((points - middle) @ [-direction[1], direction[0]])
        points = points[off <= max(3 * np.median(off), 0.1)]
    return middle, direction


def _meeting(one: tuple[Array, Array], other: tuple[Array, Array]) -> Array:
    part = np.linalg.solve(np.column_stack([one[1], -other[1]]), other[0] - one[0])
    return np.asarray(one[0] + part[0] * one[1])


def _too_few(photo: Photo, grey: NDArray[np.uint8], count: int) -> InputError:
    """Return the error that says how many markers there are, and what may be the reason."""
    import cv2

    size = (
        round(800 * grey.shape[1] / max(grey.shape)),
        round(800 * grey.shape[0] / max(grey.shape)),
    )
    small = cv2.resize(grey, size, interpolation=cv2.INTER_AREA).astype(np.float64) / 255
    blurred = float(cv2.Laplacian(small, cv2.CV_64F).var()) < SHARP
    number = {0: "none", 1: "1 only"}.get(count, f"{count} only")
    why = "; the photo is blurred: hold still, and touch the strip on the screen to focus"
    return InputError(
        f"{photo.name}: of the {MARKERS} markers of the printed sheet {number} can be seen, and "
        f"{FEWEST} are needed; photograph the whole sheet from above, or give a scale if there is "
        f"no sheet{why if blurred else ''}",
        "photo-markers",
        photo.name,
    )


def as_arrays(markers: Mapping[int, Array]) -> tuple[list[int], Array]:
    """Return the numbers of markers and all their corners (4 M, 2) in this order."""
    numbers = sorted(markers)
    return numbers, np.concatenate([markers[number] for number in numbers])
