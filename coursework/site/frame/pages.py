"""Pages of the site, rendered with the templates and the style of a course."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

from coursework.course.folder import Folder
from coursework.language.words import words
from coursework.rendering.environment import render
from coursework.rendering.html import NOT_FETCHED, environment_of
from coursework.rendering.surface import scripts_of

STATIC = Path(__file__).parents[1] / "static"
KINDS = {
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".woff2": "font/woff2",
}

#: Static files made from templates that sheets share, by file name.
_OF_SHEETS = {
    "sheet.css": "parts/page_style.css.j2",
    "motion.css": "motion/_style.html.j2",
    "paper.css": "parts/paper_style.html.j2",
    "motion.js": "motion/motion.js",
    "drawing.css": "parts/surface.css.j2",
    "fonts.css": "parts/fonts.css.j2",
    "dark.css": "parts/dark.css.j2",
    **{f"{name}.js": f"parts/{name}.js" for name in ("cells", "keys", "toolbar")},
    **{f"surface{kind}.js": f"parts/surface{kind}.js" for kind in ("", "_graph", "_paper")},
}
#: Lines of comments, and indentation, which browsers need not fetch, by content type.
_NOT_FETCHED = {
    KINDS[".js"]: re.compile(NOT_FETCHED.encode(), re.MULTILINE),
    KINDS[".css"]: re.compile(rb"^[ \t]*(?:/\*[^*]*\*/\n)?", re.MULTILINE),
}
_NONE = re.compile(rb"(?!)")

#: Files that the same pages need, as one: a request less costs a telephone less than the bytes.
_JOINED = {
    "look.css": ("fonts.css", "sheet.css", "site.css", "motion.css", "dark.css"),
    "basis.js": ("htmx.min.js", "site.js"),
    "answering.js": ("practice.js", "sheet.js", "cells.js", "keys.js", "keeping.js"),
    "mechanisms.js": ("toolbar.js", "mechanism.js", "mechanism_drawing.js"),
    **{
        f"drawing_{'_'.join(kinds)}.js": tuple(Path(script).name for script in scripts_of(kinds))
        for kinds in (("graph",), ("paper",), ("graph", "paper"))
    },
}


class SitePages:
    """Renderer of the pages of one course."""

    def __init__(self, folder: Folder):
        self._folder = folder

    def page(self, template: str, lang: str, names: Mapping[str, Any]) -> str:
        """Return the page of a template, with the names that all pages need."""
        texts = words(lang, "site")
        usual = {
            "lang": lang,
            "words": words(lang),
            "said": texts,
            "paper": "a4",
            "title": texts["site"]["title"],
            "title_of_page": "",
            "course_title": self._folder.title(lang),
            "file": self.file,
        }
        return self.rendered(template, lang, {**usual, **names})

    def rendered(self, template: str, lang: str, names: Mapping[str, Any]) -> str:
        return render(environment_of(self._folder.template_folders, lang), f"{template}.html.j2", names)

    def static(self, name: str) -> tuple[str, bytes] | None:
        """Return the content type and the bytes of a shared static file, without its comments and
        indentation; None if there is no such file."""
        kind = KINDS.get(Path(name).suffix, "")
        if name in _JOINED:
            pieces = filter(None, map(self.static, _JOINED[name]))
            return kind, b"\n".join(content for _, content in pieces)
        content = self._content(name)
        return None if content is None else (kind, _NOT_FETCHED.get(kind, _NONE).sub(b"", content))

    def _content(self, name: str) -> bytes | None:
        if name in _OF_SHEETS:
            env = environment_of(self._folder.template_folders, "en")
            return render(env, _OF_SHEETS[name], {"paper": "a4", "file": self.file}).encode()
        paths = {path.name: path for path in STATIC.iterdir() if path.suffix in KINDS}
        return paths[name].read_bytes() if name in paths else None

    def file(self, name: str) -> str:
        """Return the address of a static file, which changes with the file so that browsers may cache it."""
        return f"/static/{name}?{_stamp(self, name)}"


@cache
def _stamp(pages: SitePages, name: str) -> str:
    static_file = pages.static(name)
    return sha256(static_file[1]).hexdigest()[:12] if static_file else ""
