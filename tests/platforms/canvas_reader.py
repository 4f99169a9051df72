"""A reader of Canvas packages that shares nothing with the writer, and a judge by the rules that Canvas's own
sources state."""

from __future__ import annotations

import io
import re
import zipfile
from decimal import Decimal
from xml.etree import ElementTree as ET

Q = "{http://www.imsglobal.org/xsd/ims_qtiasiv1p2}"
M = "{http://www.imsglobal.org/xsd/imsccv1p1/imscp_v1p1}"


def unpacked(data):
    archive = zipfile.ZipFile(io.BytesIO(data))
    assert archive.testzip() is None
    return {name: archive.read(name) for name in archive.namelist()}


def quiz_of(files):
    """The quiz that the manifest names: ``{group's title: (pick, points, [question, …])}``, in order."""
    manifest = ET.fromstring(files["imsmanifest.xml"])
    resources = {one.get("type"): one for one in manifest.iter(f"{M}resource")}
    for one in manifest.iter(f"{M}file"):
        assert one.get("href") in files
    path = resources["imsqti_xmlv1p2"].find(f"{M}file").get("href")
    root = ET.fromstring(files[path]).find(f"{Q}assessment/{Q}section")
    return {group.get("title"): _group(group) for group in root.findall(f"{Q}section")}


def _group(group):
    selection = group.find(f"{Q}selection_ordering/{Q}selection")
    pick = int(selection.find(f"{Q}selection_number").text)
    points = float(selection.find(f"{Q}selection_extension/{Q}points_per_item").text)
    return pick, points, [_question(item) for item in group.findall(f"{Q}item")]


def _question(item):
    fields = {
        field.find(f"{Q}fieldlabel").text: field.find(f"{Q}fieldentry").text
        for field in item.iter(f"{Q}qtimetadatafield")
    }
    return {
        "ident": item.get("ident"),
        "label": re.findall(r"\[[^\[\]]*\]", item.find(f"{Q}presentation/{Q}material/{Q}mattext").text)[-1],
        "text": item.find(f"{Q}presentation/{Q}material/{Q}mattext").text,
        "sort": fields["question_type"],
        "points": float(fields["points_possible"]),
        "offered": {
            one.get("ident"): one.find(f".//{Q}mattext").text
            for one in item.iter(f"{Q}response_label")
            if one.find(f".//{Q}mattext") is not None
        },
        "conditions": [_condition(one) for one in item.iter(f"{Q}respcondition")],
        "said": {one.get("ident"): one.find(f".//{Q}mattext").text for one in item.iter(f"{Q}itemfeedback")},
    }


def _condition(condition):
    def texts(tag):
        return [one.text for one in condition.iter(f"{Q}{tag}")]

    negated = [one.text for no in condition.iter(f"{Q}not") for one in no.iter(f"{Q}varequal")]
    pays = condition.find(f"{Q}setvar") is not None
    return {
        "equal": [t for t in texts("varequal") if t not in negated],
        "not": negated,
        "low": texts("vargte"),
        "high": texts("varlte"),
        "pays": pays,
    }


def takes_number(question, typed):
    """Whether Canvas takes what is typed: the page keeps four decimals, the importer an exact value and a
    margin."""
    kept = Decimal(f"{float(typed):.4f}")
    for one in question["conditions"]:
        exact = Decimal(one["equal"][0])
        margin = Decimal(one["high"][0]) - exact
        assert exact - margin == Decimal(one["low"][0])
        if exact - margin <= kept <= exact + margin:
            return True
    return False


def share_of_chosen(question, chosen):
    """The share that Canvas gives for cases that are chosen, by their identifiers."""
    right = {ident for one in question["conditions"] if one["pays"] for ident in one["equal"]}
    if question["sort"] == "multiple_choice_question":
        return float(set(chosen) <= right)
    return max(0.0, (len(set(chosen) & right) - len(set(chosen) - right)) / len(right))
