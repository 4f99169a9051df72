"""Decisions of people on answers: accepted, given points, mark kept, or withdrawn; the last on an answer counts.

A folder of marks has them in ``decisions.csv``, in which a marking also lists the answers that a person marks; a database
has them in a table. ``accepted.csv``, ``to_mark.csv`` and ``by_hand.csv`` of folders of before are still read.
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any, NamedTuple

from coursework.errors import BadInput, counted, nearest
from coursework.gradebook.changes import lines_of
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.placing import UnplacedError, name_hint, sheet_of_row
from coursework.gradebook.rows import AnswerRow
from coursework.issuing.issued import Issued
from coursework.issuing.students import folded
from coursework.language.numbers import typed_number
from coursework.language.words import words
from coursework.marking.mark import Mark
from coursework.messages import Message, as_message
from coursework.system.limits import MOST_TABLE_BYTES

ACCEPTED, GIVEN, KEPT, WITHDRAWN = KINDS = ("accepted", "given", "kept", "withdrawn")
EDITED = "edited"  #: noted of a mark that was changed in ``marks.csv``; the next marking does not follow it
TO_MARK = "to_mark"  #: the verdict of an answer that waits for a person

DECISIONS_FILE = "decisions.csv"
DECISION_COLUMNS = (
    "student", "exercise", "seed", "part", "answer", "kind", "points", "out_of", "reason",
)  # fmt: skip
TO_MARK_FILE, ACCEPTED_FILE, EDITED_FILE = "to_mark.csv", "accepted.csv", "by_hand.csv"  #: of before
_NEEDED = ("student", "exercise", "part")
_OPTIONAL = ("seed", "points", "reason", "kind")
_ALIKE = 0.75  #: of two column names, beyond which one is the other with a typing error


class Decision(NamedTuple):
    """Decision of a person on an answer."""

    student: str  #: as it is written
    exercise: str
    seed: str  #: empty for whatever variant they have
    part: str
    kind: str
    points: float | None = None  #: None for all of them
    reason: str = ""
    answer: str | None = None  #: what was seen: another one is not decided on; None for whatever it is
    by: str = ""  #: person, or name of a file
    made: datetime | None = None
    line: int = 0  #: of the file
    location: str = ""  #: the same, for messages

    @property
    def key(self) -> tuple[str, str, str]:
        return folded(self.student), self.exercise, self.part

    @property
    def answer_id(self) -> tuple[str, str, str, str]:
        return self.student, self.exercise, self.seed, self.part

    @property
    def answer_text(self) -> str:
        return ", ".join(filter(None, self.answer_id))

    @property
    def gives(self) -> Message:
        return (
            Message("full points")
            if self.points is None
            else Message("points {points:g}", points=self.points)
        )

    def mark(self, line: Mark, lang: str) -> Mark:
        """Return the mark of an answer with this decision.

        Raises
        ------
        BadInput
            The part has fewer points.
        """
        if self.kind == KEPT:
            return line.saying(self.reason, self.reason)
        points = line.out_of if self.points is None else self.points
        check_points(points, line.part, line.out_of, self.location or self.by)
        verdict, word = ACCEPTED, "accepted"
        if self.kind == GIVEN:
            verdict = ACCEPTED if points >= line.out_of else "partial" if points > 0 else "wrong"
            word = "by_hand"
        message = f"{words(lang)['marking'][word]} {self.reason}".strip()
        return line._replace(verdict=verdict, points=points, says=message, feedback=message)


class Decisions:
    """Decisions in their order, and what they make of marked sheets."""

    def __init__(self, decisions: Iterable[Decision] = ()):
        self._of: dict[tuple[str, str, str], list[Decision]] = {}
        for decision in decisions:
            self._of.setdefault(decision.key, []).append(decision)

    def on(self, student: str, exercise: str, part: str) -> Sequence[Decision]:
        """Return all decisions on a student's answer, of any variant."""
        return self._of.get((folded(student), exercise, part), ()) if self._of else ()

    def standing(self, graded: Graded, line: Mark) -> Decision | None:
        """Return the decision that counts for an answer."""
        return next(self.counting(graded[:3], line), None)

    def counting(self, sheet: tuple[str, str, int], line: Mark) -> Iterator[Decision]:
        """Yield the decisions on exactly this answer of a sheet, the last first, as far as the last
        withdrawal."""
        student, exercise, seed = sheet
        for decision in reversed(self.on(student, exercise, line.part)):
            if decision.seed not in ("", str(seed)):
                continue
            if decision.kind == WITHDRAWN:
                return
            if decision.answer is None or same_answer(decision.answer, line.answer):
                yield decision

    def apply(self, graded: Graded) -> Graded:
        """Return the sheet with the decisions of people applied to its marks.

        Raises
        ------
        BadInput
            An answer is given more points than its part has.
        """
        if not self._of:
            return graded
        lines, unanswered = dict(graded.lines), list(graded.unanswered)
        for part, line in graded.lines.items():
            if (decision := self.standing(graded, line)) is not None:
                lines[part] = decision.mark(line, str(graded.record.get("lang", "fr")))
                if part not in (*graded.answered, *unanswered):
                    unanswered.append(part)
        return graded._replace(lines=lines, unanswered=tuple(unanswered))


def same_answer(text: str, other: str) -> bool:
    """Return True if two texts are the same answer, apart from spaces."""
    return " ".join(text.split()) == " ".join(other.split())


def check_points(points: float, part: str, out_of: float, location: str) -> None:
    """Refuse more points than a part has."""
    if points > out_of:
        raise BadInput(
            "{place}: {points:g} points for {part}, which has {out_of:g}; give at most these",
            place=location,
            points=points,
            part=part,
            out_of=out_of,
        )


# ------------------------------------------------------------------------ files


class DecisionFiles:
    """Files in which people write decisions: those of a folder of marks, and a file of accepted answers, by
    default ``accepted.csv`` of the folder.

    Raises
    ------
    BadInput
        A file cannot be read, a line names no answer, or its points are none.
    """

    def __init__(self, folder: Path | None, accepted: Path | None = None) -> None:
        self.path = None if folder is None else folder / DECISIONS_FILE
        self._before = None if folder is None else folder / TO_MARK_FILE
        self.files: dict[Path, list[Decision]] = {}
        self.headings: list[str] = []  #: what is wrong with them
        own = self._before if self.path and self._before and not self.path.exists() else self.path
        self._own: list[Decision] = self._read(own)
        if accepted is None and folder is not None and (folder / ACCEPTED_FILE).exists():
            accepted = folder / ACCEPTED_FILE
        self._read(accepted)
        self.decisions = Decisions(self.lines)
        self.is_edited = any(decision.kind == EDITED for decision in self._own)
        self.waiting = 0
        self.changed: list[str] = []  #: given points whose answers are not those that were marked
        self._rows: list[dict[str, Any]] = []  #: answers that a person marks
        self._used: set[Decision] = set()
        self._listed: set[Decision] = set()  #: decisions that these rows or the warnings state

    @property
    def lines(self) -> Iterator[Decision]:
        """Decisions of all files, in the order in which they count."""
        return (one for decisions in self.files.values() for one in decisions if one.kind != EDITED)

    def _read(self, path: Path | None) -> list[Decision]:
        if path is None or not (path.exists() or path.name not in (TO_MARK_FILE, DECISIONS_FILE)):
            return []
        found: list[Decision] = []
        for number, row, more in lines_of(path, MOST_TABLE_BYTES, (*_NEEDED, *_OPTIONAL)):
            location = Message("{file}, line {line}", file=path, line=number)
            if not found:
                self.headings += [
                    Message("{file}, line 1: {problem}", file=path, problem=wrong) for wrong in _misspelt(row)
                ]
            listed = path.name == TO_MARK_FILE or ("kind" in row and row.get("out_of", "") != "")
            decision = _decision(location, number, row, more, by=path.name, listed=listed)
            found += [decision] if decision is not None else []
        self.files[path] = found
        return found

    def follow(self, graded: Graded, decisions: Decisions) -> None:
        """Note which lines of the files are about a sheet, and list its answers that a person marks."""
        for part, mark in graded.lines.items():
            for decision in self.decisions.on(graded.student, graded.exercise, part):
                if decision.seed in ("", str(graded.seed)):
                    self._follow(decision, mark)
            if mark.verdict == TO_MARK:
                self._list(graded, mark, decisions)

    def _follow(self, decision: Decision, mark: Mark) -> None:
        self._used.add(decision)
        if decision.answer is not None and not same_answer(decision.answer, mark.answer):
            self._listed.add(decision)
            self.changed.append(decision.answer_text)
        elif decision.kind not in (KEPT, WITHDRAWN):
            check_points(decision.points or 0.0, mark.part, mark.out_of, decision.location)

    def _list(self, graded: Graded, mark: Mark, decisions: Decisions) -> None:
        counting = list(decisions.counting(graded[:3], mark))
        given = next((decision for decision in counting if decision.kind == GIVEN), None)
        self.waiting += not counting
        self._listed.update(
            decision
            for decision in self.decisions.on(graded.student, graded.exercise, mark.part)
            if decision.kind == GIVEN and decision.seed in ("", str(graded.seed))
        )
        row = _row(
            *graded[:3], mark.part, mark.answer, "", given and given.points, given.reason if given else ""
        )
        self._rows.append({**row, "out_of": f"{mark.out_of:g}"})

    @property
    def _unused(self) -> list[Decision]:
        """Given points of answers that nobody gave."""
        return [one for one in self._own if one.kind == GIVEN and one not in self._used]

    @property
    def lost(self) -> list[str]:
        """Warnings of points written in the file that its new version does not contain."""
        return [
            *(
                Message("marked by a person, but answered anew since: {answer}", answer=answer)
                for answer in self.changed
            ),
            *(
                Message("marked by a person, but never answered: {answer}", answer=one.answer_text)
                for one in self._unused
            ),
        ]

    def rows(self) -> list[dict[str, Any]]:
        """Return the lines of the new ``decisions.csv``: question by question the answers that a person marks,
        those without points first; then the other decisions as they were."""
        self._rows.sort(key=lambda row: (row["points"] != "", row["exercise"], row["part"]))
        return [*self._rows, *self.others({*self._listed, *self._unused})]

    def others(self, among: Iterable[Decision] = ()) -> list[dict[str, Any]]:
        """Return the lines of the decisions of ``decisions.csv`` as they were, except for those ``among``."""
        left = set(among)
        return [
            _row(*one.answer_id, one.answer or "", one.kind, one.points, one.reason)
            for one in self._own
            if one.kind != EDITED and one not in left
        ]

    @property
    def replaced(self) -> Path | None:
        """File that the new ``decisions.csv`` replaces."""
        return next((p for p in (self.path, self._before) if p is not None and p.exists()), None)

    # ------------------------------------------------------------------- checks

    def unfollowed(self, issued: Issued, students: Iterable[str]) -> tuple[list[str], list[str]]:
        """Return the faults of the files (unknown headings and names, contradictory lines), and the issued
        answers named in them that nobody gave. ``students`` are those who answered."""
        faults: list[str] = list(self.headings)
        notes: list[str] = []
        by_file = [
            [one for one in decisions if one.kind not in (GIVEN, EDITED)] for decisions in self.files.values()
        ]
        if not any(by_file):
            return faults, notes
        issued_parts = _IssuedParts(issued, tuple(students))
        for decision in (one for decisions in by_file for one in decisions if one not in self._used):
            note = Message("accepted by hand, but never answered: {answer}", answer=decision.answer_text)
            if why := issued_parts.why_not(decision):
                faults.append(
                    Message("{place}: {note}; {problem}", place=decision.location, note=note, problem=why)
                )
            else:
                notes.append(note)
        for decisions in by_file:
            faults += _contradictions(decisions, issued_parts)
        return faults, notes


def edited_row(change: Mapping[str, Any]) -> dict[str, Any]:
    """Return the line of ``decisions.csv`` about a mark that was changed in ``marks.csv``."""
    student, exercise, seed, part, answer = (
        change[c] for c in ("student", "exercise", "seed", "part", "answer")
    )
    points = float(change["points_now"])
    return _row(
        student,
        exercise,
        seed,
        part,
        answer,
        EDITED,
        points,
        f"{change['verdict_before']} → {change['verdict_now']}",
    )


def _row(
    student: str,
    exercise: str,
    seed: Any,
    part: str,
    answer: str,
    kind: str,
    points: float | None,
    reason: str,
) -> dict[str, Any]:
    shown = "" if points is None else f"{points:g}"
    values = student, exercise, seed, part, answer, kind, shown, "", reason
    return dict(zip(DECISION_COLUMNS, values, strict=True))


def _decision(
    location: str, number: int, row: Mapping[str, str], more: Sequence[str], *, by: str, listed: bool
) -> Decision | None:
    """Return the decision of a line; None if a marking ``listed`` the answer, and nobody has decided on it.

    A line without a kind gives points to a listed answer, and accepts any other.
    """
    points = points_of(row.get("points", ""), location)
    kind = row.get("kind", "") or (GIVEN if listed else ACCEPTED)
    if kind not in (*KINDS, EDITED):
        problem = Message(
            "no kind of decision {kind!r}{nearest}", kind=kind[:40], nearest=nearest(kind, KINDS)
        )
        raise BadInput("{file}: {problem}", file=location, problem=problem)
    if kind == GIVEN and points is None:
        if listed:
            return None
        problem = Message("points are given, or the answer is accepted: say how many")
        raise BadInput("{file}: {problem}", file=location, problem=problem)
    if missing := [c for c in _NEEDED if not row.get(c)]:
        raise BadInput(
            "{place}: {columns} missing; name the answer to accept",
            place=location,
            columns=", ".join(missing),
        )
    if any(cell.strip() for cell in more):
        raise BadInput(
            "{place}: {cells} more than there are headings, {found!r}; put a text with a comma, or a number with one, between quotation marks",
            place=location,
            cells=counted(len(more), "cell"),
            found=", ".join(more)[:40],
        )
    seed = re.sub(r"[.,]0+$", "", row.get("seed", ""))  # as spreadsheets write whole numbers
    answer = row.get("answer", "") if listed else row.get("answer") or None if "kind" in row else None
    named = row["student"], row["exercise"], seed, row["part"]
    return Decision(*named, kind, points, row.get("reason", ""), answer, by, None, number, location)


def _misspelt(columns: Iterable[str]) -> Iterator[str]:
    """Yield a message for each heading that looks like a misspelt optional heading."""
    columns = list(columns)
    absent = [c for c in _OPTIONAL if c not in columns]
    for column in columns:
        if column not in (*_NEEDED, *_OPTIONAL) and (
            meant := difflib.get_close_matches(column, absent, n=1, cutoff=_ALIKE)
        ):
            yield Message(
                "the column {column!r} is not read; did you mean {near!r}?", column=column, near=meant[0]
            )


def points_of(text: str, location: str) -> float | None:
    """Return the points in a cell; None for an empty cell."""
    if not text:
        return None
    points = typed_number(text)
    if not 0 <= points < math.inf:
        raise BadInput(
            "{place}: points are a number, 0 or more; found {found!r}", place=location, found=text[:40]
        )
    return points


def _contradictions(decisions: Sequence[Decision], issued_parts: _IssuedParts) -> Iterator[str]:
    """Yield a message for each line on an answer that gives other points than the line before it."""
    groups: dict[tuple[str, ...], list[Decision]] = {}
    for decision in decisions:
        groups.setdefault(decision.key, []).append(decision)
    for group in groups.values():
        for before, decision in _in_turn(group):
            if issued_parts.points(before) != issued_parts.points(decision):
                yield Message(
                    (
                        "{place}: {gives} for {answer}, but {before} in line {line}; line {last} counts: delete one of them"
                    ),
                    place=decision.location,
                    gives=decision.gives,
                    answer=decision.answer_text,
                    line=before.line,
                    before=before.gives,
                    last=decision.line,
                )


def _in_turn(decisions: Iterable[Decision]) -> Iterator[tuple[Decision, Decision]]:
    """Yield the accepted answers of one part of a student, each with the last line before it on the same
    variant; a line without a seed is on every variant."""
    last: dict[str, Decision] = {}  #: by seed
    latest: Decision | None = None
    for decision in decisions:
        if decision.kind != ACCEPTED:
            continue
        before = [last[seed] for seed in {decision.seed, ""} if seed in last] if decision.seed else [latest]
        earlier = max(filter(None, before), key=lambda other: other.line, default=None)
        if earlier is not None:
            yield earlier, decision
        last[decision.seed] = latest = decision


class _IssuedParts:
    """Parts of the issued variants, as lines of a file name them."""

    def __init__(self, issued: Issued, students: Sequence[str]) -> None:
        self._issued, self._students = issued, students
        self._answered = frozenset(map(folded, students))
        self._parts: dict[
            tuple[str, str], dict[str, float]
        ] = {}  #: points, by exercise and seed; of any seed by ""
        for (exercise, seed), record in issued.records.items():
            points = {str(part["id"]): float(part["points"]) for part in record["parts"]}
            self._parts[exercise, str(seed)] = points
            self._parts.setdefault((exercise, ""), {}).update(points)

    def why_not(self, decision: Decision) -> str:
        """Return the reason for which a line names no issued answer; empty if it names one."""
        issued, parts = self._issued, self._parts.get((decision.exercise, decision.seed))
        if not issued.has_roster and folded(decision.student) not in self._answered:
            return Message(
                "no student {student!r} among those who answered{hint}",
                student=decision.student,
                hint=name_hint(decision.student, self._students),
            )
        if issued.has_roster or parts is None:
            try:
                _, exercise, seed = sheet_of_row(
                    issued, AnswerRow(*decision.answer_id, None, decision.location)
                )
            except UnplacedError as why:
                return as_message(why)
            parts = self._parts[exercise, str(seed)]
        if decision.part in parts:
            return ""
        return Message(
            "{exercise} has no part {part!r}{nearest}",
            exercise=decision.exercise,
            part=decision.part,
            nearest=nearest(decision.part, parts),
        )

    def points(self, decision: Decision) -> float | None:
        """Return the points that a line gives; None for full points of an unknown part."""
        parts = self._parts.get((decision.exercise, decision.seed), {})
        return parts.get(decision.part) if decision.points is None else decision.points
