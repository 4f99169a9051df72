"""Combination of scanned pages and typed texts into answers: settled, waiting for a person, or missing.

A pure function of its arguments: the order of the pages makes no difference.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import sha256
from itertools import islice, product
from math import prod
from typing import Any, NamedTuple, Protocol, TypeAlias

from coursework.parsing.scanned import picture_of
from coursework.scanning.digits import LIKELY
from coursework.scanning.scan_store import ANSWERS, LOST, OTHER_NAME, PageScan, Scanned, ScannedField
from coursework.scanning.typed import NAME, PAGE, Typed

DIFFERS = "differs"  #: scans of one page say different things
DRAWN = "drawn"  #: coordinates were left blank, and something is drawn
NOBODY = "nobody"  #: why a paper without a name waits
CODE = "code"  #: why a page waits of which the code cannot be read
DOUBTED = "doubted"  #: why a number waits whose digits are read with less confidence than is asked
_READINGS = 100  #: of a doubted answer, that are compared with the right one


class FieldPosition(NamedTuple):
    """Place of an answer, or of one of its coordinates."""

    exercise: str
    seed: int
    part: str
    coordinate: int


class PrintedField(NamedTuple):
    """A place of a page, and what goes there."""

    place: FieldPosition
    coordinates: int
    what: str
    page: int


@dataclass(frozen=True)
class PrintedPaper:
    """One paper as it was printed: whose it is, and what its answer pages ask."""

    code: str
    student: str  #: empty where it was made for nobody by name
    pages: int
    asked: tuple[PrintedField, ...]


@dataclass(frozen=True)
class FieldReading:
    """Reading of one place on one scan of a page."""

    page: str  #: its id
    field: ScannedField
    index: int  #: of the field on its page

    @property
    def is_sure(self) -> bool:
        return not self.field.waits


@dataclass(frozen=True)
class AnswerCard:
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
    said: tuple[FieldReading, ...] = ()
    pages: tuple[str, ...] = ()  #: ids, of the scans to look at

    @property
    def is_likely(self) -> bool:
        """True if the number is probably read right, though not with the confidence that is asked."""
        return self.waits == DOUBTED and bool(self.candidate)

    @property
    def id(self) -> str:
        key = (self.student, self.paper, self.exercise, self.seed, self.part, self.coordinate, *self.pages)
        return sha256("\0".join(map(str, key)).encode()).hexdigest()[:16]


@dataclass(frozen=True)
class ScannedAnswer:
    """An answer of which nothing waits."""

    student: str
    exercise: str
    seed: int
    part: str
    answer: str
    pages: tuple[str, ...]  #: ids, of the scans that say it
    by_hand: bool = False
    pictures: tuple[FieldReading, ...] = ()  #: of an answer that a person reads or marks from its picture

    @property
    def text(self) -> str:
        """Answer as it is marked: for one that is a picture, the file of the picture."""
        return "; ".join(s.field.crop or picture_of(s.page) for s in self.pictures) or self.answer


@dataclass(frozen=True)
class Pending:
    """An answer of which something waits: its pieces, in order."""

    student: str
    part: Part
    pieces: tuple[AnswerCard | str, ...]

    @property
    def as_answer(self) -> ScannedAnswer:
        """Pictures of what waits, which stand for the answer until somebody has typed it."""
        said = tuple(r for piece in self.pieces if isinstance(piece, AnswerCard) for r in piece.said)
        pages = tuple(sorted({reading.page for reading in said}))
        return ScannedAnswer(self.student, *self.part, "", pages, pictures=said)


@dataclass
class Gathered:
    """Combined content of all pages."""

    answers: list[ScannedAnswer] = field(default_factory=list)
    cards: list[AnswerCard] = field(default_factory=list)
    missing: list[tuple[PrintedPaper, tuple[int, ...]]] = field(default_factory=list)
    whose: dict[str, str] = field(default_factory=dict)  #: student by code of a paper
    waits: dict[str, int] = field(default_factory=dict)  #: cards by id of a page
    unused: list[Typed] = field(default_factory=list)  #: what was typed and fits nothing that was scanned
    pending: list[Pending] = field(default_factory=list)
    #: Doubted numbers that count as they are the right answer, by id of a page.
    confirmed: dict[str, int] = field(default_factory=dict)
    #: What was drawn on, by paper, exercise and seed.
    drawn: dict[tuple[str, str, int], FieldReading] = field(default_factory=dict)

    @property
    def to_mark(self) -> list[ScannedAnswer]:
        """Answers for the marking: those of which nothing waits, and the pictures of those of which something
        does, so that no mark counts them as left out."""
        return [*self.answers, *(pending.as_answer for pending in self.pending)]


Part: TypeAlias = tuple[str, int, str]  #: exercise, seed and id


class Parts(Protocol):
    """Properties of the questions on the papers."""

    def is_open(self, part: Part) -> bool:
        """Return True if a person marks the question."""

    def is_drawn(self, part: Part) -> bool:
        """Return True if the answer is a point in millimetres on paper."""

    def joined(self, part: Part, texts: Sequence[str]) -> str:
        """Return the texts of the coordinates as one answer."""

    def is_right(self, part: Part, answer: str) -> bool:
        """Return True if an answer is right within its margin, those being right that are judged with it."""


def gather(
    pages: Iterable[Scanned], papers: Mapping[str, PrintedPaper], typed: Iterable[Typed], parts: Parts
) -> Gathered:
    """Combine pages and typed texts."""
    combined = Gathered()
    by_paper: dict[str, dict[int, dict[str, PageScan]]] = {}
    lost: dict[str, str] = {}
    for page in pages:
        if page.page.what == ANSWERS and page.page.code in papers:
            by_paper.setdefault(page.page.code, {}).setdefault(page.page.number, {})[page.id] = page.page
        elif page.page.what == LOST:
            lost[page.id] = OTHER_NAME if page.page.reason == OTHER_NAME else CODE
    decided = {page.place: page for page in typed}
    used: set[Any] = set()
    for code, paper in papers.items():
        scans = by_paper.get(code, {})
        combined.whose[code] = student = _student_of(paper, scans, decided, used, combined)
        missing = tuple(n for n in range(1, paper.pages + 1) if n not in scans)
        if missing:
            combined.missing.append((paper, missing))
        _gather_paper(combined, paper, student, scans, decided, used, parts)
    for name in sorted(lost):
        combined.cards.append(AnswerCard("", "", PAGE, 0, name, 1, 1, PAGE, lost[name], "", 0.0, (), (name,)))
    for card in combined.cards:
        for name in card.pages:
            combined.waits[name] = combined.waits.get(name, 0) + 1
    combined.unused = [page for page in decided.values() if page.place not in used]
    return combined


def _student_of(
    paper: PrintedPaper,
    scans: Mapping[int, Mapping[str, PageScan]],
    decided: Mapping[Any, Typed],
    used: set[Any],
    combined: Gathered,
) -> str:
    """Return the student of a paper; for a paper without a name, the student whom a person has typed, or else
    the code."""
    if paper.student or not scans:
        return paper.student or paper.code
    typed = decided.get((paper.code, NAME, "", "", "1"))
    if typed is not None and typed.answer.strip():
        used.add(typed.place)
        return typed.answer.strip()
    first = tuple(sorted(scans[min(scans)]))
    combined.cards.append(
        AnswerCard(paper.code, paper.code, NAME, 0, "", 1, 1, NAME, NOBODY, "", 0.0, (), first[:1])
    )
    return paper.code


def _gather_paper(
    combined: Gathered,
    paper: PrintedPaper,
    student: str,
    scans: Mapping[int, Mapping[str, PageScan]],
    decided: Mapping[Any, Typed],
    used: set[Any],
    parts: Parts,
) -> None:
    readings = _readings_of(scans)
    by_part: dict[Part, list[PrintedField]] = {}
    for printed in paper.asked:
        by_part.setdefault(printed.place[:3], []).append(printed)
    for part, fields in by_part.items():
        if not part[2]:  # paper to draw on, which is not an answer by itself
            _note_drawing(combined, paper, readings.get(fields[0].place, ()))
            continue
        settled = [
            _settle(
                printed, paper, student, readings.get(printed.place, ()), decided, used, parts.is_open(part)
            )
            for printed in fields
        ]
        if (paper.code, *part[:2]) in combined.drawn and parts.is_drawn(part):
            settled = [
                _to_click(s, printed, paper, student, readings)
                for s, printed in zip(settled, fields, strict=True)
            ]
        _add_answer(combined, student, part, _confirmed(combined, part, settled, parts), parts)


def _confirmed(
    combined: Gathered, part: Part, settled: Sequence[_Settled | AnswerCard | None], parts: Parts
) -> Sequence[_Settled | AnswerCard | None]:
    """Return the pieces of an answer as settled if some are doubted and it is probably a right answer of this
    variant: that somebody wrote a wrong one which may be read so is rarer than that a sure digit is wrong
    (docs/scans.md)."""
    doubted = [item for item in settled if isinstance(item, AnswerCard)]
    if not doubted or None in settled or not all(card.waits == DOUBTED for card in doubted):
        return settled
    right = right_readings(part, [_candidates(item) for item in settled if item is not None], parts)
    if sum(chance for _, chance in right) < LIKELY:
        return settled
    for card in doubted:
        for page in card.pages:
            combined.confirmed[page] = combined.confirmed.get(page, 0) + 1
    texts, _ = max(right, key=lambda reading: reading[1])
    return [
        _Settled(text, item.pages) if isinstance(item, AnswerCard) else item
        for text, item in zip(texts, settled, strict=True)
    ]


def _candidates(item: _Settled | AnswerCard) -> Sequence[tuple[str, float]]:
    """Return what a piece of an answer may say, with probabilities."""
    if isinstance(item, _Settled):
        return [(item.text, 1.0)]
    fields = [s.field for s in item.said if s.field.confidence == item.confidence]
    return next(
        (field.candidates for field in fields if field.candidates), [(item.candidate, item.confidence)]
    )


def right_readings(
    part: Part, candidates: Sequence[Sequence[tuple[str, float]]], parts: Parts
) -> list[tuple[tuple[str, ...], float]]:
    """Return the readings of an answer's pieces that are right, with their probabilities."""
    found = []
    for pieces in islice(product(*candidates), _READINGS):
        texts = tuple(text for text, _ in pieces)
        if parts.is_right(part, texts[0] if len(texts) == 1 else parts.joined(part, texts)):
            found.append((texts, prod(chance for _, chance in pieces)))
    return found


def _note_drawing(combined: Gathered, paper: PrintedPaper, readings: Sequence[FieldReading]) -> None:
    drawn = next((s for s in readings if s.field.waits), None)
    if drawn is not None:
        combined.drawn[paper.code, drawn.field.exercise, drawn.field.seed] = drawn


def _to_click(
    settled: _Settled | AnswerCard | None,
    printed: PrintedField,
    paper: PrintedPaper,
    student: str,
    readings: Mapping[FieldPosition, Sequence[FieldReading]],
) -> _Settled | AnswerCard | None:
    """Return a card for a blank coordinate beside a drawing, since a person may click it there; any other
    state unchanged."""
    if not isinstance(settled, _Settled) or settled.text or settled.by_hand:
        return settled
    field_readings = readings[printed.place]
    return _card(printed, paper, student, field_readings, DRAWN, "", 0.0)


def _add_answer(
    combined: Gathered,
    student: str,
    part: Part,
    settled: Sequence[_Settled | AnswerCard | None],
    parts: Parts,
) -> None:
    """Add the answer to a question if all its coordinates are known; otherwise add their cards, and list the
    answer as pending if all its pages were scanned."""
    cards = [item for item in settled if isinstance(item, AnswerCard)]
    values = [item for item in settled if isinstance(item, _Settled)]
    combined.cards += cards
    if len(cards) + len(values) < len(settled):
        return  # of its pages not all were scanned
    if cards:
        pieces = tuple(
            item if isinstance(item, AnswerCard) else item.text for item in settled if item is not None
        )
        combined.pending.append(Pending(student, part, pieces))
        return
    texts = [item.text for item in values]
    ids = tuple(sorted({name for item in values for name in item.pages}))
    combined.answers.append(
        ScannedAnswer(
            student,
            *part,
            texts[0] if len(texts) == 1 else parts.joined(part, texts),
            ids,
            any(item.by_hand for item in values),
            tuple(s for item in values for s in item.pictures),
        )
    )


def _readings_of(
    scans: Mapping[int, Mapping[str, PageScan]],
) -> dict[FieldPosition, tuple[FieldReading, ...]]:
    """Return the readings of a paper's scans by place, ordered by the ids of the scans."""
    by_position: dict[FieldPosition, list[FieldReading]] = {}
    for number in sorted(scans):
        for name in sorted(scans[number]):
            for index, scanned_field in enumerate(scans[number][name].fields):
                position = FieldPosition(
                    scanned_field.exercise, scanned_field.seed, scanned_field.part, scanned_field.coordinate
                )
                by_position.setdefault(position, []).append(FieldReading(name, scanned_field, index))
    return {position: tuple(readings) for position, readings in by_position.items()}


@dataclass(frozen=True)
class _Settled:
    text: str
    pages: tuple[str, ...]
    by_hand: bool = False
    pictures: tuple[FieldReading, ...] = ()


def _settle(
    printed: PrintedField,
    paper: PrintedPaper,
    student: str,
    readings: Sequence[FieldReading],
    decided: Mapping[Any, Typed],
    used: set[Any],
    is_open: bool,
) -> _Settled | AnswerCard | None:
    """Return the settled text of a place: the typed one, or else the reading on which all scans agree without
    doubt; otherwise a card for a person.

    None where nothing was scanned nor typed.
    """
    ids = tuple(s.page for s in readings)
    typed = _typed_at(printed.place, paper, student, decided, used)
    if typed is not None and _holds(typed, readings):
        return _Settled(typed.answer, ids, by_hand=True)
    if not readings:
        return None
    texts = {s.field.text for s in readings}
    if len(texts) == 1 and all(s.is_sure for s in readings) and typed is None:
        return _Settled(readings[0].field.text, ids)
    if is_open:
        return _Settled("", ids, pictures=tuple(s for s in readings if s.field.waits or s.field.text))
    likeliest = max(readings, key=lambda s: (s.is_sure, s.field.confidence, s.page))
    if typed is not None:
        return _card(printed, paper, student, readings, DIFFERS, typed.answer, 0.0)
    return _card(
        printed,
        paper,
        student,
        readings,
        _why(readings, texts),
        likeliest.field.text,
        likeliest.field.confidence,
    )


def _card(
    printed: PrintedField,
    paper: PrintedPaper,
    student: str,
    readings: Sequence[FieldReading],
    waits: str,
    candidate: str,
    confidence: float,
) -> AnswerCard:
    position = printed.place
    return AnswerCard(
        student,
        paper.code,
        position.exercise,
        position.seed,
        position.part,
        position.coordinate,
        printed.coordinates,
        printed.what,
        waits,
        candidate,
        confidence,
        tuple(readings),
        tuple(s.page for s in readings),
    )


def _why(readings: Sequence[FieldReading], texts: set[str]) -> str:
    """Why a place waits: its scans differ, or the first reason that one of them has."""
    if len(texts) > 1:
        return DIFFERS
    return next(s.field.waits for s in readings if s.field.waits)


def _typed_at(
    position: FieldPosition, paper: PrintedPaper, student: str, decided: Mapping[Any, Typed], used: set[Any]
) -> Typed | None:
    for name in (student, paper.code):
        key = (name, position.exercise, str(position.seed), position.part, str(position.coordinate + 1))
        if key in decided:
            used.add(key)
            return decided[key]
    return None


def _holds(typed: Typed, readings: Sequence[FieldReading]) -> bool:
    """Return True if a typed text still applies: its author saw these scans, or later ones agree with it."""
    if not typed.pages:
        return True
    seen = {s.field.text for s in readings if s.page in typed.pages and s.is_sure}
    new = [s for s in readings if s.page not in typed.pages]
    return all(s.is_sure and s.field.text in {typed.answer, *seen} for s in new)
