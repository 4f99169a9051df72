"""Names of students as they are compared; they are shown as they were written."""

from __future__ import annotations

import hashlib
import re
import unicodedata
from collections.abc import Iterable
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


_MARKS = dict.fromkeys(range(0x300, 0x370))
#: Letters that are no letter with an accent to Unicode, as they are written without them.
_SPELLED = str.maketrans(
    {
        "œ": "oe",
        "æ": "ae",
        "ß": "ss",
        "ø": "o",
        "ł": "l",
        "đ": "d",
        "ð": "d",
        "þ": "th",
        "ħ": "h",
        "ı": "i",
        "ŋ": "n",
        "ŧ": "t",
    }
)


def unaccented(name: str) -> str:
    """Return a name as it is compared, without accents: ``Loïc Lefèvre`` is ``loic lefevre``."""
    return unicodedata.normalize("NFD", folded(name)).translate(_MARKS).translate(_SPELLED)


def called(name: str, students: Iterable[str]) -> str | None:
    """Return the student of a name, else the only one whose name differs in accents alone; None for a stranger."""
    students = list(students)
    for compared in (folded, unaccented):
        found = {one for one in students if compared(one) == compared(name)}
        if found:
            return found.pop() if len(found) == 1 else None
    return None


def namesakes(name: str, students: Iterable[str]) -> list[str]:
    """The students whom more than this name tells apart: ``Marie Martin (2290)`` for ``martin marie``."""
    words = sorted(unaccented(name).split())
    return [
        one
        for one in students
        if " (" in one and sorted(unaccented(one.rpartition(" (")[0]).split()) == words
    ]


_DEVICES = {"con", "prn", "aux", "nul", *(f"{d}{n}" for d in ("com", "lpt") for n in range(10))}


def file_stems(names: Iterable[str]) -> list[str]:
    """File names from students' names: ASCII, short, all different, stable; empty where there is no name.

    A name without a letter that ASCII has is told by a number of its own, whoever stands before it.
    """
    used: set[str] = set()
    stems = []
    for name in names:
        plain = unicodedata.normalize("NFKD", unaccented(name)).encode("ascii", "ignore").decode()
        plain = re.sub(r"[^a-z0-9]+", "-", plain).strip("-")[:60].strip("-")
        if name and not plain:
            plain = f"student-{hashlib.sha256(folded(name).encode()).hexdigest()[:8]}"
        elif plain in _DEVICES:
            plain = f"student-{plain}"
        stem, number = plain, 1
        while plain and stem in used:
            number += 1
            stem = f"{plain}-{number}"
        used.add(stem)
        stems.append(stem)
    return stems
