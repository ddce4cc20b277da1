"""Chord and rise of a strip's hollow side: how long, how surely, and where in the photo."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from simulearn.calibrate.photo_reference import Reference
from simulearn.calibrate.photo_strip import Curve

Array = NDArray[np.float64]

EDGE = 0.25  # pixels, deviation of an edge that all its points share
OF_BLUR = 0.1  # of the blur, likewise


@dataclass(frozen=True, eq=False)
class Measures:
    """What a straight edge on the hollow side gives.

    Attributes:
        chord: between the tips, mm.
        rise: largest gap, mm, without a sign.
        chord_deviation, rise_deviation: standard deviations, mm.
        chord_pixels: (2, 2) the tips in the photo.
        rise_pixels: (2, 2) from the chord to the strip where the gap is largest.
    """

    chord: float
    rise: float
    chord_deviation: float
    rise_deviation: float
    chord_pixels: Array
    rise_pixels: Array

    def less_sure(self, deviation: float) -> "Measures":
        """Return the same with one more standard deviation, mm, of both."""
        return replace(
            self,
            chord_deviation=float(np.hypot(self.chord_deviation, deviation)),
            rise_deviation=float(np.hypot(self.rise_deviation, deviation)),
        )


def gap(line: Array) -> tuple[float, float, int]:
    """Return the distance of a line's ends, its largest distance from that chord, and where."""
    chord = line[-1] - line[0]
    length = float(np.linalg.norm(chord))
    off = np.abs((line - line[0]) @ np.array([-chord[1], chord[0]])) / length
    highest = int(np.argmax(off))
    return length, float(off[highest]), highest


def measures(curve: Curve, reference: Reference, width: float, blur: float) -> Measures:
    """Return chord and rise of a strip.

    Args:
        curve: the strip.
        reference: its cameras.
        width: by which it stands up from the sheet, mm.
        blur: of its edges, mm.
    """
    camera = reference.camera
    line = curve.beside(curve.hollow * curve.thickness / 2)
    chord, rise, highest = gap(line)
    points = np.array([line[0], line[-1], line[highest]])
    along = np.stack([np.cos(curve.angle), np.sin(curve.angle)], axis=1)
    inward = curve.hollow * np.stack([-along[:, 1], along[:, 0]], axis=1)[highest]
    normals = np.array([-along[0], along[-1], inward])
    away = ((points - camera.place[:2]) * normals).sum(axis=1)
    heights = np.where(away > 0, width, 0.0)
    seen = camera.pixels(np.column_stack([points, heights]))
    others = np.array(
        [
            factor * np.array(_of(other.on_plane(seen, heights)))
            for other, factor in reference.others
        ]
    )
    values = np.array([chord, rise])
    by_camera = np.sqrt(((others - _of(points)) ** 2).mean(axis=0))
    by_size = reference.size_deviation * values
    # An edge at each end, shared by many points, so that their number does not help.
    by_edge = np.sqrt(2) * np.hypot(EDGE / camera.scale_at(points.mean(axis=0)), OF_BLUR * blur)
    total = np.sqrt(by_camera**2 + by_size**2 + by_edge**2)
    part = (points[2] - points[0]) @ (points[1] - points[0]) / chord**2
    foot = points[0] + part * (points[1] - points[0])
    foot_pixels = camera.pixels([*foot, heights[0] + part * (heights[1] - heights[0])])
    return Measures(
        chord, rise, float(total[0]), float(total[1]), seen[:2], np.array([foot_pixels, seen[2]])
    )


def _of(points: Array) -> tuple[float, float]:
    """Return chord and rise of two tips and the highest point (3, 2)."""
    return gap(points[[0, 2, 1]])[:2]


def outline_pixels(curve: Curve, reference: Reference, width: float) -> Array:
    """Return the outline (N, 2) of a strip as it is seen in the photo, pixels."""
    camera, outline = reference.camera, curve.outline
    step = np.roll(outline, -1, axis=0) - np.roll(outline, 1, axis=0)
    normals = np.stack([step[:, 1], -step[:, 0]], axis=1)
    top = ((outline - camera.place[:2]) * normals).sum(axis=1) > 0
    return camera.pixels(np.column_stack([outline, np.where(top, width, 0.0)]))
