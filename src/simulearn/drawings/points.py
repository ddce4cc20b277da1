"""Points in parsed JSON: lists of two or three numbers, or objects with x, y and maybe z."""

from math import isfinite
from typing import Any

from simulearn.errors import InputError
from simulearn.grid.arrays import shown

# So many straight pieces are read from one file, far more than a grid can have.
MOST_SEGMENTS = 200_000


def too_many() -> InputError:
    """Return the error of a file with too many lines."""
    text = f"has more than {MOST_SEGMENTS:,} straight pieces; at most so many are read"
    return InputError(text, "too-large", "lines")


class Points:
    """Reads points, and counts the numbers that were written as text."""

    def __init__(self) -> None:
        self.texts = 0

    def remarks(self) -> list[str]:
        """Return messages about what was read."""
        if not self.texts:
            return []
        what = "1 number is" if self.texts == 1 else f"{self.texts} numbers are"
        return [f'{what} written as text, as in "65.0", and read as numbers']

    def point(self, value: Any, where: str) -> tuple[float, float, float]:
        """Return a point in space.

        Args:
            value: what `is_point` says is one.
            where: its place, for messages.

        Raises:
            InputError: a coordinate is no finite number, or one is missing.
        """
        if isinstance(value, dict):
            named = {str(key).casefold(): (key, part) for key, part in value.items()}
            parts = [named[axis] for axis in "xyz" if axis in named]
            wheres = [f"{where}.{key}" for key, _ in parts]
            value = [part for _, part in parts]
        else:
            wheres = [f"{where}[{k}]" for k in range(len(value))]
        x, y, *z = (self._number(part, at) for part, at in zip(value, wheres, strict=True))
        return x, y, z[0] if z else 0.0

    def _number(self, value: Any, where: str) -> float:
        number = value
        if isinstance(value, str):
            try:
                number = float(value)
                self.texts += 1
            except ValueError:
                number = None
        if isinstance(number, bool) or not isinstance(number, (int, float)):
            raise InputError(f"{where} is {shown(value)}; a coordinate is a number", "point", where)
        try:
            number = float(number)
        except OverflowError:
            number = float("inf")
        if not isfinite(number):
            text = f"{where} is {shown(value)}; a coordinate is a finite number"
            raise InputError(text, "point", where)
        return number


def is_scalar(value: Any) -> bool:
    """Return whether a value stands where a number would."""
    return not isinstance(value, (list, dict))


def is_point(value: Any) -> bool:
    """Return whether a value is a point: [x, y], [x, y, z], or an object with x and y."""
    if isinstance(value, list):
        return len(value) in (2, 3) and all(is_scalar(part) for part in value)
    if isinstance(value, dict):
        keys = {str(key).casefold() for key in value}
        return {"x", "y"} <= keys
    return False
