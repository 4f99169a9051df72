"""Marking of a class, sheet by sheet, on all processors."""

from __future__ import annotations

import itertools
from collections import Counter, deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any, NamedTuple

from coursework.course.course import Course, opened
from coursework.course.key_batch import keys_of
from coursework.course.marking_rules import Rules
from coursework.course.variant import Variant
from coursework.errors import BadCourse, BadInput, CourseworkError, NoSolution, counted
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.placing import SheetKey, Sheets, as_texts
from coursework.gradebook.rows import Rejected
from coursework.issuing.issued import Issued
from coursework.language.words import words
from coursework.marking.feedback import Sentence, right_texts
from coursework.marking.mark import Mark
from coursework.marking.marking import mark
from coursework.marking.plain_answers import plainly_right
from coursework.messages import Message, as_message
from coursework.model import Part
from coursework.system.garbage import paused_collection
from coursework.system.processes import Task, in_turn, workers

CHUNK = 500  #: sheets marked together, at least
_MOST = 2000  #: at most: the keys of many variants of one exercise cost little more than those of few
_KNOWN = 8000  #: variants whose keys are kept for the next chunks
WORTH_PROCESSES = 20_000  #: answers; fewer are marked before a process has started


# ------------------------------------------------------------------------ marking


class _SheetJob(NamedTuple):
    """A sheet to mark: its issued record, and its answers by part."""

    record: Mapping[str, Any]
    answers: Mapping[str, Any]


def rules_of(course: Course, issued: Issued) -> Rules | None:
    """Return the course's rules of marking, overridden by the assignment's; None if the assignment states
    none.

    Raises
    ------
    BadInput
        A rule does not exist, or a value makes no sense.
    """
    stated = (issued.assignment or {}).get("marking")
    if not stated:
        return None
    try:
        return Rules.of(stated, Message("the assignment in issued.json"), course.folder.rules)
    except BadCourse as fault:
        raise BadInput(as_message(fault)) from fault


def marked(course: Course, issued: Issued, sheets: Sheets) -> Iterator[Graded]:
    """Yield the marked sheets, in their order.

    A sheet that cannot be marked affects no other: its rows are added to the rejected ones, with a warning.

    Raises
    ------
    NoSolution
        The course cannot mark.
    """
    return _rejecting(sheets, _judged(course, issued, sheets))


def rejecting(sheets: Sheets, results: Iterable[tuple[SheetKey, Graded | str]]) -> Iterator[Graded]:
    """Yield the sheets that could be marked; add the rows of the others to the rejected rows, with the
    reason."""
    return _rejecting(sheets, ((sheets, *result) for result in results))


_MarkedSheet = tuple[Sheets, SheetKey, Graded | str]  #: a sheet, among which it is, and what became of it


def _rejecting(sheets: Sheets, results: Iterable[_MarkedSheet]) -> Iterator[Graded]:
    unmarked: Counter[tuple[str, str]] = Counter()
    for among, sheet, result in results:
        if not isinstance(result, str):
            yield result
            continue
        unmarked[sheet[1], result] += 1
        reason = Message("cannot be marked; it waits for a person ({problem})", problem=result)
        rows = among.sheets[sheet].values()
        sheets.rejected += [Rejected(row.source, reason, as_texts(row)) for row in rows]
    for (exercise, why), count in unmarked.items():
        sheets.warnings.append(
            Message(
                "{sheets} of {exercise} cannot be marked, see the rejected rows: {problem}",
                sheets=counted(count, "sheet"),
                exercise=exercise,
                problem=why,
            )
        )


def judged(course: Course, issued: Issued, sheets: Sheets) -> Iterator[tuple[SheetKey, Graded | str]]:
    """Yield each sheet with its marks, or with the reason for which it cannot be marked, in their order.

    Raises
    ------
    NoSolution
        The course cannot mark.
    """
    return ((sheet, result) for _, sheet, result in _judged(course, issued, sheets))


def _judged(course: Course, issued: Issued, sheets: Sheets) -> Iterator[_MarkedSheet]:
    sent: deque[tuple[Sheets, list[SheetKey]]] = deque()  #: chunks that are being marked

    def chunks() -> Iterator[list[_SheetJob]]:
        for among in sheets.parts(size):
            places = list(among.sheets)
            for start in range(0, len(places), size):
                chunk = places[start : start + size]
                sent.append((among, chunk))
                yield [_sheet_job(issued, among, sheet) for sheet in chunk]

    count = workers(sheets.answers, WORTH_PROCESSES)
    size = min(max(CHUNK, sheets.count // (4 * count)), _MOST)
    rules = rules_of(course, issued)
    for results in _marked_chunks(course, chunks(), size, count, rules):
        among, chunk = sent.popleft()
        for sheet, result in zip(chunk, results, strict=True):
            yield among, sheet, result if isinstance(result, str) else _graded(issued, among, sheet, result)


def _sheet_job(issued: Issued, sheets: Sheets, sheet: SheetKey) -> _SheetJob:
    answers = {part: row.answer for part, row in sheets.sheets[sheet].items()}
    return _SheetJob(record_of(issued, sheets, sheet), answers)


def record_of(issued: Issued, sheets: Sheets, sheet: SheetKey) -> Mapping[str, Any]:
    """Return the record against which a sheet is marked: in the language in which it was answered, and with
    the parts that a platform asked, if it asks them one by one."""
    record = issued.record_of(*sheet[:3])
    if sheet in sheets.apart:
        record = {**record, "parts": [p for p in record["parts"] if p["id"] in sheets.sheets[sheet]]}
    return {**record, "lang": sheets.langs[sheet]} if sheet in sheets.langs else record


def _graded(issued: Issued, sheets: Sheets, sheet: SheetKey, sent: Sequence[tuple[Any, ...]]) -> Graded:
    lines = {line.part: line for line in map(Mark._make, sent)}
    sitting = sheet[3] or issued.sitting_of(*sheet[:3])
    record = record_of(issued, sheets, sheet)
    graded = Graded(*sheet[:3], lines, tuple(sheets.sheets[sheet]), record, sitting=sitting)
    return graded._replace(submitted=sheets.submitted.get(sheet, ""), apart=sheet in sheets.apart)


def _marked_chunks(
    course: Course, chunks: Iterator[list[_SheetJob]], size: int, count: int, rules: Rules | None
) -> Iterator[list[list[tuple] | str]]:
    """Yield each chunk of ``size`` sheets marked, in order; ``count`` processes share them."""
    if count < 2:
        known: dict[str, Variant] = {}
        for chunk in chunks:
            yield _mark_chunk(course, chunk, rules, known)
        return
    root, first = str(course.folder.root), itertools.count(1, size)
    yield from in_turn(
        (Task(f"sheet {next(first)} on", _mark_elsewhere, (root, chunk, rules)) for chunk in chunks), count
    )


@cache
def _known(root: str) -> dict[str, Variant]:
    """Return the variants of a course that this process knows, where it marks for another: a worker of a
    cluster serves several courses, and a corrected one has the same records."""
    return {}


def _mark_elsewhere(root: str, chunk: list[_SheetJob], rules: Rules | None) -> list[list[tuple] | str]:
    return _mark_chunk(opened(root, Variant), chunk, rules, _known(root))


def _mark_chunk(
    course: Course, chunk: Sequence[_SheetJob], rules: Rules | None, known: dict[str, Variant]
) -> list[list[tuple] | str]:
    """Return the lines of each sheet, or the reason for which it cannot be marked. Variants that are
    ``known`` from the chunks before keep the keys that were computed for them."""
    # Sheets of one variant share its record.
    names = {id(job.record): f"{job.record} {rules}" for job in chunk}
    variants = {name: known[name] for name in names.values() if name in known}
    new: dict[str, list[Variant]] = {}
    for job in chunk:
        exercise, name = job.record["exercise"], names[id(job.record)]
        if name not in variants:
            variants[name] = course[exercise].from_record(job.record)
            new.setdefault(exercise, []).append(variants[name])
    for exercise, of_exercise in new.items():
        keys_of(course[exercise], of_exercise, rules)
    if len(known) > _KNOWN:
        known.clear()
    known.update(variants)
    sheets = [(variants[names[id(job.record)]], job.answers) for job in chunk]
    with paused_collection():
        return [
            _mark_sheet(*sheet, readings_of_sheet)
            for sheet, readings_of_sheet in zip(sheets, plainly_right(sheets), strict=True)
        ]


def _mark_sheet(variant: Variant, answers: Mapping[str, Any], right: Mapping[str, str]) -> list[tuple] | str:
    """Return the marks of a sheet in the order of its parts, or the reason for which it cannot be marked.
    Answers known to be ``right`` are not marked again. The marks are plain tuples, which pass between
    processes at half the price."""
    try:
        marking = mark(variant, answers, right) if len(right) < len(variant.parts) else {}
        return [
            _right(variant, part, answers[part.id], right[part.id])
            if part.id in right
            else tuple(_waiting(marking[part.id]))
            for part in variant.parts
        ]
    except NoSolution:
        raise  # no sheet is at fault
    except CourseworkError as fault:
        message = as_message(fault)
        return Message(" ".join(message.split())) if "\n" in message else message
    except Exception as fault:  # what the reader or a judge of the course did not foresee
        return f"{type(fault).__name__}: {' '.join(str(fault).split())[:80]}"


def _right(variant: Variant, part: Part, answer: str, read_as: str) -> tuple[Any, ...]:
    """Return the mark of an answer that is known to be right."""
    points, texts = float(part.points), right_texts(variant, part, read_as)
    return (part.id, answer, read_as, "correct", points, points, variant.lang, (), False, *texts)


def _waiting(mark: Mark) -> Mark:
    """Return the mark of an unreadable answer with the message that a person will look at it; another mark
    unchanged."""
    if mark.verdict != "unreadable":
        return mark
    return mark.saying(*Sentence(words(mark.lang)["marking"]["waits"], {}).texts(mark.lang))
