"""Answers in notebooks: cells with a literal, one per exercise, read and never executed."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from coursework.gradebook.lost_tags import (
    answers_statement,
    answers_texts,
    joined,
    printed_identity,
    source_of,
)
from coursework.gradebook.rows import (
    AnswerRow,
    Rejected,
    decoded_text,
    load_json,
    name_in,
    object_once,
    quoted,
    sheet_rows,
    short_fault,
    with_unread,
)
from coursework.messages import Message, joined_notes
from coursework.system import python_code

# --------------------------------------------------------------------- notebook

_SUBMITTED_BY = "handed in by"  #: among what a notebook says of itself: who its folder says


def read_notebook(data: bytes, source: str, by: str = "") -> Iterator[AnswerRow | Rejected]:
    """Yield the rows of a notebook; ``by`` is the person who submitted it, according to its folder."""
    for row in _read(data, source, by):
        if by and isinstance(row, Rejected) and not row.row.get("student"):
            row = replace(row, row={**row.row, "student": by})
        yield row


def _read(data: bytes, source: str, by: str) -> Iterator[AnswerRow | Rejected]:
    text, warning = decoded_text(data, source)
    try:
        notebook = load_json(text)
    except (ValueError, RecursionError) as fault:
        yield Rejected(source, Message("not a notebook: {problem}", problem=short_fault(fault)))
        return
    about = notebook.get("metadata", {}) if isinstance(notebook, dict) else {}
    about = about.get("coursework") if isinstance(about, dict) else None
    cells = notebook.get("cells") if isinstance(notebook, dict) else None
    if not isinstance(cells, list):
        yield Rejected(source, Message("not a notebook of ours: it has no cells"))
        return
    cells = [cell for cell in cells if isinstance(cell, dict)]
    notes = [warning] if warning else []
    if not isinstance(about, dict) or not (about.get("exercise") or isinstance(about.get("sheets"), list)):
        about = printed_identity(cells)
        if about is None:
            yield Rejected(
                source, Message("not a notebook of ours: it names no exercise, in its metadata or in print")
            )
            return
        notes.append(
            Message("{file}: its metadata is gone; student and variant are those printed in it", file=source)
        )
    about = {**about, _SUBMITTED_BY: by}
    if isinstance(about.get("sheets"), list):
        yield from _read_paper(about, cells, source, notes)
        return
    code, note = _answers_code(cells)
    if code is None:
        code_text = "\n".join(source_of(c) for c in cells if c.get("cell_type") == "code")
        row = _about(about, source) | {"answer": quoted(code_text)}
        yield Rejected(source, note, row)
        return
    answers, more = _answers_in(code)
    if isinstance(answers, str):
        yield Rejected(source, answers, _about(about, source) | {"answer": quoted(code)})
        return
    notes += [Message("{place}: {note}", place=source, note=text) for text in (note, more) if text]
    about, warning = _with_name(about, answers, source, joined_notes(notes))
    yield from sheet_rows(about, answers, source, warning)


_LONGEST = 200_000  #: characters of a cell of answers
NO_NAME = Message("a notebook contains no name; the name of its file is taken")
_NO_TAG = Message("no cell is tagged 'answers'; the one that begins with 'answers =' is read")
_OTHER = Message(
    "the cell tagged 'answers' is blank; the answers of another one that begins with 'answers =' are read"
)
_CUT = Message("the answers cell was cut into pieces; they are put together")


def _answers_code(cells: list[dict[str, Any]]) -> tuple[str | None, str]:
    """Return the code of the answers cell of one exercise, and a note about it; None and a reason if the cell
    cannot be identified."""
    tagged = [position for position, cell in enumerate(cells) if "answers" in _tags(cell)]
    named = dict(answers_texts(cells))
    tagged_texts = _filled(joined(cells, p) for p in tagged if len(tagged) == 1 or p in named)
    others = _filled(text for position, text in named.items() if position not in tagged)
    if len(tagged_texts) == 1 and (_has_answer(tagged_texts[0]) or not any(map(_has_answer, others))):
        return tagged_texts[0], "" if tagged_texts[0] in map(source_of, cells) else _CUT
    if len(others) == 1:
        return others[0], _OTHER if tagged else _NO_TAG
    count = len(tagged) if len(tagged_texts) != 1 else len(tagged) + len(others)
    return None, Message("one cell must be tagged 'answers'; found {count}", count=count)


def _filled(texts: Iterable[str]) -> list[str]:
    """Return the different texts that contain an answer; all if none does."""
    different = list(dict.fromkeys(texts))
    return [text for text in different if _has_answer(text)] or different


def _has_answer(code: str) -> bool:
    answers, _ = _answers_in(code)
    return isinstance(answers, str) or any(
        not (value is None or (isinstance(value, str) and not value.strip()))
        for name, value in answers.items()
        if name != "student"
    )


def _answers_in(code: str) -> tuple[dict[Any, Any] | str, str]:
    """Return the dict of an answers cell, or its fault; and a note if the cell contains more."""
    answers = literal_answers(code)
    if isinstance(answers, str) and len(code) <= _LONGEST and (bare := answers_statement(code)) != code:
        bare_answers = literal_answers(bare)
        if not isinstance(bare_answers, str):
            return bare_answers, Message(
                "the answers cell contains more than the answers; the rest is neither read nor run"
            )
    return answers, ""


# ------------------------------------------------------------------------ paper


def _read_paper(
    about: dict[str, Any], cells: list[dict[str, Any]], source: str, notes: list[str]
) -> Iterator[AnswerRow | Rejected]:
    """Yield the rows of a notebook of several exercises, with an answers cell for each."""
    sheets = [
        (name_in(s.get("exercise")), name_in(s.get("seed"))) for s in about["sheets"] if isinstance(s, dict)
    ]
    tagged = {
        location: _sheet_of(cell, sheets) for location, cell in enumerate(cells) if "answers" in _tags(cell)
    }
    sheets_tagged = {*tagged.values()}
    codes = [(sheet, joined(cells, location)) for location, sheet in tagged.items()]
    lost = [
        (_sheet_of(cells[location], sheets), text)
        for location, text in answers_texts(cells)
        if location not in tagged
    ]
    lost = [(sheet, text) for sheet, text in lost if sheet[0] and sheet not in sheets_tagged]
    notes += [
        Message("{place}: {note}", place=f"{source}, {exercise}", note=_NO_TAG) for (exercise, _), _ in lost
    ]
    read = [(sheet, _answers_in(code)[0], code) for sheet, code in (*codes, *lost)]
    name, warning = _name_in_paper(
        about, [cell_answers for _, cell_answers, _ in read], source, joined_notes(notes)
    )
    for (exercise, seed), cell_answers, code in read:
        identity = {
            "student": name,
            "exercise": exercise,
            "seed": seed,
            "lang": about.get("lang"),
            _SUBMITTED_BY: about[_SUBMITTED_BY],
        }
        location = f"{source}, {exercise}" if exercise else source
        if isinstance(cell_answers, str):
            yield Rejected(location, cell_answers, _about(identity, source) | {"answer": quoted(code)})
        elif not exercise:
            which = Message(
                "the exercise of an answers cell is unknown: write {example} after its {{",
                example="# " + " ".join(sheets[0]) if sheets else "# EXERCISE SEED",
            )
            yield Rejected(location, which, _about(identity, source) | {"answer": quoted(code)})
        else:
            yield from sheet_rows(identity, cell_answers, location, warning)
    there = {sheet for sheet, _, _ in read}
    others = (c for location, c in enumerate(cells) if location not in tagged)
    code = quoted("\n".join(source_of(c) for c in others if c.get("cell_type") == "code"))
    for exercise, seed in sheets:
        if (exercise, seed) not in there:
            identity = {"student": name, "exercise": exercise, "seed": seed}
            reason = Message(
                "no cell tagged 'answers' belongs to {exercise}, seed {seed}", exercise=exercise, seed=seed
            )
            yield Rejected(f"{source}, {exercise}", reason, _about(identity, source) | {"answer": code})
    if not sheets and not tagged:
        yield Rejected(source, Message("the notebook contains no answers"), _about({"student": name}, source))


_OF = re.compile(r"#[ \t]*(\w+)[ \t]+([0-9]{1,30})[ \t]*$", re.MULTILINE)


def _sheet_of(cell: dict[str, Any], sheets: list[tuple[str, str]]) -> tuple[str, str]:
    """Return exercise and seed of an answers cell: from its metadata, else from the comment at its head, else
    the only ones."""
    metadata = cell.get("metadata")
    own_metadata = metadata.get("coursework") if isinstance(metadata, dict) else None
    if isinstance(own_metadata, dict) and name_in(own_metadata.get("exercise")):
        return name_in(own_metadata["exercise"]), name_in(own_metadata.get("seed"))
    for stated in _OF.findall(re.sub(r"\r\n?", "\n", source_of(cell))):
        if stated in sheets:
            return stated
    return sheets[0] if len(sheets) == 1 else ("", "")


def _name_in_paper(
    about: dict[str, Any], read: list[dict[Any, Any] | str], source: str, warning: str
) -> tuple[str, str]:
    """Return the name of the student, which any of the cells may contain, and the warnings."""
    written = [name_in(answers.pop("student", None)) for answers in read if isinstance(answers, dict)]
    named, warning = _with_name(about, {"student": next(filter(None, written), None)}, source, warning)
    return name_in(named.get("student")), warning


def _with_name(
    about: dict[str, Any], answers: dict[Any, Any], source: str, warning: str
) -> tuple[dict[str, Any], str]:
    """Return the metadata with a student: that of the metadata, else the name written among the answers, else
    that of the folder, else the name of the file."""
    written = name_in(answers.pop("student", None))
    if name_in(about.get("student")):
        return about, warning
    if written:
        return {**about, "student": written}, warning
    if about[_SUBMITTED_BY]:
        return {**about, "student": about[_SUBMITTED_BY]}, warning
    return {**about, "student": Path(source).stem}, joined_notes((warning, NO_NAME))


def _about(about: dict[str, Any], source: str) -> dict[str, str]:
    """Return a row with the student, the exercise and the seed of a notebook; without a student, the name of
    its file."""
    named = {c: name_in(about.get(c)) for c in ("student", "exercise", "seed")}
    name = named["student"] or about.get(_SUBMITTED_BY) or Path(source).stem
    return {**named, "student": name, "part": "", "answer": ""}


def _tags(cell: dict[str, Any]) -> list[Any]:
    metadata = cell.get("metadata")
    tags = metadata.get("tags") if isinstance(metadata, dict) else None
    return tags if isinstance(tags, list) else []


def literal_answers(code: str) -> dict[Any, Any] | str:
    """Return the dict of an answers cell, or a message about its fault. Nothing is executed.

    ``answers = {…}`` or a bare ``{…}`` of texts, numbers, None, and lists or tuples of these. A value that is
    none of them is the text that stands there; a cell that is not Python is read line by line.
    """
    if len(code) > _LONGEST:
        return Message("the answers cell is too long to be read")
    code = re.sub(r"\r\n?", "\n", code)
    answers = _literal_answers(code)
    return answers if isinstance(answers, str) else _with_hidden(answers, code)


def _literal_answers(code: str) -> dict[Any, Any] | str:
    try:
        statements = python_code.parse(code).body
    except _NO_PYTHON:
        return _answers_by_line(code)
    if len(statements) != 1:
        return Message(
            "the answers cell must contain one dict and nothing else; found {count} statements",
            count=len(statements),
        )
    statement = statements[0]
    value = statement.value if isinstance(statement, (ast.Assign, ast.AnnAssign, ast.Expr)) else None
    if not isinstance(value, ast.Dict):
        return Message(
            "the answers cell must contain one dict and nothing else; found code, which is never run"
        )
    try:
        return object_once(_pairs(value, code))
    except _NO_PYTHON:
        return Message("the answers cell must contain texts and numbers only; found code, which is never run")


_NO_PYTHON = (SyntaxError, ValueError, TypeError, RecursionError, MemoryError)


def _pairs(literal: ast.Dict, code: str) -> list[tuple[Any, Any]]:
    lines = [line.encode("utf-8", "replace") for line in code.split("\n")]

    def value(node: ast.expr) -> Any:
        try:
            return ast.literal_eval(node)
        except _NO_PYTHON:
            source_lines = lines[node.lineno - 1 : node.end_lineno]
            source_lines[-1] = source_lines[-1][: node.end_col_offset]
            source_lines[0] = source_lines[0][node.col_offset :]
            return b"\n".join(source_lines).decode("utf-8", "replace")

    keys = [key for key in literal.keys if key is not None]
    if len(keys) < len(literal.keys):
        raise ValueError("** is code")
    return [(value(key), value(item)) for key, item in zip(keys, literal.values, strict=True)]


# ----------------------------------------------------------------- behind a hash

_HIDDEN = Message("an answer is behind a #, in a comment, which is not read")
_QUOTED_NUMBER = re.compile(r'"[^"]*[0-9][^"]*"')
_NUMBER_OF = re.compile(r"""[0-9]\s*["']?\s*,""")  #: as a line of the cell ends
_NUMBER_LAST = re.compile(r"""[0-9]\s*["']?\s*,\s*$""")  #: as the line of an answer ends
_NUMBER_ALONE = re.compile(r"""\s*["']?[-+]?[0-9][^,]*,\s*""")
_ENDS_IN_TEXT = re.compile(r"""(?:^|[{,])\s*(["'])([^"']+)\1\s*$""")
_ENDS_IN_KEY = re.compile(r"""(["'])([^"']+)\1\s*:\s*([^"'\s,{}][^"'{}]*)?$""")


def _with_hidden(answers: dict[Any, Any], code: str) -> dict[Any, Any]:
    """Return the answers, with those that a # cuts off or hides, unless the part is answered elsewhere:
    ``"rA": 319#.8``, ``"rA": "1",  # mm "b": "2",``."""
    unread: list[tuple[Any, str, str]] = []
    for line in code.split("\n"):
        read, comment = _parted(line)
        for key, text, is_cut in _behind(read, comment):
            if is_cut or answers.get(key) in (None, ""):
                unread.append((key, text, _HIDDEN))
    if not unread:
        return answers
    gone = {key for key, _, _ in unread}
    return with_unread(answers, unread, gone)


def _behind(read: str, comment: str) -> Iterator[tuple[str, str, bool]]:
    """Yield the answers in a comment: key, text, and True if the text before the # belongs to the answer."""
    if (bare := _ENDS_IN_TEXT.search(read)) and re.search("[:0-9]", comment):
        yield bare[2], comment.strip(" :,}"), False
        return
    open_key = _ENDS_IN_KEY.search(read)
    if open_key and open_key[3] and not read[-1:].isspace() and comment:
        yield open_key[2], f"{open_key[3]}#{comment}", True
    elif open_key and not open_key[3] and re.search("[0-9\"']", comment):
        yield open_key[2], comment.strip(), bool(_NUMBER_ALONE.fullmatch(comment))
    else:
        keys = list(_KEY.finditer(comment))
        ends = [*(key.start() for key in keys[1:]), len(comment)]
        for key, end in zip(keys, ends, strict=False):
            if (text := comment[key.end() : end].strip(" ,}")).strip("\"'"):
                yield key[2], text, False
        number = _NUMBER_LAST if read.strip() else _NUMBER_OF
        if not keys and (_QUOTED_NUMBER.search(comment) or number.search(comment)):
            yield "", f"{read}#{comment}".strip(), True  # its part cannot be identified


def _parted(line: str) -> tuple[str, str]:
    """Return the text of a line of Python before a # and after it; a # in quotation marks is ignored."""
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
    """Return the answers of a cell that is not Python, one per line as in the notebook, or a message about
    the faulty line."""
    pairs: list[tuple[Any, Any]] = []
    is_open = is_closed = False
    number, line = 0, ""
    for number, line in enumerate(map(str.strip, code.split("\n")), start=1):
        text = line
        if not is_open and (opening := _OPENS.match(text)):
            is_open, text = True, text[opening.end() :]
        if not text or text.startswith("#"):
            continue
        line_pairs = None if is_closed or not is_open else _pairs_of_line(text)
        if line_pairs is None and is_open and not is_closed and text.endswith("}"):
            is_closed, text = True, text[:-1].rstrip()
            line_pairs = _pairs_of_line(text) if text else []
        if line_pairs is None:
            return _not_as_written(number, line)
        pairs += line_pairs
    return object_once(pairs) if pairs else _not_as_written(number, line)


def _pairs_of_line(line: str) -> list[tuple[Any, Any]] | None:
    """Return the answers of a line; None if they cannot be separated."""
    code = f"{{{line}\n}}"
    with suppress(*_NO_PYTHON):
        literal = python_code.parse(code, mode="eval").body
        return _pairs(literal, code) if isinstance(literal, ast.Dict) else None
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
    if key := _KEY.match(line):
        return Message(
            "the answers cell, line {line}, part {part}, is not written as in the notebook: quotes "
            "around text, a comma after each answer; found {found!r}",
            line=number,
            part=key[2][:40],
            found=line[:40],
        )
    return Message(
        "the answers cell, line {line}, is not written as in the notebook: quotes around text, a comma "
        "after each answer; found {found!r}",
        line=number,
        found=line[:40],
    )
