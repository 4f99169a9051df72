"""The class that fills, a question, a student, marking again; files in and out."""

import csv
import io
import re
import zipfile

import pytest
from desk_class import EXERCISE, SEED, STUDENTS, DeskClass, told
from rows_of_strangers import FORMULA, computed_cells
from site_people import TEACHER
from sqlalchemy import select

from coursework.database.erasing import erase
from coursework.database.instructor_queries import Stamp, people_of, stamp
from coursework.database.publication import set_counting_attempt
from coursework.database.tables import class_summary
from coursework.site.desk.class_cache import class_now
from coursework.site.desk.question_cards import question_card
from coursework.system.tables import as_written


@pytest.fixture
def desk(tmp_path):
    found = DeskClass(f"sqlite:///{tmp_path}/desk.db", {})
    found.hand_in({"Ada": {"rA": found.at_margin("rA", 0.1)}, "Bo": {"rA": "777"}, "Cy": {"rA": "zz"}})
    return found


def stamp_of(desk):
    with desk.site.store.reading() as connection:
        return stamp(connection, desk.number)


def news(desk, at):
    browser = desk.browser(TEACHER)
    return browser.get(
        f"/desk/{desk.number}/news", params={"stamp": str(at), "rows": "6"}, headers={"hx-request": "true"}
    )


def rows_of(reply):
    return list(csv.DictReader(io.StringIO(reply.content.decode("utf-8-sig"))))


def send(desk, end, field, name, data, **more):
    browser = desk.browser(TEACHER)
    return browser.fill(f"/desk/{desk.number}/{end}", more, files={field: (name, data)})


# ------------------------------------------------------------------------- class


def test_a_stamp_is_read_back(desk):
    at = stamp_of(desk)
    assert Stamp.read(str(at)) == at
    assert Stamp.read("1-1.2-2") is None


def test_the_table_has_every_student_and_sorts_and_finds(desk):
    text = desk.page(TEACHER).text
    assert re.findall(r'<tr id="s(\d)"', text) == list("012345")
    assert re.findall(r'<tr id="s(\d)"', desk.page(TEACHER, find="flo").text) == ["5"]
    assert re.findall(r'<tr id="s(\d)"', desk.page(TEACHER, sort="waits").text)[0] == "2"


def test_no_news_is_no_reply_and_news_are_the_rows_that_changed(desk):
    at = stamp_of(desk)
    assert (news(desk, at).status_code, news(desk, at).text) == (204, "")
    desk.hand_in({"Di": {"rA": "12"}})
    reply = news(desk, at)
    assert "s3" in re.findall(r'<tr id="(s\d)" hx-swap-oob', reply.text)
    assert str(stamp_of(desk)) in reply.text


def test_a_question_shows_its_answers(desk):
    text = desk.page(TEACHER, "/question", exercise=EXERCISE, part="rA").text
    assert "777" in text
    assert ">Bo<" in text
    assert desk.page(TEACHER, "/question", exercise=EXERCISE, part="nothing").status_code == 404


def test_statistics_are_those_of_the_report(desk, tmp_path):
    from coursework.gradebook.book import marks_rows, summary_table
    from coursework.gradebook.columns import marks_columns
    from coursework.gradebook.statistics.marks import read
    from coursework.gradebook.statistics.measures import measure
    from coursework.site.desk.question_page import statistics_of
    from coursework.system.tables import csv_file

    now = class_now(desk.site, desk.number)
    rows = [row for one in now.graded.values() for row in marks_rows(one)]
    (tmp_path / "marks.csv").write_bytes(csv_file(rows, marks_columns(now.issued)))
    (tmp_path / "summary.csv").write_bytes(csv_file(*reversed(summary_table(now.book))))
    of_files, of_class = measure(read(tmp_path)), statistics_of(now)
    for name in ("students", "silent", "unread", "answers", "counts", "without_line", "rejected"):
        assert getattr(of_files, name) == getattr(of_class, name), name
    assert {p.part: p.mean for p in of_files.parts} == {p.part: p.mean for p in of_class.parts}


def test_a_decision_on_a_students_page_counts_and_is_taken_back(desk):
    place = {"name": "Bo", "exercise": EXERCISE, "seed": str(SEED), "sitting": "1", "part": "rA"}
    browser = desk.browser(TEACHER)
    reply = browser.fill(f"/desk/{desk.number}/student", {**place, "do": "points", "points": "0,5"})
    assert "0.5 points by Ada Teacher" in reply.text
    assert class_now(desk.site, desk.number).results["Bo"].points == 0.5
    browser.fill(f"/desk/{desk.number}/student", {**place, "do": "withdraw"})
    assert class_now(desk.site, desk.number).results["Bo"].points == 0


# ------------------------------------------------------------------------- files


def test_answers_come_in_once_and_are_marked(desk):
    data = f"student,exercise,seed,part,answer\nDi,{EXERCISE},{SEED},rA,12\nNobody,{EXERCISE},{SEED},rA,12\n"
    assert told(send(desk, "answers", "answers", "late.csv", data.encode())).startswith(
        "Answers received: 2. Sheets marked: 1."
    )
    assert told(send(desk, "answers", "answers", "late.csv", data.encode())).startswith(
        "Exactly the same was uploaded before"
    )
    now = class_now(desk.site, desk.number)
    assert [one.row.source for one in now.rejected] == ["late.csv, line 3"]
    assert "late.csv, ligne 3" in desk.page(TEACHER, "/files", lang="fr").text


def test_papers_are_typed_into_an_empty_table_of_the_class(desk):
    reply = desk.page(TEACHER, "/files/answers_wide.csv", lang="fr")
    header, *lines = reply.content.decode("utf-8-sig").splitlines()
    place = header.split(";").index(f"1.1 {EXERCISE} rA (mm)")
    assert [line.split(";")[0] for line in lines] == list(STUDENTS)
    cells = [*lines[-1].split(";")]
    cells[place] = "123,4"
    typed = "\n".join([header, *lines[:-1], ";".join(cells)]).encode()
    desk.browser(TEACHER).fill(f"/desk/{desk.number}/answers", files={"answers": ("papers.csv", typed)})
    marks = class_now(desk.site, desk.number).machine
    assert next(g for key, g in marks.items() if key[0] == STUDENTS[-1]).lines["rA"].answer == "123,4"


def test_a_zip_of_answers_is_read_and_one_that_is_a_bomb_is_refused(desk):
    data = f"student,exercise,seed,part,answer\nEd,{EXERCISE},{SEED},rA,12\n"

    def zipped(**files):
        made = io.BytesIO()
        with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, content in files.items():
                archive.writestr(name.replace("__", "/"), content)
        return made.getvalue()

    send(desk, "answers", "answers", "all.zip", zipped(**{"a__ed.csv": data}))
    assert "Ed" in class_now(desk.site, desk.number).exam.last_sitting
    bomb = send(desk, "answers", "answers", "bomb.zip", zipped(**{"a.csv": b"0" * (60 * 1024 * 1024)}))
    assert (bomb.status_code, "more than the limit" in bomb.text) == (422, True)
    outside = send(desk, "answers", "answers", "out.zip", zipped(**{"..__..__out.csv": data}))
    assert (outside.status_code, "outside" in outside.text) == (422, True)


def test_a_roster_adds_what_it_says_and_tells_strangers(desk):
    reply = send(desk, "roster", "roster", "class.csv", b"student,group\nBo,B\nStranger,B\n")
    assert "1 of 2 people on the roster" in reply.text
    assert "Stranger" in reply.text
    assert class_now(desk.site, desk.number).issued.columns["Bo"]["group"] == "B"


def test_tables_are_those_that_grade_writes(desk):
    marks = rows_of(desk.page(TEACHER, "/files/marks.csv"))
    assert {(row["student"], row["verdict"]) for row in marks} == {
        ("Ada", "correct"),
        ("Bo", "wrong"),
        ("Cy", "unreadable"),
    }
    assert len(rows_of(desk.page(TEACHER, "/files/summary.csv"))) == 6
    with zipfile.ZipFile(io.BytesIO(desk.page(TEACHER, "/files/archive.zip").content)) as archive:
        assert {"issued.json", "answers.csv", "marks.csv", "decisions.csv"} <= set(archive.namelist())
    assert desk.page(TEACHER, "/files/other.csv").status_code == 404


def test_a_platforms_gradebook_comes_back_filled(desk):
    data = (
        "First name,Last name,Email address,Assignment: Midterm 2 (Real)\nBo,B,bo@example.org,\n"
        "Ada,A,ada@example.org,\nX,Y,x@y.org,\n"
    )
    reply = send(
        desk,
        "gradebook",
        "template",
        "grades.csv",
        data.encode(),
        platform="moodle",
        item="Midterm 2",
        most="9",
    )
    assert "Marks in the column " in reply.text
    assert "data:text/csv;base64," in reply.text


def test_feedback_of_one_is_a_pdf(desk):
    reply = desk.page(TEACHER, "/feedback", student="Bo")
    assert (reply.status_code, reply.content[:5]) == (200, b"%PDF-")


# ----------------------------------------------------------------------- regrade


def test_marking_again_shows_what_changes_before_it_changes(tmp_path, desk, monkeypatch):
    from coursework.site.desk import regrading

    assert "Nothing would change" in desk.page(TEACHER, "/regrade").text
    before = class_now(desk.site, desk.number).stamp
    monkeypatch.setattr("coursework.database.marking.sheet_state", lambda *more: "another")
    assert "Sheets that would be marked again: 3." in desk.page(TEACHER, "/regrade").text
    assert class_now(desk.site, desk.number).stamp == before
    reply = desk.browser(TEACHER).fill(f"/desk/{desk.number}/regrade", {"do": "regrade"})
    assert "Sheets marked again: 3." in reply.text
    assert class_now(desk.site, desk.number).stamp != before
    assert regrading.ChangeRow._fields[0] == "student"


def test_what_was_erased_is_shown_as_nobody_elses(tmp_path):
    desk = DeskClass(f"sqlite:///{tmp_path}/desk.db", {"Ada": {"rA": "1"}})
    desk.hand_in({"Bo": {"rA": "777"}})
    before = class_now(desk.site, desk.number)
    assert ">Bo<" in desk.page(TEACHER).text
    with desk.site.store.begin() as connection:
        erase(connection, people_of(connection, desk.number)["Bo"])
        assert connection.execute(select(class_summary)).first() is None
    desk.hand_in({"Cy": {"rA": "888"}})
    now = class_now(desk.site, desk.number)
    assert str(now.stamp) != str(before.stamp)
    assert {one.student: one.lines["rA"].answer for one in now.machine.values()} == {"Ada": "1", "Cy": "888"}


def test_a_file_of_a_long_name_is_read(desk):
    data = f"student,exercise,seed,part,answer\nDi,{EXERCISE},{SEED},rA,5\n"
    send(desk, "answers", "answers", "答" * 200 + ".csv", data)
    assert "Di" in class_now(desk.site, desk.number).exam.last_sitting


def test_a_question_is_shown_as_it_was_asked_in_each_assignment(desk):
    now = class_now(desk.site, desk.number)
    one = next(iter(now.machine.values()))
    for name in ("rA", "theta4"):
        parts = [part for part in one.record["parts"] if part["id"] == name]
        alone = one._replace(record={**one.record, "parts": parts})
        assert question_card(now.course, now.issued, alone, name, "en").part.id == name


def test_a_zip_that_is_damaged_inside_is_refused(desk):
    whole = io.BytesIO()
    with zipfile.ZipFile(whole, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("a.csv", f"student,exercise,seed,part,answer\nDi,{EXERCISE},{SEED},rA,5\n" * 50)
    data = bytearray(whole.getvalue())
    data[40:60] = b"\xff" * 20
    reply = send(desk, "answers", "answers", "a.zip", bytes(data))
    assert (reply.status_code, "cannot be opened" in reply.text) == (422, True)


def test_other_rules_show_the_table_anew(desk):
    at = stamp_of(desk)
    with desk.site.store.begin() as connection:
        set_counting_attempt(connection, desk.number, "last")
    assert news(desk, at).headers["hx-redirect"] == f"/desk/{desk.number}"


def test_no_table_to_download_holds_what_a_spreadsheet_would_compute(tmp_path):
    desk = DeskClass(f"sqlite:///{tmp_path}/desk.db", {})
    desk.hand_in({"Ada": {"rA": FORMULA}, "Bo": {"rA": '="a"&"b"'}, "Cy": {"rA": "\t=A1"}})
    archive = zipfile.ZipFile(io.BytesIO(desk.page(TEACHER, "/files/archive.zip").content))
    tables = {
        name: archive.read(name).decode("utf-8-sig") for name in archive.namelist() if name.endswith(".csv")
    }
    assert len(tables) > 3
    assert {name: found for name, text in tables.items() if (found := computed_cells(text))} == {}
    assert "x;'=cmd" in tables["marks.csv"]
    assert FORMULA in {as_written(row["answer"]) for row in csv.DictReader(io.StringIO(tables["marks.csv"]))}


def test_long_lists_have_pages_and_a_search(desk, monkeypatch):
    monkeypatch.setattr("coursework.site.frame.paging._ROWS", 4)
    text = desk.page(TEACHER, sort="name", page="2").text
    assert re.findall(r'<tr id="s(\d)"', text) == list("45")
    assert "5 to 6 of 6" in text
    assert 'href="?sort=name&amp;page=1"' in text
    for address, name in ((f"/desk/assignments/{desk.number}", "Flo"), ("/desk/people", "Flo")):
        browser = desk.browser(TEACHER)
        first, found = (browser.get(address, params={"find": sought}).text for sought in ("", "FLO"))
        assert (f">{name}<" in first, f">{name}<" in found, ">Ada<" in found) == (False, True, False), address
        assert "1 to 4 of" in first


def test_a_stranger_is_compared_with_the_class_where_the_row_is_shown(desk, monkeypatch):
    data = f"student,exercise,seed,part,answer\nFlow,{EXERCISE},{SEED},rA,12\n"
    send(desk, "answers", "answers", "late.csv", data.encode())
    assert "<option selected>Flo</option>" in desk.page(TEACHER, "/files").text
    monkeypatch.setattr("coursework.database.class_state.closest", None)
    desk.hand_in({"Di": {"rA": "12"}})
    for end in ("", "/queue", "/questions"):
        assert desk.page(TEACHER, end).status_code == 200, end
    assert desk.browser(TEACHER).get("/desk").status_code == 200
