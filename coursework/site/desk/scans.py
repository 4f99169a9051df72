"""Instructor's page of scans: they are uploaded, read in the background, and unreadable answers are typed
card by card, or several cards of a question at once where the screen is wide."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from starlette.responses import Response

from coursework.database.class_state import ClassState
from coursework.database.permissions import Permission
from coursework.database.scans import last_typed, name_scanned, picture_scanned, put_typed, withdraw_typed
from coursework.errors import BadInput
from coursework.issuing.answer_papers import AnswerPaper
from coursework.language.words import words
from coursework.scanning.gathering import AnswerCard
from coursework.scanning.page_reading import cut
from coursework.scanning.queue import place_of_card
from coursework.scanning.sources import ENDINGS
from coursework.scanning.typed import NAME, PAGE, Typed
from coursework.site.desk import scan_jobs
from coursework.site.desk.class_cache import class_here, class_now, class_page_of
from coursework.site.desk.class_scans import ClassScans, class_scans, hand_over, is_handed_over
from coursework.site.desk.files import file_name
from coursework.site.frame.budgets import DESK_FILES
from coursework.site.frame.requests import HTTPException, Request, Route, Upload

LONGEST = 4000  #: characters of an answer
TOGETHER = 9  #: cards of a question that are confirmed at once, each with a digit as its key
_ID = re.compile(r"[0-9a-f]{16}-\d{4,6}")


@dataclass(frozen=True)
class ScanCard:
    """Card as the page shows it."""

    card: AnswerCard
    group: Mapping[str, Any]
    why: str
    crops: tuple[str, ...]  #: addresses of pictures of the field, or of the page
    pages: tuple[str, ...]


# ------------------------------------------------------------------------ pages


def scans_page(request: Request, message: str = "") -> Response:
    """Return the page of scans and their state; store an upload, if a form brings one."""
    now = class_here(request)
    if request.is_post:
        message = _sent(request, now)
    job = scan_jobs.job(request.site, now.about.id)
    scans = class_scans(request.site, now.about.id)
    if request.is_post and request.form.text("do") == "hand over":
        message = request.words["scans"]["handed_over"].format(hand_over(request.site, now.about.id, scans))
    absent = _absent(now, scans)
    return class_page_of(
        request,
        now,
        "site/instructor/scans",
        "scans",
        message=message,
        job=job,
        scans=scans,
        is_marked=is_handed_over(request.site, now.about.id, scans),
        endings=",".join((*ENDINGS, ".zip")),
        absent=absent if scans.pages else [],
    )


def _sent(request: Request, now: ClassState) -> str:
    """Start to read the uploaded files. Raises BadInput: no file was sent."""
    if request.form.text("do") == "hand over":
        return ""
    sent = request.form.uploads("scans")
    if not sent:
        raise BadInput(request.words["files"]["none_sent"])
    scan_jobs.begin(request.site, now.about.id, _by_names(sent), request.actor.name)
    return ""


def _by_names(sent: list[Upload]) -> dict[str, bytes]:
    """Return files by names, made distinct."""
    files: dict[str, bytes] = {}
    for number, upload in enumerate(sent, 1):
        name = file_name(upload)
        files[name if name not in files else f"{number}-{name}"] = upload.data
    return files


def _absent(now: ClassState, scans: ClassScans) -> list[str]:
    """Return the students with a paper of which no page was scanned."""
    met = set(scans.gathered.whose.values())
    return _shown(now, (student for student in now.issued.students if student not in met))


def _shown(now: ClassState, students: Iterable[str]) -> list[str]:
    """Return students as pages on scans show them: by their codes, in the order of these, in an anonymous
    assignment."""
    if not now.all_codes:
        return [*students]
    return sorted(now.all_codes.get(student, student) for student in students)


def cards_page(request: Request) -> Response:
    """Return one card after another, with those of its question; a form decides on one, or on all whose box
    is filled in."""
    now = class_here(request)
    scans = class_scans(request.site, now.about.id)
    if not request.is_post:
        return _card_response(request, now, scans, request.query_params.get("at", ""))
    asked_for, before = request.form.text("do"), [card.id for card in scans.cards]
    if asked_for == "undo":
        return _undone(request, now)
    if asked_for not in ("confirm", "confirm all", "nothing"):
        raise HTTPException("bad_request", 400)
    by_id, ids = {card.id: card for card in scans.cards}, request.form.texts.get("card", ())[:TOGETHER]
    there = [by_id[id_] for id_ in ids if id_ in by_id]
    answers: Sequence[tuple[AnswerCard, str]]
    if asked_for == "confirm all":
        boxes = dict(zip(ids, request.form.texts.get("answer", ()), strict=False))
        answers = [(card, text) for card in there if (text := boxes.get(card.id, "").strip()[:LONGEST])]
    else:
        answers = [(c, "" if asked_for == "nothing" else _answer(request, c)) for c in there[:1]]
    _type(request, now, scans, answers)
    texts, later = request.words["scans"], class_scans(request.site, now.about.id)
    message = (
        texts["kept"] if len(answers) == 1 else texts["kept_several"].format(len(answers)) if there else ""
    )
    if len(there) < len(ids):
        message = f"{message} {texts['taken']}".strip()
    if answers and not later.cards:
        message = texts["handed_over"].format(hand_over(request.site, now.about.id, later))
    left = {candidate.id for candidate in later.cards}
    index = before.index(ids[0]) if ids and ids[0] in before else 0
    at = next((candidate for candidate in (*before[index:], *before[:index]) if candidate in left), "")
    return _card_response(request, class_now(request.site, now.about.id), later, at, message)


def _undone(request: Request, now: ClassState) -> Response:
    """Withdraw what the person typed last, also from what was submitted; return the first of its cards."""
    before = class_scans(request.site, now.about.id)
    waited = {card.id for card in before.cards}
    is_marked = is_handed_over(request.site, now.about.id, before)
    with request.site.store.begin() as connection:
        texts = last_typed(connection, now.about.id, request.actor.name)
        if texts:
            withdraw_typed(connection, now.about.id, texts, request.actor.name, request.received_at)
            request.note(connection, "scan typed undone", assignment=now.about.id, texts=len(texts))
    said, later = request.words["queue"], class_scans(request.site, now.about.id)
    message = said["undone"].format(len(texts)) if texts else said["nothing_to_undo"]
    if texts and is_marked:
        hand_over(request.site, now.about.id, later)
    at = next((card.id for card in later.cards if card.id not in waited), "")
    return _card_response(request, class_now(request.site, now.about.id), later, at, message)


def _answer(request: Request, card: AnswerCard) -> str:
    """Return the typed answer. Raises BadInput: a name is asked for and none was typed."""
    text = request.form.text("answer").strip()[:LONGEST]
    if card.exercise == PAGE:
        return f"{request.form.text('paper')} {request.form.text('number').strip() or '1'}"
    if card.exercise == NAME and not text:
        raise BadInput(request.words["scans"]["no_name"])
    return text


def _type(
    request: Request, now: ClassState, scans: ClassScans, answers: Sequence[tuple[AnswerCard, str]]
) -> None:
    """Store the texts that are typed on cards, each as a decision of its own. Raises BadInput: there is no
    such page."""
    papers = {
        card.id: _paper_named(request, scans, answer)
        for card, answer in answers
        if card.exercise == PAGE and answer
    }
    with request.site.store.begin() as connection:
        for card, answer in answers:
            student, exercise, seed, part, coordinate = place_of_card(card)
            text = Typed(student, exercise, seed, part, coordinate, answer, " ".join(card.pages))
            put_typed(connection, now.about.id, text, request.actor.name, request.received_at)
            if card.id in papers:
                name_scanned(connection, now.about.id, part, papers[card.id].student)
            about = {
                "assignment": now.about.id,
                "exercise": exercise,
                "part": part if exercise != PAGE else "",
            }
            request.note(connection, "scan typed", **about)


def _paper_named(request: Request, scans: ClassScans, text: str) -> AnswerPaper:
    """Return the paper of the code and the page in a text. Raises BadInput: there is no such page."""
    code, _, number = text.partition(" ")
    if code not in scans.papers or all(str(page.number) != number for page in scans.papers[code]):
        raise BadInput(request.words["scans"]["no_page"])
    return scans.papers.papers[code]


def _card_response(
    request: Request, now: ClassState, scans: ClassScans, at: str, message: str = ""
) -> Response:
    """Return the requested card, or else the first; if there is none, a message."""
    cards = scans.cards
    index = next((k for k, card in enumerate(cards) if card.id == at), 0)
    shown = [_scan_card(request, now, scans, card) for card in _beside(cards, index)]
    with request.site.store.reading() as connection:
        typed = last_typed(connection, now.about.id, request.actor.name)
    names: dict[str, Any] = {
        "shown": shown[0] if shown else None,
        "together": shown if len(shown) > 1 and "alone" not in request.query_params else [],
        "of_question": sum(_question(card) == _question(cards[index]) for card in cards) if cards else 0,
        "may_undo": len(typed),
        "place": index + 1,
        "count": len(cards),
        "before": cards[index - 1].id if cards else "",
        "after": cards[(index + 1) % len(cards)].id if cards else "",
        "after_all": cards[(index + len(shown)) % len(cards)].id if cards else "",
        "scans": scans,
        "message": message,
        "place_url": f"/desk/{now.about.id}/scans/queue",
        "papers": _papers(now, scans),
    }
    if request.is_fragment:
        return request.render("site/instructor/_scan_card", now=now, **names)
    return class_page_of(request, now, "site/instructor/scan_queue", "scans", **names)


def _beside(cards: Sequence[AnswerCard], index: int) -> list[AnswerCard]:
    """Return a card with those that follow it and are of its question, as many as are confirmed at once."""
    shown = cards[index : index + 1]
    if shown and (shown[0].exercise in (NAME, PAGE) or shown[0].what == "drawing"):
        return [*shown]
    return [card for card in cards[index:] if _question(card) == _question(shown[0])][:TOGETHER]


def _question(card: AnswerCard) -> tuple[str, str]:
    return card.exercise, card.part


def _papers(now: ClassState, scans: ClassScans) -> list[tuple[str, str]]:
    """Return the codes of the papers with their students, as pages on scans show them."""
    papers = [
        (code, now.all_codes.get(p.student, p.student))
        for code, p in scans.papers.papers.items()
        if p.size == "a4"
    ]
    return sorted(papers, key=lambda paper: paper[1]) if now.all_codes else papers


def _scan_card(request: Request, now: ClassState, scans: ClassScans, card: AnswerCard) -> ScanCard:
    texts = words(request.lang, "scan")["waits"]
    base = f"/desk/{now.about.id}/scans"
    pages = tuple(f"{base}/picture?page={name}" for name in card.pages)
    crops = tuple(f"{base}/crop?page={field.page}&field={field.index}" for field in card.said) or pages
    why = texts.get(card.waits) or texts["other"].format(card.waits)
    return ScanCard(card, scans.queue.group(card), why, crops, pages)


# --------------------------------------------------------------------- pictures


def picture(request: Request) -> Response:
    """Return the picture of a page."""
    name, data = _picture(request)
    return Response(media_type="image/jpeg", content=data) if name else Response(status_code=404)


def crop(request: Request) -> Response:
    """Return the picture of a field of a page."""
    name, data = _picture(request)
    scans = class_scans(request.site, int(request.path_params["assignment"]))
    index_text, page = request.query_params.get("field", ""), scans.by_id[name].page
    number = (
        int(index_text) if index_text.isascii() and index_text.isdecimal() and len(index_text) < 5 else -1
    )
    if not 0 <= number < len(page.fields):
        raise HTTPException("own", 404)
    if not page.is_straight:
        return Response(media_type="image/jpeg", content=data)
    return Response(media_type="image/png", content=cut(data, page.fields[number]))


def _picture(request: Request) -> tuple[str, bytes]:
    """Return the page of this assignment that the address names, and its picture."""
    number, name = int(request.path_params["assignment"]), request.query_params.get("page", "")
    if _ID.fullmatch(name):
        with request.site.store.reading() as connection:
            data = picture_scanned(connection, number, name)
        if data:
            return name, data
    raise HTTPException("own", 404)


ROUTES = (
    Route(
        "/desk/{assignment:int}/scans",
        scans_page,
        Permission.SCANS_READ,
        takes_forms=True,
        limit="upload",
        budget=DESK_FILES,
        form_permission=Permission.SCANS_BRING,
    ),
    Route(
        "/desk/{assignment:int}/scans/queue",
        cards_page,
        Permission.SCANS_READ,
        takes_forms=True,
        form_permission=Permission.SCANS_TYPE,
    ),
    Route("/desk/{assignment:int}/scans/picture", picture, Permission.SCANS_READ),
    Route("/desk/{assignment:int}/scans/crop", crop, Permission.SCANS_READ),
)
