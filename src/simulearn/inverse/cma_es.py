"""CMA-ES: samples from a normal distribution that learns its shape from the better half.

Actuators are multiples of the step (the `cma` package's integer variables); a sample whose
actuators are too short is mended, one whose joints lie impossibly ranks last without being
simulated.
"""

from collections.abc import Iterator

import numpy as np

from simulearn.extras import require
from simulearn.inverse.problem import Advance, Problem, Scored

SPREAD = 1.5  # steps, standard deviation to begin with
FARTHEST = 1e3  # mm, that a joint may go
LOST = 1e4  # mm, the error of what is not valid


def cma_es(problem: Problem, start: Scored) -> Iterator[Advance]:
    """Search from a design; yield what each generation advance.

    Raises:
        InputError: the package `cma` is not installed.
    """
    require("the method cma needs", "cma")
    import cma

    space, p = problem.space, len(start.x)
    scale = np.r_[np.full(p, space.move), np.full(len(start.a), space.ratio)]
    low = np.r_[np.full(p, -FARTHEST), np.full(len(start.a), -1.0)] / scale
    begin, size = start, max(16, 4 + int(3 * np.log(len(scale))))
    while True:
        options = {
            "seed": int(problem.source.integers(1, 2**31)),
            "popsize": size,
            "verbose": -9,
            "bounds": [low.tolist(), (-low).tolist()],
            "integer_variables": list(range(p, len(scale))),
        }
        strategy = cma.CMAEvolutionStrategy(np.r_[begin.x, begin.a] / scale, SPREAD, options)
        while not strategy.stop():
            samples = strategy.ask()
            points = np.array(samples) * scale
            x = points[:, :p]
            a = np.array([space.nearest(*pair) for pair in zip(x, points[:, p:], strict=True)])
            errors = problem.errors(x, a)
            strategy.tell(samples, np.where(np.isfinite(errors), errors, LOST).tolist())
            yield Advance(f"generation of {size}, spread {strategy.sigma:.2f} steps")
        # Again, from where it came to, with twice the samples, as restarts of CMA-ES do.
        begin, size = problem.best or begin, 2 * size
