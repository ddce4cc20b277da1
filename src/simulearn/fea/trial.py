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

from simulearn.compiled import make_room
from simulearn.errors import ComputationError
from simulearn.fea.equilibrium import Control, Equilibrium, State
from simulearn.fea.laws import law_of
from simulearn.fea.mesh import COARSE, Layout, mesh
from simulearn.fea.solid import Solid
from simulearn.fea.stress import cauchy_stress, sampled_stress
from simulearn.grid import Grid
from simulearn.material import Material

Array = NDArray[np.float64]

STEPS = 10  # of stage 1
FRAMES = STEPS + 2  # flat, stage 1, creep

Progress = Callable[[int, int], None]


@dataclass(frozen=True, eq=False)
class Trial:
    """The twelve frames of a grid: flat, ten of release, one after creep; mm, MPa, +z up.

    Attributes:
        joints: (12, J, 8, 3) corners of the joints.
        beams: (12, B, 3, 4, 3) corners of the beams' sections at start, middle and end.
        stress: (12, B, 4, 4, 6) components 11 22 33 12 13 23 in global axes.
        seconds: time it took.
        record: law, iterations a frame, halved increments, whether all frames are stable, size.
        solid: the solid.
        displacements: (12, N, 3) of its nodes.
    """

    joints: Array
    beams: Array
    stress: Array
    seconds: float
    record: dict[str, Any]
    solid: Solid
    displacements: Array

    @classmethod
    def of(
        cls,
        solid: Solid,
        displacements: Sequence[Array],
        stress: Sequence[Array],
        begun: float,
        record: dict[str, Any],
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
        )


def simulate_grid(
    grid: Grid,
    material: Material,
    layout: Layout = COARSE,
    control: Control = Control(),
    progress: Progress | None = None,
) -> Trial:
    """Simulate a grid in its bath.

    Args:
        grid: a valid grid.
        material: its material system.
        layout: of the mesh.
        control: convergence settings.
        progress: called with (frames done, frames in all) after each frame.

    Raises:
        InputError: the grid cannot be meshed.
        ComputationError: an increment finds no equilibrium.
    """
    begun = time.perf_counter()
    make_room()
    problem = Equilibrium(
        mesh(grid, material, layout),
        law_of(material.law),
        material.gravity.body_force,
        control=control,
    )
    creep = 1 + material.creep.amplitude
    frames: list[State] = []
    spent: list[int] = []

    def save(state: State) -> None:
        frames.append(state)
        spent.append(problem.iterations - sum(spent))
        if progress:
            progress(len(frames), FRAMES)

    save(problem.flat())
    try:
        # Gravity first: bringing both up at once takes more iterations, and fails more often.
        path = problem.advance(frames, 0.0, 1.0)[-1:]
        for step in range(1, STEPS + 1):
            path += problem.advance(path, step / STEPS, 1.0)
            save(path[-1])
        save(problem.advance(path[-1:], 1.0, creep)[-1])
    except ComputationError as error:
        raise ComputationError(f"frame {len(frames)} of {FRAMES - 1}: {error}") from error

    solid, points = problem.solid, problem.points
    softening = [1.0] * (FRAMES - 1) + [creep]
    stress = [
        sampled_stress(
            solid,
            points,
            state.u,
            state.released,
            np.asarray(cauchy_stress(problem.law, points, state.u[solid.bricks], state.released))
            / soft,
        )
        for state, soft in zip(frames, softening, strict=True)
    ]
    record = {
        "law": material.law.kind,
        "iterations": spent,
        "halved": problem.halved,
        "stable": all(state.stable for state in frames),
        "bricks": len(solid.bricks),
        "unknowns": 3 * (len(solid.nodes) - len(solid.fixed)),
    }
    return Trial.of(solid, [state.u for state in frames], stress, begun, record)
