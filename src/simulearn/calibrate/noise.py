"""How readings differ: by the reading itself, and from strip to strip of one print.

Repeats of a strip differ by a reading error of standard deviation s on each value, and because the
released strain of each strip differs from the mean by a relative standard deviation t. The second
moves chord and rise together, by g t, where g is their derivative by the strain. So

    covariance of (chord, rise) of one strip = s^2 I + t^2 g g'

Both are estimated by the restricted likelihood of the repeats' deviations from their means
(Patterson and Thompson, Biometrika 58, 1971), with what a ruler reads for a prior of s.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar
from scipy.stats import chi2

Numbers = NDArray[np.float64]
RULER = 0.3  # mm, standard deviation of a reading by ruler or straight edge
LOG_RULER = float(np.log(RULER))
DOUBT = 0.5  # standard deviation of its logarithm
LIKELY = 4.0  # as many degrees of freedom is this prior worth
MOST_SCATTER = 0.3
POINTS = 40  # scatters that are tried
WITHIN = float(chi2.ppf(0.9, 1)) / 2  # of the logarithm of likelihood, for an interval of 90 %


class Noise(NamedTuple):
    """How readings differ.

    Attributes:
        reading: standard deviation of a reading, mm.
        scatter: relative standard deviation of the released strain from strip to strip.
        low, high: interval of 90 % of the scatter; it is not told from none where low is 0.
        freedom: degrees of freedom that the reading error is known by.
    """

    reading: float
    scatter: float
    low: float
    high: float
    freedom: float

    def covariance(self, slope: Numbers, counts: NDArray[np.int64]) -> Numbers:
        """Return the covariance (2, 2), mm2, of the means of chord and rise of one strip.

        Args:
            slope: (2,) their derivatives by the relative strain, mm.
            counts: (2,) of how many readings each is the mean.
        """
        many = np.maximum(counts, 1)
        common = np.outer(slope, slope) * self.scatter**2 / np.sqrt(np.outer(many, many))
        return np.diag(self.reading**2 / many) + common


def estimate(readings: list[Numbers], slopes: list[Numbers], lengths: list[Numbers]) -> Noise:
    """Return how readings differ.

    Args:
        readings: for each strip (R, 2) chord and rise, mm, NaN where blank.
        slopes: for each strip (2,) their derivatives by the relative strain, mm.
        lengths: for each strip (R,) lengths before, mm, NaN where blank; of these only s is told.
    """
    spread = [
        (one - one.mean(axis=0), slope)
        for all_, slope in zip(readings, slopes, strict=True)
        if len(one := all_[np.isfinite(all_).all(axis=1)]) > 1
    ]
    free, squares = 0, 0.0
    for row in lengths:
        known = row[np.isfinite(row)]
        if len(known) > 1:
            free, squares = (
                free + len(known) - 1,
                squares + float(((known - known.mean()) ** 2).sum()),
            )
    freedom = LIKELY + free + 2 * sum(len(one) - 1 for one, _ in spread)

    def cost(values: Numbers) -> float:
        """Return minus the logarithm of the likelihood, and of the prior."""
        s, t = np.exp(values[0]), values[1]
        total = ((values[0] - LOG_RULER) / DOUBT) ** 2 / 2
        total += free * values[0] + squares / (2 * s**2)
        for one, slope in spread:
            many, g = len(one) - 1, float(slope @ slope)
            # The eigenvalues of s^2 I + t^2 g g'.
            total += many * (values[0] + np.log(s**2 + t**2 * g) / 2)
            along = float(((one @ slope) ** 2).sum()) / g if g else 0.0
            across = float((one**2).sum()) - along
            total += along / (2 * (s**2 + t**2 * g)) + across / (2 * s**2)
        return float(total)

    def profile(t: float) -> tuple[float, float]:
        """Return the least cost at a scatter, and the logarithm of s there."""
        found = minimize_scalar(
            lambda x: cost(np.array([x, t])),
            bounds=(LOG_RULER - 4, LOG_RULER + 4),
            method="bounded",
        )
        return float(found.fun), float(found.x)

    scatters = np.append(0.0, np.geomspace(1e-3, MOST_SCATTER, POINTS))
    costs, logs = np.array([profile(float(t)) for t in scatters]).T
    best = int(costs.argmin())
    likely = scatters[costs <= costs[best] + WITHIN]
    low, high = (float(likely.min()), float(likely.max())) if spread else (0.0, MOST_SCATTER)
    return Noise(float(np.exp(logs[best])), float(scatters[best]), low, high, freedom)
