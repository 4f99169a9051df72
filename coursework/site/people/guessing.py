"""Counters of wrong passwords, which delay the next attempt."""

from __future__ import annotations

from datetime import UTC, datetime

from coursework.database.failures import add_failure, failures_of, forget_failures
from coursework.site.frame.attempts import Attempt, Track
from coursework.site.frame.devices import Devices
from coursework.site.frame.requests import Request
from coursework.system.allowances import network


def tracks_of(request: Request, login: str) -> tuple[Track, ...]:
    """Return the counters of an attempt: for a browser that has signed in with this login before, its own
    counter alone.

    The free failures of a network exceed the typing errors of a class behind one address.
    """
    devices, here = Devices(request.site.secret), network(request.client_address)
    device = devices.name_for_login(request.device, login)
    if device:
        return (Track(devices.digest("device", device, login), 5, 20.0, 3),)
    return (
        Track(devices.digest("here", login, here), 4, 20.0, 3),
        Track(devices.digest("anywhere", login), 20, 20.0, 6),
        Track(devices.digest("network", here), 100, 5.0, 100),
    )


def attempt_of(request: Request, login: str) -> Attempt:
    """Return an attempt to sign in, with the failures before it."""
    tracks = tracks_of(request, login)
    with request.site.store.reading() as connection:
        return Attempt(tracks, failures_of(connection, [track.key for track in tracks], datetime.now(UTC)))


def missed(request: Request, login: str) -> int:
    """Count a wrong password; return the delay of the next attempt in seconds."""
    tracks, now = tracks_of(request, login), datetime.now(UTC)
    with request.site.store.begin() as connection:
        add_failure(connection, [track.key for track in tracks], now)
        counts = failures_of(connection, [track.key for track in tracks], now)
    return int(max(track.seconds(counts.get(track.key, 0)) for track in tracks))


def fitted(request: Request, login: str) -> None:
    """Forget the failures from here after a correct password; failures elsewhere remain counted."""
    keys = [tracks_of(request, login)[0].key]
    with request.site.store.reading() as connection:
        if not failures_of(connection, keys, datetime.now(UTC)):
            return
    with request.site.store.begin() as connection:
        forget_failures(connection, keys)
