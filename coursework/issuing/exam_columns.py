"""Columns of a roster that an exam uses: group, room, seat and extra time, and those that no table of marks
repeats."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from fractions import Fraction

from coursework.errors import BadInput
from coursework.issuing.identity import EXTRA_TIME, GROUP, ROOM, SEAT, plain

THIRD = Fraction(1, 3)  #: of the duration: the extra time of a roster that only says who has some
_SHARES = {
    **dict.fromkeys(("", "0", "no", "non", "n", "false", "faux", "-", "–", "none", "aucun"), Fraction(0)),
    **dict.fromkeys(
        ("1", "x", "yes", "oui", "o", "y", "true", "vrai", "✓", "✔", "tiers", "un tiers", "1 tiers"), THIRD
    ),
    **dict.fromkeys(
        ("third", "a third", "one third", "tiers temps", "tiers-temps", "1/3 temps", "33", "0.33"), THIRD
    ),
    **dict.fromkeys(("half", "a half", "demi", "la moitie", "mi-temps", "mi temps"), Fraction(1, 2)),
}
_PRIVATE = re.compile(
    r"birth|\bborn\b|(?<!nom de )naissance|\bne(?:e|\(e\))? le\b|^nee?$|handicap|disab|health|\bsante\b"
    r"|medical|\brqth\b"
    r"|amenagement|accommodation|\bsexe?\b|\bgender\b|\bgenre\b|nationalit|telephone|\bphone\b|\bboursier"
)
_DURATION = re.compile(
    r"(?:([0-9]{1,2}) ?(?:h|hrs?|heures?|hours?)(?![^\W\d])\.?)?"
    r"(?: ?(?:et |and )?([0-9]{1,3})( ?(?:min|mins|mn|minutes?)\.?)?)?"
)


def cell(columns: Mapping[str, str], titles: Iterable[str]) -> str:
    """Return the first filled cell of a student's row under one of these titles; "" if there is none."""
    by_title = {plain(title): " ".join(value.split()) for title, value in columns.items()}
    return next((by_title[title] for title in titles if by_title.get(title)), "")


def group_of(columns: Mapping[str, str]) -> str:
    return cell(columns, GROUP)


def room_of(columns: Mapping[str, str]) -> str:
    return cell(columns, ROOM)


def seat_of(columns: Mapping[str, str]) -> str:
    return cell(columns, SEAT)


def extra_time_of(columns: Mapping[str, str]) -> Fraction:
    """Return the extra time of a student, as a share of the duration: a third unless the cell states a share.

    Raises
    ------
    BadInput
        The cell is neither a yes or no, nor a share from 0 to 1 such as 1/3 or 33 %.
    """
    text = cell(columns, EXTRA_TIME)
    share = _SHARES.get(plain(text.lstrip("+")).replace(",", "."))
    share = _share(text) if share is None else share
    if share is None:
        raise BadInput(
            "extra time is yes, no or a share such as 1/3 or 33 %; found {found!r}", found=text[:40]
        )
    return share


def _share(text: str) -> Fraction | None:
    """Return a share as written, ``1/3``, ``33 %``, ``0,5``; a percentage next to a third is a third."""
    written = re.fullmatch(r"\+? ?(\d{1,4}(?:[.,]\d{1,4})?) ?(?:/ ?(\d{1,4})|(%))?", text)
    if written is None or (written[2] and not int(written[2])):
        return None
    share = Fraction(written[1].replace(",", ".")) / (100 if written[3] else int(written[2] or 1))
    if abs(share - THIRD) < Fraction(1, 200):
        return THIRD
    return share if share <= 1 else None


def is_private(title: str) -> bool:
    """Return whether a column is about birth, health or another matter that a table of marks does not
    repeat."""
    return plain(title) in EXTRA_TIME or _PRIVATE.search(plain(title)) is not None


def minutes_of(duration: str) -> int | None:
    """Return the minutes of a stated duration, ``1 h 30`` or ``90 min``; None if it states none."""
    match = _DURATION.fullmatch(" ".join(duration.casefold().split()))
    if match is None or not (match[1] or match[3]):
        return None
    return 60 * int(match[1] or 0) + int(match[2] or 0)


def with_extra(minutes: int, share: Fraction) -> int:
    """Return a duration with extra time, in whole minutes, a begun one counted."""
    return math.ceil(minutes * (1 + share))


def duration_text(minutes: int) -> str:
    """Return a duration as printed: ``1 h 30``, ``2 h``, ``45 min``."""
    hours, rest = divmod(minutes, 60)
    return f"{rest} min" if not hours else f"{hours} h {rest:02}" if rest else f"{hours} h"
