"""The plate of a calibration: strips that together tell what a material does, for one bed.

Which strips tell what follows from the singular values of all measurements' sensitivity to the
family's parameters (docs/howto/calibrate.md). Strips with an actuator tell the active strain; both
signs tell it from the print's own curl. What is long sags, which tells weight over stiffness. The
joints' strain comes from a chain of short beams, a third of which is joints. All differ in length,
so that none is taken for another one.
"""

from dataclasses import dataclass
from typing import NamedTuple

from simulearn.calibrate.form import Form, StripRecord
from simulearn.calibrate.parameters import check_base
from simulearn.errors import InputError
from simulearn.fabricate import Job, Printer, prepare
from simulearn.grid import Grid
from simulearn.material import Material, load_material

NOMINAL = 4.0  # mm, thickness for which the lengths stand here; they grow with it
WIDTHS = 2.6  # widths that a beam is long at least
MOST_REPEATS = 9


class Kind(NamedTuple):
    """A kind of strip.

    Attributes:
        name: what it is called.
        letter: of its label on the map, before the number of the repeat.
        beams: lengths from joint to joint where the thickness is 4 mm, mm.
        ratio: of all its actuators.
        words: what it is.
    """

    name: str
    letter: str
    beams: tuple[float, ...]
    ratio: float
    words: str


KINDS = (
    Kind("long", "L", (78.0, 78.0), 0.0, "two long beams without actuators, which sag"),
    Kind("joints", "J", (20.0,) * 5, 0.0, "five short beams without actuators"),
    Kind("bottom", "B", (50.0,), -1.0, "active over its whole length in the bottom half"),
    Kind("plain", "P", (80.0,), 0.0, "without an actuator"),
    Kind("half", "H", (70.0,), 0.5, "active over half its length in the top half"),
    Kind("top", "T", (40.0,), 1.0, "active over its whole length in the top half"),
)


@dataclass(frozen=True, eq=False)
class Plate:
    """A plate that can be printed, and its form.

    Attributes:
        job: the print; `job.grids` lie where they are printed, `job.names` are their labels.
        form: with blanks for what is to be measured.
        length: name of each strip to its length from end face to end face, mm.
    """

    job: Job
    form: Form
    length: dict[str, float]


def label(name: str, repeat: int) -> str:
    """Return what is written on a strip: the letter of its kind and the repeat, from 1."""
    letters = {kind.name: kind.letter for kind in KINDS}
    return f"{letters.get(name, name)}{repeat + 1}"


def records(material: Material, repeats: int) -> dict[str, StripRecord]:
    """Return the strips for a material's section, with blanks for what is measured.

    Args:
        material: the base material.
        repeats: how often each strip is printed.
    """
    section = material.section
    blank = (None,) * repeats
    found = {}
    for kind in KINDS:
        lengths = [length * section.thickness / NOMINAL for length in kind.beams]
        beams = tuple(round(max(length, WIDTHS * section.width), 1) for length in lengths)
        found[kind.name] = StripRecord(
            beams=beams,
            actuators=(kind.ratio,) * len(beams),
            before=blank,
            chord=blank,
            rise=blank,
        )
    return found


def make_plate(printer: Printer, material: str = "pla-hot-water", repeats: int = 3) -> Plate:
    """Return the plate for a printer and a base material.

    Args:
        printer: on what it is printed.
        material: name of the material or path of its file.
        repeats: how often each strip is printed; three or more tell how they scatter.

    Raises:
        InputError: the strips do not fit on the bed, the printer cannot print the material, or no
            other can be fitted to it.
    """
    if not 1 <= repeats <= MOST_REPEATS:
        raise InputError(f"repeats is {repeats}; it is 1 to {MOST_REPEATS}", where="repeats")
    base = load_material(material)
    check_base(base)
    strips = records(base, repeats)
    grids: list[Grid] = []
    labels: list[str] = []
    for name, record in strips.items():
        grids += [record.grid(material)] * repeats
        labels += [label(name, k) for k in range(repeats)]
    try:
        job = prepare(grids, printer, labels, dangling=True)
    except InputError as error:
        if repeats > 1 and "fit" in str(error):
            raise InputError(
                f"{repeats} repeats of the strips do not fit on the bed of {printer.name}; "
                f"try {repeats - 1}",
                "calibration-bed",
                "repeats",
            ) from error
        if "larger than" in str(error):
            longest = max(record.length(base.section.width) for record in strips.values())
            raise InputError(
                f"the longest strip is {longest:g} mm; the bed of {printer.name} is smaller",
                "calibration-bed",
                "printer",
            ) from error
        raise
    form = Form(material=material, printer=printer.name, strips=strips)
    return Plate(job, form, {k: r.length(base.section.width) for k, r in strips.items()})
