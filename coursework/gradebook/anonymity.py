"""Lifting of the anonymity of an assignment, once its marks are final."""

from __future__ import annotations

import datetime
from collections.abc import Callable
from pathlib import Path
from typing import Any

from coursework.errors import BadInput
from coursework.issuing.issued import CODES, LIFTED
from coursework.system.build_folder import count_as_built
from coursework.system.json_files import read_json
from coursework.system.tables import json_text
from coursework.system.writing import write_whole


def lift(issued: Path, waiting: Callable[[], int], today: datetime.date | None = None) -> None:
    """Write the day into ``issued.json``, from which on names take the place of codes; nothing if they do
    already.

    ``waiting`` marks, and returns the number of answers that wait for a person.

    Raises
    ------
    BadInput
        The assignment has no codes, or an answer waits.
    """
    content = read_json(issued)
    if not content.get(CODES):
        raise BadInput("{file}: the papers bear names: no anonymity to lift", file=issued)
    if content.get(LIFTED):
        return
    if count := waiting():
        raise BadInput(
            "names stay hidden as long as an answer waits ({count} to look at): decide what waits, then lift",
            count=count,
        )
    day = (today or datetime.date.today()).isoformat()
    dated: dict[str, Any] = {}
    for key, value in content.items():  # in the order in which a build writes them
        dated |= {key: value, **({LIFTED: day} if key == CODES else {})}
    write_whole(issued, json_text(dated).encode())
    count_as_built(issued)
