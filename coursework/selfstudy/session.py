"""Study session: one exercise for a student working alone, in a notebook or a terminal; and its notebook."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Mapping
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from coursework.course.answer_keys import answer_keys
from coursework.course.course import Course
from coursework.course.lessons import taught_by
from coursework.course.variant import Variant
from coursework.errors import BadCourse, Starved, UnknownName, WrongValue
from coursework.issuing.issuing import distinct_variants
from coursework.language.words import words
from coursework.markup.shown import NotebookDisplay, SvgPicture
from coursework.model import Part
from coursework.rendering.displayed import DisplayedAnimation
from coursework.rendering.views import offered, points_number
from coursework.scenes.animation import shown_by_motion
from coursework.scenes.gauges import EFFECTS
from coursework.selfstudy import hints, predictions, wording
from coursework.selfstudy.attempt import (
    OwnAnswer,
    StudyAttempt,
    is_open,
    judged_out_of,
    quoted,
    sentence_of,
    sign_of,
)
from coursework.selfstudy.lessons import curves, usual_parts
from coursework.selfstudy.mastery import (
    advice_text,
    mark_what_came_unmarked,
    next_step,
    skills_text,
    standings_text,
)
from coursework.selfstudy.predictions import Prediction
from coursework.selfstudy.progress import (
    EXAMPLE,
    FILE,
    HINT,
    REVEAL,
    Clock,
    ExerciseStore,
    ProgressFile,
    is_blank,
    now,
)
from coursework.selfstudy.worked import (
    LEVELS,
    blanks,
    example_variant,
    has_example,
    steps_text,
    theory,
    without_theory,
)
from coursework.sheets.handout import handout
from coursework.sheets.sheet import Ask, Question, StudySheet
from coursework.system.distribution import DISTRIBUTION

if TYPE_CHECKING:
    from coursework import figures
    from coursework.course.exercise import CourseExercise
    from coursework.course.variant import Variant


def study_sheet(variant: Variant, student: str = "", neighbours: Collection[str] = ()) -> StudySheet:
    """Return the self-study notebook of a variant, before it is printed, with links to the lessons in
    ``neighbours``, the folder of the notebook."""
    exercise = variant.exercise
    is_other_course = not exercise.folder.is_builtin
    return StudySheet(
        handout=handout(variant, student),
        file=FILE,
        package=DISTRIBUTION,
        install=exercise.folder.install,
        course=exercise.folder.root.name if is_other_course else "",
        before=tuple(_ask(variant, p) for p in predictions.before_answers(variant)),
        cycle=tuple(_ask(variant, p) for p in predictions.over_the_cycle(variant)),
        moves=bool(predictions.moving(variant)),
        animates=exercise.is_animated,
        questions=_fresh_questions(variant),
        theory=theory(exercise),
        has_example=has_example(variant),
        lessons=taught_by(exercise.folder, exercise.name, variant.lang),
        beside=frozenset(neighbours),
    )


def fresh_variants(exercise: CourseExercise, seed: int, count: int, lang: str) -> list[Variant]:
    """Return the first valid variants after that of a seed, all distinct, without theory questions.

    Raises
    ------
    Starved
        So many do not exist.
    """
    result = distinct_variants(exercise, seed + 1, count + 1, lang)
    base = exercise.variant(seed, lang)
    return [without_theory(v) for v in result if v.given != base.given][:count]


def _fresh_questions(variant: Variant) -> tuple[Question, ...]:
    try:
        return handout(fresh_variants(variant.exercise, variant.seed, 1, variant.lang)[0]).questions
    except Starved:
        return ()


def _ask(variant: Variant, prediction: Prediction) -> Ask:
    return Ask(
        predictions.prediction_keys(variant)[prediction.id],
        predictions.question_of(variant, prediction),
        predictions.options(variant, prediction),
    )


def open_session(
    course: Course[Any],
    exercise: str,
    *,
    seed: int,
    lang: str,
    named: str | Path | None,
    version: int | None,
    folder: str | Path,
    clock: Clock = now,
) -> StudySession:
    """Return a study session of an exercise of an open course; ``named`` is the course as requested by the
    caller.

    Raises
    ------
    BadInput
        The course has another version of the exercise: the variant on paper would not be this one.
    UnknownName
        No such exercise or language.
    """
    words(lang)  # an unknown language is reported before anything is printed in it
    wording.expect(lang, "exercise", exercise, course.names)
    item = course[exercise]
    if version is not None and version != item.version:
        course_option = f"--course {named} " if named is not None else ""
        again = f"coursework {course_option}notebook {exercise} --seed {seed} --lang {lang} --out DIR"
        entries = {"exercise": exercise, "version": version, "installed": item.version, "command": again}
        raise wording.refused(lang, "version", **entries)
    return StudySession(item.variant(seed, lang), ExerciseStore(ProgressFile(Path(folder), clock), exercise))


def course_folder(course: str | Path | None, lang: str) -> Path | None:
    """Return the folder of a course given by path, or by its name beside or above the current folder; None
    for the built-in course.

    Raises
    ------
    BadCourse
        No such course.
    """
    if course is None:
        return None
    if (Path(course) / "exercises").is_dir():
        return Path(course)
    here = Path.cwd()
    for position in (here, *here.parents):
        for folder in (position / course, position):
            if folder.name == Path(course).name and (folder / "exercises").is_dir():
                return folder
    raise BadCourse(words(lang)["study"]["refused"]["course"].format(name=course, here=here))


class StudySession:
    """Study session on one variant: predictions, answers, feedback, hints, plots.

    Entries are stored in a file beside the notebook, for all exercises; none is ever erased. Each method
    returns an object for display in a notebook cell; ``print`` gives it as plain text.
    """

    _variable = ""  #: what the notebook calls this session, where it is neither the first nor another variant
    _opening = ""  #: why it is proposed

    def __init__(self, variant: Variant, store: ExerciseStore, base: int | None = None):
        self.variant = variant
        self._store = store
        self._attempt = StudyAttempt(variant, store)
        self._base = variant.seed if base is None else base
        self._hints: dict[str, int] = {}
        self._texts = words(variant.lang)["study"]

    # ---------------------------------------------------------------- statement

    def statement(self) -> NotebookDisplay:
        """Return the statement, the figure, the data and the questions."""
        sheet, text = handout(self.variant), words(self.variant.lang)["sheet"]
        colon = text["colon"]
        head = self._texts["variant"].format(title=f"**{sheet.title}**", seed=sheet.seed)
        pieces: list[str | SvgPicture] = [f"{head}\n\n{sheet.statement}"]
        if sheet.figure is not None:
            pieces.append(SvgPicture(sheet.figure.outlined_svg(), sheet.figure_alt))
        pieces += [SvgPicture(figure.outlined_svg(), alt) for figure, alt in sheet.more_figures]
        given = [f"- {hints._given(self.variant, g.name)}" for g in sheet.given]
        if given:
            pieces.append(f"**{text['data']}**\n\n" + "\n".join(given))
        questions = []
        for q in sheet.questions:
            unit = text["with_unit"] if q.asks_unit else q.unit
            prompt = " ".join(q.prompt.split())
            cases = "".join(f"\n   - `{letter}`{colon} {label}" for letter, label in offered(q))
            questions.append(f"{q.number}. `{q.key}`{colon} {prompt}{f' ({unit})' if unit else ''}{cases}")
        pieces.append("\n".join(questions))
        return self._display(*pieces)

    def _cover(self) -> NotebookDisplay:
        """Return the display of the session itself: the reason for which it is proposed, if any, else its
        statement."""
        return self._display(self._opening) if self._opening else self.statement()

    def _ipython_display_(self) -> None:
        self._cover()._ipython_display_()

    def __str__(self) -> str:
        return str(self._cover())

    __repr__ = __str__

    @property
    def figure(self) -> figures.Figure | figures.Picture | None:
        """Figure to scale, or picture; the first where there are several."""
        return self.variant.figure

    def motion(self, *effects: str) -> NotebookDisplay:
        """Return the mechanism over its cycle; ``effects`` as in
        :class:`~coursework.scenes.animation.Animation`.

        By default paths and velocities, where the solution states them; the figure alone while questions
        are left.

        Raises
        ------
        UnknownName
            An effect that is none.
        BadInput
            An effect without anything to show.
        """
        for effect in effects:
            wording.expect(self.variant.lang, "effect", effect, EFFECTS)
        try:
            moving = DisplayedAnimation(self.variant, effects)
        except BadCourse:
            return self._display(self._texts["no_motion"])
        except WrongValue:
            displayed = ", ".join(dict.fromkeys(("position", *DisplayedAnimation(self.variant).available)))
            raise wording.refused(self.variant.lang, "no_effect", names=displayed) from None
        left = self._attempt.open_parts
        if shown := [name for name in shown_by_motion(self.variant) if name in left]:
            return self._display(self._texts["motion_tells"].format(names=_names(shown)))
        if not effects:
            usual = [e for e in ("position", "velocity") if e in moving.available]
            moving = DisplayedAnimation(self.variant, usual)
        page, opens = moving.html(is_answered=not left), self._texts["motion_drag"]
        picture = SvgPicture(moving.svg(() if left else None), moving.title, page, opens)
        return self._display(*([self._texts["motion_left"]] if left else []), picture)

    # -------------------------------------------------------------- predictions

    @property
    def _asked(self) -> dict[str, Prediction]:
        both = (*predictions.before_answers(self.variant), *predictions.over_the_cycle(self.variant))
        return {p.id: p for p in both}

    @property
    def _asked_under(self) -> dict[str, str]:
        """Key of each prediction by its id."""
        return predictions.prediction_keys(self.variant)

    @property
    def predictions(self) -> dict[str, Any]:
        """Stored predictions for this variant."""
        return self._store.of(self.variant.seed, "predictions")

    def predict(self, predicted: Mapping[str, Any] | None = None, /, **named: Any) -> NotebookDisplay:
        """Store predictions, to be compared once the answers are right or the curves are shown.

        What cannot be read is said at once. Without predictions, return the stored ones.

        Raises
        ------
        UnknownName
            A name that is not predicted here.
        BadInput
            No dictionary.
        """
        requested = self._asked
        predicted, strange = self._arguments_of("predict", "prediction", predicted, named, requested)
        if not predicted:
            under = tuple(self._asked_under.values())
            example = f'`{self._name}.predict({{"{under[0]}": "…"}})`' if under else ""
            return self._display(self._texts["which_predictions"].format(names=_names(under), call=example))
        self._store.add(self.variant.seed, "predictions", predicted)
        now = self.predictions
        created = [n for n in predicted if not is_blank(now.get(n))]
        left = [n for n in predicted if is_blank(now.get(n))]
        lines = [self._texts["kept_predictions"].format(made=len(created), of=len(predicted))]
        lines += [self._left(self._asked_under[n] for n in left)] if left else []
        unread = [n for n in created if not predictions.is_understood(self.variant, requested[n], now[n])]
        lines += [
            self._texts["not_understood"].format(
                name=self._asked_under[n],
                said=quoted(now[n]),
                options=predictions.options(self.variant, requested[n]),
            )
            for n in unread
        ]
        return self._display(*strange, *lines, self._trouble)

    def _arguments_of(
        self, method: str, kind: str, text: Any, named: Mapping[str, Any], names: Collection[str]
    ) -> tuple[dict[str, Any], list[str]]:
        """Return the arguments of a method, by the names that it knows, and the messages about names that it
        does not know. Raises UnknownName: it knows none of the names."""
        results: dict[str, Any] = {}
        strange: list[UnknownName] = []
        under = self._asked_under if kind == "prediction" else self._keys
        by_key = {key: name for name, key in under.items()}
        given = wording.by_name(self.variant.lang, f"{self._name}.{method}", {} if text is None else text)
        for name, value in (*given.items(), *named.items()):
            if name == "student" and kind == "question":
                continue
            name = by_key.get(name, name) if isinstance(name, str) else name
            name = name if isinstance(name, str) and name in names else self._named(name)
            if self._is_passed_over(kind, name):
                continue
            if not isinstance(name, str) or name not in names:
                strange.append(wording.stranger(self.variant.lang, kind, name, tuple(by_key)))
            elif is_blank(results.get(name)):
                results[name] = wording.unwrapped(value)
        if strange and not results:
            raise strange[0]
        return results, [str(item) for item in strange]

    def _is_passed_over(self, kind: str, name: Any) -> bool:
        """Return whether a name belongs to this exercise but is not asked here: theory in another variant, or
        a prediction of an older notebook."""
        ids = {p.id for p in self.variant.exercise.spec.parts}
        if kind == "question":
            return name in theory(self.variant.exercise) and name not in self.variant.part_ids
        return (
            isinstance(name, str)
            and name not in self._asked
            and name.removeprefix("zeros_").removeprefix("highest_") in ids
        )

    def _named(self, question: Any) -> Any:
        """Return the name of a question given by number: ``5``, ``"5"``, ``"question 5"``."""
        ids = self._numbered
        number = question if isinstance(question, int) and not isinstance(question, bool) else None
        if isinstance(question, str) and question not in ids:
            text = re.fullmatch(
                r"\s*(?:question|q)?\.?\s*(?:n°|no\.?|#)?\s*(\d{1,3})\.?\s*", question, re.IGNORECASE
            )
            number = int(text[1]) if text else None
        return ids[number - 1] if number is not None and 1 <= number <= len(ids) else question

    @property
    def _keys(self) -> Mapping[str, str]:
        """Key of each answer by the id of its question."""
        return answer_keys(self.variant.parts)

    @property
    def _numbered(self) -> tuple[str, ...]:
        """Questions in the order of their numbers."""
        return self.variant.part_ids

    def _left(self, names: Iterable[str]) -> str:
        return self._texts["left"].format(names=_names(names))

    def _compared(self, names: Iterable[str], own_answers: Mapping[str, OwnAnswer]) -> str:
        """Return the predictions with their outcomes, as a list."""
        lines = []
        for result in self._attempt.compared([self._asked[name] for name in names], own_answers):
            mark = {True: "✓", False: "✗", None: "?"}[result.right]
            question = predictions.question_of(self.variant, result.prediction)
            line = self._texts["compared"].format(
                said=f"`{result.said.replace('`', '')}`", found=result.found
            )
            if result.right is None:
                line += f" — {predictions.options(self.variant, result.prediction)}"
            lines.append(f"- {mark} {question} {line}")
        return "\n".join([f"**{self._texts['predictions']}**", "", *lines]) if lines else ""

    # ------------------------------------------------------------------ answers

    @property
    def answers(self) -> dict[str, Any]:
        """Last answer to each question of this variant that is not blank."""
        return self._attempt.answers

    def check(self, answers: Mapping[str, Any] | None = None, /, **named: Any) -> NotebookDisplay:
        """Mark answers, by the name or number of the question, and give feedback; stored answers fill in for
        blank ones.

        An entry ``student`` is not an answer. The value of an answer is never printed. ``check(rA="238")``
        does as well.

        Raises
        ------
        UnknownName
            An answer to a question that this variant does not ask.
        BadInput
            No dictionary.
        """
        given, strange = self._arguments_of("check", "question", answers, named, self.variant.part_ids)
        checked = self._attempt.check(given)
        marking, now = checked.marking, checked.answers
        lines, unanswered = [], []
        for mark in marking.values():
            number = self._numbered.index(mark.part) + 1
            if mark.verdict == "missing" or (mark.verdict == "to_mark" and is_blank(mark.answer)):
                unanswered.append(mark.part)
            else:
                text = sentence_of(self.variant, mark, self._call("reveal", mark.part))
                lines.append(f"- {sign_of(mark)} **{number}.** `{self._keys[mark.part]}` — {text}")
        if checked.copied is not None:
            lines.insert(0, self._texts["copied"].format(seed=checked.copied) + "\n")
        total = self._texts["total"].format(
            points=points_number(marking.points, self.variant.lang),
            out_of=points_number(judged_out_of(self.variant, marking), self.variant.lang),
        )
        before = [n for n in now if (named or answers is not None) and is_blank(given.get(n))]
        after = [self._left(self._keys[n] for n in unanswered)] if unanswered else []
        after += (
            [self._texts["from_before"].format(names=_names(self._keys[n] for n in before))] if before else []
        )
        first = checked.first_missed
        after += [self._texts["try_hint"].format(call=self._call("hint", first))] if first else []
        asked_before = [p.id for p in predictions.before_answers(self.variant) if p.id in checked.right]
        return self._display(
            *strange,
            "\n".join(lines),
            f"**{total}**",
            " ".join(after),
            self._compared(asked_before, self._attempt.own(checked)),
            self._trouble,
        )

    @property
    def _right_answers(self) -> dict[str, OwnAnswer]:
        """Right answers of the student, by quantity."""
        return self._attempt.own(self._attempt.marked())

    # -------------------------------------------------------------------- hints

    def _which(self, method: str, sentence: str) -> str:
        names = _names(self._keys.values())
        return sentence.format(names=names, call=self._call(method, self.variant.part_ids[0]))

    def hint(self, question: str | int = "", step: int | None = None) -> NotebookDisplay:
        """Return a hint, one step further at each call; without a question, list the questions.

        ``step`` goes to a step at once. No hint holds the value: :meth:`reveal` does.

        Raises
        ------
        UnknownName
            No such question, and no such quantity on the way to one.
        BadInput
            A step that is not a whole number.
        """
        if question == "":
            return self._display(self._which("hint", self._texts["hint"]["which"]))
        name = self._named(question)
        if step is not None:
            step = wording.counted(self.variant.lang, "step", step)
        texts = self._attempt.hints(name, lambda n: self._call("hint", n))
        if not texts:
            return self._display(self._texts["hint"]["none"].format(call=self._call("reveal", name)))
        last = step if step is not None else self._hints.get(name, 0) + 1
        last = min(max(last, 1), len(texts))
        self._hints[name] = last
        self._note(HINT, name, step=last)
        labels = self._texts["hint"]
        pieces = [
            f"**{labels['step'].format(number=k, of=len(texts))}** {text}"
            if not text.startswith("$$")
            else f"**{labels['step'].format(number=k, of=len(texts))}**\n\n{text}"
            for k, text in enumerate(texts[:last], start=1)
        ]
        closing = (
            labels["more"] if last < len(texts) else labels["last"].format(call=self._call("reveal", name))
        )
        return self._display(*pieces, f"*{closing}*")

    def reveal(self, question: str | int = "") -> NotebookDisplay:
        """Return the complete step of the worked solution with its value, for a question by name or number.

        Raises
        ------
        UnknownName
            No such question, and no such quantity on the way to one.
        """
        if question == "":
            return self._display(self._which("reveal", self._texts["which_reveal"]))
        name = self._named(question)
        text = hints.revealed_text(self.variant, name)
        self._note(REVEAL, name)
        return self._display(text, self._trouble)

    def _note(self, event: str, part: Any, **more: Any) -> None:
        """Record that something was shown, once."""
        self._attempt.note(event, str(part), **more)

    # -------------------------------------------------------------------- plots

    def plot(self, *names: str | int) -> NotebookDisplay:
        """Plot the quantities over a turn of the driver, with the student's answers marked; then compare the
        predictions about them.

        A curve tells the answer at the position of the statement: it is drawn once the question is answered
        right, or its solution was shown. Without names, the first of those asked; any that moves may be
        named.

        Raises
        ------
        UnknownName
            A question that does not move with the driver.
        """
        parts = {p.id: p for p in predictions.moving(self.variant)}
        if not parts:
            return self._display(self._texts["no_plot"])
        label = [self._named(name) for name in names]
        for name in label:
            if not isinstance(name, str) or name not in parts:
                wording.expect(self.variant.lang, "curve", name, [self._keys[n] for n in parts])
        own_answers = self._right_answers
        wanted = [parts[name] for name in label] or list(parts.values())
        free = [p for p in wanted if p.quantity in own_answers or self._attempt.is_revealed(p)]
        held = [self._keys[p.id] for p in wanted if p not in free]
        not_yet = self._texts["not_yet"].format(names=_names(held)) if held else ""
        if not free:
            return self._display(not_yet, self._trouble)
        chosen = free if label else list(usual_parts(self.variant, free))
        symbol = self.variant.symbol
        drawn = curves(self.variant, chosen, self.answers, own_answers)
        texts = self._texts["plot"].format(list=_symbols(chosen, symbol), driver=f"${symbol(drawn.driver)}$")
        notes = [
            self._texts[note].format(list=_symbols(result, symbol))
            for note, result in (("beside_curve", drawn.beside), ("outside", drawn.outside))
            if result
        ]
        others = [] if label else [p.id for p in free if p not in chosen]
        more = (
            self._texts["more_plots"].format(
                names=_names(self._keys[n] for n in others), call=self._call("plot", others[0])
            )
            if others
            else ""
        )
        seen = {p.quantity for p in chosen}
        requested = [p.id for p in predictions.over_the_cycle(self.variant) if p.quantity in seen]
        picture = SvgPicture(drawn.plot.svg(), drawn.plain)
        return self._display(texts, picture, *notes, more, not_yet, self._compared(requested, own_answers))

    # ----------------------------------------------------------- other variants

    def fresh(self, number: int | None = None) -> StudySession:
        """Return another variant: the first, second… after the notebook's own; without a number, the next one
        not begun.

        Only variants that are worth issuing count, as for a class.

        What was written for this one stays kept.

        Raises
        ------
        BadInput
            A number below 1.
        Starved
            The exercise has no more variants.
        """
        if number is not None:
            number = wording.counted(self.variant.lang, "fresh", number)
        begun = {s for s in self._store.seeds if self._store.of(s, "answers") and not self._is_example(s)}
        # One of so many is not begun.
        count = number or len((begun | {self.variant.seed}) - {self._base}) + 1
        try:
            variants = fresh_variants(self.variant.exercise, self._base, count, self.variant.lang)
        except Starved as fault:
            why = "starved" if number is not None else "all_begun"
            raise Starved(self._texts["refused"][why].format(number=count)) from fault
        left = [v for v in variants if v.seed not in begun and v.seed != self.variant.seed]
        variant = left[0] if number is None else variants[-1]
        return StudySession(variant, self._store, self._base)

    def _is_example(self, seed: int) -> bool:
        return any(e["what"] == EXAMPLE for e in self._store.happened(seed))

    def example(self, level: int | None = None) -> ExampleSession | NotebookDisplay:
        """Return the worked solution of another variant, with blanks to fill: the last question at level 1,
        all at level 4.

        Without a level, the one after the last level shown.

        Raises
        ------
        BadInput
            No such level.
        Starved
            The exercise has no other variant.
        """
        seen = [
            int(e.get("step", 0))
            for e in self._store.progress.of(self.variant.exercise.name)
            if e["what"] == EXAMPLE
        ]
        last = min(max(seen, default=0) + 1, LEVELS)
        level = last if level is None else wording.counted(self.variant.lang, "level", level, LEVELS)
        if not has_example(self.variant.exercise.variant(self._base, self.variant.lang)):
            return self._display(self._texts["example"]["none"])
        try:
            variant = example_variant(
                self.variant.exercise.variant(self._base, self.variant.lang), self._base, level
            )
        except Starved as fault:
            raise Starved(self._texts["refused"]["starved"].format(number=1)) from fault
        return ExampleSession(variant, self._store, self._base, level)

    def next(self) -> StudySession:
        """Return a session for the recommended next exercise of the course, on a variant not begun.

        It proposes first what was missed and is due, then what cost answers before, then what is new, and
        states the reason.
        """
        course = self._course
        self._store.file.refresh()
        mark_what_came_unmarked(self._course, self._store.file)
        advice = next_step(course, self._store.progress, self._today)
        assert advice is not None  # the course has this exercise
        stored = self._store.beside(advice.exercise)
        item = StudySession(course[advice.exercise].variant(self._base, self.variant.lang), stored)
        begun = any(e["what"] != EXAMPLE for e in stored.progress.of(advice.exercise))
        result = item.fresh() if begun else item
        result._variable = "following"
        begin = self._texts["next"]["begin"].format(call=f"`{result._variable}.statement()`")
        result._opening = f"{advice_text(course, advice, self.variant.lang)} {begin}"
        return result

    @property
    def _course(self) -> Course[Any]:
        return cast("Course[Any]", self.variant.exercise.course)

    @property
    def _today(self) -> date:
        return self._store.file.clock().date()

    def progress(self) -> NotebookDisplay:
        """Return the variants begun with their results; then the other exercises, the skills lost, and those
        recovered since."""
        self._store.file.refresh()
        mark_what_came_unmarked(self._course, self._store.file)
        lines, lang = [], self.variant.lang
        for seed in dict.fromkeys((self._base, *self._store.seeds)):
            if self._is_example(seed):
                continue
            variant = self.variant.exercise.variant(seed, lang)
            variant = variant if seed == self._base else without_theory(variant)
            marking = StudyAttempt(variant, self._store).marked().marking
            right = sum(m.verdict == "correct" for m in marking.values())
            judged = sum(not is_open(variant, m) for m in marking.values())
            lines.append("- " + self._texts["variant_line"].format(seed=seed, right=right, of=judged))
        course, done = self._course, self._store.progress
        return self._display(
            "\n".join(lines),
            standings_text(course, done, self._today, lang),
            skills_text(course, done, lang),
            self._trouble,
        )

    # ------------------------------------------------------------------- common

    def __getattr__(self, name: str) -> Any:
        """Refuse an unknown method in the session's language, with the nearest name."""
        if name.startswith("_"):
            raise AttributeError(name)
        names = [n for n in dir(type(self)) if not n.startswith("_")]
        raise wording.no_method(self.variant.lang, name, names)

    def _call(self, method: str, name: str) -> str:
        """Return the call of a method in the notebook, as code in Markdown."""
        return f'`{self._name}.{method}("{self._keys.get(name, name)}")`'

    @property
    def _name(self) -> str:
        """Variable that holds this session in the notebook."""
        return self._variable or ("study" if self.variant.seed == self._base else "again")

    @property
    def _trouble(self) -> str:
        """Message about a problem with the file of answers; empty without one."""
        texts = self._texts["trouble"]
        return (
            texts[self._store.trouble].format(file=self._store.file.troubled) if self._store.trouble else ""
        )

    def _display(self, *pieces: str | SvgPicture) -> NotebookDisplay:
        return NotebookDisplay(self.variant.lang, *pieces)


class ExampleSession(StudySession):
    """Worked solution with blanks; each is answered, hinted and revealed like a question."""

    _variable = "example"

    def __init__(self, variant: Variant, store: ExerciseStore, base: int, level: int):
        self._full_sheet, self.level = variant, level
        super().__init__(variant.asking(blanks(variant, level)), store, base)
        self._note(EXAMPLE, "", step=level)

    @property
    def _keys(self) -> Mapping[str, str]:
        keys = answer_keys(self._full_sheet.parts)
        return {name: keys[name] for name in self.variant.part_ids}

    @property
    def _numbered(self) -> tuple[str, ...]:
        return self._full_sheet.part_ids

    def statement(self) -> NotebookDisplay:
        """Return the data, then the solution with its blanks."""
        texts = self._texts["example"]
        head = texts["head"].format(title=f"**{self._full_sheet.text.title}**", level=self.level, of=LEVELS)
        sheet = handout(self._full_sheet)
        given = [f"- {hints._given(self._full_sheet, g.name)}" for g in sheet.given]
        pieces: list[str | SvgPicture] = [head]
        if sheet.figure is not None:
            pieces.append(SvgPicture(sheet.figure.outlined_svg(), sheet.figure_alt))
        pieces.append("\n".join(given))
        pieces.append(steps_text(self._full_sheet, self.level, self.variant.parts, self._keys, texts))
        fill = ", ".join(f'"{key}": ""' for key in self._keys.values())
        pieces.append(texts["fill"].format(call=f"`{self._name}.check({{{fill}}})`"))
        return self._display(*pieces, self._trouble)


def _symbols(parts: Iterable[Part], symbol: Callable[[str], str]) -> str:
    return ", ".join(f"${symbol(p.quantity)}$" for p in parts)


def _names(names: Iterable[str]) -> str:
    return ", ".join(f"`{n}`" for n in names)
