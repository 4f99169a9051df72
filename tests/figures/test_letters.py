"""Labels: their letters, their boxes, indices and exponents."""

import re
import xml.etree.ElementTree as ET

import pytest
import typst
from drawn_svg import SVG, kinds
from figure_samples import SAMPLES, every_sample, slotted
from tables import each_row

from coursework.errors import WrongValue
from coursework.figures import Figure, link, pin
from coursework.figures.text import LetterRun, advance, read


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


@each_row(
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
    run, width = LetterRun("0123456789" * 3, italic=True), 0.0
    for letter in run.text:
        width += LetterRun(letter, italic=True).width
    assert run.width == width
    assert advance([run] * 3) == width + width + width


def test_the_font_of_the_text_is_one_that_typst_brings():
    named = re.search(r'font-family="([^",]+)', slotted().svg())[1]
    assert named in typst.Fonts(include_system_fonts=False).families()


def test_symbols_are_italic_with_subscripts_and_words_are_upright():
    text = ET.fromstring(Figure(link(0, 90), pin(0, r"\theta_2")).svg()).find(f".//{SVG}text")
    theta, two = text
    assert (theta.text, theta.get("font-style")) == ("θ", "italic")
    assert (two.text, two.get("font-style")) == ("2", None)
    assert float(two.get("dy")) > 0
    word = ET.fromstring(Figure(link(0, 90), pin(0, "bielle")).svg()).find(f".//{SVG}text")
    assert (word.text, word.get("font-style")) == ("bielle", None)


@each_row(
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


def test_an_unknown_label_command_offers_the_nearest():
    with pytest.raises(WrongValue, match="theta"):
        pin(0, r"\thetta_2")
