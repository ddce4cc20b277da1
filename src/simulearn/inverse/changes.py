"""Single modifications of a design: a joint moved by a step, an actuator longer or shorter by one.

As in the paper, a joint goes in eight directions (one on a line of symmetry in two), an actuator up
or down by a quarter.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulearn.inverse.space import Space

Array = NDArray[np.float64]

EIGHT = np.array([(np.cos(t), np.sin(t)) for t in np.pi / 4 * np.arange(8)]).round(12)
ARROWS = "→↗↑↖←↙↓↘"


@dataclass(frozen=True, eq=False)
class Change:
    """A modification.

    Attributes:
        dx: (P,) mm, da: (Q,) by which it moves a point of the space.
        part: "joint" or "actuator".
        indices: of the joints or beams that it changes; partners together.
        words: what it does, for people.
    """

    dx: Array
    da: Array
    part: str
    indices: tuple[int, ...]
    words: str


def changes(space: Space, a: Array) -> list[Change]:
    """Return all single modifications of a point with ratios a (Q,) that keep ratios in [-1, 1].

    Whether what they lead to is valid, `Space.valid` says.
    """
    none = np.zeros(len(space.motions)), np.zeros(len(space.groups))
    modifications = []
    for unit in space.units:
        directions = EIGHT if len(unit.slides) == 2 else np.array([[1.0], [-1.0]])
        for direction in directions:
            dx = none[0].copy()
            dx[list(unit.slides)] = space.move * direction
            words = f"move {_named('joint', unit.joints)} {_direction(space, unit.joints[0], dx)}"
            modifications.append(Change(dx, none[1], "joint", unit.joints, words))
    for q, group in enumerate(space.groups):
        for step in (space.ratio, -space.ratio):
            ratio = round(a[q] + step, 9) + 0.0
            if abs(ratio) > 1:
                continue
            da = none[1].copy()
            da[q] = ratio - a[q]
            words = f"{_named('actuator', group)}: {_signed(a[q])} → {_signed(ratio)}"
            modifications.append(Change(none[0], da, "actuator", group, words))
    return modifications


def _named(part: str, indices: tuple[int, ...]) -> str:
    return (
        f"{part} {indices[0]}"
        if len(indices) == 1
        else f"{part}s {' and '.join(map(str, indices))}"
    )


def _signed(ratio: float) -> str:
    return f"{ratio:+.3g}" if ratio else "0"


def _direction(space: Space, joint: int, dx: Array) -> str:
    """Return where a joint goes, as an arrow and a length."""
    u, v = np.einsum("p,pc->c", dx, space.motions[:, joint])
    arrow = ARROWS[round(np.arctan2(v, u) / (np.pi / 4)) % 8]
    return f"{arrow} {np.hypot(u, v):g} mm"
