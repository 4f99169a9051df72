"""Package of a pool: its items, a test that draws one item of each exercise, the pictures, and the
manifest."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from xml.etree.ElementTree import Element

from coursework.platforms._qti_item import IMAGES, STYLE, ItemFile, identifier, item_file
from coursework.platforms._qti_tree import QtiSpelling, add, decimal, manifest_written, written
from coursework.platforms.items import Pool, PoolSection
from coursework.platforms.pieces import PagePieces
from coursework.system.writing import File
from coursework.system.zips import zipped

_ITEMS, _TEST = "items", "test.xml"


def package(pool: Pool, platform: str, spelling: QtiSpelling) -> File:
    """Return the package of a pool in one language."""
    path = Path(f"{pool.name}.{pool.lang}.{platform}.zip")
    return File(path, lambda: zipped(dict(files(pool, spelling))))


def files(pool: Pool, spelling: QtiSpelling) -> Iterator[tuple[str, bytes]]:
    """Yield the files of a package with their paths."""
    pieces = PagePieces(pool.folders, pool.lang)
    items = [[item_file(item, pieces) for item in section.items] for section in pool.sections]
    yield f"{_ITEMS}/{STYLE}", pieces.style().encode()
    for written_item in (section_file for some in items for section_file in some):
        yield f"{_ITEMS}/{written_item.identifier}.xml", written(written_item.tree, spelling)
        for image in written_item.images:
            yield f"{_ITEMS}/{IMAGES}/{image.name}", image.data
    yield _TEST, written(_test(pool, items), spelling)
    yield "imsmanifest.xml", manifest_written(_manifest(pool, items, spelling), spelling)


# ---------------------------------------------------------------------------- test


def _test(pool: Pool, items: Sequence[Sequence[ItemFile]]) -> Element:
    """Return the test: one section per exercise, from which a student gets one item."""
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


def _section(section: PoolSection, items: Sequence[ItemFile]) -> Element:
    element = Element(
        "assessmentSection",
        identifier=identifier(section.exercise),
        title=section.title,
        visible="true",
        keepTogether="true",
    )
    add(element, "selection", select="1")
    for item in items:
        add(element, "assessmentItemRef", identifier=item.identifier, href=f"{_ITEMS}/{item.identifier}.xml")
    return element


def _named(pool: Pool, kind: str) -> str:
    return identifier(f"{pool.name}-{pool.lang}-{kind}")


# ------------------------------------------------------------------------ manifest


def _manifest(pool: Pool, items: Sequence[Sequence[ItemFile]], spelling: QtiSpelling) -> Element:
    root = Element("manifest", identifier=_named(pool, "package"))
    metadata = add(root, "metadata")
    add(metadata, "schema", spelling.schema_name)
    add(metadata, "schemaversion", spelling.schema_version)
    add(root, "organizations")
    resources = add(root, "resources")
    flat = [entry for some in items for entry in some]
    test = _resource(resources, _named(pool, "test"), spelling.test_type, _TEST)
    for entry in flat:
        add(test, "dependency", identifierref=entry.identifier)
    for entry in flat:
        item = _resource(resources, entry.identifier, spelling.item_type, f"{_ITEMS}/{entry.identifier}.xml")
        for path in (STYLE, *(f"{IMAGES}/{image.name}" for image in entry.images)):
            add(item, "file", href=f"{_ITEMS}/{path}")
    return root


def _resource(resources: Element, name: str, kind: str, path: str) -> Element:
    resource = add(resources, "resource", identifier=name, type=kind, href=path)
    add(resource, "file", href=path)
    return resource
