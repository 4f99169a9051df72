"""Typography of a language's running text: apostrophes, and the spaces that must not break."""

from __future__ import annotations

import re

from coursework.language.numbers import NARROW_SPACE

# Between letters, also before italics, a formula, a quotation, the next piece; after the s of a possessive.
# What stands between two such signs is a quotation, and keeps both.
_APOSTROPHE = re.compile(r"(?<!\w)'[^'\n]*'(?!\w)|(?<=\w)'(?=[\w*$«]|\Z)|(?<=s)'(?=[\s,.;:!?)])")
_UNIT = re.compile(
    r"(?<=\d)[ \u00a0](?=%|(?:[kcmµ]?m|k?g|[kmM]?N|[kMm]?W|[kMm]?J|Hz|m?s|min|h|rad|tr|rev|rpm)"
    r"(?:[²³/·.,;:)\s]|$))"
)
# Also at the head, where a formula stands before; never behind the dash of a list, which would be none.
_HIGH_MARKS = re.compile(r"(?<!\s)(?<!^-)[ \u00a0](?=[;:!?»](?:\W|$))", re.MULTILINE)
_MISSING_SPACE = re.compile(r"(?<=[\w)\]])(?=[;!?»](?:\s|$))")
_OPENING_QUOTE = re.compile(r"«[ \u00a0\u202f]?")


def typeset(text: str, lang: str) -> str:
    """Return the same words with the language's own apostrophes and unbreakable spaces.

    French has a narrow space before ``; : ! ? »``, after ``«``, and between a number and its unit.
    """
    text = _APOSTROPHE.sub(lambda found: "’" if found[0] == "'" else found[0], text)
    if lang != "fr":
        return _UNIT.sub("\N{NO-BREAK SPACE}", text)
    for pattern in (_UNIT, _HIGH_MARKS, _MISSING_SPACE):
        text = pattern.sub(NARROW_SPACE, text)
    return _OPENING_QUOTE.sub("«" + NARROW_SPACE, text)
