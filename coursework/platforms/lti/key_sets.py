"""Public keys of the platforms: cached, and fetched again for an unknown key, at a limited rate."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import httpx
import jwt

from coursework.platforms.lti.refusal import LTIRefusal
from coursework.platforms.lti.settings import LTIPlatform

CACHE_SECONDS = 3600.0  #: after which keys are fetched again, if the platform answers
AGAIN_SECONDS = 30.0  #: between two requests to one platform
_LARGEST = 256 * 1024  #: bytes of a set of keys


@dataclass
class _CachedKeys:
    """Keys of a platform, with the times of the last response and of the last request."""

    keys: dict[str, Any] = field(default_factory=dict)  #: by their identifiers
    had: float = float("-inf")
    requested: float = float("-inf")


class KeySets:
    """Public keys of the platforms."""

    def __init__(self, client: httpx.Client, clock: Callable[[], float] = time.monotonic):
        self._client, self._clock = client, clock
        self._kept: dict[str, _CachedKeys] = {}
        self._lock = threading.Lock()

    def key(self, platform: LTIPlatform, kid: str) -> Any:
        """Return the public key with the given identifier.

        Raises
        ------
        LTIRefusal
            The platform has no such key, or does not answer.
        """
        with self._lock:
            cached = self._kept.setdefault(platform.jwks_url, _CachedKeys())
            now = self._clock()
            if (
                kid not in cached.keys or now - cached.had > CACHE_SECONDS
            ) and now - cached.requested > AGAIN_SECONDS:
                cached.requested = now
                fetched = self._fetched(platform)
                if fetched is not None:
                    cached.keys, cached.had = fetched, now
        if kid in cached.keys:
            return cached.keys[kid]
        if cached.had == float("-inf"):
            raise LTIRefusal("platform_down", 502, f"no keys from {platform.name}")
        raise LTIRefusal("signature", 401, f"{platform.name} has no key {kid[:80]!r}")

    def _fetched(self, platform: LTIPlatform) -> dict[str, Any] | None:
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
            return {str(jwk["kid"]): key for jwk in stated if (key := _usable(jwk)) is not None}
        except (httpx.HTTPError, ValueError, KeyError, TypeError, AttributeError):
            return None


def _usable(stated: Any) -> Any:
    """Return an RSA key for verification; None for a key of another kind, since a platform may list
    others."""
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
