"""Statistics of a marked class, from the folder that ``grade`` wrote.

Texts are numbered as they are read, so that a line of ``marks.csv`` costs a few numbers whatever its
answer and feedback hold.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from coursework.gradebook.columns import VERDICTS
from coursework.gradebook.statistics.marks import Marks, family_of

RIGHT = ("correct", "follow_through", "accepted")
RECOGNISED = ("mistake", "slip")
TO_MARK = "to_mark"  #: for a person: neither right nor wrong yet

ENOUGH = 10  #: students below which a discrimination is chance
WEAK = 0.15  #: a discrimination below which a part is worth a look
BINS = 10  #: of the distribution of points

PART_COLUMNS = ("exercise", "part", "answers", "right", "mean", "discrimination", *VERDICTS)
MISTAKE_COLUMNS = ("exercise", "part", "kind", "mistake", "count", "share", "lost", "share_of_lost", "says")


# -------------------------------------------------------------------- measuring


@dataclass(frozen=True)
class PartStatistics:
    """Statistics of one part over a class; shares are from 0 to 1."""

    exercise: str
    part: str
    answers: int  #: lines, blank ones included
    students: int  #: who have one of them
    counts: Mapping[str, int]  #: by family of verdicts
    mean: float  #: mean share of the part's points: the lower, the harder
    discrimination: float | None  #: None where it cannot be computed
    lost: float  #: points

    def share(self, *families: str) -> float:
        return sum(self.counts[f] for f in families) / self.answers

    @property
    def right(self) -> float:
        """Share of the marked answers that are right: by themselves, relative to an earlier wrong one, or
        accepted by hand."""
        return sum(self.counts[f] for f in RIGHT) / self.marked if self.marked else 0.0

    @property
    def marked(self) -> int:
        """Number of answers that do not wait for a person."""
        return self.answers - self.counts[TO_MARK]

    def row(self) -> dict[str, Any]:
        """Return a line of ``parts.csv``: shares with four decimals."""
        r = self.discrimination
        return {
            "exercise": self.exercise,
            "part": self.part,
            "answers": self.answers,
            "right": round(self.right, 4),
            "mean": round(self.mean, 4),
            "discrimination": None if r is None else round(r, 4),
            **{f: round(self.share(f), 4) for f in VERDICTS},
        }


@dataclass(frozen=True)
class MistakeStatistics:
    """Statistics of a recognised mistake or slip, on one part or, where ``part`` is empty, on all of an
    exercise."""

    exercise: str
    part: str
    kind: str  #: mistake or slip
    name: str
    count: int
    share: float  #: of the answers to the part, or to the parts where it is met
    lost: float  #: points
    share_of_lost: float  #: of all points that the class lost on lines of marks.csv

    def row(self) -> dict[str, Any]:
        """Return a line of ``mistakes.csv``, without the words of its feedback."""
        return {
            "exercise": self.exercise,
            "part": self.part,
            "kind": self.kind,
            "mistake": self.name,
            "count": self.count,
            "share": round(self.share, 4),
            "lost": round(self.lost, 4),
            "share_of_lost": round(self.share_of_lost, 4),
        }


@dataclass(frozen=True)
class Statistics:
    """Statistics of a class."""

    students: int
    silent: int  #: students who handed in nothing
    unread: int  #: students who handed in, and nothing that could be marked
    answers: int  #: lines of marks.csv, blank ones included
    counts: Mapping[str, int]  #: of all lines, by family of verdicts
    without_line: int  #: answers asked for that no line holds
    rejected: int
    percents: np.ndarray  #: of the points each student could have, shape (students with points to have,)
    parts: tuple[PartStatistics, ...]  #: an exercise after another, in sheet order
    mistakes: tuple[MistakeStatistics, ...]  #: by part, the most frequent first

    @property
    def needs_a_look(self) -> int:
        """Number of answers that a person must check: unreadable, rejected, or to be marked by hand."""
        return self.counts["unreadable"] + self.rejected + self.counts[TO_MARK]

    @property
    def exercises(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(p.exercise for p in self.parts))

    def histogram(self) -> np.ndarray:
        """Return the number of students in each tenth of the points, shape (BINS,); a full score is in the
        last."""
        # A hair above its edge, so that rounding puts no 70 % below 70 %.
        position = np.floor(self.percents * BINS / 100 + 1e-9)
        return np.bincount(np.clip(position, 0, BINS - 1).astype(int), minlength=BINS)

    def mistakes_of_exercises(self) -> list[MistakeStatistics]:
        """Return the mistakes summed over an exercise's parts by name, the most frequent first."""
        groups: dict[tuple[str, str, str], list[MistakeStatistics]] = {}
        for item in self.mistakes:
            groups.setdefault((item.exercise, item.kind, item.name), []).append(item)
        answers = {(p.exercise, p.part): p.answers for p in self.parts}
        summed = [
            MistakeStatistics(
                *(exercise, "", kind, name),
                count=(count := sum(m.count for m in group)),
                share=count / sum(answers[m.exercise, m.part] for m in group),
                lost=sum(m.lost for m in group),
                share_of_lost=sum(m.share_of_lost for m in group),
            )
            for (exercise, kind, name), group in groups.items()
        ]
        return sorted(summed, key=lambda m: (-m.count, -m.lost))

    def as_json(self) -> dict[str, Any]:
        percents = self.percents
        some = percents.size > 0
        return {
            "students": self.students,
            "handed_in_nothing": self.silent,
            "handed_in_unreadable": self.unread,
            "answers": self.answers,
            "verdicts": dict(self.counts),
            "asked_without_line": self.without_line,
            "rejected": self.rejected,
            "percent": {
                "mean": round(float(percents.mean()), 2) if some else None,
                "median": round(float(np.median(percents)), 2) if some else None,
                "histogram": self.histogram().tolist(),
            },
            "parts": [p.row() for p in self.parts],
            "mistakes": [m.row() for m in self.mistakes],
        }


def measure(marks: Marks, sheet_order: Mapping[str, Sequence[str]] | None = None) -> Statistics:
    """Measure a class.

    ``sheet_order`` gives the part ids of exercises as their sheets print them; parts that it does not
    know follow, in the order they are met.
    """
    families = np.array([VERDICTS.index(family_of(v)) for v in marks.verdicts], dtype=int)
    family = families[marks.verdict]
    every, marks = marks, marked_lines(marks, family != VERDICTS.index(TO_MARK))
    n = len(marks.parts)
    answers, marked = np.bincount(every.part, minlength=n), np.bincount(marks.part, minlength=n)
    codes = every.part * len(VERDICTS) + family
    counts = np.bincount(codes, minlength=n * len(VERDICTS)).reshape(n, len(VERDICTS))
    share = marks.points / marks.out_of
    mean = np.bincount(marks.part, share, minlength=n) / np.maximum(marked, 1)
    lost = np.bincount(marks.part, marks.out_of - marks.points, minlength=n)
    askers = _askers(every)
    text = _discriminations(marks, share, askers)

    def place(index: int) -> tuple[int, int]:
        exercise, part = marks.parts[index]
        sheet_parts = list((sheet_order or {}).get(exercise, ()))
        return marks.exercises.index(exercise), sheet_parts.index(part) if part in sheet_parts else len(
            sheet_parts
        ) + index

    order = sorted(range(n), key=place)
    parts = tuple(
        PartStatistics(
            *marks.parts[i],
            answers=int(answers[i]),
            students=askers[i],
            counts=dict(zip(VERDICTS, counts[i].tolist(), strict=True)),
            mean=float(mean[i]),
            discrimination=text[i],
            lost=float(lost[i]),
        )
        for i in order
    )
    students = len(marks.students)
    with_line = np.bincount(every.student, minlength=students) > 0
    total = np.bincount(marks.student, marks.points, minlength=students)
    has = marks.issued > 0
    return Statistics(
        students=students,
        silent=students - int(np.count_nonzero(with_line)) - marks.unread,
        unread=marks.unread,
        answers=len(every.student),
        counts=dict(zip(VERDICTS, counts.sum(axis=0).tolist(), strict=True)),
        without_line=marks.without_line,
        rejected=marks.rejected,
        percents=100 * total[has] / marks.issued[has],
        parts=parts,
        mistakes=_mistakes(marks, answers, order, float(lost.sum())),
    )


def marked_lines(marks: Marks, marked: np.ndarray) -> Marks:
    """Return the marks without the lines that wait for a person, and without their points; ``marked`` is a
    mask of shape (lines,)."""
    if np.all(marked):
        return marks
    waiting = np.bincount(marks.student[~marked], marks.out_of[~marked], minlength=len(marks.students))
    lines = {
        name: getattr(marks, name)[marked] for name in ("student", "part", "verdict", "points", "out_of")
    }
    return replace(marks, **lines, issued=marks.issued - waiting)


def _askers(marks: Marks) -> list[int]:
    """Return for each part the number of students with a line of it."""
    students = max(1, len(marks.students))
    pairs = np.sort(marks.part * students + marks.student)
    pairs = pairs[np.diff(pairs, prepend=-1) > 0]
    return np.bincount(pairs // students, minlength=len(marks.parts)).tolist()


def _discriminations(marks: Marks, share: np.ndarray, askers: Sequence[int]) -> list[float | None]:
    """Return for each part the correlation of its points with the student's points on everything else.

    Both are shares, since variants may ask different parts; where all ask the same this is the
    correlation of the points themselves. What a student was asked and did not hand in counts as 0.
    """
    total = np.bincount(marks.student, marks.points, minlength=len(marks.students))
    others_out_of = marks.issued[marks.student] - marks.out_of
    # Out of the part alone there is no rest to compare with.
    compared = others_out_of > 1e-6 * marks.out_of
    rest = np.divide(
        total[marks.student] - marks.points, others_out_of, out=np.zeros_like(share), where=compared
    )
    lines = np.flatnonzero(compared)
    lines = lines[np.argsort(marks.part[lines], kind="stable")]
    ends = np.searchsorted(marks.part[lines], np.arange(len(marks.parts) + 1))
    results: list[float | None] = []
    for (start, end), students in zip(pairwise(ends), askers, strict=True):
        block = lines[start:end]
        enough = students >= ENOUGH and block.size > 0
        results.append(correlation(share[block], rest[block]) if enough else None)
    return results


def correlation(x: np.ndarray, y: np.ndarray) -> float | None:
    """Return Pearson's correlation of two samples; None where one of them does not vary."""
    if min(np.ptp(x), np.ptp(y)) < 1e-9:
        return None
    x, y = x - x.mean(), y - y.mean()
    return float((x * y).sum() / math.sqrt((x * x).sum() * (y * y).sum()))


def _mistakes(
    marks: Marks, answers: np.ndarray, order: Sequence[int], all_lost: float
) -> tuple[MistakeStatistics, ...]:
    recognised = np.array([family_of(v) in RECOGNISED for v in marks.verdicts], dtype=bool)
    lines = np.flatnonzero(recognised[marks.verdict])
    kinds = len(marks.verdicts)
    code, which = np.unique(marks.part[lines] * kinds + marks.verdict[lines], return_inverse=True)
    counts = np.bincount(which, minlength=len(code))
    lost = np.bincount(which, (marks.out_of - marks.points)[lines], minlength=len(code))
    rank = {index: position for position, index in enumerate(order)}
    results = []
    for item, count, points in zip(code.tolist(), counts.tolist(), lost.tolist(), strict=True):
        part, verdict = divmod(item, kinds)
        kind, _, name = marks.verdicts[verdict].partition(":")
        statistics = MistakeStatistics(
            marks.parts[part][0],
            marks.parts[part][1],
            kind,
            name,
            count=count,
            share=count / int(answers[part]),
            lost=points,
            share_of_lost=points / all_lost if all_lost > 0 else 0.0,
        )
        results.append((rank[part], statistics))
    results.sort(key=lambda f: (-f[1].count, f[0], f[1].kind, f[1].name))
    return tuple(statistics for _, statistics in results)
