"""What a page is told so that its script keeps the answers typed in it, and hands them in as a file that is marked."""

from __future__ import annotations

import json
from collections.abc import Sequence

from markupsafe import Markup

from coursework.language.words import words
from coursework.sheets.sheet import Handout

_UNTYPED = ("blank", "millimetre")  #: boxes for a pen


def keeping(handouts: Sequence[Handout], student: str, lang: str, *, numbered: bool = False) -> Markup:
    """JSON for a page that holds these exercises; ``numbered`` where their boxes' names begin with their places.

    A seed is a text, since the numbers of a script have sixteen digits.
    """
    variants = [f"{one.exercise}-{one.seed}" for one in handouts]
    said = {
        "key": " ".join(["coursework", *(f"{one.exercise} {one.seed} v{one.version}" for one in handouts), student]),
        "file": variants[0] if len(variants) == 1 else f"{variants[0]}-{len(variants)}",
        "student": student,
        "lang": lang,
        "sheets": [
            {
                "exercise": one.exercise,
                "seed": str(one.seed),
                "own": f"e{place}-" if numbered else "",
                "parts": [question.id for question in one.questions if question.box not in _UNTYPED],
            }
            for place, one in enumerate(handouts, 1)
        ],
        "words": words(lang)["page"],
    }  # fmt: skip
    return in_script(said)


def in_script(data: object) -> Markup:
    """JSON as it stands in a page: nothing in it ends the element that holds it."""
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"))
    return Markup(text.replace("<", "\\u003c"))
