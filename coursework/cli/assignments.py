"""Building papers, of exercises or of an assignment, for ``build``."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from coursework.cli.database import keeping
from coursework.cli.options import (
    exercise_names,
    opened,
    print_notes,
    settings_given,
    shared_by_cluster,
    split_list,
    writes,
)
from coursework.cli.printing import progress_bar, say, warn
from coursework.errors import BadInput, counted, nearest
from coursework.messages import Message
from coursework.system.extras import libraries

if TYPE_CHECKING:
    from coursework.course.course import Course
    from coursework.issuing.assignment import Assignment
    from coursework.issuing.roster import Student
    from coursework.issuing.variant_assignment import AssignedVariants


def is_assignment(exercises: Sequence[str]) -> bool:
    """Return whether a file is named in place of exercises."""
    return len(exercises) == 1 and exercises[0].endswith(".toml")


#: Keys of an assignment's file that are additions to its formats, with the kind of their values.
_ADDED: Mapping[str, tuple[click.ParamType, Mapping[Any, str]]] = {
    "booklet": (click.BOOL, {True: "booklet"}),
    "attendance": (click.BOOL, {True: "attendance"}),
    "scan": (click.BOOL, {True: "scan"}),
    "practice": (click.BOOL, {True: "practice"}),
    "solutions": (click.BOOL, {False: "no-solutions"}),
    "polygons": (click.BOOL, {False: "no-polygons"}),
    "paper": (click.Choice(["a4", "letter"]), {"letter": "letter"}),
    "decimal": (click.Choice(["point", "comma"]), {"comma": "decimal-comma"}),
}


class BuildSettings:
    """Options of a build: those of the command line, and those of its assignment's file."""

    def __init__(self, context: click.Context, file: Path | None, options: Mapping[str, Any]):
        self.context, self.file, self.options = context, file, options

    def is_given(self, option: str) -> bool:
        """Return True for an option of the command line."""
        return self.context.get_parameter_source(option) is not click.core.ParameterSource.DEFAULT

    def of(self, name: str, option: str = "") -> Any:
        """Return an option's value; ``option`` is what the command calls it."""
        option = option or name
        if self.is_given(option) or name not in self.options:
            return self.context.params[option]
        parameter = next(p for p in self.context.command.params if p.name == option)
        return self._cast(name, lambda value: parameter.type_cast_value(self.context, value))

    def path(self, name: str) -> Path | None:
        """Return the path of an option; one of the file is relative to it."""
        path_text = self.of(name)
        if path_text is None:
            return None
        return Path(path_text) if self.is_given(name) or self.file is None else self.file.parent / path_text

    @property
    def formats(self) -> tuple[str, ...]:
        """Formats, with what is added to them."""
        added = set[str]()
        for name in _ADDED.keys() & self.options.keys():
            kind, words = _ADDED[name]
            added.add(words.get(self._cast(name, partial(kind.convert, param=None, ctx=self.context)), ""))
        given = (*self.of("formats"), *self.of("additions"), *sorted(filter(None, added)))
        return tuple(dict.fromkeys(given))

    def _cast(self, name: str, cast: Callable[[Any], Any]) -> Any:
        value = self.options[name]
        try:
            return cast(",".join(map(str, value)) if isinstance(value, list) else value)
        except click.BadParameter as fault:
            raise BadInput(
                "{value}.toml: {name}: {message}",
                value=self.file and self.file.with_suffix(""),
                name=name,
                message=fault.message,
            ) from fault


def codes_ready() -> None:
    """Refuse answer pages where what draws their codes is missing."""
    libraries(("zxingcpp",), "scan draws codes with", "scan")


def build_papers(context: click.Context, exercises: Sequence[str]) -> None:
    """Issue the papers of exercises, or of an assignment, and write their files."""
    from coursework.issuing.assignment import read_assignment

    file = Path(exercises[0]) if is_assignment(exercises) else None
    given = context.params
    if "scan" in given["additions"]:  # what is missing on this machine before any other fault
        codes_ready()
    course = opened(context)
    assignment = None if file is None else read_assignment(file, course)
    settings = BuildSettings(context, file, {} if assignment is None else assignment.options)
    formats = settings.formats
    out, tried = settings.path("out"), given["dry_run"]
    if out is None and not tried:
        if assignment is None:
            raise BadInput("no folder to write: --out DIR")
        raise BadInput('{path} names no folder to write: --out DIR, or out = "…" in the file', path=file)
    if "scan" in formats:
        codes_ready()
        if not {"pdf", "booklet"} & {*formats}:
            raise BadInput(
                (
                    "scan adds answer pages to PDFs, but none is written (--formats {formats}): add "
                    "pdf, or --with "
                    "booklet"
                ),
                formats=",".join(formats),
            )
    names = () if assignment else exercise_names(course, exercises)
    if out is None:
        out, stood = Path(), None
    else:
        stood = _issued_before(out / "issued.json", anew=given["overwrite"])
    if not tried:
        writes(context, out)
    record = out / "issued.json"
    before = None if given["overwrite"] else stood
    if before is None and (given["again"] or given["make_up"]):
        which = "--again" if given["again"] else "--make-up"
        raise BadInput("{which} needs issued papers, but there is no {value}", which=which, value=record)
    if assignment is not None and file is not None:
        for option in ("seed", "parts", "given"):
            if settings.is_given(option):
                warn(
                    "note: --{option} is for exercises named one by one, and is not used: the file of "
                    "an assignment states its parts "
                    "and given values, and its secret draws the variants",
                    option=option,
                )
        issued = _issued_assignment(course, assignment, file, settings, record, before, stood)
    else:
        issued = _issued_exercises(course, names, settings, before)
    if tried:
        tell_dry_run(course, issued, assignment, formats)
        return
    names_issued = {issue.student for issue in issued.issues}
    only = {_student_column(name, names_issued) for name in given["again"]} or None
    shared_by_cluster(context, given["cluster"])
    written, is_unchanged = write_build(
        course,
        issued,
        formats,
        out,
        assignment,
        before=before,
        only=only,
        overwrite=given["overwrite"],
        store=keeping(
            context, given["db"], "" if assignment else out.resolve().name, course.folder.root.name
        ),
    )
    files = counted(written, "file")
    if assignment is None:
        say(
            "{files} in {out}: handouts/ to give away, issued.json and answers.csv to keep"
            if {*formats} - {"nbgrader"}
            else "{files} in {out}: issued.json and answers.csv to keep",
            files=files,
            out=out,
        )
    else:
        count = len({(i.stem, i.sitting) for i in issued.issues if only is None or i.student in only})
        say(
            "{papers} in {out}: {files}, as it was issued"
            if is_unchanged or only
            else "{papers} in {out}: {files}, to give away, issued.json and answers.csv to keep",
            papers=counted(count, "paper"),
            out=out,
            files=files,
        )
    say(
        "the key, for the staff only: {folder}"
        if "no-solutions" in formats
        else "worked solutions and the key, for the staff only: {folder}",
        folder=out / "instructor",
    )
    if "attendance" in formats and only is None and (out / "attendance.csv").exists():
        say(
            "lists of the rooms, for the staff only: {folder}; attendance.csv is to be filled in",
            folder=out / "instructor",
        )
    if "nbgrader" in formats and only is None:
        title = assignment.name if assignment else names[0]
        say(
            "a course for nbgrader: {folder}; the next steps are there, in {name}.md",
            folder=out / "nbgrader",
            name=title,
        )


def tell_dry_run(
    course: Course, issued: AssignedVariants, assignment: Assignment | None, formats: Sequence[str]
) -> None:
    """Say what a build would print, and that nothing was written."""
    from coursework.issuing.dry_run import dry_run

    paper = "letter" if "letter" in formats else "a4"
    report = dry_run(course, issued.issues, assignment, paper=paper, scan="scan" in formats)
    say(
        "{papers}, {each} each: {pages} in all, {sheets} sheet{sheets:|s} of paper{measured}",
        papers=counted(report.papers, "paper"),
        each=_range(min(report.pages), max(report.pages), "page"),
        pages=counted(report.total_pages, "page"),
        sheets=report.total_sheets,
        measured=""
        if report.measured == report.papers
        else Message(" (measured on {count} of them)", count=report.measured),
    )
    for number, share in sorted(report.white.items()):
        say("white space: page {number}, up to {share:.0f} % of its height", number=number, share=100 * share)
    if not report.white:
        say("white space: no page is white by more than a quarter")
    say(
        "points: {total}{mark}: {exercises}",
        total=_points(*report.total_points),
        mark=Message(", mark out of {of:g}", of=assignment.mark.of) if assignment and assignment.mark else "",
        exercises=", ".join(f"{name} {_points(*each)}" for name, each in report.points.items()),
    )
    for name, (used, left) in report.left.items():
        say(
            "variants of {exercise}: {used} used, {left} left",
            exercise=name,
            used=used,
            left=Message("very many") if left is None else left,
        )
    say("nothing was written")


def _range(least: int, most: int, noun: str) -> str:
    if least == most:
        return counted(least, noun)
    return Message("{least} to {most}", least=least, most=counted(most, noun))


def _points(low: float, high: float) -> str:
    return f"{low:g}" if low == high else f"{low:g}–{high:g}"


def _roster(settings: BuildSettings, notes: list[str]) -> list[Student]:
    from coursework.issuing.roster import read_roster

    roster = settings.path("roster")
    return [] if roster is None else read_roster(roster, notes.append, settings.of("columns"))


def _issued_exercises(
    course: Course, names: Sequence[str], settings: BuildSettings, before: Mapping[str, Any] | None
) -> AssignedVariants:
    """Issue exercises, each on a paper of its own; or repeat what was issued, with papers of who makes up."""
    from coursework.issuing.issued import Issued
    from coursework.issuing.issued_again import issued_again, made_up
    from coursework.issuing.issuing import issue
    from coursework.issuing.variant_assignment import AssignedVariants

    given, langs, notes = settings.context.params, settings.of("lang", "langs"), list[str]()
    if given["roster"] and given["count"]:
        raise BadInput("--variants and --roster exclude each other: a roster has one variant a student")
    if given["again"] or given["make_up"]:
        assert before is not None
        issues = issued_again(
            course, Issued(before, "issued.json"), langs if settings.is_given("langs") else ()
        )
        absent = [_student_column(name, {i.student for i in issues}) for name in given["make_up"]]
        return AssignedVariants([*issues, *made_up(course, issues, absent, given["seed"])])
    students = _roster(settings, notes)
    with_language = sum(bool(student.lang) for student in students)
    if with_language and settings.is_given("langs"):
        notes.append(
            Message(
                "the roster states the language of {some} of its {students}, which counts; --lang "
                "{langs} is for the others",
                some=with_language,
                students=counted(len(students), "student"),
                langs=",".join(langs),
            )
        )
    parts = split_list(given["parts"]) or None
    count, seed = given["count"] or 1, given["seed"]
    print_notes(notes)
    stated = settings_given(given["given"], "--given")
    if stated and "practice" in given["additions"]:
        raise BadInput(
            "--given and --with practice exclude each other: a practice notebook draws fresh values"
        )
    issues = issue(
        course,
        names,
        first_seed=seed,
        count=count,
        langs=langs,
        roster=students,
        parts=parts,
        given=stated,
        note=lambda text: print_notes([text]),
    )
    return AssignedVariants(issues, [for_practice(langs[0])] if students else [])


def _issued_assignment(
    course: Course,
    assignment: Assignment,
    file: Path,
    settings: BuildSettings,
    record: Path,
    before: Mapping[str, Any] | None,
    stood: Mapping[str, Any] | None,
) -> AssignedVariants:
    """Issue the papers of an assignment; those issued ``before`` stay."""
    from coursework.issuing.attendance import seating_faults
    from coursework.issuing.issued import secret_of
    from coursework.issuing.roster import Student
    from coursework.issuing.variant_assignment import assign_variants

    given, langs, notes = settings.context.params, settings.of("lang", "langs"), list[str]()
    if settings.path("roster") is not None and not given["again"]:
        students = _roster(settings, notes)
        _check_identity(assignment, students, notes)
        notes += seating_faults(students)
    elif before is not None and before.get("roster"):
        students = []
        if not given["again"] and not given["make_up"]:
            raise BadInput(
                "the papers were issued for a roster: name it, --roster FILE.csv ({value})", value=record
            )
    else:
        students = [Student("") for _ in range(given["count"] or 1)]
    secret = secret_of(stood, str(record))
    issued = assign_variants(course, assignment, students, langs, before, given["make_up"], secret)
    if issued.is_new and not given["dry_run"]:
        notes.append(secret_made(file, record, langs[0]))
    if not given["again"] and not given["make_up"]:
        notes += issued.notes
    print_notes(notes)
    issued.notes = []
    return issued


def write_build(
    course: Course,
    issued: AssignedVariants,
    formats: Sequence[str],
    out: Path,
    assignment: Assignment | None = None,
    *,
    before: Mapping[str, Any] | None = None,
    only: Collection[str] | None = None,
    overwrite: bool = False,
    store: Callable[[Mapping[str, Any]], None] = lambda content: None,
) -> tuple[int, bool]:
    """Write the files of a build; return their number, and whether the record is what it was ``before``.
    ``store`` is handed what ``issued.json`` says, before anything is written."""
    from coursework.issuing.build import files
    from coursework.issuing.issued import LIFTED, issued_content
    from coursework.issuing.letters import unprinted_names
    from coursework.rendering.renderer import renderer_of
    from coursework.system.tables import json_text
    from coursework.system.writing import write_tree

    lifted = str((before or {}).get(LIFTED, ""))
    content = issued_content(issued.issues, assignment, issued.secret, lifted)
    text, record = json_text(content), out / "issued.json"
    if before is not None and assignment is None and not _goes_on(before, json.loads(text)):
        raise BadInput(
            (
                "{before} contains other variants that were issued before; choose another --out, or "
                "--overwrite to "
                "replace them (files that were filled in or changed are kept under other names)"
            ),
            before=record,
        )
    wanted = list(
        files(course, issued.issues, formats, assignment, only=only, secret=issued.secret, lifted=lifted)
    )
    if "nbgrader" in formats and only is None:
        from coursework.platforms.nbgrader import tree as nbgrader

        wanted[:0] = nbgrader.files(course, issued.issues, assignment, out)
    store(content)
    is_unchanged = before is not None and record.read_bytes() == text.encode("utf-8")
    with progress_bar("building", len(wanted)) as advance:
        notes = [*write_tree(out, wanted, advance, anew=overwrite)]
    if {"booklet", "pdf"} & {*formats}:
        names = dict.fromkeys(issue.student for issue in issued.issues)
        notes += unprinted_names(renderer_of(course.folder), names if only is None else only)
    print_notes([*notes, *issued.notes])
    return len(wanted), is_unchanged


def _goes_on(before: Mapping[str, Any], now: Mapping[str, Any]) -> bool:
    """Return whether every sheet that was issued before is unchanged in the new record, which may have more
    students."""
    old, new = _by_place(before), _by_place(now)
    return all(new.get(index) == record for index, record in old.items())


def _by_place(content: Mapping[str, Any]) -> dict[tuple[Any, ...], Any]:
    """Return the records by student, exercise and seed."""
    records = ((item.get("student", ""), item["record"]) for item in content["issued"])
    return {(student, record["exercise"], record["seed"]): record for student, record in records}


def secret_made(path: Path, secret_path: Path, lang: str) -> str:
    """Return the line that says that an assignment's file has no secret, and where the new one is kept."""
    from coursework.language.words import words

    return str(words(lang)["assignment"]["secret_made"]).format(file=path, kept=secret_path)


def for_practice(lang: str) -> str:
    """Return the line that says that exercises built without an assignment are no exam."""
    from coursework.language.words import words

    return str(words(lang)["assignment"]["for_practice"])


def _issued_before(path: Path, *, anew: bool) -> Mapping[str, Any] | None:
    """Return what was issued there; if variants are assigned ``anew``, only what can still be read."""
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
    from coursework.issuing.identity import column_called

    columns = list(dict.fromkeys(title for student in students for title in student.columns))
    printed = () if assignment.anonymous else assignment.identity
    wanted = [(title, Message("a box to fill in by hand is printed")) for title in printed]
    wanted += [(title, Message("the summary has no such column")) for title in assignment.carry or ()]
    if assignment.sort:
        wanted.append((assignment.sort, Message("the papers of a booklet are in the order of the roster")))
    for title, then in wanted:
        if not column_called(columns, title):
            near = nearest(title, columns) if columns else ""
            notes.append(
                Message(
                    "the roster has no column {title!r}{nearest}: {then}",
                    title=title,
                    nearest=near,
                    then=then,
                )
            )
