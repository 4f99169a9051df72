"""Notebooks whose tags or metadata are gone, whose cells were cut or joined, are known again, told, and
marked."""

from __future__ import annotations

import copy
import json
import re

import pytest

import coursework
from coursework.gradebook.rows import AnswerRow, Rejected
from coursework.gradebook.submissions import read_file
from coursework.rendering.renderer import renderer_of

COURSE = coursework.open_course()
NAME, SEED = "four_bar_motion", 4
ANSWERS = {"theta3": "12,5", "omega4": "-3 rad/s", "a_B": "1e4"}


def filled(lang="fr", student="Zoé", name=NAME, answers=ANSWERS):
    """A notebook to hand in, with some answers."""
    book = json.loads(renderer_of(COURSE.folder).notebook(COURSE[name].variant(SEED, lang).handout(student)))
    cell = answers_cell(book)
    source = "".join(cell["source"])
    for key, text in answers.items():
        source = source.replace(f'"{key}": ""', f'"{key}": "{text}"')
    cell["source"] = source.splitlines(keepends=True)
    return book


def answers_cell(book):
    return next(c for c in book["cells"] if "answers" in c["metadata"].get("tags", ()))


def place(book):
    return book["cells"].index(answers_cell(book))


def source(cell):
    return "".join(cell["source"])


def code(text, metadata=None):
    return {
        "cell_type": "code",
        "metadata": metadata or {},
        "source": text,
        "outputs": [],
        "execution_count": None,
    }


def without_tags(book):
    for cell in book["cells"]:
        cell["metadata"] = {}


def without_metadata(book):
    without_tags(book)
    book["metadata"] = {}


def of_colab(book):
    """As Colab saves: its own metadata, ids there, outputs, no tags."""
    book["metadata"] = {
        "colab": {"provenance": []},
        "kernelspec": {"name": "python3", "display_name": "Python 3"},
    }
    for number, cell in enumerate(book["cells"]):
        cell.pop("id")
        cell["metadata"] = {"id": f"x{number}", "colab": {"base_uri": "https://example.org/"}}
        if cell["cell_type"] == "code":
            cell |= {
                "execution_count": number,
                "outputs": [{"output_type": "stream", "name": "stdout", "text": ["answers = {\n"]}],
            }
    book |= {"nbformat": 4, "nbformat_minor": 0}


def of_4_4(book):
    without_tags(book)
    for cell in book["cells"]:
        del cell["id"]
    book["nbformat_minor"] = 4


def cut(book, keep_tags):
    at = place(book)
    cell = book["cells"][at]
    lines = source(cell).splitlines(keepends=True)
    tags = cell["metadata"] if keep_tags else {}
    book["cells"][at : at + 1] = [code("".join(lines[:5]), tags), code("".join(lines[5:]), dict(tags))]


def joined_with_code(book):
    cell = answers_cell(book)
    cell["source"] = "import math\nr = math.sqrt(2)\n" + source(cell) + "\nprint(answers)\n"


def joined_and_stripped(book):
    joined_with_code(book)
    without_metadata(book)


def written_in_a_copy(book):
    """The cell that is tagged was left blank, and a copy of it filled."""
    at = place(book)
    copied = copy.deepcopy(book["cells"][at]) | {"metadata": {}}
    book["cells"][at]["source"] = re.sub(r'": "[^"]*"', '": ""', source(book["cells"][at]))
    book["cells"].append(copied)


def twice(book):
    book["cells"].append(copy.deepcopy(answers_cell(book)))


LOST = {
    "tags": without_tags,
    "metadata": without_metadata,
    "colab": of_colab,
    "4.4": of_4_4,
    "cut, tags on both": lambda book: cut(book, True),
    "cut, no tags": lambda book: cut(book, False),
    "joined": joined_with_code,
    "joined and stripped": joined_and_stripped,
    "in a copy": written_in_a_copy,
}


def read(tmp_path, book, name="paper.ipynb"):
    (tmp_path / name).write_text(json.dumps(book), "utf-8")
    found = list(read_file(tmp_path / name))
    return [r for r in found if isinstance(r, AnswerRow)], [r for r in found if isinstance(r, Rejected)]


@pytest.mark.parametrize("lang", ["fr", "en"])
@pytest.mark.parametrize("lost", LOST)
def test_what_was_lost_is_known_again_and_told(tmp_path, lost, lang):
    book = filled(lang)
    untouched, rejected = read(tmp_path, book)
    assert not rejected
    assert not any(row.warning for row in untouched)
    LOST[lost](book)
    rows, rejected = read(tmp_path, book)
    assert not rejected
    assert [r._replace(warning="") for r in rows] == untouched
    assert {(r.student, r.exercise, r.seed, r.lang) for r in rows} == {("Zoé", NAME, str(SEED), lang)}
    assert {r.part: r.answer for r in rows if r.answer} == ANSWERS
    (told,) = {r.warning for r in rows}
    assert "paper.ipynb" in told


def test_an_answers_cell_that_stands_there_twice_is_one(tmp_path):
    book = filled()
    twice(book)
    rows, rejected = read(tmp_path, book)
    assert {r.part: r.answer for r in rows if r.answer} == ANSWERS
    assert not rejected


@pytest.mark.parametrize("strip", [without_tags, without_metadata])
def test_two_cells_of_different_answers_are_not_chosen_between(tmp_path, strip):
    book = filled()
    twice(book)
    book["cells"][-1]["source"] = source(book["cells"][-1]).replace("12,5", "13")
    strip(book)
    rows, (rejected,) = read(tmp_path, book)
    assert not rows
    assert rejected.row["student"] == "Zoé"


def test_a_notebook_of_somebody_else_is_not_one_of_ours(tmp_path):
    book = filled()
    without_metadata(book)
    book["cells"] = [c for c in book["cells"] if "· v1" not in source(c)]
    rows, (rejected,) = read(tmp_path, book)
    assert not rows
    assert "not a notebook of ours" in rejected.reason


def test_code_beside_the_answers_is_not_run_and_what_changes_them_is_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for line, is_read in (
        ("open('ran', 'w')", True),
        ("study.check(answers)", True),
        ("answers['theta3'] = '0'", False),
        ("answers.update(theta3='0')", False),
        ("answers |= {}", False),
    ):
        book = filled()
        cell = answers_cell(book)
        cell["source"] = f"{source(cell)}\n{line}\n"
        rows, rejected = read(tmp_path, book)
        assert (bool(rows), bool(rejected)) == (is_read, not is_read), line
    assert not (tmp_path / "ran").exists()


def test_keys_by_number_are_marked_as_their_questions(tmp_path, capsys):
    from coursework.cli import run

    assert run(["build", "vocabulary", "--formats", "ipynb", "--lang", "fr", "--out", str(tmp_path)]) == 0
    (path,) = (tmp_path / "handouts").rglob("*.ipynb")
    book = json.loads(path.read_text("utf-8"))
    variant = COURSE["vocabulary"].from_record(
        json.loads((tmp_path / "issued.json").read_text())["issued"][0]["record"]
    )
    cell = answers_cell(book)
    text = source(cell).replace('"student": ""', '"student": "Zoé"')
    for number, part in enumerate(variant.parts, start=1):
        letter = variant.letters(part)[variant.reference(part.quantity)]
        assert f'"{part.id}"' not in text
        text = text.replace(f'"q{number}": ""', f'"q{number}": "{letter}"')
    cell["source"] = text
    without_metadata(book)
    path.write_text(json.dumps(book), "utf-8")
    run(["grade", str(path), "--issued", str(tmp_path / "issued.json"), "--out", str(tmp_path / "marks")])
    marks = (tmp_path / "marks" / "marks.csv").read_text("utf-8")
    assert marks.count(",correct,1") == len(variant.parts)
    assert "metadata is gone" in capsys.readouterr().err
