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
from starlette.exceptions import HTTPException as StarletteException
from starlette.requests import ClientDisconnect
from starlette.requests import Request as HTTPRequest
from starlette.responses import Response as HTTPResponse

from coursework.database.people import person_by_id
from coursework.database.sessions import (
    LONGEST,
    TOUCHED,
    begin_session,
    end_session,
    session_of,
    touch_session,
)
from coursework.database.settings import reloads_of
from coursework.errors import BadCourse, BadInput, BrokenFunction, UnknownName
from coursework.language.words import words
from coursework.messages import Message, as_message, localised, messages_in
from coursework.site.frame.arrivals import arrived
from coursework.site.frame.attempts import Attempt, Attempts, TooMany
from coursework.site.frame.browsers import described
from coursework.site.frame.cookies import ANONYMOUS_SECONDS, Cookies, Session, cookie_name, may_be_token
from coursework.site.frame.devices import DEVICE, DEVICE_SECONDS, Devices
from coursework.site.frame.forms import clean, read_form
from coursework.site.frame.permission_check import check_permission, note_export, person_of
from coursework.site.frame.requests import FormData, HTTPException, Person, Request, Response, Route
from coursework.site.frame.responses import to_http_response
from coursework.site.frame.security_log import FAILED, SIGNED_IN, SIGNED_OUT, event_of, happened, log_events
from coursework.site.frame.settings import Entrance, Site
from coursework.site.frame.threads import Lanes, Run
from coursework.site.people import home
from coursework.system.processes import processor_time
from coursework.system.request_slots import WAITING, Crowded

LOG = logging.getLogger("coursework.site")
_LANG = "coursework-lang"  #: the cookie of the language that somebody chose
_YEAR = 365 * 24 * 3600
_LOOPBACK = ("127.0.0.1", "localhost", "::1")
_GREATEST = 2**31 - 1  #: greatest integer of a database column
_FORWARDED = ("x-forwarded-for", "x-forwarded-host", "forwarded", "x-real-ip")  #: headers that a proxy adds
_STAFF_WAITING = 1000  #: waiting requests of a member of staff: a page of many pictures requests all at once
_CROWDED = 2  #: seconds to wait if too many requests wait
_AGAIN = 5  #: seconds to wait if the database is unavailable


class _CurrentUser(NamedTuple):
    """Current user of a request."""

    session: Session
    is_new: bool  #: the browser has no cookie of the session yet
    person: Person | None
    lang: str


class Middleware:
    """Middleware of all requests."""

    def __init__(self, site: Site):
        self.site, self.cookies, self._lanes = site, Cookies(site.secret), Lanes(site.store)
        self._lang_cookie = cookie_name(site.is_secure, _LANG)
        self._cookie, self._attempts = cookie_name(site.is_secure), Attempts()
        self._device = cookie_name(site.is_secure, DEVICE)

    def endpoint(self, route: Route) -> Any:
        """Return the endpoint of a route."""

        async def answer(http_request: HTTPRequest) -> HTTPResponse:
            return await self._logged(http_request, route.path, lambda: self._answer(http_request, route))

        return answer

    async def lost(self, http_request: HTTPRequest, fault: Exception) -> HTTPResponse:
        """Return the response to an unknown address, or to a method that it does not support."""
        status = fault.status_code if isinstance(fault, StarletteException) else 404
        why = HTTPException("method" if status == 405 else "page", status)
        allowed = {"allow": "GET, HEAD"} if status == 405 else {}

        async def answer() -> HTTPResponse:
            http_response = await run_in_threadpool(self._lost, http_request, why)
            http_response.headers.update(allowed)
            return http_response

        return await self._logged(http_request, "-", answer)

    async def _logged(self, http_request: HTTPRequest, path: str, answer: Callable[[], Any]) -> HTTPResponse:
        """Return the response and log the request: the page and the number of the person, never the content."""
        begun, why = time.perf_counter(), ""
        try:
            http_response: HTTPResponse = await answer()
        except ClientDisconnect:
            http_response = HTTPResponse(status_code=400)
        except Exception as fault:  # logged without its message, which may contain an answer
            why = _location_of(fault)
            http_response = await run_in_threadpool(self._broken, http_request)
        took = 1000 * (time.perf_counter() - begun)
        level = logging.ERROR if why else logging.INFO
        person = getattr(http_request.state, "person", 0)
        by, why = (f" person {person}" if person else ""), why and f" {why}"
        LOG.log(
            level,
            "%s %s %d %.0f ms%s%s",
            http_request.method,
            path,
            http_response.status_code,
            took,
            by,
            why,
        )
        log_events(http_request, path, _address(http_request))
        return http_response

    async def _answer(self, http_request: HTTPRequest, route: Route) -> HTTPResponse:
        run = self._lanes.short if route.is_short else self._lanes.usual
        current_user = await run(self._let_in, http_request, route)
        if isinstance(current_user, HTTPResponse):
            return current_user
        if current_user.person is None:
            return await self._read_and_answered(http_request, route, current_user, run)
        means, waiting = route.request_budget, _STAFF_WAITING if current_user.person.is_staff else WAITING
        try:
            async with self.site.places.slot((current_user.person.id, means.name), means.at_once, waiting):
                return await self._read_and_answered(http_request, route, current_user, run)
        except Crowded:
            why = HTTPException("too_often", 429, _CROWDED)
            return await run(self._refused, http_request, current_user, why)

    async def _read_and_answered(
        self, http_request: HTTPRequest, route: Route, current_user: _CurrentUser, run: Run
    ) -> HTTPResponse:
        """Return the response to a request whose turn it is; its body is read before it takes a thread."""
        form, means = FormData(), route.request_budget
        if http_request.method == "POST":
            try:
                form = await read_form(http_request, means)
            except HTTPException as why:
                return await run(self._refused, http_request, current_user, why)
        if route.attempt is not None and http_request.method == "POST":
            return await self._attempted(http_request, route, current_user, form, run)
        if not form.files:
            return await run(self._answered, http_request, route, current_user, form)
        async with self.site.places.slot(means.name, means.readings, _STAFF_WAITING):
            return await run(self._answered, http_request, route, current_user, form)

    async def _attempted(
        self, http_request: HTTPRequest, route: Route, current_user: _CurrentUser, form: FormData, run: Run
    ) -> HTTPResponse:
        """Respond to a form with a password, after the delay caused by earlier failures; no thread waits
        meanwhile."""
        attempt = await run(self._attempt, http_request, route, current_user, form)
        if isinstance(attempt, HTTPResponse):
            return attempt
        try:
            async with self._attempts.waited(attempt):
                return await run(self._answered, http_request, route, current_user, form)
        except TooMany as fault:
            return await run(
                self._refused, http_request, current_user, HTTPException("too_often", 429, fault.seconds)
            )

    def _attempt(
        self, http_request: HTTPRequest, route: Route, current_user: _CurrentUser, form: FormData
    ) -> Attempt | HTTPResponse:
        try:
            self._check_csrf_token(http_request, current_user.session, form)
            return (
                route.attempt(self._page_request(http_request, current_user, form))
                if route.attempt
                else Attempt()
            )
        except HTTPException as why:
            return self._refused(http_request, current_user, why)
        except BadInput as fault:
            return self._refused(http_request, current_user, _mistaken(fault))

    def _let_in(self, http_request: HTTPRequest, route: Route) -> _CurrentUser | HTTPResponse:
        """Return the current user if they have the permission; otherwise the response of the refusal. The
        form is not read before."""
        try:
            self._check_host(http_request)
            _check_path(http_request)
        except HTTPException as why:
            return self._without_person(http_request, why)
        try:
            current_user = self._current_user(http_request)
        except BadInput:  # the database is unavailable
            return self._without_person(http_request, HTTPException("busy", 503, _AGAIN))
        try:
            self._check_often(http_request, route, current_user)
            if http_request.method == "POST":
                self._check_origin(http_request)
            is_post = http_request.method == "POST"
            check_permission(self.site, route, current_user.person, http_request.path_params, is_post=is_post)
        except HTTPException as why:
            return self._refused(http_request, current_user, why)
        return current_user

    def _answered(
        self, http_request: HTTPRequest, route: Route, current_user: _CurrentUser, form: FormData
    ) -> HTTPResponse:
        request, begun = self._page_request(http_request, current_user, form), processor_time()
        try:
            if request.is_post:
                self._check_csrf_token(http_request, current_user.session, form)
            with messages_in(request.lang):
                response = route.endpoint(request)
            note_export(route, request, response)
            happened(
                http_request,
                FAILED if response.status_code == 401 else "",
                request.person.id if request.person else 0,
            )
            return self._sent(http_request, current_user, response)
        except HTTPException as why:
            return self._refused(http_request, current_user, why)
        except UnknownName:
            return self._refused(http_request, current_user, HTTPException("page", 404))
        except BadInput as fault:
            return self._refused(http_request, current_user, _mistaken(fault))
        except BadCourse as fault:  # its folder is unavailable, or one of its files has changed
            LOG.error("the course: %s", _location_of(fault) if isinstance(fault, BrokenFunction) else fault)
            return self._refused(http_request, current_user, HTTPException("course", 503, _AGAIN))
        except IntegrityError:  # two transactions wrote the same row; this one was rolled back
            LOG.error("the database: two wrote the same at once")
            return self._refused(http_request, current_user, HTTPException("busy", 503, _AGAIN))
        finally:
            if current_user.person is not None:
                self.site.limits.add_processor_time(
                    route.limit, current_user.person.id, processor_time() - begun
                )

    def _lost(self, http_request: HTTPRequest, why: HTTPException) -> HTTPResponse:
        try:
            self._check_host(http_request)
            current_user = self._current_user(http_request)
        except (HTTPException, BadInput):
            return self._without_person(http_request, why)
        return self._refused(http_request, current_user, why)

    # ------------------------------------------------------------ current user

    def _current_user(self, http_request: HTTPRequest) -> _CurrentUser:
        cookie = http_request.cookies.get(self._cookie, "")
        session, person = self._signed_in(cookie)
        is_new = session is None and not self.cookies.is_anonymous(cookie)
        if session is None:
            session = self.cookies.anonymous() if is_new else Session(cookie)
            person = self._owner() if self.site.entrance is Entrance.LOCAL else None
        http_request.state.person = person.id if person else 0
        return _CurrentUser(session, is_new, person, self._lang(http_request, person))

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

    def _lang(self, http_request: HTTPRequest, person: Person | None) -> str:
        languages = self.site.languages
        preferences = [http_request.cookies.get(self._lang_cookie, ""), person.lang if person else ""]
        preferences += [
            preference.split(";")[0].strip()[:2].lower()
            for preference in http_request.headers.get("accept-language", "")[:500].split(",")
        ]
        return next((lang for lang in preferences if lang in languages), languages[0])

    def _page_request(self, http_request: HTTPRequest, current_user: _CurrentUser, form: FormData) -> Request:
        return Request(
            self.site, current_user.person, current_user.lang, arrived(self.site.clock), clean(http_request.scope["path"]), dict(http_request.path_params),
            {clean(name): clean(text) for name, text in http_request.query_params.items()}, form, http_request.method == "POST",
            self.cookies.csrf_token(current_user.session),
            http_request.headers.get("hx-request") == "true" and http_request.headers.get("hx-boosted") != "true",
            _address(http_request), current_user.session.id, http_request.cookies.get(self._device, ""),
        )  # fmt: skip

    # -------------------------------------------------------------- checks

    def _check_host(self, http_request: HTTPRequest) -> None:
        """Check the host name against DNS rebinding; where no password is needed, also refuse requests that a
        proxy forwarded."""
        if _host(f"//{http_request.headers.get('host', '')}") not in (_host(self.site.url), *_LOOPBACK):
            raise HTTPException("page", 421)
        if self.site.entrance is not Entrance.ACCOUNTS and any(
            header in http_request.headers for header in _FORWARDED
        ):
            raise HTTPException("forwarded", 421)

    def _check_often(self, http_request: HTTPRequest, route: Route, current_user: _CurrentUser) -> None:
        """Check the limits on the rate of requests and on processor time.

        Routes that only store, such as submission, are not refused because of earlier processor time.
        """
        person, limits = current_user.person.id if current_user.person else 0, self.site.limits
        browser = "" if person else Devices(self.site.secret).name(http_request.cookies.get(self._device, ""))
        wait = limits.wait_for_rate(route.limit, person, _address(http_request), browser)
        if current_user.person is not None and not current_user.person.is_staff and not route.is_short:
            wait = max(wait, limits.wait_for_processor(route.limit, person))
        if wait:
            raise HTTPException("too_often", 429, wait)

    def _check_origin(self, http_request: HTTPRequest) -> None:
        """Check that a form comes from a page of this site, according to the browser's headers."""
        sent, host = http_request.headers.get("origin"), http_request.headers.get("host", "")
        origins = {_origin(self.site.url)}
        if _host(f"//{host}") in _LOOPBACK:
            origins.add(f"http://{host}")
        if sent is not None and sent not in origins:
            raise HTTPException("form", 403)
        if http_request.headers.get("sec-fetch-site", "none") not in ("same-origin", "none"):
            raise HTTPException("form", 403)

    def _check_csrf_token(self, http_request: HTTPRequest, session: Session, form: FormData) -> None:
        """Check the CSRF token of a form."""
        if not self.cookies.fits(session, http_request.headers.get("x-seal") or form.text("_seal")):
            raise HTTPException("form", 403)

    # --------------------------------------------------------------- responses

    def _sent(
        self, http_request: HTTPRequest, current_user: _CurrentUser, response: Response
    ) -> HTTPResponse:
        http_response = to_http_response(http_request, response, self.site.is_secure)
        if response.max_age:
            return http_response
        if response.signed_in is not None:
            before = current_user.person.id if current_user.person else 0
            happened(
                http_request, SIGNED_IN if response.signed_in else SIGNED_OUT, response.signed_in or before
            )
            token, seconds = self._other_session(http_request, current_user, response.signed_in)
            self._set_cookie(http_response, self._cookie, token, seconds)
        elif current_user.is_new:
            self._set_cookie(http_response, self._cookie, current_user.session.token, ANONYMOUS_SECONDS)
        if response.device:
            self._set_cookie(http_response, self._device, response.device, DEVICE_SECONDS)
        if response.lang:
            self._set_cookie(http_response, self._lang_cookie, response.lang, _YEAR)
        return http_response

    def _other_session(
        self, http_request: HTTPRequest, current_user: _CurrentUser, person: int
    ) -> tuple[str, int]:
        """End the browser's session. Return the token of a new one (anonymous for person 0), and its
        lifetime in seconds."""
        browser = described(http_request.headers.get("user-agent", ""))
        if not person and not current_user.session.id:
            return self.cookies.anonymous().token, ANONYMOUS_SECONDS
        with self.site.store.begin() as connection:
            if current_user.person is not None:
                end_session(connection, current_user.session.id, current_user.person.id)
            if not person:
                return self.cookies.anonymous().token, ANONYMOUS_SECONDS
            token = begin_session(connection, person, browser, datetime.now(UTC))
        return token, int(LONGEST.total_seconds())

    def _set_cookie(self, http_response: HTTPResponse, name: str, value: str, seconds: int) -> None:
        http_response.set_cookie(
            name, value, max_age=seconds, httponly=True, samesite="lax", secure=self.site.is_secure
        )

    def _refused(
        self, http_request: HTTPRequest, current_user: _CurrentUser, why: HTTPException
    ) -> HTTPResponse:
        happened(http_request, event_of(why), current_user.person.id if current_user.person else 0)
        request = self._page_request(http_request, current_user, FormData())
        if why.sentence == "sign_in" and not request.is_post and not request.is_fragment:
            return self._sent(http_request, current_user, Response(redirect=home.door_to(request)))
        http_response = self._sent(http_request, current_user, _refusal(request, why))
        if why.status_code in (429, 503) and why.parts:
            http_response.headers["retry-after"] = str(why.parts[0])
        return http_response

    def _broken(self, http_request: HTTPRequest) -> HTTPResponse:
        """Return the response to an unexpected fault; a short text if even the error page fails."""
        try:
            return self._without_person(http_request, HTTPException("fault", 500))
        except Exception as fault:
            LOG.error("the page for that: %s", _location_of(fault))
            return to_http_response(
                http_request,
                Response("Error 500", 500, media_type="text/plain; charset=utf-8"),
                self.site.is_secure,
            )

    def _without_person(self, http_request: HTTPRequest, why: HTTPException) -> HTTPResponse:
        """Return a refusal without the data of any person; no session begins."""
        happened(http_request, event_of(why))
        lang = self._lang(http_request, None)
        request = Request(self.site, None, lang, self.site.clock(), "/")
        http_response = to_http_response(http_request, _refusal(request, why), self.site.is_secure)
        if why.status_code == 503:
            http_response.headers["retry-after"] = str(_AGAIN)
        return http_response


def _refusal(request: Request, why: HTTPException) -> Response:
    message = str(words(request.lang, "site")["refused"][why.sentence]).format(
        *(localised(part, request.lang) if isinstance(part, Message) else part for part in why.parts)
    )
    return request.render("site/refused", why.status_code, told=message)


def _mistaken(fault: BadInput) -> HTTPException:
    """Return the refusal for a fault in the input, with its message; for an unavailable database, status 503."""
    if isinstance(fault.__cause__, (DBAPIError, NoConnection)):
        damaged = type(fault.__cause__) is DatabaseError
        LOG.error("the database: %s", "its file is damaged" if damaged else type(fault.__cause__).__name__)
        return HTTPException("busy", 503, _AGAIN)
    return HTTPException("mistaken", 422, as_message(fault))


def _check_path(http_request: HTTPRequest) -> None:
    """Check the path: refuse control characters and numbers too large for the database."""
    if any(ord(letter) < 32 or letter in "\x7f\ufffd" for letter in http_request.scope["path"]):
        raise HTTPException("page", 404)
    if any(isinstance(value, int) and value > _GREATEST for value in http_request.path_params.values()):
        raise HTTPException("page", 404)


def _address(http_request: HTTPRequest) -> str:
    """Return the client's address as the server states it: headers of the request count only behind a
    configured proxy."""
    return http_request.client.host if http_request.client else ""


def _host(url: str) -> str:
    try:
        return urlsplit(url).hostname or ""
    except ValueError:
        return ""


def _origin(url: str) -> str:
    parts = urlsplit(url)
    return f"{parts.scheme}://{parts.netloc}"


def _location_of(fault: BaseException) -> str:
    frames = traceback.extract_tb(fault.__traceback__)[-5:]
    lines = " < ".join(
        f"{frame.filename.rpartition('coursework/')[2]}:{frame.lineno}" for frame in reversed(frames)
    )
    return f"{type(fault).__name__} at {lines}"
