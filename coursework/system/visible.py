"""Foreign text on a terminal: control characters and direction marks appear as escapes."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

#: Control characters except tab and line end, direction marks, and line separators.
_ACTING = re.compile(
    r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u206f\ufff9-\ufffb]|\r(?!\n)"
)
_ENDS = re.compile(r"\r\n|[\r\n]")


def visible(text: str) -> str:
    r"""Return the text with ``\u001b`` for a character that would control a terminal, so that JSON stays the
    same JSON."""
    return _ACTING.sub(_number_of, text)


def one_line(text: str) -> str:
    r"""Return the text on one line, with control characters and ends of lines as escapes such as
    ``\u000a``."""
    return _ENDS.sub(lambda end: "".join(map(_numbered, end[0])), visible(text))


def _number_of(match: re.Match[str]) -> str:
    return _numbered(match[0])


def _numbered(character: str) -> str:
    return f"\\u{ord(character):04x}"


class Visible:
    """Stream that makes texts :func:`visible`; ``plain`` is the stream below it."""

    def __init__(self, plain: Any) -> None:
        self.plain = plain

    def write(self, text: str) -> int:
        self.plain.write(visible(text))
        return len(text)

    def writelines(self, lines: Iterable[str]) -> None:
        for line in lines:
            self.write(line)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.plain, name)


def plain(stream: Any) -> Any:
    """Return the stream for writing colours and moving the cursor; foreign text must be made visible
    first."""
    return stream.plain if isinstance(stream, Visible) else stream


@contextmanager
def visible_streams() -> Iterator[None]:
    """Make the texts on the standard streams visible while the context lasts."""
    before = sys.stdout, sys.stderr
    sys.stdout, sys.stderr = (Visible(stream) for stream in before)
    try:
        yield
    finally:
        sys.stdout, sys.stderr = before
