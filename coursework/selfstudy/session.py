"""A study session: one exercise for a student alone, in a notebook or a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from coursework.course import Course, open_course
from coursework.errors import BadCourse, NoSolution, Starved, WrongValue
from coursework.figures.plot import Axis, Plot, Spot
from coursework.language import unit_text, words
from coursework.marking import Mark, read
from coursework.motion import EFFECTS
from coursework.rendering.shown import Picture, Shown
from coursework.rendering.views import points_number
from coursework.selfstudy import hints, predictions, refusals
from coursework.selfstudy.kept import Kept, is_blank
from coursework.selfstudy.predictions import Prediction
from coursework.selfstudy.sheet import fresh_variants
from coursework.variant import Variant

if TYPE_CHECKING:
    from coursework.figures import Figure

PANELS = 6  #: curves of a plot, unless some are named


def study(
    exercise: str,
    *,
    seed: int = 0,
    lang: str = "fr",
    course: str | Path | None = None,
    version: int | None = None,
    folder: str | Path = ".",
) -> StudySession:
    """A study session of an exercise.

    Parameters
    ----------
    exercise
        Its name.
    seed
        Which variant.
    lang
        Language of all that is said.
    course
        The course's folder, or its name, looked for beside and above where the notebook is; the built-in
        course unless told.
    version
        The version that a notebook was written for.
    folder
        Where answers are kept, in ``EXERCISE.study.json``.

    Raises
    ------
    BadCourse
        No such course.
    BadInput
        The course has another version of the exercise: the variant on paper would not be this one.
    UnknownName
        No such exercise or language.
    """
    words(lang)  # an unknown language is told before anything is said in it
    opened = _found(course, lang)
    refusals.expect(lang, "exercise", exercise, opened.names)
    one = opened[exercise]
    if version is not None and version != one.version:
        again = f"coursework notebook {exercise} --seed {seed} --lang {lang} --out DIR"
        told = {"exercise": exercise, "version": version, "installed": one.version, "command": again}
        raise refusals.refused(lang, "version", **told)
    kept = Kept(Path(folder) / f"{exercise}.study.json", exercise)
    return StudySession(one.variant(seed, lang), kept)


def _found(course: str | Path | None, lang: str) -> Course:
    """A course by its folder, or by its name, beside or above the place where we are."""
    if course is None:
        return open_course()
    if (Path(course) / "exercises").is_dir():
        return open_course(course)
    here = Path.cwd()
    for place in (here, *here.parents):
        for folder in (place / course, place):
            if folder.name == Path(course).name and (folder / "exercises").is_dir():
                return open_course(folder)
    raise BadCourse(words(lang)["study"]["refused"]["course"].format(name=course, here=here))


class StudySession:
    """One variant to be worked on: predictions, answers, feedback, hints, plots.

    What is written is kept by variant in a file beside the notebook; nothing there is ever erased. Each method
    gives what a notebook's cell shows; ``print`` gives it as plain text.
    """

    def __init__(self, variant: Variant, kept: Kept, base: int | None = None):
        self.variant = variant
        self._kept = kept
        self._base = variant.seed if base is None else base
        self._hints: dict[str, int] = {}
        self._said = words(variant.lang)["study"]

    # ---------------------------------------------------------------- statement

    def statement(self) -> Shown:
        """The statement, the figure, the data and the questions."""
        sheet, said = self.variant.handout(), words(self.variant.lang)["sheet"]
        colon = said["colon"]
        head = self._said["variant"].format(title=f"**{sheet.title}**", seed=sheet.seed)
        pieces: list[str | Picture] = [f"{head}\n\n{sheet.statement}"]
        if sheet.figure is not None:
            pieces.append(Picture(sheet.figure.outlined_svg(), sheet.figure_alt))
        given = [f"- {hints._given(self.variant, g.name)}" for g in sheet.given]
        if given:
            pieces.append(f"**{said['data']}**\n\n" + "\n".join(given))
        questions = []
        for q in sheet.questions:
            unit = said["with_unit"] if q.asks_unit else q.unit
            prompt = " ".join(q.prompt.split())
            cases = "".join(f"\n   - `{key}`{colon} {label}" for key, label in q.choices)
            questions.append(f"{q.number}. `{q.id}`{colon} {prompt}{f' ({unit})' if unit else ''}{cases}")
        pieces.append("\n".join(questions))
        return self._shown(*pieces)

    def _ipython_display_(self) -> None:
        self.statement()._ipython_display_()

    def __str__(self) -> str:
        return str(self.statement())

    __repr__ = __str__

    @property
    def figure(self) -> Figure | None:
        """The figure to scale."""
        return self.variant.figure

    def motion(self, *effects: str) -> Shown:
        """The mechanism over its cycle; ``effects`` as in :class:`~coursework.motion.Animation`.

        Unless told, paths and velocities, where the solution states them.

        Raises
        ------
        UnknownName
            An effect that is none.
        BadInput
            An effect of which there is nothing to show.
        """
        for effect in effects:
            refusals.expect(self.variant.lang, "effect", effect, EFFECTS)
        try:
            moving = self.variant.animation(effects)
        except BadCourse:
            return self._shown(self._missing() or self._said["no_motion"])
        except WrongValue:
            shown = ", ".join(self.variant.animation(()).available)
            raise refusals.refused(self.variant.lang, "no_effect", names=shown) from None
        if not effects:
            usual = [e for e in ("position", "velocity") if e in moving.available]
            moving = self.variant.animation(usual)
        return self._shown(Picture(moving.svg(), moving.title))

    # -------------------------------------------------------------- predictions

    @property
    def _asked(self) -> dict[str, Prediction]:
        both = (*predictions.before_answers(self.variant), *predictions.over_the_cycle(self.variant))
        return {p.id: p for p in both}

    @property
    def predictions(self) -> dict[str, Any]:
        """What was predicted for this variant."""
        return self._kept.of(self.variant.seed, "predictions")

    def predict(self, predicted: Mapping[str, Any]) -> Shown:
        """Keep predictions, to be compared once the answers are right, or the curves are seen.

        Raises
        ------
        UnknownName
            Something that is not to be predicted here.
        BadInput
            No dictionary.
        """
        asked = self._asked
        for name in refusals.by_name(self.variant.lang, f"{self._name}.predict", predicted):
            refusals.expect(self.variant.lang, "prediction", name, asked)
        self._kept.add(self.variant.seed, "predictions", dict(predicted))
        now = self.predictions
        made = [n for n in predicted if not is_blank(now.get(n))]
        left = [n for n in predicted if is_blank(now.get(n))]
        lines = [self._said["kept_predictions"].format(made=len(made), of=len(predicted))]
        lines += [self._left(left)] if left else []
        return self._shown(*lines, self._trouble)

    def _left(self, names: Iterable[str]) -> str:
        return self._said["left"].format(names=_names(names))

    def _compared(self, names: Iterable[str]) -> str:
        """Predictions beside what came out, as a list."""
        asked, lines = self._asked, []
        for name in names:
            found = predictions.compared(self.variant, asked[name], self.predictions.get(name))
            if found is None:
                continue
            mark = {True: "✓", False: "✗", None: "?"}[found.right]
            question = predictions.asked(self.variant, asked[name])
            line = self._said["compared"].format(said=f"`{found.said.replace('`', '')}`", found=found.found)
            if found.right is None:
                line += f" ({predictions.options(self.variant, asked[name])})"
            lines.append(f"- {mark} {question} {line}")
        return "\n".join([f"**{self._said['predictions']}**", "", *lines]) if lines else ""

    # ------------------------------------------------------------------ answers

    @property
    def answers(self) -> dict[str, Any]:
        """The last answer to each question of this variant that was not blank."""
        return self._kept.of(self.variant.seed, "answers")

    def check(self, answers: Mapping[str, Any] | None = None) -> Shown:
        """Mark answers, by the name of the question, and say what to look at; kept ones fill what is blank.

        An entry ``student`` is no answer. The value of an answer is never told.

        Raises
        ------
        UnknownName
            An answer to a question that this variant does not ask.
        BadInput
            No dictionary.
        """
        told = refusals.by_name(self.variant.lang, f"{self._name}.check", {} if answers is None else answers)
        given = {n: a for n, a in told.items() if n != "student"}
        for name in given:
            refusals.expect(self.variant.lang, "question", name, self.variant.part_ids)
        copied = self._same_as_another(given)
        if not copied:
            self._kept.add(self.variant.seed, "answers", given)
        if missing := self._missing():
            return self._shown(missing, self._trouble)
        now = {**self.answers, **{n: a for n, a in given.items() if not is_blank(a)}}
        marking = self.variant.grade(now)
        lines, unanswered = [], []
        for number, mark in enumerate(marking.values(), start=1):
            if mark.verdict == "missing":
                unanswered.append(mark.part)
            else:
                lines.append(f"- {_sign(mark)} **{number}.** {mark.says}")
        if copied:
            lines.insert(0, self._said["copied"].format(seed=copied) + "\n")
        right = {m.part for m in marking.values() if m.verdict == "correct"}
        total = self._said["total"].format(
            points=points_number(marking.points, self.variant.lang),
            out_of=points_number(marking.out_of, self.variant.lang),
        )
        before = [n for n in now if answers is not None and is_blank(given.get(n))]
        after = [self._left(unanswered)] if unanswered else []
        after += [self._said["from_before"].format(names=_names(before))] if before else []
        first = next((n for n, m in marking.items() if m.verdict not in ("correct", "missing")), "")
        after += [self._said["try_hint"].format(call=self._call("hint", first))] if first else []
        asked_before = [p.id for p in predictions.before_answers(self.variant) if p.id in right]
        return self._shown(
            "\n".join(lines), f"**{total}**", " ".join(after), self._compared(asked_before), self._trouble
        )

    def _same_as_another(self, given: Mapping[str, Any]) -> int:
        """The seed of another variant that these very answers were for; 0 when there is none."""
        written = {n: a for n, a in given.items() if not is_blank(a)}
        numbers = [n for n in written if any(c.isdigit() for c in str(written[n]))]
        for seed in self._kept.seeds:
            theirs = self._kept.of(seed, "answers")
            if (
                seed != self.variant.seed
                and len(numbers) > 1
                and all(theirs.get(n) == a for n, a in written.items())
            ):
                return seed
        return 0

    @property
    def _right(self) -> frozenset[str]:
        """The quantities that the student has right."""
        marking = self.variant.grade({n: a for n, a in self.answers.items() if n in self.variant.part_ids})
        return frozenset(p.quantity for p in self.variant.parts if marking[p.id].verdict == "correct")

    # -------------------------------------------------------------------- hints

    def hint(self, question: str = "", step: int | None = None) -> Shown:
        """A hint, and one step more at each call; without a question, which there are.

        ``step`` goes to a step at once. No hint holds the value: :meth:`reveal` does.

        Raises
        ------
        UnknownName
            No such question, and no such quantity on the way to one.
        BadInput
            A step that is no whole number.
        """
        if missing := self._missing():
            return self._shown(missing)
        if not question:
            names = _names(self.variant.part_ids)
            call = self._call("hint", self.variant.part_ids[0])
            return self._shown(self._said["hint"]["which"].format(names=names, call=call))
        texts = hints.steps(self.variant, question, self._right, lambda n: self._call("hint", n))
        if not texts:
            return self._shown(self._said["hint"]["none"].format(call=self._call("reveal", question)))
        if step is not None and (isinstance(step, bool) or not isinstance(step, int)):
            raise refusals.refused(self.variant.lang, "step", found=repr(step))
        last = step if step is not None else self._hints.get(question, 0) + 1
        last = min(max(last, 1), len(texts))
        self._hints[question] = last
        said = self._said["hint"]
        pieces = [
            f"**{said['step'].format(number=k, of=len(texts))}** {text}"
            if not text.startswith("$$")
            else f"**{said['step'].format(number=k, of=len(texts))}**\n\n{text}"
            for k, text in enumerate(texts[:last], start=1)
        ]
        closing = (
            said["more"] if last < len(texts) else said["last"].format(call=self._call("reveal", question))
        )
        return self._shown(*pieces, f"*{closing}*")

    def reveal(self, question: str) -> Shown:
        """The whole step of the worked solution, with its value: for who asks for it by name.

        Raises
        ------
        UnknownName
            No such question, and no such quantity on the way to one.
        """
        if missing := self._missing():
            return self._shown(missing)
        return self._shown(hints.revealed_text(self.variant, question))

    # -------------------------------------------------------------------- plots

    def plot(self, *names: str) -> Shown:
        """Quantities over a turn of the driver, the student's own answers marked; then the predictions about them.

        Without names, the first of those asked; any that moves may be named.

        Raises
        ------
        UnknownName
            A question that does not move with the driver.
        """
        if missing := self._missing():
            return self._shown(missing)
        parts = {p.id: p for p in predictions.moving(self.variant)}
        if not parts:
            return self._shown(self._said["no_plot"])
        for name in names:
            refusals.expect(self.variant.lang, "curve", name, parts)
        first = [p.quantity for p in predictions.over_the_cycle(self.variant)]
        usual = sorted(parts, key=lambda i: parts[i].quantity not in first)[:PANELS]
        chosen = [parts[n] for n in (names or sorted(usual, key=list(parts).index))]
        driver, lang = self.variant.exercise.spec.driver.angle, self.variant.lang
        at = float(self.variant.given[driver]) % 360.0
        curves, spots = [], []
        for part in chosen:
            angles, values = predictions.curve(self.variant, part.quantity)
            curves.append(
                Axis(self.variant.exercise.symbol(part.quantity), unit_text(part.unit, lang), values)
            )
            spots.append(self._spots(part, at))
        turn = Axis(self.variant.exercise.symbol(driver), "°", angles)
        picture = Plot(turn, curves, lang, at, spots)
        symbols = ", ".join(f"${self.variant.exercise.symbol(p.quantity)}$" for p in chosen)
        said = self._said["plot"].format(list=symbols, driver=f"${self.variant.exercise.symbol(driver)}$")
        others = [n for n in parts if parts[n] not in chosen]
        more = (
            self._said["more_plots"].format(names=_names(others), call=self._call("plot", others[0]))
            if others
            else ""
        )
        asked = [p.id for p in predictions.over_the_cycle(self.variant)]
        plain = f"{', '.join(p.id for p in chosen)} / {driver}"
        return self._shown(said, Picture(picture.svg(), plain), more, self._compared(asked))

    def _spots(self, part: Any, at: float) -> tuple[Spot, ...]:
        """The student's answer as a point, where it can be read."""
        answer = self.answers.get(part.id)
        if is_blank(answer):
            return ()
        reading = read(self.variant, part, answer)
        if reading.status != "read":
            return ()
        value = float(reading.values[0])
        if part.kind == "angle":
            value = (value + 180) % 360 - 180
        return (Spot(at, value, part.quantity in self._right),)

    # ----------------------------------------------------------- other variants

    def fresh(self, number: int | None = None) -> StudySession:
        """Another variant: the first, second… after the notebook's own; without a number, the next one not begun.

        Only variants that are worth issuing count, as for a class.

        What was written for this one stays kept.

        Raises
        ------
        BadInput
            A number below 1.
        Starved
            The exercise has no more variants.
        """
        if number is not None and (isinstance(number, bool) or not isinstance(number, int) or number < 1):
            raise refusals.refused(self.variant.lang, "fresh", found=repr(number))
        begun = {seed for seed in self._kept.seeds if self._kept.of(seed, "answers")}
        # One of so many is not begun.
        count = number or len(begun) + 2
        try:
            variants = fresh_variants(self.variant.exercise, self._base, count, self.variant.lang)
        except Starved:
            raise Starved(self._said["refused"]["starved"].format(number=count)) from None
        left = [v for v in variants if v.seed not in begun and v.seed != self.variant.seed]
        variant = left[0] if number is None else variants[-1]
        return StudySession(variant, self._kept, self._base)

    def progress(self) -> Shown:
        """The variants begun, and what is right in each."""
        if missing := self._missing():
            return self._shown(missing)
        lines = []
        for seed in dict.fromkeys((self._base, *self._kept.seeds)):
            variant = self.variant.exercise.variant(seed, self.variant.lang)
            answers = {n: a for n, a in self._kept.of(seed, "answers").items() if n in variant.part_ids}
            marking = variant.grade(answers)
            right = sum(m.verdict == "correct" for m in marking.values())
            lines.append("- " + self._said["progress"].format(seed=seed, right=right, of=len(marking)))
        return self._shown("\n".join(lines), self._trouble)

    # ------------------------------------------------------------------- common

    def _call(self, method: str, name: str) -> str:
        """How the notebook calls a method, as code in Markdown."""
        return f'`{self._name}.{method}("{name}")`'

    @property
    def _name(self) -> str:
        """What the notebook calls this session."""
        return "study" if self.variant.seed == self._base else "again"

    def _missing(self) -> str:
        """What to say where the course folder has no solution of this exercise; empty when it has one."""
        try:
            self.variant.exercise.solution  # noqa: B018
        except NoSolution:
            return self._said["no_solutions"]
        return ""

    @property
    def _trouble(self) -> str:
        """What to say of the file of answers, if anything."""
        texts = self._said["trouble"]
        return texts[self._kept.trouble].format(file=self._kept.path.name) if self._kept.trouble else ""

    def _shown(self, *pieces: str | Picture) -> Shown:
        return Shown(self.variant.lang, *pieces)


def _names(names: Iterable[str]) -> str:
    return ", ".join(f"`{n}`" for n in names)


def _sign(mark: Mark) -> str:
    """The mark at the head of a line, told apart without colour."""
    if mark.verdict == "correct":
        return "✓"
    if mark.verdict in ("unreadable", "missing_unit", "wrong_unit"):
        return "?"
    return "≈" if mark.points else "✗"
