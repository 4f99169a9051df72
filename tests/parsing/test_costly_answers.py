"""No answer costs much to read, however it is made: what would be tried in all its ways is tried once."""

import pytest
from tables import each_row

from coursework import open_course
from coursework.parsing import several
from coursework.parsing.graph_tokens import plain
from coursework.parsing.graphs import graph_of, read_graph

LONGEST = 4000  #: characters of an answer
GRAPH = graph_of("1-2 revolute, 2-3 revolute")
PIECES = (
    "\n",
    "\\\\",
    " ",
    "\t",
    "1",
    "1 ",
    "1\n",
    "1:",
    "1)",
    ";",
    "; ",
    "-",
    "=",
    "=-",
    "<=",
    "(",
    "(1,2,a ",
    "joint ",
    "l",
    "l1:",
    "revolut ",
    "1-2 x 9;",
    "'a' ",
    "'",
    '"',
    "_",
    "~",
    "a",
    "P",
)


@each_row("piece", PIECES)
@each_row("way", ["{0}", "1{0}x", "({0}", "1-2 pivot{0}:"])
@pytest.mark.e2e
def test_a_graph_of_one_piece_over_and_over_is_read_at_once(piece, way):
    """Blank lines alone took hours, and every other request waited; a test that hangs has failed."""
    text = way.format(piece * LONGEST)[:LONGEST]
    assert read_graph(text, GRAPH).status in ("read", "unreadable", "missing")


CASES = {"fast": ("runs fast", "va vite"), "stable": ("is stable, and stays so",), "none_of": ("neither",)}


def test_several_cases_are_looked_for_in_few_pieces_whatever_the_answer(monkeypatch):
    """Blank space is none of them: a text of 4000 spaces took 0.3 s."""
    read, tried = several.read_choice, []
    monkeypatch.setattr(
        several, "read_choice", lambda text, choices: tried.append(len(text)) or read(text, choices)
    )
    over = {}
    for piece in (*PIECES, " ", "a, ", "[ ] a\n", ", ", "fast,", "and "):
        for way in ("{0}", "fast{0}stable", "[x] {0}"):
            tried.clear()
            several.read_choices(way.format(piece * LONGEST)[:LONGEST], CASES)
            if sum(tried) > 100_000:
                over[way, piece] = sum(tried)
    assert not over


def test_blank_space_between_cases_is_no_more_than_one_space():
    for blank in (" " * 3000, "\n" * 3000, " \t\n" * 900):
        assert several.read_choices(f"fast,{blank}stable", CASES).values == (frozenset({"fast", "stable"}),)


@each_row(
    ("told", "bare"),
    [
        ("1) 1-2 pivot", " 1-2 pivot"),
        ("L1: 1-2 pivot\n  joint 2 : 2-3 pivot", " 1-2 pivot\n 2-3 pivot"),
        ("1-2 pivot; 2) 2-3 pivot", "1-2 pivot; 2-3 pivot"),
        ("\n\n 1) 1-2 pivot", "1-2 pivot"),
    ],
)
def test_the_numbers_of_a_list_are_no_bodies(told, bare):
    assert plain(told).split() == plain(bare).split()


@pytest.fixture(scope="module")
def variant():
    return open_course()["slotted_mechanism"].variant(1, "en")


@each_row(
    "text",
    [
        "9**9**9**9",
        "9^9^9^9^9",
        "(" * LONGEST,
        "(" * 5000 + "1" + ")" * 5000,
        "1" + "0" * 5000,
        "1e" + "9" * 300,
        "2^-(2^(9^9))",
        "1 m^999999999",
        "1 " + "m*" * 200,
        "sqrt(" * 90,
        "cos " * 120,
        "1" + "+1" * 240,
        "-" * 499 + "1",
        "\\frac{" * 80,
        "1/" * 249 + "1",
        "((((",
        "[" * 499,
        "7 " * 249,
    ],
)
def test_a_formula_that_would_never_end_is_refused(variant, text):
    for part in variant.parts:
        assert variant.grade({part.id: text})[part.id].verdict != "correct"
