"""Offers for the links of a platform: the published assignments of the site, and the exercises of its
course."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sqlalchemy import Connection, select

from coursework.course.course import Course
from coursework.database.assignments import issued_of
from coursework.database.tables import assignment
from coursework.issuing.assignment import text_in
from coursework.language.words import words
from coursework.platforms.lti.deep_linking import Offer, OfferGroup
from coursework.site.frame.settings import Site


def offer_groups(site: Site, lang: str) -> Sequence[OfferGroup]:
    """Return the published assignments, then the exercises by chapter."""
    with site.store.reading() as connection:
        offers = tuple(_assignment_offers(connection, lang))
    groups = [OfferGroup(words(lang, "site")["lti"]["shelf"], offers)] if offers else []
    return [*groups, *site.cache.get(("offers", lang), lambda: _exercise_offers(site.course, lang))]


def _assignment_offers(connection: Connection, lang: str) -> list[Offer]:
    columns = assignment.c.id, assignment.c.name, assignment.c.stated
    query = select(*columns).where(assignment.c.published.is_not(None), assignment.c.link.is_(None))
    offers = []
    for row in connection.execute(query.order_by(assignment.c.id.desc())):
        titles = (row.stated or {}).get("title") or {}
        search_text = " ".join([row.name, *titles.values()])
        title = text_in(titles, lang) or row.name
        offers.append(Offer(f"assignment:{row.name}", title, _worth(connection, row.id), search_text))
    return offers


def _worth(connection: Connection, number: int) -> float:
    """Return the points of an assignment: those of the first issued paper."""
    issued = issued_of(connection, number)
    student = next(iter(issued.students), "")
    seeds = issued.issued_to(student) if student else {}
    records = [issued.record_of(student, exercise, seed) for exercise, seed in seeds.items()]
    return sum(float(part["points"]) for record in records for part in record["parts"]) or 1.0


def _exercise_offers(course: Course[Any], lang: str) -> list[OfferGroup]:
    texts, folder = words(lang)["lti"]["pick"], course.folder
    placed = {name for chapter in folder.chapters for name in chapter.exercises}
    named = [(f"{chapter.label}. {chapter.title(lang)}", chapter.exercises) for chapter in folder.chapters]
    others = tuple(name for name in folder.names if name not in placed)
    named.append((texts["others"] if placed else folder.title(lang), others))
    return [
        OfferGroup(title, tuple(_exercise_offer(course, name, lang) for name in names))
        for title, names in named
        if names
    ]


def _exercise_offer(course: Course[Any], name: str, lang: str) -> Offer:
    exercise = course[name]
    spoken = lang if lang in exercise.languages else exercise.languages[0]
    search_text = " ".join([name, *map(exercise.title, exercise.languages)])
    # The parts asked may depend on the given values; one variant represents them all.
    points = sum(part.points for part in exercise.variant(0, spoken).parts)
    return Offer(f"exercise:{name}", exercise.title(spoken), float(points), search_text)
