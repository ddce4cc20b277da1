"""The path of a solid while its stress is released: increment by increment, snaps followed.

Each increment starts from a quadratic extrapolation of the last three states. One that does not
converge is halved, and so is one that leads through unstable states or far from the extrapolation.
Where even a hundredth of the release does, the solid snaps, and `flow` leads to the next
equilibrium. An equilibrium that is not stable is left along its softest mode.

A guide tells displacements near those of some states (see `guide`). The step to such a state begins
from them, and from the distance to them so far. If that does not end nearby in a stable state, the
step is done again without a guide.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import Message
from simulearn.fea.flow import flow, leave
from simulearn.fea.problem import EquilibriumProblem, NotConvergedError, SolidState
from simulearn.schedule import Snap

Array = NDArray[np.float64]

SHORT = 0.25  # of an increment, its first part where there is no past to extrapolate
SNAP_STEP = 0.01  # of the release: to this a snap is located
FAR = 0.03  # of the solid's size: an equilibrium so far from its extrapolation is another branch
ASTRAY = (
    0.01  # of the size: an equilibrium so far from where a guide leads is not what it leads to;
)
# under gravity alone, where heavy slender grids of two meshes hang 2 % apart, it is `FAR`
GUIDED_ITERATIONS = 6  # at most, before a step is done without its guide


class Path:
    """States of a solid, each reached from the ones before.

    Args:
        problem: the equilibrium problem.
        states: to begin with; by default the flat solid.
        guide: (N, 3) mm, displacements near those at pairs of released fraction and gravity.

    Attributes:
        last: up to three states on the same smooth path.
        halved: increments that had to be halved.
        guided: increments that the guide led.
        snaps: sudden motions, in their order.
        motions: how far some part moved in each of them, mm.
        messages: what qualifies the states.
    """

    def __init__(
        self,
        problem: EquilibriumProblem,
        states: Sequence[SolidState] = (),
        guide: Mapping[tuple[float, float], Array] | None = None,
    ) -> None:
        self.problem = problem
        self.guide = guide or {}
        self.last = list(states) or [problem.flat()]
        self.halved = self.guided = 0
        self.snaps: list[Snap] = []
        self.motions: list[float] = []
        self.messages: list[Message] = []

    def restart(self) -> None:
        """Forget all but the last state, for what follows is no smooth continuation."""
        self.last = self.last[-1:]

    def advance(self, released: float, gravity: float, frame: int = 0) -> SolidState:
        """Go on to a released fraction and a multiple of gravity, and return the state there.

        Args:
            released: fraction of the residual stress, 0 to 1.
            gravity: multiple of gravity.
            frame: number of the frame that this leads to, for messages.

        Raises:
            ComputationError: no equilibrium was reached.
            CancelledError: the problem's token said so.
        """
        if state := self._guided(released, gravity):
            self.guided += 1
            self.last = [*self.last, state][-3:]
            return state
        goal = np.array([released, gravity])
        begin = np.array([self.last[-1].released, self.last[-1].gravity])
        release = released != self.last[-1].released
        least = 2.0**-self.problem.control.halvings
        if release:
            least = max(least, SNAP_STEP / abs(released - self.last[-1].released))
        blind = len(self.last) == 1 and release
        step, done = SHORT if blind else 1.0, 0.0
        while done < 1:
            to = min(done + step, 1.0)
            s, g = ((1 - to) * begin + to * goal).tolist()
            guess = extrapolated(self.last, s, g)
            state = self._near(guess)
            if state is None and to - done > least:
                self.halved += 1
                step = (to - done) / 2
                continue
            if state is None:
                if not release and self.last[-1].released == 0:
                    s, g, to = released, gravity, 1.0  # nothing is released: all the load at once
                self._snap(s, g, frame)
            elif state.negative:
                self._leave(state, frame)
            else:
                self.last = [*self.last, state][-3:]
            # After a success twice as far, after a snap a short step.
            step = SHORT * (1 - to) if len(self.last) == 1 and release else 2 * (to - done)
            done = to
        return self.last[-1]

    def _guided(self, s: float, g: float) -> SolidState | None:
        """Return the stable equilibrium to which the guide leads, None where it leads to none."""
        near = self.guide.get((s, g))
        last = [state for state in self.last if (state.released, state.gravity) in self.guide]
        if near is None or self.messages or not last or last[-1] is not self.last[-1]:
            return None
        # Distances to the guide are rougher than states, so that only two are extrapolated. The
        # carried stress knows nothing of the guide's, which would take more iterations.
        u = near.copy()
        for weight, state in zip(lagrange(last[-2:], s, g), last[-2:], strict=True):
            u += weight * (state.u - self.guide[state.released, state.gravity])
        u[self.problem.solid.fixed] = 0.0  # whatever a coarser mesh holds
        guess = SolidState(s, g, u, extrapolated(self.last, s, g).carried)
        try:
            state = self.problem.equilibrium(guess, most=GUIDED_ITERATIONS)
        except NotConvergedError:
            return None
        most = (ASTRAY if s else FAR) * self.problem.size
        return None if abs(state.u - u).max() > most or state.crossed or state.negative else state

    def _near(self, guess: SolidState) -> SolidState | None:
        """Return the equilibrium near an extrapolation, None where there is none."""
        try:
            state = self.problem.equilibrium(guess)
        except NotConvergedError:
            return None
        far = len(self.last) > 2 and abs(state.u - guess.u).max() > FAR * self.problem.size
        # Through an unstable stretch, or far from where the path led: another branch.
        return None if far or (state.crossed and state.stable) else state

    def _snap(self, s: float, g: float, frame: int) -> None:
        """Follow the flow from the last state to the equilibrium under another load."""
        before = self.last[-1]
        state = flow(self.problem, SolidState(s, g, before.u, before.carried))
        self.last = [state]
        motion = float(np.linalg.norm(state.u - before.u, axis=1).max())
        if before.released == s == 0:
            self._say(
                "hangs",
                f"the grid is so slender that it hangs down by up to {motion:.0f} mm under its own "
                "weight before any stress is released",
            )
        elif motion > FAR * self.problem.size:
            self.snaps.append(Snap(before.released, frame))
            self.motions.append(motion)
            when = f"at {100 * before.released:.1f} % of the stress released"
            if s == before.released:
                when = f"while it creeps, as under {before.gravity:.2f} times gravity"
            self._say(
                "snap",
                f"the grid snaps {when} (frame {frame}): some part of it moves by {motion:.0f} mm "
                "at once",
            )

    def _leave(self, balance: SolidState, frame: int) -> None:
        """Leave an unstable balance."""
        departure = leave(self.problem, balance)
        self.last = [departure.state]
        other = (
            "the opposite side is as likely, and leads to the mirrored shape"
            if departure.mirrored
            else "the opposite side leads to another shape"
        )
        self._say(
            "unstable-balance",
            f"at {100 * balance.released:.0f} % of the stress released (frame {frame}) the grid "
            f"stood on an unstable balance; it was left along its softest mode, {other}",
        )

    def _say(self, code: str, text: str) -> None:
        self.messages.append(Message(code, "grid", text))


def extrapolated(last: Sequence[SolidState], s: float, g: float) -> SolidState:
    """Return displacements and carried stress through up to three states (Lagrange)."""
    u = np.zeros_like(last[0].u)
    carried = np.zeros_like(last[0].carried)
    for weight, state in zip(lagrange(last, s, g), last, strict=True):
        u += weight * state.u
        carried += weight * state.carried
    return SolidState(s, g, u, carried)


def lagrange(last: Sequence[SolidState], s: float, g: float) -> list[float]:
    """Return the weights of states in the polynomial through them, at another load."""
    at, goal = [state.released + state.gravity for state in last], s + g
    return [
        float(np.prod([(goal - b) / (a - b) for j, b in enumerate(at) if j != i]))
        for i, a in enumerate(at)
    ]
