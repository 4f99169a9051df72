"""What a message quotes of an answer is what was typed, however it is spelled to be read."""

import re

from tables import each_row

from coursework.parsing.spelling import as_typed, plain_spelling, spelled_out


@each_row(
    "text",
    [
        "12 s² ou 3",
        "sin(θ4) + r4",
        r"\frac{a}{b} \circ c",
        "−2,5 m·s⁻²",
        "{,}5 ; ṙ2",
        r"3 \mathrm{mm}^2",
        "é+e\u0301=x",
    ],
)
def test_a_piece_is_quoted_as_it_was_typed(text):
    """As trying each piece of the text finds it, the first and longest first."""
    plain = plain_spelling(text)
    pieces = {plain, spelled_out(plain).strip(), *re.split(r"[\s+;=]+", plain), *spelled_out(plain).split()}
    for piece in pieces - {""}:
        tried = (
            text[a:b].strip()
            for a in range(len(text))
            for b in range(len(text), a, -1)
            if not text[a].isspace()
        )
        found = (
            one for one in tried if piece in (plain_spelling(one), spelled_out(plain_spelling(one)).strip())
        )
        assert as_typed(piece, text) == (piece if piece in text else next(found, piece)), piece
