"""Self-study notebooks run from top to bottom, in every language, and hold no answer."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from study_words import BOTH, SAID, flat
from sweeps import slow

import coursework
from coursework.cli import run
from coursework.course.answer_keys import answer_keys
from coursework.errors import BadCourse, BadInput, CourseworkError, Starved, UnknownName
from coursework.language.words import texts_of, words
from coursework.rendering.renderer import renderer_of
from coursework.system.distribution import DISTRIBUTION, pip_install

pytestmark = pytest.mark.e2e

COURSE = coursework.open_course()
every_exercise = pytest.mark.parametrize("name", COURSE.names)


def code_cells(text: str) -> list[str]:
    return ["".join(c["source"]) for c in json.loads(text)["cells"] if c["cell_type"] == "code"]


def run_cells(sources: list[str]) -> list[str]:
    """Run cells as a notebook does, and give what each shows, as plain text."""
    names: dict[str, object] = {}
    shown = []
    for source in sources:
        body = ast.parse(source).body
        last = body.pop() if body and isinstance(body[-1], ast.Expr) else None
        exec(compile(ast.Module(body, []), "cell", "exec"), names)
        if last is not None:
            value = eval(compile(ast.Expression(last.value), "cell", "eval"), names)
            shown.append(str(value))
            for bundle in getattr(value, "bundles", list)():
                assert bundle["text/plain"]
    return shown


IN_BOTH = ("assour", "four_bar_motion", "slotted_mechanism")


FEW_RUN = {("slotted_mechanism", "en"), ("ball_reducer", "fr"), ("assour", "fr"), ("velocity_polygon", "fr")}
EVERY = [(n, "fr") for n in COURSE.names] + [(n, "en") for n in IN_BOTH]


@pytest.mark.parametrize(
    ("name", "lang"), [p if p in FEW_RUN else pytest.param(*p, marks=slow) for p in EVERY]
)
def test_a_self_study_notebook_runs_from_top_to_bottom_twice(name, lang, here):
    cells = code_cells(renderer_of(COURSE.folder).study(COURSE[name].variant(3, lang).study_sheet()))
    assert any("study.check(answers)" in source for source in cells)
    assert run_cells(cells) == run_cells(cells)


@pytest.mark.parametrize(
    ("name", "lang"), [("slotted_mechanism", "en"), pytest.param("mobility", "fr", marks=slow)]
)
def test_a_self_study_notebook_runs_in_a_kernel(name, lang, tmp_path):
    import nbformat
    from nbclient import NotebookClient

    text = renderer_of(COURSE.folder).study(COURSE[name].variant(3, lang).study_sheet())
    book = nbformat.reads(text, as_version=4)
    resources = {"metadata": {"path": str(tmp_path)}}
    NotebookClient(book, timeout=120, kernel_name="python3", resources=resources).execute()
    outputs = [o for cell in book.cells for o in cell.get("outputs", ())]
    assert all(o.output_type in ("display_data", "execute_result") for o in outputs)
    assert any("text/markdown" in o.data for o in outputs)


@every_exercise
def test_a_self_study_notebook_is_the_same_twice_and_has_one_cell_of_answers(name):
    first, second = (
        renderer_of(COURSE.folder).study(COURSE[name].variant(3, "fr").study_sheet()) for _ in range(2)
    )
    assert first == second
    book = json.loads(first)
    (answers,) = [c for c in book["cells"] if "answers" in c["metadata"].get("tags", ())]
    (line,) = ast.parse("".join(answers["source"])).body
    assert ast.literal_eval(line.value).keys() == {
        "student",
        *answer_keys(COURSE[name].variant(3).parts).values(),
    }
    assert len({c["id"] for c in book["cells"]}) == len(book["cells"])
    assert book["metadata"]["coursework"]["record"] == COURSE[name].variant(3).record


@every_exercise
def test_a_notebook_to_hand_in_holds_no_answer_and_no_way_to_one(name):
    for seed in (0, 1):
        variant = COURSE[name].variant(seed, "en")
        text = renderer_of(COURSE.folder).notebook(variant.handout("Zoé"))
        printed = re.sub(r'"image/png": "[^"]*"', "", text)
        assert "coursework.study" not in printed
        for source in code_cells(text):
            tree = ast.parse(source)
            assert not any(isinstance(n, (ast.Call, ast.Import, ast.ImportFrom)) for n in ast.walk(tree))
        given = {abs(float(v)) for v in variant.given.values() if not isinstance(v, str)}
        examples = " ".join(str(text) for _, text in texts_of(words("en")))
        for part in variant.parts:
            value = variant.solution()[part.quantity]
            if part.kind == "number" and abs(value) not in given and value != round(value):
                text = f"{abs(value):.5g}"
                assert text not in printed or f'"{text} ' in examples


def test_a_filled_self_study_notebook_is_marked(tmp_path, capsys):
    assert (
        run(
            ["build", "slotted_mechanism", "--with", "practice", "--formats", "ipynb", "--out", str(tmp_path)]
        )
        == 0
    )
    (path,) = (tmp_path / "handouts").rglob("*.ipynb")
    book = json.loads(path.read_text("utf-8"))
    cell = next(c for c in book["cells"] if "answers" in c["metadata"].get("tags", ()))
    seed = book["metadata"]["coursework"]["seed"]
    value = COURSE["slotted_mechanism"].variant(seed).solution()["rA"]
    source = "".join(cell["source"]).replace('"student": ""', '"student": "Zoé"')
    cell["source"] = source.replace('"rA": ""', f'"rA": "{value:.6g} mm"').splitlines(keepends=True)
    path.write_text(json.dumps(book), "utf-8")
    run(["grade", str(path), "--issued", str(tmp_path / "issued.json"), "--out", str(tmp_path / "marks")])
    marks = (tmp_path / "marks" / "marks.csv").read_text("utf-8")
    assert re.search(rf"Zoé,slotted_mechanism,{seed},rA,.*,correct,1", marks)


def test_the_command_writes_a_notebook_for_every_exercise_of_a_course_of_ones_own(
    small_course, monkeypatch, capsys
):
    out = small_course.parent / "notebooks"
    assert run(["--course", str(small_course), "notebook", "--lang", "fr,en", "--out", str(out)]) == 0
    assert {p.name for p in out.iterdir()} == {"crank_pin.en.ipynb", "crank_pin.fr.ipynb"}
    monkeypatch.chdir(out)
    for path in sorted(out.iterdir()):
        shown = run_cells(code_cells(path.read_text("utf-8")))
        assert shown
    monkeypatch.chdir("/")
    with pytest.raises(BadCourse, match="small"):
        coursework.study("crank_pin", course="small")
    for place in (small_course, str(small_course)):
        assert coursework.study("crank_pin", course=place, folder=out).variant.exercise.name == "crank_pin"


def test_a_notebook_of_another_version_is_refused(here):
    with pytest.raises(BadInput, match=r"version 99.*coursework notebook slotted_mechanism"):
        coursework.study("slotted_mechanism", version=99)


MISTYPED = {
    "question": (lambda s: s.check({"theta44": "1"}), UnknownName, "theta4"),
    "no name": (lambda s: s.check({33: "1"}), UnknownName, "q3"),
    "no dictionary": (lambda s: s.check(["1"]), BadInput, "study.check"),
    "a text": (lambda s: s.predict("theta4"), BadInput, "study.predict"),
    "prediction": (lambda s: s.predict({"theta5": "1"}), UnknownName, "theta4"),
    "hint": (lambda s: s.hint("tehta4"), UnknownName, "theta4"),
    "hint of a list": (lambda s: s.hint(["theta4"]), UnknownName, "theta4"),
    "step": (lambda s: s.hint("theta4", "two"), BadInput, "two"),
    "reveal": (lambda s: s.reveal("thta4"), UnknownName, "theta4"),
    "curve": (lambda s: s.plot("omega44"), UnknownName, "omega4"),
    "curves": (lambda s: s.plot(["rA"]), UnknownName, "rA"),
    "effect": (lambda s: s.motion("speed"), UnknownName, "velocity"),
    "fresh": (lambda s: s.fresh("2"), BadInput, "'2'"),
}


@pytest.mark.parametrize("lang", ["fr", "en"])
@pytest.mark.parametrize("mistyped", MISTYPED)
def test_what_is_mistyped_is_said_in_the_language_of_the_notebook(mistyped, lang, here):
    call, kind, would_do = MISTYPED[mistyped]
    with pytest.raises(kind) as refused:
        call(coursework.study("slotted_mechanism", lang=lang))
    (line,) = refused.value._render_traceback_()
    assert would_do in line
    sentences = words(lang)["study"]["refused"].values()
    assert any(max(re.split(r"\{\w+\}", sentence), key=len) in line for sentence in sentences)


@pytest.mark.parametrize("lang", ["fr", "en"])
def test_the_effects_that_a_motion_has_are_each_named_once(lang, here):
    with pytest.raises(BadInput, match=r": position, velocity, acceleration\.$"):
        coursework.study("four_bar_motion", lang=lang).motion("coriolis")


@pytest.mark.parametrize("lang", ["fr", "en"])
def test_a_notebook_that_cannot_begin_says_so_in_its_language(lang, here):
    said = words(lang)["study"]["refused"]
    for told, start in (
        ({"exercise": "sloted_mechanism"}, said["exercise"]),
        ({"exercise": "slotted_mechanism", "version": 99}, said["version"]),
        ({"exercise": "slotted_mechanism", "course": "nowhere"}, said["course"]),
    ):
        with pytest.raises(CourseworkError, match=re.escape(start.partition("{")[0])):
            coursework.study(**told, lang=lang)


@pytest.mark.parametrize("lang", ["fr", pytest.param("en", marks=slow)])
def test_more_fresh_variants_than_there_are_is_said_in_the_language_of_the_notebook(lang, small_course, here):
    source = small_course / "exercises" / "crank_pin.py"
    few = source.read_text("utf-8").replace("drawn(50, 200, step=5", "drawn(50, 55, step=5")
    few = few.replace("drawn(-175, 180, step=5", "drawn(-160, 160, step=40").replace(
        "drawn(2, 20", "drawn(2, 3"
    )
    source.write_text(few, "utf-8")
    with pytest.raises(Starved) as refused:
        coursework.study("crank_pin", lang=lang, course=small_course).fresh(100)
    assert str(refused.value) == words(lang)["study"]["refused"]["starved"].format(number=100)


@BOTH
def test_the_answers_cell_of_a_self_study_notebook_is_run(lang, here):
    variant = COURSE["coriolis"].variant(3, lang)
    books = [
        renderer_of(COURSE.folder).study(variant.study_sheet()),
        renderer_of(COURSE.folder).notebook(variant.handout()),
    ]
    texts = [flat(" ".join("".join(c["source"]) for c in json.loads(book)["cells"])) for book in books]
    helps = (SAID[lang]["answers_help"], words(lang)["notebook"]["answers_help"])
    for k, text in enumerate(texts):
        last = [flat(said.strip().rpartition("\n")[2])[:40] in text for said in helps]
        assert last == [k == 0, k == 1]
    assert '`"rA": rA`' in texts[0]


#: A distribution of somebody else that is imported under our name.
STRANGER = "def grades():\n    return []\n"


@BOTH
@pytest.mark.parametrize("installed", [None, STRANGER])
def test_without_the_package_the_first_cell_says_in_a_sentence_what_to_install(lang, installed, tmp_path):
    text = renderer_of(COURSE.folder).study(COURSE["grashof"].variant(1, lang).study_sheet())
    first = code_cells(text)[0]
    if installed:
        (tmp_path / "coursework").mkdir()
        (tmp_path / "coursework" / "__init__.py").write_text(installed, "utf-8")
    hide = "" if installed else "sys.modules['coursework'] = None\n"
    (tmp_path / "cell.py").write_text(
        f"import sys\nsys.path.insert(0, {str(tmp_path)!r})\n{hide}{first}", "utf-8"
    )
    ran = subprocess.run([sys.executable, "-P", "cell.py"], cwd=tmp_path, capture_output=True, text=True)
    assert ran.returncode
    last = ran.stderr.strip().splitlines()[-1]
    said = SAID[lang]["not_installed"].format(package=DISTRIBUTION, install=pip_install())
    assert last == f"ImportError: {said}"
    assert "During handling" not in ran.stderr
    assert f"%{pip_install()}" in "".join(json.loads(text)["cells"][0]["source"])


def test_what_is_installed_is_not_called_as_a_strangers_package():
    assert DISTRIBUTION != "coursework"
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text("utf-8"))["project"]
    assert (project["name"], project["version"]) == (DISTRIBUTION, coursework.__version__)


@pytest.mark.parametrize(
    ("told", "install"),
    [
        ("mechanism-coursework>=0.2", 'pip install "mechanism-coursework>=0.2"'),
        (
            "https://example.org/coursework-1-py3-none-any.whl",
            "pip install https://example.org/coursework-1-py3-none-any.whl",
        ),
        ("ours-1-py3-none-any.whl", "pip install ./ours-1-py3-none-any.whl"),
    ],
)
def test_a_course_says_what_to_install_and_brings_its_wheel(told, install, small_course, capsys):
    settings = small_course / "exercises" / "course.toml"
    before = settings.read_text("utf-8")
    settings.write_text(f'{before}\n[study]\ninstall = "{told}"\n', "utf-8")
    if told.startswith("ours"):
        assert run(["--course", str(small_course), "notebook", "--out", str(small_course / "out")]) == 2
        assert "no such file" in capsys.readouterr().err
        (small_course / told).write_bytes(b"wheel")
    assert (
        run(["--course", str(small_course), "notebook", "--lang", "en", "--out", str(small_course / "out")])
        == 0
    )
    book = json.loads((small_course / "out" / "crank_pin.en.ipynb").read_text("utf-8"))
    assert f"%{install}" in "".join(book["cells"][0]["source"])
    assert ((small_course / "out" / told.rpartition("/")[2]).exists()) == told.startswith("ours")


@pytest.mark.parametrize("wrong", ['install = "a\\nb"', "install = 3", 'order = ["nothing"]', "order = 3"])
def test_settings_of_study_that_are_none_are_told(wrong, small_course, capsys):
    settings = small_course / "exercises" / "course.toml"
    settings.write_text(f"{settings.read_text('utf-8')}\n[study]\n{wrong}\n", "utf-8")
    out = small_course / "out"
    code = run(["--course", str(small_course), "notebook", "--out", str(out)])
    code = code or run(["--course", str(small_course), "progress"])
    assert code == 2
    assert "[study]" in capsys.readouterr().err


@BOTH
def test_an_answer_that_cannot_be_read_is_an_item_of_its_own(lang, here):
    """A space that does not break behind the dash would glue it to the line above."""
    said = (
        coursework.study("slotted_mechanism", seed=1, lang=lang)
        .check({"rA": "1", "theta4": "12 apples", "omega4": "2"})
        .markdown
    )
    assert re.findall(r"^- (\S)", said, re.M)[:3] == ["✗", "?", "✗"]
