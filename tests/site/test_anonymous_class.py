"""An anonymous class on the desk: codes in place of names on queue, class page and student page, until
nothing waits."""

import io
import re
import zipfile

import pytest
from desk_class import EXERCISE, STUDENTS, DeskClass, field
from pdf_text import page_texts
from site_people import TEACHER

from coursework.database.assignments import issued_content, put_issued
from coursework.database.current_marks import adjusted_sheets
from coursework.gradebook.rows import AnswerRow
from coursework.site.application import ROUTES

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
        verdicts = {
            sheet.student: sheet.lines["rA"].verdict for sheet in adjusted_sheets(connection, desk.number)[-1]
        }
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


def said(name, data):
    """Names and texts of what is downloaded, of the members of an archive too."""
    if data.startswith(b"PK"):
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            for member in archive.namelist():
                yield from said(f"{name}/{member}", archive.read(member))
    else:
        yield name, "".join(page_texts(data)) if data.startswith(b"%PDF") else data.decode("utf-8")


def outputs(number):
    """Every address of the desk that tells of one class."""
    about = {"student": "?name=XYZ-222", "question": f"?exercise={EXERCISE}&part=rA"}
    tables = ("marks.csv", "summary.csv", "rejected.csv", "decisions.csv", "answers.csv", "archive.zip")
    paths = {r.path for r in ROUTES if r.path.startswith("/desk/{assignment:int}")}
    for path in sorted(path.replace("{assignment:int}", str(number)) for path in paths):
        for table in tables if "{file}" in path else ("",):
            yield path.replace("{file}", table) + about.get(path.rpartition("/")[2], "")


def test_no_output_of_the_desk_tells_names_until_nothing_waits(desk):
    """But the record, which tells whose a code is: of those who may publish alone."""
    desk.hand_in({}, AnswerRow("Ada", EXERCISE, "7", "rA", "99", "more.csv, line 2"))
    form = {
        "name": "XYZ-222",
        "exercise": EXERCISE,
        "seed": "42",
        "sitting": "1",
        "part": "rA",
        "do": "accept",
    }
    browser = desk.browser(TEACHER)
    browser.fill(f"/desk/{desk.number}/student", form)
    known = re.compile(rf"(?<![A-Za-z])(?:{'|'.join(STUDENTS)})\b|\b4000\b|@example\.org", re.IGNORECASE)
    told, met = {}, []
    for address in outputs(desk.number):
        for name, text in said(address, browser.get(address).content):
            met += [name] if "XYZ-222" in text or "xyz-222" in name else []
            text = re.sub(r"\b[0-9a-f]{32,}\b", "", text)  # a token spells names by chance
            if found := known.search(f"{name}\n{text}".replace(TEACHER, "")):
                told[name] = text[max(0, found.start() - 60) : found.end() + 40]
    assert told == {}
    ends = {name.rpartition("/")[2] for name in met}
    assert {"marks.csv", "summary.csv", "rejected.csv", "decisions.csv", "answers.csv", "xyz-222.pdf"} <= ends


def test_the_table_that_renews_itself_renews_codes_too(desk):
    """Changes are told by names, rows by codes: the page is made anew."""
    address = re.search(r'hx-get="(/desk/\d+/news[^"]*)"', desk.page(TEACHER).text)[1].replace("&amp;", "&")
    browser = desk.browser(TEACHER)
    assert browser.get(address).status_code == 204
    desk.hand_in({"Di": {"rA": "trop long"}})
    assert browser.get(address, follow_redirects=False).headers["location"] == f"/desk/{desk.number}"
