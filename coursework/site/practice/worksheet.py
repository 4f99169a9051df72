"""Sheet of one practice variant for one person: the boxes, the feedback, and the page."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import cached_property
from html import escape
from itertools import repeat
from typing import TYPE_CHECKING, Any, NamedTuple

from markupsafe import Markup

from coursework.course.lessons import Lesson
from coursework.database.drafts import DraftBox, drafts
from coursework.database.permissions import Permission
from coursework.database.progress import PersonProgress
from coursework.errors import CourseworkError
from coursework.language.words import words
from coursework.marking.answers import read
from coursework.markup import markdown
from coursework.rendering import views
from coursework.rendering.feedback import verdict_word
from coursework.rendering.surface import kind_of_surface
from coursework.scenes.animation import shown_by_motion
from coursework.selfstudy import hints, predictions
from coursework.selfstudy.attempt import (
    CheckedAnswers,
    StudyAttempt,
    judged_out_of,
    read_back,
    sentence_of,
    sign_of,
)
from coursework.selfstudy.progress import HINT, REVEAL, ExerciseStore, is_blank
from coursework.selfstudy.worked import theory
from coursework.sheets.cells import answer_in, cell_names, form_of, in_cells, is_incomplete
from coursework.sheets.handout import handout
from coursework.site.frame.drafts import (
    DRAWING,
    LONGEST,
    draft_attributes,
    longest,
    save_form_drafts,
    versions_of,
)
from coursework.site.frame.requests import HTTPException
from coursework.site.lessons.lesson_content import (
    LessonLink,
    help_with_mistake,
    lessons_for,
    linked_lessons,
    section_links,
)
from coursework.site.mechanisms.mechanisms_page import address_of
from coursework.site.practice import explore_page

if TYPE_CHECKING:
    from coursework.course.variant import Variant
    from coursework.marking.mark import Mark
    from coursework.model import Part
    from coursework.site.frame.requests import Request

BOX_PREFIX = "a-"  #: prefix of the names of boxes, used by no other field of the form
_ASKS = re.compile(r'<a href="#(hint|reveal)-([^"]+)">(.*?)</a>')


class AnswerFeedback(NamedTuple):
    """Feedback on an answer."""

    sign: str
    verdict: str  #: in a word or two; empty if the sentence suffices
    html: Markup
    is_right: bool = False
    help: LessonLink | None = None  #: section of a lesson


class QuestionHints(NamedTuple):
    """Requested hints of a question, or of a step towards it."""

    name: str
    title: Markup
    steps: tuple[Markup, ...]
    of: int
    solution: Markup = Markup("")


class Worksheet:
    """Practice sheet of one variant for one person.

    Raises
    ------
    HTTPException
        There is no such exercise, or the variant is not for practice: variants of classes are reserved.
    BadInput
        The solutions are not in this copy of the course.
    """

    def __init__(self, request: Request, exercise: str, seed: str):
        self.request, site = request, request.site
        if exercise not in site.course or not re.fullmatch(r"0|[1-9][0-9]{0,15}", seed):
            raise HTTPException("page", 404)
        if not request.user.may(Permission.PRACTICE_ANY) and not site.pool.holds(exercise, int(seed)):
            raise HTTPException("own", 404)
        self.exercise, self.seed = exercise, int(seed)
        self.others: dict[str, DraftBox] = {}  #: boxes of the form that another page has changed since
        self.drafts: Mapping[str, DraftBox] = {}  #: by part
        with site.store.reading() as connection:
            self._progress = PersonProgress(site.store, request.user.id, site.clock, exercise, connection)
            if not request.is_post:
                self.drafts = drafts(connection, request.user.id, self.name)
        self.store = ExerciseStore(self._progress, exercise)
        self.variant: Variant = self._open_variant()
        self.attempt = StudyAttempt(self.variant, self.store)

    def _open_variant(self) -> Variant:
        """Return the variant; without its theory questions if another variant was begun before."""
        variant: Variant = self.request.site.variant(self.exercise, self.seed, self.request.lang)
        begun = list(self.store.progress)
        theory_parts = theory(variant.exercise) if begun and begun[0]["seed"] != self.seed else frozenset()
        theory_parts -= {e["part"] for e in begun if e["seed"] == self.seed}
        if not theory_parts:
            return variant
        key = ("without", self.exercise, self.seed, variant.lang, theory_parts)
        left = [part for part in variant.parts if part.id not in theory_parts]
        return self.request.site.cache.get(key, lambda: variant.asking(left))

    # ------------------------------------------------------------------ addresses

    @property
    def name(self) -> str:
        """Key under which its drafts are stored."""
        return f"practice/{self.exercise}/{self.seed}"

    @property
    def address(self) -> str:
        return f"/{self.name}"

    @property
    def mechanism(self) -> str:
        """Address of the page of its mechanism, for staff; empty if no file states one."""
        return address_of(self.request, self.exercise)

    @property
    def explored(self) -> str:
        """Address at which its mechanism is explored, with usual numbers; empty if it is not."""
        return f"/explore/{self.exercise}" if explore_page.is_explored(self.variant.exercise) else ""

    @property
    def explored_own(self) -> str:
        """The same with the numbers of the variant, which tell its answers."""
        return self.explored and explore_page.address(self.variant)

    # ---------------------------------------------------------------------- boxes

    @cached_property
    def parts(self) -> Mapping[str, Part]:
        return {part.id: part for part in self.variant.parts}

    @cached_property
    def draws(self) -> tuple[str, ...]:
        """Kind of the drawing surface of the sheet; empty if it has none."""
        kind = kind_of_surface(self.variant.exercise.spec, self.variant.record)
        return (kind,) if kind else ()

    @property
    def boxes(self) -> frozenset[str]:
        """Names of the boxes whose drafts are stored: those of the parts, and the drawing."""
        return frozenset({*self.parts, DRAWING} if self.draws else self.parts)

    def part(self, name: str) -> Part:
        """Return the part with a name.

        Raises
        ------
        HTTPException
            The variant has no such part.
        """
        if name not in self.parts:
            raise HTTPException("bad_request", 400)
        return self.parts[name]

    @cached_property
    def typed(self) -> dict[str, str]:
        """Texts of a form, by part; empty for a blank box, and if nothing is ticked."""
        texts = self.request.form.texts
        return {name: answer_in(texts, BOX_PREFIX + name, self.forms[name])[:LONGEST] for name in self.parts}

    @cached_property
    def forms(self) -> Mapping[str, str]:
        """Forms of the texts that boxes of components make, by part."""
        return {name: form_of(self.variant, part) for name, part in self.parts.items()}

    @property
    def _form_texts(self) -> dict[str, str]:
        """Texts of a form by box, with the drawing."""
        if not self.draws:
            return self.typed
        drawing = self.request.form.text(BOX_PREFIX + DRAWING)[: longest(DRAWING)]
        return {**self.typed, DRAWING: drawing}

    def box_contents(self) -> dict[str, str]:
        """Content of each box: the draft, or else the last answer, in the form that the box uses."""
        return self._contents(self.drafts, self.attempt.answers)

    def _contents(self, boxes: Mapping[str, DraftBox], answers: Mapping[str, Any]) -> dict[str, str]:
        texts = {
            name: boxes[name].text if name in boxes else str(answers.get(name) or "") for name in self.parts
        }
        return {
            name: ", ".join(_ticked(self.variant, self.parts[name], text)) for name, text in texts.items()
        }

    @contextmanager
    def saving(self) -> Iterator[None]:
        """Store what a form brings, and what the block records, in one transaction after the block; even if
        the block fails."""
        request, answers = self.request, self.attempt.answers
        versions = versions_of(request.form.text("versions"))
        self._progress.waits = True
        try:
            yield
        finally:
            if self._progress.unsaved or not request.is_fragment:
                with request.site.store.begin() as connection:
                    if not request.is_fragment:  # a script stores the texts by itself
                        self.drafts, others = save_form_drafts(
                            connection,
                            request,
                            self.name,
                            self._form_texts,
                            lambda boxes: self._contents(boxes, answers),
                            versions,
                        )
                        self.others = {
                            n: box
                            for n, box in others.items()
                            if n in self.parts and box.text != self.typed[n]
                        }
                    self._progress.save(connection)

    # -------------------------------------------------------------------- feedback

    def feedback(self, mark: Mark) -> AnswerFeedback:
        """Return the feedback on an answer."""
        sentence = sentence_of(self.variant, mark, self._asks("reveal", mark.part))
        if mark.verdict == "wrong" and not self.attempt.hints_seen(mark.part):
            sentence += f" {self._asks('first_hint', mark.part)}"
        html = self._with_buttons(markdown.html_inline(sentence, self.variant.lang), mark.part)
        says_all = mark.verdict in ("correct", "to_mark")
        word = "" if says_all else verdict_word(mark.verdict, self.variant.lang)
        return AnswerFeedback(sign_of(mark), word, html, mark.verdict == "correct", self._help_with(mark))

    def results(self, checked: CheckedAnswers, contents: Mapping[str, str]) -> dict[str, AnswerFeedback]:
        """Return the feedback on the answers that are still in their boxes."""
        return {
            name: self.feedback(mark)
            for name, mark in checked.marking.items()
            if not is_blank(checked.answers.get(name))
            and self._is_same(name, checked.answers[name], contents)
        }

    def _is_same(self, name: str, answer: Any, contents: Mapping[str, str]) -> bool:
        part = self.parts[name]
        return _ticked(self.variant, part, str(answer)) == _ticked(self.variant, part, contents[name])

    def read_as(self, name: str, text: str) -> Markup:
        """Return the reading of a box as HTML; empty for a blank box, and for one without text."""
        part, texts = self.parts[name], self.request.words["practice"]
        if part.choices or is_blank(text):
            return Markup("")
        if is_incomplete(text, self.forms[name]):
            return Markup(escape(self.request.words["read_back"]["incomplete"]))
        is_read, readings = read_back(self.variant, part, text)
        if is_read:
            line = texts["read_as"].format(texts["or"].join(readings)) if readings else ""
        else:
            line = readings[0]
        return Markup(markdown.html_inline(line, self.variant.lang))

    def hinted(self, name: str) -> QuestionHints:
        """Return the hints for a question, or for a step towards it, that were seen.

        Raises
        ------
        HTTPException
            The variant has no quantity of that name.
        """
        try:
            quantity = hints.quantity_of(self.variant, name)
        except CourseworkError:
            raise HTTPException("bad_request", 400) from None
        seen = self.attempt.hints_seen(name)
        texts = self.attempt.hints(name, lambda other: self._asks("hint", other))
        lang, solution = self.variant.lang, ""
        if self._is_revealed(name):
            solution = hints.revealed_text(self.variant, name)
        number = next((k for k, p in enumerate(self.parts, 1) if p == name), 0)
        title = "" if number else f"${self.variant.solution_symbol(quantity)}$"
        return QuestionHints(
            name,
            Markup(markdown.html_inline(title, lang)),
            tuple(self._with_buttons(markdown.to_html(text, lang), name) for text in texts[:seen]),
            len(texts),
            Markup(markdown.to_html(solution, lang)) if solution else Markup(""),
        )

    def hint(self, name: str) -> None:
        """Record one hint more as seen."""
        if step := min(self.attempt.hints_seen(name) + 1, self.hinted(name).of):
            self.attempt.note(HINT, name, step=step)

    def reveal(self, name: str) -> None:
        """Record the solution of a step as seen."""
        self.hinted(name)
        self.attempt.note(REVEAL, name)

    def _is_revealed(self, name: str) -> bool:
        return any(e["what"] == REVEAL and e["part"] == name for e in self.store.happened(self.variant.seed))

    def _asks(self, action: str, name: str) -> str:
        """Return a link in Markdown that :meth:`_with_buttons` turns into a button."""
        call = self.request.words["practice"][f"{action}_call"]
        return f"[{call}](#{action.removeprefix('first_')}-{name})"

    def _with_buttons(self, html: str, under: str) -> Markup:
        def button(match: re.Match[str]) -> str:
            action, name, text = match.groups()
            return (
                f'<button class="plain" name="{action}" value="{escape(under)} {name}" '
                f'formaction="#hints-{BOX_PREFIX}{escape(under)}">{text}</button>'
            )

        return Markup(_ASKS.sub(button, html))

    # ------------------------------------------------------------------ predictions

    def predictions_to_make(self) -> list[dict[str, Any]]:
        """Return the predictions to make before the computation, each with its options and the person's
        choice."""
        choices = self.attempt.predictions
        return [
            {
                "id": prediction.id,
                "question": Markup(
                    markdown.html_inline(predictions.question_of(self.variant, prediction), self.variant.lang)
                ),
                "options": self._options(prediction),
                "said": str(choices.get(prediction.id, "")),
            }
            for prediction in predictions.before_answers(self.variant)
        ]

    def _options(self, prediction: predictions.Prediction) -> list[tuple[str, str]]:
        """Return the options of a prediction, each with its label."""
        if prediction.kind != "guess":
            options = self.request.words["practice"]["options"][prediction.kind]
            return list(zip(options["values"], options["names"], strict=True))
        part, letters = self.parts[prediction.id], self.variant.letters(self.parts[prediction.id])
        lang = self.variant.lang
        return [
            (letters.get(case, case), markdown.plain_line(self.variant.called(part, case), lang))
            for case in self.variant.cases(part)
        ]

    def compared(self, checked: CheckedAnswers) -> dict[str, Markup]:
        """Return the predictions compared with the results, for the parts that are answered correctly."""
        answered = [
            prediction
            for prediction in predictions.before_answers(self.variant)
            if prediction.id in checked.right
        ]
        if not any(prediction.id in self.attempt.predictions for prediction in answered):
            return {}
        texts = words(self.variant.lang)["study"]["compared"]
        return {
            prediction.prediction.id: Markup(
                f"{ {True: '✓', False: '✗', None: '?'}[prediction.right] } "
                + markdown.html_inline(
                    texts.format(said=f"`{prediction.said.replace('`', '')}`", found=prediction.found),
                    self.variant.lang,
                )
            )
            for prediction in self.attempt.compared(answered, self.attempt.own(checked))
        }

    # ------------------------------------------------------------------------ the page

    def summary(self, checked: CheckedAnswers, contents: Mapping[str, str]) -> dict[str, Any]:
        """Return the state of the variant: the points, and the numbers of the open questions."""
        numbers = {name: k for k, name in enumerate(self.parts, 1)}
        blank = [n for n in self.parts if is_blank(checked.answers.get(n)) and not self._is_drawn(n)]
        missed = [n for n in self.parts if n not in checked.right and n not in blank and not self._is_open(n)]
        lang = self.variant.lang
        points = words(lang)["study"]["total"].format(
            points=views.points_number(checked.marking.points, lang),
            out_of=views.points_number(judged_out_of(self.variant, checked.marking), lang),
        )
        return {
            "points": points,
            "answered": any(not is_blank(a) for a in checked.answers.values()),
            "blank": [(n, numbers[n]) for n in blank],
            "missed": [(n, numbers[n]) for n in missed],
            "before": [(n, numbers[n]) for n in checked.answers if is_blank(contents.get(n))],
            "is_done": not blank and not missed,
            "copied": checked.copied,
        }

    @cached_property
    def motion_tells(self) -> tuple[str, ...]:
        """Names of the questions whose answer the motion tells."""
        return shown_by_motion(self.variant)

    @property
    def motion_waits(self) -> list[tuple[str, int]]:
        """Names and numbers of those of them without an answer, after which the motion comes."""
        return [(n, number) for n, number in self.attempt.open_parts.items() if n in self.motion_tells]

    def _is_open(self, name: str) -> bool:
        return self.parts[name].sort.is_open

    def _is_drawn(self, name: str) -> bool:
        return self.parts[name].sort.box in ("blank", "millimetre")

    def names(self, checked: CheckedAnswers, contents: Mapping[str, str]) -> dict[str, Any]:
        """Return the names for the page's template."""
        context = views.context(handout(self.variant))
        results = self.results(checked, contents)
        texts = self.request.words["practice"]["keeping"]
        return {
            **context,
            "own": BOX_PREFIX,
            "filled": dict(item for n, text in contents.items() for item in self._filled(n, text))
            | {BOX_PREFIX + n: (box.text,) for n, box in self.drafts.items() if n == DRAWING},
            "draws": self.draws,
            "before_questions": "site/student/_practice_before.html.j2",
            "below_question": "site/student/_practice_below.html.j2",
            "sheet_page": self,
            "results": results,
            "reads": {n: self.read_as(n, text) for n, text in contents.items()},
            "hinted": {n: (self.hinted(n),) for n in self._hinted_before()},
            "compared": self.compared(checked),
            "predicted": self.predictions_to_make(),
            "summary": self.summary(checked, contents),
            "is_shown": self.attempt.is_example,
            "lessons": linked_lessons(self.request.site, self.exercise, self.variant.lang),
            "form": draft_attributes(
                self.request, f"{self.address}/draft", self.name, self.drafts, BOX_PREFIX, **texts
            ),
        }

    def _filled(self, name: str, text: str) -> Iterator[tuple[str, Any]]:
        """Yield what stands in the boxes of a part, by their names."""
        cells = in_cells(text, self.forms[name])
        yield BOX_PREFIX + name, () if cells else _ticked(self.variant, self.parts[name], text)
        yield from zip(cell_names(BOX_PREFIX + name, self.forms[name]), cells or repeat(""), strict=False)

    @property
    def lessons(self) -> tuple[Lesson, ...]:
        """Lessons that teach the exercise."""
        return lessons_for(self.request.site, self.exercise, self.variant.lang)

    def help_links(self, part: str) -> tuple[LessonLink, ...]:
        """Return the links to the sections of the lesson that helps with a part: of these lessons the one
        that names it, or else the first."""
        lessons = [one for one in self.lessons if part in one.parts] or self.lessons[:1]
        return section_links(lessons[0]) if lessons else ()

    def _help_with(self, mark: Mark) -> LessonLink | None:
        """Return the section that explains the mistake of a wrong answer, or else the first that teaches what
        the part asks."""
        if mark.verdict in ("correct", "to_mark", "missing", "unreadable"):
            return None
        _, _, mistake = mark.verdict.partition("mistake:")
        link = help_with_mistake(self.request.site, self.exercise, mistake, self.variant.lang)
        return link or next(iter(self.help_links(mark.part)), None)

    def _hinted_before(self) -> Iterable[str]:
        happened = self.store.happened(self.variant.seed)
        seen = {e["part"] for e in happened if e["what"] in (HINT, REVEAL)}
        return [name for name in self.parts if name in seen and not self.attempt.is_example]


def _ticked(variant: Variant, part: Part, text: str) -> tuple[str, ...]:
    """Return the values of a box: the text, or the letters of the ticked choices."""
    if not part.choices or is_blank(text):
        return (text,) if text else ()
    reading = read(variant, part, text)
    if reading.status != "read":
        return ()
    letters = variant.letters(part)
    value = reading.values[0]
    if part.sort.box == "several":
        none = words(variant.lang)["choices"]["none"][0]
        return tuple(letter for case, letter in letters.items() if case in value) or (none,)
    return (letters.get(value, str(value)),)
