"""Gradescope's autograder: one submission in, ``results.json`` out, whatever is handed in. Nothing of a student is run.

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
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected
from coursework.gradebook.scale import mark_of
from coursework.gradebook.submissions import find, read_file
from coursework.language.numbers import localise
from coursework.language.words import languages, words
from coursework.making.issued import Issued
from coursework.markup.markdown import plain_line
from coursework.rendering.feedback import hint, note, sign, verdict_word
from coursework.sheets.sheet import FeedbackLine, FeedbackSheet

SETTINGS = "autograder.json"  #: beside the package, in the zip
Results = dict[str, Any]


def results(root: Path) -> Results:
    """What Gradescope is told of the submission in ``root / "submission"``: always something that it takes."""
    lang = languages()[0]
    try:
        settings = json.loads((root / "source" / SETTINGS).read_text("utf-8"))
        lang = str(settings["lang"])
        course = opened(root / "source" / settings["course"] if settings["course"] else None, Variant)
        issued = Issued.read(root / "source" / "issued.json")
        return _of_submission(course, issued, root, lang)
    except CourseworkError as fault:
        return _nothing(lang, "fault", why=str(fault))
    except Exception as fault:  # whatever a submission holds: Gradescope wants its file
        return _nothing(lang, "fault", why=f"{type(fault).__name__}: {str(fault)[:200]}")


def _nothing(lang: str, key: str, **names: object) -> Results:
    """No points, and a sentence that says why."""
    told = str(words(lang)["gradescope"][key]).format(**names)
    return {"score": 0, "output": told, "stdout_visibility": "hidden", "tests": []}


# --------------------------------------------------------------------- submission


def _of_submission(course: Course[Variant], issued: Issued, root: Path, lang: str) -> Results:
    about = _metadata(root / "submission_metadata.json")
    users = [user for user in _list(about.get("users")) if isinstance(user, dict)]
    named = [_who(user) for user in users]
    students = [student for student in (_student(issued, user) for user in users) if student]
    if not students:
        return _nothing(lang, "stranger", who=", ".join(filter(None, named)) or "?")
    rows = list(_rows(root / "submission"))
    tried = [marks_of_student(course, issued, student, rows) for student in dict.fromkeys(students)]
    best = max(tried, key=lambda one: (sum(len(g.answered) for g in one.sheets), -len(one.rejected)))
    notes = list(_late(about, users, best, lang))
    if len(users) > 1:
        notes.append(
            str(words(lang)["gradescope"]["group"]).format(who=best.sheets[0].student, count=len(users))
        )
    return _told(course, issued, best, notes)


def _metadata(path: Path) -> Mapping[str, Any]:
    try:
        found = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError) as fault:
        raise BadInput(f"submission_metadata.json cannot be read ({type(fault).__name__})") from fault
    return found if isinstance(found, dict) else {}


def _list(value: Any) -> Sequence[Any]:
    return value if isinstance(value, list) else ()


def _who(user: Mapping[str, Any]) -> str:
    return str(user.get("name") or user.get("email") or "")


def _student(issued: Issued, user: Mapping[str, Any]) -> str:
    """Who of the roster a user is, by e-mail first; without a roster, whoever it is."""
    called = [str(user.get(key) or "") for key in ("email", "sid", "name")]
    if issued.has_roster:
        return issued.account(called) or ""
    return _who(user)


def _rows(submission: Path) -> Iterator[AnswerRow | Rejected]:
    """The rows of what was handed in; a link out of its folder is not followed."""
    if not submission.is_dir():
        yield Rejected("submission", "the folder holds no file")
        return
    for found in find([submission]):
        if isinstance(found, Rejected):
            yield _below(found, submission)
        else:
            rows = (row for row in read_file(found, [submission]) if not isinstance(row, PlatformFile))
            yield from (_below(row, submission) for row in rows)


def _below(row: AnswerRow | Rejected, submission: Path) -> AnswerRow | Rejected:
    """A row whose file is told from the submission's folder."""
    source = row.source.replace(f"{submission}{os.sep}", "").replace(str(submission), "submission")
    if isinstance(row, Rejected):
        return Rejected(source, row.reason, row.row)
    return row._replace(source=source, warning=row.warning.replace(f"{submission}{os.sep}", ""))


def _late(
    about: Mapping[str, Any], users: Sequence[Mapping[str, Any]], found: OwnMarks, lang: str
) -> Iterator[str]:
    """That it came after it was due, of the latest date that holds for one of the users; what it costs Gradescope says."""
    stated = [about.get("assignment"), *(user.get("assignment") for user in users)]
    due = [_time(one.get("due_date")) for one in stated if isinstance(one, dict)]
    last, came = max(filter(None, due), default=None), _time(about.get("created_at"))
    if last and came and came > last:
        minutes = int((came - last).total_seconds() // 60)
        said = str(words(lang)["gradescope"]["late"])
        yield said.format(hours=minutes // 60, minutes=minutes % 60)


def _time(value: Any) -> datetime | None:
    try:
        found = datetime.fromisoformat(str(value))
    except ValueError:
        return None
    return found if found.tzinfo else None


# ------------------------------------------------------------------------ results


def _told(course: Course[Variant], issued: Issued, found: OwnMarks, notes: Sequence[str]) -> Results:
    lang = str(found.sheets[0].record.get("lang", "fr"))
    shows = (issued.assignment or {}).get("answers") == "shown"
    sheets = [(graded, feedback_sheet(course, graded, answers=shows)) for graded in found.sheets]
    several = len(sheets) > 1
    tests = [
        _test(graded, sheet, line, f"{place}." if several else "")
        for place, (graded, sheet) in enumerate(sheets, start=1)
        for line in sheet.lines
    ]
    points, out_of = sum(g.points for g in found.sheets), sum(g.out_of for g in found.sheets)
    if shows and (right := list(_right(sheets, lang, several=several))):
        title = words(lang)["gradescope"]["right"]
        tests.append({"name": title, "output": "\n".join(right), "visibility": "after_published"})
    output = [*notes, *_rejected(found, lang), *found.notes]
    if mark := mark_of(issued, points, out_of):
        scale = (issued.assignment or {})["mark"]["of"]
        said = str(words(lang)["gradescope"]["mark"])
        output.insert(0, said.format(mark=localise(mark, lang), of=localise(f"{scale:g}", lang)))
    return {
        "score": points,
        "output": "\n".join(output),
        "output_format": "text",
        "stdout_visibility": "hidden",
        "visibility": "visible",
        "tests": tests,
    }


def _test(graded: Graded, sheet: FeedbackSheet, line: FeedbackLine, prefix: str) -> dict[str, Any]:
    """One question as Gradescope lists it."""
    lang, question = sheet.handout.lang, line.question
    number = f"{prefix}{question.number}"
    name = str(words(lang)["gradescope"]["question"]).format(
        exercise=sheet.handout.title, number=number, key=question.key or question.id
    )
    mark = words(lang)["feedback"]["sign_marks"][sign(line)]
    said = [note(line, lang, prefix), hint(line, lang, prefix)]
    text = [f"{mark} {verdict_word(line.verdict, lang)}", *(plain_line(one, lang) for one in said if one)]
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


def _right(sheets: Iterable[tuple[Graded, FeedbackSheet]], lang: str, *, several: bool) -> Iterator[str]:
    """The right answers, which Gradescope shows when the staff publish the grades."""
    for place, (_, sheet) in enumerate(sheets, start=1):
        for line in sheet.lines:
            if line.right:
                prefix = f"{place}." if several else ""
                yield f"{prefix}{line.question.number} {plain_line(line.right, lang)}"


def _rejected(found: OwnMarks, lang: str) -> Iterator[str]:
    said = str(words(lang)["gradescope"]["rejected"])
    for told in dict.fromkeys(f"{one.source}: {for_student(one.reason)}" for one in found.rejected):
        yield said.format(what=told)


# --------------------------------------------------------------------------- file


def write_results(root: Path, found: Results) -> None:
    """Write ``results/results.json``, whole."""
    path = root / "results" / "results.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name("results.json.part")
    part.write_text(json.dumps(found, ensure_ascii=False, allow_nan=False, indent=1), "utf-8")
    part.replace(path)


def main() -> None:
    root = Path(os.environ.get("AUTOGRADER") or "/autograder")
    write_results(root, results(root))


if __name__ == "__main__":
    main()
