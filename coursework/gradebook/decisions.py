"""Decisions of people on answers: accepted, given points, mark kept, or withdrawn; the last on an answer
counts.

A folder of marks has them in ``decisions.csv``, in which a marking also lists the answers that a person
marks; a database has them in a table. ``accepted.csv``, ``to_mark.csv`` and ``by_hand.csv`` of folders of
before are still read.
"""

from __future__ import annotations

import difflib
import math
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from datetime import datetime
from functools import cached_property
from pathlib import Path
from typing import Any

from coursework.errors import BadInput, counted, nearest
from coursework.gradebook.adjustments import ADJUSTMENTS, Adjustments, check_adjustment
from coursework.gradebook.changes import lines_of
from coursework.gradebook.decision import ACCEPTED as ACCEPTED
from coursework.gradebook.decision import EDITED as EDITED
from coursework.gradebook.decision import GIVEN as GIVEN
from coursework.gradebook.decision import KEPT as KEPT
from coursework.gradebook.decision import KINDS as KINDS
from coursework.gradebook.decision import TO_MARK as TO_MARK
from coursework.gradebook.decision import WITHDRAWN as WITHDRAWN
from coursework.gradebook.decision import Decision as Decision
from coursework.gradebook.decision import check_points as check_points
from coursework.gradebook.decision import in_force, same_answer, with_ids
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.placing import UnplacedError, name_hint, sheet_of_row
from coursework.gradebook.rows import AnswerRow
from coursework.issuing.issued import Issued
from coursework.issuing.students import folded
from coursework.language.numbers import typed_number
from coursework.marking.mark import Mark
from coursework.messages import Message, as_message
from coursework.parsing.scanned import names_pictures
from coursework.system.limits import MOST_TABLE_BYTES

DECISIONS_FILE = "decisions.csv"
DECISION_COLUMNS = (
    "student",
    "exercise",
    "seed",
    "part",
    "answer",
    "kind",
    "points",
    "out_of",
    "reason",
)
STEP_COLUMNS = ("by", "date", "id", "withdraws")  #: more columns where a line is a step, or has an id
TO_MARK_FILE, ACCEPTED_FILE, EDITED_FILE = "to_mark.csv", "accepted.csv", "by_hand.csv"  #: of before
_FILES = (DECISIONS_FILE, TO_MARK_FILE, ACCEPTED_FILE, EDITED_FILE)
_NEEDED = ("student", "exercise", "part")
_OPTIONAL = ("seed", "points", "reason", "kind")
_LONGEST_ID, _PREFIX = 40, 3
_SHOWN = 12  #: ids in a message
_ALIKE = 0.75  #: of two column names, beyond which one is the other with a typing error


class Decisions:
    """Decisions in their order, and what they make of marked sheets: those on an answer of a student, those
    on an answer whoever gave it, and adjustments of questions and of the scale."""

    def __init__(self, decisions: Iterable[Decision] = ()):
        self._of: dict[tuple[str, str, str], list[Decision]] = {}
        self.steps: list[Decision] = []  #: on no single student, in their order, those taken back included
        for decision in with_ids(decisions):
            if decision.student:
                self._of.setdefault(decision.key, []).append(decision)
            else:
                self.steps.append(decision)

    def renamed(self, name_of: Callable[[str], str]) -> Decisions:
        """Return the decisions under other names of their students."""
        return Decisions([*(one._replace(student=name_of(one.student)) for one in self.own), *self.steps])

    @cached_property
    def standing_steps(self) -> tuple[Decision, ...]:
        """Steps that are not taken back: a withdrawal takes back what it names, or the last one on the same
        place."""
        standing: list[Decision] = []
        named = {step.id for step in self.steps}
        for step in self.steps:
            if step.kind != WITHDRAWN:
                standing.append(step)
            elif step.withdraws in named:
                standing = [one for one in standing if one.id != step.withdraws]
            else:
                last = next((one for one in reversed(standing) if one.place == step.place), None)
                standing = [one for one in standing if one is not last]
        return tuple(standing)

    def put_aside(self, reasons: Iterable[str]) -> list[Decision]:
        """Return the standing decisions that give no points to answers of students, for one of these reasons
        or several of them in one batch."""
        given = [one for one in self._own_in_force if one.kind == GIVEN and not one.points]
        wanted, batches = {*reasons}, Counter(one.id for one in given if one.id)
        return [one for one in given if one.reason in wanted or batches[one.id] > 1]

    @cached_property
    def _own_in_force(self) -> list[Decision]:
        return [one for decisions in self._of.values() for one in in_force(decisions)]

    def called(self, name: str) -> list[Decision]:
        """Return the standing decisions of an id, or of the only one that begins so by three letters at
        least; those of one batch together.

        Raises
        ------
        BadInput
            There are none, since they are taken back or never were, or several ids begin so.
        """
        standing = [*self.standing_steps, *self._own_in_force]
        long_enough = len(name) >= _PREFIX
        ids = sorted(
            {one.id for one in standing if one.id == name or (long_enough and one.id.startswith(name))}
        )
        if name in ids or len(ids) == 1:
            return [one for one in standing if one.id == (name if name in ids else ids[0])]
        if len(ids) > 1:
            raise BadInput(
                "{name!r} begins several decisions: {found}", name=name[:40], found=", ".join(ids[:_SHOWN])
            )
        if any(one.id == name for one in (*self.own, *self.steps)):
            raise BadInput("decision {name} is taken back already", name=name)
        shown = list(dict.fromkeys(one.id for one in standing if one.id))
        raise BadInput(
            "no decision {name!r}; those that stand are {found}",
            name=name[:40],
            found=", ".join(shown[-_SHOWN:]) or "–",
        )

    @cached_property
    def adjustments(self) -> Adjustments:
        """Adjustments of questions and of the scale."""
        return Adjustments(step for step in self.standing_steps if step.kind in ADJUSTMENTS)

    @cached_property
    def _of_all(self) -> dict[tuple[str, str], list[Decision]]:
        """Decisions on an answer whoever gave it, by exercise and part."""
        of_all: dict[tuple[str, str], list[Decision]] = {}
        for step in self.standing_steps:
            if step.kind not in ADJUSTMENTS:
                of_all.setdefault((step.exercise, step.part), []).append(step)
        return of_all

    @property
    def own(self) -> list[Decision]:
        """Decisions on an answer of a student, those on one answer in their order."""
        return [one for decisions in self._of.values() for one in decisions]

    def with_steps(self, steps: Iterable[Decision]) -> Decisions:
        """Return these decisions with some more."""
        return Decisions((*self.own, *self.steps, *steps))

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
        own = [one for one in self.on(student, exercise, line.part) if one.seed in ("", str(seed))]
        for decision in reversed(in_force(own)):
            if decision.answer is None or same_answer(decision.answer, line.answer):
                yield decision
        for step in reversed(self._of_all.get((exercise, line.part), ()) if self.steps else ()):
            if step.seed in ("", str(seed)) and step.is_on(line):
                yield step

    def apply(self, graded: Graded) -> Graded:
        """Return the sheet with the decisions of people applied to its marks.

        Raises
        ------
        BadInput
            An answer is given more points than its part has.
        """
        if not self._of and not self.steps:
            return graded
        lines, unanswered, settled = dict(graded.lines), list(graded.unanswered), []
        for part, line in graded.lines.items():
            if (decision := self.standing(graded, line)) is not None:
                settled.append(part)
                lines[part] = decision.mark(line, str(graded.record.get("lang", "fr")))
                if part not in (*graded.answered, *unanswered):
                    unanswered.append(part)
        return graded._replace(lines=lines, unanswered=tuple(unanswered), settled=tuple(settled))


# ------------------------------------------------------------------------ files


class DecisionFiles:
    """Files in which people write decisions: those of a folder of marks, and a file of accepted answers, by
    default ``accepted.csv`` of the folder; ``renamed`` returns the name under which the record shows a
    student.

    Raises
    ------
    BadInput
        A file cannot be read, a line names no answer, or its points are none.
    """

    def __init__(
        self, folder: Path | None, accepted: Path | None = None, renamed: Callable[[str], str] = str
    ) -> None:
        self._renamed = renamed
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
        self.on_scans = 0  #: of these, pictures
        self.changed: list[str] = []  #: given points whose answers are not those that were marked
        self._rows: list[dict[str, Any]] = []  #: answers that a person marks
        self._ids = {one.id for one in self._own if one.id}
        self._used: set[Decision] = set()
        self._listed: set[Decision] = set()  #: decisions that these rows or the warnings state

    @property
    def lines(self) -> Iterator[Decision]:
        """Decisions of all files, in the order in which they count: the steps of ``decisions.csv`` last,
        since it also states what is taken back of the others."""
        for decisions in reversed(self.files.values()):
            yield from (one for one in decisions if not one.student and one.kind != EDITED)
        for decisions in self.files.values():
            yield from (one for one in decisions if one.student and one.kind != EDITED)

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
            if decision is not None:
                found.append(decision._replace(student=self._renamed(decision.student)))
        self.files[path] = found = with_ids(found)
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
        self.on_scans += not counting and names_pictures(mark.answer)
        self._listed.update(
            decision
            for decision in self.decisions.on(graded.student, graded.exercise, mark.part)
            if decision.kind == GIVEN and decision.seed in ("", str(graded.seed))
        )
        row = _row(
            *graded[:3], mark.part, mark.answer, "", given and given.points, given.reason if given else ""
        )
        self._rows.append(
            {**row, "out_of": f"{mark.out_of:g}"}
            | (_signature(given) if given and given.id in self._ids else {})
        )

    @property
    def _unused(self) -> list[Decision]:
        """Given points of answers that nobody gave."""
        return [one for one in self._own if one.student and one.kind == GIVEN and one not in self._used]

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
        """Return the lines of the new ``decisions.csv``: question by question the answers that a person
        marks, those without points first; then the other decisions as they were."""
        self._rows.sort(key=lambda row: (row["points"] != "", row["exercise"], row["part"]))
        return [*self._rows, *self.others({*self._listed, *self._unused})]

    def others(self, among: Iterable[Decision] = ()) -> list[dict[str, Any]]:
        """Return the lines of the decisions of ``decisions.csv`` as they were, except for those ``among``."""
        left = set(among)
        return [row_of(one) for one in self._own if one.kind != EDITED and one not in left]

    @property
    def columns(self) -> tuple[str, ...]:
        """Columns of the new ``decisions.csv``."""
        has_steps = any(not one.student or one.id for one in self._own)
        return (*DECISION_COLUMNS, *STEP_COLUMNS) if has_steps else DECISION_COLUMNS

    def add(self, decisions: Iterable[Decision]) -> None:
        """Add decisions as last lines of ``decisions.csv``; they count at once."""
        self._own += decisions
        self._ids = {one.id for one in self._own}
        if self.path is not None:
            self.files[self.path] = self._own
        self.decisions = Decisions(self.lines)

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
            [one for one in decisions if one.student and one.kind not in (GIVEN, EDITED)]
            for decisions in self.files.values()
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


def row_of(one: Decision) -> dict[str, Any]:
    """Return the line of ``decisions.csv`` of a decision, with who made it, and the day."""
    row = _row(*one.answer_id, one.answer or "", one.kind, one.points, one.reason)
    return row | _signature(one)


def _signature(one: Decision) -> dict[str, str]:
    """Return the last cells of the line of a decision with an id; a person signs, and no file."""
    if not one.id:
        return {}
    by = "" if one.student and one.by in _FILES else one.by
    day = one.made.astimezone().date().isoformat() if one.made else ""
    return {"by": by, "date": day, "id": one.id, "withdraws": one.withdraws}


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
    shown = "" if points is None else f"{points:.10g}"
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
    if kind not in (*KINDS, *ADJUSTMENTS, EDITED):
        problem = Message(
            "no kind of decision {kind!r}{nearest}",
            kind=kind[:40],
            nearest=nearest(kind, (*KINDS, *ADJUSTMENTS)),
        )
        raise BadInput("{file}: {problem}", file=location, problem=problem)
    if kind in ADJUSTMENTS or (not row.get("student") and (row.get("answer") or kind == WITHDRAWN)):
        return _step(location, number, row, kind, points, by)
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
            "{place}: {cells} more than there are headings, {found!r}; put a text with a comma, or a "
            "number with one, between quotation marks",
            place=location,
            cells=counted(len(more), "cell"),
            found=", ".join(more)[:40],
        )
    seed = re.sub(r"[.,]0+$", "", row.get("seed", ""))  # as spreadsheets write whole numbers
    answer = row.get("answer", "") if listed else row.get("answer") or None if "kind" in row else None
    named = row["student"], row["exercise"], seed, row["part"]
    signed = row.get("by") or by, _made(row)
    return Decision(
        *named, kind, points, row.get("reason", ""), answer, *signed, number, location, *_ids(row)
    )


def _made(row: Mapping[str, str]) -> datetime | None:
    with suppress(ValueError):
        return datetime.fromisoformat(row.get("date", ""))
    return None


def _step(
    location: str, number: int, row: Mapping[str, str], kind: str, points: float | None, by: str
) -> Decision:
    """Return the step of a line, on no single student."""
    if row.get("student"):
        raise BadInput(
            "{place}: {kind} is for everybody: leave the column student empty", place=location, kind=kind
        )
    seed = re.sub(r"[.,]0+$", "", row.get("seed", ""))
    named = "", row.get("exercise", ""), seed, row.get("part", "")
    answer, by = row.get("answer") or None, row.get("by") or by
    return Decision(
        *named, kind, points, row.get("reason", ""), answer, by, _made(row), number, location, *_ids(row)
    )


def _ids(row: Mapping[str, str]) -> tuple[str, str]:
    """Return the id of a line, and of what it takes back."""
    return row.get("id", "")[:_LONGEST_ID], row.get("withdraws", "")[:_LONGEST_ID]


def check_steps(steps: Iterable[Decision], issued: Issued) -> None:
    """Refuse a step on a question that was not issued, or with a value that makes no sense.

    Raises
    ------
    BadInput
        There is one; the message names its line.
    """
    worth: dict[str, dict[str, float]] = {}
    for (exercise, _), record in issued.records.items():
        worth.setdefault(exercise, {}).update((str(p["id"]), float(p["points"])) for p in record["parts"])
    for step in steps:
        if step.kind in ADJUSTMENTS:
            check_adjustment(step, worth)
        elif step.part not in worth.get(step.exercise, {}):
            raise BadInput(
                "{exercise} has no part {part!r}{nearest}",
                exercise=step.exercise,
                part=step.part,
                nearest=nearest(step.part, worth.get(step.exercise, ())),
            )


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
                        "{place}: {gives} for {answer}, but {before} in line {line}; line {last} "
                        "counts: delete one of them"
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
        #: Points, by exercise and seed; of any seed by "".
        self._parts: dict[tuple[str, str], dict[str, float]] = {}
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
