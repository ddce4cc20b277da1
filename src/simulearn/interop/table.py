"""The vertices of all frames as a table, for spreadsheets and statistics."""

import csv
from pathlib import Path

import numpy as np

from simulearn.files import replacing
from simulearn.schedule import SCHEDULE
from simulearn.simulate import Result

COLUMNS = ("frame", "released", "part", "number", "section", "corner", "x", "y", "z")
SECTIONS = ("start", "middle", "end")
DIGITS = 6  # of a mm, as in a result's JSON


def write_csv(result: Result, path: Path | str) -> None:
    """Write all corners of all frames as a table of comma-separated values, mm.

    Args:
        result: what to write.
        path: the file.

    Raises:
        InputError: the file cannot be written.
    """
    joints = [("joint", j, "", c) for j, c in np.ndindex(result.joints.shape[1:3])]
    beams = [("beam", b, SECTIONS[s], c) for b, s, c in np.ndindex(result.beams.shape[1:4])]
    names = [*joints, *beams]
    with replacing(path) as temporary, temporary.open("w", encoding="ascii", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        frames = zip(SCHEDULE.released, result.joints, result.beams, strict=True)
        for frame, (released, corners, sections) in enumerate(frames):
            # + 0.0 turns -0.0 into 0.0
            places = np.concatenate([corners.reshape(-1, 3), sections.reshape(-1, 3)])
            for name, place in zip(names, places.round(DIGITS) + 0.0, strict=True):
                table.writerow([frame, released, *name, *(f"{x:.{DIGITS}f}" for x in place)])
