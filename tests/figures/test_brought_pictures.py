"""Pictures from outside and several figures: shown in every format with their words, and nothing in them
runs."""

from __future__ import annotations

import base64
import json
import re
import subprocess
from shutil import which
from urllib.parse import unquote
from xml.etree import ElementTree

import pytest
from page_scripts import allowed, digest, runs
from tables import each_row

import coursework
from coursework.authoring import checks
from coursework.cli import run
from coursework.errors import BadCourse
from coursework.figures import Picture

SVG = (
    '<?xml version="1.0"?><!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "svg11.dtd">'
    '<svg xmlns="http://www.w3.org/2000/svg" width="8cm" height="40mm" viewBox="0 0 80 40">'
    '<rect x="5" y="5" width="70" height="30" fill="none" stroke="black"/></svg>'
)

EXERCISE = '''
"""A circuit: what current flows?"""

from coursework.figures import Figure, Picture, line, pin
from coursework.model import Exercise, Part, drawn


def figure(R):
    return SHOWN


EXERCISE = Exercise(
    given={"R": drawn(10, 50, unit="ohm"), "U": drawn(10, 50, unit="V")},
    parts=(Part("I", unit="A"),),
    figure=figure,
)
'''
SOLUTION = """
def I(U, R):
    return U / R


def residual(U, R, I):
    return R * I / U - 1


KNOWN = (({"U": 20, "R": 10}, {"I": 2}),)
"""
THREE = 'Picture("circuit.svg"), Picture("photo.png", width_mm=60), Figure(line(0, 50), pin(0, "A"))'


def write_course(root, shown, sections=("figure", "figure 2", "figure 3")):
    for folder in ("exercises/circuits", "solutions/circuits"):
        (root / folder).mkdir(parents=True)
    home = root / "exercises" / "circuits"
    (home / "circuit.svg").write_text(SVG, "utf-8")
    (home / "photo.png").write_bytes(Picture(SVG.encode()).png(ppi=100))
    (home / "photo.gif").write_bytes(b"GIF89a" + bytes(40))
    (home / "circuit.py").write_text(EXERCISE.replace("SHOWN", shown), "utf-8")
    (root / "solutions/circuits/circuit.py").write_text(SOLUTION, "utf-8")
    words = "".join(f"\n## {name}\nWords of {name}.\n" for name in sections)
    for lang in ("fr", "en"):
        (home / f"circuit.{lang}.md.j2").write_text(
            f"# A circuit\n\nOf $R$.\n\n## I\nIts current.\n{words}", "utf-8"
        )
        (root / f"solutions/circuits/circuit.{lang}.md.j2").write_text("# A circuit\n", "utf-8")
    return coursework.open_course(root)


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """A course of three figures, and its build."""
    root = tmp_path_factory.mktemp("pictures")
    course = write_course(root / "own", THREE)
    build = ["build", "--variants", "1", "--formats", "pdf,ipynb,html,tex", "--lang", "en", "--out"]
    assert run(["--course", str(root / "own"), *build, str(root / "out")]) == 0
    return course, root / "out"


def test_every_promise_is_proved_of_an_exercise_with_pictures(built):
    assert not checks.check(built[0]["circuit"], 20).failures


def test_a_picture_has_its_own_size_unless_told_and_fits_its_room():
    picture = Picture(SVG.encode())
    assert picture.size_mm == (80, 40)
    assert Picture(SVG.encode(), width_mm=50).size_mm == (50, 25)
    assert picture.fitted(200, 20).size_mm == (40, 20)
    assert picture.fitted(200, 200) is picture
    pixels = Picture(picture.png(ppi=150)).size_mm
    assert pixels == pytest.approx((80, 40), abs=0.5)


def test_a_page_shows_each_with_its_words_and_runs_nothing(built):
    page = next((built[1] / "handouts" / "circuit").glob("*.html")).read_text("utf-8")
    shown = re.findall(r'<img src="data:image/svg\+xml,([^"]+)" alt="([^"]*)"', page)
    assert [alt for _, alt in shown] == ["Words of figure.", "Words of figure 2.", "Words of figure 3."]
    first, second, _ = (ElementTree.fromstring(unquote(data)) for data, _ in shown)
    assert first.get("viewBox") == "0 0 80 40"
    assert second[0].tag.endswith("image")
    assert allowed(page) == [digest(script) for script in runs(page)]
    assert not any("<script" in unquote(data) for data, _ in shown)


def test_a_notebook_has_each_attached(built):
    notebook = json.loads(next((built[1] / "handouts" / "circuit").glob("*.ipynb")).read_text("utf-8"))
    attached = {
        name: base64.b64decode(data["image/png"])
        for cell in notebook["cells"]
        for name, data in cell.get("attachments", {}).items()
    }
    assert list(attached) == ["figure.png", "figure-2.png", "figure-3.png"]
    assert all(data.startswith(b"\x89PNG") for data in attached.values())
    assert "![Words of figure 2.](attachment:figure-2.png)" in json.dumps(notebook)


@pytest.mark.skipif(which("pdflatex") is None, reason="no LaTeX here")
def test_latex_shows_a_page_of_one_file_for_each(built, tmp_path):
    source = next((built[1] / "handouts" / "circuit").glob("*.tex"))
    assert "page=3" in source.read_text("utf-8")
    command = ["pdflatex", "-halt-on-error", "-output-directory", tmp_path, source.name]
    done = subprocess.run(command, cwd=source.parent, capture_output=True, check=False)
    assert done.returncode == 0, done.stdout[-2000:]


def test_a_terminal_and_a_study_tell_of_each(built, tmp_path, capsys):
    course, _ = built
    assert run(["--course", str(course.folder.root), "show", "circuit", "--seed", "0", "--lang", "en"]) == 0
    assert "Words of figure 3." in capsys.readouterr().out
    session = coursework.study("circuit", lang="en", course=course.folder.root, folder=tmp_path)
    assert "Words of figure 2." in str(session.statement())


@pytest.mark.parametrize(
    ("shown", "said"),
    [
        ('Picture("photo.gif")', "is SVG or PNG; this begins with b'GIF89a"),
        ('Picture("circiut.svg")', "circiut.svg: No such file.*did you mean 'circuit.svg'"),
        ('Picture("circuit.svg", width_mm=-3)', "width of a picture"),
        ('"circuit.svg"', "returns a Figure, a Picture, or a tuple"),
    ],
)
def test_what_cannot_be_shown_is_refused(tmp_path, shown, said):
    exercise = write_course(tmp_path, shown)["circuit"]
    with pytest.raises(BadCourse, match=said):
        _ = exercise.variant(0).figure


def test_a_figure_without_words_is_refused(tmp_path):
    report = checks.check(write_course(tmp_path, THREE, ("figure", "figure 2"))["circuit"], 2)
    assert any("no section '## figure 3'" in fault for fault in report.failures)


@each_row(
    "planted",
    [
        "<script>alert(1)</script>",
        '<rect onload="alert(1)"/>',
        '<image href="https://example.org/a.png"/>',
        '<a xmlns:x="http://www.w3.org/1999/xlink" x:href="javascript:alert(1)"/>',
        '<rect fill="url(https://example.org/a)"/>',
        "<style>@import 'https://example.org/a.css';</style>",
        "<foreignObject><p/></foreignObject>",
        '<animate attributeName="href" to="javascript:alert(1)"/>',
        '<use href="other.svg#a"/>',
        '<meta xmlns="" http-equiv="refresh" content="0;url=//example.org"/>',
        '<img srcset="//example.org/a 1x"/>',
        '<table background="//example.org/a"/>',
        '<video xmlns="http://www.w3.org/1999/xhtml" poster="//example.org/a"/>',
        '<title><link rel="stylesheet" imagesrcset="//example.org/a"/></title>',
        '<rect style="background:u\\72l(//example.org/a)"/>',
        "<style>@\\69mport '//example.org/a.css';</style>",
        "<style>rect { background: image-set('//example.org/a' 1x) }</style>",
        "<discard/>",
    ],
)
def test_what_would_run_or_fetch_is_refused(planted):
    with pytest.raises(BadCourse, match="runs nothing and fetches nothing"):
        _ = Picture(SVG.replace("</svg>", f"{planted}</svg>").encode()).size_mm


@each_row(
    "kept",
    [
        '<use href="#a"/>',
        '<rect fill="url(#a)"/>',
        '<rect style="fill:red"/>',
        '<image href="data:image/png;base64,AAAA"/>',
    ],
)
def test_what_stays_inside_is_kept(kept):
    assert Picture(SVG.replace("</svg>", f"{kept}</svg>").encode()).size_mm == (80, 40)


def test_entities_are_not_read():
    planted = SVG.replace('"svg11.dtd">', '"svg11.dtd" [<!ENTITY a "aaaa">]>')
    with pytest.raises(BadCourse, match="entities"):
        _ = Picture(planted.encode()).size_mm
