"""Security headers: one policy for every response of an application, with more where a platform frames a
page."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, MutableMapping, Sequence
from typing import Any
from urllib.parse import urlsplit

_POLICY = (
    ("default-src", "'none'"),
    ("img-src", "'self' data:"),
    ("style-src", "'self' 'unsafe-inline'"),
    ("script-src", "'self'"),
    ("font-src", "'self'"),
    ("connect-src", "'self'"),
    ("form-action", "'self'"),
    ("base-uri", "'none'"),
    ("frame-ancestors", "'none'"),
    ("manifest-src", "'self'"),
)
_ALWAYS = {
    "x-content-type-options": "nosniff",
    "referrer-policy": "same-origin",  # the origin shows which page sent a form
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "permissions-policy": "camera=(), microphone=(), geolocation=()",
}
_HTTPS = {"strict-transport-security": "max-age=31536000; includeSubDomains"}

Message = MutableMapping[str, Any]
Send = Callable[[Message], Awaitable[None]]


def security_headers(
    is_secure: bool, frames: Sequence[str] = (), forms: Sequence[str] = (), scripts: Sequence[str] = ()
) -> dict[str, str]:
    """Return the headers of a response.

    Parameters
    ----------
    is_secure
        Served over https.
    frames
        Origins whose pages may show this one in a frame; none by default.
    forms
        Further origins to which forms may be sent.
    scripts
        Digests of scripts within the page, ``sha256-…``.
    """
    more = {"form-action": forms, "script-src": [f"'{digest}'" for digest in scripts]}
    parts = [
        " ".join([name, value, *more.get(name, ())]) for name, value in _POLICY if name != "frame-ancestors"
    ]
    parts.append("frame-ancestors " + (" ".join(frames) or "'none'"))
    headers = {"content-security-policy": "; ".join(parts), **_ALWAYS, **(_HTTPS if is_secure else {})}
    return headers if frames else {**headers, "x-frame-options": "DENY"}


def origin(url: str) -> str:
    """Return the origin of an address: ``https://moodle.example.org``."""
    parts = urlsplit(url)
    return f"{parts.scheme}://{parts.netloc}"


def cookie_name(is_secure: bool, name: str = "coursework") -> str:
    """Return the name of a cookie: over https the prefix keeps neighbouring hosts from setting one in its
    place."""
    return f"__Host-{name}" if is_secure else name


class Guarded:
    """ASGI middleware that adds the security headers to every response that lacks them, whoever made it."""

    def __init__(self, app: Any, is_secure: Callable[[], bool], frames: Sequence[str] = ()):
        self._app, self._is_secure, self._frames = app, is_secure, frames

    async def __call__(self, scope: Message, receive: Any, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        begun = False

        async def guarded(message: Message) -> None:
            nonlocal begun
            if message["type"] == "http.response.start":
                begun = True
                message["headers"] = self._with_ours(message.get("headers", ()))
            await send(message)

        try:
            await self._app(scope, receive, guarded)
        except Exception:
            if not begun:
                await guarded({"type": "http.response.start", "status": 500, "headers": []})
                await send({"type": "http.response.body", "body": b""})
            raise

    def _with_ours(self, headers: Sequence[tuple[bytes, bytes]]) -> list[tuple[bytes, bytes]]:
        present = {name.lower() for name, _ in headers}
        ours = {**security_headers(self._is_secure(), self._frames), "cache-control": "no-store"}
        if b"content-security-policy" in present:  # that policy names the pages that may frame this one
            ours.pop("x-frame-options", None)
        return [
            *headers,
            *((name.encode(), text.encode()) for name, text in ours.items() if name.encode() not in present),
        ]
