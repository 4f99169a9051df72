"""Passwords: requirements, hashing, and verification."""

from __future__ import annotations

import unicodedata
from functools import cache
from threading import BoundedSemaphore

from argon2 import PasswordHasher
from argon2.exceptions import Argon2Error, InvalidHash

from coursework.site.people.common_passwords import is_common

SHORTEST, LONGEST = 10, 200  #: characters
#: One check takes 19 MiB, so a process makes only a few at a time; the others wait.
_HASHER = PasswordHasher(time_cost=2, memory_cost=19 * 1024, parallelism=1)
_AT_A_TIME = BoundedSemaphore(4)


def weakness(password: str, *names: str) -> str:
    """Return the weakness of a password: ``short``, ``long``, ``known`` for one of the person's ``names``,
    ``common``, or an empty text."""
    text = _plain(password)
    if len(text) < SHORTEST:
        return "short"
    if len(text) > LONGEST:
        return "long"
    if any(text.casefold() == _plain(name).casefold() for name in names if name):
        return "known"
    return "common" if is_common(text, *names) else ""


def hashed(password: str) -> str:
    """Return the hash of a password, from which the password cannot be recovered."""
    with _AT_A_TIME:
        return _HASHER.hash(_plain(password))


def fits(secret: str, password: str) -> bool:
    """Return True if a password matches a stored hash; it takes as long if nothing is stored."""
    try:
        with _AT_A_TIME:
            return _HASHER.verify(secret or _of_nobody(), _plain(password)) and bool(secret)
    except (Argon2Error, InvalidHash):
        return False


def is_dated(secret: str) -> bool:
    """Return True if a hash uses outdated parameters."""
    return _HASHER.check_needs_rehash(secret)


@cache
def _of_nobody() -> str:
    return _HASHER.hash("the password of nobody")


def _plain(password: str) -> str:
    """Return the normalised form of a password, cut far above the greatest length."""
    return unicodedata.normalize("NFKC", password[: 4 * LONGEST])
