"""Queue of answers that wait for a person: one card for equal answers to one question, decided with one key
or tap."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from starlette.responses import Response

from coursework.database.class_state import ClassState, UnplacedRow
from coursework.database.decisions import decide
from coursework.database.instructor_queries import (
    decided_since,
    undoable,
)
from coursework.database.permissions import Permission
from coursework.database.submissions import drawings_of
from coursework.errors import BadInput
from coursework.figures import Figure
from coursework.gradebook.decisions import WITHDRAWN, Decision
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.waiting import (
    SHOWN_ON_REQUEST,
    WHY,
    AnswerGroup,
    AnswerToReview,
    OpenGroup,
    written,
)
from coursework.language.numbers import localise, significant
from coursework.parsing.scanned import scan_references
from coursework.rendering.surface import drawn_figure, kind_of_surface
from coursework.site.desk.class_cache import class_here, class_page_of
from coursework.site.desk.question_cards import (
    QuestionCard,
    decided_words,
    question_card,
    raw_texts,
    requested_decision,
    steps,
)
from coursework.site.frame.requests import Request, Route

REJECTED = "rejected"
LONGEST = 2000  #: characters of a comment


@dataclass(frozen=True)
class Filters:
    """Selection of the cards in the queue."""

    why: str = ""  #: reason; without one, all but those shown on request
    exercise: str = ""
    part: str = ""

    @staticmethod
    def of(params: Mapping[str, str]) -> Filters:
        why = params.get("why", "")
        return Filters(
            why if why in (*WHY, REJECTED) else "", params.get("exercise", ""), params.get("part", "")
        )

    @property
    def query(self) -> dict[str, str]:
        """Return the filters as parameters of an address."""
        return {k: v for k, v in (("why", self.why), ("exercise", self.exercise), ("part", self.part)) if v}

    def shows(self, why: str, exercise: str, part: str) -> bool:
        if self.exercise and (self.exercise, self.part or part) != (exercise, part):
            return False
        return why == self.why if self.why else why not in SHOWN_ON_REQUEST


@dataclass(frozen=True)
class QueueItem:
    """One card of the queue."""

    id: str
    why: str
    exercise: str
    part: str
    count: int
    group: AnswerGroup | None = None
    row: UnplacedRow | None = None


def items(now: ClassState, filters: Filters) -> list[QueueItem]:
    """Return the waiting cards that the filters select, in order."""
    cards = [
        QueueItem(
            entry.group.id, entry.why, entry.group.exercise, entry.group.part, len(entry.members), entry.group
        )
        for entry in now.open.values()
    ]
    cards += [
        QueueItem(
            f"r{entry.id}",
            REJECTED,
            entry.row.row.get("exercise", ""),
            entry.row.row.get("part", ""),
            1,
            row=entry,
        )
        for entry in now.coded.named
        if entry.waits
    ]
    return [entry for entry in cards if filters.shows(entry.why, entry.exercise, entry.part)]


# --------------------------------------------------------------------------- card


@dataclass(frozen=True)
class QueueCard:
    """Card of a group of equal answers."""

    item: QueueItem
    question_card: QuestionCard
    first: AnswerToReview
    members: tuple[AnswerToReview, ...]  #: answers that wait
    decided: tuple[tuple[str, str], ...]  #: students with the same answer, each with the decision
    number: str
    margin: str
    spellings: tuple[str, ...]
    steps: tuple[float, ...]
    elsewhere: int  #: answers to other questions with the same unreadable text
    drawing: Figure | None  #: what the first student drew

    @property
    def is_open(self) -> bool:
        return self.first.mark.verdict == "to_mark"

    @property
    def scans(self) -> tuple[tuple[str, str], ...]:
        """Page and field of the pictures of an answer on paper."""
        return scan_references(str(self.first.mark.answer))


def card_of(request: Request, now: ClassState, item: QueueItem) -> QueueCard:
    """Return the card of a group, decided or not."""
    assert item.group is not None
    group = item.group
    waits = now.open[group.id].members if group.id in now.open else ()
    decisions = [(entry, now.decisions.standing(entry.sheet, entry.mark)) for entry in group.members]
    first = (waits or group.members)[0]
    question = question_card(now.course, now.issued, first.sheet, group.part, request.lang)
    margin = "" if first.margin is None else localise(significant(first.margin, 2), request.lang)
    return QueueCard(
        item,
        question,
        first,
        waits,
        tuple(
            (now.shown(entry.student), decided_words(request, done, done.made))
            for entry, done in decisions
            if done is not None and done.made
        ),
        now.questions.label(group.exercise, group.part),
        margin,
        raw_texts([entry.mark for entry in group.members]),
        steps(first.mark.out_of),
        sum(len(entry.members) for entry in _alike(now, group)),
        _drawing(request, now.about.id, first.sheet, question),
    )


def _drawing(request: Request, assignment_id: int, graded: Graded, card: QuestionCard) -> Figure | None:
    """Return what the student drew on the surface of a sheet; None without a drawing."""
    if not kind_of_surface(card.variant.exercise.spec, graded.record):
        return None
    with request.site.store.reading() as connection:
        texts = drawings_of(connection, assignment_id, graded.student)
    return drawn_figure(texts, graded.sitting, card.handout)


def _alike(now: ClassState, group: AnswerGroup) -> list[OpenGroup]:
    """Return the groups of other questions that wait because of the same unreadable text."""
    if group.why != "unreadable":
        return []
    text = written(group.first.mark)
    others = (
        entry for entry in now.open.values() if entry.why == "unreadable" and entry.group.id != group.id
    )
    return [entry for entry in others if written(entry.group.first.mark) == text]


# --------------------------------------------------------------------------- pages


def queue(request: Request) -> Response:
    """Return the requested card, or else the first."""
    filters = Filters.of(request.query_params)
    now = class_here(request)
    return card_response(request, now, filters, request.query_params.get("at", ""))


def decided(request: Request) -> Response:
    """Apply the decision of a form and return the next card."""
    filters = Filters.of({k: request.form.text(k) for k in ("why", "exercise", "part")})
    now = class_here(request)
    if request.form.text("do") == "undo":
        return _undone(request, now, filters)
    name = request.form.text("group")
    group = next((candidate for candidate in now.groups if candidate.id == name), None)
    if group is None:
        return card_response(request, now, filters, "", message=request.words["queue"]["anew"])
    before = [candidate.id for candidate in items(now, filters)]
    try:
        message = _decide(request, now, group)
    except BadInput as fault:
        return card_response(request, now, filters, name, message=str(fault))
    later = class_here(request)
    return card_response(request, later, filters, _after(before, name, later, filters), message=message)


def queue_page(request: Request) -> Response:
    return decided(request) if request.is_post else queue(request)


def watch(request: Request) -> Response:
    """Return a message if somebody else has decided on a card meanwhile; otherwise an empty response."""
    now = class_here(request)
    name = request.query_params.get("group", "")
    group = next((candidate for candidate in now.groups if candidate.id == name), None)
    if group is None or name in now.open:
        return Response(status_code=204)
    decision = now.decisions.standing(group.first.sheet, group.first.mark)
    message = request.words["queue"]["taken"].format(decision.by, 1) if decision else ""
    return request.render("site/instructor/_message", message=message)


def _after(before: Sequence[str], name: str, now: ClassState, filters: Filters) -> str:
    """Return the card after another in the previous order; the same card if some of its answers still
    wait."""
    left = {candidate.id for candidate in items(now, filters)}
    if name in before:
        index = before.index(name)
        return next((candidate for candidate in (*before[index:], *before[:index]) if candidate in left), "")
    return ""


def card_response(
    request: Request, now: ClassState, filters: Filters, at: str, message: str = ""
) -> Response:
    """Return the requested card, or else the first; if there is none, a message."""
    waiting_items = items(now, filters)
    index = next((k for k, candidate in enumerate(waiting_items) if candidate.id == at), None)
    item = waiting_items[index or 0] if waiting_items else None
    if index is None and at:
        item = _closed(now, at) or item
        message = message or _already_decided_message(request, now, at)
    card = card_of(request, now, item) if item is not None and item.group is not None else None
    number = next(
        (k for k, candidate in enumerate(waiting_items) if item is not None and candidate.id == item.id), 0
    )
    names: dict[str, Any] = {
        "filters": filters,
        "item": item,
        "card": card,
        "row": item.row if item is not None else None,
        "place": number + 1,
        "count": len(waiting_items),
        "before": waiting_items[number - 1].id if waiting_items else "",
        "after": waiting_items[(number + 1) % len(waiting_items)].id if waiting_items else "",
        "message": message,
        "counts": _counts(now),
        "done": _done(now),
        "since": now.stamp.decisions[1],
        "can_undo": _can_undo(request, now),
        "by_question": _by_question(now, filters),
        "place_url": f"/desk/{now.about.id}/queue",
    }
    if request.is_fragment:
        return request.render("site/instructor/_queue_piece", now=now, swapped=True, **names)
    return class_page_of(request, now, "site/instructor/queue", "queue", **names)


def _closed(now: ClassState, name: str) -> QueueItem | None:
    """Return a decided card, to be shown again."""
    group = next((candidate for candidate in now.groups if candidate.id == name), None)
    if group is None:
        return None
    return QueueItem(group.id, group.why, group.exercise, group.part, len(group.members), group)


def _already_decided_message(request: Request, now: ClassState, name: str) -> str:
    item = _closed(now, name)
    if item is None or item.group is None:
        return str(request.words["queue"]["anew"])
    first = item.group.first
    decision = now.decisions.standing(first.sheet, first.mark)
    return (
        str(request.words["queue"]["taken"]).format(decision.by, len(item.group.members)) if decision else ""
    )


def _counts(now: ClassState) -> list[tuple[str, int]]:
    """Return the number of waiting cards, by reason."""
    counts = Counter(entry.why for entry in now.open.values())
    counts[REJECTED] = sum(entry.waits for entry in now.named)
    return [(why, counts[why]) for why in (*WHY, REJECTED) if counts[why]]


def _done(now: ClassState) -> int:
    """Return the number of answers of which nothing is left to decide."""
    return sum(len(group.members) for group in now.groups) - sum(
        len(one.members) for one in now.open.values()
    )


def _can_undo(request: Request, now: ClassState) -> bool:
    if not now.stamp.decisions[0]:
        return False
    with request.site.store.reading() as connection:
        return bool(undoable(connection, now.about.id, request.actor.name))


def _by_question(now: ClassState, filters: Filters) -> list[tuple[str, str, str, int]]:
    """Return the questions with waiting cards: number, exercise, part, cards."""
    waiting_items = items(now, replace(filters, exercise="", part=""))
    counts = Counter(
        (waiting.exercise, waiting.part) for waiting in waiting_items if waiting.group is not None
    )
    return [
        (number, *question, counts[question])
        for question, number in now.questions.items()
        if counts[question]
    ]


# ------------------------------------------------------------------------ deciding


def _decide(request: Request, now: ClassState, group: AnswerGroup) -> str:
    """Store the decision on the answers that nobody else has decided on meanwhile; return the message."""
    kind, points = requested_decision(request, group.first.mark)
    members = list(_chosen(request, now, group))
    if request.form.text("everywhere") and not points:
        members += [answer for other in _alike(now, group) for answer in other.members]
    since = request.form.text("since")
    with request.site.store.begin() as connection:
        decided_meanwhile = _decided_meanwhile(
            decided_since(
                connection, now.about.id, int(since) if since.isdecimal() and len(since) < 16 else 0
            )
        )
        free = [answer for answer in members if _key(answer) not in decided_meanwhile]
        comment = request.form.text("comment").strip()[:LONGEST]
        by = request.actor.name
        decide(connection, now.about.id, [_decision(a, kind, points, comment, by) for a in free])
        about = {"assignment": now.about.id, "exercise": group.exercise, "part": group.part, "kind": kind}
        if free:
            request.note(connection, "decision", count=len(free), points=points, **about)
    others = [decided_meanwhile[_key(answer)].by for answer in members if _key(answer) in decided_meanwhile]
    return _decision_message(request, kind, points, len(free), others)


def _decision_message(
    request: Request, kind: str, points: float | None, count: int, others: Sequence[str]
) -> str:
    """Return the message on a decision, with the number of answers that somebody else had already decided."""
    texts = request.words["queue"]
    message = (
        str(texts["decided"][kind]).format(count, localise(f"{points or 0:g}", request.lang)) if count else ""
    )
    return f"{message} {texts['taken'].format(others[0], len(others))}".strip() if others else message


def _key(answer: AnswerToReview) -> tuple[str, str, str, str]:
    return answer.student, answer.sheet.exercise, str(answer.sheet.seed), answer.mark.part


def _chosen(request: Request, now: ClassState, group: AnswerGroup) -> Sequence[AnswerToReview]:
    """Return the answers that a decision covers: all waiting ones with the same text, or the first alone; for
    a decided card, all of it."""
    waits = now.open[group.id].members if group.id in now.open else group.members
    if request.form.text("all"):
        return waits
    student = request.form.text("student")
    return [answer for answer in waits if now.shown(answer.student) == student] or waits[:1]


def _decision(answer: AnswerToReview, kind: str, points: float | None, reason: str, by: str) -> Decision:
    return Decision(*_key(answer), kind, points, reason, answer.mark.answer, by)


def _decided_meanwhile(
    later: Sequence[Decision],
) -> dict[tuple[str, str, str, str], Decision]:
    """Return the answers with a later decision."""
    decisions: dict[tuple[str, str, str, str], Decision] = {}
    for decision in later:
        if decision.kind == WITHDRAWN:
            decisions.pop(decision.answer_id, None)
        else:
            decisions[decision.answer_id] = decision
    return decisions


def _undone(request: Request, now: ClassState, filters: Filters) -> Response:
    """Withdraw the last decision and return its card."""
    texts = request.words["queue"]
    with request.site.store.begin() as connection:
        batch = undoable(connection, now.about.id, request.actor.name)
        if batch:
            by = request.actor.name
            withdrawn = [b.withdrawn(by=by) for b in batch]
            decide(connection, now.about.id, withdrawn)
            request.note(connection, "undo", assignment=now.about.id, count=len(batch))
    later = class_here(request)
    if not batch:
        return card_response(
            request, later, filters, request.form.text("group"), message=texts["nothing_to_undo"]
        )
    cards = later.open.values()
    at = next((card.group.id for card in cards if batch[0].answer_id in map(_key, card.members)), "")
    next_filters = filters if any(candidate.id == at for candidate in items(later, filters)) else Filters()
    return card_response(request, later, next_filters, at, message=texts["undone"].format(len(batch)))


ROUTES = (
    Route(
        "/desk/{assignment:int}/queue", queue_page, Permission.MARKS_DECIDE, takes_forms=True, by_group=True
    ),
    Route("/desk/{assignment:int}/queue/watch", watch, Permission.MARKS_DECIDE, by_group=True),
)
