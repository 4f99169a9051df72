"""An assignment dealt to the people of :mod:`site_people`, and published; texts that answer to a paper."""

import re
import time
from datetime import UTC, datetime

from site_people import MAX, ZOE

from coursework.course.secrecy import Secret
from coursework.database.assignments import put_issued
from coursework.database.publication import Publication, publish
from coursework.issuing.assignment import AskedExercise, Assignment, Scale
from coursework.issuing.issued import Issued, issued_content
from coursework.issuing.roster import Student
from coursework.issuing.variant_assignment import assign_variants
from coursework.site.publication import assigning

OPENS, CLOSES = datetime(2026, 11, 23, 8, tzinfo=UTC), datetime(2026, 11, 23, 12, tzinfo=UTC)
ASSIGNMENT = Assignment(
    "week3",
    (AskedExercise("slotted_mechanism", ("rA", "theta4")), AskedExercise("grashof")),
    title={"en": "Midterm", "fr": "Devoir surveillé"},
    instructions={"en": "Show your work."},
    mark=Scale(20, 0.5),
)
_ASSIGNED = {}
USUAL = Publication(opens=OPENS, closes=CLOSES, tries=2)


def dealt(one, publication=USUAL, names=(ZOE, MAX), assignment=ASSIGNMENT, before=None, **more):
    """Deal an assignment to people of a class and publish it; gives its number."""
    course, students = one.site.course, [Student(name) for name in names]
    if before is None and not more:
        # Each test draws the same secrets: what another test was dealt by this one is what would be drawn.
        secret = Secret.new()
        key = id(course), repr(assignment), tuple(names), secret
        if key not in _ASSIGNED:
            _ASSIGNED[key] = assign_variants(course, assignment, students, ["en"], secret=secret)
        found = _ASSIGNED[key]
    else:
        found = assign_variants(course, assignment, students, ["en"], before, **more)
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


FORM = {
    "opens": "2026-11-23T08:00",
    "closes": "2026-11-23T12:00",
    "tries": "2",
    "sittings": "last",
    "late": "charge",
    "late_percent": "12,5",
    "late_until": "2026-11-25T12:00",
    "feedback": "closed",
    "answers": "never",
}


def dealt_by(one, staff, reply):
    """The number of the assignment when the dealing that a reply leads to is over."""
    assert reply.status_code == 303, reply.text
    token = reply.headers["location"].rpartition("/")[2]
    until = time.monotonic() + 60
    while not (found := assigning.assigning_job(one.site, token)).is_over:
        assert time.monotonic() < until
        time.sleep(0.05)
    assert found.state == "done", found.messages
    return found.result


def handed_out(one, staff, data=None, **files):
    sent = {name: (f"week4.{name}", content) for name, content in files.items()}
    if "file" in files:
        sent["file"] = ("week4.toml", files["file"])
    return staff.fill("/desk/assignments/new", data or {}, files=sent)
