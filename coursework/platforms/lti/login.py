"""Login: the redirect of a browser to its platform, and the check that the same browser returns.

The data of a login travel in the ``state``, signed by the service. Logins therefore take no disk space; only
a verified launch is recorded, once.
"""

from __future__ import annotations

import hashlib
import secrets
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlencode, urlsplit

import jwt

from coursework.platforms.lti.refusal import LTIRefusal
from coursework.platforms.lti.settings import LTIPlatform, Settings
from coursework.system.headers import cookie_name, origin

_HINTS = ("iss", "login_hint", "target_link_uri", "lti_message_hint", "lti_deployment_id", "client_id")
_LONGEST = 2000  #: characters of a parameter
_USE = "login"


@dataclass(frozen=True)
class LoginRedirect:
    """Redirect of a browser to the platform, and the cookie that identifies the browser on its return."""

    url: str
    cookie: str
    value: str


@dataclass(frozen=True)
class VerifiedLogin:
    """Verified return of a browser from its platform."""

    platform: LTIPlatform
    nonce: str
    until: float
    again: dict[str, str]


class Login:
    """Redirection of browsers to their platforms, and verification of their return."""

    def __init__(self, settings: Settings, secret: bytes, clock: Callable[[], float] = time.time):
        self.settings, self._secret, self._clock = settings, secret, clock

    def sent(self, parameters: Mapping[str, str]) -> LoginRedirect:
        """Return the redirect that answers a login request of a platform.

        Raises
        ------
        LTIRefusal
            The platform is unknown, gives no login hint, or requests a page of another site.
        """
        for name in _HINTS:
            if len(parameters.get(name, "")) > _LONGEST:
                raise LTIRefusal("bad_request", 400, f"{name} too long")
        platform = self.settings.platform(parameters.get("iss", ""), parameters.get("client_id", ""))
        if platform is None:
            raise LTIRefusal("platform", 403, f"login from {parameters.get('iss', '')[:100]!r}")
        if not parameters.get("login_hint"):
            raise LTIRefusal("bad_request", 400, "login_hint missing")
        target = parameters.get("target_link_uri", "")
        if _unlike(target, self.settings.url):
            raise LTIRefusal("target", 400, f"target_link_uri at {origin(target)[:100]!r}")
        return self._to(platform, {name: parameters[name] for name in _HINTS if parameters.get(name)})

    def _to(self, platform: LTIPlatform, hints: dict[str, str]) -> LoginRedirect:
        nonce, value = secrets.token_urlsafe(32), secrets.token_urlsafe(32)
        claims = {
            "use": _USE,
            "nonce": nonce,
            "of": [platform.issuer, platform.client_id],
            "by": _digest(value),
            "exp": int(self._clock() + self.settings.login_seconds),
            "hints": hints,
        }
        state = jwt.encode(claims, self._secret, "HS256")
        query = {
            "scope": "openid",
            "response_type": "id_token",
            "response_mode": "form_post",
            "prompt": "none",
            "client_id": platform.client_id,
            "redirect_uri": f"{self.settings.url}/launch",
            "login_hint": hints["login_hint"],
            "state": state,
            "nonce": nonce,
        }
        if "lti_message_hint" in hints:
            query["lti_message_hint"] = hints["lti_message_hint"]
        join = "&" if urlsplit(platform.auth_url).query else "?"
        return LoginRedirect(
            f"{platform.auth_url}{join}{urlencode(query)}", cookie_of(state, self.settings.url), value
        )

    def returned(self, state: str, cookies: Mapping[str, str]) -> VerifiedLogin:
        """Return the login to which a state belongs.

        Raises
        ------
        LTIRefusal
            The state was not made here, is too old, its platform is gone, or another browser sent it.
        """
        try:
            claims: dict[str, Any] = jwt.decode(
                state,
                self._secret,
                algorithms=["HS256"],
                options={"require": ["exp"], "verify_exp": False, "verify_iat": False},
            )
        except jwt.PyJWTError:
            raise LTIRefusal("state", 400, "a state that is not ours") from None
        if claims.get("use") != _USE:
            raise LTIRefusal("state", 400, "not a state")
        platform = self.settings.platform(*claims["of"])
        if platform is None:
            raise LTIRefusal("platform", 403, f"{claims['of'][0]!r} is no longer known")
        if self._clock() > claims["exp"]:
            raise LTIRefusal("stale", 400, "a login of long ago", again=claims["hints"])
        value = cookies.get(cookie_of(state, self.settings.url))
        if value is None:
            raise LTIRefusal("cookie", 400, "no cookie came back", again=claims["hints"])
        if not secrets.compare_digest(_digest(value), claims["by"]):
            raise LTIRefusal("browser", 403, "the cookie of another login")
        return VerifiedLogin(platform, claims["nonce"], float(claims["exp"]), claims["hints"])


def cookie_of(state: str, url: str) -> str:
    """Return the name of the cookie of a state: each has its own, so that two links may be opened at once."""
    return cookie_name(url.startswith("https:"), f"lti-{_digest(state)[:16]}")


def session_cookie(session: str, url: str) -> str:
    """Return the name of the cookie of a session: each link that is open has its own."""
    return cookie_name(url.startswith("https:"), f"lti-at-{_digest(session)[:16]}")


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def _unlike(target: str, url: str) -> bool:
    """Return True if a requested page is not below the service's address."""
    try:
        return bool(target) and (origin(target) != origin(url) or "\\" in target)
    except ValueError:
        return True
