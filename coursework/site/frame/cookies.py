"""Sessions: a signed cookie that says who is signed in, and the seal that forms of the session hold."""

from __future__ import annotations

import hashlib
import hmac
import secrets
import time
from collections.abc import Callable
from typing import NamedTuple

from itsdangerous import BadSignature, URLSafeSerializer

COOKIE = "coursework"
SECONDS = 30 * 24 * 3600  #: that a session lasts after it was last used
LONGEST = 180 * 24 * 3600  #: that it lasts at all
RENEWED = 24 * 3600  #: seconds after which a cookie is made anew
_HALF = 16  #: bytes of a seal, and of the mask before it


def cookie_name(is_secure: bool) -> str:
    """What the cookie is called: where all goes by https, so that no neighbouring host can set one in its place."""
    return f"__Host-{COOKIE}" if is_secure else COOKIE


class Session(NamedTuple):
    """Whose browser it is."""

    person: int  #: 0 for nobody
    name: str  #: of the session, drawn when it begins
    began: float  #: seconds, UTC
    used: float  #: when its cookie was made


class Cookies:
    """Makes cookies, and reads them back. ``clock`` gives seconds, UTC; it is the machine's."""

    def __init__(self, key: bytes, clock: Callable[[], float] = time.time):
        self._key, self._clock = key, clock
        self._serializer = URLSafeSerializer(
            key, salt="session", signer_kwargs={"digest_method": hashlib.sha256}
        )

    def begun(self, person: int) -> Session:
        """A new session."""
        now = self._clock()
        return Session(person, secrets.token_urlsafe(16), now, now)

    def cookie(self, session: Session) -> str:
        """The cookie of a session, used now."""
        return str(self._serializer.dumps([session.person, session.name, session.began, int(self._clock())]))

    def made(self, person: int) -> str:
        """The cookie of a new session."""
        return self.cookie(self.begun(person))

    def read(self, cookie: str | None) -> Session | None:
        """The session of a cookie; none of one that is not ours, or too old."""
        if not cookie or len(cookie) > 500:
            return None
        try:
            person, name, began, used = self._serializer.loads(cookie)
            session = Session(int(person), str(name), float(began), float(used))
        except (BadSignature, ValueError, TypeError):
            return None
        now = self._clock()
        return session if now - session.used < SECONDS and now - session.began < LONGEST else None

    def is_due(self, session: Session) -> bool:
        """Whether its cookie is to be made anew."""
        return self._clock() - session.used > RENEWED

    # -------------------------------------------------------------------- seals

    def seal(self, session: Session) -> str:
        """What a form of a session holds: nobody else knows it. It is another text each time, so that a page that is
        compressed gives nothing of it away."""
        mask = secrets.token_bytes(_HALF)
        return (mask + _mixed(mask, self._own(session))).hex()

    def fits(self, session: Session, seal: str) -> bool:
        """Whether a form holds a seal of the session."""
        try:
            told = bytes.fromhex(seal)
        except ValueError:
            return False
        if len(told) != 2 * _HALF:
            return False
        return hmac.compare_digest(_mixed(told[:_HALF], told[_HALF:]), self._own(session))

    def _own(self, session: Session) -> bytes:
        told = f"form {session.person} {session.name}".encode()
        return hmac.new(self._key, told, hashlib.sha256).digest()[:_HALF]


def _mixed(one: bytes, other: bytes) -> bytes:
    return bytes(a ^ b for a, b in zip(one, other, strict=True))
