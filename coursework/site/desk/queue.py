"""The queue: what waits for a person, a card a question and a way of answering it; decided by a key or a thumb, for all who
wrote the same."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from coursework.database.audit import note
from coursework.database.decisions import ACCEPTED, GIVEN, KEPT, WITHDRAWN, Place, decide
from coursework.database.desk import Made, decided_since, place_of, undoable
from coursework.database.permissions import Permission
from coursework.errors import BadInput
from coursework.gradebook.accepted import points_of
from coursework.gradebook.waiting import SHOWN_ON_REQUEST, WHY, Group, Waits, written
from coursework.language.numbers import localise, significant
from coursework.site.desk.class_cache import (
    ClassNow,
    Open,
    RejectedRow,
    assignment_of,
    by_whom,
    class_now,
    class_page_of,
)
from coursework.site.desk.question_cards import QuestionCard, decided_words, question_card, raw_texts, steps
from coursework.site.frame.requests import HTTPException, Request, Response, Route

REJECTED = "rejected"
LONGEST = 2000  #: characters of a comment
_SCAN = re.compile(r"scan ([0-9a-f]{16}-\d{4,6})/(\d{1,4})")  #: an answer that is a picture


@dataclass(frozen=True)
class Filters:
    """Selection of the cards in the queue."""

    why: str = ""  #: all but what waits for nobody, unless told
    exercise: str = ""
    part: str = ""

    @staticmethod
    def of(told: Mapping[str, str]) -> Filters:
        why = told.get("why", "")
        return Filters(why if why in (*WHY, REJECTED) else "", told.get("exercise", ""), told.get("part", ""))

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
    group: Group | None = None
    row: RejectedRow | None = None


def items(now: ClassNow, filters: Filters) -> list[QueueItem]:
    """Return the waiting cards that the filters select, in order."""
    found = [
        QueueItem(one.group.id, one.why, one.group.exercise, one.group.part, len(one.members), one.group)
        for one in now.open.values()
    ]
    found += [
        QueueItem(
            f"r{one.id}", REJECTED, one.row.row.get("exercise", ""), one.row.row.get("part", ""), 1, row=one
        )
        for one in now.named
        if one.waits
    ]
    return [one for one in found if filters.shows(one.why, one.exercise, one.part)]


# --------------------------------------------------------------------------- card


@dataclass(frozen=True)
class QueueCard:
    """A group as it is shown."""

    item: QueueItem
    question_card: QuestionCard
    first: Waits
    members: tuple[Waits, ...]  #: those who wait
    decided: tuple[tuple[str, str], ...]  #: those who wrote the same, and what was decided of it
    number: str
    margin: str
    spellings: tuple[str, ...]
    steps: tuple[float, ...]
    elsewhere: int  #: answers to other questions in which the same cannot be read

    @property
    def is_open(self) -> bool:
        return self.first.mark.verdict == "to_mark"

    @property
    def scans(self) -> tuple[tuple[str, str], ...]:
        """Route and field of the pictures that an answer on paper is."""
        told = [_SCAN.fullmatch(one) for one in str(self.first.mark.answer).split("; ")]
        return tuple((one[1], one[2]) for one in told if one)


def card_of(request: Request, now: ClassNow, item: QueueItem) -> QueueCard:
    """Return the card of a group, decided or not."""
    assert item.group is not None
    group = item.group
    waits = now.open[group.id].members if group.id in now.open else ()
    made = [(one, now.decisions.standing(one.sheet, one.mark)) for one in group.members]
    first = (waits or group.members)[0]
    margin = "" if first.margin is None else localise(significant(first.margin, 2), request.lang)
    return QueueCard(
        item, question_card(now.course, now.issued, first.sheet, group.part, request.lang), first, waits,
        tuple((one.student, decided_words(request, done)) for one, done in made if done is not None), now.number(group.exercise, group.part), margin,
        raw_texts([one.mark for one in group.members]), steps(first.mark.out_of),
        sum(len(one.members) for one in _alike(now, group)),
    )  # fmt: skip


def _alike(now: ClassNow, group: Group) -> list[Open]:
    """Return the groups of other questions that wait because of the same unreadable text."""
    if group.why != "unreadable":
        return []
    text = written(group.first.mark)
    others = (one for one in now.open.values() if one.why == "unreadable" and one.group.id != group.id)
    return [one for one in others if written(one.group.first.mark) == text]


# --------------------------------------------------------------------------- pages


def queue(request: Request) -> Response:
    """Return the requested card, or else the first."""
    filters = Filters.of(request.query_params)
    now = class_now(request.site, assignment_of(request))
    return card_response(request, now, filters, request.query_params.get("at", ""))


def decided(request: Request) -> Response:
    """Decide what the form says, and show the next card."""
    filters = Filters.of({k: request.form.text(k) for k in ("why", "exercise", "part")})
    now = class_now(request.site, assignment_of(request))
    asked_for = request.form.text("do")
    if asked_for == "undo":
        return _undone(request, now, filters)
    name = request.form.text("group")
    group = next((one for one in now.groups if one.id == name), None)
    if group is None:
        return card_response(request, now, filters, "", told=request.words["queue"]["anew"])
    before = [one.id for one in _around(now, filters)]
    try:
        told = _decide(request, now, group, asked_for)
    except BadInput as fault:
        return card_response(request, now, filters, name, told=str(fault))
    later = class_now(request.site, now.about.id)
    return card_response(request, later, filters, _after(before, name, later, filters), told=told)


def queue_page(request: Request) -> Response:
    return decided(request) if request.is_post else queue(request)


def watch(request: Request) -> Response:
    """Return a message if somebody else has decided on a card meanwhile; otherwise an empty response."""
    now = class_now(request.site, assignment_of(request))
    name = request.query_params.get("group", "")
    group = next((one for one in now.groups if one.id == name), None)
    if group is None or name in now.open:
        return Response(status_code=204)
    made = now.decisions.standing(group.first.sheet, group.first.mark)
    told = request.words["queue"]["taken"].format(made.by, 1) if made else ""
    return request.render("_desk_told", told=told)


def _around(now: ClassNow, filters: Filters) -> list[QueueItem]:
    return items(now, filters)


def _after(before: Sequence[str], name: str, now: ClassNow, filters: Filters) -> str:
    """Return the card after another in the previous order; the same card if some of its answers still wait."""
    left = {one.id for one in items(now, filters)}
    if name in before:
        place = before.index(name)
        return next((one for one in (*before[place:], *before[:place]) if one in left), "")
    return ""


def card_response(request: Request, now: ClassNow, filters: Filters, at: str, told: str = "") -> Response:
    """Return the requested card, or else the first; if there is none, a message."""
    shown = items(now, filters)
    place = next((k for k, one in enumerate(shown) if one.id == at), None)
    item = shown[place or 0] if shown else None
    if place is None and at:
        item = _closed(now, at) or item
        told = told or _already_decided_message(request, now, at)
    card = card_of(request, now, item) if item is not None and item.group is not None else None
    number = next((k for k, one in enumerate(shown) if item is not None and one.id == item.id), 0)
    names: dict[str, Any] = {
        "filters": filters,
        "item": item,
        "card": card,
        "row": item.row if item is not None else None,
        "place": number + 1,
        "count": len(shown),
        "before": shown[number - 1].id if shown else "",
        "after": shown[(number + 1) % len(shown)].id if shown else "",
        "told": told,
        "counts": _counts(now),
        "done": _done(now),
        "since": now.stamp.decisions[1],
        "can_undo": _can_undo(request, now),
        "by_question": _by_question(now, filters),
        "place_url": f"/desk/{now.about.id}/queue",
    }
    if request.is_fragment:
        return request.render("_desk_queue_piece", now=now, swapped=True, **names)
    return class_page_of(request, now, "site_desk_queue", "queue", **names)


def _closed(now: ClassNow, name: str) -> QueueItem | None:
    """Return a decided card, to be shown again."""
    group = next((one for one in now.groups if one.id == name), None)
    if group is None:
        return None
    return QueueItem(group.id, group.why, group.exercise, group.part, len(group.members), group)


def _already_decided_message(request: Request, now: ClassNow, name: str) -> str:
    item = _closed(now, name)
    if item is None or item.group is None:
        return str(request.words["queue"]["anew"])
    first = item.group.first
    made = now.decisions.standing(first.sheet, first.mark)
    return str(request.words["queue"]["taken"]).format(made.by, len(item.group.members)) if made else ""


def _counts(now: ClassNow) -> list[tuple[str, int]]:
    """Return the number of waiting cards, by reason."""
    found = Counter(one.why for one in now.open.values())
    found[REJECTED] = sum(one.waits for one in now.named)
    return [(why, found[why]) for why in (*WHY, REJECTED) if found[why]]


def _done(now: ClassNow) -> int:
    """Return the number of decided answers."""
    return sum(now.is_decided(one) for group in now.groups for one in group.members)


def _can_undo(request: Request, now: ClassNow) -> bool:
    if not now.stamp.decisions[0]:
        return False
    with request.site.store.reading() as connection:
        return bool(undoable(connection, now.about.id, by_whom(request)))


def _by_question(now: ClassNow, filters: Filters) -> list[tuple[str, str, str, int]]:
    """Return the questions with waiting cards: number, exercise, part, cards."""
    shown = items(now, replace(filters, exercise="", part=""))
    found = Counter((one.exercise, one.part) for one in shown if one.group is not None)
    return [
        (now.number(*question), *question, found[question]) for question in now.questions if found[question]
    ]


# ------------------------------------------------------------------------ deciding


def _decide(request: Request, now: ClassNow, group: Group, asked_for: str) -> str:
    """Keep the decision on those whom nobody decided on meanwhile; says what was done."""
    kind, points = _requested_decision(asked_for, request, group)
    members = list(_chosen(request, now, group))
    if request.form.text("everywhere") and not points:
        members += [one for other in _alike(now, group) for one in other.members]
    since = request.form.text("since")
    with request.site.store.begin() as connection:
        taken = _decided_meanwhile(
            decided_since(
                connection, now.about.id, int(since) if since.isdecimal() and len(since) < 16 else 0
            )
        )
        free = [one for one in members if _key(one) not in taken]
        comment = request.form.text("comment").strip()[:LONGEST]
        decide(connection, now.about.id, map(_target, free), kind, points, comment, by_whom(request))
        about = {"assignment": now.about.id, "exercise": group.exercise, "part": group.part, "kind": kind}
        if free:
            note(
                connection,
                request.received_at,
                by_whom(request),
                "decision",
                count=len(free),
                points=points,
                **about,
            )
    others = [taken[_key(one)].by for one in members if _key(one) in taken]
    return _decision_message(request, kind, points, len(free), others)


def _decision_message(
    request: Request, kind: str, points: float | None, count: int, others: Sequence[str]
) -> str:
    """Return the message on a decision, with the number of answers that somebody else had already decided."""
    said = request.words["queue"]
    told = (
        str(said["decided"][kind]).format(count, localise(f"{points or 0:g}", request.lang)) if count else ""
    )
    return f"{told} {said['taken'].format(others[0], len(others))}".strip() if others else told


def _key(one: Waits) -> tuple[str, str, str, str]:
    return one.student, one.sheet.exercise, str(one.sheet.seed), one.mark.part


def _chosen(request: Request, now: ClassNow, group: Group) -> Sequence[Waits]:
    """Return the answers that a decision covers: all waiting ones with the same text, or the first alone; for
    a decided card, all of it."""
    waits = now.open[group.id].members if group.id in now.open else group.members
    if request.form.text("all"):
        return waits
    student = request.form.text("student")
    return [one for one in waits if one.student == student] or waits[:1]


def _requested_decision(asked_for: str, request: Request, group: Group) -> tuple[str, float | None]:
    """Return the kind of a decision, and its points.

    Raises
    ------
    HTTPException
        It is none.
    BadInput
        Its points are no number.
    """
    if asked_for == "accept":
        return ACCEPTED, None
    if asked_for == "refuse":
        return (GIVEN, 0.0) if group.first.mark.verdict in ("unreadable", "to_mark") else (KEPT, None)
    told = request.form.text("points") if asked_for == "points" else asked_for.removeprefix("give:")
    if asked_for != "points" and not asked_for.startswith("give:"):
        raise HTTPException("bad_request", 400)
    points = points_of(told.strip(), request.words["queue"]["points"])
    if points is None:
        raise BadInput(request.words["queue"]["no_points"])
    if points > group.first.mark.out_of:
        most = localise(f"{group.first.mark.out_of:g}", request.lang)
        raise BadInput(request.words["queue"]["too_many"].format(localise(told, request.lang), most))
    return GIVEN, points


def _target(one: Waits) -> Place:
    return Place(one.student, one.sheet.exercise, str(one.sheet.seed), one.mark.part, one.mark.answer)


def _decided_meanwhile(later: Sequence[Made]) -> dict[tuple[str, str, str, str], Made]:
    """Return the answers with a later decision."""
    found: dict[tuple[str, str, str, str], Made] = {}
    for one in later:
        key = one.student, one.exercise, one.seed, one.part
        if one.kind == WITHDRAWN:
            found.pop(key, None)
        else:
            found[key] = one
    return found


def _undone(request: Request, now: ClassNow, filters: Filters) -> Response:
    """Withdraw what was decided last, and show its card."""
    said = request.words["queue"]
    with request.site.store.begin() as connection:
        batch = undoable(connection, now.about.id, by_whom(request))
        if batch:
            decide(connection, now.about.id, map(place_of, batch), WITHDRAWN, None, "", by_whom(request))
            note(
                connection,
                request.received_at,
                by_whom(request),
                "undo",
                assignment=now.about.id,
                count=len(batch),
            )
    later = class_now(request.site, now.about.id)
    if not batch:
        return card_response(
            request, later, filters, request.form.text("group"), told=said["nothing_to_undo"]
        )
    at = next((one.group.id for one in later.open.values() if _is_of(one.members, batch[0])), "")
    shown = filters if any(one.id == at for one in items(later, filters)) else Filters()
    return card_response(request, later, shown, at, told=said["undone"].format(len(batch)))


def _is_of(members: Sequence[Waits], one: Made) -> bool:
    return any(_key(w) == (one.student, one.exercise, one.seed, one.part) for w in members)


ROUTES = (
    Route("/desk/{assignment:int}/queue", queue_page, Permission.MARKS_DECIDE, takes_forms=True),
    Route("/desk/{assignment:int}/queue/watch", watch, Permission.MARKS_DECIDE),
)
