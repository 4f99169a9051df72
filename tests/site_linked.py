"""A site with a learning platform in front of it."""

import shutil
from dataclasses import asdict, replace

from lti_platform import PLATFORM, TOOL, FakePlatform, Visitor, _made_keys
from site_assignments import ASSIGNMENT, USUAL, dealt, right
from site_people import Class
from sqlalchemy import select, update

from coursework.database.assignments import issued_of
from coursework.database.publication import AT_ONCE, publish
from coursework.database.tables import assignment
from coursework.lti.keys import KeyFolder
from coursework.lti.settings import Settings
from coursework.site.application import application
from coursework.site.desk.class_cache import class_now
from coursework.site.desk.class_page import rows
from coursework.site.lti.mount import mounted

AT_ONCE_TOLD = replace(USUAL, feedback=AT_ONCE)


class Linked(Class):
    """A site with a platform in front; its assignment is dealt to Zoé and Max."""

    def __init__(self, folder, publication=AT_ONCE_TOLD, platform=PLATFORM):
        super().__init__(f"sqlite:///{folder}/site.db")
        self.platform, self.site.lti = FakePlatform(), folder / "lti"
        keys = KeyFolder(self.site.lti / "keys")
        shutil.copytree(_made_keys(), keys.folder)
        self.platform.tool_keys = lambda: keys.public
        self.lti = mounted(
            self.site,
            self.site.lti,
            self.platform.client,
            Settings(self.site.lti, f"{TOOL}/lti", (platform,)),
        )
        self.app = application(self.site, self.lti)
        self.number = dealt(self, publication)
        with self.site.store.begin() as connection:
            connection.execute(update(assignment).values(asked=_table()))

    def visitor(self):
        return Visitor(self.app, self.platform, "/lti")

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
        self.lti.state.sender.send_due()
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
        "title": dict(ASSIGNMENT.title), "instructions": dict(ASSIGNMENT.instructions), "exercises": exercises,
        "mark": asdict(ASSIGNMENT.mark),
    }  # fmt: skip
