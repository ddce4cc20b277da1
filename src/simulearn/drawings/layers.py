"""Which layers of a drawing are read, and the actuators that their lines stand for."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Literal

from simulearn.drawings.convention import (
    last_name,
    near_colour,
    near_layer,
    ratio_of_colour,
    ratio_of_layer,
)
from simulearn.drawings.drawing import Curve, Drawing, Line
from simulearn.errors import InputError, Message

Choice = Literal["auto", "layers", "colours", "none"]
# Our own drawings hold the beams' axes on layers below this one, beside much else.
OWN = "skeleton"
MOST_NAMED = 8


@dataclass(frozen=True)
class LayerUse:
    """A layer of a drawing, and what became of it.

    Attributes:
        name: full, levels joined by `::`; empty for what is on no layer.
        colour: "#rrggbb" of most of its lines; None where the file says nothing.
        lines: how many lines and curves it has.
        taken: whether they are read.
        ratio: of the actuator that its name stands for; None where it stands for none.
    """

    name: str
    colour: str | None
    lines: int
    taken: bool
    ratio: float | None


def layers_of(drawing: Drawing, patterns: Sequence[str]) -> list[LayerUse]:
    """Return the layers of a drawing in the order in which they occur.

    Args:
        drawing: as its reader returns it.
        patterns: names or patterns with * and ? of those to read, in any case; also several with
            commas between them; none: all, or of our own drawings the beams' axes alone.

    Raises:
        InputError: a pattern fits no layer.
    """
    colours: dict[str, Counter[str | None]] = {}
    things: list[Line | Curve] = [*drawing.lines, *drawing.curves]
    for thing in things:
        colours.setdefault(thing.layer, Counter())[thing.colour] += 1
    patterns = [
        part
        for pattern in patterns
        for part in ([pattern] if any(_fits(n, pattern) for n in colours) else pattern.split(","))
    ]
    for pattern in patterns:
        if not any(_fits(name, pattern) for name in colours):
            names = ", ".join(f'"{name}"' for name in list(colours)[:MOST_NAMED])
            more = ", ..." if len(colours) > MOST_NAMED else ""
            text = f'there is no layer "{pattern.strip()}" with lines; the layers with lines are '
            raise InputError(f"{text}{names or 'none'}{more}", "layers-unknown", pattern)
    own = not patterns and any(_first_name(name) == OWN for name in colours)

    def taken(name: str) -> bool:
        if own:
            return _first_name(name) == OWN
        return not patterns or any(_fits(name, pattern) for pattern in patterns)

    return [
        LayerUse(name, seen.most_common(1)[0][0], seen.total(), taken(name), ratio_of_layer(name))
        for name, seen in colours.items()
    ]


def _fits(name: str, pattern: str) -> bool:
    """Return whether a pattern fits a layer's full name, its last level, or a level above."""
    pattern, name = pattern.casefold().strip(), name.casefold()
    levels = name.split("::")
    above = ("::".join(levels[:k]) for k in range(1, len(levels) + 1))
    return any(fnmatchcase(text, pattern) for text in (*above, last_name(name)))


def _first_name(name: str) -> str:
    return name.split("::")[0].strip().casefold()


def ratios_of(things: Sequence[Line | Curve], choice: Choice) -> tuple[list[float], list[Message]]:
    """Return the ratio of each line's actuator, and what was taken or nearly was.

    Args:
        things: lines and curves that are read.
        choice: what says it; "auto": layers where one's name says so, else colours where not all
            lines have the same.
    """
    count = Counter(thing.layer for thing in things)
    colours = Counter(thing.colour for thing in things)
    by_layer = {name: ratio_of_layer(name) for name in count}
    by_colour = {colour: ratio_of_colour(colour) for colour in colours}
    if choice == "none":
        return [0.0] * len(things), []
    messages = []
    if choice != "colours":
        messages = [
            _near_miss(f'the layer "{name}"', "its last name would be as in top 0.5 or bottom 1")
            for name in count
            if by_layer[name] is None and near_layer(name)
        ]
    if choice == "layers" or (choice == "auto" and any(r is not None for r in by_layer.values())):
        messages += _taken({f'"{name}"': (by_layer[name], count[name]) for name in count}, "layer")
        return [by_layer[thing.layer] or 0.0 for thing in things], messages
    if choice == "auto" and len(colours) == 1:
        return [0.0] * len(things), messages
    messages += [
        _near_miss(f"the colour {colour}", f"{near} is one of those that are read")
        for colour in colours
        if (near := near_colour(colour))
    ]
    taken = {str(colour): (by_colour[colour], colours[colour]) for colour in colours}
    messages += _taken(taken, "colour")
    return [by_colour[thing.colour] or 0.0 for thing in things], messages


def _taken(ratios: dict[str, tuple[float | None, int]], what: str) -> list[Message]:
    """Return what was taken from layers or colours: the ratio of each and its number of lines."""
    parts = [
        f"{name} is {described(ratio)} ({count} {'line' if count == 1 else 'lines'})"
        for name, (ratio, count) in ratios.items()
        if ratio is not None
    ]
    if not any(ratio for ratio, _ in ratios.values()):
        return []
    text = "; ".join(parts[:MOST_NAMED]) + ("; ..." if len(parts) > MOST_NAMED else "")
    return [Message("actuators", what, f"actuators by {what}: {text}")]


def described(ratio: float) -> str:
    """Return a ratio in the words of the convention."""
    return f"{'top' if ratio > 0 else 'bottom'} {abs(ratio):g}" if ratio else "passive"


def _near_miss(what: str, right: str) -> Message:
    text = f"{what} was not read as an actuator; {right}"
    return Message("actuator-near-miss", what, text)
