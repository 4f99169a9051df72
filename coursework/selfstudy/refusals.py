"""Errors of a session in its language: the request, the problem, the remedy."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from numbers import Integral
from typing import Any

from coursework.errors import BadInput, UnknownName, closest
from coursework.language.words import words


def expect(lang: str, kind: str, name: object, names: Collection[str]) -> None:
    """Refuse a name that is not one of the known ones.

    ``kind`` says of what: ``exercise``, ``question``, ``prediction``, ``curve`` or ``effect``.

    Raises
    ------
    UnknownName
        The name is none of them; the message has the nearest, or all.
    """
    if not (isinstance(name, str) and name in names):
        raise stranger(lang, kind, name, names)


def stranger(lang: str, kind: str, name: object, names: Collection[str]) -> UnknownName:
    """Return the error for a name that is none of the known ones."""
    texts = words(lang)["study"]["refused"]
    return UnknownName(f"{texts[kind].format(name=name)} {would_do(lang, str(name), names)}")


def would_do(lang: str, name: str, names: Collection[str]) -> str:
    """Return the nearest known name, or all."""
    texts = words(lang)["study"]["refused"]
    near = closest(name, names)
    if near is not None:
        return texts["near"].format(name=near)
    return texts["known"].format(names=", ".join(names)) if names else texts["none"]


class UnknownMethod(UnknownName, AttributeError):
    """Method that a session does not have."""


def no_method(lang: str, name: str, names: Collection[str]) -> UnknownMethod:
    """Return the error for an unknown method."""
    texts = words(lang)["study"]["refused"]["method"].format(name=name)
    return UnknownMethod(f"{texts} {would_do(lang, name, names)}")


def by_name(lang: str, call: str, text: object) -> Mapping[str, Any]:
    """Return the argument of a call as a dictionary by name.

    Raises
    ------
    BadInput
        It is no dictionary.
    """
    if not isinstance(text, Mapping):
        raise refused(lang, "mapping", call=call, found=f"{text!r:.60}")
    return text


def counted(lang: str, why: str, text: object, most: int | None = None) -> int:
    """Return a whole number from 1 to ``most``.

    Raises
    ------
    BadInput
        Anything else.
    """
    if isinstance(text, bool) or not isinstance(text, Integral) or text < 1 or (most and int(text) > most):
        raise refused(lang, why, found=repr(text), most=most)
    return int(text)


def refused(lang: str, why: str, **text: object) -> BadInput:
    """Return the error for another invalid argument."""
    return BadInput(words(lang)["study"]["refused"][why].format(**text))
