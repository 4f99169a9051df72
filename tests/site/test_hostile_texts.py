"""Whatever a student, a roster or a platform writes, it is shown as it is: nothing of it runs, loads or
breaks a page."""

import csv
import io
import re
from urllib.parse import quote, urlencode

import pytest
from desk_class import EXERCISE, SEED, STATED
from hostile_texts import ALL, FORMULAS, HOST, IN_PAGES
from site_browser import chromium, context_of, served
from site_people import TEACHER, Class
from site_walk import Patient, Scripts
from sqlalchemy import select
from tables import each_row

from coursework.database.assignments import put_issued
from coursework.database.decisions import decide
from coursework.database.marking import mark_new
from coursework.database.people import put_account
from coursework.database.publication import AT_ONCE, Publication, publish
from coursework.database.submissions import insert_submission
from coursework.database.tables import person
from coursework.gradebook.decisions import Decision
from coursework.gradebook.rows import AnswerRow, Rejected
from coursework.site.frame.forms import clean

pytestmark = pytest.mark.e2e


class Hostile(Class):
    """A student for each hostile text: it is their name, number, group and e-mail, their answers, and the
    name of their file."""

    def __init__(self, url, texts=ALL):
        super().__init__(url)
        self.site.limits = Patient()
        self.variant = self.site.course[EXERCISE].variant(SEED, "en")
        parts = [one.id for one in self.variant.parts]
        self.texts = [clean(text) for text in texts]
        self.names = [f"{k} {text}" for k, text in enumerate(self.texts)]
        columns = {
            name: {"number": f"{text} {k}", "group": text, "e-mail": f"{text}@{k}", text: text}
            for k, (name, text) in enumerate(zip(self.names, self.texts, strict=True))
        }
        stated = {
            **STATED,
            "title": {"en": self.texts[0] + self.texts[9]},
            "course": {"": self.texts[0]},
            "identity": ["number", "group"],
        }
        content = {
            "format": 1,
            "roster": True,
            "assignment": stated,
            "students": columns,
            "issued": [{"student": name, "record": self.variant.record} for name in self.names],
        }
        rows = []
        for name, text in zip(self.names, self.texts, strict=True):
            rows += [AnswerRow(name, EXERCISE, str(SEED), part, text, text) for part in parts[:3]]
            rows.append(
                Rejected(
                    text,
                    text,
                    {"student": text, "exercise": text, "seed": text, "part": text, "answer": text},
                )
            )
        with self.site.store.begin() as connection:
            self.number = put_issued(connection, content)
            publish(connection, self.number, Publication(tries=None, feedback=AT_ONCE, answers=AT_ONCE))
            insert_submission(connection, self.number, rows, source=self.texts[0], received_at=self.at)
            for place, name in zip(self.texts, self.names, strict=True):
                told = "given", 0.0, place, place, TEACHER
                decide(connection, self.number, [Decision(name, EXERCISE, str(SEED), parts[0], *told)])
            dealt = {row.name: row.id for row in connection.execute(select(person))}
            self.ids |= {name: dealt[name] for name in self.names}
            for k, name in enumerate(self.names):
                put_account(connection, self.ids[name], login=f"{k}{name}", role="student")
        mark_new(self.site.course, self.site.store, self.number)

    def desk(self):
        """The pages of the staff on which these texts stand."""
        home, first = f"/desk/{self.number}", self.variant.parts[0].id
        return [
            "/desk",
            "/desk/people",
            "/desk/audit",
            "/desk/assignments",
            home,
            f"{home}/questions",
            f"{home}/files",
            f"{home}/report",
            f"{home}/regrade",
            f"{home}/after",
            f"{home}/queue",
            f"{home}/queue?why=rejected",
            f"/desk/assignments/{self.number}",
            f"{home}/question?{urlencode({'exercise': EXERCISE, 'part': first})}",
            f"/desk/assignments/{self.number}/preview",
            "/desk/assignments/new",
        ]

    def of(self, name):
        """The pages of the staff on one student."""
        own = self.ids[name]
        return [
            f"/desk/{self.number}/student?name={quote(name)}",
            f"/desk/people/{own}",
            f"/desk/people/{own}/erase",
            f"/desk/assignments/{self.number}/as/{own}",
        ]

    def cards(self):
        """Each card of the queue."""
        from coursework.site.desk.class_cache import class_now

        found = [
            *class_now(self.site, self.number).open,
            *(f"r{one.id}" for one in class_now(self.site, self.number).named),
        ]
        why = {False: "", True: "&why=rejected"}
        return [f"/desk/{self.number}/queue?at={quote(one)}{why[one.startswith('r')]}" for one in found]


@pytest.fixture(scope="module")
def hostile(tmp_path_factory):
    return Hostile(f"sqlite:///{tmp_path_factory.mktemp('hostile')}/site.db")


def held(page):
    """What of a page comes of a text that was shown as HTML."""
    found = Scripts(page)
    tags = re.findall(
        r"<(iframe|object|embed|base|marquee|xss|noscript|video|template|link|meta)\b([^>]*)", page
    )
    odd = [tag for tag, rest in tags if tag not in ("link", "meta") or HOST in rest or "refresh" in rest]
    led = [a for a in found.addresses if not re.match(r"/(?!/)|#|\?|data:image/|$", a)]
    return [*found.inline, *found.handlers, *odd, *led]


@each_row("lang", ["fr", "en"])
def test_no_page_of_the_staff_holds_a_text_as_html(hostile, lang):
    browser = hostile.browser(TEACHER, lang)
    for address in [*hostile.desk(), *hostile.of(hostile.names[0]), *hostile.cards()[:3]]:
        reply = browser.get(address)
        assert reply.status_code == 200, (address, reply.status_code)
        assert held(reply.text) == [], address


def test_tables_hold_no_formula_that_calls(hostile):
    browser = hostile.browser(TEACHER)
    for name in ("marks.csv", "summary.csv", "rejected.csv", "decisions.csv", "answers.csv"):
        text = browser.get(f"/desk/{hostile.number}/files/{name}").content.decode("utf-8-sig")
        rows = list(csv.reader(io.StringIO(text, newline="")))
        assert len(rows) > len(FORMULAS)
        assert not [c for row in rows for c in row if re.match(r"\s*[=+@-].*[(|!]", c)], name


def test_names_of_files_stay_within_their_header(hostile):
    browser = hostile.browser(TEACHER)
    for name in hostile.names[:: max(1, len(hostile.names) // 12)]:
        reply = browser.get(f"/desk/people/{hostile.ids[name]}/data")
        assert reply.status_code == 200
        assert re.fullmatch(
            r"attachment; filename=\"[\w ().-]*\"; filename\*=UTF-8''[\w%.~-]*",
            reply.headers["content-disposition"],
        )


def watched_page(context, url, ran):
    """A page that notes each dialog, and each request that leaves the site."""
    page = context.new_page()

    def asked(one):
        if not one.url.startswith((url, "data:")):
            ran.append((page.url, one.url))

    def opened(one):
        ran.append((page.url, one.message))
        one.dismiss()

    page.on("dialog", opened)
    page.on("request", asked)
    return page


@pytest.mark.slow
def test_nothing_of_a_text_runs_or_loads_in_a_browser(hostile):
    """In Chromium, without the policy that would forbid it: every card, every student, every page of the
    desk."""
    ran = []
    with served(hostile) as url, chromium() as browser:
        for who, addresses in (
            (
                TEACHER,
                [
                    *hostile.desk(),
                    *hostile.cards(),
                    *(a for name in hostile.names for a in hostile.of(name)[:1]),
                ],
            ),
            *((name, ["/assignments", "/account"]) for name in hostile.names[:3]),
        ):
            context = context_of(browser, hostile, url, who, "en", "desk", bypass_csp=True)
            page = watched_page(context, url, ran)
            for address in addresses:
                page.goto(url + address)
                page.wait_for_timeout(30)
                assert page.evaluate(
                    "!document.querySelector('iframe, object, embed, base, [onerror], [onload], "
                    "a[href^=javascript]')"
                )
            context.close()
    assert ran == []
    assert len(IN_PAGES) >= 60
