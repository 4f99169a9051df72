"""A site with a learning platform in front of it."""

import shutil
import tempfile
import time
from dataclasses import asdict, replace
from functools import cache
from pathlib import Path

from lti_platform import PLATFORM, TOOL, FakePlatform, Visitor, _made_keys
from site_assignments import ASSIGNMENT, USUAL, dealt, right
from site_people import Class
from sqlalchemy import select, update

from coursework.database.assignments import issued_of
from coursework.database.publication import AT_ONCE, publish
from coursework.database.store import Store
from coursework.database.tables import assignment
from coursework.platforms.lti.keys import KeyFolder
from coursework.platforms.lti.settings import Settings
from coursework.platforms.lti.storage import Storage
from coursework.site.application import application
from coursework.site.desk.class_cache import class_now
from coursework.site.desk.class_table import rows
from coursework.site.frame.settings import Site
from coursework.site.lti.service import mounted

AT_ONCE_TOLD = replace(USUAL, feedback=AT_ONCE)


@cache
def _pristine():
    """A class whose assignment is dealt and published; its database is copied, since making one takes longer
    than most tests."""
    made = Class(f"sqlite:///{tempfile.mkdtemp()}/site.db")
    made.number = dealt(made, AT_ONCE_TOLD)
    with made.site.store.begin() as connection:
        connection.execute(update(assignment).values(asked=_table()))
    made.site.store.scrub()
    made.site.store.close()
    return made


class Linked(Class):
    """A site with a platform in front; its assignment is dealt to Zoé and Max. ``ahead`` are seconds by which
    the clock of the service is turned."""

    def __init__(self, folder, publication=AT_ONCE_TOLD, platform=PLATFORM):
        made = _pristine()
        shutil.copy(Path(made.site.store.display_name), folder / "site.db")
        self.at, self.ids, self.number = made.at, made.ids, made.number
        self.site = Site(
            made.site.course,
            Store(f"sqlite:///{folder}/site.db"),
            made.site.entrance,
            made.site.url,
            lambda: self.at,
        )
        if publication != AT_ONCE_TOLD:
            self.publish(publication)
        self.platform, self.site.lti, self.ahead = FakePlatform(), folder / "lti", 0.0
        self.settings = Settings(self.site.lti, f"{TOOL}/lti", (platform,))
        self.keys = KeyFolder(self.site.lti / "keys")
        shutil.copytree(_made_keys(), self.keys.folder)
        self.platform.tool_keys = lambda: self.keys.public
        self.storage = Storage(self.site.store, self.clock)
        self.begin()

    def begin(self):
        """Begin the site, or begin it once more."""
        self.lti = mounted(self.site, self.site.lti, self.platform.client, self.settings, self.clock)
        self.app = application(self.site, self.lti)

    def clock(self):
        return time.time() + self.ahead

    @property
    def course(self):
        return self.site.course

    def send(self):
        """How many scores arrived, and how many did not."""
        return self.lti.state.sender.send_due()

    def visitor(self):
        return Visitor(self.app, self.platform)

    def enter(self, visitor=None, **changed):
        visitor = visitor or self.visitor()
        page, path = visitor.enter(**{"custom": {"assignment": "week3"}, **changed})
        return visitor, page, path

    def right(self, name):
        with self.site.store.reading() as connection:
            self.issued = issued_of(connection, self.number)
        return right(self, name)

    def points(self, name):
        return next(row for row in rows(class_now(self.site, self.number)) if row.student == name)

    def one(self, *columns):
        with self.site.store.reading() as connection:
            return connection.execute(select(*columns)).all()

    def sent(self):
        self.send()
        return self.platform.scores

    def publish(self, publication):
        with self.site.store.begin() as connection:
            publish(connection, self.number, publication)


def _table():
    """The assignment as its file says it."""
    exercises = [
        {"name": one.name, **({"parts": list(one.parts)} if one.parts else {})}
        for one in ASSIGNMENT.exercises
    ]
    return {
        "title": dict(ASSIGNMENT.title),
        "instructions": dict(ASSIGNMENT.instructions),
        "exercises": exercises,
        "mark": asdict(ASSIGNMENT.mark),
    }
