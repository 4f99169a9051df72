"""Sessions: what a stolen or copied cookie is worth, and for how long."""

import hashlib
import re
from datetime import UTC, datetime, timedelta

import pytest
from site_accounts import PASSWORD, is_in, join, sign_in
from site_people import MAX, TEACHER, ZOE, Class
from sqlalchemy import event, select, update
from tables import each_row

from coursework.database import sessions as kept
from coursework.database.dump import dump, restore
from coursework.database.store import Store
from coursework.database.tables import METADATA, account, session
from coursework.site.frame.cookies import COOKIE
from coursework.site.frame.settings import Entrance
from coursework.site.people.accounts import described


def cookie_of(browser):
    return browser.cookies.get(COOKIE)


def thief_of(a_class, browser):
    """Another browser with a copy of the cookie."""
    found = a_class.browser()
    found.cookies.set(COOKIE, cookie_of(browser))
    return found


def rows(a_class):
    with a_class.site.store.reading() as connection:
        return connection.execute(select(session).order_by(session.c.id)).all()


def age(a_class, by):
    """Let the sessions be as old as if time had passed."""
    with a_class.site.store.begin() as connection:
        for one in connection.execute(select(session)).all():
            told = {name: getattr(one, name) - by for name in ("created", "seen", "until")}
            connection.execute(update(session).where(session.c.id == one.id).values(told))


# ------------------------------------------------------------- what ends a session


def test_a_copied_cookie_opens_nothing_after_signing_out(class_of_three):
    here = join(class_of_three, ZOE)
    thief = thief_of(class_of_three, here)
    assert is_in(thief)
    assert here.fill("/sign-out").status_code == 303
    assert not is_in(thief)
    assert not is_in(here)
    assert rows(class_of_three) == []


def test_what_ends_sessions_ends_them_in_every_process(class_of_three):
    other = Class.of(class_of_three)
    here = join(class_of_three, ZOE)
    thief = thief_of(other, here)
    assert is_in(thief)
    here.fill("/sign-out")
    assert not is_in(thief)


def ends(a_class, here):
    """Each way in which all other sessions of somebody end, by what it is called."""
    new = {"now": PASSWORD, "password": "another lamp by the window", "again": "another lamp by the window"}
    person = f"/desk/people/{a_class.ids[ZOE]}"
    return {
        "password": lambda: here.fill("/account", new),
        "everywhere": lambda: here.fill("/account", {"do": "everywhere"}),
        "invitation": lambda: join(a_class, ZOE),
        "role": lambda: a_class.browser(TEACHER).fill(f"{person}/role", {"role": "instructor"}),
        "erased": lambda: a_class.browser(TEACHER).fill(f"{person}/erase", {"name": ZOE}),
        "closed": lambda: close(a_class),
    }


def close(a_class):
    with a_class.site.store.begin() as connection:
        mine = account.c.person_id == a_class.ids[ZOE]
        connection.execute(update(account).where(mine).values(closed=a_class.at))


@pytest.mark.parametrize("way", ["password", "everywhere", "invitation", "role", "erased", "closed"])
def test_sessions_end_where_they_must(class_of_three, way):
    here = join(class_of_three, ZOE)
    thief, _ = sign_in(class_of_three, "zoé@example.org", PASSWORD)
    neighbour = class_of_three.browser(MAX)
    assert is_in(thief)
    ends(class_of_three, here)[way]()
    assert not is_in(thief)
    assert is_in(here) == (way == "password")
    assert is_in(neighbour)


# ------------------------------------------------------------------- identifiers


def test_who_signs_in_has_a_new_identifier_and_the_former_one_is_worth_nothing(class_of_three):
    browser = class_of_three.browser()
    browser.get("/sign-in")
    planted = cookie_of(browser)
    join(class_of_three, ZOE)
    sign_in(class_of_three, "zoé@example.org", PASSWORD, browser)
    first = cookie_of(browser)
    sign_in(class_of_three, "zoé@example.org", PASSWORD, browser)
    second = cookie_of(browser)
    assert len({planted, first, second}) == 3
    for old in (planted, first):
        thief = class_of_three.browser()
        thief.cookies.set(COOKIE, old)
        assert not is_in(thief)
    assert is_in(browser)


def test_a_changed_password_changes_the_identifier(class_of_three):
    here = join(class_of_three, ZOE)
    before = cookie_of(here)
    new = "another lamp by the window"
    assert here.fill("/account", {"now": PASSWORD, "password": new, "again": new}).status_code == 303
    assert cookie_of(here) != before
    assert is_in(here)


def test_the_database_gives_no_cookie(class_of_three):
    browsers = [join(class_of_three, ZOE), class_of_three.browser(MAX)]
    told = str([tuple(row) for row in rows(class_of_three)])
    for browser in browsers:
        assert len(cookie_of(browser)) * 6 >= 128
        assert cookie_of(browser) not in told
    for row in rows(class_of_three):
        thief = class_of_three.browser()
        thief.cookies.set(COOKIE, row.digest)
        assert not is_in(thief)


def test_a_csrf_token_belongs_to_one_session(class_of_three):
    mine, again = class_of_three.browser(ZOE), class_of_three.browser(ZOE)
    anonymous = class_of_three.browser()
    before = anonymous.seal
    for foreign in (again.seal, before):
        assert mine.post("/account", data={"_seal": foreign, "do": "everywhere"}).status_code == 403
    old = mine.seal
    mine.fill("/sign-out")
    assert mine.post("/sign-in", data={"_seal": old, "login": "x", "password": "y"}).status_code == 403


# ------------------------------------------------------------------------ in time


def test_a_session_lasts_while_it_is_used_and_not_for_ever(class_of_three):
    browser = class_of_three.browser(ZOE)
    age(class_of_three, kept.IDLE - timedelta(minutes=1))
    assert is_in(browser)
    for _ in range(int(kept.LONGEST / (kept.IDLE - timedelta(days=1)))):
        assert is_in(browser)
        age(class_of_three, kept.IDLE - timedelta(days=1))
    assert not is_in(browser)
    idle = class_of_three.browser(MAX)
    age(class_of_three, kept.IDLE)
    assert not is_in(idle)


def test_a_request_reads_one_session_and_writes_seldom(class_of_three):
    browser, seen = class_of_three.browser(ZOE), []
    browser.get("/account")

    def note(connection, cursor, statement, *more):
        seen.append(statement)

    event.listen(class_of_three.site.store.engine, "before_cursor_execute", note)
    for _ in range(5):
        browser.get("/no-such-page")
    assert sum("session.digest" in one for one in seen) == 5
    assert not [one for one in seen if re.match(r"(?i)update|insert|delete|begin immediate", one)]
    seen.clear()
    age(class_of_three, kept.TOUCHED + timedelta(seconds=1))
    for _ in range(5):
        browser.get("/no-such-page")
    assert sum(one.startswith("UPDATE session") for one in seen) == 2, "one of the test's, one of the site's"


def test_a_session_is_found_by_an_index(class_of_three):
    found = []
    with class_of_three.site.store.reading() as connection:
        event.listen(
            connection, "before_cursor_execute", lambda c, k, text, values, *m: found.append((text, values))
        )
        kept.session_of(connection, "x" * kept.TOKEN_LENGTH, datetime.now(UTC))
        text, values = found[0]
        plan = connection.exec_driver_sql(f"EXPLAIN QUERY PLAN {text}", values).all()
    assert not [row for row in plan if str(row[-1]).startswith("SCAN session")], plan


def test_who_is_nobody_leaves_no_row(class_of_three):
    for _ in range(3):
        class_of_three.browser().get("/sign-in")
        sign_in(class_of_three, "nobody@example.org", "wrong")
    assert rows(class_of_three) == []


def test_expired_sessions_are_removed_and_one_person_has_a_bounded_number(class_of_three):
    class_of_three.browser(ZOE)
    age(class_of_three, kept.IDLE)
    for _ in range(kept.MOST + 3):
        class_of_three.browser(MAX)
    left = rows(class_of_three)
    assert {row.person_id for row in left} == {class_of_three.ids[MAX]}
    assert len(left) == kept.MOST


# ------------------------------------------------------------------- one's own list


def numbers_of(page):
    return re.findall(r'name="session" value="(\d+)"', page)


def test_one_session_is_ended_from_the_list(class_of_three):
    here, there = class_of_three.browser(ZOE), class_of_three.browser(ZOE)
    theirs = class_of_three.browser(MAX)
    page = here.get("/account").text
    assert page.count("Firefox, Linux") >= 2
    assert page.count("this one") == 1
    (other,) = numbers_of(theirs.get("/account").text)
    assert other not in numbers_of(page)
    assert here.fill("/account", {"session": other}).status_code == 303
    assert is_in(theirs), "nobody ends the session of somebody else"
    mine = {row.id for row in rows(class_of_three) if row.person_id == class_of_three.ids[ZOE]}
    assert {int(one) for one in numbers_of(page)} == mine
    assert here.fill("/account", {"session": str(max(mine))}).status_code == 303
    assert not is_in(there)
    assert is_in(here)
    assert here.fill("/account", {"session": str(min(mine))}).headers["location"] == "/"
    assert not is_in(here)


@each_row("odd", ["", "x", "-1", "9" * 30, "²"])
def test_a_number_that_is_none_ends_nothing(class_of_three, odd):
    here = class_of_three.browser(ZOE)
    assert here.fill("/account", {"session": odd}).status_code == 422
    assert is_in(here)


@each_row(
    ("told", "says"),
    [
        ("Mozilla/5.0 (X11; Linux x86_64; rv:140.0) Gecko/20100101 Firefox/140.0", "Firefox, Linux"),
        (
            "Mozilla/5.0 (Windows NT 10.0) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/140.0 "
            "Safari/537.36 Edg/140.0",
            "Edge, Windows",
        ),
        (
            "Mozilla/5.0 (iPhone; CPU iPhone OS 18_0 like Mac OS X) AppleWebKit Version/18.0 Mobile "
            "Safari/604.1",
            "Safari, iPhone",
        ),
        (
            "Mozilla/5.0 (Linux; Android 15) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/140.0 "
            "Mobile Safari/537.36",
            "Chrome, Android",
        ),
        ("curl/8", ""),
        ("<script>" * 9999, ""),
    ],
)
def test_a_browser_is_described_coarsely(told, says):
    assert described(told) == says


# --------------------------------------------------------------------- elsewhere


def test_on_ones_own_machine_nobody_signs_in(class_of_three):
    class_of_three.site.entrance = Entrance.LOCAL
    browser = class_of_three.again().browser()
    assert browser.get("/desk/people").status_code == 200
    assert browser.fill("/sign-out").status_code == 303
    assert browser.get("/desk/people").status_code == 200
    assert browser.get("/sign-in").headers["location"] == "/"
    assert rows(class_of_three) == []


def test_no_dump_signs_anybody_in(class_of_three, tmp_path):
    browser = class_of_three.browser(ZOE)
    digest = rows(class_of_three)[0].digest
    dump(class_of_three.site.store, tmp_path / "dump")
    assert not [path for path in (tmp_path / "dump").iterdir() if digest in path.read_text("utf-8")]
    again = Store(f"sqlite:///{tmp_path}/again.db")
    restore(tmp_path / "dump", again)
    with again.reading() as connection:
        assert kept.session_of(connection, cookie_of(browser), datetime.now(UTC)) is None
        assert connection.execute(select(METADATA.tables["person"])).first() is not None
    again.close()


def test_cookies_of_the_former_kind_are_worth_nothing(class_of_three):
    """They were signed, and named a person; a site that is updated signs everybody out."""
    from itsdangerous import URLSafeSerializer

    serializer = URLSafeSerializer(
        class_of_three.site.secret, salt="session", signer_kwargs={"digest_method": hashlib.sha256}
    )
    now = datetime.now(UTC).timestamp()
    browser = class_of_three.browser()
    browser.cookies.set(COOKIE, serializer.dumps([class_of_three.ids[TEACHER], "x" * 22, now, int(now)]))
    assert not is_in(browser)
