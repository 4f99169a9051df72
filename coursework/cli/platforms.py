"""Commands of the platforms: export."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from coursework.cli.assignments import for_practice, is_assignment, secret_made
from coursework.cli.options import (
    EXISTING_FILE,
    FOLDER,
    LANGUAGE_DEFAULT,
    PATH,
    Lists,
    WholeNumber,
    columns_option,
    decimal_option,
    exercise_names,
    exercises_argument,
    known_languages,
    opened,
    parts_option,
    print_notes,
    seed_option,
    split_list,
    spoken,
    unknown_language,
    writes,
)
from coursework.cli.printing import progress_bar, say
from coursework.errors import BadInput, counted, reason_of
from coursework.system.limits import MOST_VARIANTS

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

    from coursework.course.course import Course
    from coursework.course.secrecy import Secret
    from coursework.issuing.assignment import Assignment
    from coursework.issuing.roster import Student
    from coursework.platforms.pools import DrawnPool

_VARIANTS = 20  #: of a pool, where nothing says how many


class _Wanted(NamedTuple):
    """Options of an export."""

    context: click.Context
    exercises: Sequence[str]  #: names, or the file of an assignment
    variants: int  #: how many; 0 where it is unknown
    seed: int
    langs: Sequence[str]
    parts: Sequence[str] | None  #: ids; None for the usual ones


class _PlatformName(click.ParamType):
    """One of the platforms there are."""

    name = "platform"

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        from click.shell_completion import CompletionItem

        from coursework.platforms.platform import platforms

        return [CompletionItem(name) for name in platforms() if name.startswith(incomplete)]


@click.command()
@click.argument("platform", type=_PlatformName())
@exercises_argument
@click.option(
    "--variants",
    "count",
    type=WholeNumber(1, MOST_VARIANTS),
    help="Number of variants of each exercise; by default that of the students of the roster, else "
    f"{_VARIANTS}.",
)
@click.option(
    "--roster",
    type=PATH,
    help=("CSV of the students, as the platform exports it; it identifies the answers that come back."),
)
@columns_option
@seed_option
@click.option(
    "--lang",
    "langs",
    type=Lists(known_languages, unknown_language),
    callback=spoken,
    help=f"Languages of the questions: fr, en, or both as fr,en; {LANGUAGE_DEFAULT}.",
)
@parts_option
@click.option(
    "--issued",
    type=EXISTING_FILE,
    help=(
        "For gradescope: the issued.json of the build whose sheets were handed out, in place of exercises. "
        "With exercises and a roster, it is that of the same build."
    ),
)
@click.option(
    "--strict", is_flag=True, help="Stop without writing anything if the platform cannot do something."
)
@decimal_option
@click.option("--out", type=FOLDER, required=True, help="Folder to write.")
@click.option("--overwrite", is_flag=True, help="Replace another pool that was exported there before.")
@click.pass_context
def export(
    context: click.Context,
    platform: str,
    exercises: Sequence[str],
    count: int | None,
    roster: Path | None,
    columns: Mapping[str, str] | None,
    seed: int,
    langs: Sequence[str],
    parts: str,
    issued: Path | None,
    strict: bool,
    decimal: str,
    out: Path,
    overwrite: bool,
) -> None:
    """Write a question bank for a PLATFORM: moodle, qti3, qti21, canvas, stack or gradescope.

    From exercises, or from the file of an assignment. The export contains the answers: it is for the staff.
    What the platform cannot do is printed and listed in lost.csv; 'coursework grade' marks the answers that
    come back with issued.json.
    """
    from coursework.issuing.roster import read_roster
    from coursework.platforms.exporting import export as exported
    from coursework.platforms.losses import loss_lines
    from coursework.platforms.platform import platform_of
    from coursework.system.tables import SPREADSHEETS
    from coursework.system.writing import write_tree

    chosen = platform_of(platform)
    course = opened(context)
    writes(context, out)
    notes: list[str] = []
    students = read_roster(roster, notes.append, columns) if roster else []
    if issued is not None and (exercises or roster):
        raise BadInput(
            "--issued {issued} already names the papers: omit the exercises and the roster", issued=issued
        )
    if issued is not None and chosen.draws_variants:
        raise BadInput(
            "--issued is for gradescope, which marks the papers of a build; {platform} has a pool of its own",
            platform=platform,
        )
    wanted = _Wanted(context, exercises, count or 0, seed, langs, split_list(parts) or None)
    if not chosen.draws_variants:
        print_notes(notes)
        _export_autograder(course, wanted, issued, students, out)
        return
    drawn = _drawn(course, wanted, students, out)
    with progress_bar("exporting", len(drawn.issues) * len(drawn.langs)) as advance:
        exported_files = exported(chosen, drawn, students, SPREADSHEETS[decimal], advance)
    lines = list(loss_lines(exported_files.lost, drawn.langs[0]))
    if strict and lines:
        raise BadInput(
            "--strict: {platform} cannot represent {features}, so nothing is written: {lines}",
            platform=platform,
            features=counted(len(lines), "feature"),
            lines=" | ".join(lines),
        )
    if not overwrite:
        _check_folder(out, drawn)
    notes += write_tree(out, exported_files.files, anew=overwrite)
    if not is_assignment(wanted.exercises):
        notes.append(for_practice(langs[0]))
    print_notes(notes)
    for line in lines:
        click.echo(line)
    say(
        (
            "{variants} for {platform} in {out}, with the answers, for the staff only: see "
            "IMPORT.{lang}.txt for "
            "the import, and lost.csv for what the platform cannot do"
        ),
        variants=counted(len(drawn.issues), "variant"),
        platform=platform,
        out=out,
        lang=drawn.langs[0],
    )


def _export_autograder(
    course: Course[Any], wanted: _Wanted, issued: Path | None, students: Sequence[Student], out: Path
) -> None:
    """Write what marks a build's answers on a platform that runs it: of the given build, or of the one
    that would be made."""
    from coursework.platforms.gradescope import PLATFORM
    from coursework.system.writing import File, write_tree

    if issued is None and not wanted.exercises:
        raise BadInput(
            "an autograder needs the papers of a build: --issued DIR/issued.json, or the exercises and "
            "the roster"
            " of the build"
        )
    if issued is not None:
        try:
            data = issued.read_bytes()
        except OSError as fault:
            raise BadInput(
                "{issued} cannot be read: {strerror}", issued=issued, strerror=reason_of(fault)
            ) from fault
        files = list(PLATFORM.autograder(course.folder, data, str(issued)))
    else:
        data = _as_built(course, wanted, students)
        files = list(PLATFORM.autograder(course.folder, data, "what was issued"))
        files.append(File(Path("issued.json"), lambda: data))
    with progress_bar("exporting", len(files)) as advance:
        print_notes(write_tree(out, files, advance))
    say(
        "{archive}, for the staff only; the installation is described in {file}",
        archive=out / "autograder.zip",
        file=files[1].path,
    )
    if issued is None:
        say("the sheets are those of 'coursework build' with the same exercises, roster and options")


def _as_built(course: Course[Any], wanted: _Wanted, students: Sequence[Student]) -> bytes:
    """Return the ``issued.json`` that a build writes."""
    from coursework.issuing.issued import issued_content
    from coursework.issuing.issuing import issue
    from coursework.issuing.roster import Student
    from coursework.issuing.variant_assignment import assign_variants
    from coursework.system.tables import json_text

    count = wanted.variants or 1
    if not is_assignment(wanted.exercises):
        names = exercise_names(course, wanted.exercises)
        issues = issue(
            course,
            names,
            first_seed=wanted.seed,
            count=count,
            langs=wanted.langs,
            roster=students,
            parts=wanted.parts,
        )
        return json_text(issued_content(issues)).encode("utf-8")
    assignment, langs = _assignment(course, wanted)
    if assignment.secret is None:
        raise BadInput(
            (
                "{exercises} has no secret, so its build drew other papers: name the issued ones, --issued "
                "DIR/issued.json"
            ),
            exercises=wanted.exercises[0],
        )
    assigned = assign_variants(course, assignment, students or [Student("") for _ in range(count)], langs)
    print_notes(assigned.notes)
    return json_text(issued_content(assigned.issues, assignment)).encode("utf-8")


def _drawn(course: Course[Any], wanted: _Wanted, students: Sequence[Student], out: Path) -> DrawnPool:
    from coursework.platforms.pools import of_assignment, of_exercises

    count = wanted.variants or len(students)
    if not is_assignment(wanted.exercises):
        names = exercise_names(course, wanted.exercises)
        return of_exercises(course, names, count or _VARIANTS, wanted.seed, wanted.langs, wanted.parts)
    assignment, langs = _assignment(course, wanted)
    if assignment.versions and count > assignment.versions:
        count = assignment.versions
    secret = None if assignment.secret else _secret_beside(wanted, out, langs[0])
    return of_assignment(course, assignment, count or assignment.versions or _VARIANTS, langs, secret)


def _secret_beside(wanted: _Wanted, out: Path, lang: str) -> Secret:
    """Return the secret of an export made there before, else a new one, which is printed."""
    from coursework.course.secrecy import Secret
    from coursework.issuing.issued import Issued, secret_of

    path = out / "issued.json"
    secret = secret_of(Issued.read_previous(path), str(path)) if path.is_file() else None
    if secret is None:
        print_notes([secret_made(Path(wanted.exercises[0]), path, lang)])
    return secret or Secret.new()


def _assignment(course: Course[Any], wanted: _Wanted) -> tuple[Assignment, Sequence[str]]:
    """Return the assignment of the file that is named, and the languages of its questions."""
    from coursework.issuing.assignment import read_assignment

    path = Path(wanted.exercises[0])
    assignment = read_assignment(path, course)
    _refuse_options(wanted.context, path)
    return assignment, _langs(wanted.context, assignment, wanted.langs)


def _refuse_options(context: click.Context, path: Path) -> None:
    default = click.core.ParameterSource.DEFAULT
    for option in ("seed", "parts"):
        if context.get_parameter_source(option) is not default:
            raise BadInput(
                "--{option} is for exercises named on the command line; {path} says it for each of its own",
                option=option,
                path=path,
            )


def _langs(context: click.Context, assignment: Assignment, langs: Sequence[str]) -> Sequence[str]:
    """Return the languages given, else those of the assignment."""
    stated = assignment.options.get("lang")
    is_given = context.get_parameter_source("langs") is not click.core.ParameterSource.DEFAULT
    if is_given or stated is None:
        return langs
    return split_list(stated) if isinstance(stated, str) else tuple(map(str, stated))


def _check_folder(out: Path, drawn: DrawnPool) -> None:
    """Check that an export replaces one of the same pool, or of a smaller one; not of another."""
    from coursework.issuing.issued import Issued

    path = out / "issued.json"
    if not path.is_file():
        return
    before = {_variant_key(item["record"]) for item in Issued.read_previous(path)["issued"]}
    if not before <= {_variant_key(issue.variant.record) for issue in drawn.issues}:
        raise BadInput(
            (
                "{path} contains other variants from an earlier export; choose another --out, or "
                "--overwrite to "
                "replace them (answers to them could then no longer be marked)"
            ),
            path=path,
        )


def _variant_key(record: Any) -> tuple[str, int]:
    return record["exercise"], record["seed"]
