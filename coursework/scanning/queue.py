"""Queue of the cards that wait for a person, as a folder: ``queue.json``, and ``index.html``, a page that
needs only a browser."""

from __future__ import annotations

import base64
import hashlib
import json
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from coursework.issuing.issued import COLUMNS as ANSWER_COLUMNS
from coursework.language.words import languages, words
from coursework.parsing.scanned import picture_of
from coursework.rendering.environment import render
from coursework.rendering.html import environment_of
from coursework.rendering.keeping import in_script
from coursework.scanning.gathering import AnswerCard, Gathered, PrintedPaper
from coursework.scanning.scan_store import ScannedField
from coursework.scanning.typed import COLUMNS as TYPED_COLUMNS
from coursework.scanning.typed import NAME, PAGE
from coursework.system.tables import json_text
from coursework.system.writing import write_whole

if TYPE_CHECKING:
    from coursework.scanning.page_reading import Papers
    from coursework.scanning.parts import Joins

FOLDER = "queue"
_EMBEDDED = 32_000_000  #: bytes of pictures that the page holds in itself; more lie beside it
#: Of coordinates in a pattern: letters that nobody types.
_PLACES = "".join(chr(0xE000 + place) for place in range(256))

#: Gives the file of a field's picture, below the folder of the job.
Cut = Callable[[Path, str, ScannedField, int], str]


@dataclass(frozen=True)
class ScanQueue:
    """Cards that wait for a person, with the data to show them."""

    papers: Papers
    asked: Mapping[str, PrintedPaper]
    found: Gathered
    joins: Joins
    out: Path

    @cached_property
    def lang(self) -> str:
        """The language in which most papers were issued."""
        spoken = Counter(
            str(record.get("lang", "en")) for paper in self.papers.papers.values() for record in paper.records
        )
        return max(sorted(spoken), key=lambda code: spoken[code]) if spoken else "en"

    @cached_property
    def cards(self) -> list[AnswerCard]:
        """Pages and papers that nobody knows, then question after question, all students together; of each
        question last the numbers that are probably read right, which a person compares with their pictures at
        a glance."""
        ranks = {question: rank for rank, question in enumerate(self.papers.questions)}
        before = {PAGE: -2, NAME: -1}

        def rank(card: AnswerCard) -> int:
            return before.get(card.exercise) or ranks.get((card.exercise, card.part), len(ranks))

        return sorted(
            self.found.cards, key=lambda c: (rank(c), c.is_likely, c.student, c.seed, c.coordinate, c.part)
        )

    def group(self, card: AnswerCard) -> dict[str, Any]:
        """Return the question of a card, in every language."""
        if card.exercise in (PAGE, NAME):
            sort = "pages" if card.exercise == PAGE else "names"
            return {
                "id": sort,
                "sort": sort,
                "number": "",
                "exercise": "",
                "part": "",
                "title": {},
                "unit": "",
                "letters": [],
            }
        place = card.exercise, card.seed, card.part
        variant, part = self.joins.part_of(place)
        letters = [part.sort.from_paper([t.case], part, variant) for t in part.sort.ticks(part, variant)]
        return {
            "id": f"{card.exercise}/{card.part}",
            "sort": "question",
            "number": self.papers.questions.number(card.exercise, card.part),
            "exercise": card.exercise,
            "part": card.part,
            "title": _titles(self.papers.course[card.exercise]),
            "unit": self.joins.unit_of(place),
            "letters": letters if card.what == "ticks" else [],
        }


def _titles(exercise: Any) -> dict[str, str]:
    return {lang: exercise.title(lang) for lang in exercise.languages}


def write_queue(queue: ScanQueue, cut: Cut) -> None:
    """Write the folder of the queue: its page and its data, each whole."""
    cards = [_card_content(queue, card, cut) for card in queue.cards]
    groups: dict[str, dict[str, Any]] = {}
    for card, entry in zip(queue.cards, cards, strict=True):
        if entry["group"] not in groups:
            groups[entry["group"]] = queue.group(card)
    content = {"lang": queue.lang, "groups": list(groups.values()), "cards": cards}
    write_whole(queue.out / FOLDER / "queue.json", json_text(content).encode())
    write_whole(queue.out / FOLDER / "index.html", page(queue, content).encode())


def _card_content(queue: ScanQueue, card: AnswerCard, cut: Cut) -> dict[str, Any]:
    """Return a card for the page, with files relative to the folder of the page."""
    sort = {PAGE: "pages", NAME: "names"}.get(card.exercise, "question")
    crops = [cut(queue.out, reading.page, reading.field, reading.index) for reading in card.said]
    pages = [picture_of(name) for name in card.pages]
    return {
        "id": card.id,
        "sort": sort,
        "group": sort if sort != "question" else f"{card.exercise}/{card.part}",
        "student": card.student,
        "place": place_of_card(card),
        "what": card.what,
        "waits": card.waits,
        "candidate": card.candidate,
        "confidence": round(100 * card.confidence),
        "likely": card.is_likely,
        "part": card.part,
        "coordinate": card.coordinate + 1 if sort == "question" else 1,
        "coordinates": card.coordinates,
        "crops": [f"../{file}" for file in (crops if sort == "question" else pages)],
        "pages": [f"../{file}" for file in pages],
        "seen": " ".join(card.pages),
        "drawing": _drawing(queue, card, cut),
    }


def place_of_card(card: AnswerCard) -> list[str]:
    """Return the first columns of a line of ``typed.csv``."""
    if card.exercise == PAGE:
        return ["", PAGE, "", card.part, ""]
    if card.exercise == NAME:
        return [card.paper, NAME, "", "", ""]
    return [
        card.student,
        card.exercise,
        str(card.seed),
        card.part,
        str(card.coordinate + 1) if card.coordinates > 1 else "",
    ]


def _drawing(queue: ScanQueue, card: AnswerCard, cut: Cut) -> dict[str, Any] | None:
    """Return the paper of a drawing, for a point in millimetres that a person can click; None for other
    cards."""
    reading = queue.found.drawn.get((card.paper, card.exercise, card.seed))
    if reading is None or not queue.joins.is_drawn((card.exercise, card.seed, card.part)):
        return None
    _, _, width, height = reading.field.box
    return {
        "source": f"../{cut(queue.out, reading.page, reading.field, reading.index)}",
        "width": width,
        "height": height,
    }


# ---------------------------------------------------------------------------- page


def page(queue: ScanQueue, content: Mapping[str, Any]) -> str:
    """Return the page on which people type: it embeds its pictures, unless they are too many, and needs no
    server."""
    folder = queue.papers.course.folder
    embedded = dict(_embedded(queue.out / FOLDER, content["cards"]))
    cards = [_with_pictures(card, embedded) for card in content["cards"]]
    key = hashlib.sha256(json.dumps([entry["place"] for entry in content["cards"]]).encode()).hexdigest()[:16]
    data = {
        **content,
        "cards": cards,
        "key": f"coursework scan {key}",
        "words": {lang: words(lang, "scan") for lang in languages()},
        "typed_columns": TYPED_COLUMNS,
        "answer_columns": ANSWER_COLUMNS,
        "answers": [[a.student, a.exercise, str(a.seed), a.part, a.text] for a in queue.found.answers],
        "joins": list(_joins(queue)),
        "places": list(_PLACES),
        "papers": list(_papers(queue)) if any(card["sort"] == "pages" for card in cards) else [],
    }
    names = {
        "lang": queue.lang,
        "languages": languages(),
        "said": words(queue.lang, "scan"),
        "data": in_script(data),
        "paper": "a4",
    }
    return render(environment_of(folder.template_folders, queue.lang), "scan/queue.html.j2", names)


def _embedded(folder: Path, cards: list[dict[str, Any]]) -> Iterator[tuple[str, str]]:
    """Yield the pictures to embed in the page, with their files; pictures of whole pages remain separate
    files."""
    files = dict.fromkeys(
        file
        for card in cards
        for file in (*card["crops"], *([card["drawing"]["source"]] if card["drawing"] else ()))
    )
    pictures = {file: (folder / file).read_bytes() for file in files}
    if sum(map(len, pictures.values())) > _EMBEDDED:
        return
    for file, data in pictures.items():
        kind = "png" if file.endswith(".png") else "jpeg"
        yield file, f"data:image/{kind};base64,{base64.b64encode(data).decode()}"


def _with_pictures(card: Mapping[str, Any], embedded: Mapping[str, str]) -> dict[str, Any]:
    drawing = card["drawing"]
    source = {**drawing, "source": embedded.get(drawing["source"], drawing["source"])} if drawing else None
    return {**card, "crops": [embedded.get(file, file) for file in card["crops"]], "drawing": source}


def _papers(queue: ScanQueue) -> Iterator[dict[str, Any]]:
    """Yield the papers to which a page may belong."""
    sizes = {queue.papers.papers[code].size for code in queue.asked} or {"a4"}
    several = len({paper.records[0]["exercise"] for paper in queue.papers.papers.values()}) > 1
    for code, paper in queue.papers.papers.items():
        if paper.size in sizes:
            title = (
                _titles(queue.papers.course[paper.records[0]["exercise"]])
                if several and not paper.assignment
                else {}
            )
            yield {"code": code, "student": paper.student, "pages": len(queue.papers[code]), "title": title}


def _joins(queue: ScanQueue) -> Iterator[dict[str, Any]]:
    """Yield the rules by which the page composes pending answers: a pattern with a letter for each
    coordinate, and another in which the printed unit applies to all."""
    for pending in queue.found.pending:
        exercise, seed, part = pending.part
        places = list(_PLACES[: len(pending.pieces)])
        unit = f" {queue.joins.unit_of(pending.part)}".rstrip()
        patterns = [places[0]] * 2
        if len(places) > 1:
            patterns = [
                queue.joins.joined(pending.part, texts) for texts in (places, [p + unit for p in places])
            ]
        yield {
            "row": [pending.student, exercise, str(seed), part],
            "cards": [piece.id if isinstance(piece, AnswerCard) else None for piece in pending.pieces],
            "texts": [piece if isinstance(piece, str) else "" for piece in pending.pieces],
            "patterns": patterns,
            "unit": unit if len(places) > 1 else "",
            "waiting": pending.as_answer.text,
        }
