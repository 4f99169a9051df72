"""The main job: issued variants become sheets, notebooks and pages, with the staff's half beside them."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from coursework import booklets
from coursework.booklets import File
from coursework.course import Course
from coursework.handout import AnswerSheet, Handout
from coursework.issuing import (
    Issue,
    csv_text,
    form_rows,
    issued_content,
    json_text,
    key_content,
    key_rows,
)
from coursework.rendering import Renderer
from coursework.submissions import COLUMNS

FORMATS = ("pdf", "ipynb", "html", "tex")
KEY_COLUMNS = ("student", "exercise", "seed", "part", "value", "unit", "tolerance")


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
) -> Iterator[File]:
    """Every file of a build, in order.

    ``practice`` makes the notebooks self-study notebooks, which check answers with the installed package. ``paper`` is
    ``a4`` or ``letter``. ``booklet`` adds the sheets of all students in one PDF for each exercise and
    language. Without ``polygons`` the worked solutions leave out the drawn velocity and acceleration polygons. A
    students' copy of the course gives the handouts alone.
    """
    renderer = course.renderer.on(paper)
    for issue in issues:
        for lang in issue.langs:
            yield from _sheets(course, renderer, issue, lang, formats, practice, polygons)
    if booklet:
        yield from booklets.files(course, renderer, issues, polygons=polygons)
    content = issued_content(course, issues)
    yield File(Path("issued.json"), _text(lambda: json_text(content)))
    yield File(Path("answers.csv"), _text(lambda: csv_text(form_rows(issues), COLUMNS)))
    if course.has_solutions:
        key = key_content(issues)
        folder = Path("instructor")
        yield File(folder / "key.json", _text(lambda: json_text(key)))
        yield File(folder / "key.csv", _text(lambda: csv_text(key_rows(key), KEY_COLUMNS)))


def _sheets(
    course: Course,
    renderer: Renderer,
    issue: Issue,
    lang: str,
    formats: Sequence[str],
    practice: bool,
    polygons: bool,
) -> Iterator[File]:
    variant = issue.variant.in_language(lang)
    name = variant.exercise.name
    for_student = Path("handouts") / name / f"{issue.stem}.{lang}"
    for_staff = Path("instructor") / name / f"{issue.stem}.{lang}"

    def handout():
        return variant.handout(issue.student)

    def solution():
        return variant.answer_sheet(issue.student, polygons=polygons)

    def study():
        return renderer.study(variant.study_sheet(issue.student))

    if "pdf" in formats:
        yield File(_with(for_student, ".pdf"), lambda: renderer.pdf(handout()))
    if "html" in formats:
        yield File(_with(for_student, ".html"), _text(lambda: renderer.html(handout())))
    if "ipynb" in formats:
        yield File(
            _with(for_student, ".ipynb"), _text(study if practice else lambda: renderer.notebook(handout()))
        )
    if "tex" in formats:
        yield from _tex(renderer, for_student, ".tex", "figure", handout)
    if course.has_solutions and "pdf" in formats:
        yield File(_with(for_staff, ".solution.pdf"), lambda: renderer.pdf(solution()))
    if course.has_solutions and "html" in formats:
        yield File(_with(for_staff, ".solution.html"), _text(lambda: renderer.html(solution())))
    if course.has_solutions and "tex" in formats:
        drawn = polygons and variant.exercise.solution.polygons is not None
        yield from _tex(renderer, for_staff, ".solution.tex", "solution-figure", solution, polygons=drawn)


def _tex(
    renderer: Renderer,
    path: Path,
    ending: str,
    what: str,
    sheet: Callable[[], Handout | AnswerSheet],
    *,
    polygons: bool = False,
) -> Iterator[File]:
    """A source and its drawings beside it; one dot in their names, as every LaTeX reads it."""
    stem = path.name.replace(".", "-")
    figure, pages = f"{stem}-{what}.pdf", f"{stem}-polygons.pdf"
    yield File(_with(path, ending), _text(lambda: renderer.tex(sheet(), figure, pages)))
    yield File(path.with_name(figure), lambda: renderer.figure_pdf(sheet()))
    if polygons:
        yield File(path.with_name(pages), lambda: renderer.polygons_pdf(sheet()))


def _with(path: Path, ending: str) -> Path:
    return path.with_name(path.name + ending)


def write_tree(
    out: Path, wanted: Sequence[File], progress: Callable[[Path], None] = lambda path: None
) -> None:
    """Make and write a build: it appears whole, in place of the one before, or not at all."""
    staging = out / ".building"
    shutil.rmtree(staging, ignore_errors=True)
    try:
        write(staging, wanted, progress)
        for made in sorted(staging.iterdir()):
            final = out / made.name
            if final.is_dir():
                shutil.rmtree(final)
            made.replace(final)
    finally:
        shutil.rmtree(staging, ignore_errors=True)


def write(out: Path, wanted: Sequence[File], progress: Callable[[Path], None] = lambda path: None) -> None:
    """Make and write files, on all processors; each appears whole or not at all.

    Raises
    ------
    ValueError
        Two files of the same path.
    """
    if len({f.path for f in wanted}) != len(wanted):
        raise ValueError("two files of a build have the same path")
    for folder in {out / f.path.parent for f in wanted}:
        folder.mkdir(parents=True, exist_ok=True)

    def one(file: File) -> None:
        data = file.make()
        if data is not None:
            write_whole(out / file.path, data)
        progress(file.path)

    # Threads, not processes: the typesetter releases the lock, and must not be forked.
    with ThreadPoolExecutor(max_workers=os.cpu_count() or 1) as pool:
        tasks = [pool.submit(one, file) for file in wanted]
        try:
            for task in tasks:
                task.result()
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def write_whole(path: Path, data: bytes) -> None:
    """Write a file so that it appears whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(path.name + ".part")
    part.write_bytes(data)
    part.replace(path)
