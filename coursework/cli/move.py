"""Commands that move a mechanism: simulate, animate."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from coursework.cli import completion
from coursework.cli.options import (
    FOLDER,
    WholeNumber,
    decimal_option,
    exercise_argument,
    is_typed,
    json_option,
    lang_option,
    opened,
    seed_option,
    settings_given,
    split_list,
    writes,
)
from coursework.cli.printing import print_json, print_table, say
from coursework.errors import WrongValue
from coursework.messages import Message, localised
from coursework.system.limits import MOST_STEPS

if TYPE_CHECKING:
    from coursework.scenes.added import Motor
    from coursework.scenes.effect_cost import EffectBudget, EffectInfluence
    from coursework.scenes.scene_files import SceneFile
    from coursework.scenes.scenes import Scene, SceneTable

# --------------------------------------------------------------------- simulate


@click.command()
@click.argument("exercise", metavar="EXERCISE|SCENE.toml", shell_complete=completion.exercises)
@click.option("--effects", default="", metavar="E,E", help="Effects to simulate; by default positions only.")
@click.option("--set", "settings", multiple=True, metavar="NAME=VALUE", help="Set a given value: r1=228.6mm.")
@click.option(
    "--show",
    multiple=True,
    metavar="WHAT",
    help="Show this as well: stroke, drive_torque, 'reaction B', 'velocity B'.",
)
@seed_option
@click.option(
    "--over",
    type=click.Choice(["cycle"]),
    default="cycle",
    show_default=True,
    help="Run over one turn of the driver, or over the travel of its jack.",
)
@click.option("--steps", type=WholeNumber(1, MOST_STEPS), help="Steps of a cycle; 360 by default.")
@click.option(
    "--drive",
    metavar="torque=VALUE",
    help="Integrate the motion under this constant torque instead of a cycle.",
)
@click.option("--duration", metavar="SECONDS", help="Duration of a motion in time; 1 s by default.")
@click.option("--plan", is_flag=True, help="Print what would be computed and why, and stop.")
@click.option(
    "--budget",
    is_flag=True,
    help="Print the cost of each effect in time, and its influence on the results shown.",
)
@click.option(
    "--tolerance",
    default=0.01,
    show_default=True,
    help="With --budget: part of an output that may be neglected.",
)
@click.option("--out", type=FOLDER, help="Folder for the table and the plot.")
@decimal_option
@json_option
@click.pass_context
def simulate(
    context: click.Context,
    /,
    exercise: str,
    plan: bool,
    budget: bool,
    tolerance: float,
    out: Path | None,
    decimal: str,
    as_json: bool,
    **options: Any,
) -> None:
    """Simulate a mechanism over a cycle or in time, with only the effects that are named.

    A scene is a file, or an exercise with options; values that are not set are those of the variant of
    --seed.
    """
    typed = {name for name in (*options, "tolerance") if is_typed(context, name)}
    if plan and budget:
        raise WrongValue("--plan says what would be done, --budget does it; give one of them")
    if "tolerance" in typed and not budget:
        raise WrongValue("--tolerance goes with --budget")
    if out is not None:
        writes(context, out)
    scene_file = _scene_file(opened(context), exercise, options, typed)
    if plan:
        _tell_plan(scene_file.scene, as_json)
    elif budget:
        _tell_budget(scene_file, tolerance, out, decimal, as_json)
    else:
        _tell_table(scene_file, out, decimal, as_json)


def _scene_file(course: Any, exercise: str, settings: dict[str, Any], typed: set[str]) -> SceneFile:
    """Return the scene of a file, or that of the options."""
    from coursework.scenes.scene_files import SceneFile, read_scene
    from coursework.scenes.scenes import Scene

    if exercise.endswith(".toml"):
        for option in ("effects", "settings", "show", "seed", "over", "steps", "drive", "duration"):
            if option in typed:
                name = "set" if option == "settings" else option
                raise WrongValue(
                    "{file} states the scene; leave --{name} out, or write it there", file=exercise, name=name
                )
        return read_scene(Path(exercise), course)
    chosen_exercise = course[exercise]
    given = {**chosen_exercise.variant(settings["seed"]).given, **settings_given(settings["settings"])}
    scene = Scene(chosen_exercise, given, split_list(settings["effects"]), tuple(settings["show"]))
    if settings["drive"] is None:
        if settings["duration"] is not None:
            raise WrongValue("--duration applies to a motion in time: give its drive too, --drive torque=5")
        return SceneFile(exercise, scene, settings["steps"] or 360)
    for option in ("steps", "over"):
        if option in typed:
            raise WrongValue(
                "--{option} applies to a cycle, and with --drive the motion runs in time", option=option
            )
    return SceneFile(
        exercise,
        scene,
        drive=_drive(chosen_exercise, settings["drive"]),
        duration=_seconds(settings["duration"]),
    )


def _seconds(text: str | None) -> float:
    from coursework.parsing.numbers import read_number

    if text is None:
        return 1.0
    reading = read_number(text, "s")
    if reading.status != "read" or len(reading.values) != 1 or not reading.values[0] > 0:
        raise WrongValue(
            "--duration takes a time above 0, such as 2 or '500 ms'; found {found!r}", found=text
        )
    return reading.values[0]


def _run(scene_file: SceneFile, scene: Scene) -> SceneTable:
    """Return a scene as its file says: over a cycle, or in time."""
    if scene_file.drive is None:
        return scene.over_cycle(scene_file.steps)
    return scene.in_time(scene_file.drive, scene_file.duration)


def _tell_table(scene_file: SceneFile, out: Path | None, decimal: str, as_json: bool) -> None:
    table = _run(scene_file, scene_file.scene)
    if as_json:
        name = scene_file.scene.exercise.name
        print_json(
            {"exercise": name, "evaluated": table.evaluated, "rows": table.rows(), "notes": table.notes}
        )
    else:
        say("evaluated: {effects}", effects=", ".join(table.evaluated))
        for note in table.notes:
            say("note: {note}", note=note)
    if out is not None:
        stem = out / f"{scene_file.name}-{'cycle' if scene_file.drive is None else 'motion'}"
        _write_rows(table.rows(), stem, decimal)
        _write_plot(table, scene_file.name, stem)
        if not as_json:
            say("table and plot: {stem}.csv, .svg", stem=stem)
    elif not as_json:
        shown_rows = table.rows(max(1, len(table) // 12))
        print_table([{h: _short_number(v) for h, v in row.items()} for row in shown_rows])


def _tell_plan(scene: Scene, as_json: bool) -> None:
    from coursework.scenes.planning import plan

    steps = plan(scene)
    if as_json:
        print_json({"exercise": scene.exercise.name, "plan": [{"evaluated": a, "why": b} for a, b in steps]})
    else:
        print_table([{"evaluated at every instant": a, "why": b} for a, b in steps])


def _tell_budget(
    scene_file: SceneFile, tolerance: float, out: Path | None, decimal: str, as_json: bool
) -> None:
    from coursework.scenes.effect_cost import budget

    effect_budget = budget(scene_file.scene, partial(_run, scene_file), tolerance)
    summary, rows = list(effect_budget.said()), list(_budget_rows(effect_budget))
    if as_json:
        print_json(
            {
                "exercise": scene_file.scene.exercise.name,
                "seconds": effect_budget.seconds,
                "effects": rows,
                "said": summary,
            }
        )
    else:
        print_table(list(_each_effect_once(rows)))
        say("the whole scene: {milliseconds:.3g} ms", milliseconds=1e3 * effect_budget.seconds)
        for sentence in summary:
            click.echo(sentence)
    if out is not None:
        stem = out / f"{scene_file.name}-budget"
        _write_rows(rows, stem, decimal)
        _write_budget_plot(effect_budget, scene_file.name, stem)
        if not as_json:
            say("table and plot: {stem}.csv, .svg", stem=stem)


def _each_effect_once(rows: Sequence[dict[str, Any]]) -> Iterator[dict[str, str]]:
    """Rows to be read: an effect and its time stand in its first row alone."""
    last = None
    for row in rows:
        texts = {h: _short_number(v, 3) for h, v in row.items()}
        if row["time [ms]"] is None:
            texts["time [ms]"] = _below(row["spread [ms]"])
        if row["effect"] == last:
            texts |= dict.fromkeys(("effect", "time [ms]", "spread [ms]"), "")
        last = row["effect"]
        yield texts


def _budget_rows(effect_budget: EffectBudget) -> Iterator[dict[str, Any]]:
    """Yield a row for each effect and output; without a time where it does not stand out of its spread."""
    for worth in effect_budget.worths:
        time = {
            "effect": worth.effect,
            "time [ms]": _cost(worth),
            "spread [ms]": None if worth.needed else 1e3 * worth.spread,
        }
        if worth.needed or not worth.changes:
            why = worth.needed or "nothing shown without it"
            yield {
                **time,
                "output": why,
                "largest": "",
                "rms": "",
                "unit": "",
                "largest [%]": "",
                "rms [%]": "",
            }
        for change in worth.changes:
            yield {
                **time,
                "output": change.output,
                "largest": change.largest,
                "rms": change.rms,
                "unit": change.unit,
                "largest [%]": 100 * change.largest_part,
                "rms [%]": 100 * change.rms_part,
            }


def _cost(worth: EffectInfluence) -> float | None:
    """Return the milliseconds of an effect; None where they do not stand out of their spread."""
    return 1e3 * worth.seconds if worth.is_timed else None


def _below(spread: float | None) -> str:
    return "" if spread is None else f"< {_rounded(spread)}"


def _write_budget_plot(effect_budget: EffectBudget, title: str, stem: Path) -> None:
    """Write a chart with a bar for each effect: its influence at most, and its cost."""
    from coursework.figures.charts import bars
    from coursework.system.writing import write_whole

    rows = []
    for worth in effect_budget.worths:
        most = worth.most
        part = 100 * most.largest_part if most else 0.0
        prefix = f"{most.output}, " if most and part else ""
        cost = _cost(worth)
        time = _rounded(cost) if cost is not None else "–" if worth.needed else _below(1e3 * worth.spread)
        rows.append((worth.effect, part, f"{_rounded(part)} % ({prefix}{time} ms)"))
    plot = bars(rows, title, localised(Message("largest change without the effect, % of the output")))
    write_whole(stem.parent / f"{stem.name}.svg", plot.encode())


def _rounded(value: float) -> str:
    """Two digits, or whole."""
    return f"{value:.0f}" if abs(value) >= 10 else f"{value:.2g}"


def _write_rows(rows: Sequence[dict[str, Any]], stem: Path, decimal: str) -> None:
    """Write a table as ``STEM.csv``."""
    from coursework.system.tables import SPREADSHEETS, csv_file
    from coursework.system.writing import write_whole

    write_whole(stem.parent / f"{stem.name}.csv", csv_file(rows, list(rows[0]), SPREADSHEETS[decimal]))


def _write_plot(table: SceneTable, title: str, stem: Path) -> None:
    """Write the curves of a scene as ``STEM.svg``."""
    import numpy as np

    from coursework.figures.plot import Axis, Plot
    from coursework.language.numbers import unit_text
    from coursework.system.writing import write_whole

    axes = [
        Axis(r"\text{" + name.replace("_", r"\_") + "}", unit_text(table.units[name], "en"), values)
        for name, values in table.columns.items()
        if name != "dead_centre" and np.isfinite(values).any()
    ]
    plot = Plot(axes[0], axes[1:], title=title)
    write_whole(stem.parent / f"{stem.name}.svg", plot.svg().encode())


def _short_number(value: Any, digits: int = 5) -> str:
    from coursework.language.numbers import significant

    if isinstance(value, float):
        return "" if value != value else significant(value, digits)
    return "" if value is None else str(value)


def _drive(exercise: Any, text: str) -> Motor:
    """Return the torque of ``--drive torque=5``, in N*m, by that name or by the exercise's own."""
    from coursework.parsing.numbers import read_number
    from coursework.scenes.added import Motor

    name, equals, value = text.partition("=")
    effort = exercise.spec.driver.effort if exercise.spec.driver else ""
    if not equals or name.strip() not in ("torque", effort):
        raise WrongValue(
            "--drive takes {effort}=VALUE; found {found!r}", effort=effort or "torque", found=text
        )
    reading = read_number(value.strip(), "N*m")
    if reading.status != "read" or len(reading.values) != 1:
        raise WrongValue("the torque of --drive is a number in N*m; found {found!r}", found=value)
    return Motor(reading.values[0])


# ---------------------------------------------------------------------- animate


@click.command()
@exercise_argument
@seed_option
@click.option(
    "--effects",
    default="",
    metavar="E,E",
    help=("Effects to draw: position (paths), velocity, acceleration, coriolis; by default paths only."),
)
@click.option(
    "--figure-alone",
    is_flag=True,
    help="Draw no paths, vectors and values: they tell answers of the exercise.",
)
@lang_option
@click.option("--out", type=FOLDER, default=".", help="Folder to write.")
@click.pass_context
def animate(
    context: click.Context, exercise: str, seed: int, effects: str, figure_alone: bool, lang: str, out: Path
) -> None:
    """Draw a moving mechanism over the cycle of its driver, or over the turns of its film.

    Writes an animated picture (SVG) and a page (HTML) on which the crank is dragged.
    """
    from coursework.system.writing import write_whole

    animation = opened(context)[exercise].variant(seed, lang).animation(split_list(effects))
    writes(context, out)
    pages = {
        "svg": animation.svg(() if figure_alone else None),
        "html": animation.html(is_answered=not figure_alone),
    }
    for ending, text in pages.items():
        write_whole(out / f"{exercise}.{ending}", text.encode("utf-8"))
        click.echo(f"{out / exercise}.{ending}")
