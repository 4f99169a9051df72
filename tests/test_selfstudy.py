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
from coursework.language import words
from coursework.selfstudy import hints, predictions
from coursework.worth import worthy

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
    cells = code_cells(COURSE.renderer.study(COURSE[name].variant(3, lang).study_sheet()))
    assert any("study.check(answers)" in source for source in cells)
    assert run_cells(cells) == run_cells(cells)


@pytest.mark.parametrize(("name", "lang"), [("slotted_mechanism", "en"), ("mobility", "fr")])
def test_a_self_study_notebook_runs_in_a_kernel(name, lang, tmp_path):
    import nbformat
    from nbclient import NotebookClient

    text = COURSE.renderer.study(COURSE[name].variant(3, lang).study_sheet())
    book = nbformat.reads(text, as_version=4)
    resources = {"metadata": {"path": str(tmp_path)}}
    NotebookClient(book, timeout=120, kernel_name="python3", resources=resources).execute()
    outputs = [o for cell in book.cells for o in cell.get("outputs", ())]
    assert all(o.output_type in ("display_data", "execute_result") for o in outputs)
    assert any("text/markdown" in o.data for o in outputs)


@every_exercise
def test_a_self_study_notebook_is_the_same_twice_and_has_one_cell_of_answers(name):
    first, second = (COURSE.renderer.study(COURSE[name].variant(3, "fr").study_sheet()) for _ in range(2))
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
        text = COURSE.renderer.notebook(variant.handout("Zoé"))
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
    shown = run_cells(code_cells(variant.exercise.course.renderer.study(variant.study_sheet())))
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
    "no name": (lambda s: s.check({3: "1"}), UnknownName, "omega4"),
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
                    constant = float(number) in (0, 0.5, 1, 2, 3, 4, 6, 90, 180, 360, 1000)
                    assert known or constant, f"{part.id}: {number} in {text}"


@every_exercise
def test_every_number_asked_has_a_hint_and_a_revealed_value(name):
    variant = COURSE[name].variant(2, "fr")
    for part in variant.parts:
        assert hints.revealed_text(variant, part.id)
        if part.kind in ("number", "angle"):
            assert hints.steps(variant, part.id)


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
