"""Questions of a Canvas quiz, as QTI 1.2 that Canvas reads."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from decimal import Decimal
from xml.etree import ElementTree as ET

from coursework.platforms._canvas_groups import Asked, Group, accepted
from coursework.platforms._xml import below
from coursework.platforms.items import SEPARATOR, Pool
from coursework.platforms.pieces import Image, Pieces, with_files
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
_FIRST_ANSWER = 1001  #: Canvas tells answers by whole numbers


def identified(*names: str) -> str:
    """The identifier of what has these names: the same at every export."""
    return "i" + hashlib.sha256("\n".join(names).encode()).hexdigest()[:31]


class Questions:
    """Writes the questions of a pool, and keeps the pictures that they show."""

    def __init__(self, pool: Pool):
        self._pool = pool
        self._pieces = Pieces(pool.folders, pool.lang)
        self._images: dict[str, Image] = {}
        self._openings: dict[str, str] = {}

    @property
    def images(self) -> list[Image]:
        return list(self._images.values())

    def add(self, parent: ET.Element, asked: Asked, group: Group) -> None:
        """A question at the end of its group."""
        posed, label = asked.posed, self._label(asked, group)
        ident = identified("question", asked.item.identifier, posed.question.id)
        item = below(parent, "item", ident=ident, title=label)
        self._metadata(item, posed, ident)
        presentation = below(item, "presentation")
        self._text(presentation, f"<div>{self._opening(asked)}{self._prompt(posed, group, label)}</div>")
        _BODIES[posed.kind](self, item, presentation, posed, group)

    def _label(self, asked: Asked, group: Group) -> str:
        """What reports tell the question by, with the unit where it is not the sheet's."""
        label = asked.item.label_of(asked.posed.question.id)
        return f"{label[:-1]}{SEPARATOR}{group.unit}]" if group.is_scaled else label

    def _opening(self, asked: Asked) -> str:
        name = asked.item.identifier
        if name not in self._openings:
            opening, images = with_files(self._pieces.opening(asked.item, named=False), _ADDRESS)
            self._openings[name] = opening
            self._keep(images)
        return self._openings[name]

    def _prompt(self, posed: Posed, group: Group, label: str) -> str:
        box = _BOX if posed.kind == NUMBER else ""
        asked = replace(posed, question=replace(posed.question, unit=group.unit))
        html, images = with_files(self._pieces.prompt(asked, box=box), _ADDRESS)
        self._keep(images)
        return f"{html}<p><small>{label}</small></p>"

    def _keep(self, images: tuple[Image, ...]) -> None:
        self._images |= {image.name: image for image in images}

    def _metadata(self, item: ET.Element, posed: Posed, ident: str) -> None:
        fields = below(below(item, "itemmetadata"), "qtimetadata")
        answers = [answer_id(place) for place in range(len(posed.options))]
        told = {
            "question_type": _TYPES[posed.kind],
            "points_possible": f"{posed.points:g}",
            **({"original_answer_ids": ",".join(answers)} if answers else {}),
            "assessment_question_identifierref": f"{ident}_q",
        }
        for label, entry in told.items():
            field = below(fields, "qtimetadatafield")
            below(field, "fieldlabel", label)
            below(field, "fieldentry", entry)

    def _text(self, parent: ET.Element, html: str) -> None:
        below(below(parent, "material"), "mattext", html, texttype="text/html")

    def _number(self, item: ET.Element, presentation: ET.Element, posed: Posed, group: Group) -> None:
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

    def _choice(self, item: ET.Element, presentation: ET.Element, posed: Posed, group: Group) -> None:
        self._offer(presentation, posed, "Single")
        judged = _judged(item)
        for place, option in enumerate(posed.options):
            if option.says:
                told = _condition(judged, going_on=True)
                below(below(told, "conditionvar"), "varequal", answer_id(place), respident=_RESPONSE)
                below(told, "displayfeedback", feedbacktype="Response", linkrefid=f"{answer_id(place)}_fb")
        for place, option in enumerate(posed.options):
            if is_right(option):
                right = _condition(judged)
                below(below(right, "conditionvar"), "varequal", answer_id(place), respident=_RESPONSE)
                _all_points(right)
        for place, option in enumerate(posed.options):
            if option.says:
                words = below(item, "itemfeedback", ident=f"{answer_id(place)}_fb")
                self._text(below(words, "flow_mat"), self._pieces.inline(option.says))

    def _choices(self, item: ET.Element, presentation: ET.Element, posed: Posed, group: Group) -> None:
        self._offer(presentation, posed, "Multiple")
        right = _condition(_judged(item))
        every = below(below(right, "conditionvar"), "and")
        for place, option in enumerate(posed.options):
            where = every if is_right(option) else below(every, "not")
            below(where, "varequal", answer_id(place), respident=_RESPONSE)
        _all_points(right)

    def _offer(self, presentation: ET.Element, posed: Posed, cardinality: str) -> None:
        box = below(presentation, "response_lid", ident=_RESPONSE, rcardinality=cardinality)
        offered = below(box, "render_choice")
        for place, option in enumerate(posed.options):
            html, images = with_files(self._pieces.option(option), _ADDRESS)
            self._keep(images)
            self._text(below(offered, "response_label", ident=answer_id(place)), html)

    def _collected(self, item: ET.Element, presentation: ET.Element, posed: Posed, group: Group) -> None:
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


def answer_id(place: int) -> str:
    return str(_FIRST_ANSWER + place)


def is_right(option: Option) -> bool:
    """Whether choosing it earns; of one that earns a part, Canvas has nothing to say."""
    return option.share >= 1 or (option.share > 0 and not option.says)


def _digits(value: Decimal) -> str:
    """Plain decimals."""
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
