"""A site with something of everybody in it, the addresses of all of it, and what may stand on no page of
somebody else."""

from __future__ import annotations

import io
import re
import tempfile
import zipfile
from collections.abc import Mapping
from datetime import timedelta
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from site_people import MAX, TEACHER, ZOE, Class, pristine
from sqlalchemy import update

from coursework.database.assignments import put_issued
from coursework.database.audit import note
from coursework.database.drafts import DraftChange, save
from coursework.database.marking import mark_new
from coursework.database.publication import AT_ONCE, CLOSED, Publication, publish
from coursework.database.submissions import insert_submission
from coursework.database.tables import person
from coursework.gradebook.rows import AnswerRow, RowOrigin
from coursework.site.frame.limits import Limits
from coursework.site.people import accounts

EXERCISE = "slotted_mechanism"
SEEDS = {ZOE: 7300019, MAX: 8400027}  #: of what each was issued; no other number on a page looks like them
PLANTED = {ZOE: "zoespoke", MAX: "maxspoke"}  #: an answer of each that could not be read


class Patient(Limits):
    """Counts, and lets all pass: a walk asks more in a minute than anybody does."""

    def wait_for_rate(self, kind: str, person: int, address: str, browser: str = "") -> int:
        super().wait_for_rate(kind, person, address, browser)
        return 0

    def wait_for_processor(self, kind: str, person: int) -> int:
        return 0


class Filled(Class):
    """Two students with an assignment of one exercise, handed in, and what each typed; ``number`` is the
    assignment's."""

    def __init__(self, url):
        path, is_new_file = url.removeprefix("sqlite:///"), url.startswith("sqlite:///")
        is_new_file = is_new_file and not Path(path).exists()
        super().__init__(url)
        self.site.limits = Patient()
        if is_new_file:
            vars(self).update(self.made())
        else:
            self.fill()

    def copied(self):
        return _filled().path, _filled().ids

    def made(self):
        """What is known of the copied database."""
        return {name: vars(_filled())[name] for name in ("variants", "number", "of_max", "receipts", "token")}

    def fill(self):
        course, at = self.site.course, self.at - timedelta(hours=2)
        self.variants = {name: course[EXERCISE].variant(seed, "en") for name, seed in SEEDS.items()}
        content = {
            "format": 1,
            "roster": True,
            "assignment": {
                "name": "midterm",
                "title": {"en": "Midterm", "fr": "Devoir"},
                "exercises": [EXERCISE],
            },
            "students": {name: {"number": name} for name in SEEDS},
            "issued": [{"student": name, "record": one.record} for name, one in self.variants.items()],
        }
        with self.site.store.begin() as connection:
            for name in SEEDS:  # as a roster tells them apart
                told = {"who": name.casefold(), "columns": {"number": name}}
                connection.execute(update(person).where(person.c.id == self.ids[name]).values(told))
            self.number = put_issued(connection, content)
            only = {
                **content,
                "issued": content["issued"][1:],
                "assignment": {**content["assignment"], "name": "of Max"},
            }
            self.of_max = put_issued(connection, only)
            for number in (self.number, self.of_max):
                publish(connection, number, self.published)
            self.receipts = {}
            for name in SEEDS:
                rows = self.rows(name)
                made = insert_submission(
                    connection,
                    self.number,
                    rows,
                    source="the site",
                    received_at=at,
                    person_id=self.ids[name],
                    number=1,
                )
                self.receipts[name] = made.receipt
                sheet = f"practice/{EXERCISE}/{SEEDS[name]}"
                save(connection, self.ids[name], sheet, {"rA": DraftChange(f"{PLANTED[name]} draft", 0)}, at)
                note(connection, at, name, "handed in", person=self.ids[name])
            self.token = accounts.invited(
                self.site, connection, self.ids[MAX], "max@example.org", "student"
            ).rpartition("/")[2]
        mark_new(course, self.site.store, self.number)

    @property
    def published(self):
        """Open for two hours more, with one more try; verdicts are told at once, answers when it has
        closed."""
        opens, closes = self.at - timedelta(hours=3), self.at + timedelta(hours=2)
        return Publication(opens=opens, closes=closes, tries=2, feedback=AT_ONCE, answers=CLOSED)

    def rows(self, name):
        told = {part.id: "1" for part in self.variants[name].parts}
        told[next(iter(told))] = PLANTED[name]
        origin = RowOrigin(sitting=1, submitted="2026-11-23T07:00:00+00:00")
        return [
            AnswerRow(name, EXERCISE, str(SEEDS[name]), part, text, "the site", origin=origin)
            for part, text in told.items()
        ]

    def secrets(self, name):
        """What no page of somebody else holds: who this is, what they were issued, and what they wrote."""
        return (name, str(SEEDS[name]), PLANTED[name])

    def answers(self, name):
        """The reference answers of what somebody was issued: as sheets print them, and in all digits that
        could slip."""
        given = {round(abs(float(one["value"])), 1) for one in self.variants[name].record["given"].values()}
        found = []
        for value in self.variants[name].solution().values():
            if isinstance(value, (int, float)) and round(abs(value), 1) not in given and abs(value) > 10:
                found.append(re.compile(rf"(?<![\d.,]){_digits(f'{abs(value):.1f}')}\d{{1,9}}(?!\d)"))
            elif isinstance(value, (int, float)) and abs(value) > 1e-3:
                found.append(re.compile(_digits(f"{abs(value):.9f}")))
        return found


class _First(Filled):
    """The first of a process, which the others are copied from."""

    def __init__(self):
        self.path = Path(tempfile.mkdtemp()) / "site.db"
        super().__init__(f"sqlite:///{self.path}")
        self.site.store.scrub()
        self.site.store.close()

    def copied(self):
        return pristine()

    def made(self):
        self.fill()
        return {}


@cache
def _filled():
    return _First()


def _digits(number):
    """A number with a point or a comma, cut and not rounded."""
    return re.escape(number[:-1] if len(number) < 9 else number[:9]).replace("\\.", "[.,]")


class Filling(NamedTuple):
    """How an address is filled in: with what is the first student's, and with what is the other's."""

    own: Mapping[str, str] = MappingProxyType({})
    others: Mapping[str, str] | None = None  #: None where everybody has it
    holds: tuple[str, ...] = ()  #: ``answers``: their own are shown there, when they may be


def fillings(site: Filled) -> dict[str, Filling]:
    """For each address of the site's table; a new page needs its line here."""
    practice = Filling({"exercise": EXERCISE, "seed": "5"})
    mine, max_only = str(site.number), str(site.of_max)
    paper = Filling({"number": mine, "assignment": mine}, {"number": max_only, "assignment": max_only})
    person = Filling({"person": str(site.ids[ZOE])}, {"person": str(site.ids[MAX])})
    places = {**paper.own, **person.own, "token": "mistyped"}
    code = (
        {"number": mine, "code": site.receipts[ZOE], "ending": "json"},
        {"number": mine, "code": site.receipts[MAX], "ending": "json"},
    )
    anybodys = (
        "/",
        "/service-worker.js",
        "/offline",
        "/accessibility",
        "/language",
        "/who",
        "/sign-in",
        "/sign-out",
        "/account",
        "/account/data",
        "/practice",
        "/progress",
        "/progress/progress.json",
        "/assignments",
        "/desk",
        "/desk/semester",
        "/desk/semester.csv",
        "/desk/issued",
        "/desk/people",
        "/desk/people/extra-time",
        "/desk/people/add",
        "/desk/people/add-staff",
        "/desk/audit",
        "/desk/receipts",
        "/desk/lti",
        "/mechanisms",
        "/desk/assignments",
        "/desk/assignments/new",
    )
    of_class = (
        "",
        "/figure",
        "/queue",
        "/queue/watch",
        "/news",
        "/student",
        "/questions",
        "/question",
        "/report",
        "/report.pdf",
        "/files",
        "/scans",
        "/scans/queue",
        "/scans/picture",
        "/scans/crop",
        "/answers",
        "/roster",
        "/gradebook",
        "/feedback",
        "/rejected",
        "/regrade",
        "/after",
        "/changes.csv",
    )
    of_publishing = (
        "",
        "/publish",
        "/unpublish",
        "/extend",
        "/roster",
        "/make-up",
        "/preview",
        "/as/{person:int}",
        "/issued.json",
        "/sheets",
    )
    return {
        **dict.fromkeys(anybodys, Filling()),
        "/static/{name}": Filling({"name": "site.css"}),
        "/invitation/{token}": Filling({"token": "mistyped"}),
        "/connect/{token}": Filling({"token": "mistyped"}),
        **{
            f"/desk/people/{{person}}{end}": person
            for end in ("", "/invitation", "/role", "/separate", "/data", "/erase")
        },
        "/practice/{exercise}": practice,
        "/lessons/{lesson}": Filling({"lesson": "plane_mechanisms"}),
        "/lessons/{lesson}/figures/{figure}": Filling({"lesson": "plane_mechanisms", "figure": "none.svg"}),
        "/lessons/{lesson}/steps/{steps}": Filling({"lesson": "plane_mechanisms", "steps": "none"}),
        "/mechanisms/{name}": Filling({"name": "new"}),
        "/explore/{exercise}": Filling({"exercise": "four_bar_motion"}),
        **{
            f"/practice/{{exercise}}/{{seed}}{end}": practice
            for end in ("", "/draft", "/read", "/solution", "/motion")
        },
        **{
            f"/assignments/{{number:int}}{end}": paper
            for end in ("", "/start", "/keep", "/read-back", "/hand-in", "/file", "/feedback")
        },
        "/assignments/{number:int}/receipts/{code}": Filling(*code),
        "/assignments/{number:int}/receipts/{code}.{ending}": Filling(*code),
        "/assignments/{number:int}/{file}": Filling(
            {"number": mine, "file": "notebook.ipynb"}, {"number": max_only, "file": "notebook.ipynb"}
        ),
        "/desk/assignments/dealing/{token}": Filling(places),
        **{f"/desk/assignments/{{number:int}}{end}": Filling(places) for end in of_publishing},
        **{f"/desk/{{assignment:int}}{end}": Filling(places) for end in of_class},
        "/desk/{assignment:int}/files/{file}": Filling({**places, "file": "issued.json"}),
    }


def filled(path: str, places: dict) -> str:
    """An address with its places filled in."""
    return re.sub(r"\{(\w+)(?::\w+)?\}", lambda found: places[found[1]], path)


#: Places and sizes of what is drawn.
_COORDINATES = re.compile(r' (?:d|points|transform|viewBox|[cr]?[xy][12]?|r|width|height)="[\w\s.,()+-]*"')


def text_of(reply) -> str:
    """What a reply says, but for the coordinates of drawn lines, among which any number is by chance; of an
    archive, all that is in it, the cells of its tables apart as no decimal comma is."""
    if not zipfile.is_zipfile(io.BytesIO(reply.content)):
        return _COORDINATES.sub("", reply.text)
    with zipfile.ZipFile(io.BytesIO(reply.content)) as archive:
        texts = {name: archive.read(name).decode("utf-8", "replace") for name in archive.namelist()}
    return "\n".join(
        text.replace(",", ", ") if name.endswith(".csv") else text for name, text in texts.items()
    )


class Scripts(HTMLParser):
    """What a page would run, where it leads, and what a person reads of it."""

    def __init__(self, text):
        super().__init__()
        self.inline, self.addresses, self.handlers, self.read = [], [], [], []
        self._within = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        told = dict(attrs)
        if tag == "script" and "src" not in told and told.get("type") not in ("application/json",):
            self.inline.append(tag)
        self.handlers += [name for name in told if name.startswith(("on", "hx-on"))]
        named = (
            "href",
            "src",
            "action",
            "formaction",
            "data",
            "poster",
            "srcset",
            "xlink:href",
            "hx-get",
            "hx-post",
            "ping",
        )
        self.addresses += [value or "" for name, value in attrs if name in named]
        if tag == "meta" and told.get("http-equiv", "").lower() == "refresh":
            self.addresses.append(told.get("content", "").partition("=")[2])
        if tag in ("svg", "script", "style"):
            self._within.append(tag)

    def handle_endtag(self, tag):
        if tag in self._within:
            self._within.remove(tag)

    def handle_data(self, data):
        if not self._within:
            self.read.append(data)


__all__ = [
    "EXERCISE",
    "MAX",
    "PLANTED",
    "SEEDS",
    "TEACHER",
    "ZOE",
    "Filled",
    "Filling",
    "Scripts",
    "filled",
    "fillings",
]


class Forms(HTMLParser):
    """The forms of a page that change something, each as a browser without a script sends it by each of its
    buttons: address and texts."""

    def __init__(self, text):
        super().__init__()
        self.sent, self._forms = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        told = dict(attrs)
        if tag == "form":
            self._forms.append((told.get("action", ""), told.get("method", "get"), {}))
        if not self._forms or self._forms[-1][1] != "post":
            return
        action, _, texts = self._forms[-1]
        if tag == "button" and told.get("type", "submit") == "submit":
            pressed = {told["name"]: told.get("value", "")} if "name" in told else {}
            self.sent.append((told.get("formaction", action), texts, pressed))
        elif tag == "input" and "name" in told and told.get("type") not in ("checkbox", "radio", "file"):
            texts[told["name"]] = told.get("value") or ""

    def handle_endtag(self, tag):
        if tag == "form":
            self._forms.pop()
