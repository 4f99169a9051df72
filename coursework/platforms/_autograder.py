"""Autograder of Gradescope: it marks one submission and always writes ``results.json``. No code of a student
is run.

It runs as ``python -m coursework.platforms._autograder`` where Gradescope has unpacked the zip of
:mod:`coursework.platforms.gradescope`; ``AUTOGRADER`` names the folder that Gradescope calls ``/autograder``.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

from coursework.course.course import Course, opened
from coursework.course.variant import Variant
from coursework.errors import BadInput, CourseworkError
from coursework.gradebook.by_student import OwnMarks, for_student, marks_of_student
from coursework.gradebook.feedback_sheets import feedback_sheet
from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected
from coursework.gradebook.scale import mark_of
from coursework.gradebook.submissions import find, read_file
from coursework.issuing.issued import Issued
from coursework.issuing.questions import PaperQuestions
from coursework.language.numbers import localise
from coursework.language.words import languages, words
from coursework.markup.markdown import plain_line
from coursework.messages import Message
from coursework.rendering.feedback import hint, note, sign, verdict_word
from coursework.sheets.sheet import FeedbackLine, FeedbackSheet

SETTINGS = "autograder.json"  #: beside the package, in the zip
Results = dict[str, Any]


def results(root: Path) -> Results:
    """Return the results for the submission in ``root / "submission"``, always in a form that Gradescope
    accepts."""
    lang = languages()[0]
    try:
        settings = json.loads((root / "source" / SETTINGS).read_text("utf-8"))
        lang = str(settings["lang"])
        course = opened(root / "source" / settings["course"] if settings["course"] else None, Variant)
        issued = Issued.read(root / "source" / "issued.json")
        return _of_submission(course, issued, root, lang)
    except CourseworkError as fault:
        return _nothing(lang, "fault", why=str(fault))
    except Exception as fault:  # Gradescope needs the file for any submission
        return _nothing(lang, "fault", why=f"{type(fault).__name__}: {str(fault)[:200]}")


def _nothing(lang: str, key: str, **names: object) -> Results:
    """Return results without points, with a sentence that gives the reason."""
    message = str(words(lang)["gradescope"][key]).format(**names)
    return {"score": 0, "output": message, "stdout_visibility": "hidden", "tests": []}


# --------------------------------------------------------------------- submission


def _of_submission(course: Course[Variant], issued: Issued, root: Path, lang: str) -> Results:
    about = _metadata(root / "submission_metadata.json")
    users = [user for user in _list(about.get("users")) if isinstance(user, dict)]
    named = [_user_name(user) for user in users]
    students = [student for student in (_student(issued, user) for user in users) if student]
    if not students:
        return _nothing(lang, "stranger", who=", ".join(filter(None, named)) or "?")
    rows = list(_rows(root / "submission"))
    tried = [marks_of_student(course, issued, student, rows) for student in dict.fromkeys(students)]
    best = max(
        tried,
        key=lambda student_marks: (
            sum(len(g.answered) for g in student_marks.sheets),
            -len(student_marks.rejected),
        ),
    )
    notes = list(_late(about, users, best, lang))
    if len(users) > 1:
        notes.append(
            str(words(lang)["gradescope"]["group"]).format(who=best.sheets[0].student, count=len(users))
        )
    return _results(course, issued, best, notes)


def _metadata(path: Path) -> Mapping[str, Any]:
    try:
        metadata = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError) as fault:
        raise BadInput(
            "submission_metadata.json cannot be read ({error})", error=type(fault).__name__
        ) from fault
    return metadata if isinstance(metadata, dict) else {}


def _list(value: Any) -> Sequence[Any]:
    return value if isinstance(value, list) else ()


def _user_name(user: Mapping[str, Any]) -> str:
    return str(user.get("name") or user.get("email") or "")


def _student(issued: Issued, user: Mapping[str, Any]) -> str:
    """Return the student of the roster for a user, by e-mail first; without a roster, the user."""
    identifiers = [str(user.get(key) or "") for key in ("email", "sid", "name")]
    if issued.has_roster:
        return issued.account(identifiers) or ""
    return _user_name(user)


def _rows(submission: Path) -> Iterator[AnswerRow | Rejected]:
    """Yield the rows of a submission; links that lead out of its folder are not followed."""
    if not submission.is_dir():
        yield Rejected("submission", Message("the folder contains no file"))
        return
    for folder_file in find([submission]):
        if isinstance(folder_file, Rejected):
            yield _below(folder_file, submission)
        else:
            rows = (row for row in read_file(folder_file, [submission]) if not isinstance(row, PlatformFile))
            yield from (_below(row, submission) for row in rows)


def _below(row: AnswerRow | Rejected, submission: Path) -> AnswerRow | Rejected:
    """Return a row with its file's path relative to the submission's folder."""
    source = row.source.replace(f"{submission}{os.sep}", "").replace(str(submission), "submission")
    if isinstance(row, Rejected):
        return Rejected(source, row.reason, row.row)
    return row._replace(source=source, warning=row.warning.replace(f"{submission}{os.sep}", ""))


def _late(
    about: Mapping[str, Any], users: Sequence[Mapping[str, Any]], own_marks: OwnMarks, lang: str
) -> Iterator[str]:
    """Yield a note if the submission is later than the latest due date of its users; Gradescope applies the
    penalty."""
    stated = [about.get("assignment"), *(user.get("assignment") for user in users)]
    due = [_time(date.get("due_date")) for date in stated if isinstance(date, dict)]
    last, submitted_at = max(filter(None, due), default=None), _time(about.get("created_at"))
    if last and submitted_at and submitted_at > last:
        minutes = int((submitted_at - last).total_seconds() // 60)
        template = str(words(lang)["gradescope"]["late"])
        yield template.format(hours=minutes // 60, minutes=minutes % 60)


def _time(value: Any) -> datetime | None:
    try:
        time = datetime.fromisoformat(str(value))
    except ValueError:
        return None
    return time if time.tzinfo else None


# ------------------------------------------------------------------------ results


def _results(course: Course[Variant], issued: Issued, own_marks: OwnMarks, notes: Sequence[str]) -> Results:
    lang = str(own_marks.sheets[0].record.get("lang", "fr"))
    shows = (issued.assignment or {}).get("answers") == "shown"
    sheets = [feedback_sheet(course, graded, answers=shows) for graded in own_marks.sheets]
    questions = PaperQuestions.of(course, issued)
    prefixes = {name: f"{place}." for name, _ in questions if (place := questions.exercise_number(name))}
    tests = [
        _test(sheet, line, prefixes.get(sheet.handout.exercise, ""))
        for sheet in sheets
        for line in sheet.lines
    ]
    points, out_of = sum(g.points for g in own_marks.sheets), sum(g.out_of for g in own_marks.sheets)
    if shows and (right := list(_right(sheets, lang, prefixes))):
        title = words(lang)["gradescope"]["right"]
        tests.append({"name": title, "output": "\n".join(right), "visibility": "after_published"})
    output = [*notes, *_rejected(own_marks, lang), *own_marks.notes]
    if mark := mark_of(issued, points, out_of):
        scale = (issued.assignment or {})["mark"]["of"]
        template = str(words(lang)["gradescope"]["mark"])
        output.insert(0, template.format(mark=localise(mark, lang), of=localise(f"{scale:g}", lang)))
    return {
        "score": points,
        "output": "\n".join(output),
        "output_format": "text",
        "stdout_visibility": "hidden",
        "visibility": "visible",
        "tests": tests,
    }


def _test(sheet: FeedbackSheet, line: FeedbackLine, prefix: str) -> dict[str, Any]:
    """Return the entry of a question."""
    lang, question = sheet.handout.lang, line.question
    number = f"{prefix}{question.number}"
    name = str(words(lang)["gradescope"]["question"]).format(
        exercise=sheet.handout.title, number=number, key=question.key or question.id
    )
    mark = words(lang)["feedback"]["sign_marks"][sign(line)]
    lines = [note(line, lang, prefix), hint(line, lang, prefix)]
    text = [
        f"{mark} {verdict_word(line.verdict, lang)}",
        *(plain_line(line_text, lang) for line_text in lines if line_text),
    ]
    return {
        "name": name,
        "number": number,
        "score": line.points,
        "max_score": line.out_of,
        "status": "passed" if line.points >= line.out_of else "failed",
        "output": "\n".join(text),
        "output_format": "text",
        "visibility": "visible",
    }


def _right(sheets: Iterable[FeedbackSheet], lang: str, prefixes: Mapping[str, str]) -> Iterator[str]:
    """Yield the right answers, which Gradescope shows after the staff publish the grades."""
    for sheet in sheets:
        for line in sheet.lines:
            if line.right:
                prefix = prefixes.get(sheet.handout.exercise, "")
                yield f"{prefix}{line.question.number} {plain_line(line.right, lang)}"


def _rejected(own_marks: OwnMarks, lang: str) -> Iterator[str]:
    template = str(words(lang)["gradescope"]["rejected"])
    for reason in dict.fromkeys(f"{row.source}: {for_student(row.reason)}" for row in own_marks.rejected):
        yield template.format(what=reason)


# --------------------------------------------------------------------------- file


def write_results(root: Path, content: Results) -> None:
    """Write ``results/results.json`` atomically."""
    path = root / "results" / "results.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name("results.json.part")
    part.write_text(json.dumps(content, ensure_ascii=False, allow_nan=False, indent=1), "utf-8")
    part.replace(path)


def main() -> None:
    root = Path(os.environ.get("AUTOGRADER") or "/autograder")
    write_results(root, results(root))


if __name__ == "__main__":
    main()
