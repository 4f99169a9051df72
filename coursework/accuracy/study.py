"""Settings that a solution may state for the measurement of accuracy against time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Motion:
    """Motion in time, integrated at several tolerances.

    The effects are ``inertia``, under a constant effort of the driver, and where ``friction`` is given a
    second motion with that. Without friction the speed follows from the energy at every angle, and the time
    from an integral, so that there is something exact to compare with. ``given`` are values that replace the
    generic ones; ``duration`` is in seconds.
    """

    effort: float
    duration: float
    given: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Study:
    """Settings of a measurement that do not follow from the exercise: values of the generic mechanism, and a
    motion in time.

    Attributes
    ----------
    given
        Values that replace those of the first variant, in canonical units.
    motion
        A motion in time, for exercises whose driver has an effort.
    """

    given: Mapping[str, Any] = field(default_factory=dict)
    motion: Motion | None = None
