"""A comparison in numbers and in words, and as a table of joints, which is read again."""

import csv
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import beta

from simulearn.compare.comparing import Comparison
from simulearn.compare.explaining import Explanation
from simulearn.files import replacing
from simulearn.simulate.resultfile import qualities

SCHEMA = "simulearn.comparison/1"
COLUMNS = ("joint", "x", "y", "z", "simulated_x", "simulated_y", "simulated_z", "deviation")
LISTED = 3  # changes of the material
LITTLE = 0.3  # a change that explains less explains nothing
EQUALLY = 0.05  # less than the best explains as well
NEGLIGIBLE = 0.01  # mm, which nobody measures
CHANCE = 0.05  # that noise alone would seem to be explained


def figures(comparison: Comparison) -> dict[str, Any]:
    """Return a comparison as data for machines: mm, degrees per mm; None where nothing is known."""
    off, result = comparison.deviation, comparison.result
    size, worst = result.grid.dimension, comparison.deviation.worst
    joints = [
        {
            "joint": int(comparison.joint_numbers[j]),
            "measured_mm": _numbers(off.joints[j]),
            "simulated_mm": _numbers(off.simulated[j]),
            "deviation_mm": _number(off.distances[j]),
            "in_plane_mm": _number(np.linalg.norm(off.moves[j, :2])),
            "up_mm": _number(off.moves[j, 2]),
        }
        for j in range(len(off.joints))
    ]
    beams = [
        {
            "beam": int(comparison.beam_numbers[b]),
            "mean_mm": _number(off.beams[b, 0]),
            "largest_mm": _number(off.beams[b, 1]),
            "curvature_deg_mm": _number(np.degrees(off.curvature[b, 0])),
            "simulated_curvature_deg_mm": _number(np.degrees(off.curvature[b, 1])),
        }
        for b in range(len(off.beams))
    ]
    return {
        "schema": SCHEMA,
        "engine": result.engine,
        **qualities(result),
        "measured": "scan" if comparison.scanned else "joints",
        "dimension_mm": round(size, 6),
        "mean_mm": _number(off.mean),
        "mean_percent": _number(100 * off.mean / size),
        "worst_mm": _number(off.distances[worst]),
        "worst_percent": _number(100 * off.distances[worst] / size),
        "worst_joint": int(comparison.joint_numbers[worst]),
        "residual_mm": _number(comparison.residual),
        "noise_mm": None if comparison.noise is None else _number(comparison.noise),
        "scatter_mm": _number(comparison.scatter.mm),
        "scatter": comparison.scatter.words,
        "joints": joints,
        "beams": beams,
        "explanations": [
            {
                "parameter": one.name,
                "value": _number(one.value),
                "nominal": _number(one.nominal),
                "explained": _number(one.explained),
                "within_family": one.within,
                "words": one.words,
                "alike": list(one.alike),
            }
            for one in comparison.explanations
        ],
        "verdict": verdict(comparison),
        "messages": [
            {"code": m.code, "where": m.where, "message": m.message} for m in comparison.messages
        ],
    }


def qualified(comparison: Comparison) -> list[str]:
    """Return sentences that say how much a deviation says."""
    mean, scatter, result = comparison.deviation.mean, comparison.scatter, comparison.result
    lines = []
    if np.isfinite(scatter.mm):
        side = "no more than" if mean <= scatter.mm else "more than"
        lines.append(
            f"prints of one design differ by {scatter.mm:.1f} mm ({scatter.words}); "
            f"this one is off by {side} that"
        )
    else:
        lines.append(f"scatter of prints: {scatter.words}")
    if result.bound_mm is not None:
        lines.append(f"nine of ten such simulations are off by less than {result.bound_mm:.2f} mm")
    else:
        lines.append(f"the engine {result.engine} does not estimate its own error")
    if comparison.noise is not None:
        lines.append(f"the scan is rough by {comparison.noise:.2f} mm about the fitted shape")
    return lines


def verdict(comparison: Comparison) -> str:
    """Return what one change of the material would explain, in a sentence or two."""
    bound = comparison.result.bound_mm or 0.0
    noise = (comparison.noise or 0.0) / 2
    mean, found = comparison.deviation.mean, comparison.explanations
    if mean <= max(bound, noise, NEGLIGIBLE):
        return (
            f"a mean of {mean:.2f} mm is within what the simulation and the measurement are off "
            "by themselves; there is nothing to explain"
        )
    if not found:
        return "what would explain it was not looked for, or the grid has no answer in others"
    best = found[0]
    least = max(LITTLE, by_chance(comparison))
    if best.explained < least:
        return (
            f"no one change of the material explains it: the best, {_change(best)}, would explain "
            f"{best.explained:.0%} of the squared deviation, and less than {least:.0%} is nothing "
            "to go by"
        )
    listed = [one for one in found[:LISTED] if one.explained > max(LITTLE / 2, 1e-3)]
    words = [f"{_change(best)} would explain {best.explained:.0%} of the squared deviation"]
    words += [f"{_change(one)} {one.explained:.0%}" for one in listed[1:]]
    text = "; ".join(words)
    equal = [one for one in listed if one.explained > best.explained - EQUALLY]
    if len(equal) > 1:
        text += f". {len(equal)} of these do equally well: this print cannot tell them apart"
    return text


def by_chance(comparison: Comparison) -> float:
    """Return what part noise alone would seem to be explained by the best of the parameters.

    The part of a random vector of n numbers along one direction is distributed as Beta(1/2,
    (n - 1)/2); the best of several is allowed for by dividing the level among them (Bonferroni).
    """
    off = comparison.deviation
    places = int(off.measured.sum() + np.isfinite(off.stations[:, 1]).all(axis=1).sum())
    free = 3 * places - 6
    if free < 2:
        return 1.0
    return float(beta.ppf(1 - CHANCE / max(1, len(comparison.explanations)), 0.5, (free - 1) / 2))


def _change(one: Explanation) -> str:
    return one.words if one.within else f"{one.words} (outside the family)"


def write_joints(comparison: Comparison, path: Path | str) -> None:
    """Write the measured joints as a table: joint,x,y,z, and what was simulated; mm.

    Args:
        comparison: whose.
        path: the file.

    Raises:
        InputError: the file cannot be written.
    """
    off = comparison.deviation
    with replacing(path) as temporary, temporary.open("w", encoding="ascii", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        for j in np.flatnonzero(off.measured).tolist():
            places = [*off.joints[j], *off.simulated[j], off.distances[j]]
            table.writerow([comparison.joint_numbers[j], *(f"{x + 0.0:.4f}" for x in places)])


def _number(x: float | np.floating[Any]) -> float | None:
    return round(float(x), 6) + 0.0 if np.isfinite(x) else None


def _numbers(row: Any) -> list[float] | None:
    return [round(float(x), 6) + 0.0 for x in row] if np.isfinite(row).all() else None
