"""Statistics of a class: numbers got another way, classes of known difficulty, pages, the command."""

from __future__ import annotations

import csv
import json

import numpy as np
import pytest
from sweeps import whole_course
from tables import each_row

from coursework.cli import run
from coursework.errors import BadInput, BadStatement
from coursework.figures import charts
from coursework.figures import text as figure_text
from coursework.gradebook.book import MARKS_COLUMNS, REJECTED_COLUMNS, SUMMARY_COLUMNS, VERDICTS
from coursework.gradebook.statistics.captions import Names
from coursework.gradebook.statistics.marks import read
from coursework.gradebook.statistics.measures import ENOUGH, WEAK, correlation, measure
from coursework.gradebook.statistics.page import mistake_rows, report, sheet_order
from coursework.language.words import languages, words
from coursework.markup.markdown import plain_line
from coursework.rendering.renderer import Renderer, renderer_of


def line(student, exercise, part, verdict, points, out_of=1.0, answer="1"):
    return {
        **dict.fromkeys(MARKS_COLUMNS, ""),
        "student": student,
        "exercise": exercise,
        "seed": 1,
        "part": part,
        "answer": answer,
        "verdict": verdict,
        "points": f"{points:g}",
        "out_of": f"{out_of:g}",
    }


def write(path, rows, columns):
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, columns)
        table.writeheader()
        table.writerows(rows)


@pytest.fixture
def folder(tmp_path):
    """Write a folder of marks; the summary names students with the points they could have."""

    def make(lines, summary=None, rejected=0):
        write(tmp_path / "marks.csv", lines, MARKS_COLUMNS)
        if summary is not None:
            rows = [
                {**dict.fromkeys(SUMMARY_COLUMNS, 0), "student": s, "out_of": of, "missing": missing}
                for s, (of, missing) in summary.items()
            ]
            write(tmp_path / "summary.csv", rows, SUMMARY_COLUMNS)
        if rejected:
            row = {**dict.fromkeys(REJECTED_COLUMNS, ""), "reason": "no student\nof this name"}
            write(tmp_path / "rejected.csv", [row] * rejected, REJECTED_COLUMNS)
        return tmp_path

    return make


def lines_of(points, out_of, exercise="e"):
    """A line a student and part, for points of shape (students, parts)."""
    return [
        line(f"s{i}", exercise, f"p{k}", "correct" if got == of else "wrong", got, of)
        for i, row in enumerate(points)
        for k, (got, of) in enumerate(zip(row, out_of, strict=True))
    ]


def part_of(statistics, part, exercise="e"):
    (found,) = (p for p in statistics.parts if (p.exercise, p.part) == (exercise, part))
    return found


# ---------------------------------------------------------------------- numbers


def test_a_small_class_counted_by_hand(folder):
    verdicts = ["correct", "follow_through", "mistake:sign", "slip:degrees", "wrong", "unreadable", "missing"]
    points = [2, 2, 1, 1, 0, 0, 0]
    lines = [line(f"s{i}", "e", "p", v, p, 2) for i, (v, p) in enumerate(zip(verdicts, points, strict=True))]
    told = measure(read(folder(lines, rejected=3)))
    part = part_of(told, "p")
    assert (told.students, told.answers, told.rejected, told.needs_a_look) == (7, 7, 3, 4)
    assert part.right == 2 / 7
    assert part.mean == pytest.approx((1 + 1 + 0.5 + 0.5) / 7)
    assert part.lost == 1 + 1 + 2 + 2 + 2
    assert part.share("missing") == part.share("slip") == 1 / 7
    assert sum(part.counts.values()) == part.answers
    assert {f for f, n in part.counts.items() if not n} == {
        *("accepted", "partial", "wrong_unit", "missing_unit", "to_mark")
    }
    sign = next(m for m in told.mistakes if m.name == "sign")
    assert (sign.count, sign.share, sign.lost, sign.share_of_lost) == (1, 1 / 7, 1, 1 / 8)
    assert [m.kind for m in told.mistakes] == ["mistake", "slip"]


def test_discrimination_is_the_correlation_with_all_the_rest(folder):
    rng = np.random.default_rng(3)
    out_of = np.array([1, 2, 0.5, 4])
    points = out_of * rng.choice([0, 0.5, 1], size=(40, 4), p=[0.3, 0.3, 0.4])
    told = measure(read(folder(lines_of(points, out_of))))
    for k in range(4):
        rest = points.sum(axis=1) - points[:, k]
        expected = np.corrcoef(points[:, k], rest)[0, 1]
        assert part_of(told, f"p{k}").discrimination == pytest.approx(expected, abs=1e-12)


def test_what_was_not_handed_in_counts_as_nothing_in_the_rest(folder):
    """Half of the class leaves the second exercise out; the summary says what they could have."""
    rng = np.random.default_rng(5)
    points = (rng.random((30, 4)) < 0.6).astype(float)
    points[::2, 2:] = 0
    lines = [
        row
        for row in lines_of(points[:, :2], [1, 1], "first")
        + [{**r, "exercise": "second"} for r in lines_of(points[:, 2:], [1, 1])]
        if row["exercise"] == "first" or int(row["student"][1:]) % 2
    ]
    told = measure(read(folder(lines, {f"s{i}": (4, 2 if i % 2 == 0 else 0) for i in range(30)})))
    expected = np.corrcoef(points[:, 0], points[:, 1:].sum(axis=1))[0, 1]
    assert part_of(told, "p0", "first").discrimination == pytest.approx(expected, abs=1e-12)
    assert part_of(told, "p0", "second").answers == 15
    assert told.without_line == 30
    assert told.percents == pytest.approx(25 * points.sum(axis=1))


def test_a_class_of_known_difficulty_is_found_again(folder):
    """Chances of a right answer by part; the last but one is a coin, the last trips those who know."""
    rng = np.random.default_rng(11)
    n, chances = 4000, [0.9, 0.7, 0.4, 0.15]
    strength = rng.normal(size=n)
    luck = rng.random(n)
    bounds = [np.quantile(strength + luck, 1 - c) for c in chances]
    columns = [strength + rng.permutation(luck) > b for b in bounds]
    columns += [rng.random(n) < 0.5, strength + luck < np.quantile(strength + luck, 0.3)]
    points = np.array(columns, dtype=float).T
    told = measure(read(folder(lines_of(points, [1] * 6))))
    for k, chance in enumerate([*chances, 0.5, 0.3]):
        assert part_of(told, f"p{k}").right == pytest.approx(chance, abs=0.03)
    assert min(part_of(told, f"p{k}").discrimination for k in range(4)) > WEAK
    assert abs(part_of(told, "p4").discrimination) < 0.06
    assert part_of(told, "p5").discrimination < -0.2


def test_students_of_the_summary_who_handed_in_nothing_count_at_zero(folder):
    told = measure(read(folder([line("a", "e", "p", "correct", 1)], {"a": (1, 0), "b": (1, 1)})))
    assert (told.students, told.silent, told.without_line) == (2, 1, 1)
    assert told.histogram().tolist() == [1, 0, 0, 0, 0, 0, 0, 0, 0, 1]
    assert part_of(told, "p").answers == 1


@pytest.mark.parametrize(("count", "computed"), [(ENOUGH - 1, False), (ENOUGH, True)])
def test_few_students_have_no_discrimination(folder, count, computed):
    points = np.arange(2 * count).reshape(count, 2) % 3 / 2
    told = measure(read(folder(lines_of(points, [1, 1]))))
    assert all((p.discrimination is not None) == computed for p in told.parts)


def test_without_spread_or_without_a_rest_there_is_no_discrimination(folder):
    alike = np.column_stack([np.ones(20), np.arange(20) % 2])
    told = measure(read(folder(lines_of(alike, [1, 1]))))
    assert [p.discrimination for p in told.parts] == [None, None]
    alone = measure(read(folder(lines_of(alike[:, 1:], [1]))))
    assert part_of(alone, "p0").discrimination is None
    assert correlation(np.array([0.1 + 0.2, 0.3]), np.array([0.0, 1.0])) is None


def test_a_student_on_an_edge_is_in_the_range_above_it(folder):
    """Ten parts of 0.1 point: their sums are a hair off the tenths."""
    points = [[0.1] * n + [0] * (10 - n) for n in range(11)]
    told = measure(read(folder(lines_of(points, [0.1] * 10), {f"s{i}": (1, 0) for i in range(11)})))
    assert told.percents[9] < 90
    assert told.histogram().tolist() == [1] * 9 + [2]


def test_an_empty_class_and_one_student_are_classes_too(folder):
    nobody = measure(read(folder([])))
    assert (nobody.students, nobody.answers, nobody.parts, nobody.percents.size) == (0, 0, (), 0)
    silent = measure(read(folder([], {"a": (3, 2)})))
    assert (silent.students, silent.silent, silent.histogram()[0]) == (1, 1, 1)
    one = measure(read(folder([line("a", "e", "p", "wrong", 0)], {"a": (1, 0)})))
    assert (one.parts[0].mean, one.parts[0].discrimination, one.percents.tolist()) == (0, None, [0])


def test_mistakes_are_counted_by_part_and_summed_over_an_exercise(folder):
    lines = [line(f"s{i}", "e", "p", "mistake:sign", 0.5) for i in range(3)]
    lines += [line(f"s{i}", "e", "q", "mistake:sign", 0, 2) for i in range(2)]
    lines += [line("s2", "e", "q", "correct", 2, 2), line("s0", "f", "p", "mistake:sign", 0)]
    told = measure(read(folder(lines)))
    assert [(m.exercise, m.part, m.count) for m in told.mistakes] == [
        ("e", "p", 3),
        ("e", "q", 2),
        ("f", "p", 1),
    ]
    first, second = told.mistakes_of_exercises()
    assert (first.exercise, first.count, first.lost) == ("e", 5, 5.5)
    assert first.share == 5 / 6
    assert first.share_of_lost == pytest.approx(5.5 / 6.5)
    assert (second.exercise, second.count) == ("f", 1)


def test_parts_stand_in_the_order_of_the_sheet_whatever_came_first(folder, course):
    lines = [line("a", "slotted_mechanism", p, "correct", 1) for p in ("alpha4", "mine", "theta4", "rA")]
    marks = read(folder(lines))
    told = measure(marks, sheet_order(course, marks.exercises))
    assert [p.part for p in told.parts] == ["rA", "theta4", "alpha4", "mine"]


def test_a_mark_mended_by_hand_counts(folder):
    place = folder([line("a", "e", "p", "unreadable", 0), line("a", "e", "q", "correct", 1)], {"a": (2, 0)})
    text = (place / "marks.csv").read_text("utf-8")
    (place / "marks.csv").write_text(text.replace("unreadable,0", "correct,1"), "utf-8")
    told = measure(read(place))
    assert told.percents.tolist() == [100]
    assert told.needs_a_look == 0


# ---------------------------------------------------------------------- reading


def test_a_file_saved_by_a_french_spreadsheet_reads_the_same(folder):
    points = np.arange(24).reshape(12, 2) % 5 / 4
    place = folder(lines_of(points, [1, 1]))
    plainly = measure(read(place)).as_json()
    with (place / "marks.csv").open(encoding="utf-8", newline="") as file:
        rows = [[c.replace(".", ",") for c in row] for row in csv.reader(file)]
    with (place / "marks.csv").open("w", encoding="utf-8-sig", newline="") as file:
        csv.writer(file, delimiter=";").writerows([*rows, [""] * len(MARKS_COLUMNS)])
    assert measure(read(place)).as_json() == plainly


@pytest.mark.parametrize("encoding", ["cp1252", "utf-16", "utf-8-sig"])
def test_a_file_saved_by_excel_reads_the_same(folder, encoding):
    place = folder([line("José", "e", "p", "correct", 1), line("Zoë", "e", "p", "wrong", 0)])
    before, path = read(place), place / "marks.csv"
    path.write_bytes(path.read_text("utf-8").encode(encoding))
    assert read(place).students == before.students == ("José", "Zoë")


def test_an_answer_of_any_length_is_read_and_no_setting_is_left_changed(folder):
    usual = csv.field_size_limit(1000)
    try:
        told = measure(read(folder([line("a", "e", "p", "unreadable", 0, answer="9" * 300_000 + "\n")])))
        assert told.answers == 1
        assert csv.field_size_limit() == 1000
    finally:
        csv.field_size_limit(usual)


@pytest.mark.parametrize(
    ("damage", "says"),
    [
        (lambda text: text.replace("verdict", "judgement", 1), "verdict missing, found .*judgement"),
        (lambda text: text.replace("correct,1", "correct,much"), "line 2: points and out_of must be numbers"),
        (lambda text: text.replace("correct,1", "correct,nan"), "line 2: points and out_of must be numbers"),
        (
            lambda text: text.replace("correct,1", "correct,1e308"),
            "line 2: points and out_of must be numbers up to 1e",
        ),
        (lambda text: text.replace("correct,1,1", "correct,1,-1"), "out of -1 points"),
        (lambda text: text.replace("correct,", "splendid,"), "no verdict 'splendid'; available: correct"),
        (lambda text: text + "a,e\r\n", "line 3: 2 cells, too few"),
        (lambda text: "", "found nothing"),
        (lambda text: "é" + text, "needs the columns student"),
    ],
)
def test_a_damaged_file_is_told_in_one_line(folder, damage, says):
    place = folder([line("a", "e", "p", "correct", 1)])
    path = place / "marks.csv"
    path.write_bytes(damage(path.read_bytes().decode()).encode())
    with pytest.raises(BadInput, match=says) as told:
        read(place)
    assert "\n" not in str(told.value)


def test_a_folder_without_marks_is_told_with_what_it_holds(tmp_path):
    with pytest.raises(BadInput, match="it is empty"):
        read(tmp_path)
    (tmp_path / "issued.json").write_text("{}")
    with pytest.raises(BadInput, match=r"found issued\.json.*coursework grade"):
        read(tmp_path)
    with pytest.raises(BadInput, match="is a file"):
        read(tmp_path / "issued.json")
    with pytest.raises(BadInput, match="no folder"):
        read(tmp_path / "nowhere")
    (tmp_path / "marks").mkdir()
    (tmp_path / "marks" / "marks.csv").write_text("x")
    with pytest.raises(BadInput, match=r"did you mean .*marks"):
        read(tmp_path)


# ------------------------------------------------------------------------- page


def lines_of_a_class(students=14):
    """Marks on two exercises, one of them of no course, with every kind of verdict."""
    verdicts = [
        *("correct", "follow_through", "mistake:no_coriolis", "slip:degrees", "wrong"),
        *("wrong_unit", "missing_unit", "unreadable", "missing"),
    ]
    right = {"correct": 1, "follow_through": 1, "mistake:no_coriolis": 0.5, "slip:degrees": 0.5}
    lines = []
    for i in range(students):
        for k, part in enumerate(("rA", "theta4", "guide", "rA_ddot")):
            verdict = verdicts[(i * (k + 1) + k) % 9] if i % 3 else "correct"
            lines.append(line(f"s{i}", "slotted_mechanism", part, verdict, right.get(verdict, 0)))
        lines.append(
            line(f"s{i}", "my <b>$own$*", "p_1|`x`", "correct" if i % 2 else "mistake:a_*b*$", i % 2)
        )
    return lines


@pytest.mark.parametrize("lang", languages())
def test_the_page_says_it_in_every_language(course, folder, lang):
    marks = read(folder(lines_of_a_class(), {f"s{i}": (5, 0) for i in range(15)}, rejected=2))
    told = measure(marks, sheet_order(course, marks.exercises))
    page = report(course, told, lang)
    assert len(page.sections) == 1 + 1 + 2 + 1
    html = renderer_of(course.folder).report_html(page)
    assert html.count("<figure>") == 4
    assert "<script" not in html
    assert "<b>$own$*" not in html
    assert "my &lt;b&gt;$own$*" in html
    assert "p_1|`x`" in html
    assert course.folder.title(lang) in html
    assert course["slotted_mechanism"].title(lang) in html
    assert words(lang)["verdicts"]["follow_through"] in html
    assert renderer_of(course.folder).report_pdf(page).startswith(b"%PDF")
    other = next(other for other in languages() if other != lang)
    assert words(other)["statistics"]["short"] not in html


def test_the_words_are_the_same_in_every_language():
    def keys(table):
        return {k: keys(v) if isinstance(v, dict) else None for k, v in table.items()}

    assert len({json.dumps(keys(words(lang)["statistics"]), sort_keys=True) for lang in languages()}) == 1


def reading(course, lines, **more):
    return report(course, measure(lines, **more), "en").sections[0].text


def test_the_reading_names_what_is_hard_weak_costly_and_to_be_looked_at(course, folder):
    half = np.arange(20) % 2
    points = np.column_stack([half, half, 1 - half * (np.arange(20) > 3), np.arange(20) > 16])
    lines = lines_of(points.astype(float), [1, 1, 1, 1])
    for row in lines:
        if row["part"] == "p3" and row["verdict"] == "wrong":
            row["verdict"] = "mistake:half" if int(row["student"][1:]) < 10 else "unreadable"
        if row["part"] == "p2" and row["verdict"] == "wrong" and row["student"] == "s5":
            row["verdict"] = "slip:sign"
    text = reading(course, read(folder(lines, rejected=1)))
    hardest, weak, costly, look = text.split("\n")
    assert "p3 (15%), p0 (50%) and p1 (50%)" in hardest.replace("\\", "")
    assert "p2 (−" in weak
    assert "0.15" in weak
    assert "*half* (e), met in 10 of 20 answers" in costly
    # 10 + 10 + 8 + 17 points are lost, 10 of them by this mistake.
    assert "22% of all the points lost" in costly
    assert "8, of which unreadable answers 7, rejected rows 1" in look


def test_any_name_in_the_marks_is_printed(course, folder):
    names = ("部", "a\nb\tc", "x" * 5000, "$", "#let", "| a | b |", "\\", "", "é" * 41)
    told = [(name, verdict) for name in names for verdict in ("correct", f"mistake:{name}")]
    lines = [line(f"s{k % 2}", name, name, verdict, 0) for k, (name, verdict) in enumerate(told)]
    page = report(course, measure(read(folder(lines))), "fr")
    assert renderer_of(course.folder).report_pdf(page).startswith(b"%PDF")
    assert renderer_of(course.folder).report_html(page).count("<figure>") == 2 + len(names)


@whole_course
def test_every_symbol_of_the_course_is_a_label_of_a_chart(course):
    for name in course.names:
        for part in course[name].spec.parts:
            symbol = course[name].symbol(part.quantity, "en")
            assert figure_text.read(symbol).runs


def test_the_reading_of_a_class_without_answers_says_so(course, folder):
    page = report(course, measure(read(folder([]))), "en")
    assert "No answer was handed in" in page.sections[0].text
    assert len(page.sections) == 1
    assert renderer_of(course.folder).report_pdf(page).startswith(b"%PDF")
    perfect = read(folder(lines_of(np.ones((3, 2)), [1, 1])))
    text = reading(course, perfect)
    assert "Every question has all its points" in text
    assert "it takes 10 students" in text
    assert "No known mistake" in text


def test_a_share_that_is_not_all_does_not_print_as_all(course, folder):
    points = np.ones((400, 1))
    points[0] = 0
    page = report(course, measure(read(folder(lines_of(points, [1])))), "fr")
    assert page.sections[2].tables[0].rows[0][2] == "99 %"


def test_mistakes_are_listed_with_what_the_student_is_told(course, folder):
    lines = [line("a", "slotted_mechanism", "rA_ddot", "mistake:no_coriolis", 0.5)]
    lines += [
        line("a", "nowhere", "p", "mistake:x", 0),
        line("b", "slotted_mechanism", "rA_ddot", "slip:no_centripetal", 0),
    ]
    told = measure(read(folder(lines)))
    says = {r["mistake"]: r["says"] for r in mistake_rows(course, told, "fr")}
    assert "Coriolis" in says["no_coriolis"]
    assert says["x"] == says["no_centripetal"] == ""


@pytest.mark.parametrize(
    ("lang", "slip"),
    [("fr", "a la grandeur attendue et le signe"), ("en", "has the expected size and the opposite sign")],
)
def test_questions_and_mistakes_are_called_as_the_students_know_them(course, folder, lang, slip):
    lines = [
        line("b", "slotted_mechanism", "rA_ddot", "mistake:no_coriolis", 0.5),
        line("b", "slotted_mechanism", "omega4", "slip:sign", 0),
        line("b", "slotted_mechanism", "guide", "wrong", 0),
    ]
    told = measure(read(folder(lines)), sheet_order(course, ["slotted_mechanism"]))
    page = report(course, told, lang)
    assert "coursework report" not in renderer_of(course.folder).report_html(page)
    reading, (table,) = page.sections[0].text, page.sections[-1].tables
    assert slip in reading
    assert "sign*" not in reading.replace(slip, "")
    assert "oriolis" in "".join(row[1] for row in table.rows)
    assert slip in "".join(row[1] for row in table.rows)
    assert "no_coriolis" not in renderer_of(course.folder).report_html(page)
    (guide,) = (p for p in told.parts if p.part == "guide")
    asked = Names(course, lang).question(guide)
    assert " " in asked
    parts, became = page.sections[2].tables
    assert parts.rows[0][0].endswith("(guide)"), "for its author"
    assert "(guide)" not in became.rows[0][0]


def test_a_chart_is_the_same_twice_and_may_have_no_rows():
    once, again = (charts.bars([("a$b$", 3, "3"), ("", 0, "")], "t", "h") for _ in range(2))
    assert once == again
    assert charts.bars([], "t", "h").startswith("<svg")


# ---------------------------------------------------------------------- command


def test_the_command_tells_a_graded_class(tmp_path, capsys, course):
    """Through build and grade, with the marks counted from marks.csv another way."""
    roster = tmp_path / "class.csv"
    roster.write_text("student\nAda\nBo\nCy\n", "utf-8")
    out, marks = tmp_path / "out", tmp_path / "marks"
    built = ["build", "slotted_mechanism", "--roster", roster, "--formats", "html", "--out", out]
    assert run([str(a) for a in built]) == 0
    rows = []
    for issued in json.loads((out / "issued.json").read_text("utf-8"))["issued"][:2]:
        variant = course["slotted_mechanism"].from_record(issued["record"])
        wrong = variant.key.wrong["no_coriolis"]
        for part, value in variant.solution().items():
            answer = wrong.get(part, value) if issued["student"] == "Bo" else value
            rows.append([issued["student"], "slotted_mechanism", variant.seed, part, answer])
    rows.append(["Nobody", "slotted_mechanism", 1, "rA", 1])
    with (tmp_path / "answers.csv").open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([["student", "exercise", "seed", "part", "answer"], *rows])
    graded = ["grade", tmp_path / "answers.csv", "--issued", out / "issued.json", "--out", marks]
    assert run([*map(str, graded), "--no-feedback"]) == 1
    capsys.readouterr()

    assert run(["report", str(marks), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert not (marks / "report").exists()
    assert (told["students"], told["handed_in_nothing"], told["rejected"]) == (3, 1, 1)
    assert told["asked_without_line"] == told["answers"] / 2
    mean = {p["part"]: p["mean"] for p in told["parts"]}
    assert mean["rA"] == 1
    assert mean["rA_ddot"] < 1 or mean["alpha4"] < 1
    assert {m["mistake"] for m in told["mistakes"]} == {"no_coriolis"}

    assert run(["report", str(marks), "--lang", "en"]) == 0
    assert "3 students" in capsys.readouterr().out
    files = {p.name: p.read_bytes() for p in (marks / "report").iterdir()}
    assert set(files) == {"report.html", "report.pdf", "parts.csv", "mistakes.csv"}
    parts = list(csv.DictReader(files["parts.csv"].decode("utf-8-sig").splitlines()))
    assert [float(p["mean"]) for p in parts] == [p["mean"] for p in told["parts"]]
    assert all(sum(float(p[f]) for f in VERDICTS) == pytest.approx(1, abs=1e-3) for p in parts)
    assert run(["report", str(marks), "--lang", "en", "--out", str(tmp_path / "again")]) == 0
    assert {p.name: p.read_bytes() for p in (tmp_path / "again").iterdir()} == files


def test_a_mistake_in_the_command_is_one_line(tmp_path, capsys):
    for arguments in (["report", str(tmp_path)], ["report", str(tmp_path), "--lang", "xx"], ["report"]):
        assert run(arguments) == 2
        said = capsys.readouterr().err
        assert said.count("\n") == 1
        assert said.startswith("coursework: ")


def test_a_report_that_cannot_be_printed_writes_nothing(folder, monkeypatch):
    place = folder([line("a", "e", "p", "correct", 1)])

    def refuse(self, report):
        raise BadStatement("no page")

    monkeypatch.setattr(Renderer, "report_pdf", refuse)
    assert run(["report", str(place)]) == 2
    assert not (place / "report").exists()


@pytest.mark.parametrize("verdict", VERDICTS)
def test_every_verdict_of_the_marking_is_counted(folder, verdict):
    told = measure(read(folder([line("a", "e", "p", verdict, 0)])))
    assert told.counts == {**dict.fromkeys(VERDICTS, 0), verdict: 1}


def test_an_answer_accepted_by_hand_is_right_in_the_report(small_course, tmp_path, capsys):
    """Graded, accepted, graded again, reported."""

    def small(*arguments):
        return run(["--course", str(small_course), *map(str, arguments)])

    (tmp_path / "class.csv").write_text("student\nAda\n", "utf-8")
    out = tmp_path / "out"
    assert small("build", "--roster", tmp_path / "class.csv", "--formats", "html", "--out", out) == 0
    answers = tmp_path / "answers.csv"
    answers.write_text("student,exercise,seed,part,answer\nAda,crank_pin,,y,somewhere\n", "utf-8")
    graded = ("grade", answers, "--issued", out / "issued.json", "--no-feedback")
    assert small(*graded) == 1
    (out / "marks" / "accepted.csv").write_text("student,exercise,part\nAda,crank_pin,y\n", "utf-8")
    assert small(*graded) == 0
    capsys.readouterr()
    assert small("report", out / "marks", "--json") == 0
    (part,) = json.loads(capsys.readouterr().out)["parts"]
    assert (part["part"], part["right"], part["accepted"], part["mean"]) == ("y", 1, 1, 1)
    assert small("report", out / "marks") == 0


@each_row("lang", ["fr", "en"])
@pytest.mark.e2e
def test_a_letter_with_an_arrow_is_drawn_in_the_labels_of_charts(course, lang):
    """Every question of the course as a chart names it has no arrow left beside its letter."""
    asked = [q for name in course.names for q in course[name].variant(0, lang).handout().questions]
    labels = [figure_text.words(plain_line(q.prompt, lang)) for q in asked]
    assert not [
        run for label in labels for run in label.runs if "\N{COMBINING RIGHT ARROW ABOVE}" in run.text
    ]
    assert sum(bool(label.accents) for label in labels) > 5
