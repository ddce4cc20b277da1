"""A trial: the twelve frames of a morphing grid, by finite elements.

Stage 1 brings gravity up on the flat grid and then releases the residual stress in ten steps.
Stage 2 lets the grid creep: the load-driven part of the strain grows by the creep compliance,
the shrinkage-driven part does not. Dividing all elastic energy by 1 + phi does just that, and is
the same as multiplying gravity by 1 + phi (a quasi-elastic solution; see `docs/verification.md`).
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import Cancel, ComputationError, Message
from simulearn.fea.frames import UNDER_GRAVITY, march
from simulearn.fea.guide import guide_of
from simulearn.fea.kernels import entries
from simulearn.fea.laws import law_of
from simulearn.fea.layout import COARSE, Layout
from simulearn.fea.mesh import mesh
from simulearn.fea.path import Path
from simulearn.fea.problem import Control, EquilibriumProblem, SolidState
from simulearn.fea.solid import Solid
from simulearn.fea.stress import cauchy_stress, sample_points, sampled_stress
from simulearn.grid import Grid
from simulearn.material import Material
from simulearn.schedule import FRAMES, Snap

Array = NDArray[np.float64]

Progress = Callable[[int, int], None]  # (frames done, frames in all)


@dataclass(frozen=True, eq=False)
class Trial:
    """The frames of a grid (F of them, see `schedule`): flat, release, creep; mm, MPa, +z up.

    Attributes:
        joints: (F, J, 8, 3) corners of the joints.
        beams: (F, B, 3, 4, 3) corners of the beams' sections at start, middle and end.
        stress: (F, B, 4, 4, 6) components 11 22 33 12 13 23 in global axes.
        seconds: time it took.
        record: law, iterations a frame, halved increments, motions of snaps, size; on a mesh finer
            than the default also the `guide` (see `Guide.record`) and the steps that it led.
        solid: the solid.
        displacements: (F, N, 3) of its nodes.
        stable: whether all frames are stable equilibria, as far as the solver can tell.
        snaps: sudden motions to another equilibrium.
        warnings: what qualifies the answer.
    """

    joints: Array
    beams: Array
    stress: Array
    seconds: float
    record: dict[str, Any]
    solid: Solid
    displacements: Array
    stable: bool = True
    snaps: tuple[Snap, ...] = ()
    warnings: tuple[Message, ...] = ()

    @classmethod
    def of(
        cls,
        solid: Solid,
        displacements: Sequence[Array],
        stress: Sequence[Array],
        begun: float,
        record: dict[str, Any],
        stable: bool = True,
        snaps: Sequence[Snap] = (),
        warnings: Sequence[Message] = (),
    ) -> "Trial":
        """Return the trial of a solid's frames, begun at a time of `time.perf_counter`."""
        u = np.stack(displacements)
        at = solid.nodes + u
        return cls(
            joints=at[:, solid.joints],
            beams=at[:, solid.beams],
            stress=np.stack(stress),
            seconds=time.perf_counter() - begun,
            record=record,
            solid=solid,
            displacements=u,
            stable=stable,
            snaps=tuple(snaps),
            warnings=tuple(warnings),
        )


def simulate_grid(
    grid: Grid,
    material: Material,
    layout: Layout = COARSE,
    control: Control = Control(),
    progress: Progress | None = None,
    cancel: Cancel | None = None,
    factors: Array | None = None,
) -> Trial:
    """Simulate a grid in its bath; on a mesh finer than the default one with that one as a guide.

    Args:
        grid: a valid grid.
        material: its material system.
        layout: of the mesh.
        control: convergence settings.
        progress: called with (frames done, frames in all) after each frame; those of a guide count.
        cancel: token that stops the simulation within an iteration.
        factors: (B,) by which the released strains of beams differ from the material's.

    Raises:
        InputError: the grid cannot be meshed.
        ComputationError: an increment has no equilibrium, nor comes to rest elsewhere.
        CancelledError: the token said so.
    """
    begun = time.perf_counter()
    solid = mesh(grid, material, layout, factors)
    report = _Report(progress, layout.finer(COARSE))
    guide = None
    if layout.finer(COARSE):
        guide = guide_of(grid, material, layout, solid, factors, control, report.coarse, cancel)
    problem = EquilibriumProblem(
        solid, law_of(material.law), material.gravity.body_force, control=control, cancel=cancel
    )
    path = Path(problem, guide=guide.displacements if guide else {})
    frames: list[SolidState] = []
    spent: list[int] = []
    try:
        for place, state in enumerate(march(path, material.creep.amplitude)):
            if place == UNDER_GRAVITY:
                continue  # its iterations count for the first frame
            frames.append(state)
            spent.append(problem.iterations - sum(spent))
            report.frame()
    except ComputationError as error:
        where = f"frame {len(frames)}"
        raise ComputationError(
            f"{where} of {FRAMES - 1}: {error}", code=error.code, where=where, hint=error.hint
        ) from error

    creep = 1 + material.creep.amplitude
    stable = all(state.stable for state in frames)
    record = {
        "law": material.law.kind,
        "iterations": spent,
        "corrections": problem.corrections,
        "halved": path.halved,
        **({"guide": guide.record | {"steps": path.guided}} if guide else {}),
        "mesh": layout.name,
        "stable": stable,
        "snaps": [
            {"released": snap.released, "frame": snap.frame, "motion_mm": motion}
            for snap, motion in zip(path.snaps, path.motions, strict=True)
        ],
        "bricks": len(problem.solid.bricks),
        "unknowns": int(3 * (len(problem.solid.nodes) - len(problem.solid.fixed))),
    }
    return Trial.of(
        problem.solid,
        [state.u for state in frames],
        [
            _stress(problem, state, creep if frame == FRAMES - 1 else 1.0)
            for frame, state in enumerate(frames)
        ],
        begun,
        record,
        stable,
        path.snaps,
        path.messages,
    )


class _Report:
    """Reports the frames of a trial, and before it those of its guide.

    Args:
        progress: receives the reports.
        guided: whether there is a guide.
    """

    def __init__(self, progress: Progress | None, guided: bool) -> None:
        self._progress = progress
        self._done, self._before = 0, FRAMES if guided else 0

    def coarse(self) -> None:
        """Report a frame of the guide."""
        self._say(self._done + 1)

    def frame(self) -> None:
        """Report a frame; a guide that ended early counts as complete."""
        self._say(max(self._done, self._before) + 1)

    def _say(self, done: int) -> None:
        self._done = done
        if self._progress:
            self._progress(done, self._before + FRAMES)


def _stress(problem: EquilibriumProblem, state: SolidState, softening: float) -> Array:
    """Return the sampled stress of a frame whose elastic energy is divided by `softening`."""
    at = sample_points(problem.solid)
    s = state.released
    _, _, F, P, _ = entries.internal(problem.law, problem.bricks, state.u, s)
    cauchy = cauchy_stress(F[at], P[at]) / softening
    return sampled_stress(problem.solid, s, F[at], cauchy)
