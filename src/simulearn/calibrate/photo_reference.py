"""What gives a photo its scale: the printed sheet, or two points whose distance is known.

Both give a camera over the sheet on which the strip stands. How wrong it may be is estimated from
other cameras that are as likely: of the sheet by the deviations of its markers, of two points by
what is not known at all, above all how far the camera was from straight above.
"""

import re
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from simulearn.calibrate.photo_camera import (
    FOCAL_KNOWN,
    FOCAL_UNKNOWN,
    Camera,
    camera_above,
    fit_camera,
)
from simulearn.calibrate.photo_file import Photo
from simulearn.calibrate.photo_markers import as_arrays, find_markers
from simulearn.calibrate.photo_sheet import FRAME, MARKERS, marker_corners
from simulearn.errors import InputError, Message

Array = NDArray[np.float64]

OTHERS = 40  # cameras that are as likely
MARGIN = 1.5  # mm from the frame, within which nothing is looked for
NOT_MEASURED, MEASURED = 0.0025, 0.0005  # relative deviation of a printed sheet's size
HELD = 6.0  # degrees, deviation of a camera that is meant to look straight down
POINT = 1.5  # pixels, deviation of a point that a person read off
NEARBY = 1.2  # of the length of a scale, within which the strip is looked for around it
FAR_OFF = 1.0  # pixels, residual of the markers of a sheet that is not flat
STEEP = 30.0  # degrees
MOST_HIGH = 50.0  # mm, of the marks of a ruler over the table
LEAST_SEEN, MOST_SEEN = 40.0, 1200.0  # mm along the longer side of a photo


@dataclass(frozen=True, eq=False)
class Reference:
    """What is known of the place of a photo's pixels.

    Attributes:
        camera: over the sheet.
        others: cameras that are as likely, each with a factor on its lengths.
        region: where the strip is looked for: left, lower, right, upper, mm.
        dark: whether the sheet is dark; None where there is none.
        size_deviation: relative deviation of all lengths.
        points: (N, 2) pixels of the markers' corners or of the ends of the scale.
        markers: how many markers were found; 0 for a scale.
        length: of the scale, mm; 0 for a sheet.
        messages: what qualifies it.
    """

    camera: Camera
    others: tuple[tuple[Camera, float], ...]
    region: tuple[float, float, float, float]
    dark: bool | None
    size_deviation: float
    points: Array
    markers: int = 0
    length: float = 0.0
    messages: tuple[Message, ...] = ()


def sheet_reference(photo: Photo, printed: tuple[float, float] | None) -> Reference:
    """Return what the markers of the sheet tell.

    Args:
        photo: of the sheet.
        printed: by how much the printed sheet is larger than meant, across and along; None if it
            was not measured.

    Raises:
        InputError: there are too few markers.
    """
    markers, dark = find_markers(photo)
    numbers, pixels = as_arrays(markers)
    scale = np.array(printed or (1.0, 1.0))
    places = np.concatenate([marker_corners(number) for number in numbers]) * scale
    camera = fit_camera(places, pixels, photo.size, photo.focal)
    others = camera.varied(OTHERS, np.random.default_rng(0))
    left, low, right, high = np.array(FRAME) * np.tile(scale, 2)
    region = (left + MARGIN, low + MARGIN, right - MARGIN, high - MARGIN)
    messages = []
    if printed is None:
        messages.append(_message("photo-size", "the sheet is taken to be printed in its true size"))
    if camera.residual > FAR_OFF:
        text = (
            f"the markers are {camera.residual:.1f} pixels away from where they would be on a flat "
            "sheet; lay the sheet flat, and do not crop the photo"
        )
        messages.append(_message("photo-not-flat", text))
    if photo.cropped:
        text = "the photo was cropped or edited, so that its lens is known less well"
        messages.append(_message("photo-cropped", text))
    if camera.tilt > STEEP:
        text = (
            f"the photo was taken {camera.tilt:.0f} degrees from straight above; below 20 is good"
        )
        messages.append(_message("photo-tilt", text))
    return Reference(
        camera,
        tuple((other, 1.0) for other in others),
        region,
        dark,
        MEASURED if printed else NOT_MEASURED,
        pixels,
        markers=len(numbers),
        messages=tuple(messages),
    )


def scale_reference(photo: Photo, text: str, height: float) -> Reference:
    """Return what two points of a photo from straight above tell.

    Args:
        photo: of a strip on its side on a plain sheet, with a ruler.
        text: the points and their distance, as "812,1204,2410,1188=100" (pixels, mm).
        height: of the points over the sheet, mm.

    Raises:
        InputError: the text is no scale, a point is not in the photo, or the height is none.
    """
    if not 0 <= height <= MOST_HIGH:
        raise InputError(
            f"the points of the scale are {height:g} mm high; they lie 0 to {MOST_HIGH:g} mm over "
            "the table",
            "photo-scale",
            "scale_height",
        )
    ends, length = _scale(text, photo)
    pixels_in_mm = float(np.linalg.norm(ends[1] - ends[0])) / length
    camera = camera_above(pixels_in_mm, height, photo.size, photo.focal)
    low, high = camera.on_plane([[0, photo.size[1] - 1], [photo.size[0] - 1, 0]])
    on_table = camera.on_plane(ends)
    low = np.maximum(low, on_table.min(axis=0) - NEARBY * length)
    high = np.minimum(high, on_table.max(axis=0) + NEARBY * length)
    random = np.random.default_rng(0)
    deviation = np.zeros(10)
    deviation[:2] = np.radians(HELD)
    deviation[6] = FOCAL_KNOWN if photo.focal else FOCAL_UNKNOWN
    others = []
    for _ in range(OTHERS):
        numbers = camera.numbers.copy()
        turned = deviation * random.standard_normal(10)
        numbers[:3] = _tilted(turned[:2])
        numbers[6] = turned[6]
        other = replace(camera, numbers=numbers)
        moved = ends + POINT * random.standard_normal(ends.shape)
        others.append((other, length / _distance(other.on_plane(moved, height))))
    note = (
        "a scale alone undoes no perspective: the photo is taken to be from straight above, give "
        f"or take {HELD:g} degrees; the printed sheet measures more exactly"
    )
    return Reference(
        camera,
        tuple(others),
        (float(low[0]), float(low[1]), float(high[0]), float(high[1])),
        None,
        MEASURED,
        ends,
        length=length,
        messages=(_message("photo-scale-only", note),),
    )


def _tilted(angles: Array) -> Array:
    """Return the turn (3,) of a camera that looks down but for two small angles."""
    from scipy.spatial.transform import Rotation

    down = Rotation.from_rotvec([np.pi, 0, 0])
    return np.asarray((Rotation.from_rotvec([*angles, 0.0]) * down).as_rotvec())


def _distance(points: ArrayLike) -> float:
    return float(np.linalg.norm(np.diff(np.asarray(points), axis=0)))


def _scale(text: str, photo: Photo) -> tuple[Array, float]:
    number = r"\s*(\d+(?:\.\d*)?|\.\d+)\s*"
    match = re.fullmatch(rf"{number},{number},{number},{number}={number}(?:mm)?\s*", text)
    if match is None:
        raise InputError(
            f'"{text}" is not a scale; it is two points of the photo in pixels and their distance '
            "in mm, as 812,1204,2410,1188=100",
            "photo-scale",
            "scale",
        )
    values = [float(group) for group in match.groups()]
    ends, length = (np.array(values[:4]).reshape(2, 2) + 0.5) / photo.shrunk - 0.5, values[4]
    width, height = (round(side * photo.shrunk) for side in photo.size)
    if not ((ends >= -0.5) & (ends < np.array(photo.size))).all():
        raise InputError(
            f"a point of the scale {text} is not in the photo, which has {width} x {height} pixels",
            "photo-scale",
            "scale",
        )
    across = length * max(photo.size) / max(_distance(ends), 1.0)  # mm in the whole photo
    if length and not LEAST_SEEN <= across <= MOST_SEEN:
        raise InputError(
            f"by the scale {text} the whole photo is {across:.4g} mm long, and photos of strips "
            f"are {LEAST_SEEN:g} to {MOST_SEEN:g}; the length behind = is in mm, the points are "
            "pixels of the photo as the camera gave it",
            "photo-scale",
            "scale",
        )
    if _distance(ends) < 50 or not length:
        raise InputError(
            f"the points of the scale {text} are too near to each other; take two that are as far "
            "apart as the strip is long",
            "photo-scale",
            "scale",
        )
    return ends, length


def _message(code: str, text: str) -> Message:
    return Message(code, "photo", text)


def found(reference: Reference) -> str:
    """Return a line that says by what a photo was measured."""
    camera = reference.camera
    if not reference.markers:
        return f"scale of {reference.length:g} mm, no perspective undone"
    sheet = "dark" if reference.dark else "white"
    return (
        f"{sheet} sheet, {reference.markers} of {MARKERS} markers, seen from "
        f"{camera.place[2]:.0f} mm above and {camera.tilt:.0f} degrees from straight above"
    )
