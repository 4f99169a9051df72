"""Sending of responses: headers, browser caching, and compression."""

from __future__ import annotations

import gzip
from functools import lru_cache
from hashlib import sha256
from urllib.parse import quote

from starlette.requests import Request
from starlette.responses import RedirectResponse, Response

from coursework.site.frame.visits import Reply, local
from coursework.system.headers import security_headers

_SMALL = 1000  #: bytes that are sent as they are
_PACKED = ("text/", "application/json", "image/svg+xml")


def response_of(request: Request, reply: Reply, is_secure: bool) -> Response:
    """Return the response of a reply."""
    headers = security_headers(is_secure)
    headers["cache-control"] = f"public, max-age={reply.keep}, immutable" if reply.keep else "no-store"
    if reply.goto and request.headers.get("hx-request") == "true":
        return Response("", 200, {**headers, "hx-redirect": _written(local(reply.goto))})
    if reply.goto:
        return RedirectResponse(_written(local(reply.goto)), 303, headers)
    if reply.file:
        headers["content-disposition"] = attached(reply.file)
    return _whole(request, reply, reply.data or reply.html.encode("utf-8", "replace"), headers)


def _whole(request: Request, reply: Reply, data: bytes, headers: dict[str, str]) -> Response:
    if reply.keep:
        headers["etag"] = f'"{sha256(data).hexdigest()[:20]}"'
        if headers["etag"] in request.headers.get("if-none-match", ""):
            return Response(status_code=304, headers=headers)
    if reply.kind.startswith(_PACKED) and len(data) > _SMALL:
        headers["vary"] = "accept-encoding"
        if "gzip" in request.headers.get("accept-encoding", ""):
            headers["content-encoding"] = "gzip"
            data = _kept_small(data) if reply.keep else gzip.compress(data, 5, mtime=0)
    return Response(data, reply.status, headers, media_type=reply.kind)


@lru_cache(maxsize=64)
def _kept_small(data: bytes) -> bytes:
    return gzip.compress(data, 9, mtime=0)


def attached(name: str) -> str:
    """Return the header value of a download: the file name in characters that every browser reads, and in
    full."""
    plain = "".join(
        letter if letter.isascii() and (letter.isalnum() or letter in " ._-()") else "_" for letter in name
    )
    whole = quote(name.encode("utf-8", "replace"), safe="")
    return f"attachment; filename=\"{plain}\"; filename*=UTF-8''{whole}"


def _written(address: str) -> str:
    """Return an address in the form that a header requires."""
    return quote(address, safe="/:%#?=@[]!$&'()*+,;~")
