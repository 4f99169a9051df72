"""In which order a variant prints the cases of a choice: shuffled by its seed, unless their order is
natural."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from coursework.course.secrecy import Secret
from coursework.model import LETTERS, Part

_ROMAN = "I II III IV V VI VII VIII IX X".split()
_COUNTED = "zero one two three four five six seven eight nine ten eleven twelve".split()
_ANSWERED = ("yes", "no", "true", "false")
_LAST = ("none", "neither", "other")  #: cases that stand behind those that they deny


def printed_order(exercise: str, seed: int, part: Part, secret: Secret | None = None) -> tuple[str, ...]:
    """Return the cases of a part in the order in which the variant of a seed, or of a code of an assignment
    with its secret, prints them: the same for ever.

    Parts of an exercise that offer the same cases offer them in one order.
    """
    if part.ordered:
        return part.choices
    if part.shuffled:
        return tuple(sorted(part.choices, key=_shuffled(f"{exercise}/{seed}/{part.id}", secret)))
    first = sorted(case for case in part.choices if case not in _LAST)
    last = [case for case in part.choices if case in _LAST]
    natural = next((label for label in _NATURAL if all(label(case) is not None for case in first)), None)
    return (*sorted(first, key=natural or _shuffled(f"{exercise}/{seed}/{','.join(first)}", secret)), *last)


def letters_of(cases: Sequence[str]) -> Mapping[str, str]:
    """Return the letter of each case, in the order printed."""
    return dict(zip(cases, LETTERS, strict=False))


def _shuffled(stream: str, secret: Secret | None) -> Callable[[str], Any]:
    """Cases by what a stream of bits of their own says of each: no case disturbs the order of others."""
    if secret is not None:
        return lambda case: secret.digest("choices", stream, case)
    return lambda case: hashlib.shake_128(f"coursework/choices/{stream}/{case}".encode()).digest(8)


def _roman(case: str) -> int | None:
    return _ROMAN.index(case) if case in _ROMAN else None


def _counted(case: str) -> int | None:
    size = case.removeprefix("minus_")
    if size not in _COUNTED:
        return None
    return _COUNTED.index(size) * (1 if size == case else -1)


def _lettered(case: str) -> int | None:
    return ord(case.lower()) if re.fullmatch("[A-Za-z]", case) else None


def _answered(case: str) -> int | None:
    return _ANSWERED.index(case) if case in _ANSWERED else None


#: Orders that readers expect: classes I II III, numbers, letters, yes and no.
_NATURAL: tuple[Callable[[str], Any], ...] = (_roman, _counted, _lettered, _answered)
