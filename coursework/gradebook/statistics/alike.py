"""Sheets whose wrong answers are right on another variant, a sign of copying.

For the staff alone, and no proof: two students may have exchanged their papers.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from coursework.errors import first_few
from coursework.gradebook.statistics.marks import columns_of

COLUMNS = ("student", "exercise", "seed", "like seed", "issued to", "answers", "of")
FEWEST = 3  #: answers that are another variant's, before it is reported
SHARE = 0.5  #: of the numbers of a sheet that are not right
CLOSE = 0.002  #: of a value: rounding to three digits
_NAMES = 3  #: students that are named
_NUMBER = re.compile(r"-?\d*\.?\d+(?:e[-+]?\d+)?")


class AlikeSheet(NamedTuple):
    """Sheet whose wrong answers are right on another variant."""

    student: str
    exercise: str
    seed: str
    other: str  #: the seed on which they are right
    owners: tuple[str, ...]  #: who answered to that one
    answers: int
    of: int  #: numbers on the sheet that are not right

    def row(self) -> dict[str, Any]:
        """Return a line of ``alike.csv``."""
        text = first_few(self.owners, _NAMES)
        return dict(
            zip(
                COLUMNS,
                (self.student, self.exercise, self.seed, self.other, text, self.answers, self.of),
                strict=True,
            )
        )


def alike(folder: Path) -> list[AlikeSheet]:
    """Return the sheets of a folder of marks most of whose wrong answers are right on one other variant.

    Raises
    ------
    BadInput
        A line of ``marks.csv`` that lacks cells.
    """
    wanted = ("student", "exercise", "seed", "part", "read_as", "verdict")
    return alike_lines(columns_of(folder / "marks.csv", wanted))


def alike_lines(lines: Iterable[tuple[str, ...]]) -> list[AlikeSheet]:
    """Return the same of lines of marks: student, exercise, seed, part, reading and verdict."""
    right: dict[tuple[str, str], dict[str, float]] = defaultdict(dict)
    owners: dict[tuple[str, str], dict[str, None]] = defaultdict(dict)
    wrong: dict[tuple[str, str, str], list[tuple[str, float]]] = defaultdict(list)
    for student, exercise, seed, part, read_as, verdict in lines:
        owners[exercise, seed][student] = None
        if (value := _measured(read_as)) is None:
            continue
        if verdict == "correct":
            right[exercise, part].setdefault(seed, value)
        elif verdict not in ("unreadable", "missing"):
            wrong[student, exercise, seed].append((part, value))
    sorted_right = {position: _sorted(by_seed) for position, by_seed in right.items()}
    return [
        AlikeSheet(student, exercise, seed, other, tuple(owners[exercise, other]), count, len(answers))
        for (student, exercise, seed), answers in wrong.items()
        if len(answers) >= FEWEST
        for other, count in _likest(exercise, seed, answers, sorted_right)
        if count >= max(FEWEST, SHARE * len(answers))
    ]


def _measured(read_as: str) -> float | None:
    """Return a number with at least three digits; None for fewer, which agree by chance."""
    match = _NUMBER.match(read_as)
    if match is None or len(re.sub(r"e.*|\D", "", match[0]).lstrip("0")) < 3:
        return None
    return float(match[0])


def _sorted(by_seed: dict[str, float]) -> tuple[np.ndarray, list[str]]:
    seeds = sorted(by_seed, key=by_seed.__getitem__)
    return np.array([by_seed[seed] for seed in seeds]), seeds


def _likest(
    exercise: str,
    seed: str,
    answers: list[tuple[str, float]],
    right: dict[tuple[str, str], tuple[np.ndarray, list[str]]],
) -> Iterator[tuple[str, int]]:
    """Yield the other variant on which most answers are right, and their number."""
    counts: Counter[str] = Counter()
    for part, value in answers:
        values, seeds = right.get((exercise, part), (np.array([]), []))
        low, high = sorted((value * (1 - CLOSE), value * (1 + CLOSE)))
        counts.update(
            set(seeds[np.searchsorted(values, low) : np.searchsorted(values, high, "right")]) - {seed}
        )
    yield from counts.most_common(1)
