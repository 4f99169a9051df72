"""Mechanisms' files of a course, for staff: which there are, and a page to write, draw, try and save one."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from sqlalchemy import func, select
from starlette.responses import Response

from coursework.authoring.linkage_files import LINKAGES, linkage_names
from coursework.authoring.scaffold import check_name
from coursework.course.builtin import builtin_root
from coursework.course.folder import MECHANISM
from coursework.database.permissions import Permission
from coursework.database.tables import variant
from coursework.errors import BadInput, CourseworkError
from coursework.language.words import languages
from coursework.site.frame.budgets import MECHANISMS, read_apart
from coursework.site.frame.requests import HTTPException, Request, Route
from coursework.site.frame.responses import Download, redirect
from coursework.site.frame.settings import Site
from coursework.site.mechanisms.mechanism_view import CheckedBoxes, MechanismView, mechanism_view
from coursework.system.writing import write_whole

NEW = "new"  #: address of a mechanism without a name
_LONGEST = 60  #: characters of a name


def mechanisms(request: Request) -> Response:
    """Return the list of the course's mechanisms, and of those to start from."""
    own = {n: path.read_text("utf-8-sig") for n, path in request.site.course.folder.mechanisms.items()}
    templates = {name: _template(name) for name in linkage_names()}
    listed: Mapping[str, Any] = {
        kind: [(name, _title(text, request.lang) or name) for name, text in texts.items()]
        for kind, texts in (("own", own), ("templates", templates))
    }
    return request.render("site/instructor/mechanisms", is_own=is_writable(request.site), **listed)


def _template(name: str) -> str:
    return (LINKAGES / "exercises" / f"{name}{MECHANISM}").read_text("utf-8")


def _title(text: str, lang: str) -> str:
    found = re.search(rf'^title = .*\b{lang} = "([^"]+)"', text, re.MULTILINE)
    return found[1] if found else ""


def is_writable(site: Site) -> bool:
    """Return True if mechanisms can be saved: into a course of one's own, in a folder that the server may
    write."""
    root = site.course.folder.root
    return root != builtin_root().resolve() and os.access(root / "exercises", os.W_OK)


def address_of(request: Request, exercise: str) -> str:
    """Return the address of the page of an exercise's mechanism; empty if no file states one, or for somebody
    who may not."""
    if not request.user.may(Permission.ASSIGNMENTS_PUBLISH):
        return ""
    is_mechanism = request.site.course.folder.mechanism("exercises", exercise) is not None
    return f"/mechanisms/{exercise}" if is_mechanism else ""


def mechanism(request: Request) -> Response:
    """Return the page of a mechanism; for a form what its text makes, or the file, or save it."""
    name = str(request.path_params["name"])
    home = _home(request.site, name)
    if not request.is_post:
        return _page(request, name, _text(request, home), home)
    form = request.form
    action, text = form.text("do", "show"), form.text("text")
    chosen = form.text("name").strip() or ("" if name == NEW else name)
    if action == "file":
        return Download(text.encode(), "application/toml", f"{_usable(chosen) or 'mechanism'}{MECHANISM}")
    choices = None
    if action == "apply":
        titles = tuple((each, form.text(f"title_{each}").strip()) for each in languages())
        choices = CheckedBoxes(tuple(form.texts.get("varies", ())), tuple(form.texts.get("asks", ())), titles)
    view = _view(request, text, _usable(chosen) or "mechanism", choices)
    if action == "save":
        problem = view.fault or _save(request, name, chosen, text)
        if not problem:
            return redirect(f"/mechanisms/{chosen}?saved=1")
        return _page(request, name, text, home, view, problem=problem, chosen=chosen, status=422)
    if request.is_fragment:
        return request.render(
            "site/instructor/mechanism_piece",
            mechanism=name,
            view=view,
            text=view.text,
            is_changed=choices is not None,
            is_piece=True,
        )
    return _page(request, name, view.text, home, view, chosen=chosen)


def _home(site: Site, name: str) -> Path | None:
    """Return the file of a mechanism of the course; None for a new one."""
    if name == NEW:
        return None
    if name not in site.course.folder.mechanisms:
        raise HTTPException("page", 404)
    return site.course.folder.home("exercises", name)


def _text(request: Request, home: Path | None) -> str:
    if home is not None:
        return home.read_text("utf-8-sig")
    start = request.query_params.get("from", "")
    return _template(start) if start in linkage_names() else str(request.words["mechanisms"]["start"])


def _usable(name: str) -> str:
    """Return a name that an exercise can have; empty for any other."""
    try:
        check_name(name)
    except BadInput:
        return ""
    return name if len(name) <= _LONGEST else ""


def _view(request: Request, text: str, name: str, choices: CheckedBoxes | None = None) -> MechanismView:
    said = request.words["mechanisms"]
    key = ("mechanism", request.lang, name, text, choices)

    def made() -> MechanismView:
        try:
            found: MechanismView = read_apart(
                MECHANISMS, str(said["too_long"]), mechanism_view, text, name, request.lang, choices
            )
        except CourseworkError as fault:  # it takes too much, or fails in a way that nobody foresaw
            return MechanismView(text, fault=str(fault))
        return found

    view: MechanismView = request.site.explored.get(key, made)
    return view


def _page(
    request: Request,
    name: str,
    text: str,
    home: Path | None,
    view: MechanismView | None = None,
    *,
    problem: str = "",
    chosen: str = "",
    status: int = 200,
) -> Response:
    folder = request.site.course.folder
    about: Mapping[str, Any] = {
        "mechanism": name,
        "is_new": home is None,
        "text": text,
        "problem": problem,
        "chosen": chosen,
        "file_name": folder.relative(home) if home is not None else "",
        "is_own": is_writable(request.site),
        "view": view or _view(request, text, "mechanism" if home is None else name),
        "saved": request.query_params.get("saved") == "1" and home is not None,
        "is_piece": False,
    }
    return request.render("site/instructor/mechanism", status, **about)


def _save(request: Request, name: str, chosen: str, text: str) -> str:
    """Write the file into the course; return what prevents it, empty if it is saved."""
    said, site = request.words["mechanisms"], request.site
    if not is_writable(site):
        return str(said["not_own"])
    if not _usable(chosen) or chosen in (NEW, "course"):
        return str(said["bad_name"])
    folder = site.course.folder
    home = folder.home("exercises", chosen)
    if chosen != name and home is not None:
        return str(said["taken"]).format(chosen)
    with site.store.begin() as connection:
        issued = select(func.count()).select_from(variant).where(variant.c.exercise == chosen)
        if connection.scalar(issued):
            return str(said["issued"]).format(chosen)
        try:
            write_whole(home or folder.root / "exercises" / f"{chosen}{MECHANISM}", text.encode("utf-8"))
        except OSError:
            return str(said["not_own"])
        request.note(connection, "mechanism saved", exercise=chosen)
    site.take(site.reopened())
    return ""


ROUTES = (
    Route("/mechanisms", mechanisms, Permission.ASSIGNMENTS_PUBLISH),
    Route(
        "/mechanisms/{name}",
        mechanism,
        Permission.ASSIGNMENTS_PUBLISH,
        takes_forms=True,
        limit="mechanism",
        budget=MECHANISMS,
    ),
)
