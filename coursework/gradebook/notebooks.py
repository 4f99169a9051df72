"""Answers in notebooks: cells that hold a literal, read and never run; one an exercise."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

from coursework.gradebook.rows import (
    Rejected,
    Row,
    decoded_text,
    load_json,
    name_in,
    object_once,
    sheet_rows,
    short_fault,
    with_unread,
)

# --------------------------------------------------------------------- notebook


def read_notebook(data: bytes, source: str) -> Iterator[Row | Rejected]:
    text, warning = decoded_text(data, source)
    try:
        notebook = load_json(text)
    except (ValueError, RecursionError) as fault:
        yield Rejected(source, f"not a notebook: {short_fault(fault)}")
        return
    about = notebook.get("metadata", {}) if isinstance(notebook, dict) else {}
    about = about.get("coursework") if isinstance(about, dict) else None
    cells = notebook.get("cells") if isinstance(notebook, dict) else None
    if not isinstance(about, dict) or not isinstance(cells, list):
        yield Rejected(source, "not a notebook of ours: its metadata names no exercise")
        return
    if isinstance(about.get("sheets"), list):
        yield from _read_paper(about, [c for c in cells if isinstance(c, dict)], source, warning)
        return
    tagged = [c for c in cells if isinstance(c, dict) and "answers" in _tags(c)]
    if len(tagged) != 1:
        found = "\n".join(_code(c) for c in cells if isinstance(c, dict) and c.get("cell_type") == "code")
        row = _about(about, source) | {"answer": found.strip()[:200]}
        yield Rejected(source, f"one cell must be tagged 'answers'; found {len(tagged)}", row)
        return
    code = _code(tagged[0])
    answers = literal_answers(code)
    if isinstance(answers, str):
        yield Rejected(source, answers, _about(about, source) | {"answer": code[:200]})
        return
    about, warning = _with_name(about, answers, source, warning)
    yield from sheet_rows(about, answers, source, warning)


# ------------------------------------------------------------------------ paper


def _read_paper(
    about: dict[str, Any], cells: list[dict[str, Any]], source: str, warning: str
) -> Iterator[Row | Rejected]:
    """A notebook of several exercises: an answers cell each, which says whose answers it holds."""
    sheets = [
        (name_in(s.get("exercise")), name_in(s.get("seed"))) for s in about["sheets"] if isinstance(s, dict)
    ]
    tagged = [cell for cell in cells if "answers" in _tags(cell)]
    read = [(_sheet_of(cell, sheets), literal_answers(_code(cell)), _code(cell)) for cell in tagged]
    name, warning = _name_in_paper(about, [found for _, found, _ in read], source, warning)
    for (exercise, seed), found, code in read:
        own = {"student": name, "exercise": exercise, "seed": seed, "lang": about.get("lang")}
        place = f"{source}, {exercise}" if exercise else source
        if isinstance(found, str):
            yield Rejected(place, found, _about(own, source) | {"answer": code[:200]})
        elif not exercise:
            which = (
                f"which exercise an answers cell is of cannot be told: write {_example(sheets)} after its {{"
            )
            yield Rejected(place, which, _about(own, source) | {"answer": code[:200]})
        else:
            yield from sheet_rows(own, found, place, warning)
    there = {sheet for sheet, _, _ in read}
    for exercise, seed in sheets:
        if (exercise, seed) not in there:
            own = {"student": name, "exercise": exercise, "seed": seed}
            code = "\n".join(_code(c) for c in cells if c.get("cell_type") == "code" and c not in tagged)
            reason = f"no cell tagged 'answers' is of {exercise}, seed {seed}"
            yield Rejected(
                f"{source}, {exercise}", reason, _about(own, source) | {"answer": code.strip()[:200]}
            )
    if not sheets and not tagged:
        yield Rejected(source, "the notebook holds no answers", _about({"student": name}, source))


_OF = re.compile(r"#[ \t]*(\w+)[ \t]+([0-9]{1,30})[ \t]*$", re.MULTILINE)


def _sheet_of(cell: dict[str, Any], sheets: list[tuple[str, str]]) -> tuple[str, str]:
    """Exercise and seed of an answers cell: by its metadata, else by the comment at its head, else the only ones."""
    metadata = cell.get("metadata")
    own = metadata.get("coursework") if isinstance(metadata, dict) else None
    if isinstance(own, dict) and name_in(own.get("exercise")):
        return name_in(own["exercise"]), name_in(own.get("seed"))
    for told in _OF.findall(re.sub(r"\r\n?", "\n", _code(cell))):
        if told in sheets:
            return told
    return sheets[0] if len(sheets) == 1 else ("", "")


def _example(sheets: list[tuple[str, str]]) -> str:
    return "# " + " ".join(sheets[0]) if sheets else "# EXERCISE SEED"


def _name_in_paper(
    about: dict[str, Any], read: list[dict[Any, Any] | str], source: str, warning: str
) -> tuple[str, str]:
    """Whose notebook it is; the name may stand in any of the cells."""
    written = [name_in(answers.pop("student", None)) for answers in read if isinstance(answers, dict)]
    named, warning = _with_name(about, {"student": next(filter(None, written), None)}, source, warning)
    return name_in(named.get("student")), warning


def _with_name(
    about: dict[str, Any], answers: dict[Any, Any], source: str, warning: str
) -> tuple[dict[str, Any], str]:
    """A notebook that was nobody's: the name its reader wrote among the answers, or else the file's."""
    written = name_in(answers.pop("student", None))
    if name_in(about.get("student")):
        return about, warning
    if written:
        return {**about, "student": written}, warning
    note = "a notebook holds no name; its file's name stands for it"
    return {**about, "student": Path(source).stem}, warning or note


def _about(about: dict[str, Any], source: str) -> dict[str, str]:
    """What a notebook says of itself; one that was nobody's is called as its file."""
    named = {c: name_in(about.get(c)) for c in ("student", "exercise", "seed")}
    return {**named, "student": named["student"] or Path(source).stem, "part": "", "answer": ""}


def _code(cell: dict[str, Any]) -> str:
    code = cell.get("source", "")
    return "".join(map(str, code)) if isinstance(code, list) else str(code)


def _tags(cell: dict[str, Any]) -> list[Any]:
    metadata = cell.get("metadata")
    tags = metadata.get("tags") if isinstance(metadata, dict) else None
    return tags if isinstance(tags, list) else []


def literal_answers(code: str) -> dict[Any, Any] | str:
    """The dict that an answers cell holds, or what is wrong with the cell. Nothing is run.

    ``answers = {…}`` or a bare ``{…}`` of texts, numbers, None, and lists or tuples of these. A value that is none of
    them is the text that stands there; a cell that is no Python is read line by line.
    """
    if len(code) > 200_000:
        return "the answers cell is too long to be read"
    code = re.sub(r"\r\n?", "\n", code)
    found = _literal_answers(code)
    return found if isinstance(found, str) else _with_hidden(found, code)


def _literal_answers(code: str) -> dict[Any, Any] | str:
    try:
        statements = ast.parse(code).body
    except _NO_PYTHON:
        return _answers_by_line(code)
    if len(statements) != 1:
        return f"the answers cell must hold one dict and nothing else; found {len(statements)} statements"
    statement = statements[0]
    value = statement.value if isinstance(statement, (ast.Assign, ast.AnnAssign, ast.Expr)) else None
    if not isinstance(value, ast.Dict):
        return "the answers cell must hold one dict and nothing else; found code, which is never run"
    try:
        return object_once(_pairs(value, code))
    except _NO_PYTHON:
        return "the answers cell must hold texts and numbers only; found code, which is never run"


_NO_PYTHON = (SyntaxError, ValueError, TypeError, RecursionError, MemoryError)


def _pairs(found: ast.Dict, code: str) -> list[tuple[Any, Any]]:
    lines = [line.encode("utf-8", "replace") for line in code.split("\n")]

    def value(node: ast.expr) -> Any:
        try:
            return ast.literal_eval(node)
        except _NO_PYTHON:
            taken = lines[node.lineno - 1 : node.end_lineno]
            taken[-1] = taken[-1][: node.end_col_offset]
            taken[0] = taken[0][node.col_offset :]
            return b"\n".join(taken).decode("utf-8", "replace")

    keys = [key for key in found.keys if key is not None]
    if len(keys) < len(found.keys):
        raise ValueError("** is code")
    return [(value(key), value(item)) for key, item in zip(keys, found.values, strict=True)]


# ----------------------------------------------------------------- behind a hash

_HIDDEN = "an answer stands behind a #, where nothing is read"
_QUOTED_NUMBER = re.compile(r'"[^"]*[0-9][^"]*"')
_NUMBER_OF = re.compile(r"""[0-9]\s*["']?\s*,""")  #: as a line of the cell ends
_ENDS_IN_TEXT = re.compile(r"""(?:^|[{,])\s*(["'])([^"']+)\1\s*$""")
_ENDS_IN_KEY = re.compile(r"""(["'])([^"']+)\1\s*:\s*([^"'\s,{}][^"'{}]*)?$""")


def _with_hidden(found: dict[Any, Any], code: str) -> dict[Any, Any]:
    """The answers, and those that a # has cut off or hides, unless the same is answered elsewhere: ``"rA": 319#.8``,
    ``"rA": "1",  # mm "b": "2",``."""
    unread: list[tuple[Any, str, str]] = []
    for line in code.split("\n"):
        read, comment = _parted(line)
        for key, text, is_cut in _behind(read, comment):
            if is_cut or found.get(key) in (None, ""):
                unread.append((key, text, _HIDDEN))
    if not unread:
        return found
    gone = {key for key, _, _ in unread}
    return with_unread(found, unread, gone)


def _behind(read: str, comment: str) -> Iterator[tuple[str, str, bool]]:
    """The answers in a comment, by key, and whether what stands before the # is a part of it."""
    if (bare := _ENDS_IN_TEXT.search(read)) and re.search("[:0-9]", comment):
        yield bare[2], comment.strip(" :,}"), False
        return
    open_key = _ENDS_IN_KEY.search(read)
    if open_key and open_key[3] and not read[-1:].isspace() and comment:
        yield open_key[2], f"{open_key[3]}#{comment}", True
    elif open_key and not open_key[3] and re.search("[0-9\"']", comment):
        yield open_key[2], comment.strip(), False
    else:
        keys = list(_KEY.finditer(comment))
        ends = [*(key.start() for key in keys[1:]), len(comment)]
        for key, end in zip(keys, ends, strict=False):
            if (text := comment[key.end() : end].strip(" ,}")).strip("\"'"):
                yield key[2], text, False
        if not keys and (_QUOTED_NUMBER.search(comment) or (not read.strip() and _NUMBER_OF.search(comment))):
            yield "", f"{read}#{comment}".strip(), True  # whose it is cannot be told


def _parted(line: str) -> tuple[str, str]:
    """What stands on a line of Python before a #, and what behind it; a # in quotation marks is none."""
    quote, escaped = "", False
    for at, char in enumerate(line):
        if escaped:
            escaped = False
        elif char == "\\":
            escaped = bool(quote)
        elif quote:
            quote = "" if char == quote else quote
        elif char in "\"'":
            quote = char
        elif char == "#":
            return line[:at], line[at + 1 :]
    return line, ""


_OPENS = re.compile(r"(?:\w+\s*=\s*)?\{\s*")
_KEY = re.compile(r"""(["'])([^"']+)\1\s*:\s*""")
_QUOTED = re.compile(r"""(["'])([^"']*)\1""")


def _answers_by_line(code: str) -> dict[Any, Any] | str:
    """The answers of a cell that is no Python, each on its line as in the notebook, or which line is not."""
    pairs: list[tuple[Any, Any]] = []
    is_open = is_closed = False
    number, line = 0, ""
    for number, line in enumerate(map(str.strip, code.split("\n")), start=1):
        text = line
        if not is_open and (opening := _OPENS.match(text)):
            is_open, text = True, text[opening.end() :]
        if not text or text.startswith("#"):
            continue
        found = None if is_closed or not is_open else _pairs_of_line(text)
        if found is None and is_open and not is_closed and text.endswith("}"):
            is_closed, text = True, text[:-1].rstrip()
            found = _pairs_of_line(text) if text else []
        if found is None:
            return _not_as_written(number, line)
        pairs += found
    return object_once(pairs) if pairs else _not_as_written(number, line)


def _pairs_of_line(line: str) -> list[tuple[Any, Any]] | None:
    """The answers of a line; None where they cannot be told apart."""
    code = f"{{{line}\n}}"
    with suppress(*_NO_PYTHON):
        found = ast.parse(code, mode="eval").body
        return _pairs(found, code) if isinstance(found, ast.Dict) else None
    key = _KEY.match(line)
    if key is None:
        return None
    quoted = _QUOTED.match(line, key.end())
    rest = line[quoted.end() if quoted else key.end() :].partition("#")[0].strip().removesuffix(",").rstrip()
    if quoted:
        return [(key[2], quoted[2])] if not rest else None
    bare = rest[1:] if rest[:1] in ("'", '"') else rest
    bare = bare[:-1] if bare[-1:] in ("'", '"') else bare
    return [(key[2], bare.strip())] if not set(bare) & set("\"'{}:") else None


def _not_as_written(number: int, line: str) -> str:
    key = _KEY.match(line)
    part = f", part {key[2][:40]}" if key else ""
    return (
        f"the answers cell, line {number}{part}, is not written as in the notebook: quotes around text, "
        f"a comma after each answer; found {line[:40]!r}"
    )
