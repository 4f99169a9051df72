"""Public keys of the platforms: cached, and fetched again for an unknown key, at a limited rate."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import httpx
import jwt

from coursework.lti.refusal import Refused
from coursework.lti.settings import Platform

KEPT_SECONDS = 3600.0  #: after which keys are had anew, should the platform answer
AGAIN_SECONDS = 30.0  #: between two requests to one platform
_LARGEST = 256 * 1024  #: bytes of a set of keys


@dataclass
class _Kept:
    keys: dict[str, Any] = field(default_factory=dict)  #: by their identifiers
    had: float = float("-inf")
    asked: float = float("-inf")


class KeySets:
    """Finds the key that a platform signed with."""

    def __init__(self, client: httpx.Client, clock: Callable[[], float] = time.monotonic):
        self._client, self._clock = client, clock
        self._kept: dict[str, _Kept] = {}
        self._lock = threading.Lock()

    def key(self, platform: Platform, kid: str) -> Any:
        """Return the public key with the given identifier.

        Raises
        ------
        Refused
            The platform has no such key, or does not answer.
        """
        with self._lock:
            kept = self._kept.setdefault(platform.jwks_url, _Kept())
            now = self._clock()
            if (kid not in kept.keys or now - kept.had > KEPT_SECONDS) and now - kept.asked > AGAIN_SECONDS:
                kept.asked = now
                found = self._fetched(platform)
                if found is not None:
                    kept.keys, kept.had = found, now
        if kid in kept.keys:
            return kept.keys[kid]
        if kept.had == float("-inf"):
            raise Refused("platform_down", 502, f"no keys from {platform.name}")
        raise Refused("signature", 401, f"{platform.name} has no key {kid[:80]!r}")

    def _fetched(self, platform: Platform) -> dict[str, Any] | None:
        """Return the RSA keys by identifier; None if the platform does not respond with keys."""
        try:
            with self._client.stream("GET", platform.jwks_url) as answer:
                answer.raise_for_status()
                data = b""
                for piece in answer.iter_bytes():
                    data += piece
                    if len(data) > _LARGEST:
                        return None
            stated = httpx.Response(200, content=data).json()["keys"]
            return {str(one["kid"]): key for one in stated if (key := _usable(one)) is not None}
        except (httpx.HTTPError, ValueError, KeyError, TypeError, AttributeError):
            return None


def _usable(stated: Any) -> Any:
    """Return an RSA key for verification; None for a key of another kind, since a platform may list others."""
    if (
        stated.get("kty") != "RSA"
        or stated.get("use", "sig") != "sig"
        or stated.get("alg", "RS256") != "RS256"
    ):
        return None
    if not stated.get("kid"):
        return None
    try:
        return jwt.PyJWK(stated, "RS256").key
    except jwt.PyJWTError:
        return None
