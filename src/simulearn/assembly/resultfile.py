"""What became of an assembly, as JSON: `simulearn.assembled/1`."""

import dataclasses
import json
from pathlib import Path
from typing import Any

import numpy as np

from simulearn.assembly.assembled import Assembled
from simulearn.files import replacing
from simulearn.rigid import Place
from simulearn.simulate import Failure, Outcome, failure_to_dict
from simulearn.simulate.resultfile import qualities

SCHEMA = "simulearn.assembled/1"
DIGITS = 4  # of mm and s


def assembled_to_dict(assembled: Assembled) -> dict[str, Any]:
    """Return the machine form of an assembly's outcome; mm, s.

    Returns:
        parts: of each its place and, in the last frame, the centres of its joints and its box; or
            why it has no result.
        timeline: when the steps begin and end, and for each moment the frame of each part and how
            far it is from its place.
        collisions: which, when, where, how deep.
    """
    assembly, moments = assembled.assembly, assembled.timeline
    distinct = assembly.distinct
    return {
        "schema": SCHEMA,
        "name": assembly.name,
        "engine": assembled.engine,
        "parts": [
            {
                "name": part.name,
                "same_grid_as": assembly.parts[distinct[k]].name,
                "place": {
                    "turn": _rounded(part.place.turn, 9),
                    "shift": _rounded(part.place.shift),
                },
                **_placed(outcome, part.place),
            }
            for k, (part, outcome) in enumerate(
                zip(assembly.parts, assembled.outcomes, strict=True)
            )
        ],
        "timeline": {
            "seconds": round(moments.seconds, DIGITS),
            "steps": [
                {
                    "name": step.title,
                    "parts": list(step.parts),
                    "slide": list(step.slide),
                    "begins": _rounded(moments.times[moments.of_step(k)[0]]),
                    "ends": _rounded(moments.times[moments.of_step(k)[-1]]),
                }
                for k, step in enumerate(assembly.order)
            ],
            "times": _rounded(moments.times),
            "frames": _rounded(moments.frames),
            "shifts": _rounded(moments.shifts),
        },
        "collisions": [
            {
                "names": list(one.names),
                "where": list(one.where),
                "step": one.step,
                "time": round(one.time, DIGITS),
                "depth_mm": round(one.depth_mm, DIGITS),
                "place": _rounded(one.place),
            }
            for one in assembled.collisions
        ],
        "warnings": [dataclasses.asdict(message) for message in assembled.warnings],
    }


def write_assembled_json(assembled: Assembled, path: Path | str) -> None:
    """Write the machine form of an assembly's outcome.

    Args:
        assembled: the outcome.
        path: the file.

    Raises:
        InputError: the file cannot be written.
    """
    text = json.dumps(assembled_to_dict(assembled), allow_nan=False)
    with replacing(path) as temporary:
        temporary.write_text(text + "\n", encoding="utf-8")


def _placed(outcome: Outcome, place: Place) -> dict[str, Any]:
    """Return where a part is in the end, or why it has no result."""
    if isinstance(outcome, Failure):
        return {"ok": False, **failure_to_dict(outcome)}
    corners = np.concatenate([outcome.joints[-1].reshape(-1, 3), outcome.beams[-1].reshape(-1, 3)])
    corners = place(corners)
    return {
        "ok": True,
        "low": _rounded(corners.min(axis=0)),
        "high": _rounded(corners.max(axis=0)),
        "centres": _rounded(place(outcome.centres[-1])),
        **qualities(outcome),
    }


def _rounded(values: Any, digits: int = DIGITS) -> Any:
    return (np.round(np.asarray(values, dtype=np.float64), digits) + 0.0).tolist()
