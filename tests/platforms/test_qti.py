"""The QTI packages, read back and played by an evaluator of the specification, agree with our marking; both
spellings say the same."""

from __future__ import annotations

import io
import re
import zipfile
from dataclasses import replace
from pathlib import Path, PurePosixPath
from xml.etree import ElementTree as ET

import pytest
from course_of_every_kind import write_course
from qti_answers import items_of, judged, lost_of, recorded, sheets
from qti_evaluator import Player, plain
from sweeps import sampled
from tables import each_row

import coursework
from coursework.course.secrecy import Secret
from coursework.gradebook.qti_results import read_results
from coursework.gradebook.rows import AnswerRow, PlatformFile
from coursework.issuing.assignment import read_assignment
from coursework.marking.marking import mark
from coursework.platforms._qti_item import identifier, identifier_of, item_file
from coursework.platforms._qti_tree import QTI_3, QTI_21, decimal, kebab, written
from coursework.platforms.pieces import PagePieces
from coursework.platforms.platform import platform_of
from coursework.platforms.pools import of_assignment, of_exercises
from coursework.platforms.posed import COLLECTED
from coursework.rendering.renderer import renderer_of

COURSE = coursework.open_course()
SPELLINGS = {"qti3": QTI_3, "qti21": QTI_21}
NAMES = {
    "qti3": "{http://www.imsglobal.org/xsd/imsqtiasi_v3p0}",
    "qti21": "{http://www.imsglobal.org/xsd/imsqti_v2p1}",
}
every_exercise = pytest.mark.parametrize(
    "name",
    sampled(
        COURSE.names, ("slotted_mechanism", "vocabulary", "mobility", "velocity_polygon", "four_bar_motion")
    ),
)
both = pytest.mark.parametrize("platform", SPELLINGS)


def pool_of(*names, count=1, langs=("en",)):
    return of_exercises(COURSE, names, count, 0, langs, None)


@pytest.fixture(scope="module")
def drawn():
    return pool_of("grashof", "slotted_mechanism", "velocity_polygon", count=2, langs=("en", "fr"))


def pieces_of(drawn):
    return PagePieces(renderer_of(drawn.course.folder).template_folders, "en")


def unpacked(file):
    with zipfile.ZipFile(io.BytesIO(file.make())) as archive:
        assert archive.testzip() is None
        return {name: archive.read(name) for name in archive.namelist()}


def package(drawn, platform, lang="en"):
    (file,) = files_of(drawn, platform, lang)
    return unpacked(file)


def files_of(drawn, platform, lang="en"):
    chosen = platform_of(platform)
    return list(chosen.files(drawn.pool(lang, chosen)))


def items(found):
    return {
        PurePosixPath(name).stem: data
        for name, data in found.items()
        if re.fullmatch(r"items/[^/]+\.xml", name)
    }


# ------------------------------------------------------------------------- marking


@every_exercise
def test_a_player_marks_every_answer_as_we_do_or_the_loss_is_listed(name):
    drawn = pool_of(name)
    lost, pieces = lost_of(drawn), pieces_of(drawn)
    for variant, given in items_of(drawn, "en"):
        player = Player(written(item_file(given, pieces).tree, QTI_3))
        some = sheets(variant, given)
        outcomes = [player.outcomes(answers) for answers, _ in some]
        found = list(judged(lost, variant, given, [row for _, row in some], outcomes))
        assert not [one for one in found if not one.under]
        assert sum(one.under == "same" for one in found) > 0.85 * len(found)


@every_exercise
def test_what_is_declared_right_has_full_marks(name):
    drawn = pool_of(name)
    pieces = pieces_of(drawn)
    for _, given in items_of(drawn, "en"):
        player = Player(written(item_file(given, pieces).tree, QTI_3))
        outcomes = player.outcomes(player.right())
        judged_points = sum(one.points for one in given.questions if one.kind != COLLECTED)
        assert outcomes["SCORE"] == pytest.approx(judged_points)
        assert outcomes["MAXSCORE"] == pytest.approx(given.points)
        blank = player.outcomes(recorded(given, lambda one: None))
        assert blank["SCORE"] == 0
        for one in given.questions:
            if one.kind == COLLECTED:
                assert outcomes[f"SCORE_{one.question.id}"] == 0
                assert player.declared[f"RESPONSE_{one.question.id}"].get("baseType") == "string"


def test_a_known_error_is_told_and_priced():
    drawn = pool_of("slotted_mechanism")
    (_, given), *_ = items_of(drawn, "en")
    pieces = pieces_of(drawn)
    player = Player(written(item_file(given, pieces).tree, QTI_21))
    posed = given.questions[1]
    error = next(one for one in posed.intervals if "arctangent" in one.message)
    outcomes = player.outcomes({"RESPONSE_theta4": f"{error.value:.6g}"})
    assert outcomes["SCORE_theta4"] == error.share * posed.points
    (shown,) = (
        one
        for one in player.item.iter("feedbackBlock")
        if one.get("outcomeIdentifier") == "FEEDBACK_theta4"
        and one.get("identifier") == outcomes["FEEDBACK_theta4"]
    )
    assert "arctangent" in "".join(shown.itertext())
    assert outcomes["FEEDBACK_rA"] == "missing"
    turned = player.outcomes({"RESPONSE_theta4": f"{posed.intervals[0].value + 360:.6g}"})
    assert turned["FEEDBACK_theta4"] == "right"


def test_several_cases_count_each_and_never_below_nothing(tmp_path):
    write_course(tmp_path)
    drawn = of_exercises(coursework.open_course(tmp_path), ["coil"], 1, 0, ["en"], None)
    (variant, given), *_ = items_of(drawn, "en")
    player = Player(written(item_file(given, pieces_of(drawn)).tree, QTI_3))
    part = next(one for one in variant.parts if one.id == "true_of_it")
    letter = variant.letters(part)
    for chosen, points in (
        (["lags", "heats", "stores"], 2),
        (["lags"], 2 / 3),
        (["lags", "leads"], 0),
        (["leads"], 0),
        ([], 0),
        (["lags", "heats", "stores", "leads"], 0),
    ):
        outcomes = player.outcomes({"RESPONSE_true_of_it": [letter[case] for case in chosen]})
        ours = mark(variant, {"true_of_it": ", ".join(letter[case] for case in chosen)})["true_of_it"]
        assert outcomes["SCORE_true_of_it"] == pytest.approx(points) == pytest.approx(ours.points), chosen
    texts = {one.get("responseIdentifier") for one in player.item.iter("extendedTextInteraction")}
    assert texts == {"RESPONSE_why", "RESPONSE_sketch"}
    sums = {(part, feature) for _, part, feature in lost_of(drawn, "qti21")}
    assert {("why", "open"), ("Z", "form"), ("true_of_it", "unreadable")} & sums == {
        ("why", "open"),
        ("Z", "form"),
    }


# ------------------------------------------------------------------------- package


@both
def test_every_path_is_told_once_and_there(drawn, platform):
    found = package(drawn, platform)
    assert all(re.fullmatch(r"[A-Za-z0-9._/-]+", name) and ".." not in name for name in found)
    manifest = ET.fromstring(found["imsmanifest.xml"])
    space = manifest.tag.removesuffix("manifest")
    told = {one.get("href") for one in manifest.iter(f"{space}file")}
    assert told | {"imsmanifest.xml"} == set(found)
    resources = {one.get("identifier"): one.get("href") for one in manifest.iter(f"{space}resource")}
    assert {one.get("identifierref") for one in manifest.iter(f"{space}dependency")} <= set(resources)
    for name, data in items(found).items():
        root = plain(ET.fromstring(data))
        assert root.get("identifier") == name
        assert resources[name] == f"items/{name}.xml"
        shown = [one.get("src") for one in root.iter("img")] + [
            one.get("href") for one in root.iter("stylesheet")
        ]
        assert all(f"items/{path}" in found for path in shown)
        assert all(one.get("alt") for one in root.iter("img"))
        assert not re.search(rb'(?:src|href)="(?:https?:)?//', data)


@both
def test_a_section_deals_one_variant_of_an_exercise(drawn, platform):
    found = package(drawn, platform)
    test = plain(ET.fromstring(found["test.xml"]))
    sections = list(test.iter("assessmentSection"))
    assert [one.get("identifier") for one in sections] == ["grashof", "slotted_mechanism", "velocity_polygon"]
    for section in sections:
        assert section.find("selection").get("select") == "1"
        references = section.findall("assessmentItemRef")
        assert len(references) == 2
        for one in references:
            assert one.get("href") in found
            assert "." not in one.get("identifier")  # a point parts an item from its variable
    maximum = {one.get("identifier"): one for one in test.findall("outcomeDeclaration")}["MAXSCORE"]
    of_items = {}
    for name, data in items(found).items():
        declared = {
            one.get("identifier"): one for one in plain(ET.fromstring(data)).findall("outcomeDeclaration")
        }
        of_items[name.split("-")[1]] = float(declared["MAXSCORE"].findtext("defaultValue/value"))
    assert float(maximum.findtext("defaultValue/value")) == sum(of_items.values())


def test_the_two_spellings_say_the_same(drawn):
    new, old = (items(package(drawn, platform)) for platform in ("qti3", "qti21"))
    assert list(new) == list(old)
    for name in new:
        one, other = ET.fromstring(new[name]), ET.fromstring(old[name])
        assert one.tag == f"{NAMES['qti3']}qti-assessment-item"
        assert other.tag == f"{NAMES['qti21']}assessmentItem"
        assert _content(plain(one)) == _content(plain(other))


def _content(element):
    """Tags, the attributes that both versions have, texts; what wraps feedback in one alone is passed
    over."""
    children = [found for child in element for found in _content(child)]
    if element.tag == "contentBody":
        return children
    kept = {
        name: value
        for name, value in element.attrib.items()
        if name not in ("externalScored", "ariaLabel", "dataPatternmaskMessage")
        and "schema" not in name.lower()
    }
    return [
        (
            element.tag,
            sorted(kept.items()),
            (element.text or "").strip(),
            (element.tail or "").strip(),
            children,
        )
    ]


@both
def test_the_archive_says_neither_when_nor_in_which_order_it_was_written(platform):
    (one,) = files_of(pool_of("grashof"), platform)
    with zipfile.ZipFile(io.BytesIO(one.make())) as archive:
        assert archive.namelist() == sorted(archive.namelist())
        assert {info.date_time for info in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}


def test_identifiers_stay_when_a_pool_grows():
    few, many = (set(items(package(pool_of("grashof", count=count), "qti3"))) for count in (2, 4))
    assert few < many


@both
def test_each_language_has_its_package_and_every_item_its_label(drawn, platform):
    for lang, comma in (("en", "decimal point"), ("fr", "point décimal")):
        found = items(package(drawn, platform, lang))
        for name, data in found.items():
            root = plain(ET.fromstring(data))
            text = " ".join(" ".join(root.find("itemBody").itertext()).split())
            _, exercise, version, seed, ending = name.rsplit("-", 4)
            assert ending == lang
            assert f"[{exercise} · {seed} · {version} · {lang}]" in text
            assert root.get("lang") == lang
            assert (comma in text) == any(
                True for one in root.iter("textEntryInteraction") if one.get("patternMask")
            )
            assert {one.get("lang") for one in root.iter("math")} == {lang}


def test_a_choice_is_one_piece(drawn):
    """Players lay out the pieces of a choice side by side, and lose the spaces between them."""
    for data in items(package(drawn, "qti3")).values():
        for choice in plain(ET.fromstring(data)).iter("simpleChoice"):
            assert len(choice) == 1
            assert not (choice.text or "").strip() + (choice[0].tail or "").strip()


def test_numbers_are_plain_decimals_compared_by_their_ends(drawn):
    for data in items(package(drawn, "qti3")).values():
        root = plain(ET.fromstring(data))
        processing = root.find("responseProcessing")
        tags = {one.tag for one in processing.iter()}
        assert tags <= set(
            "responseProcessing responseCondition responseIf responseElseIf responseElse isNull and or "
            "gte lte match "
            "variable baseValue setOutcomeValue sum mapResponse".split()
        )
        for one in processing.iter("baseValue"):
            if one.get("baseType") == "float":
                assert re.fullmatch(r"-?[0-9]+(\.[0-9]+)?", one.text)
        for condition in processing.iter("responseCondition"):
            assert condition[0][0].tag == "isNull"


@each_row("value", [-3e-12, 1e22, 0.1 + 0.2, -0.0, 5e-324, 123.0, 2**53 + 1.0])
def test_a_plain_decimal_is_the_same_number(value):
    assert re.fullmatch(r"-?[0-9]+(\.[0-9]+)?", decimal(value))
    assert float(decimal(value)) == value


@each_row(
    ("name", "spelled"),
    [("assessmentItem", "assessment-item"), ("isNull", "is-null"), ("gte", "gte"), ("xml:lang", "xml:lang")],
)
def test_a_word_of_the_old_version_in_the_new(name, spelled):
    assert kebab(name) == spelled


def test_an_identifier_is_one_and_another_for_another_name():
    names = ["rA", "r A", "r_A", "2026-week", "é", "a.b", "a/b"]
    made = [identifier(name) for name in names]
    assert len(set(made)) == len(names)
    assert all(re.fullmatch(r"[A-Za-z_][A-Za-z0-9_-]*", one) for one in made)


# ------------------------------------------------------------------------- hostile


@each_row(
    "text", ['<script>alert("1")</script>', "a & b < c > d", "]]>", "{{7*7}}", "' onclick='x", "\u202e é ü"]
)
def test_a_label_prints_as_it_is_and_does_nothing(drawn, text):
    (_, given), *_ = items_of(pool_of("grashof"), "en")
    posed = given.questions[-1]
    options = (replace(posed.options[0], label=text.replace("*", "\\*")), *posed.options[1:])
    hostile = replace(given, questions=(*given.questions[:-1], replace(posed, options=options)))
    for spelling in SPELLINGS.values():
        data = written(item_file(hostile, pieces_of(drawn)).tree, spelling)
        root = plain(ET.fromstring(data))
        label = "".join(next(root.iter("simpleChoice")).itertext())
        assert text.replace("'", "’") in label.replace("\u2060", "").replace(
            "'", "’"
        ) or text in label.replace("\u2060", "")
        assert not list(root.iter("script"))
        assert b"{{" not in data


# ---------------------------------------------------------------------- assignment


def test_points_of_an_assignment_are_those_of_its_items(tmp_path):
    path = tmp_path / "week 3.toml"
    path.write_text(
        'title = "Week 3 & more"\n[[exercises]]\nname = "grashof"\npoints = 6\n'
        '[[exercises]]\nname = "slotted_mechanism"\nparts = ["rA", "omega4"]\npoints = {rA = 2, omega4 '
        "= 3}\n",
        "utf-8",
    )
    drawn = of_assignment(COURSE, read_assignment(path, COURSE), 2, ["en"], Secret.new())
    found = package(drawn, "qti3")
    for name, data in items(found).items():
        player = Player(data)
        outcomes = player.outcomes(player.right())
        assert outcomes["SCORE"] == pytest.approx(6 if "grashof" in name else 5)
        assert name.startswith("week-3-")
    test = plain(ET.fromstring(found["test.xml"]))
    assert test.get("title") == "Week 3 & more"
    assert float(test.findall("outcomeDeclaration")[1].findtext("defaultValue/value")) == 11


# ------------------------------------------------------------------------ way back


def test_what_a_player_reported_of_an_export_is_read_row_by_row():
    """``recorded/qti_sitting.xml`` is what the qti-sdk reported of a student who sat an exported test."""
    data = (Path(__file__).parent / "recorded" / "qti_sitting.xml").read_bytes()
    found = [one for one in read_results(data, "sitting.xml") if not isinstance(one, PlatformFile)]
    assert all(isinstance(one, AnswerRow) for one in found)
    asked = {"slotted_mechanism", "grashof", "velocity_polygon"}
    assert {(one.exercise, one.student) for one in found} == {(name, "s3") for name in asked}
    parts = {part.id for name in asked for part in COURSE[name].spec.parts}
    assert {one.part for one in found} <= parts
    recorded = len(re.findall(rb'identifier="RESPONSE_', data))
    assert len(found) == recorded
    texts = {one.part: one.answer for one in found}
    assert "12.5 ; 3" in texts.values()
    assert texts["linkage_type"] in "abcdefg"


def test_identifiers_are_read_as_they_are_written(drawn):
    from coursework.gradebook.qti_results import _ITEM

    for lang in ("en", "fr"):
        for _, given in items_of(drawn, lang):
            told = _ITEM.fullmatch(identifier_of(given))
            sheet = given.handout
            assert told
            assert (told["exercise"], told["seed"], told["lang"]) == (sheet.exercise, str(sheet.seed), lang)
