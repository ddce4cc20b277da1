"""The sheet that a strip is photographed on: where its markers and its frame lie.

Eight square markers stand around a frame, at its corners and at the middles of its sides. Each has
a pattern of its own (ArUco, dictionary DICT_4X4_50 of OpenCV), so that some may be covered. Those
at the middles are nearer to the middle of the photo than those at the corners, which shows a bent
lens. x is to the right, y upwards on the page, z towards the camera, with the origin at the lower
left corner of the lower left marker; the layout is the same on A4 and Letter.
"""

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError

Array = NDArray[np.float64]

PAPERS = {"a4": (210.0, 297.0), "letter": (215.9, 279.4)}  # mm
FIELD = (180.0, 240.0)  # mm, all markers with what lies between them
MARKER = 18.0  # mm, side of a marker
CELLS = 6  # of a side of a marker: four of the pattern, and its black border
INSET = 25.0  # mm, of the frame from the field
FRAME = (INSET, INSET, FIELD[0] - INSET, FIELD[1] - INSET)  # its left, lower, right, upper side
FRAME_SIZE = (FRAME[2] - FRAME[0], FRAME[3] - FRAME[1])  # 130 x 190 mm
UP = (1.0, 0.0)  # where the arrow on the sheet points
MARKERS = 8
DARK = 8  # the number of the first marker of the dark sheet


def marker_corners(number: int) -> Array:
    """Return the corners (4, 2) mm of a marker: upper left first, then clockwise.

    Args:
        number: 0 to 7 from the lower left one on, counter-clockwise; of the dark sheet 8 more.
    """
    left, middle, right = 0.0, (FIELD[0] - MARKER) / 2, FIELD[0] - MARKER
    low, half, high = 0.0, (FIELD[1] - MARKER) / 2, FIELD[1] - MARKER
    around = [
        (left, low),
        (middle, low),
        (right, low),
        (right, half),
        (right, high),
        (middle, high),
        (left, high),
        (left, half),
    ]
    corner = np.array(around[number % MARKERS])
    return corner + MARKER * np.array([[0, 1], [1, 1], [1, 0], [0, 0.0]])


def printed_size(text: str | None) -> tuple[float, float]:
    """Return by how much a printed sheet is larger than meant, across and along.

    Args:
        text: measured size of the frame, as "130.2,190.4" (mm); None if it was not measured.

    Raises:
        InputError: the text is not two lengths near those of the frame.
    """
    if text is None:
        return 1.0, 1.0
    try:
        across, along = (float(part) for part in text.split(","))
    except ValueError as error:
        raise _not_a_size(text) from error
    scales = across / FRAME_SIZE[0], along / FRAME_SIZE[1]
    if not all(0.8 < scale < 1.25 for scale in scales):
        raise _not_a_size(text)
    return scales


def _not_a_size(text: str) -> InputError:
    return InputError(
        f'"{text}" is not the size of the printed frame; it is two numbers in mm with a comma '
        f"between them, across and along, as {FRAME_SIZE[0]:g},{FRAME_SIZE[1]:g}",
        "photo-printed",
        "printed",
    )
