"""Texts of strangers on a terminal: what would act on it, or turn a line about, is shown as its number."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

#: Control characters but the tabulator and the line's end, what turns the direction of a text about, and separators of lines.
_ACTING = re.compile(
    r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u206f\ufff9-\ufffb]|\r(?!\n)"
)
_ENDS = re.compile(r"\r\n|[\r\n]")


def visible(text: str) -> str:
    r"""The text with ``\u001b`` for the character of that number, where it would act on a terminal: so JSON stays JSON,
    and says the same."""
    return _ACTING.sub(_number_of, text)


def one_line(text: str) -> str:
    r"""The text on one line, of strangers too: ``\u000a`` for the end of one."""
    return _ENDS.sub(lambda end: "".join(map(_numbered, end[0])), visible(text))


def _number_of(found: re.Match[str]) -> str:
    return _numbered(found[0])


def _numbered(character: str) -> str:
    return f"\\u{ord(character):04x}"


class Visible:
    """A stream that texts are written to as :func:`visible` gives them; ``plain`` is the stream below it."""

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
    """The stream for who writes colours and moves the cursor: what is of strangers is to be made visible before."""
    return stream.plain if isinstance(stream, Visible) else stream


@contextmanager
def visible_streams() -> Iterator[None]:
    """Whatever is written to the standard streams meanwhile acts on no terminal."""
    before = sys.stdout, sys.stderr
    sys.stdout, sys.stderr = (Visible(stream) for stream in before)
    try:
        yield
    finally:
        sys.stdout, sys.stderr = before
