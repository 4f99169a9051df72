"""Figures: drawn to scale, labels readable, the same bytes every time."""

import cmath
import math
import random
import re
import struct
import subprocess
import sys
import threading
import xml.etree.ElementTree as ET
from itertools import pairwise

import pytest
import typst
from drawn_svg import SVG, assert_readable, crossed, kinds, strokes

from coursework.errors import UnknownName, WrongValue
from coursework.figures import (
    Figure,
    angle_mark,
    arc,
    axes,
    ball,
    centre_line,
    circle,
    contact,
    dimension,
    ground_pivot,
    line,
    link,
    note,
    pin,
    point,
    rail,
    rotation_arrow,
    scale_bar,
    section,
    slider,
    slot_link,
    trace,
    vector,
)
from coursework.figures.text import Run, advance, read


def polar(r, degrees):
    return cmath.rect(r, math.radians(degrees))


def angle(z):
    return math.degrees(cmath.phase(z))


def meet(p, rp, q, rq, side=1):
    """Intersection of two circles, on the left of p→q for side 1."""
    d = abs(q - p)
    x = (d * d + rp * rp - rq * rq) / (2 * d)
    return p + (q - p) / d * complex(x, side * math.sqrt(rp * rp - x * x))


def slotted(r1=228.6, r2=114.3, theta2=135):
    o2 = 1j * r1
    a = o2 + polar(r2, theta2)
    theta4 = angle(a)
    return Figure(
        axes(0, 90),
        line(0, o2, dashed=True, label="r_1"),
        slot_link(0, polar(r1 + 1.25 * r2, theta4)),
        slider(a, theta4),
        link(o2, a, label="r_2"),
        circle(o2, r2, dashed=True),
        ground_pivot(0, "O_4"),
        ground_pivot(o2, "O_2"),
        pin(a, "A"),
        angle_mark(o2, 0, theta2, r"\theta_2"),
        angle_mark(0, 0, theta4, r"\theta_4"),
    )


def four_bar(r1=200, r2=70, r3=180, r4=120, theta2=60, side=1):
    a, c = polar(r2, theta2), complex(r1)
    b = meet(a, r3, c, r4, side)
    return Figure(
        axes(0, 60),
        dimension(0, c, "r_1"),
        link(0, a, label="r_2"),
        link(a, b, label="r_3"),
        link(c, b, label="r_4"),
        ground_pivot(0, "O"),
        ground_pivot(c, "C"),
        pin(a, "A"),
        pin(b, "B"),
        angle_mark(0, 0, theta2, r"\theta_2"),
        angle_mark(c, 0, angle(b - c), r"\theta_4"),
        angle_mark(a, 0, angle(b - a), r"\theta_3"),
    )


def six_link(r1=120, r2=40, r3=130, r4=100, r5=240, theta2=30):
    o = 1j * r1
    a = o + polar(r2, theta2)
    b = meet(a, r3, 0j, r4, -1)
    c = b.real + math.sqrt(r5**2 - b.imag**2)
    return Figure(
        axes(0, 45),
        line(0, o, dashed=True, label="r_1"),
        link(o, a, label="r_2"),
        link(a, b, label="r_3"),
        link(0, b, label="r_4"),
        link(c, b, label="r_5"),
        rail(c - 50, c + 50),
        slider(c, 0),
        ground_pivot(0, "D"),
        ground_pivot(o, "O"),
        pin(a, "A"),
        pin(b, "B"),
        pin(c, "C"),
        dimension(0, c, "r_6"),
        angle_mark(o, 0, theta2, r"\theta_2"),
        angle_mark(0, 0, angle(b), r"\theta_4"),
    )


def ball_reducer(R=40, r=12):
    o3, edge, wall = complex(R + r, 0), R + 2 * r, R + 2 * r + 9
    frame = [edge + 8j, edge - 1j * r, R + 3 - 1j * r, R + 3 - 1j * (r + 9), wall - 1j * (r + 9), wall + 8j]
    return Figure(
        section((-26j, R - 26j, R + 5j, 5j), "S_1"),
        section((1j * r, edge + 1j * r, edge + 1j * (r + 9), 1j * (r + 9)), "S_2", -45),
        section(tuple(frame), "S_0", -45),
        ball(o3, r),
        centre_line(-44j, 38j, "z"),
        contact(o3 + r, "A", toward=180),
        contact(o3 - 1j * r, "B", toward=90),
        contact(o3 - r, "C", toward=0),
        contact(o3 + 1j * r, "D", toward=-90),
        point(o3, "O_3"),
        dimension(-26j, R - 26j, "R", offset=-7),
        dimension(o3 - 1j * r, o3 + r - 1j * r, "r", offset=-21),
        rotation_arrow(-38j, 6, 210, 330, r"\dot{\psi}"),
        rotation_arrow(33j, 6, 210, 330, r"\dot{\theta}"),
    )


def quick_return(r1=300, theta1=-60, r2=105, r3=330, r4=420, r5=500, h=420, theta2=100):
    a, d = polar(r2, theta2), polar(r1, theta1)
    b = meet(a, r3, d, r4)
    c = complex(b.real + math.sqrt(r5**2 - (h - b.imag) ** 2), h)
    return Figure(
        axes(0, 130),
        link(0, a, label="r_2"),
        link(a, b, label="r_3"),
        link(d, b, label="r_4"),
        link(b, c, label="r_5"),
        rail(c + 120, c - 190),
        slider(c, 0),
        line(0, d, dashed=True, label="r_1"),
        circle(0, r2, dashed=True),
        ground_pivot(0, "O"),
        ground_pivot(d, "D"),
        pin(a, "A"),
        pin(b, "B"),
        pin(c, "C"),
        rotation_arrow(0, 45, 150, 230, r"\omega_2"),
        angle_mark(a, angle(-a), angle(b - a), r"\alpha"),
        vector(c, -90, r"\overrightarrow{V}_C"),
    )


def slider_crank(r2=50, r3=150, theta2=50):
    a = polar(r2, theta2)
    b = complex(a.real + math.sqrt(r3**2 - a.imag**2))
    return Figure(
        axes(0, 75),
        link(0, a, label="r_2"),
        link(a, b, label="r_3"),
        rail(b - 40, b + 40),
        slider(b, 0),
        ground_pivot(0, "O"),
        pin(a, "A"),
        pin(b, "B"),
        angle_mark(0, 0, theta2, r"\theta_2"),
        dimension(0, b, "r_1"),
        trace([polar(r2, k) for k in range(0, 361, 5)]),
    )


def two_loops():
    c, f = 180 - 20j, 330 + 40j
    a = polar(60, 70)
    b = meet(a, 170, c, 110)
    d = c + polar(120, angle(b - c) - 50)
    e = meet(d, 130, f, 90)
    return Figure(
        link(0, a, label="r_2"),
        link(a, b, label="r_3"),
        link(c, b, d, label="4"),
        link(d, e, label="r_6"),
        link(f, e, label="r_7"),
        ground_pivot(0, "O"),
        ground_pivot(c, "C"),
        ground_pivot(f, "F"),
        pin(a, "A"),
        pin(b, "B"),
        pin(d, "D"),
        pin(e, "E"),
        angle_mark(c, angle(b - c), angle(d - c), r"\beta"),
        note(complex(330, 150), "groupe 6-7"),
        arc(0, 60, 0, 180, dashed=True),
        link(f, f + 40, f + 40 + 30j, weld=True),
    )


SAMPLES = {
    "slotted": slotted,
    "four_bar": four_bar,
    "six_link": six_link,
    "ball_reducer": ball_reducer,
    "quick_return": quick_return,
    "slider_crank": slider_crank,
    "two_loops": two_loops,
}
every_sample = pytest.mark.parametrize("name", SAMPLES)


def drawn_at_random(kind, seed):
    rng = random.Random(f"{kind} {seed}")
    while True:
        try:
            if kind == "slotted":
                return slotted(rng.uniform(150, 300), rng.uniform(60, 140), rng.randrange(360))
            if kind == "four_bar":
                r1, r2, r3, r4 = (rng.uniform(40, 220) for _ in range(4))
                return four_bar(r1, r2, r3, r4, rng.randrange(360), rng.choice((1, -1)))
            r2, r3, r4 = rng.uniform(25, 60), rng.uniform(80, 160), rng.uniform(70, 130)
            return six_link(rng.uniform(80, 160), r2, r3, r4, rng.uniform(160, 300), rng.randrange(360))
        except ValueError:  # this linkage does not close
            continue


@pytest.mark.parametrize("kind", ["slotted", "four_bar", "six_link"])
@pytest.mark.parametrize("seed", range(34))
def test_no_label_sits_on_a_line_or_on_another_label(kind, seed):
    assert_readable(drawn_at_random(kind, seed))


@every_sample
def test_sample_figures_are_readable_and_print_all_their_labels(name):
    figure = SAMPLES[name]()
    assert_readable(figure)
    printed = ET.fromstring(figure.svg()).findall(f"{SVG}g[2]/{SVG}text")
    assert len(printed) == len(figure.labels()) > 5


def test_the_drawing_is_to_scale():
    figure = four_bar()
    paths = [points for points in strokes(figure) if len(points) == 2]
    heavy = [p for p, item in zip(strokes(figure), ET.fromstring(figure.svg())[1], strict=True)
             if item.get("stroke-width") == "0.6"]  # fmt: skip
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


@every_sample
def test_outlined_svg_needs_no_font(name):
    outlined = ET.fromstring(SAMPLES[name]().outlined_svg())
    assert not outlined.findall(f".//{SVG}text")
    assert "font" not in SAMPLES[name]().outlined_svg()
    assert outlined.findall(f"{SVG}g[2]/{SVG}path")
    assert not [item for item in outlined.iter() if item.get("id") or item.get("href")]


def test_every_letter_of_a_label_is_outlined():
    figure = Figure(link(0, 100, label=r"r_{21}"), pin(0, r"\dot{\psi}"), pin(100, "B"))
    letters = ET.fromstring(figure.outlined_svg()).findall(f"{SVG}g[2]/{SVG}path")
    assert len(letters) == len("r21") + len("ψ") + len("B")


def test_outlines_fill_the_box_of_their_label():
    """The letters lie inside the box kept free for them, and take most of its width."""
    figure = Figure(link(0, 100, label="R+r"), link(0, 80j, label="manivelle"))
    boxes = {box.label: box for box in figure.labels()}
    texts = ET.fromstring(figure.outlined_svg()).findall(f"{SVG}g[2]/{SVG}path")
    for box, letters in ((boxes["R+r"], texts[:3]), (boxes["manivelle"], texts[3:])):
        lefts = [float(re.match(r"translate\((\S+)", item.get("transform"))[1]) for item in letters]
        baselines = [float(re.match(r"translate\(\S+ (\S+)\)", item.get("transform"))[1]) for item in letters]
        assert box.x < lefts[0] < box.x + 0.15 * box.width
        assert box.x + 0.6 * box.width < lefts[-1] < box.x + box.width
        assert all(box.y + 0.5 * box.height < y <= box.y + box.height for y in baselines)


@pytest.mark.parametrize(
    ("label", "italic"),
    [
        ("manivelle", False),
        ("228.6 mm", False),
        ("Walzwerk", False),
        ("AW", True),
        ("mw", True),
        ("Qf", True),
    ],
)
def test_a_label_box_is_wider_than_its_letters(label, italic):
    """Against typst's own measure of the same letters in the same font."""
    figure = Figure(link(0, 100j), pin(0, label))
    size = float(re.search(r'font-size="([\d.]+)"', figure.svg())[1])
    assert ('font-style="italic"' in figure.svg()) is italic
    style = "italic" if italic else "normal"
    # A length of 1 pt in typst stands here for 1 mm.
    letters = f'text(font: "Libertinus Serif", size: {size}pt, style: "{style}", "{label}")'
    source = f"#context [#metadata(measure({letters}).width.pt()) <w>]"
    found = typst.query(source.encode(), "<w>", field="value", ignore_system_fonts=True)
    measured = float(found.strip("[]"))
    width = figure.labels()[0].width
    assert measured < width < 1.25 * measured + 0.3


def test_a_label_is_as_wide_in_every_version_of_python():
    """To the last bit, so that a rounded place is the same: the built-in ``sum`` is not."""
    run, width = Run("0123456789" * 3, italic=True), 0.0
    for letter in run.text:
        width += Run(letter, italic=True).width
    assert run.width == width
    assert advance([run] * 3) == width + width + width


def test_the_font_of_the_text_is_one_that_typst_brings():
    named = re.search(r'font-family="([^",]+)', slotted().svg())[1]
    assert named in typst.Fonts(include_system_fonts=False).families()


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


def test_symbols_are_italic_with_subscripts_and_words_are_upright():
    text = ET.fromstring(Figure(link(0, 90), pin(0, r"\theta_2")).svg()).find(f".//{SVG}text")
    theta, two = text
    assert (theta.text, theta.get("font-style")) == ("θ", "italic")
    assert (two.text, two.get("font-style")) == ("2", None)
    assert float(two.get("dy")) > 0
    word = ET.fromstring(Figure(link(0, 90), pin(0, "bielle")).svg()).find(f".//{SVG}text")
    assert (word.text, word.get("font-style")) == ("bielle", None)


@pytest.mark.parametrize(
    ("label", "wider"),
    [
        (r"\vec{a}^t_{A_2}", "A_2"),
        (r"\vec a_{A_2}^t", "A_2"),
        (r"\vec{a}^c_{A_2/A_4}", "A_2/A_4"),
        ("a_2'", "2"),
        ("a'_2", "2"),
        (r"a_i^{(n+1)}", "(n+1)"),
        (r"a_{\dot{x}}^2", "x"),
    ],
)
def test_an_index_and_an_exponent_stand_one_over_the_other(label, wider):
    text, base = read(label), read("a").width
    index, exponent, end = kinds(text)
    assert index == exponent == pytest.approx(base)
    assert text.width == pytest.approx(end) == pytest.approx(base + read(f"_{{{wider}}}").width)


def test_what_follows_an_index_and_an_exponent_starts_where_the_wider_ends():
    for label in (r"\omega_2^{nn}b", r"\omega^{nn}_2b", r"\omega_{nn}^2b"):
        text = read(label)
        assert text.start(len(text.runs) - 1) == pytest.approx(read(r"\omega_{nn}").width)


def test_an_accent_in_an_index_stays_over_its_letter_when_the_exponent_comes_first():
    text = read(r"q_{\dot{x}}^2")
    (dot,) = text.accents
    assert [run.text for run in text.runs[dot.first : dot.last]] == ["x"]


def test_a_dotted_symbol_has_its_dot_above_the_letter():
    root = ET.fromstring(Figure(link(0, 90), pin(0, r"\ddot{\psi}")).svg())
    text, *dots = root.findall(f"{SVG}g[2]/*")
    assert len(dots) == 2
    for dot in dots:
        assert abs(float(dot.get("cx")) - float(text.get("x"))) < 1
        assert 1.5 < float(text.get("y")) - float(dot.get("cy")) < 4


def test_a_label_goes_to_the_side_asked_for():
    for toward in (0, 90, 180, -90):
        figure = Figure(circle(0, 50), point(0, "P", toward=toward))
        box = figure.labels()[0]
        center = [points for points in strokes(figure) if len(points) == 91][-1]
        dot = sum(center[:-1]) / 90
        seen = complex(box.x + box.width / 2, box.y + box.height / 2) - dot
        assert abs(cmath.phase(seen.conjugate() / polar(1, toward))) < 0.05


def test_the_support_of_a_pivot_turns_away_from_a_link_that_hangs():
    def support(end):
        figure = Figure(link(0, end), ground_pivot(0))
        pivot = next(points[0] for points in strokes(figure) if len(points) == 4)
        hatched = [points for points in strokes(figure) if len(points) == 2][1]
        return (sum(hatched) / 2 - pivot).imag  # y down

    assert support(60j) > 1
    assert support(-60j) < -1


def test_a_dimension_line_keeps_clear_of_a_link_on_its_outer_side():
    for side in (1, -1):
        figure = Figure(
            dimension(0, 100, "r_1"),
            link(0, 50 - 30j * side),
            link(50 - 30j * side, 100),
            point(50 + 90j * side),
        )
        drawn = list(zip(strokes(figure), ET.fromstring(figure.svg())[1], strict=True))
        a = next(p[0] for p, _ in drawn if len(p) == 2 and p[0].imag == p[1].imag)
        bars = [p for p, item in drawn if item.get("stroke-width") == "0.6"]
        ends = [z for p in bars for z in p]
        assert len(ends) == 4
        # y down: the link hangs below its pivots for side 1, and the line is above them.
        pivots = ends[0].imag
        assert (pivots - a.imag) * side > 5


def test_a_leader_reaches_a_label_that_has_no_room_nearby():
    def figure(*more):
        fan = [link(0, polar(60, k * 30)) for k in range(12)]
        return Figure(*fan, *more)

    crowded, bare = figure(pin(0, "O")), figure(pin(0))
    assert_readable(crowded)
    assert len(strokes(crowded)) == len(strokes(bare)) + 1


def inside(z, polygon):
    """By the turning number."""
    turns = sum(cmath.phase((b - z) / (a - z)) for a, b in pairwise([*polygon, polygon[0]]))
    return round(turns / math.tau) != 0


def test_hatching_stays_in_its_section_and_clear_of_its_label():
    figure = Figure(section((0, 60, 60 + 20j, 20 + 20j, 20 + 50j, 50j), "S_1"))
    *hatch, outline = strokes(figure)
    assert len(hatch) > 15
    for a, b in hatch:
        assert inside((a + b) / 2, outline[:-1])
        assert inside(a + (b - a) * 0.02, outline[:-1])
        assert inside(a + (b - a) * 0.98, outline[:-1])
        assert cmath.phase(b - a) == pytest.approx(-math.pi / 4, abs=0.1)
    (box,) = figure.labels()
    assert inside(complex(box.x, box.y), outline[:-1])
    assert crossed(figure) == []


def test_the_head_of_a_rotation_points_where_the_rotation_goes():
    def tip_and_base(start, end):
        figure = Figure(rotation_arrow(0, 50, start, end), point(0))
        head, dot = (points for points in strokes(figure) if len(points) in (4, 91))
        center = sum(dot[:-1]) / 90
        return [
            math.degrees(cmath.phase((z - center).conjugate())) for z in (head[0], (head[1] + head[2]) / 2)
        ]

    tip, base = tip_and_base(20, 160)
    assert tip == pytest.approx(160, abs=0.5)
    assert tip - 8 < base < tip - 2
    tip, base = tip_and_base(160, 20)
    assert tip == pytest.approx(20, abs=0.5)
    assert tip + 2 < base < tip + 8


@pytest.mark.parametrize(
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
        (lambda: pin(0, "r_{2"), "closing brace"),
        (lambda: pin(0, "r_"), "ends where"),
    ],
)
def test_a_wrong_figure_is_refused_and_the_element_named(build, named):
    with pytest.raises(WrongValue, match=re.escape(named)):
        build()


def four_bar_in(width, height):
    return Figure(*four_bar().elements, paper_mm=(width, height))


def test_an_unknown_label_command_offers_the_nearest():
    with pytest.raises(UnknownName, match="theta"):
        pin(0, r"\thetta_2")


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
