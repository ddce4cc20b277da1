"""The fitted material as a file: the base's own text and comments, with numbers put in place.

The base's file is kept line by line, since its comments say where its numbers come from. A line
with a number that was fitted or left undetermined has a comment of its own: value, interval, base.
"""

import re
import tomllib
from collections.abc import Iterator
from datetime import date
from pathlib import Path

from pydantic import ValidationError

from simulearn.calibrate.fit import Estimate, Fit
from simulearn.calibrate.formtext import quoted
from simulearn.errors import InputError
from simulearn.fea import simulate_grid
from simulearn.fea.bar import bar, curvature
from simulearn.files import read_text, replacing
from simulearn.material import Material, read_material
from simulearn.material.family import member_of
from simulearn.material.reading import HERE, is_name

DIGITS = 5
HEADER = re.compile(r"^\s*\[([\w.]+)\]")
KEY = re.compile(r"^(\s*)([A-Za-z_]\w*)(\s*=\s*)([^#]*?)(\s*)(#.*)?$")
# Where each fitted number stands in a material file.
PLACES = {
    "strain": ("shrinkage", "active"),
    "shell": ("shrinkage", "shell"),
    "passive": ("shrinkage", "stress_passive"),
    "joint": ("shrinkage", "stress_joint"),
    "curl": ("shrinkage", "curl"),
    "load": ("law", "scale"),
}
CALIBRATED = ", calibrated"
NEAR = 1e-3  # of a number, which is written with five digits

Values = dict[tuple[str, str], tuple[float | str, str]]  # by section and key, with a comment


def material_text(fit: Fit, name: str, source: str = "", today: date | None = None) -> str:
    """Return a material file of the fitted material.

    Args:
        fit: what was fitted.
        name: of the new material.
        source: the form's file, for the comments.
        today: the date for the comments.

    Raises:
        InputError: the base's file is written in a way that cannot be edited line by line.
    """
    base, new = fit.base, fit.material
    values: Values = {
        ("", "name"): (name, "fitted"),
        ("", "title"): (f"{base.title.removesuffix(CALIBRATED)}{CALIBRATED}", ""),
    }
    for key in ("width", "thickness"):
        if (measured := getattr(fit.form.section, key)) is not None:
            values["section", key] = measured, "by caliper"
    if new.laid is not None:
        for key, value in new.laid.model_dump().items():
            values["laid", key] = value, "as printers lay it, to come out as measured"
    for one in fit.estimates:
        section, key = PLACES[one.name]
        value = getattr(getattr(new, section), key)
        values[section, key] = float(f"{value:.{DIGITS}g}"), _comment(one)
    free = new.model_copy(update={"gravity": new.gravity.model_copy(update={"acceleration": 0.0})})
    trial = simulate_grid(bar(base.calibration.length, 1.0, free), free)
    bends = curvature(trial.solid, trial.displacements[-2])
    values["calibration", "curvature"] = float(f"{bends:.4g}"), "simulated with what was fitted"
    if any(record.repeats > 2 for record in fit.form.strips.values()):
        values["scatter", "beam"] = _scatter(fit)
    lines = _replaced(base_text(fit.form.material).splitlines(), values)
    text = "\n".join([*_head(fit, source, today or date.today()), "", *lines]) + "\n"
    _check(text, new, fit.form.material)
    return text


def write_material(fit: Fit, path: Path, source: str = "") -> Material:
    """Write the fitted material under the name of its file, and return it as it is read there.

    Raises:
        InputError: the file cannot be written.
    """
    text = material_text(fit, path.stem, source)
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return read_material(path)


def base_text(material: str) -> str:
    """Return the text of a material's file by its name or path."""
    return read_text(HERE / f"{material}.toml" if is_name(material) else material)


def _comment(one: Estimate) -> str:
    if one.determined == "not":
        return f"not determined, the base's; {one.low:.3f} to {one.high:.3f} is likely"
    ratio = "the base's" if one.name in ("strain", "load") else "the active strain"
    return (
        f"{one.name} {one.value:.3f} ({one.low:.3f} to {one.high:.3f}) of {ratio}, "
        f"determined {one.determined}"
    )


def _scatter(fit: Fit) -> tuple[float, str]:
    noise = fit.noise
    words = f"from the repeats; {noise.low:.3f} to {noise.high:.3f} is likely"
    return round(noise.scatter, 4), words


def _head(fit: Fit, source: str, today: date) -> Iterator[str]:
    """Yield comments on where the numbers come from."""
    form = fit.form
    used = [one for one in fit.differences if one.key == "chord"]
    yield f"# Fitted by `simulearn calibrate fit`, {today.isoformat()}."
    yield f"# Base: {fit.base.identity}." + (f" Form: {_line(source)}." if source else "")
    if form.printer or form.measured:
        yield f"# Printed on {_line(form.printer) or '?'}; {_line(form.measured) or 'no note'}."
    strips = ", ".join(f"{one.count} {one.strip}" for one in used)
    yield f"# Strips: {strips}. Readings differ by {fit.noise.reading:.2f} mm."
    size, low, high = fit.size
    yield f"# Printed {size:.4f} times as long as designed ({low:.4f} to {high:.4f})."
    yield "# In parentheses: intervals of 90 %. Shapes tell the load (weight over stiffness, with"
    yield "# creep); density, creep and form of the law are the base's."
    for message in fit.messages:
        yield f"# {message.code}: {_line(message.message)}"


def _line(text: str) -> str:
    """Return a text in one line, as a comment needs it."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def _replaced(lines: list[str], values: Values) -> list[str]:
    """Return lines of a TOML file with values by section and key; missing ones are added."""
    left = dict(values)
    section = ""
    kept: list[str] = []
    for line in lines:
        if header := HEADER.match(line):
            kept = _with_added(kept, section, left)
            section = header[1]
        elif (found := KEY.match(line)) and (section, found[2]) in left:
            line = found[1] + _entry(found[2], *left.pop((section, found[2])))
        kept.append(line)
    kept = _with_added(kept, section, left)
    for other in dict.fromkeys([section for section, _ in left]):
        kept = _with_added([*kept, "", f"[{other}]"], other, left)
    return kept


def _with_added(lines: list[str], section: str, left: Values) -> list[str]:
    """Return lines with what is left of a section at their end, before the blank ones."""
    mine = [place for place in left if place[0] == section]
    end = len(lines)
    while end and not lines[end - 1].strip():
        end -= 1
    return [*lines[:end], *(_entry(place[1], *left.pop(place)) for place in mine), *lines[end:]]


def _entry(key: str, value: float | str, words: str) -> str:
    entry = f"{key} = {quoted(value) if isinstance(value, str) else repr(value)}"
    return f"{entry:26} # {words}" if words else entry


def _check(text: str, meant: Material, base: str) -> None:
    """Make sure that a text is the material that was meant."""
    try:
        found = Material.model_validate(tomllib.loads(text))
        pairs = zip(member_of(found), member_of(meant), strict=True)
        if all(abs(a - b) <= NEAR * max(abs(b), 1e-6) for a, b in pairs):
            return
    except (tomllib.TOMLDecodeError, ValidationError):
        pass
    raise InputError(
        f"{base}: cannot be edited line by line; write each section as [shrinkage] with one key a "
        "line, as the materials that come along do",
        "calibration-base",
        base,
    )
