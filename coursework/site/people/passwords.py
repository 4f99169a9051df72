"""Passwords: which will do, what is kept of one, and whether one fits."""

from __future__ import annotations

import unicodedata
from functools import cache
from threading import BoundedSemaphore

from argon2 import PasswordHasher
from argon2.exceptions import Argon2Error, InvalidHash

from coursework.site.people.common_passwords import is_common

SHORTEST, LONGEST = 10, 200  #: characters
#: One try takes 19 MiB; no more than so many are made at a time by a process, the others wait.
_HASHER = PasswordHasher(time_cost=2, memory_cost=19 * 1024, parallelism=1)
_AT_A_TIME = BoundedSemaphore(4)


def weakness(password: str, *known: str) -> str:
    """Why a password will not do: ``short``, ``long``, ``known`` where it says who one is, or ``common``; nothing where it will."""
    told = _plain(password)
    if len(told) < SHORTEST:
        return "short"
    if len(told) > LONGEST:
        return "long"
    if any(told.casefold() == _plain(one).casefold() for one in known if one):
        return "known"
    return "common" if is_common(told, *known) else ""


def kept(password: str) -> str:
    """What is kept of a password: nobody finds it by that."""
    with _AT_A_TIME:
        return _HASHER.hash(_plain(password))


def fits(secret: str, password: str) -> bool:
    """Whether a password is the one that was kept; it takes the same time where nothing was kept."""
    try:
        with _AT_A_TIME:
            return _HASHER.verify(secret or _of_nobody(), _plain(password)) and bool(secret)
    except (Argon2Error, InvalidHash):
        return False


def is_dated(secret: str) -> bool:
    """Whether a password is kept in a way that is no longer the usual one."""
    return _HASHER.check_needs_rehash(secret)


@cache
def _of_nobody() -> str:
    return _HASHER.hash("the password of nobody")


def _plain(password: str) -> str:
    """A password as any keyboard sends it, no longer than one is."""
    return unicodedata.normalize("NFKC", password[: 4 * LONGEST])
