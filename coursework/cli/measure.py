"""The command that measures accuracy against time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click

from coursework.cli.options import exercises_argument, json_option, lang_option, opened, tell_lack_of_charts
from coursework.cli.printing import print_json

# --------------------------------------------------------------------- accuracy


@click.command()
@exercises_argument
@click.option("--quick", is_flag=True, help="Fewer places and shorter timings: under half a minute.")
@lang_option
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    help="Folder for the page (HTML, PDF) and JSON.",
)
@json_option
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
    from coursework.rendering.renderer import renderer_of
    from coursework.system.writing import write_whole

    course = opened(context)
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
        write_whole(out / "accuracy.html", renderer_of(course.folder).report_html(page).encode("utf-8"))
        write_whole(out / "accuracy.pdf", renderer_of(course.folder).report_pdf(page))
        tell_lack_of_charts()
        if not as_json:
            click.echo(f"page and rows: {out / 'accuracy'}.html, .pdf, .json")
