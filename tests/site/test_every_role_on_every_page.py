"""Every page of the site asked for, and every form sent, by each role: against a table that is written here
and nowhere else.

And what assistants of a group are shown, or do, of a student of another group: nothing.
"""

import re

import pytest
from site_people import MAX, TEACHER, ZOE
from site_walk import EXERCISE, PLANTED, SEEDS, Filled, filled, fillings, text_of
from sqlalchemy import insert, select, update

from coursework.database.areas import put_areas
from coursework.database.marking import mark_new
from coursework.database.people import put_account, put_person
from coursework.database.permissions import Area
from coursework.database.submissions import insert_submission
from coursework.database.tables import person, scanned
from coursework.gradebook.rows import AnswerRow, Rejected
from coursework.site.application import ROUTES

PAUL, CARA, NINA, OLAF, IVY = "Paul", "Cara", "Nina", "Olaf", "Ivy"
#: Who asks, with role and areas: ``mine`` is the assignment of both students, ``other`` that of Max alone.
STAFF = {
    PAUL: ("assistant", [("mine", None)]),  #: of the assignment
    CARA: ("assistant", [(None, "a")]),  #: of Zoé's group
    NINA: ("assistant", [("other", None)]),  #: of another assignment
    OLAF: ("assistant", []),  #: of nothing yet
    IVY: ("instructor", []),
}
NOBODY, STUDENTS, ASSISTANTS, INSTRUCTORS, ADMINISTRATORS = range(5)
RANK = {None: 0, ZOE: 1, MAX: 1, PAUL: 2, CARA: 2, NINA: 2, OLAF: 1, IVY: 3, TEACHER: 4}

#: From which role on a page is shown, and a form of it taken; none where it takes none.
WHO = {
    "/": (NOBODY, None),
    "/service-worker.js": (NOBODY, None),
    "/offline": (NOBODY, None),
    "/accessibility": (NOBODY, None),
    "/static/{name}": (NOBODY, None),
    "/language": (NOBODY, NOBODY),
    "/who": (NOBODY, NOBODY),
    "/sign-in": (NOBODY, NOBODY),
    "/invitation/{token}": (NOBODY, NOBODY),
    **dict.fromkeys(
        ("/practice", "/assignments", "/account/data", "/progress/progress.json"), (STUDENTS, None)
    ),
    **dict.fromkeys(("/sign-out", "/account", "/progress"), (STUDENTS, STUDENTS)),
    "/lessons/{lesson}": (STUDENTS, STUDENTS),
    "/lessons/{lesson}/figures/{figure}": (STUDENTS, None),
    "/lessons/{lesson}/steps/{steps}": (STUDENTS, None),
    "/practice/{exercise}": (STUDENTS, STUDENTS),
    "/practice/{exercise}/{seed}/motion": (STUDENTS, None),
    "/explore/{exercise}": (STUDENTS, None),
    **{
        f"/practice/{{exercise}}/{{seed}}{end}": (STUDENTS, STUDENTS)
        for end in ("", "/draft", "/read", "/solution")
    },
    **{
        f"/assignments/{{number:int}}{end}": (STUDENTS, STUDENTS)
        for end in ("", "/start", "/keep", "/hand-in", "/file")
    },
    **{
        f"/assignments/{{number:int}}{end}": (STUDENTS, None)
        for end in ("/read-back", "/feedback", "/receipts/{code}", "/receipts/{code}.{ending}", "/{file}")
    },
    "/desk": (ASSISTANTS, None),
    "/desk/semester": (ASSISTANTS, None),
    "/desk/semester.csv": (ASSISTANTS, None),
    "/desk/receipts": (ASSISTANTS, None),
    **{
        f"/desk/{{assignment:int}}{end}": (ASSISTANTS, None)
        for end in (
            "",
            "/news",
            "/figure",
            "/questions",
            "/question",
            "/report",
            "/report.pdf",
            "/queue/watch",
            "/files",
            "/files/{file}",
            "/feedback",
            "/scans/picture",
            "/scans/crop",
        )
    },
    **{
        f"/desk/{{assignment:int}}{end}": (ASSISTANTS, ASSISTANTS)
        for end in ("/queue", "/student", "/rejected", "/gradebook", "/scans/queue")
    },
    "/desk/{assignment:int}/scans": (ASSISTANTS, INSTRUCTORS),
    **{
        f"/desk/{{assignment:int}}{end}": (INSTRUCTORS, INSTRUCTORS)
        for end in ("/answers", "/roster", "/regrade", "/after")
    },
    "/desk/{assignment:int}/changes.csv": (INSTRUCTORS, None),
    "/desk/issued": (INSTRUCTORS, INSTRUCTORS),
    "/desk/lti": (INSTRUCTORS, None),
    "/mechanisms": (INSTRUCTORS, None),
    "/mechanisms/{name}": (INSTRUCTORS, INSTRUCTORS),
    "/desk/assignments": (INSTRUCTORS, None),
    "/desk/assignments/new": (INSTRUCTORS, INSTRUCTORS),
    "/desk/assignments/dealing/{token}": (INSTRUCTORS, None),
    **{
        f"/desk/assignments/{{number:int}}{end}": (INSTRUCTORS, None)
        for end in ("", "/preview", "/as/{person:int}", "/issued.json")
    },
    **{
        f"/desk/assignments/{{number:int}}{end}": (INSTRUCTORS, INSTRUCTORS)
        for end in ("/publish", "/unpublish", "/extend", "/roster", "/make-up", "/sheets")
    },
    **dict.fromkeys(
        ("/desk/people", "/desk/people/add", "/desk/people/extra-time"), (INSTRUCTORS, INSTRUCTORS)
    ),
    "/desk/people/{person}": (INSTRUCTORS, None),
    "/desk/people/{person}/invitation": (INSTRUCTORS, INSTRUCTORS),
    "/desk/people/{person}/separate": (INSTRUCTORS, INSTRUCTORS),
    "/connect/{token}": (STUDENTS, STUDENTS),
    **{
        f"/desk/people{end}": (ADMINISTRATORS, ADMINISTRATORS)
        for end in ("/add-staff", "/{person}/role", "/{person}/erase")
    },
    "/desk/people/{person}/data": (ADMINISTRATORS, None),
    "/desk/audit": (ADMINISTRATORS, None),
}
SAME = "zzz the same words"  #: that both students wrote, and nobody can read


class Staffed(Filled):
    """The two students in groups A and B, who also wrote the same; and staff of every sort."""

    def __init__(self, url):
        super().__init__(url)
        numbers = {"mine": self.number, "other": self.of_max, None: None}
        with self.site.store.begin() as connection:
            for name, group in ((ZOE, "A"), (MAX, "B")):
                told = {"number": name, "group": group}
                connection.execute(update(person).where(person.c.id == self.ids[name]).values(columns=told))
            for name, (role, areas) in STAFF.items():
                self.ids[name] = put_person(connection, identifier=name, name=name, lang="", columns={})
                put_account(connection, self.ids[name], login=f"{name}@example.org", role=role)
                put_areas(connection, self.ids[name], [Area(numbers[one], group) for one, group in areas])
            self.parts = [part.id for part in self.variants[ZOE].parts]
            rows = [
                AnswerRow(name, EXERCISE, str(SEEDS[name]), part, SAME, "late.csv")
                for name in SEEDS
                for part in self.parts[1:3]
            ]
            rows += [
                Rejected(
                    "late.csv, line 9",
                    "no such question",
                    {"student": MAX, "exercise": EXERCISE, "answer": "lost one"},
                ),
                Rejected(
                    "late.csv, line 10", "nobody of that name", {"student": "Stranger", "answer": "lost two"}
                ),
            ]
            insert_submission(connection, self.number, rows, source="late.csv", received_at=self.at)
            for k, name in enumerate((ZOE, MAX)):
                row = {
                    "assignment_id": self.number,
                    "page": f"{k:016x}-0001",
                    "file": f"{name}.pdf",
                    "number": 1,
                    "student": name,
                    "reading": {},
                    "picture": "AAAA",
                    "received_at": self.at,
                }
                connection.execute(insert(scanned).values(row))
        mark_new(self.site.course, self.site.store, self.number)

    def rows_of(self, table, name):
        with self.site.store.reading() as connection:
            return connection.execute(select(table).where(table.c.student == name)).all()

    def get(self, name, end, **query):
        return self.browser(name).get(f"/desk/{self.number}{end}", params=query)

    def send(self, name, end, data, **more):
        return self.browser(name).fill(f"/desk/{self.number}{end}", data, **more)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    return Staffed(f"sqlite:///{tmp_path_factory.mktemp('roles')}/site.db")


def test_the_table_has_every_page():
    assert {page.path: page.takes_forms for page in ROUTES} == {
        path: post is not None for path, (_, post) in WHO.items()
    }


def is_let_in(reply):
    """Whether a reply is more than that one may not, or must sign in."""
    to = reply.headers.get("location", "")
    return reply.status_code not in (401, 403) and not (
        reply.status_code == 303 and to.startswith("/sign-in")
    )


@pytest.mark.e2e
def test_each_role_has_the_pages_of_the_table_and_no_others(site):
    """What an assistant may do, they may where they assist alone."""
    wrong = []
    for page in ROUTES:
        told = fillings(site)[page.path]
        shown, taken = WHO[page.path]
        of_class = page.path.startswith(("/desk/{assignment", "/desk/assignments/{number"))
        for name, rank in RANK.items():
            own, others = (
                filled(page.path, told.own),
                filled(page.path, {**told.own, "assignment": str(site.of_max)}),
            )
            reply = site.browser(name).get(own)
            may = rank >= shown
            is_first = page.path == "/"  # which leads to where one signs in
            if (is_let_in(reply) != may and not is_first) or reply.status_code >= 500:
                wrong.append((name, "GET", page.path, reply.status_code))
            if of_class and shown == ASSISTANTS:
                for who, address in ((NINA, own), (PAUL, others)):
                    if site.browser(who).get(address).status_code != 404:
                        wrong.append((who, "GET", address, "of another assignment"))
            if taken is not None and rank < taken:
                reply = site.browser(name).fill(own)
                if is_let_in(reply) and reply.status_code != 405:
                    wrong.append((name, "POST", page.path, reply.status_code))
                    continue
            if of_class and taken == ASSISTANTS and name in (NINA, PAUL):
                address = own if name == NINA else others
                if site.browser(name).fill(address).status_code != 404:
                    wrong.append((name, "POST", address, "of another assignment"))
    assert not wrong


def test_who_assists_nobody_sees_no_desk(site):
    assert site.browser(OLAF).get("/desk").status_code == 403
    assert site.browser(OLAF).get(f"/desk/{site.number}").status_code == 403


# ------------------------------------------------------------------ another group

OF_MAX = [MAX, str(SEEDS[MAX]), PLANTED[MAX], "lost one", "lost two"]


def told_of(site, text):
    """What of Max stands in a text; the assignment that bears his name is no secret."""
    text = text.replace("of Max", "").replace("of-Max", "")
    secrets = [*OF_MAX, site.receipts[MAX]]
    return [one for one in secrets if re.search(rf"(?<!\w){re.escape(one)}(?!\w)", text)]


@pytest.mark.e2e
def test_no_page_shows_an_assistant_a_student_of_another_group(site):
    found = []
    for page in ROUTES:
        if not page.path.startswith("/desk"):
            continue
        told = fillings(site)[page.path]
        for number in (site.number, site.of_max):
            places = {
                **told.own,
                "assignment": str(number),
                "number": str(number),
                "person": str(site.ids[MAX]),
            }
            address = filled(page.path, places)
            for query in (
                "",
                f"?name={MAX}&student={MAX}&exercise={EXERCISE}&seed={SEEDS[MAX]}&part={site.parts[1]}&why=rejected",
                f"?exercise={EXERCISE}&part={site.parts[0]}&verdict=unreadable",
                f"?code={site.receipts[MAX]}",
            ):
                for headers in ({}, {"hx-request": "true"}):
                    reply = site.browser(CARA).get(address + query, headers=headers)
                    text = text_of(reply).replace(f'value="{site.receipts[MAX]}"', "")
                    if reply.status_code >= 500 or (secrets := told_of(site, text)):
                        found.append((address, query, reply.status_code, secrets))
    assert not found
