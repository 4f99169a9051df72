"""Device cookies: signed record in a browser of the logins that it has used (OWASP, "slow down online
guessing attacks with device cookies"). A stolen cookie gives only the right to guess slowly."""

from __future__ import annotations

import hashlib
import hmac
import secrets

from itsdangerous import BadSignature, URLSafeTimedSerializer

DEVICE = "coursework-device"
DEVICE_SECONDS = 365 * 24 * 3600
_MOST = 5  #: logins of one browser; a new one replaces the oldest
_LENGTH = 16  #: characters of the digest of a login


class Devices:
    """Maker and reader of device cookies, signed with the site's ``key``."""

    def __init__(self, key: bytes):
        self._key = key
        self._serializer = URLSafeTimedSerializer(
            key, salt="device", signer_kwargs={"digest_method": hashlib.sha256}
        )

    def name_for_login(self, cookie: str, login: str) -> str:
        """Return the name of a browser that has signed in with a login before; otherwise an empty text."""
        name, logins = self._read(cookie)
        return name if self.digest("device", login)[:_LENGTH] in logins else ""

    def name(self, cookie: str) -> str:
        """Return the name of a browser in which anybody has signed in before; otherwise an empty text."""
        return self._read(cookie)[0]

    def after_sign_in(self, cookie: str, login: str) -> str:
        """Return the cookie of a browser that has just signed in."""
        name, logins = self._read(cookie)
        entry = self.digest("device", login)[:_LENGTH]
        others = [other for other in logins if other != entry][-(_MOST - 1) :]
        return str(self._serializer.dumps([name or secrets.token_urlsafe(12), [*others, entry]]))

    def digest(self, *texts: str) -> str:
        """Return a keyed digest of texts, which reveals neither a login nor an address."""
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
