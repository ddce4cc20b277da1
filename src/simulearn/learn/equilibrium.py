"""The models that solve for equilibrium: `beams`, mechanics alone, and `equilibrium`, the default.

What they answer is a minimum of the energy of a grid of beams between joints; see `learn.shapes`.
"""

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import cached_property, lru_cache, partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.files import cores
from simulearn.learn import local, stresses
from simulearn.learn.model import Designs, Frames, Last
from simulearn.learn.shapes import Parameters, Shapes, shapes
from simulearn.learn.trust import Trust
from simulearn.material import Material, load_material
from simulearn.mechanics.corners import local_corners, placed
from simulearn.mechanics.rollout import loads, start
from simulearn.mechanics.section import first_guess
from simulearn.mechanics.skeleton import Flat, Skeleton, flat, skeletons
from simulearn.traced import Traced

TRUST = ("trust.weights", "trust.ranges", "trust.counts")
CONVERGED = 0.1  # mm, the last motion of an iteration at most
AT_ONCE = 4  # designs in one call of a kernel

Weights = dict[str, NDArray[Any]]


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A model that solves for equilibrium; without a network it is mechanics alone.

    Attributes:
        parameters: fitted.
        sizes: width, message and rounds of the networks.
        trust: the error estimate, or None.
        kind: "equilibrium" or "beams".
    """

    parameters: Parameters
    sizes: tuple[int, int, int] = (64, 16, 2)
    trust: Trust | None = None
    kind: str = "equilibrium"
    material: str = field(default="pla-hot-water")

    @cached_property
    def _parameters(self) -> Parameters:
        return jax.device_put(self.parameters)

    def rollout(self, designs: Designs) -> Frames:
        """Return the twelve frames of designs of one topology; see `learn.model.Model`."""
        told = self.told(designs)
        bound = None if self.trust is None else self.trust.bound(designs, told)
        return Frames(
            np.asarray(told.joints),
            np.asarray(told.sections),
            None if told.stress is None else np.asarray(told.stress),
            bound,
            _good(told),
        )

    def last(self, designs: Designs) -> Last:
        """Return the last frame; see `learn.model.last_frame`."""
        told = self.told(designs, last=True)
        joints, sections = np.asarray(told.joints)[:, 0], np.asarray(told.sections)[:, 0]
        good = _good(told)
        if not good.all():  # frame by frame more find their way
            whole = self.told(designs.take(~good))
            joints[~good], sections[~good] = whole.joints[:, -1], whole.sections[:, -1]
            good[~good] = _good(whole)
        return Last(joints, sections, good)

    def told(self, designs: Designs, last: bool = False) -> Shapes:
        """Return twelve frames of each design, or the last, and what the error estimate goes by."""
        count = len(designs)
        bones = skeletons(designs.beams, designs.fixed, designs.flat)
        parameters = self._parameters._replace(stress=None) if last else self._parameters
        kernel = partial(_kernel(self.material, last), parameters)
        size = AT_ONCE if count >= AT_ONCE else 1
        parts = [np.arange(a, a + size) % count for a in range(0, count, size)]

        def run(which: NDArray[np.int64]) -> Any:
            take = lambda x: x[which]  # noqa: E731
            some = Skeleton(*map(take, bones))
            told = kernel(some, designs.flat[which], designs.actuators[which])
            return jax.tree.map(np.asarray, told)

        if len(parts) > 1:
            with ThreadPoolExecutor(min(cores(), len(parts))) as pool:
                told = list(pool.map(run, parts))
        else:
            told = [run(which) for which in parts]
        return Shapes(*jax.tree.map(lambda *x: np.concatenate(x)[:count], *told))

    def config(self) -> dict[str, Any]:
        """Return the architecture."""
        width, message, rounds = self.sizes
        return {"width": width, "message": message, "rounds": rounds, "material": self.material}

    def to_arrays(self) -> Weights:
        """Return law, networks and error estimate by name."""
        arrays = {name: np.asarray(x) for name, x in _named(self.parameters)}
        if self.trust is not None:
            arrays |= {f"trust.{key}": value for key, value in vars(self.trust).items()}
        return arrays

    @classmethod
    def from_arrays(
        cls, config: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]
    ) -> "Equilibrium":
        """Return the model of a bundle.

        Raises:
            InputError: a weight is missing, too many, or has the wrong shape.
        """
        sizes = config["width"], config["message"], config["rounds"]
        network = any(name.startswith("network.") for name in arrays)
        stress = any(name.startswith("stress.") for name in arrays)
        shape_of = lambda heads: jax.eval_shape(  # noqa: E731
            lambda: local.weights(jax.random.key(0), heads, *sizes)
        )
        blank = Parameters(
            jax.eval_shape(first_guess),
            shape_of(local.CORRECTIONS) if network else None,
            shape_of(local.STRESSES) if stress else None,
        )
        expected = dict(_named(blank))
        for name, value in expected.items():
            if name not in arrays:
                raise InputError(f"weight {name} is missing")
            if arrays[name].shape != value.shape:
                raise InputError(
                    f"weight {name} has the shape {arrays[name].shape}, not {value.shape}"
                )
        trust = {name: arrays[name] for name in TRUST if name in arrays}
        if 0 < len(trust) < len(TRUST):
            raise InputError(f"weight {next(n for n in TRUST if n not in trust)} is missing")
        if extra := arrays.keys() - expected.keys() - trust.keys():
            raise InputError(f"weight {min(extra)} does not belong to this architecture")
        tree = jax.tree.structure(blank)
        dtype = lambda name, x: np.asarray(arrays[name], x.dtype)  # noqa: E731
        filled = jax.tree.unflatten(tree, [dtype(n, x) for n, x in expected.items()])
        return cls(
            filled,
            sizes,
            Trust(*(np.asarray(x, np.float64) for x in trust.values())) if trust else None,
            "equilibrium" if network else "beams",
            str(config["material"]),
        )


def _good(told: Shapes) -> NDArray[np.bool_]:
    """Return which designs (T,) have an answer."""
    way = np.asarray(told.way)
    finite = [
        np.isfinite(x).reshape(len(way), -1).all(axis=1) for x in (told.joints, told.sections)
    ]
    return np.asarray((way < CONVERGED) & np.all(finite, axis=0))


def _named(parameters: Parameters) -> list[tuple[str, Any]]:
    """Return the arrays of parameters with their names, in the order of the tree."""
    pairs = jax.tree_util.tree_flatten_with_path(parameters)[0]
    return [(".".join(str(k).strip(".[]") for k in path), x) for path, x in pairs]


@lru_cache
def _kernel(material: str, last: bool) -> Traced:
    """Return the compiled function: parameters, skeletons, joints, ratios -> frames."""
    data = load_material(material)
    load = loads(data)

    def kernel(parameters: Parameters, bones: Skeleton, joints: Any, ratio: Any) -> Any:
        one = partial(_last if last else _whole, parameters, load, data)
        return tuple(jax.vmap(one)(bones, joints, ratio))

    return Traced(f"equilibrium {material} {last}", kernel)


def _last(
    parameters: Parameters, load: Any, data: Material, bones: Skeleton, joints: Any, ratio: Any
) -> Shapes:
    """Return the last frame of a design."""
    plan = flat(bones, joints, data.section)
    return shapes(parameters, bones, plan, ratio, load, data, last=True)


def _whole(
    parameters: Parameters, load: Any, data: Material, bones: Skeleton, joints: Any, ratio: Any
) -> Shapes:
    """Return all twelve frames of a design."""
    plan = flat(bones, joints, data.section)
    later = shapes(parameters, bones, plan, ratio, load, data)
    at, sections = first_frame(parameters, bones, plan)
    before = lambda x, y: jnp.concatenate([x[None], y])  # noqa: E731
    stress = later.stress
    if stress is not None:
        printed = stresses.printed(data, plan, ratio)
        stress = before(stresses.in_space(bones, plan, start(plan), printed), stress)
    both = before(at, later.joints), before(sections, later.sections)
    return later._replace(joints=both[0], sections=both[1], stress=stress)


def first_frame(parameters: Parameters, bones: Skeleton, plan: Flat) -> Any:
    """Return the corners of the flat grid: of joints, of sections."""
    zero = jnp.zeros((*bones.ends.shape, 4, 3))
    own = local_corners(parameters.law, bones, plan, jnp.array(0.0), zero, zero)
    return placed(bones, plan, start(plan), *own)
