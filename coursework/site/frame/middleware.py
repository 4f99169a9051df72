"""Middleware of all requests: the current user, the permissions, the form, and the cookies of the
response."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from contextlib import AsyncExitStack, suppress
from datetime import UTC, datetime
from urllib.parse import urlsplit

from sqlalchemy.exc import DatabaseError, DBAPIError, IntegrityError
from sqlalchemy.exc import TimeoutError as NoConnection
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException as StarletteException
from starlette.requests import ClientDisconnect
from starlette.requests import Request as StarletteRequest
from starlette.responses import PlainTextResponse, Response

from coursework.database.people import person_by_id
from coursework.database.sessions import TOUCHED, session_of, touch_session
from coursework.database.settings import reloads_of
from coursework.errors import BadCourse, BadInput, BrokenFunction, UnknownName
from coursework.messages import Message, as_message, localised, messages_in
from coursework.site.frame.attempts import Attempt, Attempts, TooMany
from coursework.site.frame.cookies import ANONYMOUS_SECONDS, COOKIE, LANG, Session, may_be_token
from coursework.site.frame.devices import Devices
from coursework.site.frame.forms import read_form
from coursework.site.frame.permission_check import GREATEST, check_permission, note_export, person_of
from coursework.site.frame.requests import HTTPException, Person, Request, Route, preferred_language
from coursework.site.frame.responses import redirect, set_cookie
from coursework.site.frame.security_log import FAILED, event_of, location_of, log_event
from coursework.site.frame.settings import Entrance, Site
from coursework.site.frame.threads import Run
from coursework.site.frame.turns import (
    Visitor,
    check_limits,
    counted_time,
    log_request,
    reading_slot,
    visitor_slot,
)
from coursework.site.people import home
from coursework.system.headers import origin

LOG = logging.getLogger("coursework.site")
_LOOPBACK = ("127.0.0.1", "localhost", "::1")
_FORWARDED = ("x-forwarded-for", "x-forwarded-host", "forwarded", "x-real-ip")  #: headers that a proxy adds
_AGAIN = 5  #: seconds to wait if the database is unavailable


class Middleware:
    """Middleware of all requests."""

    def __init__(self, site: Site):
        self.site, self._attempts = site, Attempts()

    async def answer(self, http: StarletteRequest, asked: Route | Exception) -> Response:
        """Return the response of a route, or to an address or a method that no route has; log the request:
        the page and the number of the person, never the content."""
        request = Request(self.site, http.scope, http.receive)
        begun, why = time.perf_counter(), ""
        try:
            response = await self._response(request, asked)
        except ClientDisconnect:
            response = Response(status_code=400)
        except Exception as fault:
            refusal = _refusal_of(fault)
            if refusal.status_code == 500:  # logged without its message, which may contain an answer
                why = location_of(fault)
                request.person, request.browser, request.is_new = None, Session(""), False
            response = await run_in_threadpool(self._refused, request, refusal)
        path = asked.path if isinstance(asked, Route) else "-"
        label = _visitor(request).label
        log_request(request.method, path, response.status_code, begun, label, why, is_error=bool(why))
        for event, person in request.events:
            log_event(
                event, request.method, path, f"person {person}" if person else "", request.client_address
            )
        return response

    async def _response(self, request: Request, asked: Route | Exception) -> Response:
        """Return the response of a page. Its body is read before it takes a thread, and nothing waits in
        one."""
        if isinstance(asked, Exception):
            await run_in_threadpool(self._find_user, request)
            raise asked
        lanes = self.site.lanes
        run: Run = lanes.short if asked.is_short else lanes.usual
        await run(self._let_in, request, asked)
        budget = asked.request_budget
        async with AsyncExitStack() as stack:
            await stack.enter_async_context(visitor_slot(self.site, _visitor(request), budget))
            if request.is_post:
                request.form = await read_form(request, budget)
            if request.is_post and asked.attempt is not None:
                attempt = await run(self._attempt, request, asked.attempt)
                await stack.enter_async_context(self._attempts.waited(attempt))
            if request.form.files:
                await stack.enter_async_context(reading_slot(self.site, budget))
            return await run(self._page, request, asked)

    def _let_in(self, request: Request, route: Route) -> None:
        """Find the current user, and check what they may; the form is not read before."""
        self._find_user(request)
        visitor = _visitor(request)._replace(
            browser="" if request.person else Devices(self.site.secret).name(request.device)
        )
        check_limits(self.site, route.limit, visitor, request.client_address, is_short=route.is_short)
        if request.is_post:
            self._check_origin(request)
        check_permission(self.site, route, request.person, request.path_params, is_post=request.is_post)

    def _attempt(self, request: Request, attempt: Callable[[Request], Attempt]) -> Attempt:
        self._check_csrf_token(request)
        return attempt(request)

    def _page(self, request: Request, route: Route) -> Response:
        with counted_time(self.site, route.limit, _visitor(request)):
            if request.is_post:
                self._check_csrf_token(request)
            elif not route.has_page:
                raise HTTPException("method", 405)
            with messages_in(request.lang):
                response = route.endpoint(request)
            note_export(route, request, response)
            if response.status_code == 401:
                request.events.append((FAILED, request.person.id if request.person else 0))
            return self._sent(request, response)

    # ------------------------------------------------------------ current user

    def _find_user(self, request: Request) -> None:
        request.lang = self._lang(request)
        self._check_host(request)
        _check_path(request)
        cookie = request.cookie(COOKIE)
        try:
            session, request.person = self._signed_in(cookie)
            if session is None and self.site.entrance is Entrance.LOCAL:
                request.person = self._owner()
        except BadInput:  # the database is unavailable
            raise HTTPException("busy", 503, _AGAIN) from None
        request.is_new = session is None and not self.site.cookies.is_anonymous(cookie)
        request.browser = session or (self.site.cookies.anonymous() if request.is_new else Session(cookie))
        request.lang = self._lang(request)

    def _signed_in(self, token: str) -> tuple[Session | None, Person | None]:
        """Return the session of a token and its person, by one indexed read; its time is updated every few
        minutes."""
        if not may_be_token(token):
            return None, None
        now = datetime.now(UTC)
        with self.site.store.reading() as connection:
            row = session_of(connection, token, now)
            self.site.follow(connection, None if row is None else reloads_of(row.taken))
            person = person_of(connection, row) if row is not None else None
        if row is None:
            return None, None
        if now - row.session_seen > TOUCHED:
            with (
                suppress(BadInput),
                self.site.store.begin() as connection,
            ):  # a page can be read even if the disk is full
                touch_session(connection, row.session_id, row.session_created, now)
        return Session(token, row.session_id), person

    def _owner(self) -> Person | None:
        """Return the owner of the site on their own machine."""
        number = home.owner(self.site)
        with self.site.store.reading() as connection:
            row = person_by_id(connection, number)
            self.site.follow(connection)
            return person_of(connection, row) if row is not None else None

    def _lang(self, request: Request) -> str:
        own = request.person.lang if request.person else ""
        preferences = request.cookie(LANG), own, request.headers.get("accept-language", "")
        return preferred_language(",".join(preferences), self.site.languages)

    # -------------------------------------------------------------- checks

    def _check_host(self, request: Request) -> None:
        """Check the host name against DNS rebinding; where no password is needed, also refuse requests that a
        proxy forwarded. Starlette's check would answer in no language, and log nothing."""
        if _host(f"//{request.headers.get('host', '')}") not in (_host(self.site.url), *_LOOPBACK):
            raise HTTPException("page", 421)
        if self.site.entrance is not Entrance.ACCOUNTS and any(h in request.headers for h in _FORWARDED):
            raise HTTPException("forwarded", 421)

    def _check_origin(self, request: Request) -> None:
        """Check that a form comes from a page of this site, according to the browser's headers."""
        sent, host = request.headers.get("origin"), request.headers.get("host", "")
        origins = {origin(self.site.url)}
        if _host(f"//{host}") in _LOOPBACK:
            origins.add(f"http://{host}")
        if sent is not None and sent not in origins:
            raise HTTPException("form", 403)
        if request.headers.get("sec-fetch-site", "none") not in ("same-origin", "none"):
            raise HTTPException("form", 403)

    def _check_csrf_token(self, request: Request) -> None:
        """Check the CSRF token of a form."""
        token = request.headers.get("x-seal") or request.form.text("_seal")
        if not self.site.cookies.fits(request.browser, token):
            raise HTTPException("form", 403)

    # --------------------------------------------------------------- responses

    def _sent(self, request: Request, response: Response) -> Response:
        """Return the response with the cookie of a new session; for a script with its redirect in a
        header."""
        if response.status_code == 303 and request.headers.get("hx-request") == "true":
            address = response.headers["location"]
            response.status_code = 200
            del response.headers["location"]
            response.headers["hx-redirect"] = address
        is_shared = "immutable" in response.headers.get("cache-control", "")
        if request.person is not None and not is_shared:
            response.headers["x-person"] = str(request.person.id)
        if request.is_new and not is_shared:
            set_cookie(request, response, COOKIE, request.browser.token, ANONYMOUS_SECONDS)
        return response

    def _refused(self, request: Request, why: HTTPException) -> Response:
        if event := event_of(why.sentence, why.status_code):
            request.events.append((event, request.person.id if request.person else 0))
        if why.sentence == "sign_in" and not request.is_post and not request.is_fragment:
            return self._sent(request, redirect(home.door_to(request)))
        message = str(request.words["refused"][why.sentence]).format(
            *(localised(part, request.lang) if isinstance(part, Message) else part for part in why.parts)
        )
        try:
            response = request.render("site/refused", why.status_code, message=message)
        except Exception as fault:
            LOG.error("the page for that: %s", location_of(fault))
            request.is_new = False
            response = PlainTextResponse(f"Error {why.status_code}", why.status_code)
        response.headers.update(why.headers or {})
        return self._sent(request, response)


def _visitor(request: Request) -> Visitor:
    person = request.person
    return Visitor(person.id, person.is_staff, label=f"person {person.id}") if person else Visitor()


def _refusal_of(fault: Exception) -> HTTPException:
    """Return the refusal for a fault, with status 500 for an unexpected one."""
    if isinstance(fault, HTTPException):
        return fault
    if isinstance(fault, StarletteException):  # of the table of routes
        refusal = HTTPException("method" if fault.status_code == 405 else "page", fault.status_code)
        refusal.headers = {"allow": "GET, HEAD"} if fault.status_code == 405 else None
        return refusal
    if isinstance(fault, TooMany):
        return HTTPException("too_often", 429, fault.seconds)
    if isinstance(fault, UnknownName):
        return HTTPException("page", 404)
    if isinstance(fault, BadInput):
        return _mistaken(fault)
    if isinstance(fault, BadCourse):  # its folder is unavailable, or one of its files has changed
        LOG.error("the course: %s", location_of(fault) if isinstance(fault, BrokenFunction) else fault)
        return HTTPException("course", 503, _AGAIN)
    if isinstance(fault, IntegrityError):  # two transactions wrote the same row; this one was rolled back
        LOG.error("the database: two wrote the same at once")
        return HTTPException("busy", 503, _AGAIN)
    return HTTPException("fault", 500)


def _mistaken(fault: BadInput) -> HTTPException:
    """Return the refusal for a fault in the input, with its message; for an unavailable database, status
    503."""
    if isinstance(fault.__cause__, (DBAPIError, NoConnection)):
        damaged = type(fault.__cause__) is DatabaseError
        LOG.error("the database: %s", "its file is damaged" if damaged else type(fault.__cause__).__name__)
        return HTTPException("busy", 503, _AGAIN)
    return HTTPException("mistaken", 422, as_message(fault))


def _check_path(request: Request) -> None:
    """Check the path: refuse control characters and numbers too large for the database."""
    if any(ord(letter) < 32 or letter in "\x7f\ufffd" for letter in request.scope["path"]):
        raise HTTPException("page", 404)
    if any(isinstance(value, int) and value > GREATEST for value in request.path_params.values()):
        raise HTTPException("page", 404)


def _host(url: str) -> str:
    try:
        return urlsplit(url).hostname or ""
    except ValueError:
        return ""
