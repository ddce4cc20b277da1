"""The table of vertices: every corner of every frame, plain numbers, in the documented order."""

import csv

import bent
import numpy as np

from simulearn.interop import write_csv
from simulearn.schedule import SCHEDULE

RESULT = bent.result(bent.kinds()["star"])


def test_every_corner_is_read_back(tmp_path):
    path = tmp_path / "a.csv"
    write_csv(RESULT, path)
    with path.open(encoding="ascii", newline="") as file:
        rows = [*csv.DictReader(file)]
    assert [*rows[0]] == [
        "frame", "released", "part", "number", "section", "corner", "x", "y", "z"
    ]  # fmt: skip
    joints, beams = np.full_like(RESULT.joints, np.nan), np.full_like(RESULT.beams, np.nan)
    sections = ["start", "middle", "end"]
    for row in rows:
        frame, number, corner = (int(row[key]) for key in ("frame", "number", "corner"))
        place = [float(row[key]) for key in "xyz"]
        assert float(row["released"]) == SCHEDULE.released[frame]
        if row["part"] == "joint":
            assert row["section"] == ""
            joints[frame, number, corner] = place
        else:
            beams[frame, number, sections.index(row["section"]), corner] = place
    np.testing.assert_allclose(joints, RESULT.joints, atol=1e-6)
    np.testing.assert_allclose(beams, RESULT.beams, atol=1e-6)
    assert len(rows) == (joints.size + beams.size) // 3
    text = path.read_text()
    assert not {"e", "-0.000000"} & {*text.partition("\n")[2].replace("beam", "").split(",")}
    assert "\r" not in text
