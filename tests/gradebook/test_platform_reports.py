"""What platforms export is read as it comes: every response ends as marked, rejected with its reason, or
blank."""

from __future__ import annotations

import csv
import json
from xml.etree import ElementTree

import pytest
from class_of_three import table
from collected_pools import EXERCISE, RECORDED, graded, pool
from tables import each_row

from coursework.cli import run
from coursework.errors import nearest
from coursework.gradebook.by_student import for_student
from coursework.gradebook.item_label import label_in
from coursework.gradebook.moodle_responses import columns_of, parts_of
from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected
from coursework.gradebook.submissions import find, read_file
from coursework.issuing.issued import Issued
from coursework.messages import Message, localised


def rows_of(path, data=None):
    if data is not None:
        path.write_bytes(data if isinstance(data, bytes) else data.encode("utf-8"))
    found = list(read_file(path))
    return tuple([r for r in found if isinstance(r, kind)] for kind in (AnswerRow, Rejected, PlatformFile))


# ------------------------------------------------------------------------ Moodle


def test_a_report_of_moodle_has_the_points_that_were_found_by_hand(tmp_path):
    """A 7 of Moodle's is 9 of ours, for the unit that it ignored; one error and the right method after it 8
    and not 3."""
    book = graded(tmp_path, RECORDED / "moodle_responses_en.csv")
    by_student = {row["student"]: row for row in table(tmp_path / "marks/summary.csv")}
    with (RECORDED / "moodle_responses_en.csv").open(encoding="utf-8-sig") as file:
        theirs = {
            f"{row['First name']} {row['Last name']}": float(row["Grade/9.00"])
            for row in csv.DictReader(file)
        }
    assert theirs == {"Ann Doe": 7, "Émile D’Été": 3, "Bob Ray": 1}
    assert {name: row["points"] for name, row in by_student.items()} == {
        "Ann Doe": "9",
        "Émile D’Été": "8",
        "Bob Ray": "2",
    }
    assert (book.rows_in, book.marked, book.rejected) == (27, 27, [])
    assert "Moodle's Responses report, 3 finished attempts of 3 students" in book.seen[0]
    assert by_student["Ann Doe"]["Email address"] == "ann@example.org"


@pytest.mark.parametrize("name", ["moodle_responses.csv", "moodle_responses.json", "moodle_responses_fr.csv"])
def test_a_report_is_the_same_in_every_spelling_of_it(tmp_path, name):
    graded(tmp_path / "one", RECORDED / "moodle_responses.csv")
    graded(tmp_path / "two", RECORDED / name)
    one, two = (table(tmp_path / n / "marks/marks.csv") for n in ("one", "two"))
    assert [{**row, "feedback": ""} for row in one] == [{**row, "feedback": ""} for row in two]
    assert len(one) == 44


@pytest.mark.parametrize("delimiter", [";", "\t"])
def test_a_report_that_a_spreadsheet_saved_again_is_the_same(tmp_path, delimiter):
    with (RECORDED / "moodle_responses_fr.csv").open(encoding="utf-8-sig", newline="") as file:
        cells = list(csv.reader(file))
    with (tmp_path / "again.csv").open("w", encoding="cp1252", errors="replace", newline="") as file:
        csv.writer(file, delimiter=delimiter).writerows(cells)
    theirs, _, _ = rows_of(RECORDED / "moodle_responses_fr.csv")
    ours, _, (seen,) = rows_of(tmp_path / "again.csv")
    assert [(r.seed, r.part, r.answer.replace("?", "")) for r in ours] == [
        (r.seed, r.part, r.answer.replace("?", "")) for r in theirs
    ]
    assert "Moodle's Responses report" in seen.what


def test_attempts_are_sittings_and_the_better_counts(tmp_path):
    """Ann handed in a blank one, then a right one, in French; another Ann is somebody else."""
    graded(tmp_path, RECORDED / "moodle_responses.csv")
    ann, other, bob = table(tmp_path / "marks/summary.csv")
    assert (ann["student"], ann["points"], ann["out_of"], ann["sitting"]) == ("Ann Doe", "11", "11", "2")
    assert (other["student"], other["points"]) == ("Ann Doe (wb.ann2@example.org)", "4")
    assert (bob["student"], bob["points"], bob["missing"]) == ("Bob Ray", "0", "11")
    marks = table(tmp_path / "marks/marks.csv")
    assert [row["sitting"] for row in marks if row["student"] == "Ann Doe"] == ["1"] * 11 + ["2"] * 11
    assert {row["submitted"] for row in marks} == {"22 November 2026  10:30 PM"}


def test_marking_an_attempts_report_again_changes_nothing_and_its_marks_may_stand(tmp_path, capsys):
    graded(tmp_path, RECORDED / "moodle_responses.csv")
    assert graded(tmp_path, RECORDED / "moodle_responses.csv").changes == 0
    before = table(tmp_path / "marks/summary.csv")
    status = run(
        [
            "grade",
            "--from",
            str(tmp_path / "marks/marks.csv"),
            "--issued",
            str(tmp_path / "issued.json"),
            "--no-feedback",
        ]
    )
    assert status == 1, "an answer that cannot be read waits for somebody"
    assert "changed by hand" not in capsys.readouterr().out
    assert table(tmp_path / "marks/summary.csv") == before


def test_sheets_of_feedback_are_printed_of_a_pool(tmp_path):
    graded(tmp_path, RECORDED / "moodle_responses.csv", feedback=True)
    assert len(list((tmp_path / "marks/feedback").glob("*.pdf"))) >= 3


def test_an_attempt_that_is_not_handed_in_is_told_by_its_state(tmp_path):
    book = graded(tmp_path, RECORDED / "moodle_responses_fr.csv")
    (rejected,) = book.rejected
    assert "'En cours'" in rejected.reason
    assert rejected.row["student"] == "Émile D’Été"
    assert "1 student without an attempt" in book.seen[0]


def test_answers_of_an_attempt_that_is_open_are_rejected_one_by_one(tmp_path):
    text = (
        (RECORDED / "moodle_responses_en.csv")
        .read_text("utf-8")
        .replace(
            'Finished,"22 November 2026  7:13 AM","22 November 2026  7:13 AM"',
            '"Never submitted","22 November 2026  7:13 AM",-',
            1,
        )
    )
    rows, (rejected,), _ = rows_of(tmp_path / "a.csv", text)
    assert len(rows) == 18
    assert "'Never submitted'" in rejected.reason
    assert rejected.row["answer"].startswith("part 1: 0.111535 m")
    assert (rejected.row["exercise"], rejected.row["seed"]) == (EXERCISE, "4")


def test_the_average_in_the_last_line_is_nobody(tmp_path):
    average = '"Overall average",,,,,,,3.67,,\n'
    rows, rejected, (seen,) = rows_of(
        tmp_path / "a.csv", (RECORDED / "moodle_responses_en.csv").read_text("utf-8") + average
    )
    assert (len(rows), rejected) == (27, [])
    assert "3 finished attempts of 3 students" in seen.what
    assert "without" not in seen.what


@each_row(
    ("response", "answers"),
    [
        ("part 1: 238.4 mm; part 2: ", ["238.4 mm", ""]),
        ("part 1: 1; or 2; part 2: a ; part of it; part 3:", ["1; or 2", "a ; part of it", ""]),
        ("partie 1\u00a0: 3,5; partie 2 : x = 1 ; y = 2", ["3,5", "x = 1 ; y = 2"]),
        ("Teil 1: a; Teil 2: b", ["a", "b"]),
        ("部分 1：甲; 部分 2：乙", ["甲", "乙"]),
        ("part 1: the; part 2: of mine; part 2: 4", []),  # whose the second is, nobody knows
        ("part 2: 4", []),
        ("238.4 mm", []),
    ],
)
def test_parts_are_told_apart_though_answers_hold_semicolons(response, answers):
    assert parts_of(response) == answers


def test_a_response_whose_parts_nobody_can_tell_waits_for_a_person(tmp_path):
    text = (
        (RECORDED / "moodle_responses_en.csv")
        .read_text("utf-8")
        .replace("part 2: 71.9969", "part 2: 1; part 2: 2")
    )
    rows, (rejected,), _ = rows_of(tmp_path / "a.csv", text)
    assert len(rows) == 18
    assert "waits for a person" in rejected.reason
    assert "part 2: 1; part 2: 2" in rejected.row["answer"]


def test_what_is_no_responses_report_says_what_to_download(tmp_path):
    names = "First name,Last name,Email address,Status,Started,Completed,Duration,Grade/9.00"
    for header, told in (
        (f"{names},Q. 1 /4.00,Q. 2 /5.00", "download the Responses report"),
        (f"{names},Response 1,Response 2", "tick 'question text'"),
        ("name,whatever", "the header must name student"),
    ):
        _, (rejected,), _ = rows_of(tmp_path / "a.csv", header + "\nAnn,Doe\n")
        assert told in rejected.reason
    titles = "lastname firstname emailaddress status started completed duration grade1100 response1 response2"
    _, (rejected,), _ = rows_of(tmp_path / "a.json", json.dumps([[dict.fromkeys(titles.split(), "x")]]))
    assert "tick 'question text'" in rejected.reason
    (tmp_path / "a.xlsx").write_bytes(b"PK")
    (rejected,) = find([tmp_path / "a.xlsx"])
    assert "download the table as CSV" in rejected.reason


def test_another_question_in_the_quiz_is_told_where_it_is_answered(tmp_path):
    text = (
        (RECORDED / "moodle_responses.csv")
        .read_text("utf-8")
        .replace("[slotted_mechanism · 4 · v1 · en · rA]", "")
    )
    rows, rejected, _ = rows_of(tmp_path / "a.csv", text)
    without = [r for r in rejected if "has no label" in r.reason]
    assert sorted(r.row["answer"] for r in without) == ["0,1115 m", "111.5 mm"]
    assert "rA" not in {r.part for r in rows}


def test_another_version_of_the_exercise_is_not_marked(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(
        (RECORDED / "moodle_responses_en.csv").read_text("utf-8").replace("· 4 · v1]", "· 4 · v2]"), "utf-8"
    )
    book = graded(tmp_path, path)
    assert len(book.rejected) == 9
    assert (
        "the answers belong to version 2 of slotted_mechanism, and version 1 was issued"
        in book.rejected[0].reason
    )


def test_columns_are_found_whatever_the_language_calls_them():
    header = (
        "Nachname,Vorname,E-Mail-Adresse,Status,Begonnen,Beendet,Verbrauchte Zeit,Bewertung/9,Frage "
        "1,Antwort 1,Frage 2,Antwort 2"
    )
    columns = columns_of(header.split(","))
    assert columns.questions == ((8, 9), (10, 11))
    assert (columns.state, columns.completed) == (3, 5)
    assert columns_of(["student", "exercise", "seed", "part", "answer"]) is None


@each_row(
    ("text", "label"),
    [
        ("[slotted_mechanism · 4 · v1]", (EXERCISE, "4", "1", "", "")),
        ("a [b] [slotted_mechanism\u00a0· 42 ·\tv2 · fr]  x", (EXERCISE, "42", "2", "fr", "")),
        ("[slotted_mechanism · 4 · v1 · en · rA_dot]", (EXERCISE, "4", "1", "en", "rA_dot")),
        ("[slotted_mechanism, 4]", None),
    ],
)
def test_labels(text, label):
    found = label_in(text)
    assert (found if found is None else tuple(found[:5])) == label


def test_a_bare_number_is_in_the_unit_that_the_question_printed(tmp_path):
    """Canvas is asked in smaller units, since its margins have four decimals: the label tells which."""
    text = (RECORDED / "canvas_analysis.csv").read_text("utf-8")
    text = text.replace("· 4 · v1 · en · rA]", "· 4 · v1 · en · rA · µm]").replace(
        "· theta4]", "· theta4 · 10⁻³ °]"
    )
    path = tmp_path / "a.csv"
    path.write_text(text.replace(",111.535,", ",111535,").replace(",71.9969,", ",71996.9,"), "utf-8")
    graded(tmp_path, path)
    right = [row["answer"] for row in table(tmp_path / "marks/marks.csv") if row["verdict"] == "correct"]
    assert right == ["111535 µm", "71996.9·10⁻³ °", "133.739"]
    assert label_in("[a · 1 · v1 · en · b · µm]").answer("3 mm") == "3 mm"


# ------------------------------------------------------------------------ students of a pool

CLASS = {
    "Ann Doe (wb-1)": {"ID number": "wb-1", "Email address": "WB.ann@example.org"},
    "Ann Doe (wb-2)": {"ID number": "wb-2", "Email address": "wb.ann2@example.org"},
    "Robert Ray": {"ID number": "wb-4", "Email address": "wb.bob@example.org"},
    "Émile D'Été": {},
    "Cy Wu": {"Email address": "wb.cy@example.org"},
}


def test_students_of_a_pool_are_found_by_what_identifies_them_then_by_name(tmp_path):
    graded(tmp_path, RECORDED / "moodle_responses.csv", students=CLASS)
    found = {row["student"]: row["points"] for row in table(tmp_path / "marks/summary.csv")}
    assert found == {
        "Ann Doe (wb-1)": "11",
        "Ann Doe (wb-2)": "4",
        "Robert Ray": "0",
        "Émile D'Été": "0",
        "Cy Wu": "0",
    }
    assert {row["out_of"] for row in table(tmp_path / "marks/summary.csv")} == {"11", "9"}


def test_what_identifies_a_student_goes_before_a_name_that_another_has(tmp_path):
    namesakes = {"Ann Doe": {"ID number": "wb-1"}, "Ann Doe (wb-2)": {"ID number": "wb-2"}}
    issued = Issued.read(pool(tmp_path, seeds=(4,), students=namesakes))
    assert issued.student("Ann Doe", [("ID number", "wb-2")]) == "Ann Doe (wb-2)"
    assert issued.student("Ann Doe", [("ID number", "wb-1")]) == "Ann Doe"


def test_a_stranger_to_the_roster_of_a_pool_is_rejected(tmp_path):
    few = {name: CLASS[name] for name in ("Ann Doe (wb-1)", "Robert Ray")}
    book = graded(tmp_path, RECORDED / "moodle_responses.csv", students=few)
    assert {r.row["student"] for r in book.rejected if "on the roster" in r.reason} == {"Ann Doe"}
    assert {row["student"] for row in table(tmp_path / "marks/marks.csv")} == set(few)


def test_who_may_have_any_record_of_a_pool_may_not_have_another_seed(tmp_path):
    issued = Issued.read(pool(tmp_path, seeds=(4,), students=CLASS))
    assert issued.student("D'été, Émile", ()) == "Émile D'Été"
    assert issued.student("Somebody", [("e", "wb.cy@example.org")]) == "Cy Wu"
    assert issued.student("Ann Doe", ()) is None, "there are two"
    book = graded(tmp_path, RECORDED / "moodle_responses.csv", seeds=(4,))
    assert {r.reason for r in book.rejected if "was not issued" in r.reason} == {
        f"seed 5 of {EXERCISE} was not issued"
    }


def test_a_pool_read_from_a_plain_table_needs_the_seed(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(
        f"student,exercise,seed,part,answer\nCy Wu,{EXERCISE},5,rA,133.739\nCy Wu,{EXERCISE},,theta4,1\n",
        "utf-8",
    )
    book = graded(tmp_path, path, students=CLASS)
    assert book.marked == 1
    assert "a seed is a whole number" in book.rejected[0].reason


# ------------------------------------------------------------------------ Canvas and QTI


def test_canvas_asks_part_by_part_and_each_is_out_of_all_that_it_asks(tmp_path):
    book = graded(tmp_path, RECORDED / "canvas_analysis.csv")
    ann, emile = table(tmp_path / "marks/summary.csv")
    assert (ann["points"], ann["out_of"], ann["sitting"]) == ("2", "2", "2"), (
        "rA of one variant and theta4 of another"
    )
    assert (emile["points"], emile["out_of"], emile["missing"]) == ("0", "2", "1")
    assert [r.row["answer"] for r in book.rejected] == ["x"]
    assert "Canvas's Student Analysis, 3 attempts of 2 students" in book.seen[0]
    assert {row["submitted"] for row in table(tmp_path / "marks/marks.csv")} >= {"2026-11-22 20:13:05 UTC"}


def test_the_item_analysis_of_canvas_holds_nobody(tmp_path):
    _, (rejected,), _ = rows_of(
        tmp_path / "a.csv", "Question Id,Question Title,Answered Student Count\n1,x,2\n"
    )
    assert "download the Student Analysis" in rejected.reason


def test_a_result_of_qti_is_read_by_the_identifiers_of_its_items(tmp_path):
    book = graded(tmp_path, RECORDED / "qti_result.xml", students={"Ann Doe": {"SIS User ID": "s-1"}})
    marks = {row["part"]: (row["student"], row["verdict"]) for row in table(tmp_path / "marks/marks.csv")}
    assert marks == {
        "rA": ("Ann Doe", "correct"),
        "theta4": ("Ann Doe", "correct"),
        "swing": ("Ann Doe", "missing"),
    }
    assert [r.row["answer"] for r in book.rejected] == ["7"]


@pytest.mark.parametrize("data", ["<a", "<a/>", '<!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>', "", "\0"])
def test_xml_that_is_no_result_is_one_rejected_row(tmp_path, data):
    rows, rejected, _ = rows_of(tmp_path / "a.xml", data)
    assert (rows, len(rejected)) == ([], 1)


# ------------------------------------------------------------------------ rows in = rows out


def responses_in(path) -> list[str]:
    """What students typed in a recorded export, found another way than the readers do."""
    if path.suffix == ".xml":
        tree = ElementTree.parse(path)
        given = [
            v
            for v in tree.iter()
            if v.tag.endswith("responseVariable") and v.get("identifier") != "numAttempts"
        ]
        return ["".join(v.itertext()).strip() for v in given]
    if path.suffix == ".json":
        sheets = [list(item.values()) for item in json.loads(path.read_text("utf-8"))[0]]
        cells = [cell for item in sheets if item[3] == "Finished" for cell in item[9::2]]
    else:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = list(csv.reader(file))[1:]
        own = rows if "analysis" in path.name else [r for r in rows if r[5] != "-"]
        cells = [c for r in own for c in (r[8:16:2] if "analysis" in path.name else r[9::2])]
        cells = [c for c in cells if c] if "analysis" in path.name else cells
    found = []
    for cell in cells:
        pieces = cell.split("; part")
        found += (
            [p.partition(":")[2].strip() for p in pieces if ":" in p]
            if cell.startswith("part") and ":" in cell
            else [cell]
        )
    # An answer that says "; part of it" is one answer.
    return ["" if c == "-" else c for c in found]


@pytest.mark.parametrize(
    "name",
    [
        "moodle_responses_en.csv",
        "moodle_responses.csv",
        "moodle_responses.json",
        "moodle_responses_fr.csv",
        "canvas_analysis.csv",
        "qti_result.xml",
    ],
)
def test_every_response_ends_as_marked_rejected_or_blank(tmp_path, name):
    book = graded(tmp_path, RECORDED / name)
    marks = table(tmp_path / "marks/marks.csv")
    rejected = table(tmp_path / "marks/rejected.csv")
    assert book.rows_in == len(marks) + len(rejected) + book.blanks
    assert len(rejected) == len(book.rejected)
    # An answer of nothing but a part's name is the whole of "27.4 rad/s² ; part of it" and the like.
    typed = [a for a in responses_in(RECORDED / name) if a]
    ended = " ¦ ".join(row["answer"] for row in (*marks, *rejected))
    lost = [a for a in typed if a.split(";")[0].strip() not in ended]
    assert typed
    assert not lost


def test_a_response_without_a_word_is_as_many_blank_rows_as_the_variant_asks(tmp_path):
    text = (RECORDED / "moodle_responses_en.csv").read_text("utf-8")
    begin = text.index("part 1: 0.111535 m")
    path = tmp_path / "a.csv"
    path.write_text(text[: begin - 1] + "-" + text[text.index('"', begin) + 1 :], "utf-8")
    book = graded(tmp_path, path)
    assert (book.rows_in, book.marked, book.rejected) == (27, 27, [])
    assert table(tmp_path / "marks/summary.csv")[0]["missing"] == "9"


def test_a_student_reads_why_a_row_was_rejected_without_the_names_of_other_parts():
    reason = Message(
        "{exercise} has no part {part!r}{nearest}",
        exercise="coil",
        part="Y",
        nearest=nearest("thta4", ["theta4"]),
    )
    assert "theta4" in localised(reason, "fr")
    for lang in ("en", "fr"):
        told = localised(for_student(Message("{file}: {reason}", file="a.csv", reason=reason)), lang)
        assert "theta4" not in told
        assert "Y" in told
