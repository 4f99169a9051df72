"""Digits written by hand in printed boxes: the digit in each and its confidence."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from coursework.system.extras import library

Floats: TypeAlias = NDArray[np.float32]

EMPTY = -1

#: Classes of the net: the ten digits, an empty box, a minus sign, and what is none of these.
BLANK, OTHER = 10, 12  # 11 is the minus sign

#: A digit, or an emptiness, of at least this confidence is taken; what is below goes to a person
#: (docs/scans.md: how often it errs).
CONFIDENT = 0.99

#: A doubted number is taken if it is a right answer of its variant with at least this probability.
LIKELY = 0.8

#: What the net sees: a box of 7 mm by 9 mm at 4 px/mm, and a rim of two pixels.
HEIGHT, WIDTH, RIM = 36, 28, 2

#: The outline, printed or a little beside its place, lies within this many pixels of the net's picture.
OUTLINE = 3

#: Convolutions of the net in their order: single ones, and pairs of which the output is added to the input.
LAYERS: tuple[str | tuple[str, str], ...] = ("a", "b", ("c", "d"), "e", ("f", "g"), ("h", "i"), "j")
_HALVING = frozenset("bej")  #: convolutions of stride 2

#: Cells that go through the net at once: bounds the memory.
BATCH = 128


def read_digits(
    cells: NDArray[np.uint8],
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """Return the digit in each box, ``EMPTY`` for none, its confidence, and the probability of each digit.

    The boxes are those of one person, and help to read each other: a digit is likelier if the person's
    other boxes that show it look alike.

    Parameters
    ----------
    cells
        Grey pictures, dark ink on light paper, shape ``(n, height, width)``: each a box as it is printed,
        cut along the middle of its outline (up to 0.7 mm beside it does no harm), of any resolution.

    Returns
    -------
    digits, confidences
        Shape ``(n,)`` each. A confidence is the calibrated probability that the box holds this digit, or
        nothing; it is low where the box holds something else: a letter, a struck-out digit, two digits, a
        part of one.
    chances
        The probability of each digit from 0 to 9, shape ``(n, 10)``.
    """
    chances = of_one_hand(features(prepared(cells)))
    likeliest = chances[:, : BLANK + 1].argmax(axis=1)
    confidences = chances[np.arange(len(likeliest)), likeliest]
    return np.where(likeliest == BLANK, EMPTY, likeliest), confidences, chances[:, :BLANK]


def prepared(cells: NDArray[np.uint8]) -> Floats:
    """Return boxes as input of the network: darkness relative to the paper, 0 to 1, on the scale of the
    darkest ink; shape (n, 40, 32)."""
    seen = np.zeros((len(cells), HEIGHT + 2 * RIM, WIDTH + 2 * RIM), np.float32)
    if len(cells):
        seen[:, RIM:-RIM, RIM:-RIM] = _darkness(np.stack([_resized(cell) for cell in cells]))
    return seen


def probabilities(hidden: Floats) -> NDArray[np.float64]:
    """Return calibrated probabilities of the classes, shape (n, 13), for features of boxes, each alone."""
    return _softmax(_logits(hidden))


def of_one_hand(hidden: Floats) -> NDArray[np.float64]:
    """Return calibrated probabilities of the classes, shape (n, 13), for features of boxes of one person.

    A digit gains by similar boxes of the same person, less what a struck-out digit gains on average.
    """
    w, chances = _weights(), probabilities(hidden)
    digits = chances[:, :BLANK]
    chances[:, :BLANK] = digits * np.exp(w["own"] * similarity(hidden, digits) - w["struck"])
    return chances / chances.sum(axis=1, keepdims=True)


def similarity(hidden: Floats, chances: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how much more similar each box is to the same person's other boxes of a digit than to the
    average box of that digit, shape (n, 10).

    Similarity is the mean cosine between features, weighted by the ``chances``, shape (n, 10), that the other
    boxes show the digit. It is shrunk by n / (n + 1), where n is their sum.
    """
    units = hidden / np.maximum(np.linalg.norm(hidden, axis=1, keepdims=True), 1e-6)
    others = chances.sum(axis=0) - chances
    own = units @ (chances.T @ units).T - chances * (units**2).sum(axis=1, keepdims=True)
    more: NDArray[np.float64] = (own - others * (units @ _weights()["average"].T)) / (others + 1)
    return more


def _resized(cell: NDArray[np.uint8]) -> Floats:
    cv2 = library("cv2", "Reading scans needs", "scan")
    smaller = cell.shape[0] >= HEIGHT
    how = cv2.INTER_AREA if smaller else cv2.INTER_LINEAR
    grey: Floats = cv2.resize(cell, (WIDTH, HEIGHT), interpolation=how).astype(np.float32)
    return grey


def _darkness(grey: Floats) -> Floats:
    """Return the darkness of boxes relative to their paper, each on the scale of the darkest ink inside; ink
    fainter than a quarter stays faint."""
    paper = np.maximum(np.percentile(grey, 90, axis=(1, 2), keepdims=True), 1.0)
    dark = np.clip(1 - grey / paper, 0, 1)
    inside = dark[:, OUTLINE:-OUTLINE, OUTLINE:-OUTLINE]
    ink = np.percentile(inside, 98, axis=(1, 2), keepdims=True)
    scaled: Floats = np.minimum(dark / np.maximum(ink, 0.25), 1).astype(np.float32)
    return scaled


@cache
def _weights() -> dict[str, Floats]:
    with (files("coursework.scanning") / "digits.npz").open("rb") as file, np.load(file) as stored:
        return {name: stored[name].astype(np.float32) for name in stored.files}


def features(seen: Floats) -> Floats:
    """Return the values of the last hidden layer, shape (n, 96), for prepared boxes."""
    batches = [_features(seen[k : k + BATCH]) for k in range(0, len(seen), BATCH)]
    return np.concatenate(batches) if batches else np.zeros((0, _weights()["hidden.bias"].size), np.float32)


def _features(seen: Floats) -> Floats:
    """Convolutions, single and in residual pairs, and a full layer."""
    w = _weights()
    flow = seen[..., None]
    for step in LAYERS:
        if isinstance(step, str):
            flow = _rectified(flow, step)
        else:
            first, second = step
            flow = np.maximum(flow + _layer(_rectified(flow, first), second), 0)
    hidden: Floats = np.maximum(flow.reshape(len(flow), -1) @ w["hidden.weight"] + w["hidden.bias"], 0)
    return hidden


def _logits(hidden: Floats) -> Floats:
    w = _weights()
    logits: Floats = (hidden @ w["classes.weight"] + w["classes.bias"]) / w["temperature"]
    return logits


def _rectified(flow: Floats, name: str) -> Floats:
    return np.maximum(_layer(flow, name), 0)


def _layer(flow: Floats, name: str) -> Floats:
    w = _weights()
    out: Floats = _convolved(flow, w[f"{name}.weight"], 2 if name in _HALVING else 1) + w[f"{name}.bias"]
    return out


def _convolved(flow: Floats, weight: Floats, stride: int) -> Floats:
    """Return the 3 by 3 convolution with zero padding; ``flow`` (n, h, w, in), ``weight`` (9 in, out)."""
    around = np.pad(flow, ((0, 0), (1, 1), (1, 1), (0, 0)))
    height, width = flow.shape[1:3]
    shifted = [
        around[:, row : row + height : stride, column : column + width : stride]
        for row in range(3)
        for column in range(3)
    ]
    return np.concatenate(shifted, axis=-1) @ weight


def _softmax(logits: Floats) -> NDArray[np.float64]:
    raised = np.exp(logits.astype(np.float64) - logits.max(axis=1, keepdims=True))
    chances: NDArray[np.float64] = raised / raised.sum(axis=1, keepdims=True)
    return chances
