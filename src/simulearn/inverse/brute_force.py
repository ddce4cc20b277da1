"""Brute force, the paper's method: apply the best single modification until none improves.

Yang et al., SimuLearn, UIST 2020, "Inverse and Hybrid Workflow".
"""

from collections.abc import Iterator

import numpy as np

from simulearn.inverse.changes import changes
from simulearn.inverse.problem import Did, Found, Problem


def brute_force(problem: Problem, start: Found) -> Iterator[Did]:
    """Search from a design; yield what each iteration did."""
    now = start
    while True:
        tried = changes(problem.space, now.a)
        x = now.x + np.array([change.dx for change in tried])
        a = now.a + np.array([change.da for change in tried])
        told = problem.points(x, a)
        errors = problem.error(told)
        k = int(errors.argmin())
        if not errors[k] < now.error:
            return
        now = Found(x[k], a[k], told[k], float(errors[k]))
        yield Did(tried[k].words)
