"""Files of measurements: which reader takes which."""

from dataclasses import replace
from pathlib import Path

from simulearn.compare.measurement import Measurement
from simulearn.compare.scans import FORMATS, of_points, read_scan
from simulearn.compare.tables import read_table
from simulearn.drawings.text import decoded
from simulearn.errors import InputError
from simulearn.surfaces.meshfile import contents

TABLES = (".csv", ".tsv", ".txt", ".xyz", ".asc", ".pts")
LEAST_CLOUD = 20  # times as many points as joints are a cloud


def read_measurement(path: Path | str, joints: int) -> Measurement:
    """Return what a file holds: places of joints, or points of a surface.

    Args:
        path: a table (.csv, .tsv, .txt, .xyz, .asc, .pts), or a scan (.stl, .ply, .obj).
        joints: of the grid; a table of many more points is a cloud, with numbers or without.

    Raises:
        InputError: the file cannot be read, or is no measurement; the message names the place.
    """
    path = Path(path)
    ending = path.suffix.lower()
    if ending in FORMATS:
        return read_scan(path)
    if ending not in TABLES:
        known = " ".join((*TABLES, *FORMATS))
        raise InputError(
            f"{path}: the ending is not one of {known}", "measurement-format", str(path)
        )
    data = contents(path, "measurement")
    try:
        table = read_table(_text(data))
    except InputError as error:
        raise InputError(f"{path}: {error}", error.code, error.where) from error
    count = len(table.places)
    if count < LEAST_CLOUD * joints and (table.numbers is not None or count <= joints):
        return table
    if count < LEAST_CLOUD * joints:
        raise InputError(
            f"{path}: has {count} points without the number of a joint, and the grid has {joints} "
            f"joints; a cloud has at least {LEAST_CLOUD * joints} points",
            "measurement-count",
            str(path),
        )
    return replace(of_points(table.places), unit=table.unit)


def _text(data: bytes) -> str:
    try:
        return decoded(data)
    except InputError as error:
        text = "is no text; a table of joints is text, such as a spreadsheet saves as .csv"
        raise InputError(text, "measurement-table", "measurement") from error
