"""Request of a page: that of starlette with the current user and the content of a form, and the table of
routes."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from starlette.datastructures import QueryParams
from starlette.exceptions import HTTPException as StarletteException
from starlette.requests import Request as StarletteRequest
from starlette.responses import HTMLResponse, Response

from coursework.database.audit import Actor, note
from coursework.database.permissions import STAFF, Area, Permission, is_of_staff, may
from coursework.errors import CourseworkError
from coursework.language.words import words
from coursework.site.frame.arrivals import arrived
from coursework.site.frame.budgets import DESK, PLAIN, Budget
from coursework.site.frame.cookies import Session
from coursework.site.frame.devices import DEVICE
from coursework.system.headers import cookie_name

if TYPE_CHECKING:
    from datetime import datetime

    from sqlalchemy import Connection

    from coursework.site.frame.attempts import Attempt
    from coursework.site.frame.settings import Site


class HTTPException(StarletteException, CourseworkError):
    """Refusal of a request: the key of a message in ``[refused]``, and the status code.

    The first part of a refusal for a time is the number of seconds to wait.
    """

    def __init__(self, sentence: str, status_code: int, *parts: object):
        wait = {"retry-after": str(parts[0])} if status_code in (429, 503) and parts else None
        super().__init__(status_code, sentence, wait)
        self.sentence, self.parts = sentence, parts


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
        """Return True if the person has a permission; in a given assignment, for a student of a given
        group."""
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

    def uploads(self, name: str) -> list[Upload]:
        """Return the files of a field that are not empty."""
        return [upload for upload in self.files.get(name, ()) if upload.data]

    def upload(self, name: str) -> Upload | None:
        """Return the first of these files; None if there is none."""
        return next(iter(self.uploads(name)), None)


class Request(StarletteRequest):
    """Request of a page, with the current user and the content of its form.

    The middleware finds the current user and reads the form before the page sees the request.
    """

    form: FormData  # type: ignore[assignment]  # the middleware reads it, within its limits

    def __init__(self, site: Site, *http: Any):
        super().__init__(*http)
        self.site = site
        self.person: Person | None = None
        self.lang = site.languages[0]
        self.browser = Session("")  #: session of the browser
        self.is_new = False  #: the browser has no cookie of the session yet
        self.form = FormData()
        self.events: list[tuple[str, int]] = []  #: of the security log

    @classmethod
    def of_person(
        cls, site: Site, person: Person, lang: str, path: str, path_params: Mapping[str, Any], form: FormData
    ) -> Request:
        """Return a request of a person who is signed in elsewhere; a form if it has texts."""
        method = "POST" if form.texts else "GET"
        scope = {"type": "http", "method": method, "path": path, "path_params": path_params, "headers": []}
        request = cls(site, scope)
        request.person, request.lang, request.form = person, lang, form
        return request

    @cached_property
    def received_at(self) -> datetime:
        """Time in UTC; for a form, the time at which its bytes arrived."""
        return arrived(self.site.clock)

    @property
    def path(self) -> str:
        """Path as the browser sees it."""
        return clean(self.scope["path"])

    @property
    def query_params(self) -> QueryParams:
        return QueryParams([(clean(n), clean(text)) for n, text in super().query_params.multi_items()])

    @property
    def is_post(self) -> bool:
        return self.method == "POST"

    @property
    def is_fragment(self) -> bool:
        """True if a script asks for a fragment of the page."""
        return self.headers.get("hx-request") == "true" and self.headers.get("hx-boosted") != "true"

    @property
    def client_address(self) -> str:
        """Address of the client as the server states it: headers of the request count only behind a
        configured proxy."""
        return self.client.host if self.client else ""

    def cookie(self, name: str) -> str:
        """Return the value of a cookie of the site; empty if there is none."""
        return self.cookies.get(cookie_name(self.site.is_secure, name), "")

    @property
    def device(self) -> str:
        return self.cookie(DEVICE)

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

    def note(self, connection: Connection, what: str, **about: Any) -> None:
        """Record in the audit what the current user does."""
        note(connection, self.received_at, self.actor, what, **about)

    def require(self, permission: Permission) -> None:
        """Refuse the request unless the user has a permission beyond that of the route.

        Raises
        ------
        HTTPException
            The user has not the permission.
        """
        if not may(self.person, permission):
            raise HTTPException("role", 403)

    @property
    def words(self) -> Mapping[str, Any]:
        """Texts of the site in the language of the request."""
        return words(self.lang, "site")

    def render(self, template: str, status_code: int = 200, **names: Any) -> Response:
        """Return the page of a template such as ``site/practice``, with the frame of all pages."""
        csrf_token = self.site.cookies.csrf_token(self.browser) if self.browser.token else ""
        common = {"request": self, "person": self.person, "csrf_token": csrf_token}
        html = self.site.pages.page(template, self.lang, {**common, **names})
        return HTMLResponse(html.encode("utf-8", "replace"), status_code)


class Route(NamedTuple):
    """Route of the site: path, endpoint and permission.

    If the path names an ``assignment`` or its ``number``, the permission is needed for that assignment.
    """

    path: str
    endpoint: Callable[[Request], Response]
    permission: Permission
    takes_forms: bool = False  #: POST requests are allowed
    has_page: bool = True  #: GET requests are allowed
    limit: str = "usual"  #: kind of page (:mod:`coursework.site.frame.limits`)
    budget: Budget | None = None  #: budget of its forms; required if students send them
    is_short: bool = False  #: it only stores data, and is answered before pages
    form_permission: Permission | None = None  #: permission of a form, if different
    staff_permission: Permission | None = None  #: permission if the path names a ``person`` of the staff
    attempt: Callable[[Request], Attempt] | None = None  #: attempt counted for a form with a password
    #: An assistant sees the students of their groups; otherwise the whole class is needed.
    by_group: bool = False
    audit_event: str = "exported"  #: name in the audit of a download by staff

    @property
    def request_budget(self) -> Budget:
        """Budget of its requests; the smallest if none is stated."""
        return self.budget or (DESK if is_of_staff(self.permission) else PLAIN)


def preferred_language(wanted: str, languages: Sequence[str]) -> str:
    """Return the first available one of the wanted languages, from ``fr-CA, en;q=0.8`` or ``fr_FR``; else the
    first."""
    codes = re.findall(r"(?:^|[,\s])([a-zA-Z]{2,3})(?=[-_,;.\s]|$)", wanted[:500])
    return next((code.lower() for code in codes if code.lower() in languages), languages[0])


def clean(text: str) -> str:
    """Return a text that databases and pages can contain: with uniform line ends, without NUL and lone
    surrogates."""
    return text.replace("\r\n", "\n").replace("\0", "").encode("utf-8", "replace").decode()
