"""On the site too nobody draws a paper from public words, and no page or file of a student holds the
secret."""

import re
from collections import Counter
from datetime import timedelta

import pytest
from secret_words import holds, parts_of, spelled
from site_assignments import FORM, OPENS, dealt, dealt_by, handed_out
from site_people import MAX, TEACHER, ZOE, Class
from sqlalchemy import select
from sweeps import slow

import coursework
from coursework.course.secrecy import Secret
from coursework.database.assignments import issued_content
from coursework.database.tables import assignment
from coursework.site.application import ROUTES
from coursework.site.worker import Worker

COURSE = coursework.open_course()
TOML = (
    b'title = "Exam"\n\n[[exercises]]\nname = "slotted_mechanism"\n\n[[exercises]]\nname = "closed_chain"\n'
)
SECRET = "0b6c5d1f2a9e47388c1fd2b7a4e3905d"


def published_on(site, toml=TOML):
    """Dealt from a file, one who comes late, one who makes up; then published; gives the number."""
    staff = site.browser(TEACHER)
    number = dealt_by(site, staff, handed_out(site, staff, file=toml, roster=b"student\nZo\xc3\xa9\n"))
    late = {"roster": ("class.csv", "student\nZoé\nMax\n".encode())}
    dealt_by(site, staff, staff.fill(f"/desk/assignments/{number}/roster", {}, files=late))
    dealt_by(site, staff, staff.fill(f"/desk/assignments/{number}/make-up", {"student": MAX}))
    assert staff.fill(f"/desk/assignments/{number}/publish", FORM).status_code == 303
    return number


def papers(site, number):
    with site.site.store.reading() as connection:
        content = issued_content(connection, number)
    return {
        (i["student"], i["record"]["exercise"], i.get("sitting", 1)): i["record"] for i in content["issued"]
    }


def test_no_paper_of_a_site_is_drawn_on_a_site_of_ones_own_nor_by_its_code(tmp_path):
    ours, hers = (Class(f"sqlite:///{tmp_path / name}.db") for name in ("ours", "hers"))
    mine, guessed = (papers(site, published_on(site)) for site in (ours, hers))
    assert mine.keys() == guessed.keys()
    assert len(mine) == 6
    assert [p for p in mine if mine[p]["given"] == guessed[p]["given"]] == []
    assert [p for p, r in mine.items() if COURSE[p[1]].variant(r["seed"]).record["given"] == r["given"]] == []


@pytest.mark.parametrize("most", [1, pytest.param(1000, marks=slow)], ids=["few", "all"])
@pytest.mark.parametrize("in_file", [True, False])
@pytest.mark.e2e
def test_no_page_and_no_file_of_a_student_holds_the_secret(class_of_three, in_file, most, caplog):
    number = published_on(class_of_three, f'secret = "{SECRET}"\n'.encode() + TOML if in_file else TOML)
    with class_of_three.site.store.reading() as connection:
        row = connection.execute(select(assignment).where(assignment.c.id == number)).one()
    assert (row.secret == SECRET) == in_file
    assert "secret" not in row.asked
    ways = spelled(row.secret)
    zoe = class_of_three.browser(ZOE)
    pages = _crawled(
        zoe, ["/", "/assignments", f"/assignments/{number}", "/account", "/privacy", "/receipts"], most
    )
    assert {f"/assignments/{number}", "/account"} <= pages.keys()
    assert any(address.startswith("/lessons/") for address in pages)
    assert [address for address, data in pages.items() if holds(data, ways)] == []
    assert zoe.get(f"/desk/assignments/{number}/issued.json").status_code in (403, 404)
    staff = class_of_three.browser(TEACHER)
    for address in (
        f"/desk/assignments/{number}",
        f"/desk/assignments/{number}/preview",
        "/desk/audit",
        "/desk",
    ):
        assert not holds(staff.get(address).content, ways), address
    assert holds(staff.get(f"/desk/assignments/{number}/issued.json").content, ways)
    assert row.secret not in caplog.text


def test_no_address_tells_a_paper_before_it_opens(class_of_three):
    """Every address of the site, asked for and filled in by a student who knows all numbers."""
    class_of_three.site.has_worker = True
    class_of_three.at = OPENS - timedelta(hours=1)
    number = dealt(class_of_three, secret=Secret.of(SECRET))
    worker = Worker(class_of_three.site, "test")
    worker.prepare_all()
    while worker.work_once():
        pass
    codes = {e: str(code) for e, code in class_of_three.issued.issued_to(ZOE).items()}
    zoe, told = class_of_three.browser(ZOE), []
    known = {"number": number, "assignment": number, "person": class_of_three.ids[ZOE], "exercise": "grashof"}
    for page in ROUTES:
        for file in ("paper.pdf", "notebook.ipynb", "issued.json"):
            address = re.sub(r"{(\w+)[^}]*}", lambda place, f=file: str(known.get(place[1], f)), page.path)
            replies = [zoe.get(address)]
            if page.takes_forms and not page.path.startswith("/sign-"):
                replies.append(zoe.fill(address))
            for reply in replies:
                parts = b"\n".join(parts_of(reply.content))
                told += [
                    (address, c) for c in codes.values() if re.search(rb"(?<!\d)%b(?!\d)" % c.encode(), parts)
                ]
            if "{file}" not in page.path:
                break
    assert told == []
    class_of_three.at = OPENS
    assert all(code in zoe.get(f"/assignments/{number}").text for code in codes.values())


def _crawled(browser, addresses, most):
    """All that links lead to, from some addresses on; of practice the first page alone, of lessons and what
    is explored, which know of no assignment, so many pages of each folder."""
    found, waiting, everybodys = {}, list(addresses), Counter()
    while waiting:
        address = waiting.pop().partition("#")[0].partition("?")[0]
        if address in found or address.startswith(("/static", "/sign-out")) or address.count("/practice/"):
            continue
        if address.startswith(("/lessons/", "/explore/")):
            folder = address.split("/")[1], address.count("/")
            if everybodys[folder] >= most:
                continue
            everybodys[folder] += 1
        found[address] = (reply := browser.get(address)).content
        if "html" in reply.headers.get("content-type", ""):
            waiting += re.findall(r'(?:href|src|action)="(/[^"/][^"]*|/)"', reply.text)
    return found


def test_a_malformed_secret_is_refused_by_its_line_and_not_quoted(class_of_three):
    staff = class_of_three.browser(TEACHER)
    page = handed_out(
        class_of_three,
        staff,
        file=b'secret = "' + SECRET[:-1].encode() + b'"\n' + TOML,
        roster=b"student\nMax\n",
    )
    assert page.status_code == 422
    assert "line 1: a secret is 32 hexadecimal digits; found 31 characters" in page.text
    assert SECRET[:20] not in page.text


def test_who_marks_and_may_not_publish_has_no_secret(class_of_three):
    number = published_on(class_of_three, f'secret = "{SECRET}"\n'.encode() + TOML)
    told = {"role": "assistant", "assignment": "*", "group": "*"}
    class_of_three.browser(TEACHER).fill(f"/desk/people/{class_of_three.ids[MAX]}/role", told)
    for name, may in ((TEACHER, True), (MAX, False)):
        file = class_of_three.browser(name).get(f"/desk/{number}/files/issued.json")
        assert file.status_code == 200
        assert (SECRET in file.text) == may
