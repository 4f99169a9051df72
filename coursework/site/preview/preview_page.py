"""Page of an exercise that is being edited, on this machine only: variant, sheet, solution, key and check,
renewed at each save."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from datetime import datetime
from typing import Any
from urllib.parse import urlencode, urlsplit

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from coursework.course.folder import course_folder
from coursework.language.words import languages, words
from coursework.messages import localised
from coursework.site.frame.pages import SitePages
from coursework.site.preview.previewed import ViewRequest
from coursework.site.preview.under_work import EditedExercise, View

#: Views by name, in order: content and format.
VIEWS = {
    "sheet": ("sheet", "html"),
    "pdf": ("sheet", "pdf"),
    "solution": ("solution", "html"),
    "solution_pdf": ("solution", "pdf"),
    "key": ("key", ""),
    "check": ("check", ""),
}
_LARGEST = 2**31  #: seed
_DIGITS = 12  #: of a seed in an address: a longer number exceeds the largest seed
_PAGE_HEADERS = {
    "content-security-policy": "default-src 'none'; img-src 'self' data:; style-src 'self'; "
    "script-src 'self'; connect-src "
    "'self'; "
    "frame-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'",
    "cache-control": "no-store",
    "x-content-type-options": "nosniff",
}
#: A sheet states its own policy for its scripts.
_FRAMED = {
    "content-security-policy": "frame-ancestors 'self'",
    "cache-control": "no-store",
    "x-content-type-options": "nosniff",
}


def preview(work: EditedExercise, lang: str) -> Starlette:
    """Return the application; ``lang`` is the default language."""
    pages = _PreviewPages(work, lang)
    routes = [
        Route("/", _local(pages.page)),
        Route("/state", _local(pages.state)),
        Route("/view/{view}", _local(pages.view)),
        Route("/static/{name}", _local(pages.static)),
    ]
    return Starlette(routes=routes)


def _local(answer: Callable[[Request], Response]) -> Callable[[Request], Response]:
    """Refuse a request under a host name other than this machine's own, as in DNS rebinding."""

    def answered(request: Request) -> Response:
        host = urlsplit(f"//{request.headers.get('host', '')}").hostname
        if host not in ("127.0.0.1", "localhost", "::1"):
            return Response("this page is for this machine alone\n", 421, media_type="text/plain")
        return answer(request)

    return answered


class _Choice:
    """Parameters of an address."""

    def __init__(self, query: Mapping[str, str], lang: str):
        seed = query.get("seed", "0")
        self.seed = min(int(seed[:_DIGITS]), _LARGEST) if seed.isascii() and seed.isdecimal() else 0
        self.lang = query.get("lang", lang) if query.get("lang", lang) in languages() else lang
        self.view = query.get("view", "sheet") if query.get("view") in VIEWS else "sheet"

    def address(self, **other: Any) -> str:
        return f"/?{urlencode({**vars(self), **other})}"


class _PreviewPages:
    def __init__(self, work: EditedExercise, lang: str):
        self._work, self._lang = work, lang
        self._pages = SitePages(course_folder(None))

    def page(self, request: Request) -> Response:
        """Return the whole page; the script requests it again after each change, and updates the parts that
        differ."""
        work, choice = self._work, _Choice(request.query_params, self._lang)
        stamp = work.stamp
        about = work.view(ViewRequest("about"))
        properties: Any = about.content or {"languages": [choice.lang], "version": ""}
        if choice.lang not in properties["languages"]:
            choice.lang = properties["languages"][0]
        content = self._view(choice, about)
        content = content._replace(fault=localised(content.fault, choice.lang))
        texts = words(choice.lang, "site")["preview"]
        names = {
            "lang": choice.lang,
            "said": texts,
            "exercise": work.exercise,
            "choice": choice,
            "stamp": stamp,
            "views": list(VIEWS),
            "spoken": properties["languages"],
            "version": properties["version"],
            "shown": content,
            "framed": VIEWS[choice.view][1] and content.content is not None,
            "check": work.check,
            "file": self._pages.file,
            "worked": _clock(content.worked),
            "words": words(choice.lang),
        }
        return Response(
            self._pages.rendered("site/instructor/preview", choice.lang, names),
            200,
            _PAGE_HEADERS,
            "text/html",
        )

    def _view(self, choice: _Choice, about: View) -> View:
        view, form = VIEWS[choice.view]
        if view == "check":
            result = self._work.check
            return View(result and result.content, result.fault if result else about.fault, None)
        return self._work.view(ViewRequest(view, choice.seed, choice.lang, form or "html"))

    def state(self, request: Request) -> Response:
        return JSONResponse({"stamp": self._work.stamp}, headers=_PAGE_HEADERS)

    def view(self, request: Request) -> Response:
        """Return a sheet by itself, in its current state or its last valid one."""
        choice = _Choice({**request.query_params, "view": request.path_params["view"]}, self._lang)
        view, form = VIEWS[choice.view]
        result = self._work.view(ViewRequest(view, choice.seed, choice.lang, form)) if form else None
        if result is None or not isinstance(result.content, bytes):
            return Response("", 404, _FRAMED)
        kind = "application/pdf" if form == "pdf" else "text/html; charset=utf-8"
        return Response(result.content, 200, _FRAMED, kind)

    def static(self, request: Request) -> Response:
        static_file = self._pages.static(str(request.path_params["name"]))
        if static_file is None:
            return Response("", 404, _PAGE_HEADERS)
        return Response(
            static_file[1], 200, {**_PAGE_HEADERS, "cache-control": "max-age=3600"}, static_file[0]
        )


def _clock(at: datetime | None) -> str:
    return at.strftime("%H:%M:%S") if at else ""
