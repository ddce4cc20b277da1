"""What is wrong with the readings of a form: impossible values, wrong signs, blanks, outliers.

An impossible value is an error, since what was meant is not known. A rise with the wrong sign on a
strip with an actuator is mended, since no material bends it the other way. An outlier is left out.
All is said.
"""

from collections.abc import Iterator
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from simulearn.calibrate.form import MEASURED, Form, StripRecord
from simulearn.errors import InputError, Message
from simulearn.material import Section
from simulearn.units import in_mm

Numbers = NDArray[np.float64]
TOO_LONG = 1.02  # of the printed length; a strip swells by less
SIZE = 0.05  # by so much of it a strip may be printed longer or shorter
UNITS = in_mm("cm", "in", "m")
OF_SECTION = 0.3  # by so much of it a caliper's value may differ from the base's section
SLACK = 2.0  # mm
SURE = 2.0  # mm, a rise of less may have either sign
OUTLIER = 5.0  # standard deviations of a reading from the median of its repeats
LEAST_SD = 0.3  # mm
# Of three normal numbers the median distance from their median is in the median 0.364 sd.
OF_MIDDLE = 1 / 0.364
SCATTER = 0.1  # of a rise, by which strips may differ


def check_section(form: Form, section: Section) -> None:
    """Make sure that what the caliper says can be of strips that were printed with a section.

    Raises:
        InputError: a value is far from the section's.
    """
    for key in ("width", "thickness"):
        value, meant = getattr(form.section, key), getattr(section, key)
        if value is not None and abs(value / meant - 1) > OF_SECTION:
            where = f"section.{key}"
            low, high = (1 - OF_SECTION) * meant, (1 + OF_SECTION) * meant
            unit = _unit(value, low, high, meant)
            why = f"it seems to be in {unit}" if unit else "is the form of another material?"
            text = f"{where} is {value:g} mm, but the strips were printed {meant:g} mm; {why}"
            raise InputError(text, "calibration-value", where)


def check_values(form: Form, width: float) -> None:
    """Make sure that all readings are possible.

    Args:
        form: the form.
        width: of the strips, mm.

    Raises:
        InputError: some are not; the message names strip and repeat, `messages` has all of them.
    """
    wrong = [
        message for name, record in form.strips.items() for message in _wrong(name, record, width)
    ]
    if wrong:
        more = f" (and {len(wrong) - 1} more)" if len(wrong) > 1 else ""
        raise InputError(wrong[0].message + more, wrong[0].code, wrong[0].where, wrong)


def _wrong(name: str, record: StripRecord, width: float) -> Iterator[Message]:
    length = record.length(width)
    for k in range(record.repeats):
        before, chord, rise = (getattr(record, key)[k] for key in MEASURED)
        if before is not None and abs(before / length - 1) > SIZE:
            yield _impossible(name, k, "before", before, record, length)
        if chord is not None and not length / 8 < chord < TOO_LONG * length + SLACK / 2:
            yield _impossible(name, k, "chord", chord, record, length)
        elif rise is not None:
            most = _highest(length, chord)
            if abs(rise) > most:
                where = f"strip {name}, rise of repeat {k + 1}"
                over = f" over a chord of {chord:g} mm" if chord else ""
                if chord and chord <= _highest(length, abs(rise)):
                    over += "; have chord and rise changed places?"
                yield Message(
                    "calibration-value",
                    where,
                    f"{where} is {rise:g} mm; a strip of {length:g} mm rises at most {most:.1f} mm"
                    f"{over}",
                )


def _highest(length: float, chord: float | None) -> float:
    """Return the largest rise (mm) of a strip over a chord: of all arcs a triangle is highest."""
    return sqrt(max((length * TOO_LONG) ** 2 - (chord or 0.0) ** 2, 0.0)) / 2 + SLACK


def _impossible(
    name: str, repeat: int, key: str, value: float, record: StripRecord, length: float
) -> Message:
    """Return the message for a length that a strip cannot have, with what it may be."""
    where = f"strip {name}, {key} of repeat {repeat + 1}"
    low = (1 - SIZE) * length if key == "before" else length / 3
    high = TOO_LONG * length + SLACK
    others = [v for v in getattr(record, key) if v is not None and low <= v <= high]
    if others:
        why = f"other repeats have {others[0]:g}; is a digit or the decimal point missing?"
    elif unit := _unit(value, low, high, length):
        why = f"it seems to be in {unit}; write {value * UNITS[unit]:.4g} (mm)"
    elif key == "before":
        why = "is the strip another one?"
    else:
        why = "a chord is shorter than its strip"
    text = f"{where} is {value:g} mm, but the strip was printed {length:g} mm long; {why}"
    return Message("calibration-value", where, text)


def _unit(value: float, low: float, high: float, meant: float) -> str:
    """Return the unit in which a value comes nearest to what is meant (mm); "" if none does."""
    fitting = [unit for unit, mm in UNITS.items() if low <= value * mm <= high]
    return min(fitting, key=lambda unit: abs(value * UNITS[unit] - meant), default="")


def signs_mended(form: Form) -> tuple[Form, list[Message]]:
    """Return the form with the rises of strips with actuators given their sign, and warnings."""
    messages = []
    for name, record in form.strips.items():
        ratios = set(np.sign(record.actuators).tolist())
        if len(ratios) != 1 or 0.0 in ratios or min(map(abs, record.actuators)) < 0.4:
            continue
        sign = ratios.pop()
        for k, rise in enumerate(record.rise):
            if rise is not None and rise * sign < 0 and abs(rise) > SURE:
                where = f"strip {name}, rise of repeat {k + 1}"
                side = "top" if sign > 0 else "bottom"
                text = (
                    f"{where} is {rise:g} mm, but what is active in the {side} half is hollow "
                    f"there; it is taken as {-rise:g}"
                )
                messages.append(Message("calibration-sign", where, text))
                form = form.with_reading(name, k, rise=-rise)
    return form, messages


def blanks(form: Form) -> list[Message]:
    """Return a note for each strip with values that are not given."""
    messages = []
    for name, record in form.strips.items():
        missing = {
            key: [k + 1 for k, value in enumerate(getattr(record, key)) if value is None]
            for key in MEASURED
        }
        if all(len(some) == record.repeats for some in missing.values()):
            text = f"strip {name} has no values and is left out"
        elif some := [
            f"{key} (all)" if len(which) == record.repeats else f"{key} of {_listed(which)}"
            for key, which in missing.items()
            if which
        ]:
            text = f"strip {name} has blanks, which are not used: {', '.join(some)}"
        else:
            continue
        messages.append(Message("calibration-blank", f"strip {name}", text))
    return messages


def without_outliers(form: Form) -> tuple[Form, list[Message]]:
    """Return the form without readings that lie far from the other repeats', and warnings.

    Three repeats at least are needed to tell which is wrong. The spread is that of all strips.
    """
    rows = {
        (name, key): np.array([np.nan if v is None else v for v in getattr(record, key)])
        for name, record in form.strips.items()
        for key in MEASURED
    }
    rows = {place: row for place, row in rows.items() if np.isfinite(row).sum() >= 3}
    if not rows:
        return form, []
    away = {place: row - np.nanmedian(row) for place, row in rows.items()}
    # Not moved by the outlier itself, even if it is the only row.
    middles = [float(np.nanmedian(np.abs(row))) for row in away.values()]
    sd = max(LEAST_SD, OF_MIDDLE * float(np.median(middles)))
    messages = []
    for (name, key), row in away.items():
        rise = form.strips[name].rise
        high = (
            np.nanmedian(np.abs([np.nan if v is None else v for v in rise])) if any(rise) else 0.0
        )
        allowed = OUTLIER * sd + (0.0 if key == "before" else SCATTER * high)
        far = np.flatnonzero(np.abs(np.nan_to_num(row)) > allowed).tolist()
        for k in far:
            where = f"strip {name}, {key} of repeat {k + 1}"
            value = rows[name, key][k]
            text = (
                f"{where} is {value:g} mm, {abs(row[k]):.1f} mm from the median of its repeats; it "
                "is left out"
            )
            messages.append(Message("calibration-outlier", where, text))
            form = form.with_reading(name, k, **{key: None})
    return form, messages


def _listed(numbers: list[int]) -> str:
    return ("repeats " if len(numbers) > 1 else "repeat ") + ", ".join(map(str, numbers))
