"""QTI results (``assessmentResult``, versions 2.1 to 3): the identifier of an item names the variant."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator

from coursework.errors import counted
from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected, RowOrigin, decoded_text, short_fault
from coursework.messages import Message

WHAT = Message("a result of QTI")
_ITEM = re.compile(
    r"(?:.*[.-])?(?P<exercise>\w+)[.-]v(?P<version>\w+)[.-](?P<seed>[0-9]{1,30})[.-](?P<lang>[a-z]{2,3})"
)
_NUMBERED = re.compile(r"(?:RESPONSE|R|PART)[_-]?(?P<number>[1-9][0-9]*)", re.I)
_NO_ANSWERS = ("numattempts", "duration", "completionstatus")


def read_results(data: bytes, source: str) -> Iterator[AnswerRow | Rejected | PlatformFile]:
    """Yield the answers of a file of results; entities declared in a file are never followed."""
    text, warning = decoded_text(data, source)
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        yield Rejected(source, Message("QTI results declare no entities; this file does, so it is not read"))
        return
    try:
        root = ET.fromstring(data)
    except (ET.ParseError, LookupError, ValueError) as fault:
        yield Rejected(source, Message("not XML: {problem}", problem=short_fault(fault)))
        return
    results = [element for element in root.iter() if _tag(element) == "assessmentResult"]
    items = 0
    for result in results:
        student = _student(result)
        for item in (element for element in result if _tag(element) == "itemResult"):
            items += 1
            yield from _item(item, student, source, warning)
    if items:
        yield PlatformFile(
            source,
            Message(
                "{report}, {items} of {students}",
                report=WHAT,
                items=counted(items, "item"),
                students=counted(len(results), "student"),
            ),
        )
    else:
        yield Rejected(
            source,
            Message(
                "no answers: an XML file must be {what}, an assessmentResult with itemResult in it", what=WHAT
            ),
        )


def _tag(element: ET.Element) -> str:
    """Return the name without its namespace, in the spelling of version 2."""
    name = element.tag.rpartition("}")[2].removeprefix("qti-")
    head, *rest = name.split("-")
    return head + "".join(word.capitalize() for word in rest)


def _named(element: ET.Element, name: str) -> str:
    wanted = name.replace("-", "").casefold()
    return next((v for k, v in element.attrib.items() if k.replace("-", "").casefold() == wanted), "")


def _student(result: ET.Element) -> str:
    context = next((element for element in result if _tag(element) == "context"), None)
    return "" if context is None else _named(context, "sourcedId").strip()


def _item(item: ET.Element, student: str, source: str, warning: str) -> Iterator[AnswerRow | Rejected]:
    identifier = _named(item, "identifier")
    location, match = f"{source}, {identifier}", _ITEM.fullmatch(identifier)
    answers = [answer for answer in item if _tag(answer) == "responseVariable"]
    item_answers = [
        answer for answer in answers if _named(answer, "identifier").casefold() not in _NO_ANSWERS
    ]
    if match is None:
        reason = Message(
            "this item has another name than the export gave it, such as set-exercise-v1-4-en, so its "
            "variant is "
            "unknown"
        )
        yield from (
            Rejected(location, reason, {"student": student, "answer": _values(answer)})
            for answer in item_answers
        )
        return
    origin = RowOrigin(
        (("login", student),) if student else (), (), 0, _named(item, "datestamp"), match["version"]
    )
    for answer in item_answers:
        part = _part(_named(answer, "identifier"))
        yield AnswerRow(
            student,
            match["exercise"],
            match["seed"],
            part,
            _values(answer),
            f"{location}, {part}",
            warning,
            match["lang"],
            origin,
        )


def _part(identifier: str) -> str:
    numbered = _NUMBERED.fullmatch(identifier)
    if numbered:
        return f"question_{numbered['number']}"
    return "question_1" if identifier == "RESPONSE" else identifier.removeprefix("RESPONSE_")


def _values(variable: ET.Element) -> str:
    """Return the answer; several values are separated by semicolons."""
    given = [element for element in variable if _tag(element) == "candidateResponse"]
    values = [value.text or "" for element in given for value in element if _tag(value) == "value"]
    return "; ".join(values)
