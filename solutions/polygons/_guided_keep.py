"""Conditions that drawings of slotted guides share: how the guide and its block move."""

from typing import Any, NamedTuple

from ...exercises._drawn import dot
from ...exercises._told_speeds import guide_rates

__all__ = ["guide_rates", "sliding_motion"]


class SlidingMotion(NamedTuple):
    """At unit rate of the crank: vectors of the sides of both polygons, complex."""

    velocities: tuple[Any, ...]  #: of A2, of A4 (the point of the guide), of A2 relative to A4; over omega2
    accelerations: tuple[Any, ...]
    """Of A2; Coriolis; of A4, normal then tangential; relative, along the guide; over omega2 squared, the crank at a
    constant rate."""
    guide_rate: Any
    guide_gain: Any  #: of the rate, at a constant rate of the crank


def sliding_motion(guided, guide_rates):
    crank, arm = guided
    along = guided.along
    rate, sliding = guide_rates
    left = -crank + rate**2 * arm - 2j * rate * sliding * along
    gain, sliding_gain = dot(left, 1j * along) / abs(arm), dot(left, along)
    return SlidingMotion(
        (1j * crank, 1j * rate * arm, sliding * along),
        (-crank, 2j * rate * sliding * along, -(rate**2) * arm, 1j * gain * arm, sliding_gain * along),
        rate,
        gain,
    )
