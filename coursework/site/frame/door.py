"""Middleware of all requests: the current user, the permissions, and the response."""

from __future__ import annotations

import logging
import time
import traceback
from collections.abc import Callable
from contextlib import suppress
from datetime import UTC, datetime
from typing import Any, NamedTuple
from urllib.parse import urlsplit

from sqlalchemy.exc import DatabaseError, DBAPIError, IntegrityError
from sqlalchemy.exc import TimeoutError as NoConnection
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response

from coursework.database.people import person_by_id
from coursework.database.sessions import (
    LONGEST,
    TOUCHED,
    begin_session,
    end_session,
    session_of,
    touch_session,
)
from coursework.database.settings import taken_of
from coursework.errors import BadCourse, BadInput, BrokenFunction, UnknownName
from coursework.language.words import words
from coursework.site.frame.arrivals import arrived
from coursework.site.frame.attempts import Attempt, Attempts, TooMany
from coursework.site.frame.browsers import described
from coursework.site.frame.cookies import ANONYMOUS_SECONDS, Cookies, Session, cookie_name, may_be_token
from coursework.site.frame.devices import DEVICE, DEVICE_SECONDS, Devices
from coursework.site.frame.forms import clean, read_form
from coursework.site.frame.lanes import Lanes, Run
from coursework.site.frame.permitting import check_permission, note_export, person_of
from coursework.site.frame.security_log import FAILED, SIGNED_IN, SIGNED_OUT, event_of, happened, log_events
from coursework.site.frame.sending import response_of
from coursework.site.frame.settings import Entrance, Site
from coursework.site.frame.visits import Form, Page, Person, Refused, Reply, Visit
from coursework.site.people import home
from coursework.system.places import WAITING, Crowded
from coursework.system.processes import processor_time

LOG = logging.getLogger("coursework.site")
_LANG = "coursework-lang"  #: the cookie of the language that somebody chose
_YEAR = 365 * 24 * 3600
_LOOPBACK = ("127.0.0.1", "localhost", "::1")
_GREATEST = 2**31 - 1  #: that numbers of a database reach
_FORWARDED = ("x-forwarded-for", "x-forwarded-host", "forwarded", "x-real-ip")  #: what a proxy in front adds
_STAFF_WAITING = 1000  #: requests of one of the staff that wait: a page of many pictures asks for all at once
_CROWDED = 2  #: seconds after which to try again where too many wait
_AGAIN = 5  #: seconds after which to try again what the database did not take


class _Comer(NamedTuple):
    """Current user of a request."""

    session: Session
    is_new: bool  #: the browser holds no cookie of the session
    person: Person | None
    lang: str


class Door:
    """Middleware of all requests."""

    def __init__(self, site: Site):
        self.site, self.cookies, self._lanes = site, Cookies(site.secret), Lanes(site.store)
        self._lang_cookie = cookie_name(site.is_secure, _LANG)
        self._cookie, self._attempts = cookie_name(site.is_secure), Attempts()
        self._device = cookie_name(site.is_secure, DEVICE)

    def answering(self, page: Page) -> Any:
        """Return the endpoint of a page."""

        async def answer(request: Request) -> Response:
            return await self._written_down(request, page.path, lambda: self._answer(request, page))

        return answer

    async def lost(self, request: Request, fault: Exception) -> Response:
        """Return the response to an unknown address, or to a method that it does not support."""
        status = fault.status_code if isinstance(fault, HTTPException) else 404
        why = Refused("method" if status == 405 else "page", status)
        allowed = {"allow": "GET, HEAD"} if status == 405 else {}

        async def answer() -> Response:
            response = await run_in_threadpool(self._lost, request, why)
            response.headers.update(allowed)
            return response

        return await self._written_down(request, "-", answer)

    async def _written_down(self, request: Request, path: str, answer: Callable[[], Any]) -> Response:
        """Return the response and log the request: the page and the number of the person, never the content."""
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
        person = getattr(request.state, "person", 0)
        who, why = (f" person {person}" if person else ""), why and f" {why}"
        LOG.log(level, "%s %s %d %.0f ms%s%s", request.method, path, response.status_code, took, who, why)
        log_events(request, path, _address(request))
        return response

    async def _answer(self, request: Request, page: Page) -> Response:
        run = self._lanes.short if page.is_short else self._lanes.usual
        comer = await run(self._let_in, request, page)
        if isinstance(comer, Response):
            return comer
        if comer.person is None:
            return await self._read_and_answered(request, page, comer, run)
        means, waiting = page.means, _STAFF_WAITING if comer.person.is_staff else WAITING
        try:
            async with self.site.places.one((comer.person.id, means.name), means.at_once, waiting):
                return await self._read_and_answered(request, page, comer, run)
        except Crowded:
            why = Refused("too_often", 429, _CROWDED)
            return await run(self._refused, request, comer, why)

    async def _read_and_answered(self, request: Request, page: Page, comer: _Comer, run: Run) -> Response:
        """Return the response to a request whose turn it is; its body is read before it takes a thread."""
        form, means = Form(), page.means
        if request.method == "POST":
            try:
                form = await read_form(request, means)
            except Refused as why:
                return await run(self._refused, request, comer, why)
        if page.attempt is not None and request.method == "POST":
            return await self._attempted(request, page, comer, form, run)
        if not form.files:
            return await run(self._answered, request, page, comer, form)
        async with self.site.places.one(means.name, means.readings, _STAFF_WAITING):
            return await run(self._answered, request, page, comer, form)

    async def _attempted(self, request: Request, page: Page, comer: _Comer, form: Form, run: Run) -> Response:
        """Respond to a form with a password, after the delay caused by earlier failures; no thread waits
        meanwhile."""
        attempt = await run(self._attempt, request, page, comer, form)
        if isinstance(attempt, Response):
            return attempt
        try:
            async with self._attempts.waited(attempt):
                return await run(self._answered, request, page, comer, form)
        except TooMany as fault:
            return await run(self._refused, request, comer, Refused("too_often", 429, fault.seconds))

    def _attempt(self, request: Request, page: Page, comer: _Comer, form: Form) -> Attempt | Response:
        try:
            self._check_seal(request, comer.session, form)
            return page.attempt(self._visit(request, comer, form)) if page.attempt else Attempt()
        except Refused as why:
            return self._refused(request, comer, why)
        except BadInput as fault:
            return self._refused(request, comer, _mistaken(fault))

    def _let_in(self, request: Request, page: Page) -> _Comer | Response:
        """Return the current user if they have the permission; otherwise the response of the refusal. The
        form is not read before."""
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
            posted = request.method == "POST"
            check_permission(self.site, page, comer.person, request.path_params, posted=posted)
        except Refused as why:
            return self._refused(request, comer, why)
        return comer

    def _answered(self, request: Request, page: Page, comer: _Comer, form: Form) -> Response:
        visit, begun = self._visit(request, comer, form), processor_time()
        try:
            if visit.posted:
                self._check_seal(request, comer.session, form)
            reply = page.answer(visit)
            note_export(page, visit, reply)
            happened(request, FAILED if reply.status == 401 else "", visit.person.id if visit.person else 0)
            return self._sent(request, comer, reply)
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
        finally:
            if comer.person is not None:
                self.site.limits.took(page.limit, comer.person.id, processor_time() - begun)

    def _lost(self, request: Request, why: Refused) -> Response:
        try:
            self._check_host(request)
            comer = self._comer(request)
        except (Refused, BadInput):
            return self._without_person(request, why)
        return self._refused(request, comer, why)

    # -------------------------------------------------------------- who comes

    def _comer(self, request: Request) -> _Comer:
        cookie = request.cookies.get(self._cookie, "")
        session, person = self._signed_in(cookie)
        is_new = session is None and not self.cookies.is_anonymous(cookie)
        if session is None:
            session = self.cookies.anonymous() if is_new else Session(cookie)
            person = self._owner() if self.site.entrance is Entrance.LOCAL else None
        request.state.person = person.id if person else 0
        return _Comer(session, is_new, person, self._lang(request, person))

    def _signed_in(self, token: str) -> tuple[Session | None, Person | None]:
        """Return the session of a token and its person: one indexed read, and a write every few minutes."""
        if not may_be_token(token):
            return None, None
        now = datetime.now(UTC)
        with self.site.store.reading() as connection:
            row = session_of(connection, token, now)
            self.site.follow(connection, None if row is None else taken_of(row.taken))
            person = person_of(connection, row) if row is not None else None
        if row is None:
            return None, None
        if now - row.session_seen > TOUCHED:
            with suppress(BadInput), self.site.store.begin() as connection:  # a full disk refuses no reader
                touch_session(connection, row.session_id, row.session_created, now)
        return Session(token, row.session_id), person

    def _owner(self) -> Person | None:
        """Return who opens the site on their own machine."""
        number = home.owner(self.site)
        with self.site.store.reading() as connection:
            row = person_by_id(connection, number)
            self.site.follow(connection)
            return person_of(connection, row) if row is not None else None

    def _lang(self, request: Request, person: Person | None) -> str:
        known = self.site.languages
        asked = [request.cookies.get(self._lang_cookie, ""), person.lang if person else ""]
        asked += [
            one.split(";")[0].strip()[:2].lower()
            for one in request.headers.get("accept-language", "")[:500].split(",")
        ]
        return next((lang for lang in asked if lang in known), known[0])

    def _visit(self, request: Request, comer: _Comer, form: Form) -> Visit:
        return Visit(
            self.site, comer.person, comer.lang, arrived(self.site.clock), clean(request.scope["path"]), dict(request.path_params),
            {clean(name): clean(text) for name, text in request.query_params.items()}, form, request.method == "POST",
            self.cookies.seal(comer.session),
            request.headers.get("hx-request") == "true" and request.headers.get("hx-boosted") != "true",
            _address(request), comer.session.id, request.cookies.get(self._device, ""),
        )  # fmt: skip

    # ------------------------------------------------------------ whether they may

    def _check_host(self, request: Request) -> None:
        """Check the host name against DNS rebinding; where no password is needed, also refuse requests that a
        proxy forwarded."""
        if _host(f"//{request.headers.get('host', '')}") not in (_host(self.site.url), *_LOOPBACK):
            raise Refused("page", 421)
        if self.site.entrance is not Entrance.ACCOUNTS and any(one in request.headers for one in _FORWARDED):
            raise Refused("forwarded", 421)

    def _check_often(self, request: Request, page: Page, comer: _Comer) -> None:
        """Check the limits on the rate of requests and on processor time.

        What stores and shows nothing, handing in among it, is refused to nobody for what they did before.
        """
        person, limits = comer.person.id if comer.person else 0, self.site.limits
        browser = "" if person else Devices(self.site.secret).name(request.cookies.get(self._device, ""))
        wait = limits.asked(page.limit, person, _address(request), browser)
        if comer.person is not None and not comer.person.is_staff and not page.is_short:
            wait = max(wait, limits.owed(page.limit, person))
        if wait:
            raise Refused("too_often", 429, wait)

    def _check_origin(self, request: Request) -> None:
        """Check that a form comes from a page of this site, as far as the browser tells."""
        sent, host = request.headers.get("origin"), request.headers.get("host", "")
        own = {_origin(self.site.url)}
        if _host(f"//{host}") in _LOOPBACK:
            own.add(f"http://{host}")
        if sent is not None and sent not in own:
            raise Refused("form", 403)
        if request.headers.get("sec-fetch-site", "none") not in ("same-origin", "none"):
            raise Refused("form", 403)

    def _check_seal(self, request: Request, session: Session, form: Form) -> None:
        """Check the CSRF token of a form."""
        if not self.cookies.fits(session, request.headers.get("x-seal") or form.text("_seal")):
            raise Refused("form", 403)

    # ----------------------------------------------------------------- what goes back

    def _sent(self, request: Request, comer: _Comer, reply: Reply) -> Response:
        response = response_of(request, reply, self.site.is_secure)
        if reply.keep:
            return response
        if reply.signed_in is not None:
            before = comer.person.id if comer.person else 0
            happened(request, SIGNED_IN if reply.signed_in else SIGNED_OUT, reply.signed_in or before)
            token, seconds = self._other_session(request, comer, reply.signed_in)
            self._set_cookie(response, self._cookie, token, seconds)
        elif comer.is_new:
            self._set_cookie(response, self._cookie, comer.session.token, ANONYMOUS_SECONDS)
        if reply.device:
            self._set_cookie(response, self._device, reply.device, DEVICE_SECONDS)
        if reply.lang:
            self._set_cookie(response, self._lang_cookie, reply.lang, _YEAR)
        return response

    def _other_session(self, request: Request, comer: _Comer, person: int) -> tuple[str, int]:
        """End the session that the browser had. Return the token of a new one, of nobody for 0, and its seconds."""
        browser = described(request.headers.get("user-agent", ""))
        if not person and not comer.session.id:
            return self.cookies.anonymous().token, ANONYMOUS_SECONDS
        with self.site.store.begin() as connection:
            if comer.person is not None:
                end_session(connection, comer.session.id, comer.person.id)
            if not person:
                return self.cookies.anonymous().token, ANONYMOUS_SECONDS
            token = begin_session(connection, person, browser, datetime.now(UTC))
        return token, int(LONGEST.total_seconds())

    def _set_cookie(self, response: Response, name: str, value: str, seconds: int) -> None:
        response.set_cookie(
            name, value, max_age=seconds, httponly=True, samesite="lax", secure=self.site.is_secure
        )

    def _refused(self, request: Request, comer: _Comer, why: Refused) -> Response:
        happened(request, event_of(why), comer.person.id if comer.person else 0)
        visit = self._visit(request, comer, Form())
        if why.sentence == "sign_in" and not visit.posted and not visit.is_piece:
            return self._sent(request, comer, Reply(goto=home.door_to(visit)))
        response = self._sent(request, comer, _refusal(visit, why))
        if why.status in (429, 503) and why.parts:
            response.headers["retry-after"] = str(why.parts[0])
        return response

    def _broken(self, request: Request) -> Response:
        """Return the response to an unexpected fault; a short text if even the error page fails."""
        try:
            return self._without_person(request, Refused("fault", 500))
        except Exception as fault:
            LOG.error("the page for that: %s", _place_of(fault))
            return response_of(
                request, Reply("Error 500", 500, kind="text/plain; charset=utf-8"), self.site.is_secure
            )

    def _without_person(self, request: Request, why: Refused) -> Response:
        """Return a refusal without the data of any person; no session begins."""
        happened(request, event_of(why))
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
    """Return the refusal for a fault in the input, with its message; for an unavailable database, status 503."""
    if isinstance(fault.__cause__, (DBAPIError, NoConnection)):
        damaged = type(fault.__cause__) is DatabaseError
        LOG.error("the database: %s", "its file is damaged" if damaged else type(fault.__cause__).__name__)
        return Refused("busy", 503, _AGAIN)
    return Refused("mistaken", 422, str(fault))


def _check_path(request: Request) -> None:
    """Check the path: refuse control characters and numbers too large for the database."""
    if any(ord(letter) < 32 or letter in "\x7f\ufffd" for letter in request.scope["path"]):
        raise Refused("page", 404)
    if any(isinstance(one, int) and one > _GREATEST for one in request.path_params.values()):
        raise Refused("page", 404)


def _address(request: Request) -> str:
    """Return the client's address as the server states it: headers of the request count only behind a
    configured proxy."""
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
