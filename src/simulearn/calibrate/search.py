"""The search for the numbers that fit readings best: least squares with what is likely before.

A difference counts over its standard deviation, which the repeats tell (see `noise`). A number
counts by how far it lies from the base's, over how far materials lie from one another. The last
number is the size: printed over designed lengths.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from simulearn.calibrate.model import Model
from simulearn.calibrate.noise import estimate
from simulearn.errors import ComputationError

Numbers = NDArray[np.float64]
SIZE_SD = 0.005  # by which a printer prints too large or too small
SIZES = (0.9, 1.1)
MODEL_SD = 0.14  # mm, error of simulated strips: rms of 36 against the fine mesh
TOLERANCE = 1e-3
MOST_STEPS = 30


class Search:
    """Readings of S strips, their noise, and the best P + 1 numbers so far.

    Args:
        model: what numbers make of the strips.
        start: (P,) numbers of the base material.

    Raises:
        ComputationError: a strip of the base material has no simulation.
    """

    def __init__(self, model: Model, start: Numbers) -> None:
        self.model = model
        self.base = np.append(start, 1.0)
        self.prior = np.array([one.sd for one in model.parameters] + [SIZE_SD])
        self.low = np.array([one.low for one in model.parameters] + [SIZES[0]])
        self.high = np.array([one.high for one in model.parameters] + [SIZES[1]])
        self.free = np.ones(len(self.base), dtype=bool)
        self.at = self.base.copy()
        self._arrive()
        self.start = self.values

    def hold(self, held: NDArray[np.bool_]) -> None:
        """Keep some numbers (P,) at the base's."""
        self.free[:-1] = ~held
        self.at = np.where(self.free, self.at, self.base)

    def solve(self) -> None:
        """Go to the best numbers, and weigh the readings by the noise that there is at them.

        Raises:
            ComputationError: a strip has no simulation there.
        """
        free = self.free
        low, high = self.low[free], self.high[free]
        inside = 1e-6 * (high - low)
        found = least_squares(
            self._residual,
            np.clip(self.at[free], low + inside, high - inside),
            self._jacobian,
            (low, high),
            x_scale=self.prior[free],
            xtol=TOLERANCE,
            ftol=TOLERANCE,
            max_nfev=MOST_STEPS,
        )
        self.at = self._all(found.x)
        self._arrive()

    def solve_from(self, moved: Numbers) -> None:
        """Go to the best numbers from others than the base's, and stay there if they are better.

        Args:
            moved: (P,) by how many standard deviations of the prior the start is away.
        """
        kept = self.at, self.cost
        at = self.base + self.prior * np.append(moved, 0.0)
        self.at = np.where(self.free, np.clip(at, self.low, self.high), self.base)
        try:
            self._arrive()
            self.solve()
        except ComputationError:  # a strip has no simulation so far away
            self.at = kept[0]
        if self.cost > kept[1]:
            self.at = kept[0]
        self._arrive()

    @property
    def cost(self) -> float:
        """Sum of the squares of all differences, those from the prior among them."""
        from_data = self.data(self.values, self.slopes, self.at)
        from_prior = ((self.at - self.base) / self.prior)[self.free]
        return float(from_data @ from_data + from_prior @ from_prior)

    def covariance(self) -> Numbers:
        """Return the covariance (P + 1, P + 1) of all numbers, whether they are held or not."""
        rows = self.rows(self.slopes)
        return np.asarray(np.linalg.inv(rows.T @ rows + np.diag(self.prior**-2)))

    def deviations(self) -> Numbers:
        """Return the standard deviations (P + 1,) of all numbers."""
        return np.asarray(np.sqrt(np.diag(self.covariance())))

    def rows(self, slopes: Numbers) -> Numbers:
        """Return the derivatives (M, P + 1) of all readings over their standard deviations."""
        found = [
            weight @ slope[strip.known]
            for strip, weight, slope in zip(self.model.strips, self.weights, slopes, strict=True)
        ]
        sizes = np.zeros((len(self.lengths), len(self.base)))
        sizes[:, -1] = [beams / sd for beams, _, sd in self.lengths]
        return np.concatenate([*found, sizes])

    def data(self, values: Numbers, slopes: Numbers, at: Numbers) -> Numbers:
        """Return the differences (M,) of all readings over their standard deviations.

        Args:
            values: (S, 2) simulated chords and rises at the designed size, mm.
            slopes: (S, 2, P + 1) their derivatives.
            at: (P + 1,) the numbers.
        """
        found = []
        for s, strip in enumerate(self.model.strips):
            simulated = values[s] + (at[-1] - 1) * slopes[s, :, -1]
            found.append(self.weights[s] @ (simulated - strip.means)[strip.known])
        sizes = [(at[-1] * beams - mean) / sd for beams, mean, sd in self.lengths]
        return np.concatenate([*found, sizes])

    def _arrive(self) -> None:
        """Simulate the numbers so far, estimate the noise there, and weigh the readings by it."""
        strips = self.model.strips
        self.values, self.slopes = self.model.slopes(self.at[:-1])
        for strip, value in zip(strips, self.values, strict=True):
            if not np.isfinite(value).all():
                raise ComputationError(
                    f"strip {strip.name} has no simulation with what fits best so far",
                    "calibration-no-simulation",
                    f"strip {strip.name}",
                )
        by_strain = [slope[:, 0] * self.at[0] for slope in self.slopes]
        self.noise = estimate([s.readings for s in strips], by_strain, [s.before for s in strips])
        self.covariances = [
            self.noise.covariance(slope, s.counts) + MODEL_SD**2 * np.eye(2)
            for s, slope in zip(strips, by_strain, strict=True)
        ]
        self.weights = [
            np.linalg.inv(np.linalg.cholesky(c[np.ix_(s.known, s.known)]))
            for s, c in zip(strips, self.covariances, strict=True)
        ]
        width = self.model.base.section.width
        self.lengths = [  # of the beams of a strip: designed, measured mean, its deviation; mm
            (
                sum(strip.record.beams),
                float(np.nanmean(strip.before)) - width,
                self.noise.reading / float(np.isfinite(strip.before).sum()) ** 0.5,
            )
            for strip in strips
            if np.isfinite(strip.before).any()
        ]

    def _all(self, free: Numbers) -> Numbers:
        at = self.at.copy()
        at[self.free] = free
        return at

    def _residual(self, free: Numbers) -> Numbers:
        at = self._all(free)
        values = self.model.values([at[:-1]])[0]
        prior = ((at - self.base) / self.prior)[self.free]
        found = np.concatenate([self.data(values, self.slopes, at), prior])
        return np.where(np.isfinite(found), found, np.inf)  # so that a step is taken back

    def _jacobian(self, free: Numbers) -> Numbers:
        _, self.slopes = self.model.slopes(self._all(free)[:-1])
        prior = np.diag(1 / self.prior)[self.free]
        return np.concatenate([self.rows(self.slopes), prior])[:, self.free]
