"""Web service of LTI within a site, under ``/lti``: login, launch, keys, and the pages of a session."""

from __future__ import annotations

import hmac
import json
import time
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from contextlib import asynccontextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import httpx
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import JSONResponse, RedirectResponse, Response
from starlette.routing import Route

from coursework.errors import BadInput
from coursework.language.words import words
from coursework.messages import number_form
from coursework.platforms.lti import deep_linking
from coursework.platforms.lti.class_list import as_csv
from coursework.platforms.lti.key_sets import KeySets
from coursework.platforms.lti.keys import KeyFolder
from coursework.platforms.lti.launch import PICKING, Launch, launch_of
from coursework.platforms.lti.login import Login, cookie_of, session_cookie
from coursework.platforms.lti.refusal import LTIRefusal
from coursework.platforms.lti.roles import Role
from coursework.platforms.lti.sending import Sender
from coursework.platforms.lti.services import Member, NotServed, Services
from coursework.platforms.lti.settings import LTIPlatform, Settings, checked_url, read_settings
from coursework.platforms.lti.storage import Storage, Waiting
from coursework.platforms.lti.tokens import verified
from coursework.site.frame.budgets import BOXES, HAND_IN
from coursework.site.frame.cookies import Session
from coursework.site.frame.forms import read_form
from coursework.site.frame.requests import FormData, preferred_language
from coursework.site.frame.requests import HTTPException as RefusedRequest
from coursework.site.frame.security_log import FAILED, SIGNED_IN, event_of, location_of, log_event
from coursework.site.frame.settings import Site
from coursework.site.frame.turns import Visitor, check_limits, counted_time, log_request, visitor_slot
from coursework.site.lti.launch_request import LTIRequest
from coursework.site.lti.offers import offer_groups
from coursework.site.lti.scores import ScoreWatch
from coursework.site.lti.site_host import SiteHost
from coursework.system.headers import Guarded, origin, security_headers

_ROSTER_SECONDS = 60.0  #: for which a roster is cached
_SECONDS = 8.0  #: time limit of a platform's response


PATH = "/lti"


def settings_of(folder: Path, url: str) -> Settings:
    """Return the settings of the platforms in a folder, for a site at an address.

    Raises
    ------
    BadInput
        The file cannot be read, or was written for a service at another address.
    """
    settings, due = read_settings(folder), checked_url(url, "the site's --url") + PATH
    if settings.url not in ("", due):
        raise BadInput(
            "{folder}: platforms.toml is for a service at {found}, and the site has it at {due}: "
            "coursework lti platform --in {folder} --url {due}, and register that address on the platform",
            folder=folder,
            found=settings.url,
            due=due,
        )
    return replace(settings, url=due)


def mounted(
    site: Site,
    folder: Path,
    client: httpx.Client | None = None,
    settings: Settings | None = None,
    clock: Callable[[], float] = time.time,
) -> Starlette:
    """Return the service of a site as an ASGI application, with its own cookies, headers and refusals.

    Parameters
    ----------
    site
        Site that provides the content of links.
    folder
        Folder of the platforms and the keys.
    client
        HTTP client for platforms; by default with short time limits.
    settings
        Its address, its platforms and its time limits; by default those of the folder.
    clock
        Function that returns the time in seconds.
    """
    settings = settings or settings_of(folder, site.url)
    lti_service = _Service(settings, site, client or _client(), clock)
    watch = ScoreWatch(site, lti_service.storage, lti_service.sender.wake)
    routes = [
        lti_service.route("/login", lti_service.login, ["GET", "POST"]),
        lti_service.route("/launch", lti_service.launch, ["POST"], "sign_in"),
        lti_service.route("/jwks", lti_service.jwks, ["GET"]),
        lti_service.route("/at/{session}", lti_service.page, ["GET", "POST"]),
        lti_service.route("/at/{session}/{path:path}", lti_service.page, ["GET", "POST"]),
    ]

    @asynccontextmanager
    async def running(app: Starlette) -> AsyncIterator[None]:
        lti_service.sender.start()
        watch.start()
        yield
        watch.stop()
        await run_in_threadpool(lti_service.sender.stop)

    handlers: Mapping[Any, Any] = {HTTPException: lti_service.no_page}
    app = Starlette(routes=routes, lifespan=running, exception_handlers=handlers)
    is_secure = settings.url.startswith("https:")
    app.add_middleware(Guarded, is_secure=lambda: is_secure, frames=settings.frames)
    app.router.redirect_slashes = False  # it would redirect to any host that a request names
    app.state.sender, app.state.watch = lti_service.sender, watch
    return app


def _client() -> httpx.Client:
    return httpx.Client(
        timeout=_SECONDS, follow_redirects=False, headers={"User-Agent": "coursework"}, trust_env=False
    )


class _Service:
    """Endpoints of the service."""

    def __init__(self, settings: Settings, site: Site, client: httpx.Client, clock: Callable[[], float]):
        self.settings, self.site, self._clock = settings, site, clock
        self.storage = Storage(site.store, clock)
        self.keys = KeyFolder(settings.folder / "keys", clock)
        self.key_sets = KeySets(client)
        self.services = Services(client, self.keys)
        self.sender = Sender(settings, self.storage, self.services)
        self.host = SiteHost(site, self.storage, self.sender.wake)
        self._login = Login(settings, self.keys.secret, clock)
        self._rosters: dict[str, tuple[float, list[Member]]] = {}

    # ------------------------------------------------------------------ requests

    def route(
        self,
        path: str,
        work: Callable[[Request, FormData], Response],
        methods: Sequence[str],
        limit: str = "usual",
    ) -> Route:
        """Return the route of an endpoint under the site's limits, with a kind of page
        (:mod:`coursework.site.frame.limits`) for requests without a session; a refusal or an unexpected fault
        becomes a page, never a traceback."""

        async def answer(request: Request) -> Response:
            begun, refusal, fault_at = time.perf_counter(), None, ""
            try:
                response = await self._response(request, work, limit)
            except Exception as fault:
                refusal = _refusal_of(fault)
                fault_at = location_of(fault) if refusal.why == "failed" else ""
                response = await run_in_threadpool(self.refused, request, refusal)
            self._guard(response, request)
            self._log(request, PATH + path, response, begun, refusal, fault_at)
            return response

        return Route(path, answer, methods=list(methods))

    async def _response(
        self, request: Request, work: Callable[[Request, FormData], Response], limit: str
    ) -> Response:
        """Run an endpoint in the threads of the site, when its limits allow the person of the session, or the
        address of somebody unknown, another request. A student's form is a submission, which precedes
        pages."""
        lanes, is_post = self.site.lanes, request.method == "POST"
        launch = await (lanes.short if is_post else lanes.usual)(self._launch_of, request)
        is_short = is_post and launch is not None and launch.role is Role.STUDENT
        kind = limit if launch is None else "hand_in" if is_short else "paper"
        visitor, budget = _visitor(launch), HAND_IN if is_short else BOXES
        check_limits(self.site, kind, visitor, _address(request), is_short=is_short)
        async with visitor_slot(self.site, visitor, budget):
            form = await read_form(request, budget) if is_post else FormData()
            return await (lanes.short if is_short else lanes.usual)(
                self._counted, kind, visitor, work, request, form
            )

    def _counted(
        self,
        kind: str,
        visitor: Visitor,
        work: Callable[[Request, FormData], Response],
        request: Request,
        form: FormData,
    ) -> Response:
        with counted_time(self.site, kind, visitor):
            return work(request, form)

    def _log(
        self,
        request: Request,
        path: str,
        response: Response,
        begun: float,
        refusal: LTIRefusal | None,
        fault: str,
    ) -> None:
        """Log a request as the site does, with the reason of a refusal, and its event of security."""
        label = _visitor(getattr(request.state, "launch", None)).label
        is_error = bool(fault)
        why = fault or str(refusal or "")
        log_request(request.method, path, response.status_code, begun, label, why, is_error=is_error)
        if refusal is not None:
            event = FAILED if refusal.status == 401 else event_of(refusal.why, refusal.status)
        else:
            event = SIGNED_IN if path == f"{PATH}/launch" else ""
        if event:
            log_event(event, request.method, path, label, _address(request))

    def _launch_of(self, request: Request) -> Launch | None:
        """Return the launch of the session in the address, for this browser; None if the address has no
        session."""
        name = request.path_params.get("session")
        if name is None:
            return None
        request.state.launch = launch = self.storage.launch(
            name, request.cookies.get(session_cookie(name, self.settings.url))
        )
        return launch

    def _guard(self, response: Response, request: Request) -> None:
        """Add the security headers; registered platforms may show the page in a frame."""
        state = request.state
        frames = getattr(state, "frames", self.settings.frames)
        forms = dict.fromkeys([*self.settings.frames, *getattr(state, "forms", ())])
        is_secure = self.settings.url.startswith("https:")
        response.headers.update(
            security_headers(is_secure, frames, list(forms), getattr(state, "scripts", ()))
        )
        response.headers.setdefault("Cache-Control", "no-store")

    def refused(self, request: Request, fault: LTIRefusal) -> Response:
        lang = preferred_language(request.headers.get("accept-language", ""), self.site.languages)
        texts = words(lang)["lti"]["refused"]
        names = {
            "title": texts["title"],
            "message": texts.get(fault.why, texts["failed"]),
            "again": fault.again,
            "action": f"{self.settings.url}/login",
            "targets": " ".join(dict.fromkeys(origin(p.auth_url) for p in self.settings.platforms)),
            "back": "",
        }
        after = {"Retry-After": str(fault.wait)} if fault.wait else None
        return Response(
            self.host.pages.page("platform/lti_message", lang, names),
            fault.status,
            after,
            media_type="text/html",
        )

    async def no_page(self, request: Request, fault: HTTPException) -> Response:
        why = "method" if fault.status_code == 405 else "page"
        response = await run_in_threadpool(self.refused, request, LTIRefusal(why, fault.status_code))
        self._guard(response, request)
        return response

    # ------------------------------------------------------------------ launches

    def jwks(self, request: Request, form: FormData) -> Response:
        return JSONResponse(self.keys.public, headers={"Cache-Control": "public, max-age=300"})

    def login(self, request: Request, form: FormData) -> Response:
        parameters = (
            {name: form.text(name) for name in form.texts} if form.texts else dict(request.query_params)
        )
        sent = self._login.sent(parameters)
        response = RedirectResponse(sent.url, 302)
        self._set_cookie(response, sent.cookie, sent.value, self.settings.login_seconds)
        return response

    def launch(self, request: Request, form: FormData) -> Response:
        if "error" in form.texts:
            raise LTIRefusal("bad_request", 400, f"the platform says {form.text('error')[:60]!r}")
        state, token = form.text("state"), form.text("id_token")
        if not state or not token:
            raise LTIRefusal("bad_request", 400, "state or id_token missing")
        back = self._login.returned(state, request.cookies)
        claims = verified(token, self.settings, self.key_sets, back.platform)
        if not hmac.compare_digest(str(claims["nonce"]).encode("utf-8", "replace"), back.nonce.encode()):
            raise LTIRefusal("nonce", 400, "the nonce of another login")
        launch = launch_of(claims)
        if not back.platform.emails_verified:  # on such a platform anybody can enter any address
            launch = replace(launch, email="")
        if not self.storage.use(back.nonce, back.until):
            raise LTIRefusal("replayed", 403, "a launch that came before")
        if launch.kind == PICKING and not launch.role.picks:
            raise LTIRefusal("role", 403, f"deep linking by {launch.role}")
        name, secret = self.storage.begin(launch, self.settings.session_seconds)
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

    def page(self, request: Request, form: FormData) -> Response:
        name = request.path_params["session"]
        launch = request.state.launch
        lti_request = self._lti_request(launch, name, request)
        if request.method == "POST":
            self._check_csrf_token(request, name, form)
        if launch.kind == PICKING:
            response = self._picking(lti_request, form, request)
        elif lti_request.path == "roster.csv":
            response = self._roster_file(lti_request)
        else:
            response = self.host.answer(lti_request, form if request.method == "POST" else None)
        platform = self._platform(launch)
        request.state.frames = platform.frames
        return response

    def _lti_request(self, launch: Launch, name: str, request: Request | None = None) -> LTIRequest:
        return LTIRequest(
            launch,
            preferred_language(
                launch.locale or (request.headers.get("accept-language", "") if request else ""),
                self.site.languages,
            ),
            f"{self.settings.url}/at/{name}",
            request.path_params.get("path", "") if request else "",
            dict(request.query_params) if request else {},
            self.site.cookies.csrf_token(Session(name)),
            (lambda: self._roster(launch)) if launch.memberships else None,
            lambda: self._scores(launch),
        )

    def _scores(self, launch: Launch) -> dict[str, Waiting]:
        return {waiting.launch.person: waiting for waiting in self.storage.scores(launch)}

    def _check_csrf_token(self, request: Request, name: str, form: FormData) -> None:
        """Check the CSRF token of a form: the form must come from a page of this session."""
        sent = request.headers.get("origin")
        if sent is not None and sent != origin(self.settings.url):
            raise LTIRefusal("form", 403, "a form from another site")
        if not self.site.cookies.fits(Session(name), form.text("_seal")):
            raise LTIRefusal("form", 403, "a form without its csrf_token")

    # -------------------------------------------------------------------- roster

    def _platform(self, launch: Launch) -> LTIPlatform:
        platform = self.settings.platform(launch.issuer, launch.client_id)
        if platform is None:
            raise LTIRefusal("platform", 403, "a platform that is no longer known")
        return platform

    def _roster(self, launch: Launch) -> list[Member]:
        at, members = self._rosters.get(launch.course, (float("-inf"), []))
        if self._clock() - at > _ROSTER_SECONDS:
            members = self.services.roster(self._platform(launch), launch.memberships)
            self._rosters = {
                **dict(list(self._rosters.items())[-200:]),
                launch.course: (self._clock(), members),
            }
        return members

    def _roster_file(self, lti_request: LTIRequest) -> Response:
        if not lti_request.launch.role.sees_class:
            raise LTIRefusal("role", 403, "the roster")
        if lti_request.roster is None:
            raise LTIRefusal("page", 404, "no roster")
        try:
            members = lti_request.roster()
        except NotServed as fault:
            raise LTIRefusal("platform_down", 502, str(fault)) from None
        attached = {"Content-Disposition": 'attachment; filename="roster.csv"'}
        return Response(
            as_csv(members).encode("utf-8-sig"), 200, attached, media_type="text/csv; charset=utf-8"
        )

    # ------------------------------------------------------------------- picking

    def _picking(self, lti_request: LTIRequest, form: FormData, request: Request) -> Response:
        launch = lti_request.launch
        if lti_request.path or launch.picking is None or not launch.role.picks:
            raise LTIRefusal(
                "role" if not launch.role.picks else "page", 403 if not launch.role.picks else 404, "picking"
            )
        groups = offer_groups(self.site, lti_request.lang)
        if request.method == "POST":
            items = (
                []
                if form.text("cancel")
                else deep_linking.content_items(launch, groups, form.texts, self.settings.url)
            )
            return self._sent_back(lti_request, items, request)
        sought = lti_request.query.get("q", "")[:200].strip()
        names = {
            "title": words(lti_request.lang)["lti"]["pick"]["title"],
            "home": lti_request.home,
            "csrf_token": lti_request.csrf_token,
            "sought": sought,
            "several": launch.picking.several,
            "with_line": launch.picking.with_line,
            "offer_groups": deep_linking.matching_offers(groups, sought),
        }
        return Response(
            self.host.pages.page("platform/lti_pick", lti_request.lang, names), media_type="text/html"
        )

    def _sent_back(
        self, lti_request: LTIRequest, items: Sequence[dict[str, Any]], request: Request
    ) -> Response:
        """Return a page that sends the instructor and the chosen links back to the platform."""
        launch, texts = lti_request.launch, words(lti_request.lang)["lti"]["pick"]
        if launch.picking is None:
            raise LTIRefusal("page", 404, "picking")
        ready = texts["return_says"][number_form(len(items), lti_request.lang)]
        request.state.forms = [origin(launch.picking.return_url)]
        request.state.scripts = [self.host.pages.digest("platform/_lti_return.js")]
        names = {
            "title": texts["return_title"],
            "message": ready.format(len(items)),
            "address": launch.picking.return_url,
            "target": " ".join(
                dict.fromkeys([origin(launch.picking.return_url), *self._platform(launch).frames])
            ),
            "token": deep_linking.response(launch, items, self.keys.signing),
        }
        return Response(
            self.host.pages.page("platform/lti_return", lti_request.lang, names), media_type="text/html"
        )


# -------------------------------------------------------------------------- pieces


def _visitor(launch: Launch | None) -> Visitor:
    """Return the sender of a request as the limits know them: the person on the platform, whichever link they
    opened."""
    if launch is None:
        return Visitor()
    return Visitor(
        json.dumps([launch.issuer, launch.person]),
        launch.role.sees_class or launch.role.picks,
        label=f"somebody of {launch.platform}",
    )


def _address(request: Request) -> str:
    return request.client.host if request.client else ""


def _refusal_of(fault: Exception) -> LTIRefusal:
    """Return the refusal for a fault, with status 500 for an unexpected one."""
    if isinstance(fault, LTIRefusal):
        return fault
    if not isinstance(fault, RefusedRequest):
        return LTIRefusal("failed", 500)
    if fault.sentence == "too_often":
        seconds = int(str(fault.parts[0]))
        return LTIRefusal("too_often", 429, f"{seconds} s", wait=seconds)
    return LTIRefusal("too_large" if fault.status_code == 413 else "bad_request", fault.status_code, "a form")
