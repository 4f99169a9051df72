"""Charts: titles that are not cut, and what becomes of a command where no chart can be drawn."""

from __future__ import annotations

import io
import re
import sys

import numpy as np
import pytest
from matplotlib.image import imread
from tables import each_row

from coursework.cli import run
from coursework.figures import charts
from coursework.figures.typesetting import converted
from coursework.system.distribution import add_extra

LONG = {
    "fr": "Réponses justes\u00a0: L’angle de transmission et l’avantage mécanique d’un étau-limeur à retour rapide désaxé",
    "en": "Right answers: Transmission angle and mechanical advantage of an offset quick-return shaper mechanism",
}
TURN = np.linspace(0, 360, 20)
DRAWN = {
    "bars": lambda title: charts.bars(
        [("1", 20, "20 %"), ("forgets the projection of the velocity", 9, "9 %")], title, "h"
    ),
    "histogram": lambda title: charts.histogram([1, 2, 3], [0, 1, 2, 3], title, "h", "v"),
    "scatter": lambda title: charts.scatter(
        {"a method with a long name of its own": ([1, 10], [1, 10])}, title, "h", "v"
    ),
    "curves": lambda title: charts.curves(("t [s]", TURN), {"a_long_name_of_a_quantity": TURN}, {"a_long_name_of_a_quantity": "mm"}, title),
}  # fmt: skip


def picture(svg):
    width = float(re.search(rb'width="([\d.]+)pt"', svg).group(1)) * 25.4 / 72
    return imread(io.BytesIO(converted(svg.decode(), width, "png", 72)))


def lines_of(svg):
    return re.findall(r"<!-- (.*?) -->", svg.decode())


@each_row("lang", LONG)
@each_row("kind", DRAWN)
def test_a_long_title_is_whole_and_within_its_chart(kind, lang):
    svg = DRAWN[kind](LONG[lang])
    assert LONG[lang] in " ".join(lines_of(svg))
    drawn = picture(svg)[..., :3]
    edges = np.concatenate([drawn[:30, :2], drawn[:30, -2:]])
    assert edges.min() == 1  # white


def test_a_title_of_one_long_word_is_cut_into_lines_and_nothing_is_lost():
    word = "a_very_long_exercise_name_" * 6
    svg = DRAWN["curves"](word)
    assert word in "".join(lines_of(svg))
    assert picture(svg)[:30, :2, :3].min() == picture(svg)[:30, -2:, :3].min() == 1


@each_row("kind", DRAWN)
def test_a_short_title_stands_over_its_panel_on_one_line(kind):
    lines = lines_of(DRAWN[kind]("Points"))
    assert lines.count("Points") == 1


@pytest.fixture
def without_matplotlib(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)


def test_simulate_without_matplotlib_writes_its_table_and_says_so(tmp_path, without_matplotlib, capsys):
    scene = ["simulate", "slotted_mechanism", "--steps", "6", "--out", str(tmp_path)]
    assert run(scene) == 0
    told = capsys.readouterr()
    assert told.err.count("\n") == 1
    assert "all is written but the charts: charts need matplotlib, which is not installed" in told.err
    assert add_extra("charts") in told.err
    assert told.out.endswith("slotted_mechanism-cycle.csv\n")
    assert [p.name for p in tmp_path.iterdir()] == ["slotted_mechanism-cycle.csv"]
    assert len((tmp_path / "slotted_mechanism-cycle.csv").read_text("utf-8").splitlines()) == 8


def test_a_matplotlib_that_cannot_be_loaded_is_told_as_such(tmp_path, monkeypatch, capsys):
    """As one does that was built for another NumPy."""
    (tmp_path / "matplotlib").mkdir()
    (tmp_path / "matplotlib" / "__init__.py").write_text("raise AttributeError('_ARRAY_API not found')\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "matplotlib")
    assert run(["simulate", "slotted_mechanism", "--steps", "6", "--out", str(tmp_path / "scene")]) == 0
    told = capsys.readouterr().err
    assert "installed and cannot be loaded (AttributeError: _ARRAY_API not found)" in told
    assert "not installed" not in told
