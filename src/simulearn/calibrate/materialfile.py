"""The fitted material as a file: the base's own text and comments, with numbers put in place.

The base's file is kept line by line, since its comments say where its numbers come from. A line with
a number that was fitted or not told has its own comment: value, interval, base.
"""

import re
from collections.abc import Iterator
from datetime import date
from pathlib import Path

from simulearn.calibrate.fit import Estimate, Fit
from simulearn.errors import InputError
from simulearn.fea import simulate_grid
from simulearn.fea.bar import bar, curvature
from simulearn.files import read_text, replacing
from simulearn.material import Material, read_material
from simulearn.material.material import HERE, is_name

DIGITS = 5
HEADER = re.compile(r"^\s*\[([\w.]+)\]")
KEY = re.compile(r"^(\s*)([A-Za-z_]\w*)(\s*=\s*)([^#]*?)(\s*)(#.*)?$")
# Where each fitted number stands in a material file, and what the number there is over the fitted one.
PLACES = {
    "strain": ("shrinkage", "active"),
    "shell": ("shrinkage", "shell"),
    "passive": ("shrinkage", "stress_passive"),
    "joint": ("shrinkage", "stress_joint"),
    "curl": ("shrinkage", "curl"),
    "load": ("law", "scale"),
}


def material_text(fit: Fit, name: str, source: str = "", today: date | None = None) -> str:
    """Return a material file of the fitted material.

    Args:
        fit: what was fitted.
        name: of the new material.
        source: the form's file, for the comments.
        today: the date for the comments.
    """
    base, new = fit.base, fit.material
    text = base_text(fit.form.material)
    values: dict[tuple[str, str], tuple[float, str]] = {}
    for key in ("width", "thickness"):
        if (measured := getattr(fit.form.section, key)) is not None:
            values["section", key] = measured, "by caliper"
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
    lines = list(_replaced(text.splitlines(), values))
    lines = [_named(line, name, f"{base.title}, calibrated") for line in lines]
    return "\n".join([*_head(fit, source, today or date.today()), "", *lines]) + "\n"


def write_material(fit: Fit, path: Path, source: str = "") -> None:
    """Write the fitted material under the name of its file.

    Raises:
        InputError: the file cannot be written.
    """
    text = material_text(fit, path.stem, source)
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
        read_material(temporary)  # what cannot be read again is not written


def base_text(material: str) -> str:
    """Return the text of a material's file by its name or path."""
    return read_text(HERE / f"{material}.toml" if is_name(material) else material)


def _comment(one: Estimate) -> str:
    if one.told == "not":
        return f"not told by the strips, the base's; {one.low:.3f} to {one.high:.3f} is likely"
    ratio = "the base's" if one.name in ("strain", "load") else "the active strain"
    return f"{one.name} {one.value:.3f} ({one.low:.3f} to {one.high:.3f}) of {ratio}, told {one.told}"


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
    yield f"# Printed {size:.4f} times as long as designed ({low:.4f} to {high:.4f}); in no number."
    yield "# In parentheses: intervals of 90 %. The load (weight over stiffness, with creep) is told by"
    yield "# shapes; density, creep and form of the law are the base's."
    for message in fit.messages:
        yield f"# {message.code}: {_line(message.message)}"


def _line(text: str) -> str:
    """Return a text in one line, as a comment needs it."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def _replaced(
    lines: list[str], values: dict[tuple[str, str], tuple[float, str]]
) -> Iterator[str]:
    """Yield lines of a TOML file with values by section and key; missing ones are added."""
    left = dict(values)
    section, kept = "", []
    for line in lines:
        if header := HEADER.match(line):
            kept += _added(section, left)
            section = header[1]
        elif (found := KEY.match(line)) and (section, found[2]) in left:
            value, words = left.pop((section, found[2]))
            line = f"{found[1]}{found[2]}{found[3]}{value!r}   # {words}"
        kept.append(line)
    kept += _added(section, left)
    for other in dict.fromkeys(section for section, _ in left):
        kept += ["", f"[{other}]", *_added(other, left)]
    yield from kept


def _added(section: str, left: dict[tuple[str, str], tuple[float, str]]) -> list[str]:
    """Return lines for what a section does not have yet, and take it from what is left."""
    mine = [place for place in left if place[0] == section]
    return [f"{key} = {value!r}   # {words}" for _, key in mine for value, words in [left.pop((section, key))]]


def _named(line: str, name: str, title: str) -> str:
    found = KEY.match(line)
    if found and found[2] in ("name", "title") and not found[1]:
        text = name if found[2] == "name" else title
        return f'{found[2]} = "{text}"'
    return line
