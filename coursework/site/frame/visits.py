"""Request and response of a page: the current user with the input, and the content sent back."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

from coursework.database.audit import Actor
from coursework.database.permissions import STAFF, Area, Permission, is_of_staff, may
from coursework.errors import CourseworkError
from coursework.language.words import words
from coursework.site.frame.budgets import DESK, PLAIN, Budget

if TYPE_CHECKING:
    from datetime import datetime

    from coursework.site.frame.attempts import Attempt
    from coursework.site.frame.settings import Site


def local(address: str, usual: str = "/") -> str:
    """Return an address of this site; the first page if the given address leads elsewhere."""
    seen = "".join(letter for letter in address if ord(letter) >= 32)  # browsers take no notice of the others
    leads_away = seen.startswith("//") or "\\" in seen.partition("?")[0]
    return seen if seen.startswith("/") and not leads_away else usual


class Refused(CourseworkError):
    """A page that is not shown: the name of a sentence of ``[refused]``, and the status that goes with it."""

    def __init__(self, sentence: str, status: int, *parts: object):
        self.sentence, self.status, self.parts = sentence, status, parts
        super().__init__(sentence)


class Person(NamedTuple):
    """Current user who is signed in."""

    id: int
    name: str
    role: str  #: one of :data:`coursework.database.permissions.ROLES`
    lang: str = ""
    areas: tuple[Area, ...] = ()  #: in which an assistant works

    @property
    def is_staff(self) -> bool:
        return self.role in STAFF

    def may(self, permission: str, assignment: int | None = None, group: str | None = None) -> bool:
        """Return True if the person has a permission; in a given assignment, for a student of a given group."""
        return may(self, Permission(permission), assignment, group)


class Upload(NamedTuple):
    """A file that was sent."""

    name: str
    data: bytes


@dataclass(frozen=True)
class Form:
    """Content of a form: texts and files by the names of its fields, each with all of its values."""

    texts: Mapping[str, Sequence[str]] = field(default_factory=dict)
    files: Mapping[str, Sequence[Upload]] = field(default_factory=dict)

    def text(self, name: str, usual: str = "") -> str:
        return next(iter(self.texts.get(name, ())), usual)


@dataclass(frozen=True)
class Visit:
    """A page that is asked for."""

    site: Site
    person: Person | None
    lang: str
    at: datetime  #: UTC; of what is sent its arrival, however long it waited
    address: str  #: path, as the browser sees it
    path: Mapping[str, Any] = field(default_factory=dict)  #: what the path's places hold
    query: Mapping[str, str] = field(default_factory=dict)
    form: Form = field(default_factory=Form)
    posted: bool = False
    seal: str = ""  #: what a form holds in its field ``_seal``
    is_piece: bool = False  #: a script asks for a piece of the page alone
    came_from: str = ""  #: the address of the machine that asks
    session: int = 0  #: number of the session; 0 where there is none
    device: str = ""  #: the device cookie, as it came

    @property
    def who(self) -> Person:
        """Current user, who must be signed in.

        Raises
        ------
        Refused
            Nobody is.
        """
        if self.person is None:
            raise Refused("sign_in", 401)
        return self.person

    @property
    def actor(self) -> Actor:
        """Current user and address, as the audit records them."""
        name = self.who.name or str(self.said["site"]["local"])
        return Actor(name, self.who.id, self.came_from)

    def require(
        self, permission: Permission, assignment: int | None = None, group: str | None = None
    ) -> None:
        """Refuse the request unless the person may do what the form says beyond what its page needs.

        Raises
        ------
        Refused
            They may not.
        """
        if not may(self.person, permission, assignment, group):
            raise Refused("role", 403)

    @property
    def said(self) -> Mapping[str, Any]:
        """The site's words."""
        return words(self.lang, "site")

    def page(self, template: str, status: int = 200, **names: Any) -> Reply:
        """Return the page of a template such as ``site_practice``, with the frame of all pages."""
        own = {"visit": self, "person": self.person, "seal": self.seal}
        return Reply(self.site.pages.page(template, self.lang, {**own, **names}), status)


@dataclass(frozen=True)
class Reply:
    """Response of a page: a page or a part of one, a redirect, or a file."""

    html: str = ""
    status: int = 200
    goto: str = ""
    kind: str = "text/html; charset=utf-8"
    data: bytes = b""
    file: str = ""  #: its name, where it is to be kept
    keep: int = 0  #: seconds for which a browser may keep it; nothing is kept unless told
    device: str = ""  #: the device cookie that the browser is to keep
    signed_in: int | None = None  #: who is from now on; 0 for nobody
    lang: str = ""  #: which the browser is to remember


class Page(NamedTuple):
    """An address: the permission that it needs, and what answers.

    Where its path names an ``assignment`` or its ``number``, the permission is needed for that assignment.
    """

    path: str
    answer: Callable[[Visit], Reply]
    needs: Permission
    posts: bool = False  #: it takes forms
    limit: str = "usual"  #: which of the limits it falls under (:mod:`coursework.site.frame.limits`)
    budget: Budget | None = None  #: of what is sent to it; who takes forms of students states it
    is_short: bool = False  #: it stores what is sent and shows nothing: answered before pages are
    posting: Permission | None = None  #: that a form needs, where it is another one
    of_staff: Permission | None = None  #: that it needs where its path names a ``person`` of the staff
    attempt: Callable[[Visit], Attempt] | None = None  #: what a form that holds a password is counted by
    by_group: bool = (
        False  #: it shows an assistant the students of their groups alone; else it is for the whole class
    )
    noted: str = "exported"  #: how the audit calls a file that the staff takes there

    @property
    def means(self) -> Budget:
        """The budget of its requests: the least where none is stated."""
        return self.budget or (DESK if is_of_staff(self.needs) else PLAIN)
