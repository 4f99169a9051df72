"""A class marked sheet by sheet, on all processors."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from coursework.course.course import Course, opened
from coursework.course.key_batch import keys_of
from coursework.course.marking_rules import Rules
from coursework.course.variant import Variant
from coursework.errors import BadCourse, BadInput, CourseworkError, NoSolution
from coursework.gradebook.graded import Graded
from coursework.gradebook.placing import SheetPlace, Sheets, as_texts
from coursework.gradebook.rows import Rejected
from coursework.language.words import words
from coursework.making.issued import Issued
from coursework.marking.feedback import Said, right_feedback
from coursework.marking.mark import Mark
from coursework.marking.marking import mark
from coursework.marking.plain_answers import plainly_right
from coursework.model import Part
from coursework.system.processes import processes, workers

CHUNK = 500  #: sheets marked together
WORTH_PROCESSES = 20_000  #: answers; fewer are marked before a process has started


# ------------------------------------------------------------------------ marking


class _Job(NamedTuple):
    """A sheet to mark: the record it was issued by, and its answers by part."""

    record: Mapping[str, Any]
    answers: Mapping[str, Any]


class _How(NamedTuple):
    """How sheets are marked, here and in other processes."""

    printed: bool  #: feedback sheets are to be made of them
    rules: Rules | None  #: the course's unless the assignment says others


def rules_of(course: Course, issued: Issued) -> Rules | None:
    """The course's rules of marking, overridden by the assignment's; None where it states none.

    Raises
    ------
    BadInput
        A rule that there is not, or a value that makes no sense.
    """
    stated = (issued.assignment or {}).get("marking")
    if not stated:
        return None
    try:
        return Rules.of(stated, "the assignment in issued.json", course.folder.rules)
    except BadCourse as fault:
        raise BadInput(str(fault)) from fault


def marked(course: Course, issued: Issued, sheets: Sheets, *, printed: bool = True) -> Iterator[Graded]:
    """The sheets marked, in their order; ``printed`` where feedback sheets are to be made of them.

    A sheet that cannot be marked costs itself alone: its rows are added to the rejected, and the warnings tell it.

    Raises
    ------
    NoSolution
        The course cannot mark.
    """
    unmarked: Counter[tuple[str, str]] = Counter()
    places = list(sheets.sheets)
    chunks = [places[i : i + CHUNK] for i in range(0, len(places), CHUNK)]

    def record(place: SheetPlace) -> Mapping[str, Any]:
        issued_as = issued.record_of(*place[:3])
        if place in sheets.apart:
            issued_as = {
                **issued_as,
                "parts": [p for p in issued_as["parts"] if p["id"] in sheets.sheets[place]],
            }
        return {**issued_as, "lang": sheets.langs[place]} if place in sheets.langs else issued_as

    def jobs(chunk: Sequence[SheetPlace]) -> list[_Job]:
        return [
            _Job(record(place), {p: row.answer for p, row in sheets.sheets[place].items()}) for place in chunk
        ]

    how = _How(printed, rules_of(course, issued))
    marking = _marked_chunks(course, map(jobs, chunks), sheets.answers, how)
    for chunk, results in zip(chunks, marking, strict=True):
        for place, result in zip(chunk, results, strict=True):
            rows = sheets.sheets[place]
            if isinstance(result, str):
                unmarked[place[1], result] += 1
                reason = f"cannot be marked, somebody must look at it ({result})"
                sheets.rejected += [Rejected(row.source, reason, as_texts(row)) for row in rows.values()]
            else:
                lines = {line.part: line for line in map(Mark.received, result)}
                sitting = place[3] or issued.sitting_of(*place[:3])
                graded = Graded(*place[:3], lines, tuple(rows), record(place), sitting=sitting)
                yield graded._replace(submitted=sheets.submitted.get(place, ""), apart=place in sheets.apart)
    for (exercise, why), count in unmarked.items():
        what = "1 sheet" if count == 1 else f"{count} sheets"
        sheets.warnings.append(f"{what} of {exercise} cannot be marked, see the rejected rows: {why}")


def _marked_chunks(
    course: Course, chunks: Iterator[list[_Job]], answers: int, how: _How
) -> Iterator[list[list[tuple] | str]]:
    """Each chunk marked, in order; by processes where there is much to do."""
    count = workers(answers)
    if answers < WORTH_PROCESSES or count < 2:
        for chunk in chunks:
            yield _mark_chunk(course, chunk, how)
        return
    with processes(count) as submit:
        waiting: list[Any] = []
        for chunk in chunks:
            waiting.append(submit(_mark_elsewhere, str(course.folder.root), chunk, how))
            if len(waiting) >= 3 * count:
                yield waiting.pop(0).result()
        for task in waiting:
            yield task.result()


def _mark_elsewhere(root: str, chunk: list[_Job], how: _How) -> list[list[tuple] | str]:
    return _mark_chunk(opened(root, Variant), chunk, how)


def _mark_chunk(course: Course, chunk: Sequence[_Job], how: _How) -> list[list[tuple] | str]:
    """Lines a sheet, or why it cannot be marked."""
    variants = [course[job.record["exercise"]].from_record(job.record) for job in chunk]
    by_exercise: dict[str, list[int]] = {}
    for i, variant in enumerate(variants):
        by_exercise.setdefault(variant.exercise.name, []).append(i)
    right: list[dict[str, str]] = [{} for _ in chunk]
    for name, places in by_exercise.items():
        batch = keys_of(course[name], [variants[i] for i in places], how.rules)
        if not how.printed:
            found = plainly_right(course[name], batch, [chunk[i].answers for i in places])
            for i, digits in zip(places, found, strict=True):
                right[i] = digits
    return [
        _mark_sheet(variant, job.answers, own, how.printed)
        for variant, job, own in zip(variants, chunk, right, strict=True)
    ]


def _mark_sheet(
    variant: Variant, answers: Mapping[str, Any], right: Mapping[str, str], printed: bool
) -> list[tuple] | str:
    """A sheet's lines in the order of its parts, or why it cannot be marked; those that are plainly ``right`` are not
    marked anew."""
    try:
        marking = mark(variant, answers, right) if len(right) < len(variant.parts) else {}
        return [
            _right(variant, part, answers[part.id], right[part.id])
            if part.id in right
            else _waiting(marking[part.id]).sent(printed=printed)
            for part in variant.parts
        ]
    except NoSolution:
        raise  # no sheet is at fault
    except CourseworkError as fault:
        return " ".join(str(fault).split())
    except Exception as fault:  # what the reader or a judge of the course did not foresee
        return f"{type(fault).__name__}: {' '.join(str(fault).split())[:80]}"


def _right(variant: Variant, part: Part, answer: str, read_as: str) -> tuple[Any, ...]:
    """The mark of an answer that is plainly right, as it is sent."""
    points = float(part.points)
    says = right_feedback(variant, part, read_as)
    return (part.id, answer, read_as, "correct", points, points, variant.lang, (), False, "", says)


def _waiting(mark: Mark) -> Mark:
    """An answer that could not be read is said to wait for somebody."""
    if mark.verdict != "unreadable":
        return mark
    return mark._replace(told=(*mark.told, Said(words(mark.lang)["marking"]["waits"], {})))
