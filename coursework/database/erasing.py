"""Erasure of all data of one person. Not even an anonymous mark remains: anybody with the printed paper,
which states the name and the seed, could tell whose it is.

Texts of others remain; if they, a file or the staff *named* the person, the name is struck out.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from functools import lru_cache
from typing import Any

from sqlalchemy import Connection, Table, delete, exists, select, update

from coursework.database.personal_data import PersonIdentifiers, conditions, identifiers_of
from coursework.database.tables import (
    answer,
    assignment,
    audit,
    class_summary,
    decision,
    extension,
    issue,
    marking,
    placing,
    rejected,
    scanned,
    seen,
    submission,
    typed,
    variant,
    worksheet,
)

STRUCK = "…"  #: replaces a name
#: Characters of what is struck out of the texts of others: a shorter word says of nobody who it is.
_SHORTEST = 3
#: What an assignment says, where a name of letters alone is more likely another word.
_HEADS = ("stated", "asked")

#: Texts that may name a person; answers of others are not among them.
TELLING: tuple[tuple[Table, tuple[str, ...]], ...] = (
    (assignment, ("stated", "columns", "asked")),
    (submission, ("source",)),
    (answer, ("source", "warning", "origin")),
    (rejected, ("source", "reason", "row")),
    (seen, ("source", "what")),
    (marking, ("fault", "submitted")),
    (decision, ("reason", "by")),
    (placing, ("reason", "by")),
    (scanned, ("file",)),
    (typed, ("by",)),
    (worksheet, ("lines",)),
    (extension, ("reason", "by")),
    (audit, ("by", "about")),
)


def erase(connection: Connection, number: int) -> dict[str, int]:
    """Delete all data of a person; return the number of deleted rows of each table. An exercise that only
    this person opened by a link of a platform is deleted with its assignment.

    The audit's line on it is for who calls to write.
    """
    known_as = identifiers_of(connection, number)
    if known_as is None:
        return {}
    gone = {}
    for name, (table, theirs) in conditions(connection, known_as).items():
        gone[name] = connection.execute(delete(table).where(theirs)).rowcount
    connection.execute(delete(class_summary))  # which name everybody in the class
    issued = exists().where(variant.c.assignment_id == assignment.c.id, issue.c.variant_id == variant.c.id)
    connection.execute(delete(assignment).where(assignment.c.link.is_not(None), ~issued))
    theirs = audit.c.actor == number
    connection.execute(update(audit).where(theirs).values(actor=None, address=None))
    _strike(connection, known_as)
    return gone


def _strike(connection: Connection, known_as: PersonIdentifiers) -> None:
    """Remove names from texts of others."""
    words = {word for word in known_as.words if len(word) >= _SHORTEST}
    in_heads = {word for word in words if not word.isalpha()}
    for table, names in TELLING:
        for row in connection.execute(select(table.c.id, *(table.c[name] for name in names))).all():
            before = {name: getattr(row, name) for name in names}
            after = {
                name: _struck(value, in_heads if name in _HEADS else words, keys=name == "columns")
                for name, value in before.items()
            }
            changed = {name: value for name, value in after.items() if value != before[name]}
            if changed:
                connection.execute(update(table).where(table.c.id == row.id).values(changed))


def _struck(value: Any, words: Collection[str], *, keys: bool = False) -> Any:
    """Return a text or JSON without the names; if the ``keys`` of a table are names of students, without the
    entries of these names."""
    if isinstance(value, str):
        return _without(value, words)
    if isinstance(value, list):
        return [_struck(item, words) for item in value]
    if isinstance(value, Mapping):
        remaining = {key: item for key, item in value.items() if not keys or _without(key, words) != STRUCK}
        return {key: _struck(item, words) for key, item in remaining.items()}
    return value


def _without(text: str, words: Collection[str]) -> str:
    for word in sorted(words, key=len, reverse=True):
        if word.casefold() in text.casefold():
            text = _pattern(word).sub(STRUCK, text)
    return text


@lru_cache(maxsize=64)
def _pattern(word: str) -> re.Pattern[str]:
    """Return the pattern of a name as a whole word. A name of letters alone is case-sensitive, since it may
    be a word of the language."""
    return re.compile(rf"(?<!\w){re.escape(word)}(?!\w)", 0 if word.isalpha() else re.IGNORECASE)
