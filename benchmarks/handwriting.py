"""Handwritten digits of public collections, read from one folder.

- ``train-*-ubyte`` and ``t10k-*-ubyte``: MNIST, by 539 writers in the United States and 297 others;
  ``qmnist-test-labels-idx2-int.gz``, of QMNIST, states the writers of the latter.
- ``semeion.data``: UCI's "Semeion Handwritten Digit", by 80 writers in Italy.
- ``optdigits-orig.tra`` and ``.windep``: UCI's "Optical Recognition of Handwritten Digits", by 30 writers in
  Turkey and 13 others.
- ``pendigits-orig.tra`` and ``.tes``: UCI's "Pen-Based Recognition of Handwritten Digits", by 30 writers in
  Turkey and 14 others.
- ``inkml/``: formulas of the competitions CROHME; those of HAMEX are by 39 writers in France.

Pictures are white on black. The last two are paths of pens on tablets, which are drawn with any pen.
"""

from __future__ import annotations

import gzip
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

import cv2
import numpy as np

#: The strokes of a digit, each (n, 2), the second coordinate downwards.
Paths = list[np.ndarray]


class Digits(NamedTuple):
    """Digits as pictures or as paths, what they are, and by whom, where that is known."""

    pictures: Sequence[np.ndarray] | Sequence[Paths]
    labels: np.ndarray
    writers: np.ndarray | None = None

    def of(self, chosen: np.ndarray) -> Digits:
        """Return some of the digits, by a mask."""
        writers = None if self.writers is None else self.writers[chosen]
        pictures = [self.pictures[k] for k in np.flatnonzero(chosen)]
        return Digits(pictures, self.labels[chosen], writers)


def mnist(folder: Path, part: str) -> Digits:
    """Return MNIST's digits, 28 by 28; ``part`` is ``train`` or ``t10k``, of which the writers are known."""
    pictures, labels = (_idx(folder / f"{part}-{what}-ubyte") for what in ("images-idx3", "labels-idx1"))
    if part == "train":
        return Digits(pictures, labels)
    about = _idx(folder / "qmnist-test-labels-idx2-int.gz")[: len(labels)]
    return Digits(pictures, labels, about[:, 2])


def _idx(path: Path) -> np.ndarray:
    raw = path.read_bytes()
    raw = gzip.decompress(raw) if path.suffix == ".gz" else raw
    shape = np.frombuffer(raw, ">i4", raw[3], 4)
    return np.frombuffer(raw, {8: np.uint8, 12: ">i4"}[raw[2]], -1, 4 + 4 * raw[3]).reshape(shape)


def semeion(folder: Path) -> Digits:
    """Return Semeion's digits, 16 by 16 in black and white, on MNIST's scale, and softened as much."""
    lines = (folder / "semeion.data").read_text("ascii").splitlines()
    rows = np.array([[float(v) for v in line.split()[:266]] for line in lines])
    small = np.pad(255 * rows[:, :256].reshape(-1, 16, 16), ((0, 0), (2, 2), (2, 2))).astype(np.float32)
    large = [cv2.GaussianBlur(cv2.resize(one, (28, 28)), (0, 0), 0.5) for one in small]
    return Digits(np.array(large).astype(np.uint8), rows[:, 256:].argmax(1))


#: The first digits of UCI's form, which every writer filled in; some left out a few.
_FORM = r"(?:0?123456(?:78)?9){2,}(?=0955)"


def bitmaps(folder: Path, part: str) -> Digits:
    """Return UCI's digits in 32 by 32 dots, each stretched to a square; ``part`` is ``tra`` or
    ``windep``, of other writers."""
    lines = [line.strip() for line in (folder / f"optdigits-orig.{part}").read_text("ascii").splitlines()]
    first = [k for k, line in enumerate(lines) if len(line) == 32 and set(line) <= {"0", "1"}][::32]
    digits = [[[255 * int(dot) for dot in row] for row in lines[k : k + 32]] for k in first]
    labels = "".join(lines[k + 32] for k in first)
    begun = np.isin(np.arange(len(labels)), [found.start() for found in re.finditer(_FORM, labels)])
    writers = np.cumsum(begun) if begun.any() else None  # the digits that train are shuffled
    return Digits(np.array(digits, np.uint8), np.array([*map(int, labels)]), writers)


def coarse(digits: Digits) -> Digits:
    """Return digits of 32 by 32 dots as UCI and scikit-learn publish them, 8 by 8 of 17 greys, enlarged."""
    greys = np.asarray(digits.pictures, np.float32).reshape(-1, 8, 4, 8, 4).mean((2, 4))
    large = [cv2.resize(each, (24, 24), interpolation=cv2.INTER_CUBIC) for each in greys]
    return digits._replace(pictures=np.clip(np.pad(large, ((0, 0), (2, 2), (2, 2))), 0, 255).astype(np.uint8))


def paths(folder: Path, part: str, *, odd: bool | None = None) -> Digits:
    """Return UCI's digits as paths (UNIPEN); ``part`` is ``tra`` or ``tes``, of 14 other writers; of these
    only those with odd numbers, or with even ones, if ``odd`` says so."""
    found = []
    for segment in (folder / f"pendigits-orig.{part}").read_text("ascii").split(".SEGMENT DIGIT")[1:]:
        label, about = re.search(r'"(\d)"', segment), re.search(r"\.COMMENT\s+\d+\s+(\d+)", segment)
        down = [each.partition(".PEN_UP")[0] for each in segment.split(".PEN_DOWN")[1:]]
        strokes = [np.array(each.split(), float).reshape(-1, 2) * (1, -1) for each in down]
        if label and about and any(len(each) > 1 for each in strokes):
            found.append(([each for each in strokes if len(each)], int(label[1]), int(about[1])))
    digits = _digits(found)
    return digits if odd is None else digits.of(digits.writers % 2 == odd)


def _digits(found: Sequence[tuple[Paths, int, int | str]]) -> Digits:
    pictures, labels, writers = zip(*found, strict=True)
    return Digits(pictures, np.array(labels), np.array(writers))


_INK = "{http://www.w3.org/2003/InkML}"


def formulas(folder: Path) -> Digits:
    """Return the digits in the formulas of ``inkml/`` as paths."""
    return _digits([each for path in sorted(folder.glob("inkml/*.inkml")) for each in _of_formula(path)])


def _of_formula(path: Path) -> Iterator[tuple[Paths, int, str]]:
    try:
        root = ElementTree.parse(path).getroot()
    except ElementTree.ParseError:  # a few files are not XML
        return
    strokes = {
        trace.get("id"): np.array([point.split()[:2] for point in trace.text.split(",")], float)
        for trace in root.findall(f"{_INK}trace")
        if trace.text and trace.text.strip()
    }
    about = {each.get("type"): each.text or "" for each in root.findall(f"{_INK}annotation")}
    writer = about.get("writer", path.stem)
    for group in root.iter(f"{_INK}traceGroup"):
        sign, parts = group.findtext(f"{_INK}annotation", ""), group.findall(f"{_INK}traceView")
        drawn = [strokes[each.get("traceDataRef")] for each in parts if each.get("traceDataRef") in strokes]
        if drawn and len(sign) == 1 and sign in "0123456789":
            yield drawn, int(sign), writer


def inked(strokes: Paths, high: float, width: float) -> np.ndarray:
    """Return a picture of a digit ``high`` pixels high, written by a pen ``width`` pixels wide."""
    every = np.concatenate(strokes)
    low, size = every.min(0), np.ptp(every, 0)
    scale = high / max(size[1], 0.35 * size[0], 1e-9)  # a flat one is not blown up
    rim = int(np.ceil(width)) + 2
    canvas = np.zeros([int(np.ceil(length * scale)) + 2 * rim for length in size[::-1]], np.uint8)
    for stroke in strokes:
        points = (((stroke - low) * scale + rim) * 16).round().astype(np.int32)
        cv2.polylines(canvas, [points], False, 255, max(1, round(width)), cv2.LINE_AA, 4)
    return canvas
