"""The door: what every request goes through. Who comes, whether they may, and how a page goes back."""

from __future__ import annotations

import logging
import time
import traceback
from collections.abc import Callable
from typing import Any, NamedTuple
from urllib.parse import urlsplit

from sqlalchemy.exc import DatabaseError, DBAPIError, IntegrityError
from sqlalchemy.exc import TimeoutError as NoConnection
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response

from coursework.database.people import person_by_id
from coursework.errors import BadCourse, BadInput, BrokenFunction, UnknownName
from coursework.language.words import words
from coursework.site.frame.cookies import SECONDS, Cookies, Session, cookie_name
from coursework.site.frame.forms import clean, read_form
from coursework.site.frame.sending import response_of
from coursework.site.frame.settings import Entrance, Site
from coursework.site.frame.visits import Form, Page, Person, Refused, Reply, Visit, Who
from coursework.site.people import home

LOG = logging.getLogger("coursework.site")
_LANG = "coursework-lang"  #: the cookie of the language that somebody chose
_YEAR = 365 * 24 * 3600
_LOOPBACK = ("127.0.0.1", "localhost", "::1")
_GREATEST = 2**31 - 1  #: that numbers of a database reach
_FORWARDED = ("x-forwarded-for", "x-forwarded-host", "forwarded", "x-real-ip")  #: what a proxy in front adds
_AGAIN = 5  #: seconds after which to try again what the database did not take


class _Comer(NamedTuple):
    """Who asks."""

    session: Session
    is_new: bool  #: the browser holds no cookie of the session
    person: Person | None
    lang: str


class Door:
    """What every request goes through."""

    def __init__(self, site: Site):
        self.site, self.cookies = site, Cookies(site.secret)
        self._cookie = cookie_name(site.is_secure)

    def answering(self, page: Page) -> Any:
        """The endpoint of a page."""

        async def answer(request: Request) -> Response:
            return await self._written_down(request, page.path, lambda: self._answer(request, page))

        return answer

    async def lost(self, request: Request, fault: Exception) -> Response:
        """An address that there is not, or that takes no form."""
        status = fault.status_code if isinstance(fault, HTTPException) else 404
        why = Refused("method" if status == 405 else "page", status)
        allowed = {"allow": "GET, HEAD"} if status == 405 else {}

        async def answer() -> Response:
            response = await run_in_threadpool(self._lost, request, why)
            response.headers.update(allowed)
            return response

        return await self._written_down(request, "-", answer)

    async def _written_down(self, request: Request, path: str, answer: Callable[[], Any]) -> Response:
        """What is answered, with a line of the log: which page, never of whom and with what."""
        begun, why = time.perf_counter(), ""
        try:
            response: Response = await answer()
        except ClientDisconnect:
            response = Response(status_code=400)
        except Exception as fault:  # written down without any value, since a message may hold an answer
            why = _place_of(fault)
            response = await run_in_threadpool(self._broken, request)
        took = 1000 * (time.perf_counter() - begun)
        level = logging.ERROR if why else logging.INFO
        LOG.log(
            level, "%s %s %d %.0f ms%s", request.method, path, response.status_code, took, why and f" {why}"
        )
        return response

    async def _answer(self, request: Request, page: Page) -> Response:
        if request.method != "POST":
            return await run_in_threadpool(self._visited, request, page)
        comer = await run_in_threadpool(self._let_in, request, page)
        if isinstance(comer, Response):
            return comer
        try:
            form = await read_form(request, page.largest)
        except Refused as why:
            return await run_in_threadpool(self._refused, request, comer, why)
        return await run_in_threadpool(self._answered, request, page, comer, form)

    def _visited(self, request: Request, page: Page) -> Response:
        comer = self._let_in(request, page)
        return comer if isinstance(comer, Response) else self._answered(request, page, comer, Form())

    def _let_in(self, request: Request, page: Page) -> _Comer | Response:
        """Who asks, where they may; else what they are told. Nothing of a form is read before."""
        try:
            self._check_host(request)
            _check_path(request)
        except Refused as why:
            return self._without_person(request, why)
        try:
            comer = self._comer(request)
        except BadInput:  # the database is gone
            return self._without_person(request, Refused("busy", 503, _AGAIN))
        try:
            self._check_often(request, page, comer)
            if request.method == "POST":
                self._check_origin(request)
            _check_role(page, comer.person)
        except Refused as why:
            return self._refused(request, comer, why)
        return comer

    def _answered(self, request: Request, page: Page, comer: _Comer, form: Form) -> Response:
        visit = self._visit(request, comer, form)
        try:
            if visit.posted:
                self._check_seal(request, comer.session, form)
            return self._sent(request, comer, page.answer(visit))
        except Refused as why:
            return self._refused(request, comer, why)
        except UnknownName:
            return self._refused(request, comer, Refused("page", 404))
        except BadInput as fault:
            return self._refused(request, comer, _mistaken(fault))
        except BadCourse as fault:  # its folder is out of reach, or a file in it is not as it was
            LOG.error("the course: %s", _place_of(fault) if isinstance(fault, BrokenFunction) else fault)
            return self._refused(request, comer, Refused("course", 503, _AGAIN))
        except IntegrityError:  # somebody else wrote the same at the same time: nothing of this was kept
            LOG.error("the database: two wrote the same at once")
            return self._refused(request, comer, Refused("busy", 503, _AGAIN))

    def _lost(self, request: Request, why: Refused) -> Response:
        try:
            self._check_host(request)
            comer = self._comer(request)
        except (Refused, BadInput):
            return self._without_person(request, why)
        return self._refused(request, comer, why)

    # -------------------------------------------------------------- who comes

    def _comer(self, request: Request) -> _Comer:
        session = self.cookies.read(request.cookies.get(self._cookie))
        is_new = session is None
        if session is None:
            session = self.cookies.begun(home.owner(self.site) if self.site.entrance is Entrance.LOCAL else 0)
        person = self._person(session)
        if person is None and session.person:
            session, is_new = self.cookies.begun(0), True
        return _Comer(session, is_new, person, self._lang(request, person))

    def _person(self, session: Session) -> Person | None:
        if not session.person:
            return None
        with self.site.store.reading() as connection:
            row = person_by_id(connection, session.person)
            self.site.follow(connection)
        if row is None or max(row.created, row.sessions_from or row.created).timestamp() > session.began:
            return (
                None  # erased (another person may have the number by now), or over since the password changed
            )
        return Person(row.id, row.name, row.role or "student", row.lang)

    def _lang(self, request: Request, person: Person | None) -> str:
        known = self.site.languages
        asked = [request.cookies.get(_LANG, ""), person.lang if person else ""]
        asked += [
            one.split(";")[0].strip()[:2].lower()
            for one in request.headers.get("accept-language", "")[:500].split(",")
        ]
        return next((lang for lang in asked if lang in known), known[0])

    def _visit(self, request: Request, comer: _Comer, form: Form) -> Visit:
        return Visit(
            self.site, comer.person, comer.lang, self.site.clock(), clean(request.scope["path"]), dict(request.path_params),
            {clean(name): clean(text) for name, text in request.query_params.items()}, form, request.method == "POST",
            self.cookies.seal(comer.session),
            request.headers.get("hx-request") == "true" and request.headers.get("hx-boosted") != "true",
            _address(request),
        )  # fmt: skip

    # ------------------------------------------------------------ whether they may

    def _check_host(self, request: Request) -> None:
        """A name that is not ours leads here only by a trick; and where nobody needs a password, no other machine may."""
        if _host(f"//{request.headers.get('host', '')}") not in (_host(self.site.url), *_LOOPBACK):
            raise Refused("page", 421)
        if self.site.entrance is not Entrance.ACCOUNTS and any(one in request.headers for one in _FORWARDED):
            raise Refused("forwarded", 421)

    def _check_often(self, request: Request, page: Page, comer: _Comer) -> None:
        person = comer.person.id if comer.person else 0
        wait = self.site.limits.asked(page.limit, person, _address(request))
        if wait:
            raise Refused("too_often", 429, wait)

    def _check_origin(self, request: Request) -> None:
        """A form comes from a page of ours, as far as the browser says."""
        sent, host = request.headers.get("origin"), request.headers.get("host", "")
        own = {_origin(self.site.url)}
        if _host(f"//{host}") in _LOOPBACK:
            own.add(f"http://{host}")
        if sent is not None and sent not in own:
            raise Refused("form", 403)
        if request.headers.get("sec-fetch-site", "none") not in ("same-origin", "none"):
            raise Refused("form", 403)

    def _check_seal(self, request: Request, session: Session, form: Form) -> None:
        """A form was made for this session."""
        if not self.cookies.fits(session, request.headers.get("x-seal") or form.text("_seal")):
            raise Refused("form", 403)

    # ----------------------------------------------------------------- what goes back

    def _sent(self, request: Request, comer: _Comer, reply: Reply) -> Response:
        response = response_of(request, reply, self.site.is_secure)
        if reply.keep:
            return response
        session, is_due = comer.session, comer.is_new or self.cookies.is_due(comer.session)
        if reply.signed_in is not None:
            session, is_due = self.cookies.begun(reply.signed_in), True
        if is_due:
            self._set_cookie(response, self._cookie, self.cookies.cookie(session), SECONDS)
        if reply.lang:
            self._set_cookie(response, _LANG, reply.lang, _YEAR)
        return response

    def _set_cookie(self, response: Response, name: str, value: str, seconds: int) -> None:
        response.set_cookie(
            name, value, max_age=seconds, httponly=True, samesite="lax", secure=self.site.is_secure
        )

    def _refused(self, request: Request, comer: _Comer, why: Refused) -> Response:
        visit = self._visit(request, comer, Form())
        if why.sentence == "sign_in" and not visit.posted and not visit.is_piece:
            return self._sent(request, comer, Reply(goto=home.door_to(visit)))
        response = self._sent(request, comer, _refusal(visit, why))
        if why.status in (429, 503) and why.parts:
            response.headers["retry-after"] = str(why.parts[0])
        return response

    def _broken(self, request: Request) -> Response:
        """What is told when something was not foreseen; in two words where even the page for it is broken."""
        try:
            return self._without_person(request, Refused("fault", 500))
        except Exception as fault:
            LOG.error("the page for that: %s", _place_of(fault))
            return response_of(
                request, Reply("Error 500", 500, kind="text/plain; charset=utf-8"), self.site.is_secure
            )

    def _without_person(self, request: Request, why: Refused) -> Response:
        """What is told to whom nothing may be told of anybody, or when nobody can be looked up; no session begins."""
        lang = self._lang(request, None)
        visit = Visit(self.site, None, lang, self.site.clock(), "/")
        response = response_of(request, _refusal(visit, why), self.site.is_secure)
        if why.status == 503:
            response.headers["retry-after"] = str(_AGAIN)
        return response


def _refusal(visit: Visit, why: Refused) -> Reply:
    told = str(words(visit.lang, "site")["refused"][why.sentence]).format(*why.parts)
    return visit.page("site_refused", why.status, told=told)


def _mistaken(fault: BadInput) -> Refused:
    """A file or a value that somebody mistook is told as the commands tell it; a database that takes nothing, as such."""
    if isinstance(fault.__cause__, (DBAPIError, NoConnection)):
        damaged = type(fault.__cause__) is DatabaseError
        LOG.error("the database: %s", "its file is damaged" if damaged else type(fault.__cause__).__name__)
        return Refused("busy", 503, _AGAIN)
    return Refused("mistaken", 422, str(fault))


def _check_role(page: Page, person: Person | None) -> None:
    if page.who is Who.NOBODY:
        return
    if person is None:
        raise Refused("sign_in", 401)
    if page.who is Who.STAFF and not person.is_staff:
        raise Refused("role", 403)


def _check_path(request: Request) -> None:
    """No address of ours holds what no keyboard writes."""
    if any(ord(letter) < 32 or letter in "\x7f\ufffd" for letter in request.scope["path"]):
        raise Refused("page", 404)
    if any(isinstance(one, int) and one > _GREATEST for one in request.path_params.values()):
        raise Refused("page", 404)


def _address(request: Request) -> str:
    """The machine that asks, as the server tells it: what a request itself says of it counts only behind a proxy that the
    server was told of."""
    return request.client.host if request.client else ""


def _host(url: str) -> str:
    try:
        return urlsplit(url).hostname or ""
    except ValueError:
        return ""


def _origin(url: str) -> str:
    parts = urlsplit(url)
    return f"{parts.scheme}://{parts.netloc}"


def _place_of(fault: BaseException) -> str:
    frames = traceback.extract_tb(fault.__traceback__)[-5:]
    told = " < ".join(
        f"{frame.filename.rpartition('coursework/')[2]}:{frame.lineno}" for frame in reversed(frames)
    )
    return f"{type(fault).__name__} at {told}"
