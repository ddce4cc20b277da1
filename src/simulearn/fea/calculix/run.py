"""CalculiX on a solid: all frames, by one run where it has the law, by many where it has not."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import Cancel, InputError
from simulearn.fea.calculix import grown
from simulearn.fea.calculix.brick import matching
from simulearn.fea.calculix.process import Ccx, NotConvergedError, ccx
from simulearn.fea.calculix.schedule import Step, schedule
from simulearn.fea.calculix.state import StepResult
from simulearn.fea.laws import law_of
from simulearn.fea.solid import Solid
from simulearn.material import ElasticData, MarlowData, Material
from simulearn.schedule import FRAMES

Progress = Callable[[int, int], None]  # (frames done, frames in all)
Kind = Literal["marlow", "neo-hookean", "st-venant-kirchhoff"]

PARTS = (1, 2, 4)  # steps per tenth of release, the next tried where one does not converge


@dataclass(frozen=True, eq=False)
class CalculixFrames:
    """What CalculiX computed.

    Attributes:
        displacements: (F, N, 3) mm of the frames; frame 0 is zero.
        stress: (F, E, Q, 6) Cauchy stress at the solid's integration points, MPa, global axes,
            order 11 22 33 12 13 23; frame 0 is zero, frame 11 that of the unmultiplied gravity.
        record: `law`, `program`, `seconds`, `iterations` of each frame, `runs` of ccx.
    """

    displacements: NDArray[np.float64]
    stress: NDArray[np.float64]
    record: dict[str, Any]


def calculix(
    solid: Solid,
    material: Material,
    *,
    law: Kind | None = None,
    progress: Progress | None = None,
    timeout: float | None = None,
    threads: int = 1,
    cancel: Cancel | None = None,
) -> CalculixFrames:
    """Return the frames of a solid, computed by CalculiX.

    Args:
        solid: the solid, with 2 x 2 x 2 integration points, and one growth, in each brick.
        material: its law, gravity and creep are used.
        law: the law where it is not to be the material's own; with its modulus and Poisson ratio.
        progress: called with the frames done and the frames in all.
        timeout: most seconds to wait.
        threads: processors that CalculiX may use.
        cancel: token that stops it.

    Raises:
        InputError: CalculiX is not installed, or cannot take this mesh or law.
        ComputationError: it did not converge, crashed or took too long.
        CancelledError: the token said so.
    """
    order = matching(solid.points)
    if (matching(solid.joint_points) != order).any():
        raise InputError("CalculiX needs the integration points of joints in the order of beams")
    if material.shrinkage.curl:
        raise InputError(
            f"material {material.name} curls of its own (shrinkage.curl), so that growth varies "
            "inside bricks, which CalculiX does not take; use the engine fea",
            "calculix-curl",
            "material",
        )
    data = _data(material, law)
    begin = time.monotonic()
    report = _reporter(progress)
    with ccx(threads, timeout, cancel) as program:
        if isinstance(data, ElasticData) and data.kind == "st-venant-kirchhoff":
            steps, states = _grown(program, solid, data, material, report)
        else:
            from simulearn.fea.calculix import linearised  # with JAX, which nothing else needs here

            steps = schedule(material)
            states = linearised.solve(program, solid, law_of(data), steps, report)
    kept = [k for k, step in enumerate(steps) if step.frame is not None]
    moves = [states[k].displacements for k in kept]
    stresses = [states[k].stress[:, order] for k in kept]
    # Creep softens the energy by 1 + amplitude; CalculiX had the load multiplied instead.
    stresses[-1] = stresses[-1] / (1 + material.creep.amplitude)
    record = {
        "law": data.kind,
        "program": program.program,
        "seconds": time.monotonic() - begin,
        "iterations": _per_frame(steps, [state.iterations for state in states]),
        "runs": max(1, sum(state.runs for state in states)),
    }
    return CalculixFrames(
        np.stack([np.zeros_like(moves[0]), *moves]),
        np.stack([np.zeros_like(stresses[0]), *stresses]),
        record,
    )


def _data(material: Material, law: Kind | None) -> MarlowData | ElasticData:
    if law is None or law == material.law.kind:
        return material.law
    if law == "marlow":
        raise InputError(f"material {material.name} has no test table for a marlow law")
    return ElasticData(kind=law, poisson=material.law.poisson, modulus=material.law.stiffness)


def _grown(
    program: Ccx,
    solid: Solid,
    data: ElasticData,
    material: Material,
    report: Callable[[Sequence[Step]], None],
) -> tuple[list[Step], list[StepResult]]:
    """Solve in one run, with smaller steps where larger ones do not converge."""
    for parts in PARTS:
        steps = schedule(material, parts)
        try:
            return steps, grown.solve(program, solid, data, steps, report)
        except NotConvergedError:
            if parts == PARTS[-1]:
                raise
    raise AssertionError


def _reporter(progress: Progress | None) -> Callable[[Sequence[Step]], None]:
    """Return a function of the steps that are done that reports every frame once."""
    reported = 0

    def report(steps: Sequence[Step]) -> None:
        nonlocal reported
        frame = max([step.frame or 0 for step in steps], default=0)
        if progress is not None and frame > reported:
            reported = frame
            progress(frame + 1, FRAMES)

    return report


def _per_frame(steps: Sequence[Step], counts: Sequence[int]) -> list[int]:
    """Add up counts of the steps that lead to each frame."""
    total = [0] * FRAMES
    frame = FRAMES - 1
    for step, count in zip(reversed(steps), reversed(counts), strict=True):
        frame = frame if step.frame is None else step.frame
        total[frame] += count
    return total
