"""TOML files that people write: read within limits, with the line of each key for messages; and values as
such a file states them."""

from __future__ import annotations

import datetime
import json
import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from coursework.errors import BadInput, nearest, reason_of
from coursework.messages import Message

_LARGEST = 1_000_000  #: characters of an assignment's file
_MOST_DOTS = 200  #: before an equals sign: the reader takes minutes for a key of thousands of names
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
        common = min(len(here), len(keys))
        if here[:common] == keys[:common] and common > depth:
            best, depth = number, common
    return best


def _keys(dotted: str) -> list[str]:
    return [part.strip().strip("\"'") for part in dotted.split(".")]


def source_of(path: Path) -> str:
    """Return the text of a file.

    Raises
    ------
    BadInput
        It cannot be read, or is not UTF-8.
    """
    try:
        return path.read_text("utf-8-sig")
    except OSError as fault:
        raise BadInput("{file} cannot be read: {problem}", file=path, problem=reason_of(fault)) from fault
    except UnicodeDecodeError as fault:
        raise BadInput(
            "{file} is not UTF-8: {reason} at byte {position}",
            file=path,
            reason=fault.reason,
            position=fault.start,
        ) from fault


def table_of(source: str, source_name: str) -> dict[str, Any]:
    """Return the table of the text of a TOML file.

    Raises
    ------
    BadInput
        The text is not TOML, or too large, nested too deep, or has a number of more than 64 bits.
    """
    if len(source) > _LARGEST:
        raise BadInput(
            "{source_name} has {count} characters; such a file has at most {most}",
            source_name=source_name,
            count=len(source),
            most=_LARGEST,
        )
    for number, line in enumerate(source.splitlines(), start=1):
        if line.partition("=")[0].count(".") > _MOST_DOTS:
            raise BadInput(
                "{source_name}, line {number}: a key with more than {most} dots; a key has one or two",
                source_name=source_name,
                number=number,
                most=_MOST_DOTS,
            )
    try:
        table = tomllib.loads(source)
    except RecursionError:
        raise BadInput(
            "{source_name}: brackets nested too deep to be read", source_name=source_name
        ) from None
    except ValueError as fault:
        raise _syntax_fault(source, source_name, str(fault)) from fault
    if _holds_huge(table):
        raise BadInput(
            "{source_name}: a whole number of more than 64 bits, which TOML does not have",
            source_name=source_name,
        )
    return table


def _syntax_fault(source: str, source_name: str, message: str) -> BadInput:
    """Return what the reader of TOML says, with the line as it stands and what would do where people often
    slip."""
    match = re.fullmatch(r"(.*) \(at line (\d+), column \d+\)", message, re.DOTALL)
    if match is None:
        return BadInput("{source_name}: {problem}", source_name=source_name, problem=message)
    problem: object = match[1]
    if match[1].startswith(("Cannot overwrite", "Cannot declare", "Duplicate", "Cannot mutate")):
        problem = Message("a name stands here twice")
    elif match[1].startswith("Illegal character"):
        problem = Message('a text begins and ends on one line with a straight quotation mark, "')
    elif match[1].endswith(("a table declaration", "an array declaration")):
        problem = Message("a table begins with [name], each of several alike with [[name]]")
    elif match[1].startswith(("Expected", "Invalid value")):
        problem = Message(
            'a line is name = value, with texts in straight quotation marks, ", and a decimal point in '
            "numbers"
        )
    number = int(match[2])
    line = source.split("\n")[number - 1].strip()[:80]
    return BadInput(
        "{source_name}, line {number}: {problem}; found {line}",
        source_name=source_name,
        number=number,
        problem=problem,
        line=line,
    )


def _holds_huge(value: Any) -> bool:
    if isinstance(value, (dict, list)):
        return any(map(_holds_huge, value.values() if isinstance(value, dict) else value))
    return isinstance(value, int) and value.bit_length() > 64


def toml_value(value: Any) -> str:
    """Return a text, number, date, list or table as TOML, on one line."""
    if isinstance(value, Mapping):
        pairs = (
            (key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else toml_value(key), toml_value(item))
            for key, item in value.items()
        )
        return "{ " + ", ".join(map(" = ".join, pairs)) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    if isinstance(value, datetime.date):
        return value.isoformat()
    if isinstance(value, float) and value.is_integer():
        return f"{value:.0f}"
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


class TomlReader:
    """Reader of the tables of one file; its errors name the line."""

    def __init__(self, path: Path, source: str) -> None:
        self.path, self.source = path, source

    def refused(self, at: Sequence[str | int], template: str, /, **values: Any) -> BadInput:
        """Return the error of a key, with file and line: a message, or its template and the values that fill
        it."""
        why = template if isinstance(template, Message) else Message(template, **values)
        if line := line_of(self.source, at):
            return BadInput("{file}, line {line}: {problem}", file=self.path, line=line, problem=why)
        return BadInput("{file}: {problem}", file=self.path, problem=why)

    def only(
        self, table: Mapping[str, Any], names: Sequence[str], at: Sequence[str | int] = (), where: str = ""
    ) -> None:
        """Refuse a key that is none of the names; ``where`` is the table in the message."""
        for key in table:
            if key not in names:
                near = nearest(key, names)
                if where:
                    raise self.refused(
                        [*at, key], "no key {key!r} in {table}{near}", key=key, table=where, near=near
                    )
                raise self.refused([*at, key], "no key {key!r}{near}", key=key, near=near)
