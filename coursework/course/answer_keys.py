"""Names under which a student writes answers where there are no boxes: the symbol that is asked for, or the
question's number.

The id of a part is a word of its author, in the author's language, and may tell: ``highest_group`` is the
highest. It is shown only where it spells a symbol of the sheet, as ``theta4`` and ``a_BA_t`` do; every other
question goes by its number, ``q7``.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from coursework.model import Part

_GREEK = frozenset(
    "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi omicron pi rho sigma tau "
    "upsilon phi chi psi omega".split()
)
_DERIVED = frozenset(("dot", "ddot"))
_NUMBERED = re.compile(r"(?:q|Q|question_)([1-9][0-9]{0,2})")


def spells_a_symbol(name: str) -> bool:
    """Return whether a name is a symbol as it is typed: one or two letters, Greek ones, figures, dots."""
    pieces = re.split(r"_|[0-9]+", name)
    return all(len(p) <= 2 or p.lower() in _GREEK or p in _DERIVED for p in pieces)


def answer_keys(parts: Sequence[Part]) -> Mapping[str, str]:
    """By part id, in order, what an answer is written under."""
    ids = frozenset(part.id for part in parts)
    return {part.id: _key(number, part, ids) for number, part in enumerate(parts, start=1)}


def _key(number: int, part: Part, ids: frozenset[str]) -> str:
    if part.choices or not spells_a_symbol(part.id):
        return f"question_{number}" if f"q{number}" in ids else f"q{number}"
    return part.id


def part_called(name: str, ids: Sequence[str]) -> str:
    """Return the id of the part that an answer under a name is of, among those asked, in order; the name
    itself where it is none."""
    if name in ids:
        return name
    match = _NUMBERED.fullmatch(name)
    return ids[int(match[1]) - 1] if match and int(match[1]) <= len(ids) else name
