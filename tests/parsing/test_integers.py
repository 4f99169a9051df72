"""Whole numbers are read however they are written."""

from tables import each_row

from coursework.parsing.numbers import read_integer


@each_row(
    ("text", "value"),
    [
        ("3", 3),
        ("3,0", 3),
        ("γ = 3", 3),
        ("-2", -2),
        ("2+1", 3),
        ("1,234", 1234),
        ("1 234", 1234),
        ("1 ddl", 1),
        ("2 degrés de liberté", 2),
        ("3 dof", 3),
        (3, 3),
        (3.0, 3),
    ],
)
def test_an_integer_is_read_however_it_is_written(text, value):
    reading = read_integer(text)
    assert reading.values == (value,)
    assert type(reading.values[0]) is int


@each_row("text", ["2.5", "1/3", "1e30", 2.5, "0,1"])
def test_a_number_that_is_not_whole_is_said_so(text):
    reading = read_integer(text)
    assert (reading.status, reading.code, reading.text) == ("unreadable", "not_an_integer", str(text))
