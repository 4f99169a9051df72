"""The web service: login, launch, keys, and the pages behind a launch."""

from __future__ import annotations

import asyncio
import hashlib
import hmac
import json
import logging
import re
import time
import traceback
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from contextlib import asynccontextmanager
from dataclasses import replace
from typing import Any
from urllib.parse import parse_qsl

import httpx
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import JSONResponse, RedirectResponse, Response
from starlette.routing import Route

from coursework.language.words import words
from coursework.lti import deep_linking
from coursework.lti.class_list import as_csv
from coursework.lti.host import Form, Host, Reply, Visit
from coursework.lti.key_sets import KeySets
from coursework.lti.keys import KeyFolder
from coursework.lti.launch import PICKING, Launch, launch_of
from coursework.lti.login import Login, cookie_of, session_cookie
from coursework.lti.pages import Pages
from coursework.lti.refusal import Refused
from coursework.lti.roles import Role
from coursework.lti.sending import Sender
from coursework.lti.services import SCORE, Member, NotServed, Services
from coursework.lti.settings import Platform, Settings, origin
from coursework.lti.storage import Storage, Waiting
from coursework.lti.tokens import verified
from coursework.system.allowances import Allowances, network
from coursework.system.headers import Guarded, security_headers
from coursework.system.processes import processor_time
from coursework.system.request_slots import Crowded, RequestSlots

LOG = logging.getLogger("coursework.lti")
LARGEST = 256 * 1024  #: bytes of a form
_FIELDS = 400  #: of a form
_FORM_SECONDS, _RATE = 30.0, 20_000  #: that a form may take: at once, and bytes a second
AT_ONCE = 2  #: requests of one person that are answered at once; the others wait
#: Requests that a person, or an address where nobody is known, may make at once, and that come back in a second.
PERSONS, ADDRESSES = (600.0, 10.0), (6000.0, 100.0)
#: Seconds of a processor of a student, likewise; for what is sent apart from what is looked at.
PROCESSOR = (30.0, 0.1)
_AGAIN = 2  #: seconds after which to try again where too many wait
_ROSTER_SECONDS = 60.0  #: that a roster is kept
_SECONDS = 8.0  #: that a platform has to answer

Told = Mapping[str, Sequence[str]]


def service(
    settings: Settings, host: Host, pages: Pages, *, storage: Storage | None = None, client: httpx.Client | None = None,
    clock: Callable[[], float] = time.time,
) -> Starlette:  # fmt: skip
    """Return the service as an ASGI application.

    Parameters
    ----------
    settings
        Where it stands, and the platforms that it knows.
    host
        What stands behind it.
    pages
        Renders its own pages: refusals, and what is picked for a link.
    storage
        What it keeps; in the folder of the settings unless told.
    client
        Asks platforms; one with short times to wait unless told.
    clock
        Tells the time in seconds.
    """
    desk = _Service(
        settings, host, pages, storage or Storage(settings.folder, clock), client or _client(), clock
    )
    routes = [
        Route("/login", desk.answering(desk.login), methods=["GET", "POST"]),
        Route("/launch", desk.answering(desk.launch), methods=["POST"]),
        Route("/jwks", desk.answering(desk.jwks), methods=["GET"]),
        Route("/at/{session}", desk.answering(desk.page), methods=["GET", "POST"]),
        Route("/at/{session}/{path:path}", desk.answering(desk.page), methods=["GET", "POST"]),
    ]

    @asynccontextmanager
    async def running(app: Starlette) -> AsyncIterator[None]:
        desk.sender.start()
        yield
        await run_in_threadpool(desk.sender.stop)

    handlers: Mapping[Any, Any] = {HTTPException: desk.no_page}
    app = Starlette(routes=routes, lifespan=running, exception_handlers=handlers)
    is_secure = settings.url.startswith("https:")
    app.add_middleware(Guarded, is_secure=lambda: is_secure, frames=settings.frames)
    app.router.redirect_slashes = False  # it would lead to whatever host a request names
    app.state.sender, app.state.processor = desk.sender, desk.processor
    return app


def _client() -> httpx.Client:
    return httpx.Client(
        timeout=_SECONDS, follow_redirects=False, headers={"User-Agent": "coursework"}, trust_env=False
    )


class _Service:
    def __init__(
        self,
        settings: Settings,
        host: Host,
        pages: Pages,
        storage: Storage,
        client: httpx.Client,
        clock: Callable[[], float],
    ):
        self.settings, self.host, self.pages, self.storage, self._clock = (
            settings,
            host,
            pages,
            storage,
            clock,
        )
        self.keys = KeyFolder(settings.folder / "keys", clock)
        self.key_sets = KeySets(client)
        self.services = Services(client, self.keys)
        self.sender = Sender(settings, storage, self.services)
        self._secret = self.keys.secret
        self._login = Login(settings, self._secret, clock)
        self._rosters: dict[str, tuple[float, list[Member]]] = {}
        self._places = RequestSlots()
        self._asked = {"person": Allowances(*PERSONS), "address": Allowances(*ADDRESSES)}
        self.processor = Allowances(*PROCESSOR)

    # ------------------------------------------------------------------ answering

    def answering(self, work: Callable[[Request, Told], Response]) -> Callable[[Request], Any]:
        """Return an endpoint that works in a thread; a refusal or an unexpected fault becomes a page, never a
        traceback."""

        async def answer(request: Request) -> Response:
            begun = time.perf_counter()
            try:
                response = await self._in_turn(request, work)
                why = ""
            except Refused as fault:
                response, why = await run_in_threadpool(self.refused, request, fault), str(fault)
            except Exception as fault:
                why = _place_of(fault)
                LOG.error("%s failed: %s", _shown_path(request), why)
                response = await run_in_threadpool(self.refused, request, Refused("failed", 500))
            self._guard(response, request)
            shown = _shown_path(request)
            LOG.info(
                "%s %s %d %.0f ms%s",
                request.method,
                shown,
                response.status_code,
                1000 * (time.perf_counter() - begun),
                why and f" {why}",
            )
            return response

        return answer

    async def _in_turn(self, request: Request, work: Callable[[Request, Told], Response]) -> Response:
        """Do the work once fewer requests of the same person are under way; no thread waits for that.

        Raises
        ------
        Refused
            The person, or the address where nobody is known, asks too often.
        """
        launch = await run_in_threadpool(self._launch_of, request)
        if launch is None:
            self._count("address", network(request.client.host if request.client else ""))
            return await run_in_threadpool(work, request, await _form(request))
        who = json.dumps([launch.issuer, launch.person])
        self._count("person", who)
        key = who, request.method == "POST"
        if launch.role is Role.STUDENT and (wait := self.processor.wait(key)):
            raise Refused("too_often", 429, f"{wait} s", wait=wait)
        try:
            async with self._places.slot(who, AT_ONCE):
                form = await _form(request)
                return await run_in_threadpool(self._charged, key, work, request, form)
        except Crowded:
            raise Refused("too_often", 429, "too many at once", wait=_AGAIN) from None

    def _launch_of(self, request: Request) -> Launch | None:
        """Return the launch of the session that an address names, of this browser; None where it names none."""
        name = request.path_params.get("session")
        if name is None:
            return None
        request.state.launch = launch = self.storage.launch(
            name, request.cookies.get(session_cookie(name, self.settings.url))
        )
        return launch

    def _count(self, kind: str, key: str) -> None:
        if wait := self._asked[kind].wait(key):
            raise Refused("too_often", 429, f"{wait} s", wait=wait)
        self._asked[kind].spend(key, 1.0)

    def _charged(
        self, key: tuple[str, bool], work: Callable[[Request, Told], Response], request: Request, form: Told
    ) -> Response:
        begun = processor_time()
        try:
            return work(request, form)
        finally:
            self.processor.spend(key, processor_time() - begun)

    def _guard(self, response: Response, request: Request) -> None:
        """Add the security headers: a platform that is known may show the page in a frame."""
        told = request.state
        frames = getattr(told, "frames", self.settings.frames)
        forms = dict.fromkeys([*self.settings.frames, *getattr(told, "forms", ())])
        is_secure = self.settings.url.startswith("https:")
        response.headers.update(
            security_headers(is_secure, frames, list(forms), getattr(told, "scripts", ()))
        )
        response.headers.setdefault("Cache-Control", "no-store")

    def refused(self, request: Request, fault: Refused) -> Response:
        lang = self._lang(request.headers.get("accept-language", ""))
        said = words(lang)["lti"]["refused"]
        names = {
            "title": said["title"],
            "message": said.get(fault.why, said["failed"]),
            "again": fault.again,
            "action": f"{self.settings.url}/login",
            "targets": " ".join(dict.fromkeys(origin(p.auth_url) for p in self.settings.platforms)),
            "back": "",
        }
        after = {"Retry-After": str(fault.wait)} if fault.wait else None
        return Response(
            self.pages.page("lti_message", lang, names), fault.status, after, media_type="text/html"
        )

    async def no_page(self, request: Request, fault: HTTPException) -> Response:
        why = "method" if fault.status_code == 405 else "page"
        response = await run_in_threadpool(self.refused, request, Refused(why, fault.status_code))
        self._guard(response, request)
        return response

    def _lang(self, wanted: str) -> str:
        """Return the first requested language that the host supports, from ``fr-CA, en;q=0.8`` or from
        ``fr_FR``."""
        for one in re.findall(r"[a-zA-Z]{2,3}(?=[-_,;.\s]|$)", wanted):
            if one.lower() in self.host.languages:
                return str(one.lower())
        return self.host.languages[0]

    # ---------------------------------------------------------------- the way in

    def jwks(self, request: Request, form: Told) -> Response:
        return JSONResponse(self.keys.public, headers={"Cache-Control": "public, max-age=300"})

    def login(self, request: Request, form: Told) -> Response:
        told = {name: values[0] for name, values in form.items()} if form else dict(request.query_params)
        sent = self._login.sent(told)
        response = RedirectResponse(sent.url, 302)
        self._set_cookie(response, sent.cookie, sent.value, self.settings.login_seconds)
        return response

    def launch(self, request: Request, form: Told) -> Response:
        if "error" in form:
            raise Refused("bad_request", 400, f"the platform says {_first(form, 'error')[:60]!r}")
        state, token = _first(form, "state"), _first(form, "id_token")
        if not state or not token:
            raise Refused("bad_request", 400, "state or id_token missing")
        back = self._login.returned(state, request.cookies)
        claims = verified(token, self.settings, self.key_sets, back.platform)
        if not hmac.compare_digest(str(claims["nonce"]).encode("utf-8", "replace"), back.nonce.encode()):
            raise Refused("nonce", 400, "the nonce of another login")
        launch = launch_of(claims)
        if not back.platform.emails_verified:  # anybody may have written any address there
            launch = replace(launch, email="")
        if not self.storage.use(back.nonce, back.until):
            raise Refused("replayed", 403, "a launch that came before")
        if launch.kind == PICKING and not launch.role.picks:
            raise Refused("role", 403, f"deep linking by {launch.role}")
        name, secret = self.storage.begin(launch, self.settings.session_seconds)
        self._pass_on(self._visit(launch, name))
        response = RedirectResponse(f"{self.settings.url}/at/{name}", 303)
        self._set_cookie(
            response, session_cookie(name, self.settings.url), secret, self.settings.session_seconds
        )
        self._set_cookie(response, cookie_of(state, self.settings.url), "", 0)
        return response

    def _set_cookie(self, response: Response, name: str, value: str, seconds: float) -> None:
        """Set a cookie that browsers also send in the frame of another site, partitioned by that site.
        Browsers accept it from this machine over plain HTTP as well."""
        response.headers.append(
            "set-cookie",
            f"{name}={value}; Path=/; Max-Age={int(seconds)}; HttpOnly; SameSite=None; Secure; Partitioned",
        )

    # ----------------------------------------------------------------- the pages

    def page(self, request: Request, form: Told) -> Response:
        name = request.path_params["session"]
        launch = request.state.launch
        visit = self._visit(launch, name, request)
        if request.method == "POST":
            self._check_seal(request, visit, form)
        if launch.kind == PICKING:
            response = self._picking(visit, form, request)
        elif visit.path == "roster.csv":
            response = self._roster_file(visit)
        else:
            response = self._hosted(visit, form, request.method == "POST")
        platform = self._platform(launch)
        request.state.frames = platform.frames
        return response

    def _hosted(self, visit: Visit, form: Form, posted: bool) -> Response:
        reply = self.host.take(visit, form) if posted else self.host.show(visit)
        if posted:
            self._pass_on(visit)
        return self._replied(reply)

    def _replied(self, reply: Reply) -> Response:
        if reply.goto:
            return RedirectResponse(reply.goto, 303)
        if reply.file:
            attached = {"Content-Disposition": f'attachment; filename="{reply.file}"'}
            return Response(reply.data, reply.status, attached, media_type=reply.kind)
        return Response(reply.html, reply.status, media_type="text/html")

    def _visit(self, launch: Launch, name: str, request: Request | None = None) -> Visit:
        seal = hmac.new(self._secret, f"form {name}".encode(), hashlib.sha256).hexdigest()
        return Visit(
            launch,
            self._lang(launch.locale or (request.headers.get("accept-language", "") if request else "")),
            f"{self.settings.url}/at/{name}",
            request.path_params.get("path", "") if request else "",
            dict(request.query_params) if request else {},
            seal,
            (lambda: self._roster(launch)) if launch.memberships else None,
            lambda: self._scores(launch),
        )

    def _scores(self, launch: Launch) -> dict[str, Waiting]:
        return {person: waiting for (_, person), waiting in self.storage.scores(launch.place).items()}

    def _check_seal(self, request: Request, visit: Visit, form: Told) -> None:
        """Check the CSRF token of a form: the form must come from a page of this session."""
        sent = request.headers.get("origin")
        if sent is not None and sent != origin(self.settings.url):
            raise Refused("form", 403, "a form from another site")
        if not hmac.compare_digest(_first(form, "_seal").encode(), visit.seal.encode()):
            raise Refused("form", 403, "a form without its seal")

    def _pass_on(self, visit: Visit) -> None:
        """Put the person's score on its way, should it say something new."""
        launch = visit.launch
        if launch.role is not Role.STUDENT or SCORE not in launch.scopes or not (launch.line or launch.lines):
            return
        score = self.host.score(visit)
        if score is not None and self.storage.put_score(launch, score):
            self.sender.wake()

    # -------------------------------------------------------------------- roster

    def _platform(self, launch: Launch) -> Platform:
        found = self.settings.platform(launch.issuer, launch.client_id)
        if found is None:
            raise Refused("platform", 403, "a platform that is no longer known")
        return found

    def _roster(self, launch: Launch) -> list[Member]:
        at, kept = self._rosters.get(launch.course, (float("-inf"), []))
        if self._clock() - at > _ROSTER_SECONDS:
            kept = self.services.roster(self._platform(launch), launch.memberships)
            self._rosters = {**dict(list(self._rosters.items())[-200:]), launch.course: (self._clock(), kept)}
        return kept

    def _roster_file(self, visit: Visit) -> Response:
        if not visit.launch.role.sees_class:
            raise Refused("role", 403, "the roster")
        if visit.roster is None:
            raise Refused("page", 404, "no roster")
        try:
            members = visit.roster()
        except NotServed as fault:
            raise Refused("platform_down", 502, str(fault)) from None
        return self._replied(
            Reply(file="roster.csv", kind="text/csv; charset=utf-8", data=as_csv(members).encode("utf-8-sig"))
        )

    # ------------------------------------------------------------------- picking

    def _picking(self, visit: Visit, form: Form, request: Request) -> Response:
        launch = visit.launch
        if visit.path or launch.picking is None or not launch.role.picks:
            raise Refused(
                "role" if not launch.role.picks else "page", 403 if not launch.role.picks else 404, "picking"
            )
        shelves = self.host.shelves(visit.lang)
        if request.method == "POST":
            items = (
                []
                if form.get("cancel")
                else deep_linking.content_items(launch, shelves, form, self.settings.url)
            )
            return self._sent_back(visit, items, request)
        sought = visit.query.get("q", "")[:200].strip()
        names = {
            "title": words(visit.lang)["lti"]["pick"]["title"],
            "home": visit.home,
            "seal": visit.seal,
            "sought": sought,
            "several": launch.picking.several,
            "with_line": launch.picking.with_line,
            "shelves": deep_linking.found(shelves, sought),
        }
        return Response(self.pages.page("lti_pick", visit.lang, names), media_type="text/html")

    def _sent_back(self, visit: Visit, items: Sequence[dict[str, Any]], request: Request) -> Response:
        """Return a page that sends the instructor and the chosen links back to the platform."""
        launch, said = visit.launch, words(visit.lang)["lti"]["pick"]
        if launch.picking is None:
            raise Refused("page", 404, "picking")
        ready = said["return_says"][
            "one"
            if len(items) == 1 or (not items and words(visit.lang)["numbers"]["one_below_two"])
            else "many"
        ]
        request.state.forms = [origin(launch.picking.return_url)]
        request.state.scripts = [self.pages.digest("_lti_return.js")]
        names = {
            "title": said["return_title"],
            "message": ready.format(len(items)),
            "address": launch.picking.return_url,
            "target": " ".join(
                dict.fromkeys([origin(launch.picking.return_url), *self._platform(launch).frames])
            ),
            "token": deep_linking.response(launch, items, self.keys.signing),
        }
        return Response(self.pages.page("lti_return", visit.lang, names), media_type="text/html")


# -------------------------------------------------------------------------- pieces


async def _form(request: Request) -> dict[str, list[str]]:
    """Return the fields of a form, within limits of type, size, number and time; empty unless the request is
    a POST.

    Raises
    ------
    Refused
        It is larger, takes longer, or is of another kind.
    """
    if request.method != "POST":
        return {}
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind != "application/x-www-form-urlencoded":
        raise Refused("bad_request", 415, f"a form of kind {kind[:60]!r}")
    told = request.headers.get("content-length", "")
    if told.isascii() and told.isdecimal() and (len(told) > 15 or int(told) > LARGEST):
        raise Refused("too_large", 413, "a form")
    data = b""
    try:
        async with asyncio.timeout(_FORM_SECONDS + LARGEST / _RATE):
            async for piece in request.stream():
                data += piece
                if len(data) > LARGEST:
                    raise Refused("too_large", 413, "a form")
    except TimeoutError:
        raise Refused("bad_request", 408, "a form that takes too long") from None
    try:
        pairs = parse_qsl(
            data.decode("ascii"), keep_blank_values=True, max_num_fields=_FIELDS, errors="strict"
        )
    except (UnicodeDecodeError, ValueError):
        raise Refused("bad_request", 400, "no form that can be read") from None
    found: dict[str, list[str]] = {}
    for name, value in pairs:
        found.setdefault(name, []).append(value.replace("\r\n", "\n"))
    return found


def _first(form: Told, name: str) -> str:
    return next(iter(form.get(name, ())), "")


def _shown_path(request: Request) -> str:
    """Return the path for the log, without the query and the name of the session."""
    return re.sub(r"/at/[^/]+", "/at/…", request.url.path)[:100]


def _place_of(fault: BaseException) -> str:
    """Return the type of a fault and the lines that raised it, without its message, since a message may
    contain an answer."""
    frames = traceback.extract_tb(fault.__traceback__)[-4:]
    told = " < ".join(
        f"{frame.filename.rpartition('coursework/')[2]}:{frame.lineno}" for frame in reversed(frames)
    )
    return f"{type(fault).__name__} at {told}"
