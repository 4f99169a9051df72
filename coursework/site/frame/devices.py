"""Device cookies: a signed note in a browser that it signed in as some logins before (OWASP, "slow down online guessing attacks
with device cookies"). Who steals one can guess as slowly as anybody, and nothing else."""

from __future__ import annotations

import hashlib
import hmac
import secrets

from itsdangerous import BadSignature, URLSafeTimedSerializer

DEVICE = "coursework-device"
DEVICE_SECONDS = 365 * 24 * 3600
_MOST = 5  #: logins of one browser; the first is forgotten for a sixth
_LENGTH = 16  #: characters of what stands for a login


class Devices:
    """Makes device cookies, and reads them. ``key`` is the site's."""

    def __init__(self, key: bytes):
        self._key = key
        self._serializer = URLSafeTimedSerializer(
            key, salt="device", signer_kwargs={"digest_method": hashlib.sha256}
        )

    def name_for_login(self, cookie: str, login: str) -> str:
        """Return the name of a browser that signed in as a login before; an empty text for any other."""
        name, logins = self._read(cookie)
        return name if self.digest("device", login)[:_LENGTH] in logins else ""

    def name(self, cookie: str) -> str:
        """Return the name of a browser in which somebody signed in before; an empty text for any other."""
        return self._read(cookie)[0]

    def after_sign_in(self, cookie: str, login: str) -> str:
        """Return the cookie of a browser that has just signed in."""
        name, logins = self._read(cookie)
        entry = self.digest("device", login)[:_LENGTH]
        others = [other for other in logins if other != entry][-(_MOST - 1) :]
        return str(self._serializer.dumps([name or secrets.token_urlsafe(12), [*others, entry]]))

    def digest(self, *texts: str) -> str:
        """Return a keyed digest of texts, of which nobody reads a login or an address."""
        text = "\0".join(texts).encode("utf-8", "replace")
        return hmac.new(self._key, text, hashlib.sha256).hexdigest()

    def _read(self, cookie: str) -> tuple[str, list[str]]:
        if not cookie or len(cookie) > 1000:
            return "", []
        try:
            name, logins = self._serializer.loads(cookie, max_age=DEVICE_SECONDS)
            return str(name), [str(entry) for entry in logins]
        except (BadSignature, ValueError, TypeError):
            return "", []
