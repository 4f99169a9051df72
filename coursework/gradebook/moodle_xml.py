"""Marks in the format of Moodle's XML import: the item and the students by their ID numbers, without any
mapping."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence

from coursework.errors import BadInput
from coursework.gradebook.class_points import Scored
from coursework.issuing.identity import NUMBER, plain

_NUMBERS = ("id number", plain("numéro d'identification"), *NUMBER)


def number_of(student: Scored) -> str:
    """Return a student's number; empty if there is none."""
    identifiers = {plain(title): value for title, value in student.ids}
    return next((identifiers[title] for title in _NUMBERS if title in identifiers), "")


def moodle_xml(
    item: str, scored: Sequence[Scored], most: float | None, batch: str
) -> tuple[bytes, list[str]]:
    """Return the file, and the students who are not in it since they have no number.

    Raises
    ------
    BadInput
        Nobody has a number, or somebody more than the maximum.
    """
    root = ET.Element("results", batch=batch)
    left = [student.name for student in scored if not number_of(student)]
    if len(left) == len(scored):
        raise BadInput(
            "Moodle's XML names students by their ID number, and the class has none: give a roster "
            "with a column 'ID number' when "
            "exporting, or fill a --template"
        )
    for student in scored:
        if number := number_of(student):
            points = student.of(most)
            limit = most if most is not None else float(student.out_of or "inf")
            if not 0 <= float(points) <= limit:
                raise BadInput(
                    "{name} has {points} of {limit:g}: Moodle would refuse it, and nothing is written",
                    name=student.name,
                    points=points,
                    limit=limit,
                )
            result = ET.SubElement(root, "result")
            for tag, text in (("state", "new"), ("assignment", item), ("student", number), ("score", points)):
                ET.SubElement(result, tag).text = text
    ET.indent(root)
    return ET.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n", left
