"""Practice: the course in its order, an exercise with a variant of one's own, answers checked one by one or together."""

from __future__ import annotations

from functools import partial
from typing import Any

from coursework.database.permissions import Permission
from coursework.database.progress import PersonProgress
from coursework.marking.marking import mark
from coursework.motion.gauges import EFFECTS
from coursework.rendering import motion_page, views
from coursework.rendering.displayed import DisplayedAnimation
from coursework.selfstudy.attempt import CheckedAnswers
from coursework.selfstudy.store import is_blank
from coursework.sheets.answer_sheet import answer_sheet
from coursework.site.frame.budgets import BOXES, PLAIN
from coursework.site.frame.keeping import kept
from coursework.site.frame.visits import Page, Refused, Reply, Visit
from coursework.site.papers.own_assignment import to_hand_in
from coursework.site.practice.begun import begun
from coursework.site.practice.contents import called, contents, next_of
from coursework.site.practice.worksheet import OWN, Hinted, Worksheet


def course(visit: Visit) -> Reply:
    """Return the page of the course: its order of study, the person's progress, and the next step."""
    progress = PersonProgress(visit.site.store, visit.who.id, visit.site.clock).progress
    going = next(begun(visit, progress), None)
    return visit.page(
        "site_practice",
        title=visit.said["practice"]["title"],
        chapters=contents(visit, progress),
        going=going,
        going_title=going and called(visit.site.course[going.exercise], visit.lang),
        next=next_of(visit, progress),
        due=to_hand_in(visit),
    )


def exercise(visit: Visit) -> Reply:
    """On to the variant that one is at, or to a fresh one, which a form asks for."""
    name, site = str(visit.path["exercise"]), visit.site
    if name not in site.course:
        raise Refused("page", 404)
    progress = PersonProgress(site.store, visit.who.id, site.clock, name).progress
    going = None if visit.posted else next(begun(visit, progress, name), None)
    if going is not None:
        return Reply(goto=going.address)
    seeds = {int(one["seed"]) for one in progress}
    return Reply(goto=f"/practice/{name}/{site.pool.own(name, visit.who.id, seeds)}")


def sheet(visit: Visit) -> Reply:
    """Return the page of a variant; a form checks answers, or requests a hint, the solution of a step, or
    predictions."""
    work = _worksheet(visit)
    if visit.posted:
        return _asked(visit, work)
    _warm(visit, work)
    return _page(visit, work, work.attempt.marked(), work.stands())


def _worksheet(visit: Visit) -> Worksheet:
    return Worksheet(visit, str(visit.path["exercise"]), str(visit.path["seed"]))


def _warm(visit: Visit, work: Worksheet) -> None:
    """Find beforehand what wrong answers are compared with: it is the longest part of a first check."""
    wrong = {part.id: "1.2345" for part in work.variant.parts if not part.choices}
    visit.site.ahead(("keys", work.variant), partial(mark, work.variant, wrong))


def _asked(visit: Visit, work: Worksheet) -> Reply:
    others = {} if visit.is_piece else _keep_typed(visit, work)
    _keep_predictions(visit, work)
    if place := visit.form.text("go"):
        return _gone(visit, work, place)
    texts = visit.form.texts
    hinted: dict[str, tuple[Hinted, ...]] = {}
    shown: tuple[str, ...] = ()
    if "hint" in texts or "reveal" in texts:
        checked, hinted = work.attempt.marked(), _hinted(visit, work)
    elif "check" in texts:
        checked, shown = _checked(visit, work)
    else:
        checked = work.attempt.marked()
    if visit.is_piece:
        return _pieces(visit, work, checked, shown, hinted)
    names = {"others": {OWN + n: box for n, box in others.items()}, "came": shown}
    return _page(visit, work, checked, work.typed, hinted, **names)


def _gone(visit: Visit, work: Worksheet, place: str) -> Reply:
    """Return a redirect to another page, after the drafts have been stored."""
    if place == "fresh":
        return exercise(visit)
    if place not in ("solution", "motion"):
        raise Refused("bad_request", 400)
    return Reply(goto=f"{work.address}/{place}")


def _checked(visit: Visit, work: Worksheet) -> tuple[CheckedAnswers, tuple[str, ...]]:
    """Check one answer or all of them; return the result, and the parts to show again."""
    one = visit.form.text("check")
    given = work.typed if not one else {work.part(one).id: work.typed[one]}
    checked = work.attempt.check(given)
    answered = (name for name in given if one or not is_blank(checked.answers.get(name)))
    return checked, tuple(dict.fromkeys((*answered, *checked.changed)))


def _hinted(visit: Visit, work: Worksheet) -> dict[str, tuple[Hinted, ...]]:
    """Return the hints of a question, and below them those of the requested step towards it."""
    what = "hint" if "hint" in visit.form.texts else "reveal"
    under, _, name = visit.form.text(what).partition(" ")
    work.part(under)
    name = name or under
    new = work.hint(name) if what == "hint" else work.reveal(name)
    return {under: (new,) if name == under else (work.hinted(under), new)}


def _keep_predictions(visit: Visit, work: Worksheet) -> None:
    said = {name: visit.form.text(f"predict-{name}") for name in work.parts}
    work.kept.add(work.seed, "predictions", dict(said))


def _page(
    visit: Visit, work: Worksheet, checked: CheckedAnswers, stands: dict[str, str],
    hinted: dict[str, tuple[Hinted, ...]] | None = None, **more: Any,
) -> Reply:  # fmt: skip
    names = {"others": {}, "came": (), **work.names(checked, stands), **more}
    names["hinted"] = {**names["hinted"], **(hinted or {})}
    for name in names["came"]:
        names["results"].setdefault(name, None)
    return visit.page("site_practice_sheet", **names, **_after(visit, names["summary"]))


def _pieces(
    visit: Visit, work: Worksheet, checked: CheckedAnswers, shown: tuple[str, ...], hinted: dict[str, Any]
) -> Reply:
    """Return the parts of the page that a script replaces."""
    results = work.results(checked, work.typed)
    summary = work.summary(checked, work.typed)
    return visit.page(
        "site_practice_pieces",
        own=OWN,
        sheet_page=work,
        results={name: results.get(name) for name in shown},
        compared=work.compared(checked) if shown else {},
        hinted=hinted,
        summary=summary,
        focus=_focus(visit, hinted),
        is_shown=work.attempt.is_example,
        **_after(visit, summary),
    )


def _focus(visit: Visit, hinted: dict[str, Any]) -> str:
    """Return the id of the new element that receives the keyboard focus."""
    if hinted:
        return f"hints-{OWN}{next(iter(hinted))}"
    one = visit.form.text("check")
    return f"told-{OWN}{one}" if one else "summary" if "check" in visit.form.texts else ""


def _after(visit: Visit, summary: dict[str, Any]) -> dict[str, Any]:
    """Return the next step, if every question is answered."""
    if not summary["is_done"]:
        return {"next": None}
    return {"next": next_of(visit, PersonProgress(visit.site.store, visit.who.id, visit.site.clock).progress)}


# ------------------------------------------------------------------- what is typed


def _keep_typed(visit: Visit, work: Worksheet) -> dict[str, Any]:
    """Keep what a form without script brings; gives the boxes that another page wrote to since."""
    others = work.keep_typed(visit.form.text("versions"))
    return {n: box for n, box in others.items() if box.text != work.typed[n]}


def draft(visit: Visit) -> Reply:
    """Keep what a script sends while one types."""
    _only_posted(visit)
    work = _worksheet(visit)
    return kept(visit, work.name, work.parts)


def read(visit: Visit) -> Reply:
    """Return the reading of a box; store nothing."""
    _only_posted(visit)
    work = _worksheet(visit)
    part = work.part(visit.form.text("part"))
    return Reply(str(work.read_as(part.id, work.typed[part.id])))


def _only_posted(visit: Visit) -> None:
    if not visit.posted:
        raise Refused("method", 405)


# ---------------------------------------------------------- the solution, the motion


def solution(visit: Visit) -> Reply:
    """Return the worked solution, after a confirmation that the variant then no longer counts."""
    work = _worksheet(visit)
    if visit.posted:
        work.attempt.reveal()
        return Reply(goto=f"{work.address}/solution")
    names: dict[str, Any] = {"sheet_page": work, "title": work.variant.text.title}
    if not work.attempt.is_example:
        return visit.page("site_practice_sure", **names)
    sheet_ = answer_sheet(work.variant)
    return visit.page("site_practice_solution", **{**views.context(sheet_), **names})


def motion(visit: Visit) -> Reply:
    """Return the mechanism in motion; with its numbers once every answer is correct, or after the solution
    was shown."""
    work = _worksheet(visit)
    if not work.variant.exercise.is_animated:
        raise Refused("page", 404)
    told = work.attempt.is_example or set(work.attempt.marked().right) >= {
        part.id for part in work.variant.parts if not part.sort.is_open
    }
    key = ("motion", work.exercise, work.seed, work.variant.lang, told)
    names = visit.site.shelf.get(key, lambda: _motion(work.variant, told))
    more = {"sheet_page": work, "motion_title": work.variant.text.title, "is_piece": visit.is_piece}
    return visit.page("site_practice_motion", **{**more, "motion": names})


def _motion(variant: Any, told: bool) -> dict[str, Any]:
    moving = DisplayedAnimation(variant)
    usual = [one for one in EFFECTS[:2] if one == "position" or one in moving.available]
    return motion_page.context(DisplayedAnimation(variant, usual), told=told)


PAGES = (
    Page("/practice", course, Permission.OWN),
    Page("/practice/{exercise}", exercise, Permission.OWN, posts=True, budget=PLAIN),
    Page("/practice/{exercise}/{seed}", sheet, Permission.OWN, posts=True, budget=BOXES),
    Page("/practice/{exercise}/{seed}/draft", draft, Permission.OWN, posts=True, budget=BOXES),
    Page("/practice/{exercise}/{seed}/read", read, Permission.OWN, posts=True, budget=BOXES),
    Page("/practice/{exercise}/{seed}/solution", solution, Permission.OWN, posts=True, budget=PLAIN),
    Page("/practice/{exercise}/{seed}/motion", motion, Permission.OWN),
)
