"""What a session refuses, said in its language: what was asked, what was found, what would do."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from coursework.errors import BadInput, UnknownName, closest
from coursework.language import words


def expect(lang: str, kind: str, name: object, known: Collection[str]) -> None:
    """Nothing, where a name is one of the known ones.

    ``kind`` says of what: ``exercise``, ``question``, ``prediction``, ``curve`` or ``effect``.

    Raises
    ------
    UnknownName
        The name is none of them; the message has the nearest, or all.
    """
    if isinstance(name, str) and name in known:
        return
    said = words(lang)["study"]["refused"]
    near = closest(str(name), known)
    if near is not None:
        would_do = said["near"].format(name=near)
    else:
        would_do = said["known"].format(names=", ".join(known)) if known else said["none"]
    raise UnknownName(f"{said[kind].format(name=name)} {would_do}")


def by_name(lang: str, call: str, told: object) -> Mapping[str, Any]:
    """What a call is told, by name.

    Raises
    ------
    BadInput
        It is no dictionary.
    """
    if not isinstance(told, Mapping):
        raise refused(lang, "mapping", call=call, found=f"{told!r:.60}")
    return told


def refused(lang: str, why: str, **told: object) -> BadInput:
    """The error for anything else that would not do."""
    return BadInput(words(lang)["study"]["refused"][why].format(**told))
