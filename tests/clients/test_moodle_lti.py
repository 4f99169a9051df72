"""Links of a site against a real Moodle, in a real browser: a link is picked, opened, answered, and the
points arrive.

``COURSEWORK_MOODLE``: the folder of Moodle's code, with its ``config.php``; the site is up, on this machine.
``COURSEWORK_CHROMIUM``: the program of a Chromium; Playwright for Python drives it. ``COURSEWORK_PICTURES``:
a folder for pictures of the pages, where they are wanted; with ``COURSEWORK_MOODLE_ADMIN``, name and password
of the administrator as ``admin:…``, that of the registration page too.

The tests make a course, its people and a tool of their own, and take them away. Moodle asks no address of
this machine, so two of its settings are emptied meanwhile: for tests on one's own machine, and never on a
site that others use.
"""

import contextlib
import json
import os
import re
import socket
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

import pytest
from sqlalchemy import select

import coursework
from coursework.database.store import Store
from coursework.database.tables import variant
from coursework.issuing.roster import read_roster

MOODLE, CHROMIUM = os.environ.get("COURSEWORK_MOODLE", ""), os.environ.get("COURSEWORK_CHROMIUM", "")
PICTURES, ADMIN = os.environ.get("COURSEWORK_PICTURES", ""), os.environ.get("COURSEWORK_MOODLE_ADMIN", "")
COURSE, PASSWORD, NAME = "coursework_lti", "Lti.12345", "slotted_mechanism"
_SCRIPT = Path(__file__).with_name("moodle_lti.php")
_COMMAND = [sys.executable, "-P", "-c", "import sys; from coursework.cli import main; main()"]

pytestmark = pytest.mark.skipif(
    not (MOODLE and CHROMIUM),
    reason="COURSEWORK_MOODLE and COURSEWORK_CHROMIUM name no Moodle and no Chromium",
)


def ask(verb, **what):
    command = ["php", "-d", "max_input_vars=5000", "-d", "memory_limit=1G", str(_SCRIPT), verb]
    done = subprocess.run(command, input=json.dumps(what), capture_output=True, text=True, check=False)
    assert not done.returncode, done.stderr[-2000:] + done.stdout[-2000:]
    return json.loads(done.stdout.splitlines()[-1])


def command(folder, *arguments):
    done = subprocess.run([*_COMMAND, *arguments], cwd=folder, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def lti(folder, *arguments):
    return command(folder, "lti", *arguments)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """A Moodle with a course of ours, and the service running beside it."""
    root = re.search(r"wwwroot\s*=\s*'([^']+)'", (Path(MOODLE) / "config.php").read_text("utf-8"))[1]
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    home, folder = f"http://localhost:{port}", tmp_path_factory.mktemp("lti")
    url = f"{home}/lti"
    made = ask("prepare", course=COURSE, url=url, password=PASSWORD)
    kept, service = ask("open"), None
    try:
        assert lti(folder, "keys", "new")[0] == 0
        told = ["--client-id", made["client_id"], "--deployment", made["deployment"]]
        assert lti(folder, "platform", "moodle", root, "--url", url, *told)[0] == 0
        serving = ["serve", "--lti", "lti", "--port", str(port), "--url", home]
        assert command(folder, *serving, "--administrator", "ada@example.org")[0] == 0
        service = subprocess.Popen([*_COMMAND, *serving], cwd=folder, stderr=subprocess.DEVNULL, text=True)
        _wait_for(f"{url}/jwks")
        yield {"root": root, "url": url, "folder": folder, **made}
    finally:
        if service is not None:
            service.terminate()
            service.communicate(timeout=20)
        ask("close", kept=kept)
        ask("reset", course=COURSE)


def _wait_for(url):
    for _ in range(100):
        try:
            return urllib.request.urlopen(url, timeout=2).read()
        except OSError:
            time.sleep(0.2)
    raise AssertionError(f"nothing at {url}")


@pytest.fixture(scope="module", params=["cookies", "no cookies of other sites"])
def chromium(request):
    from playwright.sync_api import sync_playwright

    strict = ["--test-third-party-cookie-phaseout"] if request.param != "cookies" else []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", *strict])
        yield browser
        browser.close()


class Person:
    """Somebody's browser, logged in."""

    def __init__(self, chromium, site, who, password=PASSWORD, width=1280, height=1000):
        from playwright.sync_api import Error

        self.site = site
        self.page = chromium.new_context(
            viewport={"width": width, "height": height}, locale="en-GB"
        ).new_page()
        self.page.set_default_timeout(60_000)
        for _ in range(4):  # a site that others use at once may take the form and not answer
            self.page.goto(f"{site['root']}/login/index.php", wait_until="domcontentloaded")
            if not self.page.query_selector("#username"):
                break
            self.page.fill("#username", who)
            self.page.fill("#password", password)
            with contextlib.suppress(Error):
                self.page.click("#loginbtn", timeout=10_000)
                self.page.wait_for_url(lambda url: "/login/" not in url, wait_until="commit", timeout=10_000)
                break

    def open(self, title, lang="en"):
        """The tool's page within a link of the course."""
        self.page.goto(f"{self.site['root']}/course/view.php?id={self.site['course']}&lang={lang}")
        # A tour of Moodle may stand before the link.
        self.page.goto(self.page.get_attribute(f'a.aalink:has-text("{title}")', "href"))
        return self.tool()

    def tool(self, selector="h1"):
        """The frame of the tool, once it shows something."""
        from playwright.sync_api import Error

        for _ in range(150):
            with contextlib.suppress(Error):  # it goes from one page to another
                for frame in self.page.frames:
                    if frame.url.startswith(f"{self.site['url']}/at/") and frame.query_selector(selector):
                        frame.wait_for_load_state()
                        return frame
            self.page.wait_for_timeout(200)
        raise AssertionError([frame.url for frame in self.page.frames])

    def picture(self, name, **how):
        path = Path(PICTURES) / name
        if PICTURES and not path.exists():
            self.page.screenshot(path=str(path), **how)


def variant_on(site, frame):
    """The variant of a page, as it was issued."""
    seed = re.search(rf"{NAME} · (\d+)", frame.inner_text("main"))[1]
    with Store(str(site["folder"] / "coursework.db")).reading() as connection:
        record = connection.execute(select(variant.c.record).where(variant.c.seed == seed)).scalars().first()
    return coursework.open_course()[NAME].from_record(record)


def answer(site, frame, wrong=()):
    variant = variant_on(site, frame)
    found = variant.solution()
    for part in variant.parts:
        value = found[part.quantity]
        if part.choices:
            frame.check(f"input[name='e1-{part.id}'][value='{variant.letters(part)[value]}']")
        else:
            frame.fill(
                f"input[name='e1-{part.id}']",
                f"{value * (-1 if part.id in wrong else 1):.6g}".replace(".", ","),
            )
    return sum(part.points for part in variant.parts)


def arrived(person, wanted=lambda grade: True):
    """The grade of a person that is wanted, once Moodle has it."""
    for _ in range(60):
        given = [
            one for one in ask("grades", course=COURSE) if one["type"] == "mod" and one["user"] == person
        ]
        if found := next((one for one in given if one["grade"] is not None and wanted(one)), None):
            return found
        time.sleep(0.5)
    raise AssertionError(given)


def test_moodle_gives_its_keys_and_a_token(site):
    status, told = lti(site["folder"], "platform", "--check")
    assert status == 0, told


def test_a_link_is_picked_opened_answered_and_graded(site, chromium):
    teacher = Person(chromium, site, f"{COURSE}_teacher")
    teacher.page.goto(
        f"{site['root']}/course/modedit.php?add=lti&type=0&course={site['course']}&section=1&typeid={site['type']}"
    )
    teacher.page.click("text=Select content")
    frame = teacher.tool()
    frame.fill("#q", "coulisse")
    frame.click("text=Find")
    frame.wait_for_selector(f"input[value='exercise:{NAME}']")
    frame.check(f"input[value='exercise:{NAME}']")
    frame.fill("input[name=points]", "20")
    frame.fill("input[name=tries]", "3")
    frame.check(f"input[value='exercise:{NAME}']")
    teacher.picture("moodle-pick.png")
    frame.click("text=Use in the course")
    teacher.page.wait_for_function("document.querySelector('#id_name').value != ''")
    title = "Slotted mechanism" + " again" * any(
        one["item"] == "Slotted mechanism" for one in ask("grades", course=COURSE)
    )
    teacher.page.fill("#id_name", title)
    teacher.page.click("#id_submitbutton2")
    teacher.page.wait_for_load_state()

    student = Person(chromium, site, f"{COURSE}_ada")
    frame = student.open(title)
    student.picture("moodle-launch.png")
    worth = answer(site, frame, wrong=["theta4"])
    frame.click("text=Hand in my answers")
    student.tool(".told")
    student.picture("moodle-feedback.png")
    first = arrived(site["people"]["ada"], lambda one: one["item"] == title)
    assert first["max"] == 20
    assert 0 < first["grade"] < 20
    assert "one slip away" in first["feedback"]

    frame = student.tool(".told")
    frame.click("text=Answer again")
    frame = student.tool("form")
    answer(site, frame)
    frame.click("text=Hand in my answers")
    student.tool(".told")
    best = arrived(site["people"]["ada"], lambda one: one["item"] == title and one["grade"] == 20)
    assert best["feedback"].startswith(f"{worth:g} of {worth:g} points (try 2)")

    frame = teacher.open(title)
    told = frame.inner_text("main")
    assert re.search(rf"Ada Byron\s+2\s+{worth:g} / {worth:g}\s+yes", told), told
    assert "Bob Noyce" in told.split("In the course, without a paper")[1]
    teacher.picture("moodle-class.png")
    teacher.page.goto(f"{site['root']}/grade/report/grader/index.php?id={site['course']}")
    teacher.page.add_style_tag(content="[data-flexitour] { display: none !important }")
    teacher.page.wait_for_timeout(1500)
    assert "20.00" in teacher.page.inner_text(".gradeparent")
    teacher.picture("moodle-gradebook.png", clip={"x": 290, "y": 120, "width": 990, "height": 540})


def test_a_student_reads_french_where_moodle_does(site, chromium):
    made = ask(
        "link",
        course=COURSE,
        type=site["type"],
        name=f"Coulisse {time.time_ns() % 10000}",
        custom=f"exercise={NAME}",
        points=9,
    )
    assert made["module"]
    bob = Person(chromium, site, f"{COURSE}_bob", width=390, height=844)
    bob.page.goto(f"{site['root']}/mod/lti/view.php?id={made['module']}&lang=fr")
    frame = bob.tool()
    assert frame.get_attribute("html", "lang") == "fr"
    assert "Remettre mes réponses" in frame.inner_text("main")
    worth = answer(site, frame)
    frame.click("text=Remettre mes réponses")
    bob.tool(".told")
    grade = arrived(site["people"]["bob"])
    assert grade["grade"] == grade["max"]
    assert f"{worth:g} points sur {worth:g}" in grade["feedback"]


def test_the_roster_of_moodle_is_one_that_build_reads(site):
    status, told = lti(site["folder"], "roster", "Mechanics", "--out", "class.csv")
    assert status == 0, told
    assert [one.name for one in read_roster(site["folder"] / "class.csv")] == ["Ada Byron", "Bob Noyce"]


def test_a_key_is_rotated_while_moodle_goes_on(site):
    assert lti(site["folder"], "keys", "rotate")[0] == 0
    status, told = lti(site["folder"], "platform", "--check")
    assert status == 0, told


@pytest.mark.skipif(not (PICTURES and ADMIN), reason="no picture is wanted")
def test_the_registration_page_is_as_the_documentation_shows(site, chromium):
    name, _, password = ADMIN.partition(":")
    admin = Person(chromium, site, name, password, height=1500)
    admin.page.goto(f"{site['root']}/my/")
    admin.page.goto(f"{site['root']}/mod/lti/typessettings.php?action=add&sesskey={_sesskey(admin.page)}")
    told = "https://exercises.example.org/lti"
    admin.page.fill("#id_lti_typename", "Coursework")
    admin.page.fill("#id_lti_toolurl", f"{told}/launch")
    admin.page.select_option("#id_lti_ltiversion", label="LTI 1.3")
    admin.page.select_option("#id_lti_keytype", label="Keyset URL")
    admin.page.fill("#id_lti_publickeyset", f"{told}/jwks")
    admin.page.fill("#id_lti_initiatelogin", f"{told}/login")
    admin.page.fill("#id_lti_redirectionuris", f"{told}/launch")
    admin.page.check("#id_lti_contentitem")
    admin.page.fill("#id_lti_toolurl_ContentItemSelectionRequest", f"{told}/launch")
    admin.picture("moodle-register.png", full_page=True)


def _sesskey(page):
    return page.evaluate("M.cfg.sesskey")
