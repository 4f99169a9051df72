"""One student's version of an exercise: its numbers, its words, its answer key."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self

from coursework.course.exercise import CourseExercise, refuse_complex
from coursework.course.lettering import letters_of, printed_order
from coursework.course.texts import RenderedText
from coursework.errors import BadCourse, CourseworkError
from coursework.language.numbers import localise, plain, significant, with_unit
from coursework.language.words import languages, no_language, words
from coursework.model import Part
from coursework.quantities.graph import call_on_quantities, plain_scalar

if TYPE_CHECKING:
    from coursework.course.answer_key import Key, KeyNumbers
    from coursework.figures import Figure, Picture

_SEVERAL_JOINTS = 3  #: cases of a choice that are kinds of joints, from which on all are


class Variant:
    """One student's version of an exercise."""

    def __init__(
        self,
        exercise: CourseExercise[Any],
        seed: int,
        given: Mapping[str, Any],
        lang: str,
        parts: Sequence[Part] | None = None,
        issued: Mapping[str, Any] | None = None,
        orders: Mapping[str, Sequence[str]] | None = None,
    ):
        if lang not in languages():
            raise no_language(lang)
        self.exercise = exercise
        self.seed = seed
        self.lang = lang
        self.chosen = parts  #: the parts to ask, where they are not the usual ones
        self.given: Mapping[str, Any] = MappingProxyType(dict(given))  #: canonical units, as printed
        self._issued = issued  #: the record of an older version
        #: Of choices by part, as they were recorded; None where nothing was: they are the seed's.
        self._orders = orders
        self._found: dict[str, Any] = {}
        self._key: Key | None = None

    def __repr__(self) -> str:
        return f"<variant {self.exercise.name} {self.seed}>"

    def __reduce__(self) -> tuple[Any, ...]:
        """Return what another process makes the variant from: the exercise there, and what the key has
        computed."""
        chosen = None if self.chosen is None else {part.id: part.points for part in self.parts}
        numbers = None if self._key is None else self._key.numbers
        return _made_anew, (
            type(self),
            self.exercise,
            self.seed,
            dict(self.given),
            self.lang,
            chosen,
            self._issued,
            numbers,
            self._orders,
        )

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
        if self._issued is not None:
            return dict(self._issued)
        spec = self.exercise.spec
        return {
            "exercise": self.exercise.name,
            "version": spec.version,
            "seed": self.seed,
            "lang": self.lang,
            "given": {n: {"value": v, "unit": spec.given[n].unit} for n, v in self.given.items()},
            "parts": [self._recorded(p) for p in self.parts],
        }

    def _recorded(self, part: Part) -> dict[str, Any]:
        attributes = {name: getattr(part, name) for name in ("id", "quantity", "unit", "kind", "points")}
        letters = self.letters(part)
        return {**attributes, "choices": list(letters)} if letters else attributes

    def in_language(self, lang: str) -> Self:
        """Return the same variant on a sheet in another language."""
        variant = type(self)(
            self.exercise, self.seed, self.given, lang, self.chosen, self._issued, self._orders
        )
        variant._key = self._key  # it speaks no language
        return variant

    def asking(self, parts: Sequence[Part]) -> Self:
        """Return the same variant with other parts, or the same worth other points."""
        return type(self)(
            self.exercise, self.seed, self.given, self.lang, tuple(parts), self._issued, self._orders
        )

    def quantities(self, names: Iterable[str]) -> dict[str, Any]:
        """Quantities of this variant alone, as the solution gives them; each is computed once.

        Raises
        ------
        NoSolution
            The course folder has no solutions.
        """
        names = tuple(names)
        missing = tuple(n for n in names if n not in self._found and n not in self.used)
        if missing:
            graph = self.exercise.solution.graph
            self._found |= graph.everything(missing, self.used, self.effects, self._found)
        return {n: self.used[n] if n in self.used else self._found[n] for n in names}

    @property
    def computed(self) -> Mapping[str, Any]:
        """Return the quantities of this variant that have been computed so far, hidden ones too."""
        return MappingProxyType(self._found)

    def solution(self) -> dict[str, Any]:
        """Return the asked quantities in canonical units and full precision.

        Raises
        ------
        NoSolution
            The course folder has no solutions.
        Undefined
            One of them does not exist for the given values.
        BadCourse
            One of them is complex where its part asks for a real number.
        """
        values = self.quantities(self.asked_quantities)
        refuse_complex(self.exercise, self.parts, values)
        return {name: self.exercise.existing(name, value, self.used) for name, value in values.items()}

    @property
    def effects(self) -> tuple[str, ...]:
        """The optional effects that the parts call for."""
        return self.exercise.spec.effects

    @property
    def asked_quantities(self) -> tuple[str, ...]:
        """The quantities of the parts, and those that parts are judged with; none of what a person marks."""
        judged = [p for p in self.parts if not p.sort.is_open]
        along = (p.along for p in judged if p.along)
        return tuple(dict.fromkeys([*(p.quantity for p in judged), *along]))

    @cached_property
    def text(self) -> RenderedText:
        """The statement's sections in this variant's language."""
        return self.exercise.texts.text("exercises", self.lang, self.printed)

    @property
    def printed(self) -> dict[str, Any]:
        """Given values as running text, for the texts: ``228,6 mm``; then what the exercise tells besides."""
        spec = self.exercise.spec
        texts: dict[str, Any] = {
            n: str(v) if spec.given[n].is_choice else with_unit(plain(v), spec.given[n].unit, self.lang)
            for n, v in self.given.items()
        }
        return {**texts, **spec.statement_values(self.given)}

    @cached_property
    def used(self) -> dict[str, Any]:
        """The given quantities that the solution knows."""
        return {n: v for n, v in self.given.items() if n in self.exercise.quantity_names}

    @cached_property
    def walk(self) -> dict[str, Any]:
        """The given quantities, then every one met on the way to the asked ones, in order.

        Raises
        ------
        NoSolution
            The course folder has no solutions.
        """
        met = self.exercise.solution.graph.walk(self.asked_quantities, self.used, self.effects)
        return {**self.used, **{n: plain_scalar(v) for n, v in self.quantities(met).items()}}

    @cached_property
    def solution_text(self) -> RenderedText:
        """The sections of the solution's words; any quantity may stand in them, rounded.

        One that is not on the walk, of a question that is not asked, is computed for the words that it stands
        in.
        """
        texts, lang = self.exercise.texts, self.lang
        besides = texts.names("solutions", lang) & {*self.exercise.solution.graph.quantities}
        values = {**self.existing(besides - self.walk.keys()), **self.walk}
        rounded = {n: _rounded(v, lang) for n, v in values.items()}
        return texts.text("solutions", lang, {**rounded, **self.printed})

    def existing(self, names: Iterable[str]) -> dict[str, Any]:
        """Those of some quantities that exist for the given values, as plain Python holds them."""
        values = {}
        for name in sorted(names):
            try:
                values[name] = self.exercise.existing(name, self.quantities([name])[name], self.used)
            except BadCourse:
                raise
            except CourseworkError:
                continue
        return values

    def letters(self, part: Part) -> Mapping[str, str]:
        """Return the letters of a choice by case, in the order printed; none of a sheet that was issued
        without."""
        if not part.choices:
            return {}
        if self._orders is not None:
            return letters_of(self._orders.get(part.id, ()))
        return letters_of(printed_order(self.exercise.name, self.seed, part))

    def cases(self, part: Part) -> tuple[str, ...]:
        """Return the cases of a choice in the order printed."""
        return tuple(self.letters(part)) or part.choices

    def called(self, part: Part, case: str) -> str:
        """Return a case as its sheet offers it, with its letter where there is one: ``b) oscille``."""
        label, letter = self.label(part.id, case), self.letters(part).get(case)
        return label if letter is None else words(self.lang)["choices"]["lettered"].format(letter, label)

    def labels(self, part: Part) -> dict[str, list[str]]:
        """Return the labels of each case of a choice, in every language; empty for another kind."""
        return self.exercise.texts.labels(
            part.id, part.choices, self.lang, lambda case: self._names(part, case)
        )

    def _names(self, part: Part, case: str) -> Iterator[str]:
        """Yield the labels of a case, each without its article, and other names of a joint among joints."""
        for lang in self._langs:
            joints = words(lang)["graph"]["kinds"]
            if sum(choice in joints for choice in part.choices) >= _SEVERAL_JOINTS:
                yield from joints.get(case, ())
            yield (label := self.label(part.id, case, lang))
            if "$" in label:
                from coursework.markup.markdown import html_words, plain_line

                yield plain_line(label, lang)  # what is offered is read
                yield html_words(label, lang)  # and what a platform's report makes of it
            for article in words(lang)["choices"]["articles"]:
                start = article if article.endswith("'") else f"{article} "
                if label.replace("’", "'").lower().startswith(start):
                    yield label[len(start) :]

    @property
    def _langs(self) -> tuple[str, ...]:
        """Every language of the exercise, this variant's first."""
        return (self.lang, *(lang for lang in self.exercise.languages if lang != self.lang))

    def label(self, quantity: str, case: str, lang: str = "") -> str:
        """Return the label of a case, in this variant's language by default."""
        lang = lang or self.lang
        label = self.exercise.texts.constants("exercises", lang).labels.get((quantity, case))
        if label is None:
            label = self._engine_label(quantity, case, lang)
        if label:
            return label
        return (self.text if lang == self.lang else self.in_language(lang).text).label(quantity, case)

    def _engine_label(self, quantity: str, case: str, lang: str) -> str:
        """Return the engine's label of a case that the statement need not name: a kind of joint."""
        return next((p.sort.called(case, lang) for p in self.exercise.spec.parts if p.id == quantity), "")

    def mistake_text(self, mistake: str) -> str:
        """Return the message for a student who made a named mistake."""
        name = f"mistake {mistake}"
        text = self.exercise.texts.constants("solutions", self.lang).texts.get(name)
        return self.solution_text.section(name).text if text is None else text

    @property
    def stated(self) -> dict[str, tuple[float, str]]:
        """The numbers that the statement gives by their names, each with its unit.

        Neither a case, which has no symbol, nor the number of a drawn mechanism, which no student sees.
        """
        units, listed = self.exercise.units, self.exercise.spec.given
        return {
            n: (v, units[n])
            for n, v in self.given.items()
            if not isinstance(v, str) and listed[n].is_listed(self.part_ids)
        }

    def reference(self, quantity: str) -> Any:
        """Return the right value of an asked quantity."""
        return self.key.reference[quantity]

    @property
    def key(self) -> Key:
        """Return the answer key of the variant, made at the first use unless one was given."""
        if self._key is None:
            from coursework.course.answer_key import Key

            self._key = Key(self)
        return self._key

    @key.setter
    def key(self, key: Key) -> None:
        self._key = key

    @cached_property
    def figures(self) -> tuple[Figure | Picture, ...]:
        """The figures to scale and the pictures, in order: laid out once, shown on every sheet of the
        variant.

        Raises
        ------
        BadCourse
            What the exercise gives is not a figure, or a picture that cannot be shown.
        """
        function = self.exercise.spec.figure
        if function is None:
            return ()
        from coursework.figures import Figure, Picture

        given = call_on_quantities(function, self.given, tuple(self.exercise.spec.helpers))
        if given is None:  # of this variant
            return ()
        drawings = tuple(given) if isinstance(given, (tuple, list)) else (given,)
        for drawing in drawings:
            if not isinstance(drawing, (Figure, Picture)):
                raise BadCourse(
                    f"{self.exercise.name}: figure(…) returns a Figure, a Picture, or a tuple of them; "
                    f"found {str(drawing)[:60]}"
                )
        home, symbols = Path(function.__code__.co_filename).parent, self.exercise.symbols(self.lang)
        return tuple(
            drawing.beside(home) if isinstance(drawing, Picture) else drawing.labelled(symbols)
            for drawing in drawings
        )

    def symbol(self, name: str) -> str:
        """Return LaTeX of a quantity of the statement in the variant's language."""
        return self.exercise.symbol(name, self.lang)

    def solution_symbol(self, name: str) -> str:
        """Return LaTeX of a quantity of the solution, or else of the statement, in the variant's language."""
        return self.exercise.solution_symbol(name, self.lang)

    @property
    def figure(self) -> Figure | Picture | None:
        """The first of the figures, if there is one."""
        return self.figures[0] if self.figures else None


def _made_anew(
    kind: type[Variant],
    exercise: CourseExercise[Any],
    seed: int,
    given: Mapping[str, Any],
    lang: str,
    chosen: Mapping[str, float] | None,
    issued: Mapping[str, Any] | None,
    numbers: KeyNumbers | None,
    orders: Mapping[str, Sequence[str]] | None,
) -> Variant:
    parts = None if chosen is None else [replace(p, when=None) for p in exercise.parts_worth(chosen)]
    variant = kind(exercise, seed, given, lang, parts, issued, orders)
    if numbers is not None:
        from coursework.course.answer_key import Key

        variant.key = Key(variant, numbers=numbers)
    return variant


def _rounded(value: Any, lang: str) -> Any:
    """Return a number as running text; a list of records as it is, for the text to go through."""
    if isinstance(value, tuple):
        return value
    return localise(significant(value), lang) if isinstance(value, (int, float)) else str(value)
