"""Whatever a file holds, its reader gives a value or refuses it by name, in little time and memory; rows in
are rows out.

The cases are the same at each run: few of each reader here, thousands among the slow tests. What the fuzz
found stays as a case of its own.
"""

from __future__ import annotations

import csv
import io
import json
import random
import shutil
import struct
import zipfile
import zlib

import pytest
from fuzzing import COMMON, PYTHON, READERS, TABLE, damaged, parquet, within

from coursework.errors import BadInput, CourseworkError
from coursework.gradebook.rows import AnswerRow, Rejected
from coursework.gradebook.submissions import read_file

every_reader = pytest.mark.parametrize("name", READERS)


def samples_of(name):
    if name == "answers, Parquet":
        pytest.importorskip("pyarrow")
        return (parquet(),)
    return READERS[name].samples


def tried(folder, name, data):
    """Whether a file of some bytes is read; a refusal names it."""
    reader, own = READERS[name], folder / "own"
    shutil.rmtree(own, ignore_errors=True)
    own.mkdir()
    path = own / f"{reader.name}{reader.ending}"
    path.write_bytes(data)
    try:
        with within():
            reader.read(path)
    except CourseworkError as why:
        if path.name not in str(why) and "files.json" not in str(why):
            pytest.fail(f"{why} names no file")
        return False
    return True


@every_reader
def test_what_is_not_damaged_is_read(tmp_path, name):
    for data in samples_of(name):
        assert tried(tmp_path, name, data)


def fuzzed(folder, name, cases):
    samples = samples_of(name)
    for case in cases:
        generator = random.Random(f"{name} {case}")
        data = damaged(generator, generator.choice(samples), READERS[name])
        try:
            tried(folder, name, data)
        except BaseException as fault:
            fault.add_note(f"{name}, case {case}: {data[:300]!r}")
            raise


@every_reader
def test_damage_is_read_or_refused_by_name(tmp_path, name):
    fuzzed(tmp_path, name, range(30))


@pytest.mark.slow
@every_reader
def test_much_damage_is_read_or_refused_by_name(tmp_path, name):
    fuzzed(tmp_path, name, range(30, 3000))


# ------------------------------------------------------------ rows in, rows out

COLUMNS = ("student", "exercise", "seed", "part", "answer")
CELLS = [
    cell
    for cell in (*COMMON, *TABLE, "12,5", "a;b", "1\t2", " x ", "")
    if not set(cell) & set("\0\ud800\r\n\x85\u2028")
]


def tables(count):
    """Tables of any cells of one line, well written; with the number of their rows."""
    for seed in range(count):
        generator = random.Random(f"table {seed}")
        rows = [[generator.choice(CELLS) for _ in COLUMNS] for _ in range(generator.randrange(1, 30))]
        rows = [row for row in rows if any(cell.strip() for cell in row)]
        made = io.StringIO()
        quoting = generator.choice((csv.QUOTE_MINIMAL, csv.QUOTE_ALL))
        writer = csv.writer(
            made,
            delimiter=generator.choice(",;\t"),
            quoting=quoting,
            lineterminator=generator.choice(("\n", "\r\n")),
        )
        writer.writerows([COLUMNS, *rows])
        yield made.getvalue().encode("utf-8"), rows


@pytest.mark.parametrize("count", [30, pytest.param(1000, marks=pytest.mark.slow)])
def test_every_row_of_a_table_comes_out_as_it_was_written(tmp_path, count):
    for data, rows in tables(count):
        (tmp_path / "a.csv").write_bytes(data)
        found = list(read_file(tmp_path / "a.csv"))
        assert [type(row) for row in found] == [AnswerRow] * len(rows)
        assert [row.part for row in found] == [row[3].strip() for row in rows]
        for row, (*_, answer) in zip(found, rows, strict=True):
            assert row.answer == answer or (answer.startswith("'") and row.answer == answer[1:])


@pytest.mark.parametrize("count", [40, pytest.param(2000, marks=pytest.mark.slow)])
def test_every_answer_of_a_sheet_comes_out(tmp_path, count):
    for seed in range(count):
        generator = random.Random(f"sheet {seed}")
        pairs = [
            (
                f"p{k}" if generator.random() < 0.9 else "p0",
                generator.choice((*COMMON, *PYTHON, 1, None, [1, "x"], {}, 1e300)),
            )
            for k in range(9)
        ]
        body = ", ".join(f"{json.dumps(key)}: {json.dumps(value)}" for key, value in pairs)
        (tmp_path / "a.json").write_text(
            f'{{"student": "Ana", "exercise": "coil", "seed": 1, "answers": {{{body}}}}}'
        )
        found = list(read_file(tmp_path / "a.json"))
        assert sorted(row.part if isinstance(row, AnswerRow) else row.row["part"] for row in found) == sorted(
            key for key, _ in pairs
        )


# ------------------------------------------------------------- what it has found


def read_all(path, data):
    path.write_bytes(data)
    return list(read_file(path))


@pytest.mark.parametrize(
    "header",
    [
        b"student,exercise,seed,part,answer",
        b"student;exercise;seed;part;answer\r\n\r\n",
        b"\n\nstudent,exercise,seed,part,answer\n,,,,\n",
    ],
)
def test_a_table_of_answers_without_any_is_told(tmp_path, header):
    (row,) = read_all(tmp_path / "a.csv", header)
    assert row == Rejected(str(tmp_path / "a.csv"), "the file contains no answers")


def test_a_parquet_without_rows_or_with_damaged_names_is_told(tmp_path):
    pytest.importorskip("pyarrow")
    data = parquet()
    for damage in (data.replace(b"answer", b"answeR"), data.replace(b"answer", b"answeR", 1)):
        (row,) = read_all(tmp_path / "a.parquet", damage)
        assert isinstance(row, Rejected)


@pytest.mark.parametrize("odd", ["x\0y", "\ud800", "\udfff" * 300])
@pytest.mark.parametrize("code", ["{odd}answers = {{", "answers = {{'a': {odd}", "{odd}"])
def test_what_is_quoted_of_a_cell_is_what_a_table_can_hold(tmp_path, odd, code):
    cell = {"cell_type": "code", "metadata": {"tags": ["answers"]}, "source": code.format(odd=odd)}
    for about in (
        {"exercise": "coil", "seed": 1},
        {"sheets": [{"exercise": "coil", "seed": 1}, {"exercise": "x", "seed": 2}]},
    ):
        for tags in (["answers"], []):
            cell["metadata"]["tags"] = tags
            notebook = {
                "cells": [cell],
                "metadata": {"coursework": about},
                "nbformat": 4,
                "nbformat_minor": 5,
            }
            for row in read_all(tmp_path / "a.ipynb", json.dumps(notebook).encode()):
                if isinstance(row, Rejected):
                    assert "\0" not in row.row["answer"]
                    assert row.row["answer"].encode("utf-8") is not None


def test_an_attempt_of_many_digits_is_none(tmp_path):
    sample = READERS["answers, Canvas"].samples[0].decode("utf-8-sig")
    rows = list(csv.reader(io.StringIO(sample)))
    rows[1][rows[0].index("attempt")] = "9" * 5000
    made = io.StringIO()
    csv.writer(made).writerows(rows)
    found = [
        row for row in read_all(tmp_path / "a.csv", made.getvalue().encode()) if isinstance(row, AnswerRow)
    ]
    assert found
    assert found[0].origin.sitting == 0


@pytest.mark.parametrize(
    "field",
    [
        '"least": 1e999',
        '"number": "1"',
        '"is_straight": 1',
        '"code": []',
        '"reason": "\\ud800"',
        '"least": ' + "[" * 5000,
        '"number": true',
        '"fields": [{}]',
    ],
)
def test_a_page_that_is_kept_otherwise_is_read_anew(tmp_path, field):
    from coursework.scanning.scan_store import stored_page

    whole = json.loads(READERS["page of a scan"].samples[0])
    whole.pop(json.loads(f"[{field.partition(':')[0]}]")[0])
    (tmp_path / ".scanned").mkdir()
    (tmp_path / ".scanned" / "p.json").write_text(f"{json.dumps(whole)[:-1]}, {field}}}")
    assert stored_page(tmp_path, "p") is None


@pytest.mark.parametrize(
    "field", ['"digest": ["x"]', '"pages": "2"', '"name": 7', '"pages": ' + "[" * 5000, '"fault": null']
)
def test_a_list_of_scanned_files_that_is_none_is_told_by_its_name(tmp_path, field):
    whole = json.loads(READERS["files of a scan"].samples[0])
    whole[0].pop(json.loads(f"[{field.partition(':')[0]}]")[0])
    assert not tried(tmp_path, "files of a scan", f"[{json.dumps(whole[0])[:-1]}, {field}}}]".encode())


@pytest.mark.parametrize("end", ["\u2028", "\x85", "\x0b", "\x0c", "\x1c"])
def test_what_was_typed_is_kept_whole(tmp_path, end):
    from coursework.scanning.typed import Typed, read_typed, typed_file

    typed = [
        Typed("Ana", "coil", "3", "Z", "1", f"3{end}4", "x"),
        Typed("Ben", "coil", "3", "Z", "1", "5", ""),
    ]
    (tmp_path / "typed.csv").write_bytes(typed_file(typed))
    assert read_typed(tmp_path / "typed.csv") == typed


def test_an_archive_with_a_file_without_a_name_is_told(tmp_path):
    from coursework.system.unzipping import unpack

    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as archive:
        archive.writestr("a", b"x")
    data = bytearray(made.getvalue())
    place = data.index(b"PK\x01\x02")
    data[place + 28 : place + 30] = b"\0\0"  # the length of its name
    data[place + 30 : place + 32] = b"\1\0"
    (tmp_path / "a.zip").write_bytes(data)
    with pytest.raises(BadInput, match=r"a\.zip"):
        unpack(tmp_path / "a.zip", tmp_path / "out")


# ------------------------------------------------------------- beyond all measure


def test_a_roster_beyond_its_size_or_its_columns_is_told(tmp_path, monkeypatch):
    from coursework.issuing.roster import read_roster

    path = tmp_path / "r.csv"
    path.write_text("student" + ",x" * 5000 + "\nAna\n")
    with pytest.raises(BadInput, match=r"r\.csv: a table of 5,001 columns is not read; the limit is 5,000"):
        read_roster(path)
    monkeypatch.setattr("coursework.issuing.roster.MOST_TABLE_BYTES", 10)
    with pytest.raises(BadInput, match=r"r\.csv: a file of [0-9,]+ bytes is not read; the limit is 10"):
        read_roster(path)


@pytest.mark.parametrize(
    ("name", "more"), [("gradebook.decisions.DecisionFiles", [None]), ("scanning.typed.read_typed", [])]
)
def test_what_people_write_is_read_to_a_size(tmp_path, monkeypatch, name, more):
    room, _, reads = f"coursework.{name}".rpartition(".")
    monkeypatch.setattr(f"{room}.MOST_TABLE_BYTES", 10)
    (tmp_path / "a.csv").write_text("student,exercise,seed,part,answer\nA,x,1,rA,2\n")
    with pytest.raises(BadInput, match=r"a\.csv: a file of 45 bytes is not read; the limit is 10"):
        getattr(__import__(room, fromlist=[reads]), reads)(*more, tmp_path / "a.csv")


def notebook(*sources, **about):
    cells = [{"cell_type": "code", "metadata": {"tags": ["answers"]}, "source": source} for source in sources]
    return json.dumps({"cells": cells, "metadata": {"coursework": about}, "nbformat": 4}).encode()


@pytest.mark.parametrize("one", ['"a{}": "1",\n', '"a": "' + "9" * 40 + '{}",\n'])
def test_a_cell_beyond_all_measure_is_never_parsed(tmp_path, monkeypatch, one):
    from coursework.system import python_code

    parsed = []
    parse = python_code.parse
    monkeypatch.setattr(
        python_code, "parse", lambda code, *more: parsed.append(len(code)) or parse(code, *more)
    )
    cell = "answers = {\n" + "".join(one.format(k) for k in range(60_000)) + "}\n"
    for source in (cell, cell + "print(answers)"):
        (row,) = read_all(tmp_path / "a.ipynb", notebook(source, exercise="coil", seed=1))
        assert "too long" in row.reason
    assert not parsed


def test_a_paper_of_many_sheets_is_read_in_steps(tmp_path, monkeypatch):
    """Each cell is looked at a few times, however many there are."""
    from coursework.gradebook import notebooks

    count, looked = 400, []
    sheets = [{"exercise": f"e{k}", "seed": k} for k in range(count)]
    cells = [f'answers = {{  # e{k} {k}\n"a": "{k}",\n}}' for k in range(count)]
    tags = notebooks._tags
    monkeypatch.setattr(notebooks, "_tags", lambda cell: looked.append(1) or tags(cell))

    class Cell(dict):
        def __eq__(self, other):
            raise AssertionError("cells are told apart by their places")

        __hash__ = None

    load = notebooks.load_json

    def loaded(text):
        found = load(text)
        return {**found, "cells": [Cell(cell) for cell in found["cells"]]}

    monkeypatch.setattr(notebooks, "load_json", loaded)
    rows = read_all(tmp_path / "a.ipynb", notebook(*cells, student="Ana", sheets=sheets))
    assert [(row.exercise, row.answer) for row in rows] == [(f"e{k}", str(k)) for k in range(count)]
    assert len(looked) <= 2 * count


def test_a_parquet_of_too_many_rows_is_refused_before_any_is_read(tmp_path, monkeypatch):
    arrow, pq = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    column = arrow.DictionaryArray.from_arrays(
        arrow.array([0] * 2_000_001, arrow.int32()), arrow.array(["1"])
    )
    pq.write_table(arrow.table(dict.fromkeys(COLUMNS, column)), tmp_path / "a.parquet", compression="zstd")
    monkeypatch.setattr(pq.ParquetFile, "iter_batches", lambda *_, **__: pytest.fail("it is read"))
    (row,) = read_file(tmp_path / "a.parquet")
    assert "2,000,001 rows is not read; the limit is 2,000,000" in row.reason


# ------------------------------------------------------------------------- bombs


def bomb(size, count=1):
    """An archive whose files are so many bytes, all of them 0."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        for number in range(count):
            with archive.open(f"{number}.csv", "w") as file:
                for _ in range(size >> 20):
                    file.write(bytes(1 << 20))
    return made.getvalue()


def overlapping(count):
    """An archive of many names for one file, which is there once."""
    data = bomb(2 << 20)
    start, end = data.index(b"PK\x01\x02"), data.index(b"PK\x05\x06")
    entry = data[start:end]
    body, listed = data[:start], entry * count
    return body + listed + struct.pack("<4sHHHHIIH", b"PK\x05\x06", 0, 0, count, count, len(listed), start, 0)


@pytest.mark.parametrize(
    ("made", "told"),
    [
        (lambda: bomb(3 << 20), "unpacks to more"),
        (lambda: bomb(1 << 20, 9), "unpacks to more"),
        (lambda: overlapping(51), "contains 51 files"),
        (lambda: overlapping(40), ""),
    ],
    ids=["one", "several", "names", "overlapping"],
)
def test_an_archive_that_swells_is_not_gone_on_with(tmp_path, made, told):
    from coursework.system.unzipping import ArchiveLimits, unpack

    limits = ArchiveLimits(files=50, each=2 << 20, total=8 << 20)

    (tmp_path / "a.zip").write_bytes(made())
    with within(room=300_000_000), pytest.raises(BadInput, match=rf"a\.zip.*{told}"):
        unpack(tmp_path / "a.zip", tmp_path / "out", limits)
    assert sum(p.stat().st_size for p in tmp_path.rglob("out/*")) <= limits.total + (1 << 16)


def test_an_archive_in_an_archive_stays_closed(tmp_path):
    from coursework.scanning.sources import scans
    from coursework.system.unzipping import unpack

    inner = bomb(1 << 20)
    for _ in range(5):
        made = io.BytesIO()
        with zipfile.ZipFile(made, "w") as archive:
            for number in range(8):
                archive.writestr(f"{number}.zip", inner)
        inner = made.getvalue()
    (tmp_path / "a.zip").write_bytes(inner)
    assert sorted(p.name for p in unpack(tmp_path / "a.zip", tmp_path / "out")) == [
        f"{k}.zip" for k in range(8)
    ]
    found = scans([tmp_path / "a.zip"], tmp_path / "scans")
    assert len(found) == 1 or all("is not opened" in one.fault for one in found)


def png(width, height):
    """A picture whose head says so much, with as many bytes behind it."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    squeeze, row = zlib.compressobj(9), bytes((width + 7) // 8 + 1)
    rows = b"".join(squeeze.compress(row) for _ in range(min(height, 1000))) + squeeze.flush()
    head = struct.pack(">IIBBBBB", width, height, 1, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", rows) + chunk(b"IEND", b"")


def tiff(width, height):
    tags = {256: width, 257: height, 258: 1, 259: 1, 262: 1, 273: 8, 277: 1, 278: height, 279: 100}
    entries = b"".join(struct.pack("<HHII", tag, 4, 1, value) for tag, value in tags.items())
    return b"II*\0\x08\0\0\0" + struct.pack("<H", len(tags)) + entries + bytes(104)


def pdf(box, pages=1):
    parts = [
        b"<</Type/Catalog/Pages 2 0 R>>",
        b"<</Type/Pages/Kids[%s]/Count %d>>" % (b" ".join([b"3 0 R"] * pages), pages),
        b"<</Type/Page/Parent 2 0 R/MediaBox[%s]>>" % box,
    ]
    data, places = b"%PDF-1.4\n", []
    for number, part in enumerate(parts, start=1):
        places.append(len(data))
        data += b"%d 0 obj\n%s\nendobj\n" % (number, part)
    table = b"".join(b"%010d 00000 n \n" % place for place in places)
    return (
        data
        + b"xref\n0 4\n0000000000 65535 f \n%strailer<</Size 4/Root 1 0 R>>\nstartxref\n%d\n%%%%EOF"
        % (table, len(data))
    )


PICTURES = {
    "png of 4 000 million pixels": (".png", lambda: png(65_535, 65_535)),
    "png of one column": (".png", lambda: png(1, 2**31 - 1)),
    "tiff of 4 000 million pixels": (".tif", lambda: tiff(65_535, 65_535)),
    "tiff of nothing": (".tif", lambda: tiff(0, 0)),
    "pdf of a mile": (".pdf", lambda: pdf(b"0 0 5000000 5000000")),
    "pdf of a line": (".pdf", lambda: pdf(b"0 0 1 100000000")),
    "pdf of 30 000 pages": (".pdf", lambda: pdf(b"0 0 595 842", 30_000)),
}


@pytest.mark.parametrize("kind", PICTURES)
def test_a_picture_larger_than_any_page_is_told_and_not_unpacked(tmp_path, kind):
    for module in ("cv2", "pypdfium2"):
        pytest.importorskip(module)
    from coursework.scanning.pictures import BadPicture, opencv, page_count, picture_at

    ending, made = PICTURES[kind]
    path = tmp_path / f"x{ending}"
    path.write_bytes(made())
    assert path.stat().st_size < 1_000_000
    opencv()
    with within(room=400_000_000), pytest.raises(BadPicture, match=f"x{ending}"):
        [picture_at(path, number) for number in range(1, page_count(path) + 1)]


def test_a_page_of_a_pdf_is_a_picture_of_rows_and_columns(tmp_path):
    pytest.importorskip("pypdfium2")
    from coursework.scanning.pictures import LARGEST, picture_at

    path = tmp_path / "x.pdf"
    for box in (b"0 0 595 842", b"0 0 36 14400", b"0 0 14400 14400"):
        path.write_bytes(pdf(box))
        grey = picture_at(path, 1).grey
        assert grey.ndim == 2
        assert grey.size <= 1.01 * LARGEST


@pytest.mark.parametrize("count", [5, pytest.param(400, marks=pytest.mark.slow)])
def test_a_damaged_picture_is_a_page_or_told(tmp_path, count):
    cv2 = pytest.importorskip("cv2")
    pytest.importorskip("pypdfium2")
    import numpy as np
    from mutations import damaged_bytes

    from coursework.scanning.pictures import LARGEST, BadPicture, page_count, picture_at

    grey = np.random.default_rng(1).integers(0, 255, (60, 50), np.uint8)
    samples = {e: cv2.imencode(e, grey)[1].tobytes() for e in (".png", ".jpg", ".tif")} | {
        ".pdf": pdf(b"0 0 595 842", 2)
    }
    for ending, sample in samples.items():
        path = tmp_path / f"x{ending}"
        for case in range(count):
            path.write_bytes(damaged_bytes(random.Random(f"{ending} {case}"), sample))
            try:
                with within():
                    pages = [picture_at(path, number).grey for number in range(1, page_count(path) + 1)]
            except BadPicture as why:
                told = path.name in str(why)
            else:
                told = True
                assert all(page.ndim == 2 and 0 < page.size <= 1.01 * LARGEST for page in pages)
            assert told
