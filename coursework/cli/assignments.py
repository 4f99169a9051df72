"""Building an assignment from its file, for ``build``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from coursework.cli.database import keeping
from coursework.cli.options import opened, print_notes, shared_by_cluster, writes
from coursework.cli.printing import progress_bar, say
from coursework.errors import BadInput, counted, nearest
from coursework.system.extras import libraries

if TYPE_CHECKING:
    from coursework.issuing.assignment import Assignment


def is_assignment(exercises: Sequence[str]) -> bool:
    """Return whether a file is named in place of exercises."""
    return len(exercises) == 1 and exercises[0].endswith(".toml")


@dataclass(frozen=True)
class _Settings:
    """The options of a build: those that were given win over those of the file."""

    context: click.Context
    assignment: Assignment
    base: Path  #: the file's folder, from which its paths are told

    def of(self, name: str, option: str = "") -> Any:
        """Return an option's value; ``option`` is what the command calls it."""
        option = option or name
        given = self.context.params[option]
        default = click.core.ParameterSource.DEFAULT
        if self.context.get_parameter_source(option) is not default or name not in self.assignment.options:
            return given
        parameter = next(p for p in self.context.command.params if p.name == option)
        value = self.assignment.options[name]
        value = ",".join(map(str, value)) if isinstance(value, list) else value
        try:
            return parameter.type_cast_value(self.context, value)
        except click.BadParameter as fault:
            raise BadInput(
                "{value}.toml: {name}: {message}",
                value=self.base / self.assignment.name,
                name=name,
                message=fault.message,
            ) from fault

    def path(self, name: str) -> Path | None:
        path_text = self.of(name)
        if path_text is None:
            return None
        is_given = self.context.get_parameter_source(name) is not click.core.ParameterSource.DEFAULT
        return Path(path_text) if is_given else self.base / path_text


def codes_ready() -> None:
    """Refuse answer pages where what draws their codes is missing."""
    libraries(("zxingcpp",), "--scan draws codes with", "scan")


def check_scan(formats: Sequence[str], *, booklet: bool) -> None:
    """Refuse answer pages where nothing is printed, or what draws their codes is missing."""
    codes_ready()
    if "pdf" not in formats and not booklet:
        raise BadInput(
            "--scan adds answer pages to PDFs, and none is asked (--formats {formats}): add pdf, or --booklet",
            formats=",".join(formats),
        )


def build_assignment(
    context: click.Context, path: Path, *, again: Sequence[str], make_up: Sequence[str], overwrite: bool
) -> None:
    """Issue an assignment and write its files."""
    from coursework.issuing import papers
    from coursework.issuing.assignment import read_assignment
    from coursework.issuing.issued import issued_content, secret_of
    from coursework.issuing.letters import unprinted_names
    from coursework.issuing.roster import Student, read_roster
    from coursework.issuing.variant_assignment import assign_variants
    from coursework.rendering.renderer import renderer_of
    from coursework.system.tables import SPREADSHEETS, json_text
    from coursework.system.writing import write_tree

    course = opened(context)
    assignment = read_assignment(path, course)
    settings = _Settings(context, assignment, path.parent)
    out = settings.path("out")
    if out is None:
        raise BadInput('{path} says no folder to write: --out DIR, or out = "…" in the file', path=path)
    if settings.of("practice"):
        raise BadInput(
            "self-study notebooks are built by naming exercises: coursework build EXERCISE … --practice"
        )
    if settings.of("scan"):
        check_scan(settings.of("formats"), booklet=settings.of("booklet"))
    writes(context, out)
    stood = _issued_before(out / "issued.json", anew=overwrite)
    before = None if overwrite else stood
    if before is None and (again or make_up):
        which = "--again" if again else "--make-up"
        raise BadInput(
            "{which} is for what was issued: there is no {value}", which=which, value=out / "issued.json"
        )
    notes: list[str] = []
    roster = settings.path("roster")
    if roster is not None and not again:
        students = read_roster(roster, notes.append, settings.of("columns"))
        _check_identity(assignment, students, notes)
    elif before is not None and before.get("roster"):
        students = []
        if not again and not make_up:
            raise BadInput(
                "papers were issued by a roster: name it, --roster FILE.csv ({value})",
                value=out / "issued.json",
            )
    else:
        students = [Student("") for _ in range(settings.of("variants", "count") or 1)]
    langs = settings.of("lang", "langs")
    dealt = assign_variants(
        course, assignment, students, langs, before, make_up, secret_of(stood, str(out / "issued.json"))
    )
    if dealt.is_new:
        notes.append(secret_made(path, out / "issued.json", langs[0]))
    names = {issue.student for issue in dealt.issues}
    only = None if not again else {_student_column(name, names) for name in again}
    wanted = list(
        papers.files(
            course,
            assignment,
            dealt.issues,
            settings.of("formats"),
            paper=settings.of("paper"),
            booklet=settings.of("booklet"),
            scan=settings.of("scan"),
            polygons=settings.of("polygons"),
            spreadsheet=SPREADSHEETS[settings.of("decimal")],
            only=only,
            secret=dealt.secret,
        )
    )
    with_nbgrader = "nbgrader" in settings.of("formats") and only is None
    if with_nbgrader:
        from coursework.nbgrader import tree as nbgrader

        wanted[:0] = nbgrader.files(course, dealt.issues, assignment, out)
    if not again and not make_up:
        notes += dealt.notes
    print_notes(notes)
    content = issued_content(dealt.issues, assignment, dealt.secret)
    keeping(context, settings.of("db"), settings.of("name"), course.folder.root.name)(content)
    same = json_text(content).encode("utf-8")
    is_unchanged = before is not None and (out / "issued.json").read_bytes() == same
    shared_by_cluster(context, context.params["cluster"])
    with progress_bar("building", len(wanted)) as advance:
        notes = list(write_tree(out, wanted, advance, anew=overwrite))
    if settings.of("booklet") or "pdf" in settings.of("formats"):
        notes += unprinted_names(renderer_of(course.folder), names if only is None else only)
    print_notes(notes)
    count = len({(i.stem, i.sitting) for i in dealt.issues if only is None or i.student in only})
    as_issued = is_unchanged or again
    say(
        "{papers} in {out}: {files}, as it was issued"
        if as_issued
        else "{papers} in {out}: {files}, to give away, issued.json and answers.csv to keep",
        papers=counted(count, "paper"),
        out=out,
        files=counted(len(wanted), "file"),
    )
    say_staff_half(out, assignment.name if with_nbgrader else "")


def say_staff_half(out: Path, name: str) -> None:
    """Print where the staff's half of a build is, and the nbgrader course of a name; an empty name stands for none."""
    say("worked solutions and the key, for the staff alone: {folder}", folder=out / "instructor")
    if name:
        say(
            "a course of nbgrader: {folder}; how to go on stands there, in {name}.md",
            folder=out / "nbgrader",
            name=name,
        )


def secret_made(path: Path, secret_path: Path, lang: str) -> str:
    """Return the line that says that an assignment's file has no secret, and where the new one is kept."""
    from coursework.language.words import words

    return str(words(lang)["assignment"]["secret_made"]).format(file=path, kept=secret_path)


def for_practice(lang: str) -> str:
    """Return the line that says that exercises built without an assignment are no exam."""
    from coursework.language.words import words

    return str(words(lang)["assignment"]["for_practice"])


def _issued_before(path: Path, *, anew: bool) -> Mapping[str, Any] | None:
    """Return what was issued there; of what is dealt ``anew``, whatever can still be read."""
    from coursework.issuing.issued import Issued

    if not path.is_file():
        return None
    try:
        return Issued.read_previous(path)
    except BadInput:
        if anew:
            return None
        raise


def _student_column(name: str, names: set[str]) -> str:
    from coursework.issuing.students import student_named

    column = student_named(name, names)
    if column is None:
        raise BadInput(
            "no student {name!r} was issued a paper{nearest}", name=name, nearest=nearest(name, names)
        )
    return column


def _check_identity(assignment: Assignment, students: Sequence[Any], notes: list[str]) -> None:
    """Columns that are to be printed should be in the roster; else there are boxes."""
    from coursework.issuing.students import folded

    columns = list(dict.fromkeys(title for student in students for title in student.columns))
    folded_columns = set(map(folded, columns))
    wanted = [(title, "a box to fill in by hand is printed") for title in assignment.identity]
    if assignment.sort:
        wanted.append((assignment.sort, "a booklet stands as the roster does"))
    for title, then in wanted:
        if folded(title) not in folded_columns:
            near = nearest(title, columns) if columns else ""
            notes.append(f"the roster has no column {title!r}{near}: {then}")
