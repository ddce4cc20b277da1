"""Chord and rise of a curled strip from a photo.

The strip lies on its side, so that its arc lies in the plane of the sheet. Its scale comes from the
printed sheet or from two points (`photo_reference`), its outline from its edges (`photo_outline`),
and a curve of one thickness is fitted to that (`photo_strip`). Chord and rise are those that a
straight edge gives, as in the form of a calibration: between the tips of the hollow side, and the
largest gap under it.

The deviations add up what differs by chance: where the camera was (the strip is measured by other
cameras that the markers allow too), the size of the printed sheet, and the edges themselves.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from simulearn.calibrate.photo_camera import Camera
from simulearn.calibrate.photo_file import Photo, read_photo
from simulearn.calibrate.photo_outline import Outline, find_outline
from simulearn.calibrate.photo_reference import Reference, scale_reference, sheet_reference
from simulearn.calibrate.photo_sheet import UP, printed_size
from simulearn.calibrate.photo_strip import Curve, Fit, fit_curve
from simulearn.errors import InputError, Message
from simulearn.extras import require
from simulearn.material import Section

Array = NDArray[np.float64]

Up = Literal["inside", "outside", "arrow", "left", "right", "top", "bottom"]
UPS: tuple[str, ...] = get_args(Up)
IN_PICTURE = {"left": (-1, 0), "right": (1, 0), "top": (0, -1), "bottom": (0, 1)}
EDGE = 0.2  # pixels, deviation of an edge that all its points share
UNSURE = 0.35  # between the direction that is up and that of the hollow side, cosine
THICK = 0.12  # relative difference from the section's thickness that is told
ROUGH = 0.25  # mm, residual of what is no strip
WAVY = 0.25  # of the rise, on the other side of the chord


@dataclass(frozen=True, eq=False)
class StripPhoto:
    """A strip measured in a photo.

    Attributes:
        name: of the photo.
        chord: between the tips of the hollow side, mm.
        rise: largest gap between that chord and the hollow side, mm; with a sign if `signed`.
        signed: whether the rise has a sign: + hollow on the side that was up in the printer.
        chord_deviation, rise_deviation: standard deviations, mm.
        length: along the centre line, mm.
        thickness: mm.
        curve: the strip on the sheet.
        outline: its measured outline.
        fit: of the curve to it.
        reference: what gave the scale.
        messages: what qualifies the answer.
    """

    name: str
    chord: float
    rise: float
    signed: bool
    chord_deviation: float
    rise_deviation: float
    length: float
    thickness: float
    curve: Curve
    outline: Outline
    fit: Fit
    reference: Reference
    messages: tuple[Message, ...]

    @property
    def camera(self) -> Camera:
        """The camera over the sheet."""
        return self.reference.camera

    @property
    def height(self) -> Array:
        """(2,) heights over the sheet at which sides and ends are seen, 0 or 1 of the width."""
        return np.array([0.0, 1.0])

    def to_dict(self) -> dict[str, Any]:
        """Return the answer for programs: lengths in mm."""
        middle = _gap(self.curve.line)
        return {
            "photo": self.name,
            "chord": round(self.chord, 3),
            "rise": round(self.rise, 3),
            "signed": self.signed,
            "chord_deviation": round(self.chord_deviation, 3),
            "rise_deviation": round(self.rise_deviation, 3),
            "centre_line": {
                "chord": round(middle[0], 3),
                "rise": round(middle[1], 3),
                "length": round(self.length, 3),
            },
            "thickness": round(self.thickness, 3),
            "residual": round(self.fit.residual, 4),
            "blur": round(self.outline.blur, 4),
            "markers": self.reference.markers,
            "tilt": round(self.camera.tilt, 2),
            "distance": round(float(self.camera.place[2]), 1),
            "messages": [vars(message) for message in self.messages],
        }


def measure_photo(
    path: Path | str,
    section: Section,
    *,
    scale: str | None = None,
    scale_height: float = 0.0,
    printed: str | None = None,
    up: Up | None = None,
) -> StripPhoto:
    """Return what a photo shows of a strip.

    Args:
        path: of a photo, JPEG or PNG.
        section: of the strip: thickness, and the width by which it stands up from the sheet, mm.
        scale: two points of the photo and their distance, as "812,1204,2410,1188=100" (pixels, mm);
            None if the strip lies on the printed sheet.
        scale_height: of these points over the sheet, mm.
        printed: measured size of the printed frame, as "130.2,190.4" (mm); None if not measured.
        up: where the side is that was up in the printer: "inside" of the curve or "outside",
            where the sheet's "arrow" points, or "left", "right", "top" or "bottom" in the photo;
            None gives the rise no sign.

    Raises:
        InputError: OpenCV is not installed, there is no such photo, or the strip cannot be measured
            in it; the message says why.
    """
    require("photos need", "cv2")
    if up is not None and up not in UPS:
        raise InputError(f'"{up}" is not where up is; it is one of {", ".join(UPS)}', "photo-up")
    photo = read_photo(path)
    try:
        return _measured(photo, section, scale, scale_height, printed, up)
    except InputError as error:
        text = str(error)
        if error.code == "photo-scale" or text.startswith(photo.name):
            raise
        raise InputError(f"{photo.name}: {text}", error.code, photo.name) from error


def _measured(
    photo: Photo,
    section: Section,
    scale: str | None,
    scale_height: float,
    printed: str | None,
    up: Up | None,
) -> StripPhoto:
    if scale is None:
        reference = sheet_reference(photo, printed_size(printed) if printed else None)
    else:
        reference = scale_reference(photo, scale, scale_height)
    outline = find_outline(photo, reference, section.thickness, section.width)
    fit = fit_curve(outline.points, outline.middle, section.thickness)
    if fit.residual > ROUGH or fit.used.mean() < 0.5:
        raise InputError(
            "what was found is not as evenly thick as a strip is, or a shadow hides its edge; use "
            "light from all around, and lay nothing on the strip",
            "photo-no-strip",
        )
    curve = fit.curve
    chord, rise = _gap(_hollow_line(curve))
    sign, signed = _sign(curve, reference, up)
    chord_deviation, rise_deviation = _deviations(curve, reference, outline, section.width)
    messages = (*reference.messages, *_remarks(fit, rise, section, outline, reference))
    return StripPhoto(
        photo.name,
        chord,
        sign * rise,
        signed,
        chord_deviation,
        rise_deviation,
        curve.length,
        curve.thickness,
        curve,
        outline,
        fit,
        reference,
        messages,
    )


def _hollow_line(curve: Curve) -> Array:
    """Return the hollow side (N, 2) of a strip, on which a straight edge lies."""
    return curve.beside(curve.hollow * curve.thickness / 2)


def _gap(line: Array) -> tuple[float, float]:
    """Return the distance of the ends of a line, and its largest distance from that chord."""
    chord = line[-1] - line[0]
    length = float(np.linalg.norm(chord))
    off = (line - line[0]) @ np.array([-chord[1], chord[0]]) / length
    return length, float(np.abs(off).max())


def _sign(curve: Curve, reference: Reference, up: Up | None) -> tuple[float, bool]:
    """Return the sign of the rise, and whether it is known."""
    if up is None:
        return 1.0, False
    if up in ("inside", "outside"):
        return (1.0 if up == "inside" else -1.0), True
    start, end = curve.line[0], curve.line[-1]
    across = np.array([start[1] - end[1], end[0] - start[0]]) / np.linalg.norm(end - start)
    if up == "arrow":
        if not reference.markers:
            raise InputError(
                "there is an arrow on the printed sheet only; say inside or outside", "photo-up"
            )
        direction = np.array(UP)
    else:
        at = reference.camera.pixels([*curve.line.mean(axis=0), 0.0])
        there = reference.camera.on_plane([at, at + 20 * np.array(IN_PICTURE[up])])
        direction = there[1] - there[0]
        direction /= np.linalg.norm(direction)
    cosine = float(curve.hollow * across @ direction)
    if abs(cosine) < UNSURE:
        raise InputError(
            f"the strip lies along the direction ({up}) that is said to be up, so that it does not "
            "tell its sides apart; say inside or outside of the curve",
            "photo-up",
        )
    return float(np.sign(cosine)), True


def _deviations(
    curve: Curve, reference: Reference, outline: Outline, width: float
) -> tuple[float, float]:
    """Return the standard deviations of chord and rise, mm."""
    camera = reference.camera
    line = _hollow_line(curve)
    tips = line[[0, -1]]
    apex = line[_highest(line)]
    keys = np.array([tips[0], tips[1], apex])
    foot = camera.place[:2]
    ahead = curve.angle[[0, -1]]
    outward = np.stack([np.cos(ahead), np.sin(ahead)], axis=1) * [[-1], [1]]
    bulge = -(tips.mean(axis=0) - apex)
    bulge = -bulge if bulge @ (tips.mean(axis=0) - apex) > 0 else bulge
    inward = tips.mean(axis=0) - apex  # the normal of the hollow side at its highest point
    normals = np.array([*outward, inward])
    heights = np.where(((keys - foot) * normals).sum(axis=1) > 0, width, 0.0)
    seen = camera.pixels(np.column_stack([keys, heights]))
    values = np.array([_triangle(keys)])
    others = np.array(
        [_triangle(factor * other.on_plane(seen, heights)) for other, factor in reference.others]
    )
    by_camera = np.sqrt(((others - values) ** 2).mean(axis=0))
    by_size = reference.size_deviation * np.abs(values[0])
    # Two edges shared by many points, beside the chance of each point.
    pixel = 1 / camera.scale_at(keys.mean(axis=0))
    by_edge = np.sqrt(2) * EDGE * pixel + outline.blur / 50
    total = np.sqrt(by_camera**2 + by_size**2 + by_edge**2)
    return float(total[0]), float(total[1])


def _highest(line: Array) -> int:
    chord = line[-1] - line[0]
    return int(np.argmax(np.abs((line - line[0]) @ np.array([-chord[1], chord[0]]))))


def _triangle(keys: Array) -> Array:
    """Return chord and rise of two tips and the highest point (3, 2)."""
    chord = keys[1] - keys[0]
    length = float(np.linalg.norm(chord))
    return np.array([length, abs((keys[2] - keys[0]) @ np.array([-chord[1], chord[0]])) / length])


def _remarks(
    fit: Fit, rise: float, section: Section, outline: Outline, reference: Reference
) -> list[Message]:
    curve = fit.curve
    messages = []
    ratio = curve.thickness / section.thickness
    if abs(ratio - 1) > THICK:
        text = (
            f"the strip looks {curve.thickness:.1f} mm thick and not {section.thickness:g}; "
            "see in the picture whether a shadow was taken for it, and whether it lies on its side"
        )
        messages.append(Message("photo-thickness", "photo", text))
    line = curve.line
    chord = line[-1] - line[0]
    off = (line - line[0]) @ np.array([-chord[1], chord[0]]) / np.linalg.norm(chord)
    other = min(off.max(), -off.min())
    if other > WAVY * max(rise, 1.0):
        text = f"the strip bends to both sides, by {other:.1f} mm to the other one"
        messages.append(Message("photo-wavy", "photo", text))
    return messages
