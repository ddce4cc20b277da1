"""Motion through a viscous bath to the next stable equilibrium under the same load.

At a limit point no equilibrium is near, and a print moves through the bath to the next one, slowly,
for hot plastic is viscous. So the solid follows a gradient flow of its energy by backward Euler,
K du + c M (u - u_ref) = R, with lumped nodal volumes M; c falls as steps succeed, until the solid
stands without it. (Commercial solvers call it stabilisation.) It needs no arc length and ends in a
stable equilibrium.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import ComputationError
from simulearn.fea.problem import EquilibriumProblem, NotConvergedError, SolidState

Array = NDArray[np.float64]

# Viscosities c over modulus / thickness^2, which have the same unit (N/mm per mm3).
BEGIN, END, MOST = 1e-4, 1e-11, 1e3
FACTOR = 4.0  # by which c falls after a step that succeeds, and grows after one that fails
CALM = 0.15  # of the solid's size: a step that moves it by more does not lower c
SLOW = 0.01  # of the size: a step that moves it by less lowers c twice
STEPS = 400  # at most
STILL = 1e-4  # of the size: a step that moves it by less leads nowhere
ITERATIONS = 8  # at most, in one step
WAIT = 3  # steps after a failed one, before c falls again
GROW = 1.5  # c over the size of a negative eigenvalue: its mode grows threefold in each step
PUSH = 1e-3  # of the solid's size, along the softest mode, from an unstable balance
PUSHES = 3  # at most
ALIKE = 1e-3  # relative difference of two motions, up to which they are mirror images
COMPARED = 6  # of their steps


def flow(
    problem: EquilibriumProblem, start: SolidState, viscosity: float | None = None
) -> SolidState:
    """Return the stable equilibrium to which a solid moves under the load of a state.

    Args:
        problem: the equilibrium problem.
        start: displacements from which it moves, with the load that acts.
        viscosity: c of the first step, N/mm per mm3; by default so large that it moves little.

    Raises:
        ComputationError: the motion comes to no end.
        CancelledError: the problem's token said so.
    """
    state = start
    for state in moving(problem, start, viscosity):  # noqa: B007  the last one counts
        pass
    return state


def moving(
    problem: EquilibriumProblem, start: SolidState, viscosity: float | None = None
) -> Iterator[SolidState]:
    """Yield the states of a solid that moves, the last one at rest; see `flow`."""
    thickness = float(np.ptp(problem.solid.nodes[:, 2]))
    unit = (problem.law.first + 2 * problem.law.shear) / thickness**2
    state, c, pushes = start, viscosity or BEGIN * unit, 0
    wait = WAIT if viscosity else 0
    for _ in range(STEPS):
        plain = c < END * unit
        after = _step(problem, state, 0.0 if plain else c)
        if after is not None and plain and after.negative and pushes < PUSHES:
            pushes += 1
            value, push = unstable_mode(problem, after)
            state, c = replace(after, u=after.u + push), GROW * abs(value)
        elif after is None or after.negative:
            # Too far at once, or not towards a minimum of the energy.
            c *= FACTOR * (FACTOR if plain else 1)
            wait = WAIT
            if c > MOST * unit:
                break
        else:
            yield after
            if plain:
                return
            motion = abs(after.u - state.u).max() / problem.size
            if wait and motion > STILL:
                wait -= 1
            elif motion < CALM:
                c /= FACTOR * (FACTOR if motion < SLOW else 1)
            state = after
    raise ComputationError(
        f"the grid comes to no rest at {100 * start.released:.1f} % of the stress released under "
        f"{start.gravity:.2f} times gravity",
        code="no-equilibrium",
        hint="a smaller grid, or shorter actuators, may have a shape",
    )


def _step(problem: EquilibriumProblem, state: SolidState, viscosity: float) -> SolidState | None:
    """Return the state after a step of the flow, None where there is none."""
    try:
        return problem.equilibrium(state, viscosity, state.u, ITERATIONS)
    except NotConvergedError:
        return None


@dataclass(frozen=True, eq=False)
class Departure:
    """How a solid leaves an unstable balance.

    Attributes:
        state: the stable equilibrium that it comes to.
        mirrored: whether the opposite push leads as far, to the mirrored shape.
    """

    state: SolidState
    mirrored: bool


def leave(problem: EquilibriumProblem, balance: SolidState) -> Departure:
    """Leave an unstable balance along the unstable mode that grows fastest.

    Args:
        problem: the equilibrium problem, its last factors those of the balance.
        balance: an equilibrium with negative eigenvalues.
    """
    value, push = unstable_mode(problem, balance)
    viscosity = GROW * abs(value)
    state, sizes = balance, []
    for state in moving(problem, replace(balance, u=balance.u + push), viscosity):
        sizes.append(np.linalg.norm(state.u - balance.u))
    # Mirror images move alike from the first step on, so some steps tell.
    others = moving(problem, replace(balance, u=balance.u - push), viscosity)
    alike = [
        abs(np.linalg.norm(other.u - balance.u) - size) < ALIKE * size
        for size, other in zip(sizes[:COMPARED], others, strict=False)
    ]
    return Departure(state, all(alike))


def unstable_mode(problem: EquilibriumProblem, balance: SolidState) -> tuple[float, Array]:
    """Return the lowest eigenvalue (N/mm per mm3) of a balance and a small push along its mode.

    The first large component of the push is positive, so that the side is always the same.

    Args:
        problem: the equilibrium problem, its last factors those of the balance.
        balance: an equilibrium with negative eigenvalues.
    """
    values, modes = problem.soft_modes(balance.negative + 1)
    mode = modes[int(np.argmin(values))]
    large = mode[abs(mode) > 0.5]
    return float(values.min()), np.sign(large[0]) * PUSH * problem.size * mode
