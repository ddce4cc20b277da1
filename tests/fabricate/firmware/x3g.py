"""Reads X3G, the binary form in which a Replicator gets a print.

Layout of the commands: MakerBot's protocol document "s3g", and what GPX's s3gdump prints.
"""

import struct
from dataclasses import dataclass, field

import numpy as np

# Bytes after a command's number; text ends with a zero and is counted apart.
LENGTHS = {
    131: 7, 132: 7, 133: 4, 134: 1, 135: 5, 137: 1, 139: 24, 140: 20, 141: 5, 142: 25,
    143: 1, 144: 1, 145: 2, 146: 5, 147: 5, 148: 4, 150: 2, 151: 1, 152: 1, 154: 1,
    155: 31, 156: 1, 157: 20,
}  # fmt: skip
TEXTS = {149: 4, 153: 4}
HOME_LOW, HOME_HIGH, PLACE, DEFINE, RECALL, MOVE = 131, 132, 139, 140, 144, 155
# Steps a millimetre of a Replicator 2X in x, y, z, and of its filament.
STEPS = (88.888889, 88.888889, 400.0, 96.275202)


@dataclass
class Film:
    """What an X3G file does.

    Attributes:
        commands: numbers of the commands in order, moves left out.
        axes: for each homing: "low" or "high", and the axes.
        defined: places (mm) that were set as where the machine is.
        places: (x, y, z) after each move, mm.
        fed: filament fed less drawn back, mm.
        seconds: of the moves at their speeds, without acceleration.
    """

    commands: list[int] = field(default_factory=list)
    axes: list[tuple[str, str]] = field(default_factory=list)
    defined: list[tuple[float, ...]] = field(default_factory=list)
    places: list[tuple[float, ...]] = field(default_factory=list)
    fed: float = 0.0
    seconds: float = 0.0


def read_x3g(data: bytes) -> Film:
    """Return what a file does.

    Raises:
        ValueError: a command is not known, or the file ends within one.
    """
    film, at = Film(), 0
    while at < len(data):
        number, at = data[at], at + 1
        if number == 136:  # to a tool: which, what, how long
            end = at + 3 + data[at + 2]
        elif number in TEXTS:
            end = data.index(0, at + TEXTS[number]) + 1
        elif number in LENGTHS:
            end = at + LENGTHS[number]
        else:
            raise ValueError(f"{number} at byte {at - 1} is no command")
        if end > len(data):
            raise ValueError("the file ends within a command")
        body, at = data[at:end], end
        if number in (PLACE, DEFINE, MOVE):
            steps = struct.unpack_from("<5i", body)
            place = tuple(n / s for n, s in zip(steps, STEPS, strict=False))[:3]
        if number in (PLACE, MOVE):
            film.places.append(place)
        if number == MOVE:
            distance, speed = struct.unpack_from("<fH", body, 25)
            film.fed -= steps[3] / STEPS[3]
            film.seconds += distance / (speed / 64)
            continue
        film.commands.append(number)
        if number == DEFINE:
            film.defined.append(place)
        if number in (HOME_LOW, HOME_HIGH):
            axes = "".join(axis for k, axis in enumerate("XYZ") if body[0] & 1 << k)
            film.axes.append(("low" if number == HOME_LOW else "high", axes))
    return film


def check_film(film, job):
    """Check that it homes, recalls where the axes are, and stays in the frame.

    Args:
        film: of a Replicator 2X.
        job: of which it was made.
    """
    assert film.axes == [("high", "XY"), ("low", "Z")]
    assert film.commands.index(HOME_LOW) < film.commands.index(RECALL)
    # Where the machine is was known when it was defined.
    assert film.commands.index(PLACE) < film.commands.index(DEFINE)
    places = np.array(film.places)
    bed = job.printer.bed
    assert (places.min(axis=0) >= [*bed.low, 0]).all()
    assert (places.max(axis=0) <= [*bed.high, bed.height]).all()
    # The retraction at the end is given again at the start.
    assert abs(film.fed / job.estimate.filament_mm - 1) < 2e-3
