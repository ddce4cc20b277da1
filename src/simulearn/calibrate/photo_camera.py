"""The camera of a photo, found from points whose places on the sheet are known.

A pinhole with square pixels and a little radial bending of the lens: x' = x (1 + bend r^2) for a
direction x at distance r from the axis (Brown 1966, first term). Ten numbers are fitted to the
corners of the markers in the photo: turn, place, focal length, where the axis meets the picture,
bend. Corners alone do not fix them all (from straight above a longer lens looks like a greater
distance), so each number beyond turn and place has an expected value with its deviation, as one
more measurement. What they leave open is in the covariance, and so in every uncertainty.

With the camera a point of the photo has a place on any plane that is parallel to the sheet.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from simulearn.calibrate.photo_file import FILM_DIAGONAL

Array = NDArray[np.float64]

FOCAL_GUESS = 26.0  # mm on 35 mm film: the main lens of telephones, 24 to 28
FOCAL_UNKNOWN, FOCAL_KNOWN = 0.2, 0.04  # relative deviations without and with a word of the file
AXIS = 0.008  # of the diagonal, deviation of the axis from the middle of the picture
BEND = 0.02  # deviation of the lens from a straight one; telephones straighten their photos
CORNER = 0.15  # pixels, least deviation of a marker's corner
ROUNDS = 8  # of undoing the bend


@dataclass(frozen=True, eq=False)
class Camera:
    """A camera over the sheet.

    Attributes:
        numbers: (10,) turn (3) as a rotation vector from the sheet's axes to the camera's, place of
            the sheet's origin before the camera (3) mm, the third over what the focal length is
            more than `focal`, so that the picture hardly depends on the length; log of the focal
            length over `focal`, the axis's distance from the middle (2) in diagonals, bend.
        size: of the picture, pixels.
        focal: expected focal length, pixels.
        covariance: (10, 10) of the numbers; zero where nothing is known of it.
        residual: root mean square distance of the corners, pixels.
    """

    numbers: Array
    size: tuple[int, int]
    focal: float
    covariance: Array
    residual: float = 0.0

    @property
    def turn(self) -> Array:
        """(3, 3) from the sheet's axes to the camera's (right, down, forward)."""
        return np.asarray(Rotation.from_rotvec(self.numbers[:3]).as_matrix())

    @property
    def focal_length(self) -> float:
        """Fitted focal length, pixels."""
        return float(self.focal * np.exp(self.numbers[6]))

    @property
    def shift(self) -> Array:
        """(3,) place of the sheet's origin in the camera's axes, mm."""
        return self.numbers[3:6] * [1, 1, np.exp(self.numbers[6])]

    @cached_property
    def place(self) -> Array:
        """(3,) of the camera over the sheet, mm."""
        return -self.turn.T @ self.shift

    @property
    def tilt(self) -> float:
        """Angle between the camera's axis and straight down, degrees."""
        return float(np.degrees(np.arccos(np.clip(-self.turn[2, 2], -1, 1))))

    @property
    def axis(self) -> Array:
        """(2,) where the camera's axis meets the picture, pixels."""
        return np.array(self.size) / 2 - 0.5 + self.numbers[7:9] * np.hypot(*self.size)

    def pixels(self, points: ArrayLike) -> Array:
        """Return where points (..., 3) mm over the sheet are in the photo: (..., 2) pixels."""
        seen = np.asarray(points, float) @ self.turn.T + self.shift
        flat = seen[..., :2] / seen[..., 2:]
        bent = flat * (1 + self.numbers[9] * (flat**2).sum(axis=-1, keepdims=True))
        return np.asarray(self.axis + self.focal_length * bent)

    def on_plane(self, pixels: ArrayLike, height: ArrayLike = 0.0) -> Array:
        """Return the places (..., 2) mm of pixels (..., 2) at a height (mm) over the sheet."""
        bent = (np.asarray(pixels, float) - self.axis) / self.focal_length
        flat = bent
        for _ in range(ROUNDS):
            flat = bent / (1 + self.numbers[9] * (flat**2).sum(axis=-1, keepdims=True))
        rays = np.concatenate([flat, np.ones_like(flat[..., :1])], axis=-1) @ self.turn
        along = (np.asarray(height) - self.place[2]) / rays[..., 2]
        return np.asarray(self.place[:2] + along[..., None] * rays[..., :2])

    def scale_at(self, point: ArrayLike) -> float:
        """Return how many pixels a mm of the sheet is at a point (2,) mm of it."""
        x, y = np.asarray(point, float)
        square = self.pixels([[x, y, 0], [x + 1, y, 0], [x, y + 1, 0]])
        right, up = square[1:] - square[0]
        return float(np.sqrt(abs(right[0] * up[1] - right[1] * up[0])))

    def varied(self, count: int, random: np.random.Generator) -> "list[Camera]":
        """Return cameras that the corners allow too, drawn by the covariance."""
        drawn = random.multivariate_normal(self.numbers, self.covariance, count, method="eigh")
        return [replace(self, numbers=numbers) for numbers in drawn]


def fit_camera(places: Array, pixels: Array, size: tuple[int, int], focal: float | None) -> Camera:
    """Return the camera that shows points of the sheet where they are in the photo.

    Args:
        places: (N, 2) mm, at least four, not in a line.
        pixels: (N, 2) where they are in the photo.
        size: of the photo, pixels.
        focal: length by the file, pixels; None where it is not known.
    """
    expected = focal or FOCAL_GUESS / FILM_DIAGONAL * float(np.hypot(*size))
    deviation = np.array([FOCAL_KNOWN if focal else FOCAL_UNKNOWN, AXIS, AXIS, BEND])
    raised = np.column_stack([places, np.zeros(len(places))])
    blank = Camera(np.zeros(10), size, expected, np.zeros((10, 10)))

    def off(numbers: Array, corner: float) -> Array:
        wrong = replace(blank, numbers=numbers).pixels(raised) - pixels
        return np.concatenate([wrong.ravel() / corner, numbers[6:] / deviation])

    start = np.concatenate([_pose(places, pixels, blank), np.zeros(4)])
    corner = CORNER
    for _ in range(2):  # the second time with the corners' own deviation
        fit = least_squares(off, start, args=(corner,), x_scale="jac", method="trf", loss="soft_l1")
        start, camera = fit.x, replace(blank, numbers=fit.x)
        wrong = camera.pixels(raised) - pixels
        residual = float(np.sqrt((wrong**2).sum(axis=1).mean()))
        free = max(1, wrong.size - 6)  # the others are measured on their own too
        corner = max(CORNER, float(np.sqrt((wrong**2).sum() / free)))
    jacobian = least_squares(off, fit.x, args=(corner,), max_nfev=1).jac
    covariance = np.linalg.inv(jacobian.T @ jacobian)
    return replace(camera, covariance=covariance, residual=residual)


def camera_above(
    pixels_in_mm: float, height: float, size: tuple[int, int], focal: float | None
) -> Camera:
    """Return a camera that looks straight down, from how large a mm is in its photo.

    Args:
        pixels_in_mm: in the plane of the scale.
        height: of the scale over the sheet on which the strip stands, mm.
        size: of the photo, pixels.
        focal: length by the file, pixels; None where it is not known.

    Returns:
        The camera over the sheet, its origin in the middle of the picture and y upwards in it.
    """
    expected = focal or FOCAL_GUESS / FILM_DIAGONAL * float(np.hypot(*size))
    distance = expected / pixels_in_mm + height
    numbers = np.array([np.pi, 0, 0, 0, 0, distance, 0, 0, 0, 0.0])
    return Camera(numbers, size, expected, np.zeros((10, 10)))


def _pose(places: Array, pixels: Array, camera: Camera) -> Array:
    """Return turn and place (6,) of a camera by the homography from sheet to photo (Zhang 2000)."""
    flat = (pixels - camera.axis) / camera.focal
    middle, spread = places.mean(axis=0), places.std()
    x, y = ((places - middle) / spread).T
    zero, one = np.zeros_like(x), np.ones_like(x)
    u, v = flat.T
    rows = np.concatenate(
        [
            np.column_stack([x, y, one, zero, zero, zero, -u * x, -u * y, -u]),
            np.column_stack([zero, zero, zero, x, y, one, -v * x, -v * y, -v]),
        ]
    )
    first, second, shift = np.linalg.svd(rows)[2][-1].reshape(3, 3).T
    unit = np.sqrt(np.linalg.norm(first) * np.linalg.norm(second)) * np.sign(shift[2])
    first, second, shift = first / unit, second / unit, shift / unit * spread
    frame = np.column_stack([first, second, np.cross(first, second)])
    left, _, right = np.linalg.svd(frame)
    turn = left @ np.diag([1, 1, np.linalg.det(left @ right)]) @ right
    place = shift - turn[:, :2] @ middle
    return np.concatenate([Rotation.from_matrix(turn).as_rotvec(), place])
