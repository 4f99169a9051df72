"""Symbols that a language writes otherwise than the exercises' Python, such as ``T`` for a torque in English.

``exercises/course.toml`` states them, pieces of LaTeX by pieces of LaTeX::

    [symbols.en]
    'F_e' = 'F_\\mathrm{in}'
    '\\Gamma' = 'T'

Names of quantities stay what they are in every language. A text states its symbols itself.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cached_property

from coursework.errors import BadCourse


class Symbols:
    """The symbols of one language.

    Parameters
    ----------
    stated
        LaTeX in the exercises' Python, and the LaTeX of this language in its place.
    """

    def __init__(self, stated: Mapping[str, str]):
        self.stated = dict(stated)

    @classmethod
    def of(cls, settings: Mapping[str, object], lang: str, source: str, usual: Mapping[str, str]) -> Symbols:
        """Return the symbols that the settings of a course state for a language, beside ``usual`` ones.

        Raises
        ------
        BadCourse
            The settings state something else than texts.
        """
        tables = settings.get("symbols", {})
        stated = tables.get(lang, {}) if isinstance(tables, Mapping) else tables
        if not isinstance(stated, Mapping) or not all(isinstance(v, str) and v for v in stated.values()):
            raise BadCourse(
                f"{source}: [symbols.{lang}] states a symbol by a symbol, such as '\\Gamma' = 'T'; found "
                f"{stated!r}"
            )
        return cls({**usual, **stated})

    @cached_property
    def _pattern(self) -> re.Pattern[str]:
        longest_first = sorted(self.stated, key=len, reverse=True)
        return re.compile(rf"(?<![\\A-Za-z])(?:{'|'.join(map(re.escape, longest_first))})(?![A-Za-z0-9])")

    def __call__(self, latex: str) -> str:
        """Return LaTeX with the symbols of the language."""
        return self._pattern.sub(lambda found: self.stated[found[0]], latex) if self.stated else latex
