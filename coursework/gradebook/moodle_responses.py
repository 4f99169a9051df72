"""Moodle's Responses report of a quiz: CSV in the language of the person who downloads it, or JSON.

Its columns are known by their places and numbers, since Moodle translates their titles: who, then state,
start, end and duration of the attempt and its grade, then for each question its text and the response,
``Question 1``, ``Response 1``.
"""

from __future__ import annotations

import itertools
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from coursework.errors import counted
from coursework.gradebook.item_label import NO_LABEL, ItemLabel, label_in, languages_in
from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected, RowOrigin
from coursework.gradebook.stack_responses import stack_answers
from coursework.issuing.identity import EMAIL, FIRST_NAME, SURNAME, WHOLE, identifies, is_called
from coursework.messages import Message
from coursework.system.tables import as_written

_NUMBERED = re.compile(r"(?P<what>\D*?[^\W\d])\s*(?P<number>[0-9]{1,3})")
_GRADE = re.compile(r"[^\d/]+/?[0-9]+(?:[.,][0-9]+)?")  #: ``Grade/9.00``; in JSON ``grade900``
_GRADES_REPORT = re.compile(r"\D{1,12}[0-9]+\s*/\s*[0-9]+(?:[.,][0-9]+)?")  #: ``Q. 1 /9.00``
_NONE = ("", "-")  #: what Moodle writes for nothing
_AVERAGE = ("average", "moyenne", "durchschnitt", "promedio", "media", "média", "gemiddelde", "średnia")

WHAT = Message("Moodle's Responses report")
NO_RESPONSES = Message(
    "the Responses report contains neither questions nor responses: tick 'question text' and 'response' "
    "in its display options, and download it again"
)


class ResponseColumns(NamedTuple):
    """Positions of the columns of a report."""

    name: tuple[int, ...]  #: of the first name and the surname
    ids: tuple[int, ...]
    state: int
    completed: int
    questions: tuple[tuple[int, int], ...]  #: of text and response


def columns_of(header: Sequence[str]) -> ResponseColumns | None:
    """Return the positions of the columns; None if this is not a Responses report."""
    matches = [_NUMBERED.fullmatch(title.strip()) for title in header]
    numbers = [
        match["number"] if match and not _is_grade(header, k) else "" for k, match in enumerate(matches)
    ]
    first = next((k for k, (a, b) in enumerate(itertools.pairwise(numbers)) if a and a == b), None)
    if first is None or first < 6:
        return None
    about = first - (5 if _GRADE.fullmatch(header[first - 1].strip()) else 4)
    starts = {number: k for k, number in reversed([*enumerate(numbers)]) if number and k >= first}
    questions = tuple(
        (k, k + 1)
        for number, k in sorted(starts.items(), key=lambda match: match[1])
        if numbers[k + 1 : k + 2] == [number]
    )
    identity_titles = header[:about]
    return ResponseColumns(
        _name(identity_titles),
        tuple(k for k, title in enumerate(identity_titles) if identifies(title)),
        about,
        about + 2,
        questions,
    )


def _is_grade(header: Sequence[str], index: int) -> bool:
    return "/" in header[index]


def _name(titles: Sequence[str]) -> tuple[int, ...]:
    """Return the columns of first name and surname, or of the whole name."""
    for names in (WHOLE, (*FIRST_NAME, *SURNAME)):
        named = [k for k, title in enumerate(titles) if is_called(title, names)]
        if named:
            return tuple(sorted(named, key=lambda k: not is_called(titles[k], FIRST_NAME)))[:2]
    return tuple(k for k in range(min(2, len(titles))))


def is_another(header: Sequence[str]) -> str:
    """Return a message if this is another report of a quiz; empty otherwise."""
    if sum(bool(_GRADES_REPORT.fullmatch(title.strip())) for title in header) >= 2 and any(
        is_called(title, EMAIL) for title in header
    ):
        return Message(
            "this is the Grades report of a Moodle quiz, without answers: download the Responses report"
        )
    singles = [match["number"] for match in map(_NUMBERED.fullmatch, map(str.strip, header)) if match]
    if (
        singles
        and singles[0] == "1"
        and len(header) > 6
        and _GRADE.fullmatch(header[-len(singles) - 1].strip())
    ):
        return NO_RESPONSES
    return ""


def read_responses(
    header: Sequence[str], rows: Iterable[tuple[str, Sequence[str]]], source: str, warning: str
) -> Iterator[AnswerRow | Rejected | PlatformFile]:
    """Yield the answers of a report, attempt by attempt; each of ``rows`` has its location and its cells."""
    columns = columns_of(header)
    assert columns is not None, "only a header that has them comes here"
    attempts: Counter[tuple[str, ...]] = Counter()
    absent = 0
    student: tuple[str, tuple[tuple[str, str], ...]] = ("", ())
    for location, cells in rows:
        cells = [*map(as_written, cells), *[""] * (len(header) - len(cells))]
        if _is_average(header, columns, cells):
            continue
        # The name of a student with several attempts is printed once.
        student = _student_of(header, columns, cells) or student
        if all(cells[k].strip() in _NONE for pair in columns.questions for k in pair):
            absent += 1
            continue
        if cells[columns.completed].strip() in _NONE:
            yield from _unfinished(columns, cells, student[0], location)
            continue
        attempts[(student[0], *map(str, student[1]))] += 1
        origin = RowOrigin(
            student[1], (), attempts[(student[0], *map(str, student[1]))], cells[columns.completed].strip()
        )
        for question, response in columns.questions:
            where = f"{location}, {header[response].strip()}"
            yield from _response(cells[question], cells[response], student[0], origin, where, warning)
    numbers = {
        "report": WHAT,
        "items": counted(sum(attempts.values()), "finished attempt"),
        "students": counted(len(attempts), "student"),
    }
    yield PlatformFile(
        source,
        Message(
            "{report}, {items} of {students}, {absent} without an attempt",
            **numbers,
            absent=counted(absent, "student"),
        )
        if absent
        else Message("{report}, {items} of {students}", **numbers),
    )


def _is_average(header: Sequence[str], columns: ResponseColumns, cells: Sequence[str]) -> bool:
    """Return True for the last line: an average in the column of names, no e-mail, no answers."""
    if any(cells[k].strip() not in _NONE for pair in columns.questions for k in pair):
        return False
    name = " ".join(cells[k] for k in columns.name).casefold()
    return not any(cells[k].strip() for k in columns.ids) and any(word in name for word in _AVERAGE)


def _student_of(
    header: Sequence[str], columns: ResponseColumns, cells: Sequence[str]
) -> tuple[str, tuple[tuple[str, str], ...]] | None:
    name = " ".join(" ".join(cells[k] for k in columns.name).split())
    ids = tuple((header[k].strip(), cells[k].strip()) for k in columns.ids if cells[k].strip() not in _NONE)
    return (name, ids) if name or ids else None


def _unfinished(
    columns: ResponseColumns, cells: Sequence[str], student: str, location: str
) -> Iterator[Rejected]:
    """Yield the responses of an attempt that was not submitted, which has no end."""
    state = cells[columns.state].strip()
    reason = Message(
        (
            "the attempt is not finished but {state!r}: close or submit it in Moodle, and download the "
            "report "
            "again"
        ),
        state=state,
    )
    answered = [pair for pair in columns.questions if cells[pair[1]].strip() not in _NONE]
    if not answered:
        yield Rejected(location, reason, {"student": student})
    for question, response in answered:
        label = label_in(cells[question]) or ItemLabel("", "", "")
        row = {"student": student, "exercise": label.exercise, "seed": label.seed, "part": label.part}
        yield Rejected(location, reason, row | {"answer": cells[response].strip()})


def _response(
    question: str, response: str, student: str, origin: RowOrigin, location: str, warning: str
) -> Iterator[AnswerRow | Rejected]:
    """Yield the answers of one response: all parts of a question with several gaps, or the part that its
    label names."""
    label, text = label_in(question), response.strip()
    if label is None:
        if text not in _NONE:
            yield Rejected(location, NO_LABEL, {"student": student, "answer": text})
        return
    origin = origin._replace(version=label.version, apart=bool(label.part))
    shows_all = len(languages_in(question)) > 1

    def row(part: str, answer: str) -> AnswerRow:
        return AnswerRow(
            student,
            label.exercise,
            label.seed,
            part,
            _letters_of(answer) if shows_all else answer,
            f"{location}, {part}",
            warning,
            label.lang,
            origin,
        )

    if label.part:
        yield row(label.part, "" if text in _NONE else label.answer(text))
    elif text in _NONE:
        yield row("", "")
    elif boxes := stack_answers(text):
        yield from (row(f"question_{number}", answer) for number, answer in boxes.items())
    elif answers := parts_of(text):
        yield from (row(f"question_{number}", answer) for number, answer in enumerate(answers, start=1))
    else:
        columns = {"student": student, "exercise": label.exercise, "seed": label.seed, "answer": text}
        reason = Message(
            "a response of several parts is written 'part 1: …; part 2: …', each once: this one waits for a "
            "person"
        )
        yield Rejected(location, reason, columns)


_LETTERED = re.compile(r"(?:\A|(?<=[\s;]))([a-z])\) ")


def _letters_of(answer: str) -> str:
    """Return the letters of cases that are written in several languages, ``b) swings b) oscille``; another
    answer as it is."""
    letters = dict.fromkeys(_LETTERED.findall(answer))
    return ", ".join(letters) if _LETTERED.match(answer) else answer


_FIRST = re.compile(r"(?P<before>[^\d:;]{1,30}?)1(?P<colon>\s*[:：])")


def parts_of(text: str) -> list[str]:
    """Return the answers of ``part 1: 238.4 mm; part 2: …``, in any language; none if they cannot be
    separated.

    An answer may contain semicolons. If the separator of two answers also occurs in one of them, they cannot
    be separated.
    """
    first = _FIRST.match(text)
    if first is None:
        return []
    before, colon = re.escape(first["before"].strip()), re.escape(first["colon"].strip())
    begins = re.compile(rf"(?:\A|;\s){before}\s*([0-9]{{1,3}})\s*{colon}\s?")
    matches = [*begins.finditer(text)]
    if [int(match[1]) for match in matches] != [*range(1, len(matches) + 1)]:
        return []
    ends = [*(match.start() for match in matches[1:]), len(text)]
    return [text[match.end() : end].strip() for match, end in zip(matches, ends, strict=True)]
