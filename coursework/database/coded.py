"""Class by the codes of its papers in place of names, for what is written of it as long as an answer
waits."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, TypeVar

from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.placing import Sheets
from coursework.gradebook.rows import Rejected
from coursework.issuing.issued import CODE, Issued
from coursework.messages import as_message

_Key = TypeVar("_Key", bound=tuple[Any, ...])
_Value = TypeVar("_Value")


def codes_of(issued: Issued) -> dict[str, str]:
    """Return the codes on the papers of an anonymous assignment by student, of a record read by name."""
    if not (issued.assignment or {}).get("anonymous"):
        return {}
    return {student: cells[CODE] for student, cells in issued.columns.items() if CODE in cells}


def by_code(table: Mapping[_Key, _Value], codes: Mapping[str, str]) -> dict[_Key, _Value]:
    """Return a table whose keys begin with a student by codes, in the order of these."""
    renamed: dict[Any, _Value] = {
        (codes.get(key[0], key[0]), *key[1:]): value for key, value in table.items()
    }
    return {key: renamed[key] for key in sorted(renamed, key=lambda key: str(key[0]))}


def coded_graded(graded: Graded, codes: Mapping[str, str]) -> Graded:
    """Return a marked sheet under the code of its student."""
    return graded._replace(student=codes.get(graded.student, graded.student))


def coded_row(row: Rejected, student: str, codes: Mapping[str, str]) -> Rejected:
    """Return a rejected row with codes in place of names, of the student whom it names and in its reason."""
    reason = as_message(row.reason)
    for name in sorted((name for name in codes if name in reason), key=len, reverse=True):
        reason = reason.replacing(name, codes[name])
    named = {"student": codes.get(student, student)} if student else {}
    return replace(row, reason=reason, row={**row.row, **named})


def coded_sheets(sheets: Sheets, codes: Mapping[str, str], named_by: Callable[[Rejected], str]) -> Sheets:
    """Return the rows of answers by codes; ``named_by`` returns the student whom a rejected row names."""
    return replace(
        sheets,
        sheets={
            key: {part: row._replace(student=key[0]) for part, row in rows.items()}
            for key, rows in by_code(sheets.sheets, codes).items()
        },
        rejected=[coded_row(row, named_by(row), codes) for row in sheets.rejected],
        warnings=[],
        langs=by_code(sheets.langs, codes),
        submitted=by_code(sheets.submitted, codes),
        apart={(codes.get(key[0], key[0]), *key[1:]) for key in sheets.apart},
    )
