"""Self-study notebooks run, keep what is written, hint without telling, and compare predictions with what is."""

from __future__ import annotations

import ast
import json
import re
import shutil

import numpy as np
import pytest

import coursework
from coursework.cli import run
from coursework.errors import BadCourse, BadInput, CourseworkError, Starved, UnknownName, WrongValue
from coursework.figures.plot import Axis, Plot, Spot
from coursework.language.words import words
from coursework.making.flaws import worthy
from coursework.rendering.renderer import renderer_of
from coursework.selfstudy import hints, predictions
from coursework.selfstudy import word_answers as wording

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


@pytest.fixture
def here(tmp_path, monkeypatch):
    """An empty folder, as the notebook's own."""
    folder = tmp_path / "notebooks"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder


# ------------------------------------------------------------------- notebooks


IN_BOTH = ("assour", "four_bar_motion", "slotted_mechanism")


@pytest.mark.parametrize(("name", "lang"), [(n, "fr") for n in COURSE.names] + [(n, "en") for n in IN_BOTH])
def test_a_self_study_notebook_runs_from_top_to_bottom_twice(name, lang, here):
    cells = code_cells(renderer_of(COURSE.folder).study(COURSE[name].variant(3, lang).study_sheet()))
    assert any("study.check(answers)" in source for source in cells)
    assert run_cells(cells) == run_cells(cells)


@pytest.mark.parametrize(("name", "lang"), [("slotted_mechanism", "en"), ("mobility", "fr")])
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
    assert ast.literal_eval(line.value).keys() == {"student", *COURSE[name].variant(3).part_ids}
    assert len({c["id"] for c in book["cells"]}) == len(book["cells"])
    assert book["metadata"]["coursework"]["record"] == COURSE[name].variant(3).record


@every_exercise
def test_a_notebook_to_hand_in_holds_no_answer_and_no_way_to_one(name):
    for seed in (0, 1):
        variant = COURSE[name].variant(seed, "en")
        text = renderer_of(COURSE.folder).notebook(variant.handout("Zoé"))
        words = re.sub(r'"image/png": "[^"]*"', "", text)
        assert "coursework.study" not in words
        for source in code_cells(text):
            tree = ast.parse(source)
            assert not any(isinstance(n, (ast.Call, ast.Import, ast.ImportFrom)) for n in ast.walk(tree))
        given = {float(v) for v in variant.given.values() if not isinstance(v, str)}
        for part in variant.parts:
            value = variant.solution()[part.quantity]
            if part.kind == "number" and abs(value) not in {abs(g) for g in given} and value != round(value):
                assert f"{abs(value):.5g}" not in words


def test_a_filled_self_study_notebook_is_marked(tmp_path, capsys):
    assert (
        run(["build", "slotted_mechanism", "--practice", "--formats", "ipynb", "--out", str(tmp_path)]) == 0
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


def test_a_students_copy_says_that_its_solutions_are_missing(small_course, monkeypatch):
    shutil.rmtree(small_course / "solutions")
    monkeypatch.chdir(small_course.parent)
    variant = coursework.open_course(small_course)["crank_pin"].variant(0, "en")
    shown = run_cells(code_cells(renderer_of(variant.exercise.folder).study(variant.study_sheet())))
    session = coursework.study("crank_pin", lang="en", course="small", folder=small_course)
    for said in (
        session.check({"x": "1"}),
        session.hint("x"),
        session.reveal("x"),
        session.plot(),
        session.motion(),
    ):
        assert "solutions are not in this copy" in str(said)
    assert session.answers == {"x": "1"}
    assert any("solutions are not in this copy" in text for text in shown)


def test_a_notebook_of_another_version_is_refused(here):
    with pytest.raises(BadInput, match=r"version 99.*coursework notebook slotted_mechanism"):
        coursework.study("slotted_mechanism", version=99)


MISTYPED = {
    "question": (lambda s: s.check({"theta44": "1"}), UnknownName, "theta4"),
    "no name": (lambda s: s.check({33: "1"}), UnknownName, "omega4"),
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


@pytest.mark.parametrize("lang", ["fr", "en"])
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


# -------------------------------------------------------------------- feedback


@every_exercise
def test_right_answers_are_all_right(name, here):
    session = coursework.study(name, seed=1, lang="en")
    variant = session.variant
    values = variant.solution()
    answers = {p.id: _as_answer(values[p.quantity], p) for p in variant.parts}
    said = str(session.check(answers))
    total = sum(p.points for p in variant.parts)
    assert f"{total:g} out of {total:g} points" in said
    assert "✗" not in said


def _as_answer(value, part):
    if isinstance(value, (list, tuple, np.ndarray)):
        return "; ".join(repr(float(v)) for v in value)
    text = value if isinstance(value, str) else repr(int(value) if part.kind == "integer" else float(value))
    return f"{text} {part.unit}" if part.asks_unit else text


def test_feedback_names_what_is_blank_and_what_to_ask_next(here):
    session = coursework.study("slotted_mechanism", seed=42, lang="en")
    right = session.variant.solution()
    said = str(session.check({"student": "Zoé", "rA": f"{right['rA']:.5g}", "omega4": "1e9"}))
    assert said.startswith("- ✓ 1.")
    assert 'study.hint("omega4")' in said
    assert "theta4" in said.partition("Still blank")[2]
    with pytest.raises(UnknownName, match="omega4"):
        session.check({"omega44": "1"})


def test_what_is_written_is_never_lost(here):
    session = coursework.study("slotted_mechanism", seed=5, lang="en")
    session.check({"rA": "100", "theta4": "20"})
    assert "before" not in str(session.check({"rA": "100", "theta4": "20"}))
    assert "before: rA" in str(session.check({"rA": "", "theta4": "30"}))
    session.predict(dict.fromkeys([p.id for p in predictions.before_answers(session.variant)], ""))
    session.predict({"theta4": "2"})
    session.predict({"theta4": ""})
    again = session.fresh(1)
    again.check({"rA": "7"})
    assert again.variant.seed > 5
    later = coursework.study("slotted_mechanism", seed=5, lang="fr")
    assert later.answers == {"rA": "100", "theta4": "30"}
    assert later.predictions == {"theta4": "2"}
    assert later.fresh(1).answers == {"rA": "7"}
    assert later.fresh().variant.seed == later.fresh(2).variant.seed > again.variant.seed
    assert f"variante {again.variant.seed}" in str(later.progress())


def test_answers_of_another_variant_are_not_kept_for_this_one(here):
    session = coursework.study("slotted_mechanism", seed=5, lang="en")
    session.check({"rA": "100", "theta4": "20"})
    again = session.fresh(2)
    assert "variant 5" in str(again.check({"rA": "100", "theta4": "20"}))
    assert again.answers == {}


def test_a_damaged_file_is_set_aside_and_told(here):
    (here / "coriolis.study.json").write_text("{", "utf-8")
    session = coursework.study("coriolis", lang="en")
    assert "set aside" in str(session.check({}))
    assert (here / "coriolis.study.damaged.json").read_text("utf-8") == "{"
    session.check({"a_coriolis": "3"})
    assert json.loads((here / "coriolis.study.json").read_text("utf-8"))["variants"]["0"]["answers"]


def test_a_folder_that_cannot_be_written_is_told(here):
    session = coursework.study("coriolis", lang="en", folder=here / "nowhere")
    assert "cannot be written" in str(session.check({"a_coriolis": "3"}))
    assert session.answers == {"a_coriolis": "3"}


def test_a_deliberate_error_shows_no_traceback_in_a_notebook():
    (line,) = CourseworkError("too long")._render_traceback_()
    assert line == "CourseworkError: too long"


def test_fresh_variants_are_worth_issuing_all_different_and_the_same_for_ever(here):
    session = coursework.study("four_bar_motion", seed=3, lang="en")
    fresh = [session.fresh(k).variant for k in range(1, 6)]
    assert [v.seed for v in fresh] == [session.fresh(1).fresh(k).variant.seed for k in range(1, 6)]
    assert len({tuple(v.given.values()) for v in (session.variant, *fresh)}) == 6
    assert len(worthy(session.variant.exercise, fresh)) == 5
    for number in (0, -1, True, "2"):
        with pytest.raises(BadInput, match="from 1 on"):
            session.fresh(number)


def test_one_fresh_variant_follows_another_without_an_answer(here):
    session = coursework.study("slotted_mechanism", seed=42, lang="en")
    seeds = {session.variant.seed}
    for _ in range(2):
        session = session.fresh()
        assert session.variant.seed not in seeds
        seeds.add(session.variant.seed)
        session.check({"rA": "1"})
    again = session.fresh().fresh()
    assert again.variant.seed not in seeds


@pytest.mark.parametrize("lang", ["fr", "en"])
def test_what_is_offered_as_a_prediction_is_read(lang):
    offered = words(lang)["study"]["options"]
    assert [wording.sign(option) for option in offered["sign"].split(" / ")] == ["+", "-"]
    assert [wording.comparison(option) for option in offered["compare"].split(" / ")] == [">", "<"]
    assert [wording.quadrant(option) for option in offered["quadrant"].split(" / ")] == [1, 2, 3, 4]


def test_a_right_answer_within_a_wide_tolerance_is_the_curves_own(here):
    session = coursework.study("slider_crank", seed=8, lang="en")
    value = session.variant.walk["ab_n"] + 0.9 * session.variant.key.half_width(
        next(p for p in session.variant.parts if p.id == "ab_n")
    )
    assert "✓" in str(session.check({"ab_n": f"{value:.4g}"}))
    assert "another" not in str(session.plot("ab_n"))


BOTH = pytest.mark.parametrize("lang", ["fr", "en"])
SAID = {lang: words(lang)["study"] for lang in ("fr", "en")}


def start_of(sentence: str) -> str:
    """The longest piece of a sentence that does not depend on what is put in."""
    return flat(max(re.split(r"\{\w+\}", sentence), key=len)).strip(" .:;`»”“")


def flat(shown: object) -> str:
    """What is shown, on one line, with the spaces and apostrophes of a keyboard."""
    return " ".join(str(shown).replace("’", "'").split())


@BOTH
def test_values_of_numpy_are_answers_and_predictions(lang, here):
    session = coursework.study("ball_reducer", lang=lang)
    for _ in range(2):
        session.check({"axis_30_dir": np.array([1, 0, 1]), "omega": np.float64(2.5)})
    assert session.answers == {"axis_30_dir": [1, 0, 1], "omega": 2.5}
    assert coursework.study("ball_reducer", lang=lang).answers == session.answers
    session = coursework.study("slotted_mechanism", lang=lang)
    assert start_of(SAID[lang]["not_understood"]) not in flat(session.predict({"theta4": np.int64(2)}))


@BOTH
def test_answers_that_are_right_in_both_variants_are_no_copy(lang, here):
    session = coursework.study("slider_extras", seed=1, lang=lang)
    equation = "r2*cos(theta2) + r3*cos(theta3) = r4*cos(theta4)"
    session.check({"mobility": "1", "cycles": "2", "loop_1_x": equation})
    again = session.fresh(1)
    for told in ({"mobility": "1", "cycles": "2"}, {"mobility": "1", "cycles": "2", "loop_1_x": equation}):
        assert start_of(SAID[lang]["copied"]) not in flat(again.check(told))
        assert again.answers == told
    assert coursework.study("slider_extras", seed=1, lang=lang).fresh(1).answers == told


@BOTH
def test_a_copy_of_variant_zero_is_one_too_and_keeps_what_is_right(lang, here):
    session = coursework.study("slider_extras", seed=0, lang=lang)
    right = session.variant.solution()
    told = {"mobility": "1", **{n: f"{right[n]:.5g}" for n in ("theta3", "omega4")}}
    session.check(told)
    again = session.fresh(1)
    assert start_of(SAID[lang]["copied"].format(seed=0)) in flat(again.check(told))
    assert again.answers == {"mobility": "1"}
    assert session.answers == told


@BOTH
def test_what_was_accepted_in_another_way_is_not_contradicted(lang, here):
    """The second assembly given first: the reference of the first is neither told nor compared."""
    session = coursework.study("four_bar_positions", seed=1, lang=lang)
    walk = session.variant.walk
    session.predict({"theta4_open": "3"})
    session.check({"theta3_open": f"{walk['theta3_crossed']:.2f}"})
    last = str(session.hint("theta4_open", 4)).rpartition("4. ")[2]
    assert f"{walk['theta3_open']:.1f}" not in last.replace(",", ".")
    assert "θ₃" in last
    said = str(session.check({"theta4_open": f"{walk['theta4_crossed']:.2f}"}))
    assert said.count("- ✓ ") == 3
    assert "- ✗" not in said


@BOTH
def test_a_hint_holds_what_the_student_wrote_not_the_reference(lang, here):
    session = coursework.study("slotted_mechanism", seed=1, lang=lang)
    session.check({"theta4": "66"})
    last = str(session.hint("omega4", 4))
    assert "66.7" not in last.replace(",", ".")
    assert "− 66°" in last


@BOTH
def test_a_right_answer_of_another_choice_is_not_marked_on_the_curve(lang, here):
    session = coursework.study("four_bar_positions", seed=1, lang=lang)
    names = [p.id for p in predictions.moving(session.variant)]
    session.check({"theta3_open": f"{session.variant.walk['theta3_crossed']:.3f}"})
    assert "theta3_open" in names
    shown = session.plot("theta3_open")
    assert not any("<circle" in getattr(piece, "svg", "") for piece in shown.pieces)
    assert start_of(SAID[lang]["beside_curve"]) in flat(shown)


@BOTH
def test_another_scale_of_the_drawing_leaves_symbols_in_the_hints(lang, here):
    session = coursework.study("velocity_polygon", seed=1, lang=lang)
    walk = session.variant.walk
    scale = 2 * walk["kv"]
    told = {"kv": f"{scale:g}", "p": "0; 0", "a": walk["a"] / 2, "b": walk["b"] / 2, "ab": walk["ab"] / 2}
    said = str(session.check({**told, "pv_b": walk["pv_b"] / 2}))
    assert "- ✓ 9." in said
    last = str(session.hint("v_B", 9))
    assert not re.search(r"\d", last.rpartition("=")[2].partition("\n")[0])


@BOTH
@pytest.mark.parametrize("question", [5, "5", "question 5", "Q5", "n° 5"])
def test_a_question_may_be_told_by_its_number(question, lang, here):
    session = coursework.study("slotted_mechanism", seed=42, lang=lang)
    assert str(session.hint(question)) == str(
        coursework.study("slotted_mechanism", seed=42, lang=lang, folder=here / "x").hint("omega4")
    )
    assert str(session.reveal(question)) == str(session.reveal("omega4"))
    assert str(session.plot(question)) == str(session.plot("omega4"))
    session.check({question: "7"})
    assert session.answers == {"omega4": "7"}
    with pytest.raises(UnknownName):
        session.hint(99)


@every_exercise
def test_the_name_of_a_question_stands_beside_its_number(name, here):
    variant = COURSE[name].variant(3, "fr")
    book = json.loads(renderer_of(COURSE.folder).study(variant.study_sheet()))
    text = "\n".join("".join(c["source"]) for c in book["cells"] if c["cell_type"] == "markdown")
    for number, part in enumerate(variant.parts, start=1):
        assert f"**{number}.** `{part.id}` — " in text


@BOTH
def test_feedback_names_the_question_beside_its_number(lang, here):
    said = coursework.study("slotted_mechanism", lang=lang).check({"omega4": "1e9"})
    assert "**5.** `omega4` — " in said.markdown


@BOTH
def test_a_call_without_what_it_needs_says_what_there_is(lang, here):
    session = coursework.study("slotted_mechanism", lang=lang)
    for said in (session.reveal(), session.predict(), session.predict({}), session.hint()):
        assert "theta4" in str(said)
    session.check(rA="238")
    session.predict(theta4="1")
    assert session.answers == {"rA": "238"}
    assert session.predictions == {"theta4": "1"}
    with pytest.raises(UnknownName) as refused:
        session.hints("rA")
    assert start_of(SAID[lang]["refused"]["method"]) in str(refused.value)
    assert "hint" in str(refused.value).partition("hints")[2]
    assert not hasattr(session, "hints")


NOT_READ = {
    "velocity_polygon": {"kv": "12 ± 3 ± 1", "p": "là", "known_A": "je ne sais pas"},
    "slider_extras": {"mobility": "un peu", "theta3": "50 ou 60", "loop_1_x": "r2 + + = 3 )"},
}


@BOTH
@pytest.mark.parametrize("name", NOT_READ)
def test_who_works_alone_is_not_told_that_somebody_will_look(name, lang, here):
    session = coursework.study(name, seed=1, lang=lang)
    for part, text in NOT_READ[name].items():
        said = " ".join(str(session.check({part: text})).split())
        assert "- ? " in said, said
        assert "somebody" not in said
        assert "quelqu" not in said
    said = flat(session.check(NOT_READ[name]))
    if name == "velocity_polygon":
        assert f"length ({flat(session.variant.label('known_A', 'length'))})" in said
    else:
        assert start_of(SAID[lang]["not_read"]["equation"].partition("`")[0]) in said


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


@BOTH
def test_what_a_file_holds_beyond_what_is_asked_stays_and_does_no_harm(lang, here):
    path = here / "slotted_mechanism.study.json"
    answers = {"rA": "1", "zz": "3", "omega4": {"x": 1}, "guide": [2], "theta4": None}
    kept = {"variants": {"1": {"answers": answers, "predictions": {"yy": "+", "theta4": [1]}}}}
    path.write_text(json.dumps(kept), "utf-8")
    session = coursework.study("slotted_mechanism", seed=1, lang=lang)
    for said in (session.check({}), session.hint("rA_dot", 4), session.plot(), session.progress()):
        assert str(said)
    session.check({"rA": "2"})
    assert "zz" not in session.answers
    assert json.loads(path.read_text("utf-8"))["variants"]["1"]["answers"]["zz"] == "3"


@BOTH
@pytest.mark.parametrize(
    ("content", "why"),
    [
        ({"exercise": "coriolis", "variants": {"1": {"answers": {"rA": "1"}}}}, "other"),
        ({"variants": {"-3": {"answers": {"rA": "1"}}}}, "damaged"),
        ({"variants": {"one": {}}}, "damaged"),
        ({"variants": {"1": {"answers": "rA"}}}, "damaged"),
        ([], "damaged"),
    ],
)
def test_a_file_that_cannot_be_of_this_exercise_is_set_aside_and_told(content, why, lang, here):
    path = here / "slotted_mechanism.study.json"
    for number in ("", "1"):
        path.write_text(json.dumps(content), "utf-8")
        session = coursework.study("slotted_mechanism", seed=1, lang=lang)
        told = start_of(SAID[lang]["trouble"][why].format(file=path.name))
        assert told[:40] in str(session.progress()).replace("\n", " ")
        assert not path.exists()
        assert json.loads((here / f"slotted_mechanism.study.damaged{number}.json").read_text()) == content


# ----------------------------------------------------------------------- hints


@every_exercise
def test_no_hint_holds_a_value_that_is_asked(name):
    """Numbers of hints are given ones, or small whole numbers of formulas."""
    for seed in range(3):
        variant = COURSE[name].variant(seed, "en")
        given = [abs(v) for v in variant.given.values() if not isinstance(v, str)]
        for part in variant.parts:
            for text in hints.steps(variant, part.id):
                for number in re.findall(r"\\num\{([^{}]*)\}", text):
                    known = any(abs(abs(float(number)) - g) <= 1e-5 * g for g in given)
                    constant = float(number) in (0, 0.5, 1, 2, 3, 4, 5, 6, 90, 180, 360, 1000)
                    assert known or constant, f"{part.id}: {number} in {text}"


@every_exercise
def test_every_question_has_a_hint_and_a_revealed_value(name):
    for lang in ("fr", "en"):
        variant = COURSE[name].variant(2, lang)
        for part in variant.parts:
            assert hints.revealed_text(variant, part.id)
            assert all(text.strip() for text in hints.steps(variant, part.id))
            assert hints.steps(variant, part.id), part.id


@every_exercise
def test_no_hint_tells_the_case_of_a_choice(name):
    for seed in range(4):
        variant = COURSE[name].variant(seed, "en")
        for part in variant.parts:
            if part.kind == "choice":
                label = variant.label(part.id, str(variant.walk[part.quantity]))
                for text in hints.steps(variant, part.id):
                    assert f"“{label}”" not in text, f"{part.id}: {text}"
                    assert f"**{label}**" not in text, f"{part.id}: {text}"


def test_numbers_side_by_side_would_be_the_answer_and_are_no_hint():
    variant = COURSE["ball_reducer"].variant(3, "en")
    assert [
        r"\num{" in text.replace(r"\num{0}", "") for text in hints.steps(variant, "axis_31_point")[1:]
    ] == [
        False,
        False,
    ]


def test_hints_come_one_by_one_and_stay(here):
    session = coursework.study("slotted_mechanism", seed=42, lang="en")
    first, second = str(session.hint("omega4")), str(session.hint("omega4"))
    assert "Hint 1 of 4" in first
    assert "Hint 2" not in first
    assert "Hint 1 of 4" in second
    assert "Hint 2 of 4" in second
    assert "Hint 4 of 4" in str(session.hint("omega4", 4))
    assert "reveal" in str(session.hint("omega4"))
    with pytest.raises(UnknownName, match="omega4"):
        session.hint("omega44")


def test_what_the_student_has_found_stands_as_a_number_in_the_last_hint(here):
    session = coursework.study("slotted_mechanism", seed=42, lang="en")
    assert "r_A" in str(session.hint("omega4", 4)).rpartition("Hint 4")[2]
    right = session.variant.solution()
    session.check({"rA": f"{right['rA']:.6g}"})
    last = str(session.hint("omega4", 4)).rpartition("Hint 4")[2]
    assert f"{right['rA']:.6g}" in last
    assert "r_A" not in last


def test_a_step_on_the_way_has_hints_of_its_own(here):
    session = coursework.study("slotted_mechanism", seed=42, lang="en")
    assert 'study.hint("delta")' in str(session.hint("rA"))
    assert "Hint 1" in str(session.hint("delta"))


# ----------------------------------------------------------------- predictions


def test_predictions_are_compared_with_what_comes_out(here):
    """The values are the course's own: at theta2 = 135° the guide points at 104.64°, 319.80 mm long."""
    exercise = COURSE["slotted_mechanism"]
    variant = exercise.variant(0, "en")
    given = {"r1": 228.6, "theta1": 90, "r2": 114.3, "theta2": 135, "omega2": 1, "alpha2": 0}
    variant = type(variant)(exercise, 0, given, "en")
    asked = {
        "theta4": ("quadrant", "2", "1"),
        "rA": ("compare", ">", "<"),
        "omega4": ("sign", "+", "-"),
        "guide": ("guess", "oscillates", "rotates"),
        # The crank lies along the frame at 90°; the guide oscillates, so it stands still twice.
        "highest_rA": ("highest", "80", "270"),
        "zeros_omega4": ("zeros", "2", "0"),
    }
    for key, (kind, right, wrong) in asked.items():
        quantity = key.rpartition("_")[2]
        choices = ("oscillates", "rotates") if kind == "guess" else ()
        one = predictions.Prediction(key, quantity, kind, "r1" if kind == "compare" else "", choices)
        assert predictions.compared(variant, one, right).right is True, key
        assert predictions.compared(variant, one, wrong).right is False, key
        assert predictions.compared(variant, one, " ") is None
        assert predictions.compared(variant, one, "eh?").right is None, key


READ = {
    wording.sign: {
        "+": ["+", "positif", "Positive", "plus", "+ 3", "> 0", "POSITIF."],
        "-": ["-", "−", "négatif", "negative", "negatif", "moins", "minus", "< 0"],
        "": ["+/-", "+ ou -", "positif ou négatif", "eh?", "0", "non positif"],
    },
    wording.comparison: {
        ">": [">", "plus grand", "plus grande que r1", "larger", "larger than r1", "> r1", "greater", "Plus Grand"],
        "<": ["<", "plus petit", "smaller", "plus petit que $r_1$", "less than r1", "inférieur à r1"],
        "=": ["=", "égal", "equal to r1"],
        "": ["<>", "plus grand ou plus petit", "12", "eh?"],
    },
    wording.quadrant: {
        4: ["4", "IV", "iv", "4e", "4ème", "4th", "quatrième", "fourth", "Q4", "quadrant 4", "le 4e quadrant", "4.0"],
        1: ["1", "I", "1er", "premier", "first", "the first quadrant", "1st", "un", "one"],
        None: ["5", "0", "V", "1 ou 2", "eh?", "45°"],
    },
    wording.count: {
        2: ["2", "2 fois", "deux", "deux fois", "2.0", "2,0", "two", "twice", "two times", "2 times"],
        0: ["0", "jamais", "never", "zéro", "aucune"],
        1: ["une fois", "once", "1 fois"],
        None: ["2,5", "-1", "eh?", "plusieurs"],
    },
    wording.truth: {
        True: ["oui", "yes", "Vrai", "True", True],
        False: ["non", "no", "Faux", "false", False],
        None: ["eh?", "oui et non", "1"],
    },
}  # fmt: skip


@pytest.mark.parametrize("reader", READ, ids=lambda reader: reader.__name__)
def test_predictions_are_read_in_the_words_of_their_questions(reader):
    for meant, texts in READ[reader].items():
        for text in texts:
            assert reader(text) == meant, text


@BOTH
@pytest.mark.parametrize(
    "text", ["90 degrés", "90 degrees", "90°", "90", "environ 90", "vers 90°", "1,5708 rad", 90.0]
)
def test_the_place_of_a_peak_is_read_with_its_unit(text, lang):
    variant = COURSE["slotted_mechanism"].variant(1, lang)
    (one,) = [p for p in predictions.over_the_cycle(variant) if p.kind == "highest"]
    assert predictions.compared(variant, one, text).right is True


@BOTH
def test_a_prediction_that_cannot_be_read_is_told_at_once(lang, here):
    session = coursework.study("slotted_mechanism", seed=1, lang=lang)
    told = start_of(SAID[lang]["not_understood"])
    said = flat(session.predict({"theta4": "eh?", "omega4": "+/-", "rA": ">"}))
    assert said.count(told) == 2
    assert "1 / 2 / 3 / 4" in said
    assert told not in flat(
        session.predict({"theta4": "IV", "omega4": words(lang)["study"]["reads"]["negative"][0]})
    )


@every_exercise
def test_the_choices_of_a_prediction_are_named_in_the_language_of_the_notebook(name):
    variant = COURSE[name].variant(4, "fr")
    for one in predictions.before_answers(variant):
        shown = predictions.options(variant, one)
        for case in one.choices:
            label = variant.label(one.id, case)
            plain = re.sub(r"[$\\].*", "", label).replace("'", "’").split(":")[0].strip()
            assert plain in shown.replace("'", "’").replace("\u202f", " "), (label, shown)


@every_exercise
def test_nothing_is_compared_with_a_direction(name):
    variant = COURSE[name].variant(4, "fr")
    for one in predictions.before_answers(variant):
        assert one.kind != "compare" or COURSE[name].spec.given[one.other].unit != "deg"


def test_a_curve_that_vanishes_at_the_ends_of_the_turn_vanishes_there_once():
    turn = np.radians(np.linspace(0, 360, 721))
    counts = [predictions.zeros(f(k * turn)) for f in (np.sin, np.cos) for k in (1, 2)]
    assert counts == [2, 4, 2, 4]
    assert predictions.zeros(np.ones(9)) == 0


@every_exercise
def test_a_rate_whose_sign_is_asked_over_the_cycle_passes_through_zero_there(name):
    """Lengths of vectors touch zero without a change of sign: they are not asked."""
    for seed in (1, 2):
        variant = COURSE[name].variant(seed, "en")
        for one in predictions.over_the_cycle(variant):
            if one.kind == "zeros":
                values = predictions.curve(variant, one.quantity)[1]
                touches = (np.abs(values) <= np.roll(np.abs(values), 1)) & (
                    np.abs(values) < np.roll(np.abs(values), -1)
                )
                near = np.abs(values) < 2e-3 * np.nanmax(np.abs(values))
                if not np.isnan(values).any():
                    assert (touches & near)[:-1].sum() <= predictions.zeros(values)


def test_a_prediction_is_compared_only_when_its_answer_is_right(here):
    session = coursework.study("slotted_mechanism", seed=42, lang="en")
    session.predict({"theta4": "1"})
    assert "You said" not in str(session.check({"theta4": "1000"}))
    right = session.variant.solution()["theta4"]
    assert "You said" in str(session.check({"theta4": f"{right:.4f}"}))


@every_exercise
def test_every_exercise_has_something_to_predict(name):
    variant = COURSE[name].variant(4, "en")
    before = predictions.before_answers(variant)
    assert 1 <= len(before) <= predictions.MOST
    for one in (*before, *predictions.over_the_cycle(variant)):
        assert predictions.asked(variant, one).endswith("?")
        assert predictions.options(variant, one)


def test_what_to_predict_does_not_depend_on_the_variant():
    """Else the question itself would tell something of the answer."""
    exercise = COURSE["four_bar_motion"]
    kinds = {tuple(predictions.before_answers(exercise.variant(seed))) for seed in range(5)}
    assert len(kinds) == 1


def test_something_not_asked_cannot_be_predicted(here):
    with pytest.raises(UnknownName, match="theta4"):
        coursework.study("slotted_mechanism").predict({"theta5": "1"})


def test_lessons_compare_predictions_with_what_came_out():
    said = str(coursework.compare({"a": 2, "b": None, "c": True, "d": "x"}, {"a": 2.1, "b": 5, "c": False, "d": 1}, "en"))  # fmt: skip
    assert said.splitlines() == [
        "- ✓ a: predicted 2, found 2.1",
        "- · b: no prediction, found 5",
        "- ✗ c: predicted yes, found no",
        "- ✗ d: predicted x, found 1",
    ]


AGREE = [
    ("non", False, True), ("oui", False, False), ("Vrai", True, True), ("True", True, True), (True, True, True),
    ("eh?", False, False), ("2,3", 2.3, True), ("140 mm", 140.0, True), ("0,14 m", 140.0, True), ("deux", 2, True),
    ("2 fois", 2, True), ("0", 0, True), (0.01, 0, True), (1, 0, False), ("5°", 0, True), ("360°", 0, True),
    ("20°", 0, False), (np.float64(2.2), 2.3, True), ("II", "II", True), ("ii", "II", True), ("I", "II", False),
    (2, 2.5, False), ("+/-", 1, False),
]  # fmt: skip


@pytest.mark.parametrize(("guess", "value", "agrees"), AGREE)
def test_a_lesson_reads_predictions_as_they_are_written(guess, value, agrees):
    for lang in ("fr", "en"):
        assert str(coursework.compare({"a": guess}, {"a": value}, lang)).startswith(
            "- ✓" if agrees else "- ✗"
        )


def test_an_angle_is_near_whole_turns_apart_where_it_is_named_as_one():
    for guess in (5, 360, "-4", "355"):
        assert str(coursework.compare({"a": guess}, {"a": 0}, "fr", angles=("a",))).startswith("- ✓")
        assert str(coursework.compare({"a": guess}, {"a": 0}, "fr")).startswith("- ✗")
    assert str(coursework.compare({"a": 20}, {"a": 0}, "fr", angles=("a",))).startswith("- ✗")


@BOTH
def test_a_lesson_says_which_name_nothing_has_come_out_of(lang):
    said = str(coursework.compare({"facteru": 2, "other": None}, {"facteur": 2}, lang))
    assert said.splitlines()[1].startswith("- ? facteru")
    assert said.replace("\n", " ").count("facteur") == 2
    assert "other" not in said


# ----------------------------------------------------------------------- plots


def points_of(svg: str) -> list[np.ndarray]:
    """The curve's pieces, mm, y down."""
    (path,) = re.findall(r'<path d="([^"]*)" fill="none" stroke="#1b3a57" stroke-width="0.5"', svg)
    return [np.array([p.split() for p in run.split("L")], dtype=float) for run in path.split("M")[1:]]


def test_a_curve_is_drawn_to_scale_and_the_same_twice():
    x = np.linspace(0, 360, 25)
    plot = Plot(Axis(r"\theta_2", "°", x), [Axis("y", "mm", 2 * x + 5)], "en")
    (curve,) = points_of(plot.svg())
    assert plot.svg() == plot.svg()
    step = np.diff(curve, axis=0)
    assert np.ptp(step, axis=0) == pytest.approx([0, 0], abs=0.021)
    assert (step * [1, -1] > 0).all()


def test_a_curve_is_cut_where_it_has_no_value_and_where_a_direction_turns_over():
    x = np.arange(8.0)
    y = np.array([1, 2, np.nan, 3, 4, 5, 4, 3.0])
    assert len(points_of(Plot(Axis("x", "", x), [Axis("y", "mm", y)]).svg())) == 2
    y = np.array([170, 175, 179, -178, -170, -160, -150, -140.0])
    assert len(points_of(Plot(Axis("x", "", x), [Axis("y", "°", y)]).svg())) == 2
    assert len(points_of(Plot(Axis("x", "", x), [Axis("y", "mm", y)]).svg())) == 1


def test_a_right_point_lies_on_its_curve_and_is_told_from_a_wrong_one():
    x = np.linspace(0, 10, 11)
    spots = [[Spot(4, 16, True)], [Spot(4, 60, False)]]
    plot = Plot(Axis("x", "", x), [Axis("y", "mm", x**2), Axis("z", "mm", x**2)], "en", 4, spots)
    svg = plot.svg()
    cx, cy = map(float, re.search(r'<circle cx="([\d.]+)" cy="([\d.]+)" r="1.3"', svg).groups())
    first = points_of(Plot(plot.horizontal, plot.panels[:1], "en", 4, spots[:1]).svg())[0]
    assert [cx, cy] == pytest.approx(first[4].tolist(), abs=0.011)
    assert svg.count('stroke="#b3261e"') == 1


def test_a_point_far_off_its_curve_is_an_arrow_at_the_edge_with_its_number():
    x = np.linspace(0, 10, 11)
    for y, is_far in ((60.0, False), (900.0, True), (-900.0, True)):
        plot = Plot(Axis("x", "", x), [Axis("y", "mm", x**2)], "en", 4, [[Spot(4, y, False, 246.7)]])
        cross, arrow = (s in plot.svg() for s in ('stroke="#b3261e"', 'z" fill="#b3261e"'))
        assert (plot.has_outside, cross, arrow) == ((is_far,), not is_far, is_far)
    far, near = (
        Plot(plot.horizontal, plot.panels, "en", 4, [[Spot(4, 900.0, False, w)]]) for w in (1.0, 246.7)
    )
    assert far.svg() != near.svg()


@BOTH
def test_a_wrong_angle_is_not_drawn_as_if_it_were_nearly_right(lang, here):
    session = coursework.study("slotted_mechanism", seed=1, lang=lang)
    session.check({"theta4": "246,7"})
    shown = session.plot("theta4")
    assert start_of(SAID[lang]["outside"]) in flat(shown)
    (svg,) = (piece.svg for piece in shown.pieces if hasattr(piece, "svg"))
    # 246.7° is above the curve, which reaches 114°.
    assert re.search(r'h2.8l-1.4 -2z" fill="#b3261e"', svg)


def test_a_plot_says_what_it_cannot_draw():
    x = np.arange(3.0)
    for panels in ([], [Axis("y", "", np.arange(2.0))], [Axis("y", "", x * np.nan)]):
        with pytest.raises(WrongValue, match=r"curve|plot"):
            Plot(Axis("x", "", x), panels)


def test_the_curves_of_a_session_pass_through_the_answers(here):
    for name in ("slotted_mechanism", "slider_crank", "three_loop_shaper"):
        session = coursework.study(name, seed=2, lang="en")
        variant = session.variant
        driver = variant.exercise.spec.driver.angle
        for part in predictions.moving(variant):
            angles, values = predictions.curve(variant, part.quantity)
            at = np.argmin(np.abs((angles - variant.given[driver] + 180) % 360 - 180))
            gap = values[at] - variant.walk[part.quantity]
            gap = (gap + 180) % 360 - 180 if part.kind == "angle" else gap
            assert abs(gap) <= 1e-6 * np.nanmax(np.abs(values))
        assert "largest" in str(session.predict({})) or session.plot().pieces
        with pytest.raises(UnknownName):
            session.plot("nothing")
