"""Each reader with samples of what it reads and the words of its format; what it may answer; how long, in how
much memory."""

from __future__ import annotations

import io
import json
import random
import resource
import signal
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mutations import damaged_bytes, damaged_json, damaged_table

RECORDED = Path(__file__).parent / "gradebook" / "recorded"
SECONDS = 20  #: of processor, of one case: the dearest takes a hundredth of it
ROOM = 700_000_000  #: bytes, of one case, beside what the process has

COMMON = (
    "\0",
    "\ufeff",
    "\ud800",
    "\x1b[31m",
    "\u202e",
    "'" * 40,
    '"' * 41,
    '"',
    '""',
    "'",
    "\r",
    "\n",
    "\r\n",
    "\x85",
    "\u2028",
    "\t",
    ";" * 30,
    "," * 300,
    "-",
    "=cmd()|x",
    "../../etc/passwd",
    "9" * 400,
    "9" * 5000,
    "-1",
    "1e999",
    "nan",
    "inf",
    "1e-400",
    "٣",
    "²",
    "é" * 500,
    "%s%n{0}{}",
    "${7*7}",
    "None",
    "true",
    "0x1F",
    "1_000",
    "a\u0301",
    "ﬁ",
    "İ",
    "ß",
    "\\",
    "\\u0000",
    "\\ud800",
)
TABLE = (
    "student",
    "student,student",
    "exercise",
    "seed",
    "part",
    "answer",
    "points",
    "reason",
    "lang",
    "Question 1",
    "Response 1",
    "Réponse 1",
    "Seed: 1; ans1: ",
    "ans1: [1] [score]; ",
    "part 1: ",
    "partie 2 : ",
    "; part 3: ",
    "Grade/9.00",
    "Name",
    "id",
    "attempt",
    "12345: x",
    "Email address",
    "Adresse de courriel",
    "First name",
    "Prénom",
    "SIS User ID",
    "Student, Test",
    "Points Possible",
    "Overall average",
    "|123",
    "[Total Pts: 5]",
    " (Real)",
    "1700000000",
    "coordinate",
    "seen",
)
JSON = (
    "null",
    "{}",
    "[]",
    "[" * 3000,
    '{"a":' * 3000,
    "NaN",
    "1e999",
    '"answers"',
    '"student"',
    ":",
    ",",
    "}",
    "]",
    '"\\ud83d"',
)
PYTHON = (
    "answers = {",
    "}",
    "#",
    "# mm",
    '"rA": ',
    "**{}",
    "(" * 300,
    "[" * 300,
    "-" * 3000,
    "1+" * 3000,
    "lambda: 1",
    "f'{1}'",
    "b'x'",
    "1j",
    "'''",
    '"""',
    "\\n",
    "\\\\",
    "__import__('os')",
    "{'a': {}}",
    "9" * 5000,
    "# four_bar_motion 3",
    "0xFF",
    "...",
    "student",
)
XML = (
    "<!DOCTYPE a [<!ENTITY b 'c'>]>",
    "&b;",
    "&#0;",
    "&#xD800;",
    "<![CDATA[",
    "]]>",
    "<value>",
    "</value>",
    "<a>" * 3000,
    "xmlns='x'",
    '<?xml version="1.0" encoding="utf-7"?>',
    '<?xml version="1.0" encoding="rot13"?>',
    "<!--",
    "candidateResponse",
    "qti-item-result",
)
TOML = (
    "[",
    "]",
    "[[",
    "]]",
    "=",
    "{",
    "}",
    "[mark]",
    "[[exercises]]",
    "[service]",
    "[[platforms]]",
    "title",
    "name",
    "seed",
    "versions",
    "= 1",
    "= -1",
    "= 1e400",
    "= nan",
    "= inf",
    "= true",
    "= []",
    "= {}",
    "= ''",
    '= "x"',
    "= 1979-05-27",
    "= [[1], ['a']]",
    "a.b.c.d = 1",
    "= " + "[" * 3000,
    "= 9" + "9" * 400,
    "= 0xFFFFFFFFFFFFFFFFFFFF",
    '= "\\u0000"',
    "= 07:32:00",
    "'''",
    "steps",
    "loads",
    "marking",
)


# ----------------------------------------------------------------------- damage


def with_words(generator: random.Random, data: bytes, words: tuple[str, ...]) -> bytes:
    """A text with words of its format, or of no format, put in or in the place of others, lines doubled, gone
    or many."""
    text = data.decode("utf-8", "replace")
    for _ in range(generator.choice((1, 1, 2, 3, 8))):
        place, word = generator.randrange(len(text) + 1), generator.choice(words + COMMON)
        lines = text.split("\n")
        line = generator.randrange(len(lines))
        match generator.randrange(6):
            case 0 | 1:
                text = text[:place] + word + text[place:]
            case 2:
                text = text[:place] + word + text[place + generator.randrange(1, 30) :]
            case 3:
                text = "\n".join((*lines[:line], *lines[line:][1:]))
            case 4:
                text = "\n".join(
                    (*lines[:line], lines[line], lines[generator.randrange(len(lines))], *lines[line:])
                )
            case _:
                text = text[:place] + word * generator.choice((2, 50, 1000)) + text[place:]
            # What has grown beyond measure is a matter of its own.
        text = text[:400_000]
    return text.encode("utf-8", "surrogatepass")


VALUES = (
    "1",
    "-1",
    "0",
    "2.5",
    "1e308",
    "-0.0",
    "nan",
    "inf",
    "-inf",
    "true",
    '""',
    '" "',
    '"x"',
    "'\\x00'",
    '"\\u0000"',
    '"a\\nb"',
    '"é"',
    "[]",
    "{}",
    "[[]]",
    '["x"]',
    '["x", "x"]',
    "[1]",
    "{x = 1}",
    '{fr = "x"}',
    "{en = 1}",
    "[{}]",
    "1979-05-27",
    "07:32:00",
    "1979-05-27T07:32:00Z",
    "9" * 30,
    "0x" + "F" * 80,
    "1e-320",
    '"' + "9" * 5000 + '"',
    '"' + "(" * 5000 + '"',
    '"1e999 kg"',
    '"nan kg"',
    '"0 kg"',
    '"-1 mm"',
    '"1 kg/s^9"',
    "[" * 60 + "]" * 60,
    '"../../x"',
    '"/etc/passwd"',
    '"="',
    '"four_bar_motion"',
    '"https://["',
    '"https://x:99999/"',
    '"http://x"',
    '"javascript:x"',
    '["1", 2]',
    '"\\ud7ff\\ue000"',
    '"\\u202e"',
    "99999999999999999999",
    "1000000",
    "26",
    "27",
    "[1, [2]]",
    '{name = "x"}',
)


def damaged_toml(generator: random.Random, text: str) -> bytes:
    """A TOML that is one still, mostly: values and keys exchanged, lines and tables gone, doubled or
    elsewhere."""
    lines = text.splitlines()
    for _ in range(generator.choice((1, 1, 1, 2, 4))):
        place = generator.randrange(len(lines))
        key, equals, _ = lines[place].partition(" = ")
        match generator.randrange(6):
            case 0 | 1 | 2 if equals:
                lines[place] = f"{key} = {generator.choice(VALUES)}"
            case 3 if equals:
                other = generator.choice(lines).partition(" = ")
                lines[place] = f"{key} = {other[2] or 1}"
            case 4 if equals:
                key = generator.choice(
                    (f'"{key} "', '""', '"\\u0000"', "x.y", generator.choice(lines).partition(" = ")[0])
                )
                lines[place] = f"{key} = {lines[place].partition(' = ')[2]}"
            case 5:
                lines.insert(generator.randrange(len(lines)), lines.pop(place))
            case _:
                lines[place] = (
                    lines[place].replace("[", "", 1).replace("]", "", 1) if lines[place][:1] == "[" else ""
                )
    return "\n".join(lines).encode("utf-8", "surrogatepass")


def damaged(generator: random.Random, data: bytes, reader: Reader) -> bytes:
    """A sample, damaged as its format allows."""
    what = generator.randrange(3)
    if what == 0 or not reader.words:
        return damaged_bytes(generator, data)
    if what == 1 and reader.ending in (".csv", ".txt"):
        text = data.decode("utf-8", "replace")
        return damaged_table(generator, text.encode(), max(",;\t", key=text.count))
    if what == 1 and reader.ending in (".json", ".ipynb"):
        return damaged_json(generator, data.decode("utf-8"))
    if reader.ending == ".toml" and generator.random() < 0.9:
        return damaged_toml(generator, data.decode("utf-8"))
    return with_words(generator, data, reader.words)


# ------------------------------------------------------------------------ limits


class TooLong(BaseException):
    """No reader catches it."""


@contextmanager
def within(seconds: float = SECONDS, room: int = ROOM) -> Iterator[None]:
    """End what takes more of the processor's time, or of the memory, than any reader may."""

    def late(*_: object) -> None:
        raise TooLong(f"more than {seconds} s")

    size = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    before, limits = signal.signal(signal.SIGPROF, late), resource.getrlimit(resource.RLIMIT_AS)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    resource.setrlimit(resource.RLIMIT_AS, (size + room, limits[1]))
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        resource.setrlimit(resource.RLIMIT_AS, limits)
        signal.signal(signal.SIGPROF, before)


# ----------------------------------------------------------------------- readers


@dataclass(frozen=True)
class Reader:
    """``read`` is given the damaged file, alone in a folder; it gives what it likes, or refuses."""

    ending: str
    samples: tuple[bytes, ...]
    read: Callable[[Path], Any]
    words: tuple[str, ...] = ()
    name: str = "x"  #: of the file


def _checked_rows(path: Path) -> None:
    from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected
    from coursework.gradebook.submissions import read_file

    rows = list(read_file(path))
    assert rows, "a file of no rows is told"
    for row in rows:
        assert isinstance(row, (AnswerRow, Rejected, PlatformFile))
        if isinstance(row, Rejected):
            assert row.reason
            assert path.name in row.source
        told = row if isinstance(row, tuple) else (row.source, row.reason, *row.row.items())
        for text in _texts(told):
            assert "\0" not in text, f"NUL: {text[:80]!r}"
            text.encode("utf-8")


def _texts(told: Any) -> Iterator[str]:
    if isinstance(told, str):
        yield told
    elif isinstance(told, (tuple, list)):
        for one in told:
            yield from _texts(one)


def _notebook(*sources: str, **about: Any) -> bytes:
    cells = [{"cell_type": "markdown", "metadata": {}, "source": "**Name:** Ana\n\nfour_bar_motion · 3 · v1"}]
    cells += [
        {
            "cell_type": "code",
            "metadata": {"tags": ["answers"]},
            "source": source.splitlines(True),
            "outputs": [],
            "execution_count": None,
        }
        for source in sources
    ]
    return json.dumps(
        {"cells": cells, "metadata": {"coursework": about}, "nbformat": 4, "nbformat_minor": 5}
    ).encode()


ANSWERS = (
    b'student,exercise,seed,part,answer\nAna,four_bar_motion,3,rA,"319,8 mm"\nBen,four_bar_motion,4,rA,12.5\n'
    b'"O\'Neil, D",coil,5,why,"so\nand so"\n',
    b"answer;student;exercise;seed;part\n319,8;Ana;four_bar_motion;3;rA\n'=1+1;Ben;four_bar_motion;4;rB\n",
)
SHEETS = json.dumps(
    [
        {
            "student": "Ana",
            "exercise": "coil",
            "seed": 3,
            "lang": "fr",
            "answers": {"Z": "3+4i", "M": [[1, 2], [3, 4]], "n": 2, "x": None},
        }
    ]
).encode()
NOTEBOOKS = (
    _notebook(
        'answers = {\n    "student": "Ana",\n    "rA": "319.8 mm",\n    "n": 2,  # whole\n    "v": '
        "(1.5, 2),\n}\n",
        exercise="four_bar_motion",
        seed=3,
    ),
    _notebook(
        'answers = {  # coil 3\n    "Z": "3+4i",\n}\n',
        'answers = {  # gear 4\n    "i": -2.5,\n}\n',
        student="Ana",
        sheets=[{"exercise": "coil", "seed": 3}, {"exercise": "gear", "seed": 4}],
    ),
    _notebook('answers = {\n    "rA": "319.8 mm",\n', '    "b": 2,\n}\nprint(answers)\n'),
)
ROSTERS = (
    b'student,number,lang,group\nAna,7,fr,A\nBen,8,en,B\n"Lef\xc3\xa8vre, C\xc3\xa9lo",9,,A\n',
    b"Nom;Pr\xe9nom;Adresse de courriel\nLef\xe8vre;Ana;a@x.org\nO'Neil;Ben;b@x.org\n",
)
ACCEPTED = b'student,exercise,seed,part,points,reason\nAna,coil,3,Z,1,good\nBen,coil,,I,"0,5","a, b"\n'
TYPED = (
    b"student,exercise,seed,part,coordinate,answer,seen\nAna,coil,3,Z,1,3+4i,abc-0001 abc-0002\n"
    b"K7,(name),,,,Ben,\n"
)
PAGE = json.dumps(
    {
        "format": 1,
        "what": "answers",
        "reason": "",
        "code": "K7",
        "number": 1,
        "is_straight": True,
        "has_picture": False,
        "least": 0.9,
        "fields": [
            {
                "exercise": "coil",
                "seed": 3,
                "part": "Z",
                "coordinate": 0,
                "coordinates": 1,
                "what": "number",
                "text": "3",
                "confidence": 0.99,
                "waits": "",
                "crop": "",
                "box": [10, 10, 50, 8],
            }
        ],
    }
).encode()
FILES = json.dumps([{"name": "a.pdf", "digest": "0123456789abcdef", "pages": 2, "fault": ""}]).encode()
ASSIGNMENT = b"""title = { fr = "Devoir 2", en = "Midterm 2" }
course = "Mechanics"
date = 2026-12-04
duration = "1 h 30"
instructions = { fr = "Sans documents", en = "No documents" }
cover = true
mark = { of = 20, step = 0.5 }
versions = "each"
identity = ["number", "group"]
sort = "group"
sittings = "best"
answers = "shown"
solutions_after = 2026-12-05
roster = "class.csv"
formats = "pdf,ipynb"
booklet = true
lang = "fr"
paper = "a4"
decimal = "comma"
[[exercises]]
name = "slotted_mechanism"
parts = ["rA", "theta4"]
points = { rA = 2 }
[[exercises]]
name = "vocabulary"
seed = 12
[[exercises]]
name = "grashof"
points = 6
[marking]
follow_through = 0.5
"""
SCENE = b"""exercise = "three_loop_shaper"
seed = 7
effects = ["load", "gravity"]
show = ["drive_torque", "reaction D", "d5"]
steps = 24
[given]
omega2 = "4 rad/s"
[bodies.8]
mass = "12 kg"
[bodies.5]
mass = "4000 g"
centre = ["6 cm", "0 mm"]
[[loads]]
on = "G"
force = "0,8 kN"
angle = "180 deg"
during = "working stroke"
[friction]
D = { coefficient = 0.08, radius = "10 mm" }
[flywheel]
unevenness = "2 %"
"""
SETTINGS = b"""[service]
url = "https://tool.example.org"
session_hours = 3
[[platforms]]
name = "Moodle"
issuer = "https://moodle.example.org"
client_id = "abc"
deployments = ["1", "2"]
auth_url = "https://moodle.example.org/auth"
token_url = "https://moodle.example.org/token"
jwks_url = "https://moodle.example.org/keys"
"""
COURSE = b"""title = { fr = "Cours", en = "Course" }
languages = ["en", "fr"]
[[chapters]]
title = { fr = "Un", en = "One" }
[[chapters.sections]]
title = { fr = "Un", en = "One" }
exercises = ["coil", { name = "gear", needs = ["coil"] }]
[marking]
digits = 4
follow_through = 0.5
[marking.prices]
sign = 0.5
[study]
install = "coursework==1.0"
[feedback]
practice = true
"""
PROGRESS = json.dumps(
    {
        "format": "coursework progress",
        "version": 1,
        "entries": [
            {
                "at": "2026-01-01T00:00:00.000000Z",
                "exercise": "coil",
                "seed": 3,
                "part": "Z",
                "what": "answer",
                "answer": "3",
                "verdict": "wrong",
            }
        ],
    }
).encode()
METADATA = json.dumps(
    {
        "users": [
            {
                "name": "Ana",
                "email": "a@x.org",
                "sid": "7",
                "assignment": {"due_date": "2026-01-01T00:00:00Z"},
            }
        ],
        "created_at": "2026-01-02T00:00:00.000000-08:00",
        "assignment": {"due_date": "2026-01-01T00:00:00Z"},
    }
).encode()
MARKS = b"""student,exercise,seed,part,answer,verdict,points,out_of,feedback
Ana,coil,3,Z,3+4i,correct,2,2,
Ana,coil,3,I,1,wrong,0,2,no
Ben,coil,4,Z,,missing,0,2,
"""


def zipped() -> bytes:
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("a/ana.csv", ANSWERS[0] * 20)
        archive.writestr("b.json", SHEETS)
        archive.writestr("empty", b"")
    return made.getvalue()


def parquet() -> bytes:
    import pyarrow as arrow
    from pyarrow import parquet

    made = io.BytesIO()
    columns = {c: arrow.array(["a", "b", None] * 5) for c in ("student", "exercise", "part")}
    more = {"seed": arrow.array(range(15)), "answer": arrow.array(["1", "2.5 mm", None] * 5)}
    parquet.write_table(arrow.table({**columns, **more}), made)
    return made.getvalue()


# ---------------------------------------------------------------------- the table


def _roster(path: Path) -> None:
    from coursework.issuing.roster import read_roster

    students = read_roster(path)
    assert students
    assert len({one.name for one in students}) == len(students)
    assert all(one.name.strip() and one.draw_key for one in students)


def _accepted(path: Path) -> None:
    from coursework.gradebook.decisions import DecisionFiles

    assert all(one.student and one.exercise and one.part for one in DecisionFiles(None, path).lines)


def _typed(path: Path) -> None:
    from coursework.scanning.typed import merged, read_typed, typed_file

    found = [one for one in merged([], read_typed(path)) if any(one[:6])]
    path.write_bytes(typed_file(found))
    assert [one.place for one in read_typed(path)] == [one.place for one in found]


def _page(path: Path) -> None:
    from coursework.scanning.scan_store import page_as_json, page_of, put_page, stored_page

    out = path.parent
    (out / ".scanned").mkdir(exist_ok=True)
    path = path.rename(out / ".scanned" / "p.json")
    found = stored_page(out, "p")
    if found is not None:
        assert page_of(page_as_json(found)) == found
        put_page(out, "p", found, {})
        assert stored_page(out, "p") == found


def _files(path: Path) -> None:
    from coursework.scanning.scan_store import joined, scanned, stored_files

    (path.parent / ".scanned").mkdir(exist_ok=True)
    path.rename(path.parent / ".scanned" / "files.json")
    found = joined(stored_files(path.parent), ())
    assert sum(1 for _ in scanned(path.parent, found)) < 100_000


def _assignment(path: Path) -> None:
    from coursework.api import open_course
    from coursework.issuing.assignment import read_assignment

    read_assignment(path, open_course())


def _scene(path: Path) -> None:
    from coursework.api import open_course
    from coursework.scenes.scene_files import read_scene

    read_scene(path, open_course())


def _platforms(path: Path) -> None:
    from coursework.platforms.lti.settings import as_toml, read_settings

    found = read_settings(path.parent)
    path.write_text(as_toml(found), "utf-8")
    assert read_settings(path.parent) == found


def _course(path: Path) -> None:
    from coursework.api import open_course
    from coursework.issuing.practice import offers_practice

    (path.parent / "exercises").mkdir()
    for name in ("coil", "gear"):
        (path.parent / "exercises" / f"{name}.py").touch()
    path.rename(path.parent / "exercises" / "course.toml")
    course = open_course(path.parent)
    folder = course.folder
    for lang in folder.languages:
        folder.title(lang), folder.lacks_title(lang)
    assert folder.rules, folder.install
    assert isinstance(folder.chapters, tuple)
    offers_practice(course)


def _progress(path: Path) -> None:
    from coursework.selfstudy.progress import ExerciseStore, ProgressFile

    before = path.read_bytes()
    ExerciseStore(ProgressFile(path.parent), "coil").add(3, "answers", {"Z": "4"})
    kept = [file.read_bytes() for file in path.parent.iterdir()]
    assert len(ProgressFile(path.parent).progress) >= 1 or before in kept


def _marks(path: Path) -> None:
    from coursework.gradebook.statistics.marks import read

    read(path.parent)


def _archive(path: Path) -> None:
    from coursework.system.unzipping import ArchiveLimits, unpack

    for file in unpack(path, path.parent / "out", ArchiveLimits(files=20, each=1_000_000, total=2_000_000)):
        assert file.resolve().is_relative_to((path.parent / "out").resolve())


def _gradebook(platform: str, item: str) -> Callable[[Path], None]:
    def read(path: Path) -> None:
        from coursework.gradebook.filling import fill
        from coursework.gradebook.platform_gradebooks import platform_gradebook

        fill(platform_gradebook(platform), path, item, [])

    return read


def _tsv(path: Path) -> None:
    _checked_rows(path.rename(path.with_suffix(".tsv")))


def recorded(*names: str) -> tuple[bytes, ...]:
    return tuple((RECORDED / name).read_bytes() for name in names)


READERS = {
    "answers, CSV": Reader(".csv", ANSWERS, _checked_rows, TABLE),
    "answers, TSV": Reader(".csv", tuple(one.replace(b",", b"\t") for one in ANSWERS), _tsv, TABLE),
    "answers, JSON": Reader(".json", (SHEETS,), _checked_rows, JSON),
    "answers, notebook": Reader(".ipynb", NOTEBOOKS, _checked_rows, PYTHON + JSON),
    "answers, Moodle": Reader(
        ".csv", recorded("moodle_responses.csv", "moodle_responses_fr.csv"), _checked_rows, TABLE
    ),
    "answers, Moodle's JSON": Reader(".json", recorded("moodle_responses.json"), _checked_rows, JSON + TABLE),
    "answers, Canvas": Reader(".csv", recorded("canvas_analysis.csv"), _checked_rows, TABLE),
    "answers, QTI": Reader(".xml", recorded("qti_result.xml"), _checked_rows, XML),
    "answers, Parquet": Reader(".parquet", (), _checked_rows),
    "roster": Reader(
        ".csv",
        ROSTERS + recorded("moodle_participants.csv", "canvas_gradebook.csv", "sakai_gradebook.csv"),
        _roster,
        TABLE,
    ),
    "accepted": Reader(".csv", (ACCEPTED,), _accepted, TABLE),
    "typed": Reader(".csv", (TYPED,), _typed, TABLE, "typed"),
    "page of a scan": Reader(".json", (PAGE,), _page, JSON),
    "files of a scan": Reader(".json", (FILES,), _files, JSON),
    "assignment": Reader(".toml", (ASSIGNMENT,), _assignment, TOML),
    "scene": Reader(".toml", (SCENE,), _scene, TOML),
    "platforms": Reader(".toml", (SETTINGS,), _platforms, TOML, "platforms"),
    "course": Reader(".toml", (COURSE,), _course, TOML, "course"),
    "progress": Reader(".json", (PROGRESS,), _progress, JSON, "progress"),
    "marks": Reader(".csv", (MARKS,), _marks, TABLE, "marks"),
    **{
        f"gradebook, {name}": Reader(
            ".csv",
            recorded(*(p.name for p in sorted(RECORDED.glob(f"{name}_gradebook*.*")))),
            _gradebook(name, item),
            TABLE,
        )
        for name, item in (
            ("moodle", "Week 3"),
            ("canvas", "Quiz 1"),
            ("blackboard", "Week 3"),
            ("sakai", "Quiz"),
        )
    },
    "archive": Reader(".zip", (zipped(),), _archive),
}
