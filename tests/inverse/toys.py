"""A toy in place of a simulator: smooth, quick, and with an answer that can be reached."""

import numpy as np

from simulearn.grid import Grid
from simulearn.learn.common.model import Designs


def toy(designs: Designs) -> np.ndarray:
    """Return joint centres (T, J, 3): beams lift what is near them, and pull the joints inwards."""
    starts, ends = (designs.flat[:, designs.beams[:, k]] for k in (0, 1))
    length = np.linalg.norm(ends - starts, axis=-1)
    near = np.linalg.norm((starts + ends)[:, None] / 2 - designs.flat[:, :, None], axis=-1)
    lift = np.einsum("tb,tb,tjb->tj", designs.actuators, length, np.exp(-near / 50)) / 3
    pull = 1 - 0.05 * (designs.actuators**2).mean(axis=1)[:, None, None]
    return np.concatenate([designs.flat * pull, lift[..., None]], axis=-1)


def alone(grid: Grid) -> Designs:
    grid = grid.centred
    return Designs(grid.beams, grid.fixed, grid.joints[None], grid.actuators[None])
