"""Readings of photos written into the form of a calibration, in its own text.

Only the values change; comments, blanks and all else that a person wrote stay as they are. What
cannot be changed in this way is left alone, and the message says what to write by hand.
"""

import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from simulearn.calibrate.form import number, with_blanks
from simulearn.errors import InputError
from simulearn.files import read_text, replacing
from simulearn.material import Section

VALUE = re.compile(r'"[^"\n]*"|\'[^\'\n]*\'|[^,\s\[\]]+')


class FormText:
    """A form as text.

    Args:
        path: of the file.
        strip: name of a strip in it.
        repeat: which of its repeats, from 1.

    Raises:
        InputError: the file is no form, or there is no such strip or repeat.
    """

    def __init__(self, path: Path, strip: str, repeat: int) -> None:
        self.path, self.strip, self.repeat = path, strip, repeat
        self.text = read_text(path)
        self.data = _parsed(self.text, path)
        strips = self.data.get("strips")
        if not isinstance(strips, dict) or not strips:
            raise InputError(f"{path}: is no form of a calibration; it has no strips", "photo-form")
        if strip not in strips:
            known = ", ".join(strips)
            raise InputError(
                f'{path}: there is no strip "{strip}" in the form; it has {known}', "photo-form"
            )
        self.record = strips[strip]
        count = len(self.record.get("chord") or [])
        if not 1 <= repeat <= count:
            raise InputError(
                f"{path}: strip {strip} has {count} repeats; {repeat} is none of them", "photo-form"
            )

    @property
    def expected_sign(self) -> float | None:
        """Sign of the rise by the strip's actuators; None where they do not tell it."""
        ratios = [float(ratio) for ratio in self.record.get("actuators", [])]
        if any(ratio > 0 for ratio in ratios) and min(ratios) >= 0:
            return 1.0
        if any(ratio < 0 for ratio in ratios) and max(ratios) <= 0:
            return -1.0
        return None

    def section(self, section: Section) -> Section:
        """Return a section with what the form has of it by caliper."""
        measured = self.data.get("section") or {}
        values = {key: _number(measured.get(key)) for key in ("width", "thickness")}
        return section.model_copy(update={key: value for key, value in values.items() if value})

    def write(self, values: Mapping[str, float]) -> None:
        """Write values of the strip, such as chord and rise, mm.

        Raises:
            InputError: the text cannot be changed, or the file cannot be written.
        """
        text = self.text
        for key, value in values.items():
            text = self._changed(text, key, f"{value:.2f}")
        after = _parsed(text, self.path)
        for key, value in values.items():
            row = list(self.record[key])
            row[self.repeat - 1] = round(value, 2)
            self.record[key] = row
        if after != self.data:
            raise self._by_hand(values)
        with replacing(self.path) as temporary:
            temporary.write_text(text, encoding="utf-8")

    def _changed(self, text: str, key: str, value: str) -> str:
        """Return the text with one value of one key of the strip changed."""
        name = re.escape(self.strip)
        head = re.search(rf"(?m)^[ \t]*\[\s*strips\s*\.\s*[\"']?{name}[\"']?\s*\]", text)
        if head is None:
            raise self._by_hand({key: float(value)})
        after = re.search(r"(?m)^[ \t]*\[[^\[\]\n=]+\][ \t]*(#.*)?$", text[head.end() :])
        end = head.end() + after.start() if after else len(text)
        row = re.search(rf"(?m)^[ \t]*{key}\s*=\s*\[([^\]#]*)\]", text[head.end() : end])
        if row is None:
            raise self._by_hand({key: float(value)})
        begin = head.end() + row.start(1)
        cells = list(VALUE.finditer(row[1]))
        if len(cells) < self.repeat:
            raise self._by_hand({key: float(value)})
        cell = cells[self.repeat - 1]
        return text[: begin + cell.start()] + value + text[begin + cell.end() :]

    def _by_hand(self, values: Mapping[str, float]) -> InputError:
        values_text = " and ".join(f"{key} {value:.2f}" for key, value in values.items())
        return InputError(
            f"{self.path}: the values of strip {self.strip} cannot be written into this text, as "
            f"it has another layout; write {values_text} as number {self.repeat} by hand",
            "photo-form",
        )


def _parsed(text: str, path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(with_blanks(text))
    except ValueError as error:
        raise InputError(f"{path}: is not valid TOML: {error}", "photo-form") from error


def _number(value: object) -> float | None:
    """Return a length (mm) that a person wrote; None where it is blank or is none."""
    try:
        return number("" if value is None else value) or None
    except ValueError:
        return None
