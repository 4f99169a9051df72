"""Publishing: what is handed out, the late ones, extensions, what a student sees of it; and that nobody else
may."""

import base64
import io
import json
import re
import tomllib
import zipfile
from dataclasses import replace
from datetime import UTC, date, datetime, timedelta

import pytest
from site_assignments import CLOSES, FORM, OPENS, USUAL, dealt, dealt_by, handed_in, handed_out
from site_people import MAX, TEACHER, ZOE
from tables import each_row

from coursework.authoring.new_assignment import toml_of
from coursework.database.assignments import issued_content, names
from coursework.database.audit import noted
from coursework.database.publication import ACCEPT, CHARGE, Publication, extensions, published
from coursework.errors import unknown
from coursework.issuing.assignment import read_assignment
from coursework.issuing.issued import Issued
from coursework.site.frame import jobs
from coursework.site.publication import assigning
from coursework.site.publication.publishing import holders

TOML = b"""
title = { fr = "Devoir", en = "Midterm" }
logo = "../../../../etc/passwd.svg"
roster = "/etc/passwd"
out = "/tmp/somewhere"
date = 2026-12-04

[[exercises]]
name = "slotted_mechanism"
parts = ["rA", "theta4"]

[[exercises]]
name = "grashof"
points = 6
"""
ROSTER = "student,group\nZoé,1\nMax,2\n".encode()

CELL = re.compile(r"<(t[hd])\b[^>]*>(.*?)</\1>", re.DOTALL)


@pytest.fixture
def number(class_of_three):
    return dealt(class_of_three, None)


@pytest.fixture
def staff(class_of_three):
    return class_of_three.browser(TEACHER)


def content(one, number):
    with one.site.store.reading() as connection:
        return issued_content(connection, number)


def names_of(one):
    with one.site.store.reading() as connection:
        return names(connection)


# ------------------------------------------------------------------------- dealing


def test_a_file_and_a_roster_are_dealt_and_published(class_of_three, staff):
    number = dealt_by(class_of_three, staff, handed_out(class_of_three, staff, file=TOML, roster=ROSTER))
    zoe = class_of_three.browser(ZOE)
    assert zoe.get(f"/assignments/{number}").status_code == 404
    assert staff.fill(f"/desk/assignments/{number}/publish", FORM).status_code == 303
    page = zoe.get(f"/assignments/{number}")
    assert (page.status_code, "Midterm" in page.text, "4 December 2026" in page.text) == (200, True, True)
    assert handed_in(zoe, number, {"e1-rA": "1"}).status_code == 303
    assert content(class_of_three, number)["assignment"]["sittings"] == "last"


def test_what_an_uploaded_file_names_is_never_looked_for(class_of_three, staff, monkeypatch):
    from coursework.issuing.assignment import _AssignmentReader

    def looked(self, value):
        raise AssertionError(value)

    monkeypatch.setattr(_AssignmentReader, "_logo", looked)
    number = dealt_by(class_of_three, staff, handed_out(class_of_three, staff, file=TOML, roster=ROSTER))
    for path in ("", "/preview"):
        assert staff.get(f"/desk/assignments/{number}{path}").status_code == 200


@pytest.mark.parametrize("name", ["../../etc/week.toml", "..\\..\\week.toml", "/week.toml"])
def test_a_name_is_no_path(class_of_three, staff, name):
    files = {"file": (name, TOML), "roster": ("r.csv", ROSTER)}
    dealt_by(class_of_three, staff, staff.fill("/desk/assignments/new", {}, files=files))
    assert list(names_of(class_of_three)) == ["week"]


def test_exercises_are_chosen_and_dealt_to_who_has_an_account(class_of_three, staff):
    data = {
        "title": "Week 5",
        "exercise": ["slotted_mechanism", "grashof"],
        "accounts": "1",
        "mark_of": "20",
        "versions": "each",
    }
    number = dealt_by(class_of_three, staff, staff.fill("/desk/assignments/new", data))
    staff.fill(f"/desk/assignments/{number}/publish", FORM)
    for name in (ZOE, MAX):
        assert class_of_three.browser(name).get(f"/assignments/{number}").status_code == 200
    seeds = Issued(content(class_of_three, number), "test")
    assert seeds.issued_to(ZOE) != seeds.issued_to(MAX)


@pytest.mark.parametrize("versions", [b"", b"versions = 2\n"], ids=["each their own", "two versions"])
def test_the_list_of_papers_has_a_column_for_versions_where_there_are_any(class_of_three, staff, versions):
    reply = handed_out(class_of_three, staff, file=versions + TOML, roster=ROSTER)
    number = dealt_by(class_of_three, staff, reply)
    issued = content(class_of_three, number)["issued"]
    letters = {one["student"]: one["version"] for one in issued if "version" in one}
    assert bool(letters) == bool(versions)
    page = staff.get(f"/desk/assignments/{number}").text
    (table,) = (one for one in re.findall(r"<table>(.*?)</table>", page, re.DOTALL) if 'name="who"' in one)
    head, *rows = (
        [text for _, text in CELL.findall(row)] for row in re.findall(r"<tr>.*?</tr>", table, re.DOTALL)
    )
    assert ("Version" in head) == bool(versions)
    assert [len(row) for row in rows] == [len(head)] * 2
    if versions:
        assert {row[1]: row[head.index("Version")] for row in rows} == letters


def test_what_a_build_issued_is_taken_in_as_it_is(class_of_three, staff):
    number = dealt(class_of_three, None)
    issued = content(class_of_three, number)
    issued["assignment"]["name"] = "elsewhere"
    reply = handed_out(class_of_three, staff, issued=json.dumps(issued).encode())
    taken = int(reply.headers["location"].rpartition("/")[2])
    assert content(class_of_three, taken)["issued"] == issued["issued"]
    assert staff.get(f"/desk/assignments/{taken}/preview").status_code == 200


@each_row(
    ("data", "files", "told"),
    [
        ({}, {}, "a title and a name"),
        ({"title": "x"}, {}, "Choose an exercise"),
        ({"title": "x", "exercise": "grashof"}, {}, "For whom?"),
        ({"title": "x", "exercise": "no_such"}, {}, "Choose an exercise"),
        ({}, {"file": ("x.toml", b"titel = 1")}, "no key"),
        ({}, {"file": ("x.toml", b"\xff")}, "not UTF-8"),
        ({}, {"file": ("x.toml", b"a = ")}, "x.toml"),
        ({"title": "x", "exercise": "grashof"}, {"roster": ("r.csv", b"a,b\n1,2\n")}, "roster.csv"),
        ({}, {"issued": ("issued.json", b"{}")}, "not a list of issued records"),
        ({"title": "x", "exercise": "grashof", "versions": "-1", "accounts": "1"}, {}, "versions"),
    ],
)
def test_what_makes_no_sense_is_told_and_nothing_is_dealt(class_of_three, staff, data, files, told):
    reply = staff.fill("/desk/assignments/new", data, files=files or None)
    assert (reply.status_code, told in reply.text) == (422, True)
    assert not names_of(class_of_three)
    assert "/tmp" not in reply.text


def test_a_name_is_given_once(class_of_three, staff):
    dealt_by(class_of_three, staff, handed_out(class_of_three, staff, file=TOML, roster=ROSTER))
    reply = handed_out(class_of_three, staff, file=TOML, roster=ROSTER)
    assert (reply.status_code, "already" in reply.text) == (422, True)


@pytest.mark.e2e
def test_a_large_class_is_dealt_by_another_process_the_same_way(class_of_three, staff, monkeypatch):
    roster = b"student\n" + b"".join(b"S%d\n" % k for k in range(24))
    monkeypatch.setattr(jobs, "_PATIENCE", 0.0)
    reply = handed_out(class_of_three, staff, file=TOML, roster=roster)
    assert "This page refreshes itself" in staff.get(reply.headers["location"]).text
    number = dealt_by(class_of_three, staff, reply)
    apart = content(class_of_three, number)["issued"]
    monkeypatch.setattr(assigning, "_ALONE", 1000)
    other = dealt_by(
        class_of_three,
        staff,
        staff.fill(
            "/desk/assignments/new", {}, files={"file": ("week6.toml", TOML), "roster": ("r.csv", roster)}
        ),
    )
    assert len(apart) == len(content(class_of_three, other)["issued"]) == 48
    assert (
        assigning.assigning_job(class_of_three.site, reply.headers["location"].rpartition("/")[2]).state
        == "done"
    )


def test_a_dealing_that_fails_is_told_and_issues_nothing(class_of_three, staff, monkeypatch):
    def failing(*told):
        raise RuntimeError("no memory")

    monkeypatch.setattr(assigning, "_assigned", failing)
    reply = handed_out(class_of_three, staff, file=TOML, roster=ROSTER)
    page = staff.get(reply.headers["location"])
    assert "Nothing was issued" in page.text
    assert not names_of(class_of_three)


def test_a_job_reports_its_fault_in_the_language_of_who_began_it(class_of_three, staff, monkeypatch):
    def failing(*_):
        raise unknown("exercise", "cranck", ["crank"])

    monkeypatch.setattr(assigning, "_assigned", failing)
    staff.cookies.set("coursework-lang", "fr")
    reply = handed_out(class_of_three, staff, file=TOML, roster=ROSTER)
    assert "aucun exercice" in staff.get(reply.headers["location"]).text


def test_a_dealing_that_was_interrupted_is_told(class_of_three, staff):
    jobs.store(class_of_three.site, "dealing abc", jobs.Job(jobs.RUNNING, "x", 3))
    class_of_three.at += timedelta(hours=2)
    assert "interrupted" in staff.get("/desk/assignments/dealing/abc").text


# ------------------------------------------------------------------------ late ones


def test_the_late_ones_are_added_and_everybody_keeps_theirs(class_of_three, staff):
    number = dealt_by(
        class_of_three, staff, handed_out(class_of_three, staff, file=TOML, roster="student\nZoé\n".encode())
    )
    before = content(class_of_three, number)["issued"]
    files = {"roster": ("r.csv", ROSTER)}
    staff.fill(f"/desk/assignments/{number}/publish", FORM)
    dealt_by(class_of_three, staff, staff.fill(f"/desk/assignments/{number}/roster", {}, files=files))
    after = content(class_of_three, number)["issued"]
    assert [one for one in after if one["student"] == ZOE] == before
    assert {one["student"] for one in after} == {ZOE, MAX}
    assert class_of_three.browser(MAX).get(f"/assignments/{number}").status_code == 200
    assert content(class_of_three, number)["assignment"]["sittings"] == "last"


def test_a_make_up_is_handed_in_though_no_try_of_the_first_paper_is_left(class_of_three, staff):
    number = dealt(class_of_three, replace(USUAL, tries=1))
    zoe = class_of_three.browser(ZOE)
    handed_in(zoe, number, {"e1-rA": "1"})
    assert 'name="e1-rA"' not in zoe.get(f"/assignments/{number}").text
    one_try = replace(USUAL, tries=1)
    dealt(class_of_three, one_try, before=content(class_of_three, number), make_up=[ZOE])
    assert 'name="e1-rA"' in zoe.get(f"/assignments/{number}").text
    reply = zoe.fill(f"/assignments/{number}/hand-in", {"e1-rA": "2", "_number": "2"})
    assert reply.status_code == 303, reply.text
    assert zoe.fill(f"/assignments/{number}/hand-in", {"e1-rA": "3", "_number": "3"}).status_code == 409


def test_a_make_up_is_another_variant_and_the_one_that_is_shown(class_of_three, staff):
    number = dealt_by(class_of_three, staff, handed_out(class_of_three, staff, file=TOML, roster=ROSTER))
    staff.fill(f"/desk/assignments/{number}/publish", FORM)
    first = Issued(content(class_of_three, number), "test").issued_to(ZOE)
    dealt_by(class_of_three, staff, staff.fill(f"/desk/assignments/{number}/make-up", {"student": ZOE}))
    second = Issued(content(class_of_three, number), "test").issued_to(ZOE)
    page = class_of_three.browser(ZOE).get(f"/assignments/{number}").text
    assert all(str(seed) in page for seed in second.values())
    assert not [seed for seed in first.values() if str(seed) in page]
    assert handed_in(class_of_three.browser(ZOE), number, {"e1-rA": "1"}).status_code == 303


def test_nobody_is_added_to_what_came_without_its_file(class_of_three, staff):
    number = dealt(class_of_three)
    reply = staff.fill(f"/desk/assignments/{number}/roster", {}, files={"roster": ("r.csv", ROSTER)})
    assert (reply.status_code, "issued elsewhere" in reply.text) == (422, True)


# ----------------------------------------------------------------------- publication


def test_what_the_form_says_is_what_is_published(class_of_three, staff):
    number = dealt(class_of_three, None)
    staff.fill(f"/desk/assignments/{number}/publish", FORM)
    with class_of_three.site.store.reading() as connection:
        found = published(connection, number)
    assert (found.tries, found.late, found.late_percent, found.feedback) == (2, CHARGE, 12.5, "closed")
    assert found.closes == datetime(2026, 11, 23, 12).astimezone(UTC)
    page = staff.get(f"/desk/assignments/{number}").text
    assert 'value="2026-11-23T12:00"' in page


@each_row(
    ("change", "told"),
    [
        ({"closes": "2026-11-23T07:00"}, "closes before it opens"),
        ({"closes": "tomorrow"}, "not a date and time"),
        ({"closes": "0001-01-01T00:00"}, "not a date and time"),
        ({"closes": ""}, "never closes"),
        ({"tries": "0"}, "from 1 on"),
        ({"tries": "x"}, "not a number"),
        ({"late_percent": "0"}, "above 0"),
        ({"late_percent": "101"}, "above 0"),
        ({"late_percent": "nan"}, "above 0"),
        ({"late_until": "2026-11-23T11:00"}, "before the assignment closes"),
        ({"late_until": ""}, "state a date"),
        ({"feedback": "date"}, "the date is missing"),
        ({"feedback": "sometimes"}, "not one of the choices"),
        ({"sittings": "sometimes"}, "not one of the choices"),
        ({"answers": "last_try", "tries": ""}, "no last attempt"),
    ],
)
def test_a_publication_that_makes_no_sense_is_refused_and_says_why(
    class_of_three, staff, number, change, told
):
    reply = staff.fill(f"/desk/assignments/{number}/publish", {**FORM, **change})
    assert (reply.status_code, told in reply.text) == (422, True)
    with class_of_three.site.store.reading() as connection:
        assert published(connection, number) is None


def test_unpublished_nobody_sees_it_and_nothing_is_lost(class_of_three, staff):
    number = dealt(class_of_three)
    browser = class_of_three.browser(ZOE)
    reply = handed_in(browser, number, {"e1-rA": "1"})
    staff.fill(f"/desk/assignments/{number}/unpublish")
    assert browser.get(reply.headers["location"]).status_code == 404
    staff.fill(f"/desk/assignments/{number}/publish", FORM)
    assert browser.get(reply.headers["location"]).status_code == 200


def test_an_extension_is_for_one_person_with_a_reason(class_of_three, staff):
    number = dealt(class_of_three)
    given = {"person": str(class_of_three.ids[ZOE]), "closes": "2026-11-24T12:00", "tries": "5"}
    assert staff.fill(f"/desk/assignments/{number}/extend", given).status_code == 422
    assert (
        staff.fill(
            f"/desk/assignments/{number}/extend", {**given, "reason": "ill", "person": "999"}
        ).status_code
        == 422
    )
    assert staff.fill(f"/desk/assignments/{number}/extend", {**given, "reason": "ill"}).status_code == 303
    with class_of_three.site.store.reading() as connection:
        (more,) = extensions(connection, number).values()
    assert (more.tries, more.reason, more.by) == (5, "ill", TEACHER)
    class_of_three.at = CLOSES + timedelta(hours=1)
    assert class_of_three.browser(ZOE).fill(f"/assignments/{number}", {"e1-rA": "1"}).status_code == 200
    assert class_of_three.browser(MAX).fill(f"/assignments/{number}", {"e1-rA": "1"}).status_code == 409


def test_all_that_is_done_is_noted_without_an_answer(class_of_three, staff):
    number = dealt_by(class_of_three, staff, handed_out(class_of_three, staff, file=TOML, roster=ROSTER))
    person = str(class_of_three.ids[ZOE])
    staff.fill(f"/desk/assignments/{number}/publish", FORM)
    staff.fill(f"/desk/assignments/{number}/extend", {"person": person, "tries": "9", "reason": "ill"})
    handed_in(class_of_three.browser(ZOE), number, {"e1-rA": "4711"})
    staff.get(f"/desk/assignments/{number}/as/{person}")
    staff.fill(f"/desk/assignments/{number}/unpublish")
    with class_of_three.site.store.reading() as connection:
        rows = noted(connection)
    done = [
        "assignment dealt",
        "assignment published",
        "extension",
        "seen as a student",
        "assignment unpublished",
    ]
    assert [row.what for row in reversed(rows)] == done
    assert {row.by for row in rows} == {TEACHER}
    assert not [row for row in rows if "4711" in json.dumps(row.about) or "ill" in json.dumps(row.about)]


# --------------------------------------------------------------- as a student sees it


def test_a_preview_is_of_a_variant_that_is_nobodys(class_of_three, staff):
    number = dealt_by(class_of_three, staff, handed_out(class_of_three, staff, file=TOML, roster=ROSTER))
    page = staff.get(f"/desk/assignments/{number}/preview").text
    issued = content(class_of_three, number)["issued"]
    assert not [one for one in issued if str(one["record"]["seed"]) in page]
    assert "data-keep" not in page
    assert content(class_of_three, number)["issued"] == issued


def test_a_students_paper_is_seen_and_what_they_typed_is_not(class_of_three, staff):
    number = dealt(class_of_three)
    class_of_three.browser(ZOE).fill(f"/assignments/{number}/keep", {"text.e1-rA": "4711", "over.e1-rA": "0"})
    page = staff.get(f"/desk/assignments/{number}/as/{class_of_three.ids[ZOE]}").text
    seeds = class_of_three.issued.issued_to(ZOE).values()
    assert all(str(seed) in page for seed in seeds)
    assert "4711" not in page
    assert "data-keep" not in page


def test_none_of_it_is_for_students(class_of_three):
    number = dealt(class_of_three)
    for name in (ZOE, None):
        browser = class_of_three.browser(name)
        for path in (
            "",
            "/new",
            f"/{number}",
            f"/{number}/preview",
            f"/{number}/as/1",
            f"/{number}/issued.json",
            f"/{number}/sheets",
            "/dealing/abc",
        ):
            assert browser.get(f"/desk/assignments{path}").status_code in (303, 403)
        for path in (
            "/new",
            f"/{number}/publish",
            f"/{number}/unpublish",
            f"/{number}/extend",
            f"/{number}/roster",
            f"/{number}/make-up",
        ):
            assert browser.fill(f"/desk/assignments{path}", FORM).status_code in (303, 401, 403)
    with class_of_three.site.store.reading() as connection:
        assert published(connection, number) == USUAL


# ------------------------------------------------------------------------- pure


def test_a_publication_is_kept_and_read_back_whole():
    told = Publication(
        OPENS,
        CLOSES,
        None,
        CHARGE,
        CLOSES + timedelta(days=1),
        7.5,
        "date",
        CLOSES,
        "date",
        CLOSES,
        True,
        OPENS,
    )
    assert Publication.of(json.loads(json.dumps(told.as_json()))) == told
    assert Publication.of({}) == Publication()
    assert Publication.of({"of a later version": 1}) == Publication()


@each_row(
    ("late", "share"), [(0, 0), (1, 0.1), (86400, 0.1), (86401, 0.2), (9 * 86400, 0.9), (99 * 86400, 1.0)]
)
def test_a_day_that_has_begun_counts_and_nobody_owes_more_than_all(late, share):
    rule = replace(USUAL, late=CHARGE, late_percent=10.0)
    assert rule.charged(late) == pytest.approx(share)
    assert replace(rule, late=ACCEPT).charged(late) == 0


def test_sheets_are_printed_a_file_a_language_for_those_ticked_or_all(class_of_three, staff):
    roster = "student,lang\nZoé,fr\nMax,en\nAda,\n".encode()
    number = dealt_by(class_of_three, staff, handed_out(class_of_three, staff, file=TOML, roster=roster))
    here = f"/desk/assignments/{number}/sheets"
    every = staff.get(here)
    with zipfile.ZipFile(io.BytesIO(every.content)) as archive:
        assert archive.namelist() == ["week4.en.pdf", "week4.fr.pdf"]
    with class_of_three.site.store.reading() as connection:
        people = {one.student: one.person for one in holders(connection, number)}
    some = staff.fill(here, {"who": [str(people["Zoé"])]})
    assert some.headers["content-type"] == "application/pdf"
    assert "week4.fr.pdf" in some.headers["content-disposition"]
    assert len(some.content) < len(every.content)


def test_practice_tells_what_is_to_be_handed_in_until_it_is(class_of_three):
    number = dealt(class_of_three)
    zoe = class_of_three.browser(ZOE)
    assert f'href="/assignments/{number}"' in zoe.get("/practice").text
    handed_in(zoe, number, {"e1-rA": "12"})
    assert f'href="/assignments/{number}"' not in zoe.get("/practice").text


# ------------------------------------------------------------------ what a form puts together

CHOSEN = {
    "title": 'Contrôle n° 3 : "bielle"',
    "name": "week7",
    "date": "2026-12-04",
    "duration": "1 h 30",
    "mark_of": "20",
    "versions": "2",
    "exercise": ["slotted_mechanism", "grashof"],
    "place.slotted_mechanism": "2",
    "place.grashof": "1",
    "part.slotted_mechanism": ["rA", "theta4"],
    "points.slotted_mechanism.rA": "2,5",
    "points.slotted_mechanism.theta4": "1",
}


def test_a_form_shows_parts_points_and_pages_and_writes_the_file_that_it_issues(
    class_of_three, staff, tmp_path
):
    page = staff.fill("/desk/assignments/new", {**CHOSEN, "do": "look"})
    assert page.status_code == 200
    assert not names_of(class_of_three)
    assert page.text.count('src="data:image/png;base64,') >= 2
    assert 'name="points.slotted_mechanism.rA" value="2,5"' in page.text
    file = base64.b64decode(re.search(r'href="data:application/toml;base64,([^"]+)"', page.text)[1])
    path = tmp_path / "week7.toml"
    path.write_bytes(file)
    told = read_assignment(path, class_of_three.site.course)
    assert (told.date, told.duration, told.versions, told.names) == (
        date(2026, 12, 4),
        {"": "1 h 30"},
        2,
        ("grashof", "slotted_mechanism"),
    )
    asked = re.compile(r"<details( open)?><summary>Questions asked: (\d+)</summary>")
    assert asked.findall(page.text) == [(" open", "3"), (" open", "2")]
    # From a mechanism's page its questions are chosen already: they stand folded away.
    assert asked.findall(staff.get("/desk/assignments/new?exercise=slotted_mechanism").text) == [("", "10")]
    assert told.exercises[1].parts == ("rA", "theta4")
    assert told.exercises[1].points == {"rA": 2.5, "theta4": 1.0}
    number = dealt_by(class_of_three, staff, staff.fill("/desk/assignments/new", {**CHOSEN, "accounts": "1"}))
    stated = content(class_of_three, number)["assignment"]
    assert (stated["name"], stated["title"][""]) == ("week7", CHOSEN["title"])
    assert 'name="minutes" min="1" max="1440" value="90"' in staff.get(f"/desk/assignments/{number}").text
    again = staff.fill("/desk/assignments/new", {"do": "look"}, files={"file": ("week8.toml", file)})
    assert 'name="source_name" value="week8"' in again.text
    edited = {
        "source": file.decode().replace("versions = 2", "versions = 3"),
        "source_name": "week8",
        "accounts": "1",
    }
    other = dealt_by(class_of_three, staff, staff.fill("/desk/assignments/new", edited))
    assert list(names_of(class_of_three)) == ["week7", "week8"]
    assert other != number


@pytest.mark.slow
@each_row(
    ("data", "told"),
    [
        ({"date": "tomorrow"}, "day such as"),
        ({"points.slotted_mechanism.rA": "many"}, "above 0"),
        ({"points.slotted_mechanism.rA": "-1"}, "above 0"),
        ({"exercise": []}, "Choose an exercise"),
        ({"source": "titel = 1", "source_name": "x"}, "no key"),
        ({"source": "a = 1"}, "a name"),
    ],
)
def test_a_form_that_makes_no_sense_is_told_before_anything_is_drawn(class_of_three, staff, data, told):
    reply = staff.fill("/desk/assignments/new", {**CHOSEN, **data, "do": "look"})
    assert (reply.status_code, told in reply.text) == (422, True), reply.text[:3000]


def test_a_table_written_as_a_file_reads_back_as_itself():
    table = {
        "title": 'a "b" \\ \n\t\x7f é',
        "date": date(2026, 1, 2),
        "mark": {"of": 20.0, "step": 0.25},
        "cover": True,
        "exercises": [{"name": "x", "parts": ["a", "b"], "points": {"a": 1.0, "b.c d": 2.5}}],
    }
    assert tomllib.loads(toml_of(table)) == table
