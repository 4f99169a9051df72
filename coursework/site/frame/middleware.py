"""Middleware of all requests: the current user, the permissions, the form, and the cookies of the response."""

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
from coursework.site.frame.security_log import FAILED, event_of, location_of, log_events
from coursework.site.frame.settings import Entrance, Site
from coursework.site.frame.threads import Lanes, Run
from coursework.site.people import home
from coursework.system.headers import origin
from coursework.system.processes import processor_time
from coursework.system.request_slots import WAITING, Crowded

LOG = logging.getLogger("coursework.site")
_LOOPBACK = ("127.0.0.1", "localhost", "::1")
_FORWARDED = ("x-forwarded-for", "x-forwarded-host", "forwarded", "x-real-ip")  #: headers that a proxy adds
_STAFF_WAITING = 1000  #: waiting requests of a member of staff: a page of many pictures requests all at once
_CROWDED = 2  #: seconds to wait if too many requests wait
_AGAIN = 5  #: seconds to wait if the database is unavailable


class Middleware:
    """Middleware of all requests."""

    def __init__(self, site: Site):
        self.site, self._lanes, self._attempts = site, Lanes(site.store), Attempts()

    async def answer(self, http: StarletteRequest, asked: Route | Exception) -> Response:
        """Return the response of a route, or to an address or a method that no route has; log the request: the page
        and the number of the person, never the content."""
        request = Request(self.site, http.scope, http.receive)
        begun, level, why = time.perf_counter(), logging.INFO, ""
        try:
            response = await self._response(request, asked)
        except ClientDisconnect:
            response = Response(status_code=400)
        except Exception as fault:
            refusal = _refusal_of(fault)
            if refusal.status_code == 500:  # logged without its message, which may contain an answer
                level, why = logging.ERROR, f" {location_of(fault)}"
                request.person, request.browser, request.is_new = None, Session(""), False
            response = await run_in_threadpool(self._refused, request, refusal)
        took = 1000 * (time.perf_counter() - begun)
        path = asked.path if isinstance(asked, Route) else "-"
        by = f" person {request.person.id}" if request.person else ""
        LOG.log(level, "%s %s %d %.0f ms%s%s", request.method, path, response.status_code, took, by, why)
        log_events(request, path)
        return response

    async def _response(self, request: Request, asked: Route | Exception) -> Response:
        """Return the response of a page. Its body is read before it takes a thread, and nothing waits in one."""
        if isinstance(asked, Exception):
            await run_in_threadpool(self._find_user, request)
            raise asked
        run: Run = self._lanes.short if asked.is_short else self._lanes.usual
        await run(self._let_in, request, asked)
        budget, slots = asked.request_budget, self.site.places
        async with AsyncExitStack() as held:
            if request.person is not None:
                waiting = _STAFF_WAITING if request.person.is_staff else WAITING
                await held.enter_async_context(
                    slots.slot((request.person.id, budget.name), budget.at_once, waiting)
                )
            if request.is_post:
                request.form = await read_form(request, budget)
            if request.is_post and asked.attempt is not None:
                attempt = await run(self._attempt, request, asked.attempt)
                await held.enter_async_context(self._attempts.waited(attempt))
            if request.form.files:
                await held.enter_async_context(slots.slot(budget.name, budget.readings, _STAFF_WAITING))
            return await run(self._page, request, asked)

    def _let_in(self, request: Request, route: Route) -> None:
        """Find the current user, and check what they may; the form is not read before."""
        self._find_user(request)
        self._check_often(request, route)
        if request.is_post:
            self._check_origin(request)
        check_permission(self.site, route, request.person, request.path_params, is_post=request.is_post)

    def _attempt(self, request: Request, attempt: Callable[[Request], Attempt]) -> Attempt:
        self._check_csrf_token(request)
        return attempt(request)

    def _page(self, request: Request, route: Route) -> Response:
        begun = processor_time()
        try:
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
        finally:
            if request.person is not None:
                spent = processor_time() - begun
                self.site.limits.add_processor_time(route.limit, request.person.id, spent)

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

    def _check_often(self, request: Request, route: Route) -> None:
        """Check the limits on the rate of requests and on processor time.

        Routes that only store, such as submission, are not refused because of earlier processor time.
        """
        person, limits = request.person.id if request.person else 0, self.site.limits
        browser = "" if person else Devices(self.site.secret).name(request.device)
        wait = limits.wait_for_rate(route.limit, person, request.client_address, browser)
        if request.person is not None and not request.person.is_staff and not route.is_short:
            wait = max(wait, limits.wait_for_processor(route.limit, person))
        if wait:
            raise HTTPException("too_often", 429, wait)

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
        """Return the response with the cookie of a new session; for a script with its redirect in a header."""
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
        if event := event_of(why):
            request.events.append((event, request.person.id if request.person else 0))
        if why.sentence == "sign_in" and not request.is_post and not request.is_fragment:
            return self._sent(request, redirect(home.door_to(request)))
        message = str(request.words["refused"][why.sentence]).format(
            *(localised(part, request.lang) if isinstance(part, Message) else part for part in why.parts)
        )
        try:
            response = request.render("site/refused", why.status_code, told=message)
        except Exception as fault:
            LOG.error("the page for that: %s", location_of(fault))
            request.is_new = False
            response = PlainTextResponse(f"Error {why.status_code}", why.status_code)
        response.headers.update(why.headers or {})
        return self._sent(request, response)


def _refusal_of(fault: Exception) -> HTTPException:
    """Return the refusal for a fault, with status 500 for an unexpected one."""
    if isinstance(fault, HTTPException):
        return fault
    if isinstance(fault, StarletteException):  # of the table of routes
        refusal = HTTPException("method" if fault.status_code == 405 else "page", fault.status_code)
        refusal.headers = {"allow": "GET, HEAD"} if fault.status_code == 405 else None
        return refusal
    if isinstance(fault, Crowded):
        return HTTPException("too_often", 429, _CROWDED)
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
    """Return the refusal for a fault in the input, with its message; for an unavailable database, status 503."""
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
