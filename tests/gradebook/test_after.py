"""The evening after an exam from a folder of marks: what is left, a change with its preview, confirmed and
undone."""

import json
import os
import re
import subprocess
import sys

import pytest
from small_assignment import grade, issue, item, right, table

import coursework
from coursework.cli import run
from coursework.course.answer_key import Key
from coursework.course.variant import Variant
from coursework.gradebook.after import is_non_answer

NAMES = [f"S{k:02}" for k in range(12)]


@pytest.fixture
def marked(small_course, tmp_path):
    """Twelve students, of whom the six best answer v wrongly and the others rightly; a wrong sign, and two
    answers that wait."""
    course = coursework.open_course(small_course)
    papers = issue(tmp_path, [item(course, name, 5) for name in NAMES])
    rows = []
    for k, name in enumerate(NAMES):
        wrong = {"v": 77.7} if k < 6 else {"x": 77.7 + k, "y": 99.9 + k} if k < 9 else {"x": "hm 3 or 4"}
        wrong = {"x": -course["crank_pin"].variant(5).solution()["x"]} if k == 9 else wrong
        rows += right(course, name, 5, **wrong)
    rows += [["Nobody", "crank_pin", 5, "v", "1"]]
    grade(course, papers, rows)
    (tmp_path / "week3.toml").write_text(
        'mark = { of = 20, step = 0.5 }\nout = "."\n[[exercises]]\nname = "crank_pin"\npoints = { x = 3 }\n'
    )

    def after(*options):
        asked = [
            "--course",
            course.folder.root,
            "after",
            tmp_path / "week3.toml",
            *options,
            "--by",
            "Mme Roy",
        ]
        return run(list(map(str, asked)))

    return tmp_path / "marks", after


def said_by(capsys, after, *options):
    capsys.readouterr()
    after(*options, "--json")
    return json.loads(capsys.readouterr().out)


def marks_in(folder):
    return [row["mark"] for row in table(folder / "summary.csv")]


def test_what_is_left_is_told_with_the_proposal_that_fits(marked, capsys, monkeypatch):
    _, after = marked
    state = said_by(capsys, after)
    assert (state["cards"]["unreadable"], state["rejected"]) == ([1, 2], 1)
    assert state["provisional"] == {"S10": 1, "S11": 1}
    (v,) = (one for one in state["questions"] if one["part"] == "v")
    assert (v["why"], v["proposal"]) == ("reversed", "neutral_if_hurt")
    monkeypatch.setenv("LC_ALL", "fr_FR.UTF-8")
    assert after() == 1
    text = capsys.readouterr().out
    assert "Illisibles" in text
    assert "no student 'Nobody' on the roster (lignes" in text  # as grade wrote it, then in English
    assert "les meilleurs la manquent" in text
    assert "sur 3\n" in text
    assert after("--put-away", "--neutralise", "1.3") == 0
    text += capsys.readouterr().out
    assert "rien n’est encore changé" in text
    assert not re.findall(r"\w'\w| [;:!?»](?=\s)", text.replace("student 'Nobody'", ""))


def test_a_change_is_previewed_confirmed_applied_by_grade_and_undone(marked, capsys):
    folder, after = marked
    before = marks_in(folder)
    number = next(q["number"] for q in said_by(capsys, after)["questions"] if q["part"] == "v")
    preview = said_by(capsys, after, "--neutralise", number)
    assert marks_in(folder) == before
    assert not (folder / "decisions.csv").exists()
    assert {c["student"]: c["now"] for c in preview["changes"]}["S00"] == 20
    assert after("--neutralise", number, "--why", "misprint", "--yes") == 0
    assert marks_in(folder)[:7] == ["20"] * 6 + ["0"]
    (line,) = table(folder / "decisions.csv")
    assert (line["kind"], line["reason"], line["by"], len(line["date"])) == (
        "neutral",
        "misprint",
        "Mme Roy",
        10,
    )
    assert {r["mark_now"] for r in table(folder / "changes.csv") if r["student"] == "S00"} == {"20"}
    assert after("--undo", "--yes") == 0
    assert marks_in(folder) == before
    assert [row["kind"] for row in table(folder / "decisions.csv")] == ["neutral", "withdrawn"]
    assert after("--weight", f"{number}=9", "--bonus", number, "--full", "2", "--yes") == 0
    assert marks_in(folder) != before
    assert after("--undo-since", "9999-01-01") == after("--undo-since", "yesterday") == 2
    capsys.readouterr()
    assert after("--undo-since", "all") == 0
    assert re.findall(r"To undo: .*: (2 points|.*bonus|.*of 9)", capsys.readouterr().out)[0] == "2 points"
    assert after("--undo-since", "2000-01-01", "--yes") == 0
    assert "3 decisions taken back" in capsys.readouterr().out
    assert marks_in(folder) == before


def test_what_is_confirmed_is_kept_if_nobody_reads_the_preview_and_json_is_json_alone(marked, capsys):
    folder, after = marked
    confirmed = ("--neutralise", "1.3", "--yes", "--by", "Mme Roy")
    asked = [sys.executable, "-m", "coursework", "--course", folder.parent / "small", "after"]
    reader, writer = os.pipe()
    os.close(reader)
    with os.fdopen(writer, "w") as closed:
        subprocess.run([*asked, folder.parent / "week3.toml", *confirmed], stdout=closed, check=False)
    assert [row["kind"] for row in table(folder / "decisions.csv")] == ["neutral"]
    (folder / "feedback").mkdir()
    assert said_by(capsys, after, "--undo", "--yes")["changes"]
    assert [row["kind"] for row in table(folder / "decisions.csv")] == ["neutral", "withdrawn"]
    assert after("--put-away", "--yes") == 0
    for nothing in (["--put-away"], ["--refuse", "1.3"]):
        assert said_by(capsys, after, *nothing)["changes"] == []


def test_students_who_answered_nothing_are_named_until_their_presence_is_stated(marked, small_course, capsys):
    folder, after = marked
    course = coursework.open_course(small_course)
    papers = issue(folder.parent, [item(course, name, 5) for name in ("Ada", "Bo", "Cy")])
    blank = [[*row[:-1], ""] for name in ("Bo", "Cy") for row in right(course, name, 5)]
    for stated, named in ((None, ["Bo", "Cy"]), ("absent", ["Cy"]), ("present", ["Cy"])):
        if stated:
            (folder.parent / "attendance.csv").write_text(f"student,present\nBo,{stated}\n")
        grade(course, papers, right(course, "Ada", 5) + blank)
        assert [name for name, _ in said_by(capsys, after)["patterns"]["blank"]] == named
        after()
        (line,) = (line for line in capsys.readouterr().out.splitlines() if "Blank sheets" in line)
        assert line.endswith(": " + ", ".join(named))


def test_a_gradebook_of_points_is_told_that_the_total_was_scaled(marked, capsys):
    """A curve and points that are worth the best mark change marks alone; weights change points, too."""
    folder, after = marked

    def is_told(score):
        capsys.readouterr()
        asked = ["gradebook", "moodle", str(folder), *f"--item w3 --score {score} --out-of 20".split()]
        run([*asked, "--out", str(folder.parent / "gradebook.xml")])
        return "--score mark writes them" in capsys.readouterr().err

    assert after("--weight", "1.1=9", "--yes") == 0
    assert not is_told("points")
    for scale in (("--full", "2"), ("--curve", "0:0 1:9 2:20")):
        assert after(*scale, "--yes") == 0
        assert [is_told(score) for score in ("points", "percent", "mark")] == [True, True, False]
        assert after("--undo", "--yes") == 0
    assert not is_told("points")


def test_weights_changed_in_the_file_and_an_accepted_answer_count_when_confirmed(marked, capsys):
    folder, after = marked
    assert after("--restated", "--accept", "1.1=hm 3 or 4", "--yes") == 0
    assert {row["out_of"] for row in table(folder / "summary.csv")} == {"6"}
    assert "provisional" not in table(folder / "summary.csv")[0]
    capsys.readouterr()
    after()
    assert "--restated" not in capsys.readouterr().out


def test_a_non_answer_says_no_number_and_refers_nowhere():
    said = {"hm": True, "no time": True, "…": True, "3 or 4": False, "see sheet": False, "π": False}
    assert {text: is_non_answer(text, is_number=True) for text in said} == said
    assert not is_non_answer("crank", is_number=False)


def test_all_that_waits_in_a_question_is_refused_at_one_stroke(marked, capsys):
    folder, after = marked
    assert after("--refuse", "1.1", "--yes") == 0
    assert "provisional" not in table(folder / "summary.csv")[0]
    assert {row["points"] for row in table(folder / "decisions.csv")} == {"0"}
    capsys.readouterr()
    assert after("--refuse", "1.1", "--yes") == 0
    assert "no answer waits" in capsys.readouterr().out


def test_a_change_in_the_middle_is_taken_back_by_its_id(marked, capsys):
    folder, after = marked
    before = marks_in(folder)
    assert after("--weight", "1.1=9", "--full", "2", "--yes") == 0
    weight, full = (row["id"] for row in table(folder / "decisions.csv"))
    capsys.readouterr()
    assert after("--undo", weight, "--why", "no") == 0
    told = capsys.readouterr().out
    assert f"To undo: {weight}" in told
    assert "Undone" not in told
    assert after("--undo", weight, "--yes") == 0
    assert [(r["kind"], r["withdraws"]) for r in table(folder / "decisions.csv")][2:] == [
        ("withdrawn", weight)
    ]
    assert after("--undo", weight) == after("--undo", "0zz") == 2
    assert re.findall("taken back already|those that stand are .*", capsys.readouterr().err) == [
        "taken back already",
        f"those that stand are {full}",
    ]
    assert after("--undo", f"{full}", "--yes") == 0
    assert marks_in(folder) == before


def test_decisions_written_without_ids_are_taken_back_too_and_those_of_an_earlier_file(marked, capsys):
    folder, after = marked
    before = marks_in(folder)
    (folder / "accepted.csv").write_text("student,exercise,part,answer\n,crank_pin,x,hm 3 or 4\n", "utf-8")
    lines = ["kind,points,exercise,part,answer,by", "full,2,,,,Mme Roy", "weight,9,crank_pin,x,,Mme Roy"]
    (folder / "decisions.csv").write_text("\n".join(lines) + "\n", "utf-8")
    capsys.readouterr()
    after()
    steps = re.findall(r"^  ([a-z]{6})  .*(accepted|best|out of 9)", capsys.readouterr().out, re.MULTILINE)
    accepted, full, weight = (name for name, _ in steps)
    assert after("--undo", f"{accepted},{full}", "--yes") == 0
    assert [row["id"] for row in table(folder / "decisions.csv")][:2] == [full, weight]
    assert {row["provisional"] for row in table(folder / "summary.csv")} == {"", "1"}
    assert after("--undo", "--yes") == 0
    assert marks_in(folder) == before


def test_what_was_refused_and_taken_back_is_decided_anew(marked, capsys):
    folder, after = marked
    path = folder / "decisions.csv"
    assert after("--refuse", "1.1", "--yes") == after("--undo", "--yes") == 0
    assert {row["provisional"] for row in table(folder / "summary.csv")} == {"", "1"}
    path.write_text(path.read_text("utf-8") + "S10,crank_pin,5,x,,accepted,,,,,,,\n", "utf-8")
    capsys.readouterr()
    assert said_by(capsys, after)["provisional"] == {"S11": 1}


def test_prices_changed_in_the_file_count_when_confirmed_as_if_the_papers_had_stated_them(marked, capsys):
    folder, after = marked
    plain, before = folder.parent / "issued.json", (folder / "marks.csv").read_text("utf-8")
    content = json.loads(plain.read_text("utf-8"))
    file = folder.parent / "week3.toml"
    rules = "[marking]\ndigits = 5\nfollow_through = 0.4\n[marking.prices]\nsign = 0.75\nmistake = 0.25\n"
    file.write_text(file.read_text("utf-8").replace("points = { x = 3 }", "") + rules, "utf-8")
    capsys.readouterr()
    assert after() == 1
    assert "digits = 5 in [marking], and the papers 4" in capsys.readouterr().out
    assert after("--restated", "--yes") == 0
    (batch,) = {row["id"] for row in table(folder / "decisions.csv")}
    prices = {row["answer"]: row["points"] for row in table(folder / "decisions.csv")}
    assert (prices["slip:sign"], prices["follow_through"]) == ("0.75", "0.4")
    capsys.readouterr()
    after()
    assert "--restated" not in capsys.readouterr().out
    decided = (folder / "marks.csv").read_text("utf-8")
    assert decided != before
    content["assignment"]["marking"] = {"follow_through": 0.4, "prices": {"sign": 0.75, "mistake": 0.25}}
    plain.write_text(json.dumps(content), "utf-8")
    assert after("--undo", batch, "--yes") == 0
    assert table(folder / "decisions.csv")[-1]["withdraws"] == batch
    assert (folder / "marks.csv").read_text("utf-8") == decided


def test_digits_and_the_other_case_count_as_if_the_papers_had_stated_them(tmp_path, capsys):
    """One student took the other assembly, another rounded a velocity beyond the margin of four digits."""
    course = coursework.open_course()
    exercise = course["four_bar_motion"]
    variant = exercise.variant(3)
    own = {i: v for i, v in variant.solution().items() if i in variant.part_ids}
    mode = "crossed" if variant.given["mode"] == "open" else "open"
    other = Variant(exercise, 3, {**variant.given, "mode": mode}, "en").solution()
    key, part = Key(variant), next(p for p in variant.parts if p.id == "omega4")
    off = key.reference["omega4"] + 1.5 * key.half_width(part)
    written = {"Ada": {i: other[i] for i in own}, "Bo": own | {"omega4": off}, "Cy": own}
    papers = issue(
        tmp_path, [{"student": n, "record": variant.record} for n in written], exercises=["four_bar_motion"]
    )
    rows = [
        [n, "four_bar_motion", 3, i, f"{v:.12g}"]
        for n, answers in written.items()
        for i, v in answers.items()
    ]
    file, rules = tmp_path / "week3.toml", {"digits": 3, "other_case": 0.5}
    file.write_text(
        'out = "."\n[[exercises]]\nname = "four_bar_motion"\n[marking]\ndigits = 3\nother_case = 0.5\n',
        "utf-8",
    )

    def points():
        return [row["points"] for row in table(tmp_path / "marks" / "marks.csv")]

    grade(course, papers, rows)
    before = points()
    assert run(["after", str(file), "--restated", "--yes"]) == 0
    (batch,) = {row["id"] for row in table(tmp_path / "marks" / "decisions.csv")}
    capsys.readouterr()
    run(["after", str(file)])
    assert f"{batch}  " in capsys.readouterr().out
    applied = points()
    assert run(["after", str(file), "--undo", batch, "--yes"]) == 0
    assert points() == before
    plain = tmp_path / "issued.json"
    content = json.loads(plain.read_text("utf-8"))
    content["assignment"]["marking"] = rules
    plain.write_text(json.dumps(content), "utf-8")
    grade(course, papers, rows)
    assert points() == applied
    changed = [k for k, pair in enumerate(zip(before, applied, strict=True)) if pair[0] != pair[1]]
    assert {rows[k][0] for k in changed} == {"Ada", "Bo"}


def test_who_puts_answers_away_is_written_and_told(marked, capsys):
    folder, after = marked
    path = folder.parent / "answers.csv"
    path.write_text(path.read_text("utf-8").replace("hm 3 or 4", "hm hm"), "utf-8")
    papers = str(folder.parent / "issued.json")
    run(["--course", str(folder.parent / "small"), "grade", str(path), "--issued", papers, "--no-feedback"])
    assert after("--put-away", "--yes") == 0
    lines = table(folder / "decisions.csv")
    assert [(line["student"], line["by"], len(line["date"])) for line in lines] == [
        (name, "Mme Roy", 10) for name in ("S10", "S11")
    ]
    capsys.readouterr()
    after()
    (batch,) = {line["id"] for line in lines}
    assert re.search(rf"{batch}  \d+-\d+-\d+, Mme Roy: .*put away: 2", capsys.readouterr().out)
    assert after("--weight", "1.1=9", "--yes") == 0  # the next writing keeps who it was
    assert table(folder / "decisions.csv")[0]["by"] == "Mme Roy"
    assert after("--undo", batch, "--yes") == 0
    assert "provisional" in table(folder / "summary.csv")[0]


def test_questions_are_called_by_number_exercise_or_kind(marked, capsys):
    folder, after = marked
    assert after("--price", "1.1/slip:sign=0.75", "--price", "crank_pin/slip=1", "--yes") == 0
    lines = [(line["part"], line["answer"]) for line in table(folder / "decisions.csv")]
    assert lines == [("x", "slip:sign"), *((part, "slip") for part in "xyv")]
    assert "2 decisions kept" in capsys.readouterr().out
    for place, parts in {
        "1.2": "y",
        "crank_pin/v": "v",
        "1": "xyv",
        "crank_pin": "xyv",
        "Numbers": "xyv",
    }.items():
        assert after("--weight", f"{place}=9", "--yes") == 0
        lines = [line for line in table(folder / "decisions.csv") if line["kind"] == "weight"][-len(parts) :]
        assert ("".join(line["part"] for line in lines), len({line["id"] for line in lines})) == (parts, 1)
        assert after("--undo", "--yes") == 0
        assert {row["out_of"] for row in table(folder / "summary.csv")} == {"4"}
    capsys.readouterr()
    assert after("--weight", "angel=9") == 2
    assert "the papers have 1.1 to 1.3, and the kinds numbers" in capsys.readouterr().err
    for misspelt, near in (
        ("1.1/slip:sgin", "slip:sign"),
        ("follow_through:other", "follow_through:other_case"),
    ):
        assert after("--price", f"{misspelt}=0.5", "--yes") == 2
        assert f"did you mean '{near}'" in capsys.readouterr().err
