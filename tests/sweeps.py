"""How far sweeps go: a few of each always, the rest where every test runs."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any

import pytest

slow = pytest.mark.slow

#: Of the exercises, one of each sort: lengths and angles, a motion, solids, counts, a drawing.
HANDFUL = ("slotted_mechanism", "four_bar_motion", "parallel_joints", "mobility", "velocity_polygon")


def sampled(values: Iterable[Any], few: Collection[Any] = HANDFUL) -> list[Any]:
    """The values of a parameter in their order; all but the few are slow."""
    return [value if value in few else pytest.param(value, marks=slow) for value in values]


def seeds(few: int, every: int) -> pytest.MarkDecorator:
    """Seeds from 0 on in two blocks: the first few, and the others, slow."""
    blocks = [range(few), pytest.param(range(few, every), marks=slow)]
    return pytest.mark.parametrize("seeds", blocks, ids=["few", "many"])
