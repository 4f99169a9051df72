"""The drawing surface: one short script without words, let run by its digest; boxes and directions of the
sheet."""

import json
import re
from pathlib import Path

import pytest
from page_scripts import allowed, digest, runs

import coursework
from coursework.language.words import words
from coursework.rendering import html
from coursework.rendering.surface import scripts_of, surface
from coursework.sheets.handout import handout

COURSE = coursework.open_course()
TEMPLATES = Path(__file__).parents[2] / "templates"
KINDS = ("graph", "paper")
DRAWN = [name for name in COURSE.names if COURSE[name].spec.drawing_mm]


def page(name, lang="en", seed=3):
    sheet = handout(COURSE[name].variant(seed, lang))
    return sheet, html.page(COURSE.folder.template_folders, sheet)


def test_the_scripts_have_no_words():
    code = "".join(re.sub(r"//.*", "", (TEMPLATES / one).read_text()) for one in scripts_of(KINDS))
    spoken = {
        sentence.lower()
        for lang in ("en", "fr")
        for table in ("hints", "script")
        for sentence in words(lang)["drawing"][table].values()
        if isinstance(sentence, str)
    }
    literals = {one.lower() for pair in re.findall(r'"([^"\n]*)"|`([^`\n]*)`', code) for one in pair}
    assert not spoken & literals
    assert not [one for one in literals if re.search(r"[a-zà-ÿ]{3,} [a-zà-ÿ]{2,} [a-zà-ÿ]{2,}", one)]
    assert not re.search(r"\beval\b|innerHTML|new Function|fetch\(", code)


@pytest.mark.parametrize("name", [*DRAWN[:2], "joint_graph", "grashof"])
def test_a_page_runs_the_script_where_there_is_something_to_draw(name):
    sheet, text = page(name)
    assert allowed(text) == [digest(script) for script in runs(text)]
    _, *drawing = runs(text)
    assert len(drawing) == (surface(sheet) is not None)
    assert len("".join(drawing).encode()) <= 25_600
    assert "\n//" not in "".join(runs(text))
    assert (surface(sheet) is None) == ("data-surface" not in text)
    own = {kind for kind in KINDS if f".{kind} = s =>" in text}
    assert own == set(re.findall(r'data-surface="(\w+)"', text))  # and no script of another kind


def test_each_drawn_exercise_offers_its_points_scales_and_links():
    lost = []
    for name in DRAWN:
        sheet = handout(COURSE[name].variant(3, "en"))
        drawn = surface(sheet)
        boxes = {question.id for question in (*drawn.points, *drawn.arrows)}
        if boxes != {question.id for question in sheet.questions if question.kind == "point"}:
            lost.append((name, boxes))
        if not drawn.scales or not drawn.links:
            lost.append((name, drawn.scales, drawn.links))
    assert lost == []


@pytest.mark.parametrize("name", ["velocity_polygon", "acceleration_polygon", "havens_construction"])
@pytest.mark.parametrize("seed", range(5))
def test_links_have_the_directions_that_the_statement_gives(name, seed):
    sheet = handout(COURSE[name].variant(seed, "en"))
    stated = {float(number) for number in re.findall(r"\\num\{(-?[\d.]+)\}\^", sheet.statement)}
    offered = {link.degrees for link in surface(sheet).links}
    assert len(stated & offered) >= (1 if name == "havens_construction" else 2)


def test_settings_end_no_element_of_the_page():
    drawn = surface(handout(COURSE["havens_construction"].variant(1, "fr")))
    text = str(drawn.settings("</script>"))
    assert "<" not in text
    assert json.loads(text)["own"] == "</script>"
