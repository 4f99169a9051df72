"""Canvas: a quiz in QTI 1.2, with a group for each question."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import ClassVar
from xml.etree import ElementTree as ET

from coursework.language.words import words
from coursework.platforms._canvas_groups import CanvasItem, QuestionGroup, groups, left_out
from coursework.platforms._canvas_questions import FOLDER, Questions, canvas_item, identified
from coursework.platforms._xml import below, xml_bytes
from coursework.platforms.items import Item, Loss, Pool
from coursework.platforms.pieces import Image, PagePieces
from coursework.platforms.platform import Platform
from coursework.system.writing import File
from coursework.system.zips import PackedFile, compressed, zipped

_QTI = "http://www.imsglobal.org/xsd/ims_qtiasiv1p2"
_META = "http://canvas.instructure.com/xsd/cccv1p0"
_MANIFEST = "http://www.imsglobal.org/xsd/imsccv1p1/imscp_v1p1"
_TEST, _BESIDE, _CONTENT = (
    "imsqti_xmlv1p2",
    "associatedcontent/imscc_xmlv1p1/learning-application-resource",
    "webcontent",
)


class Canvas(Platform):
    """Export for Canvas, one package per language: ``canvas.LANG.zip``."""

    name: ClassVar[str] = "canvas"

    def content(self, item: Item, pieces: PagePieces) -> CanvasItem:
        return canvas_item(item, pieces)

    def files(self, pool: Pool) -> Iterator[File]:
        yield File(Path(f"canvas.{pool.lang}.zip"), partial(_package, pool))

    def losses(self, pool: Pool) -> Iterable[Loss]:
        texts = words(pool.lang)["platforms"]["canvas"]
        for section in pool.sections:
            for group in groups(section):
                if group.is_scaled:
                    instead = texts["scaled"].format(unit=group.unit, asked=group.question.unit or "1")
                    yield Loss(section.exercise, group.part, "tolerance", instead)
                elif group.is_coarse:
                    yield Loss(section.exercise, group.part, "tolerance", texts["coarse"])
            for part, count in left_out(section).items():
                yield Loss(section.exercise, part, "one_variant", texts["left_out"].format(count=count))


def _package(pool: Pool) -> bytes:
    quiz, questions = identified("quiz", pool.name, pool.lang), Questions(pool)
    test = compressed(_test(pool, quiz, questions))
    images = questions.images
    files: dict[str, bytes | PackedFile] = {
        f"{quiz}/{quiz}.xml": test,
        f"{quiz}/assessment_meta.xml": _settings(pool, quiz),
        **{f"{FOLDER}/{image.name}": image.data for image in images},
    }
    return zipped({"imsmanifest.xml": _manifest(quiz, images), **files})


def _test(pool: Pool, quiz: str, questions: Questions) -> Iterator[bytes]:
    """Yield the quiz in pieces: a group for each question of each exercise, from which a student gets one."""
    end = b""
    for section in pool.sections:
        for group in groups(section):
            root = ET.Element("questestinterop", xmlns=_QTI)
            test = below(root, "assessment", ident=quiz, title=pool.title)
            top = below(test, "section", ident="root_section")
            group_element = _group(top, pool, group, section.title)
            for variant_question in group.asked:
                questions.add(group_element, variant_question, group)
            document = xml_bytes(root)
            first, last = document.index(b"\n      <section"), document.rindex(b"\n    </section>")
            yield document[0 if not end else first : last]
            end = document[last:]
    yield end


def _group(parent: ET.Element, pool: Pool, group: QuestionGroup, title: str) -> ET.Element:
    ident = identified("group", pool.name, pool.lang, group.exercise, str(group.number))
    element = below(parent, "section", ident=ident, title=f"{title} · {group.number}")
    selection = below(below(element, "selection_ordering"), "selection")
    below(selection, "selection_number", "1")
    below(below(selection, "selection_extension"), "points_per_item", f"{group.points:g}")
    return element


def _settings(pool: Pool, quiz: str) -> bytes:
    """Return the settings of the quiz: one attempt, no shuffling, not published yet."""
    root = ET.Element("quiz", xmlns=_META, identifier=quiz)
    points = sum(group.points for section in pool.sections for group in groups(section))
    fields = {
        "title": pool.title,
        "description": f"<p>{words(pool.lang)['platforms']['canvas']['how']}</p>",
        "shuffle_answers": "false",
        "scoring_policy": "keep_highest",
        "quiz_type": "assignment",
        "points_possible": f"{points:g}",
        "show_correct_answers": "false",
        "allowed_attempts": "1",
        "one_question_at_a_time": "false",
        "available": "false",
    }
    for name, value in fields.items():
        below(root, name, value)
    return xml_bytes(root)


def _manifest(quiz: str, images: Iterable[Image]) -> bytes:
    root = ET.Element("manifest", xmlns=_MANIFEST, identifier=f"{quiz}_manifest")
    metadata = below(root, "metadata")
    below(metadata, "schema", "IMS Content")
    below(metadata, "schemaversion", "1.1.3")
    below(root, "organizations")
    resources = below(root, "resources")
    test = below(resources, "resource", identifier=quiz, type=_TEST)
    below(test, "file", href=f"{quiz}/{quiz}.xml")
    below(test, "dependency", identifierref=f"{quiz}_meta")
    meta = f"{quiz}/assessment_meta.xml"
    resource = below(resources, "resource", identifier=f"{quiz}_meta", type=_BESIDE, href=meta)
    below(resource, "file", href=meta)
    for image in images:
        href = f"{FOLDER}/{image.name}"
        image_resource = below(
            resources, "resource", identifier=identified("file", image.name), type=_CONTENT, href=href
        )
        below(image_resource, "file", href=href)
    return xml_bytes(root)


PLATFORM = Canvas()
