"""A small class whose papers were filled in and scanned: what is written is known, and drawn from the layout
alone."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from scanned_pages import Bank, Hand, plain_sheet

from coursework.api import open_course
from coursework.issuing.answer_papers import answer_papers
from coursework.issuing.issued import issued_content
from coursework.issuing.issuing import issue
from coursework.issuing.roster import Student
from coursework.parsing.scanned import names_pictures
from coursework.scanning.page_reading import Papers
from coursework.scanning.pages import FieldRead, PageRead
from coursework.scanning.pictures import PageImage
from coursework.sheets.answer_pages import AnswerField, AnswerPage
from coursework.system.tables import as_written

#: What somebody writes, by part: a number as digits (a tuple of them for coordinates), the letters of boxes,
#: or ``~`` for a scrawl.
Answers = Mapping[str, str | tuple[str, ...]]


@dataclass
class ScannedClass:
    """What was issued, and the sheets to fill in."""

    folder: Path
    names: tuple[str, ...]
    exercise: str
    parts: tuple[str, ...] | None = None

    def __post_init__(self) -> None:
        self.course = open_course()
        students = [Student(name) for name in self.names]
        issues = issue(
            self.course,
            [self.exercise],
            first_seed=5,
            count=1,
            langs=["en"],
            roster=students,
            parts=self.parts,
        )
        self.content = issued_content(issues)
        self.issued = self.folder / "issued.json"
        self.issued.write_text(json.dumps(self.content), "utf-8")
        papers = answer_papers(self.content)
        self.papers = {p.student: p for p in papers.values() if p.size == "a4"}

    def pages(self, student: str) -> tuple[AnswerPage, ...]:
        return self.papers[student].pages(self.course)

    def variant(self, student: str):
        return self.papers[student].variants(self.course)[0]

    def told(self, student: str, number: int, answers: Answers, seed: int = 1) -> np.ndarray:
        """A picture that tells :func:`read_told` what is written on an answer page, in place of one of
        paper."""
        said = {"code": self.pages(student)[number - 1].code_text, "answers": answers, "seed": seed}
        return as_picture(json.dumps(said).encode())

    def filled(self, student: str, number: int, answers: Answers, seed: int = 1) -> np.ndarray:
        """An answer page, filled in; grey, 200 dots an inch."""
        page = self.pages(student)[number - 1]
        sheet = plain_sheet(page)
        hand = Hand(jitter=0.2, rng=np.random.default_rng(seed))
        hand.begin(sheet)
        for field in page.fields:
            told = answers.get(field.part, "")
            write(hand, field, told if isinstance(told, str) else told[field.coordinate])
        grey = cv2.cvtColor(hand.finish(sheet), cv2.COLOR_BGR2GRAY)
        return cv2.resize(grey, None, fx=2 / 3, fy=2 / 3, interpolation=cv2.INTER_AREA)


_WIDE = 64


def as_picture(data: bytes) -> np.ndarray:
    """Bytes as the dots of a small picture."""
    high = max(40, -(-len(data) // _WIDE))
    return np.frombuffer(data.ljust(high * _WIDE, b"\0"), np.uint8).reshape(high, _WIDE)


def read_told(picture: PageImage, papers: Papers, reader: object, least: float) -> PageRead:
    """Stands for the reading of pages where what they say is told: ``~`` is what a person must look at, ``≈``
    a number that is probably read right."""
    try:
        said = json.loads(picture.grey.tobytes().rstrip(b"\0"))
        _, code, number = said["code"].split(" ")
    except (ValueError, KeyError, UnicodeDecodeError):
        return PageRead(picture.file, picture.page, "no code", picture.grey)
    pages = papers.get(code, ())
    if not pages:
        return PageRead(picture.file, picture.page, "other assignment", picture.grey, said["code"])
    if number.startswith("0/"):
        return PageRead(picture.file, picture.page, "statement", picture.grey, said["code"], pages[0])
    page = pages[int(number.partition("/")[0]) - 1]
    fields = tuple(_field_told(field, said["answers"].get(field.part, "")) for field in page.fields)
    return PageRead(
        picture.file,
        picture.page,
        "answers",
        np.full((2970, 2100), 250, np.uint8),
        said["code"],
        page,
        fields,
    )


def _field_told(field: AnswerField, told: str | list[str]) -> FieldRead:
    text = told if isinstance(told, str) else told[field.coordinate]
    if text.startswith("~"):
        return FieldRead(field, text[1:], 0.5, "free", crop=np.full((90, 900), 200, np.uint8))
    if text.startswith("≈"):
        likely = text[1:]
        return FieldRead(
            field, likely, 0.9, "doubted", (), np.full((90, 900), 220, np.uint8), ((likely, 0.9),)
        )
    if field.what == "ticks":
        cases = tuple(field.ticks["abcdefghijklm".index(letter)][0] for letter in text.split(", ") if letter)
        return FieldRead(field, ", ".join(cases), 1.0, cases=cases)
    return FieldRead(field, text, 1.0)


def write(hand: Hand, field: AnswerField, told: str) -> None:
    """Write something into a field."""
    if not told:
        return
    if told == "~":
        hand.scribble(field.free or field.whole)
    elif field.what == "ticks":
        for letter in told.split(", "):
            hand.cross(field.ticks["abcdefghijklm".index(letter)][1])
    elif field.what == "number":
        _number(hand, field, told)
    elif field.what == "drawing":
        points = [tuple(map(float, one.split(","))) for one in told.split()]
        box = field.whole
        at = [(box.x + x, box.y + box.height - y) for x, y in points]
        hand.stroke(at)
    else:
        hand.scribble(field.whole)


def _number(hand: Hand, field: AnswerField, told: str) -> None:
    number, _, unit = told.partition(" ")
    if number.startswith("-"):
        hand.minus(field.sign)
    whole, _, behind = number.removeprefix("-").partition(".")
    for box, digit in zip((*field.digits[-len(whole) :], *field.decimals), whole + behind, strict=False):
        hand.digit(box, int(digit))
    if unit and field.unit is not None:
        hand.cross(field.unit)


def save(path: Path, *sheets: np.ndarray) -> Path:
    """Pages as one file: TIFF of several pages, PNG, or a PDF."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if path.suffix == ".pdf":
        path.write_bytes(as_pdf(sheets))
    elif len(sheets) == 1:
        assert cv2.imwrite(str(path), sheets[0])
    else:
        assert cv2.imwritemulti(str(path), list(sheets))
    return path


def as_pdf(sheets) -> bytes:
    """A PDF of pictures, 210 mm wide."""
    import pypdfium2

    document = pypdfium2.PdfDocument.new()
    for sheet in sheets:
        image = pypdfium2.PdfImage.new(document)
        image.load_jpeg(
            io.BytesIO(cv2.imencode(".jpg", sheet, [cv2.IMWRITE_JPEG_QUALITY, 90])[1].tobytes()), inline=True
        )
        wide = 210 / 25.4 * 72
        high = wide * sheet.shape[0] / sheet.shape[1]
        image.set_matrix(pypdfium2.PdfMatrix().scale(wide, high))
        page = document.new_page(wide, high)
        page.insert_obj(image)
        page.gen_content()
    made = io.BytesIO()
    document.save(made)
    return made.getvalue()


def handwritten() -> Bank:
    """Digits that people wrote."""
    with np.load(Path(__file__).parent / "handwritten_digits.npz") as stored:
        digits, labels = stored["digits"].astype(np.float32) / 255, stored["labels"]

    def drawn(digit: int, rng: np.random.Generator) -> np.ndarray:
        ink = digits[rng.choice(np.flatnonzero(labels == digit))]
        ys, xs = np.flatnonzero(ink.max(axis=1) > 0.3), np.flatnonzero(ink.max(axis=0) > 0.3)
        return ink[ys[0] : ys[-1] + 1, xs[0] : xs[-1] + 1]

    return drawn


# ------------------------------------------------------------------ what a job wrote


def rows(path: Path) -> list[dict[str, str]]:
    text = path.read_text("utf-8-sig")
    found = csv.DictReader(io.StringIO(text, newline=""))
    return [{k: as_written(v) for k, v in row.items()} for row in found]


def bytes_of(folder: Path) -> dict[str, bytes]:
    files = (p for p in sorted(folder.rglob("*")) if p.is_file())
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in files}


def answered(folder: Path, student: str) -> dict[str, str]:
    """What is known of somebody's answers, without those that wait as pictures."""
    own = [row for row in rows(folder / "answers.csv") if row["student"] == student]
    return {row["part"]: row["answer"] for row in own if not names_pictures(row["answer"])}


def queued(folder: Path) -> list[dict]:
    return json.loads((folder / "queue" / "queue.json").read_text("utf-8"))["cards"]
