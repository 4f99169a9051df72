"""Guessing passwords: it is slow, nobody is locked out by others, and no reply says which logins there
are."""

import asyncio
import base64
import json
from datetime import UTC, datetime, timedelta

import pytest
from site_accounts import PASSWORD, is_in, join, sign_in
from site_people import MAX, ZOE, Class
from sqlalchemy import select, update

from coursework.database.tables import failure
from coursework.site.frame import attempts
from coursework.site.frame.attempts import Attempt, Attempts, TooMany, Track
from coursework.site.frame.devices import DEVICE, Devices
from coursework.site.frame.limits import Rate
from coursework.site.people import passwords
from coursework.site.people.common_passwords import is_common

LOGIN = "zoé@example.org"


@pytest.fixture
def waits(monkeypatch):
    """The seconds that requests wait, which nobody waits."""
    found = []

    async def sleep(seconds):
        found.append(seconds)

    monkeypatch.setattr(attempts, "sleep", sleep)
    return found


def guess(a_class, times, login=LOGIN, **more):
    browser = a_class.browser()
    seal = browser.seal
    for number in range(times):
        told = {"_seal": seal, "login": login, "password": f"wrong {number}"}
        assert browser.post("/sign-in", data=told, **more).status_code == 401


@pytest.mark.e2e
@pytest.mark.parametrize("times", [12, 150])
def test_nobody_locks_the_right_password_out(class_of_three, waits, times):
    """From the same address: a browser that signed in before is at once in, a new one after a bounded
    wait."""
    known = join(class_of_three, ZOE)
    known.fill("/sign-out")
    guess(class_of_three, times)
    assert waits[:4] == [1, 2, 4, 8]
    assert waits == sorted(waits)
    assert max(waits) <= 20
    waits.clear()
    assert sign_in(class_of_three, LOGIN, PASSWORD, known)[1].status_code == 303
    assert waits == []
    new, reply = sign_in(class_of_three, LOGIN, PASSWORD)
    assert reply.status_code == 303
    assert is_in(new)
    assert len(waits) == 1
    assert 0 < waits[0] <= 20


def test_a_neighbour_does_not_wait(class_of_three, waits):
    join(class_of_three, MAX)
    guess(class_of_three, 12)
    waits.clear()
    assert sign_in(class_of_three, "max@example.org", PASSWORD)[1].status_code == 303
    assert waits == []


@pytest.mark.e2e
def test_a_class_that_mistypes_behind_one_address_does_not_wait(class_of_three, waits):
    for number in range(99):
        guess(class_of_three, 1, f"student{number}@example.org")
    assert waits == []
    guess(class_of_three, 5, "sprayer@example.org")
    assert waits, "but not without end"


def test_one_s_own_mistakes_are_forgotten_with_the_right_password(class_of_three, waits):
    join(class_of_three, ZOE)
    for _ in range(3):
        guess(class_of_three, 4)
        assert sign_in(class_of_three, LOGIN, PASSWORD)[1].status_code == 303
    assert waits == [1, 1, 1], "of each right one behind four wrong ones"


def test_failures_count_in_every_process_and_are_forgotten_in_time(class_of_three, waits):
    join(class_of_three, ZOE)
    guess(class_of_three, 6)
    waits.clear()
    guess(Class.of(class_of_three), 1)
    assert waits == [4]
    with class_of_three.site.store.begin() as connection:
        told = {"last": datetime.now(UTC) - timedelta(minutes=16)}
        connection.execute(update(failure).values(told))
    waits.clear()
    guess(class_of_three, 1)
    assert waits == []
    with class_of_three.site.store.reading() as connection:
        rows = connection.execute(select(failure)).all()
    assert len(rows) == 3
    assert {(len(row._mapping["key"]), row._mapping["count"]) for row in rows} == {(64, 1)}


def test_an_unknown_login_waits_as_a_known_one_does(class_of_three, waits):
    join(class_of_three, ZOE)
    guess(class_of_three, 8)
    known = list(waits)
    waits.clear()
    guess(class_of_three, 8, "nobody@example.org")
    assert waits == known


def test_who_stole_no_device_cookie_makes_none(class_of_three, waits):
    join(class_of_three, ZOE)
    guess(class_of_three, 6)
    for odd in (
        "x",
        Devices(b"another key").after_sign_in("", LOGIN),
        Devices(class_of_three.site.secret).after_sign_in("", "max@example.org"),
    ):
        browser = class_of_three.browser()
        browser.cookies.set(DEVICE, odd)
        waits.clear()
        sign_in(class_of_three, LOGIN, "wrong", browser)
        assert waits, odd


def test_a_browser_that_signed_in_before_guesses_slowly_too(class_of_three, waits):
    known = join(class_of_three, ZOE)
    known.fill("/sign-out")
    for _ in range(8):
        sign_in(class_of_three, LOGIN, "wrong", known)
    assert waits == [1, 2, 4]


def test_device_cookies_name_nobody(class_of_three):
    known = join(class_of_three, ZOE)
    told = known.cookies.get(DEVICE)
    payload = told.partition(".")[0]
    plain = base64.urlsafe_b64decode(payload + "=" * (-len(payload) % 4)).decode()
    assert "zo" not in plain.casefold().replace(json.loads(plain)[0].casefold(), "")
    devices = Devices(class_of_three.site.secret)
    many = ""
    for number in range(9):
        many = devices.after_sign_in(many, f"login{number}")
    assert [bool(devices.name_for_login(many, f"login{n}")) for n in range(9)] == [False] * 4 + [True] * 5
    assert len(many) < 400


def test_the_present_password_is_guessed_as_slowly(class_of_three, waits):
    here = join(class_of_three, ZOE)
    for _ in range(7):
        told = {"now": "wrong", "password": "another lamp by the window", "again": "x"}
        assert here.fill("/account", told).status_code == 422
    assert waits == [1, 2]


def test_a_form_without_its_token_counts_and_waits_nothing(class_of_three, waits):
    for _ in range(30):
        assert (
            class_of_three.browser().post("/sign-in", data={"login": LOGIN, "password": "x"}).status_code
            == 403
        )
    with class_of_three.site.store.reading() as connection:
        assert connection.execute(select(failure)).all() == []


def test_who_asks_without_end_shuts_no_known_browser_out(class_of_three):
    """All pages of signing in that one address has were asked for: a browser that signed in before has its
    own."""
    known = join(class_of_three, ZOE)
    known.fill("/sign-out")
    limits, most = class_of_three.site.limits, 10
    limits._of_addresses["sign_in"] = Rate(most, 10**6).allowances
    while not limits.wait_for_rate("sign_in", 0, "testclient"):
        most -= 1
    assert most == 0
    assert class_of_three.browser().get("/sign-in").status_code == 429
    assert sign_in(class_of_three, LOGIN, PASSWORD, known)[1].status_code == 303
    forged = class_of_three.browser()
    forged.cookies.set(DEVICE, "x" + known.cookies[DEVICE])
    assert forged.get("/sign-in").status_code == 429


# ------------------------------------------------------------------- many at once


def test_many_guesses_at_once_are_no_faster_and_fill_nothing(monkeypatch):
    """A hundred at once: the first few are free, a few wait, the others are told to come again."""
    gate, slept = asyncio.Event(), []

    async def sleep(seconds):
        slept.append(seconds)
        await gate.wait()

    monkeypatch.setattr(attempts, "sleep", sleep)
    track, others = Track("login", 4, 20.0, 7), Track("somebody else", 4, 20.0, 7)

    async def one(known, of):
        try:
            async with known.waited(Attempt((of,), {})):
                await gate.wait()
        except TooMany:
            return 429
        return 0

    async def all_of_them():
        known = Attempts()
        tasks = [asyncio.create_task(one(known, track)) for _ in range(100)]
        tasks += [asyncio.create_task(one(known, others))]
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        gate.set()
        done = await asyncio.gather(*tasks)
        return done, known

    done, known = asyncio.run(all_of_them())
    assert done == [0] * 7 + [429] * 93 + [0]
    assert slept == [1, 2, 4]
    assert not known._under_way, "nothing is kept of what is over"


# --------------------------------------------------------------------- passwords

COMMON = """password12 Password123! p@ssw0rd2024 motdepasse1 MotDePasse!! 1234567890
0987654321 12345678910 qwertyuiop azertyuiop qwertzuiop 1qaz2wsx3edc abcdefghij aaaaaaaaaaaa abcabcabcabc
121212121212 iloveyou2024 bienvenue2026 welcome1234 soleil12345 passwordpassword azertyazerty
football2026 trustno1!!!! admin12345678 2026password2026""".split()
FINE = [
    "a lamp by the window",
    "correct horse stapler",
    "vélo-12-lune",
    "Tq7#vR2!mmZ",
    "une phrase de passe",
    "kinetic badger 9",
]


def test_passwords_that_are_guessed_first_are_refused_and_no_others():
    assert [one for one in COMMON if passwords.weakness(one) != "common"] == []
    assert [one for one in FINE if passwords.weakness(one)] == []
    assert not passwords.weakness("é" + "ab c" * 16), "64 characters and more are taken"


def test_what_says_who_one_is_makes_no_password():
    known = ("zoe.martin@example.org", "Zoé Martin")
    for one in ("zoe.martin@example.org", "Martin2026!", "zoe.martin1", "ZoéMartin99", "martin12345"):
        assert passwords.weakness(one, *known) in ("known", "common"), one
    assert not is_common("martin eats green pears", *known)
