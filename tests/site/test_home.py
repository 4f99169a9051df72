"""The first page, the language, the shared files, and who may send a form."""

import re
from pathlib import Path

import pytest
from site_people import TEACHER, ZOE, Class
from tables import each_row

from coursework.site.frame.pages import STATIC
from coursework.site.frame.settings import Entrance

TEMPLATES = Path(__file__).parents[2] / "templates"


@pytest.mark.parametrize(("name", "goes"), [(None, "/sign-in"), (ZOE, "/practice"), (TEACHER, "/desk")])
def test_the_first_page_leads_on(class_of_three, name, goes):
    reply = class_of_three.browser(name).get("/")
    assert (reply.status_code, reply.headers["location"]) == (303, goes)


def test_the_language_is_the_browsers_until_another_is_chosen(class_of_three):
    browser = class_of_three.browser(ZOE, "fr-FR,fr;q=0.9")
    assert 'lang="fr"' in browser.get("/no-such-page").text
    browser.fill("/language", {"back": "/practice"})
    assert 'lang="en"' in browser.get("/no-such-page").text


@each_row("back", ["https://evil.example", "//evil.example", "/\\evil.example", "practice"])
def test_no_form_leads_away(class_of_three, back):
    assert class_of_three.browser(ZOE).fill("/language", {"back": back}).headers["location"] == "/"


def test_a_form_without_its_seal_or_from_elsewhere_is_refused(class_of_three):
    browser = class_of_three.browser(ZOE)
    seal = browser.seal
    assert browser.post("/sign-out", data={}).status_code == 403
    assert browser.post("/sign-out", data={"_seal": class_of_three.browser(TEACHER).seal}).status_code == 403
    elsewhere = {"origin": "https://evil.example"}
    assert browser.post("/sign-out", data={"_seal": seal}, headers=elsewhere).status_code == 403
    assert browser.post("/sign-out", data={"_seal": seal}).status_code == 303


def test_a_name_that_is_not_ours_leads_nowhere(class_of_three):
    assert class_of_three.browser(ZOE).get("/", headers={"host": "evil.example"}).status_code == 421


@pytest.mark.parametrize(
    "name", ["look.css", "sheet.css", "site.css", "basis.js", "answering.js", "htmx.min.js"]
)
def test_shared_files_are_kept_by_browsers(class_of_three, name):
    reply = class_of_three.browser().get(f"/static/{name}")
    assert (reply.status_code, "immutable" in reply.headers["cache-control"]) == (200, True)


def test_joined_files_hold_each_of_theirs_without_comments(class_of_three):
    pages = class_of_three.site.pages
    names = {
        "look.css": ["fonts.css", "sheet.css", "site.css", "motion.css", "dark.css"],
        "answering.js": ["practice.js", "sheet.js", "cells.js", "keys.js", "keeping.js"],
        "drawing_graph.js": ["toolbar.js", "surface_graph.js", "surface.js"],
    }
    for joined, parts in names.items():
        assert pages.static(joined)[1] == b"\n".join(pages.static(part)[1] for part in parts)
    surface = pages.static("surface.js")[1]
    assert not re.search(rb"^(//|[ \t])", surface, re.MULTILINE)
    assert b"use strict" in surface
    assert pages.static("answering") is None


def test_no_text_in_a_script_is_broken_over_lines():
    """They are sent without indentation, which would be missing in it."""
    scripts = [one for folder in (STATIC, TEMPLATES) for one in folder.rglob("*.js")]
    lines = [(one.name, line) for one in scripts for line in one.read_text().splitlines()]
    assert [(name, line) for name, line in lines if line.count("`") % 2] == []


def test_who_one_is_is_chosen_in_a_demonstration_alone(class_of_three):
    assert class_of_three.browser().get("/who").status_code == 404
    class_of_three.site.entrance = Entrance.DEMO
    browser = class_of_three.browser()
    assert browser.fill("/who", {"person": str(class_of_three.ids[ZOE])}).status_code == 303
    assert browser.get("/").headers["location"] == "/practice"


@pytest.mark.parametrize("header", ["x-forwarded-for", "forwarded", "x-real-ip", "x-forwarded-host"])
def test_a_proxy_in_front_makes_nobody_the_owner(class_of_three, header):
    class_of_three.site.entrance = Entrance.LOCAL
    assert class_of_three.browser().get("/desk/people").status_code == 200
    reply = class_of_three.browser().get("/desk/people", headers={header: "192.0.2.7"})
    assert reply.status_code == 421
    assert "set-cookie" not in reply.headers


def test_a_course_that_one_process_takes_anew_is_taken_by_all(class_of_three):
    """Or a corrected solution would mark for some, and not for others."""
    other = Class(str(class_of_three.site.store.url))
    before = other.site.course
    assert other.browser(ZOE).get("/").status_code == 303
    assert other.site.course is before
    class_of_three.site.take(class_of_three.site.reopened())
    assert other.browser(ZOE).get("/").status_code == 303
    assert other.site.course is not before
    assert other.site.course.folder.root == before.folder.root
