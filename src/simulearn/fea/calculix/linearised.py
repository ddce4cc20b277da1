"""Any law, by linear ones: CalculiX finds the equilibrium of a law that it does not have.

At a state E_k, with stress S_k and moduli D of the law, CalculiX is given the linear law
S = D : (E - E0) with E0 = E_k - D^-1 : S_k, which is the law's own tangent there. It answers with
displacements in full geometric nonlinearity, which are the next state, until they stay. Then its
equilibrium holds with S = S_k, the law itself, whatever D was. So D may be what CalculiX can take:
one for each brick, the mean of its points; E0 is exact at each point.

Elements, kinematics, equilibrium and load are CalculiX's; the law is ours (see `moduli`).
"""

from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import ComputationError
from simulearn.fea.calculix import deck
from simulearn.fea.calculix.brick import matching
from simulearn.fea.calculix.moduli import COLUMN, ROW, moduli_of
from simulearn.fea.calculix.output import read_dat, read_sta
from simulearn.fea.calculix.process import Ccx, NotConvergedError
from simulearn.fea.calculix.schedule import Step
from simulearn.fea.calculix.state import Report, StepResult
from simulearn.fea.kernels.law import ConstitutiveLaw
from simulearn.fea.points import bricks_of
from simulearn.fea.solid import Solid

Array = NDArray[np.float64]
Past = list[tuple[Step, Array]]

SHEARS = np.array([1, 1, 1, 2, 2, 2])  # engineering over tensor strain
# CalculiX's 21 constants: the upper triangle of D, column by column.
TRIANGLE = np.array([(i, j) for j in range(6) for i in range(j + 1)]).T

CHANGE = 1e-3  # mm by which the last run may still move a node
MOST_RUNS = 20
MOST_HALVINGS = 4


def solve(
    ccx: Ccx, solid: Solid, law: ConstitutiveLaw, steps: Sequence[Step], report: Report
) -> list[StepResult]:
    """Return the state at the end of each step.

    Args:
        ccx: CalculiX in its folder.
        solid: the solid.
        law: its constitutive law.
        steps: what to compute.
        report: called with the steps that are done.

    Raises:
        InputError: the solid's integration points are not CalculiX's.
        ComputationError: CalculiX failed, or found no equilibrium.
    """
    problem = _Problem(ccx, solid, law)
    past: Past = [(Step(0.0, 0.0, 0), np.zeros_like(solid.nodes))]
    states = []
    for k, step in enumerate(steps):
        states.append(_advance(problem, past, step, MOST_HALVINGS))
        report(steps[: k + 1])
    return states


def _advance(problem: "_Problem", past: Past, step: Step, halvings: int) -> StepResult:
    """Solve a step: from an extrapolation, else from the last state, else in halves."""
    reason: NotConvergedError
    for start in _starts(past, step):
        try:
            state = problem.equilibrium(step, start)
        except NotConvergedError as error:
            reason = error
        else:
            past.append((step, state.displacements))
            return state
    if not halvings:
        raise ComputationError(f"at {100 * step.release:.1f} % released: {reason}") from reason
    last = past[-1][0]
    middle = Step((last.release + step.release) / 2, (last.load + step.load) / 2, None)
    half = _advance(problem, past, middle, halvings - 1)
    rest = _advance(problem, past, step, halvings - 1)
    counts = half.iterations + rest.iterations, half.runs + rest.runs
    return StepResult(rest.displacements, rest.stress, *counts)


def _starts(past: Past, step: Step) -> Iterator[Array]:
    """Yield an extrapolation through three past states under the same load, and the last state."""
    known = [(at.release, u) for at, u in past if at.load == step.load][-3:]
    if len(known) == 3:
        u = np.zeros_like(known[0][1])
        for s, value in known:
            u += value * np.prod([(step.release - t) / (s - t) for t, _ in known if t != s])
        yield u
    yield past[-1][1]


class _Problem:
    """A solid and its law, for CalculiX to solve at one state after the other."""

    def __init__(self, ccx: Ccx, solid: Solid, law: ConstitutiveLaw) -> None:
        bricks, _, _ = bricks_of(solid)
        c, s = bricks.axis.T
        zero, one = np.zeros_like(c), np.ones_like(c)
        frames = np.stack([[c, s, zero], [-s, c, zero], [zero, zero, one]]).transpose(2, 0, 1)
        self.ccx = ccx
        self.solid = solid
        self.moduli = moduli_of(law)
        self.gradients = bricks.gradients
        self.frames = np.repeat(frames, len(solid.weights), axis=0)
        self.growth = bricks.growth.reshape(-1, 3)
        self.place = np.argsort(matching(solid.points))  # of CalculiX's points among ours
        self.mesh = list(deck.mesh(solid))

    def equilibrium(self, step: Step, u: Array) -> StepResult:
        """Return the equilibrium of a step, sought from displacements u (N, 3).

        Raises:
            NotConvergedError: there is none, or none near enough.
        """
        iterations = 0
        for run in range(1, MOST_RUNS + 1):
            linear = self._linear(step.release, u)
            with self.ccx.path("inp").open("w", encoding="ascii") as file:
                file.writelines(self.mesh)
                file.writelines(_cards(*linear, u, step.load))
            self.ccx.run()
            moves, stresses = read_dat(self.ccx.path("dat"), len(u), len(self.solid.bricks))
            if not moves or not stresses:
                raise ComputationError("CalculiX wrote no result")
            iterations += sum(row[2] for row in read_sta(self.ccx.path("sta")))
            change = np.linalg.norm(moves[-1] - u, axis=1).max()
            u = moves[-1]
            if change < CHANGE:
                return StepResult(u, stresses[-1], iterations, run)
        raise NotConvergedError(f"still moving by {change:.2g} mm after {MOST_RUNS} runs")

    def _linear(self, release: float, u: Array) -> tuple[Array, Array]:
        """Return D (E, 6, 6) and E0 (E, 8, 6) at CalculiX's points, tensor strain."""
        H = np.einsum("enk,eqin->eqki", u[self.solid.bricks], self.gradients)
        E = ((H + H.swapaxes(2, 3) + H.swapaxes(2, 3) @ H) / 2)[..., ROW, COLUMN] * SHEARS
        S, D = self.moduli(E.reshape(-1, 6), self.frames, 1 + release * self.growth)
        stress = np.asarray(S).reshape(E.shape)
        mean = np.einsum("eqij,q->eij", np.asarray(D).reshape(*E.shape, 6), self.solid.weights)
        if not (np.isfinite(mean).all() and np.isfinite(stress).all()):
            raise NotConvergedError("a brick folded over")
        start = E - np.linalg.solve(mean[:, None], stress[..., None])[..., 0]
        return mean, (start / SHEARS)[:, self.place]


def _cards(moduli: Array, strain: Array, u: Array, load: float) -> Iterable[str]:
    for k, constants in enumerate(moduli[:, *TRIANGLE]):
        yield f"*MATERIAL, NAME=BRICK{k}\n*ELASTIC, TYPE=ANISO\n"
        for part in (constants[:8], constants[8:16], constants[16:]):
            yield f"{deck.numbers(part)}{',' if len(part) == 8 else ''}\n"
        yield deck.DENSITY
        yield from deck.elements(f"SET{k}", [k])
        yield f"*SOLID SECTION, ELSET=SET{k}, MATERIAL=BRICK{k}\n"
    yield "*INITIAL CONDITIONS, TYPE=PLASTIC STRAIN\n"
    yield from deck.strains(strain)
    yield "*INITIAL CONDITIONS, TYPE=DISPLACEMENT\n"
    for k, move in enumerate(u, 1):
        yield from (f"{k}, {axis}, {deck.numbers([x])}\n" for axis, x in enumerate(move, 1))
    yield deck.begin(strained=True) + deck.gravity(load) + deck.PRINT + deck.END
