"""Figures: drawn to scale, labels readable, the same bytes every time."""

import re
import struct
import subprocess
import sys
import threading
import xml.etree.ElementTree as ET

import pytest
from drawn_svg import SVG, strokes
from figure_samples import SAMPLES, every_sample, four_bar, slotted
from tables import each_row

from coursework.errors import WrongValue
from coursework.figures import (
    Figure,
    angle_mark,
    circle,
    ground_pivot,
    link,
    pin,
    point,
    scale_bar,
    slider,
    trace,
    vector,
)


def test_the_drawing_is_to_scale():
    figure = four_bar()
    paths = [points for points in strokes(figure) if len(points) == 2]
    heavy = [
        p
        for p, item in zip(strokes(figure), ET.fromstring(figure.svg())[1], strict=True)
        if item.get("stroke-width") == "0.6"
    ]
    assert len(paths) > len(heavy) == 3
    lengths = [abs(points[1] - points[0]) for points in heavy]
    assert lengths == pytest.approx([70 * figure.scale, 180 * figure.scale, 120 * figure.scale], abs=0.15)


@every_sample
def test_bars_meet_their_pins_exactly_and_lie_on_tenths_of_a_millimetre(name):
    drawing = ET.fromstring(SAMPLES[name]().svg())[1]
    pins = {(item.get("cx"), item.get("cy")) for item in drawing if item.tag == SVG + "circle"}
    bars = [item for item in drawing if item.get("stroke-width") == "0.6" and item.tag == SVG + "path"]
    assert bars or name == "ball_reducer"
    for item in bars:
        for end in re.findall(r"[ML]([^MLZ]*)", item.get("d")):
            assert all(re.fullmatch(r"\d+(\.\d)?", x) for x in end.split())
        if name != "two_loops":  # its bent bar ends on no pin
            assert {tuple(end.split()) for end in re.findall(r"[ML]([^MLZ]*)", item.get("d"))} <= pins


def test_a_figure_uses_its_paper_up_and_keeps_its_aspect():
    tall = Figure(link(0, 300j), ground_pivot(0, "O"), paper_mm=(50, 60))
    assert 56 < tall.size_mm[1] <= 60
    assert tall.size_mm[0] < 20


@every_sample
def test_the_same_figure_gives_the_same_bytes(name):
    first, second = SAMPLES[name](), SAMPLES[name]()
    assert first == second
    assert first.svg() == second.svg()
    assert first.outlined_svg() == second.outlined_svg()
    assert first.png(60) == second.png(60)
    assert first.pdf() == second.pdf()


def test_threads_draw_what_the_main_thread_draws():
    found = {}
    threads = [threading.Thread(target=lambda k=k: found.update({k: slotted().png(60)})) for k in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert set(found.values()) == {slotted().png(60)}


def test_importing_figures_loads_neither_typst_nor_numpy():
    code = "import sys, coursework.figures; print(sorted({'typst', 'numpy'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_png_has_the_size_of_the_drawing():
    figure = four_bar()
    width, height = struct.unpack(">II", figure.png(254)[16:24])
    assert (width / 10, height / 10) == pytest.approx(figure.size_mm, abs=0.2)


def test_svg_is_black_on_white_and_measured_in_millimetres():
    root = ET.fromstring(slotted().svg())
    width, height = slotted().size_mm
    assert float(root.get("width").removesuffix("mm")) == width
    assert [float(x) for x in root.get("viewBox").split()] == [0, 0, width, height]
    assert set(re.findall(r"#[0-9a-f]{3,6}", slotted().svg())) <= {"#000", "#fff", "#e4e4e4"}
    assert root.find(SVG + "title") is None


@each_row(
    ("build", "named"),
    [
        (lambda: pin(complex("nan"), "A"), "pin: p"),
        (lambda: link(0, float("inf")), "bar: points"),
        (lambda: circle(0, -3), "circle: radius"),
        (lambda: slider("A", 0), "slider: p"),
        (lambda: angle_mark(0, 0, float("nan"), "a"), "angle_mark: to_deg"),
        (lambda: pin(0, 3), "pin: label"),
        (lambda: Figure(pin(3 + 4j, "A"), ground_pivot(3 + 4j, "B")), "pin, ground_pivot"),
        (lambda: Figure(), "no element"),
        (lambda: Figure("pin"), "'pin'"),
        (lambda: four_bar_in(8, 8).svg(), "too small"),
        (lambda: pin(0, "r_{2"), "} expected after a group"),
        (lambda: pin(0, "r_"), "nothing after _"),
    ],
)
def test_a_wrong_figure_is_refused_and_the_element_named(build, named):
    with pytest.raises(WrongValue, match=re.escape(named)):
        build()


def four_bar_in(width, height):
    return Figure(*four_bar().elements, paper_mm=(width, height))


def test_a_figure_with_a_scale_of_its_own_keeps_it_whatever_its_size():
    figure = Figure(vector(0, 30 + 40j, "v"), scale=1)
    assert figure.scale == 1
    (arrow, _) = strokes(figure)
    assert abs(arrow[-1] - arrow[0]) == pytest.approx(50, abs=3)
    assert Figure(vector(0, 300j), scale=2).size_mm[1] > 600
    with pytest.raises(WrongValue, match="positive"):
        Figure(vector(0, 1), scale=0)


def test_the_beginning_of_a_figure_is_its_first_elements_where_they_are_in_the_whole():
    elements = (point(0, "p"), vector(0, 30, "v"), point(30, "a"), vector(30, 20j, "w"))
    whole = Figure(*elements, scale=1)
    start = whole.beginning(3)
    assert start.size_mm == whole.size_mm
    assert whole.beginning(4).svg() == whole.svg()
    assert whole.beginning(4).outlined_svg() == whole.outlined_svg()
    kept, lines = start.svg().splitlines(), whole.svg().splitlines()
    assert [line for line in lines if line in kept] == kept
    assert ">w<" not in start.svg()
    assert ">v<" in start.svg()
    assert ">v<" not in whole.beginning(1).svg()


def test_a_bar_of_scale_is_as_long_as_it_says_with_its_words_under_it():
    figure = Figure(scale_bar(0, 20, "100 mm/s"), point(10j), scale=1)
    bar = max(strokes(figure), key=lambda points: abs(points[-1] - points[0]) if len(points) == 2 else 0)
    assert abs(bar[1] - bar[0]) == pytest.approx(20)
    (label,) = figure.labels()
    assert label.y > bar[0].imag


def test_a_figure_laid_out_for_a_room_keeps_its_letters_and_changes_its_bars():
    whole = four_bar()
    small = whole.fitted(60, 40)
    assert small.size_mm[0] <= 60
    assert small.size_mm[1] <= 40
    assert small.scale < whole.scale
    heights = {box.label: box.height for box in whole.labels()}
    assert {box.label: box.height for box in small.labels()} == heights
    assert small is whole.fitted(60, 40)


def test_a_room_does_not_overrule_what_an_author_told():
    elements = link(0, 100), link(100, 100 + 80j)
    assert Figure(*elements, paper_mm=(50, 60)).fitted(112, 58).paper_mm == (50, 58)
    drawn_to_scale = Figure(*elements, scale=1)
    assert drawn_to_scale.fitted(40, 40) is drawn_to_scale


def test_a_room_too_small_for_the_labels_leaves_the_figure_as_it_is():
    whole = four_bar()
    assert whole.fitted(6, 6) is whole


def test_a_trace_is_dotted_unless_told():
    corners = (0, 50, 50 + 50j)
    assert "stroke-dasharray" in Figure(trace(corners)).svg()
    assert "stroke-dasharray" not in Figure(trace(corners, dotted=False)).svg()
