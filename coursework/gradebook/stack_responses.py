"""Responses to STACK questions in Moodle's reports: ``Seed: 1; ans1: 238.4 mm [score]; …; prt1: # = 1 |
…``."""

from __future__ import annotations

import json
import re

_BEGINS = re.compile(r"Seed: -?[0-9]+(?:; |\Z)")
_ANSWER = re.compile(
    r"ans(?P<number>[0-9]{1,3}): "
    r'(?P<typed>"(?:[^"\\]|\\.)*"|\["(?:[^"\\]|\\.)*"(?:,\s*"(?:[^"\\]|\\.)*")*\]|.*?)'
    r" \[(?:score|valid|invalid|blank)\](?:; |\Z)",
    re.DOTALL,
)
_EMPTY = ("EMPTYANSWER", "[]")


def stack_answers(text: str) -> dict[int, str] | None:
    """Return the text of each box, by its number; None if this is no such response, or if its answers cannot
    be separated.

    Texts are in quotes and may contain anything; a text that STACK refused is unchanged.
    """
    begins = _BEGINS.match(text)
    if begins is None:
        return None
    position, answers = begins.end(), dict[int, str]()
    while match := _ANSWER.match(text, position):
        number = int(match["number"])
        if answers and number <= max(answers):
            return None
        answers[number] = _plain(match["typed"])
        position = match.end()
    return answers if not text[position:] or text.startswith("prt", position) else None


def _plain(typed: str) -> str:
    """Return a text without its quotes, several values separated by commas."""
    if typed in _EMPTY:
        return ""
    if not typed.startswith(('"', '["')):
        return typed
    try:
        value = json.loads(typed)
    except ValueError:
        return typed.strip('"')
    return ", ".join(value) if isinstance(value, list) else str(value)
