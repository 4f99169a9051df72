"""A course of nbgrader: what ``build --formats nbgrader`` writes, in the folder ``nbgrader`` of the build.

``source/ASSIGNMENT/ASSIGNMENT.ipynb`` is the one notebook that nbgrader has for a class; ``issued/ASSIGNMENT.json`` is what
answers are marked against; ``own/`` has the students' own notebooks, where everybody has another variant.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from coursework.course.course import Course
from coursework.course.folder import Folder
from coursework.errors import BadInput, counted
from coursework.language.words import words
from coursework.making.assignment import Assignment
from coursework.making.issued import issued_content
from coursework.making.issuing import Issue
from coursework.making.papers import IssuedPaper, papers
from coursework.nbgrader.cells import for_nbgrader, without_variants
from coursework.rendering.renderer import Renderer, renderer_of
from coursework.sheets.sheet import Handout
from coursework.system.distribution import pip_install
from coursework.system.tables import json_text
from coursework.system.writing import File

FOLDER = Path("nbgrader")
CONFIG = "nbgrader_config.py"


@dataclass(frozen=True)
class Collected:
    """One assignment of nbgrader: its name, and what each student was issued of it, an exercise or a paper."""

    name: str
    issues: tuple[Issue, ...]
    assignment: Assignment | None

    @property
    def lang(self) -> str:
        return self.issues[0].langs[0]

    @property
    def papers(self) -> tuple[tuple[Issue, ...], ...]:
        """The issues of each student, in the order of the exercises."""
        return self._papers(issue for issue in self.issues if issue.sitting == 1)

    @property
    def own(self) -> tuple[tuple[Issue, ...], ...]:
        """The papers that have a notebook of their own: each, where variants differ, and those of who makes up."""
        return self._papers(issue for issue in self.issues if self.is_own or issue.sitting > 1)

    def _papers(self, issues: Iterable[Issue]) -> tuple[tuple[Issue, ...], ...]:
        found: dict[str, list[Issue]] = {}
        for issue in issues:
            found.setdefault(issue.stem, []).append(issue)
        return tuple(map(tuple, found.values()))

    @property
    def is_own(self) -> bool:
        """Whether students have other variants than their neighbours."""
        return len({tuple(issue.variant.seed for issue in paper) for paper in self.papers}) > 1

    @property
    def has_roster(self) -> bool:
        return any(issue.student for issue in self.issues)


def files(
    course: Course[Any], issues: Sequence[Issue], assignment: Assignment | None, out: Path
) -> Iterator[File]:
    """Every file of the course of nbgrader, below the build's folder ``out``.

    Raises
    ------
    BadInput
        It cannot be had with one notebook for a class: several languages, variants without a roster, variants that ask
        different parts.
    """
    for one in _collected(issues, assignment):
        check(one)
        yield from _assignment(renderer_of(course.folder), one)
    config = partial(_config, course.folder, out)
    yield File(FOLDER / CONFIG, lambda: config().encode("utf-8"))


def _collected(issues: Sequence[Issue], assignment: Assignment | None) -> list[Collected]:
    """What nbgrader calls assignments: a paper is one, and so is each exercise that is built alone."""
    if assignment is not None:
        return [Collected(_name(assignment.name), tuple(issues), assignment)]
    names = dict.fromkeys(issue.variant.exercise.name for issue in issues)
    return [
        Collected(name, tuple(i for i in issues if i.variant.exercise.name == name), None) for name in names
    ]


def _name(name: str) -> str:
    """A name that nbgrader takes: it parts the names of its own files by plus signs."""
    return name.replace("+", "-").strip()


def check(one: Collected) -> None:
    """Refuse what one notebook for a class cannot hold.

    Raises
    ------
    BadInput
        Says what would do.
    """
    langs = dict.fromkeys(lang for issue in one.issues for lang in issue.langs)
    if len(langs) > 1 and any(len(issue.langs) > 1 for issue in one.issues):
        raise BadInput(
            f"nbgrader has one notebook of {one.name} for a class, in one language: --lang {' or --lang '.join(langs)}"
        )
    if one.is_own and not one.has_roster:
        raise BadInput(
            f"nbgrader has one notebook of {one.name} for a class: one variant, or a variant a student by --roster FILE.csv; "
            f"found {counted(len(one.papers), 'variant')} that are nobody's"
        )
    asked: dict[str, set[tuple[tuple[str, float], ...]]] = {}
    for issue in one.issues:
        parts = tuple((part.id, float(part.points)) for part in issue.variant.parts)
        asked.setdefault(issue.variant.exercise.name, set()).add(parts)
    for exercise, different in asked.items():
        if len(different) > 1:
            everywhere = set.intersection(*({part for part, _ in parts} for parts in different))
            some = f" such as --parts {','.join(sorted(everywhere))}" if everywhere else ""
            raise BadInput(
                f"the variants of {exercise} do not ask the same, and nbgrader has the same cells for a class: name parts "
                f"that all of them ask,{some} or give everybody one variant"
            )


# ---------------------------------------------------------------------- notebooks


def _assignment(renderer: Renderer, one: Collected) -> Iterator[File]:
    name = f"{one.name}.ipynb"
    first = one.papers[0]
    yield File(FOLDER / "source" / one.name / name, partial(_class_notebook, renderer, one), anywhere=True)
    for paper in one.own:
        path = FOLDER / "own" / one.name / paper[0].stem / name
        yield File(path, partial(_own_notebook, renderer, one, paper), anywhere=True)
    content = issued_content(one.issues, one.assignment)
    yield File(FOLDER / "issued" / f"{one.name}.json", lambda: json_text(content).encode("utf-8"))
    yield File(FOLDER / f"{one.name}.md", lambda: _go_on(one, first[0].langs[0]).encode("utf-8"))


def _class_notebook(renderer: Renderer, one: Collected) -> bytes:
    """The notebook that is released: of the variant that all have, or without variants."""
    paper = one.papers[0]
    if not one.is_own:
        return _bytes(_notebook(renderer, one, paper, student="", own=False))
    book = _notebook(renderer, one, paper, student="", own=True)
    handouts = [issue.variant.handout() for issue in paper]
    heading = _paper(one, paper).heading(one.lang) if one.assignment else None
    return _bytes(without_variants(book, handouts, heading.title if heading else handouts[0].title))


def _own_notebook(renderer: Renderer, one: Collected, paper: Sequence[Issue]) -> bytes:
    return _bytes(_notebook(renderer, one, paper, student=paper[0].student, own=True))


def _notebook(
    renderer: Renderer, one: Collected, paper: Sequence[Issue], *, student: str, own: bool
) -> Mapping[str, Any]:
    handouts: Sequence[Handout]
    if one.assignment is None:
        handouts = [issue.variant.handout(student) for issue in paper]
        text = renderer.notebook(handouts[0], collected=True)
    else:
        whole = _paper(one, paper, student=student).paper(paper[0].langs[0])
        handouts, text = whole.handouts, renderer.paper_notebook(whole, collected=True)
    return for_nbgrader(json.loads(text), handouts, own=own)


def _paper(one: Collected, paper: Sequence[Issue], *, student: str = "") -> IssuedPaper:
    """The paper of a student, or that which is nobody's."""
    assert one.assignment is not None
    whole = papers(one.assignment, paper, polygons=False)[0]
    if student:
        return whole
    return replace(whole, issues=tuple(replace(issue, student="", columns={}) for issue in whole.issues))


def _bytes(book: Mapping[str, Any]) -> bytes:
    import nbformat

    nbformat.validate(book)
    return (json.dumps(book, ensure_ascii=False, indent=1, sort_keys=True) + "\n").encode("utf-8")


# -------------------------------------------------------------------- how to go on


def _go_on(one: Collected, lang: str) -> str:
    said = words(lang)["nbgrader"]
    text = str(said["go_on"]).strip().format(
        name=one.name,
        notebook=one.name,
        install=pip_install(extra="nbgrader"),
        variants=said["each" if one.is_own else "one"],
        student=said["known" if one.has_roster else "anybody"],
    )  # fmt: skip
    return f"{text}\n"


def _config(folder: Folder, out: Path) -> str:
    """nbgrader's configuration; a course of one's own is named by the way to it."""
    course = "" if folder.label == "the built-in course" else _way(folder.root, out / FOLDER)
    named = f", course={course!r}" if course else ""
    return (
        "# A course of nbgrader, written by coursework build. What is not of coursework is run and marked by nbgrader as ever.\n"
        "from pathlib import Path\n\n"
        "from coursework.nbgrader import configure\n\n"
        f"configure(get_config(), Path(__file__).parent{named})  # noqa: F821\n"
    )


def _way(target: Path, start: Path) -> str:
    """The way from a folder to another; on another drive there is none but the whole one."""
    try:
        return Path(os.path.relpath(target, start.resolve())).as_posix()
    except ValueError:
        return str(target)
