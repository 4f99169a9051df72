"""Practice: the course in order of study, and exercises with a personal variant, checked answer by answer or
together."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime
from functools import partial
from typing import Any, NamedTuple
from urllib.parse import urlencode

from starlette.responses import HTMLResponse, Response

from coursework.database.drafts import sheets
from coursework.database.permissions import Permission
from coursework.database.progress import PersonProgress
from coursework.gradebook.own_drawings import own_drawings
from coursework.marking.marking import mark
from coursework.rendering import motion_page, views
from coursework.rendering.displayed import DisplayedAnimation
from coursework.scenes.gauges import EFFECTS
from coursework.selfstudy.attempt import CheckedAnswers
from coursework.selfstudy.mastery import RIGHT
from coursework.selfstudy.progress import ANSWER, EXAMPLE, Progress, date_of, is_blank
from coursework.sheets.answer_sheet import answer_sheet
from coursework.site.frame.budgets import BOXES, PLAIN
from coursework.site.frame.drafts import save_drafts
from coursework.site.frame.requests import HTTPException, Request, Route
from coursework.site.frame.responses import opens_offline, redirect
from coursework.site.lessons.lesson_content import LessonLink, lesson_address
from coursework.site.lessons.places import places
from coursework.site.papers.assignment_state import to_hand_in
from coursework.site.practice.contents import ChapterEntry, contents, exercise_title, next_of
from coursework.site.practice.worksheet import BOX_PREFIX, QuestionHints, Worksheet


def course(request: Request) -> Response:
    """Return the page of the course: its order of study, the person's progress, and the next step."""
    progress = PersonProgress(request.site.store, request.user.id, request.site.clock).progress
    going = next(begun(request, progress), None)
    page = request.render(
        "site/student/practice",
        title=request.words["practice"]["title"],
        chapters=contents(request, progress),
        going=going,
        going_title=going and exercise_title(request.site.course[going.exercise], request.lang),
        next=next_of(request, progress),
        due=to_hand_in(request),
        places=places(request),
    )
    return opens_offline(page)


def exercise(request: Request) -> Response:
    """Redirect to the current variant of an exercise, or to a new one if a form requests it."""
    name, site = str(request.path_params["exercise"]), request.site
    if name not in site.course:
        raise HTTPException("page", 404)
    progress = PersonProgress(site.store, request.user.id, site.clock, name).progress
    going = None if request.is_post else next(begun(request, progress, name), None)
    if going is not None:
        return redirect(going.address)
    seeds = {int(entry["seed"]) for entry in progress}
    return redirect(f"/practice/{name}/{site.pool.choose_seed(name, request.user.id, seeds)}")


def sheet(request: Request) -> Response:
    """Return the page of a variant; a form checks answers, or requests a hint, the solution of a step, or
    predictions."""
    work = _worksheet(request)
    if request.is_post:
        return _form_response(request, work)
    _warm(request, work)
    query = request.query_params  # what a form asked for: the page that it leads to can be gone back to
    hinted = _seen_hints(work, query["hint"]) if "hint" in query else {}
    came = (work.part(query["check"]).id,) if "check" in query else ()
    return opens_offline(_page(request, work, work.attempt.marked(), work.box_contents(), hinted, came=came))


class BegunVariant(NamedTuple):
    """Variant that was begun and is not finished."""

    exercise: str
    seed: int
    right: int
    questions: int

    @property
    def address(self) -> str:
        return f"/practice/{self.exercise}/{self.seed}"


def begun(request: Request, progress: Progress, exercise: str = "") -> Iterator[BegunVariant]:
    """Yield the variants to continue with, of one exercise if given."""
    for name, seed in _touched(request, progress, exercise):
        if name not in request.site.course or not request.site.pool.holds(name, seed):
            continue
        variant = _standing(request, progress, name, seed)
        if variant is not None and variant.right < variant.questions:
            yield variant


def _touched(request: Request, progress: Progress, exercise: str) -> list[tuple[str, int]]:
    with request.site.store.reading() as connection:
        typed = sheets(connection, request.user.id, f"practice/{exercise}/" if exercise else "practice/")
    when: dict[tuple[str, int], datetime] = {}
    for sheet, changed in typed.items():
        _, name, seed = sheet.split("/")
        when[name, int(seed)] = changed
    for entry in progress:
        if exercise in ("", entry["exercise"]):
            variant = str(entry["exercise"]), int(entry["seed"])
            when[variant] = max(when.get(variant, date_of(entry)), date_of(entry))
    return sorted(when, key=lambda variant: when[variant], reverse=True)


def _standing(request: Request, progress: Progress, exercise: str, seed: int) -> BegunVariant | None:
    """Return the progress on a variant; None if it was shown with its solution."""
    mine = [e for e in progress.of(exercise) if e["seed"] == seed]
    if any(e["what"] == EXAMPLE for e in mine):
        return None
    last = {e["part"]: e.get("verdict") for e in mine if e["what"] == ANSWER}
    variant = request.site.variant(exercise, seed, request.lang)
    questions = [part.id for part in variant.parts if not part.sort.is_open]
    return BegunVariant(exercise, seed, sum(last.get(name) in RIGHT for name in questions), len(questions))


def _worksheet(request: Request) -> Worksheet:
    return Worksheet(request, str(request.path_params["exercise"]), str(request.path_params["seed"]))


def _warm(request: Request, work: Worksheet) -> None:
    """Compute the data for wrong answers in advance, since it takes most of the time of the first check."""
    wrong = {part.id: "1.2345" for part in work.variant.parts if not part.choices}
    request.site.ahead(("keys", work.variant), partial(mark, work.variant, wrong))


def _form_response(request: Request, work: Worksheet) -> Response:
    target = request.form.text("go")
    with work.saving():
        choices = {name: request.form.text(f"predict-{name}") for name in work.parts}
        work.store.add(work.seed, "predictions", choices)
        checked, parts, hinted = _acted(request, work)
    if target:
        return _gone(request, work, target)
    if request.is_fragment:
        return _pieces(request, work, checked, parts, hinted)
    if work.others:  # what was typed is stored nowhere
        names = {"others": {BOX_PREFIX + n: box for n, box in work.others.items()}, "came": parts}
        return _page(request, work, checked, work.typed, hinted, **names)
    shown = {
        "check": request.form.text("check"),
        "hint": request.form.text("hint") or request.form.text("reveal"),
    }
    query = urlencode({name: text for name, text in shown.items() if text})
    return redirect(f"{work.address}?{query}" if query else work.address)


def _acted(
    request: Request, work: Worksheet
) -> tuple[CheckedAnswers, tuple[str, ...], dict[str, tuple[QuestionHints, ...]]]:
    """Do what a form requests; return the marked answers, the parts to show again, and the hints."""
    texts = request.form.texts
    if "hint" in texts or "reveal" in texts:
        return work.attempt.marked(), (), _hinted(request, work)
    if "check" in texts and "go" not in texts:
        return *_checked(request, work), {}
    return work.attempt.marked(), (), {}


def _gone(request: Request, work: Worksheet, target: str) -> Response:
    """Return a redirect to another page, after the drafts have been stored."""
    if target == "fresh":
        return exercise(request)
    if target not in ("solution", "motion"):
        raise HTTPException("bad_request", 400)
    return redirect(f"{work.address}/{target}")


def _checked(request: Request, work: Worksheet) -> tuple[CheckedAnswers, tuple[str, ...]]:
    """Check one answer or all of them; return the result, and the parts to show again."""
    box = request.form.text("check")
    given = work.typed if not box else {work.part(box).id: work.typed[box]}
    checked = work.attempt.check(given)
    answered = (name for name in given if box or not is_blank(checked.answers.get(name)))
    return checked, tuple(dict.fromkeys((*answered, *checked.changed)))


def _hinted(request: Request, work: Worksheet) -> dict[str, tuple[QuestionHints, ...]]:
    """Record the hint or the solution that a form requests; return what is then shown."""
    action = "hint" if "hint" in request.form.texts else "reveal"
    under, _, name = request.form.text(action).partition(" ")
    (work.hint if action == "hint" else work.reveal)(name or work.part(under).id)
    return _seen_hints(work, request.form.text(action))


def _seen_hints(work: Worksheet, text: str) -> dict[str, tuple[QuestionHints, ...]]:
    """Return the seen hints of a question, and below them those of the step towards it that the text of a
    button names."""
    under, _, name = text.partition(" ")
    return {work.part(under).id: tuple(map(work.hinted, dict.fromkeys((under, name or under))))}


def _page(
    request: Request,
    work: Worksheet,
    checked: CheckedAnswers,
    texts: dict[str, str],
    hinted: dict[str, tuple[QuestionHints, ...]] | None = None,
    **more: Any,
) -> Response:
    names = {"others": {}, "came": (), **work.names(checked, texts), **more}
    names["hinted"] = {**names["hinted"], **(hinted or {})}
    for name in names["came"]:
        names["results"].setdefault(name, None)
    return request.render("site/student/practice_sheet", **names, **_after(request, work, names["summary"]))


def _pieces(
    request: Request, work: Worksheet, checked: CheckedAnswers, parts: tuple[str, ...], hinted: dict[str, Any]
) -> Response:
    """Return the parts of the page that a script replaces."""
    results = work.results(checked, work.typed)
    summary = work.summary(checked, work.typed)
    return request.render(
        "site/student/practice_pieces",
        own=BOX_PREFIX,
        sheet_page=work,
        results={name: results.get(name) for name in parts},
        compared=work.compared(checked) if parts else {},
        hinted=hinted,
        summary=summary,
        focus=_focus(request, hinted),
        is_shown=work.attempt.is_example,
        **_after(request, work, summary),
    )


def _focus(request: Request, hinted: dict[str, Any]) -> str:
    """Return the id of the new element that receives the keyboard focus."""
    if hinted:
        return f"hints-{BOX_PREFIX}{next(iter(hinted))}"
    checked = request.form.text("check")
    return f"told-{BOX_PREFIX}{checked}" if checked else "summary" if "check" in request.form.texts else ""


class DoneExercise(NamedTuple):
    """Exercise whose questions are all right: its title, the lesson that teaches it, and its chapter."""

    title: str
    lesson: LessonLink | None
    chapter: ChapterEntry | None


def _after(request: Request, work: Worksheet, summary: dict[str, Any]) -> dict[str, Any]:
    """Return what was learned, and the next step, if every question is answered."""
    if not summary["is_done"]:
        return {"next": None}
    progress = PersonProgress(request.site.store, request.user.id, request.site.clock).progress
    chapters = contents(request, progress)
    own = (c for c in chapters if any(entry.name == work.exercise for entry in c.exercises))
    lesson = next((LessonLink(lesson_address(each.name), each.title) for each in work.lessons), None)
    done = DoneExercise(work.variant.text.title, lesson, next(own, None))
    return {"next": next_of(request, progress, work.exercise), "done": done}


# ------------------------------------------------------------------- drafts


def draft(request: Request) -> Response:
    """Store the drafts that a script sends during typing."""
    work = _worksheet(request)
    return save_drafts(request, work.name, work.boxes)


def read(request: Request) -> Response:
    """Return the reading of a box; store nothing."""
    work = _worksheet(request)
    part = work.part(request.form.text("part"))
    return HTMLResponse(str(work.read_as(part.id, work.typed[part.id])))


# ---------------------------------------------------------- the solution, the motion


def solution(request: Request) -> Response:
    """Return the worked solution, with what the student drew over the right construction, after a
    confirmation that the variant then no longer counts."""
    work = _worksheet(request)
    if request.is_post:
        work.attempt.reveal()
        return redirect(f"{work.address}/solution")
    names: dict[str, Any] = {"sheet_page": work, "title": work.variant.text.title}
    if not work.attempt.is_example:
        return request.render("site/student/practice_sure", **names)
    sheet_ = answer_sheet(work.variant)
    answers = {name: text for name, text in work.box_contents().items() if not is_blank(text)}
    names["drawings"] = own_drawings(work.variant, mark(work.variant, answers))
    return request.render("site/student/practice_solution", **{**views.context(sheet_), **names})


def motion(request: Request) -> Response:
    """Return the mechanism in motion: as its figure alone, until every question is answered or its solution
    was shown, and not before those of which the motion itself is the answer."""
    work = _worksheet(request)
    if not work.variant.exercise.is_animated:
        raise HTTPException("page", 404)
    open_parts = work.attempt.open_parts
    names: dict[str, Any] = {
        "sheet_page": work,
        "motion_title": work.variant.text.title,
        "is_piece": request.is_fragment,
        "own": BOX_PREFIX,
    }
    if not work.motion_waits:
        key = ("motion", work.exercise, work.seed, work.variant.lang, not open_parts)
        names["motion"] = request.site.cache.get(key, lambda: _motion(work.variant, not open_parts))
    return request.render("site/student/practice_motion", **names)


def _motion(variant: Any, is_answered: bool) -> dict[str, Any]:
    moving = DisplayedAnimation(variant)
    usual = [effect for effect in EFFECTS[:2] if effect == "position" or effect in moving.available]
    return motion_page.context(DisplayedAnimation(variant, usual), is_answered=is_answered)


ROUTES = (
    Route("/practice", course, Permission.OWN),
    Route("/practice/{exercise}", exercise, Permission.OWN, takes_forms=True, budget=PLAIN),
    Route("/practice/{exercise}/{seed}", sheet, Permission.OWN, takes_forms=True, budget=BOXES),
    Route(
        "/practice/{exercise}/{seed}/draft",
        draft,
        Permission.OWN,
        takes_forms=True,
        has_page=False,
        budget=BOXES,
    ),
    Route(
        "/practice/{exercise}/{seed}/read",
        read,
        Permission.OWN,
        takes_forms=True,
        has_page=False,
        budget=BOXES,
    ),
    Route("/practice/{exercise}/{seed}/solution", solution, Permission.OWN, takes_forms=True, budget=PLAIN),
    Route("/practice/{exercise}/{seed}/motion", motion, Permission.OWN),
)
