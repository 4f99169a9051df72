"""Server of the queue's page on this machine, which takes back what is typed there; nothing else reaches it.

The address holds a random word, so that other programs and users of the machine do not find it. Pages of
other places cannot send anything, and only the page, its pictures and its data are served.
"""

from __future__ import annotations

import re
import secrets
from collections.abc import Callable
from contextlib import suppress
from hmac import compare_digest
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Lock
from typing import Any

from coursework.errors import CourseworkError
from coursework.messages import localised
from coursework.system.limits import MOST_TABLE_BYTES
from coursework.system.links import open_inside

_SERVED = re.compile(
    r"/([\w-]+)/((?:queue/(?:index\.html|queue\.json))|(?:(?:pictures|crops)/[\w-]+\.(?:png|jpg)))"
)
_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".json": "application/json",
    ".png": "image/png",
    ".jpg": "image/jpeg",
}
_PATIENCE = 30.0  #: seconds for which a connection may be silent


class QueueServer(ThreadingHTTPServer):
    """Server of the folder of a scan job; ``take`` is called with each ``typed.csv`` that the page sends."""

    daemon_threads = True

    def __init__(self, out: Path, take: Callable[[bytes], None]):
        super().__init__(("127.0.0.1", 0), _Handler)
        self.out, self.take = out, take
        self.token, self.lock = secrets.token_urlsafe(24), Lock()

    @property
    def origin(self) -> str:
        return f"http://127.0.0.1:{self.server_address[1]}"

    @property
    def url(self) -> str:
        """Address of the page."""
        return f"{self.origin}/{self.token}/queue/index.html"


class _Handler(BaseHTTPRequestHandler):
    server: QueueServer
    timeout = _PATIENCE
    protocol_version = "HTTP/1.1"

    def do_GET(self) -> None:
        """Answer with a file of the queue."""
        match = _SERVED.fullmatch(self.path)
        if not (self._is_asked_here() and match and self._is_known(match[1])):
            self._answer(404)
            return
        path = self.server.out / match[2]
        with suppress(OSError), open_inside(path, self.server.out) as file:
            self._answer(200, file.read(), _TYPES[path.suffix])
            return
        self._answer(404)

    def do_POST(self) -> None:
        """Take what was typed."""
        token, _, name = self.path.removeprefix("/").partition("/")
        is_from_page = self.headers.get("Origin") == self.server.origin
        if not (self._is_asked_here() and is_from_page and name == "typed" and self._is_known(token)):
            self._answer(403)
            return
        length = self.headers.get("Content-Length", "")
        if not length.isdecimal() or int(length) > MOST_TABLE_BYTES:
            self._answer(413)
            return
        data = self.rfile.read(int(length))
        try:
            with self.server.lock:
                self.server.take(data)
        except CourseworkError as fault:
            self._answer(
                400,
                localised(fault.args[0] if fault.args else str(fault)).encode(),
                "text/plain; charset=utf-8",
            )
        else:
            self._answer(204)

    def _is_asked_here(self) -> bool:
        return f"http://{self.headers.get('Host')}" == self.server.origin

    def _is_known(self, token: str) -> bool:
        return compare_digest(token.encode(), self.server.token.encode())

    def _answer(self, status: int, data: bytes = b"", kind: str = "text/plain") -> None:
        self.close_connection = True
        self.send_response(status)
        headers = {
            "Content-Type": kind,
            "Content-Length": str(len(data)),
            "Connection": "close",
            "Cache-Control": "no-store",
            "X-Content-Type-Options": "nosniff",
            "X-Frame-Options": "DENY",
            "Referrer-Policy": "no-referrer",
        }
        for name, text in headers.items():
            self.send_header(name, text)
        self.end_headers()
        self.wfile.write(data)

    def log_message(self, format: str, *args: Any) -> None:
        """Log nothing: addresses hold the random word."""
