"""Brute force, the paper's method: apply the best single modification until none improves.

Yang et al., SimuLearn, UIST 2020, "Inverse and Hybrid Workflow".
"""

from collections.abc import Iterator

import numpy as np

from simulearn.inverse.changes import changes
from simulearn.inverse.problem import Advance, Problem, Scored


def brute_force(problem: Problem, start: Scored) -> Iterator[Advance]:
    """Search from a design; yield what each iteration advance."""
    now = start
    while True:
        tried = changes(problem.space, now.a)
        x = now.x + np.array([change.dx for change in tried])
        a = now.a + np.array([change.da for change in tried])
        points = problem.points(x, a)
        errors = problem.error(points)
        k = int(errors.argmin())
        if not errors[k] < now.error:
            return
        now = Scored(x[k], a[k], points[k], float(errors[k]))
        yield Advance(tried[k].words)
