"""Answer pages filled in by hand, printed and scanned in simulation, and read: what is right, wrong, and left to a person.

python benchmarks/scans.py FOLDER [PAGES]      # 10 000 unless told; goes on where it stopped
python benchmarks/scans.py FOLDER table        # of what was read so far
python benchmarks/scans.py FOLDER wrong        # what was read wrong

FOLDER keeps the printed sheets and a line a page, ``read.jsonl``. The handwriting is MNIST's test set (the bank of the
tests, which trained nothing) and, every fifth page, scikit-learn's digits, of other writers, 8 by 8 pixels and so blurred.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Iterator
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

from coursework.scanning.digits import read_digits  # noqa: E402
from coursework.scanning.pages import read_page  # noqa: E402
from coursework.scanning.pictures import PageImage  # noqa: E402
from coursework.sheets.answer_pages import AnswerPage, answer_pages, paper_code  # noqa: E402

#: Exercises whose answer pages are filled in: numbers, choices, several choices, vectors, words, drawings.
EXERCISES = (
    "two_circles", "joint_twist", "slider_extras", "four_bar_positions", "vocabulary", "ball_reducer", "slotted_mechanism",
    "crank_shaper_drawn",
)  # fmt: skip
SIZES = ("a4", "letter")


def sheets(folder: Path) -> list[tuple[AnswerPage, Path]]:
    """The answer pages of the exercises, as printed; drawn once."""
    from coursework import open_course
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


@cache
def bank(which: int) -> simulated.Bank:
    if which == 0:
        with np.load(TESTS / "handwritten_digits.npz") as kept:
            return simulated.handwriting(kept["digits"], kept["labels"])
    from sklearn.datasets import load_digits

    digits = load_digits()
    large = [cv2.resize(np.float32(d), (24, 24), interpolation=cv2.INTER_CUBIC) for d in digits.images]
    return simulated.handwriting(np.clip(large, 0, None), digits.target)


@cache
def printed(file: str) -> np.ndarray:
    return cv2.imread(file, cv2.IMREAD_GRAYSCALE)


def one(index: int, page: AnswerPage, file: str) -> dict[str, Any]:
    """A page filled in, scanned and read; what became of each of its answers."""
    cv2.setNumThreads(1)
    rng = np.random.default_rng([23, index])
    kind = list(simulated.KINDS)[index // 2 % len(simulated.KINDS)]
    hand = simulated.a_hand(rng, bank(int(index % 5 == 4)))
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
        "found": read.found,
        "seconds": seconds,
    }
    counts: Counter[str] = Counter()
    row["wrong"] = []
    for said, meant in zip(read.fields, wrote, strict=False):
        counts[_became(said, meant)] += 1
        if said.waits and not meant.waits:
            counts[f"why {said.waits}"] += 1
        elif _became(said, meant) == "wrong":
            place = said.field.part, said.field.coordinate
            row["wrong"].append((*place, said.text, meant.text, meant.how, said.confidence))
        counts[f"boxes {_became(said, meant)}"] += len(simulated.boxes_of(said.field))
    return row | {"counts": counts}


def _became(said: Any, meant: simulated.Wrote) -> str:
    if said.waits:
        return "must wait" if meant.waits else "waits"
    return "wrong" if meant.waits or said.text != meant.text else "right"


def kept(folder: Path) -> Iterator[dict[str, Any]]:
    path = folder / "read.jsonl"
    if path.exists():
        yield from (json.loads(line) for line in path.read_text("utf-8").splitlines())


def run(folder: Path, count: int) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    pages = sheets(folder)
    done = {row["index"] for row in kept(folder)}
    rest = [k for k in range(count) if k not in done]
    with ProcessPoolExecutor(os.cpu_count()) as pool, (folder / "read.jsonl").open("a") as out:
        chosen = [pages[np.random.default_rng([7, k]).integers(len(pages))] for k in rest]
        for row in pool.map(one, rest, [p for p, _ in chosen], [str(f) for _, f in chosen], chunksize=4):
            out.write(json.dumps(row) + "\n")
            out.flush()


def table(folder: Path) -> None:
    rows = sorted(kept(folder), key=lambda row: row["index"])
    by: dict[str, list[dict[str, Any]]] = defaultdict(list)
    for row in rows:
        by[row["kind"]].append(row)
    print(
        "| scanned as | pages | not found | answers | read right | read wrong | to a person, as they must | to a person besides | s a page |"
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
            f"| {name} | {len(those):,} | {lost} | {asked:,} | {total['right']:,} | {total['wrong']} | {' | '.join(shares)} | {seconds:.2f} |"
        )
    why: Counter[str] = Counter()
    for row in rows:
        why.update({k.removeprefix("why "): n for k, n in row["counts"].items() if k.startswith("why ")})
    print("\nTo a person besides, by reason:", ", ".join(f"{k} {n}" for k, n in why.most_common()))


def wrong(folder: Path) -> None:
    for row in kept(folder):
        for each in row["wrong"]:
            print(row["index"], row["kind"], row["pen"], each)
        if row["found"] != "answers":
            print(row["index"], row["kind"], row["found"])


def main() -> None:
    folder, what = Path(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else "10000"
    if what.isdigit():
        run(folder, int(what))
    (wrong if what == "wrong" else table)(folder)


if __name__ == "__main__":
    main()
