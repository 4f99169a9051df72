"""Files of a build: sheets, notebooks and pages for students, and the staff's solutions and key."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias

from coursework.course.course import Course
from coursework.course.secrecy import Secret
from coursework.issuing import booklets
from coursework.issuing.assignment import Assignment
from coursework.issuing.attendance import list_files
from coursework.issuing.booklets import Booklet
from coursework.issuing.issued import CODES, COLUMNS, Issued, form_rows, issued_content, key_content, key_rows
from coursework.issuing.issuing import Issue
from coursework.issuing.papers import IssuedPaper, papers
from coursework.issuing.questions import PaperQuestions
from coursework.issuing.students import file_stems
from coursework.issuing.wide_form import wide_form
from coursework.rendering.renderer import Renderer, renderer_of
from coursework.sheets.sheet import AnswerSheet, Handout
from coursework.system.tables import SPREADSHEETS, Spreadsheet, csv_file, json_text
from coursework.system.writing import File

#: Columns of the tables of pages in booklets, of papers and of exercises that are handed out alone.
PAPER_COLUMNS = ("student", "version", "lang", "first page", "last page", "file")
SHEET_COLUMNS = ("student", "exercise", "seed", "lang", "first page", "last page", "file")
KEY_COLUMNS = ("student", "exercise", "seed", "part", "value", "unit", "tolerance")


Made: TypeAlias = str | bytes | None


def _text(make: Callable[[], str]) -> Callable[[], bytes]:
    return lambda: make().encode("utf-8")


def files(
    course: Course,
    issues: Sequence[Issue],
    formats: Collection[str],
    assignment: Assignment | None = None,
    *,
    only: Collection[str] | None = None,
    secret: Secret | None = None,
    lifted: str = "",
) -> Iterator[File]:
    """Yield every file of a build, in order: one paper for each student and sitting of an assignment, one for
    each exercise without one.

    Parameters
    ----------
    course, issues, assignment
        The issued variants, with their course and assignment.
    formats
        Of :data:`coursework.issuing.formats.FORMATS` and :data:`~coursework.issuing.formats.ADDITIONS`.
    only
        Students whose papers alone are written, without tables.
    secret
        Secret to store in ``issued.json``.
    lifted
        Day on which names took the place of codes, to store there.
    """
    paper = "letter" if "letter" in formats else "a4"
    spreadsheet = SPREADSHEETS["comma" if "decimal-comma" in formats else "point"]
    renderer = renderer_of(course.folder).on(paper)
    polygons, scan = "no-polygons" not in formats, paper if "scan" in formats else ""
    issued_papers = papers(assignment, issues, polygons=polygons, scan=scan)
    for issued_paper in issued_papers:
        if only is None or issued_paper.first.student in only:
            for lang in issued_paper.first.langs:
                yield from _paper(renderer, issued_paper, lang, formats)
    if only is not None:
        return
    if "booklet" in formats:
        columns = SHEET_COLUMNS if assignment is None else PAPER_COLUMNS
        bound = (_booklet(renderer, *booklet) for booklet in _booklets(issued_papers, booklets.EXERCISES))
        solutions = (
            (name, partial(_solved, renderer, part, lang))
            for name, part, lang in _booklets(issued_papers, booklets.SOLVED)
            if "no-solutions" not in formats
        )
        yield from booklets.bound(bound, solutions, columns, spreadsheet)
    if "attendance" in formats and assignment is not None:
        langs = tuple(dict.fromkeys(lang for issue in issues for lang in issue.langs))
        yield from list_files(renderer, issued_papers, langs, spreadsheet)
    yield from tables(course, issues, assignment, spreadsheet, secret, lifted)


def tables(
    course: Course,
    issues: Sequence[Issue],
    assignment: Assignment | None,
    spreadsheet: Spreadsheet,
    secret: Secret | None = None,
    lifted: str = "",
) -> Iterator[File]:
    """Yield the record of issued variants, the form for answers, and the key for the staff; ``secret`` is
    stored if the assignment's file has none."""
    content = issued_content(issues, assignment, secret, lifted)
    yield File(Path("issued.json"), _text(lambda: json_text(content)))
    yield File(Path("answers.csv"), lambda: csv_file(form_rows(issues), COLUMNS, spreadsheet))
    if assignment is not None:
        questions, codes = PaperQuestions.of(course, Issued(content, "what is issued")), content.get(CODES)
        columns, rows = wide_form(course, content, questions, assignment.identity, codes)
        yield File(Path("answers_wide.csv"), lambda: csv_file(rows, columns, spreadsheet))
    yield from key_files(issues, spreadsheet)


def key_files(issues: Sequence[Issue], spreadsheet: Spreadsheet = SPREADSHEETS["point"]) -> Iterator[File]:
    """Yield the answer key for the staff, as JSON and as a table."""
    key = key_content(issues)
    folder = Path("instructor")
    yield File(folder / "key.json", _text(lambda: json_text(key)))
    yield File(folder / "key.csv", lambda: csv_file(key_rows(key), KEY_COLUMNS, spreadsheet))


def _paper(
    renderer: Renderer, issued_paper: IssuedPaper, lang: str, formats: Collection[str]
) -> Iterator[File]:
    for_student, for_staff = (
        Path(folder) / issued_paper.folder / f"{issued_paper.first.stem}.{lang}"
        for folder in ("handouts", "instructor")
    )
    paper, solution = partial(issued_paper.paper, lang), partial(issued_paper.solution, lang)
    if "pdf" in formats:
        yield rendered(for_student, ".pdf", renderer.pdf, partial(issued_paper.printed, lang))
    if "html" in formats:
        yield rendered(for_student, ".html", renderer.html, paper)
    if "ipynb" in formats and "practice" in formats:
        for issue in issued_paper.issues:
            variant = issue.variant.in_language(lang)
            path = Path("handouts") / variant.exercise.name / for_student.name
            yield rendered(path, ".ipynb", renderer.study, partial(variant.study_sheet, issue.shown))
    elif "ipynb" in formats:
        yield rendered(for_student, ".ipynb", renderer.notebook, paper)
    if "tex" in formats:
        yield from _tex(renderer, issued_paper, lang, for_student, solved=False)
    if "no-solutions" in formats:
        return
    if "pdf" in formats:
        yield rendered(for_staff, ".solution.pdf", renderer.pdf, solution)
    if "html" in formats:
        yield rendered(for_staff, ".solution.html", renderer.html, solution)
    if "tex" in formats:
        yield from _tex(renderer, issued_paper, lang, for_staff, solved=True)


def _tex(
    renderer: Renderer, issued_paper: IssuedPaper, lang: str, path: Path, *, solved: bool
) -> Iterator[File]:
    """Yield a LaTeX source and the drawings of each exercise."""
    stem, numbers = tex_stem(path), issued_paper.drawing_numbers
    figures = [f"{stem}-{'solution-figure' if solved else 'figure'}{number}.pdf" for number in numbers]
    polygons = [f"{stem}-polygons{number}.pdf" for number in numbers]
    yield rendered(
        path,
        ".solution.tex" if solved else ".tex",
        partial(renderer.tex, figures=figures, polygons=polygons),
        partial(issued_paper.solution if solved else issued_paper.paper, lang),
    )
    for issue, figure, drawn in zip(issued_paper.issues, figures, polygons, strict=True):
        variant = issue.variant.in_language(lang)
        sheet: Callable[[], Handout | AnswerSheet] = (
            partial(variant.answer_sheet, issue.shown, polygons=issued_paper.polygons)
            if solved
            else partial(variant.handout, issue.shown)
        )
        yield rendered(path.with_name(figure), "", renderer.figure_pdf, sheet)
        if solved and issued_paper.polygons and variant.exercise.solution.polygons is not None:
            yield rendered(path.with_name(drawn), "", renderer.polygons_pdf, sheet)


def _booklets(
    issued_papers: Sequence[IssuedPaper], limit: int
) -> Iterator[tuple[str, Sequence[IssuedPaper], str]]:
    """Yield the name, the papers and the language of each booklet of a build, of at most so many exercises:
    of each language, and of each exercise that is handed out alone."""
    groups: dict[tuple[str, str], list[IssuedPaper]] = {}
    for issued_paper in sorted(issued_papers, key=lambda issued_paper: issued_paper.sorted_by):
        for lang in issued_paper.first.langs:
            room = "".join(file_stems([issued_paper.room])) if issued_paper.is_by_room else ""
            name = issued_paper.folder or "-".join(filter(None, ("class", room)))
            groups.setdefault((name, lang), []).append(issued_paper)
    for (group_name, lang), group in groups.items():
        exercises = max(len(issued_paper.issues) for issued_paper in group)
        for name, part in booklets.parted(f"{group_name}.{lang}", group, exercises, limit):
            yield name, part, lang


def _booklet(renderer: Renderer, name: str, issued_papers: Sequence[IssuedPaper], lang: str) -> Booklet:
    return Booklet(
        name,
        lambda: renderer.booklet([issued_paper.printed(lang) for issued_paper in issued_papers]),
        [{**issued_paper.cells, "lang": lang} for issued_paper in issued_papers],
    )


def _solved(renderer: Renderer, issued_papers: Sequence[IssuedPaper], lang: str) -> bytes:
    return renderer.booklet([issued_paper.solution(lang) for issued_paper in issued_papers])[0]


def tex_stem(path: Path) -> str:
    """Return the stem of the names of a source's drawings; LaTeX reads only one dot in a name."""
    return path.name.replace(".", "-")


def rendered(path: Path, ending: str, render: Callable[[Any], Made], sheet: Callable[[], Any]) -> File:
    """Return a file that a renderer makes of a sheet, in any process."""
    return File(path.with_name(path.name + ending), partial(_rendered, render, sheet), anywhere=True)


def _rendered(render: Callable[[Any], Made], sheet: Callable[[], Any]) -> bytes | None:
    content = render(sheet())
    return content.encode("utf-8") if isinstance(content, str) else content
