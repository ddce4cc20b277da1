"""CalculiX as an engine: the same trial, computed by another program.

It follows no snap: where it does not converge, even in smaller steps, there is no trial. It does
not say whether an equilibrium is stable either.
"""

import time
from collections.abc import Callable

from simulearn.errors import Cancel
from simulearn.fea.calculix.run import Kind, calculix
from simulearn.fea.kernels import entries
from simulearn.fea.laws import law_of
from simulearn.fea.layout import THREE_ACROSS, Layout
from simulearn.fea.mesh import mesh
from simulearn.fea.points import bricks_of
from simulearn.fea.stress import sample_points, sampled_stress
from simulearn.fea.trial import Trial
from simulearn.grid import Grid
from simulearn.material import Material
from simulearn.schedule import FRAMES, SCHEDULE


def simulate_grid(
    grid: Grid,
    material: Material,
    layout: Layout = THREE_ACROSS,
    law: Kind | None = None,
    progress: Callable[[int, int], None] | None = None,
    threads: int = 1,
    cancel: Cancel | None = None,
) -> Trial:
    """Simulate a grid by CalculiX.

    Args:
        grid: a valid grid.
        material: its material system.
        layout: of the mesh, with at least one brick across the core: CalculiX knows one growth
            in a brick.
        law: where it is not to be the material's own, with the same modulus and Poisson ratio.
        progress: called with (frames done, frames in all).
        threads: processors that CalculiX may use.
        cancel: token that stops it within a fraction of a second.

    Raises:
        InputError: CalculiX is not installed, or cannot compute this mesh.
        ComputationError: CalculiX failed.
        CancelledError: the token said so.
    """
    begun = time.perf_counter()
    solid = mesh(grid, material, layout)
    frames = calculix(solid, material, law=law, progress=progress, threads=threads, cancel=cancel)
    record = {"bricks": len(solid.bricks), **frames.record}
    bricks, _, _ = bricks_of(solid)
    law_, at = law_of(material.law), sample_points(solid)
    tensor = frames.stress[..., [[0, 3, 4], [3, 1, 5], [4, 5, 2]]].reshape(FRAMES, -1, 3, 3)
    stress = []
    for u, s, cauchy in zip(frames.displacements, SCHEDULE.released, tensor, strict=True):
        _, _, F, _, _ = entries.internal(law_, bricks, u, s)  # F knows no law
        stress.append(sampled_stress(solid, s, F[at], cauchy[at]))
    return Trial.of(solid, list(frames.displacements), stress, begun, record)
