"""The page of a semester: the marks of all assignments, weighted, of those whom one marks."""

import csv
import io
import re

import pytest
from site_people import MAX, TEACHER, ZOE
from site_walk import Filled
from sqlalchemy import update

from coursework.database.areas import put_areas
from coursework.database.people import put_account, put_person
from coursework.database.permissions import Area
from coursework.database.tables import person
from coursework.site.desk.class_cache import class_now
from coursework.site.desk.question_page import statistics_of

CARA = "Cara"


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    made = Filled(f"sqlite:///{tmp_path_factory.mktemp('semester')}/site.db")
    with made.site.store.begin() as connection:
        for name, group in ((ZOE, "TD 1"), (MAX, "TD 2")):
            told = {"number": name, "group": group}
            connection.execute(update(person).where(person.c.id == made.ids[name]).values(columns=told))
        made.ids[CARA] = put_person(connection, identifier=CARA, name=CARA, lang="", columns={})
        put_account(connection, made.ids[CARA], login="cara@example.org", role="assistant")
        put_areas(connection, made.ids[CARA], [Area(None, "td 1")])
    return made


def lines(site, name=TEACHER, **query):
    reply = site.browser(name).get("/desk/semester.csv", params=query)
    assert reply.status_code == 200, reply.text
    return {row["student"]: row for row in csv.DictReader(io.StringIO(reply.text.lstrip("\ufeff")))}


def percent(site, number, student):
    text = site.browser(TEACHER).get(f"/desk/{number}/files/summary.csv").text
    row = next(row for row in csv.DictReader(io.StringIO(text.lstrip("\ufeff"))) if row["student"] == student)
    return 100 * float(row["points"]) / float(row["out_of"])


def value(cell):
    return float(cell.rstrip("*"))


def test_averages_are_weighted_and_absences_are_worth_what_is_chosen(site):
    first, other = f"weight.{site.number}", f"weight.{site.of_max}"
    chosen = {first: "2", other: "1"}
    mark = percent(site, site.number, MAX) / 5
    assert value(lines(site, **chosen)[ZOE]["midterm"]) == pytest.approx(
        percent(site, site.number, ZOE) / 5, abs=0.006
    )
    found = {worth: lines(site, **chosen, absent=worth) for worth in ("none", "zero", "excused")}
    averages = {worth: table[MAX]["average"] for worth, table in found.items()}
    assert averages["none"] == ""
    assert value(averages["zero"]) == pytest.approx(mark * 2 / 3, abs=0.006)
    assert value(averages["excused"]) == pytest.approx(mark, abs=0.006)
    assert "absent: of Max" in found["none"][MAX]["status"]
    assert "of Max" not in lines(site, **{first: "1", other: "0"})[MAX]
    refused = site.browser(TEACHER).get("/desk/semester", params={first: "many"})
    assert (refused.status_code, "from 0 to 1000" in refused.text) == (422, True)


def test_the_page_says_the_same_in_the_words_of_the_reader(site):
    for lang, words in (
        ("en", ("Average", "absent: Midterm (of Max)", "provisional")),
        ("fr", ("Moyenne", "absent : Devoir (of Max)", "provisoire")),
    ):
        page = re.sub(
            "[\u00a0\u202f]",
            " ",
            site.browser(TEACHER, lang)
            .get("/desk/semester", params={f"weight.{site.number}": "1", f"weight.{site.of_max}": "1"})
            .text,
        )
        assert [word for word in words if word not in page] == []
        assert "weight." in page


def test_a_group_is_shown_alone_and_an_assistant_sees_theirs(site):
    weights = {f"weight.{site.number}": "1", f"weight.{site.of_max}": "1"}
    assert set(lines(site, **weights, class_group="td 2")) <= {MAX}
    assert set(lines(site, CARA, **weights)) == {ZOE}
    page = site.browser(CARA).get("/desk/semester", params=weights)
    assert not re.search(r"(?<!\w)Max(?!\w)", page.text)
    assert site.browser(ZOE).get("/desk/semester").status_code == 403


def test_presence_on_the_roster_is_known_to_class_evening_and_semester(site):
    """An attendance list sent as a roster: who is excused has no zero, who was present and wrote nothing has
    one."""
    page, at = site.browser(TEACHER, "fr"), f"/desk/{site.of_max}"
    answered = {
        name
        for name, row in lines(site, **{f"weight.{site.of_max}": "1"}).items()
        if row["of Max"] != "absent"
    }
    assert MAX not in answered
    for text, cell, told in (("ABJ", "excused", "dispensé"), ("présent", "0", "0")):
        sent = {"roster": ("attendance.csv", f"student,present\n{MAX},{text}\n".encode())}
        page.fill(f"{at}/roster", {}, files=sent)
        assert lines(site, **{f"weight.{site.of_max}": "1"})[MAX]["of Max"] == cell
        row = re.search(rf"<tr id=.*?{MAX}.*?</tr>", page.get(at).text, re.DOTALL)[0]
        assert told in row
        counted = statistics_of(class_now(site.site, site.of_max)).students
        assert counted == (cell != "excused"), "who is excused is not at zero in the statistics"
    assert "presence" in page.get(f"{at}/files/summary.csv").text.splitlines()[0]
