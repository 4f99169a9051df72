"""Log of security events: sign-ins and sign-outs with their addresses, and refused requests.

A person appears as an id of the table ``person``; no line contains a name, a login, an answer or a token.
Times are in UTC.
"""

from __future__ import annotations

import logging
import traceback

from coursework.system.allowances import network

LOG = logging.getLogger("coursework.security")

SIGNED_IN, SIGNED_OUT, FAILED = "signed in", "signed out", "sign-in failed"
_BY_STATUS = {
    400: "body refused",
    403: "no permission",
    408: "body refused",
    411: "body refused",
    413: "body refused",
    415: "body refused",
    421: "another host",
    429: "too often",
}
_BY_SENTENCE = {"form": "forged form", "own": "no permission", "role": "no permission"}


def event_of(sentence: str, status: int) -> str:
    """Return the security event of a refusal; empty if it does not concern security."""
    return _BY_SENTENCE.get(sentence) or _BY_STATUS.get(status, "")


def log_event(event: str, method: str, path: str, by: str, address: str) -> None:
    """Write an event, with the path of the route, who sent the request if anybody is known, and the
    network."""
    level = logging.INFO if event in (SIGNED_IN, SIGNED_OUT) else logging.WARNING
    LOG.log(level, "security: %s, %s %s, %s, from %s", event, method, path, by or "nobody", network(address))


def location_of(fault: BaseException) -> str:
    """Return the type of a fault and the lines that raised it, without its message, since a message may
    contain an answer."""
    frames = traceback.extract_tb(fault.__traceback__)[-5:]
    lines = " < ".join(
        f"{frame.filename.rpartition('coursework/')[2]}:{frame.lineno}" for frame in reversed(frames)
    )
    return f"{type(fault).__name__} at {lines}"
