"""Errors of parts of a test set: by kind of grid, and by what its materials are."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from simulearn.material import Member

if TYPE_CHECKING:
    from simulearn.learn.common.metrics import Errors

LEAST = 2  # trials that a part has at least


def parts_of(errors: "Errors") -> dict[str, Any]:
    """Return the figures of each kind of grid, and of the lowest and highest thirds of each number
    of the materials, as far as they differ.
    """  # noqa: D205
    out: dict[str, Any] = {}
    if errors.bound is not None:
        out |= _bounded(errors, np.ones(len(errors.numbers), np.bool_))
    if errors.kinds:
        kinds = np.array(errors.kinds)
        out["kinds"] = {str(kind): _figures(errors, kinds == kind) for kind in np.unique(kinds)}
    members = errors.members
    if members is not None and (np.ptp(members, axis=0) > 1e-9).any():
        out["members"] = {}
        for name, values in zip(Member._fields, members.T, strict=True):
            values = abs(values) if name == "curl" else values
            low, high = np.quantile(values, [1 / 3, 2 / 3])
            if high - low > 1e-9:
                out["members"][name] = {
                    "low": {"most": float(low), **_figures(errors, values <= low)},
                    "high": {"least": float(high), **_figures(errors, values >= high)},
                }
    return out


def _figures(errors: "Errors", which: NDArray[np.bool_]) -> dict[str, Any]:
    last = errors.percent[which, -1]
    figures = {
        "trials": int(which.sum()),
        "mean_percent": float(last.mean()),
        "median_percent": float(np.median(last)),
        "worst_percent": float(last.max()),
    }
    return figures if errors.bound is None else figures | _bounded(errors, which)


def _bounded(errors: "Errors", which: NDArray[np.bool_]) -> dict[str, float]:
    assert errors.bound is not None
    error, bound = errors.vertex[which, -1], errors.bound[which]
    return {
        "below_bound_percent": float(100 * (error <= bound).mean()),
        "bound_over_error": float(np.median(bound) / max(np.median(error), 1e-9)),
    }
