"""Web service of LTI within a site, under ``/lti``: login, launch, keys, and the pages of a session."""

from __future__ import annotations

import hmac
import json
import logging
import re
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
from coursework.site.frame.budgets import Budget
from coursework.site.frame.cookies import Session
from coursework.site.frame.forms import read_form
from coursework.site.frame.requests import FormData, preferred_language
from coursework.site.frame.requests import HTTPException as RefusedForm
from coursework.site.frame.security_log import location_of
from coursework.site.frame.settings import Site
from coursework.site.lti.launch_request import LTIRequest
from coursework.site.lti.offers import offer_groups
from coursework.site.lti.scores import ScoreWatch
from coursework.site.lti.site_host import SiteHost
from coursework.system.headers import Guarded, origin, security_headers
from coursework.system.processes import processor_time
from coursework.system.request_slots import Crowded

LOG = logging.getLogger("coursework.lti")
LARGEST = 256 * 1024  #: bytes of a form
AT_ONCE = 2  #: requests of one person that are answered at once; the others wait
_BUDGET = Budget("lti", LARGEST, 400, AT_ONCE)
_AGAIN = 2  #: seconds until another attempt if too many requests wait
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
    site: Site, folder: Path, client: httpx.Client | None = None, settings: Settings | None = None,
    clock: Callable[[], float] = time.time,
) -> Starlette:  # fmt: skip
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
        Route("/login", lti_service.answering(lti_service.login), methods=["GET", "POST"]),
        Route("/launch", lti_service.answering(lti_service.launch), methods=["POST"]),
        Route("/jwks", lti_service.answering(lti_service.jwks), methods=["GET"]),
        Route("/at/{session}", lti_service.answering(lti_service.page), methods=["GET", "POST"]),
        Route("/at/{session}/{path:path}", lti_service.answering(lti_service.page), methods=["GET", "POST"]),
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

    def answering(self, work: Callable[[Request, FormData], Response]) -> Callable[[Request], Any]:
        """Return an endpoint that works in a thread; a refusal or an unexpected fault becomes a page, never a
        traceback."""

        async def answer(request: Request) -> Response:
            begun = time.perf_counter()
            try:
                response = await self._in_turn(request, work)
                why = ""
            except LTIRefusal as fault:
                response, why = await run_in_threadpool(self.refused, request, fault), str(fault)
            except Exception as fault:
                why = location_of(fault)
                LOG.error("%s failed: %s", _shown_path(request), why)
                response = await run_in_threadpool(self.refused, request, LTIRefusal("failed", 500))
            self._guard(response, request)
            path = _shown_path(request)
            LOG.info(
                "%s %s %d %.0f ms%s",
                request.method,
                path,
                response.status_code,
                1000 * (time.perf_counter() - begun),
                why and f" {why}",
            )
            return response

        return answer

    async def _in_turn(self, request: Request, work: Callable[[Request, FormData], Response]) -> Response:
        """Run an endpoint when fewer requests of the same person are in progress, without blocking a thread
        meanwhile.

        Raises
        ------
        LTIRefusal
            The person, or the address of an unknown person, sends too many requests.
        """
        launch = await run_in_threadpool(self._launch_of, request)
        if launch is None:
            self._count(request, "")
            return await run_in_threadpool(work, request, await _form(request))
        person = json.dumps([launch.issuer, launch.person])
        self._count(request, person)
        kind = f"link {request.method}"  # pages are counted apart from forms, which a page never keeps back
        if launch.role is Role.STUDENT and (wait := self.site.limits.wait_for_processor(kind, person)):
            raise LTIRefusal("too_often", 429, f"{wait} s", wait=wait)
        try:
            async with self.site.places.slot(person, AT_ONCE):
                form = await _form(request)
                return await run_in_threadpool(self._charged, (kind, person), work, request, form)
        except Crowded:
            raise LTIRefusal("too_often", 429, "too many at once", wait=_AGAIN) from None

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

    def _count(self, request: Request, person: str) -> None:
        """Count a request of a person, or of the address of an unknown one."""
        address = request.client.host if request.client else ""
        if wait := self.site.limits.wait_for_rate("usual", 0, address, person):
            raise LTIRefusal("too_often", 429, f"{wait} s", wait=wait)

    def _charged(
        self,
        key: tuple[str, str],
        work: Callable[[Request, FormData], Response],
        request: Request,
        form: FormData,
    ) -> Response:
        begun = processor_time()
        try:
            return work(request, form)
        finally:
            self.site.limits.add_processor_time(*key, processor_time() - begun)

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
        ready = texts["return_says"][
            "one"
            if len(items) == 1 or (not items and words(lti_request.lang)["numbers"]["one_below_two"])
            else "many"
        ]
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


async def _form(request: Request) -> FormData:
    """Return the form of a POST request; an empty one for another request.

    Raises
    ------
    LTIRefusal
        The form is too large, too slow, or cannot be read.
    """
    if request.method != "POST":
        return FormData()
    try:
        return await read_form(request, _BUDGET)
    except RefusedForm as fault:
        why = "too_large" if fault.status_code == 413 else "bad_request"
        raise LTIRefusal(why, fault.status_code, "a form") from None


def _shown_path(request: Request) -> str:
    """Return the path for the log, without the query and the name of the session."""
    return re.sub(r"/at/[^/]+", "/at/…", request.url.path)[:100]
