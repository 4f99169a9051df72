"""Staff against staff: nobody takes over an account, or a role, that an administrator did not give."""

import html
import re
from pathlib import Path

import pytest
from site_people import HOME, MAX, TEACHER, ZOE, Class
from sqlalchemy import select, update

from coursework.database.audit import Actor, note
from coursework.database.people import put_account, put_person
from coursework.database.permissions import PERMISSIONS, ROLES, Permission
from coursework.database.tables import account, audit, person

PASSWORD = "a lamp by the window"
EVE = "Eve Instructor"  #: who attacks


@pytest.fixture
def site(tmp_path):
    found = Class(f"sqlite:///{tmp_path}/site.db")
    with found.site.store.begin() as connection:
        found.ids[EVE] = put_person(connection, identifier="eve", name=EVE, lang="", columns={})
        put_account(connection, found.ids[EVE], login="eve@example.org", role="instructor")
    return found


def links_of(reply):
    return re.findall(rf"{HOME}/invitation/[\w-]+", reply.text)


def opens(site, reply, login):
    """Whether a reply holds a link that opens an account."""
    return any(login in site.browser().get(address.removeprefix(HOME)).text for address in links_of(reply))


def row_of(site, name):
    with site.site.store.reading() as connection:
        return connection.execute(select(account).where(account.c.person_id == site.ids[name])).one()


def test_an_instructor_makes_no_link_for_staff(site):
    """Before: the link, a password of one's own, and one was somebody else."""
    eve, got = site.browser(EVE), []
    for name, login in ((TEACHER, "ada@example.org"), (EVE, "eve@example.org")):
        number = site.ids[name]
        for address, told in (
            (f"/desk/people/{number}", {"do": "invite"}),
            (f"/desk/people/{number}/invitation", {}),
            ("/desk/people", {"do": "some", "person": str(number)}),
            ("/desk/people", {"do": "some", "person": [str(site.ids[ZOE]), str(number)]}),
            ("/desk/people", {"do": "all"}),
            ("/desk/people", {"do": "all-file"}),
        ):
            reply = eve.fill(address, told)
            if opens(site, reply, login) or row_of(site, name).invitation is not None:
                got.append((name, address, told))
    assert not got
    assert opens(site, eve.fill(f"/desk/people/{site.ids[MAX]}/invitation"), "max@example.org")
    assert opens(
        site, site.browser(TEACHER).fill(f"/desk/people/{site.ids[EVE]}/invitation"), "eve@example.org"
    )


def test_an_instructor_gives_nobody_a_role(site):
    """Before: whoever was to teach taught, and an instructor made others students."""
    eve = site.browser(EVE)
    for name in (EVE, MAX, TEACHER):
        before = row_of(site, name).role
        for role in ROLES:
            eve.fill(f"/desk/people/{site.ids[name]}", {"do": "role", "role": role})
            eve.fill(f"/desk/people/{site.ids[name]}/role", {"role": role})
        assert row_of(site, name).role == before
    told = {"name": "Mallory", "login": "mallory@example.org", "role": "administrator"}
    eve.fill("/desk/people/add", told)
    assert eve.fill("/desk/people/add-staff", told).status_code == 403
    with site.site.store.reading() as connection:
        assert not connection.execute(select(account).where(account.c.login == told["login"])).all()


def test_an_instructor_renames_nobody_of_the_staff(site):
    """Or what they decide would stand under another name."""
    eve = site.browser(EVE)
    with site.site.store.begin() as connection:
        connection.execute(update(person).where(person.c.id == site.ids[TEACHER]).values(who="4711"))
    roster = b"student,number\nMallory,4711\n"
    eve.fill("/desk/people/add", files={"roster": ("class.csv", roster, "text/csv")})
    with site.site.store.reading() as connection:
        assert (
            connection.execute(select(person.c.name).where(person.c.id == site.ids[TEACHER])).scalar()
            == TEACHER
        )


def test_a_link_or_a_password_of_a_student_opens_no_account_of_staff(site):
    """Who made the link as long as somebody was a student does not come in as staff."""
    eve, admin = site.browser(EVE), site.browser(TEACHER)
    zoe, old = site.ids[ZOE], site.ids[MAX]
    [link] = links_of(eve.fill(f"/desk/people/{zoe}/invitation"))
    [taken] = links_of(eve.fill(f"/desk/people/{old}/invitation"))
    thief = site.browser()
    thief.fill(taken.removeprefix(HOME), {"password": PASSWORD, "again": PASSWORD})
    assert thief.get("/account").status_code == 200
    for number in (zoe, old):
        reply = admin.fill(f"/desk/people/{number}/role", {"role": "instructor"})
        assert len(links_of(reply)) == 1, "the administrator is given the link that is left"
    assert site.browser().get(link.removeprefix(HOME)).status_code == 410
    assert thief.get("/desk").status_code == 303, "the session is over"
    told = {"login": "max@example.org", "password": PASSWORD}
    assert site.browser().fill("/sign-in", told).status_code == 401


def test_what_is_done_with_an_account_is_told_to_its_holder_and_in_the_audit(site):
    admin = site.browser(TEACHER)
    zoe = site.ids[ZOE]
    admin.fill(f"/desk/people/{zoe}/invitation")
    page = site.browser(ZOE).get("/account").text
    assert "made an invitation link" in page
    assert TEACHER in page
    admin.get(f"/desk/people/{zoe}/data")
    admin.fill(f"/desk/people/{zoe}/role", {"role": "assistant", "assignment": "*", "group": "*"})
    admin.fill(f"/desk/people/{site.ids[MAX]}/erase", {"name": MAX})
    with site.site.store.reading() as connection:
        lines = connection.execute(select(audit)).all()
    told = {row.what: row for row in lines}
    assert {"invited", "data given", "role", "erased"} <= {*told}
    for what, subject in (("invited", zoe), ("data given", zoe), ("role", zoe), ("erased", site.ids[MAX])):
        row = told[what]
        assert (row.by, row.actor, row.subject, row.at) == (TEACHER, site.ids[TEACHER], subject, site.at), (
            what
        )
        assert row.address == "testclient", what
    assert (told["role"].about["before"], told["role"].about["role"]) == ("student", "assistant")


def test_the_audit_comes_in_pages_of_a_hundred_and_is_filtered(site):
    with site.site.store.begin() as connection:
        for k in range(250):
            note(
                connection,
                site.at,
                Actor(EVE if k % 5 else TEACHER, 1, "192.0.2.9"),
                f"kind {k % 2}",
                person=k % 3,
            )
    admin = site.browser(TEACHER)
    page, met = "/desk/audit", []
    while page:
        text = admin.get(page).text
        rows = re.findall(r'class="kept"', text)
        assert len(rows) <= 100
        met.append(len(rows))
        found = re.search(r'href="(/desk/audit\?[^"]*before=[^"]*)"', text)
        page = html.unescape(found[1]) if found else ""
    assert sum(met) == 250
    assert len(re.findall(r'class="kept"', admin.get("/desk/audit?by=Ada&what=kind+1").text)) == 25
    assert len(re.findall(r'class="kept"', admin.get("/desk/audit?of=2&what=kind+0").text)) == 42
    assert site.browser(EVE).get("/desk/audit").status_code == 403


def test_the_documentation_says_who_may_what():
    page = (Path(__file__).resolve().parents[2] / "docs/site.md").read_text("utf-8")
    told = {}
    for name, cells in re.findall(r"^\| `([a-z_.]+)`: [^|]+\|(.*)\|$", page, re.MULTILINE):
        told[name] = {role for role, cell in zip(ROLES, cells.split("|"), strict=True) if cell.strip()}
    assert told == {str(one): {role for role in ROLES if one in PERMISSIONS[role]} for one in Permission}
