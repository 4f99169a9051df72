"""A site of the built-in course with an instructor and students, and browsers without a browser, each signed
in as somebody."""

import re
import shutil
import tempfile
from contextlib import contextmanager
from datetime import UTC, datetime
from functools import cache
from pathlib import Path

from site_client import Client
from sqlalchemy import event

from coursework import open_course
from coursework.database.people import put_account, put_person
from coursework.database.sessions import begin_session
from coursework.database.store import Store
from coursework.issuing.students import folded
from coursework.site.application import application
from coursework.site.frame import pool
from coursework.site.frame.cookies import COOKIE, Cookies, Session
from coursework.site.frame.settings import Entrance, Site
from coursework.site.lessons import lesson_content

#: What one site finds of the built-in course, another finds as well; a lesson is rendered in a process that
#: begins for it.
pool._drawn = cache(pool._drawn)
lesson_content._rendered = cache(lesson_content._rendered)

HOME = "http://127.0.0.1:8000"
ZOE, MAX, TEACHER = "Zoé", "Max", "Ada Teacher"


def signed_in(store, person):
    """The cookie of a browser in which a person has just signed in."""
    with store.begin() as connection:
        return begin_session(connection, person, "Firefox, Linux", datetime.now(UTC))


def seal_of(site, cookie):
    """A CSRF token that goes with a cookie."""
    return Cookies(site.secret).csrf_token(Session(cookie))


@contextmanager
def statements(store):
    """The statements of the block, in order, with ``CONNECTION`` wherever a connection is taken."""
    found = []

    def note(connection, cursor, text, *more):
        found.append(text)

    def take(*more):
        found.append("CONNECTION")

    event.listen(store.engine, "before_cursor_execute", note)
    event.listen(store.engine, "checkout", take)
    try:
        yield found
    finally:
        event.remove(store.engine, "before_cursor_execute", note)
        event.remove(store.engine, "checkout", take)


def count_of(found):
    """How many statements read or write, and how many transactions write; without a lock of SQLite."""
    ends = ("BEGIN", "CONNECTION")
    return (
        sum(not text.startswith(ends) for text in found),
        sum(text.startswith("BEGIN IMMEDIATE") for text in found),
    )


def put_people(store):
    """Put three people with accounts into a database; return their numbers."""
    ids = {}
    with store.begin() as connection:
        for name, role in ((ZOE, "student"), (MAX, "student"), (TEACHER, "administrator")):
            ids[name] = put_person(connection, identifier=folded(name), name=name, lang="", columns={})
            put_account(connection, ids[name], login=f"{name.split()[0].lower()}@example.org", role=role)
    return ids


@cache
def pristine():
    """A database with the three people, and their numbers: copied, since making one takes longer than many
    tests."""
    path = Path(tempfile.mkdtemp()) / "site.db"
    store = Store(f"sqlite:///{path}")
    ids = put_people(store)
    store.scrub()
    store.close()
    return path, ids


class Browser(Client):
    """Follows no address by itself; ``fill`` fills in the seal of the page's forms, and sees how answers are
    read."""

    def __init__(self, app, lang):
        super().__init__(app, base_url=HOME, headers={"accept-language": lang})

    _seal = ("", "")

    @property
    def seal(self):
        """The CSRF token of the forms, from a page; it stays while the cookie does."""
        cookie = self.cookies.get(COOKIE, "")
        if not cookie or self._seal[0] != cookie:
            found = re.search(r'X-Seal": "([0-9a-f]{64})"', self.get("/no-such-page").text)[1]
            self._seal = self.cookies.get(COOKIE, ""), found
        return self._seal[1]

    def fill(self, address, data=None, **more):
        reply = self.post(address, data={"_seal": self.seal, **(data or {})}, **more)
        where = reply.headers.get("location", "")
        return self.get(where) if where.endswith("/read-back") else reply


class Class:
    """A site with three people; ``at`` is what its clock says."""

    def __init__(self, url, entrance=Entrance.ACCOUNTS):
        self.at = datetime(2026, 11, 23, 9, tzinfo=UTC)
        path = Path(url.removeprefix("sqlite:///"))
        is_new_file = url.startswith("sqlite:///") and not path.exists()
        if is_new_file:
            shutil.copy(self.copied()[0], path)
        self.site = Site(open_course(), Store(url), entrance, HOME, lambda: self.at)
        self.app = application(self.site)
        self.ids = dict(self.copied()[1] if is_new_file else put_people(self.site.store))

    def copied(self):
        """The database that a new one is copied from, and the numbers of its people."""
        return pristine()

    @classmethod
    def of(cls, other):
        """Another process of the same site, with the people of the first."""
        found = cls.__new__(cls)
        found.at, found.ids = other.at, other.ids
        found.site = Site(
            other.site.course, Store(other.site.store.url), other.site.entrance, HOME, other.site.clock
        )
        found.app = application(found.site)
        return found

    def again(self):
        """The same site, begun once more."""
        self.app = application(self.site)
        return self

    def browser(self, name=None, lang="en"):
        """A browser of somebody; of nobody unless told."""
        found = Browser(self.app, lang)
        if name is not None:
            found.cookies.set(COOKIE, signed_in(self.site.store, self.ids[name]))
        return found
