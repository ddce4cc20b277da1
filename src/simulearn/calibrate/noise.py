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
from scipy.stats import chi2

Numbers = NDArray[np.float64]
RULER = 0.3  # mm, standard deviation of a reading by ruler or straight edge
LOG_RULER = float(np.log(RULER))
DOUBT = 0.5  # standard deviation of its logarithm
LIKELY = 4.0  # as many degrees of freedom is this prior worth
MOST_SCATTER = 0.3
SPAN, READINGS = 3.0, 241  # of logarithms of reading errors that are tried
POINTS = 60  # scatters that are tried
TINY = 1e-12
WITHIN = float(chi2.ppf(0.9, 1)) / 2  # of the logarithm of likelihood, for an interval of 90 %


class Noise(NamedTuple):
    """How readings differ.

    Attributes:
        reading: standard deviation of a reading, mm.
        scatter: relative standard deviation of the released strain from strip to strip.
        low, high: interval of 90 % of the scatter; it is not distinct from none where low is 0.
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
        lengths: for each strip (R,) lengths before, mm, NaN where blank; these determine s only.
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

    # Of each strip: repeats less one, g'g, and squares of the deviations along g and across it.
    found = []
    for one, slope in spread:
        size_of = float(slope @ slope)
        on_slope = float(((one @ slope) ** 2).sum()) / max(size_of, TINY)
        found.append((len(one) - 1, size_of, on_slope, float((one**2).sum()) - on_slope))
    many, size, along, across = np.array(found).reshape(-1, 4).T

    logs = LOG_RULER + np.linspace(-SPAN, SPAN, READINGS)
    scatters = np.append(0.0, np.geomspace(1e-3, MOST_SCATTER, POINTS))
    s2, t2 = np.exp(2 * logs)[:, None, None], scatters[:, None] ** 2
    # The eigenvalues of s^2 I + t^2 g g'; minus the logarithm of likelihood and prior.
    wide = s2 + t2 * size
    cost = (many * np.log(wide * s2) + along / wide + across / s2).sum(axis=2) / 2
    cost += (free * logs + squares * np.exp(-2 * logs) / 2)[:, None]
    cost += (((logs - LOG_RULER) / DOUBT) ** 2 / 2)[:, None]

    least, best = divmod(int(cost.argmin()), len(scatters))
    likely = scatters[cost.min(axis=0) <= cost.min() + WITHIN]
    low, high = (float(likely.min()), float(likely.max())) if found else (0.0, MOST_SCATTER)
    return Noise(float(np.exp(logs[least])), float(scatters[best]), low, high, freedom)
