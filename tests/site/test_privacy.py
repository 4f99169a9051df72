"""What is kept of somebody can be had and erased; logs hold no answers; nothing is asked of another host."""

import csv
import io
import json
import logging
import re
import zipfile
from datetime import timedelta

import pytest
from site_people import MAX, TEACHER, ZOE
from site_walk import PLANTED, SEEDS, Filled
from sqlalchemy import JSON, String, insert, select, update

from coursework.database import erasing
from coursework.database.audit import note
from coursework.database.decisions import decide
from coursework.database.people import put_person
from coursework.database.publication import Publication, publish
from coursework.database.submissions import insert_submission
from coursework.database.tables import METADATA, SafeText, extension, worksheet
from coursework.database.tables import person as people
from coursework.errors import BadCourse
from coursework.gradebook.decisions import Decision
from coursework.gradebook.rows import AnswerRow, Rejected

LEA, NUMBER, MAIL = "Léa Quatrebarbes", "20264711", "lea.quatrebarbes@example.org"


@pytest.fixture
def site(tmp_path):
    return Filled(f"sqlite:///{tmp_path}/site.db")


def archive_of(reply):
    assert reply.status_code == 200, reply.text
    return zipfile.ZipFile(io.BytesIO(reply.content))


def table(archive, name):
    return list(csv.DictReader(io.StringIO(archive.read(f"{name}.csv").decode("utf-8-sig"))))


def test_somebody_is_given_what_is_kept_of_them_and_nothing_of_others(site):
    archive = archive_of(site.browser(ZOE).get("/account/data"))
    assert {"LISEZ-MOI.txt", "README.txt", "everything.json", "person.csv", "answer.csv"} <= set(
        archive.namelist()
    )
    whole = "\n".join(archive.read(name).decode() for name in archive.namelist())
    assert PLANTED[ZOE] in whole
    assert not any(secret in whole for secret in (MAX, PLANTED[MAX], str(SEEDS[MAX])))
    assert {row["answer"] for row in table(archive, "answer")} >= {PLANTED[ZOE], "1"}
    assert json.loads(archive.read("everything.json"))["person"][0]["name"] == ZOE


def test_marks_are_not_had_before_they_are_told(site):
    def own():
        return set(archive_of(site.browser(ZOE).get("/account/data")).namelist()) & {
            "mark.csv",
            "issue.csv",
        }

    assert own() == {"issue.csv"}, "it is open"
    site.at += timedelta(hours=3)
    assert own() == {"issue.csv", "mark.csv"}, "it has closed"
    with site.site.store.begin() as connection:
        publish(connection, site.number, Publication(opens=site.at + timedelta(hours=1)))
    assert not own(), "it is to come"
    with site.site.store.begin() as connection:
        publish(connection, site.number, None)
    assert not own(), "it is not published"
    theirs = archive_of(site.browser(TEACHER).get(f"/desk/people/{site.ids[ZOE]}/data")).namelist()
    assert {"mark.csv", "marking.csv", "issue.csv"} <= set(theirs)


def lea(site):
    """Somebody who is named in every table that can name anybody."""
    at = site.at
    with site.site.store.begin() as connection:
        person = put_person(connection, NUMBER, LEA, "fr", {"number": NUMBER, "e-mail": MAIL, "group": "A"})
        from coursework.database.assignments import issued_content, put_issued

        content = issued_content(connection, site.number)
        record = site.site.course["slotted_mechanism"].variant(11, "fr").record
        content["issued"] = [*content["issued"], {"student": LEA, "record": record}]
        content["students"] = {LEA: {"number": NUMBER, "e-mail": MAIL}}
        content["assignment"] = {**content["assignment"], "instructions": {"": f"{LEA} has more time"}}
        put_issued(connection, content)
        rows = [
            AnswerRow(LEA, "slotted_mechanism", "11", "rA", "1", f"{LEA}.ipynb, cell 2"),
            Rejected(f"{LEA}.csv, line 3", "no such part", {"student": LEA, "part": "zz"}),
        ]
        insert_submission(
            connection, site.number, rows, source=f"{LEA}.zip", received_at=at, person_id=person, number=1
        )
        file = [
            AnswerRow(LEA.upper(), "slotted_mechanism", "11", "theta4", "2", "class.csv, line 9"),
            *site.rows(MAX),
        ]
        insert_submission(connection, site.number, file, source=f"of {LEA} and others.csv", received_at=at)
        place = LEA, "slotted_mechanism", "11", "rA"
        agreed = Decision(*place, "accepted", None, f"agreed with {LEA}", "1", TEACHER)
        other = Decision(MAX, "slotted_mechanism", "", "rA", "accepted", reason=f"as {LEA} said", by=LEA)
        decide(connection, site.number, [agreed, other])
        told = {"assignment_id": site.number, "reason": f"{LEA} was ill", "by": TEACHER, "made": at}
        connection.execute(insert(extension).values(person_id=person, **told))
        connection.execute(insert(extension).values(person_id=site.ids[MAX], **{**told, "by": LEA}))
        lines = [{"student": LEA, "reason": ""}]
        connection.execute(insert(worksheet).values(assignment_id=site.number, file="0" * 64, lines=lines))
        note(connection, at, LEA, "handed in", person=person, login=MAIL)
        from coursework.site.people.accounts import invited

        invited(site.site, connection, person, MAIL, "student")
    from coursework.database.marking import mark_new

    mark_new(site.site.course, site.site.store, site.number)
    return person


def every_text(site):
    """Each text of each table, however deep it stands."""
    with site.site.store.reading() as connection:
        for one in METADATA.sorted_tables:
            for row in connection.execute(select(one)):
                for column, value in row._mapping.items():
                    yield one.name, column, json.dumps(value, ensure_ascii=False, default=str).casefold()


def places_of(site, *words):
    return {
        (table, column)
        for table, column, text in every_text(site)
        for word in words
        if word.casefold() in text
    }


def test_no_table_holds_who_was_erased(site):
    person = lea(site)
    words = (LEA, NUMBER, MAIL)
    assert len(places_of(site, *words)) > 20, "there is much to be found before"
    with site.site.store.reading() as connection:
        before = {one.name: connection.execute(select(one)).all() for one in METADATA.sorted_tables}
    staff = site.browser(TEACHER)
    address = f"/desk/people/{person}/erase"
    assert staff.fill(address, {"name": "Léa"}).status_code == 422
    assert places_of(site, LEA)
    assert staff.fill(address, {"name": LEA}).status_code == 303
    assert not places_of(site, *words)
    with site.site.store.reading() as connection:
        after = {one.name: connection.execute(select(one)).all() for one in METADATA.sorted_tables}
    lost = {
        name: set(map(str, before[name])) - set(map(str, after[name])) for name in ("mark", "answer", "issue")
    }
    gone = {row.id for row in before["marking"]} - {row.id for row in after["marking"]}
    assert {row.student for row in before["marking"] if row.id in gone} == {LEA}
    assert lost["mark"] == {str(row) for row in before["mark"] if row.marking_id in gone}
    assert lost["answer"] == {
        str(row) for row in before["answer"] if row.student.casefold() == LEA.casefold()
    }
    assert lost["issue"] == {str(row) for row in before["issue"] if row.student == LEA}
    assert staff.get(f"/desk/people/{person}").status_code == 404
    assert "erased" in staff.get("/desk/audit").text


#: Texts that say nobody's name, or are what others wrote; the tables of one person go as a whole.
NOBODYS = {
    "assignment.secret",
    "assignment.link",
    "job",
    "lti_nonce",
    "lti_course",
    "setting",
    "assignment.name",
    "assignment.published",
    "assignment.course",
    "variant.exercise",
    "variant.seed",
    "variant.letter",
    "variant.record",
    "submission.digest",
    "submission.receipt",
    "answer.exercise",
    "answer.seed",
    "answer.part",
    "answer.answer",
    "answer.lang",
    "answer.student",
    "drawing",
    "marking.student",
    "marking.exercise",
    "marking.seed",
    "marking.state",
    "marking.lang",
    "mark",
    "decision.student",
    "decision.exercise",
    "decision.seed",
    "decision.part",
    "decision.kind",
    "decision.answer",
    "worksheet.file",
    "decision.lasting_id",
    "decision.withdraws",
    "placing.row",
    "audit.what",
    "audit.address",
    "issue",
    "scanned.page",
    "scanned.student",
    "scanned.reading",
    "scanned.picture",
    "typed.student",
    "typed.exercise",
    "typed.seed",
    "typed.part",
    "typed.coordinate",
    "typed.answer",
    "typed.seen",
}


def test_every_text_of_every_table_is_thought_of():
    """A new table or column fails here until it is said whether it can name somebody."""
    told = {f"{table.name}.{name}" for table, names in erasing.TELLING for name in names}
    owned = {
        "person",
        "account",
        "area",
        "session",
        "failure",
        "identity",
        "progress",
        "draft",
        "prepared",
        "class_summary",  # of the whole class, and erased with anybody
        "lti_session",
        "lti_launch",
    }
    for one in METADATA.sorted_tables:
        for column in one.c:
            if isinstance(column.type, (String, SafeText, JSON)):
                known = {one.name, f"{one.name}.{column.name}"}
                assert known & (told | owned | NOBODYS), f"{one.name}.{column.name}: can it name somebody?"


def test_what_others_have_stays_when_somebody_is_erased(site):
    def marks():
        from coursework.database.current_marks import adjusted_sheets

        with site.site.store.reading() as connection:
            return [
                (one.student, one.points)
                for one in adjusted_sheets(connection, site.number)[-1]
                if one.student != LEA
            ]

    before = marks()
    person = lea(site)
    site.browser(TEACHER).fill(f"/desk/people/{person}/erase", {"name": LEA})
    from coursework.database.marking import mark_new

    mark_new(site.site.course, site.site.store, site.number)
    assert {one[0] for one in marks()} == {one[0] for one in before} == {ZOE, MAX}
    archive = archive_of(site.browser(ZOE).get("/account/data"))
    assert PLANTED[ZOE] in archive.read("answer.csv").decode("utf-8-sig")


def test_who_was_erased_is_out_at_once_and_nobody_takes_the_place(site):
    person = lea(site)
    site.ids[LEA] = person
    browser = site.browser(LEA)
    assert browser.get("/account").status_code == 200
    site.browser(TEACHER).fill(f"/desk/people/{person}/erase", {"name": LEA})
    assert browser.get("/account").status_code == 303
    with site.site.store.begin() as connection:
        again = put_person(connection, "somebody else", "Somebody Else", "", {})
        # No database of ours gives a number once more; should one do it all the same, a session is not handed
        # on.
        assert again != person
        connection.execute(update(people).where(people.c.id == again).values(id=person))
    assert browser.get("/account").status_code == 303


def test_a_name_that_is_a_word_strikes_no_other(site):
    """Max is struck where Max is told, and stays in what is a word of the language."""
    with site.site.store.begin() as connection:
        note(connection, site.at, TEACHER, "told", of="the max of Maxwell, said Max")
    site.browser(TEACHER).fill(f"/desk/people/{site.ids[MAX]}/erase", {"name": MAX})
    with site.site.store.reading() as connection:
        told = [text for table, column, text in every_text(site) if table == "audit" and "maxwell" in text]
    assert json.loads(told[0])["of"] == "the max of maxwell, said …"


# ------------------------------------------------------------------- logs, hosts


@pytest.mark.e2e
def test_logs_hold_no_answer_no_name_and_no_invitation(site, caplog):
    caplog.set_level(logging.DEBUG)
    from site_walk import filled, fillings

    from coursework.site.application import ROUTES

    secrets = ("planted-4711", ZOE, "zoé", str(SEEDS[ZOE]), site.token)
    for name in (None, ZOE, TEACHER):
        browser = site.browser(name)
        for page in ROUTES:
            if page.path in ("/sign-out", "/language"):
                continue
            address = filled(page.path, fillings(site)[page.path].own)
            told = dict.fromkeys(
                ("text.rA", "rA", "answer", "login", "password", "name", "q"), "planted-4711"
            )
            browser.get(address, params={"q": "planted-4711", "after": "planted-4711"})
            browser.fill(address, told)
        browser.get(f"/invitation/{site.token}")
        browser.get("/planted-4711")
    lines = [record.getMessage() for record in caplog.records if not record.name.startswith("httpx")]
    assert any("/account" in line for line in lines)
    assert not [line for line in lines for secret in secrets if secret in line]


def test_a_fault_is_written_down_without_what_it_says(site, caplog, monkeypatch):
    def broken(*told, **more):
        raise ValueError("planted-4711")

    monkeypatch.setattr(type(site.site.pages), "page", broken)
    reply = site.browser(ZOE).get("/account")
    assert reply.status_code == 500
    lines = "\n".join(record.getMessage() for record in caplog.records)
    assert re.search(r"ValueError at .*test_privacy", lines)
    assert "planted-4711" not in lines + reply.text


def test_a_course_that_is_gone_is_told_with_the_file_that_is_missing(site, caplog, monkeypatch):
    browser, pages = site.browser(ZOE), type(site.site.pages)
    page, asked = pages.page, []

    def gone(*told, **more):
        asked.append(told)
        if len(asked) == 1:
            raise BadCourse("/courses/mine/exercises: no such folder")
        return page(*told, **more)

    monkeypatch.setattr(pages, "page", gone)
    reply = browser.get("/account")
    assert (reply.status_code, "/courses/mine" in reply.text) == (503, False)
    assert int(reply.headers["retry-after"]) > 0
    assert any("/courses/mine/exercises" in record.getMessage() for record in caplog.records)


def test_a_database_that_is_gone_is_told_as_such(site, monkeypatch):
    from sqlalchemy.exc import OperationalError

    from coursework.errors import BadInput

    def gone(*told):
        raise BadInput("sqlite:////secret/path: disk full") from OperationalError(
            "SELECT", {}, Exception("x")
        )

    browser = site.browser(ZOE)
    monkeypatch.setattr(type(site.site.store), "reading", gone)
    reply = browser.get("/account")
    assert (reply.status_code, "secret" in reply.text) == (503, False)
    assert int(reply.headers["retry-after"]) > 0
