"""The form as a text that a person fills in, with what to measure and how beside the blanks."""

from collections.abc import Sequence
from pathlib import Path

from simulearn.calibrate.form import MEASURED, Form, StripRecord
from simulearn.calibrate.plate import KINDS, label
from simulearn.files import path_from, replacing
from simulearn.material import load_material
from simulearn.material.reading import is_name

HEAD = """\
# Calibration form. Fill in what stands between the quotes; what stays "" is not used.
# Then: simulearn calibrate fit THIS_FILE -o my-material.toml
#
# All in mm. Each list has one value for every repeat of the strip, in the order of the labels in
# the comment above it. Write the labels on the strips (top side, held end) before you take them
# off the bed: the map shows which is which. Cut off the brim.
#
#   before   before the bath: straight length from end face to end face.
#   In the bath: hold each strip by the end that is black on the map, level, the side up that was
#   up when it was printed, all else free in the water. Let it become solid before you let go.
#   chord    lay the strip on its side on paper, and a straight edge across the two tips of its
#            hollow side: the distance between these tips.
#   rise     the largest gap between the straight edge and the strip. Plus if it is hollow on the
#            side that was up (its ends bend up), minus if it is hollow on the other side.
#
#           <--------- chord --------->
#        tip===========================tip   straight edge
#          \\\\            ^            //
#            \\\\          | rise      //      +  this hollow side was up
#              \\\\_       v       _//        -  this hollow side was down
#                 '--___________--'
#
# More: docs/howto/calibrate.md
"""


def form_text(form: Form) -> str:
    """Return the form as TOML with comments, its values where they are known."""
    section = load_material(form.material).section
    width = form.section.width or section.width
    lines = [
        HEAD,
        f'format = "{form.format}"',
        f"material = {quoted(form.material)}   # the base: what the plate was made with",
        f"printer = {quoted(form.printer)}",
        f"measured = {quoted(form.measured)}   # when, which filament, which bath: a note",
        "",
        "[section]   # of the strips before the bath by caliper, mean of a few places",
        f"width = {_value(form.section.width)}       # printed as {section.width:g}",
        f"thickness = {_value(form.section.thickness)}   # printed as {section.thickness:g}",
    ]
    for name, record in form.strips.items():
        lines += ["", *_strip(name, record, width)]
    return "\n".join(lines) + "\n"


def write_form(form: Form, path: Path) -> None:
    """Write the form, the path of its material as seen from there; nobody reads half of it."""
    text = form_text(form)
    if not is_name(form.material):
        seen = path_from(path.parent, Path(form.material))
        text = text.replace(
            f"\nmaterial = {quoted(form.material)} ", f"\nmaterial = {quoted(seen)} "
        )
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _strip(name: str, record: StripRecord, width: float) -> list[str]:
    labels = ", ".join(label(name, k) for k in range(record.repeats))
    what = next((f", {kind.words}" for kind in KINDS if kind.name == name), "")
    lines = [
        f"[strips.{name}]   # {labels}: {record.length(width):g} mm long{what}",
        f"beams = {_list(record.beams)}   # this and the next line: as printed, leave them",
        f"actuators = {_list(record.actuators)}",
        *(f"{key} = {_list(getattr(record, key))}" for key in MEASURED),
    ]
    if any(record.photo):
        lines.append(f"photo = {_list(record.photo)}")
    return lines


def _list(values: Sequence[float | str | None]) -> str:
    return f"[{', '.join(_value(value) for value in values)}]"


def _value(value: float | str | None) -> str:
    if value is None:
        return '""'
    return quoted(value) if isinstance(value, str) else repr(float(value))


def quoted(text: str) -> str:
    """Return a text as a TOML basic string."""
    escaped = "".join(
        f"\\u{ord(c):04x}" if ord(c) < 32 or ord(c) == 127 else c
        for c in text.replace("\\", "\\\\").replace('"', '\\"')
    )
    return f'"{escaped}"'
