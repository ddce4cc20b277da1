"""Reading G-code back with another parser, and what it then says of the print."""

from dataclasses import dataclass

import numpy as np
from gcodeparser import parse_gcode_lines

ROLES = ("skirt", "brim", "shell", "active", "passive", "joint")
COLUMNS = {key: column for column, key in enumerate("XYZEFS")}


@dataclass
class Read:
    """A file's commands in order: name, place after it, filament fed by it, speed, bead number."""

    command: np.ndarray
    places: np.ndarray
    fed: np.ndarray
    speed: np.ndarray
    s: np.ndarray
    bead: np.ndarray
    layer: np.ndarray
    roles: list[str]
    parts: list[str]

    @property
    def moved(self):
        """Length of each move in the plane, mm."""
        steps = np.diff(self.places[:, :2], axis=0, prepend=np.nan)
        return np.nan_to_num(np.hypot(steps[:, 0], steps[:, 1]))

    @property
    def prints(self):
        return (self.fed > 0) & (self.moved > 0)


def read(text):
    """Return what a file says; equal lines are parsed once, since layers repeat."""
    lines = text.split("\n")
    numbers: dict[str, int] = {}
    which = np.array([numbers.setdefault(line, len(numbers)) for line in lines])
    table = np.full((len(numbers), 6), np.nan)  # X Y Z E F S
    names = np.full(len(numbers), "", dtype=object)
    comments: dict[int, str] = {}
    rows, columns, values = [], [], []
    for line in parse_gcode_lines("\n".join(numbers), include_comments=True):
        k = line.line_index
        if line.command[0] == ";":
            comments[k] = line.comment
            continue
        names[k] = f"{line.command[0]}{line.command[1]}"
        for key, value in line.params.items():
            if key in COLUMNS:
                rows.append(k)
                columns.append(COLUMNS[key])
                values.append(float(value))
    table[rows, columns] = values
    command, values = names[which], table[which]

    beads, layers = np.zeros(len(lines), dtype=int), np.zeros(len(lines), dtype=int)
    roles, parts = [], []
    for k, comment in comments.items():
        words = comment.split(", ")
        if len(words) > 1 and words[0] in ROLES:
            beads[which == k] = 1
        if comment.startswith("LAYER:"):
            layers[which == k] = 1
    for k in which[beads == 1]:
        words = comments[k].split(", ")
        roles.append(words[0])
        parts.append(words[1])

    move = np.isin(command, ["G0", "G1"])
    places = np.stack([_held(np.where(move, values[:, c], np.nan)) for c in range(3)], axis=1)
    speed = _held(np.where(move, values[:, 4], np.nan))
    relative = _held(np.select([command == "M83", command == "M82"], [1.0, 0.0], np.nan)) == 1
    counts = (move & ~relative) | (command == "G92")
    counted = np.nan_to_num(_held(np.where(counts, values[:, 3], np.nan)))
    fed = np.where(relative, np.nan_to_num(values[:, 3]), np.diff(counted, prepend=0.0))
    fed = np.where(move, fed, 0.0)
    keep = command != ""
    return Read(
        command[keep],
        places[keep],
        fed[keep],
        speed[keep],
        values[keep, 5],
        np.cumsum(beads)[keep] - 1,
        np.cumsum(layers)[keep] - 1,
        roles,
        parts,
    )


def _held(values):
    """Return the values with each gap filled by the one before it."""
    last = np.maximum.accumulate(np.where(np.isnan(values), 0, np.arange(len(values))))
    return values[last]
