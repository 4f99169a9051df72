"""Comparison of students' names; messages show them as written."""

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
    """Return a name without differences of case, spaces, apostrophes, dashes and encoding of accents."""
    plain = unicodedata.normalize("NFKC", name.translate(_ALIKE))
    seen = "".join(c for c in plain if unicodedata.category(c) != "Cf")  # characters without width
    return unicodedata.normalize("NFKC", " ".join(seen.split()).casefold())


_MARKS = dict.fromkeys(range(0x300, 0x370))
#: Letters that Unicode does not decompose into a letter and an accent, in plain letters.
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


def student_named(name: str, students: Iterable[str]) -> str | None:
    """Return the student of this name, else the only one whose name differs in accents alone; None if there
    is none."""
    students = list(students)
    for compared in (folded, unaccented):
        matches = {student for student in students if compared(student) == compared(name)}
        if matches:
            return matches.pop() if len(matches) == 1 else None
    return None


def namesakes(name: str, students: Iterable[str]) -> list[str]:
    """Return the students whose name alone does not distinguish them: ``Marie Martin (2290)`` for ``martin
    marie``."""
    words = sorted(unaccented(name).split())
    return [
        student
        for student in students
        if " (" in student and sorted(unaccented(student.rpartition(" (")[0]).split()) == words
    ]


_DEVICES = {"con", "prn", "aux", "nul", *(f"{d}{n}" for d in ("com", "lpt") for n in range(10))}


def file_stems(names: Iterable[str]) -> list[str]:
    """Return file names of students' names: ASCII, short, distinct, stable; "" for an empty name.

    A name without ASCII letters gets a number that depends on the name alone.
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
