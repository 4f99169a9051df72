"""Kinds of errors that marking knows, each with its default penalty."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

#: The share of a question's points that one error leaves, by its kind: the same in every exercise, whoever
#: names it. The size is right, or nearly all of the way; or something of the relation is missing.
PENALTIES: Mapping[str, float] = MappingProxyType(
    {
        # the answer itself
        "sign": 0.5,
        "conjugate": 0.5,
        "inverse": 0.5,
        "unit": 0.5,
        "radians": 0.5,
        "turns_a_minute": 0.5,
        "quadrant": 0.5,
        "branch": 0.5,
        "exchanged": 0.5,
        "count": 0.5,
        "other_case": 0.0,
        "input": 0.0,
        "neighbour": 0.0,
        # a twist or a wrench
        "moment_sign": 0.5,
        "columns": 0.5,
        "other_point": 0.5,
        "complement": 0.0,
        # in a formula
        "term_sign": 0.5,
        "angle_sign": 0.5,
        "constant": 0.5,
        "term": 0.0,
        "angle": 0.0,
        "factor": 0.0,
        "square": 0.0,
        "root": 0.0,
        "function": 0.0,
        "arguments": 0.0,
        "degrees": 0.0,
        "all_degrees": 0.0,
        # in an equation of a loop
        "link_sign": 0.5,
        "link_missing": 0.0,
        "link_term": 0.0,
        "link_turn": 0.0,
        "link_axis": 0.0,
        "link_angle": 0.0,
        "frame_missing": 0.0,
        "angle_unit": 0.0,
        "other_loop": 0.0,
        "repeated_equation": 0.0,
        "says_nothing": 0.0,
        "squared": 0.0,
        "wrapped": 0.0,
        "one_projection": 0.0,
        "numbers": 0.0,
        "some_positions": 0.0,
        "not_derived": 0.0,
        # what is read off a drawing that is not there, or not right
        "not_drawn": 0.25,
        # what the author names without saying of which kind it is
        "mistake": 0.0,
    }
)
