"""Commands that look at a course: list, show, variant, solve."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import click

from coursework.cli.options import (
    DONE,
    FOUND,
    WholeNumber,
    exercise_argument,
    given_option,
    json_option,
    lang_option,
    opened,
    parts_option,
    print_notes,
    seed_option,
    settings_given,
    split_list,
)
from coursework.cli.printing import print_json, print_table, say, warn
from coursework.errors import BadInput, MissingQuantity, WrongValue
from coursework.system.limits import MOST_VARIANTS

# ------------------------------------------------------------------------- look


@click.command("list")
@json_option
@click.pass_context
def list_exercises(context: click.Context, as_json: bool) -> int:
    """List the exercises of the course in the order of learning; the exit status is 1 if one is broken."""
    from coursework.course.folder import course_folder
    from coursework.course.listing import listing

    folder = course_folder(context.obj)
    rows, faults = listing(folder, lambda name: _listed(opened(context)[name]))
    rows = [{**row, **_chapter_of(folder, row["exercise"])} for row in rows]
    if as_json:
        print_json(rows)
    else:
        for chapter in (*folder.chapters, None):
            in_chapter = [r for r in rows if r["chapter"] == (chapter and chapter.number)]
            print_table(
                [_row(r) for r in in_chapter],
                f"{chapter.label}. {_titled(folder, chapter)}" if chapter else "",
            )
        if not folder.names:
            say("This course has no exercise yet.")
    for name, fault in faults.items():
        warn(
            "{name} cannot be listed: {fault}",
            name=name,
            fault=" ".join(fault.removeprefix(f"{name}: ").split()),
        )
    return FOUND if faults else DONE


def _listed(exercise: Any) -> dict[str, Any]:
    """Return the entry of an exercise in ``list``."""
    return {
        "exercise": exercise.name,
        "title": {lang: exercise.title(lang) for lang in exercise.languages},
        "version": exercise.version,
        "parts": sum(not part.by_request for part in exercise.spec.parts),
        "by_request": sum(part.by_request for part in exercise.spec.parts),
    }


def _chapter_of(folder: Any, exercise: str) -> dict[str, Any]:
    """Return the chapter and lesson of an exercise; empty for one that no chapter lists."""
    chapter = next((c for c in folder.chapters if exercise in c.exercises), None)
    section = folder.section_of(exercise)
    return {
        "chapter": chapter and chapter.number,
        "lesson": section.lesson if section else "",
        "needs": list(section.needed(exercise)) if section else [],
    }


def _row(listed: dict[str, Any]) -> dict[str, Any]:
    """Return a row of the table: the chapter stands above it, and the lesson is the first thing needed."""
    cells = {k: v for k, v in listed.items() if k not in ("chapter", "lesson")}
    return {**cells, "title": "\n".join(listed["title"].values()), "needs": "\n".join(listed["needs"])}


def _titled(folder: Any, chapter: Any) -> str:
    return " / ".join(chapter.title(lang) for lang in folder.languages)


@click.command()
@exercise_argument
@seed_option
@lang_option
@parts_option
@given_option
@click.pass_context
def show(
    context: click.Context, exercise: str, seed: int, lang: str, parts: str, given: Sequence[str]
) -> None:
    """Print a statement."""
    from coursework.rendering.renderer import renderer_of

    course = opened(context)
    (drawn,) = _drawn(course[exercise], [seed], lang, parts, given)
    click.echo(renderer_of(course.folder).terminal(drawn.handout()))


def _drawn(
    exercise: Any, seeds: Sequence[int], lang: str, parts: str, given: Sequence[str] = ()
) -> list[Any]:
    """Return variants that ask the parts named, with the values that are given."""
    values = settings_given(given, "--given")
    variants = exercise.variants(seeds, lang, split_list(parts) or None, given=values)
    if exercise.draws.is_whole(values):
        from coursework.issuing.issuing import reservations

        print_notes(reservations(exercise, variants[0]))
    for item in variants:
        if not item.parts:
            raise WrongValue(
                "{exercise}, seed {seed}, asks none of the parts {parts}; try another seed",
                exercise=exercise.name,
                seed=item.seed,
                parts=parts,
            )
    return variants


@click.command()
@exercise_argument
@seed_option
@click.option(
    "--count",
    type=WholeNumber(1, MOST_VARIANTS),
    default=1,
    show_default=True,
    help="Number of variants, with consecutive seeds.",
)
@click.option("--solution", is_flag=True, help="Include the reference answers.")
@lang_option
@parts_option
@given_option
@json_option
@click.pass_context
def variant(
    context: click.Context,
    exercise: str,
    seed: int,
    count: int,
    solution: bool,
    lang: str,
    parts: str,
    given: Sequence[str],
    as_json: bool,
) -> None:
    """Print the records of variants; with --json one JSON object on each line."""
    for drawn in _drawn(opened(context)[exercise], range(seed, seed + count), lang, parts, given):
        record = _with_answers(drawn) if solution else drawn.record
        if as_json:
            print_json(record)
            continue
        rows = [{"quantity": n, "value": g["value"], "unit": g["unit"]} for n, g in record["given"].items()]
        rows += [
            {"quantity": f"{part} (asked)", "value": a["value"], "unit": a["unit"]}
            for part, a in record.get("answers", {}).items()
        ]
        print_table(rows, title=f"{exercise}, seed {drawn.seed}")


def _with_answers(drawn: Any) -> dict[str, Any]:
    from coursework.issuing.issued import record_with_answers

    return record_with_answers(drawn)


@click.command()
@exercise_argument
@click.option("--set", "settings", multiple=True, metavar="NAME=VALUE", help="Set a given value: r1=228.6mm.")
@click.option(
    "--only", default="", metavar="Q,Q", help="Quantities to compute; by default those of every part."
)
@click.option(
    "--effects",
    default=None,
    metavar="E,E",
    help=("Optional effects to include, '' for none; by default those of the questions of the exercise."),
)
@json_option
@click.pass_context
def solve(
    context: click.Context,
    exercise: str,
    settings: Sequence[str],
    only: str,
    effects: str | None,
    as_json: bool,
) -> None:
    """Solve an exercise for given values."""
    from coursework.issuing.issued import plain_value
    from coursework.language.numbers import significant, unit_text

    chosen_exercise = opened(context)[exercise]
    given = settings_given(settings)
    try:
        effect_names = None if effects is None else split_list(effects)
        quantities = chosen_exercise.solve(**given, only=split_list(only) or None, effects=effect_names)
    except MissingQuantity as fault:
        raise BadInput(fault.advising(" ".join(f"--set {n}=…" for n in fault.names))) from fault
    used = {
        n: chosen_exercise.spec.given[n].default
        for n in chosen_exercise.spec.given
        if chosen_exercise.spec.given[n].default is not None
    }
    used |= {n: chosen_exercise.intake.value(n, v) for n, v in given.items()}
    units = chosen_exercise.units
    content = {
        "exercise": exercise,
        "given": {n: {"value": plain_value(v), "unit": units.get(n, "1")} for n, v in used.items()},
        "quantities": {
            n: {"value": _json_value(v), "unit": units.get(n, "1")} for n, v in quantities.items()
        },
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
            for n, v in quantities.items()
        ]
    )


def _json_value(value: Any) -> Any:
    from coursework.issuing.issued import plain_value

    return {"re": value.real, "im": value.imag} if isinstance(value, complex) else plain_value(value)
