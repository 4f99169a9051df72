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
    seen = "".join(letter for letter in address if ord(letter) >= 32)  # browsers ignore the others
    leads_away = seen.startswith("//") or "\\" in seen.partition("?")[0]
    return seen if seen.startswith("/") and not leads_away else usual


class HTTPException(CourseworkError):
    """Refusal of a request: the key of a message in ``[refused]``, and the status code."""

    def __init__(self, sentence: str, status_code: int, *parts: object):
        self.sentence, self.status_code, self.parts = sentence, status_code, parts
        super().__init__(sentence)


class Person(NamedTuple):
    """Current user who is signed in."""

    id: int
    name: str
    role: str  #: one of :data:`coursework.database.permissions.ROLES`
    lang: str = ""
    areas: tuple[Area, ...] = ()  #: areas of an assistant

    @property
    def is_staff(self) -> bool:
        return self.role in STAFF

    def may(self, permission: str, assignment: int | None = None, group: str | None = None) -> bool:
        """Return True if the person has a permission; in a given assignment, for a student of a given group."""
        return may(self, Permission(permission), assignment, group)


class Upload(NamedTuple):
    """Uploaded file."""

    name: str
    data: bytes


@dataclass(frozen=True)
class FormData:
    """Content of a form: texts and files by the names of its fields, each with all of its values."""

    texts: Mapping[str, Sequence[str]] = field(default_factory=dict)
    files: Mapping[str, Sequence[Upload]] = field(default_factory=dict)

    def text(self, name: str, usual: str = "") -> str:
        return next(iter(self.texts.get(name, ())), usual)


@dataclass(frozen=True)
class Request:
    """Request of a page, with the current user and the input."""

    site: Site
    person: Person | None
    lang: str
    received_at: datetime  #: UTC; for a form, the time at which its bytes arrived
    path: str  #: as the browser sees it
    path_params: Mapping[str, Any] = field(default_factory=dict)
    query_params: Mapping[str, str] = field(default_factory=dict)
    form: FormData = field(default_factory=FormData)
    is_post: bool = False
    csrf_token: str = ""  #: value of the form field ``_seal``
    is_fragment: bool = False  #: a script asks for a fragment of the page
    client_address: str = ""  #: network address of the client
    session: int = 0  #: id of the session; 0 if there is none
    device: str = ""  #: value of the device cookie

    @property
    def user(self) -> Person:
        """Current user, who must be signed in.

        Raises
        ------
        HTTPException
            Nobody is signed in.
        """
        if self.person is None:
            raise HTTPException("sign_in", 401)
        return self.person

    @property
    def actor(self) -> Actor:
        """Current user and address, as the audit records them."""
        name = self.user.name or str(self.words["site"]["local"])
        return Actor(name, self.user.id, self.client_address)

    def require(
        self, permission: Permission, assignment: int | None = None, group: str | None = None
    ) -> None:
        """Refuse the request unless the user has a permission beyond that of the route.

        Raises
        ------
        HTTPException
            The user has not the permission.
        """
        if not may(self.person, permission, assignment, group):
            raise HTTPException("role", 403)

    @property
    def words(self) -> Mapping[str, Any]:
        """Texts of the site in the language of the request."""
        return words(self.lang, "site")

    def render(self, template: str, status_code: int = 200, **names: Any) -> Response:
        """Return the page of a template such as ``site_practice``, with the frame of all pages."""
        common = {"request": self, "person": self.person, "csrf_token": self.csrf_token}
        return Response(self.site.pages.page(template, self.lang, {**common, **names}), status_code)


@dataclass(frozen=True)
class Response:
    """Response of a page: a page or a part of one, a redirect, or a file."""

    html: str = ""
    status_code: int = 200
    redirect: str = ""  #: address to which the browser goes on
    media_type: str = "text/html; charset=utf-8"
    content: bytes = b""
    filename: str = ""  #: name of a download
    max_age: int = 0  #: seconds for which a browser may cache it
    device: str = ""  #: new value of the device cookie
    signed_in: int | None = None  #: id of the user who signs in; 0 to sign out
    lang: str = ""  #: language to store in a cookie


class Route(NamedTuple):
    """Route of the site: path, endpoint and permission.

    If the path names an ``assignment`` or its ``number``, the permission is needed for that assignment.
    """

    path: str
    endpoint: Callable[[Request], Response]
    permission: Permission
    takes_forms: bool = False  #: POST requests are allowed
    limit: str = "usual"  #: kind of page (:mod:`coursework.site.frame.limits`)
    budget: Budget | None = None  #: budget of its forms; required if students send them
    is_short: bool = False  #: it only stores data, and is answered before pages
    form_permission: Permission | None = None  #: permission of a form, if different
    staff_permission: Permission | None = None  #: permission if the path names a ``person`` of the staff
    attempt: Callable[[Request], Attempt] | None = None  #: attempt counted for a form with a password
    by_group: bool = (
        False  #: an assistant sees the students of their groups; otherwise the whole class is needed
    )
    audit_event: str = "exported"  #: name in the audit of a download by staff

    @property
    def request_budget(self) -> Budget:
        """Budget of its requests; the smallest if none is stated."""
        return self.budget or (DESK if is_of_staff(self.permission) else PLAIN)
