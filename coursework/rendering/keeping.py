"""Settings of a page whose script stores the answers typed in it, and saves them as a file to hand in."""

from __future__ import annotations

import json
from collections.abc import Sequence

from markupsafe import Markup

from coursework.language.words import words
from coursework.sheets.sheet import Handout

_UNTYPED = ("blank", "millimetre")  #: boxes for a pen


def keeping(handouts: Sequence[Handout], student: str, lang: str, *, numbered: bool = False) -> Markup:
    """JSON for a page that holds these exercises; ``numbered`` where their boxes' names begin with their
    places.

    A seed is a text, since the numbers of a script have sixteen digits.
    """
    variants = [f"{handout.exercise}-{handout.seed}" for handout in handouts]
    settings = {
        "key": " ".join(
            [
                "coursework",
                *(f"{handout.exercise} {handout.seed} v{handout.version}" for handout in handouts),
                student,
            ]
        ),
        "file": variants[0] if len(variants) == 1 else f"{variants[0]}-{len(variants)}",
        "student": student,
        "lang": lang,
        "sheets": [
            {
                "exercise": handout.exercise,
                "seed": str(handout.seed),
                "own": f"e{number}-" if numbered else "",
                "parts": [question.id for question in handout.questions if question.box not in _UNTYPED],
            }
            for number, handout in enumerate(handouts, 1)
        ],
        "words": words(lang)["page"],
    }
    return in_script(settings)


def in_script(data: object) -> Markup:
    """JSON as it stands in a page: nothing in it ends the element that holds it."""
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"))
    return Markup(text.replace("<", "\\u003c"))
