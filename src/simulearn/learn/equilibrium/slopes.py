"""How a cost of the last frame changes with a design: the derivative of a simulation.

Equilibria are differentiated by the theorem of implicit functions, so the price is about that of
two more iterations in each frame, whatever the number of joints and beams.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from simulearn.compiled import double_precision, make_room
from simulearn.learn.common.model import Designs
from simulearn.learn.equilibrium.model import CONVERGED, Equilibrium
from simulearn.learn.equilibrium.parameters import Parameters
from simulearn.learn.equilibrium.prediction import TOLERANCE, predict
from simulearn.mechanics.poses import Array
from simulearn.mechanics.properties import Properties, properties_of
from simulearn.mechanics.topology import Topology, flat_geometry, topologies

Cost = Callable[[Array, Array, Any], Array]


class Slopes(NamedTuple):
    """Costs of T designs, and their derivatives.

    Attributes:
        cost: (T,).
        flat: (T, J, 2) by the places of joints, per mm.
        actuators: (T, B) by the signed ratios; at a ratio of 0, where a beam has a kink, that of
            its upper half.
        converged: (T,) whether the simulation has an answer.
    """

    cost: NDArray[np.float64]
    flat: NDArray[np.float64]
    actuators: NDArray[np.float64]
    converged: NDArray[np.bool_]


@double_precision
def slopes(
    model: Equilibrium,
    designs: Designs,
    cost: Cost,
    given: Any,
    tolerance: float = TOLERANCE,
) -> Slopes:
    """Return costs of designs of one topology, and how they change with the designs.

    Args:
        model: the simulator.
        designs: T of them.
        cost: (joints (J, 8, 3), sections (B, 3, 4, 3), given) -> (), in terms of JAX; a function
            of a module, since it is compiled once.
        given: arrays that the cost goes by, the same for all designs.
        tolerance: of the last motion of an iteration, mm; costs that are to be compared with each
            other need a tight one.
    """
    make_room()
    topology = topologies(designs.beams, designs.fixed, designs.flat)
    kernel = _kernel(cost, tolerance)
    mesh = model.mesh_of(designs)
    parameters = model.parameters._replace(stress=None)
    parts = []
    for t in range(len(designs)):
        one = Topology(*(np.asarray(x)[t] for x in topology))
        p = properties_of(designs.material_of(t), mesh)
        parts.append(kernel(parameters, one, designs.flat[t], designs.actuators[t], p, given))
    values: list[Any] = [np.stack([np.asarray(part[k]) for part in parts]) for k in range(4)]
    return Slopes(values[0], values[1], values[2], values[3] < CONVERGED)


@lru_cache(maxsize=16)
def _kernel(cost: Cost, tolerance: float) -> Any:
    """Return the compiled function: parameters, topology, joints, ratios, material, given."""

    def value(
        design: tuple[Array, Array],
        parameters: Parameters,
        topology: Topology,
        p: Properties,
        given: Any,
    ) -> tuple[Array, Array]:
        geometry = flat_geometry(topology, design[0], p)
        prediction = predict(parameters, topology, geometry, design[1], p, tolerance, last=True)
        return cost(prediction.joints[-1], prediction.sections[-1], given), prediction.motion

    @jax.jit
    def kernel(
        parameters: Parameters,
        topology: Topology,
        joints: Array,
        ratio: Array,
        p: Properties,
        given: Any,
    ) -> Any:
        both, slope = jax.value_and_grad(value, has_aux=True)(
            (joints, ratio), parameters, topology, p, given
        )
        return both[0], slope[0], slope[1], jnp.asarray(both[1])

    return kernel
