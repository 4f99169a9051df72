"""Drawings on a dark page: each colour of the palette has a counterpart that is seen, and only ours are
changed."""

import itertools
import re
from pathlib import Path

import coursework
from coursework.figures import Figure, bar
from coursework.figures.dark import DARK, dark_rules, darkened
from coursework.figures.ink import BLACK, SHADES, WHITE
from coursework.figures.plot import GRID
from coursework.rendering.html import environment_of, svg_image

PACKAGE = Path(coursework.__file__).parent
FAINT = {WHITE, GRID, *SHADES.values(), "#ddd", "#ccc", "#b8b8b8", "#999"}  #: grounds, fills and grids


def linear(colour):
    parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    return [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]


def light(colour):
    return sum(share * part for share, part in zip((0.2126, 0.7152, 0.0722), linear(colour), strict=True))


def test_colours_are_seen_on_a_dark_page_and_told_apart():
    shown = {colour: dark for colour, dark in DARK.items() if colour not in FAINT}
    ground = light(DARK[WHITE]) + 0.05
    assert {
        c: round((light(dark) + 0.05) / ground, 1)
        for c, dark in shown.items()
        if light(dark) + 0.05 < 4.5 * ground
    } == {}
    near = [
        (a, b)
        for a, b in itertools.combinations(set(shown.values()) - {DARK["#777"]}, 2)
        if sum(abs(x - y) for x, y in zip(linear(a), linear(b), strict=True)) < 0.15
    ]
    assert near == []


def test_every_colour_of_a_drawing_has_a_counterpart():
    folders = ("figures", "figures/polygons", "rendering", "site/practice", "site/mechanisms")
    files = [path for folder in folders for path in (PACKAGE / folder).glob("*.py") if path.name != "dark.py"]
    colours = {
        found for path in files for found in re.findall(r'"(#[0-9a-f]{3,8})[" ]', path.read_text("utf-8"))
    }
    assert colours - set(DARK) == set()
    assert len(colours) > 10


def test_a_drawing_says_what_it_becomes_and_one_of_other_colours_stays():
    svg = Figure(bar((0, 3 + 1j), label="r")).outlined_svg()
    dark = darkened(svg)
    assert f'[fill="{BLACK}"]{{fill:{DARK[BLACK]}}}' in dark
    assert re.sub("<style>.*?</style>", "", dark) == svg
    others = svg.replace(BLACK, "#123456")
    assert darkened(others) == others
    assert 'class="white"' in svg_image(others, "")
    assert "class" not in svg_image(svg, "") + svg_image(svg, "", goes_dark=False)
    assert "prefers" not in svg_image(svg, "", goes_dark=False)


def test_pages_give_the_drawings_that_are_their_elements_the_same_colours():
    page = environment_of((), "en").globals["dark_rules"]
    assert page == dark_rules()
    assert page.count("{") == 2 * len(DARK)
