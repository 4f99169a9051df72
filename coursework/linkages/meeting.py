"""Errors of groups that do not close: what the numeric core found, in the names of the mechanism's file."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

from coursework.errors import CannotAssemble, Undefined
from coursework.messages import Message, as_message

#: By a value that the error of the core has, what its values say of named points.
_FOUND = {
    "p_length": "{P} and {Q} are {distance:.6g} mm apart, but {P}{B} and {Q}{B}, {p_length:.6g} and "
    "{q_length:.6g} mm long, reach only {least:.6g} to {most:.6g} mm (gap {gap:.3g} mm)",
    "rod": "the line of {B} is {away:.6g} mm away from {P}, but {P}{B} reaches only {rod:.6g} mm "
    "(gap {gap:.3g} mm)",
    "offset": "{P} and {Q} are {distance:.6g} mm apart, but the line of the slide passes {Q} at "
    "{offset:.6g} mm (gap {gap:.3g} mm)",
    "apart": "the lines on which it slides are parallel (gap {apart:.3g} mm)",
}


def meeting(
    bodies: str, B: str, P: str = "", Q: str = ""
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Name the bodies and points of a group in the errors of what closes it.

    Parameters
    ----------
    bodies
        The bodies of the group.
    B
        The point at which they meet; several of a larger group.
    P, Q
        The points that are placed before: of two bars in the order of their lengths, of a guide the block
        first.

    Returns
    -------
    A decorator of the function that closes the group; it changes no value.
    """

    def named(function: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(function)
        def closed(*given: Any) -> Any:
            try:
                return function(*given)
            except CannotAssemble as fault:
                values = as_message(fault).values
                found = next((text for key, text in _FOUND.items() if key in values), "")
                why = Message(found, **{**values, "P": P, "Q": Q, "B": B}) if found else as_message(fault)
                raise CannotAssemble(
                    "bodies {bodies} do not meet at {joints}: {problem}"
                    if "," in bodies
                    else "body {bodies} does not reach {joints}: {problem}",
                    bodies=bodies,
                    joints=B,
                    problem=why,
                ) from fault
            except Undefined as fault:
                raise Undefined(
                    "bodies {bodies} at {joints}: {problem}"
                    if "," in bodies
                    else "body {bodies} at {joints}: {problem}",
                    bodies=bodies,
                    joints=B,
                    problem=as_message(fault),
                ) from fault

        return closed

    return named
