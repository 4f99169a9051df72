"""Cookies and CSRF tokens.

The cookie of a signed-in user is the token of a row of the table ``session``. Other browsers have a signed
cookie without a row, to which the CSRF tokens of the sign-in page are bound.
"""

from __future__ import annotations

import hashlib
import hmac
import secrets
from typing import NamedTuple

from itsdangerous import BadSignature, TimestampSigner

from coursework.database.sessions import TOKEN_LENGTH

COOKIE = "coursework"
LANG = "coursework-lang"  #: the cookie of the language that somebody chose
ANONYMOUS_SECONDS = 30 * 24 * 3600  #: lifetime of an anonymous cookie
_HALF = 16  #: bytes of a CSRF token, and of the mask before it


class Session(NamedTuple):
    """The session of a browser."""

    token: str  #: the value of its cookie
    id: int = 0  #: id of its row; 0 if nobody is signed in


class Cookies:
    """Maker of anonymous cookies and CSRF tokens, which it also verifies."""

    def __init__(self, key: bytes):
        self._key = key
        self._signer = TimestampSigner(key, salt="anonymous", digest_method=hashlib.sha256)

    def anonymous(self) -> Session:
        """Return a new anonymous session."""
        return Session(self._signer.sign(secrets.token_urlsafe(16)).decode())

    def is_anonymous(self, cookie: str) -> bool:
        """Return True for an anonymous cookie of this site that has not expired."""
        if len(cookie) > 200:
            return False
        try:
            self._signer.unsign(cookie, max_age=ANONYMOUS_SECONDS)
        except BadSignature:
            return False
        return True

    # --------------------------------------------------------------- CSRF tokens

    def csrf_token(self, session: Session) -> str:
        """Return a CSRF token of a session. It is masked differently each time, so that the length of a
        compressed page reveals nothing of it."""
        mask = secrets.token_bytes(_HALF)
        return (mask + _mixed(mask, self._expected_token(session))).hex()

    def fits(self, session: Session, token: str) -> bool:
        """Return True for a CSRF token of the session."""
        try:
            data = bytes.fromhex(token)
        except ValueError:
            return False
        if len(data) != 2 * _HALF:
            return False
        return hmac.compare_digest(_mixed(data[:_HALF], data[_HALF:]), self._expected_token(session))

    def _expected_token(self, session: Session) -> bytes:
        return hmac.new(self._key, f"form {session.token}".encode(), hashlib.sha256).digest()[:_HALF]


def may_be_token(cookie: str) -> bool:
    """Return True for a cookie of the length of a session's token; signed ones are longer."""
    return len(cookie) == TOKEN_LENGTH and "." not in cookie


def _mixed(left: bytes, right: bytes) -> bytes:
    return bytes(a ^ b for a, b in zip(left, right, strict=True))
