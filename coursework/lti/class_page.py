"""Instructor's page of a link: the papers issued, the answers submitted, and the state of each score."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from coursework.language.numbers import localise, plain
from coursework.language.words import words
from coursework.lti.class_list import students
from coursework.lti.host import Visit
from coursework.lti.services import Member
from coursework.lti.storage import Paper, Try, Waiting
from coursework.lti.wanted import BEST, Wanted
from coursework.making.assignment import Assignment
from coursework.making.issued import COLUMNS, ISSUED_FORMAT
from coursework.making.students import folded
from coursework.system.tables import csv_file


class Row(NamedTuple):
    """A student of the class, or one who was."""

    name: str
    variants: str
    tries: str
    points: str
    gradebook: str
    outside: bool = False


def settings_rows(visit: Visit, wanted: Wanted, title: str, versions: int | None) -> list[tuple[str, str]]:
    """Return the settings of the link, each with its label."""
    said = words(visit.lang)["lti"]["class"]
    dealt = (
        said["own"]
        if versions is None
        else said["same"]
        if versions == 1
        else said["versions"].format(versions)
    )
    return [
        (said["opens"], title),
        (said["variants"], dealt),
        (said["tries"], said["any_number"] if wanted.tries is None else str(wanted.tries)),
        (said["counts"], said["best" if wanted.counts == BEST else "last"]),
        (said["answers"], said["after" if wanted.shows_answers else "never"]),
        (said["sends"], said["yes" if visit.launch.line or visit.launch.lines else "no"]),
    ]


def class_rows(
    papers: Sequence[Paper], tries: Sequence[Try], counted: Mapping[str, Try | None], scores: Mapping[str, Waiting],
    members: Sequence[Member] | None, lang: str,
) -> list[Row]:  # fmt: skip
    """Return one row per student of the roster or of the opened link, sorted by name."""
    done = Counter(one.person for one in tries)
    own = {paper.person: paper for paper in papers}
    there = {one.person: one for one in students(members or ())}
    names = {
        **{person: paper.name for person, paper in own.items()},
        **{p: m.name or p for p, m in there.items()},
    }
    rows = []
    for person in sorted(names, key=lambda one: (folded(names[one]), one)):
        paper, best = own.get(person), counted.get(person)
        rows.append(
            Row(
                names[person],
                ", ".join(f"{r['exercise']} {r['seed']}" for r in paper.records) if paper else "",
                str(done[person] or ""),
                f"{_text(best.points, lang)} / {_text(best.out_of, lang)}" if best else "",
                _standing(best, scores.get(person), lang),
                members is not None and person not in there,
            )
        )
    return rows


def _text(number: float, lang: str) -> str:
    return localise(plain(round(number, 3)), lang)


def _standing(best: Try | None, waiting: Waiting | None, lang: str) -> str:
    said = words(lang)["lti"]["class"]
    if best is None or waiting is None:
        return ""
    if waiting.due is None:
        return str(said["waits_person"] if best.waits else said["arrived"])
    return str(said["waits_because"].format(waiting.said) if waiting.said else said["on_its_way"])


# ------------------------------------------------------------------------ files


def called(papers: Sequence[Paper]) -> dict[str, str]:
    """Return the name of each person in files; two people of one name are distinguished by their identifiers."""
    alike = Counter(folded(paper.name) for paper in papers)
    return {p.person: p.name if alike[folded(p.name)] == 1 else f"{p.name} ({p.person})" for p in papers}


def taken_csv(papers: Sequence[Paper], counted: Mapping[str, Try | None]) -> bytes:
    """Return the answers that count as CSV, in the format that ``coursework grade`` reads."""
    return csv_file(_answer_rows(papers, counted), COLUMNS)


def _answer_rows(papers: Sequence[Paper], counted: Mapping[str, Try | None]) -> Iterator[dict[str, Any]]:
    names = called(papers)
    for paper in papers:
        made = counted.get(paper.person)
        for record, texts in zip(paper.records, made.answers if made else (), strict=False):
            for part, text in texts.items():
                yield dict(
                    zip(
                        COLUMNS,
                        (names[paper.person], record["exercise"], record["seed"], part, text),
                        strict=True,
                    )
                )


def issued_json(papers: Sequence[Paper], assignment: Assignment | None) -> dict[str, Any]:
    """Return the records issued to each person, in the format that ``coursework grade --issued`` reads."""
    names = called(papers)
    stated = {} if assignment is None else {"assignment": assignment.stated()}
    items: Iterable[dict[str, Any]] = (
        {"student": names[paper.person], "record": record} for paper in papers for record in paper.records
    )
    return {"format": ISSUED_FORMAT, "roster": True, **stated, "issued": list(items)}
