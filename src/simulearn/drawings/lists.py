"""Lines and graphs in JSON."""

from typing import Any
import numpy as np
from simulearn.drawings.drawing import Drawing, Line


def read_json_lines(value: Any) -> Drawing:
    lines = [
        Line(np.array([[*p, 0.0][:3] for p in l], float), where=f"line {k}")
        for k, l in enumerate(value)
    ]
    return Drawing("JSON lines", lines, plain=True)
