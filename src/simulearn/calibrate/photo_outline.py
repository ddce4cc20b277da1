"""The outline of the strip on the sheet, from its edges in the photo.

A strip stands up from the sheet by its width, so that a photo shows its upper edge where it leans
away from the camera and its lower edge where it leans towards it: the outline of an upright prism
is seen at the top where its normal points away from the place below the camera, else at the bottom.
So each point of the outline is taken back to the sheet from the height at which it is seen. Where
one goes over into the other the outline runs towards the camera, and the height does not matter.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from simulearn.calibrate.photo_camera import Camera
from simulearn.calibrate.photo_edges import edge_offsets
from simulearn.calibrate.photo_file import Photo
from simulearn.calibrate.photo_reference import Reference
from simulearn.calibrate.photo_segment import COARSE, Band, find_strip, relative_light
from simulearn.errors import InputError

Array = NDArray[np.float64]

SPACING = 0.2  # mm between points of the outline
ROUNDING = 0.45  # mm, over which the outline of pixels is smoothed
REACH = 0.9  # mm, within which an edge is looked for
NEAR, FAR = (0.2, 1.5), (0.55, 3.5)  # from where to where the light beside it is taken: mm, pixels
BLURRED = 0.45  # mm, deviation of the blur of an edge, at most
SPREAD = 1.683  # deviations of a blur in which it goes from a fifth to four fifths
FOUND = 0.6  # of the outline where there must be an edge
CONTRAST = {"colour": 0.25, "darker": 0.08, "brighter": 0.15}


@dataclass(frozen=True, eq=False)
class Outline:
    """The outline of a strip.

    Attributes:
        points: (N, 2) mm on the sheet.
        pixels: (N, 2) where they are in the photo.
        top: (N,) whether the upper edge was seen.
        middle: (M, 2) roughly along the middle of the strip, mm.
        blur: deviation of the blur of its edges, mm.
        lightness: light of the strip over that of the empty sheet.
        band: what was found of it, in pixels of a picture of its own.
    """

    points: Array
    pixels: Array
    top: NDArray[np.bool_]
    middle: Array
    blur: float
    lightness: float
    band: Band


def find_outline(photo: Photo, reference: Reference, thickness: float, width: float) -> Outline:
    """Return the outline of the strip in a photo.

    Args:
        photo: of it.
        reference: its camera, and where the strip is looked for.
        thickness: of the strip, mm.
        width: by which it stands up, mm.

    Raises:
        InputError: there is no strip or more than one, it reaches the edge, or it is blurred.
    """
    import cv2

    camera = reference.camera
    light = photo.light
    picture, beyond = _from_above(light, camera, reference.region)
    relative = relative_light(picture, COARSE, bool(reference.dark))
    apart = None
    if not reference.markers:
        apart = _around(camera.on_plane(reference.points), reference.region, beyond.shape)
    band = find_strip(relative, COARSE, thickness, reference.dark, beyond, apart)

    chains, _ = cv2.findContours(
        band.mask.astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE
    )
    chain = max(chains, key=len)[:, 0].astype(float)
    rough, normals = _smooth(_to_sheet(chain, reference.region))
    start = camera.pixels(_raised(rough))
    direction = camera.pixels(_raised(rough + 0.2 * normals)) - start
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    grey = _grey(light, relative, band, picture)
    scale = camera.scale_at(rough.mean(axis=0))
    near, far = (max(mm * scale, pixels) for mm, pixels in (NEAR, FAR))
    contrast = CONTRAST[band.kind]
    offsets, spread = edge_offsets(grey, start, direction, REACH * scale, near, far, contrast)
    good = np.isfinite(offsets)
    blur = float(np.nanmedian(spread)) / SPREAD / scale if np.isfinite(spread).any() else np.inf
    if blur > BLURRED:
        raise InputError(
            "the strip is blurred; hold still, touch the strip on the screen to focus, and go "
            "closer",
            "photo-blurred",
        )
    if good.mean() < FOUND:
        raise InputError(
            "the strip has no clear edges in the photo; use more light, from all around, and a "
            "sheet from which the strip's colour differs",
            "photo-no-strip",
        )
    pixels = (start + offsets[:, None] * direction)[good]
    low, high = camera.on_plane(pixels, 0.0), camera.on_plane(pixels, width)
    top = ((low - camera.place[:2]) * normals[good]).sum(axis=1) > 0
    points = np.where(top[:, None], high, low)
    middle = camera.on_plane(
        camera.pixels(_raised(_to_sheet(band.middle, reference.region))), width / 2
    )
    lightness = float(np.median(relative[band.mask]))
    return Outline(points, pixels, top, middle, blur, lightness, band)


def _raised(points: Array) -> Array:
    return np.column_stack([points, np.zeros(len(points))])


def _to_sheet(pixels: Array, region: tuple[float, float, float, float]) -> Array:
    """Return the places (N, 2) mm of pixels of the picture from above."""
    at = (pixels + 0.5) / COARSE
    return np.stack([region[0] + at[:, 0], region[3] - at[:, 1]], axis=1)


def _from_above(
    light: NDArray[np.float32], camera: Camera, region: tuple[float, float, float, float]
) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    """Return the sheet as seen from straight above, and where the photo does not reach."""
    import cv2

    left, low, right, high = region
    columns, rows = int((right - left) * COARSE), int((high - low) * COARSE)
    x = left + (np.arange(columns) + 0.5) / COARSE
    y = high - (np.arange(rows) + 0.5) / COARSE
    places = np.stack([*np.meshgrid(x, y), np.zeros((rows, columns))], axis=-1)
    at = camera.pixels(places)
    size = np.array(camera.size)
    beyond = ((at < 0) | (at > size - 1)).any(axis=-1)
    shrunk = max(1, int(camera.scale_at([(left + right) / 2, (low + high) / 2]) / COARSE))
    small = cv2.resize(light, (size[0] // shrunk, size[1] // shrunk), interpolation=cv2.INTER_AREA)
    at = (at + 0.5) * (np.array(small.shape[1::-1]) / size) - 0.5
    picture = cv2.remap(
        small,
        at[..., 0].astype(np.float32),
        at[..., 1].astype(np.float32),
        cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
    )
    return np.asarray(picture, np.float32), np.asarray(beyond)


def _around(
    ends: Array, region: tuple[float, float, float, float], shape: tuple[int, ...]
) -> NDArray[np.bool_]:
    """Return the pixels near the line between the ends of a scale, where its ruler lies."""
    import cv2

    at = np.stack([ends[:, 0] - region[0], region[3] - ends[:, 1]], axis=1) * COARSE
    mask = np.zeros(shape[:2], np.uint8)
    first, second = (tuple(int(value) for value in np.rint(end)) for end in at)
    cv2.line(mask, first, second, 1, max(1, round(2 * COARSE)))
    return mask > 0


def _smooth(chain: Array) -> tuple[Array, Array]:
    """Return points (N, 2) around a closed chain, evenly spaced, and their outward normals."""
    closed = np.concatenate([chain, chain[:1]])
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    count = max(40, round(along[-1] / SPACING))
    at = np.linspace(0, along[-1], count, endpoint=False)
    points = np.stack([np.interp(at, along, axis) for axis in closed.T], axis=1)
    points = gaussian_filter1d(points, ROUNDING / (along[-1] / count), axis=0, mode="wrap")
    step = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
    normals = np.stack([step[:, 1], -step[:, 0]], axis=1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    x, y = points.T
    if np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) < 0:  # clockwise
        normals = -normals
    return points, normals


def _grey(
    light: NDArray[np.float32],
    relative: NDArray[np.float32],
    band: Band,
    picture: NDArray[np.float32],
) -> NDArray[np.float32]:
    """Return the photo in one number a pixel, in which strip and sheet differ and shadows do not.

    A pixel is so much of the strip's colour and so much of the sheet's. Where the strip has a
    colour, the number is the sheet's part: neither shades of the strip nor the blur of its edge
    change where that has fallen to a half. Else it is the light along the difference of both.
    """
    import cv2

    inside = cv2.erode(band.mask.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
    strip = np.median(relative[inside], axis=0).astype(float)
    sheet = np.median((picture / np.maximum(relative, 1e-6))[~band.mask], axis=0).astype(float)
    if band.kind == "colour":
        parts = np.linalg.pinv(np.stack([strip, np.ones(3)], axis=1))[1]
    elif band.kind == "darker":
        parts = np.ones(3) / 3
    else:
        parts = (strip - 1) / np.sum((strip - 1) ** 2)
    return np.asarray(light @ (parts / np.maximum(sheet, 1e-3)).astype(np.float32))
