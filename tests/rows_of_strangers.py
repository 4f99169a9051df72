"""Texts that strangers send: what acts on a terminal, what a spreadsheet computes, and how both are found."""

from __future__ import annotations

import csv
import io
import re

#: What no terminal may be handed: control characters but tabulators and ends of lines, and what turns a text
#: about.
ACTING = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]")
FORMULA = "x;=cmd|' /C calc'!A0"


def computed_cells(text):
    return [cell for cell in seen_by_a_spreadsheet(text) if is_computed(cell)]


def seen_by_a_spreadsheet(text):
    """The cells that some way to open a table makes of it: by each separator, with quotation marks and
    without."""
    for delimiter in ",;\t":
        for row in csv.reader(io.StringIO(text, newline=""), delimiter=delimiter):
            yield from row
        for line in re.split(r"[\r\n\v\f\x85\u2028\u2029]", text):
            yield from line.split(delimiter)


UNSEEN = ' "\t\r\n\v\f\u00a0\u200b\u2028\ufeff\x1b\x85'
ONE = r"[+-] ?[0-9.,]*[0-9](e[+-]?[0-9]+)?[^=+@|!&'$*<>#-]*"


def is_computed(cell):
    """Whether it begins with what begins a formula, and is not a number or list of numbers with their
    units."""
    bare = cell.lstrip(UNSEEN)
    if not bare or bare[0] not in "=+-@＝＋－＠﹦﹢﹣﹫":
        return False
    return not re.fullmatch(rf"{ONE}([;,] ?[([]?{ONE})*|[\s+-]*", bare, re.I | re.S)
