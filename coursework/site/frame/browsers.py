"""Coarse description of a browser, for somebody's own list of sessions: nothing that tells two people apart."""

from __future__ import annotations

#: What stands in the header ``User-Agent``, the most telling first: many browsers name others beside themselves.
_PROGRAMS = (
    ("Edg", "Edge"), ("OPR/", "Opera"), ("SamsungBrowser", "Samsung Internet"), ("FxiOS", "Firefox"), ("Firefox/", "Firefox"),
    ("CriOS", "Chrome"), ("Chrome/", "Chrome"), ("Safari/", "Safari"),
)  # fmt: skip
_SYSTEMS = (
    ("iPhone", "iPhone"), ("iPad", "iPad"), ("Android", "Android"), ("CrOS", "ChromeOS"), ("Windows", "Windows"),
    ("Mac OS X", "macOS"), ("Linux", "Linux"),
)  # fmt: skip


def described(user_agent: str) -> str:
    """Return ``Firefox, Linux`` for the header of a browser; an empty text for what is none of the usual ones."""
    names = (
        next((name for piece, name in table if piece in user_agent[:500]), "")
        for table in (_PROGRAMS, _SYSTEMS)
    )
    return ", ".join(filter(None, names))
