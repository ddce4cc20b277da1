"""Equilibrium of a solid along a path of released fraction and gravity.

Each increment starts from a quadratic extrapolation of the last three states and iterates with the
mixed Newton method of `kernel`. An increment that does not converge is halved, down to a limit,
beyond which the computation fails and says where: there is never a wrong answer.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray
from threadpoolctl import ThreadpoolController

from simulearn.errors import ComputationError
from simulearn.fea import elimination
from simulearn.fea.kernel import Points, Response, carry, points_of, respond
from simulearn.fea.laws import Law
from simulearn.fea.solid import Solid
from simulearn.fea.structure import Structure, structure_of

Array = NDArray[np.float64]

# The matrices are small: several threads only wait for each other, the more so beside other work.
BLAS = ThreadpoolController()


@dataclass(frozen=True)
class Control:
    """When an increment has converged, and when to give up.

    Attributes:
        tolerance: largest change of a displacement in the last iteration, mm. Convergence is
            quadratic: what is left after it is far smaller.
        iterations: at most, in one increment.
        halvings: at most, of one increment.
        mixed: carry the stress as an own unknown; without, it is plain Newton.
    """

    tolerance: float = 1e-4
    iterations: int = 15
    halvings: int = 6
    mixed: bool = True


@dataclass(frozen=True, eq=False)
class State:
    """A solid in equilibrium.

    Attributes:
        released: fraction of the residual stress that is released.
        gravity: multiple of gravity.
        u: (N, 3) mm, displacements of the nodes.
        carried: (3, 3, M) MPa, second Piola-Kirchhoff stress at the points, in the grown state.
        stable: whether the stiffness is positive definite, so that it does not buckle.
    """

    released: float
    gravity: float
    u: Array
    carried: Array
    stable: bool = True


class NotConvergedError(Exception):
    """An increment found no equilibrium, for the reason given."""


@dataclass(eq=False)
class Equilibrium:
    """The equilibrium problem of one solid.

    Attributes:
        solid: the solid.
        law: its constitutive law.
        body_force: weight per volume towards -z, N/mm3.
        forces: (N, 3) further dead loads, N, scaled with gravity.
        control: convergence settings.
        iterations: spent so far.
        halved: increments that had to be halved so far.
    """

    solid: Solid
    law: Law
    body_force: float
    forces: Array | None = None
    control: Control = field(default_factory=Control)
    iterations: int = 0
    halved: int = 0

    def __post_init__(self) -> None:
        self.points: Points = points_of(self.solid)
        self.structure, self.skeleton = structure_of(self.solid)
        self.load = np.zeros_like(self.solid.nodes)
        self.load[:, 2] = -self.body_force * np.bincount(
            self.solid.bricks.ravel(), np.asarray(self.points.load).ravel(), len(self.load)
        )
        if self.forces is not None:
            self.load += self.forces

    def flat(self) -> State:
        """Return the solid as printed: nothing released, no gravity."""
        points = self.points.volumes.size
        return State(0.0, 0.0, np.zeros_like(self.solid.nodes), np.zeros((3, 3, points)))

    def advance(self, past: Sequence[State], released: float, gravity: float) -> list[State]:
        """Return the states on the way from the last of `past` to the given one, the last included.

        Args:
            past: states on the same smooth path, for extrapolation; at least one.
            released: fraction of the residual stress to be released, 0 to 1.
            gravity: multiple of the body force.

        Raises:
            ComputationError: no equilibrium was found, however small the increment.
        """
        with BLAS.limit(limits=1, user_api="blas"):
            return self._advance(list(past), released, gravity)[len(past) :]

    def _advance(self, path: list[State], released: float, gravity: float) -> list[State]:
        # Release without a past to extrapolate from begins with a short step.
        blind = len(path) == 1 and released != path[-1].released
        step, done = (0.25 if blind else 1.0), 0.0
        start = np.array([path[-1].released, path[-1].gravity])
        goal = np.array([released, gravity])
        reason = ""
        while done < 1:
            to = min(done + step, 1.0)
            s, g = (1 - to) * start + to * goal
            try:
                path.append(self._increment(path, float(s), float(g)))
                done = to
                step = 1.0 - done
            except NotConvergedError as error:
                reason = str(error)
                step /= 2
                self.halved += 1
                if step < 2.0**-self.control.halvings:
                    raise ComputationError(
                        f"no equilibrium beyond {100 * path[-1].released:.1f} % of the stress "
                        f"released under {path[-1].gravity:.2f} times gravity: {reason}, even "
                        f"with the increment halved {self.control.halvings} times"
                    ) from error
        return path

    def _increment(self, path: list[State], s: float, g: float) -> State:
        u, carried = _extrapolate(path, s, g)
        least = 100.0  # mm
        for _ in range(self.control.iterations):
            stress = carried if self.control.mixed else None
            u, carried, change, stable = self._iterate(u, s, stress, g * self.load)
            self.iterations += 1
            if change < self.control.tolerance:
                return State(s, g, np.asarray(u), np.asarray(carried), stable)
            if not change < 100 * least:
                break
            least = min(least, change)
        raise NotConvergedError(f"the last iteration still moved it by {change:.2g} mm")

    def _iterate(
        self, u: Array, s: float, carried: Array | None, load: Array
    ) -> tuple[Array, Array, float, bool]:
        """Return displacements, stress, largest change (mm) and whether the tangent is definite."""
        for definite in (True, False):
            response, condensed, out = _reduce(
                self.law,
                self.points,
                self.structure,
                u,
                s,
                carried,
                load,
                self.solid.bricks,
                definite,
            )
            beams = np.asarray(condensed.beams)
            if not definite or np.isfinite(beams).all():
                break
        nodes = self.structure.blocks
        try:
            joints, stable = elimination.solve_joints(
                self.skeleton,
                np.array(condensed.blocks),
                beams,
                np.asarray(condensed.rest),
                np.asarray(out)[nodes].reshape(len(nodes), -1),
            )
        except (np.linalg.LinAlgError, ValueError) as error:
            raise NotConvergedError("the stiffness is singular") from error
        u, carried, change = _update(
            self.points, self.structure, response, condensed.levels, joints, u, s, self.solid.bricks
        )
        return u, carried, float(change), definite and stable


@partial(jax.jit, static_argnames="definite")
def _reduce(
    law: Law,
    points: Points,
    structure: Structure,
    u: jax.Array,
    s: float,
    carried: jax.Array | None,
    load: jax.Array,
    bricks: jax.Array,
    definite: bool,
) -> tuple[Response, elimination.Condensed, jax.Array]:
    """Return the bricks' response, the system on the joints, and the forces out of balance."""
    response = respond(law, points, u[bricks], s, carried)
    out = load.at[bricks].add(-response.residual)
    return response, elimination.condense(structure, response.entries, out, definite), out


@jax.jit
def _update(
    points: Points,
    structure: Structure,
    response: Response,
    levels: list[elimination.Level],
    joints: jax.Array,
    u: jax.Array,
    s: jax.Array | float,
    bricks: jax.Array,
) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Return displacements and carried stress after an iteration, and its largest change."""
    du = elimination.expand(structure, levels, joints, len(u))
    change = jnp.where(jnp.isfinite(du).all(), abs(du).max(), jnp.inf)
    return u + du, carry(points, response, du[bricks], s), change


def _extrapolate(path: list[State], s: float, g: float) -> tuple[Array, Array]:
    """Extrapolate displacements and carried stress through up to three states (Lagrange)."""
    last = path[-3:]
    place = lambda state: state.released + state.gravity  # noqa: E731
    at, goal = [place(state) for state in last], s + g
    weights = [
        np.prod([(goal - b) / (a - b) for j, b in enumerate(at) if j != i])
        for i, a in enumerate(at)
    ]
    u = sum(w * state.u for w, state in zip(weights, last, strict=True))
    carried = sum(w * state.carried for w, state in zip(weights, last, strict=True))
    return np.asarray(u), np.asarray(carried)
