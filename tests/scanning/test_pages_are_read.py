"""Pages that were filled in, printed and scanned in simulation: found, laid flat, and nothing read that is
not there."""

from dataclasses import replace

import numpy as np
import pytest
import scanned_pages as simulated
from scanned_pages import (
    KINDS,
    Hand,
    Scan,
    a_hand,
    example_page,
    filled_in,
    plain_digits,
    plain_sheet,
    scanned,
)
from tables import each_row

from coursework.scanning.codes import codes_in
from coursework.scanning.pages import read_page
from coursework.scanning.pictures import PageImage, is_two_toned
from coursework.scanning.straightening import straightened
from coursework.sheets.answer_pages import Box

PAGE = example_page()


def few_and_all(rows, few):
    """The first rows, and all of them, slow."""
    rows = list(rows)
    return [rows[:few], pytest.param(rows, marks=pytest.mark.slow)]


PAPERS = {"ABCDEFGHIJKLM": (PAGE,)}
READER = simulated.template_reader(plain_digits, 1)


@pytest.fixture(scope="module")
def sheet():
    return plain_sheet(PAGE)


def answered(sheet, seed, pen=None):
    """A sheet that somebody filled in, and what they wrote."""
    hand = a_hand(np.random.default_rng(seed), plain_digits)
    hand.pen = pen or hand.pen
    return filled_in(sheet, PAGE, hand)


def read(picture, papers=PAPERS):
    return read_page(PageImage("scan.pdf", 1, picture), papers, READER)


def told(page):
    return [(f.field.part, f.text, f.cases, f.waits) for f in page.fields]


@pytest.mark.sweep
@each_row("kind", KINDS)
def test_however_a_page_is_scanned_nothing_is_read_that_was_not_written(kind, sheet):
    rng = np.random.default_rng([7, *kind.encode()])
    filled, wrote = answered(sheet, rng)
    found = read(scanned(filled, KINDS[kind](rng), rng))
    assert found.found == "answers"
    sure = [(one, w) for one, w in zip(found.fields, wrote, strict=True) if not one.waits]
    for one, w in sure:
        assert not w.waits, f"{one.field.part} must wait: {w.how}"
        assert (one.text, one.cases) == (w.text, w.cases)
    assert len(sure) >= 2


@pytest.mark.sweep
@each_row("kind", KINDS)
@each_row("is_written", [False, True])
def test_what_is_written_below_the_rows_may_be_the_answer_of_a_blank_one(kind, is_written):
    page = example_page(rows=1)
    page = replace(
        page,
        fields=page.fields[:3],
        height=230.0,
        marks=tuple((x, y if y < 90 else 219.0) for x, y in page.marks),
    )
    rng = np.random.default_rng([11, *kind.encode()])
    hand = Hand(pen="blue", bank=plain_digits, jitter=0.2, rng=rng)
    sheet = plain_sheet(page)
    hand.begin(sheet)
    hand.cross(page.fields[1].ticks[0][1])
    if is_written:
        for k, digit in enumerate((1, 0, 4)):
            hand.digit(Box(40 + 6 * k, 150, 6, 8), digit)
    scan = replace(KINDS[kind](rng), stains=0)  # a drop of coffee may look like writing
    found = read(scanned(hand.finish(sheet), scan, rng), {"ABCDEFGHIJKLM": (page,)})
    expected = "elsewhere" if is_written else ""
    assert [f.waits for f in found.fields] == [expected, "", expected]
    assert [f.crop is not None for f in found.fields] == [is_written, False, is_written]


@pytest.mark.sweep
@each_row("kind", KINDS)
def test_a_scan_in_black_and_white_is_known_for_one(kind, sheet):
    rng = np.random.default_rng([3, *kind.encode()])
    filled, _ = answered(sheet, rng)
    assert is_two_toned(scanned(filled, KINDS[kind](rng), rng)) == (kind in ("black and white", "dithered"))


@each_row(("bilevel", "waits"), [("", False), ("otsu", True)])
def test_in_black_and_white_doubt_counts_tenfold(bilevel, waits, sheet):
    def hesitant(cells):
        found, sure = READER(cells)
        return found, np.minimum(sure, 0.998)

    hand = Hand(pen="black", bank=plain_digits, jitter=0.2, rng=np.random.default_rng(5))
    filled, _ = filled_in(sheet, PAGE, hand, odd=0.0)
    picture = scanned(filled, Scan(dpi=200, bilevel=bilevel), np.random.default_rng(0))
    found = read_page(PageImage("scan.pdf", 1, picture), PAPERS, hesitant)
    assert {bool(f.waits) for f in found.fields if f.field.what == "number" and f.text} == {waits}


def test_the_reader_sees_all_boxes_of_a_page_at_once(sheet):
    piles = []

    def counting(cells):
        piles.append(len(cells))
        return READER(cells)

    hand = Hand(pen="black", bank=plain_digits, jitter=0.2, rng=np.random.default_rng(5))
    filled, wrote = filled_in(sheet, PAGE, hand, odd=0.0)
    rows = [(f, w.text) for f, w in zip(PAGE.fields, wrote, strict=True) if f.what == "number"]
    picture = PageImage("scan.pdf", 1, scanned(filled, Scan(dpi=200), np.random.default_rng(0)))
    assert [f.text for f in read_page(picture, PAPERS, counting).fields] == [w.text for w in wrote]
    assert piles == [sum(sum(map(str.isdigit, text)) for _, text in rows)]
    first = next(f for f, text in rows if text)
    hand.stroke([(first.free.x + 3, first.free.y + 3), (first.free.x + 8, first.free.y + 6)])
    picture = PageImage("scan.pdf", 1, scanned(hand.finish(sheet), Scan(dpi=200), np.random.default_rng(0)))
    assert [f.waits for f in read_page(picture, PAPERS, counting).fields if f.field == first] == ["free"]
    assert piles[1] == piles[0] - sum(map(str.isdigit, dict(rows)[first]))


def test_no_reader_is_asked_about_a_page_without_digits(sheet):
    picture = PageImage("scan.pdf", 1, scanned(sheet, Scan(dpi=200), np.random.default_rng(0)))
    assert not any(f.text or f.waits for f in read_page(picture, PAPERS, None).fields)


@pytest.mark.parametrize("rows", few_and_all(simulated.PENS, 2))
def test_a_good_scan_is_read_whole_whatever_the_pen(rows, sheet):
    for pen in rows:
        hand = Hand(pen=pen, bank=plain_digits, jitter=0.2, rng=np.random.default_rng(5))
        filled, wrote = filled_in(sheet, PAGE, hand, odd=0.0)
        found = read(scanned(filled, Scan(dpi=200, skew=1.0), np.random.default_rng(0)))
        assert [bool(f.waits) for f in found.fields] == [w.waits for w in wrote]
        assert [f.text for f in found.fields] == [w.text for w in wrote]


@pytest.mark.e2e
def test_a_page_says_the_same_however_it_is_turned(sheet):
    filled, _ = answered(sheet, 11)
    upright = scanned(filled, Scan(dpi=200), np.random.default_rng(0))
    says = told(read(upright))
    for turn in (1, 2, 3):
        assert told(read(np.rot90(upright, turn))) == says, turn


@pytest.mark.parametrize("rows", few_and_all([0, 2, 3], 1))
def test_three_marks_are_enough(rows, sheet):
    for corner in rows:
        filled, wrote = answered(sheet, 2, "black")
        found = read(scanned(filled, Scan(dpi=200, cut_corner=corner, skew=2.0), np.random.default_rng(0)))
        assert found.found == "answers"
        assert [f.text for f in found.fields if not f.waits] == [
            w.text for w, f in zip(wrote, found.fields, strict=True) if not f.waits
        ]


def test_two_marks_are_not(sheet):
    cut = sheet.copy()
    for x, y in PAGE.marks[2:]:
        simulated._fill(cut, simulated.Box(x - 4, y - 4, 8, 8), 255)
    assert read(scanned(cut, Scan(), np.random.default_rng(0))).found == "not straight"


@pytest.mark.parametrize(
    "rows",
    few_and_all(
        [
            Scan(dpi=200, skew=9.0, shear=1.0),
            Scan(dpi=250, perspective=0.03, curve=3.0, table=True),
            Scan(dpi=250, fold=0.2),
            Scan(dpi=150, perspective=0.05, table=True),
        ],
        3,
    ),
)
@pytest.mark.e2e
def test_boxes_are_found_to_half_a_millimetre(rows, sheet):
    for scan in rows:
        picture = scanned(sheet, scan, np.random.default_rng(4))
        flat = straightened(picture, codes_in(picture)[0], PAGE)
        dark = 255 - flat.ink.astype(float)
        off = [
            _off(dark, flat.placed(box))
            for one in PAGE.fields
            for box in (*one.digits, *(b for _, b in one.ticks))
        ]
        assert np.abs(off).max() < 0.5


def _off(dark, box):
    """How far the outline of a box, seen where nothing is written, lies from where it was placed: mm, (x,
    y)."""
    reach, off = 6, []
    for level in (False, True):
        near = dark.T if not level else dark
        start, length = (box.x, box.height) if not level else (box.y, box.width)
        other = box.y if not level else box.x
        lines = slice(round((other + 1.5) * 10), round((other + length - 1.5) * 10))
        profile = near[round(start * 10) - reach : round(start * 10) + reach + 1, lines].mean(axis=1)
        off.append((int(profile.argmax()) - reach) / 10)
    return off


def coded(text, sheet):
    """The sheet with another code."""
    other = sheet.copy()
    simulated._code(other, replace(PAGE, code_text=text))
    return scanned(other, Scan(), np.random.default_rng(0))


@each_row(
    ("text", "what"),
    [
        ("CW1 ABCDEFGHIJKLM 0/1", "statement"),
        ("CW1 ZZZZZZZZZZZZZ 1/1", "other assignment"),
        ("CW1 ABCDEFGHIJKLM 7/9", "other assignment"),
        ("https://example.org", "no sheet"),
    ],
)
def test_what_is_no_answer_page_of_ours_is_told_with_its_picture(text, what, sheet):
    found = read(coded(text, sheet))
    assert (found.found, found.fields) == (what, ())
    assert found.grey.size
    assert found.code == text


def test_a_page_without_a_code_and_two_pages_in_one_picture_are_told(sheet):
    blank = np.full((1200, 900), 250, np.uint8)
    assert read(blank).found == "no code"
    both = np.hstack([coded("CW1 ABCDEFGHIJKLM 1/1", sheet), coded("CW1 ABCDEFGHIJKLM 2/2", sheet)])
    assert read(both).found == "two pages"


def test_what_waits_has_a_crop_to_scale(sheet):
    hand = Hand(bank=plain_digits, rng=np.random.default_rng(0))
    hand.begin(sheet)
    drawing = PAGE.fields[-1]
    hand.scribble(drawing.whole)
    found = read(scanned(hand.finish(sheet), Scan(dpi=200, skew=3.0), np.random.default_rng(0))).fields[-1]
    assert found.waits == "drawing"
    assert found.crop.shape == ((30 + 4) * 10, (60 + 4) * 10)


def ring(hand, x, y, radius):
    turn = np.linspace(0, 2 * np.pi, 25)
    hand.stroke(list(zip(x + radius * np.cos(turn), y + radius * np.sin(turn), strict=True)))


def said_of_choice(sheet, write):
    """What the first question with boxes to tick says where ``write`` has written."""
    hand = Hand(bank=plain_digits, rng=np.random.default_rng(0))
    hand.begin(sheet)
    choice = next(f for f in PAGE.fields if f.what == "ticks")
    write(hand, dict(choice.ticks)["case1"], choice)
    page = read(scanned(hand.finish(sheet), Scan(dpi=200, skew=1.0), np.random.default_rng(0)))
    return next(f for f in page.fields if f.field.part == choice.part)


@pytest.mark.parametrize(
    "rows",
    few_and_all(
        [
            lambda hand, box, row: ring(hand, box.x + 2.5, box.y + 2.5, 4.2),
            lambda hand, box, row: ring(hand, box.right + 2.6, box.y + 2.5, 2.9),
            lambda hand, box, row: hand.scribble(replace(box, x=row.ticks[-1][1].right + 12, width=20)),
            lambda hand, box, row: (hand.cross(row.ticks[-1][1]), ring(hand, box.x + 2.5, box.y + 2.5, 4.2)),
        ],
        2,
    ),
)
def test_what_is_written_beside_boxes_to_tick_waits(rows, sheet):
    for write in rows:
        assert said_of_choice(sheet, write).waits == "free"


def test_a_cross_may_go_beyond_its_box(sheet):
    def generous(hand, box, row):
        x0, y0, x1, y1 = box.x - 1.6, box.y - 1.6, box.right + 1.6, box.bottom + 1.6
        hand.stroke([(x0, y0), (x1, y1)])
        hand.stroke([(x1, y0), (x0, y1)])

    found = said_of_choice(sheet, generous)
    assert (found.cases, found.waits) == (("case1",), "")


@each_row("called", ["none", "0"])
def test_none_ticked_with_others_waits_whatever_it_is_called(called, sheet):
    several = next(f for f in PAGE.fields if f.several)
    ticks = (*several.ticks[:-1], (called, several.ticks[-1][1]))
    page = replace(PAGE, fields=tuple(replace(f, ticks=ticks) if f is several else f for f in PAGE.fields))
    hand = Hand(bank=plain_digits, rng=np.random.default_rng(0))
    hand.begin(sheet)
    hand.cross(ticks[0][1])
    hand.cross(ticks[-1][1])
    picture = scanned(hand.finish(sheet), Scan(dpi=200), np.random.default_rng(0))
    found = read(picture, {"ABCDEFGHIJKLM": (page,)}).fields[PAGE.fields.index(several)]
    assert (found.waits, found.cases) == ("two ticks", (ticks[0][0], called))
