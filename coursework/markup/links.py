"""Links in the texts of a course: to an exercise, to a lesson, a section or a numbered figure of one, and
terms of an index.

``[the construction](exercise:two_circles)``, ``[positions](lesson:positions#3)``,
``[dead points](#index "dead point")``.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

_LINK = re.compile(
    r"\[(?P<said>[^\[\]]+)\]\("
    r"(?:(?P<kind>exercise|lesson|figure(?=:\w+#)):(?P<name>\w+)(?:#(?P<number>\d+(?:\.\d+)?))?"
    r"|#(?P<mark>index|word|machine)(?:\s+\"(?P<entry>[^\"]*)\")?)\)"
)
_VERBATIM = re.compile(r"(```.*?```|`[^`\n]*`)", re.DOTALL)

TERM = "term"
WORD, MACHINE = "word", "machine"  #: words that an index has found in the text, for its own list each


@dataclass(frozen=True)
class TextLink:
    """Link to an exercise, a lesson or a figure of one, or a term with its entry in the index."""

    said: str
    kind: str  #: exercise, lesson, figure, term, or of what an index has found: word or machine
    name: str  #: of the exercise or lesson, or the entry
    number: str = ""  #: of a section or of a figure

    @property
    def section(self) -> int:
        """Number of the section of a lesson; 0 without one."""
        return 0 if self.kind == "figure" else int(self.number or 0)

    @property
    def anchor(self) -> str:
        """Identifier of the section or figure in its lesson, such as ``section-3``; "" for the lesson
        itself."""
        if not self.number:
            return ""
        return f"{'figure' if self.kind == 'figure' else 'section'}-{self.number}"


def relinked(text: str, write: Callable[[TextLink], str]) -> str:
    """Replace each link of a text by the result of ``write``; leave code unchanged."""
    pieces = _VERBATIM.split(text)
    pieces[::2] = [_LINK.sub(lambda result: write(_link(result)), piece) for piece in pieces[::2]]
    return "".join(pieces)


def links(text: str) -> tuple[TextLink, ...]:
    """Return the links of a text, in order."""
    return tuple(_link(result) for piece in _VERBATIM.split(text)[::2] for result in _LINK.finditer(piece))


def _link(match: re.Match[str]) -> TextLink:
    text = " ".join(match["said"].split())
    if match["kind"] is None:
        kind = TERM if match["mark"] == "index" else match["mark"]
        return TextLink(text, kind, " ".join((match["entry"] or text).split()))
    return TextLink(text, match["kind"], match["name"], match["number"] or "")
