"""What an exam needs on paper: codes in place of names, room, seat, own time, lists to sign, and room for the
reasoning."""

import json

import pypdfium2
import pytest

from coursework.cli import run
from coursework.issuing import dry_run

pytestmark = pytest.mark.e2e

ROSTER = """student,number,group,Salle,place,tiers temps
Ada Lovelace,N9101,TD 10,Amphi B,A2,
Bo Diddley,N9102,TD 2,Amphi B,A1,oui
Cy Young,N9103,TD 2,B14,C1,
Di Prima,N9104,TD 2,B9,,
"""
EXAM = """title = "Final"
roster = "class.csv"
identity = ["number"]
duration = "1 h 30"
date = 2026-12-04
cover = true
rules = true
work = 40
sort = "room"
formats = "pdf"
booklet = true
attendance = true
solutions = false
anonymous = true
secret = "0123456789abcdef0123456789abcdef"
[[exercises]]
name = "crank_pin"
"""
NAMES = ("Ada Lovelace", "Bo Diddley", "Cy Young", "Di Prima")


def text(path):
    return [
        page.get_textpage().get_text_bounded().replace("\xa0", " ") for page in pypdfium2.PdfDocument(path)
    ]


@pytest.fixture
def exam(small_course, tmp_path):
    (tmp_path / "class.csv").write_text(ROSTER)
    (tmp_path / "final.toml").write_text(EXAM)

    def build(*options):
        asked = [
            "build",
            str(tmp_path / "final.toml"),
            "--out",
            str(tmp_path / "out"),
            "--lang",
            "en",
            *options,
        ]
        return run(["--course", str(small_course), *asked])

    assert build() == 0
    return build, tmp_path / "out"


def test_papers_bear_codes_rooms_and_times_and_lists_say_who_is_who(exam, capsys):
    build, out = exam
    codes = json.loads((out / "issued.json").read_text())["codes"]
    assert list(codes) == list(NAMES)
    assert len(set(codes.values())) == 4
    handouts = sorted(path.name for path in (out / "handouts").iterdir())
    booklets = ["class-amphi-b.en.pdf", "class-b14.en.pdf", "class-b9.en.pdf", "pages.csv"]
    assert handouts == sorted([*booklets, *(f"{code.lower()}.en.pdf" for code in codes.values())])
    hidden = [*NAMES, "N9101", "N9102", "N9103", "N9104"]
    for path in (out / "handouts").glob("*.pdf"):
        assert not [name for name in hidden if name in "".join(text(path))]
    for table in ("answers.csv", "answers_wide.csv", "handouts/pages.csv", "instructor/key.json"):
        assert not [name for name in NAMES if name in (out / table).read_text("utf-8-sig")]
    bo = text(out / "handouts" / f"{codes['Bo Diddley'].lower()}.en.pdf")
    for told in (f"Code: {codes['Bo Diddley']}", "Room: Amphi B", "Seat: A1", "2 h", "switched off"):
        assert told in bo[0]
    assert "Reasoning for exercise 1" in bo[1]
    ada = text(out / "handouts" / f"{codes['Ada Lovelace'].lower()}.en.pdf")
    assert "1 h 30" in ada[0]
    # In a room by seat; rooms in their natural order.
    stack = "".join(text(out / "handouts" / "class-amphi-b.en.pdf"))
    assert stack.index(codes["Bo Diddley"]) < stack.index(codes["Ada Lovelace"])
    rooms = [page for page in text(out / "instructor" / "attendance.en.pdf") if page.strip()]
    assert [next(r for r in ("Amphi B", "B9", "B14") if f"– {r}" in page) for page in rooms] == [
        "Amphi B",
        "B9",
        "B14",
    ]
    for told in (
        "2 students",
        "Ada Lovelace",
        codes["Ada Lovelace"],
        "N9101",
        "TD 10",
        "2 h",
        "End with extra time",
    ):
        assert told in rooms[0]
    assert "extra time" not in rooms[1]
    (door,) = text(out / "instructor" / "seats.en.pdf")
    assert all(name in door for name in NAMES)
    assert not [code for code in codes.values() if code in door]
    assert "2 h" not in door
    table = (out / "attendance.csv").read_text("utf-8-sig").splitlines()
    assert table[0] == "student,code,number,group,room,seat,present"
    assert [line.split(",")[0] for line in table[1:]] == [
        "Bo Diddley",
        "Ada Lovelace",
        "Di Prima",
        "Cy Young",
    ]
    # Building again changes nothing, and a late student changes no code.
    before = {path: path.read_bytes() for path in (out / "handouts").glob("*.pdf")}
    roster = out.parent / "class.csv"
    roster.write_text(ROSTER.replace("Cy Young", "Aa Late,99,TD 1,B14,C2,\nCy Young"))
    assert build() == 0
    later = json.loads((out / "issued.json").read_text())["codes"]
    assert {name: later[name] for name in NAMES} == codes
    assert {path for path, data in before.items() if path.read_bytes() != data} == {
        out / "handouts" / "class-b14.en.pdf"
    }


def test_a_dry_run_tells_pages_white_points_and_variants_and_writes_nothing(
    small_course, tmp_path, capsys, monkeypatch
):
    (tmp_path / "class.csv").write_text(ROSTER)
    exam = EXAM.replace('secret = "0123456789abcdef0123456789abcdef"\n', "").replace(
        "roster", "versions = 2\nroster", 1
    )
    (tmp_path / "final.toml").write_text(exam)
    out = tmp_path / "out"
    asked = ["--course", str(small_course), "build", str(tmp_path / "final.toml"), "--out", str(out)]
    assert run([*asked, "--dry-run"]) == 0
    told = capsys.readouterr().out.splitlines()
    assert told[0] == "4 papers, 2 pages each: 8 pages in all, 4 sheets of paper (measured on 2 of them)"
    assert told[1] == "white space: no page is white by more than a quarter"
    assert told[-3:-1] == ["points: 4: crank_pin 4", told[-2]]
    assert told[-2].startswith("variants of crank_pin: 2 used, ")
    assert told[-1] == "nothing was written"
    monkeypatch.setattr(dry_run, "WHITE", 0.01)
    assert run([*asked, "--dry-run"]) == 0
    assert capsys.readouterr().out.splitlines()[1].startswith("white space: page 2, up to ")
    assert not out.exists()


def test_a_room_for_the_reasoning_that_no_page_holds_is_refused(small_course, tmp_path, capsys):
    (tmp_path / "class.csv").write_text(ROSTER)
    for line in ("work = 500", "work = -1", 'work = "half"', "work = true"):
        (tmp_path / "final.toml").write_text(EXAM.replace("work = 40", line))
        assert (
            run(
                [
                    "--course",
                    str(small_course),
                    "build",
                    str(tmp_path / "final.toml"),
                    "--out",
                    str(tmp_path / "o"),
                ]
            )
            == 2
        )
        assert "line 8: work is a height in mm from 0 to 230" in capsys.readouterr().err
