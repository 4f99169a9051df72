"""Coarse description of a browser for a person's own list of sessions; it identifies nobody."""

from __future__ import annotations

#: Parts of the header ``User-Agent``, the most specific first, since many browsers also name others.
_PROGRAMS = (
    ("Edg", "Edge"), ("OPR/", "Opera"), ("SamsungBrowser", "Samsung Internet"), ("FxiOS", "Firefox"), ("Firefox/", "Firefox"),
    ("CriOS", "Chrome"), ("Chrome/", "Chrome"), ("Safari/", "Safari"),
)  # fmt: skip
_SYSTEMS = (
    ("iPhone", "iPhone"), ("iPad", "iPad"), ("Android", "Android"), ("CrOS", "ChromeOS"), ("Windows", "Windows"),
    ("Mac OS X", "macOS"), ("Linux", "Linux"),
)  # fmt: skip


def described(user_agent: str) -> str:
    """Return a description such as ``Firefox, Linux`` from the header of a browser; empty for an unusual
    one."""
    names = (
        next((name for piece, name in table if piece in user_agent[:500]), "")
        for table in (_PROGRAMS, _SYSTEMS)
    )
    return ", ".join(filter(None, names))
