"""Chord and rise of a curled strip from a photo.

The strip lies on its side, so that its arc lies in the plane of the sheet. Its scale comes from the
printed sheet or from two points (`photo_reference`), its outline from its edges (`photo_outline`),
and a curve of one thickness is fitted to that (`photo_strip`). Chord and rise are those that a
straight edge gives, as in the form of a calibration: between the tips of the hollow side, and the
largest gap under it.

The deviations add up what differs by chance: where the camera was (the strip is measured by other
cameras that the markers allow too), the size of the printed sheet, and the edges themselves.
"""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from simulearn.calibrate.photo_camera import Camera
from simulearn.calibrate.photo_file import Photo, read_photo
from simulearn.calibrate.photo_measures import Measures, gap, measures
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
UNSURE = 0.35  # between the direction that is up and that of the hollow side, cosine
OF_SHADOW = 0.5  # mm, deviation of an edge that may be that of a shadow
THICK = 0.12  # relative difference from the section's thickness that is reported
ROUGH = 0.1  # mm, residual of what is no strip: strips have .02 to .05, shadows .15
USED = 0.7  # of the outline that a strip has near its curve, but for its corners
LIKE_SHADOW = 0.4  # of the sheet's light, from where on a grey strip may be a shadow
WAVY = 0.25  # of the rise, on the other side of the chord


@dataclass(frozen=True, eq=False)
class StripPhoto:
    """A strip measured in a photo.

    Attributes:
        photo: what it was measured in.
        section: of the strip.
        measures: chord and rise of its hollow side, with their deviations.
        sign: of the rise: 1 hollow on the side that was up in the printer, -1 on the other one;
            None where that is not known.
        fit: of a curve to its outline.
        outline: its edges.
        reference: what gave the scale.
        messages: what qualifies the answer.
    """

    photo: Photo
    section: Section
    measures: Measures
    sign: float | None
    fit: Fit
    outline: Outline
    reference: Reference
    messages: tuple[Message, ...]

    @property
    def chord(self) -> float:
        """Distance of the tips of the hollow side, mm."""
        return self.measures.chord

    @property
    def rise(self) -> float:
        """Largest gap between that chord and the hollow side, mm; with a sign if it is known."""
        return self.measures.rise * (self.sign or 1.0)

    @property
    def curve(self) -> Curve:
        """The strip on the sheet."""
        return self.fit.curve

    @property
    def camera(self) -> Camera:
        """The camera over the sheet."""
        return self.reference.camera

    def to_dict(self) -> dict[str, Any]:
        """Return the answer for programs: lengths in mm."""
        chord, rise, _ = gap(self.curve.line)
        numbers = {
            "chord": self.chord,
            "rise": self.rise,
            "chord_deviation": self.measures.chord_deviation,
            "rise_deviation": self.measures.rise_deviation,
            "length": self.curve.length,
            "thickness": self.curve.thickness,
            "centre_line_chord": chord,
            "centre_line_rise": rise,
            "residual": self.fit.residual,
            "blur": self.outline.blur,
            "tilt": self.camera.tilt,
            "distance": float(self.camera.place[2]),
        }
        return {
            "photo": self.photo.name,
            "signed": self.sign is not None,
            "markers": self.reference.markers,
            **{key: round(value, 4) for key, value in numbers.items()},
            "messages": [asdict(message) for message in self.messages],
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
    if fit.residual > ROUGH or fit.used.mean() < USED:
        raise InputError(
            "what was found is not as evenly thick as a strip is, or a shadow hides its edge; use "
            "light from all around, and the dark sheet for a white strip",
            "photo-no-strip",
        )
    curve = fit.curve
    sign = _sign(curve, reference, up)
    result = measures(curve, reference, section.width, outline.blur)
    messages = [*reference.messages, *_remarks(curve, result.rise, section, reference)]
    if outline.band.kind == "darker" and outline.lightness > LIKE_SHADOW:
        text = (
            "the strip is hardly darker than a shadow is; see in the picture that it is the strip"
        )
        messages.append(Message("photo-grey", "photo", text))
        result = result.less_sure(OF_SHADOW)
    return StripPhoto(photo, section, result, sign, fit, outline, reference, tuple(messages))


def _sign(curve: Curve, reference: Reference, up: Up | None) -> float | None:
    """Return the sign of the rise; None where it is not known."""
    if up is None:
        return None
    if up in ("inside", "outside"):
        return 1.0 if up == "inside" else -1.0
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
    return float(np.sign(cosine))


def _remarks(
    curve: Curve, rise: float, section: Section, reference: Reference
) -> Iterator[Message]:
    """Yield what else a person should know of a strip."""
    if abs(curve.thickness / section.thickness - 1) > THICK:
        text = (
            f"the strip looks {curve.thickness:.1f} mm thick and not {section.thickness:g}; "
            "see in the picture whether a shadow was taken for it, and whether it lies on its side"
        )
        yield Message("photo-thickness", "photo", text)
    line = curve.line
    chord = line[-1] - line[0]
    off = (line - line[0]) @ np.array([-chord[1], chord[0]]) / np.linalg.norm(chord)
    other = float(min(off.max(), -off.min()))
    if other > WAVY * max(rise, 2.0):
        text = f"the strip bends to both sides, by {other:.1f} mm to the other one"
        yield Message("photo-wavy", "photo", text)
    if reference.markers:
        around = ConvexHull(reference.camera.on_plane(reference.points)).equations
        if (around[:, :2] @ line.T + around[:, 2:] > 0).any():
            text = (
                "the strip lies outside of the markers that can be seen, so that it is measured "
                "less well than said; photograph it with all markers"
            )
            yield Message("photo-outside", "photo", text)
