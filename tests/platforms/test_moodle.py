"""What is written for Moodle says what the pool says, by the grammar that Moodle documents; read by a parser
of its own."""

from __future__ import annotations

import base64
import re
from dataclasses import replace
from xml.etree import ElementTree
from xml.parsers import expat

import pytest
from platforms.cloze import boxes_of
from tables import each_row

import coursework
from coursework.language.words import words
from coursework.platforms import moodle
from coursework.platforms.items import Pool, item, section
from coursework.platforms.moodle import PLATFORM, escaped, numerical
from coursework.platforms.pieces import PagePieces
from coursework.platforms.pools import of_exercises
from coursework.platforms.posed import CHOICE, CHOICES, COLLECTED, NUMBER, Interval
from coursework.rendering.renderer import renderer_of

COURSE = coursework.open_course()
FOLDERS = renderer_of(COURSE.folder).template_folders
LANGS = ("en", "fr")
KINDS = {NUMBER: "NUMERICAL", CHOICE: "MULTICHOICE_V", CHOICES: "MULTIRESPONSE", COLLECTED: "SHORTANSWER"}

every_exercise = pytest.mark.parametrize("name", COURSE.names)
every_language = pytest.mark.parametrize("lang", ["en", pytest.param("fr", marks=pytest.mark.slow)])


@pytest.fixture(scope="module")
def written():
    """The variant of an exercise in a language, and what is written of it."""
    made = {}

    def of(name, lang):
        if (name, lang) not in made:
            drawn = of_exercises(COURSE, [name], 1, 0, [lang], None)
            given = item(drawn.variants[0][0].in_language(lang), drawn.name)
            made[name, lang] = given, written_of(drawn, lang)
        return made[name, lang]

    return of


def quiz(*pools):
    """The one file of a quiz."""
    (file,) = PLATFORM.files_of(pools)
    return b"".join(file.make())


def written_of(drawn, lang, **changes):
    return quiz(replace(drawn.pool(lang, PLATFORM), **changes))


def questions(data):
    """Name, idnumber, text and files of each question, and the categories between them."""
    for question in ElementTree.fromstring(data):
        if question.get("type") == "category":
            yield "category", question.findtext("category/text")
        else:
            files = {f.get("name"): base64.b64decode(f.text) for f in question.findall("questiontext/file")}
            text = question.findtext("questiontext/text")
            yield question.findtext("name/text"), question.findtext("idnumber"), text, files


@every_language
@every_exercise
def test_every_question_has_its_box(written, name, lang):
    """Type, weight, intervals, shares: as posed; what is collected weighs nothing and takes whatever is
    written."""
    given, data = written(name, lang)
    category, question = questions(data)
    assert category[1].startswith("$course$/top/")
    assert question[0] == given.label[1:-1]
    boxes, around = boxes_of(question[2])
    assert [box.kind for box in boxes] == [KINDS[posed.kind] for posed in given.questions]
    assert given.label in "".join(around)
    assert not re.search(r"[{}]", "".join(around))
    least = min(posed.points for posed in given.questions)
    scale = next(n for n in (1, 2, 4) if float(n * least).is_integer())  # weights are whole numbers
    for posed, box in zip(given.questions, boxes, strict=True):
        assert box.weight == (0 if posed.kind == COLLECTED else scale * posed.points)
        if posed.kind == NUMBER:
            assert [one.share for one in box.answers] == pytest.approx([one.share for one in posed.intervals])
            for answer, one in zip(box.answers, posed.intervals, strict=True):
                _check_interval(answer, one)
        elif posed.kind == COLLECTED:
            assert [(one.share, one.text) for one in box.answers[1:]] == [(0.5, "*")]
            assert box.answers[0].text.strip() == words(lang)["platforms"]["moodle"]["later"]
        else:
            pieces = PagePieces(FOLDERS, lang)
            assert [one.text for one in box.answers] == [pieces.option(one) for one in posed.options]
            assert [one.share for one in box.answers] == pytest.approx([one.share for one in posed.options])


def _check_interval(answer, interval):
    """The whole interval, and hardly more; the answer that students are shown is short."""
    value, half = float(answer.text), interval.half
    slack = 1e-12 * max(abs(interval.low), abs(interval.high))
    assert value - answer.margin <= interval.low + slack
    assert interval.high - slack <= value + answer.margin
    assert answer.margin <= half * 1.0021 + slack
    if half >= 0.01 * abs(interval.value):
        assert len(answer.text.strip("-0.").replace(".", "").rstrip("0")) <= 6


@every_exercise
def test_pictures_travel_with_their_question(written, name):
    """Each is named in the text and there as a file; nothing is fetched, nothing needs a filter."""
    *_, (_, _, text, files) = questions(written(name, "en")[1])
    assert set(re.findall(r'src="@@PLUGINFILE@@/([^"]+)"', text)) == set(files)
    assert all(data.lstrip().startswith((b"<svg", b"<?xml")) for data in files.values())
    assert not re.search(r"https?://(?!www\.w3\.org)|data:image|\\\(|\$\$|<script", text)


def test_identifiers_are_short_and_each_question_has_its_own():
    pool = of_exercises(COURSE, ["grashof", "slotted_mechanism"], 3, 0, LANGS, None)
    found = [one for lang in LANGS for one in questions(written_of(pool, lang)) if one[0] != "category"]
    assert len({one[1] for one in found}) == len(found) == 12
    assert all(len(one[1]) <= 100 for one in found)


def test_a_long_name_of_a_pool_leaves_identifiers_short_and_different(written):
    given, _ = written("grashof", "en")
    pieces, ids = PagePieces(FOLDERS, "en"), set()
    for tail in "ab":
        made = PLATFORM.made(replace(given, pool="week " * 40 + tail), pieces)
        pool = Pool("", "", "en", (section([made]),), FOLDERS, COURSE.folder.root)
        ids |= {one[1] for one in questions(quiz(pool)) if one[0] != "category"}
    assert {len(one) for one in ids} == {100}
    assert len(ids) == 2


#: The pattern and the choice of Moodle's filter_multilang.
SPAN = r'<span(?:\s+lang="[a-zA-Z0-9_-]+"|\s+class="multilang"){2}\s*>.*?</span>'
BLOCK = re.compile(rf"({SPAN})(\s*{SPAN})+", re.IGNORECASE | re.DOTALL)
ONE = re.compile(
    r'<(?:lang|span)[^>]+lang="([a-zA-Z0-9_-]+)"[^>]*>(.*?)</(?:lang|span)>', re.IGNORECASE | re.DOTALL
)


def filtered(text, lang):
    return BLOCK.sub(lambda block: dict(ONE.findall(block[0]))[lang], text)


def check_two_languages(names, tmp_path):
    """What a student reads in a quiz of two languages is what a quiz of their language says, and the boxes
    judge alike."""
    drawn = of_exercises(COURSE, names, 1, 0, LANGS, None)
    both = quiz(*(drawn.pool(lang, PLATFORM) for lang in LANGS))
    found = [one for one in questions(both) if one[0] != "category"]
    for lang in LANGS:
        single = [one for one in questions(written_of(drawn, lang)) if one[0] != "category"]
        for one, other in zip(single, found, strict=True):
            boxes, around = boxes_of(other[2])
            expected_boxes, expected = boxes_of(one[2])
            expected[0] = expected[0].replace(f'<div lang="{lang}">', "<div>", 1)
            read = [filtered(text, lang).replace("bdi", "span") for text in around]
            assert read == [text.replace("bdi", "span") for text in expected], (other[0], lang)
            assert set(one[3]) <= set(other[3])
            for box, alone in zip(boxes, expected_boxes, strict=True):
                assert (box.kind, box.weight) == (alone.kind, alone.weight)
                for answer, answer_alone in zip(box.answers, alone.answers, strict=True):
                    assert (answer.share, answer.margin) == (answer_alone.share, answer_alone.margin)
                    assert filtered(answer.says, lang).replace("bdi", "span") == answer_alone.says
                    if box.kind != "SHORTANSWER":
                        assert filtered(answer.text, lang).replace("bdi", "span") == answer_alone.text


def test_a_question_in_two_languages_says_in_each_what_one_of_it_says(tmp_path):
    check_two_languages(["slotted_mechanism", "grashof", "crank_shaper_drawn"], tmp_path)


@pytest.mark.sweep
@every_exercise
def test_every_question_in_two_languages_says_in_each_what_one_of_it_says(name, tmp_path):
    check_two_languages([name], tmp_path)


def test_files_are_small_and_hold_every_question_once(monkeypatch):
    drawn = of_exercises(COURSE, ["grashof", "slotted_mechanism"], 3, 0, LANGS, None)
    pools = [drawn.pool(lang, PLATFORM) for lang in LANGS]
    whole = [one for one in questions(quiz(*pools)) if one[0] != "category"]
    slotted = [pool.sections[1] for pool in pools]
    largest = max(
        len(
            quiz(
                *(
                    replace(pool, sections=(replace(s, items=s.items[k : k + 1]),))
                    for pool, s in zip(pools, slotted, strict=True)
                )
            )
        )
        for k in range(3)
    )
    monkeypatch.setattr(moodle, "_LARGEST_FILE", 2 * largest)
    files = {str(file.path): b"".join(file.make()) for file in PLATFORM.files_of(pools)}
    assert [*files] == [f"coursework.en-fr.{k}.xml" for k in range(1, len(files) + 1)]
    assert len(files) > 1
    assert max(map(len, files.values())) < 2 * largest + 1000
    assert [one for data in files.values() for one in questions(data) if one[0] != "category"] == whole
    assert all(next(questions(data))[0] == "category" for data in files.values())


def test_texts_come_in_one_piece():
    """Moodle's reader drops a piece of white space between two entities: a text that holds tags is one
    section."""
    data = written_of(of_exercises(COURSE, ["slotted_mechanism"], 1, 0, ("fr",), None), "fr")
    outside, inside = [], []
    reader = expat.ParserCreate()
    reader.StartCdataSectionHandler = lambda: inside.append(True)
    reader.EndCdataSectionHandler = inside.clear
    reader.CharacterDataHandler = lambda text: outside.append(text) if not inside else None
    reader.Parse(data, True)
    assert not any("<" in piece or ">" in piece for piece in outside)


@each_row(
    "text",
    [
        "}",
        "~",
        "#",
        '"',
        "&amp;",
        "=",
        "%50%",
        "\\",
        "a\\}b",
        "a\\#b",
        "x~%100%y#z}",
        "&amp;#35;",
        "{1:SA:=x}",
        "5 &lt; 6",
    ],
)
def test_what_stands_in_an_answer_comes_back_as_it_was(text):
    """HTML is compared as a browser shows it: a backslash may be written by its number."""
    (box,), _ = boxes_of(f"{{1:MULTICHOICE_V:={escaped('a' + text)}~b{escaped(text)}#{escaped(text)}}}")
    assert [one.text.replace("&#92;", "\\") for one in box.answers] == [f"a{text}", f"b{text}"]
    assert box.answers[1].says.replace("&#92;", "\\") == text


HOSTILE = 'a } brace, 50% ~ # "quoted" & 1 = 2 {1:NUMERICAL:=3} \\ ]]> <b> / {#1}'


def test_hostile_words_of_a_course_open_no_box(small_course):
    """Braces, tildes, hashes, slashes of statement, options and titles are what students read."""
    for lang in LANGS:
        path = small_course / "exercises" / f"crank_pin.{lang}.md.j2"
        path.write_text(
            f"{{% raw %}}{path.read_text('utf-8')}{{% endraw %}}".replace(
                "\n\n", f"\n\n{_markdown(HOSTILE)} ", 1
            ),
            "utf-8",
        )
    course = coursework.open_course(small_course)
    drawn = of_exercises(course, ["crank_pin"], 2, 0, LANGS, None)
    category, *found = questions(written_of(drawn, "en", title="Week 3/4"))
    assert "/top/Week 3//4/" in category[1]
    for (_, _, text, _), variant in zip(found, drawn.variants[0], strict=True):
        boxes, around = boxes_of(text)
        given = item(variant.in_language("en"), "pool")
        assert [len(box.answers) for box in boxes] == [len(posed.intervals) for posed in given.questions]
        assert "{1:NUMERICAL:=3}" not in text
        assert "&#123;1:NUMERICAL:=3&#125;" in "".join(around)


def _markdown(text):
    return re.sub(r"([\\`*_{}\[\]<>#~])", r"\\\1", text)


def _interval(value, half):
    return Interval(value - half, value + half, value)


@each_row(
    ("value", "half", "shown"),
    [
        (238.43712345, 2.3843712345, "238.437"),
        (3, 0, "3"),
        (12345678.25, 0, "12345678.25"),
        (1e-17, 0.01, "0"),
        (-0.00023812345678, 2.4e-6, "-0.000238123"),
        (0.1234567891, 1e-7, "0.1234567891"),
        (-51234.5678, 500, "-51234.6"),
        (1.5e9, 1e7, "1500000000"),
    ],
)
def test_numbers_are_shown_short_and_keep_their_interval(value, half, shown):
    text, margin = numerical(_interval(value, half))
    assert text == shown
    assert "e" not in text + margin or not half
    assert float(text) - float(margin) <= value - half
    assert value + half <= float(text) + float(margin)


def test_weights_are_whole_where_points_are_not(tmp_path):
    """Halves and thirds of points keep their proportions."""
    from coursework.platforms.moodle import _scale

    assert [_scale(points) for points in ((1, 2), (0.5, 1), (1 / 3, 1), (0.25, 0.1))] == [1, 2, 3, 20]
