"""Answer pages filled in by hand, printed and scanned in simulation, and read: what is right, wrong, and left
to a person.

python benchmarks/scans.py FOLDER [PAGES] [KIND]   # 10 000 unless told, of one kind or all; goes on
python benchmarks/scans.py FOLDER table            # of what was read so far
python benchmarks/scans.py FOLDER doubted          # of doubted numbers: what is taken if they are right
python benchmarks/scans.py FOLDER wrong            # what was read wrong

Two thirds of the answers are right ones of a variant, rounded; of the wrong ones most are near a right one: a
digit changed or exchanged, another sign, a point elsewhere, a few per cent too many. FOLDER keeps the printed
sheets and a line a page, ``read.jsonl``. Each page is by one writer. The collection changes every thirty
pages: `handwriting.py` lists them and reads them from FOLDER; nothing was trained with them. Without
collections, the 400 MNIST digits of the tests are used, of mixed writers.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import cv2
import numpy as np

TESTS = Path(__file__).parents[1] / "tests"
sys.path.insert(0, str(TESTS))

import scanned_pages as simulated  # noqa: E402
from handwriting import Digits, bitmaps, formulas, inked, mnist, paths  # noqa: E402

from coursework import open_course  # noqa: E402
from coursework.marking.marking import is_right_alone  # noqa: E402
from coursework.scanning.digits import LIKELY, read_digits  # noqa: E402
from coursework.scanning.gathering import right_readings  # noqa: E402
from coursework.scanning.pages import read_page  # noqa: E402
from coursework.scanning.parts import joined_answer  # noqa: E402
from coursework.scanning.pictures import PageImage  # noqa: E402
from coursework.sheets.answer_pages import AnswerField, AnswerPage, answer_pages, paper_code  # noqa: E402

#: Exercises whose answer pages are filled in: numbers, choices, several choices, vectors, words, drawings.
EXERCISES = (
    "two_circles",
    "joint_twist",
    "slider_extras",
    "four_bar_positions",
    "vocabulary",
    "ball_reducer",
    "slotted_mechanism",
    "crank_shaper_drawn",
)
SIZES = ("a4", "letter")


def sheets(folder: Path) -> list[tuple[AnswerPage, Path]]:
    """The answer pages of the exercises, as printed; drawn once."""
    from coursework.rendering.renderer import builtin_renderer

    course, found = open_course(), []
    for place, name in enumerate(EXERCISES):
        lang, size = ("fr", "en")[place % 2], SIZES[place // 2 % 2]
        variant = course[name].variant(1, lang)
        pages = answer_pages([variant], lang, size, paper_code("", "", 1, [variant.record], size))
        files = [folder / f"{name}-{page.number}.png" for page in pages]
        if not all(file.exists() for file in files):
            sheet = replace(variant.handout(""), answer_pages=pages)
            made = builtin_renderer().on(size).pdf(sheet)
            for page, file in zip(pages, files, strict=True):
                cv2.imwrite(str(file), simulated.sheet_of_pdf(made, page.number - 1 - len(pages)))
        found += zip(pages, files, strict=True)
    return found


#: Writers whom no training saw, and how their digits are read.
HANDS = {
    "American": lambda folder: mnist(folder, "t10k"),
    "Turkish": lambda folder: paths(folder, "tes", odd=True),
    "French": formulas,
    "Turkish, stretched": lambda folder: bitmaps(folder, "windep"),
}


def hand_of(index: int) -> str:
    return list(HANDS)[index // 30 % len(HANDS)]


@cache
def collection(folder: Path, hand: str) -> Digits:
    if not (folder / "t10k-images-idx3-ubyte").exists():
        with np.load(TESTS / "handwritten_digits.npz") as kept:
            return Digits(kept["digits"], kept["labels"])
    return HANDS[hand](folder)


def bank(folder: Path, hand: str, rng: np.random.Generator) -> simulated.Bank:
    """Return the digits of one writer of a collection. If that writer runs out, digits of others follow; no
    picture is used twice, since a digit that somebody writes again looks different."""
    digits = collection(folder, hand)
    writer = rng.choice(np.unique(digits.writers)) if digits.writers is not None else None
    order = rng.permutation(len(digits.labels))
    if writer is not None:
        order = order[np.argsort(digits.writers[order] != writer, kind="stable")]
    broad = rng.uniform(5, 11)
    left = {digit: iter(order[digits.labels[order] == digit].tolist()) for digit in range(10)}

    def drawn(digit: int, rng: np.random.Generator) -> np.ndarray:
        picture = digits.pictures[next(left[digit])]
        if isinstance(picture, np.ndarray):
            return simulated.handwriting(picture[None], np.array([digit]))(digit, rng)
        ink = inked(picture, 110, broad) / 255
        rows, columns = np.flatnonzero(ink.max(1) > 0.2), np.flatnonzero(ink.max(0) > 0.2)
        return ink[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]

    return drawn


@cache
def printed(file: str) -> np.ndarray:
    return cv2.imread(file, cv2.IMREAD_GRAYSCALE)


RIGHT = 2 / 3  #: share of the numbers that are right answers
VARIANTS = 60  #: of which answers are written; all have the pages of the first

course = cache(open_course)


@cache
def variant_of(exercise: str, seed: int) -> Any:
    return course()[exercise].variant(seed, "en")


class Student:
    """Somebody who writes right and wrong numbers of a variant; an answer of several pieces is right or wrong
    as a whole."""

    def __init__(self, page: AnswerPage, rng: np.random.Generator):
        exercise = page.fields[0].exercise
        self.rng, self.variant = rng, variant_of(exercise, int(rng.integers(1, VARIANTS + 1)))
        self.units = {field.part: field.unit_text for field in page.fields if field.unit_text}
        self.parts = {part.id: part for part in self.variant.parts}
        self.knows = {name: rng.random() < RIGHT for name in self.parts}

    def value(self, field: AnswerField) -> float | None:
        """The right number of a field."""
        part = self.parts.get(field.part)
        if part is None:
            return None
        try:
            pieces = np.asarray(self.variant.key.reference[part.quantity], float).ravel()
        except (KeyError, TypeError, ValueError):
            return None
        is_read = len(pieces) == field.coordinates and np.isfinite(pieces).all()
        return float(pieces[field.coordinate]) if is_read else None

    def is_right(self, name: str, answer: str) -> bool:
        return is_right_alone(self.variant, self.parts[name], answer)

    def joined(self, name: str, texts: Sequence[str]) -> str:
        return joined_answer(self.variant, self.parts[name], texts, self.units.get(name, ""))

    def answer(self, field: AnswerField) -> str:
        value = self.value(field)
        if value is None:
            return ""
        text = self._fitting(field, value)
        if not text or self.knows[field.part]:
            return text
        return self._fitting(field, float(self._spoilt(text)))

    def _fitting(self, field: AnswerField, value: float) -> str:
        """A number with three to five figures, if it fits the boxes."""
        figures = int(self.rng.integers(3, 6))
        places = max(0, figures - 1 - int(np.floor(np.log10(abs(value))))) if value else 0
        text = f"{value:.{min(places, len(field.decimals))}f}"
        whole = text.lstrip("-").partition(".")[0]
        return text if len(whole) <= len(field.digits) and (field.sign or value >= 0) else ""

    def _spoilt(self, text: str) -> str:
        draw = self.rng.random()
        places = [k for k, sign in enumerate(text) if sign.isdigit()]
        if draw < 0.4:  # one digit is another
            k = int(self.rng.choice(places))
            return f"{text[:k]}{(int(text[k]) + int(self.rng.integers(1, 10))) % 10}{text[k + 1 :]}"
        if draw < 0.5 and len(places) > 1:  # two neighbours are exchanged
            k, other = places[-2:]
            figures = list(text)
            figures[k], figures[other] = figures[other], figures[k]
            return "".join(figures)
        factor = self.rng.choice(
            [
                -1,
                2,
                0.5,
                10,
                0.1,
                np.pi / 180,
                float(self.rng.uniform(0.9, 1.1)),
                float(self.rng.uniform(0.1, 10)),
            ]
        )
        return str(float(text) * factor)


def one(folder: Path, index: int, page: AnswerPage, file: str, only: str = "") -> dict[str, Any]:
    """A page filled in, scanned and read; what became of each of its answers."""
    cv2.setNumThreads(1)
    rng = np.random.default_rng([23, index])
    kind = only or list(simulated.KINDS)[index // 2 % len(simulated.KINDS)]
    student = Student(page, np.random.default_rng([29, index]))
    hand = simulated.a_hand(rng, bank(folder, hand_of(index), np.random.default_rng([37, index])))
    hand.answers = student.answer
    filled, wrote = simulated.filled_in(printed(file), page, hand, odd=0.1)
    scan = simulated.KINDS[kind](rng)
    picture = simulated.scanned(filled, scan, rng)
    start = time.perf_counter()
    read = read_page(PageImage(file, 1, picture), {page.code_text.split()[1]: (page,)}, read_digits)
    seconds = time.perf_counter() - start
    row: dict[str, Any] = {
        "index": index,
        "kind": kind,
        "pen": hand.pen,
        "writers": hand_of(index),
        "found": read.found,
        "seconds": seconds,
    }
    counts: Counter[str] = Counter()
    row["wrong"], row["doubted"] = [], []
    answers: dict[str, list[tuple[Any, simulated.Wrote]]] = defaultdict(list)
    for said, meant in zip(read.fields, wrote, strict=False):
        counts[_became(said, meant)] += 1
        if said.waits and not meant.waits:
            counts[f"why {said.waits}"] += 1
        elif _became(said, meant) == "wrong":
            place = said.field.part, said.field.coordinate
            row["wrong"].append((*place, said.text, meant.text, meant.how, said.confidence))
        counts[f"boxes {_became(said, meant)}"] += len(simulated.boxes_of(said.field))
        if student.value(said.field) is not None:
            counts[f"numbers {_became(said, meant)}"] += 1
            answers[said.field.part].append((said, meant))
    for part, pieces in answers.items():
        row["doubted"] += _doubts(student, part, pieces)
    return row | {"counts": counts}


def _doubts(
    student: Student, part: str, pieces: Sequence[tuple[Any, simulated.Wrote]]
) -> Iterator[tuple[float, bool, bool]]:
    """Of each doubted piece of an answer: the probability that the answer is right, whether the piece is what
    was written, and whether what was written is right."""
    if any(said.waits not in ("", "doubted") or meant.waits for said, meant in pieces):
        return
    right = right_readings(part, [said.candidates or [(said.text, 1.0)] for said, _ in pieces], student)
    texts = [meant.text for _, meant in pieces]
    is_right = student.is_right(part, texts[0] if len(texts) == 1 else student.joined(part, texts))
    chance = sum(chance for _, chance in right)
    for said, meant in pieces:
        if said.waits:
            yield chance, said.text == meant.text, is_right


def _became(said: Any, meant: simulated.Wrote) -> str:
    if said.waits:
        return "must wait" if meant.waits else "waits"
    return "wrong" if meant.waits or said.text != meant.text else "right"


def kept(folder: Path) -> Iterator[dict[str, Any]]:
    path = folder / "read.jsonl"
    if path.exists():
        yield from (json.loads(line) for line in path.read_text("utf-8").splitlines())


def run(folder: Path, count: int, kind: str) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    pages = sheets(folder)
    done = {row["index"] for row in kept(folder)}
    rest = [k for k in range(count) if k not in done]
    with ProcessPoolExecutor(os.cpu_count()) as pool, (folder / "read.jsonl").open("a") as out:
        chosen = [pages[np.random.default_rng([7, k]).integers(len(pages))] for k in rest]
        for row in pool.map(
            one,
            [folder] * len(rest),
            rest,
            [p for p, _ in chosen],
            [str(f) for _, f in chosen],
            [kind] * len(rest),
            chunksize=4,
        ):
            out.write(json.dumps(row) + "\n")
            out.flush()


def table(folder: Path) -> None:
    rows = sorted(kept(folder), key=lambda row: row["index"])
    by: dict[str, list[dict[str, Any]]] = defaultdict(list)
    for row in rows:
        by[row["kind"]].append(row)
    print(
        "| scanned as | pages | not found | answers | read right | read wrong | to a person, as they "
        "must | to a person besides | s a page |"
    )
    print("|---|--:|--:|--:|--:|--:|--:|--:|--:|")
    for name, those in [*by.items(), ("all", rows)]:
        total: Counter[str] = Counter()
        for row in those:
            total.update(row["counts"])
        asked = sum(total[k] for k in ("right", "wrong", "must wait", "waits"))
        lost = sum(row["found"] != "answers" for row in those)
        shares = [f"{total[k] / max(asked, 1):.1%}" for k in ("must wait", "waits")]
        seconds = float(np.median([row["seconds"] for row in those]))
        print(
            f"| {name} | {len(those):,} | {lost} | {asked:,} | {total['right']:,} | {total['wrong']} | "
            f"{' | '.join(shares)} | {seconds:.2f} |"
        )
    why: Counter[str] = Counter()
    for row in rows:
        why.update({k.removeprefix("why "): n for k, n in row["counts"].items() if k.startswith("why ")})
    print("\nTo a person besides, by reason:", ", ".join(f"{k} {n}" for k, n in why.most_common()))


def doubted(folder: Path) -> None:
    """What a person looks at after right answers are taken, of each kind of scan and of each collection."""
    by: dict[str, list[dict[str, Any]]] = defaultdict(list)
    for row in kept(folder):
        for name in (row["kind"], row["writers"], "all"):
            by[name].append(row)
    print(
        "| pages | places | clean | read wrong | to a person besides | doubted | right ones | taken | though "
        "something else was wrong | left of the clean ones |\n|---|" + "--:|" * 9
    )
    for name, rows in by.items():
        total: Counter[str] = Counter()
        for row in rows:
            total.update(row["counts"])
        clean = sum(total[k] for k in ("right", "wrong", "waits"))
        cases = [case for row in rows for case in row["doubted"]]
        taken = [case for case in cases if case[0] >= LIKELY]
        left = (total["waits"] - len(taken)) / max(clean, 1)
        print(
            f"| {name}, {len(rows)} | {clean + total['must wait']} | {clean} | {total['wrong']} | "
            f"{total['waits'] / max(clean, 1):.1%} | {len(cases)} | {sum(case[2] for case in cases)} | "
            f"{len(taken)} | {sum(not case[2] for case in taken)} | {left:.1%} |"
        )


def wrong(folder: Path) -> None:
    for row in kept(folder):
        for each in row["wrong"]:
            print(row["index"], row["kind"], row["pen"], each)
        if row["found"] != "answers":
            print(row["index"], row["kind"], row["found"])


def main(folder: str, what: str = "10000", kind: str = "") -> None:
    if what.isdigit():
        run(Path(folder), int(what), kind)
    {"wrong": wrong, "doubted": doubted}.get(what, table)(Path(folder))


if __name__ == "__main__":
    main(*sys.argv[1:4])
