"""Which part of a photo is the strip: the one long even band that is no shadow.

The light is divided by that of the empty sheet around it, which takes uneven light out. What then
differs from the sheet is looked for in three ways: by colour (a shadow on a white sheet is grey, so
it has none), as darker, and as brighter (a shadow never is). Each is cut at several thresholds;
every long part that comes out is judged by how even its width is and how near to the strip's
thickness, and the best one is taken. A threshold that takes a shadow for the strip gives an uneven
band, and one that loses part of the strip does too.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from simulearn.errors import InputError

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Light = NDArray[np.float32]

COARSE = 4.0  # pixels in a mm of the picture in which the strip is looked for
BLOCK = 5.0  # mm, of the blocks whose light makes the empty sheet's
COLOUR = (0.06, 0.1, 0.16, 0.25, 0.4)  # thresholds: part of the light that is colour
DARKER = (0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75)  # part of the sheet's light that is missing
BRIGHTER = (0.1, 0.18, 0.3, 0.45)  # part of the brightest
LONG = 4.5  # times its width that a strip is long
WIDTHS = (0.55, 1.9)  # of the expected thickness; the wall that is seen of a strip adds to it
BORDER = 4  # pixels, nearer to the edge of what is searched a part is cut off by it
UNEVEN = 0.16  # deviation of the width over the width, at most
PART = 1.5  # times the length of the strip, something longer that it is a part of
SECOND = 0.5  # of the length of the strip, another part that is a strip too


@dataclass(frozen=True, eq=False)
class Band:
    """A part of the photo that is long and even.

    Attributes:
        mask: (H, W) its pixels.
        middle: (N, 2) pixels along its middle.
        width: of the band, pixels.
        uneven: relative deviation of its width.
        kind: "colour", "darker" or "brighter".
        edge: whether it reaches the edge of what was searched.
    """

    mask: Mask
    middle: Array
    width: float
    uneven: float
    kind: str
    edge: bool

    @property
    def length(self) -> float:
        """Length along the middle, pixels."""
        return float(np.linalg.norm(np.diff(self.middle, axis=0), axis=1).sum())


def relative_light(light: Light, pixels_in_mm: float, dark: bool) -> Light:
    """Return light over that of the empty sheet: 1 where nothing lies on it.

    Args:
        light: (H, W, 3).
        pixels_in_mm: of the picture.
        dark: whether what lies on the sheet is brighter than it.
    """
    step = max(4, round(BLOCK * pixels_in_mm))
    rows, columns = light.shape[0] // step, light.shape[1] // step
    blocks = light[: rows * step, : columns * step].reshape(rows, step, columns, step, 3)
    blocks = blocks.swapaxes(1, 2).reshape(rows, columns, -1, 3)
    level = np.percentile(blocks, 30 if dark else 70, axis=2).astype(float)
    y, x = (np.indices((rows, columns)) + 0.5) * 2 / np.array([rows, columns])[:, None, None] - 1
    terms = _terms(x.ravel(), y.ravel())
    height, width = light.shape[:2]
    grid_y, grid_x = np.linspace(-1, 1, 40), np.linspace(-1, 1, 40)
    fine_x, fine_y = (one.ravel() for one in np.meshgrid(grid_x, grid_y))
    sheet = np.empty((height, width, 3), np.float32)
    grey = level.mean(axis=2).ravel()
    # What is far from the sheet's light from the first, as a table beside it, pulls no fit.
    kept = grey < 2 * np.percentile(grey, 25) if dark else grey > 0.5 * np.percentile(grey, 75)
    for _ in range(6):  # blocks with a strip, a shadow or writing in them are left out
        fitted = terms @ np.linalg.lstsq(terms[kept], grey[kept], rcond=None)[0]
        off = (grey - fitted) / np.maximum(fitted, 1e-4)
        spread = max(1.5 * float(np.median(np.abs(off[kept]))), 0.01)
        kept = np.abs(off) < 3 * spread
    for k in range(3):
        numbers = np.linalg.lstsq(terms[kept], level[..., k].ravel()[kept], rcond=None)[0]
        small = (_terms(fine_x, fine_y) @ numbers).reshape(40, 40)
        sheet[..., k] = _enlarged(small, height, width)
    even: Light = (light / np.maximum(sheet, 2e-3)).astype(np.float32)
    return even


def _terms(x: Array, y: Array) -> Array:
    one = np.ones_like(x)
    return np.stack([one, x, y, x * x, x * y, y * y, x**3, x * x * y, x * y * y, y**3], axis=1)


def _enlarged(small: Array, height: int, width: int) -> Light:
    import cv2

    # The corners of the small grid are those of the picture.
    x = np.tile(np.linspace(0, small.shape[1] - 1, width, dtype=np.float32), (height, 1))
    y = np.tile(np.linspace(0, small.shape[0] - 1, height, dtype=np.float32)[:, None], (1, width))
    return np.asarray(cv2.remap(small.astype(np.float32), x, y, cv2.INTER_LINEAR))


def find_strip(
    light: Light,
    pixels_in_mm: float,
    thickness: float,
    dark: bool | None,
    beyond: Mask,
    apart: Mask | None = None,
) -> Band:
    """Return the strip in a picture of the sheet.

    Args:
        light: (H, W, 3) relative to the empty sheet.
        pixels_in_mm: of the picture, about COARSE.
        thickness: of the strip, mm.
        dark: whether the sheet is dark; None where that is not known.
        beyond: (H, W) where the photo does not reach.
        apart: (H, W) a part that touches one of these is none.

    Raises:
        InputError: there is no strip, or there are several, or it reaches the edge; the text
            does not name the photo.
    """
    import cv2

    light = np.where(beyond[..., None], np.float32(1), light)
    light = np.asarray(cv2.medianBlur(np.ascontiguousarray(light), 3), np.float32)
    width = thickness * pixels_in_mm
    bands = [
        band
        for kind, mask in _candidates(light, dark)
        for band in _bands(mask, kind, width, beyond, apart)
    ]
    even = [band for band in bands if band.uneven < UNEVEN]
    if not even:
        raise _nothing(bands, dark)
    cut = [band for band in bands if band.edge]
    inner = [
        band
        for band in even
        if not band.edge and not any((band.mask & other.mask).any() for other in cut)
    ]
    if not inner:
        raise InputError(
            "the strip reaches the edge of where it is looked for; lay it in the middle of the "
            "frame, and photograph all of it",
            "photo-edge",
        )
    best = min(inner, key=lambda band: _badness(band, width))
    _alone(best, inner)
    _whole(best, bands)
    return best


def _candidates(light: Light, dark: bool | None) -> Iterator[tuple[str, Mask]]:
    """Yield masks of what differs from the sheet, each with the kind of its difference."""
    mean = light.mean(axis=2)
    if not dark:  # on a dark sheet a little colour of its dark print is much of its light
        colour = light.max(axis=2) - light.min(axis=2)
        part = colour / np.maximum(light.max(axis=2), 0.1)
        yield from (("colour", part > level) for level in COLOUR)
        yield from (("darker", mean < 1 - level) for level in DARKER)
    if dark is not False:
        above = light.max(axis=2) - 1
        most = float(np.percentile(above, 99.5))
        if most > 0.5:
            yield from (("brighter", above > level * most) for level in BRIGHTER)


def _bands(mask: Mask, kind: str, width: float, beyond: Mask, apart: Mask | None) -> Iterator[Band]:
    """Yield the long parts of a mask whose width may be a strip's."""
    import cv2

    across = max(3, round(0.45 * width) | 1)  # lines of a pen are thinner, and vanish
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (across, across))
    filled = cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_CLOSE, np.ones((3, 3), np.uint8))
    opened = cv2.morphologyEx(filled, cv2.MORPH_OPEN, disc)
    count, labels, stats, _ = cv2.connectedComponentsWithStats(opened, connectivity=4)
    for k in range(1, count):
        left, top, wide, high, area = (int(value) for value in stats[k])
        if area < LONG * (WIDTHS[0] * width) ** 2 or area > 0.4 * mask.size:
            continue
        one = labels == k
        if apart is not None and (one & apart).any():
            continue
        one = ndimage.binary_fill_holes(one)
        right, bottom = mask.shape[1] - left - wide, mask.shape[0] - top - high
        edge = min(left, top, right, bottom) < BORDER
        edge = edge or bool((ndimage.binary_dilation(one, iterations=BORDER) & beyond).any())
        band = _measured(one, kind, edge)
        if band is None or not WIDTHS[0] * width < band.width < WIDTHS[1] * width:
            continue
        if band.length > LONG * band.width:
            yield band


def _measured(mask: Mask, kind: str, edge: bool) -> Band | None:
    """Return a part with its middle and widths, from the distances along it from one end."""
    rows, columns = np.nonzero(mask)
    top, left = rows.min(), columns.min()
    part = np.pad(mask[top : rows.max() + 1, left : columns.max() + 1], 1)
    first = _along(part, None)
    start = np.unravel_index(np.argmax(first), part.shape)
    along = _along(part, (int(start[0]), int(start[1])))
    longest = float(along.max())
    breadth = part.sum() / max(longest, 1.0)
    pieces = int(longest / max(0.5 * breadth, 2.0))
    if pieces < 8:
        return None
    number = np.minimum((along / longest * pieces).astype(int), pieces - 1)
    here = part.nonzero()
    labels = number[here]
    count = np.bincount(labels, minlength=pieces)
    if (count == 0).any():
        return None
    middle = np.stack(
        [np.bincount(labels, weights=axis, minlength=pieces) / count for axis in here[::-1]], axis=1
    )
    inner = slice(2, -2)  # at the ends the pieces are cut askew
    step = np.linalg.norm(np.gradient(middle, axis=0), axis=1)
    widths = count[inner] / np.maximum(step[inner], 1e-9)
    width = float(np.median(widths))
    return Band(
        mask, np.add(middle, [left - 1, top - 1]), width, float(widths.std() / width), kind, edge
    )


def _along(part: Mask, start: tuple[int, int] | None) -> Array:
    """Return how far each pixel is from a start within the part; 0 outside of it.

    Steps go to the eight neighbours and like a knight, which is within 3 % of the distance.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import dijkstra

    number = np.full(part.shape, -1)
    number[part] = np.arange(part.sum())
    lists = []
    for dy, dx in ((0, 1), (1, 0), (1, 1), (1, -1), (1, 2), (2, 1), (1, -2), (2, -1)):
        a = number[: part.shape[0] - dy, max(0, -dx) : part.shape[1] - max(0, dx)]
        b = number[dy:, max(0, dx) : part.shape[1] - max(0, -dx)]
        both = (a >= 0) & (b >= 0)
        lists.append((a[both], b[both], np.full(both.sum(), np.hypot(dy, dx))))
    a, b, weight = (np.concatenate(one) for one in zip(*lists, strict=True))
    graph = coo_matrix((weight, (a, b)), shape=(part.sum(),) * 2).tocsr()
    begin = 0 if start is None else int(number[start])
    distance = dijkstra(graph, directed=False, indices=begin)
    along = np.zeros(part.shape)
    along[part] = np.where(np.isfinite(distance), distance, 0)
    return along


def _badness(band: Band, width: float) -> float:
    # A wall that is seen makes a strip up to a third wider than its thickness.
    return band.uneven + 0.1 * abs(np.log(band.width / (1.12 * width)))


def _alone(best: Band, bands: list[Band]) -> None:
    """Raise InputError if there is another strip than the best band, of about its length."""
    others = [
        band
        for band in bands
        if band.kind == best.kind and not (band.mask & best.mask).any()
        if band.length > SECOND * best.length
    ]
    if others:
        raise InputError(
            "there are several strips in the photo; photograph one at a time, and take rulers and "
            "other long things away",
            "photo-strips",
        )


def _whole(best: Band, bands: list[Band]) -> None:
    """Raise InputError if the best band is a part of a much longer one, cut by its threshold."""
    if any(
        band.kind == best.kind
        and band.length > PART * best.length
        and (band.mask & best.mask).sum() > best.mask.sum() / 2
        for band in bands
    ):
        raise InputError(
            "what looks like a strip is a part of something longer that is not evenly wide; "
            "photograph one strip at a time, which touches nothing, in light from all around",
            "photo-strips",
        )


def _nothing(bands: list[Band], dark: bool | None) -> InputError:
    """Return the error that says why there is no strip."""
    if bands:
        text = (
            "what is in the photo is not evenly wide as a strip is, so that shadows cannot be told "
            "from it; use light from all around, as near a window without sun"
        )
    else:
        text = "no strip can be seen in the photo"
    if dark:
        text += "; on the dark sheet only light strips can be seen, all others on the white one"
    else:
        text += "; a white strip cannot be seen on white paper, print the dark sheet for it"
    return InputError(text, "photo-no-strip")
