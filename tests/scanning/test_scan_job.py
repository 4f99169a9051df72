"""The job of reading scans: every page is somewhere, whatever the order of files and however often it is
run."""

from __future__ import annotations

import csv
import io
import struct
import zipfile
import zlib

import numpy as np
import pytest
from scanned_class import ScannedClass, answered, as_pdf, as_picture, bytes_of, queued, rows, save

from coursework.cli import run
from coursework.errors import BadInput
from coursework.scanning import page_reading
from coursework.scanning import scan as scanning
from coursework.scanning.scan import scan

pytestmark = pytest.mark.e2e

ZOE, MAX, EVIL = "Zoé Öztürk", "Max <b>", "=cmd()|x"
SURE = {"rA": "319.8", "theta4": "104", "guide": "b"}
DOUBTFUL = {**SURE, "theta4": "~104"}


@pytest.fixture(scope="module")
def scanned(tmp_path_factory):
    return ScannedClass(tmp_path_factory.mktemp("class"), (ZOE, MAX, EVIL), "slotted_mechanism")


@pytest.fixture(scope="module")
def scans(scanned):
    """Three papers, of which one has a scrawl; and a blank page."""
    folder = scanned.folder / "scans"
    save(folder / "one.png", scanned.told(ZOE, 1, SURE))
    blank = np.full((80, 64), 250, np.uint8)
    save(folder / "more.tif", scanned.told(MAX, 1, DOUBTFUL), blank, scanned.told(EVIL, 1, SURE))
    return folder


@pytest.fixture
def read(pages_are_told, scanned, scans, tmp_path):
    """Read what is named, or the scans of the class."""

    def job(*sources, out=tmp_path / "read", **more):
        return scan(scanned.course, sources or [scans], scanned.issued, out, **more)

    job.out = tmp_path / "read"
    return job


def test_what_was_written_is_read_or_waits(read):
    book = read()
    assert answered(read.out, ZOE)["rA"] == "319.8"
    assert answered(read.out, EVIL)["guide"] == "b"
    assert "theta4" not in answered(read.out, MAX)
    (card,) = queued(read.out)
    (waiting,) = [r["answer"] for r in rows(read.out / "answers.csv") if ".png" in r["answer"]]
    assert f"../{waiting}" == card["crops"][0], "what waits is given to the marking as its picture"
    assert (card["student"], card["part"], card["waits"]) == (MAX, "theta4", "free")
    assert (read.out / "queue" / card["crops"][0]).is_file()
    assert (book.pages, book.waiting, book.blank) == (4, 1, 1)
    assert book.needs_a_look


def test_a_page_that_is_dark_all_over_is_not_taken_for_a_blank_one(read, tmp_path):
    save(tmp_path / "dark.png", np.full((400, 300), 8, np.uint8))
    book = read(tmp_path / "dark.png")
    assert (book.blank, book.waiting) == (0, 1)
    assert rows(read.out / "pages.csv")[0]["what"] == "lost"


def test_a_picture_on_which_reading_fails_stops_no_pile_and_waits_with_its_picture(read, scans, monkeypatch):
    import cv2

    from coursework.scanning import pages

    told = pages.read_page

    def failing(picture, *more):
        if picture.file == "one.png":
            cv2.resize(picture.grey, (0, 0))
        return told(picture, *more)

    monkeypatch.setattr(pages, "read_page", failing)
    book = read()
    assert [one["what"] for one in rows(read.out / "pages.csv")] == ["answers", "blank", "answers", "lost"]
    assert book.pages == 4
    assert next(c for c in queued(read.out) if c["waits"] == "code")["crops"]


def test_every_page_is_in_the_list_and_every_field_in_answers_or_the_queue(read, scanned):
    read()
    listed = rows(read.out / "pages.csv")
    assert [(row["file"], row["page"], row["what"]) for row in listed] == [
        ("more.tif", "1", "answers"),
        ("more.tif", "2", "blank"),
        ("more.tif", "3", "answers"),
        ("one.png", "1", "answers"),
    ]
    for row in listed:
        assert (read.out / row["picture"]).is_file()
    places = [tuple(card["place"][:4]) for card in queued(read.out)]
    known = [r for r in rows(read.out / "answers.csv") if ".png" not in r["answer"]]
    places += [(r["student"], r["exercise"], r["seed"], r["part"]) for r in known]
    asked = [
        (student, f.exercise, str(f.seed), f.part)
        for student in scanned.names
        for page in scanned.pages(student)
        for f in page.fields
    ]
    assert sorted(places) == sorted(asked)


def test_the_order_of_files_and_how_they_come_make_no_difference(read, scans, tmp_path):
    read(scans / "one.png", scans / "more.tif", out=tmp_path / "a")
    read(scans / "more.tif", scans / "one.png", out=tmp_path / "b")
    read(scans / "more.tif", out=tmp_path / "c")
    read(scans / "one.png", out=tmp_path / "c")
    assert bytes_of(tmp_path / "a") == bytes_of(tmp_path / "b") == bytes_of(tmp_path / "c")


def test_several_processes_write_the_same(scanned, scans, tmp_path, monkeypatch):
    """They read pictures by themselves: of these, that they have no code."""
    scan(scanned.course, [scans], scanned.issued, tmp_path / "one")
    monkeypatch.setattr(scanning, "_WORTH_PROCESSES", 1)
    monkeypatch.setattr(scanning, "_CHUNK", 1)
    used = []
    monkeypatch.setattr(scanning, "workers", lambda tasks: used.append(tasks) or 2)
    scan(scanned.course, [scans], scanned.issued, tmp_path / "shared")
    assert used
    assert bytes_of(tmp_path / "shared") == bytes_of(tmp_path / "one")


def test_a_job_that_was_stopped_goes_on(read, tmp_path, monkeypatch):
    read()
    page, left = page_reading._read, [2]

    def stopped(*told):
        if not left[0]:
            raise KeyboardInterrupt
        left[0] -= 1
        return page(*told)

    monkeypatch.setattr(page_reading, "_read", stopped)
    with pytest.raises(KeyboardInterrupt):
        read(out=tmp_path / "stopped")
    assert not (tmp_path / "stopped" / "answers.csv").exists()
    left[0] = 2  # as many as are left
    assert read(out=tmp_path / "stopped").pages == 4
    assert bytes_of(tmp_path / "stopped") == bytes_of(read.out)


def test_run_again_it_reads_nothing_twice(read):
    before = read()
    stood = bytes_of(read.out)
    assert before.read_now == 4
    assert read().read_now == 0
    assert bytes_of(read.out) == stood


# ------------------------------------------------------------------- what was typed


def type_in(path, **changes):
    """A line of what was typed."""
    told = {"student": MAX, "exercise": "slotted_mechanism", "part": "theta4", "answer": "104.6°", **changes}
    path.write_text(",".join(told) + "\n" + ",".join(f'"{v}"' for v in told.values()) + "\n", "utf-8")
    return path


def test_what_was_typed_counts_is_kept_and_ends_the_waiting(read, scanned, tmp_path):
    read()
    typed = type_in(tmp_path / "typed.csv", seed=queued(read.out)[0]["place"][2])
    assert read(typed=[typed]).waiting == 0
    assert answered(read.out, MAX)["theta4"] == "104.6°"
    assert scan(scanned.course, [], scanned.issued, read.out).waiting == 0, "it stands in the folder"


def test_a_typed_csv_that_is_put_into_the_folder_is_read(read, scanned):
    read()
    (card,) = queued(read.out)
    type_in(read.out / "typed.csv", seed=card["place"][2], seen=card["seen"], answer="")
    assert scan(scanned.course, [], scanned.issued, read.out).waiting == 0
    assert answered(read.out, MAX)["theta4"] == ""


def test_what_was_typed_and_fits_nothing_is_kept_and_told(read, tmp_path):
    book = read(typed=[type_in(tmp_path / "typed.csv", student="Nobody", seed="1")])
    assert (book.waiting, book.unused) == (1, 1)
    assert [row["student"] for row in rows(read.out / "typed.csv")] == ["Nobody"]


# ---------------------------------------------------------------------- scanned twice


def test_a_page_scanned_twice_counts_once_where_it_says_the_same(read, scanned, scans, tmp_path):
    alone = read(scans / "one.png", out=tmp_path / "alone")
    save(tmp_path / "again.png", scanned.told(ZOE, 1, SURE, seed=2))
    book = read(scans / "one.png", tmp_path / "again.png")
    assert (book.pages, book.answers, book.waiting) == (2, alone.answers, 0)
    (source,) = {row["source"] for row in rows(read.out / "answers.csv")}
    assert sorted(source.split("; ")) == ["again.png p. 1", "one.png p. 1"]


def test_a_page_scanned_twice_waits_where_it_says_another_thing(read, scanned, scans, tmp_path):
    save(tmp_path / "other.png", scanned.told(ZOE, 1, {**SURE, "rA": "219.8"}))
    assert read(scans / "one.png", tmp_path / "other.png").waiting == 1
    (card,) = queued(read.out)
    assert (card["part"], card["waits"], len(card["crops"])) == ("rA", "differs", 2)
    assert all((read.out / "queue" / crop).is_file() for crop in card["crops"])
    assert "rA" not in answered(read.out, ZOE)


def test_what_was_typed_waits_again_where_a_later_scan_says_another_thing(read, scanned, tmp_path):
    read()
    (card,) = queued(read.out)
    typed = type_in(tmp_path / "typed.csv", seed=card["place"][2], seen=card["seen"], answer="104")
    assert read(typed=[typed]).waiting == 0
    save(tmp_path / "same.png", scanned.told(MAX, 1, SURE))
    assert read(tmp_path / "same.png").waiting == 0, "it says what was typed"
    save(tmp_path / "other.png", scanned.told(MAX, 1, {**SURE, "theta4": "105"}))
    assert read(tmp_path / "other.png").waiting == 1
    (card,) = queued(read.out)
    assert (card["waits"], card["candidate"]) == ("differs", "104")


def test_the_same_file_twice_is_a_copy(read, scans, tmp_path):
    (tmp_path / "two.png").write_bytes((scans / "one.png").read_bytes())
    alone = read(scans / "one.png", out=tmp_path / "alone")
    book = read(scans / "one.png", tmp_path / "two.png")
    assert (book.pages, book.copies, book.answers) == (2, 1, alone.answers)
    assert [row["what"] for row in rows(read.out / "pages.csv")] == ["answers", "copy"]


# ---------------------------------------------------------------- what is no page


@pytest.fixture
def odd_files(tmp_path, scans):
    """A file of each sort of which no page can be read."""
    folder = tmp_path / "odd"
    folder.mkdir()
    (folder / "empty.pdf").write_bytes(b"")
    (folder / "damaged.pdf").write_bytes(as_pdf([np.zeros((90, 60), np.uint8)])[:400])
    (folder / "damaged.png").write_bytes(b"\x89PNG\r\n\x1a\n" + b"x" * 300)
    (folder / "huge.png").write_bytes(_png_header(60_000, 60_000))
    (folder / "locked.pdf").write_bytes(LOCKED)
    (folder / "notes.docx").write_bytes(b"PK\x03\x04")
    (folder / "bad.zip").write_bytes(b"PK\x03\x04" + b"\0" * 30)
    with zipfile.ZipFile(folder / "up.zip", "w") as archive:
        archive.writestr("../../escape.png", b"x")
    return folder


def _png_header(wide: int, high: int) -> bytes:
    """The beginning of a picture that says that it is so large."""
    head = b"IHDR" + struct.pack(">IIBBBBB", wide, high, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + head + struct.pack(">I", zlib.crc32(head))


#: A PDF that asks for a password: the keys of its handler fit none.
LOCKED = (
    b"%PDF-1.4\n1 0 obj<</Type/Catalog/Pages 2 0 R>>endobj\n2 0 obj<</Type/Pages/Kids[]/Count 0>>endobj\n"
    b"3 0 obj<</Filter/Standard/V 1/R 2/O<" + b"41" * 32 + b">/U<" + b"42" * 32 + b">/P -4>>endobj\n"
    b"xref\n0 4\n0000000000 65535 f \n0000000009 00000 n \n0000000054 00000 n \n0000000100 00000 n \n"
    b"trailer<</Size 4/Root 1 0 R/Encrypt 3 0 R/ID[<00><00>]>>\nstartxref\n292\n%%EOF\n"
)


def test_files_that_cannot_be_read_are_a_line_each_and_cost_no_other(read, scans, odd_files):
    book = read(scans, odd_files)
    told = {row["file"]: row["reason"] for row in rows(read.out / "rejected.csv")}
    assert set(told) == {p.name for p in odd_files.iterdir()}
    assert all(reason and "\n" not in reason for reason in told.values())
    assert "empty" in told["empty.pdf"]
    assert "assword" in told["locked.pdf"]
    assert book.pages == 4
    listed = rows(read.out / "pages.csv")
    assert sum(row["what"] == "refused" for row in listed) == len(told)
    assert len(listed) == 4 + len(told)


def test_the_command_says_so_in_lines_and_by_its_status(
    pages_are_told, scanned, scans, odd_files, tmp_path, capsys
):
    told = [
        "scan",
        str(scans),
        str(odd_files),
        "--issued",
        str(scanned.issued),
        "--out",
        str(tmp_path / "cli"),
    ]
    assert run(told) == 1
    shown = capsys.readouterr()
    assert "1 place waits for a person" in shown.out
    assert len(shown.err.splitlines()) == 8
    assert run(["scan", "no such.pdf", "--issued", str(scanned.issued)]) == 2
    assert run(["scan", str(scans), "--issued", str(odd_files / "empty.pdf")]) == 2
    assert "Traceback" not in capsys.readouterr().err


def test_an_archive_is_as_its_files(read, scans, tmp_path):
    with zipfile.ZipFile(tmp_path / "all.zip", "w") as archive:
        for path in sorted(scans.iterdir()):
            archive.write(path, path.name)
    book = read(tmp_path / "all.zip")
    assert (book.pages, book.waiting) == (4, 1)
    assert rows(read.out / "pages.csv")[0]["file"] == "all.zip/more.tif"


def test_nothing_named_and_nothing_kept_is_said(scanned, tmp_path):
    with pytest.raises(BadInput, match="name the scans"):
        scan(scanned.course, [], scanned.issued, tmp_path / "none")


def test_a_sheet_of_something_else_is_rejected_with_its_picture(read, scans, tmp_path_factory):
    other = ScannedClass(tmp_path_factory.mktemp("other"), ("Ada",), "slotted_mechanism")
    save(other.folder / "ada.png", other.told("Ada", 1, SURE))
    read(scans / "one.png", other.folder / "ada.png")
    (row,) = rows(read.out / "rejected.csv")
    assert row["file"] == "ada.png"
    assert (read.out / row["picture"]).is_file()


# ------------------------------------------------------------- of nobody, or missing


def test_a_page_without_a_readable_code_waits_until_somebody_says_what_it_is(read, scanned, tmp_path):
    save(tmp_path / "coffee.png", as_picture(b"\xff" * 2000 + b"coffee" * 30))
    assert read(tmp_path / "coffee.png").waiting == 1
    (card,) = queued(read.out)
    assert card["waits"] == "code"
    (listed,) = rows(read.out / "pages.csv")
    assert (listed["what"], listed["waiting"]) == ("lost", "1")
    which = {"student": "", "exercise": "(page)", "seed": "", "part": card["place"][3]}
    told = type_in(tmp_path / "t.csv", **which, answer=f"{scanned.papers[ZOE].code} 1")
    assert read(tmp_path / "coffee.png", typed=[told]).waiting == len(scanned.pages(ZOE)[0].fields)
    assert {one["student"] for one in queued(read.out)} == {ZOE}
    type_in(tmp_path / "t.csv", **which, answer="")
    assert read(tmp_path / "coffee.png", typed=[tmp_path / "t.csv"]).waiting == 0
    assert "by hand" in rows(read.out / "rejected.csv")[0]["reason"]


def test_who_was_not_scanned_is_told(read, scans):
    assert read(scans / "one.png").absent == 2
    assert {row["student"] for row in rows(read.out / "missing.csv")} == {MAX, EVIL}
    assert {row["missing"] for row in rows(read.out / "missing.csv")} == {"all"}


# --------------------------------------------------------------------- hostile texts


def test_no_name_becomes_a_formula_or_markup(read, tmp_path, scans):
    hostile = tmp_path / "=HYPERLINK(1)|<img src=x>.png"
    hostile.write_bytes((scans / "one.png").read_bytes())
    read(scans, hostile)
    for file in ("answers.csv", "pages.csv", "rejected.csv", "missing.csv"):
        for line in csv.reader(io.StringIO((read.out / file).read_text("utf-8-sig"), newline="")):
            assert not [cell for cell in line if cell.startswith(("=", "@")) and "(" in cell]
    page = (read.out / "queue" / "index.html").read_text("utf-8")
    assert MAX not in page
    assert "<img src=x>" not in page
