"""Tables that other programs open."""

from __future__ import annotations

import sys
import unicodedata

from coursework.system.tables import as_written, inert


def test_no_cell_begins_with_a_sign_that_a_spreadsheet_may_take_for_a_formulas():
    """The signs of every width are looked for in all of Unicode."""
    signs = [*"=+-@"]
    for character in map(chr, range(sys.maxunicode + 1)):
        form, _, plain = unicodedata.decomposition(character).partition(" ")
        if form in ("<wide>", "<narrow>", "<small>") and chr(int(plain.split()[0], 16)) in "=+-@":
            signs.append(character)
    assert set("＝＋－＠﹢﹣﹦﹫") <= set(signs)
    for sign in signs:
        cell = f"{sign}SUM(A1:A9)"
        assert inert(cell) == f"'{cell}", f"U+{ord(sign):04X}"
        assert as_written(inert(cell)) == cell
