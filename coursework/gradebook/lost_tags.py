"""Notebooks without their tags and metadata: some editors drop them, some people cut and join cells.

The printed text remains: the line with exercise, seed and version, the name, and cells with ``answers = {``.
Nothing is executed.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence
from typing import Any

from coursework.language.words import languages, words
from coursework.system import python_code

BEGINS = re.compile(r"^answers[ \t]*=[ \t]*\{", re.MULTILINE)
_VARIANT = re.compile(r"(?<!\w)([A-Za-z]\w*) · ([0-9]{1,30}) · v[0-9]{1,6}(?!\w)")
_ESCAPED = re.compile(r"\\([^A-Za-z0-9\s])")
_SHOWN = re.compile(r"\([ \t]*answers[ \t]*\)")
_PIECES = 6  #: cells that one may have been cut into


def source_of(cell: dict[str, Any]) -> str:
    code = cell.get("source", "")
    return "".join(map(str, code)) if isinstance(code, list) else str(code)


def printed_identity(cells: Sequence[dict[str, Any]]) -> dict[str, Any] | None:
    """Return the student and the variants that the text of a notebook states; None if it names no variant.

    In the form of the metadata that it lacks: ``exercise`` and ``seed``, or ``sheets`` for a paper.
    """
    text = _ESCAPED.sub(r"\1", "\n".join(source_of(c) for c in cells if c.get("cell_type") == "markdown"))
    variants = list(dict.fromkeys(_VARIANT.findall(text)))
    if not variants:
        return None
    lang = next(
        (language for language in languages() if f"# {words(language)['notebook']['answers']}" in text), ""
    )
    name = _name_in(text)
    commented = any(re.search(r"answers = \{[ \t]*#[ \t]*\w+[ \t]+[0-9]", source_of(c)) for c in cells)
    if len(variants) > 1 or commented:
        sheets = [{"exercise": exercise, "seed": seed} for exercise, seed in variants]
        return {"student": name.partition(" — ")[0], "sheets": sheets, "lang": lang}
    return {"student": name, "exercise": variants[0][0], "seed": variants[0][1], "lang": lang}


def _name_in(text: str) -> str:
    labels = "|".join(re.escape(str(words(lang)["sheet"]["name"])) for lang in languages())
    match = re.search(rf"\*\*(?:{labels})\s*:\*\*[^\S\n]*(\S.*)", text)
    return match[1].strip() if match else ""


def answers_texts(cells: Sequence[dict[str, Any]]) -> Iterator[tuple[int, str]]:
    """Return the cells that assign a dict to ``answers``, each with its position; a cell that was cut is
    joined again."""
    for position, cell in enumerate(cells):
        if cell.get("cell_type") == "code" and BEGINS.search(source_of(cell)):
            yield position, joined(cells, position)


def joined(cells: Sequence[dict[str, Any]], position: int) -> str:
    """Return the text of a cell of code, joined with the following cells that close its brackets; the cell
    alone if none do."""
    text = source_of(cells[position])
    code = text
    for behind in cells[position + 1 : position + _PIECES]:
        if _closes(code):
            return code
        if behind.get("cell_type") != "code":
            break
        code += "\n" + source_of(behind)
    return code if _closes(code) else text


def _closes(text: str) -> bool:
    """Return True if each brace opened outside quotation marks is closed."""
    bare = re.sub(r"""("{3}|'{3})[\s\S]*?\1|"[^"\n]*"|'[^'\n]*'|#[^\n]*""", "", text)
    return bare.count("{") <= bare.count("}")


def answers_statement(code: str) -> str:
    """Return the statement ``answers = {…}`` of a cell with more statements, if no other one uses the
    answers; else the whole text."""
    start = BEGINS.search(code)
    if start is None:
        return code
    try:
        assignments = [
            statement
            for statement in python_code.parse(code).body
            if isinstance(statement, ast.Assign)
            and isinstance(statement.value, ast.Dict)
            and _is_answers(statement.targets)
        ]
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        end = re.compile(r"^\}[ \t]*(?:#[^\n]*)?$", re.MULTILINE).search(code, start.start())
        span = (start.start(), end.end()) if end else (0, len(code))
    else:
        if len(assignments) != 1:
            return code
        lines = code.split("\n")
        first, last = assignments[0].lineno - 1, assignments[0].end_lineno or len(lines)
        span = (sum(len(line) + 1 for line in lines[:first]), sum(len(line) + 1 for line in lines[:last]) - 1)
    rest = _SHOWN.sub("()", code[: span[0]] + code[span[1] :])
    return code if re.search(r"\banswers\b", re.sub(r"#[^\n]*", "", rest)) else code[span[0] : span[1]]


def _is_answers(targets: Sequence[ast.expr]) -> bool:
    return len(targets) == 1 and isinstance(targets[0], ast.Name) and targets[0].id == "answers"
