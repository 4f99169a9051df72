"""Commands that move a mechanism: simulate, animate."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from coursework.cli.options import (
    Whole,
    decimal_option,
    exercise_argument,
    json_option,
    lang_option,
    opened,
    seed_option,
    settings_given,
    split_list,
    tell_lack_of_charts,
)
from coursework.cli.printing import print_json, print_table
from coursework.errors import WrongValue

# --------------------------------------------------------------------- simulate


@click.command()
@exercise_argument
@click.option(
    "--effects", default="", metavar="E,E", help="What the scene calls for; positions alone unless told."
)
@click.option("--set", "settings", multiple=True, metavar="NAME=VALUE", help="A given value: r1=228.6mm.")
@seed_option
@click.option(
    "--over", type=click.Choice(["cycle"]), default="cycle", show_default=True, help="One turn of the driver."
)
@click.option("--steps", type=Whole(1), default=360, show_default=True, help="Steps of a cycle.")
@click.option(
    "--drive", metavar="torque=VALUE", help="Integrate the motion under this constant torque instead."
)
@click.option("--duration", type=float, default=1.0, show_default=True, help="Seconds of a motion in time.")
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), help="Folder for table and plot.")
@decimal_option
@json_option
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
    decimal: str,
    as_json: bool,
) -> None:
    """Move a mechanism over a cycle or in time, with only the effects named.

    Values that are not set are those of the variant of --seed.
    """
    from coursework.motion.scenes import Scene

    one = opened(context)[exercise]
    scene = Scene(one, {**one.variant(seed).used, **settings_given(settings)}, split_list(effects))
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
        _write_scene(table, stem, decimal)
        if not (bare := tell_lack_of_charts()):
            _write_plot(table, exercise, stem)
        if not as_json:
            click.echo(f"table: {stem}.csv" if bare else f"table and plot: {stem}.csv, .svg")
    elif not as_json:
        shown_rows = rows[:: max(1, len(rows) // 12)]
        print_table([{h: _short_number(v) for h, v in row.items()} for row in shown_rows])


def _write_scene(table: Any, stem: Path, decimal: str) -> None:
    """The table of a scene as ``STEM.csv``."""
    from coursework.system.tables import SPREADSHEETS, csv_file
    from coursework.system.writing import write_whole

    rows = table.rows()
    write_whole(stem.parent / f"{stem.name}.csv", csv_file(rows, list(rows[0]), SPREADSHEETS[decimal]))


def _write_plot(table: Any, title: str, stem: Path) -> None:
    """The curves of a scene as ``STEM.svg``."""
    from coursework.figures.charts import curves
    from coursework.system.writing import write_whole

    first, *others = table.columns
    shown = {n: table.columns[n] for n in others if n != "dead_centre"}
    plot = curves((f"{first} [{table.units[first]}]", table.columns[first]), shown, table.units, title)
    write_whole(stem.parent / f"{stem.name}.svg", plot)


def _short_number(value: Any) -> str:
    from coursework.language.numbers import significant

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


@click.command()
@exercise_argument
@seed_option
@click.option(
    "--effects",
    default="",
    metavar="E,E",
    help="What is seen: position (paths), velocity, acceleration, coriolis; paths alone unless told.",
)
@lang_option
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), default=".", help="Folder to write.")
@click.pass_context
def animate(context: click.Context, exercise: str, seed: int, effects: str, lang: str, out: Path) -> None:
    """Show a mechanism in motion: over the cycle of its driver, or over the turns of its film.

    Writes a moving picture (SVG) and a page with a slider (HTML).
    """
    from coursework.system.writing import write_whole

    animation = opened(context)[exercise].variant(seed, lang).animation(split_list(effects))
    pages = {"svg": animation.svg(), "html": animation.html()}
    for ending, text in pages.items():
        write_whole(out / f"{exercise}.{ending}", text.encode("utf-8"))
        click.echo(f"{out / exercise}.{ending}")
