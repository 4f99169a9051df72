"""Line numbers of keys in a TOML file, for messages: the standard library's reader does not give them."""

from __future__ import annotations

import re
from collections.abc import Sequence

_HEADING = re.compile(r"\s*(\[\[?)\s*([^\]]+?)\s*\]")


def line_of(text: str, path: Sequence[str | int]) -> int:
    """Return the line, from 1, of ``("loads", 1, "force")``: the second table of loads, its key; 0 if it is
    not found.

    If the key is written in another way, return the line of its table.
    """
    keys = [str(part) for part in path]
    best, depth = 0, 0
    home: list[str] = []
    counts: dict[str, int] = {}
    for number, line in enumerate(text.splitlines(), start=1):
        if heading := _HEADING.match(line):
            name = ".".join(_keys(heading[2]))
            home = _keys(heading[2])
            if heading[1] == "[[":
                counts[name] = counts.get(name, -1) + 1
                home = [*home, str(counts[name])]
            here = home
        elif assignment := re.match(r"\s*([\w\"'.\- ]+?)\s*=", line):
            here = [*home, *_keys(assignment[1])]
        else:
            continue
        if here == keys[: len(here)] and len(here) > depth:
            best, depth = number, len(here)
    return best


def _keys(dotted: str) -> list[str]:
    return [part.strip().strip("\"'") for part in dotted.split(".")]
