"""Questions of a Canvas quiz, in the QTI 1.2 that Canvas reads."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from decimal import Decimal
from xml.etree import ElementTree as ET

from coursework.platforms._canvas_groups import CanvasItem, QuestionGroup, VariantQuestion, accepted
from coursework.platforms._xml import below
from coursework.platforms.items import SEPARATOR, Item, Pool
from coursework.platforms.pieces import Image, PagePieces, with_files
from coursework.platforms.posed import CHOICE, CHOICES, COLLECTED, NUMBER, Option, Posed

FOLDER = "coursework"  #: of the pictures, in the package and among the course's files
_ADDRESS = f"$IMS-CC-FILEBASE$/{FOLDER}/{{}}"
_TYPES = {
    NUMBER: "numerical_question",
    CHOICE: "multiple_choice_question",
    CHOICES: "multiple_answers_question",
    COLLECTED: "essay_question",
}
_BOX = "…"
_RESPONSE = "response1"
_FIRST_ANSWER = 1001  #: Canvas identifies answers by integers


def identified(*names: str) -> str:
    """Return an identifier of the given names, the same at every export."""
    return "i" + hashlib.sha256("\n".join(names).encode()).hexdigest()[:31]


def canvas_item(item: Item, pieces: PagePieces) -> CanvasItem:
    """Return what the quiz holds of a variant."""
    opening, images = with_files(pieces.opening(item, named=False), _ADDRESS)
    questions = tuple(
        replace(posed, intervals=tuple(interval for interval in posed.intervals if interval.is_right))
        for posed in item.questions
    )
    labels = tuple(item.label_of(posed.question.id) for posed in questions)
    return CanvasItem(item.identifier, labels, opening, images, questions)


class Questions:
    """Writer of the questions of a pool, which collects their pictures."""

    def __init__(self, pool: Pool):
        self._pieces = PagePieces(pool.folders, pool.lang)
        self._images: dict[str, Image] = {}

    @property
    def images(self) -> list[Image]:
        return list(self._images.values())

    def add(self, parent: ET.Element, variant_question: VariantQuestion, group: QuestionGroup) -> None:
        """Add a question to its group."""
        posed, label = variant_question.posed, self._label(variant_question, group)
        ident = identified("question", variant_question.item.identifier, posed.question.id)
        item = below(parent, "item", ident=ident, title=label)
        self._metadata(item, posed, ident)
        presentation = below(item, "presentation")
        self._store(variant_question.item.images)
        opening = variant_question.item.opening
        self._text(presentation, f"<div>{opening}{self._prompt(posed, group, label)}</div>")
        _BODIES[posed.kind](self, item, presentation, posed, group)

    def _label(self, variant_question: VariantQuestion, group: QuestionGroup) -> str:
        """Return the label of a question in reports, with the unit if it differs from the sheet's."""
        label = variant_question.label
        return f"{label[:-1]}{SEPARATOR}{group.unit}]" if group.is_scaled else label

    def _prompt(self, posed: Posed, group: QuestionGroup, label: str) -> str:
        box = _BOX if posed.kind == NUMBER else ""
        posed_in_unit = replace(posed, question=replace(posed.question, unit=group.unit))
        html, images = with_files(self._pieces.prompt(posed_in_unit, box=box), _ADDRESS)
        self._store(images)
        return f"{html}<p><small>{label}</small></p>"

    def _store(self, images: tuple[Image, ...]) -> None:
        self._images |= {image.name: image for image in images}

    def _metadata(self, item: ET.Element, posed: Posed, ident: str) -> None:
        fields = below(below(item, "itemmetadata"), "qtimetadata")
        answers = [answer_id(index) for index in range(len(posed.options))]
        values = {
            "question_type": _TYPES[posed.kind],
            "points_possible": f"{posed.points:g}",
            **({"original_answer_ids": ",".join(answers)} if answers else {}),
            "assessment_question_identifierref": f"{ident}_q",
        }
        for label, entry in values.items():
            field = below(fields, "qtimetadatafield")
            below(field, "fieldlabel", label)
            below(field, "fieldentry", entry)

    def _text(self, parent: ET.Element, html: str) -> None:
        below(below(parent, "material"), "mattext", html, texttype="text/html")

    def _number(self, item: ET.Element, presentation: ET.Element, posed: Posed, group: QuestionGroup) -> None:
        box = below(presentation, "response_str", ident=_RESPONSE, rcardinality="Single")
        below(below(box, "render_fib", fibtype="Decimal"), "response_label", ident="answer1")
        judged = _judged(item)
        for interval in posed.intervals:
            if interval.is_right:
                value, low, high = accepted(interval, group.decades)
                either = below(below(_condition(judged), "conditionvar"), "or")
                below(either, "varequal", _digits(value), respident=_RESPONSE)
                both = below(either, "and")
                below(both, "vargte", _digits(low), respident=_RESPONSE)
                below(both, "varlte", _digits(high), respident=_RESPONSE)
                _all_points(judged[-1])

    def _choice(self, item: ET.Element, presentation: ET.Element, posed: Posed, group: QuestionGroup) -> None:
        self._offer(presentation, posed, "Single")
        judged = _judged(item)
        for index, option in enumerate(posed.options):
            if option.message:
                condition = _condition(judged, going_on=True)
                below(below(condition, "conditionvar"), "varequal", answer_id(index), respident=_RESPONSE)
                below(
                    condition, "displayfeedback", feedbacktype="Response", linkrefid=f"{answer_id(index)}_fb"
                )
        for index, option in enumerate(posed.options):
            if is_right(option):
                right = _condition(judged)
                below(below(right, "conditionvar"), "varequal", answer_id(index), respident=_RESPONSE)
                _all_points(right)
        for index, option in enumerate(posed.options):
            if option.message:
                words = below(item, "itemfeedback", ident=f"{answer_id(index)}_fb")
                self._text(below(words, "flow_mat"), self._pieces.inline(option.message))

    def _choices(
        self, item: ET.Element, presentation: ET.Element, posed: Posed, group: QuestionGroup
    ) -> None:
        self._offer(presentation, posed, "Multiple")
        right = _condition(_judged(item))
        every = below(below(right, "conditionvar"), "and")
        for index, option in enumerate(posed.options):
            where = every if is_right(option) else below(every, "not")
            below(where, "varequal", answer_id(index), respident=_RESPONSE)
        _all_points(right)

    def _offer(self, presentation: ET.Element, posed: Posed, cardinality: str) -> None:
        box = below(presentation, "response_lid", ident=_RESPONSE, rcardinality=cardinality)
        offered = below(box, "render_choice")
        for index, option in enumerate(posed.options):
            html, images = with_files(self._pieces.option(option), _ADDRESS)
            self._store(images)
            self._text(below(offered, "response_label", ident=answer_id(index)), html)

    def _collected(
        self, item: ET.Element, presentation: ET.Element, posed: Posed, group: QuestionGroup
    ) -> None:
        box = below(presentation, "response_str", ident=_RESPONSE, rcardinality="Single")
        below(below(box, "render_fib"), "response_label", ident="answer1", rshuffle="No")
        condition = _condition(_judged(item))
        below(below(condition, "conditionvar"), "other")


_BODIES = {
    NUMBER: Questions._number,
    CHOICE: Questions._choice,
    CHOICES: Questions._choices,
    COLLECTED: Questions._collected,
}


def answer_id(index: int) -> str:
    return str(_FIRST_ANSWER + index)


def is_right(option: Option) -> bool:
    """Return whether choosing an option earns points; Canvas has no message for a partly right option."""
    return option.share >= 1 or (option.share > 0 and not option.message)


def _digits(value: Decimal) -> str:
    """Return a plain decimal."""
    return f"{value:f}" if value else "0"


def _judged(item: ET.Element) -> ET.Element:
    judged = below(item, "resprocessing")
    outcome = below(judged, "outcomes")
    below(outcome, "decvar", maxvalue="100", minvalue="0", varname="SCORE", vartype="Decimal")
    return judged


def _condition(judged: ET.Element, *, going_on: bool = False) -> ET.Element:
    return below(judged, "respcondition", **{"continue": "Yes" if going_on else "No"})


def _all_points(condition: ET.Element) -> None:
    below(condition, "setvar", "100", action="Set", varname="SCORE")
