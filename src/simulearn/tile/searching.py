"""The search for one module: from its patch's curvature, or on from an earlier answer.

What the engine gets wrong hardly changes from a design to its neighbours. So the search is for
targets that are moved by what finite elements found out about the last design, and ends with
another check. Where the module lies is free.

Joints alone leave open how beams run between them. So the middles of beams are wanted where the
patch's curvature has them, too, but count less.
"""

import hashlib
import json
from dataclasses import asdict, dataclass, replace
from time import monotonic
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import ComputationError, InputError
from simulearn.grid import Grid, grid_from_dict, grid_to_dict, lattice
from simulearn.inverse.checking import check
from simulearn.inverse.goals import Goals, Vertex
from simulearn.inverse.newton import descent
from simulearn.inverse.problem import OutOfTime, Problem, Scored
from simulearn.inverse.relaxing import relaxed, rounded
from simulearn.inverse.scoring import places
from simulearn.inverse.space import Space
from simulearn.inverse.task import Free
from simulearn.material import Material
from simulearn.rigid import Place
from simulearn.simulate import engine as engine_of
from simulearn.simulate.learned import Learned
from simulearn.tile.starting import start

Array = NDArray[np.float64]

VERSION = 2  # raise it when a search answers differently, so that older answers are not taken
GOOD = 0.05  # mm by the engine, where a search ends
CORRECTED = 0.15  # mm by finite elements, above which the search may go on from a check
WORTH = 0.3  # of the error, that the engine must be off by for that
TRIES = 3  # starts where an answer is not near, or not near enough to its neighbours
NEAR = 0.25  # mm
SECONDS = 120.0  # of one search, at most
MIDDLE = 0.05  # weight of the middle of a beam; a joint's is 1 or more
SPREAD = 0.3  # of ratios, of starts after the first


@dataclass(frozen=True)
class ModuleJob:
    """What a worker computes, in plain data that travels to other machines.

    Attributes:
        targets: (K, 3) mm, of the joints.
        normals: (K, 3) of the surface there.
        cells: of the module.
        weights: (K,) of the targets.
        material: the material system.
        engine: "learned" or "beams".
        model: of the engine; None: its default.
        ratio: step of the ratios.
        grid: the design to go on from, as in a grid file; None begins with the curvature.
        shift: (K + B, 3) mm, of joints and middles of beams from finite elements to the engine, of
            that design.
        corrections: how often to go on from a check.
    """

    targets: list[list[float]]
    normals: list[list[float]]
    cells: tuple[int, int]
    weights: list[float]
    material: dict[str, Any]
    engine: str
    model: str | None
    ratio: float
    grid: dict[str, Any] | None = None
    shift: list[list[float]] | None = None
    corrections: int = 1

    @property
    def key(self) -> str:
        """The name under which the answer is kept."""
        contents = {"version": VERSION, **asdict(self)}
        text = json.dumps(contents, sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()[:32]


@dataclass(frozen=True)
class ModuleAnswer:
    """The answer to a job, in plain data.

    Attributes:
        grid: the design, as in a grid file; None where there is none.
        joints: (K, 3) mm, centres, seen from the fixed joint; by finite elements where `checked`.
        beams: (B, 3, 3) mm, centres of sections start, middle, end; likewise.
        shift: (K + B, 3) mm, of joints and middles from finite elements to the engine.
        checked: whether finite elements answered.
        error_mm: mean distance from the targets, in the best place.
        engine_mm: the same by the engine.
        why: why there is no design, or no check.
        designs: that were simulated.
        checks: by finite elements.
        seconds: that it took.
    """

    grid: dict[str, Any] | None
    joints: list[list[float]] | None = None
    beams: list[list[list[float]]] | None = None
    shift: list[list[float]] | None = None
    checked: bool = False
    error_mm: float = float("inf")
    engine_mm: float = float("inf")
    why: str = ""
    designs: int = 0
    checks: int = 0
    seconds: float = 0.0


def run(job: ModuleJob) -> ModuleAnswer:
    """Search for a module; whatever goes wrong is an answer, too."""
    begun = monotonic()
    try:
        answer = _Search(job, begun).run()
    except (ComputationError, InputError) as error:
        answer = ModuleAnswer(None, why=str(error))
    except Exception as error:
        answer = ModuleAnswer(None, why=f"{type(error).__name__}: {error}")
    return replace(answer, seconds=round(monotonic() - begun, 3))


class _Search:
    def __init__(self, job: ModuleJob, begun: float) -> None:
        engine = engine_of(job.engine, job.model)
        assert isinstance(engine, Learned)
        self.job, self.engine, self.until = job, engine, begun + SECONDS
        self.material = Material.model_validate(job.material)
        self.targets, self.weights = np.array(job.targets), np.array(job.weights)
        self.weights = self.weights / self.weights.sum()
        self.lattice = lattice(job.cells, 1.0)
        self.start = start(
            self.targets,
            np.array(job.normals),
            self.lattice,
            self.material,
            job.engine,
            job.model,
        )
        self.goals = self._goals()
        self.designs = self.checks = 0

    def run(self) -> ModuleAnswer:
        job = self.job
        shift = np.zeros((len(self.goals), 3)) if job.shift is None else np.array(job.shift)
        if job.grid is None:
            space = self._space(self._flat())
            now = self._best_of(space, space.start[0], self.start.ratios, shift, NEAR)
        else:  # it did not come near enough: from elsewhere, too
            space = self._space(
                grid_from_dict(job.grid, materials={self.material.name: self.material})
            )
            now = self._best_of(space, *space.start, shift, 0.0)
        best = None
        for k in range(job.corrections + 1):
            answer = self._checked(space.grid_at(now.x, now.a), now.points, shift)
            if best is None or answer.error_mm < best.error_mm:
                best = answer
            after = np.array(answer.shift)
            off = float(np.linalg.norm(after - shift, axis=1).mean())
            if k == job.corrections or answer.error_mm < CORRECTED or off < WORTH * answer.error_mm:
                break
            shift = after
            now = self._nearer(space, now.x, now.a, shift)
        assert best is not None
        return replace(best, designs=self.designs, checks=self.checks)

    def _best_of(self, space: Space, x: Array, a: Array, shift: Array, near: float) -> Scored:
        """Return the best design of searches from a point and from others around it.

        Args:
            space: of the designs.
            x: the point's joints.
            a: its ratios.
            shift: (K + B, 3) mm, from finite elements to the engine.
            near: mm, an error below which no other search is begun.

        Raises:
            ComputationError: the engine has no answer.
        """
        source = np.random.default_rng(int(self.job.key[:8], 16))
        best: Scored | None = None
        for k in range(TRIES):
            begin = a + (SPREAD * source.standard_normal(len(a)) if k else 0.0)
            now = self._nearer(space, x, np.clip(begin, -1, 1), shift)
            if best is None or now.error < best.error:
                best = now
            if best.error < near or monotonic() > self.until:
                break
        assert best is not None
        if not np.isfinite(best.error):
            text = f"the engine {self.job.engine} has no answer near the patch's own shape"
            raise ComputationError(text, "no-answer", "grid")
        return best

    def _flat(self) -> Grid:
        plain = self.lattice
        passive = np.zeros(len(plain.beams))
        return Grid(self.start.joints, plain.beams, passive, plain.fixed, self.material)

    def _space(self, grid: Grid) -> Space:
        return Space.of(grid, Free(ratio=self.job.ratio), self.engine.training)

    def _nearer(self, space: Space, x: Array, a: Array, shift: Array) -> Scored:
        """Return the best design near a point, wherever it is put."""
        free = self.goals.shifted(shift)
        simulated = places(self.engine, free)
        points = simulated(space.designs(x[None], a[None]))[0]
        if not np.isfinite(points).all():  # as flat as it is printed
            flat = np.c_[space.designs(x[None], a[None]).flat[0], np.zeros(len(self.targets))]
            points = np.concatenate([flat, flat[self.lattice.beams].mean(axis=1)])
        model = self.engine.bundle.model
        problem = Problem(space, free.begun(points), simulated, model=model, until=self.until)
        problem.best = problem.scored(x, space.nearest(x, a))
        try:
            steps = list(relaxed(problem, x, a))
            if steps:
                rounded(problem, *steps[-1])
            if np.isfinite(problem.best.error):
                for _ in descent(problem, problem.best):
                    if problem.best.error < GOOD:
                        break
        except OutOfTime:
            pass
        self.designs += problem.designs
        return problem.best

    def _goals(self) -> Goals:
        """Return what is wanted of joints and middles, wherever the module is put."""
        joints = Goals.centres(self.targets).vertices
        middles = tuple(Vertex("beam", b, section=1) for b in range(len(self.lattice.beams)))
        counts = np.r_[self.weights * len(joints), np.full(len(middles), MIDDLE)]
        wanted = np.concatenate([self.targets, self.start.middles])
        return Goals.together(Goals.of((*joints, *middles), wanted, counts).parts, pose=Place())

    def _away(self, points: Array) -> float:
        """Return how far joints (K, 3) are from their targets in the best place, mm."""
        place = Place.fitting(points, self.targets)
        away = np.linalg.norm(place(points) - self.targets, axis=1)
        return float(away @ self.weights)

    def _checked(self, grid: Grid, points: Array, shift: Array) -> ModuleAnswer:
        """Return a design with what finite elements say of it."""
        self.checks += 1
        one = check(grid, points, self.goals, self.engine)
        shape = one.shape
        if shape is None:
            raise ComputationError(one.why or "the design has no answer", "no-answer", "grid")
        by_engine = (points - shift)[: len(self.targets)]
        joints = by_engine if one.fea is None else shape.centres[-1]
        return ModuleAnswer(
            grid_to_dict(grid),
            joints.tolist(),
            shape.beams[-1].mean(axis=2).tolist(),
            (shift if one.shift is None else one.shift).tolist(),
            one.fea is not None,
            self._away(joints),
            self._away(by_engine),
            one.why,
        )
