"""The main job: issued variants become sheets, notebooks and pages, with the staff's half beside them."""

from __future__ import annotations

import pickle
import shutil
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias

from coursework import booklets
from coursework.blocks import processors
from coursework.booklets import File
from coursework.build_folder import place
from coursework.course import Course
from coursework.errors import BadInput
from coursework.handout import AnswerSheet, Handout
from coursework.issuing import (
    Issue,
    csv_file,
    form_rows,
    issued_content,
    json_text,
    key_content,
    key_rows,
)
from coursework.processes import processes, workers
from coursework.rendering import Renderer
from coursework.submissions import COLUMNS

FORMATS = ("pdf", "ipynb", "html", "tex")
WORTH_PROCESSES = 150  #: files; fewer are made before a process has started
_CHUNK = 8  #: files that a process is sent at once
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
    yield File(Path("answers.csv"), lambda: csv_file(form_rows(issues), COLUMNS))
    if course.has_solutions:
        key = key_content(issues)
        folder = Path("instructor")
        yield File(folder / "key.json", _text(lambda: json_text(key)))
        yield File(folder / "key.csv", lambda: csv_file(key_rows(key), KEY_COLUMNS))


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
    handout = partial(variant.handout, issue.student)
    solution = partial(variant.answer_sheet, issue.student, polygons=polygons)

    def file(path: Path, ending: str, render: Callable[[Any], Made], sheet: Callable[[], Any]) -> File:
        return File(_with(path, ending), partial(_rendered, render, sheet), anywhere=True)

    if "pdf" in formats:
        yield file(for_student, ".pdf", renderer.pdf, handout)
    if "html" in formats:
        yield file(for_student, ".html", renderer.html, handout)
    if "ipynb" in formats and practice:
        yield file(for_student, ".ipynb", renderer.study, partial(variant.study_sheet, issue.student))
    elif "ipynb" in formats:
        yield file(for_student, ".ipynb", renderer.notebook, handout)
    if "tex" in formats:
        yield from _tex(renderer, for_student, ".tex", "figure", handout)
    if course.has_solutions and "pdf" in formats:
        yield file(for_staff, ".solution.pdf", renderer.pdf, solution)
    if course.has_solutions and "html" in formats:
        yield file(for_staff, ".solution.html", renderer.html, solution)
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
    source = partial(renderer.tex, figure=figure, polygons=pages)
    yield File(_with(path, ending), partial(_rendered, source, sheet), anywhere=True)
    yield File(path.with_name(figure), partial(_rendered, renderer.figure_pdf, sheet), anywhere=True)
    if polygons:
        yield File(path.with_name(pages), partial(_rendered, renderer.polygons_pdf, sheet), anywhere=True)


def _rendered(render: Callable[[Any], Made], sheet: Callable[[], Any]) -> bytes | None:
    made = render(sheet())
    return made.encode("utf-8") if isinstance(made, str) else made


def _with(path: Path, ending: str) -> Path:
    return path.with_name(path.name + ending)


def write_tree(
    out: Path,
    wanted: Sequence[File],
    progress: Callable[[Path], None] = lambda path: None,
    *,
    anew: bool = False,
) -> list[str]:
    """Make and write a build: it appears whole, in place of the one before, or not at all.

    What somebody changed or put there is not lost, and ``anew`` is as in :func:`coursework.build_folder.place`; gives
    notes to tell.

    Raises
    ------
    BadInput
        The folder cannot be written, or a file that no build wrote stands in the way.
    """
    staging = out / ".building"
    shutil.rmtree(staging, ignore_errors=True)
    try:
        with writing(out):
            (staging / "new").mkdir(parents=True)
        write(staging / "new", wanted, progress)
        with writing(out):
            return place(staging, out, anew=anew)
    finally:
        shutil.rmtree(staging, ignore_errors=True)


@contextmanager
def writing(place: Path) -> Iterator[None]:
    """What the system says against writing, told with the place that was asked for and what would do."""
    try:
        yield
    except OSError as fault:
        raise BadInput(
            f"{place} cannot be written: {fault.strerror or fault}; name another folder, or make this one writable"
        ) from fault


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
    elsewhere = [file for file in wanted if file.anywhere]
    count = workers(len(elsewhere))
    if len(elsewhere) < WORTH_PROCESSES or count < 2:
        elsewhere = []
    here = [file for file in wanted if not (elsewhere and file.anywhere)]
    with ExitStack() as pools:
        threads = pools.enter_context(ThreadPoolExecutor(processors()))
        tasks = [(threads.submit(_write_all, out, [file]), [file]) for file in here]
        # What threads share they wait for: the interpreter, and what the typesetter remembers.
        if elsewhere:
            submit = pools.enter_context(processes(count))
            chunks = (elsewhere[start : start + _CHUNK] for start in range(0, len(elsewhere), _CHUNK))
            tasks += [(submit(_write_sent, out, pickle.dumps(chunk)), chunk) for chunk in chunks]
        try:
            for task, chunk in tasks:
                task.result()
                for file in chunk:
                    progress(file.path)
        finally:
            for task, _ in tasks:
                task.cancel()


def _write_sent(out: Path, files: bytes) -> None:
    """In another process. The files come as bytes, so that a course that cannot be opened there is told as such."""
    _write_all(out, pickle.loads(files))


def _write_all(out: Path, files: Sequence[File]) -> None:
    for file in files:
        data = file.make()
        if data is not None:
            write_whole(out / file.path, data)


def write_whole(path: Path, data: bytes) -> None:
    """Write a file so that it appears whole or not at all.

    Raises
    ------
    BadInput
        It cannot be written.
    """
    part = path.with_name(path.name + ".part")
    with writing(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        part.write_bytes(data)
        part.replace(path)
