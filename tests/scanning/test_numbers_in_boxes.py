"""What a row of boxes says, by its rules: each row as somebody writes it, and what is read or why it
waits."""

import numpy as np
import pytest
from scanned_pages import DOTS, Hand, boxes_of, example_page, plain_digits, template_reader
from tables import each_row

from coursework.scanning.numbers import FieldText, numbers
from coursework.scanning.outlines import Shifts
from coursework.scanning.straightening import SCALE, Straight

FIELD = example_page().fields[0]
READER = template_reader(plain_digits, 1)


def flat(write):
    """A page laid flat on which ``write`` has written, and nothing is printed but light outlines."""
    import cv2

    page = example_page()
    sheet = np.full((round(page.height * DOTS), round(page.width * DOTS)), 255, np.uint8)
    for box in boxes_of(FIELD):
        at = [(round(box.x * DOTS), round(box.y * DOTS)), (round(box.right * DOTS), round(box.bottom * DOTS))]
        cv2.rectangle(sheet, *at, 190, 2)
    hand = Hand(pen="black", rng=np.random.default_rng(3), jitter=0.15, bank=plain_digits)
    hand.begin(sheet)
    write(hand)
    size = (round(page.width * SCALE), round(page.height * SCALE))
    small = cv2.resize(hand.finish(sheet), size, interpolation=cv2.INTER_AREA)
    return Straight(small, small, Shifts(np.empty((0, 2)), np.empty((0, 2)), 1.0), 4, 0.5)


def row(
    text, *, at=None, behind="", behind_at=0, sign=False, power="", power_sign=False, unit=False, more=None
):
    """Somebody's row: digits from the box ``at`` on, or up to the comma."""

    def write(hand):
        first = len(FIELD.digits) - len(text) if at is None else at
        for box, digit in zip(FIELD.digits[first:], text, strict=False):
            if digit != "_":
                hand.digit(box, int(digit))
        for box, digit in zip(FIELD.decimals[behind_at:], behind, strict=False):
            hand.digit(box, int(digit))
        for box, digit in zip(FIELD.power[2 - len(power) :], power, strict=True):
            hand.digit(box, int(digit))
        for is_there, box in ((sign, FIELD.sign), (power_sign, FIELD.power_sign)):
            if is_there:
                hand.minus(box)
        if unit:
            hand.cross(FIELD.unit)
        if more:
            more(hand)

    return write


def number(page, reader=READER, **how):
    """The reading of the field on a page."""
    (found,) = numbers(page, [FIELD], reader, **how)
    return found


def said(write):
    return number(flat(write))


@each_row(
    ("write", "text"),
    [
        (row("319", behind="8"), "319.8"),
        (row("319", behind="8", sign=True), "-319.8"),
        (row("42"), "42"),
        (row("42", at=0), "42"),
        (row("12345", behind="6789"), "12345.6789"),
        (row("0", behind="05"), "0.05"),
        (row("3", behind="2", power="12"), "3.2e12"),
        (row("3", behind="2", power="4", power_sign=True), "3.2e-4"),
    ],
)
def test_what_keeps_the_rules_is_read_as_it_would_be_typed(write, text):
    found = said(write)
    assert (found.text, found.waits) == (text, "")
    assert found.confidence >= 0.99


def test_the_unit_is_said_where_its_box_is_ticked():
    assert said(row("42", unit=True)) == FieldText("42 mm")
    assert said(row("42")) == FieldText("42")


def test_an_empty_row_is_a_blank_answer_and_does_not_wait():
    assert said(lambda hand: None) == FieldText("")


@each_row(
    ("write", "why"),
    [
        (row("3_9"), "gap"),
        (row("31", at=1, behind="5"), "gap"),
        (row("3", behind="5", behind_at=1), "gap"),
        (row("", behind="5"), "comma"),
        (row("", sign=True), "comma"),
        (row("", power="3"), "comma"),
        (row("3", power_sign=True), "power"),
        (row("44", more=lambda hand: hand.stroke([(76, 49), (82, 51)])), "joined"),
        (row("17", more=lambda hand: hand.scribble(FIELD.free, 3)), "free"),
        (row("", more=lambda hand: hand.scribble(FIELD.free, 3)), "free"),
        (row("17", more=lambda hand: hand.stroke([(158, 47), (160, 51), (162, 48), (164, 51)])), "free"),
        (row("", more=lambda hand: hand.stroke([(158, 47), (160, 51), (162, 48), (164, 51)])), "free"),
        (row("317", more=lambda hand: hand.strike(FIELD.digits[-3:])), "struck"),
        (row("7", more=lambda hand: hand.fill(FIELD.digits[-1])), "digit"),
        (row("7", more=lambda hand: hand.fill(FIELD.sign)), "sign"),
        (row("7", more=lambda hand: hand.cross(FIELD.sign)), "sign"),
        (row("7", more=lambda hand: hand.stroke([(146, 48), (150, 50)])), "unit"),
    ],
)
def test_what_breaks_a_rule_waits_and_says_why(write, why):
    assert said(write).waits == why


def test_a_minus_in_a_box_for_a_digit_is_never_dropped():
    assert said(row("7", sign=True, more=lambda hand: hand.minus(FIELD.digits[0]))).waits
    assert said(row("7", more=lambda hand: hand.minus(FIELD.digits[-2]))).waits


@each_row("faint", [0.12, 0.2, 0.3, 0.5])
def test_a_faint_digit_is_read_or_waits_but_is_not_left_out(faint):
    page = flat(row("31"))
    box = FIELD.digits[-3]
    weak = flat(row("831"))
    ink = page.ink.copy()
    place = np.s_[
        round(box.y * 10) + 5 : round(box.bottom * 10) - 5, round(box.x * 10) + 5 : round(box.right * 10) - 5
    ]
    ink[place] = 255 - ((255 - weak.ink[place]) * faint).astype(np.uint8)
    found = number(Straight(ink, ink, page.shifts, 4, 0.5))
    assert found.text == "831" or found.waits


def test_a_box_with_less_confidence_than_is_stated_waits_with_what_it_looks_like():
    chance = 0.97

    def doubting(cells):
        digits, _ = READER(cells)
        return digits, np.where(digits == 9, chance, 1.0)

    found = number(flat(row("319")), doubting)
    assert (found.text, found.waits) == ("319", "doubted")
    assert found.confidence == pytest.approx(0.97)
    assert not number(flat(row("319")), doubting, least=0.95).waits
    chance = 0.6
    assert number(flat(row("319")), doubting).waits == "digit"


def maybe_four(cells):
    """A reader that takes a 9 for a 4, perhaps."""
    digits, _ = READER(cells)
    chances = np.where(digits[:, None] == np.arange(10), 1.0, 0.0)
    chances[digits == 9] = 0.8 * (np.arange(10) == 9) + 0.15 * (np.arange(10) == 4)
    return digits, chances.max(axis=1), chances


def test_a_doubted_number_tells_what_it_may_be():
    found = number(flat(row("319", behind="1", unit=True)), maybe_four)
    assert (found.text, found.waits) == ("319.1 mm", "doubted")
    assert [(text, pytest.approx(chance)) for text, chance in found.candidates] == [
        ("319.1 mm", 0.8),
        ("314.1 mm", 0.15),
    ]
    assert not number(flat(row("315")), maybe_four).candidates


def test_a_doubted_number_with_something_beside_it_is_never_taken():
    beside = row("319", more=lambda hand: hand.stroke([(158, 47), (160, 51), (162, 48), (164, 51)]))
    found = number(flat(beside), maybe_four)
    assert (found.waits, found.candidates) == ("free", ())


@each_row("dark", [40, 90, 200])
@each_row("sign", [FIELD.sign, FIELD.power_sign])
def test_a_short_thin_minus_is_read_or_waits_but_is_not_left_out(sign, dark):
    page = flat(row("31", power="4"))
    ink = page.ink.copy()
    x, y = round((sign.x + 2.5) * SCALE), round((sign.y + 4.5) * SCALE)
    ink[y : y + 2, x : x + 14] = 255 - dark
    found = number(Straight(ink, ink, page.shifts, 4, 0.5))
    assert "-" in found.text or found.waits


@each_row(("lean", "waits"), [(2.8, "doubted"), (2.2, "doubted"), (0.9, ""), (-0.5, "")])
def test_the_bar_of_a_fraction_is_no_one(lean, waits):
    box = FIELD.digits[-2]
    x, y = box.x + 3.5, box.y + 4.5
    bar = row("4_5", more=lambda hand: hand.stroke([(x + lean / 2, y - 3), (x - lean / 2, y + 3)]))
    found = number(flat(bar), lambda cells: (np.array([4, 1, 5]), np.ones(3)))
    assert (found.text, found.waits) == ("415", waits)


def test_a_slanted_one_at_the_end_of_a_number_is_one():
    box = FIELD.digits[-1]
    leaning = row(
        "45_", more=lambda hand: hand.stroke([(box.x + 4.6, box.y + 1.5), (box.x + 2.2, box.y + 7.5)])
    )
    assert number(flat(leaning), lambda cells: (np.array([4, 5, 1]), np.ones(3))).waits == ""


@each_row("dark", [30, 60, 120])
def test_an_edge_that_runs_through_a_box_is_no_one(dark):
    page = flat(row("8", at=0))
    ink, box = page.ink.copy(), FIELD.digits[1]
    x = round((box.x + 3.5) * SCALE)
    ink[round((box.y - 8) * SCALE) : round((box.bottom + 8) * SCALE), x : x + 5] = 255 - dark
    found = number(Straight(ink, ink, page.shifts, 4, 0.5), lambda cells: (np.array([8, 1]), np.ones(2)))
    assert found.waits == "digit"


@each_row("below", [False, True])
@each_row("dark", [30, 60, 120])
def test_nor_is_one_that_cuts_its_corner(dark, below):
    import cv2

    page = flat(row("8", at=len(FIELD.digits) - 2))
    ink, box = page.ink.copy(), FIELD.digits[-1]
    high = ((box.y - 2.5, box.bottom - 1), (box.bottom + 2.5, box.y + 1))[below]
    ends = zip((box.x + 1, box.right + 1.8), high, strict=True)
    cv2.line(ink, *((round(x * SCALE), round(y * SCALE)) for x, y in ends), 255 - dark, 5)
    found = number(Straight(ink, ink, page.shifts, 4, 0.5), lambda cells: (np.array([8, 1]), np.ones(2)))
    assert (found.text, found.waits) == ("81", "digit")
