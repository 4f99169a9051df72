"""Package of a pool: its items, a test that draws one item of each exercise, the pictures, and the
manifest."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from xml.etree.ElementTree import Element

from coursework.platforms._qti_item import IMAGES, STYLE, identifier, item_file
from coursework.platforms._qti_tree import QtiSpelling, add, decimal, manifest_written, written
from coursework.platforms.items import Item, Pool, PoolSection
from coursework.platforms.pieces import PagePieces
from coursework.system.writing import File
from coursework.system.zips import PackedFile, compressed, zipped

_ITEMS, _TEST = "items", "test.xml"

#: Of an item, by their paths below the items' folder: the item, then its pictures.
Files = dict[str, PackedFile]


def item_content(item: Item, pieces: PagePieces, spelling: QtiSpelling) -> Files:
    """Return the files of a variant of a pool."""
    made = item_file(item, pieces)
    files = {f"{made.identifier}.xml": compressed([written(made.tree, spelling)])}
    return files | {f"{IMAGES}/{image.name}": compressed([image.data]) for image in made.images}


def package(pool: Pool, platform: str, spelling: QtiSpelling) -> File:
    """Return the package of a pool in one language."""
    path = Path(f"{pool.name}.{pool.lang}.{platform}.zip")
    return File(path, lambda: zipped(dict(files(pool, spelling))))


def files(pool: Pool, spelling: QtiSpelling) -> Iterator[tuple[str, bytes | PackedFile]]:
    """Yield the files of a package with their paths."""
    yield f"{_ITEMS}/{STYLE}", PagePieces(pool.folders, pool.lang).style().encode()
    for item in pool.items:
        yield from ((f"{_ITEMS}/{path}", member) for path, member in item.content.items())
    yield _TEST, written(_test(pool), spelling)
    yield "imsmanifest.xml", manifest_written(_manifest(pool, spelling), spelling)


# ---------------------------------------------------------------------------- test


def _test(pool: Pool) -> Element:
    """Return the test: one section per exercise, from which a student gets one item."""
    root = Element(
        "assessmentTest", {"identifier": _named(pool, "test"), "title": pool.title, "toolName": "coursework"}
    )
    for name, value in (("SCORE", 0.0), ("MAXSCORE", pool.points)):
        declared = add(root, "outcomeDeclaration", identifier=name, cardinality="single", baseType="float")
        add(add(declared, "defaultValue"), "value", decimal(value))
    part = add(
        root, "testPart", identifier="exercises", navigationMode="nonlinear", submissionMode="individual"
    )
    add(part, "itemSessionControl", maxAttempts="1", showFeedback="true", showSolution="false")
    part.extend(map(_section, pool.sections))
    total = add(add(root, "outcomeProcessing"), "setOutcomeValue", identifier="SCORE")
    add(add(total, "sum"), "testVariables", variableIdentifier="SCORE")
    return root


def _section(section: PoolSection) -> Element:
    element = Element(
        "assessmentSection",
        identifier=identifier(section.exercise),
        title=section.title,
        visible="true",
        keepTogether="true",
    )
    add(element, "selection", select="1")
    for item in section.items:
        path = next(iter(item.content))
        add(element, "assessmentItemRef", identifier=_identifier(path), href=f"{_ITEMS}/{path}")
    return element


def _identifier(path: str) -> str:
    return path.removesuffix(".xml")


def _named(pool: Pool, kind: str) -> str:
    return identifier(f"{pool.name}-{pool.lang}-{kind}")


# ------------------------------------------------------------------------ manifest


def _manifest(pool: Pool, spelling: QtiSpelling) -> Element:
    root = Element("manifest", identifier=_named(pool, "package"))
    metadata = add(root, "metadata")
    add(metadata, "schema", spelling.schema_name)
    add(metadata, "schemaversion", spelling.schema_version)
    add(root, "organizations")
    resources = add(root, "resources")
    test = _resource(resources, _named(pool, "test"), spelling.test_type, _TEST)
    for path, *_ in (item.content for item in pool.items):
        add(test, "dependency", identifierref=_identifier(path))
    for path, *images in (item.content for item in pool.items):
        resource = _resource(resources, _identifier(path), spelling.item_type, f"{_ITEMS}/{path}")
        for file in (STYLE, *images):
            add(resource, "file", href=f"{_ITEMS}/{file}")
    return root


def _resource(resources: Element, name: str, kind: str, path: str) -> Element:
    resource = add(resources, "resource", identifier=name, type=kind, href=path)
    add(resource, "file", href=path)
    return resource
