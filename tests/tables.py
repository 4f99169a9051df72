"""Tests over a table: one test for all rows, which lists each row that fails."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Collection, Iterable, Sequence
from typing import Any

import pytest

_SHOWN = 40  #: failing rows that are listed


def each_row(
    names: str | Sequence[str], rows: Iterable[Any]
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Run a test for each row of a table, as one test that fails with a list of the rows that fail.

    The arguments are those of ``pytest.mark.parametrize``. Fixtures are made once for all rows.
    """
    columns = [name.strip() for name in names.split(",")] if isinstance(names, str) else list(names)
    rows = rows if isinstance(rows, Collection) else list(rows)

    def of_all_rows(test: Callable[..., None]) -> Callable[..., None]:
        @functools.wraps(test)
        def run(**fixtures: Any) -> None:
            # Some tables are filled after the test is defined.
            lines = [_values(row, len(columns)) for row in rows]
            assert lines, "a table without rows tests nothing"
            failures: list[tuple[Any, BaseException]] = []
            for line in lines:
                try:
                    test(**dict(zip(columns, line, strict=True)), **fixtures)
                except (Exception, pytest.fail.Exception) as error:
                    failures.append((line, error))
            if failures:
                listed = "\n".join(
                    f"{_shown(line)}: {_first_line(error)}" for line, error in failures[:_SHOWN]
                )
                text = f"{len(failures)} of {len(lines)} rows fail\n{listed}"
                raise AssertionError(text) from failures[0][1]

        parameters = inspect.signature(test).parameters.values()
        run.__signature__ = inspect.Signature([p for p in parameters if p.name not in columns])  # type: ignore[attr-defined]
        del run.__wrapped__  # type: ignore[attr-defined]
        return run

    return of_all_rows


def _values(row: Any, count: int) -> tuple[Any, ...]:
    if hasattr(row, "marks"):  # pytest.param
        assert not row.marks, "a row of a table has no marks"
        return tuple(row.values)
    return (row,) if count == 1 else tuple(row)


def _shown(line: tuple[Any, ...]) -> str:
    text = ", ".join(map(repr, line))
    return text if len(text) <= 160 else text[:157] + "..."


def _first_line(error: BaseException) -> str:
    lines = str(error).strip().splitlines() or [""]
    return f"{type(error).__name__}: {lines[0][:200]}"
