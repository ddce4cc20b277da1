"""The unit of a drawing: what a person says, else what the file says, where it makes sense."""

from dataclasses import dataclass

from simulearn.drawings.drawing import Drawing, Unit
from simulearn.drawings.units import UnitError, guessed, odd, unit_named
from simulearn.errors import InputError, Message


@dataclass(frozen=True)
class Size:
    """The size of a drawing in units of its file.

    Attributes:
        width: along x.
        height: along y.
        beam: length of the middle beam.
    """

    width: float
    height: float
    beam: float


def given_unit(drawing: Drawing, unit: str | None, width: float | None, size: Size) -> Unit | None:
    """Return the unit that a person or the file says; None where nobody does.

    Args:
        drawing: as its reader returns it.
        unit: name of a unit, if a person says so.
        width: mm that the drawing is wide, if a person says so; goes before the unit.
        size: of the drawing.

    Raises:
        InputError: the unit has no such name, or the drawing has no width.
    """
    if width is not None:
        if not 0 < width < float("inf"):
            raise InputError(f"the width is {width:g} mm; it is more than 0", "width", "width")
        if size.width <= 1e-9 * size.height:
            raise InputError("the drawing has no width; its unit can be given", "width", "width")
        return Unit(width / size.width, "unit", f"the width of {width:g} mm that is asked for")
    if unit is not None:
        return unit_named(unit, "as asked for")
    if drawing.plain and drawing.unit is None:
        return Unit(1.0, "mm", f"{drawing.format} has no units")
    return drawing.unit


def likely(drawing: Drawing, size: Size) -> Unit | None:
    """Return the unit that a drawing is likely in: its reader's guess where that makes sense."""
    if drawing.guess and not odd(drawing.guess.mm * size.beam):
        return drawing.guess
    return guessed(size.beam)


def unit_error(drawing: Drawing, size: Size) -> UnitError:
    """Return the error of a drawing whose unit is unknown, or whose size is odd in its unit."""
    guess = likely(drawing, size)
    if drawing.unit is None:
        what = "the file does not say its unit"
    else:
        mm = drawing.unit.mm
        what = (
            f"{drawing.unit.source}, but in {drawing.unit.name} the middle beam would be "
            f"{mm * size.beam:.3g} mm long; beams are 20 to 100 mm long"
        )
    measure = f"it is {size.width:.4g} x {size.height:.4g} units wide and high"
    text = f"{what}; {measure}; {_as_guessed(guess, size)}"
    return UnitError(text, guess, (size.width, size.height))


def size_warning(size: Size, guess: Unit | None) -> Message:
    """Return the warning about plain numbers, taken as mm, that make an odd size."""
    text = (
        f"the middle beam is {size.beam:.3g} mm long, which is odd, as numbers without a unit are "
        f"taken as mm; {_as_guessed(guess, size)}"
    )
    return Message("size-odd", "unit", text)


def _as_guessed(guess: Unit | None, size: Size) -> str:
    if guess is None:
        return "no unit makes sense of it: say how wide it is"
    width, height = guess.mm * size.width, guess.mm * size.height
    return (
        f'the likely unit is "{guess.name}", with which it is {width:.4g} x {height:.4g} mm '
        f"({guess.source})"
    )
