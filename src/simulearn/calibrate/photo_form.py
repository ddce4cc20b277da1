"""Readings of photos written into the form of a calibration, in its own text.

Only the values change; comments, blanks and all else that a person wrote stay as they are. What
cannot be changed in this way is left alone, and the message says what to write by hand.
"""

import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from simulearn.calibrate.checks import check_section
from simulearn.calibrate.form import read_form, with_blanks
from simulearn.errors import InputError
from simulearn.files import read_text, replacing
from simulearn.material import Section, load_material

SHORTEST, LONGEST = 0.75, 1.05  # of its printed length, along the middle of a strip after the bath
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
        self.form = read_form(path)  # says what is wrong with any of its values
        self.record = strips[strip]
        count = len(self.record.get("chord") or [])
        if not 1 <= repeat <= count:
            raise InputError(
                f"{path}: strip {strip} has {count} repeats; {repeat} is none of them", "photo-form"
            )

    @property
    def expected_sign(self) -> float | None:
        """Sign of the rise by the strip's actuators; None where they do not tell it."""
        ratios = self.form.strips[self.strip].actuators
        if any(ratio > 0 for ratio in ratios) and min(ratios) >= 0:
            return 1.0
        if any(ratio < 0 for ratio in ratios) and max(ratios) <= 0:
            return -1.0
        return None

    def section(self, material: str | None) -> Section:
        """Return the section of the strips: the caliper's, else that of a material.

        Args:
            material: name or path; None takes the form's own.
        """
        section = load_material(material or self.form.material).section
        check_section(self.form, section)
        values = self.form.section.model_dump(exclude_none=True)
        return section.model_copy(update=values)

    def check_length(self, length: float, width: float) -> None:
        """Make sure that a strip in a photo may be the one of the form.

        Args:
            length: along its middle, mm.
            width: of the strips, mm.

        Raises:
            InputError: it is much longer or shorter than that one was printed.
        """
        printed = self.form.strips[self.strip].length(width)
        if not SHORTEST * printed <= length <= LONGEST * printed:
            raise InputError(
                f"the strip in the photo is {length:.1f} mm long, and strip {self.strip} was "
                f"printed {printed:g} mm long; {self.path} stays as it is: name the strip that it "
                "is, or see in the picture whether its ends are right",
                "photo-form",
                f"strip {self.strip}",
            )

    def write(self, values: Mapping[str, float]) -> None:
        """Write values of the strip, such as chord and rise, mm.

        Raises:
            InputError: the text cannot be changed, or the file cannot be written.
        """
        text = self.text
        for key, value in values.items():
            changed = self._changed(text, key, f"{value:.2f}")
            if changed is None:
                raise self._by_hand(values)
            text = changed
        after = _parsed(text, self.path)
        for key, value in values.items():
            row = list(self.record[key])
            row[self.repeat - 1] = round(value, 2)
            self.record[key] = row
        if after != self.data:
            raise self._by_hand(values)
        with replacing(self.path) as temporary:
            temporary.write_text(text, encoding="utf-8")

    def _changed(self, text: str, key: str, value: str) -> str | None:
        """Return the text with one value of one key of the strip changed; None if it cannot be."""
        name = re.escape(self.strip)
        head = re.search(rf"(?m)^[ \t]*\[\s*strips\s*\.\s*[\"']?{name}[\"']?\s*\]", text)
        if head is None:
            return None
        after = re.search(r"(?m)^[ \t]*\[[^\[\]\n=]+\][ \t]*(#.*)?$", text[head.end() :])
        end = head.end() + after.start() if after else len(text)
        row = re.search(rf"(?m)^[ \t]*{key}\s*=\s*\[([^\]#]*)\]", text[head.end() : end])
        if row is None:
            return None
        begin = head.end() + row.start(1)
        cells = list(VALUE.finditer(row[1]))
        if len(cells) < self.repeat:
            return None
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
