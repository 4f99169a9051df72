"""One student's version of an exercise: its numbers, its sheet, its answers, its marks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from coursework import statement
from coursework.graph import plain_scalar
from coursework.language import languages, localise, no_language, plain, significant, with_unit, words
from coursework.model import Part

if TYPE_CHECKING:
    from coursework.constructions import Construction
    from coursework.exercise import CourseExercise
    from coursework.figures import Figure
    from coursework.handout import AnswerSheet, Handout
    from coursework.key import Key
    from coursework.marking import Marking
    from coursework.motion import Animation
    from coursework.selfstudy.sheet import StudySheet


class Variant:
    """One student's version of an exercise."""

    def __init__(
        self,
        exercise: CourseExercise,
        seed: int,
        given: Mapping[str, Any],
        lang: str,
        parts: Sequence[Part] | None = None,
    ):
        if lang not in languages():
            raise no_language(lang)
        self.exercise = exercise
        self.seed = seed
        self.lang = lang
        self.chosen = parts  #: the parts to ask, where they are not the usual ones
        self.given: Mapping[str, Any] = MappingProxyType(dict(given))  #: canonical units, as printed

    def __repr__(self) -> str:
        return f"<variant {self.exercise.name} {self.seed}>"

    def __reduce__(self) -> tuple[Any, ...]:
        """In another process it is made anew of the exercise there; what its key has computed goes along."""
        chosen = None if self.chosen is None else tuple(part.id for part in self.chosen)
        numbers = self.key.numbers if "key" in self.__dict__ else None
        return _made_anew, (self.exercise, self.seed, dict(self.given), self.lang, chosen, numbers)

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """The parts that this variant asks."""
        if self.chosen is None:
            return self.exercise.usual_parts(self.given)
        return tuple(part for part in self.chosen if part.is_asked(self.given))

    @property
    def part_ids(self) -> tuple[str, ...]:
        return tuple(part.id for part in self.parts)

    @cached_property
    def record(self) -> dict[str, Any]:
        """The JSON record: what is issued, stored and marked against; no answer in it."""
        spec = self.exercise.spec
        return {
            "exercise": self.exercise.name,
            "version": spec.version,
            "seed": self.seed,
            "lang": self.lang,
            "given": {n: {"value": v, "unit": spec.given[n].unit} for n, v in self.given.items()},
            "parts": [
                {"id": p.id, "quantity": p.quantity, "unit": p.unit, "kind": p.kind, "points": p.points}
                for p in self.parts
            ],
        }

    def in_language(self, lang: str) -> Variant:
        """The same variant on a sheet in another language."""
        variant = Variant(self.exercise, self.seed, self.given, lang, self.chosen)
        if "key" in self.__dict__:
            variant.__dict__["key"] = self.key  # it speaks no language
        return variant

    def solution(self) -> dict[str, Any]:
        """The asked quantities in canonical units and full precision."""
        return self.exercise.solve(**self.given, only=self.asked_quantities, effects=self.effects)

    @property
    def effects(self) -> tuple[str, ...]:
        """The optional effects that the parts call for."""
        return self.exercise.spec.effects

    @property
    def asked_quantities(self) -> tuple[str, ...]:
        """The quantities of the parts, and those that parts are judged with."""
        along = (p.along for p in self.parts if p.along)
        return tuple(dict.fromkeys([*(p.quantity for p in self.parts), *along]))

    @cached_property
    def text(self) -> statement.Text:
        """The statement's sections in this variant's language."""
        return self.exercise.text("exercises", self.lang, self.printed)

    @property
    def printed(self) -> dict[str, Any]:
        """Given values as running text, for the texts: ``228,6 mm``; then what the exercise tells besides."""
        spec = self.exercise.spec
        shown: dict[str, Any] = {
            n: str(v) if spec.given[n].is_choice else with_unit(plain(v), spec.given[n].unit, self.lang)
            for n, v in self.given.items()
        }
        return {**shown, **spec.told(self.given)}

    @cached_property
    def used(self) -> dict[str, Any]:
        """The given quantities that the solution knows."""
        return {n: v for n, v in self.given.items() if n in self.exercise.quantity_names}

    @cached_property
    def found(self) -> dict[str, Any]:
        """Every quantity met on the way to the asked ones, of this variant alone, as the solution gives it;
        hidden ones too.

        Raises
        ------
        NoSolution
            The course folder has no solutions.
        """
        graph = self.exercise.solution.graph
        return graph.everything(self.asked_quantities, self.used, self.effects)

    @cached_property
    def walk(self) -> dict[str, Any]:
        """The given quantities, then every one met on the way to the asked ones, in order.

        Raises
        ------
        NoSolution
            The course folder has no solutions.
        """
        found = self.exercise.solution.graph.evaluate_all(self.asked_quantities, self.used, self.effects)
        return {**self.used, **{n: plain_scalar(v) for n, v in found.items()}}

    @cached_property
    def solution_text(self) -> statement.Text:
        """The sections of the solution's words; any quantity of the walk may stand in them, rounded."""
        rounded = {n: _rounded(v, self.lang) for n, v in self.walk.items()}
        return self.exercise.text("solutions", self.lang, {**rounded, **self.printed})

    def labels(self, part: Part) -> dict[str, list[str]]:
        """What each case of a choice is called, in every language; nothing for another kind."""
        known = self.exercise.constant_labels
        place = (part.id, self.lang)
        if place not in known:
            found = {case: [*self._called(part.id, case)] for case in part.choices}
            if not all(self.exercise.is_constant(part.id, case) for case in part.choices):
                return found
            known[place] = found
        return known[place]

    def _called(self, part: str, case: str) -> Iterator[str]:
        """The labels of a case, and each without its article."""
        for lang in self._langs:
            yield (label := self.label(part, case, lang))
            if "$" in label:
                from coursework.telling import plain_line

                yield plain_line(label, lang)  # what is offered is read
            for article in words(lang)["choices"]["articles"]:
                start = article if article.endswith("'") else f"{article} "
                if label.replace("’", "'").lower().startswith(start):
                    yield label[len(start) :]

    @property
    def _langs(self) -> tuple[str, ...]:
        """Every language of the exercise, this variant's first."""
        return (self.lang, *(lang for lang in self.exercise.languages if lang != self.lang))

    def label(self, quantity: str, case: str, lang: str = "") -> str:
        """What a case is called, in this variant's language unless told."""
        lang = lang or self.lang
        label = self.exercise.constants("exercises", lang).labels.get((quantity, case))
        if label is not None:
            return label
        return (self.text if lang == self.lang else self.in_language(lang).text).label(quantity, case)

    def told(self, mistake: str) -> str:
        """What to say to who made a named mistake."""
        name = f"mistake {mistake}"
        text = self.exercise.constants("solutions", self.lang).texts.get(name)
        return self.solution_text.section(name).text if text is None else text

    @cached_property
    def key(self) -> Key:
        """What the variant's answers are marked by."""
        from coursework.key import Key

        return Key(self)

    def grade(self, answers: Mapping[str, Any]) -> Marking:
        """Mark a student's answers, by part id.

        Raises
        ------
        UnknownName
            An answer to a part that this variant does not ask.
        """
        from coursework.marking import mark

        return mark(self, answers)

    @cached_property
    def figure(self) -> Figure | None:
        """The figure to scale: laid out once, shown on every sheet of the variant."""
        from coursework.sheets import figure

        return figure(self)

    def animation(self, effects: Sequence[str] = (), count: int = 72) -> Animation:
        """The mechanism over the cycle of its driver; see :class:`~coursework.motion.Animation`."""
        from coursework.motion import Animation

        return Animation(self, effects, count)

    def polygons(self) -> tuple[Construction, ...]:
        """The velocity and acceleration polygons that the solution states, drawn to scale.

        None where it states none, and none in which nothing moves.

        Raises
        ------
        NoSolution
            The course folder has no solutions.
        """
        return self._polygons

    @cached_property
    def _polygons(self) -> tuple[Construction, ...]:
        from coursework.sheets import polygons

        return polygons(self)

    def handout(self, student: str = "") -> Handout:
        """What the student's sheet shows."""
        return replace(self._handout, student=student)

    @cached_property
    def _handout(self) -> Handout:
        from coursework.sheets import handout

        return handout(self)

    def study_sheet(self, student: str = "") -> StudySheet:
        """What the self-study notebook of this variant shows."""
        from coursework.selfstudy.sheet import study_sheet

        return study_sheet(self, student)

    def answer_sheet(self, student: str = "", *, polygons: bool = True) -> AnswerSheet:
        """The handout with its answers and worked solution."""
        from coursework.sheets import answer_sheet

        return answer_sheet(self, student, polygons=polygons)


def _made_anew(
    exercise: CourseExercise,
    seed: int,
    given: Mapping[str, Any],
    lang: str,
    chosen: Sequence[str] | None,
    numbers: Mapping[str, Any] | None,
) -> Variant:
    parts = {part.id: part for part in exercise.spec.parts}
    variant = Variant(exercise, seed, given, lang, None if chosen is None else [parts[i] for i in chosen])
    if numbers is not None:
        variant.key.__dict__.update(numbers)
    return variant


def _rounded(value: Any, lang: str) -> Any:
    """A number as running text; a list of records as it is, for the text to go through."""
    if isinstance(value, tuple):
        return value
    return localise(significant(value), lang) if isinstance(value, (int, float)) else str(value)
