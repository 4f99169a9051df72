"""Coming in with a password: invitations, signing in, and what ends a session."""

import csv
import io
import re
from datetime import timedelta

import pytest
from argon2 import PasswordHasher, Type, extract_parameters
from site_accounts import PASSWORD, invite, is_in, join, sign_in
from site_people import HOME, MAX, TEACHER, ZOE
from sqlalchemy import select, update

from coursework.database.accounts import account_by_login
from coursework.database.people import people
from coursework.database.tables import account
from coursework.errors import BadInput
from coursework.site.frame.cookies import COOKIE, Cookies
from coursework.site.frame.settings import Entrance
from coursework.site.people import accounts, passwords

# -------------------------------------------------------------------- invitations


def test_an_invitation_gives_a_password_and_signs_in(class_of_three):
    address = invite(class_of_three, ZOE)
    browser = class_of_three.browser()
    assert "zoé@example.org" in browser.get(address).text
    assert not is_in(browser), "looking at an invitation takes nothing up"
    assert browser.fill(address, {"password": PASSWORD, "again": PASSWORD}).status_code == 303
    assert is_in(browser)
    other, reply = sign_in(class_of_three, " ZOÉ@example.org ", PASSWORD)
    assert reply.status_code == 303
    assert is_in(other)


def test_an_invitation_works_once(class_of_three):
    address = invite(class_of_three, ZOE)
    told = {"password": PASSWORD, "again": PASSWORD}
    assert class_of_three.browser().fill(address, told).status_code == 303
    assert class_of_three.browser().get(address).status_code == 410
    assert (
        class_of_three.browser()
        .fill(address, {"password": "another one!", "again": "another one!"})
        .status_code
        == 410
    )
    assert sign_in(class_of_three, "zoé@example.org", PASSWORD)[1].status_code == 303


def test_a_later_invitation_replaces_the_one_before(class_of_three):
    before, after = invite(class_of_three, ZOE), invite(class_of_three, ZOE)
    assert class_of_three.browser().get(before).status_code == 410
    assert class_of_three.browser().get(after).status_code == 200


def test_an_invitation_is_over_in_time(class_of_three):
    address = invite(class_of_three, ZOE)
    class_of_three.at += timedelta(days=accounts.DAYS, seconds=1)
    assert class_of_three.browser().get(address).status_code == 410
    told = {"password": PASSWORD, "again": PASSWORD}
    assert class_of_three.browser().fill(address, told).status_code == 410


def test_nothing_that_is_kept_gives_an_invitation_or_a_password(class_of_three):
    address = invite(class_of_three, ZOE)
    join(class_of_three, MAX)
    with class_of_three.site.store.reading() as connection:
        kept = str(connection.execute(select(account)).all())
    assert address.rpartition("/")[2] not in kept
    assert PASSWORD not in kept
    assert "$argon2id$" in kept


@pytest.mark.parametrize(
    ("password", "again"),
    [
        ("short", "short"),
        ("a" * 12, "a" * 12),
        ("x" * 100 + "abcde" * 30,) * 2,
        (PASSWORD, PASSWORD.upper()),
        ("zoé@example.org",) * 2,
    ],
)
def test_a_password_that_will_not_do_takes_nothing_up(class_of_three, password, again):
    address = invite(class_of_three, ZOE)
    browser = class_of_three.browser()
    assert browser.fill(address, {"password": password, "again": again}).status_code == 422
    assert browser.get(address).status_code == 200


# ------------------------------------------------------------------------ sign in


def test_an_unknown_login_and_a_wrong_password_are_told_alike(class_of_three):
    join(class_of_three, ZOE)
    texts = []
    for login in ("zoé@example.org", "max@example.org", "nobody@example.org"):
        reply = sign_in(class_of_three, login, "not the password")[1]
        assert reply.status_code == 401
        texts.append(re.sub(r"[0-9a-f]{64}", "", reply.text).replace(login, ""))
    assert len(set(texts)) == 1


def test_an_unknown_login_costs_what_a_wrong_password_costs(class_of_three, monkeypatch):
    join(class_of_three, ZOE)
    tried, verify = [], PasswordHasher.verify

    def counted(self, kept, password):
        tried.append((extract_parameters(kept), password))
        return verify(self, kept, password)

    monkeypatch.setattr(PasswordHasher, "verify", counted)
    for login in ("zoé@example.org", "nobody@example.org"):
        assert sign_in(class_of_three, login, "not the password")[1].status_code == 401
    known, unknown = tried
    assert known == unknown


def test_a_password_costs_who_guesses_19_mebibytes_twice_over(strong_hasher):
    found = extract_parameters(strong_hasher.hash(PASSWORD))
    assert found.type is Type.ID
    assert found.memory_cost >= 19 * 1024
    assert found.time_cost >= 2


def test_a_password_that_is_kept_in_an_older_way_is_kept_anew(class_of_three):
    join(class_of_three, ZOE)
    weak = PasswordHasher(time_cost=1, memory_cost=8, parallelism=1).hash(PASSWORD)
    with class_of_three.site.store.begin() as connection:
        connection.execute(update(account).where(account.c.login == "zoé@example.org").values(secret=weak))
    assert sign_in(class_of_three, "zoé@example.org", PASSWORD)[1].status_code == 303
    with class_of_three.site.store.reading() as connection:
        assert not passwords.is_dated(account_by_login(connection, "zoé@example.org").secret)
    assert sign_in(class_of_three, "zoé@example.org", PASSWORD)[1].status_code == 303


def test_a_class_of_500_behind_one_address_can_sign_in(class_of_three):
    limits = class_of_three.site.limits
    assert not any(limits.wait_for_rate("sign_in", 0, "192.0.2.7") for _ in range(3 * 500))
    assert not any(limits.wait_for_rate("usual", 0, "192.0.2.7") for _ in range(10 * 500))
    assert sum(limits.wait_for_rate("sign_in", 0, "192.0.2.7") > 0 for _ in range(3000)) > 1000, (
        "but not without end"
    )


def test_who_signs_in_goes_on_to_the_page_that_was_asked_for(class_of_three):
    join(class_of_three, ZOE)
    browser = class_of_three.browser()
    asked = browser.get("/account").headers["location"]
    assert asked == "/sign-in?after=/account"
    assert 'value="/account"' in browser.get(asked).text
    told = {"login": "zoé@example.org", "password": PASSWORD, "after": "/account"}
    assert browser.fill("/sign-in", told).headers["location"] == "/account"


@pytest.mark.parametrize(
    "away",
    [
        "https://evil.example",
        "//evil.example",
        "/\\evil.example",
        "/\t/evil.example",
        "\\\\evil.example",
        "javascript:alert(1)",
    ],
)
def test_signing_in_leads_nowhere_else(class_of_three, away):
    join(class_of_three, ZOE)
    told = {"login": "zoé@example.org", "password": PASSWORD, "after": away}
    for headers in ({}, {"hx-request": "true"}):
        browser = class_of_three.browser()
        reply = browser.fill("/sign-in", told, headers=headers)
        assert (
            reply.headers.get("location", reply.headers.get("hx-redirect")) in ("/", "/%09/evil.example")[:1]
        )


# ----------------------------------------------------------------------- sessions


def test_another_password_ends_the_sessions_elsewhere(class_of_three):
    here = join(class_of_three, ZOE)
    there, _ = sign_in(class_of_three, "zoé@example.org", PASSWORD)
    new = "another lamp by the window"
    assert here.fill("/account", {"now": "wrong", "password": new, "again": new}).status_code == 422
    assert is_in(there)
    assert here.fill("/account", {"now": PASSWORD, "password": new, "again": new}).status_code == 303
    assert is_in(here)
    assert not is_in(there)
    assert sign_in(class_of_three, "zoé@example.org", PASSWORD)[1].status_code == 401
    assert sign_in(class_of_three, "zoé@example.org", new)[1].status_code == 303


def test_a_cookie_that_is_not_ours_is_replaced(class_of_three):
    for odd in ("x", "a.b.c", "é" * 9, Cookies(b"another key").anonymous().token, "x" * 43):
        browser = class_of_three.browser()
        reply = browser.get("/sign-in", headers={"cookie": f"{COOKIE}={odd}".encode()})
        assert reply.status_code == 200
        assert COOKIE in reply.headers["set-cookie"]


def test_cookies_cannot_be_read_by_scripts_nor_sent_by_other_sites(class_of_three):
    told = class_of_three.browser().get("/sign-in").headers["set-cookie"].lower()
    assert all(word in told for word in ("httponly", "samesite=lax", "path=/"))
    assert "secure" not in told
    class_of_three.site.url = "https://mechanics.example.org"
    browser = type(class_of_three).again(class_of_three).browser()
    told = browser.get("/sign-in", headers={"host": "mechanics.example.org"}).headers
    assert told["set-cookie"].startswith("__Host-coursework=")
    assert "secure" in told["set-cookie"].lower()
    assert "domain" not in told["set-cookie"].lower()
    assert "strict-transport-security" in told


# ---------------------------------------------------------------- people, by staff


def test_the_staff_invites_a_class_and_the_links_work(class_of_three):
    staff = class_of_three.browser(TEACHER)
    reply = staff.fill("/desk/people", {"do": "all-file"})
    rows = list(csv.DictReader(io.StringIO(reply.content.decode("utf-8-sig"))))
    assert {row["student"] for row in rows} == {ZOE, MAX, TEACHER}
    for row in rows:
        assert class_of_three.browser().get(row["invitation"].removeprefix(HOME)).status_code == 200
    assert "/invitation/" not in staff.get("/desk/people").text


def test_a_roster_is_added_once(class_of_three):
    staff = class_of_three.browser(TEACHER)
    roster = "student,number,e-mail\nLéa Roy,4711,lea@example.org\n=1+2,4712,odd@example.org\n".encode()
    for added in (2, 0):
        reply = staff.fill("/desk/people/add", files={"roster": ("class.csv", roster, "text/csv")})
        assert reply.headers["location"] == f"/desk/people?added={added}"
    assert "lea@example.org" in staff.get("/desk/people").text
    assert "'=1+2" in staff.fill("/desk/people", {"do": "all-file"}).content.decode("utf-8-sig")


def test_a_login_belongs_to_one_person(class_of_three):
    staff = class_of_three.browser(TEACHER)
    told = {"name": "Somebody Else", "login": "max@example.org"}
    assert staff.fill("/desk/people/add", told).status_code == 303
    other = re.findall(r'value="(\d+)" aria-label="Choose Somebody Else"', staff.get("/desk/people").text)
    assert staff.fill("/desk/people", {"do": "some", "person": other}).status_code == 409


def test_the_last_administrator_stays(class_of_three):
    staff = join(class_of_three, TEACHER)
    mine, zoe = (f"/desk/people/{class_of_three.ids[name]}" for name in (TEACHER, ZOE))
    for role in ("student", "assistant", "instructor"):
        assert staff.fill(f"{mine}/role", {"role": role}).status_code == 409
    assert staff.fill(f"{mine}/erase", {"name": TEACHER}).status_code == 409
    assert staff.fill(f"{zoe}/role", {"role": "administrator"}).status_code == 200
    assert staff.fill(f"{mine}/role", {"role": "student"}).status_code == 409, "she has no password yet"
    join(class_of_three, ZOE)
    assert staff.fill(f"{mine}/role", {"role": "student"}).status_code == 303
    assert staff.get("/desk/people").status_code == 303, "what she may has changed: she signs in anew"


def test_a_site_for_others_needs_an_administrator(class_of_three):
    site = class_of_three.site
    with pytest.raises(BadInput, match="--administrator"):
        accounts.check_administrator(site)
    address = accounts.invited_by_command(site, "Head@Example.org", "instructor").removeprefix(HOME)
    accounts.check_administrator(site)
    browser = class_of_three.browser()
    browser.fill(address, {"password": PASSWORD, "again": PASSWORD})
    assert browser.get("/desk/audit").status_code == 200, "the first of a site administers it"
    class_of_three.at += timedelta(days=400)
    accounts.check_administrator(site)
    second = accounts.invited_by_command(site, "second@example.org", "instructor").removeprefix(HOME)
    browser = class_of_three.browser()
    browser.fill(second, {"password": PASSWORD, "again": PASSWORD})
    assert browser.get("/desk/people").status_code == 200
    assert browser.get("/desk/audit").status_code == 403


def test_a_command_lowers_nobody_and_makes_whom_it_names_administrator(class_of_three):
    site = class_of_three.site
    join(class_of_three, TEACHER)
    accounts.invited_by_command(site, "ada@example.org", "instructor")
    accounts.invited_by_command(site, "max@example.org", "administrator")
    with site.store.reading() as connection:
        roles = {one.login: one.role for one in people(connection)}
    assert roles["ada@example.org"] == roles["max@example.org"] == "administrator"


@pytest.mark.parametrize("entrance", [Entrance.LOCAL, Entrance.DEMO])
def test_without_accounts_nobody_is_asked_for_a_password(class_of_three, entrance):
    class_of_three.site.entrance = entrance
    accounts.check_administrator(class_of_three.site)
    browser = class_of_three.browser()
    goes = browser.get("/sign-in").headers["location"]
    assert goes == ("/who" if entrance is Entrance.DEMO else "/")
    if entrance is Entrance.LOCAL:
        assert browser.get("/desk/people").status_code == 200
        browser.fill("/sign-out")
        browser.get("/sign-in")
        assert browser.get("/desk/people").status_code == 200
