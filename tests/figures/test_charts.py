"""Charts: bars and points to scale, and titles that are not cut."""

from __future__ import annotations

import re

import cv2
import numpy as np
import pytest
from tables import each_row

from coursework.cli import run
from coursework.figures import charts
from coursework.figures.plot import Axis, Plot, _title_lines
from coursework.figures.typesetting import converted

LONG = {
    "fr": "Réponses justes\u00a0: L’angle de transmission et l’avantage mécanique d’un étau-limeur à retour "
    "rapide désaxé",
    "en": "Right answers: Transmission angle and mechanical advantage of an offset quick-return shaper "
    "mechanism",
}
TURN = np.linspace(0, 360, 20)
DRAWN = {
    "bars": lambda title: charts.bars(
        [("1", 20, "20 %"), ("forgets the projection of the velocity v\u20d7", 9, "9 %")], title, "h"
    ),
    "histogram": lambda title: charts.histogram([1, 2, 3], [0, 1, 2, 3], title, "h", "v"),
    "scatter": lambda title: charts.scatter(
        {"a method with a long name of its own": ([1, 10], [1, 10])}, title, "h", "v"
    ),
    "curves": lambda title: Plot(Axis("t", "s", TURN), [Axis("y", "mm", TURN)], title=title).svg(),
}


def picture(svg):
    width = float(re.search(r'width="([\d.]+)mm"', svg)[1])
    return cv2.imdecode(np.frombuffer(converted(svg, width, "png", 72), np.uint8), cv2.IMREAD_GRAYSCALE)


@each_row("lang", LONG)
@each_row("kind", DRAWN)
def test_a_long_title_is_whole_and_within_its_chart(kind, lang):
    drawn, short = (picture(DRAWN[kind](title)) for title in (LONG[lang], "Points"))
    assert len(drawn) > len(short)  # a line more
    assert np.concatenate([drawn[:28, :2], drawn[:28, -2:]]).min() == 255


def test_a_title_of_one_long_word_is_cut_into_lines_and_nothing_is_lost():
    word = "a_very_long_exercise_name_" * 6
    lines = _title_lines(word, 100)
    assert len(lines) > 1
    assert "".join(lines) == word


def test_bars_are_as_long_as_their_numbers_and_the_axis_reaches_its_end():
    svg = charts.bars([("a", 20, ""), ("b", 50, ""), ("c", 0, "")], "t", "h", full=100)
    first, second, none = (float(x) for x in re.findall(r'h([\d.]+)v3.4h[-\d.]+z"', svg))
    whole = float(re.search(r'H([\d.]+)" stroke="#000"', svg)[1]) - float(
        re.search(r"<path d=\"M([\d.]+) 0v", svg)[1]
    )
    assert [first / whole, second / whole, none] == pytest.approx([0.2, 0.5, 0], abs=1e-3)


def test_points_stand_at_their_powers_of_ten_and_what_has_none_is_left_out():
    svg = charts.scatter({"m": ([1e-3, 1e-2, 1e-1, 1], [1e-9, 1e-6, 1e-3, 0.0])}, "t", "h", "v")
    run = re.search(r'<path d="M([^"]*)" fill="none" stroke="#1b3a57"', svg)[1].split("L")
    steps = np.diff([tuple(map(float, point.split())) for point in run], axis=0)
    assert len(run) == 3
    assert steps[0] == pytest.approx(steps[1], abs=0.011)
    assert steps[0, 0] > 0 > steps[0, 1]


def test_a_letter_has_its_outline_once():
    svg = charts.bars([("aaaa", 1, "a")], "aa", "a")
    outlines = re.findall(r'<path id="g\d+" d="([^"]*)"', svg)
    assert len(outlines) == len(set(outlines)) > 0
    assert svg.count("<use ") > len(outlines)


def test_simulate_draws_a_panel_for_each_column(tmp_path, capsys):
    assert run(["simulate", "slotted_mechanism", "--steps", "6", "--out", str(tmp_path)]) == 0
    assert capsys.readouterr().out.endswith("slotted_mechanism-cycle.csv, .svg\n")
    heads = (tmp_path / "slotted_mechanism-cycle.csv").read_text("utf-8-sig").splitlines()[0].split(",")
    svg = (tmp_path / "slotted_mechanism-cycle.svg").read_text("utf-8")
    assert svg.count('stroke-linejoin="round"') == len(heads) - 1
