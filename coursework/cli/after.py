"""Command of the evening after an exam: after."""

from __future__ import annotations

import getpass
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from datetime import date
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from coursework.cli.options import (
    DONE,
    EXISTING_FILE,
    FILE,
    FOLDER,
    FOUND,
    DecimalNumber,
    WholeNumber,
    assignment_option,
    db_option,
    json_option,
    opened,
    writes,
)
from coursework.cli.printing import print_json, print_table, progress_bar, say, warn
from coursework.course.marking_rules import DIGITS_KEPT
from coursework.errors import BadInput, counted, first_few
from coursework.language.words import words
from coursework.messages import Message, language_of_messages, localised
from coursework.system.visible import one_line

if TYPE_CHECKING:
    from coursework.course.course import Course
    from coursework.gradebook.after import Exam, Preview
    from coursework.gradebook.decision import Decision
    from coursework.issuing.assignment import Assignment

_named = partial(first_few, most=12, with_count=True)  #: students on a line
_CHANGES = 200  #: changed marks in a table
_REASONS = 5  #: of rejected rows, the most frequent
_PLACE = re.compile(r"(?P<place>[^=]*)=(?P<value>.+)", re.DOTALL)

Confirm = Callable[[Sequence["Decision"], bool], None]


def _several(name: str, metavar: str, **more: Any) -> Callable[[Any], Any]:
    return click.option(name, multiple=True, metavar=metavar, **more)


@click.command()
@click.argument("file", type=EXISTING_FILE, metavar="FILE.toml")
@click.option(
    "--issued",
    type=FILE,
    help="The issued.json of the build; by default in the folder that FILE names, or that is named like it.",
)
@click.option(
    "--marks", type=FOLDER, help="Folder of marks that grade wrote; by default marks/ beside issued.json."
)
@click.option("--read", type=FOLDER, help="Folder that scan wrote; by default read/ beside issued.json.")
@db_option
@assignment_option
@_several(
    "--weight",
    "QUESTIONS=POINTS",
    help="Give a question, such as 2.3, other points; or all of an exercise, such as 2, or of a kind, such "
    "as angle.",
)
@_several("--neutralise", "QUESTIONS", help="Let questions count for nobody.")
@_several("--spare", "QUESTIONS", help="Let questions count only for those whose mark they do not lower.")
@_several("--bonus", "QUESTIONS", help="Add the points of questions without counting them in the total.")
@_several("--accept", "QUESTION=ANSWER", help="Accept an answer, whoever wrote it.")
@_several(
    "--refuse",
    "QUESTIONS[=ANSWER]",
    help="Give no points to an answer that waits, whoever wrote it; without ANSWER to all that wait in the "
    "questions.",
)
@_several("--tolerance", "QUESTIONS=FACTOR", help="Widen the accepted margin of questions: 2 doubles it.")
@click.option(
    "--digits",
    type=WholeNumber(*DIGITS_KEPT),
    help="Make all margins as wide as so many digits kept on the way cost.",
)
@_several(
    "--price",
    "[QUESTIONS/]VERDICT=SHARE",
    help="Change the share of the points that a verdict leaves: slip:sign=0.75.",
)
@click.option("--full", type=DecimalNumber(), metavar="POINTS", help="Points that are worth the best mark.")
@click.option("--curve", metavar="POINTS:MARK…", help='Scale by points: "0:0 16:10 32:20".')
@click.option("--step", "rounding", type=DecimalNumber(), help="Step to which marks are rounded.")
@click.option(
    "--restated",
    is_flag=True,
    help="Apply the weights, prices and digits that FILE states now, changed after issuing.",
)
@click.option(
    "--put-away", is_flag=True, help="Put away the waiting answers that say nothing, without points."
)
@click.option("--cards", is_flag=True, help="List the answers that wait, question by question.")
@click.option(
    "--undo",
    is_flag=False,
    flag_value="last",
    metavar="[ID…]",
    help="Take decisions back, by the ids that stand before them, or the last; with --put-away what was put "
    "away.",
)
@click.option(
    "--undo-since",
    metavar="DAY|all",
    help="Take back all of these decisions from a day on, such as 2026-01-31, or all there are.",
)
@click.option("--why", default="", help="Reason, kept with the decision.")
@click.option("--by", default="", help="Who decides; by default the account that runs the command.")
@click.option("--yes", is_flag=True, help="Confirm what is previewed.")
@click.option("--feedback", is_flag=True, help="Write the feedback sheets again, which takes a while.")
@json_option
@click.pass_context
def after(
    context: click.Context,
    /,
    file: Path,
    issued: Path | None,
    marks: Path | None,
    read: Path | None,
    db: str | None,
    assignment: str,
    undo: str | None,
    undo_since: str | None,
    put_away: bool,
    cards: bool,
    restated: bool,
    why: str,
    by: str,
    yes: bool,
    feedback: bool,
    as_json: bool,
    **asked: Any,
) -> int:
    """Show what is left before the marks of an exam may go out, and change what its questions count.

    Without a change it lists the waiting answers, patterns that a person should look at, and every question
    with a proposal. A change is previewed: who goes from which mark to which. --yes confirms it: it is a
    dated line of decisions.csv, or of the database, that every later grade applies, and --undo or
    --undo-since takes it back, whatever was decided since.
    """
    from coursework.gradebook.after import restated as restated_of
    from coursework.gradebook.after import undoing
    from coursework.issuing.assignment import read_assignment

    course = opened(context)
    stated = read_assignment(file, course)
    incomplete: Sequence[str] = ()
    if db is not None:
        exam, confirm = _stored(context, course, db, assignment or stated.name)
    else:
        issued = issued or _issued_of(file, stated)
        exam, confirm = _in_folder(context, course, issued, marks)
        incomplete = _incomplete_papers(read or issued.parent / "read")
    by = by or getpass.getuser()
    changed = restated_of(stated, exam)
    steps = [step._replace(reason=why, by=by) for step in _steps(exam, asked)]
    if restated:
        texts = words(language_of_messages())["after"]
        steps += [step._replace(reason=why or texts["file_why"], by=by) for step in changed.steps]
    if put_away and undo is None:
        steps += exam.put_away(by, why or words(language_of_messages())["after"]["put_away_why"])
    undone = _undone(exam, undo, undo_since, put_away=put_away)
    steps += undoing(undone, by, why)
    if not steps and (put_away or asked["refuse"]):
        if as_json:
            print_json(_preview_json(exam.preview([])))
        else:
            say("no answer that waits says nothing" if put_away else "no answer waits in these questions")
        return DONE
    if not steps:
        if feedback:
            confirm([], True)
        if as_json:
            print_json(_as_json(exam) | {"incomplete_papers": list(incomplete)})
        elif cards:
            _tell_cards(exam)
        else:
            _tell(exam, incomplete, changed.steps, changed.notes)
        return FOUND if exam.cards or exam.rejected or incomplete or changed.steps else DONE
    preview = exam.preview(steps)
    if yes:  # before a line is printed, since the reader of a pipe may close it
        confirm(steps, feedback)
    if as_json:
        print_json(_preview_json(preview))
        return DONE
    _tell_preview(exam, steps, preview, undone, is_kept=yes)
    if not yes and sys.stdin.isatty() and click.confirm(localised(Message("Confirm?"))):
        confirm(steps, feedback)
        yes = True
    if yes:
        message = "{decisions} taken back" if undone else "{decisions} kept; --undo takes the last one back"
        say(message, decisions=counted(len({one.withdraws or one.id for one in steps}), "decision"))
    else:
        say("nothing is written: --yes confirms it")
    return DONE


# ------------------------------------------------------------------------ where


def _issued_of(file: Path, stated: Assignment) -> Path:
    """Return the ``issued.json`` of the file of an assignment."""
    out = stated.options.get("out")
    places = [file.parent / str(out)] if out else [file.with_suffix(""), Path(file.stem)]
    found = [place / "issued.json" for place in places if (place / "issued.json").is_file()]
    if not found:
        raise BadInput(
            "no issued.json in {places}: name that of the build, --issued",
            places=", ".join(map(str, dict.fromkeys(places))),
        )
    return found[0]


def _incomplete_papers(read: Path) -> Sequence[str]:
    """Return the students of papers that lack a page in the folder of a scan; nobody if there is none."""
    if not read.is_dir():
        return ()
    from coursework.scanning.scan import incomplete_papers

    return incomplete_papers(read)


def _in_folder(
    context: click.Context,
    course: Course,
    issued: Path,
    marks: Path | None,
) -> tuple[Exam, Confirm]:
    """Return the exam in a folder of marks, and what keeps decisions on it."""
    from coursework.gradebook.after_files import MarkedFolder

    folder = MarkedFolder(course, issued, marks or issued.parent / "marks")

    def confirm(steps: Sequence[Decision], feedback: bool) -> None:
        writes(context, folder.folder)
        with progress_bar("writing", None) as advance:
            book = folder.write(steps, feedback=feedback, progress=advance)
        for warning in book.warnings:
            warn("note: {note}", note=one_line(localised(warning)))
        if not feedback and (folder.folder / "feedback").is_dir():
            warn("the feedback sheets are those of before: --feedback writes them again, once at the end")

    return folder.exam, confirm


def _stored(context: click.Context, course: Course, url: str, name: str) -> tuple[Exam, Confirm]:
    """Return the exam in a database, and what keeps decisions on it."""
    from coursework.cli.database import store_at

    store = store_at(context, url)
    from coursework.database.after import stored_exam
    from coursework.database.assignments import assignment_called
    from coursework.database.decisions import decide

    with store.reading() as connection:
        number = assignment_called(connection, name)

    def confirm(steps: Sequence[Decision], feedback: bool) -> None:
        with store.begin() as connection:
            decide(connection, number, steps)

    return stored_exam(course, store, number), confirm


# ------------------------------------------------------------------------ steps


def _steps(exam: Exam, asked: Mapping[str, Any]) -> Iterator[Decision]:
    """Yield the steps that the options ask for; what is asked of several questions at once is one batch."""
    from coursework.gradebook import adjustments as kinds
    from coursework.gradebook.after import steps_on
    from coursework.gradebook.decisions import ACCEPTED, GIVEN

    lang = language_of_messages()

    def on(kind: str, place: str, points: float | None = None, answer: str | None = None) -> list[Decision]:
        return steps_on(exam, kind, place, points, answer, lang=lang)

    for option, kind in (("weight", kinds.WEIGHT), ("tolerance", kinds.TOLERANCE)):
        for text in asked[option]:
            place, value = _split(option, text)
            yield from on(kind, place, _value(option, value))
    for option, kind in (("neutralise", kinds.NEUTRAL), ("spare", kinds.SPARED), ("bonus", kinds.BONUS)):
        for place in asked[option]:
            yield from on(kind, place)
    for option, kind, points in (("accept", ACCEPTED, None), ("refuse", GIVEN, 0.0)):
        for text in asked[option]:
            if kind == GIVEN and "=" not in text:
                yield from exam.refusals(exam.called(text, lang))
                continue
            place, answer = _split(option, text)
            yield from on(kind, place, points, answer)
    for text in asked["price"]:
        verdict, value = _split("price", text)
        place, _, verdict = verdict.rpartition("/")
        yield from on(kinds.PRICE, place, _value("price", value), verdict)
    for option, kind in (("digits", kinds.DIGITS), ("full", kinds.FULL), ("rounding", kinds.STEP)):
        if asked[option] is not None:
            yield from on(kind, "", asked[option])
    if asked["curve"]:
        yield from on(kinds.CURVE, "", answer=asked["curve"])


def _undone(exam: Exam, undo: str | None, since: str | None, *, put_away: bool) -> Sequence[Decision]:
    """Return the standing decisions that the options take back, in their order."""
    from coursework.gradebook.after import steps_since

    if undo is None and (since is None or put_away):
        return ()
    if put_away:
        return exam.put_aside
    standing: Sequence[Decision] = exam.decisions.standing_steps
    if since is None and undo != "last":
        return exam.undoable((undo or "").replace(",", " ").split())
    if since is None:
        standing = [one for one in standing if one.id == standing[-1].id]
    elif since != "all":
        try:
            standing = steps_since(standing, date.fromisoformat(since))
        except ValueError:
            raise BadInput(
                "--undo-since takes a day such as 2026-01-31, or all; found {found!r}", found=since[:40]
            ) from None
    if not standing:
        raise BadInput("nothing is decided that could be undone")
    return standing


def _split(option: str, text: str) -> tuple[str, str]:
    match = _PLACE.fullmatch(text)
    if match is None:
        raise BadInput(
            "--{option} takes a place and a value with = between; found {found!r}", option=option, found=text
        )
    return match["place"].strip(), match["value"].strip()


def _value(option: str, text: str) -> float:
    from coursework.language.numbers import typed_number

    value = typed_number(text)
    if value != value:
        raise BadInput("--{option} takes a number; found {found!r}", option=option, found=text[:40])
    return value


# ------------------------------------------------------------------------ lines


def _print(text: str) -> None:
    """Print a line in the typography of the language of messages."""
    from coursework.language.typography import typeset

    click.echo(typeset(text, language_of_messages()))


def _tell(
    exam: Exam, incomplete: Sequence[str], restated: Sequence[Decision], notes: Sequence[Message]
) -> None:
    """Print what is left, the questions, and the steps."""
    from coursework.gradebook import after_words as said

    lang = language_of_messages()
    texts, colon = words(lang)["after"], words(lang)["sheet"]["colon"]
    now = exam.distribution()
    present, names = len(now.marks), exam.issued.students or tuple(now.marks)
    _print(texts["handed_in"].format(len(names), present, len(exam.provisional)))
    if any(exam.missing):
        _print(texts["missing"].format(*exam.missing))
    _print(texts["marks"].format(said.number(now.mean, lang), said.number(now.of, lang), now.passed, present))
    counts = zip(said.bins(now, lang), now.counts, strict=True)
    print_table([{texts["mark"]: name, texts["students"]: count} for name, count in counts])
    _print(f"\n{texts['left']}")
    for why, (cards, answers) in exam.cards.items():
        _print("  " + texts["cards"].format(texts["cards_by"][why], cards, answers))
    if exam.cards:
        _print(f"  {texts['list_them']}{colon} --cards")
    if exam.non_answers:
        _print("  " + texts["silent"].format(len(exam.non_answers)) + " --put-away")
    if exam.rejected:
        _print("  " + texts["rejected"].format(len(exam.rejected)))
        reasons = Counter(localised(row.reason) for row in exam.rejected)
        for reason, count in reasons.most_common(_REASONS):
            _print("    " + one_line(texts["rejected_why"].format(reason, count)))
    if incomplete:
        _print(f"  {texts['incomplete'].format(len(incomplete))}{colon} {_named(list(incomplete))}")
    if not exam.cards and not exam.rejected and not incomplete:
        _print("  " + texts["nothing_left"])
    if exam.provisional:
        _print(f"  {texts['provisional']}{colon} {_named(list(exam.provisional))}")
    if exam.patterns:
        _print(f"\n{texts['seen']}")
    for pattern in exam.patterns:
        shown = [f"{student} ({place})" if place else student for student, place in pattern.sheets]
        _print(f"  {texts['patterns'][pattern.kind]}{colon} {one_line(_named(shown))}")
    _print("")
    print_table([_question_row(question, texts, lang) for question in exam.table], texts["table"])
    if restated or notes:
        _print(f"\n{texts['file_says']}")
    for _, text in said.batch_texts(exam, restated, lang):
        _print(f"  {text}")
    for note in notes:
        _print(f"  {localised(note)}")
    if restated:
        _print(f"  {texts['apply_file']}{colon} --restated")
    _print(f"\n{texts['steps']}")
    lines = step_lines(exam, (*exam.decisions.standing_steps, *exam.put_aside), lang)
    for line in lines or [texts["no_steps"]]:
        _print(f"  {line}")


def _tell_cards(exam: Exam) -> None:
    """Print the groups of equal answers that wait."""
    texts = words(language_of_messages())["after"]
    print_table(
        [
            {
                texts["number"]: exam.questions.label(group.exercise, group.part),
                texts["look"]: texts["cards_by"][group.why],
                texts["answer"]: one_line(members[0].mark.answer)[:60],
                texts["answers"]: len(members),
                texts["students"]: one_line(first_few([one.student for one in members], 3)),
            }
            for group, members in exam.open
        ]
    )


def step_lines(exam: Exam, steps: Iterable[Decision], lang: str) -> list[str]:
    """Return a line on the steps of each batch: its id, the day, who, what, and why."""
    from coursework.gradebook import after_words as said

    lines = []
    for step, text in said.batch_texts(exam, steps, lang):
        day = step.made.astimezone().date().isoformat() if step.made else "–"
        line = str(words(lang)["after"]["step_line"]).format(day, step.by, text)
        lines.append(one_line(f"{step.id}  {line} ({step.reason})" if step.reason else f"{step.id}  {line}"))
    return lines


def _question_row(question: Any, texts: Any, lang: str) -> dict[str, Any]:
    from coursework.gradebook import after_words as said
    from coursework.language.numbers import localise

    measured, flags = question.statistics, {"neutral": "--neutralise", "neutral_if_hurt": "--spare"}
    discrimination = measured and measured.discrimination
    proposal = ""
    if question.proposal is not None:
        answer = question.proposal.answer
        proposal = (
            f"--accept {question.number}={answer!r}"
            if answer
            else f"{flags[question.proposal.kind]} {question.number}"
        )
    return {
        texts["number"]: question.number,
        texts["question"]: question.part,
        texts["points"]: said.points_text(question, lang),
        texts["answers"]: str(measured.answers if measured else 0),
        texts["mean"]: f"{100 * measured.mean:.0f} %" if measured else "",
        texts["discrimination"]: "" if discrimination is None else localise(f"{discrimination:.2f}", lang),
        texts["counts"]: said.counting_text(question, lang),
        texts["look"]: texts["whys"][question.why] if question.why else "",
        texts["proposal"]: one_line(proposal),
    }


def _tell_preview(
    exam: Exam, steps: Sequence[Decision], preview: Preview, undone: Sequence[Decision], *, is_kept: bool
) -> None:
    """Print who goes from which mark to which, and the new mean and distribution."""
    from coursework.gradebook import after_words as said

    lang = language_of_messages()
    texts, colon = words(lang)["after"], words(lang)["sheet"]["colon"]
    made = steps[: len(steps) - len(undone)]
    _print(texts["changes" if is_kept else "preview"])
    for _, text in said.batch_texts(exam, (step for step in made if not step.student), lang):
        _print(one_line(text))
    for line in reversed(step_lines(exam, (step for step in undone if not step.student), lang)):
        _print(texts["to_undo"].format(line))
    for title, among in (("put_away", made), ("back", undone)):
        if own := [f"{exam.shown(one.student)} ({one.answer})" for one in among if one.student]:
            _print(one_line(f"{texts[title]}{colon} {_named(own)}"))
    changes = preview.changes
    print_table(
        [
            {
                texts["students"]: change.student,
                texts["before"]: said.number(change.before, lang),
                texts["now"]: said.number(change.now, lang),
            }
            for change in changes[:_CHANGES]
        ]
    )
    if not changes:
        _print(texts["nobody_moves"])
    rows = zip(said.bins(preview.now, lang), preview.before.counts, preview.now.counts, strict=True)
    print_table([{texts["mark"]: n, texts["before"]: b, texts["now"]: a} for n, b, a in rows])
    still = len(preview.now.marks) - len(changes)
    _print(texts["moves"].format(preview.rise, preview.fall, still))
    means = (said.number(one.mean, lang) for one in (preview.before, preview.now))
    _print(texts["means"].format(*means, said.number(preview.now.of, lang)))
    _print(texts["pass_line"].format(preview.before.passed, preview.now.passed))


def _as_json(exam: Exam) -> dict[str, Any]:
    now = exam.distribution()
    return {
        "cards": {why: list(counts) for why, counts in exam.cards.items()},
        "non_answers": len(exam.non_answers),
        "rejected": len(exam.rejected),
        "provisional": exam.provisional,
        "patterns": {pattern.kind: [list(sheet) for sheet in pattern.sheets] for pattern in exam.patterns},
        "questions": [
            {
                "number": q.number,
                "exercise": q.exercise,
                "part": q.part,
                "points": q.weight,
                "status": q.status,
                "tolerance": q.tolerance,
                "mean": q.statistics and round(q.statistics.mean, 4),
                "discrimination": q.statistics and q.statistics.discrimination,
                "why": q.why,
                "proposal": q.proposal and q.proposal.kind,
            }
            for q in exam.table
        ],
        "mean": round(now.mean, 4),
        "out_of": now.of,
        "distribution": now.counts,
    }


def _preview_json(preview: Preview) -> dict[str, Any]:
    return {
        "changes": [change._asdict() for change in preview.changes],
        "mean": [round(preview.before.mean, 4), round(preview.now.mean, 4)],
        "distribution": [preview.before.counts, preview.now.counts],
    }
