"""Variant as a QTI item: the text, an interaction per question, and the marking of each question.

The variable of a response is ``RESPONSE_`` with the part's name, of its score ``SCORE_`` and of its feedback
``FEEDBACK_``; a choice is recorded by its letter.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import groupby
from xml.etree.ElementTree import Element

from coursework.language.numbers import significant
from coursework.language.words import words
from coursework.platforms._qti_body import elements, html, is_inline, put_in_box
from coursework.platforms._qti_tree import BLANKED, FORMULA, LANG, add, decimal
from coursework.platforms.items import Item
from coursework.platforms.pieces import Image, PagePieces, with_files
from coursework.platforms.posed import CHOICE, CHOICES, COLLECTED, NUMBER, Interval, Option, Posed
from coursework.rendering.feedback import verdict_word
from coursework.rendering.views import points_number

STYLE = "coursework.css"
IMAGES = "images"
_RIGHT, _WRONG, _NONE = "right", "wrong", "missing"
_DIGITS = 6  #: of the right number that a player may show
#: Letters that a box of a number takes: a comma or a unit is refused as it is typed, and never marked as
#: something else.
_MASK = "[0-9.eE+-]*"
#: Visible width of a box in characters, and its class in players and in the style sheet.
_WIDTHS = {"usual": (10, "qti-input-width-10"), "wide": (20, "qti-input-width-20"), "line": (72, "line")}
_LINES = 4  #: of a box of several lines, by default


@dataclass(frozen=True)
class ItemFile:
    """Item with its pictures."""

    identifier: str
    title: str
    tree: Element
    images: tuple[Image, ...]


def identifier_of(item: Item) -> str:
    """Return the item's identifier: without dots, since a test's variables use them, and with a letter
    first."""
    return identifier(item.identifier.replace(".", "-"))


@lru_cache(maxsize=4096)
def identifier(text: str) -> str:
    """Return a text as a QTI identifier: letters, digits, ``_`` and ``-``, and for any other character its
    code."""
    name = re.sub(r"[^A-Za-z0-9_-]", lambda match: f"_{ord(match[0]):x}_", text)
    return name if re.match("[A-Za-z_]", name) else f"_{name}"


def item_file(item: Item, pieces: PagePieces) -> ItemFile:
    """Return the file of a variant of a pool."""
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
    questions = [_QtiQuestion(posed, item, pieces) for posed in item.questions]
    for question in questions:
        root.append(question.response())
    root.extend(_outcomes(item, questions))
    add(root, "stylesheet", href=STYLE, type="text/css")
    root.append(_body(item, opening, questions, pieces))
    root.append(_processing(questions))
    _set_language(root, sheet.lang)
    return ItemFile(identifier_of(item), sheet.title, root, images)


def _set_language(root: Element, lang: str) -> None:
    """Set the language of the formulas: they have an alternative text."""
    for formula in root.iter(FORMULA):
        formula.set(LANG, lang)


def _outcomes(item: Item, questions: Sequence[_QtiQuestion]) -> Iterator[Element]:
    yield _outcome("SCORE", 0.0, maximum=item.points)
    yield _outcome("MAXSCORE", item.points)
    for question in questions:
        score = _outcome(question.named("SCORE"), 0.0, maximum=question.posed.points)
        if question.posed.kind == COLLECTED:
            score.set("externalScored", "human")
        yield score
        if question.feedback_texts:
            attributes = {
                "identifier": question.named("FEEDBACK"),
                "cardinality": "single",
                "baseType": "identifier",
            }
            yield Element("outcomeDeclaration", attributes)


def _outcome(name: str, value: float, maximum: float | None = None) -> Element:
    declaration = Element("outcomeDeclaration", identifier=name, cardinality="single", baseType="float")
    if maximum is not None:
        declaration.set("normalMaximum", decimal(maximum))
    add(add(declaration, "defaultValue"), "value", decimal(value))
    return declaration


# ---------------------------------------------------------------------------- body


def _body(item: Item, opening: str, questions: Sequence[_QtiQuestion], pieces: PagePieces) -> Element:
    body = Element("itemBody")
    content = elements(opening)
    body.append(content)
    if any(question.posed.kind == NUMBER for question in questions):
        note = words(item.handout.lang)["platforms"]["qti"]["numbers"]
        content.append(elements(f"<p>{pieces.inline(note)}</p>")[0])
    for question in questions:
        body.append(question.body())
    return body


class _QtiQuestion:
    """Question of an item."""

    def __init__(self, posed: Posed, item: Item, pieces: PagePieces):
        self.posed, self.pieces, self.lang = posed, pieces, item.handout.lang
        self.words = words(self.lang)["platforms"]["qti"]
        self.feedback_texts = dict(self._feedback_texts())

    def named(self, prefix: str) -> str:
        return identifier(f"{prefix}_{self.posed.question.id}")

    # -- the response

    def response(self) -> Element:
        """Return the declaration of the response, with the right answer that a player may show."""
        kind = self.posed.kind
        base = {NUMBER: "float", COLLECTED: "string"}.get(kind, "identifier")
        declaration = Element(
            "responseDeclaration",
            {
                "identifier": self.named("RESPONSE"),
                "cardinality": "multiple" if kind == CHOICES else "single",
                "baseType": base,
            },
        )
        right = tuple(self._right())
        if right:
            correct = add(declaration, "correctResponse")
            for value in right:
                add(correct, "value", value)
        if kind == CHOICES:
            self._map(add(declaration, "mapping", lowerBound="0", defaultValue="0"))
        return declaration

    def _right(self) -> Iterator[str]:
        if self.posed.kind == NUMBER:
            yield _shown_number(self.posed.intervals[0])
        share = max((option.share for option in self.posed.options), default=0.0)
        for option in self.posed.options:
            if option.share >= (share if self.posed.kind == CHOICE else 0.0):
                yield choice_name(option, self.posed)

    def _map(self, mapping: Element) -> None:
        """Return the points of each of several options; wrong ones subtract, down to zero."""
        for option in self.posed.options:
            earned = decimal(self.posed.points * option.share)
            add(mapping, "mapEntry", mapKey=choice_name(option, self.posed), mappedValue=earned)

    # -- the body

    def body(self) -> Element:
        """Return the question in the body, with the feedback below it."""
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
        for name, identifier_shown in self.feedback_texts.items():
            block.append(self._feedback(name, identifier_shown))
        return block

    @property
    def _is_long(self) -> bool:
        return self.posed.kind == COLLECTED and self.posed.question.box not in _WIDTHS

    def _entry(self) -> Element:
        """Return the box for a number, or for an answer of one line that is only collected."""
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
        """Return the interaction with its prompt inside, or below a prompt of several lines."""
        prompt = elements(self.pieces.prompt(self.posed))
        interaction = self._choices() if self.posed.options else self._lines()
        line = prompt[0] if len(prompt) == 1 and prompt[0].tag == html("p") else prompt
        if is_inline(line):
            line.tag, line.tail = "prompt", None
            interaction.insert(0, line)
        else:
            yield prompt
        yield interaction

    def _choices(self) -> Element:
        several = self.posed.kind == CHOICES
        interaction = Element(
            "choiceInteraction",
            {
                "responseIdentifier": self.named("RESPONSE"),
                "shuffle": "false",
                "maxChoices": "0" if several else "1",
                "class": "qti-labels-none",
            },
        )
        for option in self.posed.options:
            choice = add(interaction, "simpleChoice", identifier=choice_name(option, self.posed))
            label = elements(self.pieces.option(option))
            if is_inline(label):  # in one piece: there are players that set the pieces of a choice apart
                label.tag = html("span")
            choice.append(label)
        return interaction

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
        """Return the note below an answer that the player does not mark."""
        return elements(f"<p><small>{self.pieces.inline(self.words['later'])}</small></p>")[0]

    def _feedback(self, name: str, identifier_shown: str) -> Element:
        block = Element(
            "feedbackBlock",
            {"outcomeIdentifier": self.named("FEEDBACK"), "identifier": name, "showHide": "show"},
        )
        html, digits = self.pieces.blank_inline(identifier_shown)
        blanks = add(add(block, "contentBody"), BLANKED, digits=digits)
        blanks.append(_shared_feedback(f"<p>{html}</p>", f"feedback {name.split('_')[0]}", self.lang))
        return block

    def _feedback_texts(self) -> Iterator[tuple[str, str]]:
        """Yield the feedback on an answer, as identifier and Markdown."""
        if self.posed.kind in (COLLECTED, CHOICES):
            return
        yield _RIGHT, self._line("correct", 1.0, "")
        yield _WRONG, self._line("wrong", 0.0, "")
        for name, verdict, share, message in self._errors():
            yield name, self._line(verdict, share, message)

    def _line(self, verdict: str, share: float, message: str) -> str:
        points = self.posed.points
        return (
            str(self.words["said"])
            .format(
                verdict=verdict_word(verdict, self.lang),
                points=points_number(points * share, self.lang),
                of=points_number(points, self.lang),
                says=message,
            )
            .strip()
        )

    def _errors(self) -> Iterator[tuple[str, str, float, str]]:
        for some in self.errors:
            yield self._name(some[0]), some[0].verdict, some[0].share, some[0].message
        for option in self.posed.options:
            if option.message:
                verdict = "mistake" if option.share > 0 else "wrong"
                yield f"said_{choice_name(option, self.posed)}", verdict, option.share, option.message

    @cached_property
    def errors(self) -> list[list[Interval]]:
        """Return the intervals of the known errors in the order of their priority, an angle's turns
        together."""
        wrong = [interval for interval in self.posed.intervals if not interval.is_right]
        return [list(some) for _, some in groupby(wrong, key=_feedback_key)]

    def _name(self, error: Interval) -> str:
        """Return the identifier of an error's feedback, the same for all of its intervals."""
        distinct = list(dict.fromkeys(_feedback_key(some[0]) for some in self.errors))
        return f"said_{distinct.index(_feedback_key(error)) + 1}"

    # -- the marking

    def rules(self) -> Iterator[Element]:
        """Return the marking rules of the answer."""
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
        """Yield each known answer: its condition, its share of the points, its feedback."""
        if self.posed.kind == NUMBER:
            right = [interval for interval in self.posed.intervals if interval.is_right]
            yield self._within(right), 1.0, _RIGHT
            for some in self.errors:
                yield self._within(some), some[0].share, self._name(some[0])
            return
        for option in self.posed.options:
            name = _RIGHT if option.share >= 1 else f"said_{choice_name(option, self.posed)}"
            if option.share or option.message:
                yield self._is(option), option.share, name if name in self.feedback_texts else _WRONG

    def _within(self, intervals: Sequence[Interval]) -> Element:
        """Return whether the answer is in one of the closed intervals."""
        tests = [self._between(interval) for interval in intervals]
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
        match = Element("match")
        add(match, "variable", identifier=self.named("RESPONSE"))
        add(match, "baseValue", choice_name(option, self.posed), baseType="identifier")
        return match

    def _set(self, rule: Element, share: float, name: str) -> None:
        earned = add(rule, "setOutcomeValue", identifier=self.named("SCORE"))
        add(earned, "baseValue", decimal(self.posed.points * share), baseType="float")
        if self.feedback_texts:
            outcome = add(rule, "setOutcomeValue", identifier=self.named("FEEDBACK"))
            add(outcome, "baseValue", name, baseType="identifier")


@lru_cache(maxsize=4096)
def _shared_feedback(page: str, css_class: str, lang: str) -> Element:
    """Return a feedback for all items that have it, their digits apart; nobody changes it."""
    content = elements(page, **{"class": css_class})
    _set_language(content, lang)
    return content


def _processing(questions: Sequence[_QtiQuestion]) -> Element:
    """Return the marking of the item: each question by itself, then the sum."""
    processing = Element("responseProcessing")
    for question in questions:
        processing.extend(question.rules())
    total = add(add(processing, "setOutcomeValue", identifier="SCORE"), "sum")
    for question in questions:
        add(total, "variable", identifier=question.named("SCORE"))
    return processing


def _feedback_key(error: Interval) -> tuple[str, float, str]:
    return error.verdict, error.share, error.message


def choice_name(option: Option, posed: Posed) -> str:
    """Return the recorded name of a choice: its letter, or its position if the sheet has no letters."""
    return option.letter or f"choice_{posed.options.index(option) + 1}"


def _shown_number(interval: Interval) -> str:
    """Return the right number, rounded as far as it stays right."""
    rounded = float(significant(interval.value, _DIGITS))
    return decimal(rounded if interval.low <= rounded <= interval.high else interval.value)
