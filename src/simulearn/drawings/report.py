"""What was done to a drawing and what was left out of it, in plain sentences."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.drawings.drawing import Curve, Drawing
from simulearn.errors import Message

# For each mend what is said of one and of several.
SENTENCES = {
    "plane": (
        "1 line lies in another plane than x and y and is seen in its own",
        "{} lines lie in another plane than x and y and are seen in their own",
    ),
    "flattened": ("1 curve became straight pieces", "{} curves became straight pieces"),
    "crumb": (
        "1 crumb shorter than the tolerance was left out",
        "{} crumbs shorter than the tolerance were left out",
    ),
    "double": (
        "1 line drawn over another one was left out",
        "{} lines drawn over other ones were left out",
    ),
    "overlap": (
        "1 line overlaps another one and was joined to it",
        "{} lines overlap other ones and were joined to them",
    ),
    "gap": (
        "a gap was closed at 1 joint",
        "gaps were closed at {} joints",
    ),
    "overshoot": (
        "lines that ran past 1 joint were cut there",
        "lines that ran past {} joints were cut there",
    ),
    "t-touch": (
        "1 line was split where another one ends on it",
        "lines were split at {} places where another one ends on them",
    ),
    "crossing": (
        "a joint was made at 1 crossing",
        "joints were made at {} crossings",
    ),
    "stub": (
        "1 stub past a joint was removed",
        "{} stubs past joints were removed",
    ),
    "leaf": (
        "1 dangling beam, which closes no loop, was removed",
        "{} dangling beams, which close no loop, were removed",
    ),
    "straight": (
        "1 needless point in a straight beam was left out",
        "{} needless points in straight beams were left out",
    ),
}


@dataclass(frozen=True)
class Mend:
    """Something done to a drawing so that it becomes a grid.

    Attributes:
        code: one of `mending.MENDS`.
        count: how often.
        message: a sentence.
        places: (x, y) mm in the grid, where there are places.
    """

    code: str
    count: int
    message: str
    places: tuple[tuple[float, float], ...]


def mend(code: str, places: NDArray[np.float64], more: str = "") -> Mend:
    """Return the message of a mend at places (n, 2) mm, with more to say about it."""
    count = len(places)
    text = SENTENCES[code][count > 1].format(count)
    spots = tuple((x, y) for x, y in (places.round(3) + 0.0).tolist())
    return Mend(code, count, text + more, spots)


def left_out(drawing: Drawing) -> Iterator[Message]:
    """Yield a message for each kind of thing that is not read, with count, layer and reason."""
    for thing in drawing.left_out:
        text = f"{thing.count} x {thing.kind}{on_layer(thing.layer)} left out: {thing.reason}"
        yield Message("left-out", thing.layer, text)


def curves_left_out(curves: Iterable[Curve]) -> Iterator[Message]:
    """Yield a message for each kind of curve on each layer."""
    count: dict[tuple[str, str], int] = {}
    for curve in curves:
        count[curve.kind, curve.layer] = count.get((curve.kind, curve.layer), 0) + 1
    for (kind, layer), number in count.items():
        text = f"{number} x {kind}{on_layer(layer)} left out: is curved, and beams are straight"
        yield Message("curves", layer, text)


def on_layer(layer: str) -> str:
    """Return where a thing is, for a sentence."""
    return f' on the layer "{layer}"' if layer else ""
