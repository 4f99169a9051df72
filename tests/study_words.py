"""What a session says, and how to find it in what it shows."""

from __future__ import annotations

import re

import pytest

from coursework.language.words import words

SAID = {lang: words(lang)["study"] for lang in ("fr", "en")}
BOTH = pytest.mark.parametrize("lang", ["fr", "en"])


def flat(shown: object) -> str:
    """What is shown, on one line, with the spaces and apostrophes of a keyboard."""
    return " ".join(str(shown).replace("’", "'").split())


def start_of(sentence: str) -> str:
    """The longest piece of a sentence that does not depend on what is put in."""
    return flat(max(re.split(r"\{\w+\}", sentence), key=len)).strip(" .:;`»”“")
