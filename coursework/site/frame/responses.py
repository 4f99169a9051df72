"""Sending of responses: headers, browser caching, and compression."""

from __future__ import annotations

import gzip
from functools import lru_cache
from hashlib import sha256
from urllib.parse import quote

from starlette.requests import Request as HTTPRequest
from starlette.responses import RedirectResponse
from starlette.responses import Response as HTTPResponse

from coursework.site.frame.requests import Response, local
from coursework.system.headers import security_headers

_COMPRESSED_FROM = 1000  #: bytes from which a response is compressed
_COMPRESSED_TYPES = ("text/", "application/json", "image/svg+xml")


def to_http_response(http_request: HTTPRequest, response: Response, is_secure: bool) -> HTTPResponse:
    """Return the HTTP response of a page's response."""
    headers = security_headers(is_secure)
    headers["cache-control"] = (
        f"public, max-age={response.max_age}, immutable" if response.max_age else "no-store"
    )
    if response.redirect and http_request.headers.get("hx-request") == "true":
        return HTTPResponse("", 200, {**headers, "hx-redirect": _written(local(response.redirect))})
    if response.redirect:
        return RedirectResponse(_written(local(response.redirect)), 303, headers)
    if response.filename:
        headers["content-disposition"] = attached(response.filename)
    return _response_with_body(
        http_request, response, response.content or response.html.encode("utf-8", "replace"), headers
    )


def _response_with_body(
    http_request: HTTPRequest, response: Response, data: bytes, headers: dict[str, str]
) -> HTTPResponse:
    if response.max_age:
        headers["etag"] = f'"{sha256(data).hexdigest()[:20]}"'
        if headers["etag"] in http_request.headers.get("if-none-match", ""):
            return HTTPResponse(status_code=304, headers=headers)
    if response.media_type.startswith(_COMPRESSED_TYPES) and len(data) > _COMPRESSED_FROM:
        headers["vary"] = "accept-encoding"
        if "gzip" in http_request.headers.get("accept-encoding", ""):
            headers["content-encoding"] = "gzip"
            data = _compressed(data) if response.max_age else gzip.compress(data, 5, mtime=0)
    return HTTPResponse(data, response.status_code, headers, media_type=response.media_type)


@lru_cache(maxsize=64)
def _compressed(data: bytes) -> bytes:
    return gzip.compress(data, 9, mtime=0)


def attached(name: str) -> str:
    """Return the header value of a download: the file name in characters that every browser reads, and in
    full."""
    plain = "".join(
        letter if letter.isascii() and (letter.isalnum() or letter in " ._-()") else "_" for letter in name
    )
    encoded = quote(name.encode("utf-8", "replace"), safe="")
    return f"attachment; filename=\"{plain}\"; filename*=UTF-8''{encoded}"


def _written(address: str) -> str:
    """Return an address in the form that a header requires."""
    return quote(address, safe="/:%#?=@[]!$&'()*+,;~")
