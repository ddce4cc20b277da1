"""Which sampling points of stress lie in the active part of their beam: one rule for all engines.

Stress is sampled just inside the ends of a beam and on either side of its middle. The inner
sections of an actuated beam are active, the outer ones where the actuator reaches so far.
"""

from typing import Any

INSIDE = 0.9  # mm from a beam's end, or from its middle


def outer_is_active(ratio: Any, length: Any) -> Any:
    """Return whether actuators reach the sampling points near the ends of their beams.

    Args:
        ratio: (...) signed ratios.
        length: (...) net lengths, mm.
    """
    return (1 - abs(ratio)) / 2 * length < INSIDE
