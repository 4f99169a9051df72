"""Long lists, a hundred rows a page, with a search by name."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Generic, NamedTuple, TypeVar
from urllib.parse import urlencode

from coursework.issuing.students import folded
from coursework.site.frame.requests import Request

_ROWS = 100  #: of a page
Row = TypeVar("Row")


class ListPage(NamedTuple, Generic[Row]):
    """Rows of one page of a list."""

    rows: Sequence[Row]
    first: int  #: number of the first row, from 1 on
    total: int
    sought: str  #: name that is sought
    before: str  #: query of the page before; empty if there is none
    after: str

    @property
    def last(self) -> int:
        return self.first + len(self.rows) - 1

    @property
    def is_part(self) -> bool:
        """Return True if some rows are not on this page."""
        return bool(self.sought or self.before or self.after)


def page_of(
    request: Request, rows: Sequence[Row], name_of: Callable[[Row], str] | None = None
) -> ListPage[Row]:
    """Return the page of a list that the query states; of the rows alone whose name has what is sought, if
    their names are given."""
    query = dict(request.query_params)
    sought = query.get("find", "").strip()
    if name_of is not None and sought:
        rows = [row for row in rows if folded(sought) in folded(name_of(row))]
    pages = max(1, -(-len(rows) // _ROWS))
    stated = query.get("page", "")
    number = min(int(stated), pages) if stated.isdecimal() and 0 < len(stated) < 9 and int(stated) else 1
    before, after = (
        urlencode({**query, "page": other}) if 1 <= other <= pages else ""
        for other in (number - 1, number + 1)
    )
    start = (number - 1) * _ROWS
    return ListPage(rows[start : start + _ROWS], start + 1, len(rows), sought, before, after)
