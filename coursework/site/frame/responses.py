"""Responses of the site that starlette lacks: downloads, redirects within the site, and cookies."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from urllib.parse import quote

from starlette.responses import RedirectResponse, Response

from coursework.site.frame.requests import Request
from coursework.system.headers import cookie_name


class Download(Response):
    """File to store; the audit records those that staff take."""

    def __init__(self, content: bytes, media_type: str, filename: str):
        self.filename = filename
        super().__init__(content, media_type=media_type)
        self.headers["content-disposition"] = attached(filename)


def attached(name: str) -> str:
    """Return the header value of a download: the file name in characters that every browser reads, and in
    full."""
    plain = "".join(
        letter if letter.isascii() and (letter.isalnum() or letter in " ._-()") else "_" for letter in name
    )
    encoded = quote(name.encode("utf-8", "replace"), safe="")
    return f"attachment; filename=\"{plain}\"; filename*=UTF-8''{encoded}"


def local(address: str, usual: str = "/") -> str:
    """Return an address of this site; the first page if the given address leads elsewhere."""
    seen = "".join(letter for letter in address if ord(letter) >= 32)  # browsers ignore the others
    leads_away = seen.startswith("//") or "\\" in seen.partition("?")[0]
    return seen if seen.startswith("/") and not leads_away else usual


def redirect(address: str) -> Response:
    """Return a redirect to an address of this site."""
    return RedirectResponse(local(address), 303)


_OFFLINE = timedelta(days=14)  #: for which a page opens without a network at most


def opens_offline(response: Response, lasting: timedelta | None = None) -> Response:
    """Return a page that its person may open again without a network (``static/service-worker.js``).

    Parameters
    ----------
    lasting
        Time for which it may; two weeks if None, and never longer.
    """
    until = datetime.now(UTC) + min(_OFFLINE, _OFFLINE if lasting is None else lasting)
    response.headers["offline-until"] = str(int(until.timestamp()))
    return response


def set_cookie(request: Request, response: Response, name: str, value: str, seconds: int) -> None:
    """Set a cookie of the site that no script can read."""
    secure = request.site.is_secure
    response.set_cookie(
        cookie_name(secure, name), value, max_age=seconds, httponly=True, samesite="lax", secure=secure
    )
