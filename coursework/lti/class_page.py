"""Instructor's page of a link: the papers issued, the answers submitted, and the state of each score."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from coursework.issuing.assignment import Assignment
from coursework.issuing.issued import COLUMNS, ISSUED_FORMAT
from coursework.issuing.students import folded
from coursework.language.numbers import localise, plain
from coursework.language.words import words
from coursework.lti.class_list import students
from coursework.lti.host import LTIRequest
from coursework.lti.link_settings import BEST, LinkSettings
from coursework.lti.services import Member
from coursework.lti.storage import LTIAttempt, LTIPaper, Waiting
from coursework.system.tables import csv_file


class ClassListRow(NamedTuple):
    """Row of the class: a student, or a former student."""

    name: str
    variants: str
    tries: str
    points: str
    gradebook: str
    outside: bool = False


def settings_rows(
    visit: LTIRequest, wanted: LinkSettings, title: str, versions: int | None
) -> list[tuple[str, str]]:
    """Return the settings of the link, each with its label."""
    texts = words(visit.lang)["lti"]["class"]
    variant_setting = (
        texts["own"]
        if versions is None
        else texts["same"]
        if versions == 1
        else texts["versions"].format(versions)
    )
    return [
        (texts["opens"], title),
        (texts["variants"], variant_setting),
        (texts["tries"], texts["any_number"] if wanted.tries is None else str(wanted.tries)),
        (texts["counts"], texts["best" if wanted.counts == BEST else "last"]),
        (texts["answers"], texts["after" if wanted.shows_answers else "never"]),
        (texts["sends"], texts["yes" if visit.launch.line or visit.launch.lines else "no"]),
    ]


def class_rows(
    papers: Sequence[LTIPaper], tries: Sequence[LTIAttempt], counted: Mapping[str, LTIAttempt | None], scores: Mapping[str, Waiting],
    members: Sequence[Member] | None, lang: str,
) -> list[ClassListRow]:  # fmt: skip
    """Return one row per student of the roster or of the opened link, sorted by name."""
    done = Counter(member.person for member in tries)
    paper_of = {paper.person: paper for paper in papers}
    there = {member.person: member for member in students(members or ())}
    names = {
        **{person: paper.name for person, paper in paper_of.items()},
        **{p: m.name or p for p, m in there.items()},
    }
    rows = []
    for person in sorted(names, key=lambda member: (folded(names[member]), member)):
        paper, best = paper_of.get(person), counted.get(person)
        rows.append(
            ClassListRow(
                names[person],
                ", ".join(f"{r['exercise']} {r['seed']}" for r in paper.records) if paper else "",
                str(done[person] or ""),
                f"{_text(best.points, lang)} / {_text(best.out_of, lang)}" if best else "",
                _score_state(best, scores.get(person), lang),
                members is not None and person not in there,
            )
        )
    return rows


def _text(number: float, lang: str) -> str:
    return localise(plain(round(number, 3)), lang)


def _score_state(best: LTIAttempt | None, waiting: Waiting | None, lang: str) -> str:
    texts = words(lang)["lti"]["class"]
    if best is None or waiting is None:
        return ""
    if waiting.due is None:
        return str(texts["waits_person"] if best.waits else texts["arrived"])
    return str(texts["waits_because"].format(waiting.problem) if waiting.problem else texts["on_its_way"])


# ------------------------------------------------------------------------ files


def file_names(papers: Sequence[LTIPaper]) -> dict[str, str]:
    """Return the name of each person in files; two people of one name are distinguished by their identifiers."""
    alike = Counter(folded(paper.name) for paper in papers)
    return {p.person: p.name if alike[folded(p.name)] == 1 else f"{p.name} ({p.person})" for p in papers}


def taken_csv(papers: Sequence[LTIPaper], counted: Mapping[str, LTIAttempt | None]) -> bytes:
    """Return the answers that count as CSV, in the format that ``coursework grade`` reads."""
    return csv_file(_answer_rows(papers, counted), COLUMNS)


def _answer_rows(
    papers: Sequence[LTIPaper], counted: Mapping[str, LTIAttempt | None]
) -> Iterator[dict[str, Any]]:
    names = file_names(papers)
    for paper in papers:
        attempt = counted.get(paper.person)
        for record, texts in zip(paper.records, attempt.answers if attempt else (), strict=False):
            for part, text in texts.items():
                yield dict(
                    zip(
                        COLUMNS,
                        (names[paper.person], record["exercise"], record["seed"], part, text),
                        strict=True,
                    )
                )


def issued_json(papers: Sequence[LTIPaper], assignment: Assignment | None) -> dict[str, Any]:
    """Return the records issued to each person, in the format that ``coursework grade --issued`` reads."""
    names = file_names(papers)
    stated = {} if assignment is None else {"assignment": assignment.stated()}
    items: Iterable[dict[str, Any]] = (
        {"student": names[paper.person], "record": record} for paper in papers for record in paper.records
    )
    return {"format": ISSUED_FORMAT, "roster": True, **stated, "issued": list(items)}
