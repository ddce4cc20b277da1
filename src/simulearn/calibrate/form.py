"""The form of a calibration: which strips were printed, and what was measured of them.

A form is a TOML file that a person fills in with a ruler and a caliper, or that `calibrate photo`
fills in. What is left blank is not used. A value may stand in quotes, with a decimal comma, and
with its unit.

How a strip is measured, out of the water and solid again (see docs/howto/calibrate.md):

before: straight length before the bath, from end face to end face, mm.
chord:  it lies on its side. A straight edge is laid across the two tips of its hollow side; the
        chord is the distance between these tips, mm.
rise:   the largest gap between straight edge and strip, mm; + where the strip is hollow on the side
        that was up when it was printed (its ends bend up), - where it is hollow on the other one.
"""

import re
import tomllib
from datetime import date, time
from math import isfinite
from pathlib import Path
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, model_validator

from simulearn.errors import InputError
from simulearn.files import is_there, read_text
from simulearn.grid import Grid
from simulearn.material.faults import reason
from simulearn.material.reading import is_name
from simulearn.units import LENGTHS, length_named

FORMAT: Literal["simulearn-calibration/1"] = "simulearn-calibration/1"
MEASURED = ("before", "chord", "rise")  # what is measured of a strip, mm
UNITS = ("mm", "cm", "m", "in")  # in which a length may be written
READING = re.compile(r"([+-]?(?:\d*\.?\d+|\d+\.))\s*(\D*)")
MINUS = str.maketrans({"−": "-", "–": "-", "—": "-", ",": "."})
# A key with nothing behind it, and a place between commas with nothing in it.
BLANK = re.compile(r"(?m)^(\s*[\w.-]+\s*=)[ \t]*(?=#|$)")
ROW = re.compile(rf"(?m)^(\s*(?:{'|'.join(MEASURED)})\s*=\s*\[)([^\[\]#\n]*)(?=\])")


def number(value: Any) -> Any:
    """Return what a person wrote as a number of mm; None where it is blank.

    Args:
        value: a number, or a text with a decimal point or comma and perhaps a unit.

    Raises:
        ValueError: it is neither; the text is the rest of a sentence.
    """
    if value is None:
        return None
    if isinstance(value, str):
        text = value.strip().translate(MINUS)
        if not text:
            return None
        match = READING.fullmatch(text)
        unit = length_named(match[2] or "mm") if match is not None else None
        if match is not None and unit in UNITS:
            mm = float(match[1]) * LENGTHS[unit]
            return float(f"{mm:.9g}")  # 1.6 in and not 40.640000000000001
    elif isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value):
        return float(value)
    raise ValueError(f'is {value!r}; write a number of mm, or "" where nothing was measured')


def with_blanks(text: str) -> str:
    """Return a form's text with "" wherever a person left nothing at all."""
    return ROW.sub(_row, BLANK.sub(r'\1 ""', text))


def _row(match: re.Match[str]) -> str:
    """Return the head and the values of a row, with "" before and between commas alone."""
    values = re.sub(r"^[ \t]*(?=,)", '""', match[2])
    return match[1] + re.sub(r"(?<=,)[ \t]*(?=,)", ' ""', values)


def _name(value: Any) -> Any:
    return (value.strip() or None) if isinstance(value, str) else value


def _note(value: Any) -> Any:
    return str(value) if isinstance(value, int | float | date | time) else value


_Length = Annotated[Annotated[float, Field(gt=0)] | None, BeforeValidator(number)]
_Height = Annotated[float | None, BeforeValidator(number)]
_File = Annotated[str | None, BeforeValidator(_name)]
_Note = Annotated[str, BeforeValidator(_note)]


class _Data(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class CaliperSection(_Data):
    """Section of the printed beams by caliper, mm; None is the base material's."""

    width: _Length = None
    thickness: _Length = None


class StripRecord(_Data):
    """A kind of strip and what was measured of its R repeats.

    Attributes:
        beams: (B,) lengths of its beams from joint to joint, from the held end, mm.
        actuators: (B,) their ratios, as in a grid.
        before, chord, rise: (R,) mm, None where blank; see the head of this file.
        photo: (R,) files of photographs, None where there is none.
    """

    beams: tuple[Annotated[float, Field(gt=0)], ...] = Field(min_length=1)
    actuators: tuple[Annotated[float, Field(ge=-1, le=1)], ...]
    before: tuple[_Length, ...]
    chord: tuple[_Length, ...]
    rise: tuple[_Height, ...]
    photo: tuple[_File, ...] = ()

    @model_validator(mode="after")
    def _counts_agree(self) -> Self:
        if len(self.beams) != len(self.actuators):
            raise ValueError(f"has {len(self.beams)} beams and {len(self.actuators)} actuators")
        for key in ("before", "rise", *(["photo"] if self.photo else [])):
            count, chords = len(getattr(self, key)), len(self.chord)
            if count != chords:
                commas = 2 * min(count, chords) <= max(count, chords)
                hint = "; decimals have a point, or stand in quotes" if commas else ""
                raise ValueError(
                    f"{key} has {count} values and chord {chords}; each has one for every repeat, "
                    f'"" where it is not measured{hint}'
                )
        return self

    @property
    def repeats(self) -> int:
        """R, how many strips of this kind there are."""
        return len(self.chord)

    def grid(self, material: str = "pla-hot-water", stretch: float = 1.0) -> Grid:
        """Return the strip as a grid along +x whose first joint is held.

        Args:
            material: name of the material or path of its file.
            stretch: factor on all lengths.
        """
        x = np.concatenate([[0.0], np.cumsum(self.beams)]) * stretch
        beams = [[k, k + 1] for k in range(len(self.beams))]
        return Grid(np.stack([x, 0 * x], axis=1), beams, self.actuators, 0, material)

    def length(self, width: float) -> float:
        """Return the printed length from end face to end face, mm; joints are as wide as beams."""
        return sum(self.beams) + width


class Form(_Data):
    """A form.

    Attributes:
        format: of the file.
        material: name or path of the base material, of which the plate was made.
        printer: on what it was printed.
        measured: when, and whatever else is worth a note; goes into the fitted material's comments.
        section: by caliper.
        strips: by their names.
    """

    format: Literal["simulearn-calibration/1"] = FORMAT
    material: str = "pla-hot-water"
    printer: _Note = ""
    measured: _Note = ""
    section: CaliperSection = CaliperSection()
    strips: dict[str, StripRecord] = Field(min_length=1)

    def with_reading(self, strip: str, repeat: int, **values: float | str | None) -> "Form":
        """Return the form with some values of one strip written in.

        Args:
            strip: its name.
            repeat: which of its repeats, from 0.
            values: before, chord, rise (mm) or photo (a file's name).

        Raises:
            InputError: there is no such strip or repeat.
        """
        record = self.strips.get(strip)
        if record is None:
            known = ", ".join(self.strips)
            raise InputError(f'strip "{strip}" is not in the form; it has {known}', where=strip)
        if not 0 <= repeat < record.repeats:
            raise InputError(
                f"strip {strip} has {record.repeats} repeats; {repeat + 1} is none of them",
                where=strip,
            )
        update = {}
        for key, value in values.items():
            row = list(getattr(record, key) or (None,) * record.repeats)
            row[repeat] = value
            update[key] = tuple(row)
        new = record.model_copy(update=update)
        return self.model_copy(update={"strips": self.strips | {strip: new}})


def read_form(path: str | Path) -> Form:
    """Return the form in a TOML file; a path of its material is as seen from there.

    Raises:
        InputError: it cannot be read or is no form; the message names the key and the strip.
    """
    form = parse_form(read_text(path), str(path))
    beside = str(Path(path).parent / form.material)
    moved = is_there(beside) or not is_there(form.material)
    if is_name(form.material) or not moved:
        return form
    return form.model_copy(update={"material": beside})


def parse_form(text: str, path: str = "form") -> Form:
    """Return the form of a text.

    Args:
        text: in TOML; a key with nothing after its "=" is blank.
        path: what messages call it.

    Raises:
        InputError: it is no form; the message names the key and the strip.
    """
    try:
        data = tomllib.loads(with_blanks(text))
    except ValueError as error:  # also of a number of thousands of digits
        raise InputError(
            f"{path}: is not valid TOML: {error}; values of repeats stand between [ and ] with "
            "commas between them, decimals have a point with a digit on both sides",
            "calibration-form",
        ) from error
    except RecursionError as error:
        raise InputError(f"{path}: is nested too deeply", "calibration-form") from error
    if "strips" not in data:
        raise InputError(
            f"{path}: is no form of a calibration, which has [strips.NAME]; `simulearn calibrate "
            "plate` writes one",
            "calibration-form",
            "strips",
        )
    try:
        return Form.model_validate(data)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = _place(first["loc"])
        others = f" (and {error.error_count() - 1} more)" if error.error_count() > 1 else ""
        colon = ":" if first["loc"] and where == _place(first["loc"][:2]) else ""
        text = f"{path}: {where}{colon} {_reason(first)}{others}"
        raise InputError(text, "calibration-form", where) from error


def _reason(error: Any) -> str:
    """Return one of pydantic's errors as the rest of a sentence that begins with its place."""
    if error["type"] == "value_error":
        return str(error["ctx"]["error"])
    words = reason(error)
    if error["type"] == "greater_than" and "chord" in error["loc"]:
        words += "; have chord and rise changed places?"
    return words


def _place(loc: tuple[int | str, ...]) -> str:
    """Return the place of an error: "strip top, chord of repeat 2", or a key."""
    if len(loc) < 2 or loc[0] != "strips":
        return ".".join(str(part) for part in loc) or "form"
    place = f"strip {loc[1]}"
    if len(loc) > 2:
        place += f", {loc[2]}"
    if len(loc) > 3:
        place += f" of repeat {int(loc[3]) + 1}" if loc[2] in MEASURED else f"[{loc[3]}]"
    return place
