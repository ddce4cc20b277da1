"""What is fitted in a model that solves for equilibrium: its arrays, their shapes and names.

The law of sections, the network that corrects it, and the network for stresses. The inputs and
outputs of the networks are listed here with how each changes in a mirrored design, and in one that
is turned upside down.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from simulearn.mechanics.model import SECTION_SHAPES, TERMS, SectionLaw

TWIST_MIRROR = np.array([1, -1, 1, -1, 1, -1.0])
TWIST_FLIP = np.array([1, 1, -1, -1, -1, 1.0])
TWIST_SIZE = np.array([1, 1, 1, 0.2, 0.2, 0.1])  # mm, rad: what is usual


class Heads(NamedTuple):
    """How a vector of outputs is mirrored and put upside down: new = old[order] * sign.

    Attributes:
        mirror, flip: (order (O,), sign (O,)).
        size: (O,) what is usual.
    """

    mirror: tuple[np.ndarray, np.ndarray]
    flip: tuple[np.ndarray, np.ndarray]
    size: np.ndarray


def signed(mirror: np.ndarray, flip: np.ndarray, size: np.ndarray) -> Heads:
    """Return heads that change their signs only."""
    order = np.arange(len(size))
    return Heads((order, mirror), (order, flip), size)


def _at_corners(mirror: list[int], flip: list[int], size: float) -> Heads:
    """Return the heads of something at the corners right-bottom, left-bottom, right-top, left-top.

    Args:
        mirror: sign of each of its components when right and left change places.
        flip: the same for bottom and top.
        size: what is usual.
    """
    count = len(mirror)

    def order(corners: list[int]) -> np.ndarray:
        return (np.array(corners)[:, None] * count + np.arange(count)).ravel()

    return Heads(
        (order([1, 0, 3, 2]), np.tile(np.array(mirror, float), 4)),
        (order([2, 3, 0, 1]), np.tile(np.array(flip, float), 4)),
        np.full(4 * count, size),
    )


def joined(*heads: Heads) -> Heads:
    """Return heads one after the other."""
    starts = np.cumsum([0, *(len(h.size) for h in heads)])

    def join(pairs: list[tuple[np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
        return (
            np.concatenate([order + at for (order, _), at in zip(pairs, starts, strict=False)]),
            np.concatenate([sign for _, sign in pairs]),
        )

    return Heads(
        join([h.mirror for h in heads]),
        join([h.flip for h in heads]),
        np.concatenate([h.size for h in heads]),
    )


_VECTOR = _at_corners([1, -1, 1], [1, 1, -1], 0.2)  # mm
_TENSOR = _at_corners([1, 1, 1, -1, 1, -1], [1, 1, 1, 1, -1, -1], 0.01)  # MPa; 11 22 33 12 13 23
CORRECTIONS = joined(
    signed(TWIST_MIRROR, TWIST_FLIP, 0.3 * TWIST_SIZE),  # of the rest
    signed(np.ones(6), np.ones(6), np.full(6, 0.5)),  # of the stiffness
    _VECTOR,  # warping at the face
    _VECTOR,  # and at the middle
)
STRESSES = joined(_TENSOR, _TENSOR)  # near the face and near the middle
REST, STIFF, FACE, MIDDLE = slice(0, 6), slice(6, 12), slice(12, 24), slice(24, 36)


ODD = ("skew", "far skew")
PLAIN = (
    "length", "ratio", "idle", "passive", "active", "reach", "skew", "far reach", "far skew",
    "held", "held over", "far held", "far held over", "area", "valence", "released", "creep",
    "passive ratio", "joint ratio", "shell ratio", "rim", "slender", "mesh", "curl over", "weight",
)  # fmt: skip
VALUES_MIRROR = np.concatenate(
    [
        np.array([-1.0 if name in ODD else 1.0 for name in PLAIN]),
        TWIST_MIRROR,
        TWIST_MIRROR,
        [1, -1, 1],
        [1, -1, 1],
    ]
)
FEATURES = len(VALUES_MIRROR)


HARMONICS = 2
CHANNELS = 2 * (1 + 2 * HARMONICS)


class NetworkWeights(NamedTuple):
    """Weights of a network: (in, out) matrices and biases, by layer."""

    encode: list[tuple[Any, Any]]
    rounds: list[list[tuple[Any, Any]]]
    decode: list[tuple[Any, Any]]


class Parameters(NamedTuple):
    """All that is fitted: the law of sections, the network that corrects it, that for stresses."""

    law: SectionLaw
    network: NetworkWeights | None = None
    stress: NetworkWeights | None = None


class Prediction(NamedTuple):
    """Frames of a design, or of designs stacked along T: F all of them, or the last alone.

    Attributes:
        joints: (F, J, 8, 3) corners, mm.
        sections: (F, B, 3, 4, 3) corners, mm.
        stress: (F, B, 4, 4, 6) MPa, or None if there is no network for it.
        motion: () the last motion of an iteration, mm; large if there is no equilibrium.
        apart: () mean distance between the joints of the first shape and the last, last frame, mm.
        sag: () mean motion of the joints in creep, first shape, mm.
        strain: () root of the mean square turn of the halves from rest, last frame, rad.
        stable: () whether the last frame is stable, or None where it is not known.
        left_balance: () whether an unstable equilibrium was left, so that a mirrored shape exists,
            or None where it is not known.
        snaps: sudden motions of each design, or None where they are not known.
        seen: (2 B, SEEN) length, actuator, faces and joint of each half in sections of the
            reference width, by which designs are like or unlike those of the training.
    """

    joints: Any
    sections: Any
    stress: Any
    motion: Any
    apart: Any
    sag: Any
    strain: Any
    stable: Any = None
    left_balance: Any = None
    snaps: Any = None
    seen: Any = None


SEEN = 8


def network_shapes(heads: Heads, width: int, message: int, rounds: int) -> NetworkWeights:
    """Return the shapes of a network's weights, in their places.

    Args:
        heads: its outputs.
        width: of its hidden layers.
        message: length of what halves send to each other.
        rounds: how often they do.
    """

    def layer(inner: int, outer: int) -> tuple[tuple[int, int], tuple[int]]:
        return (inner, outer), (outer,)

    return NetworkWeights(
        [layer(FEATURES, width), layer(width, width)],
        [
            [layer(width, message), layer(2 * width + CHANNELS * message, width)]
            for _ in range(rounds)
        ],
        [layer(width, width), layer(width, len(heads.size))],
    )


def named_arrays(parameters: Parameters) -> dict[str, np.ndarray]:
    """Return all arrays by their names, as in `network.encode.0.1`."""
    arrays = {}
    for part, tree in parameters._asdict().items():
        if tree is not None:
            arrays.update({f"{part}.{key}": np.asarray(x) for key, x in _leaves(tree)})
    return arrays


def shapes_by_name(network: bool, stress: bool, sizes: tuple[int, int, int]) -> dict[str, Any]:
    """Return (shape, type) of each array that a model with these parts has, by name."""
    shapes: dict[str, Any] = {
        f"law.{name}": ((TERMS, *shape), np.float64)  # double precision
        for name, shape in SECTION_SHAPES._asdict().items()
    }
    for part, heads, present in (
        ("network", CORRECTIONS, network),
        ("stress", STRESSES, stress),
    ):
        if present:
            for key, shape in _leaves(network_shapes(heads, *sizes), _is_shape):
                shapes[f"{part}.{key}"] = (shape, np.float32)
    return shapes


def parameters_of(arrays: dict[str, np.ndarray], rounds: int) -> Parameters:
    """Return the parameters of arrays by name; see `shapes_by_name` for what there must be."""
    law = SectionLaw(*(arrays[f"law.{name}"] for name in SectionLaw._fields))

    def network(part: str) -> NetworkWeights | None:
        if not any(name.startswith(f"{part}.") for name in arrays):
            return None

        def layer(name: str) -> tuple[Any, Any]:
            return arrays[f"{part}.{name}.0"], arrays[f"{part}.{name}.1"]

        return NetworkWeights(
            [layer(f"encode.{k}") for k in range(2)],
            [[layer(f"rounds.{r}.{k}") for k in range(2)] for r in range(rounds)],
            [layer(f"decode.{k}") for k in range(2)],
        )

    return Parameters(law, network("network"), network("stress"))


def _is_shape(tree: Any) -> bool:
    return isinstance(tree, tuple) and all(isinstance(n, int) for n in tree)


def _is_array(tree: Any) -> bool:
    return hasattr(tree, "shape")


def _leaves(tree: Any, is_leaf: Any = _is_array) -> Iterator[tuple[str, Any]]:
    """Yield the leaves of named tuples and lists with their names, joined by dots."""
    if is_leaf(tree):
        yield "", tree
        return
    items = tree._asdict().items() if hasattr(tree, "_asdict") else enumerate(tree)
    for key, branch in items:
        for name, leaf in _leaves(branch, is_leaf):
            yield f"{key}.{name}".rstrip("."), leaf
