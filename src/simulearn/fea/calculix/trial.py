"""CalculiX as an engine: the same trial, computed by another program."""

import time
from collections.abc import Callable

import numpy as np

from simulearn.fea.calculix.run import Kind, calculix
from simulearn.fea.kernel import points_of
from simulearn.fea.mesh import THREE_ACROSS, Layout, mesh
from simulearn.fea.stress import sampled_stress
from simulearn.fea.trial import FRAMES, STEPS, Trial
from simulearn.grid import Grid
from simulearn.material import Material


def simulate_grid(
    grid: Grid,
    material: Material,
    layout: Layout = THREE_ACROSS,
    law: Kind | None = None,
    progress: Callable[[int, int], None] | None = None,
    threads: int = 1,
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

    Raises:
        InputError: CalculiX is not installed, or cannot compute this mesh.
        ComputationError: CalculiX failed.
    """
    begun = time.perf_counter()
    solid = mesh(grid, material, layout)
    frames = calculix(solid, material, law=law, progress=progress, threads=threads)
    record = {"bricks": len(solid.bricks), **frames.record}
    points = points_of(solid)
    tensor = frames.stress[..., [[0, 3, 4], [3, 1, 5], [4, 5, 2]]].reshape(FRAMES, -1, 3, 3)
    released = np.minimum(np.arange(FRAMES) / STEPS, 1.0)
    stress = [
        sampled_stress(solid, points, u, float(s), cauchy)
        for u, s, cauchy in zip(frames.displacements, released, tensor, strict=True)
    ]
    return Trial.of(solid, list(frames.displacements), stress, begun, record)
