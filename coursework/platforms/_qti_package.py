"""A pool as a package: its items, a test that deals one of each exercise to a student, what they show, and the manifest."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from xml.etree.ElementTree import Element

from coursework.platforms._qti_item import IMAGES, STYLE, ItemFile, identifier, item_file
from coursework.platforms._qti_tree import Spelling, add, decimal, manifest_written, written
from coursework.platforms.items import Pool, Section
from coursework.platforms.pieces import Pieces
from coursework.system.writing import File
from coursework.system.zips import zipped

_ITEMS, _TEST = "items", "test.xml"


def package(pool: Pool, platform: str, spelling: Spelling) -> File:
    """The package of a pool in one language."""
    path = Path(f"{pool.name}.{pool.lang}.{platform}.zip")
    return File(path, lambda: zipped(dict(files(pool, spelling))))


def files(pool: Pool, spelling: Spelling) -> Iterator[tuple[str, bytes]]:
    """The files of a package, by their paths in it."""
    pieces = Pieces(pool.folders, pool.lang)
    items = [[item_file(item, pieces) for item in section.items] for section in pool.sections]
    yield f"{_ITEMS}/{STYLE}", pieces.style().encode()
    for made in (one for some in items for one in some):
        yield f"{_ITEMS}/{made.identifier}.xml", written(made.tree, spelling)
        for image in made.images:
            yield f"{_ITEMS}/{IMAGES}/{image.name}", image.data
    yield _TEST, written(_test(pool, items), spelling)
    yield "imsmanifest.xml", manifest_written(_manifest(pool, items, spelling), spelling)


# ---------------------------------------------------------------------------- test


def _test(pool: Pool, items: Sequence[Sequence[ItemFile]]) -> Element:
    """One section an exercise, of which a student gets one item."""
    root = Element(
        "assessmentTest",
        {"identifier": _named(pool, "test"), "title": pool.title, "toolName": "coursework"},
    )
    for name, value in (("SCORE", 0.0), ("MAXSCORE", pool.points)):
        declared = add(root, "outcomeDeclaration", identifier=name, cardinality="single", baseType="float")
        add(add(declared, "defaultValue"), "value", decimal(value))
    part = add(
        root, "testPart", identifier="exercises", navigationMode="nonlinear", submissionMode="individual"
    )
    add(part, "itemSessionControl", maxAttempts="1", showFeedback="true", showSolution="false")
    for section, some in zip(pool.sections, items, strict=True):
        part.append(_section(section, some))
    total = add(add(root, "outcomeProcessing"), "setOutcomeValue", identifier="SCORE")
    add(add(total, "sum"), "testVariables", variableIdentifier="SCORE")
    return root


def _section(section: Section, items: Sequence[ItemFile]) -> Element:
    made = Element(
        "assessmentSection",
        identifier=identifier(section.exercise),
        title=section.title,
        visible="true",
        keepTogether="true",
    )
    add(made, "selection", select="1")
    for one in items:
        add(made, "assessmentItemRef", identifier=one.identifier, href=f"{_ITEMS}/{one.identifier}.xml")
    return made


def _named(pool: Pool, what: str) -> str:
    return identifier(f"{pool.name}-{pool.lang}-{what}")


# ------------------------------------------------------------------------ manifest


def _manifest(pool: Pool, items: Sequence[Sequence[ItemFile]], spelling: Spelling) -> Element:
    root = Element("manifest", identifier=_named(pool, "package"))
    metadata = add(root, "metadata")
    add(metadata, "schema", spelling.schema_name)
    add(metadata, "schemaversion", spelling.schema_version)
    add(root, "organizations")
    resources = add(root, "resources")
    flat = [one for some in items for one in some]
    test = _resource(resources, _named(pool, "test"), spelling.test_type, _TEST)
    for one in flat:
        add(test, "dependency", identifierref=one.identifier)
    for one in flat:
        item = _resource(resources, one.identifier, spelling.item_type, f"{_ITEMS}/{one.identifier}.xml")
        for path in (STYLE, *(f"{IMAGES}/{image.name}" for image in one.images)):
            add(item, "file", href=f"{_ITEMS}/{path}")
    return root


def _resource(resources: Element, name: str, kind: str, path: str) -> Element:
    made = add(resources, "resource", identifier=name, type=kind, href=path)
    add(made, "file", href=path)
    return made
