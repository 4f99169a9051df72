"""An anonymous class on the desk: codes in place of names on queue, class page and student page, until nothing waits."""

import re

import pytest
from desk_class import EXERCISE, STUDENTS, DeskClass, field
from site_people import TEACHER

from coursework.database.assignments import issued_content, put_issued
from coursework.database.current_marks import graded

CODES = dict(zip(STUDENTS, ("XYZ-222", "K7M-3XP", "CCC-777", "HHH-333", "RRR-444", "NNN-555"), strict=True))


@pytest.fixture
def desk(tmp_path):
    desk = DeskClass(f"sqlite:///{tmp_path}/desk.db", {})
    with desk.site.store.begin() as connection:
        content = issued_content(connection, desk.number)
        stated = {**content["assignment"], "anonymous": True}
        put_issued(connection, {**content, "assignment": stated, "codes": CODES})
    desk.hand_in({"Ada": {"rA": "trop court"}, "Bo": {"rA": "Trop court"}, "Cy": {"rA": "voir feuille"}})
    return desk


def page_of(desk, student):
    return desk.browser(TEACHER).get(f"/desk/{desk.number}/student", params={"name": student})


def names_in(page):
    """Names and identifiers that stand in a page, the reader's own left out."""
    text = page.text.replace(TEACHER, "")
    return [name for name in (*STUDENTS, "4000", "@example.org") if re.search(rf"[>=\"]{name}\b", text)]


def test_a_class_goes_by_codes_until_nothing_waits(desk):
    queue, table = desk.page(TEACHER, "/queue"), desk.page(TEACHER)
    assert (names_in(queue), names_in(table)) == ([], [])
    after = desk.page(TEACHER, "/after", kind="accepted", question=f"{EXERCISE}/rA", answer="trop court")
    assert ("XYZ-222" in after.text, names_in(after)) == (True, [])
    assert queue.text.index("XYZ-222") > 0
    evening = desk.page(TEACHER, "/after")
    assert (names_in(evening), "XYZ-222" in evening.text) == ([], True)
    listed = sorted(CODES.values(), key=table.text.index)
    assert listed == sorted(CODES.values())  # the order of the roster would tell
    student = page_of(desk, "XYZ-222")
    assert (student.status_code, names_in(student)) == (200, [])
    assert page_of(desk, "Ada").status_code == 404
    hidden = {k: field(queue, k) or "" for k in ("group", "since", "student")}
    assert hidden["student"] in CODES.values()
    press = {**hidden, "all": "", "do": "accept"}
    shown = desk.browser(TEACHER).fill(f"/desk/{desk.number}/queue", press)
    assert names_in(shown) == []
    with desk.site.store.reading() as connection:
        verdicts = {sheet.student: sheet.lines["rA"].verdict for sheet in graded(connection, desk.number)}
    assert verdicts[next(name for name, code in CODES.items() if code == hidden["student"])] == "accepted"
    assert sorted(verdicts.values()) == ["accepted", "unreadable", "unreadable"]
    for name, code in CODES.items():
        form = {
            "name": code,
            "exercise": EXERCISE,
            "seed": "42",
            "sitting": "1",
            "part": "rA",
            "do": "accept",
        }
        if name in verdicts:
            desk.browser(TEACHER).fill(f"/desk/{desk.number}/student", form)
    assert "Ada" in names_in(desk.page(TEACHER))
    assert "XYZ-222" not in desk.page(TEACHER).text
    assert page_of(desk, "Ada").status_code == 200
