"""An assignment dealt to the people of :mod:`site_people`, and published; texts that answer to a paper."""

import re
from datetime import UTC, datetime

from site_people import MAX, ZOE

from coursework.database.assignments import put_issued
from coursework.database.publication import Publication, publish
from coursework.making.assignment import AskedExercise, Assignment, Scale
from coursework.making.dealing import deal
from coursework.making.issued import Issued, issued_content
from coursework.making.roster import Student

OPENS, CLOSES = datetime(2026, 11, 23, 8, tzinfo=UTC), datetime(2026, 11, 23, 12, tzinfo=UTC)
ASSIGNMENT = Assignment(
    "week3",
    (AskedExercise("slotted_mechanism", ("rA", "theta4")), AskedExercise("grashof")),
    title={"en": "Midterm", "fr": "Devoir surveillé"},
    instructions={"en": "Show your work."},
    mark=Scale(20, 0.5),
)
USUAL = Publication(opens=OPENS, closes=CLOSES, tries=2)


def dealt(one, publication=USUAL, names=(ZOE, MAX), assignment=ASSIGNMENT, before=None, **more):
    """Deal an assignment to people of a class and publish it; gives its number."""
    found = deal(one.site.course, assignment, [Student(name) for name in names], ["en"], before, **more)
    content = issued_content(found.issues, assignment)
    with one.site.store.begin() as connection:
        number = put_issued(connection, content, assignment.name)
        publish(connection, number, publication)
    one.issued = Issued(content, "test")
    return number


def right(one, name):
    """The right answers to the paper of somebody, by box."""
    texts = {}
    for place, (exercise, seed) in enumerate(one.issued.issued_to(name).items(), 1):
        variant = one.site.course[exercise].from_record(one.issued.record_of(name, exercise, seed))
        for part in variant.parts:
            value = variant.key.reference[part.quantity]
            texts[f"e{place}-{part.id}"] = value if isinstance(value, str) else f"{float(value):.4f}"
    return texts


def handed_in(browser, number, texts, form_number="1"):
    """Read back, then confirmed; gives the reply."""
    seen = browser.fill(f"/assignments/{number}", texts)
    assert seen.status_code == 200, seen.text
    return browser.fill(f"/assignments/{number}/hand-in", {**texts, "_number": form_number})


def code_of(reply):
    return re.search(r"/receipts/([A-Z2-7-]+)", reply.headers["location"])[1]
