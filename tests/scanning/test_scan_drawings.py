"""Papers of several pages, answers of several coordinates, and drawings whose points somebody clicks."""

from __future__ import annotations

import json

import pytest
from scanned_class import ScannedClass, answered, queued, rows, save
from site_browser import chromium

from coursework.scanning.scan import scan

pytestmark = pytest.mark.e2e

ADA = "Ada"


@pytest.fixture(scope="module")
def scanned(tmp_path_factory):
    return ScannedClass(tmp_path_factory.mktemp("drawn"), (ADA,), "velocity_polygon")


@pytest.fixture
def read(pages_are_told, scanned, tmp_path):
    """Read pages, by number, on which something is written."""

    def job(*numbers, **answers):
        paths = [save(tmp_path / f"{n}.png", scanned.told(ADA, n, answers)) for n in numbers]
        return scan(scanned.course, paths, scanned.issued, tmp_path / "read")

    job.out = tmp_path / "read"
    return job


def pages_of(scanned, *parts):
    """The answer pages that ask some parts."""
    found = [p.number for p in scanned.pages(ADA) if {f.part for f in p.fields} & set(parts)]
    return sorted(set(found))


def test_missing_pages_of_a_paper_are_told(read, scanned):
    count = len(scanned.pages(ADA))
    assert count > 1
    assert read(1).missing == [f"{ADA}: page {', '.join(map(str, range(2, count + 1)))} of {count}"]
    (row,) = rows(read.out / "missing.csv")
    assert (row["student"], row["scanned"], row["pages"]) == (ADA, "1", str(count))
    assert not read(*range(2, count + 1)).missing


def test_coordinates_are_written_as_their_kind_reads_them(read, scanned):
    read(*pages_of(scanned, "a", "b"), a=["12.5 mm", "30"], b=["-4", "7"])
    known = answered(read.out, ADA)
    assert known["b"] == "(-4 ; 7)"
    marking = scanned.variant(ADA).grade({"a": known["a"], "b": known["b"]})
    assert marking["a"].read_as == "(12.5; 30) mm"
    assert marking["b"].read_as.startswith("(-4; 7)")


def test_one_coordinate_waits_and_the_answer_with_it(read, scanned):
    read(*pages_of(scanned, "a"), a=["12.5", "~30"])
    (card,) = (c for c in queued(read.out) if c["part"] == "a")
    assert (card["coordinate"], card["coordinates"], card["candidate"]) == (2, 2, "30")
    assert "a" not in answered(read.out, ADA)


def test_points_are_clicked_on_the_drawing_in_millimetres(read, scanned, tmp_path):
    drawn = {"": "~"}
    read(*range(1, len(scanned.pages(ADA)) + 1), **drawn)
    points = [c for c in queued(read.out) if c["waits"] == "drawn"]
    assert {c["part"] for c in points} == {"p", "a", "b"}
    size = points[0]["drawing"]
    with chromium() as browser:
        page = browser.new_page(viewport={"width": 1280, "height": 900})
        page.goto((read.out / "queue" / "index.html").as_uri())
        page.locator(".card button", has_text="Click points").first.click()
        image = page.locator("#click-image")
        frame = image.bounding_box()
        names = list(dict.fromkeys(c["part"] for c in points))
        for k in range(len(names)):
            at = {"x": frame["width"] * (k + 1) / 4, "y": frame["height"] * (1 - 0.25)}
            image.click(position=at)
        page.locator("#clicking button.main").click()
        with page.expect_download() as got:
            page.locator("#save-typed").click()
        got.value.save_as(read.out / "typed.csv")
    assert scan(scanned.course, [], scanned.issued, read.out).waiting == 0
    known = answered(read.out, ADA)
    for k, name in enumerate(names):
        x, y = (float(v) for v in known[name].strip("()").split(" ; "))
        assert x == pytest.approx(size["width"] * (k + 1) / 4, abs=0.6)
        assert y == pytest.approx(size["height"] * 0.25, abs=0.6)
    assert json.loads((read.out / "queue" / "queue.json").read_text("utf-8"))["cards"] == []
