"""A variant as one item: what students read, an interaction a question, and how a player marks each by itself.

A response is named ``RESPONSE_`` and its part, so is its score ``SCORE_`` and what is shown of it ``FEEDBACK_``; a choice is
recorded by its letter.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from xml.etree.ElementTree import Element

from coursework.language.numbers import significant
from coursework.language.words import words
from coursework.platforms._qti_body import elements, html, is_inline, put_in_box
from coursework.platforms._qti_tree import FORMULA, LANG, add, decimal
from coursework.platforms.items import Item
from coursework.platforms.pieces import Image, Pieces, with_files
from coursework.platforms.posed import CHOICE, CHOICES, COLLECTED, NUMBER, Interval, Option, Posed
from coursework.rendering.feedback import verdict_word
from coursework.rendering.views import points_number

STYLE = "coursework.css"
IMAGES = "images"
_RIGHT, _WRONG, _NONE = "right", "wrong", "missing"
_DIGITS = 6  #: of the right number that a player may show
#: Letters that a box of a number takes: a comma or a unit is refused as it is typed, and never marked as something else.
_MASK = "[0-9.eE+-]*"
#: Letters that a box shows at once, and what players and the style sheet know this width by.
_WIDTHS = {
    "usual": (10, "qti-input-width-10"),
    "wide": (20, "qti-input-width-20"),
    "line": (72, "line"),
}
_LINES = 4  #: of a box of several, where the part says nothing


@dataclass(frozen=True)
class ItemFile:
    """An item and the pictures that it shows."""

    identifier: str
    title: str
    tree: Element
    images: tuple[Image, ...]


def identifier_of(item: Item) -> str:
    """The item's identifier, which the name of a variable in a test must be told from: no point in it, a letter before all."""
    return identifier(item.identifier.replace(".", "-"))


def identifier(text: str) -> str:
    """A text as QTI lets things be called: letters, digits, ``_`` and ``-``, and for any other sign its number."""
    name = re.sub(r"[^A-Za-z0-9_-]", lambda found: f"_{ord(found[0]):x}_", text)
    return name if re.match("[A-Za-z_]", name) else f"_{name}"


def item_file(item: Item, pieces: Pieces) -> ItemFile:
    """A variant of a pool."""
    sheet = item.handout
    opening, images = with_files(pieces.opening(item), f"{IMAGES}/{{}}")
    root = Element(
        "assessmentItem",
        {
            "identifier": identifier_of(item),
            "title": sheet.title,
            LANG: sheet.lang,
            "adaptive": "false",
            "timeDependent": "false",
            "toolName": "coursework",
        },
    )
    asked = [_Asked(posed, item, pieces) for posed in item.questions]
    for one in asked:
        root.append(one.response())
    root.extend(_outcomes(item, asked))
    add(root, "stylesheet", href=STYLE, type="text/css")
    root.append(_body(item, opening, asked, pieces))
    root.append(_processing(asked))
    for formula in root.iter(FORMULA):  # whose words for who cannot see it are of this language
        formula.set(LANG, sheet.lang)
    return ItemFile(identifier_of(item), sheet.title, root, images)


def _outcomes(item: Item, asked: Sequence[_Asked]) -> Iterator[Element]:
    yield _outcome("SCORE", 0.0, maximum=item.points)
    yield _outcome("MAXSCORE", item.points)
    for one in asked:
        score = _outcome(one.named("SCORE"), 0.0, maximum=one.posed.points)
        if one.posed.kind == COLLECTED:
            score.set("externalScored", "human")
        yield score
        if one.said:
            shown = {
                "identifier": one.named("FEEDBACK"),
                "cardinality": "single",
                "baseType": "identifier",
            }
            yield Element("outcomeDeclaration", shown)


def _outcome(name: str, value: float, maximum: float | None = None) -> Element:
    made = Element("outcomeDeclaration", identifier=name, cardinality="single", baseType="float")
    if maximum is not None:
        made.set("normalMaximum", decimal(maximum))
    add(add(made, "defaultValue"), "value", decimal(value))
    return made


# ---------------------------------------------------------------------------- body


def _body(item: Item, opening: str, asked: Sequence[_Asked], pieces: Pieces) -> Element:
    body = Element("itemBody")
    shown = elements(opening)
    body.append(shown)
    if any(one.posed.kind == NUMBER for one in asked):
        note = words(item.handout.lang)["platforms"]["qti"]["numbers"]
        shown.append(elements(f"<p>{pieces.inline(note)}</p>")[0])
    for one in asked:
        body.append(one.shown())
    return body


class _Asked:
    """A question of an item."""

    def __init__(self, posed: Posed, item: Item, pieces: Pieces):
        self.posed, self.pieces, self.lang = posed, pieces, item.handout.lang
        self.words = words(self.lang)["platforms"]["qti"]
        self.said = dict(self._said())

    def named(self, what: str) -> str:
        return identifier(f"{what}_{self.posed.question.id}")

    # -- what is answered

    def response(self) -> Element:
        """The declaration of the response, with what a player may show as right."""
        kind = self.posed.kind
        base = {NUMBER: "float", COLLECTED: "string"}.get(kind, "identifier")
        made = Element(
            "responseDeclaration",
            {
                "identifier": self.named("RESPONSE"),
                "cardinality": "multiple" if kind == CHOICES else "single",
                "baseType": base,
            },
        )
        right = tuple(self._right())
        if right:
            correct = add(made, "correctResponse")
            for value in right:
                add(correct, "value", value)
        if kind == CHOICES:
            self._map(add(made, "mapping", lowerBound="0", defaultValue="0"))
        return made

    def _right(self) -> Iterator[str]:
        if self.posed.kind == NUMBER:
            yield _shown_number(self.posed.intervals[0])
        share = max((option.share for option in self.posed.options), default=0.0)
        for option in self.posed.options:
            if option.share >= (share if self.posed.kind == CHOICE else 0.0):
                yield choice_name(option, self.posed)

    def _map(self, mapping: Element) -> None:
        """Points of each of several cases; what is wrong takes some away, and never below nothing."""
        for option in self.posed.options:
            earned = decimal(self.posed.points * option.share)
            add(mapping, "mapEntry", mapKey=choice_name(option, self.posed), mappedValue=earned)

    # -- what is seen

    def shown(self) -> Element:
        """The question as it stands in the body, and below it what may be said of the answer."""
        block = Element(html("div"), {"class": "question"})
        if self.posed.options or self._is_long:
            block.extend(self._below_prompt())
        else:
            page = elements(self.pieces.prompt(self.posed, box="<input>"))
            put_in_box(page, self._entry())
            parts = list(page) if page.get("class") is None and not (page.text or "").strip() else [page]
            block.extend(parts)
        if self.posed.kind == COLLECTED:
            block.append(self._note())
        for name, told in self.said.items():
            block.append(self._feedback(name, told))
        return block

    @property
    def _is_long(self) -> bool:
        return self.posed.kind == COLLECTED and self.posed.question.box not in _WIDTHS

    def _entry(self) -> Element:
        """The box of a number, or of an answer of one line that is kept as it is typed."""
        question = self.posed.question
        letters, width = _WIDTHS.get(question.box, _WIDTHS["usual"])
        attributes = {
            "responseIdentifier": self.named("RESPONSE"),
            "expectedLength": str(letters),
            "class": width,
            "placeholderText": self.words["answer"].format(question.number),
            "aria-label": self.words["answer"].format(question.number),
        }
        if self.posed.kind == NUMBER:
            attributes |= {"patternMask": _MASK, "data-patternmask-message": self.words["refused"]}
        return Element("textEntryInteraction", attributes)

    def _below_prompt(self) -> Iterator[Element]:
        """An interaction that holds its prompt, or stands below it where that is more than a line."""
        prompt = elements(self.pieces.prompt(self.posed))
        made = self._choices() if self.posed.options else self._lines()
        line = prompt[0] if len(prompt) == 1 and prompt[0].tag == html("p") else prompt
        if is_inline(line):
            line.tag, line.tail = "prompt", None
            made.insert(0, line)
        else:
            yield prompt
        yield made

    def _choices(self) -> Element:
        several = self.posed.kind == CHOICES
        made = Element(
            "choiceInteraction",
            {
                "responseIdentifier": self.named("RESPONSE"),
                "shuffle": "false",
                "maxChoices": "0" if several else "1",
                "class": "qti-labels-none",
            },
        )
        for option in self.posed.options:
            choice = add(made, "simpleChoice", identifier=choice_name(option, self.posed))
            label = elements(self.pieces.option(option))
            if is_inline(label):  # in one piece: there are players that set the pieces of a choice apart
                label.tag = html("span")
            choice.append(label)
        return made

    def _lines(self) -> Element:
        room = self.posed.question.room
        lines = room if isinstance(room, int) else _LINES
        return Element(
            "extendedTextInteraction",
            {
                "responseIdentifier": self.named("RESPONSE"),
                "expectedLines": str(lines),
                "class": f"qti-height-lines-{3 if lines <= 3 else 6 if lines <= 6 else 15}",
                "aria-label": self.words["answer"].format(self.posed.question.number),
            },
        )

    def _note(self) -> Element:
        """What students are told of an answer that nobody marks there."""
        return elements(f"<p><small>{self.pieces.inline(self.words['later'])}</small></p>")[0]

    def _feedback(self, name: str, told: str) -> Element:
        block = Element(
            "feedbackBlock",
            {"outcomeIdentifier": self.named("FEEDBACK"), "identifier": name, "showHide": "show"},
        )
        content = elements(
            f"<p>{self.pieces.inline(told)}</p>", **{"class": f"feedback {name.split('_')[0]}"}
        )
        add(block, "contentBody").append(content)
        return block

    def _said(self) -> Iterator[tuple[str, str]]:
        """What may be shown of an answer, Markdown, by the identifier that shows it."""
        if self.posed.kind in (COLLECTED, CHOICES):
            return
        yield _RIGHT, self._line("correct", 1.0, "")
        yield _WRONG, self._line("wrong", 0.0, "")
        for name, verdict, share, says in self._errors():
            yield name, self._line(verdict, share, says)

    def _line(self, verdict: str, share: float, says: str) -> str:
        points = self.posed.points
        return str(self.words["said"]).format(
            verdict=verdict_word(verdict, self.lang),
            points=points_number(points * share, self.lang),
            of=points_number(points, self.lang),
            says=says,
        ).strip()  # fmt: skip

    def _errors(self) -> Iterator[tuple[str, str, float, str]]:
        for some in self.errors:
            yield self._name(some[0]), some[0].verdict, some[0].share, some[0].says
        for option in self.posed.options:
            if option.says:
                verdict = "mistake" if option.share > 0 else "wrong"
                yield f"said_{choice_name(option, self.posed)}", verdict, option.share, option.says

    @cached_property
    def errors(self) -> list[list[Interval]]:
        """The intervals of the known errors in the order in which they count, an angle's turns together."""
        wrong = [one for one in self.posed.intervals if not one.is_right]
        return [list(some) for _, some in groupby(wrong, key=_told)]

    def _name(self, error: Interval) -> str:
        """What shows an error: the same of all of its intervals."""
        told = list(dict.fromkeys(_told(some[0]) for some in self.errors))
        return f"said_{told.index(_told(error)) + 1}"

    # -- what it is worth

    def rules(self) -> Iterator[Element]:
        """What a player does with the answer."""
        if self.posed.kind == COLLECTED:
            return
        condition = Element("responseCondition")
        blank = add(condition, "responseIf")
        add(add(blank, "isNull"), "variable", identifier=self.named("RESPONSE"))
        self._set(blank, 0.0, _NONE)
        if self.posed.kind == CHOICES:
            earned = add(add(condition, "responseElse"), "setOutcomeValue", identifier=self.named("SCORE"))
            add(earned, "mapResponse", identifier=self.named("RESPONSE"))
        else:
            for test, share, name in self._cases():
                case = add(condition, "responseElseIf")
                case.append(test)
                self._set(case, share, name)
            self._set(add(condition, "responseElse"), 0.0, _WRONG)
        yield condition

    def _cases(self) -> Iterator[tuple[Element, float, str]]:
        """Each answer that is known: how it is told, its share of the points, what shows it."""
        if self.posed.kind == NUMBER:
            right = [one for one in self.posed.intervals if one.is_right]
            yield self._within(right), 1.0, _RIGHT
            for some in self.errors:
                yield self._within(some), some[0].share, self._name(some[0])
            return
        for option in self.posed.options:
            name = _RIGHT if option.share >= 1 else f"said_{choice_name(option, self.posed)}"
            if option.share or option.says:
                yield self._is(option), option.share, name if name in self.said else _WRONG

    def _within(self, intervals: Sequence[Interval]) -> Element:
        """Whether the answer is in one of the intervals, their ends among them."""
        tests = [self._between(one) for one in intervals]
        if len(tests) == 1:
            return tests[0]
        either = Element("or")
        either.extend(tests)
        return either

    def _between(self, interval: Interval) -> Element:
        both = Element("and")
        for test, end in (("gte", interval.low), ("lte", interval.high)):
            compared = add(both, test)
            add(compared, "variable", identifier=self.named("RESPONSE"))
            add(compared, "baseValue", decimal(end), baseType="float")
        return both

    def _is(self, option: Option) -> Element:
        made = Element("match")
        add(made, "variable", identifier=self.named("RESPONSE"))
        add(made, "baseValue", choice_name(option, self.posed), baseType="identifier")
        return made

    def _set(self, rule: Element, share: float, name: str) -> None:
        earned = add(rule, "setOutcomeValue", identifier=self.named("SCORE"))
        add(earned, "baseValue", decimal(self.posed.points * share), baseType="float")
        if self.said:
            shown = add(rule, "setOutcomeValue", identifier=self.named("FEEDBACK"))
            add(shown, "baseValue", name, baseType="identifier")


def _processing(asked: Sequence[_Asked]) -> Element:
    """How the item is marked: each question by itself, then their sum."""
    made = Element("responseProcessing")
    for one in asked:
        made.extend(one.rules())
    total = add(add(made, "setOutcomeValue", identifier="SCORE"), "sum")
    for one in asked:
        add(total, "variable", identifier=one.named("SCORE"))
    return made


def _told(error: Interval) -> tuple[str, float, str]:
    return error.verdict, error.share, error.says


def choice_name(option: Option, posed: Posed) -> str:
    """What a choice is recorded by: its letter; its place on a sheet that was issued without."""
    return option.letter or f"choice_{posed.options.index(option) + 1}"


def _shown_number(interval: Interval) -> str:
    """The right number, rounded as far as it stays right."""
    rounded = float(significant(interval.value, _DIGITS))
    return decimal(rounded if interval.low <= rounded <= interval.high else interval.value)
