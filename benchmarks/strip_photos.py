"""Photos of curled strips on the sheet, drawn by a camera model of their own, with known answers.

A strip is a prism: its outline stands on the sheet and is as high as the strip is wide. Light comes
from lamps of a certain size, so that shadows are sharp where the strip touches the sheet and soft
further away, and from all around. What a telephone does to the light follows: blur, noise, the tone
curve of sRGB, JPEG. Nothing here is shared with `simulearn.calibrate` but the page itself.
"""

from dataclasses import dataclass, field, replace
from functools import lru_cache
from io import BytesIO
from pathlib import Path

import cv2
import numpy as np
import shapely
from numpy.typing import NDArray
from PIL import Image
from scipy import sparse

from simulearn.show.photo_sheet import photo_sheet

Array = NDArray[np.float64]

DOTS = 8  # of the page in a mm
PAGE = (210.0, 297.0)
CORNER = (-15.0, -28.5)  # of the page, from the origin of its markers, mm
FILM = 43.27  # mm, diagonal on 35 mm film
COLOURS = {  # amounts of light that PLA sends back: red, green, blue
    "red": (0.55, 0.03, 0.03),
    "blue": (0.03, 0.10, 0.42),
    "green": (0.05, 0.33, 0.08),
    "orange": (0.75, 0.22, 0.02),
    "yellow": (0.80, 0.60, 0.04),
    "black": (0.025, 0.025, 0.028),
    "grey": (0.20, 0.20, 0.21),
    "silver": (0.36, 0.36, 0.37),
    "natural": (0.66, 0.61, 0.48),
    "white": (0.80, 0.80, 0.78),
}


@dataclass(frozen=True)
class Strip:
    """A strip as it lies on its side.

    Attributes:
        pieces: lengths (mm) and curvatures (1/mm, + to the left) of its centre line.
        place: of the middle of its box on the sheet, mm.
        heading: of its first end, degrees.
        thickness, width: mm; the width stands up from the sheet.
    """

    pieces: tuple[tuple[float, float], ...] = ((7.2, 0.0), (50.0, 0.034), (7.2, 0.0))
    place: tuple[float, float] = (90.0, 120.0)
    heading: float = 0.0
    thickness: float = 4.0
    width: float = 7.2

    def line(self, aside: float = 0.0, step: float = 0.02) -> Array:
        """Return the points (N, 2) of a line that keeps `aside` to the left of the middle, mm."""
        rates = np.concatenate(
            [np.full(max(1, round(length / step)), bend) for length, bend in self.pieces]
        )
        steps = np.concatenate(
            [np.full(k := max(1, round(length / step)), length / k) for length, _ in self.pieces]
        )
        angle = np.radians(self.heading) + np.concatenate([[0.0], np.cumsum(rates * steps)])
        middle = (angle[1:] + angle[:-1]) / 2
        move = steps[:, None] * np.stack([np.cos(middle), np.sin(middle)], axis=1)
        points = np.concatenate([[[0.0, 0.0]], np.cumsum(move, axis=0)])
        box = (points.max(axis=0) + points.min(axis=0)) / 2
        left = np.stack([-np.sin(angle), np.cos(angle)], axis=1)
        return points - box + np.array(self.place) + aside * left

    def outline(self) -> Array:
        """Return the outline (N, 2) of its side face, mm, counter-clockwise."""
        half = self.thickness / 2
        right, left = self.line(-half, 0.25), self.line(half, 0.25)
        ends = _between(right[-1], left[-1]), _between(left[0], right[0])
        return np.concatenate([right, ends[0], left[::-1], ends[1]])

    def measures(self) -> tuple[float, float]:
        """Return chord and rise of its hollow side, mm; the rise without a sign."""
        turned = sum(length * bend for length, bend in self.pieces)
        return measures(self.line(np.sign(turned) * self.thickness / 2))


def measures(line: Array) -> tuple[float, float]:
    """Return the distance of a line's ends and its largest distance from that chord."""
    chord = line[-1] - line[0]
    length = float(np.linalg.norm(chord))
    off = (line - line[0]) @ np.array([-chord[1], chord[0]]) / length
    return length, float(np.abs(off).max())


def _between(start: Array, end: Array) -> Array:
    return start + np.linspace(0, 1, 18)[1:-1, None] * (end - start)


@dataclass(frozen=True)
class Lens:
    """Where the camera is and how it looks.

    Attributes:
        distance: from the point looked at, mm.
        tilt: from straight down, degrees; towards the side `azimuth`, degrees.
        roll: about its axis, degrees.
        at: the point looked at, mm.
        film: focal length on 35 mm film.
        size: pixels.
        bend: of the lens.
        off: of the axis from the middle of the picture, in diagonals.
    """

    distance: float = 380.0
    tilt: float = 8.0
    azimuth: float = 30.0
    roll: float = 90.0
    at: tuple[float, float] = (90.0, 120.0)
    film: float = 26.0
    size: tuple[int, int] = (2000, 1500)
    bend: float = 0.0
    off: tuple[float, float] = (0.0, 0.0)

    @property
    def focal(self) -> float:
        """Focal length, pixels."""
        return self.film / FILM * float(np.hypot(*self.size))

    def axes(self) -> tuple[Array, Array]:
        """Return the camera's axes (right, down, forward) as rows, and its place, mm."""
        tilt, azimuth, roll = np.radians([self.tilt, self.azimuth, self.roll])
        up = np.array(
            [np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)]
        )
        place = np.array([*self.at, 0.0]) + self.distance * up
        right = np.cross(-up, [np.sin(roll), np.cos(roll), 0.0])
        right /= np.linalg.norm(right)
        return np.stack([right, np.cross(-up, right), -up]), place

    def seen(self, points: Array) -> Array:
        """Return the pixels (N, 2) of points (N, 3)."""
        axes, place = self.axes()
        x = (points - place) @ axes.T
        flat = x[:, :2] / x[:, 2:]
        flat = flat * (1 + self.bend * np.sum(flat**2, axis=1, keepdims=True))
        return self.focal * flat + self._middle

    @property
    def _middle(self) -> Array:
        size = np.array(self.size)
        return (size - 1) / 2 + np.array(self.off) * np.hypot(*size)

    def ground(self, finer: int) -> NDArray[np.float32]:
        """Return the places (H, W, 2) on the sheet of all pixels of a picture so much finer."""
        width, height = self.size
        across, down = np.arange(0, width + STRIDE, STRIDE), np.arange(0, height + STRIDE, STRIDE)
        coarse = self._ground(np.stack(np.meshgrid(across, down), axis=-1).astype(float))
        rows, columns = _between_rows(height, finer), _between_rows(width, finer)
        return np.stack(
            [(rows @ (columns @ coarse[..., k].T).T).astype(np.float32) for k in (0, 1)], axis=-1
        )

    def _ground(self, pixels: Array) -> Array:
        bent = (pixels - self._middle) / self.focal
        flat = bent
        for _ in range(8):
            flat = bent / (1 + self.bend * np.sum(flat**2, axis=-1, keepdims=True))
        axes, place = self.axes()
        ray = flat[..., :1] * axes[0] + flat[..., 1:] * axes[1] + axes[2]
        return place[:2] - place[2] / ray[..., 2:] * ray[..., :2]


STRIDE = 8  # pixels between those whose places are computed; the others lie between them


def _between_rows(count: int, finer: int) -> sparse.csr_matrix:
    """Return the matrix that interpolates finer pixels between each STRIDE-th."""
    at = ((np.arange(count * finer) + 0.5) / finer - 0.5) / STRIDE
    low = np.floor(at).astype(int).clip(0)
    part = at - low
    rows = np.arange(len(at))
    shape = len(at), len(range(0, count + STRIDE, STRIDE))
    ends = [sparse.csr_matrix((w, (rows, low + k)), shape) for k, w in ((0, 1 - part), (1, part))]
    return ends[0] + ends[1]


@dataclass(frozen=True)
class Lamp:
    """A lamp: height over the horizon and azimuth, degrees; half its angle; its share of light."""

    height: float = 55.0
    azimuth: float = 120.0
    half_angle: float = 4.0
    share: float = 0.5

    def directions(self, count: int = 12) -> Array:
        """Return directions (N, 3) towards its parts."""
        k = np.arange(count)
        spread = np.radians(self.half_angle) * np.sqrt((k + 0.5) / count)
        turn = k * 2.39996
        height = np.radians(self.height) + spread * np.sin(turn)
        azimuth = np.radians(self.azimuth) + spread * np.cos(turn) / np.cos(height)
        x, y = np.cos(height) * np.cos(azimuth), np.cos(height) * np.sin(azimuth)
        return np.stack([x, y, np.sin(height)], axis=1)


@dataclass(frozen=True)
class Scene:
    """All that a photo depends on.

    Attributes:
        strips: of which all have one colour.
        lens: the camera.
        colour: key of COLOURS.
        lamps: beside the light from all around.
        uneven: by how much the light differs from one side to the other, relative.
        exposure: of the white page.
        blur: deviation, pixels.
        noise: deviation of the light at full exposure.
        note: whether something is written beside the strip.
        dark: whether it is the dark sheet.
        sheet: whether there is a sheet; a plain white table otherwise, with a ruler of 100 mm.
        cover: numbers of markers that are covered.
        seed: of the noise.
    """

    strips: tuple[Strip, ...] = (Strip(),)
    lens: Lens = field(default_factory=Lens)
    colour: str = "red"
    lamps: tuple[Lamp, ...] = (Lamp(),)
    uneven: float = 0.2
    exposure: float = 0.7
    blur: float = 0.7
    noise: float = 0.01
    note: bool = False
    dark: bool = False
    sheet: bool = True
    cover: tuple[int, ...] = ()
    seed: int = 0


RULER = ((40.0, 60.0), (140.0, 60.0))  # the ends of the plain photo's scale, mm


def photograph(scene: Scene, finer: int = 2) -> NDArray[np.uint8]:
    """Return the photo (H, W, 3) of a scene.

    Args:
        scene: what is photographed.
        finer: how many samples in a row make a pixel.
    """
    random = np.random.default_rng(scene.seed)
    lens = scene.lens
    ground = lens.ground(finer)
    page = _page(scene, random).astype(np.float32)
    page = page * _sheet_light(scene)[..., None]
    at = ((ground - CORNER) * DOTS).astype(np.float32)
    rows = page.shape[0] - at[..., 1]
    light = cv2.remap(
        page,
        at[..., 0] - 0.5,
        rows - 0.5,
        cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_CONSTANT,
        borderValue=(0.30, 0.22, 0.15),
    )
    for strip in scene.strips:
        _draw(light, strip, scene, finer)
    x, y = np.linspace(-1, 1, light.shape[1]), np.linspace(-1, 1, light.shape[0])[:, None]
    turn = random.uniform(0, 2 * np.pi)
    uneven = 1 + scene.uneven * (np.cos(turn) * x + np.sin(turn) * y) / 2 - 0.08 * (x**2 + y**2)
    light *= (scene.exposure * uneven).astype(np.float32)[..., None]
    light = cv2.resize(light, lens.size, interpolation=cv2.INTER_AREA)
    light = cv2.GaussianBlur(light, (0, 0), scene.blur)
    grain = scene.noise * np.sqrt(np.maximum(light, 0.02))
    light = np.clip(light + grain * random.standard_normal(light.shape, np.float32), 0, 1)
    curve = np.where(light < 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return np.rint(255 * np.clip(curve, 0, 1)).astype(np.uint8)


def save(scene: Scene, path: Path, quality: int = 88, exif: bool = True) -> Path:
    """Write the photo of a scene as JPEG, with the focal length that a telephone writes."""
    image = Image.fromarray(photograph(scene))
    tags = image.getexif()
    if exif:
        tags.get_ifd(0x8769)[0xA405] = round(scene.lens.film)
    content = BytesIO()
    image.save(content, "JPEG", quality=quality, exif=tags)
    path.write_bytes(content.getvalue())
    return path


@lru_cache(maxsize=2)
def _printed(dark: bool) -> NDArray[np.float32]:
    figure = photo_sheet("a4", dark)
    content = BytesIO()
    figure.savefig(content, format="png", dpi=25.4 * DOTS)
    size = round(PAGE[0] * DOTS), round(PAGE[1] * DOTS)
    drawn = np.asarray(Image.open(content).convert("RGB").resize(size)) / 255
    return (0.03 + 0.82 * drawn**2.2).astype(np.float32)


def _page(scene: Scene, random: np.random.Generator) -> NDArray[np.float32]:
    if scene.sheet:
        page = _printed(scene.dark).copy()
    else:
        size = round(PAGE[1] * DOTS), round(PAGE[0] * DOTS), 3
        page = np.full(size, 0.85, np.float32)
        for k in range(101):
            start = np.add(RULER[0], [k, 0])
            long = 8 if k % 10 == 0 else 4
            ends = [_dots(page, start), _dots(page, start - [0, long])]
            cv2.line(page, *ends, (0.05, 0.05, 0.05), 2)
    for number in scene.cover:
        around = [(0, 0), (81, 0), (162, 0), (162, 111), (162, 222), (81, 222), (0, 222), (0, 111)]
        low = np.array(around[number], float)
        corners = _dots(page, low - 3), _dots(page, low + 21)
        cv2.rectangle(page, corners[0], corners[1], (0.5, 0.4, 0.3), -1)
    if scene.note:
        x, y = random.uniform(32, 60), random.uniform(190, 200)
        written = np.zeros(page.shape[:2], np.uint8)
        font = cv2.FONT_HERSHEY_SCRIPT_SIMPLEX
        for text, height in (("strip 3, 2 Nov", y), ("80 C", 40)):
            cv2.putText(written, text, _dots(page, (x, height)), font, 2.2, 255, 5, cv2.LINE_AA)
        cover = written[..., None] / np.float32(255)
        page = page * (1 - cover) + cover * np.array([0.03, 0.05, 0.25], np.float32)
    return page


def _dots(page: NDArray[np.float32], point: object) -> tuple[int, int]:
    x, y = (np.asarray(point, float) - CORNER) * DOTS
    return round(x), round(page.shape[0] - y)


def _sheet_light(scene: Scene) -> NDArray[np.float32]:
    """Return the light on the page; 1 where all lamps are seen."""
    size = round(PAGE[1] * DOTS), round(PAGE[0] * DOTS)
    total = np.full(size, 1 - sum(lamp.share for lamp in scene.lamps), np.float32)
    for lamp in scene.lamps:
        directions = lamp.directions()
        seen = np.zeros(size, np.float32)
        for direction in directions:
            hidden = np.zeros(size, np.uint8)
            for strip in scene.strips:
                # cv2.fillPoly makes it half a dot larger.
                inner = shapely.Polygon(strip.outline()).buffer(-0.5 / DOTS)
                outline = np.array(inner.exterior.coords)
                for part in np.linspace(0, 1, 14):
                    moved = outline - direction[:2] / direction[2] * strip.width * part
                    _fill(hidden, (moved - CORNER) * [DOTS, -DOTS] + [0, size[0]], 1)
            seen += 1.0 - hidden
        total += lamp.share * seen / len(directions)
    return total


def _draw(light: NDArray[np.float32], strip: Strip, scene: Scene, finer: int) -> None:
    """Draw the walls of a strip and then its upper face, which hides none of them from above."""
    outline = strip.outline()
    colour = np.array(COLOURS[scene.colour])
    around = 1 - sum(lamp.share for lamp in scene.lamps)
    low, high = (
        scene.lens.seen(np.column_stack([outline, np.full(len(outline), z)])) + 0.5
        for z in (0.0, strip.width)
    )
    both = np.concatenate([low, high])
    corner = np.maximum(np.floor(both.min(axis=0)).astype(int) - 1, 0)
    end = np.minimum(np.ceil(both.max(axis=0)).astype(int) + 1, scene.lens.size)
    if (end <= corner).any():
        return
    wide, tall = end - corner
    drawn = np.zeros((tall * FINEST, wide * FINEST, 4), np.float32)
    low, high = ((one - corner) * FINEST - 0.5 for one in (low, high))
    for k in range(len(outline)):
        j = (k + 1) % len(outline)
        along = outline[j] - outline[k]
        if not np.hypot(*along):
            continue
        normal = np.array([along[1], -along[0]]) / np.hypot(*along)
        shade = 0.6 * around
        for lamp in scene.lamps:
            middle = lamp.directions().mean(axis=0)
            shade += lamp.share * max(0.0, normal @ middle[:2]) / middle[2]
        wall = np.array([low[k], low[j], high[j], high[k]])
        _fill(drawn, wall, (*(colour * min(shade, 1.3)), 1.0))
    _fill(drawn, high, (*colour, 1.0))
    drawn = cv2.resize(drawn, (wide * finer, tall * finer), interpolation=cv2.INTER_AREA)
    here = light[corner[1] * finer : end[1] * finer, corner[0] * finer : end[0] * finer]
    here *= 1 - drawn[..., 3:]
    here += drawn[..., :3]


FINEST = 8  # samples of a strip in a pixel, in a row: cv2.fillPoly makes it half of one larger


def _fill(picture: NDArray[np.generic], points: Array, value: object) -> None:
    # cv2 counts a picture's pixels from their middles, in 1/16 here.
    cv2.fillPoly(picture, [np.rint(points * 16).astype(np.int32)], value, cv2.LINE_8, 4)


def random_scene(seed: int, **changes: object) -> Scene:
    """Return a scene as people make them: any strip, camera, light and colour.

    Args:
        seed: of the choice.
        changes: fields of the scene that are given.
    """
    random = np.random.default_rng([41, seed])
    net = random.uniform(25, 70)
    bend = random.choice([-1, 1]) * random.uniform(0.004, min(0.045, 2.6 / net))
    joint = 7.2
    pieces = ((joint, 0.0), (net / 2, bend * random.uniform(0.9, 1.1)), (net / 2, bend), (joint, 0))
    place = random.uniform([80, 105], [100, 135])
    strip = Strip(pieces, tuple(place), random.uniform(0, 360), random.uniform(3.7, 4.3), 7.2)
    lens = Lens(
        distance=random.uniform(300, 600),
        tilt=random.uniform(0, 20),
        azimuth=random.uniform(0, 360),
        roll=random.choice([0, 90, 180, 270]) + random.uniform(-15, 15),
        at=tuple(random.uniform([80, 110], [100, 130])),
        film=random.uniform(24, 28),
        size=(2400, 1800),
        bend=random.normal(0, 0.01),
        off=tuple(random.normal(0, 0.004, 2)),
    )
    colours = [name for name in COLOURS if name != "white"]
    lamps = tuple(
        Lamp(
            random.uniform(40, 75),
            random.uniform(0, 360),
            random.uniform(2, 12),
            random.uniform(0.15, 0.4),
        )
        for _ in range(random.integers(1, 3))
    )
    scene = Scene(
        (strip,),
        lens,
        str(random.choice(colours)),
        lamps,
        random.uniform(0, 0.5),
        random.uniform(0.45, 0.85),
        random.uniform(0.5, 1.2),
        random.uniform(0.004, 0.02),
        bool(random.integers(0, 2)),
        seed=seed,
    )
    return replace(scene, **changes)
