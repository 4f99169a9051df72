"""Every address of the site, asked for by nobody, a student, another student and an administrator: who may,
who may not, and what no reply holds. Pages are found in the site's own table; a page that
``site_walk.fillings`` does not know fails."""

import re
from functools import cache
from typing import NamedTuple

import pytest
from site_policy import POLICY, faults_of
from site_walk import MAX, TEACHER, ZOE, Filled, Scripts, filled, fillings, text_of
from tables import each_row

from coursework.database.permissions import Permission, is_of_staff
from coursework.site.application import ROUTES

every_page = each_row("page", ROUTES)
posting = each_row("page", [page for page in ROUTES if page.takes_forms])
BROKEN = 500


@pytest.fixture(scope="session")  # a module's is made anew where another process takes some of its tests
def site(tmp_path_factory):
    return Filled(f"sqlite:///{tmp_path_factory.mktemp('walk')}/site.db")


def address_of(site, page, *, others=False):
    known = fillings(site)
    assert page.path in known, (
        f"{page.path} is new: say in tests/site_walk.py how it is filled in, and whose it is"
    )
    told = known[page.path]
    return filled(page.path, told.others if others and told.others is not None else told.own)


class Replies(NamedTuple):
    """What a page answers to nobody, a student and an administrator; what they are shown after it; what an
    odd request is told."""

    shown: dict
    later: list
    odd: list


@pytest.fixture(scope="session")
def replies(site):
    """The replies of a page, asked for once by all tests."""
    known = {}
    return lambda page: known.get(page.path) or known.setdefault(page.path, asked(site, page))


def asked(site, page):
    """A reply of each sort: shown, refused, not there, too large, odd; what nobody is told who asks oddly:
    test_headers.py."""
    address = address_of(site, page)
    browsers = {name: site.browser(name, "fr" if name == ZOE else "en") for name in (None, ZOE, TEACHER)}
    headers = {None: {"origin": "https://evil.example"}}
    shown = {name: one.get(address, headers=headers.get(name)) for name, one in browsers.items()}
    later = [browsers[name].get("/progress") for name in (ZOE, TEACHER)]
    browser, form = browsers[TEACHER], {"content-type": "multipart/form-data; boundary=x"}
    odd = [
        browser.get(address + "/no/such/page"),
        browser.get(address, headers={"host": "evil.example"}),
        browser.get(address, headers={"host": "["}),
        browser.put(address),
        browser.post(address, content=b"", headers={"content-length": "99999999999"}),
        browser.post(address, content=b"\xff\xfe", headers=form),
    ]
    return Replies(shown, later, odd)


def test_every_address_is_listed_once():
    assert len({page.path for page in ROUTES}) == len(ROUTES)


def test_every_page_falls_under_a_limit(site):
    for page in ROUTES:
        site.site.limits.wait_for_rate(page.limit, 1, "192.0.2.1")
        assert 0 < page.request_budget.largest <= 64 * 1024 * 1024


# ----------------------------------------------------------------------- who may


@every_page
def test_nobody_sees_only_what_is_public(site, replies, page):
    reply = replies(page).shown[None]
    if page.permission is Permission.PUBLIC:
        assert reply.status_code < BROKEN
    else:
        assert (reply.status_code, reply.headers["location"].partition("?")[0]) == (303, "/sign-in")
        assert site.browser().fill(address_of(site, page)).status_code in (401, 405)


@every_page
def test_a_student_sees_no_page_of_the_staff(site, replies, page):
    reply = replies(page).shown[ZOE]
    if is_of_staff(page.permission):
        assert reply.status_code == 403
        assert site.browser(ZOE).fill(address_of(site, page)).status_code in (403, 405)
    else:
        assert reply.status_code not in (401, 403), reply.text
        assert reply.status_code < BROKEN


@every_page
def test_a_student_sees_nothing_of_another(site, page):
    if page.permission is not Permission.OWN or fillings(site)[page.path].others is None:
        return
    theirs = address_of(site, page, others=True)
    assert site.browser(ZOE).get(theirs).status_code in (403, 404, 405)
    if page.takes_forms:
        assert site.browser(ZOE).fill(theirs).status_code in (403, 404)


@every_page
def test_an_administrator_may(replies, page):
    reply = replies(page).shown[TEACHER]
    assert reply.status_code not in (401, 403), reply.text
    assert reply.status_code < BROKEN


@every_page
@each_row("name", [None, ZOE])
def test_no_reply_holds_what_is_not_for_them(site, page, name):
    """Neither an answer before its time, nor anything of another student, wherever they stand; whatever is
    asked."""
    browser, places = site.browser(name), fillings(site)[page.path]
    for others in (False, True) if places.others is not None else (False,):
        for ask in ("get", "fill"):
            text = text_of(getattr(browser, ask)(address_of(site, page, others=others)))
            told = [
                secret
                for secret in site.secrets(MAX)
                if re.search(rf"(?<!\w){re.escape(secret)}(?!\w)", text)
            ]
            assert not told
            if "answers" not in places.holds:
                assert not [
                    text[max(0, found.start() - 40) : found.end() + 10]
                    for who in (ZOE, MAX)
                    for one in site.answers(who)
                    if (found := one.search(text))
                ]


@every_page
def test_what_is_practised_is_no_variant_that_was_issued(site, page):
    """Or the worked solution of a paper could be had before its time."""
    if "{seed}" not in page.path:
        return
    for name in (ZOE, MAX):
        places = {**fillings(site)[page.path].own, "seed": str(site.variants[name].record["seed"])}
        for ask in ("get", "fill"):
            text = text_of(getattr(site.browser(ZOE), ask)(filled(page.path, places)))
            assert not [one.pattern for one in site.answers(name) if one.search(text)]


# ------------------------------------------------------------------------- forms


@every_page
def test_no_link_signs_anybody_in_or_out(replies, page):
    assert not [name for name in (ZOE, TEACHER) if "set-cookie" in replies(page).shown[name].headers]
    assert [reply.status_code for reply in replies(page).later] == [200, 200]


@pytest.fixture(scope="module")
def browsers_of(site):
    """Two browsers of somebody, and one of another student between them."""
    return cache(lambda name: [site.browser(who) for who in (name, MAX, name)])


@posting
@each_row("name", [ZOE, TEACHER])
def test_no_form_is_taken_without_its_seal(site, browsers_of, page, name):
    if is_of_staff(page.permission) and name == ZOE:
        return
    address, (browser, others, again) = address_of(site, page), browsers_of(name)
    seal, others, again = browser.seal, others.seal, again.seal
    for told in (
        {},
        {"_seal": ""},
        {"_seal": others},
        {"_seal": again},
        {"_seal": seal[:-1] + ("1" if seal[-1] == "0" else "0")},
        {"_seal": "é" * 64},
    ):
        assert browser.post(address, data=told).status_code == 403, told
        assert (
            browser.post(
                address, data={"x": "y"}, headers={"x-seal": told.get("_seal", "").encode("latin-1")}
            ).status_code
            == 403
        )


@posting
def test_no_form_is_taken_from_elsewhere(site, page):
    browser = site.browser(TEACHER)
    told = {"_seal": browser.seal}
    for headers in (
        {"origin": "https://evil.example"},
        {"origin": "null"},
        {"origin": "https://127.0.0.1:8000"},
        {"origin": "http://["},
        {"origin": "http://127.0.0.1:8001"},
        {"sec-fetch-site": "cross-site"},
        {"sec-fetch-site": "same-site"},
    ):
        assert browser.post(address_of(site, page), data=told, headers=headers).status_code == 403, headers


# ------------------------------------------------------------------------ headers


@every_page
@pytest.mark.e2e
def test_every_reply_says_what_a_browser_may_do_with_it(replies, page):
    for reply in (*replies(page).shown.values(), *replies(page).odd):
        assert faults_of(reply, POLICY) == [], reply.request
        assert "immutable" not in reply.headers["cache-control"] or "set-cookie" not in reply.headers
        assert reply.status_code != BROKEN, reply.request


@every_page
def test_every_text_says_its_letters_and_no_reply_is_for_other_origins(replies, page):
    for reply in (*replies(page).shown.values(), *replies(page).odd):
        kind = reply.headers.get("content-type", "")
        is_text = kind.startswith("text/") or kind.partition(";")[0].endswith("xml")
        assert not is_text or "charset=utf-8" in kind, kind
        assert kind or not reply.content
        assert not [header for header in reply.headers if header.startswith("access-control-")]


@every_page
def test_no_page_runs_what_stands_in_it_or_asks_another_host(replies, page):
    for reply in (*replies(page).shown.values(), *replies(page).odd):
        if not reply.headers.get("content-type", "").startswith("text/html"):
            continue
        found = Scripts(reply.text)
        assert not found.inline
        assert not found.handlers
        for address in found.addresses:
            assert re.match(r"(/(?!/)|#|\?|data:image/|[\w.-]+$|$)", address), address
        styles = re.findall(r"url\(\s*(?!['\"]?(?:data:|#))([^)]*)", reply.text)
        assert not styles
        beyond = set(re.findall(r"https?://[^\s\"'<>]+", reply.text))
        assert all(one.startswith(("http://www.w3.org/", "http://127.0.0.1:8000")) for one in beyond), beyond
