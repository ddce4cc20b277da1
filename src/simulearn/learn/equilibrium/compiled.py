"""Predictions compiled by JAX for each topology: small batches on all cores, kept between runs."""

from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache, partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from simulearn.compiled import double_precision
from simulearn.files import cores
from simulearn.learn.common.model import Designs
from simulearn.learn.equilibrium import stresses
from simulearn.learn.equilibrium.native import seen_in
from simulearn.learn.equilibrium.parameters import Parameters
from simulearn.learn.equilibrium.prediction import Prediction
from simulearn.learn.equilibrium.prediction import predict as predict_frames
from simulearn.mechanics.corners import local_corners, placed
from simulearn.mechanics.model import SectionModel, section_of
from simulearn.mechanics.properties import Properties, properties_of, stacked
from simulearn.mechanics.rollout import start
from simulearn.mechanics.topology import FlatGeometry, Topology, flat_geometry, topologies
from simulearn.traced import Traced

AT_ONCE = 4  # designs in one call of a kernel


@double_precision
def predict(
    parameters: Parameters, designs: Designs, mesh: float, last: bool = False
) -> Prediction:
    """Return all twelve frames of designs of one topology, stacked along T, or the last alone.

    Args:
        parameters: fitted.
        designs: T of them; beams do not differ from the material here.
        mesh: 0 for answers as of the default mesh, 1 for those of the fine one.
        last: whether only the last frame is needed.
    """
    count = len(designs)
    topology = topologies(designs.beams, designs.fixed, designs.flat)
    if last:
        parameters = parameters._replace(stress=None)
    materials = designs.materials or (designs.material,) * count
    properties = stacked([properties_of(material, mesh) for material in materials])
    kernel = partial(_kernel(last), parameters)
    size = AT_ONCE if count >= AT_ONCE else 1
    parts = [np.arange(a, a + size) % count for a in range(0, count, size)]

    @double_precision
    def run(which: NDArray[np.int64]) -> Any:
        some = Topology(*(np.asarray(x)[which] for x in topology))
        own = Properties(*(x[which] for x in properties))
        found = kernel(some, designs.flat[which], designs.actuators[which], own)
        return jax.tree.map(np.asarray, found)

    if len(parts) > 1:
        with ThreadPoolExecutor(min(cores(), len(parts))) as pool:
            results = list(pool.map(run, parts))
    else:
        results = [run(which) for which in parts]
    found = Prediction(*jax.tree.map(lambda *x: np.concatenate(x)[:count], *results))
    return found if last else found._replace(seen=seen_in(designs))


@lru_cache(maxsize=2)
def _kernel(last: bool) -> Traced:
    """Return the compiled function: parameters, topologies, joints, ratios, materials."""

    def kernel(
        parameters: Parameters, topology: Topology, joints: Any, ratio: Any, properties: Any
    ) -> Any:
        one = partial(_last if last else _frames, parameters)
        return tuple(jax.vmap(one)(topology, joints, ratio, properties))

    return Traced(f"equilibrium {last}", kernel)


def _last(
    parameters: Parameters, topology: Topology, joints: Any, ratio: Any, p: Properties
) -> Prediction:
    """Return the last frame of a design."""
    geometry = flat_geometry(topology, joints, p)
    return predict_frames(parameters, topology, geometry, ratio, p, last=True)


def _frames(
    parameters: Parameters, topology: Topology, joints: Any, ratio: Any, p: Properties
) -> Prediction:
    """Return all twelve frames of a design."""
    geometry = flat_geometry(topology, joints, p)
    later = predict_frames(parameters, topology, geometry, ratio, p)
    at, sections = first_frame(section_of(parameters.law, p, jnp), topology, geometry)
    stress = later.stress
    if stress is not None:
        printed = stresses.printed(p, geometry, ratio)
        first = stresses.in_space(topology, geometry, start(geometry), printed)
        stress = jnp.concatenate([first[None], stress])
    return later._replace(
        joints=jnp.concatenate([at[None], later.joints]),
        sections=jnp.concatenate([sections[None], later.sections]),
        stress=stress,
    )


def first_frame(section_model: SectionModel, topology: Topology, geometry: FlatGeometry) -> Any:
    """Return the corners of the flat grid: of joints, of sections."""
    zero = jnp.zeros((*topology.ends.shape, 4, 3))
    own = local_corners(section_model, topology, geometry, jnp.array(0.0), zero, zero)
    return placed(topology, geometry, start(geometry), *own)
