"""Connections of the server, with the time at which the operating system received their last bytes; a busy
process reads them later."""

from __future__ import annotations

import socket
import struct
import time
from contextlib import suppress
from typing import Any

from uvicorn.protocols.http.auto import AutoHTTPProtocol

from coursework.site.frame.arrivals import RECEIVED

_LAST_DATA = 52  #: offset of the field ``tcpi_last_data_recv`` of Linux's ``struct tcp_info``: milliseconds
_LONGEST = 120.0  #: seconds beyond which the system's report on a connection is ignored
_Protocol: Any = AutoHTTPProtocol


class Stamped(_Protocol):
    """Protocol that puts the time of the last bytes into the state of each request."""

    def connection_made(self, transport: Any) -> None:
        """Start to track a connection."""
        super().connection_made(transport)
        self._line = transport.get_extra_info("socket")
        self._at = [time.monotonic()]
        self.app_state: dict[str, Any] = {**self.app_state, RECEIVED: self._at}

    def data_received(self, data: bytes) -> None:
        """Record the time of the bytes and pass them on."""
        self._at[0] = time.monotonic() - waited(self._line)
        super().data_received(data)


def waited(line: Any) -> float:
    """Return the seconds since the last bytes of a connection were received; 0 if the system does not report
    them."""
    with suppress(OSError, AttributeError, struct.error, TypeError):
        info = line.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, _LAST_DATA + 4)
        seconds = struct.unpack_from("=I", info, _LAST_DATA)[0] / 1000
        return float(seconds) if seconds <= _LONGEST else 0.0
    return 0.0
