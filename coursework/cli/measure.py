"""The command that measures accuracy against time."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from coursework.cli.options import FOLDER, exercises_argument, json_option, lang_option, opened, writes
from coursework.cli.printing import print_json, say
from coursework.errors import counted
from coursework.messages import Message, localised

if TYPE_CHECKING:
    from coursework.sheets.report import ReportContent

# --------------------------------------------------------------------- accuracy


@click.command()
@exercises_argument
@click.option("--quick", is_flag=True, help="Take fewer places and shorter timings: about a minute.")
@click.option(
    "--paper", is_flag=True, help="Measure the accuracy of students on paper: digits kept, and the margin."
)
@lang_option
@click.option("--out", type=FOLDER, help="Folder for the page (HTML, PDF) and the JSON.")
@json_option
@click.pass_context
def accuracy(
    context: click.Context,
    exercises: Sequence[str],
    quick: bool,
    paper: bool,
    lang: str,
    out: Path | None,
    as_json: bool,
) -> None:
    """Measure the cost of accuracy in time on this machine.

    Without names: one row for each exercise with numerical answers, with the digits kept in ordinary and in
    the hardest places and the time for each configuration, beside the textbook formula. With names: every
    method of these exercises, with its time and its largest error against fifty digits.
    """
    if not paper:
        from coursework.accuracy.measuring import needs_mpmath

        needs_mpmath()
    course = opened(context)
    if out is not None:
        writes(context, out)
    if paper:
        rows, page = _on_paper(course, exercises or course.names, quick, lang, as_json)
    elif exercises:
        rows, page = _in_detail(course, exercises, quick, lang, as_json)
    else:
        rows, page = _overview(course, quick, lang, as_json)
    if as_json:
        print_json(rows)
    if out is not None:
        _write(course, rows, page(), out)
        if not as_json:
            say("page and rows: {stem}.html, .pdf, .json", stem=out / "accuracy")


def _in_detail(course: Any, names: Sequence[str], quick: bool, lang: str, silent: bool) -> tuple[list, Any]:
    """Every way to compute each of the named exercises."""
    from coursework.accuracy.measuring import DATA, measure, subject_of
    from coursework.accuracy.page import report

    for name in names:
        subject_of(course[name])  # what cannot be measured is refused before anything is
    rows = []
    for name in names:
        for row in measure(course[name], quick=quick):
            rows.append(row)
            if not silent and row.family != DATA:
                error = Message("no answer") if row.max_error is None else f"{row.max_error:.1e}"
                failed = Message("  no answer at {failed} of {all}", failed=row.failed, all=row.n)
                click.echo(
                    f"{row.exercise:22} {row.what:12} {row.method:20} {row.place:16} {row.median:14,.0f} ns "
                    f"({row.low:,.0f} … {row.high:,.0f})  {localised(error)}"
                    + (localised(failed) if row.failed and row.max_error is not None else "")
                )
    return [row.as_json() for row in rows], lambda: report(course, rows, lang)


def _overview(course: Any, quick: bool, lang: str, silent: bool) -> tuple[list, Any]:
    """Return a line for each exercise of the course."""
    from coursework.accuracy.overview import overview
    from coursework.accuracy.pages import overview_report

    lines, without = [], []
    for name in course.names:
        line = overview(course[name], quick=quick)
        if line is None:
            without.append(name)
            continue
        lines.append(line)
        if not silent:
            click.echo(overview_text(line))
    if not silent and without:
        say("no numbers to lose digits: {names}", names=", ".join(without))
    return [line.as_json() for line in lines], lambda: overview_report(course, lines, without, lang)


def overview_text(line: Any) -> str:
    """Return the line of an exercise: its errors, their cost, and the quantities that lose digits."""
    if line.wrong:
        return f"{line.exercise:28} {line.wrong}"

    if not line.quantities:
        lacking = Message(
            "no reference: the formula of {names} cannot be evaluated with many digits",
            names=", ".join(line.lacking),
        )
        return f"{line.exercise:28} {localised(lacking)}"

    def error(value: float | None) -> str:
        return "      –" if value is None else f"{value:7.1e}"

    times = Message(
        "{stable} ns, textbook {textbook} ns",
        stable=f"{1e9 * line.stable_ns.median:8,.0f}",
        textbook=f"{1e9 * line.textbook_ns.median:8,.0f}",
    )
    digits = Message("all that the data allow")
    if line.beyond > 1:
        lost = ", ".join(f"{name} × {times:.0e}" for name, times in line.losing.items())
        asked = "" if line.asked_losing else Message("; the asked answers keep all that the data allow")
        digits = Message("beyond what the data explain: {lost}{asked}", lost=lost, asked=asked)
    hard = Message(
        "hard {error} (textbook {textbook}), {digits}",
        error=error(line.hard),
        textbook=error(line.hard_textbook),
        digits=digits,
    )
    generic = Message(
        "generic {error} (textbook {textbook})",
        error=error(line.generic),
        textbook=error(line.generic_textbook),
    )
    hard = hard if line.places else Message("no hard place")
    return f"{line.exercise:28} {localised(generic)}  {localised(times)}  {localised(hard)}"


def _on_paper(course: Any, names: Sequence[str], quick: bool, lang: str, silent: bool) -> tuple[list, Any]:
    """Measure the effect of students' digits and of the course's margin on right and on wrong answers."""
    from coursework.accuracy.pages import paper_report
    from coursework.accuracy.paper import PLAIN, on_paper, total

    variants = 100 if quick else 500
    rows = [row for name in names for row in on_paper(course[name], variants)]
    if not silent:
        for row in total(rows):
            digits = Message("1 % alone") if row.digits == PLAIN else counted(row.digits, "digit")
            say(
                "{digits} right answers marked wrong: by 1 % {plain}, by our margin {ours};  accepted: "
                "mistakes {mistakes}, "
                "neighbours {neighbours}",
                digits=f"{localised(digits):11}",
                plain=f"{row.wronged.value:8.3%}",
                ours=f"{row.wronged_ours.value:8.3%}",
                mistakes=f"{row.mistakes.value:8.3%}",
                neighbours=f"{row.neighbours.value:8.3%}",
            )
    return [row.as_json() for row in rows], lambda: paper_report(course, rows, variants, lang)


def _write(course: Any, rows: list, page: ReportContent, out: Path) -> None:
    from coursework.rendering.renderer import renderer_of
    from coursework.system.writing import write_whole

    write_whole(out / "accuracy.json", (json.dumps(rows, indent=1) + "\n").encode())
    write_whole(out / "accuracy.html", renderer_of(course.folder).report_html(page).encode("utf-8"))
    write_whole(out / "accuracy.pdf", renderer_of(course.folder).report_pdf(page))
