"""Files of a build: sheets, notebooks and pages for students, and the staff's solutions and key."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias

from coursework.course.course import Course
from coursework.course.secrecy import Secret
from coursework.issuing import booklets
from coursework.issuing.answer_papers import printed_handout
from coursework.issuing.assignment import Assignment
from coursework.issuing.issued import COLUMNS, form_rows, issued_content, key_content, key_rows
from coursework.issuing.issuing import Issue
from coursework.rendering.renderer import Renderer, renderer_of
from coursework.sheets.sheet import AnswerSheet, Handout
from coursework.system.tables import SPREADSHEETS, Spreadsheet, csv_file, json_text
from coursework.system.writing import File

KEY_COLUMNS = ("student", "exercise", "seed", "part", "value", "unit", "tolerance")


Made: TypeAlias = str | bytes | None


def _text(make: Callable[[], str]) -> Callable[[], bytes]:
    return lambda: make().encode("utf-8")


def files(
    course: Course,
    issues: Sequence[Issue],
    formats: Sequence[str],
    *,
    practice: bool = False,
    paper: str = "a4",
    booklet: bool = False,
    polygons: bool = True,
    spreadsheet: Spreadsheet = SPREADSHEETS["point"],
    scan: bool = False,
) -> Iterator[File]:
    """Yield every file of a build, in order.

    ``practice`` makes the notebooks self-study notebooks, which check answers with the installed package. ``paper`` is
    ``a4`` or ``letter``. ``booklet`` adds the sheets of all students in one PDF for each exercise and
    language. Without ``polygons`` the worked solutions leave out the drawn velocity and acceleration polygons.
    The tables are written for the ``spreadsheet``. With ``scan`` the PDFs have answer pages that a scanner reads.
    """
    renderer = renderer_of(course.folder).on(paper)
    for issue in issues:
        for lang in issue.langs:
            yield from _sheets(
                course, renderer, issue, lang, formats, practice, polygons, paper if scan else ""
            )
    if booklet:
        yield from booklets.files(
            course, renderer, issues, polygons=polygons, spreadsheet=spreadsheet, scan=scan
        )
    yield from tables(course, issues, None, spreadsheet)


def tables(
    course: Course,
    issues: Sequence[Issue],
    assignment: Assignment | None,
    spreadsheet: Spreadsheet,
    secret: Secret | None = None,
) -> Iterator[File]:
    """Yield the record of issued variants, the form for answers, and the key for the staff; ``secret`` is
    stored if the assignment's file has none."""
    content = issued_content(issues, assignment, secret)
    yield File(Path("issued.json"), _text(lambda: json_text(content)))
    yield File(Path("answers.csv"), lambda: csv_file(form_rows(issues), COLUMNS, spreadsheet))
    yield from key_files(issues, spreadsheet)


def key_files(issues: Sequence[Issue], spreadsheet: Spreadsheet = SPREADSHEETS["point"]) -> Iterator[File]:
    """Yield the answer key for the staff, as JSON and as a table."""
    key = key_content(issues)
    folder = Path("instructor")
    yield File(folder / "key.json", _text(lambda: json_text(key)))
    yield File(folder / "key.csv", lambda: csv_file(key_rows(key), KEY_COLUMNS, spreadsheet))


def _sheets(
    course: Course,
    renderer: Renderer,
    issue: Issue,
    lang: str,
    formats: Sequence[str],
    practice: bool,
    polygons: bool,
    scan: str,
) -> Iterator[File]:
    variant = issue.variant.in_language(lang)
    name = variant.exercise.name
    for_student = Path("handouts") / name / f"{issue.stem}.{lang}"
    for_staff = Path("instructor") / name / f"{issue.stem}.{lang}"
    handout = partial(variant.handout, issue.student)
    solution = partial(variant.answer_sheet, issue.student, polygons=polygons)

    if "pdf" in formats:
        yield rendered(for_student, ".pdf", renderer.pdf, partial(printed_handout, issue, lang, scan))
    if "html" in formats:
        yield rendered(for_student, ".html", renderer.html, handout)
    if "ipynb" in formats and practice:
        yield rendered(for_student, ".ipynb", renderer.study, partial(variant.study_sheet, issue.student))
    elif "ipynb" in formats:
        yield rendered(for_student, ".ipynb", renderer.notebook, handout)
    if "tex" in formats:
        yield from _tex(renderer, for_student, ".tex", "figure", handout)
    if "pdf" in formats:
        yield rendered(for_staff, ".solution.pdf", renderer.pdf, solution)
    if "html" in formats:
        yield rendered(for_staff, ".solution.html", renderer.html, solution)
    if "tex" in formats:
        drawn = polygons and variant.exercise.solution.polygons is not None
        yield from _tex(renderer, for_staff, ".solution.tex", "solution-figure", solution, polygons=drawn)


def _tex(
    renderer: Renderer,
    path: Path,
    ending: str,
    figure_name: str,
    sheet: Callable[[], Handout | AnswerSheet],
    *,
    polygons: bool = False,
) -> Iterator[File]:
    """Yield a LaTeX source and its drawings."""
    stem = tex_stem(path)
    figure, pages = f"{stem}-{figure_name}.pdf", f"{stem}-polygons.pdf"
    yield rendered(path, ending, partial(renderer.tex, figure=figure, polygons=pages), sheet)
    yield rendered(path.with_name(figure), "", renderer.figure_pdf, sheet)
    if polygons:
        yield rendered(path.with_name(pages), "", renderer.polygons_pdf, sheet)


def tex_stem(path: Path) -> str:
    """Return the stem of the names of a source's drawings; LaTeX reads only one dot in a name."""
    return path.name.replace(".", "-")


def rendered(path: Path, ending: str, render: Callable[[Any], Made], sheet: Callable[[], Any]) -> File:
    """Return a file that a renderer makes of a sheet, in any process."""
    return File(path.with_name(path.name + ending), partial(_rendered, render, sheet), anywhere=True)


def _rendered(render: Callable[[Any], Made], sheet: Callable[[], Any]) -> bytes | None:
    content = render(sheet())
    return content.encode("utf-8") if isinstance(content, str) else content
