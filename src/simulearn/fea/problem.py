"""The equilibrium problem of one solid: its bricks, loads and factors, and one iteration of it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import Cancel, stop_if
from simulearn.fea.fronts import fronts_of
from simulearn.fea.kernels import entries
from simulearn.fea.kernels.law import ConstitutiveLaw
from simulearn.fea.points import bricks_of
from simulearn.fea.solid import Solid

Array = NDArray[np.float64]

# A step below this part of the grid's size (mm per mm) is corrected with the factors at hand: they
# differ from the new ones by about that part, so each correction gains as many digits.
NEAR = 2e-4
REST = 3e-3  # of the tolerance: largest last correction
# Residual over the forces of the bricks, root of the sums of squares, at which it is balanced.
BALANCED = 1e-3
# Largest difference of the stress in the factors from the final one, relative: if it is larger, the
# negative pivots do not tell whether the equilibrium is stable.
DRIFT = 0.05
MODE_ITERATIONS = 12
GROWTH = 100  # of a step over the least one: it diverges


@dataclass(frozen=True)
class Control:
    """When an increment has converged, and when to give up.

    Attributes:
        tolerance: of displacements, mm in a grid of 100 mm, in proportion in others. The last
            correction is below `REST` of it, and the forces are balanced to `BALANCED`.
        iterations: at most, in one increment.
        halvings: at most, of one increment.
        mixed: carry the stress as an own unknown; without, it is plain Newton.
    """

    tolerance: float = 1e-4
    iterations: int = 15
    halvings: int = 6
    mixed: bool = True


@dataclass(frozen=True, eq=False)
class SolidState:
    """A solid in equilibrium.

    Attributes:
        released: fraction of the residual stress that is released.
        gravity: multiple of gravity.
        u: (N, 3) mm, displacements of the nodes.
        carried: (M, 6) MPa, second Piola-Kirchhoff stress at the points, in the grown state, order
            11 22 33 12 13 23.
        negative: number of negative eigenvalues of the stiffness.
        crossed: whether the iteration came through displacements where the stiffness had some.
    """

    released: float
    gravity: float
    u: Array
    carried: Array
    negative: int = 0
    crossed: bool = False

    @property
    def stable(self) -> bool:
        """Whether the stiffness is positive definite, so that nothing buckles."""
        return self.negative == 0


class NotConvergedError(Exception):
    """An increment reached no equilibrium, for the reason given."""


class EquilibriumProblem:
    """The equilibrium problem of one solid.

    Args:
        solid: the solid.
        law: its constitutive law.
        body_force: weight per volume towards -z, N/mm3.
        forces: (N, 3) further dead loads, N, scaled with gravity.
        control: convergence settings.
        cancel: token that stops the computation.

    Attributes:
        load: (N, 3) N, dead loads under one gravity.
        size: largest extent of the solid, mm.
        iterations: factorisations so far.
        corrections: steps with factors at hand so far.
    """

    def __init__(
        self,
        solid: Solid,
        law: ConstitutiveLaw,
        body_force: float,
        forces: Array | None = None,
        control: Control = Control(),
        cancel: Cancel | None = None,
    ) -> None:
        self.solid, self.law, self.control, self.cancel = solid, law, control, cancel
        self.bricks, volumes, self.mass = bricks_of(solid)
        self.fronts = fronts_of(solid)
        self.load = np.zeros_like(solid.nodes)
        self.load[:, 2] = -body_force * volumes
        if forces is not None:
            self.load += forces
        self.size = float(np.ptp(solid.nodes, axis=0).max())
        self.iterations = self.corrections = 0
        # Stress (MPa) and force (N) that are nothing: rounding in a solid without loads.
        self._rounding = 1e-12 * (law.first + 2 * law.shear)
        self._nothing = self._rounding * self.size**2
        self._factors = np.empty(self.fronts.factors[-1])
        self._pivots = np.empty(self.fronts.pivots[-1])

    def flat(self) -> SolidState:
        """Return the solid as printed: nothing released, no gravity."""
        stress = np.zeros((self.bricks.volumes.size, 6))
        return SolidState(0.0, 0.0, np.zeros_like(self.solid.nodes), stress)

    def factor(
        self,
        u: Array,
        released: float,
        carried: Array,
        load: Array,
        viscosity: float = 0.0,
        mixed: bool = True,
    ) -> tuple[Array, int]:
        """Factor the stiffness at a state and return the step that the forces out of balance cause.

        Args:
            u: (N, 3) displacements, mm.
            released: fraction of the residual stress.
            carried: (M, 6) stress of the geometric stiffness, MPa.
            load: (N, 3) N.
            viscosity: that the lumped volumes are multiplied by, on the diagonal, N/mm per mm3.
            mixed: whether the carried stress is used, or that of the displacements.

        Returns:
            the step (N, 3) mm, and the number of negative eigenvalues.
        """
        step, negative = entries.factor(
            self.law,
            self.bricks,
            self.fronts,
            u,
            released,
            carried,
            mixed,
            load,
            viscosity * self.mass,
            self._factors,
            self._pivots,
        )
        return step, int(negative)

    def solve(self, load: Array) -> Array:
        """Return the displacements (N, 3) that a load (N, 3) causes, with the last factors."""
        step: Array = entries.solve(self.fronts, self._factors, self._pivots, load)
        return step

    def equilibrium(
        self,
        start: SolidState,
        viscosity: float = 0.0,
        origin: Array | None = None,
        most: int | None = None,
    ) -> SolidState:
        """Return the equilibrium near a state, under that state's released fraction and gravity.

        Args:
            start: where to begin; it need not be in equilibrium.
            viscosity: resistance c to motion away from `origin`, N/mm per mm3; see `flow`.
            origin: (N, 3) mm, displacements that it resists to leave.
            most: iterations at most, if fewer than the control's.

        Raises:
            NotConvergedError: none was reached.
            CancelledError: the token said so.
        """
        control, s = self.control, start.released
        u, carried = start.u, start.carried
        least = change = np.inf
        crossed = False
        for _ in range(min(control.iterations, most or control.iterations)):
            stop_if(self.cancel)
            self.iterations += 1
            load = self._external(u, start.gravity, viscosity, origin)
            step, negative = self.factor(u, s, carried, load, viscosity, control.mixed)
            crossed |= negative > 0
            factored = carried
            change = _largest(step)
            if not change < min(GROWTH * least, 100 * self.size):
                break
            least = min(least, change)
            carried = entries.carry(self.law, self.bricks, u, step, s)
            u = u + step
            if change < NEAR * self.size:
                u, carried, change, done = self._correct(u, start, viscosity, origin, change)
                # Where the factors know nothing of the stress, their pivots do not tell.
                drift = abs(carried - factored).max()
                known = not control.mixed or drift < DRIFT * abs(carried).max() + self._rounding
                if done and known:
                    return SolidState(s, start.gravity, u, carried, negative, crossed)
        raise NotConvergedError(f"the last iteration still moved it by {change:.2g} mm")

    def _correct(
        self, u: Array, start: SolidState, viscosity: float, origin: Array | None, change: float
    ) -> tuple[Array, Array, float, bool]:
        """Correct displacements with the factors at hand as long as that converges fast.

        Args:
            u: (N, 3) mm, after a full step.
            start: the state that says what is released and what gravity acts.
            viscosity: see `equilibrium`.
            origin: see `equilibrium`.
            change: largest component of the full step, mm.

        Returns:
            displacements, their stress S (M, 6), the last change (mm), and whether it is the end.
        """
        end = REST * self.control.tolerance * self.size / 100
        while True:
            forces, stress, _, _, scale = entries.internal(self.law, self.bricks, u, start.released)
            out = self._external(u, start.gravity, viscosity, origin) - forces
            out[self.solid.fixed] = 0.0
            balanced = np.sqrt((out * out).sum()) < BALANCED * scale + self._nothing
            step = self.solve(out)
            self.corrections += 1
            before, change = change, _largest(step)
            if not (change < end or change < before):
                return u, stress, change, False
            u = u + step
            # They converge linearly, so what is left is a part of the last one.
            if (change < end and balanced) or not change < before / 5:
                return u, stress, change, change < end and balanced

    def _external(self, u: Array, gravity: float, viscosity: float, origin: Array | None) -> Array:
        """Return the load (N, 3) at displacements u, with the viscous resistance, N."""
        load = gravity * self.load
        if origin is not None:
            load -= viscosity * self.mass[:, None] * (u - origin)
        return load

    def soft_modes(self, many: int) -> tuple[Array, Array]:
        """Return the eigenvalues nearest zero of the stiffness last factored, and their modes.

        They are those of K x = l M x with the lumped volumes M, by subspace iteration with the
        factors at hand.

        Args:
            many: how many are wanted; a few more are iterated.

        Returns:
            eigenvalues (many,) in N/mm per mm3; modes (many, N, 3), their largest component one.
        """
        shape = (many + 4, *self.load.shape)
        x = np.random.default_rng(0).normal(size=shape)
        mass = self.mass[:, None]
        for _ in range(MODE_ITERATIONS):
            y = np.stack([self.solve(mass * v) for v in x])
            inner = np.einsum("ank,bnk->ab", y * mass, y)
            low, turn = np.linalg.eigh(inner)
            x = np.einsum("ab,ank->bnk", turn / np.sqrt(np.maximum(low, 1e-300)), y)
        y = np.stack([self.solve(mass * v) for v in x])
        inverse, turn = np.linalg.eigh(np.einsum("ank,bnk->ab", x * mass, y))
        order = np.argsort(-abs(inverse))[:many]
        modes = np.einsum("ab,ank->bnk", turn[:, order], x)
        return 1 / inverse[order], modes / abs(modes).max(axis=(1, 2), keepdims=True)


def _largest(step: Array) -> float:
    """Return the largest component of a step, infinity where it is not finite."""
    size = float(abs(step).max())
    return size if np.isfinite(size) else np.inf
