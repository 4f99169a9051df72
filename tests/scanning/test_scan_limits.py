"""Scans that are made to cost, to pass for another's, or to count twice."""

import json

import cv2
import numpy as np
import pytest
from scanned_pages import KINDS, Scan, scanned, sheet_of_pdf
from sweeps import slow
from tables import each_row

from coursework import cli
from coursework.api import open_course
from coursework.issuing.answer_papers import answer_papers
from coursework.issuing.students import file_stems
from coursework.scanning import names, pictures
from coursework.scanning.pictures import BadPicture, page_count, picture_at
from coursework.scanning.scan_store import LOST, OTHER_NAME, stored_page
from coursework.system.limits import MOST_PAGES
from coursework.system.processes import ResourceLimits

STUDENTS = ("Zoé", "Max", "Martin Paul", "Élodie Lefèvre-Dupont", "Nguyễn Thị Minh Khai", "Li Wei")
EXERCISE = "grashof"


def pdf(pages, size=(b"595", b"842"), content=b""):
    """A PDF that says one page so many times; ``size`` in points."""
    told = [
        b"<< /Type /Catalog /Pages 2 0 R >>",
        b"<< /Type /Pages /Count %d /Kids [%s] >>" % (pages, b" ".join([b"3 0 R"] * pages)),
        b"<< /Type /Page /Parent 2 0 R /MediaBox [0 0 %s %s] /Contents 4 0 R >>" % size,
        b"<< /Length %d >>\nstream\n%s\nendstream" % (len(content), content),
    ]
    out, places = b"%PDF-1.4\n", []
    for number, one in enumerate(told, 1):
        places.append(len(out))
        out += b"%d 0 obj\n%s\nendobj\n" % (number, one)
    table = b"".join(b"%010d 00000 n \n" % place for place in places)
    return (
        out
        + b"xref\n0 5\n0000000000 65535 f \n"
        + table
        + (b"trailer << /Size 5 /Root 1 0 R >>\nstartxref\n%d\n%%%%EOF" % len(out))
    )


@pytest.mark.parametrize("pages", [21, 2000, 20_000])
def test_a_file_that_says_one_page_over_and_over_is_refused_by_name(pages, tmp_path):
    """60 kB of 20 000 pages took more than 100 s."""
    path = tmp_path / "many.pdf"
    path.write_bytes(pdf(pages))
    with pytest.raises(BadPicture, match=r"many\.pdf"):
        page_count(path)


def test_more_pages_than_any_scan_are_refused_whatever_the_size(tmp_path):
    path = tmp_path / "large.pdf"
    path.write_bytes(pdf(MOST_PAGES + 1) + b"\n%" + b" " * 600 * MOST_PAGES)
    with pytest.raises(BadPicture, match=r"large\.pdf"):
        page_count(path)


@pytest.mark.parametrize(
    "size", [(b"10000000", b"10000000"), (b"595", b"10000000"), (b"1", b"1"), (b"20000", b"842")]
)
def test_a_page_of_no_paper_is_refused_by_name_and_not_taken_for_a_blank_one(size, tmp_path):
    path = tmp_path / "wide.pdf"
    path.write_bytes(pdf(1, size))
    with pytest.raises(BadPicture, match=r"wide\.pdf is .* inches"):
        picture_at(path, 1)


@pytest.mark.e2e
def test_a_page_that_takes_for_ever_to_be_drawn_is_ended(tmp_path, monkeypatch):
    """What is not a picture of a scanner is drawn in a process of its own, which is ended."""
    path = tmp_path / "lines.pdf"
    lines = b" ".join(b"0 0 m %d 842 l 595 %d l S" % (k % 595, k % 842) for k in range(200))
    path.write_bytes(pdf(1, content=lines))
    assert (picture_at(path, 1).grey < 128).any()
    monkeypatch.setattr(pictures, "_DRAWING", ResourceLimits(0.0, 10**9))
    path.write_bytes(pdf(1, content=lines * 50))
    with pytest.raises(BadPicture, match=r"lines\.pdf takes too much time"):
        picture_at(path, 1)


# ------------------------------------------------------------------------------ names


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """A class's sheets as they are printed, by student; the folder of the build."""
    folder = tmp_path_factory.mktemp("names")
    (folder / "class.csv").write_text("student\n" + "\n".join(STUDENTS) + "\n", "utf-8")
    told = [
        "--roster",
        str(folder / "class.csv"),
        *"--with scan --formats pdf --lang fr --out".split(),
        str(folder / "out"),
    ]
    assert cli.run(["build", EXERCISE, *told]) == 0
    handouts = folder / "out" / "handouts" / EXERCISE
    return folder, {
        name: sheet_of_pdf((handouts / f"{file_stems([name])[0]}.fr.pdf").read_bytes(), -1)
        for name in STUDENTS
    }


@pytest.fixture(scope="module")
def places(built):
    """The last answer page of each student."""
    papers = answer_papers(json.loads((built[0] / "out" / "issued.json").read_text("utf-8"))).values()
    course = open_course()
    return {p.student: p.pages(course, "fr")[-1] for p in papers if p.size == "a4"}


def pasted(sheets, places, of, onto):
    """The sheet of a student with the code of another's pasted on it."""
    sheet, at = sheets[onto].copy(), places[onto].code
    x0, y0, x1, y1 = (
        round(v * 300 / 25.4) for v in (at.x - 1, at.y - 1, at.x + at.width + 1, at.y + at.height + 1)
    )
    sheet[y0:y1, x0:x1] = sheets[of][y0:y1, x0:x1]
    return sheet


def read(folder, sheets, out):
    """Scan pictures by their names; gives what is kept of each."""
    place = folder / "scans"
    place.mkdir()
    for name, picture in sheets.items():
        cv2.imwrite(str(place / name), picture)
    return cli.run(["scan", str(place), "--issued", str(out / "issued.json"), "--out", str(folder / "read")])


def kept(folder):
    return [
        stored_page(folder / "read", path.stem)
        for path in sorted((folder / "read" / ".scanned").glob("*-0001.json"))
    ]


@pytest.mark.e2e
def test_anothers_page_with_a_pasted_code_waits_for_a_person(built, places, tmp_path):
    out, sheets = built[0] / "out", built[1]
    rng = np.random.default_rng(3)
    picture = scanned(pasted(sheets, places, "Zoé", "Max"), Scan(dpi=200, skew=1.0, noise=2.5), rng)
    assert read(tmp_path, {"a.png": picture}, out) == 1
    (page,) = kept(tmp_path)
    assert (page.what, page.reason, page.fields) == (LOST, OTHER_NAME, ())
    cards = json.loads((tmp_path / "read" / "queue" / "queue.json").read_text("utf-8"))["cards"]
    assert [card["waits"] for card in cards] == [OTHER_NAME]


@pytest.mark.parametrize("step", [6, pytest.param(1, marks=slow)], ids=["few", "all"])
@each_row("kind", ["office scanner", "150 dpi", "black and white", "photograph", "light copy", "coffee"])
@pytest.mark.e2e
def test_an_honest_page_is_never_taken_for_anothers(kind, step, built, places):
    """However it is scanned; and whose it is, where the scan is clean."""
    from coursework.scanning.codes import codes_in
    from coursework.scanning.pictures import without_streaks
    from coursework.scanning.straightening import straightened

    rng = np.random.default_rng([5, *kind.encode()])
    alarms, seen = [], []
    pairs = list(zip(STUDENTS, STUDENTS[1:] + STUDENTS[:1], strict=True))[len(kind) % step :: step]
    for owner, other in pairs:
        picture = scanned(built[1][owner], KINDS[kind](rng), rng)
        (code,) = codes_in(picture)
        flat = straightened(without_streaks(picture), code, places[owner])
        told = [
            names.other_name(flat.paper, places[owner].name, one, STUDENTS, "fr") for one in (owner, other)
        ]
        alarms += [owner] if told[0] else []
        seen.append(told[1])
    assert alarms == []
    assert set(seen) <= {*STUDENTS, ""}
    if kind == "office scanner":
        assert seen == [owner for owner, _ in pairs]


# ----------------------------------------------------------------------------- copies


@pytest.mark.parametrize("turn", [1, 2, *(pytest.param(turn, marks=slow) for turn in (0, 3))])
@pytest.mark.e2e
def test_a_copy_is_known_however_it_is_turned(turn, built, tmp_path):
    rng = np.random.default_rng(4)
    picture = scanned(built[1]["Zoé"], Scan(dpi=200, skew=0.7, noise=2.5), rng)
    turned = np.ascontiguousarray(np.rot90(picture, turn))
    read(tmp_path, {"a.png": picture, "b.png": turned}, built[0] / "out")
    told = (tmp_path / "read" / "pages.csv").read_text("utf-8-sig").splitlines()
    assert [line.split(",")[2] for line in told[1:]] == ["answers", "copy"]


@pytest.mark.e2e
def test_a_page_on_which_something_was_added_is_no_copy(built, places, tmp_path):
    rng = np.random.default_rng(4)
    sheet = built[1]["Zoé"].copy()
    before = scanned(sheet, Scan(dpi=200, noise=2.5), rng)
    box = next(box for field in places["Zoé"].fields for box in (*field.digits, *(b for _, b in field.ticks)))
    at = [round(v * 300 / 25.4) for v in (box.x + 1.5, box.y + 1.5, box.x + 3.5, box.y + 3.5)]
    cv2.line(sheet, (at[0], at[1]), (at[2], at[3]), 60, 5)
    after = scanned(sheet, Scan(dpi=200, noise=2.5), rng)
    read(tmp_path, {"a.png": before, "b.png": np.ascontiguousarray(np.rot90(after, 2))}, built[0] / "out")
    told = (tmp_path / "read" / "pages.csv").read_text("utf-8-sig").splitlines()
    assert [line.split(",")[2] for line in told[1:]] == ["answers", "answers"]
