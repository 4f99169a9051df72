"""Files of assignments that nobody writes: told in a line, at once."""

import pytest
from tables import each_row

from coursework import open_course
from coursework.errors import BadInput
from coursework.issuing.assignment import assignment_of
from coursework.rendering.papers import logo_svg
from coursework.sheets.paper import Logo
from coursework.system.toml_files import table_of


@pytest.fixture(scope="module")
def course():
    return open_course()


@each_row(
    "source",
    [
        "a = " + "[" * 100_000,
        "a = " + "[" * 900 + "]" * 900,
        "a = " + "{b=" * 5000,
        ".".join(["a"] * 20_000) + " = 1",
        "[" + ".".join(["a"] * 20_000) + "]",
        "a = 0x" + "f" * 5000,
        "a = " + "9" * 5000,
        'a = """' + "x" * 2_000_000 + '"""',
        '"\\ud800" = 1',
    ],
)
def test_what_is_no_assignment_is_told_in_a_line(source):
    with pytest.raises(BadInput, match=r"^week3.toml") as told:
        table_of(source, "week3.toml")
    assert len(str(told.value)) < 300


@each_row("value", ["x" * 10**6, [""] * 10**4, {"en": ["x"] * 10**5}, [[["a"]]] * 1000])
@each_row("key", ["date", "mark", "versions", "identity", "sort", "cover", "duration"])
def test_a_value_that_is_refused_is_quoted_in_short(course, key, value):
    with pytest.raises(BadInput) as told:
        assignment_of("week3", {"exercises": ["grashof"], "title": "x", key: value}, course)
    assert len(str(told.value)) < 500


@each_row("key", ["name", "parts", "points", "seed", "x" * 10**5])
@each_row("value", ["x" * 10**6, ["x" * 10**6], {"x" * 10**6: 1}])
@pytest.mark.e2e
def test_so_is_a_value_in_an_exercise(course, key, value):
    with pytest.raises(BadInput) as told:
        assignment_of("week3", {"exercises": [{"name": "grashof", key: value}]}, course)
    assert len(str(told.value).partition("; available: ")[0]) < 500


@each_row(
    "planted",
    [
        "<script/>",
        '<image href="secret.png"/>',
        '<image href="/etc/x.png"/>',
        '<img srcset="//x.example/a"/>',
    ],
)
def test_a_logo_runs_nothing_and_holds_no_other_file(planted):
    svg = (
        '<svg xmlns="http://www.w3.org/2000/svg" width="10" height="5" viewBox="0 0 10 5"><rect width="9" '
        f'height="4"/>{planted}</svg>'
    )
    with pytest.raises(BadInput, match=r"^the logo: .*runs nothing and fetches nothing"):
        logo_svg(Logo(svg.encode(), "svg", "x"))
    assert logo_svg(Logo(svg.replace(planted, "").encode(), "svg", "x"))
