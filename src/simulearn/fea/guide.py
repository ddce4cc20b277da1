"""What a trial on the coarse mesh says of one on a finer mesh, as a guide to its path.

Both meshes divide the same blocks, so every node of the fine one lies in a brick of the coarse one,
whose shape functions give its displacement. A coarse trial takes a tenth of the time, and is some
tenths of a millimetre from the fine one, by a distance that changes slowly from frame to frame: a
step of the fine path begins near its end. What it ends in, is the same equilibrium as without.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from skfem import ElementHexS2

from simulearn.errors import Cancel, ComputationError, InputError
from simulearn.fea.frames import UNDER_GRAVITY, march
from simulearn.fea.laws import law_of
from simulearn.fea.layout import COARSE, Breaks, Layout, breaks_of
from simulearn.fea.mesh import mesh
from simulearn.fea.path import Path
from simulearn.fea.problem import Control, EquilibriumProblem, SolidState
from simulearn.fea.solid import Solid
from simulearn.grid import Grid, outline
from simulearn.material import Material

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

CORNERS = np.asarray(ElementHexS2.doflocs)  # (20, 3) places of the nodes in the unit brick


@dataclass(frozen=True, eq=False)
class Guide:
    """Displacements of the nodes of a fine mesh, by a coarse one.

    Attributes:
        displacements: (N, 3) mm for pairs of released fraction and multiple of gravity.
        record: bricks, iterations and corrections of the coarse trial, and the code of why it ended
            early, if it did.
    """

    displacements: Mapping[tuple[float, float], Array]
    record: dict[str, Any]


def guide_of(
    grid: Grid,
    material: Material,
    layout: Layout,
    solid: Solid,
    factors: Array | None = None,
    control: Control = Control(),
    reached: Callable[[], None] | None = None,
    cancel: Cancel | None = None,
) -> Guide:
    """Return the guide to the path of a grid's solid, by a trial on the coarse mesh.

    It ends before a snap or an unstable balance: there the fine mesh must find its own way.

    Args:
        grid: the design.
        material: its material system.
        layout: of the fine mesh.
        solid: the fine mesh.
        factors: (B,) by which the released strains of beams differ from the material's.
        control: convergence settings.
        reached: called after each frame of the coarse trial.
        cancel: token that stops the simulation within an iteration.

    Raises:
        CancelledError: the token said so.
    """
    try:
        coarse = mesh(grid, material, COARSE, factors)
    except InputError as error:
        return Guide({}, {"ended": error.code})
    problem = EquilibriumProblem(
        coarse, law_of(material.law), material.gravity.body_force, control=control, cancel=cancel
    )
    path = Path(problem)
    states: list[SolidState] = []
    ended = ""
    try:
        for state in march(path, material.creep.amplitude):
            if path.messages:
                ended = path.messages[0].code
                break
            states.append(state)
            if reached and len(states) - 1 != UNDER_GRAVITY:
                reached()
    except ComputationError as error:
        ended = error.code
    centred = grid.centred
    shape = outline(centred, material.section)
    between = interpolation(
        coarse,
        breaks_of(centred, shape, material.section, COARSE),
        solid,
        breaks_of(centred, shape, material.section, layout),
    )
    record = {
        "bricks": len(coarse.bricks),
        "iterations": problem.iterations,
        "corrections": problem.corrections,
        "ended": ended,
    }
    return Guide({(state.released, state.gravity): between @ state.u for state in states}, record)


def interpolation(coarse: Solid, wide: Breaks, fine: Solid, narrow: Breaks) -> csr_array:
    """Return the weights (N, n) of a coarse mesh's n nodes in the N nodes of a fine one.

    Args:
        coarse: the coarse mesh of a grid.
        wide: where its bricks begin and end.
        fine: the fine mesh of the same grid.
        narrow: where its bricks begin and end.
    """
    lower, upper = _boxes(fine, narrow)
    nodes, first = np.unique(fine.bricks, return_index=True)
    brick, corner = np.divmod(first, fine.bricks.shape[1])
    at = lower[brick] + (upper - lower)[brick] * CORNERS[corner]  # in the unit block

    beam, joint = fine.parts[brick].T
    across, up = (_slot(breaks, at[:, k]) for k, breaks in ((1, wide.across), (2, wide.up)))
    strips, layers = len(wide.across) - 1, len(wide.up) - 1
    joints = int(coarse.parts[coarse.parts[:, 0] < 0, 1].max()) + 1
    slab = np.where(
        beam < 0,
        joint * strips + _slot(wide.across, at[:, 0]),
        joints * strips + beam * coarse.slabs + _slot(wide.along[beam], at[:, 0]),
    )
    of = (slab * strips + across) * layers + up

    lower, upper = _boxes(coarse, wide)
    local = (at - lower[of]) / (upper - lower)[of]
    shape = ElementHexS2()
    weights = np.stack([shape.lbasis(local.T, k)[0] for k in range(len(CORNERS))], axis=1)
    return csr_array(
        (weights.ravel(), coarse.bricks[of].ravel(), np.arange(len(nodes) + 1) * len(CORNERS)),
        shape=(len(nodes), len(coarse.nodes)),
    )


def _boxes(solid: Solid, breaks: Breaks) -> tuple[Array, Array]:
    """Return the lower and upper corner (E, 3) of each brick in the unit block it belongs to."""
    joints = int(solid.parts[solid.parts[:, 0] < 0, 1].max()) + 1
    in_joints = np.broadcast_to(breaks.across, (joints, len(breaks.across)))
    ends = []
    for side in (slice(None, -1), slice(1, None)):
        parts = []
        for along in (in_joints, breaks.along):
            x, y, z = along[:, side, None, None], breaks.across[side, None], breaks.up[side]
            parts.append(np.stack(np.broadcast_arrays(x, y, z), axis=-1).reshape(-1, 3))
        ends.append(np.concatenate(parts))
    return ends[0], ends[1]


def _slot(breaks: Array, at: Array) -> Indices:
    """Return between which of the breaks (..., k) each place (M,) lies."""
    return np.asarray((breaks[..., 1:-1] <= at[:, None]).sum(axis=-1))
