"""Page of a paper from parts that were prepared in advance, with the drafts filled into the boxes."""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import suppress
from datetime import datetime
from functools import partial
from html import escape, unescape

from sqlalchemy import Connection, select
from sqlalchemy.exc import IntegrityError

from coursework.database.prepared import PreparedPieces, prepare_later, prepared_state, put_prepared
from coursework.database.publication import Phase, is_over, student_assignments
from coursework.database.tables import person
from coursework.errors import BadInput
from coursework.sheets.cells import filled_cells
from coursework.site.frame.drafts import box_values
from coursework.site.frame.lru_cache import LRUCache
from coursework.site.frame.settings import Site
from coursework.site.papers.student_paper import StudentPaper, Texts, student_paper

_BOX = re.compile(r"<(?:input|textarea)\b[^>]*>")
_ATTRIBUTE = re.compile(r' ([a-z-]+)="([^"]*)"')
_AFTER_NAME = re.compile(r' name="[^"]*"(?: class="[^"]*")?')
_CLOSED = re.compile(r'<details class="one-line">(?=(?:<(?!input)|[^<])*<input[^>]* value=")')
_AFTER_VALUE = re.compile(r' value="[^"]*"')


def make_pieces(
    site: Site, number: int, person_id: int, paper: StudentPaper, *, stores: bool
) -> PreparedPieces:
    """Make the parts of a page; store them in the database if ``stores``.

    A reader sees the page even if the database accepts no writes; nothing is stored for a person erased
    meanwhile.
    """
    pieces = paper.pieces()
    if stores:
        with suppress(BadInput, IntegrityError), site.store.begin() as connection:
            put_prepared(connection, number, person_id, paper.lang, paper.state, pieces)
    return pieces


def prepare_soon(site: Site, connection: Connection, number: int, person_id: int | None = None) -> None:
    """Queue the preparation of the pages of an assignment, or of one person's page, if the site has a
    worker."""
    if site.has_worker and not is_over(connection, number, site.clock()):
        prepare_later(connection, number, site.clock(), person_id)


def prepare(site: Site, number: int, person_id: int, at: datetime, cache: LRUCache | None = None) -> int:
    """Make the pages of a person's paper if it is published and not closed; return their number.

    A page is made in the person's language, or in each language of the site if theirs is unknown.
    """
    count = 0
    for lang in _langs(site, person_id):
        with site.store.reading() as connection:
            assignments = student_assignments(connection, person_id, number)
            assignment = assignments[0] if len(assignments) == 1 else None
            if assignment is None or assignment.publication is None:
                return count
            if assignment.own_publication.phase(assignment.publication.now(at)) is Phase.CLOSED:
                return count
            paper = student_paper(connection, site.course, assignment, person_id, lang, cache)
            state = prepared_state(connection, number, person_id, lang)
        if state != paper.state:
            make_pieces(site, number, person_id, paper, stores=True)
            count += 1
    return count


def _langs(site: Site, person_id: int) -> tuple[str, ...]:
    with site.store.reading() as connection:
        lang = connection.execute(select(person.c.lang).where(person.c.id == person_id)).scalar()
    return (lang,) if lang in site.languages else site.languages


def filled_in(body: str, texts: Texts) -> str:
    """Return the body of a page with texts in its boxes, by their names."""
    values = {name: box_values(text) for name, text in filled_cells(texts, _forms(body)).items() if text}
    filled = _BOX.sub(partial(_filled, values), body) if values else body
    return _CLOSED.sub(lambda tag: f"{tag[0][:-1]} open>", filled)


def _forms(body: str) -> dict[str, str]:
    """Return the forms of the texts that boxes of components make, by the name of the whole."""
    boxes = (dict(_ATTRIBUTE.findall(tag)) for tag in _BOX.findall(body) if " data-form=" in tag)
    return {unescape(box["name"]): unescape(box["data-form"]) for box in boxes}


def _filled(values: Mapping[str, list[str]], match: re.Match[str]) -> str:
    tag = match[0]
    attributes = dict(_ATTRIBUTE.findall(tag))
    texts = values.get(unescape(attributes.get("name", "")))
    if texts is None:
        return tag
    if tag.startswith("<textarea"):
        return f"{tag}\n{escape(texts[0])}"
    if attributes.get("type") in ("radio", "checkbox"):
        is_held = unescape(attributes.get("value", "")) in texts
        return _AFTER_VALUE.sub(lambda part: f"{part[0]} checked", tag, count=1) if is_held else tag
    return _AFTER_NAME.sub(lambda part: f'{part[0]} value="{escape(texts[0])}"', tag, count=1)
