"""The command line: reads arguments, calls what does the work, says what became of it."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from coursework.errors import BadInput, CourseworkError, MissingQuantity, WrongValue, counted
from coursework.printing import print_json, print_note, print_table, progress_bar

if TYPE_CHECKING:
    from coursework.course import Course
    from coursework.roster import Student

DONE, FOUND, BAD = 0, 1, 2  #: exit statuses


def main() -> None:
    """Run the command line; a user's mistake is one line on standard error, never a traceback."""
    sys.exit(run(sys.argv[1:]))


def run(arguments: Sequence[str]) -> int:
    """Run one command and give its exit status."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(encoding="utf-8", errors="replace")
    try:
        return cli.main(list(arguments), prog_name="coursework", standalone_mode=False) or DONE
    except click.exceptions.NoArgsIsHelpError as fault:
        click.echo(fault.format_message(), err=True)
        return BAD
    except click.ClickException as fault:
        hint = (
            f"; see 'coursework {_command(arguments)}--help'" if isinstance(fault, click.UsageError) else ""
        )
        return _complain(fault.format_message().rstrip(".") + hint)
    except click.exceptions.Exit as stop:
        return stop.exit_code
    except click.Abort:
        return _complain("interrupted")
    except CourseworkError as fault:
        return _complain(str(fault))
    except BrokenPipeError:
        sys.stderr.close()
        return DONE
    except OSError as fault:
        return _complain(f"{fault.filename or 'a file'}: {fault.strerror or fault}")


def _command(arguments: Sequence[str]) -> str:
    known = [a for a in arguments if a in cli.commands]
    return f"{known[0]} " if known else ""


def _tell(notes: Sequence[str]) -> None:
    """Say what is to be known and is no error."""
    for note in notes[:10]:
        click.echo(f"coursework: note: {note}", err=True)
    if len(notes) > 10:
        click.echo(f"coursework: note: and {len(notes) - 10} more such", err=True)


def _complain(message: str) -> int:
    click.echo(f"coursework: {' '.join(message.split())}", err=True)
    return BAD


class _Whole(click.ParamType):
    """A whole number that is not less than the least."""

    name = "whole number"

    def __init__(self, least: int):
        self.least = least

    def convert(self, value: Any, param: Any, ctx: Any) -> int:
        try:
            number = int(value)
        except ValueError:
            number = self.least - 1
        if number < self.least:
            self.fail(f"takes a whole number, {self.least} or more; found {value!r}", param, ctx)
        return number


class _Lists(click.ParamType):
    """Comma-separated words, each among those known."""

    name = "list"

    def __init__(self, known: Callable[[], Iterable[str]], refusal: Callable[[str], str] | None = None):
        self.known = known
        self.refusal = (
            refusal  #: what is said of an unknown word, where more is to be said than what there is
        )

    def convert(self, value: Any, param: Any, ctx: Any) -> tuple[str, ...]:
        if isinstance(value, tuple):
            return value
        words = tuple(dict.fromkeys(w.strip() for w in value.split(",") if w.strip()))
        known = tuple(self.known())
        for word in words:
            if word not in known:
                told = self.refusal(word) if self.refusal else f"no {word!r}; there is {', '.join(known)}"
                self.fail(told, param, ctx)
        if not words:
            self.fail(f"nothing named; there is {', '.join(known)}", param, ctx)
        return words


def _known_languages() -> tuple[str, ...]:
    from coursework.language import languages

    return languages()


def _unknown_language(lang: str) -> str:
    from coursework.language import no_language

    return str(no_language(lang))


def _known_formats() -> tuple[str, ...]:
    from coursework.building import FORMATS

    return FORMATS


_json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON.")
_lang_option = click.option("--lang", default="fr", show_default=True, help="Language of the sheet.")
_parts_option = click.option(
    "--parts",
    default="",
    metavar="P,P",
    help="The parts to ask: ids, 'usual' for those asked unless told, 'all' for every one.",
)
_replace_option = click.option(
    "--overwrite", is_flag=True, help="Replace notebooks that are there, and what was written in them."
)
_seed_option = click.option(
    "--seed", type=_Whole(0), default=0, show_default=True, help="Which variant (the first one)."
)


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.option(
    "--course", "folder", type=click.Path(), help="Course folder; the built-in course unless given."
)
@click.version_option(package_name="coursework", prog_name="coursework")
@click.pass_context
def cli(context: click.Context, folder: str | None) -> None:
    """Parameterised exercises in plane-mechanism kinematics: draw, solve, print and mark them."""
    context.obj = folder


def _course(context: click.Context) -> Course:
    from coursework.course import open_course

    return open_course(context.obj)


def _exercise_names(course: Course, names: Sequence[str]) -> tuple[str, ...]:
    for name in names:
        course[name]  # an unknown name stops here, with the nearest one
    if not course.names:
        raise BadInput(
            f"the course {course.root} has no exercise; 'coursework new {course.root} NAME' writes one"
        )
    return tuple(dict.fromkeys(names)) or course.names


# ------------------------------------------------------------------------- look


@cli.command("list")
@_json_option
@click.pass_context
def list_exercises(context: click.Context, as_json: bool) -> int:
    """Say which exercises the course has; status 1 when one of them is broken."""
    course = _course(context)
    rows, faults = [], {}
    for name in course.names:
        try:
            rows.append(_listed(course[name]))
        except CourseworkError as fault:
            faults[name] = str(fault)
    if as_json:
        print_json(rows)
    else:
        print_table([{**r, "title": "\n".join(r["title"].values())} for r in rows])
        if not course.names:
            click.echo("This course has no exercise yet.")
    for name, told in faults.items():
        _complain(f"{name} cannot be listed: {told.removeprefix(f'{name}: ')}")
    return FOUND if faults else DONE


def _listed(exercise: Any) -> dict[str, Any]:
    """What ``list`` says of an exercise."""
    return {
        "exercise": exercise.name,
        "title": {lang: exercise.title(lang) for lang in exercise.languages},
        "version": exercise.version,
        "parts": sum(not part.by_request for part in exercise.spec.parts),
        "by_request": sum(part.by_request for part in exercise.spec.parts),
    }


@cli.command()
@click.argument("exercise")
@_seed_option
@_lang_option
@_parts_option
@click.pass_context
def show(context: click.Context, exercise: str, seed: int, lang: str, parts: str) -> None:
    """Print a statement."""
    course = _course(context)
    (drawn,) = _drawn(course[exercise], [seed], lang, parts)
    click.echo(course.renderer.terminal(drawn.handout()))


def _drawn(exercise: Any, seeds: Sequence[int], lang: str, parts: str) -> list[Any]:
    """Variants that ask the parts named."""
    found = exercise.variants(seeds, lang, _split(parts) or None)
    for one in found:
        if not one.parts:
            raise WrongValue(
                f"{exercise.name}, seed {one.seed}, asks none of the parts {parts}; try another seed"
            )
    return found


@cli.command()
@click.argument("exercise")
@_seed_option
@click.option("--count", type=_Whole(1), default=1, show_default=True, help="How many, seed after seed.")
@click.option("--solution", is_flag=True, help="With the reference answers.")
@_lang_option
@_parts_option
@_json_option
@click.pass_context
def variant(
    context: click.Context,
    exercise: str,
    seed: int,
    count: int,
    solution: bool,
    lang: str,
    parts: str,
    as_json: bool,
) -> None:
    """Print the records of variants, one JSON object a line with --json."""
    from coursework.issuing import record_with_answers

    for drawn in _drawn(_course(context)[exercise], range(seed, seed + count), lang, parts):
        record = record_with_answers(drawn) if solution else drawn.record
        if as_json:
            print_json(record)
            continue
        rows = [{"quantity": n, "value": g["value"], "unit": g["unit"]} for n, g in record["given"].items()]
        rows += [
            {"quantity": f"{part} (asked)", "value": a["value"], "unit": a["unit"]}
            for part, a in record.get("answers", {}).items()
        ]
        print_table(rows, title=f"{exercise}, seed {drawn.seed}")


@cli.command()
@click.argument("exercise")
@click.option("--set", "settings", multiple=True, metavar="NAME=VALUE", help="A given value: r1=228.6mm.")
@click.option("--only", default="", metavar="Q,Q", help="The quantities wanted; every part's unless told.")
@click.option("--effects", default="", metavar="E,E", help="Optional effects to call for.")
@_json_option
@click.pass_context
def solve(
    context: click.Context, exercise: str, settings: Sequence[str], only: str, effects: str, as_json: bool
) -> None:
    """Solve an exercise for one's own numbers."""
    from coursework.issuing import plain_value
    from coursework.language import significant, unit_text

    one = _course(context)[exercise]
    given = _settings(settings)
    try:
        found = one.solve(**given, only=_split(only) or None, effects=_split(effects))
    except MissingQuantity as fault:
        raise BadInput(fault.advising(" ".join(f"--set {n}=…" for n in fault.names))) from fault
    used = {n: one.spec.given[n].default for n in one.spec.given if one.spec.given[n].default is not None}
    used |= {n: one.intake.value(n, v) for n, v in given.items()}
    units = one.units
    content = {
        "exercise": exercise,
        "given": {n: {"value": plain_value(v), "unit": units.get(n, "1")} for n, v in used.items()},
        "quantities": {n: {"value": _json_value(v), "unit": units.get(n, "1")} for n, v in found.items()},
    }
    if as_json:
        print_json(content)
        return
    print_table(
        [
            {
                "quantity": n,
                "value": significant(v, 6) if isinstance(v, (int, float)) else str(v),
                "unit": unit_text(units.get(n, "1"), "en"),
            }
            for n, v in found.items()
        ]
    )


def _settings(settings: Sequence[str]) -> dict[str, str]:
    """The given values of ``--set NAME=VALUE``, as texts."""
    given: dict[str, str] = {}
    for setting in settings:
        name, equals, value = setting.partition("=")
        if not equals or not value.strip():
            raise WrongValue(f"--set takes NAME=VALUE; found {setting!r}")
        given[name.strip()] = value.strip()
    return given


def _split(text: str) -> tuple[str, ...]:
    return tuple(w.strip() for w in text.split(",") if w.strip())


def _json_value(value: Any) -> Any:
    from coursework.issuing import plain_value

    value = plain_value(value)
    return {"re": value.real, "im": value.imag} if isinstance(value, complex) else value


# --------------------------------------------------------------------- simulate


@cli.command()
@click.argument("exercise")
@click.option(
    "--effects", default="", metavar="E,E", help="What the scene calls for; positions alone unless told."
)
@click.option("--set", "settings", multiple=True, metavar="NAME=VALUE", help="A given value: r1=228.6mm.")
@_seed_option
@click.option(
    "--over", type=click.Choice(["cycle"]), default="cycle", show_default=True, help="One turn of the driver."
)
@click.option("--steps", type=_Whole(1), default=360, show_default=True, help="Steps of a cycle.")
@click.option(
    "--drive", metavar="torque=VALUE", help="Integrate the motion under this constant torque instead."
)
@click.option("--duration", type=float, default=1.0, show_default=True, help="Seconds of a motion in time.")
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), help="Folder for table and plot.")
@_json_option
@click.pass_context
def simulate(
    context: click.Context,
    exercise: str,
    effects: str,
    settings: Sequence[str],
    seed: int,
    over: str,
    steps: int,
    drive: str | None,
    duration: float,
    out: Path | None,
    as_json: bool,
) -> None:
    """Move a mechanism over a cycle or in time, with only the effects named.

    Values that are not set are those of the variant of --seed.
    """
    from coursework.scenes import Scene

    one = _course(context)[exercise]
    scene = Scene(one, {**one.variant(seed).used, **_settings(settings)}, _split(effects))
    table = scene.over_cycle(steps) if drive is None else scene.in_time(_drive(one, drive), duration)
    rows = table.rows()
    if as_json:
        print_json({"exercise": exercise, "evaluated": table.evaluated, "rows": rows, "notes": table.notes})
    else:
        click.echo(f"evaluated: {', '.join(table.evaluated)}")
        for note in table.notes:
            click.echo(f"note: {note}")
    if out is not None:
        stem = out / f"{exercise}-{'cycle' if drive is None else 'motion'}"
        _write_scene(table, exercise, stem)
        if not as_json:
            click.echo(f"table and plot: {stem}.csv, .svg")
    elif not as_json:
        shown_rows = rows[:: max(1, len(rows) // 12)]
        print_table([{h: _short_number(v) for h, v in row.items()} for row in shown_rows])


def _write_scene(table: Any, title: str, stem: Path) -> None:
    """The table of a scene as ``STEM.csv`` and its curves as ``STEM.svg``."""
    from coursework.building import write_whole
    from coursework.charts import curves
    from coursework.issuing import csv_text

    first, *others = table.columns
    rows = table.rows()
    write_whole(stem.parent / f"{stem.name}.csv", csv_text(rows, list(rows[0])).encode("utf-8"))
    shown = {n: table.columns[n] for n in others if n != "dead_centre"}
    plot = curves((f"{first} [{table.units[first]}]", table.columns[first]), shown, table.units, title)
    write_whole(stem.parent / f"{stem.name}.svg", plot)


def _short_number(value: Any) -> str:
    from coursework.language import significant

    return significant(value, 5) if isinstance(value, float) else str(value)


def _drive(exercise: Any, text: str) -> float:
    """The torque of ``--drive torque=5``, in N*m."""
    name, equals, value = text.partition("=")
    effort = exercise.spec.driver.effort if exercise.spec.driver else ""
    if not equals or name.strip() != effort:
        wanted = f"{effort}=VALUE" if effort else "nothing: the exercise names no effort of its driver"
        raise WrongValue(f"--drive takes {wanted}; found {text!r}")
    return exercise.intake.value(effort, value.strip())


# ---------------------------------------------------------------------- animate


@cli.command()
@click.argument("exercise")
@_seed_option
@click.option(
    "--effects",
    default="",
    metavar="E,E",
    help="What is seen: position (paths), velocity, acceleration, coriolis; paths alone unless told.",
)
@_lang_option
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), default=".", help="Folder to write.")
@click.pass_context
def animate(context: click.Context, exercise: str, seed: int, effects: str, lang: str, out: Path) -> None:
    """Show a mechanism in motion: over the cycle of its driver, or over the turns of its film.

    Writes a moving picture (SVG) and a page with a slider (HTML).
    """
    from coursework.building import write_whole

    animation = _course(context)[exercise].variant(seed, lang).animation(_split(effects))
    pages = {"svg": animation.svg(), "html": animation.html()}
    for ending, text in pages.items():
        write_whole(out / f"{exercise}.{ending}", text.encode("utf-8"))
        click.echo(f"{out / exercise}.{ending}")


# ----------------------------------------------------------------------- lesson


@cli.command()
@click.argument("lessons", nargs=-1)
@_lang_option
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), help="Folder for the notebooks.")
@_replace_option
@click.pass_context
def lesson(
    context: click.Context, lessons: Sequence[str], lang: str, out: Path | None, overwrite: bool
) -> None:
    """Write the course's lessons as notebooks; without --out, list them."""
    from coursework.building import write_whole

    course = _course(context)
    books = {name: course.lesson(name, lang) for name in lessons or course.lessons}
    if out is None:
        for name in books:
            click.echo(name)
        return
    paths = [out / f"{name}.{lang}.ipynb" for name in books]
    _spare(paths, overwrite)
    for path, book in zip(paths, books.values(), strict=True):
        write_whole(path, book.encode("utf-8"))
        click.echo(str(path))


def _spare(paths: Sequence[Path], overwrite: bool) -> None:
    """Notebooks that somebody may have written in are not replaced unasked."""
    there = [] if overwrite else [path for path in paths if path.exists()]
    if there:
        told = str(there[0]) if len(there) == 1 else f"{there[0]} and {len(there) - 1} more"
        exist = "exists" if len(there) == 1 else "exist"
        raise BadInput(
            f"{told} {exist} already, and may hold what somebody wrote; choose another --out, or --overwrite to "
            "replace"
        )


# --------------------------------------------------------------------- notebook


@cli.command()
@click.argument("exercises", nargs=-1)
@_seed_option
@click.option(
    "--lang", "langs", type=_Lists(_known_languages, _unknown_language), default="fr", show_default=True
)
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    default="notebooks",
    show_default=True,
    help="Folder for the notebooks.",
)
@_replace_option
@click.pass_context
def notebook(
    context: click.Context,
    exercises: Sequence[str],
    seed: int,
    langs: Sequence[str],
    out: Path,
    overwrite: bool,
) -> None:
    """Write self-study notebooks: predictions, instant feedback, hints, plots, fresh variants.

    One for each exercise named, else for every exercise of the course.
    """
    from coursework.building import write_whole
    from coursework.issuing import distinct_variants

    course = _course(context)
    paths = {
        (name, lang): out / f"{name}.{lang}.ipynb"
        for name in _exercise_names(course, exercises)
        for lang in langs
    }
    _spare(list(paths.values()), overwrite)
    for (name, lang), path in paths.items():
        (variant,) = distinct_variants(course[name], seed, 1, lang)
        write_whole(path, course.renderer.study(variant.study_sheet()).encode("utf-8"))
        click.echo(str(path))


# --------------------------------------------------------------------- accuracy


@cli.command()
@click.argument("exercises", nargs=-1)
@click.option("--quick", is_flag=True, help="Fewer places and shorter timings: under half a minute.")
@_lang_option
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    help="Folder for the page (HTML, PDF) and JSON.",
)
@_json_option
@click.pass_context
def accuracy(
    context: click.Context, exercises: Sequence[str], quick: bool, lang: str, out: Path | None, as_json: bool
) -> None:
    """Measure what accuracy costs in time, here and now.

    Every exercise whose solution states a study, unless some are named: time a configuration and largest
    error against fifty digits, at generic and at hard places, of every way to compute it.
    """
    import json

    from coursework.accuracy.measuring import measure, study_of
    from coursework.building import write_whole

    course = _course(context)
    names = exercises or [n for n in course.names if study_of(course[n]) is not None]
    rows = []
    for name in names:
        for row in measure(course[name], quick=quick):
            rows.append(row)
            if not as_json:
                error = "no answer" if row.max_error is None else f"{row.max_error:.1e}"
                failed = (
                    f"  no answer at {row.failed} of {row.n}"
                    if row.failed and row.max_error is not None
                    else ""
                )
                click.echo(
                    f"{row.exercise:22} {row.what:9} {row.method:20} {row.place:8} "
                    f"{row.ns_per_configuration:14,.0f} ns  {error}{failed}"
                )
    as_rows = [row.as_json() for row in rows]
    if as_json:
        print_json(as_rows)
    if out is not None:
        from coursework.accuracy.page import report

        page = report(course, rows, lang)
        write_whole(out / "accuracy.json", (json.dumps(as_rows, indent=1) + "\n").encode())
        write_whole(out / "accuracy.html", course.renderer.report_html(page).encode("utf-8"))
        write_whole(out / "accuracy.pdf", course.renderer.report_pdf(page))
        if not as_json:
            click.echo(f"page and rows: {out / 'accuracy'}.html, .pdf, .json")


# ------------------------------------------------------------------------ build


@cli.command()
@click.argument("exercises", nargs=-1)
@click.option("--variants", "count", type=_Whole(1), help="How many variants; with a roster, one a student.")
@_seed_option
@click.option(
    "--roster",
    type=click.Path(path_type=Path),
    help="CSV with a column student, or surname and first name, and, if wanted, lang.",
)
@click.option("--formats", type=_Lists(_known_formats), default="pdf,ipynb,html", show_default=True)
@click.option(
    "--lang",
    "langs",
    type=_Lists(_known_languages, _unknown_language),
    default="fr",
    show_default=True,
    help="Languages of the sheets: fr, en, or both as fr,en. A student whose roster line says lang has that one.",
)
@_parts_option
@click.option("--practice", is_flag=True, help="Self-study notebooks, which check answers.")
@click.option(
    "--paper",
    type=click.Choice(["a4", "letter"]),
    default="a4",
    show_default=True,
    help="Paper of the sheets.",
)
@click.option("--booklet", is_flag=True, help="Also all students' sheets in one PDF, to print at once.")
@click.option(
    "--polygons/--no-polygons",
    default=True,
    help="Velocity and acceleration polygons in the worked solutions; without them a build takes half to two thirds of the time.",
)
@click.option(
    "--out", type=click.Path(path_type=Path, file_okay=False), required=True, help="Folder to write."
)
@click.option(
    "--overwrite",
    is_flag=True,
    help="Replace what was issued there before. Files that were filled in or changed are set aside, not lost.",
)
@click.pass_context
def build(
    context: click.Context,
    exercises: Sequence[str],
    count: int | None,
    seed: int,
    roster: Path | None,
    formats: Sequence[str],
    langs: Sequence[str],
    parts: str,
    practice: bool,
    paper: str,
    booklet: bool,
    polygons: bool,
    out: Path,
    overwrite: bool,
) -> None:
    """Make sheets, notebooks and pages for a class, with the staff's half beside them."""
    from coursework.roster import read_roster

    if roster and count:
        raise BadInput("--variants and --roster exclude each other: a roster has one variant a student")
    course = _course(context)
    names = _exercise_names(course, exercises)
    notes: list[str] = []
    students = read_roster(roster, notes.append) if roster else []
    own = sum(bool(student.lang) for student in students)
    if own and context.get_parameter_source("langs") is not click.core.ParameterSource.DEFAULT:
        notes.append(
            f"the roster says the language of {own} of its {counted(len(students), 'student')}, which counts; "
            f"--lang {','.join(langs)} is for those of whom it says none"
        )
    _tell(notes)
    written = build_files(
        course,
        names,
        count or 1,
        seed,
        students,
        formats,
        langs,
        out,
        parts=_split(parts) or None,
        practice=practice,
        paper=paper,
        booklet=booklet,
        polygons=polygons,
        overwrite=overwrite,
    )
    click.echo(
        f"{counted(written, 'file')} in {out}: handouts/ to give away, issued.json and answers.csv to keep"
    )
    if course.has_solutions:
        click.echo(f"worked solutions and the key, for the staff alone: {out / 'instructor'}")


def build_files(
    course: Course,
    names: Sequence[str],
    count: int,
    seed: int,
    students: Sequence[Student],
    formats: Sequence[str],
    langs: Sequence[str],
    out: Path,
    *,
    parts: Sequence[str] | None = None,
    practice: bool = False,
    paper: str = "a4",
    booklet: bool = False,
    polygons: bool = True,
    overwrite: bool = False,
) -> int:
    """Issue and write a build; gives how many files were written."""
    from coursework import building, issuing

    issues = issuing.issue(
        course, names, first_seed=seed, count=count, langs=langs, roster=students, parts=parts
    )
    issued = issuing.json_text(issuing.issued_content(course, issues))
    before = out / "issued.json"
    if before.is_file() and before.read_bytes() != issued.encode("utf-8") and not overwrite:
        raise BadInput(
            f"{before} holds other variants, issued before; choose another --out, or --overwrite to replace them "
            "(files that were filled in or changed are set aside, not lost)"
        )
    wanted = list(
        building.files(
            course, issues, formats, practice=practice, paper=paper, booklet=booklet, polygons=polygons
        )
    )
    with progress_bar("building", len(wanted)) as advance:
        notes = building.write_tree(out, wanted, advance, anew=overwrite)
    _tell(notes)
    return len(wanted)


# ------------------------------------------------------------------------ grade


@cli.command()
@click.argument("submissions", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "--issued", type=click.Path(path_type=Path), required=True, help="The issued.json of the build."
)
@click.option(
    "--out", type=click.Path(path_type=Path, file_okay=False), help="Folder to write; marks/ beside it."
)
@click.option(
    "--feedback/--no-feedback",
    default=None,
    help="Feedback sheets, a PDF a student; unless told, for up to 1000 students.",
)
@click.option(
    "--accepted",
    type=click.Path(path_type=Path, dir_okay=False, exists=True),
    help="CSV of answers accepted by hand: student,exercise,seed,part and, if wanted, points,reason.",
)
@click.pass_context
def grade(
    context: click.Context,
    submissions: Sequence[Path],
    issued: Path,
    out: Path | None,
    feedback: bool | None,
    accepted: Path | None,
) -> int:
    """Mark CSV, JSON, Parquet and notebooks of answers, files or folders of them.

    Marked again, it says what changed and for whom.
    """
    if issued.is_dir():
        inside = issued / "issued.json"
        would_do = f"did you mean {inside}?" if inside.exists() else "name the issued.json that build wrote"
        raise BadInput(f"--issued takes a file; {issued} is a folder: {would_do}")
    out = out or issued.parent / "marks"
    book = grade_with_bar(_course(context), submissions, issued, out, feedback=feedback, accepted=accepted)
    told = f"{counted(book.rows_in, 'row')}: {book.marked} marked, {len(book.rejected)} rejected"
    told += f", {book.blanks} blank beside another" if book.blanks else ""
    click.echo(f"{told}; see {out}")
    if book.unreadable:
        what = "1 unreadable answer" if book.unreadable == 1 else f"{book.unreadable} unreadable answers"
        click.echo(f"{what} to look at: verdict unreadable in {out / 'marks.csv'}")
    if book.changes:
        what = (
            "1 mark is not what it was"
            if book.changes == 1
            else f"{book.changes} marks are not what they were"
        )
        click.echo(f"{what} before; see {out / 'changes.csv'}")
    for warning in book.warnings:
        click.echo(f"coursework: note: {warning}", err=True)
    for rejected in book.rejected[:10]:
        click.echo(f"coursework: {rejected.source}: {rejected.reason}", err=True)
    if len(book.rejected) > 10:
        more = len(book.rejected) - 10
        click.echo(f"coursework: and {more} more in {out / 'rejected.csv'}", err=True)
    return FOUND if book.needs_a_look else DONE


def grade_with_bar(
    course: Course,
    submissions: Sequence[Path],
    issued: Path,
    out: Path,
    *,
    feedback: bool | None = True,
    accepted: Path | None = None,
):
    """Mark files and write the tables, with a bar on a terminal."""
    from coursework.grading import grade_files

    with progress_bar("marking", None) as advance:
        return grade_files(
            course, submissions, issued, out, feedback=feedback, accepted=accepted, progress=advance
        )


# ----------------------------------------------------------------------- report


@cli.command()
@click.argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@_lang_option
@click.option(
    "--out", type=click.Path(path_type=Path, file_okay=False), help="Folder to write; DIR/report unless told."
)
@_json_option
@click.pass_context
def report(context: click.Context, folder: Path, lang: str, out: Path | None, as_json: bool) -> None:
    """Say how a class did, from the folder DIR that grade wrote: a page (HTML, PDF) and tables.

    With --json and no --out nothing is written.
    """
    from coursework import statistics, statistics_page
    from coursework.language import words

    words(lang)  # an unknown language stops here
    course = _course(context)
    marks = statistics.read(folder)
    told = statistics.measure(marks, statistics_page.sheet_order(course, marks.exercises))
    if as_json:
        print_json(told.as_json())
    if out is not None or not as_json:
        out = out or folder / "report"
        _write_report(course, told, lang, out)
    if not as_json:
        click.echo(
            f"{counted(told.students, 'student')}, {counted(told.answers, 'answer')}, {told.needs_a_look} to be looked at; "
            f"see {out / 'report'}.html, .pdf, parts.csv, mistakes.csv"
        )


def _write_report(course: Course, told: Any, lang: str, out: Path) -> None:
    """Everything is made before the first file is written."""
    from coursework import statistics, statistics_page
    from coursework.building import write_whole
    from coursework.issuing import csv_text

    page = statistics_page.report(course, told, lang)
    mistakes = statistics_page.mistake_rows(course, told, lang)
    files = {
        "report.html": course.renderer.report_html(page).encode("utf-8"),
        "report.pdf": course.renderer.report_pdf(page),
        "parts.csv": csv_text((p.row() for p in told.parts), statistics.PART_COLUMNS).encode("utf-8"),
        "mistakes.csv": csv_text(mistakes, statistics.MISTAKE_COLUMNS).encode("utf-8"),
    }
    for name, content in files.items():
        write_whole(out / name, content)


# ------------------------------------------------------------------------ check


@cli.command()
@click.argument("exercises", nargs=-1)
@click.option("--variants", "count", type=_Whole(1), default=200, show_default=True)
@_json_option
@click.pass_context
def check(context: click.Context, exercises: Sequence[str], count: int, as_json: bool) -> int:
    """Prove the promises of every exercise of the course; status 1 when one is broken."""
    from coursework import check_report, checks

    course = _course(context)
    names = _exercise_names(course, exercises)
    with progress_bar("checking", len(names)) as advance:
        reports = checks.check_all(course, names, count, advance)
    if as_json:
        for report in reports:
            print_json(report.as_json())
    else:
        print_table(check_report.table(reports))
        for note in check_report.notes(reports):
            print_note(note)
        for report in reports:
            for failure in report.failures[:20]:
                click.echo(f"{report.name}: {failure}")
            if len(report.failures) > 20:
                click.echo(f"{report.name}: and {len(report.failures) - 20} more")
    return DONE if all(r.passed for r in reports) else FOUND


# -------------------------------------------------------------------------- new


@cli.command()
@click.argument("folder", type=click.Path(path_type=Path, file_okay=False))
@click.argument("exercise", required=False)
def new(folder: Path, exercise: str | None) -> None:
    """Write a working course folder, or a working exercise in one."""
    from coursework.scaffold import new_course, new_exercise

    made = new_exercise(folder, exercise) if exercise else new_course(folder)
    for path in made:
        click.echo(f"wrote {path}")
    click.echo(f"try: coursework --course {folder} check")


# ------------------------------------------------------------------------- demo


@cli.command()
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), default="demo", show_default=True)
def demo(out: Path) -> None:
    """Do the whole job on a small class: sheets, answers of all kinds, marks."""
    from coursework.demo import class_of_twelve

    rows, report = class_of_twelve(out, build_files, grade_with_bar)
    print_table(rows, title="What became of the answers")
    for line in report:
        click.echo(line)
