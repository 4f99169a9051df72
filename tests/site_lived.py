"""The demonstration's class as its people see it: every page that a browser shows, with something on it."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple
from urllib.parse import urlencode

from site_people import HOME, Class
from site_practising import Practising, right_answer
from sqlalchemy import update

from coursework import open_course
from coursework.cli.demo_site import TEACHER, demo_database
from coursework.database.accounts import account_of, set_secret
from coursework.database.assignments import names
from coursework.database.people import people, put_account
from coursework.database.store import Store
from coursework.database.submissions import insert_submission, submissions_of
from coursework.database.tables import person
from coursework.gradebook.rows import Rejected
from coursework.platforms.lti.launch import Launch
from coursework.platforms.lti.roles import Role
from coursework.site.application import application
from coursework.site.frame.settings import Entrance, Site
from coursework.site.lti.connecting import address as connecting_address
from coursework.site.people import accounts, passwords

STUDENT, OTHER = "David O'Neil", "Émilie Lefèvre"
EXERCISE = "slotted_mechanism"
DRAWN = ("coupler_curve", "joint_graph")  #: an exercise for each kind of surface


class Lived(Class):
    """The class of twelve after its first assignment: ``done`` is marked, ``now`` is open.

    One student has practised, has drafts, and an invitation that is not used; a row could not be placed.
    """

    def __init__(self, folder: Path):
        self.at = datetime(2026, 11, 23, 9, tzinfo=UTC)
        self.site = Site(
            open_course(), Store(demo_database(None, folder)), Entrance.ACCOUNTS, HOME, lambda: self.at
        )
        self.app = application(self.site)
        with self.site.store.reading() as connection:
            self.ids = {one.name: one.id for one in people(connection)}
            self.done, self.now = names(connection).values()
            self.receipt = submissions_of(connection, self.done, self.ids[STUDENT])[-1].receipt
        with self.site.store.begin() as connection:  # the student reads in the browser's language
            connection.execute(update(person).where(person.c.id == self.ids[STUDENT]).values(lang=""))
            put_account(connection, self.ids[STUDENT], login="david@example.org", role="student")
            mine = account_of(connection, self.ids[STUDENT])
            set_secret(connection, mine.id, passwords.hashed("a password of the demonstration"))
        self.seed = self._practised()
        self.drawn = [Practising(self, self.browser(STUDENT), name).address for name in DRAWN]
        self.question = self.site.course[EXERCISE].name, "rA"
        row = {"student": OTHER, "answer": "12", "exercise": EXERCISE, "seed": "1", "part": "rA"}
        with self.site.store.begin() as connection:
            lost = [Rejected("answers.csv, line 2", "seed 1 is of no sheet of this student", row)]
            insert_submission(connection, self.done, lost, source="answers.csv", received_at=self.at)
            link = accounts.invited(self.site, connection, self.ids[OTHER], "student5@example.org", "student")
        self.token = link.rpartition("/")[2]

    def _practised(self) -> str:
        """Somebody answers a question right, one wrong, leaves one that cannot be read; gives the variant."""
        sheet = Practising(self, self.browser(STUDENT), EXERCISE)
        first, *others = sheet.variant.parts
        typed = {first.id: right_answer(sheet.variant, first), others[0].id: "1", others[1].id: "12 apples"}
        sheet.send(typed, check="")
        sheet.send(typed, hint=others[0].id)
        return sheet.address.rpartition("/")[2]


class Shown(NamedTuple):
    """A page: its row of the site's table, who looks, and where."""

    path: str
    name: str | None
    address: str


def shown(site: Lived) -> list[Shown]:
    """Every page that a browser shows, as a student, as staff and as nobody."""
    done, now, own = f"/assignments/{site.done}", f"/assignments/{site.now}", site.ids[STUDENT]
    paper, practice = "/assignments/{number:int}", "/practice/{exercise}/{seed}"
    sheet = f"/practice/{EXERCISE}/{site.seed}"
    issued = f"/desk/assignments/{site.now}"
    first = f"/desk/assignments/{site.done}"
    question = urlencode({"exercise": site.question[0], "part": site.question[1]})
    launch = Launch("https://moodle.example", "client", "1", "57", STUDENT, Role.STUDENT, "link")
    students = (
        ("/practice", "/practice"),
        ("/lessons/{lesson}", "/lessons/plane_mechanisms"),
        ("/explore/{exercise}", f"/explore/{EXERCISE}"),
        (practice, sheet),
        *((practice, address) for address in site.drawn),
        (f"{practice}/solution", f"{sheet}/solution"),
        (f"{practice}/motion", f"{sheet}/motion"),
        ("/progress", "/progress"),
        ("/assignments", "/assignments"),
        (paper, now),
        (f"{paper}/feedback", f"{done}/feedback"),
        (f"{paper}/receipts/{{code}}", f"{done}/receipts/{site.receipt}"),
        ("/account", "/account"),
        ("/connect/{token}", connecting_address(site.site, launch, own).removeprefix(site.site.url)),
    )
    of_class = "/desk/{assignment:int}"
    staff = (
        ("/desk", "/desk"),
        ("/desk/people", "/desk/people"),
        ("/desk/semester", "/desk/semester"),
        ("/desk/people/{person}", f"/desk/people/{own}"),
        ("/desk/people/{person}/erase", f"/desk/people/{own}/erase"),
        ("/desk/audit", "/desk/audit"),
        ("/desk/lti", "/desk/lti"),
        ("/mechanisms", "/mechanisms"),
        ("/mechanisms/{name}", "/mechanisms/new"),
        ("/desk/receipts", f"/desk/receipts?code={site.receipt}"),
        ("/desk/assignments", "/desk/assignments"),
        ("/desk/assignments/new", "/desk/assignments/new"),
        ("/desk/assignments/{number:int}", issued),
        ("/desk/assignments/{number:int}", first),
        ("/desk/assignments/{number:int}/preview", f"{issued}/preview"),
        ("/desk/assignments/{number:int}/as/{person:int}", f"{issued}/as/{own}"),
        (of_class, f"/desk/{site.done}"),
        (of_class, f"/desk/{site.now}"),
        (f"{of_class}/queue", f"/desk/{site.done}/queue"),
        (f"{of_class}/queue", f"/desk/{site.done}/queue?why=rejected"),
        (f"{of_class}/queue", f"/desk/{site.now}/queue"),
        (f"{of_class}/student", f"/desk/{site.done}/student?{urlencode({'name': STUDENT})}"),
        (f"{of_class}/questions", f"/desk/{site.done}/questions"),
        (f"{of_class}/questions", f"/desk/{site.now}/questions"),
        (f"{of_class}/question", f"/desk/{site.done}/question?{question}"),
        (f"{of_class}/report", f"/desk/{site.done}/report"),
        (f"{of_class}/files", f"/desk/{site.done}/files"),
        (f"{of_class}/scans", f"/desk/{site.done}/scans"),
        (f"{of_class}/scans/queue", f"/desk/{site.done}/scans/queue"),
        (f"{of_class}/regrade", f"/desk/{site.done}/regrade"),
        (f"{of_class}/after", f"/desk/{site.done}/after"),
    )
    nobody = (
        ("/offline", "/offline"),
        ("/accessibility", "/accessibility"),
        ("/sign-in", "/sign-in"),
        ("/invitation/{token}", f"/invitation/{site.token}"),
    )
    return [
        *(Shown(path, STUDENT, address) for path, address in students),
        *(Shown(path, TEACHER, address) for path, address in staff),
        *(Shown(path, None, address) for path, address in nobody),
    ]


#: What shows no page to who asks for its address: forms that are sent there, files, pieces, ways on.
NO_PAGES = frozenset(
    (
        "/",
        "/language",
        "/who",
        "/sign-out",
        "/account/data",
        "/service-worker.js",
        "/static/{name}",
        "/assignments/{number:int}/read-back",
        "/practice/{exercise}",
        "/practice/{exercise}/{seed}/draft",
        "/practice/{exercise}/{seed}/read",
        "/lessons/{lesson}/figures/{figure}",
        "/lessons/{lesson}/steps/{steps}",
        "/progress/progress.json",
        "/assignments/{number:int}/keep",
        "/assignments/{number:int}/hand-in",
        "/assignments/{number:int}/file",
        "/assignments/{number:int}/{file}",
        "/assignments/{number:int}/receipts/{code}.{ending}",
        "/desk/issued",
        "/assignments/{number:int}/start",
        "/desk/people/add",
        "/desk/people/add-staff",
        "/desk/people/extra-time",
        "/desk/people/{person}/data",
        "/desk/semester.csv",
        *(f"/desk/people/{{person}}/{end}" for end in ("invitation", "role", "separate")),
        "/desk/assignments/dealing/{token}",
        "/desk/{assignment:int}/figure",
        "/desk/{assignment:int}/queue/watch",
        "/desk/{assignment:int}/news",
        "/desk/{assignment:int}/report.pdf",
        "/desk/{assignment:int}/answers",
        "/desk/{assignment:int}/roster",
        "/desk/{assignment:int}/gradebook",
        "/desk/{assignment:int}/feedback",
        "/desk/{assignment:int}/rejected",
        "/desk/{assignment:int}/changes.csv",
        "/desk/{assignment:int}/files/{file}",
        "/desk/{assignment:int}/scans/picture",
        "/desk/{assignment:int}/scans/crop",
        *(
            f"/desk/assignments/{{number:int}}/{end}"
            for end in ("publish", "unpublish", "extend", "roster", "make-up", "issued.json", "sheets")
        ),
    )
)

__all__ = ["EXERCISE", "NO_PAGES", "OTHER", "STUDENT", "TEACHER", "Lived", "Shown", "shown"]
