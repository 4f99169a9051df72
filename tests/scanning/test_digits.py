"""What is written in a box is read as it was meant, or is told unsure; on handwriting that trained
nothing."""

from pathlib import Path

import cv2
import numpy as np
import pytest
from scipy.signal import correlate2d
from tables import each_row

from coursework.cli.scan import scan
from coursework.scanning import digits
from coursework.scanning.digits import CONFIDENT, EMPTY, read_digits

#: Forty of each digit of MNIST's test set; ``pens``: five of each digit by each of four of UCI's writers in
#: Turkey, numbered in ``pen_writers``.
with np.load(
    Path(__file__).parents[1] / "handwritten_digits.npz"
) as _bank:  # which unpacks an array at each look
    BANK = dict(_bank)

ONE_WITH_UPSTROKE = [
    [(18, 50), (40, 14), (38, 76)],
    [(14, 44), (46, 12), (44, 78)],
    [(25, 30), (42, 12), (42, 76)],
]
SEVEN_WITH_BAR = [
    [[(14, 14), (54, 13), (28, 76)], [(24, 44), (52, 42)]],
    [[(12, 20), (14, 14), (55, 12), (36, 78)], [(26, 42), (56, 44)]],
]
OPEN_FOUR = [
    [[(20, 14), (15, 48), (58, 47)], [(48, 14), (46, 76)]],
    [[(26, 12), (16, 46), (56, 48)], [(46, 24), (44, 78)]],
]


def box(grey=190):
    """An empty box, 10 px/mm, cut along its outline."""
    cell = np.full((90, 70), 250, np.uint8)
    cv2.rectangle(cell, (0, 0), (69, 89), grey, 2)
    return cell


def inked(cell, ink, dark=0.85):
    return np.clip(cell * (1 - dark * ink), 0, 255).astype(np.uint8)


def written(index, at=(0, 0), height=60, bank="digits"):
    """The ink of a digit of the bank in a box."""
    glyph = BANK[bank][index]
    rows, columns = np.flatnonzero(glyph.max(1) > 40), np.flatnonzero(glyph.max(0) > 40)
    cut = glyph[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1] / np.float32(255)
    by = min(height / cut.shape[0], 62 / cut.shape[1])
    middle = np.array([35.0 + at[0], 45.0 + at[1]]) - by * (np.array(cut.shape[::-1]) - 1) / 2
    place = np.array([[by, 0, middle[0]], [0, by, middle[1]]])
    field = cv2.warpAffine(cut, place, (70, 90), flags=cv2.INTER_CUBIC)
    return 1 / (1 + np.exp(-(field - 0.5) / 0.1))


def stroked(*strokes, width=5):
    ink = np.zeros((90, 70), np.uint8)
    for points in strokes:
        cv2.polylines(ink, [np.array(points, np.int32)], False, 255, width, cv2.LINE_AA)
    return cv2.GaussianBlur(ink, (0, 0), 0.7) / 255


#: Each digit of the bank in turn, by every fourth of its writers.
CHOSEN = np.arange(0, len(BANK["labels"]), 4)
LABELS = BANK["labels"][CHOSEN]


def everyone(**how):
    return np.array([inked(box(), written(index, **how)) for index in CHOSEN])


def assert_read(cells, labels, least):
    """Check that this share is taken at least, none of it wrongly, and that most guesses are right."""
    found, sure, _ = read_digits(cells)
    taken = sure >= CONFIDENT
    assert not np.sum(taken & (found != labels))
    assert taken.mean() > least
    assert np.mean(found == labels) > 0.95


@each_row("how", [{}, {"at": (6, -8)}, {"height": 44}, {"height": 80}])
def test_digits_of_other_writers_are_read_or_told_unsure(how):
    assert_read(everyone(**how), LABELS, 0.7)


@each_row("how", [{}, {"at": (6, -8)}, {"height": 44}, {"height": 80}])
def test_digits_that_europeans_write_with_a_pen_are_read_or_told_unsure(how):
    labels = BANK["pen_labels"]
    cells = [inked(box(), written(index, bank="pens", **how)) for index in range(len(labels))]
    assert_read(np.array(cells), labels, 0.8)


@each_row("dots", [0.59, 0.79, 2.36])
def test_another_resolution_says_no_other_digit(dots):
    cells = everyone()
    other = np.array(
        [cv2.resize(cell, None, fx=dots, fy=dots, interpolation=cv2.INTER_AREA) for cell in cells]
    )
    found, sure, _ = read_digits(other)
    assert np.all(found[sure >= CONFIDENT] == LABELS[sure >= CONFIDENT])
    assert np.mean(sure >= CONFIDENT) > 0.7


def test_pencil_and_paper_in_the_shade_are_read_as_ink():
    shade = np.linspace(0.6, 0.8, 70)
    faint = [inked(box(), written(index), 0.4) * shade for index in CHOSEN]
    found, sure, _ = read_digits(np.array(faint).astype(np.uint8))
    assert np.all(found[sure >= CONFIDENT] == LABELS[sure >= CONFIDENT])
    assert np.mean(sure >= CONFIDENT) > 0.6


@each_row(("digit", "shapes"), [(1, [[s] for s in ONE_WITH_UPSTROKE]), (7, SEVEN_WITH_BAR), (4, OPEN_FOUR)])
def test_digits_as_europe_writes_them_are_read(digit, shapes):
    cells = [inked(box(), stroked(*shape, width=width)) for shape in shapes for width in (3, 5, 7)]
    found, sure, _ = read_digits(np.array(cells))
    assert np.all(found[sure >= CONFIDENT] == digit)
    assert np.mean(sure >= CONFIDENT) > 0.5


@each_row("grey", [250, 190, 60])
def test_nothing_is_read_as_nothing(grey):
    rng = np.random.default_rng(1)
    cells = np.array([box(grey) - rng.integers(0, 12, (90, 70), np.uint8) for _ in range(20)])
    found, sure, _ = read_digits(cells)
    assert np.all(found == EMPTY)
    assert np.all(sure > 0.99)  # the rows of boxes ask of what is not bare alone


def struck(index, bank="digits"):
    lines = [[(6, y), (64, y + 4)] for y in (34, 44, 54)]
    return np.maximum(written(index, bank=bank), stroked(*lines, width=4))


def two(index):
    left, right = written(index, height=46), written((index + 57) % len(BANK["labels"]), height=46)
    squeeze = [np.array([[0.6, 0, shift], [0, 1, 0]]) for shift in (-4.0, 32.0)]
    return np.maximum(
        *(cv2.warpAffine(ink, s, (70, 90)) for ink, s in zip((left, right), squeeze, strict=True))
    )


def blackened(index):
    zigzag = [[(6 + 58 * (k % 2), 8 + 5 * k) for k in range(16)]]
    return np.maximum(written(index), stroked(*zigzag, width=5))


@each_row("spoilt", [struck, two, blackened])
def test_what_is_struck_out_or_no_single_digit_is_told_unsure(spoilt):
    cells = np.array([inked(box(), spoilt(index)) for index in CHOSEN])
    assert np.mean(read_digits(cells)[1] >= CONFIDENT) < 0.01


@each_row("letter", "ACEFHKMNRXaknw?")
def test_a_letter_is_told_unsure(letter):
    cell = box()
    cv2.putText(cell, letter, (16, 64), cv2.FONT_HERSHEY_SIMPLEX, 1.8, 40, 4, cv2.LINE_AA)
    assert read_digits(cell[None])[1][0] < CONFIDENT


def test_a_minus_is_no_digit():
    assert read_digits(inked(box(), stroked([(18, 45), (52, 44)]))[None])[1][0] < CONFIDENT


def test_a_box_looks_the_same_alone_and_among_others():
    seen = digits.prepared(everyone())
    together = digits.features(seen)
    for index in range(0, len(seen), 20):
        assert digits.features(seen[index : index + 1])[0] == pytest.approx(together[index], abs=1e-5)


WRITERS = [np.flatnonzero(BANK["pen_writers"] == writer) for writer in np.unique(BANK["pen_writers"])]


def pages_taken(pages):
    """Count the boxes of some pages of digits by pens that are taken; check that none is wrong."""
    count = 0
    for page in pages:
        found, sure, _ = read_digits(np.array([inked(box(), written(index, bank="pens")) for index in page]))
        taken = sure >= CONFIDENT
        assert np.all(found[taken] == BANK["pen_labels"][page][taken])
        count += int(taken.sum())
    return count


def test_boxes_of_one_person_help_to_read_each_other():
    mixed = np.array(WRITERS).T.reshape(len(WRITERS), -1)
    assert pages_taken(WRITERS) > pages_taken(mixed)


def test_a_struck_out_digit_is_taken_no_oftener_beside_digits_of_its_writer():
    for page in WRITERS:
        cells = [inked(box(), written(index, bank="pens")) for index in page]
        cells += [inked(box(), struck(index, "pens")) for index in page[::2]]
        hidden = digits.features(digits.prepared(np.array(cells)))
        alone, beside = (
            chances[len(page) :, :10].max(axis=1)
            for chances in (digits.probabilities(hidden), digits.of_one_hand(hidden))
        )
        assert np.sum(beside >= CONFIDENT) <= np.sum(alone >= CONFIDENT)
        assert np.log(beside / (1 - beside)).mean() < np.log(alone / (1 - alone)).mean() + 0.5


def test_similarity_is_as_its_definition_says():
    rng = np.random.default_rng(5)
    hidden, chances = rng.random((7, 96), np.float32), rng.random((7, 10))
    average = digits._weights()["average"]

    def cosine(one, other):
        return one @ other / np.linalg.norm(one) / np.linalg.norm(other)

    for index, one in enumerate(hidden):
        others = [k for k in range(7) if k != index]
        for digit in range(10):
            weights = chances[others, digit]
            own = np.average([cosine(one, hidden[k]) for k in others], weights=weights)
            usual = one @ average[digit] / np.linalg.norm(one)
            expected = (own - usual) * weights.sum() / (weights.sum() + 1)
            assert digits.similarity(hidden, chances)[index, digit] == pytest.approx(expected, abs=1e-5)


def test_the_command_leaves_the_same_boxes_to_a_person():
    assert {option.name: option.default for option in scan.params}["sure"] == CONFIDENT


def test_no_boxes_give_no_digits():
    found, sure, _ = read_digits(np.zeros((0, 90, 70), np.uint8))
    assert found.shape == sure.shape == (0,)


@each_row("stride", [1, 2])
def test_the_convolution_is_scipys(stride):
    rng = np.random.default_rng(3)
    flow, weight = rng.normal(size=(2, 8, 6, 3)), rng.normal(size=(27, 4))
    kernels = weight.reshape(3, 3, 3, 4)
    expected = np.array(
        [
            [sum(correlate2d(one[..., i], kernels[..., i, o], "same") for i in range(3)) for o in range(4)]
            for one in flow
        ]
    ).transpose(0, 2, 3, 1)[:, ::stride, ::stride]
    assert digits._convolved(flow, weight, stride) == pytest.approx(expected)


def test_the_weights_are_small_and_travel_with_the_package():
    path = Path(digits.__file__).with_name("digits.npz")
    assert path.stat().st_size < 1_000_000
