"""No cell of a table is computed by the spreadsheet that opens it, however it parts them, and every text
comes back."""

from __future__ import annotations

import csv
import io
import re

import hypothesis.strategies as st
from hypothesis import example, given
from rows_of_strangers import is_computed, seen_by_a_spreadsheet
from tables import each_row

from coursework.system.tables import SPREADSHEETS, as_written, csv_text, inert

ALIVE = (
    "=A1",
    "=1+2",
    "+A1",
    "-A1",
    "@SUM(A1)",
    "＝1+1",
    "＋A1",
    "－A1",
    "＠A1",
    '="a"&"b"',
    "='file:///etc/passwd'#$x.A1",
    "x;=cmd|' /C calc'!A0",
    "x,=cmd|' /C calc'!A0",
    "x\t=A1",
    "\t=A1",
    "\r=A1",
    "\n=A1",
    "a\r\n=A1",
    " =A1",
    "\u00a0=A1",
    "\ufeff=A1",
    "\u200b=A1",
    "\x1b=A1",
    'x;"=cmd|x!A',
    "-3,5+cmd|x!A",
    "-2+3",
    "-3*x",
    "3;-1+cmd|x!A",
    "x\u2028=A1",
    "=",
    "x;;=A1",
    "1;+HYPERLINK(A1)",
)
PLAIN = (
    "-3",
    "+3,5",
    "-12.5 mm",
    "-1,5e-3 rad/s",
    "-3; -4,5",
    "(-3 ; -4)",
    "(3, -4); (5, -6)",
    "[26.0, -19.0]; [19.0, 26.0]",
    "-",
    "--",
    "-45°",
    "12 mm",
    "-3 m/s^2",
    "-2 %",
    "a=b",
    "x - y",
    "l'été",
    "'t Hooft",
    "-1/2",
)


@each_row("spreadsheet", SPREADSHEETS.values())
@each_row("text", ALIVE)
def test_no_way_to_part_the_cells_makes_one_that_is_computed(text, spreadsheet):
    assert any(map(is_computed, seen_by_a_spreadsheet(csv_text_of(text, raw=True))))
    for columns in (("student", "answer"), (text, "answer")):
        told = csv_text([dict.fromkeys(columns, text)], columns, spreadsheet)
        assert not [cell for cell in seen_by_a_spreadsheet(told) if is_computed(cell)]


def csv_text_of(text, raw):
    out = io.StringIO()
    csv.writer(out).writerows([["student", "answer"], [text, text]])
    return out.getvalue()


@each_row("text", PLAIN)
def test_numbers_with_their_units_and_words_stay_as_they_are(text):
    assert inert(text) == text == as_written(text)


TEXTS = st.text(
    st.sampled_from("=+-@＝'\";,|!( \t\r\n\u00a0\u200b\ufeff\x1b\\\u2028^eE[]){}0123456789.abcé"), max_size=24
)


@given(TEXTS | st.text(max_size=12))
@example("\t'=A1")
@example(";' =A1")
def test_every_text_comes_back_from_its_cell(text):
    (row,) = csv.DictReader(io.StringIO(csv_text([{"a": text}], ["a"]), newline=""))
    assert as_written(row["a"]) == text


@given(TEXTS)
def test_no_text_has_a_formula_after_it_was_made_inert(text):
    once = inert(text)
    for start in re.split(r"[\t\n\v\f\r;,\x85\u2028\u2029]", once):
        bare = start.lstrip(' "\u00a0\u200b\ufeff\x1b')
        assert bare[:1] not in ("=", "@", "＝"), once
        if bare[:1] in ("+", "-"):
            assert re.fullmatch(r"[+-][ \u00a0]?[0-9.].*|[+-][\s+-]*", bare, re.DOTALL), once
