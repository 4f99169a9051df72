"""Feedback to a student on an exercise, or on several with one total, as PDF, web page and notebook."""

from __future__ import annotations

import datetime
import shutil
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import NamedTuple

from coursework.course.course import Course
from coursework.course.variant import Variant
from coursework.errors import CourseworkError
from coursework.gradebook.book import Gradebook, is_away, results
from coursework.gradebook.columns import own_columns
from coursework.gradebook.feedback_form import USUAL, FeedbackForm, shows_solutions
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.own_drawings import own_drawings
from coursework.gradebook.scale import mark_of
from coursework.issuing.assignment import text_in
from coursework.issuing.identity import printed_columns
from coursework.issuing.issued import Issued
from coursework.issuing.papers import date_text
from coursework.issuing.practice import PracticeOf
from coursework.issuing.students import file_stems
from coursework.language.numbers import localise, plain
from coursework.language.words import words
from coursework.marking.feedback import localised
from coursework.marking.mark import WAITING, Mark
from coursework.marking.marking import mark
from coursework.markup.markdown import plain_line
from coursework.messages import Message
from coursework.model import Part
from coursework.quantities.usual_errors import ALL_DEGREES
from coursework.rendering.feedback import kind_of
from coursework.rendering.renderer import Renderer, renderer_of
from coursework.sheets.answer_sheet import answer_sheet, answer_text
from coursework.sheets.following import follows_from
from coursework.sheets.handout import handout as handout_of
from coursework.sheets.paper import FeedbackPaper, PaperHeading
from coursework.sheets.sheet import FeedbackLine, FeedbackSheet, Question
from coursework.system.build_folder import renew
from coursework.system.writing import File, Progress, write, writing


class FeedbackOptions(NamedTuple):
    """Content of the feedback: a further exercise to practise, and the worked solutions."""

    practice: PracticeOf | None = None
    solutions: bool = False


MARKS_ALONE = FeedbackOptions()


def feedback_sheet(
    course: Course, graded: Graded, *, answers: bool = False, telling: FeedbackOptions = MARKS_ALONE
) -> FeedbackSheet:
    """Return a student's marks on one exercise, ready to print; with the right ``answers`` if they are
    released."""
    variant = course[graded.exercise].from_record(graded.record)
    handout = handout_of(variant, graded.student)
    right = _right_answers(variant) if answers or telling.solutions else {}
    lines = [
        _line(variant, question, graded.lines[question.id], right.get(question.id, ""))
        for question in handout.questions
    ]
    if not any(line.answer for line in lines):  # nothing was tried: the lesson and another variant say more
        lines = [replace(line, hint="") for line in lines]
    lost = any(line.points < line.out_of and line.verdict not in WAITING for line in lines)
    practice = (
        telling.practice.after(graded.exercise, graded.student, variant.lang)
        if telling.practice and lost
        else None
    )
    solution = answer_sheet(variant, graded.student) if telling.solutions else None
    drawings = own_drawings(variant, graded.lines) if telling.solutions else ()
    return FeedbackSheet(handout, tuple(lines), graded.points, graded.out_of, practice, solution, drawings)


def _line(variant: Variant, question: Question, line: Mark, right: str) -> FeedbackLine:
    """Return the feedback line of one answer; if points are missing, with the quantities from which it
    follows."""
    values = localised(line.read_as, variant.lang), line.verdict, line.points, line.out_of, line.says
    part = next(p for p in variant.parts if p.id == question.id)
    lost = line.points < line.out_of and _is_looked_for(part, line.verdict)
    return FeedbackLine(
        question,
        line.answer,
        *values,
        right=right,
        hint=follows_from(variant, part.quantity) if lost else "",
        read=_with_formulas(question, line.read_as, variant.lang),
    )


#: Messages of wrong numbers, which list what these are computed from.
_LISTING = ("wrong", "wrong_place", "wrong_count")


def _is_looked_for(part: Part, verdict: str) -> bool:
    """Return whether it helps to hear from what a quantity follows.

    Not where the message lists it, as it does for a wrong number; not where only the form of the answer is
    wrong, nor for what is drawn or chosen freely and judged with other answers.
    """
    if part.sort.is_open or part.judge or verdict in _NOT_ABOUT_IT:
        return False
    return kind_of(verdict) != "slip" and (verdict != "wrong" or part.sort.wrong not in _LISTING)


def _with_formulas(question: Question, read_as: str, lang: str) -> str:
    """Return the reading of a choice as the sheet offers it, in Markdown, if it contains formulas; empty
    otherwise."""
    form = words(lang)["choices"]["lettered"]
    letters = question.letters or ("",) * len(question.choices)
    for letter, (_, label) in zip(letters, question.choices, strict=True):
        offered = form.format(letter, label) if letter else label
        if "$" in offered and plain_line(offered, lang) == read_as:
            return offered
    return ""


def _right_answers(variant: Variant) -> dict[str, str]:
    """Return the reference answers by part, in Markdown; none for an open question."""
    values = variant.walk
    return {part.id: answer_text(variant, part, values) for part in variant.parts if not part.sort.is_open}


# ------------------------------------------------------------------------ paper

_ADVISED = 3  #: places that are pointed at
#: Verdicts of answers that do not show how their quantity was looked for.
_NOT_ABOUT_IT = (*WAITING, "wrong_unit", "missing_unit", "follow_through", "accepted", f"slip:{ALL_DEGREES}")


def feedback_paper(
    course: Course,
    issued: Issued,
    student: str,
    graded: Sequence[Graded],
    lang: str,
    waiting: Collection[str] = (),
    telling: FeedbackOptions = MARKS_ALONE,
) -> FeedbackPaper:
    """Return a student's marks on one sitting of an assignment: one total, the mark, and advice.

    An exercise that was not submitted has a sheet without answers, unless it is ``waiting``: submitted, and
    not read yet.
    """
    stated = issued.assignment or {}
    sitting = graded[0].sitting if graded else 1
    by_exercise = {g.exercise: g._replace(record={**g.record, "lang": lang}) for g in graded}
    blank = _blank(course, issued, student, sitting, lang)
    sheets, left_out = {}, 0.0
    for place, exercise in enumerate(map(str, stated.get("exercises", issued.exercises)), start=1):
        graded_sheet = by_exercise.get(exercise) or (None if exercise in waiting else blank(exercise))
        if graded_sheet is None:
            left_out += _worth(issued, exercise)
        else:
            shows_answers = stated.get("answers") != "never"
            sheets[place] = feedback_sheet(course, graded_sheet, answers=shows_answers, telling=telling)
    points = sum(s.points for s in sheets.values())
    out_of = sum(s.out_of for s in sheets.values()) + left_out
    return FeedbackPaper(
        heading_of(course, issued, student, sitting, lang),
        tuple(sheets.values()),
        points,
        out_of,
        localise(mark_of(issued, points, out_of), lang),
        stated.get("answers") != "never",
        tuple(_advice(sheets, set(by_exercise), lang)),
        places=tuple(sheets),
        open=sum(graded_sheet.open for graded_sheet in graded) + len(waiting),
    )


def feedback_collection(
    course: Course, student: str, graded: Sequence[Graded], telling: FeedbackOptions = MARKS_ALONE
) -> FeedbackPaper:
    """Return a student's marks on exercises that were handed out one by one: under one total, with the
    question numbers of each sheet."""
    lang = str(graded[0].record.get("lang", "fr"))
    sheets = tuple(
        feedback_sheet(course, sheet._replace(record={**sheet.record, "lang": lang}), telling=telling)
        for sheet in graded
    )
    heading = PaperHeading(lang=lang, title=course.folder.title(lang), course="", student=student)
    points, out_of = sum(s.points for s in sheets), sum(s.out_of for s in sheets)
    waits = sum(sheet.open for sheet in graded)
    return FeedbackPaper(
        heading, sheets, points, out_of, answers=telling.solutions, numbered=False, open=waits
    )


def _blank(
    course: Course, issued: Issued, student: str, sitting: int, lang: str
) -> Callable[[str], Graded | None]:
    """Return a function that makes the sheet of an exercise that the student did not submit."""
    seeds = issued.issued_to(student, sitting)

    def sheet(exercise: str) -> Graded | None:
        if exercise not in seeds:
            return None
        key = student, exercise, seeds[exercise]
        record = {**issued.record_of(*key), "lang": lang}
        lines = mark(course[exercise].from_record(record), {})
        return Graded(*key, dict(lines), (), record, sitting=sitting)

    return sheet


def _worth(issued: Issued, exercise: str) -> float:
    """Return the points of an exercise, which are those of all its variants."""
    record = next((r for (e, _), r in issued.records.items() if e == exercise), {"parts": ()})
    return float(sum(part["points"] for part in record["parts"]))


def heading_of(course: Course, issued: Issued, student: str, sitting: int, lang: str) -> PaperHeading:
    """Return the heading of a student's paper, from the issued records."""
    stated = issued.assignment or {}
    roster_cells = own_columns(issued, student)
    versions = (issued.versions.get(key) for key in issued.issued_to(student, sitting).items())
    scale = stated.get("mark")
    date = str(stated.get("date") or "")
    return PaperHeading(
        lang=lang,
        title=text_in(stated.get("title") or {}, lang) or str(stated.get("name", "")),
        course=text_in(stated.get("course") or {}, lang) or course.folder.title(lang),
        student=student,
        is_code=issued.is_anonymous,
        identity=()
        if issued.is_anonymous
        else printed_columns(stated.get("identity") or (), roster_cells, lang),
        date=date_text(datetime.date.fromisoformat(date) if date else None, lang),
        duration=text_in(stated.get("duration") or {}, lang),
        version=next(filter(None, versions), ""),
        mark_of=localise(plain(scale["of"]), lang) if scale else "",
    )


def _advice(sheets: Mapping[int, FeedbackSheet], handed_in: Collection[str], lang: str) -> Iterator[str]:
    """Yield the questions, and the exercises not submitted, in which most points can still be gained."""
    texts = words(lang)["feedback"]
    places: list[tuple[float, float, str]] = []
    for place, sheet in sheets.items():
        if sheet.handout.exercise not in handed_in:
            places.append((0.0, sheet.out_of, sheet.handout.title))
            continue
        for line in sheet.lines:
            if line.verdict not in WAITING:
                number = f"{place}.{line.question.number}"  # as papers number their questions
                name = texts["advised"].format(exercise=sheet.handout.title, number=number)
                symbol = f", ${line.question.symbol}$" if line.question.symbol else ""
                places.append((line.points, line.out_of, name + symbol))
    places.sort(key=lambda candidate: candidate[0] - candidate[1])
    for points, out_of, name in places[:_ADVISED]:
        if points < out_of:
            got, most = (localise(f"{n:g}", lang) for n in (points, out_of))
            yield f"{name} ({got} / {most})"


# ---------------------------------------------------------------------- writing


def write_feedback(
    course: Course,
    book: Gradebook,
    sheets: Sequence[Graded],
    folder: Path,
    progress: Progress,
    form: FeedbackForm = USUAL,
) -> None:
    """Write a file for each student and format, named like the student's handouts; for an assignment, one for
    each sitting. Whoever was away has none.

    A sheet that cannot be printed is a warning, and costs no other.
    """
    by_student: dict[str, dict[int, list[Graded]]] = {student: {} for student in book.issued.students}
    away = {student for student, result in results(book) if is_away(book, student, result)}
    for graded in sheets:
        if graded.student in away:
            continue
        by_student.setdefault(graded.student, {}).setdefault(graded.sitting, []).append(graded)
    unread = {sitting: {e for e, _ in unread_sheets} for sitting, unread_sheets in book.unread().items()}
    practice, solutions = PracticeOf(course, book.issued), shows_solutions(book.issued, form)
    stems = file_stems(by_student)
    places = [
        (student, mine, f"{stem}" if n == 1 else f"{stem}.sitting-{n}", unread.get((student, n), ()))
        for stem, (student, sittings) in zip(stems, by_student.items(), strict=True)
        for n, mine in sorted(sittings.items())
    ]

    renderer = renderer_of(course.folder)
    files = []
    for student, mine, name, waiting in places:
        issued = book.issued.of_student(student)
        telling = FeedbackOptions(practice.of_student(issued), solutions)
        content = _FeedbackContent(course, issued, student, tuple(mine), waiting, telling)
        for end in form.formats:
            make = partial(_printed, renderer, content, end)
            failed = partial(_warn, book, student)
            files.append(File(Path(f"{name}.{end}"), make, anywhere=True, failed=failed))
    done = iter(range(1, len(files) + 1))
    write(folder, files, lambda _: progress(next(done), len(files)))


def _warn(book: Gradebook, student: str, fault: CourseworkError) -> None:
    book.warnings.append(
        Message("no feedback sheet for {student}: {problem}", student=student, problem=fault)
    )


@dataclass(frozen=True, eq=False)
class _FeedbackContent:
    """Feedback of one sitting, to be made in the process that prints it."""

    course: Course
    issued: Issued
    student: str
    graded: tuple[Graded, ...]
    waiting: Collection[str]
    telling: FeedbackOptions

    @cached_property
    def sheet(self) -> FeedbackSheet | FeedbackPaper:
        mine = self.graded
        if self.issued.assignment is not None:
            lang = str(mine[0].record.get("lang", "fr"))
            return feedback_paper(
                self.course, self.issued, self.student, mine, lang, self.waiting, self.telling
            )
        if len(mine) == 1:
            return feedback_sheet(self.course, mine[0], telling=self.telling)
        return feedback_collection(self.course, self.student, mine, self.telling)


def renew_feedback(
    course: Course,
    book: Gradebook,
    sheets: Sequence[Graded],
    out: Path,
    progress: Progress,
    form: FeedbackForm = USUAL,
    ready: Callable[[], None] = lambda: None,
) -> None:
    """Print feedback, then move it to ``out / "feedback"``. Sheets of an earlier marking are replaced; a
    sheet that somebody has edited is kept under another name, with a warning; other files stay.

    Earlier files remain unchanged while the new ones are printed. ``ready`` is called before these are moved,
    and may raise an error.
    """
    printing = out / ".printing"
    shutil.rmtree(printing, ignore_errors=True)
    try:
        with writing(out):
            printing.mkdir(parents=True)
        write_feedback(course, book, sheets, printing, progress, form)
        ready()
        with writing(out / "feedback"):
            book.warnings += renew(printing, out / "feedback", out / ".feedback.json")
    finally:
        shutil.rmtree(printing, ignore_errors=True)


def _printed(renderer: Renderer, content: _FeedbackContent, end: str) -> bytes:
    """Return the feedback in a format."""
    sheet = content.sheet
    if end == "ipynb":
        return renderer.feedback_notebook(sheet).encode("utf-8")
    return renderer.pdf(sheet) if end == "pdf" else renderer.html(sheet).encode("utf-8")
