"""Names of students as they are compared; they are shown as they were written."""

from __future__ import annotations

import unicodedata
from functools import lru_cache

_APOSTROPHES = "’‘‛ʼʻʹ′`´＇"
_DASHES = "‐‑‒–—―−﹣－"
_ALIKE = str.maketrans({**dict.fromkeys(_APOSTROPHES, "'"), **dict.fromkeys(_DASHES, "-")})


@lru_cache(maxsize=65_536)
def folded(name: str) -> str:
    """A name whatever its case, spaces, apostrophes and dashes, and however its accents are encoded."""
    plain = unicodedata.normalize("NFKC", name.translate(_ALIKE))
    seen = "".join(c for c in plain if unicodedata.category(c) != "Cf")  # what has no width is not seen
    return unicodedata.normalize("NFKC", " ".join(seen.split()).casefold())
