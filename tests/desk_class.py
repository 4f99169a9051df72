"""A class on the desk: six students with one variant of one exercise, and what each wrote to two of its
questions."""

import re

from site_people import HOME, Class

from coursework.course.answer_key import Key
from coursework.database.assignments import put_issued
from coursework.database.marking import mark_new
from coursework.database.people import put_account, put_person
from coursework.database.submissions import insert_submission
from coursework.gradebook.rows import AnswerRow, Rejected, RowOrigin

EXERCISE, SEED = "slotted_mechanism", 42
STUDENTS = ("Ada", "Bo", "Cy", "Di", "Ed", "Flo")
OTHER = "Emmy Teacher"  #: a second instructor
STATED = {
    "name": "week3",
    "title": {"fr": "Devoir 2", "en": "Midterm 2"},
    "course": {"": "Mechanics"},
    "date": "2026-12-04",
    "duration": {"": "1 h"},
    "mark": {"of": 20, "step": 0.5},
    "identity": ["number"],
    "sittings": "best",
    "answers": "shown",
    "marking": {},
    "exercises": [EXERCISE],
}


class DeskClass(Class):
    """``written`` is by student what they wrote, by part; nothing of who is not in it."""

    def __init__(self, url, written):
        super().__init__(url)
        self.variant = self.site.course[EXERCISE].variant(SEED, "en")
        columns = {
            name: {"number": str(4000 + k), "e-mail": f"{name.lower()}@example.org"}
            for k, name in enumerate(STUDENTS)
        }
        content = {
            "format": 1,
            "roster": True,
            "assignment": STATED,
            "students": columns,
            "issued": [{"student": name, "record": self.variant.record} for name in STUDENTS],
        }
        with self.site.store.begin() as connection:
            self.ids[OTHER] = put_person(connection, identifier=OTHER, name=OTHER, lang="", columns={})
            put_account(connection, self.ids[OTHER], login="emmy@example.org", role="instructor")
            self.number = put_issued(connection, content)
        if written:
            self.hand_in(written)

    def at_margin(self, part, times):
        """A number so many accepted margins from the right one."""
        own, key = next(p for p in self.variant.parts if p.id == part), Key(self.variant)
        return f"{key.reference[own.quantity] + times * key.half_width(own):.10g}"

    def hand_in(self, written, *more, sitting=0):
        """Answers come in, and are marked."""
        origin = RowOrigin(sitting=sitting) if sitting else None
        rows = [
            AnswerRow(name, EXERCISE, str(SEED), part, text, f"answers.csv, line {k}", origin=origin)
            for name, own in written.items()
            for k, (part, text) in enumerate(own.items(), 2)
        ]
        with self.site.store.begin() as connection:
            insert_submission(
                connection, self.number, [*rows, *more], source="answers.csv", received_at=self.at
            )
        mark_new(self.site.course, self.site.store, self.number)

    def page(self, name, end="", lang="en", **query):
        """A page of the assignment, as somebody sees it."""
        return self.browser(name, lang).get(f"/desk/{self.number}{end}", params=query)


def field(page, name):
    """What a hidden field of a page's first form holds."""
    found = re.search(rf'name="{name}" value="([^"]*)"', page.text)
    return found and found[1]


def told(page):
    """What the page says was done."""
    found = re.search(r'class="told">([^<]*)<', page.text)
    return found[1] if found else ""


__all__ = ["EXERCISE", "HOME", "OTHER", "SEED", "STUDENTS", "DeskClass", "Rejected", "field", "told"]
