"""No page needs more statements because there are more assignments, papers or students."""

import re
from datetime import timedelta

import pytest
from site_people import count_of, statements
from site_walk import EXERCISE, SEEDS, TEACHER, ZOE, Filled, filled, fillings

from coursework.database.assignments import put_issued
from coursework.database.instructor_queries import people_of
from coursework.database.marking import mark_new
from coursework.database.permissions import is_of_staff
from coursework.database.publication import publish
from coursework.database.submissions import insert_submission
from coursework.gradebook.rows import AnswerRow, RowOrigin
from coursework.site.application import ROUTES
from coursework.site.worker import Worker

MORE = [f"Student {number}" for number in range(4)]  #: who join the two
NAMED = {  #: what an address names in its query
    "/desk/{assignment:int}/student": f"?name={ZOE}",
    "/desk/{assignment:int}/question": f"?exercise={EXERCISE}&part=rA",
    "/desk/{assignment:int}/figure": f"?exercise={EXERCISE}&seed={SEEDS[ZOE]}",
    "/desk/{assignment:int}/feedback": f"?student={ZOE}",
}
#: Ends of addresses that draw much and read little.
ONCE = (
    "report",
    "report.pdf",
    "feedback",
    "sheets",
    "motion",
)
DIGEST = re.compile("[0-9a-f]{64}")


@pytest.fixture
def site(tmp_path):
    return Filled(f"sqlite:///{tmp_path}/site.db")


def grow(site):
    """More students in the first assignment, then more assignments for everybody, all handed in and
    marked."""
    variants = {name: site.variants.get(name, site.variants[ZOE]) for name in (*SEEDS, *MORE)}
    issued = [{"student": name, "record": one.record} for name, one in variants.items()]
    for title in ("midterm", *(f"week {number}" for number in range(4))):
        stated = {"name": title, "exercises": [EXERCISE]}
        if title == "midterm":
            stated["title"] = {"en": "Midterm", "fr": "Devoir"}
        roster = {name: {"number": name} for name in variants}
        content = {"format": 1, "roster": True, "assignment": stated, "students": roster, "issued": issued}
        with site.site.store.begin() as connection:
            number = put_issued(connection, content)
            publish(connection, number, site.published)
            for name, person in people_of(connection, number).items():
                if title != "midterm" or name in MORE:
                    hand_in(connection, number, name, person, variants[name], site.at - timedelta(hours=1))
        mark_new(site.site.course, site.site.store, number)


def hand_in(connection, number, name, person, variant, at):
    origin = RowOrigin(sitting=1, submitted="2026-11-23T07:00:00+00:00")
    rows = [
        AnswerRow(name, EXERCISE, str(variant.seed), part.id, "12 apples", "the site", origin=origin)
        for part in variant.parts
    ]
    insert_submission(connection, number, rows, source="the site", received_at=at, person_id=person, number=1)


def walk(site):
    """The statements of each page that was asked for before, by who asks."""
    browsers, places, counted = {name: site.browser(name) for name in (ZOE, TEACHER)}, fillings(site), {}
    for page in ROUTES:
        address = filled(page.path, places[page.path].own) + NAMED.get(page.path, "")
        for name in (TEACHER,) if is_of_staff(page.permission) else (ZOE, TEACHER):
            if page.path.rpartition("/")[2] not in ONCE:
                browsers[name].get(address)
            with statements(site.site.store) as found:
                reply = browsers[name].get(address)
            counted[page.path, name] = (reply.status_code, *count_of(found))
    return counted


@pytest.mark.e2e
def test_no_page_needs_more_statements_where_there_is_more(site):
    before = walk(site)
    grow(site)
    after = walk(site)
    assert {page: (before[page], after[page]) for page in before if before[page] != after[page]} == {}
    for path, most in {"/assignments": 8, "/practice": 9}.items():
        assert after[path, ZOE][1] <= most, path


@pytest.mark.parametrize("who", ["page", "worker"])
def test_what_one_process_has_counted_no_other_counts_again(site, who):
    grow(site)
    other = Filled.of(site)
    if who == "worker":
        Worker(site.site, "test").count_classes()
    for address in ("/desk", f"/desk/{site.number}"):
        told = site.browser(TEACHER).get(address) if who == "page" else None
        with statements(other.site.store) as found:
            again = other.browser(TEACHER).get(address)
        assert not [text for text in found if re.search(r"\b(mark\.points|answer\.answer)\b", text)], address
        assert told is None or DIGEST.sub("", again.text) == DIGEST.sub("", told.text)
