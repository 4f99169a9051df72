"""Secret of an assignment: 128 random bits that key all its draws, so that public words draw none of its
papers."""

from __future__ import annotations

import hmac
import re
import secrets
from typing import Self

from coursework.errors import counted

_BYTES = 16
_FEWEST_DIGITS = 6  #: different ones; random bits have fewer once in a thousand million


class Secret:
    """Key of draws, which no text shows: ``repr`` and ``str`` are masked."""

    __slots__ = ("_bits",)

    def __init__(self, bits: bytes):
        if len(bits) != _BYTES:
            raise ValueError(f"{len(bits)} bytes, of {_BYTES}")
        self._bits = bits

    @classmethod
    def new(cls) -> Self:
        """Return fresh random bits of the operating system."""
        return cls(secrets.token_bytes(_BYTES))

    @classmethod
    def of(cls, text: object) -> Self:
        """Return the secret that a file or a database holds as 32 hexadecimal digits.

        Raises
        ------
        ValueError
            The text is none; the message does not quote it.
        """
        if not isinstance(text, str):
            raise ValueError(f"a secret is a text of {2 * _BYTES} hexadecimal digits; found no text")
        if not re.fullmatch(rf"[0-9A-Fa-f]{{{2 * _BYTES}}}", text):
            raise ValueError(
                f"a secret is {2 * _BYTES} hexadecimal digits; found {counted(len(text), 'character')}"
                + ("" if len(text) != 2 * _BYTES else ", not all of them such digits")
            )
        if len(set(text.lower())) < _FEWEST_DIGITS:
            raise ValueError(
                f"a secret is {2 * _BYTES} random hexadecimal digits; found only "
                f"{len(set(text.lower()))} different "
                "ones, which is easy to guess"
            )
        return cls(bytes.fromhex(text))

    @property
    def text(self) -> str:
        """The 32 hexadecimal digits, for the files and tables that keep the secret."""
        return self._bits.hex()

    def digest(self, *words: str) -> bytes:
        """Return 32 bytes that depend on the secret and on all the words, in order."""
        content = b"".join(len(word.encode()).to_bytes(4, "big") + word.encode() for word in words)
        return hmac.digest(self._bits, content, "sha256")

    def under(self, *words: str) -> Secret:
        """Return the secret of one use, from which neither this one nor that of other words can be
        computed."""
        return Secret(self.digest("under", *words)[:_BYTES])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Secret) and hmac.compare_digest(self._bits, other._bits)

    def __hash__(self) -> int:
        return hash(self._bits)

    def __repr__(self) -> str:
        return "<secret>"

    def __reduce__(self) -> tuple[type[Secret], tuple[bytes]]:
        """Allow the secret into a process of its own, which draws."""
        return Secret, (self._bits,)
