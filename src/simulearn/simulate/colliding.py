"""The collisions of results, and what is said of them: no engine knows of contact."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from simulearn.collisions import Collision, find
from simulearn.errors import Message
from simulearn.simulate.result import Result
from simulearn.simulate.skin import edges

Array = NDArray[np.float64]

NAMED = 3  # pairs in a message
ALONG = np.linspace(0, 1, 81)  # of a beam, between which places its solid is taken as straight


def with_collisions(result: Result) -> Result:
    """Return a result with its collisions, and a warning where there are any."""
    found = find(result.joints, sections_of(result), result.grid.beams, result.grid.actuators)
    warnings = (*result.warnings, *collision_warnings(found))
    return replace(result, collisions=found, warnings=warnings)


def sections_of(result: Result) -> Array:
    """Return sections (F, B, S, 4, 3) along the beams, mm: of the solid where there is one."""
    if result.solid is None or result.displacements is None:
        return result.beams
    return np.stack([edges(result, b, ALONG) for b in range(len(result.grid.beams))], axis=1)


def collision_warnings(
    collisions: Sequence[Collision], bound_mm: float | None = None
) -> tuple[Message, ...]:
    """Return a warning that names the deepest collisions, or none where there are none.

    Args:
        collisions: of a result, the deepest first.
        bound_mm: of the error of its shape: what is less deep may not happen.
    """
    if not collisions:
        return ()
    named = "; ".join(collision_text(one) for one in collisions[:NAMED])
    more = f"; and {len(collisions) - NAMED} more pairs" if len(collisions) > NAMED else ""
    first = min(one.first for one in collisions)
    text = (
        f"parts run through each other ({named}{more}): contact is not simulated, so from frame "
        f"{first} on the shape is not to be believed"
    )
    unsure = sum(one.depth_mm < bound_mm for one in collisions) if bound_mm is not None else 0
    if unsure:
        which = "all" if unsure == len(collisions) else f"{unsure} of {len(collisions)}"
        text += (
            f"; {which} less deep than the shape may be off ({bound_mm:.1f} mm), so that these may "
            "not happen"
        )
    return (Message("beams-pass", collisions[0].parts[0], text),)


def collision_text(one: Collision) -> str:
    """Return which parts run through each other, when and how deep, in a few words."""
    when = f"between frames {one.frame} and {one.frame + 1}" if one.share else f"frame {one.frame}"
    return f"{one.parts[0]} and {one.parts[1]}, {when}, {one.depth_mm:.1f} mm deep"


def collision_place(result: Result, one: Collision, frame: int) -> Array:
    """Return about where two parts of a result collide in a frame: (3,) mm.

    The place of the worst moment goes along with the nearest section of the first part.
    """
    frame %= len(result.joints)
    kind, number = one.parts[0].split()
    part = result.beams if kind == "beam" else result.joints[:, :, None]
    centres = part[:, int(number)].mean(axis=2)
    then = centres[one.frame] + one.share * (
        centres[min(one.frame + 1, len(centres) - 1)] - centres[one.frame]
    )
    near = int(np.linalg.norm(then - one.place, axis=1).argmin())
    return np.asarray(one.place + centres[frame, near] - then[near])
