"""The same crosses on sheets of this package, of Auto Multiple Choice and of R/exams (NOPS), scanned alike
and read by each.

    python benchmarks/scan_rivals.py FOLDER [--pages 24] [--root ROOT]

Every page has 14 questions of five boxes. Which are crossed, by which pen and how shakily, and how the page
is scanned depends on the page and on the kind of disturbance alone, so that all three see the same. Needs the
programs ``auto-multiple-choice`` (1.6) and ``pdflatex``, and ``Rscript`` with the packages exams (2.4) and
png: on this machine, or in a system of their own under ROOT, entered by chroot; then FOLDER lies in ROOT.
What is not there is left out and said.

Auto Multiple Choice takes a box as ticked above a darkness that its users choose: 0.15 here, for crosses (its
default 0.5 is for boxes filled wholly). NOPS has its defaults. Neither tells of a box that it is unsure; both
may fail at a page.
"""

from __future__ import annotations

import argparse
import shutil
import sqlite3
import subprocess
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

import scanned_pages as simulated
from scanned_pages import Scan

from coursework.scanning.pages import read_page
from coursework.scanning.pictures import PageImage
from coursework.sheets.answer_pages import AnswerField, AnswerPage, Box

QUESTIONS, CASES = 14, "ABCDE"
DARK = 0.15

#: What a reader says of a page: of each question, of each box, whether it is ticked; None where it is told
#: unsure.
Said = list[list[bool | None]]
Command = Callable[[Path, list[str]], str]

KINDS: dict[str, Callable[[np.random.Generator], Scan]] = {
    "straight, 300 dpi": lambda r: Scan(dpi=300),
    "upside down": lambda r: Scan(dpi=300, turn=2),
    "a quarter turned": lambda r: Scan(dpi=300, turn=1),
    "skewed 2 degrees": lambda r: Scan(dpi=300, skew=2 * r.choice([-1, 1])),
    "skewed 5 degrees": lambda r: Scan(dpi=300, skew=5 * r.choice([-1, 1])),
    "skewed 10 degrees": lambda r: Scan(dpi=300, skew=10 * r.choice([-1, 1])),
    "150 dpi, JPEG": lambda r: Scan(dpi=150, noise=4, blur=0.15, jpeg=60, skew=r.uniform(-1, 1)),
    "black and white": lambda r: Scan(dpi=300, bilevel="threshold", noise=4, dust=20, skew=r.uniform(-1, 1)),
    "coffee": lambda r: Scan(dpi=300, stains=2, noise=3, skew=r.uniform(-1, 1)),
    "edge of a shadow": lambda r: Scan(dpi=300, edge=0.4, noise=4, skew=r.uniform(-1, 1)),
    "photograph": simulated.KINDS["photograph"],
}


def crossed(page: int) -> np.ndarray:
    """Which boxes are to be crossed on a page."""
    return np.random.default_rng([7, page]).random((QUESTIONS, len(CASES))) < 0.3


def picture(sheet: np.ndarray, boxes: list[list[Box]], page: int, kind: str) -> np.ndarray:
    """A page with its crosses, scanned."""
    hand = simulated.a_hand(np.random.default_rng([8, page]))
    hand.begin(sheet)
    for row, wanted in zip(boxes, crossed(page), strict=True):
        for box, is_wanted in zip(row, wanted, strict=True):
            if is_wanted:
                hand.cross(box)
    draw = np.random.default_rng([9, page, list(KINDS).index(kind)])
    return simulated.scanned(hand.finish(sheet), KINDS[kind](draw), draw)


# ------------------------------------------------------------------- this package


class Ours:
    """Answer pages with boxes to tick, as this package lays them out and reads them."""

    name = "this package"

    def __init__(self, pages: int) -> None:
        self.pages = {page: _page(page) for page in range(pages)}

    def sheet(self, page: int) -> tuple[np.ndarray, list[list[Box]]]:
        ours = self.pages[page]
        return simulated.plain_sheet(ours), [[box for _, box in field.ticks] for field in ours.fields]

    def read(self, pictures: dict[int, np.ndarray]) -> dict[int, Said]:
        papers = {page.code_text.split()[1]: (page,) for page in self.pages.values()}
        numbers = {page.code_text: number for number, page in self.pages.items()}
        said = {}
        for grey in pictures.values():
            read = read_page(PageImage("", 1, grey), papers, _no_digits)
            if read.found == "answers":
                said[numbers[read.code]] = [_ours(one) for one in read.fields]
        return said


def _ours(read) -> list[bool | None]:
    return [None if read.waits else case in read.cases for case, _ in read.field.ticks]


def _no_digits(cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return np.full(len(cells), -1), np.ones(len(cells))


def _page(page: int) -> AnswerPage:
    code = "".join("ABCDEFGHIJKLMNOPQRSTUVWXYZ234567"[(page >> 5 * k) % 32] for k in range(13))
    fields = tuple(
        AnswerField(
            0,
            "rivals",
            1,
            f"q{k}",
            0,
            1,
            "ticks",
            whole=Box(28, 46 + 14.0 * k, 90, 8),
            several=True,
            ticks=tuple((case, Box(42 + 12.0 * c, 47 + 14.0 * k, 5, 5)) for c, case in enumerate(CASES)),
        )
        for k in range(QUESTIONS)
    )
    marks = ((11.0, 11.0), (199.0, 11.0), (199.0, 286.0), (11.0, 286.0))
    return AnswerPage(
        1,
        1,
        f"CW1 {code} 1/1",
        210.0,
        297.0,
        marks,
        Box(172.5, 8, 20, 20),
        fields,
        title=Box(20, 8, 100, 8),
        name=Box(20, 17, 100, 8),
        rules=None,
        guide=(),
    )


# ------------------------------------------------------------------- Auto Multiple Choice

AMC = r"""\documentclass[a4paper,10pt]{article}
\usepackage[utf8]{inputenc}\usepackage[T1]{fontenc}\usepackage[box,nowatermark]{automultiplechoice}
\newcommand\one[1]{\begin{questionmult}{q#1}Question #1.
\begin{choiceshoriz}[o]\correctchoice{A}\wrongchoice{B}\wrongchoice{C}\wrongchoice{D}\wrongchoice{E}\end{choiceshoriz}
\end{questionmult}\par}
\begin{document}
\onecopy{PAGES}{\noindent Choices\hfill\namefield{\fbox{Name:\hspace{5cm}}}\par QUESTIONS\clearpage}
\end{document}
"""


class AutoMultipleChoice:
    name = "Auto Multiple Choice"

    def __init__(self, folder: Path, run: Command, pages: int) -> None:
        self.folder, self.run = folder, run
        shutil.rmtree(folder, ignore_errors=True)
        for inside in ("data", "cr", "scans"):
            (folder / inside).mkdir(parents=True)
        questions = "".join(rf"\one{{{k}}}" for k in range(1, QUESTIONS + 1))
        (folder / "sheet.tex").write_text(AMC.replace("PAGES", str(pages)).replace("QUESTIONS", questions))
        self._run(
            "prepare --mode s --prefix ./ --data data sheet.tex --out-sujet sheet.pdf --out-calage sheet.xy "
            "--out-corrige solution.pdf --with pdflatex"
        )
        self._run("meptex --src sheet.xy --data data")
        self.pdf = (folder / "sheet.pdf").read_bytes()
        self.boxes = {page: self._boxes(page + 1) for page in range(pages)}

    def _run(self, job: str) -> str:
        return self.run(self.folder, ["auto-multiple-choice", *job.split()])

    def _boxes(self, copy: int) -> list[list[Box]]:
        with sqlite3.connect(self.folder / "data" / "layout.sqlite") as layout:
            rows = layout.execute(
                "select xmin, ymin, xmax, ymax from layout_box where student = ? and page = 1 order by "
                "question, answer",
                (copy,),
            ).fetchall()
        mm = np.array(rows) * 25.4 / 300
        boxes = [Box(x0, y0, x1 - x0, y1 - y0) for x0, y0, x1, y1 in mm.tolist()]
        return [boxes[k : k + len(CASES)] for k in range(0, len(boxes), len(CASES))]

    def sheet(self, page: int) -> tuple[np.ndarray, list[list[Box]]]:
        return simulated.sheet_of_pdf(self.pdf, page), self.boxes[page]

    def read(self, pictures: dict[int, np.ndarray]) -> dict[int, Said]:
        (self.folder / "data" / "capture.sqlite").unlink(missing_ok=True)
        files = [f"scans/{page}.png" for page in pictures]
        for file, grey in zip(files, pictures.values(), strict=True):
            cv2.imwrite(str(self.folder / file), grey)
        (self.folder / "list").write_text("\n".join(files) + "\n")
        self._run("analyse --projet . --data data --cr cr --liste-fichiers list")
        with sqlite3.connect(self.folder / "data" / "capture.sqlite") as capture:
            zones = capture.execute(
                "select student, id_a, id_b, 1.0 * black / total from capture_zone where type = 4 "
                "order by 1, 2, 3"
            ).fetchall()
        said: dict[int, Said] = {}
        for student, question, answer, black in zones:
            page = said.setdefault(student - 1, [[None] * len(CASES) for _ in range(QUESTIONS)])
            page[question - 1][answer - 1] = black > DARK
        return said


# ------------------------------------------------------------------- R/exams

CHOOSE = r"""\begin{question}
Choose.
\begin{answerlist}
\item A
\item B
\item C
\item D
\item E
\end{answerlist}
\end{question}
\extype{mchoice}
\exsolution{10000}
\exname{choose}
\exshuffle{FALSE}
"""


class Nops:
    name = "R/exams, NOPS"

    def __init__(self, folder: Path, run: Command, pages: int) -> None:
        self.folder, self.run = folder, run
        shutil.rmtree(folder, ignore_errors=True)
        (folder / "scans").mkdir(parents=True)
        (folder / "q.Rnw").write_text(CHOOSE)
        self._r(
            f"set.seed(1); exams::exams2nops(rep(list('q.Rnw'), {QUESTIONS}), n = {pages}, dir = "
            "'out', name = 'sheet', "
            "date = '2026-01-15', blank = 0, duplex = FALSE)"
        )
        self.pdfs = [path.read_bytes() for path in sorted((folder / "out").glob("sheet*.pdf"))]

    def _r(self, code: str) -> str:
        return self.run(self.folder, ["Rscript", "-e", code])

    def sheet(self, page: int) -> tuple[np.ndarray, list[list[Box]]]:
        sheet = simulated.sheet_of_pdf(self.pdfs[page])
        return sheet, _squares(sheet)

    def read(self, pictures: dict[int, np.ndarray]) -> dict[int, Said]:
        shutil.rmtree(self.folder / "scans")
        (self.folder / "scans").mkdir()
        for page, grey in pictures.items():
            cv2.imwrite(str(self.folder / "scans" / f"{page}.png"), grey)
        self._r("writeLines(exams::nops_scan(dir = 'scans', file = FALSE, verbose = FALSE), 'read.txt')")
        said: dict[int, Said] = {}
        for line in (self.folder / "read.txt").read_text().splitlines():
            file, identity, *rest = line.split()
            page = int(Path(file).stem)
            answers = rest[4 : 4 + QUESTIONS]
            if identity == f"260115{page + 1:05}" and len(answers) == QUESTIONS:
                said[page] = [[mark == "1" for mark in answer] for answer in answers]
        return said


def _squares(sheet: np.ndarray) -> list[list[Box]]:
    """The boxes of the answers on a NOPS sheet, found where they are printed: 14 rows of five."""
    dark = (sheet < 128).astype(np.uint8)
    contours, nesting = cv2.findContours(dark, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_SIMPLE)
    holes = [cv2.boundingRect(c) for c, nest in zip(contours, nesting[0], strict=True) if nest[3] >= 0]
    found = [
        b
        for b in (np.array(holes) / simulated.DOTS).tolist()
        if 3.5 < b[2] < 5.5 and b[0] < 65 and b[1] > 155
    ]
    boxes = [Box(*b) for b in sorted(found, key=lambda b: (round(b[1]), b[0]))]
    rows = [boxes[k : k + len(CASES)] for k in range(0, len(boxes), len(CASES))]
    assert len(boxes) == QUESTIONS * len(CASES), f"{len(boxes)} boxes found on the sheet"
    return rows


# ------------------------------------------------------------------- the comparison


def judged(said: dict[int, Said], pages: int) -> Counter:
    """Boxes right, wrong, unsure; pages lost."""
    count: Counter = Counter()
    for page in range(pages):
        if page not in said:
            count["lost"] += 1
            continue
        for row, wanted in zip(said[page], crossed(page), strict=True):
            for box, is_wanted in zip(row, wanted, strict=True):
                count["unsure" if box is None else "right" if box == bool(is_wanted) else "wrong"] += 1
    return count


def command(root: Path | None) -> Command:
    def run(folder: Path, words: list[str]) -> str:
        place = folder.resolve()
        if root is None:
            return subprocess.run(words, cwd=place, capture_output=True, text=True).stdout
        inside = "/" / place.relative_to(root.resolve())
        entered = ["chroot", str(root), "sh", "-c", 'cd "$0" && HOME="$0" exec "$@"', str(inside), *words]
        return subprocess.run(entered, capture_output=True, text=True).stdout

    return run


def systems(options: argparse.Namespace) -> list:
    run = command(options.root)
    found: list = [Ours(options.pages)]
    for system, folder in ((AutoMultipleChoice, "amc"), (Nops, "nops")):
        try:
            found.append(system(options.folder / folder, run, options.pages))
        except (OSError, sqlite3.Error, IndexError) as fault:
            print(f"{system.name} is left out: {fault}")
    return found


def main(options: argparse.Namespace) -> None:
    readers = systems(options)
    print("| scan | reader | pages lost | boxes right | wrong | told unsure |\n|---|---|--:|--:|--:|--:|")
    for kind in KINDS:
        for reader in readers:
            pictures = {page: picture(*reader.sheet(page), page, kind) for page in range(options.pages)}
            count = judged(reader.read(pictures), options.pages)
            boxes = "".join(f" {count[word]} |" for word in ("right", "wrong", "unsure"))
            print(f"| {kind} | {reader.name} | {count['lost']} of {options.pages} |{boxes}", flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--pages", type=int, default=24)
    parser.add_argument("--root", type=Path)
    main(parser.parse_args())
