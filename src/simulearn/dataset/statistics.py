"""What is in a data set: counts, ranges and percentiles, beside those of the paper's.

The paper's figures: Yang et al., SimuLearn, UIST 2020, dataset of 4,377 trials.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.dataset.packed import Batch, Dataset

PERCENTILES = (0, 3, 50, 97, 100)


@dataclass(frozen=True)
class Quantity:
    """Something that each trial or beam has one of.

    Attributes:
        words: what it is.
        unit: of its values.
        values: (N,) of the data set.
        paper: what the paper says of it: mean, or percentile -> value.
    """

    words: str
    unit: str
    values: NDArray[np.float64]
    paper: Mapping[str, float]

    def summary(self) -> dict[str, Any]:
        """Return mean and percentiles, and what the paper says."""
        figures = {"mean": float(self.values.mean())}
        figures |= {f"p{p}": float(np.percentile(self.values, p)) for p in PERCENTILES}
        near = {name: float(self._figure(name)) for name in self.paper if name not in figures}
        return {"unit": self.unit, **figures, **near, "paper": dict(self.paper)}

    def _figure(self, name: str) -> float:
        return float(np.percentile(self.values, float(name.removeprefix("p"))))


def quantities(data: Dataset) -> dict[str, Quantity]:
    """Return what is worth knowing of a data set, by name."""

    def of(value: Any) -> NDArray[np.float64]:
        return np.concatenate([np.asarray(value(b), np.float64).ravel() for b in data.batches])

    return {
        "dimension": Quantity(
            "grid dimension",
            "mm",
            of(lambda b: b.dimensions),
            {"mean": 94.44, "p3": 65.64, "p96": 124.39},
        ),
        "beam_length": Quantity("beam length, joint to joint", "mm", of(beam_lengths), {}),
        # The paper does not say whether its beams end at the joints' faces; its figures do.
        "net_length": Quantity(
            "beam length, net of its joints",
            "mm",
            of(net_lengths),
            {"mean": 51.29, "p3": 23.11, "p97": 80.19},
        ),
        "actuator": Quantity("actuator ratio", "", of(lambda b: b.actuators), {}),
        "motion": Quantity("mean motion of the corners", "mm", of(motions), {}),
        "motion_percent": Quantity(
            "the same", "% of dimension", of(lambda b: 100 * motions(b) / b.dimensions), {}
        ),
        "creep_share": Quantity(
            "of it by creep", "%", of(lambda b: 100 * motions(b, 10) / motions(b)), {}
        ),
    }


def beam_lengths(batch: Batch) -> NDArray[np.float64]:
    """Return the lengths of all beams from joint to joint: (T, B), mm."""
    ends = batch.flat[:, batch.beams]
    return np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=-1)


def net_lengths(batch: Batch) -> NDArray[np.float64]:
    """Return the lengths of all beams between the faces of their joints: (T, B), mm."""
    middles = batch.sections[:, 0].mean(axis=3)
    return np.linalg.norm(middles[:, :, 2] - middles[:, :, 0], axis=-1).astype(np.float64)


def motions(batch: Batch, since: int = 0) -> NDArray[np.float64]:
    """Return how far the joints' corners move from a frame to the last: mean, (T,), mm."""
    motion = batch.joints[:, -1] - batch.joints[:, since]
    return np.linalg.norm(motion, axis=-1).mean(axis=(1, 2)).astype(np.float64)


def summary(data: Dataset) -> dict[str, Any]:
    """Return all figures of a data set as plain data."""
    records = list(data.records.values())
    iterations = [sum(record["iterations"]) for record in records]
    return {
        "name": data.config.name,
        "seed": data.config.seed,
        "designs": data.config.trials,
        "trials": len(data),
        "train": int(sum((~b.test).sum() for b in data.batches)),
        "test": int(sum(b.test.sum() for b in data.batches)),
        "failed": len(data.failures),
        "failures": [{"trial": k, "reason": reason} for k, reason in data.failures],
        "redrawn": data.redraws,
        "topologies": len(data.batches),
        "joints": sorted({b.flat.shape[1] for b in data.batches}),
        "beams": sorted({len(b.beams) for b in data.batches}),
        "unstable": sum(not record["stable"] for record in records),
        "halved": sum(record["halved"] > 0 for record in records),
        "iterations": {"median": float(np.median(iterations)), "most": max(iterations)},
        "sha256": data.sha256,
        "quantities": {name: q.summary() for name, q in quantities(data).items()},
    }
