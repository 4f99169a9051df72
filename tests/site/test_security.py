"""What docs/security.md promises of every reply, every cookie and the log, beside what stands in the other
tests of the site."""

import logging
import re
from pathlib import Path

import pytest
from site_client import Client
from site_people import MAX, TEACHER, ZOE
from site_walk import Filled, filled, fillings

import coursework
from coursework.database.accounts import account_of, set_secret
from coursework.site.application import ROUTES, application
from coursework.site.people import passwords

SECURE = "https://mechanics.example.org"
PASSWORD = "four plain words here"


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    found = Filled(f"sqlite:///{tmp_path_factory.mktemp('security')}/site.db")
    with found.site.store.begin() as connection:
        set_secret(connection, account_of(connection, found.ids[ZOE]).id, passwords.hashed(PASSWORD))
    return found


@pytest.fixture
def browser(site):
    """A browser of nobody, over https."""
    site.site.url, before = SECURE, site.site.url
    yield Client(application(site.site), SECURE, {"accept-language": "en"}, client=("192.0.2.7", 1))
    site.site.url = before


def token_of(browser):
    return re.search(r'X-Seal": "([0-9a-f]{64})"', browser.get("/no-such-page").text)[1]


def signs_in(browser, password=PASSWORD):
    told = {"_seal": token_of(browser), "login": "zoé@example.org", "password": password}
    return browser.post("/sign-in", data=told)


def set_cookies(*replies):
    return [one for reply in replies for one in reply.headers.get_list("set-cookie")]


# ---------------------------------------------------------------------- replies


def test_every_cookie_is_this_hosts_own(site, browser):
    """No cookie can be set by plain http or by a neighbouring host, or read by a script."""
    replies = [browser.get("/sign-in"), signs_in(browser)]
    replies.append(browser.post("/language", data={"_seal": token_of(browser), "lang": "fr", "back": "/"}))
    replies.append(browser.post("/sign-out", data={"_seal": token_of(browser)}))
    cookies = set_cookies(*replies)
    assert len({one.partition("=")[0] for one in cookies}) == 3, "session, language, device"
    for one in cookies:
        assert one.startswith("__Host-coursework"), one
        words = {word.strip().casefold() for word in one.split(";")}
        assert {"path=/", "secure", "httponly", "samesite=lax"} <= words, one


def test_browsers_come_back_by_https_alone(browser):
    for address in ("/sign-in", "/no-such-page", "/static/site.css", "/desk"):
        told = browser.get(address).headers["strict-transport-security"]
        assert "includeSubDomains" in told
        assert int(re.search(r"max-age=(\d+)", told)[1]) >= 365 * 24 * 3600


def test_no_other_method_is_answered(site):
    browser = site.browser(TEACHER)
    for page in ROUTES:
        address = filled(page.path, fillings(site)[page.path].own)
        others = ("PUT", "DELETE", "PATCH", "OPTIONS", "CONNECT", "PROPFIND") if page in ROUTES[:2] else ()
        for method in ("TRACE", *others):
            reply = browser.request(method, address)
            assert reply.status_code == 405, (method, page.path)
            assert browser.cookies.get("coursework", "-") not in reply.text


# ---------------------------------------------------------------------- the log


def events(caplog):
    return [one.getMessage() for one in caplog.records if one.name == "coursework.security"]


def test_what_concerns_security_is_logged_with_who_and_from_where(site, browser, caplog):
    caplog.set_level(logging.INFO, "coursework")
    me = site.ids[ZOE]
    assert signs_in(browser, "another password").status_code == 401
    assert signs_in(browser).status_code == 303
    assert browser.get("/desk").status_code == 403
    forged = browser.post("/account", data={"_seal": "0" * 64})
    elsewhere = browser.post(
        "/sign-out", data={"_seal": token_of(browser)}, headers={"origin": "https://evil.example.org"}
    )
    assert (forged.status_code, elsewhere.status_code) == (403, 403)
    assert browser.get("/practice", headers={"host": "evil.example.org"}).status_code == 421
    assert browser.post("/sign-out", data={"_seal": token_of(browser)}).status_code == 303
    assert events(caplog) == [
        "security: sign-in failed, POST /sign-in, nobody, from 192.0.2.7",
        f"security: signed in, POST /sign-in, person {me}, from 192.0.2.7",
        f"security: no permission, GET /desk, person {me}, from 192.0.2.7",
        f"security: forged form, POST /account, person {me}, from 192.0.2.7",
        f"security: forged form, POST /sign-out, person {me}, from 192.0.2.7",
        "security: another host, GET /practice, nobody, from 192.0.2.7",
        f"security: signed out, POST /sign-out, person {me}, from 192.0.2.7",
    ]
    refused = [
        one.levelname
        for one in caplog.records
        if one.name == "coursework.security" and "signed" not in one.getMessage()
    ]
    assert set(refused) == {"WARNING"}


def test_limits_and_bodies_that_are_refused_are_logged(site, caplog):
    caplog.set_level(logging.INFO, "coursework")
    browser = site.browser(MAX)
    assert (
        browser.post("/account", content=b"x" * 2_000_000, headers={"content-type": "text/plain"}).status_code
        >= 400
    )
    browser.get("/practice")
    assert [one.partition(",")[0] for one in events(caplog)] == ["security: body refused"]
    lines = [one.getMessage() for one in caplog.records if one.name == "coursework.site"]
    assert re.fullmatch(rf"GET /practice 200 \d+ ms person {site.ids[MAX]}", lines[-1])


# ------------------------------------------------------------------------- code


def test_no_weak_hash_is_used():
    """Neither for secrets nor beside them, where the next one would copy it."""
    weak = re.compile(
        r"\b(md5|sha1)\s*\(|[\"'](md5|sha1)[\"']|\bimport random\b|\brandom\.(random|choice|randint|seed)\("
    )
    package = Path(coursework.__file__).parent
    found = [
        p.relative_to(package).as_posix() for p in package.rglob("*.py") if weak.search(p.read_text("utf-8"))
    ]
    assert not [p for p in found if "_course" not in p]
