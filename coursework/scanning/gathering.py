"""Combination of scanned pages and typed texts into answers: settled, waiting for a person, or missing.

A pure function of what it is told: the order in which pages came makes no difference.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import sha256
from typing import Any, NamedTuple, Protocol, TypeAlias

from coursework.scanning.kept import ANSWERS, LOST, OTHER_NAME, FieldKept, PageKept, Scanned
from coursework.scanning.typed import NAME, PAGE, Typed

DIFFERS = "differs"  #: scans of one page say different things
DRAWN = "drawn"  #: coordinates were left blank, and something is drawn
NOBODY = "nobody"  #: why a paper without a name waits
CODE = "code"  #: why a page waits of which the code cannot be read


class Place(NamedTuple):
    """Place of an answer, or of one of its coordinates."""

    exercise: str
    seed: int
    part: str
    coordinate: int


class Asked(NamedTuple):
    """A place of a page, and what goes there."""

    place: Place
    coordinates: int
    what: str
    page: int


@dataclass(frozen=True)
class PaperAsked:
    """One paper as it was printed: whose it is, and what its answer pages ask."""

    code: str
    student: str  #: empty where it was made for nobody by name
    pages: int
    asked: tuple[Asked, ...]


@dataclass(frozen=True)
class Said:
    """Reading of one place on one scan of a page."""

    page: str  #: its id
    field: FieldKept
    index: int  #: of the field on its page

    @property
    def is_sure(self) -> bool:
        return not self.field.waits


@dataclass(frozen=True)
class Card:
    """Card on which a person types or confirms a text."""

    student: str
    paper: str
    exercise: str  #: ``(name)`` and ``(page)`` where it is not an answer that is asked
    seed: int
    part: str
    coordinate: int
    coordinates: int
    what: str
    waits: str
    candidate: str
    confidence: float
    said: tuple[Said, ...] = ()
    pages: tuple[str, ...] = ()  #: ids, of the scans to look at

    @property
    def id(self) -> str:
        told = (self.student, self.paper, self.exercise, self.seed, self.part, self.coordinate, *self.pages)
        return sha256("\0".join(map(str, told)).encode()).hexdigest()[:16]


@dataclass(frozen=True)
class Answer:
    """An answer of which nothing waits."""

    student: str
    exercise: str
    seed: int
    part: str
    answer: str
    pages: tuple[str, ...]  #: ids, of the scans that say it
    by_hand: bool = False
    pictures: tuple[Said, ...] = ()  #: of an answer that a person marks from its picture


@dataclass(frozen=True)
class Pending:
    """An answer of which something waits: its pieces, in order."""

    student: str
    part: Part
    pieces: tuple[Card | str, ...]


@dataclass
class Gathered:
    """Combined content of all pages."""

    answers: list[Answer] = field(default_factory=list)
    cards: list[Card] = field(default_factory=list)
    missing: list[tuple[PaperAsked, tuple[int, ...]]] = field(default_factory=list)
    whose: dict[str, str] = field(default_factory=dict)  #: student by code of a paper
    waits: dict[str, int] = field(default_factory=dict)  #: cards by id of a page
    unused: list[Typed] = field(default_factory=list)  #: what was typed and fits nothing that was scanned
    pending: list[Pending] = field(default_factory=list)
    drawn: dict[tuple[str, str, int], Said] = field(
        default_factory=dict
    )  #: what was drawn on, by paper, exercise and seed


Part: TypeAlias = tuple[str, int, str]  #: exercise, seed and id


class Parts(Protocol):
    """Properties of the questions on the papers."""

    def is_open(self, part: Part) -> bool:
        """Return True if a person marks the question."""

    def is_drawn(self, part: Part) -> bool:
        """Return True if the answer is a point in millimetres on paper."""

    def joined(self, part: Part, texts: Sequence[str]) -> str:
        """Return the texts of the coordinates as one answer."""


def gather(
    pages: Iterable[Scanned],
    papers: Mapping[str, PaperAsked],
    typed: Iterable[Typed],
    parts: Parts,
) -> Gathered:
    """Combine pages and typed texts."""
    found = Gathered()
    by_paper: dict[str, dict[int, dict[str, PageKept]]] = {}
    lost: dict[str, str] = {}
    for one in pages:
        if one.page.what == ANSWERS and one.page.code in papers:
            by_paper.setdefault(one.page.code, {}).setdefault(one.page.number, {})[one.id] = one.page
        elif one.page.what == LOST:
            lost[one.id] = OTHER_NAME if one.page.reason == OTHER_NAME else CODE
    decided = {one.place: one for one in typed}
    used: set[Any] = set()
    for code, paper in papers.items():
        scans = by_paper.get(code, {})
        found.whose[code] = whose = _whose(paper, scans, decided, used, found)
        missing = tuple(n for n in range(1, paper.pages + 1) if n not in scans)
        if missing:
            found.missing.append((paper, missing))
        _gather_paper(found, paper, whose, scans, decided, used, parts)
    for name in sorted(lost):
        found.cards.append(Card("", "", PAGE, 0, name, 1, 1, PAGE, lost[name], "", 0.0, (), (name,)))
    for card in found.cards:
        for name in card.pages:
            found.waits[name] = found.waits.get(name, 0) + 1
    found.unused = [one for one in decided.values() if one.place not in used]
    return found


def _whose(
    paper: PaperAsked,
    scans: Mapping[int, Mapping[str, PageKept]],
    decided: Mapping[Any, Typed],
    used: set[Any],
    found: Gathered,
) -> str:
    """Return the student of a paper; for a paper without a name, the student whom a person has typed, or else
    the code."""
    if paper.student or not scans:
        return paper.student or paper.code
    told = decided.get((paper.code, NAME, "", "", "1"))
    if told is not None and told.answer.strip():
        used.add(told.place)
        return told.answer.strip()
    first = tuple(sorted(scans[min(scans)]))
    found.cards.append(Card(paper.code, paper.code, NAME, 0, "", 1, 1, NAME, NOBODY, "", 0.0, (), first[:1]))
    return paper.code


def _gather_paper(
    found: Gathered,
    paper: PaperAsked,
    whose: str,
    scans: Mapping[int, Mapping[str, PageKept]],
    decided: Mapping[Any, Typed],
    used: set[Any],
    parts: Parts,
) -> None:
    said = _said(scans)
    by_part: dict[Part, list[Asked]] = {}
    for one in paper.asked:
        by_part.setdefault(one.place[:3], []).append(one)
    for part, asked in by_part.items():
        if not part[2]:  # paper to draw on, which is no answer by itself
            _note_drawing(found, paper, said.get(asked[0].place, ()))
            continue
        settled = [
            _settle(one, paper, whose, said.get(one.place, ()), decided, used, parts.is_open(part))
            for one in asked
        ]
        if (paper.code, *part[:2]) in found.drawn and parts.is_drawn(part):
            settled = [_to_click(s, one, paper, whose, said) for s, one in zip(settled, asked, strict=True)]
        _put(found, whose, part, settled, parts)


def _note_drawing(found: Gathered, paper: PaperAsked, said: Sequence[Said]) -> None:
    drawn = next((s for s in said if s.field.waits), None)
    if drawn is not None:
        found.drawn[paper.code, drawn.field.exercise, drawn.field.seed] = drawn


def _to_click(
    settled: _Settled | Card | None,
    one: Asked,
    paper: PaperAsked,
    whose: str,
    said: Mapping[Place, Sequence[Said]],
) -> _Settled | Card | None:
    """Return a card for a blank coordinate beside a drawing, since a person may click it there; any other
    state unchanged."""
    if not isinstance(settled, _Settled) or settled.text or settled.by_hand:
        return settled
    own = said[one.place]
    return _card(one, paper, whose, own, DRAWN, "", 0.0)


def _put(
    found: Gathered, whose: str, part: Part, settled: Sequence[_Settled | Card | None], parts: Parts
) -> None:
    """Add the answer to a question if all its coordinates are known; otherwise add their cards, and list the
    answer as pending if all its pages were scanned."""
    cards = [one for one in settled if isinstance(one, Card)]
    known = [one for one in settled if isinstance(one, _Settled)]
    found.cards += cards
    if len(cards) + len(known) < len(settled):
        return  # of its pages not all were scanned
    if cards:
        pieces = tuple(one if isinstance(one, Card) else one.text for one in settled if one is not None)
        found.pending.append(Pending(whose, part, pieces))
        return
    texts = [one.text for one in known]
    ids = tuple(sorted({name for one in known for name in one.pages}))
    found.answers.append(
        Answer(
            whose, *part, texts[0] if len(texts) == 1 else parts.joined(part, texts), ids, any(one.by_hand for one in known),
            tuple(s for one in known for s in one.pictures),
        )
    )  # fmt: skip


def _said(scans: Mapping[int, Mapping[str, PageKept]]) -> dict[Place, tuple[Said, ...]]:
    """Return the readings of a paper's scans by place, ordered by the ids of the scans."""
    found: dict[Place, list[Said]] = {}
    for number in sorted(scans):
        for name in sorted(scans[number]):
            for index, one in enumerate(scans[number][name].fields):
                place = Place(one.exercise, one.seed, one.part, one.coordinate)
                found.setdefault(place, []).append(Said(name, one, index))
    return {place: tuple(said) for place, said in found.items()}


@dataclass(frozen=True)
class _Settled:
    text: str
    pages: tuple[str, ...]
    by_hand: bool = False
    pictures: tuple[Said, ...] = ()


def _settle(
    one: Asked,
    paper: PaperAsked,
    whose: str,
    said: Sequence[Said],
    decided: Mapping[Any, Typed],
    used: set[Any],
    is_open: bool,
) -> _Settled | Card | None:
    """Return the settled text of a place: the typed one, or else the reading on which all scans agree without
    doubt; otherwise a card for a person.

    None where nothing was scanned nor typed.
    """
    ids = tuple(s.page for s in said)
    typed = _typed_at(one.place, paper, whose, decided, used)
    if typed is not None and _holds(typed, said):
        return _Settled(typed.answer, ids, by_hand=True)
    if not said:
        return None
    texts = {s.field.text for s in said}
    if len(texts) == 1 and all(s.is_sure for s in said) and typed is None:
        return _Settled(said[0].field.text, ids)
    if is_open:
        return _Settled("", ids, pictures=tuple(s for s in said if s.field.waits or s.field.text))
    likeliest = max(said, key=lambda s: (s.is_sure, s.field.confidence, s.page))
    if typed is not None:
        return _card(one, paper, whose, said, DIFFERS, typed.answer, 0.0)
    return _card(one, paper, whose, said, _why(said, texts), likeliest.field.text, likeliest.field.confidence)


def _card(
    one: Asked,
    paper: PaperAsked,
    whose: str,
    said: Sequence[Said],
    waits: str,
    candidate: str,
    confidence: float,
) -> Card:
    place = one.place
    return Card(
        whose, paper.code, place.exercise, place.seed, place.part, place.coordinate, one.coordinates, one.what, waits, candidate,
        confidence, tuple(said), tuple(s.page for s in said),
    )  # fmt: skip


def _why(said: Sequence[Said], texts: set[str]) -> str:
    """Why a place waits: its scans differ, or the first reason that one of them has."""
    if len(texts) > 1:
        return DIFFERS
    return next(s.field.waits for s in said if s.field.waits)


def _typed_at(
    place: Place, paper: PaperAsked, whose: str, decided: Mapping[Any, Typed], used: set[Any]
) -> Typed | None:
    for name in (whose, paper.code):
        key = (name, place.exercise, str(place.seed), place.part, str(place.coordinate + 1))
        if key in decided:
            used.add(key)
            return decided[key]
    return None


def _holds(typed: Typed, said: Sequence[Said]) -> bool:
    """Return True if a typed text still applies: its author saw these scans, or later ones agree with it."""
    if not typed.pages:
        return True
    seen = {s.field.text for s in said if s.page in typed.pages and s.is_sure}
    new = [s for s in said if s.page not in typed.pages]
    return all(s.is_sure and s.field.text in {typed.answer, *seen} for s in new)
