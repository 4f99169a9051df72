"""Course folder of nbgrader that ``build --formats nbgrader`` writes, in the folder ``nbgrader`` of the
build.

``source/ASSIGNMENT/ASSIGNMENT.ipynb`` is the notebook that nbgrader releases to the class;
``issued/ASSIGNMENT.json`` is the record that answers are marked against; ``own/`` has the students' personal
notebooks if variants differ.
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
from coursework.issuing.assignment import Assignment
from coursework.issuing.issued import issued_content
from coursework.issuing.issuing import Issue
from coursework.issuing.papers import IssuedPaper, papers
from coursework.language.words import words
from coursework.messages import Message
from coursework.platforms.nbgrader.cells import for_nbgrader, without_variants
from coursework.rendering.renderer import Renderer, renderer_of
from coursework.sheets.sheet import Handout
from coursework.system.distribution import pip_install
from coursework.system.tables import json_text
from coursework.system.writing import File

FOLDER = Path("nbgrader")
CONFIG = "nbgrader_config.py"


@dataclass(frozen=True)
class NbAssignment:
    """Assignment of nbgrader: its name, and the exercises or the paper issued to each student."""

    name: str
    issues: tuple[Issue, ...]
    assignment: Assignment | None

    @property
    def lang(self) -> str:
        return self.issues[0].langs[0]

    @property
    def papers(self) -> tuple[tuple[Issue, ...], ...]:
        """Return the issues of each student, in the order of the exercises."""
        return self._papers(issue for issue in self.issues if issue.sitting == 1)

    @property
    def personal_papers(self) -> tuple[tuple[Issue, ...], ...]:
        """Return the papers that need a personal notebook: all if variants differ, and those of make-up
        sittings."""
        return self._papers(issue for issue in self.issues if self.has_personal_variants or issue.sitting > 1)

    def _papers(self, issues: Iterable[Issue]) -> tuple[tuple[Issue, ...], ...]:
        by_stem: dict[str, list[Issue]] = {}
        for issue in issues:
            by_stem.setdefault(issue.stem, []).append(issue)
        return tuple(map(tuple, by_stem.values()))

    @property
    def has_personal_variants(self) -> bool:
        """Return whether students have different variants."""
        return len({tuple(issue.variant.seed for issue in paper) for paper in self.papers}) > 1

    @property
    def has_roster(self) -> bool:
        return any(issue.student for issue in self.issues)


def files(
    course: Course[Any], issues: Sequence[Issue], assignment: Assignment | None, out: Path
) -> Iterator[File]:
    """Yield every file of the course of nbgrader, below the build's folder ``out``.

    Raises
    ------
    BadInput
        One notebook for the class is impossible: several languages, variants without a roster, or variants
        that ask different parts.
    """
    for nb_assignment in _assignments(issues, assignment):
        check(nb_assignment)
        yield from _assignment(renderer_of(course.folder), nb_assignment)
    config = partial(_config, course.folder, out)
    yield File(FOLDER / CONFIG, lambda: config().encode("utf-8"))


def _assignments(issues: Sequence[Issue], assignment: Assignment | None) -> list[NbAssignment]:
    """Return the assignments of nbgrader: the paper, or each exercise that is built alone."""
    if assignment is not None:
        return [NbAssignment(_name(assignment.name), tuple(issues), assignment)]
    names = dict.fromkeys(issue.variant.exercise.name for issue in issues)
    return [
        NbAssignment(name, tuple(i for i in issues if i.variant.exercise.name == name), None)
        for name in names
    ]


def _name(name: str) -> str:
    """Return a name that nbgrader accepts: it separates the names of its own files by plus signs."""
    return name.replace("+", "-").strip()


def check(nb_assignment: NbAssignment) -> None:
    """Raise if one notebook for a class cannot hold the assignment.

    Raises
    ------
    BadInput
        Several languages, variants without a roster, or variants that ask different parts; the message gives
        the remedy.
    """
    langs = dict.fromkeys(lang for issue in nb_assignment.issues for lang in issue.langs)
    if len(langs) > 1 and any(len(issue.langs) > 1 for issue in nb_assignment.issues):
        raise BadInput(
            "nbgrader has one notebook of {name} for a class, in one language: --lang {options}",
            name=nb_assignment.name,
            options=" or --lang ".join(langs),
        )
    if nb_assignment.has_personal_variants and not nb_assignment.has_roster:
        raise BadInput(
            (
                "nbgrader has one notebook of {name} for a class: one variant, or one for each student "
                "with --roster "
                "FILE.csv; found {variants} without a student"
            ),
            name=nb_assignment.name,
            variants=counted(len(nb_assignment.papers), "variant"),
        )
    parts_of: dict[str, set[tuple[tuple[str, float], ...]]] = {}
    for issue in nb_assignment.issues:
        parts = tuple((part.id, float(part.points)) for part in issue.variant.parts)
        parts_of.setdefault(issue.variant.exercise.name, set()).add(parts)
    for exercise, different in parts_of.items():
        if len(different) > 1:
            everywhere = set.intersection(*({part for part, _ in parts} for parts in different))
            advice: str = Message("name parts that all of them ask, or give everybody the same variant")
            if everywhere:
                advice = Message(
                    "name parts that all of them ask, such as --parts {parts}, or give everybody the "
                    "same variant",
                    parts=",".join(sorted(everywhere)),
                )
            raise BadInput(
                (
                    "the variants of {exercise} ask different parts, and nbgrader has the same cells "
                    "for a class: "
                    "{advice}"
                ),
                exercise=exercise,
                advice=advice,
            )


# ---------------------------------------------------------------------- notebooks


def _assignment(renderer: Renderer, nb_assignment: NbAssignment) -> Iterator[File]:
    name = f"{nb_assignment.name}.ipynb"
    first = nb_assignment.papers[0]
    yield File(
        FOLDER / "source" / nb_assignment.name / name,
        partial(_class_notebook, renderer, nb_assignment),
        anywhere=True,
    )
    for paper in nb_assignment.personal_papers:
        path = FOLDER / "own" / nb_assignment.name / paper[0].stem / name
        yield File(path, partial(_own_notebook, renderer, nb_assignment, paper), anywhere=True)
    content = issued_content(nb_assignment.issues, nb_assignment.assignment)
    yield File(FOLDER / "issued" / f"{nb_assignment.name}.json", lambda: json_text(content).encode("utf-8"))
    yield File(
        FOLDER / f"{nb_assignment.name}.md",
        lambda: _next_steps(nb_assignment, first[0].langs[0]).encode("utf-8"),
    )


def _class_notebook(renderer: Renderer, nb_assignment: NbAssignment) -> bytes:
    """Return the notebook that is released: with the variant that all share, or without variants."""
    paper = nb_assignment.papers[0]
    if not nb_assignment.has_personal_variants:
        return _bytes(_notebook(renderer, nb_assignment, paper, student="", personal=False))
    book = _notebook(renderer, nb_assignment, paper, student="", personal=True)
    handouts = [issue.variant.handout() for issue in paper]
    heading = _paper(nb_assignment, paper).heading(nb_assignment.lang) if nb_assignment.assignment else None
    return _bytes(without_variants(book, handouts, heading.title if heading else handouts[0].title))


def _own_notebook(renderer: Renderer, nb_assignment: NbAssignment, paper: Sequence[Issue]) -> bytes:
    return _bytes(_notebook(renderer, nb_assignment, paper, student=paper[0].student, personal=True))


def _notebook(
    renderer: Renderer, nb_assignment: NbAssignment, paper: Sequence[Issue], *, student: str, personal: bool
) -> Mapping[str, Any]:
    handouts: Sequence[Handout]
    if nb_assignment.assignment is None:
        handouts = [issue.variant.handout(student) for issue in paper]
        text = renderer.notebook(handouts[0], collected=True)
    else:
        paper_of_student = _paper(nb_assignment, paper, student=student).paper(paper[0].langs[0])
        handouts, text = paper_of_student.handouts, renderer.notebook(paper_of_student, collected=True)
    return for_nbgrader(json.loads(text), handouts, personal=personal)


def _paper(nb_assignment: NbAssignment, paper: Sequence[Issue], *, student: str = "") -> IssuedPaper:
    """Return the paper of a student, or the paper without a name."""
    assert nb_assignment.assignment is not None
    issued_paper = papers(nb_assignment.assignment, paper, polygons=False)[0]
    if student:
        return issued_paper
    return replace(
        issued_paper, issues=tuple(replace(issue, student="", columns={}) for issue in issued_paper.issues)
    )


def _bytes(book: Mapping[str, Any]) -> bytes:
    import nbformat

    nbformat.validate(book)
    return (json.dumps(book, ensure_ascii=False, indent=1, sort_keys=True) + "\n").encode("utf-8")


# -------------------------------------------------------------------- how to go on


def _next_steps(nb_assignment: NbAssignment, lang: str) -> str:
    texts = words(lang)["nbgrader"]
    text = (
        str(texts["go_on"])
        .strip()
        .format(
            name=nb_assignment.name,
            notebook=nb_assignment.name,
            install=pip_install(extra="nbgrader"),
            variants=texts["each" if nb_assignment.has_personal_variants else "one"],
            student=texts["known" if nb_assignment.has_roster else "anybody"],
        )
    )
    return f"{text}\n"


def _config(folder: Folder, out: Path) -> str:
    """Return nbgrader's configuration file; it names the course's folder by its relative path."""
    course = "" if folder.label == "the built-in course" else _relative_path(folder.root, out / FOLDER)
    named = f", course={course!r}" if course else ""
    return (
        "# A course of nbgrader, written by coursework build. What is not of coursework is run and "
        "marked by nbgrader as ever.\n"
        "from pathlib import Path\n\n"
        "from coursework.nbgrader import configure\n\n"
        f"configure(get_config(), Path(__file__).parent{named})  # noqa: F821\n"
    )


def _relative_path(target: Path, start: Path) -> str:
    """Return the relative path from ``start`` to ``target``; the full path if they are on different
    drives."""
    try:
        return Path(os.path.relpath(target, start.resolve())).as_posix()
    except ValueError:
        return str(target)
