"""Lessons on the site: every piece in steps, links that lead somewhere, blanks that are marked as in a
notebook."""

import gzip
import re
from functools import cache
from html import unescape
from itertools import product
from threading import Thread

import pytest
from site_people import MAX, ZOE, Class
from site_practising import BOX, Practising, right_answer, words_of
from site_walk import EXERCISE, Filled
from sweeps import sampled
from tables import each_row

import coursework
from coursework.course.lessons import lesson_sections, taught_by
from coursework.errors import BadCourse
from coursework.language.words import words
from coursework.markup.markdown import html_inline
from coursework.rendering.books import LessonPages
from coursework.rendering.html import environment_of
from coursework.rendering.lesson_steps import stepped, steps
from coursework.selfstudy.workbook.lessons import explained_mistakes, lesson_text
from coursework.sheets.book import BlanksPiece, HeadPiece, LaterPiece, ProsePiece
from coursework.site import warming
from coursework.site.lessons import lesson_content

LESSON = "positions"
COURSE = coursework.open_course()
every_lesson = pytest.mark.parametrize("name", sampled(COURSE.folder.lessons, (LESSON,)))


@pytest.fixture(scope="module")
def class_(tmp_path_factory):
    return Class(f"sqlite:///{tmp_path_factory.mktemp('lessons')}/site.db")


@pytest.fixture(scope="module")
def zoe(class_):
    return class_.browser(ZOE)


# ----------------------------------------------------------------------- every lesson


@cache
def text_in(name, lang):
    return lesson_text(COURSE, name, lang)


@cache
def in_steps(name, lang):
    """A lesson of the site, the text of its steps, and the identifiers of their sections and figures."""
    env = environment_of(COURSE.folder.template_folders, lang)
    lesson = stepped(env, text_in(name, lang), lesson_content._address, "/figures")
    html = "".join(step.html + step.below for step in lesson.steps)
    return lesson, html, re.findall(r' id="([^"]+)"', html)


@every_lesson
@pytest.mark.parametrize("lang", COURSE.folder.languages)
def test_a_lesson_in_steps_says_all_that_its_book_page_says_and_leads_somewhere(name, lang):
    """Rendered here rather than by the site, which adds nothing but the frame: the next test."""
    text = text_in(name, lang)
    env = environment_of(COURSE.folder.template_folders, lang)
    lesson, html, ids = in_steps(name, lang)
    book = LessonPages(env, text, lesson_content._address).html(
        [piece for piece in text.pieces if not isinstance(piece, BlanksPiece)]
    )
    assert words_of(html).split() == words_of(book).split()
    assert len(re.findall("<img", html)) == len(re.findall("<img", book))
    assert len(ids) == len(set(ids))
    for address in re.findall(r'href="([^"]+)"', html):
        path, _, anchor = address.partition("#")
        kind, _, target = path.partition("?")[0].strip("/").partition("/")
        if path.startswith("http"):
            continue
        assert target in {"practice": COURSE.names, "lessons": COURSE.folder.lessons}[kind], address
        assert not anchor or anchor in in_steps(target, lang)[2], address
    for number in lesson_sections(COURSE.folder, name, lang):
        assert f"section-{number}" in ids
    for file in re.findall(r'src="/figures/([^"]+)"', html):
        assert lesson.figures[file].startswith(b"<svg")
    moving = [
        file for file in re.findall(r'src="/figures/([^"]+)"', html) if b"<animate" in lesson.figures[file]
    ]
    stills = re.findall(r'data-still="/figures/([^"]+)"', html)
    assert len(stills) == len(moving)
    assert not [file for file in stills if b"<animate" in lesson.figures[file]]
    assert "data:image" not in html


@every_lesson
def test_a_step_holds_one_idea(name):
    """A heading begins one, an answer ends one, and what poses an example to complete stays together."""
    made = list(steps(text_in(name, "en").pieces))
    for step in made:
        kinds = [type(piece) for piece in step]
        heads = [k for k, kind in enumerate(kinds) if kind is HeadPiece]
        assert heads == list(range(len(heads)))
        assert LaterPiece not in kinds[:-1] or set(kinds[kinds.index(LaterPiece) :]) == {LaterPiece}
        assert not (kinds[-1] is ProsePiece and step[-1].text.rstrip().endswith(":")) or step is made[-1]
    assert len(made) > len(lesson_sections(COURSE.folder, name, "en"))


# ------------------------------------------------------------------------- the page


@pytest.mark.parametrize("lang", ["en", "fr"])
@pytest.mark.e2e
def test_a_lesson_stands_on_the_site_with_its_figures_and_leads_to_its_exercises(class_, lang):
    browser = class_.browser(ZOE, lang)
    page = browser.get(f"/lessons/{LESSON}?whole").text
    at_end = page[page.index('class="step lesson-end"') :]
    taught = [
        n for n in COURSE.folder.in_order if LESSON in [x.name for x in taught_by(COURSE.folder, n, lang)]
    ]
    assert re.findall(r'href="/practice/(\w+)"', at_end) == taught
    numbers = [int(n) for n in re.findall(r'id="step-(\d+)"', page)]
    assert numbers == list(range(1, len(numbers) + 1))
    for anchor in re.findall(r'<li><a href="#([^"]+)"', page):
        assert f'id="{anchor}"' in page
    figure = browser.get(re.search(r'src="(/lessons/[^"]+)"', page)[1])
    assert figure.headers["content-type"].startswith("image/svg+xml")
    assert "immutable" in figure.headers["cache-control"]
    assert words(lang, "site")["lessons"]["contents"] in page


#: Kilobytes of a lesson's page at most, as the site compresses it: every time, and of a part of its steps,
#: once.
PAGE_KB, STEPS_KB = 5, 18


@every_lesson
@pytest.mark.parametrize("lang", COURSE.folder.languages)
@pytest.mark.e2e
def test_a_lesson_seen_before_weighs_little_for_its_steps_are_kept(class_, name, lang):
    def sent(address):
        reply = browser.get(address, headers={"accept-encoding": "gzip"})
        assert reply.headers["content-encoding"] == "gzip"
        return reply, len(gzip.compress(reply.content, 6)) / 1000

    browser = class_.browser(ZOE, lang)
    page, size = sent(f"/lessons/{name}")
    assert size < PAGE_KB
    assert "no-store" in page.headers["cache-control"]
    whole = re.sub(r'<input type="hidden" name="_seal"[^>]*>', "", browser.get(f"/lessons/{name}?whole").text)
    numbers = []
    for part in re.search(r' data-steps="([^"]+)"', page.text)[1].split():
        steps, size = sent(part)
        assert size < STEPS_KB
        assert "immutable" in steps.headers["cache-control"]
        assert "_seal" not in steps.text
        assert whole.find(steps.text.strip()) > 0
        numbers += re.findall(r'class="step" id="step-(\d+)"', steps.text)
    count = int(re.search(r' data-count="(\d+)"', page.text)[1])
    assert numbers == [str(number) for number in range(1, count + 1)]
    assert f'content="0; url=/lessons/{name}?whole"' in page.text


@each_row(
    "address", ["positions/steps/none", "no_such", "positions/figures/none.svg", "no_such/figures/none.svg"]
)
@pytest.mark.e2e
def test_other_addresses_of_lessons_lead_nowhere(zoe, address):
    assert zoe.get(f"/lessons/{address}").status_code == 404


def test_a_lesson_is_rendered_once_however_many_ask_at_once(tmp_path, monkeypatch):
    class_, made = Class(f"sqlite:///{tmp_path}/site.db"), []

    def rendered(course, name, lang):
        made.append((name, lang))
        if len(made) == 1:
            raise BadCourse("out of reach")
        return lesson_content.SteppedLesson(name, (), {})

    monkeypatch.setattr(lesson_content, "_rendered", rendered)
    with pytest.raises(BadCourse):
        lesson_content.lesson_of(class_.site, LESSON, "en")
    threads = [Thread(target=lesson_content.lesson_of, args=(class_.site, LESSON, "en")) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert made == [(LESSON, "en")] * 2  # the fault, and once more for all


@each_row("has_worker", [True, False])
def test_lessons_are_ready_ahead_where_a_worker_marks(class_, monkeypatch, has_worker):
    monkeypatch.setattr(class_.site, "has_worker", has_worker)
    made = []
    monkeypatch.setattr(warming, "lesson_of", lambda site, name, lang: made.append((name, lang)))
    for piece in warming._pieces(class_.site):
        if piece.func is warming.lesson_of:
            piece()
    every = {(name, lang) for name in COURSE.folder.lessons for lang in COURSE.folder.languages}
    assert set(made) == (every if has_worker else set())


# ------------------------------------------------------------------- blanks of examples


def blanks(page):
    """The forms of a page's examples: the number, and the names of the boxes."""
    forms = re.findall(r'<form class="blanks"[^>]*>.*?</form>', page, re.DOTALL)
    return [
        (re.search(r'name="example" value="(\d+)"', form)[1], re.findall(r'name="(blank-[^"]+)"', form))
        for form in forms
    ]


@each_row("script", [True, False])
def test_a_blank_is_marked_as_in_a_notebook(zoe, script):
    asked = ("a", "b", "c", "theta3_open", "theta4_open", "theta3_crossed", "theta4_crossed")
    example = coursework.worked("four_bar_positions", seed=38, lang="en", level=4, parts=asked)
    number, boxes = blanks(zoe.get(f"/lessons/{LESSON}?whole").text)[-1]
    keys = [box.removeprefix("blank-") for box in boxes]
    assert set(keys) == set(example._keys.values())
    walk = example.variant.walk
    answers = {key: f"{walk[part.quantity]:.6g}" for part, key in zip(example.parts, keys, strict=True)}
    answers |= {keys[1]: "12", keys[2]: "", keys[3]: "12 apples"}
    headers = {"hx-request": "true"} if script else {}
    form = {"_seal": zoe.seal, "example": number, **{f"blank-{key}": text for key, text in answers.items()}}
    reply = zoe.post(f"/lessons/{LESSON}", data=form, headers=headers)
    told = reply.text
    if not script:
        told = zoe.get(reply.headers["location"].partition("#")[0]).text
        assert f'name="blank-{keys[1]}" value="12"' in told
        told = re.search(rf'id="checked-{number}".*?</div>', told, re.DOTALL)[0]
    notebook = example.check({key: text for key, text in answers.items() if text}).pieces[0]
    lines = [line for line in notebook.splitlines() if line.startswith("- ")]
    signs = re.findall(r'told-sign" aria-hidden="true">(.)</span> <strong>(\d+)\.', told)
    assert [sign for sign, _ in signs] == [line[2] for line in lines]
    assert [number for _, number in signs] == ["1", "2", "4", "5", "6", "7"]
    assert not [line for line in lines if html_inline(line.partition(" — ")[2], "en") not in told]


def test_all_right_is_said_and_nothing_typed_too(zoe):
    number, boxes = blanks(zoe.get(f"/lessons/{LESSON}?whole").text)[0]
    example = coursework.worked(
        "four_bar_positions",
        seed=234,
        lang="en",
        level=2,
        parts=("a", "b", "c", "theta3_open", "theta4_open", "theta3_crossed", "theta4_crossed"),
    )
    right = {
        box: f"{example.variant.walk[part.quantity]:.6g}"
        for box, part in zip(boxes, example.left, strict=True)
    }
    form = {"_seal": zoe.seal, "example": number}
    script = {"hx-request": "true"}
    assert "Everything is right." in zoe.post(f"/lessons/{LESSON}", data=form | right, headers=script).text
    del right[boxes[0]]
    assert "Everything" not in zoe.post(f"/lessons/{LESSON}", data=form | right, headers=script).text
    assert "Write an answer first." in zoe.post(f"/lessons/{LESSON}", data=form, headers=script).text
    place = zoe.post(f"/lessons/{LESSON}", data=form).headers["location"]
    assert place.endswith(f"#blanks-{number}")
    assert "Write an answer first." in zoe.get(place).text
    assert "Write an answer first." not in zoe.get(f"/lessons/{LESSON}?whole").text


def test_an_example_that_was_checked_stands_as_it_was_left_on_every_device(class_):
    """Of the person alone, in either form of the page, in the language of the reader, as long as the lesson
    has the example."""
    number, boxes = blanks(class_.browser(MAX).get(f"/lessons/{LESSON}?whole").text)[0]
    mine = class_.browser(MAX)
    mine.post(f"/lessons/{LESSON}", data={"_seal": mine.seal, "example": number, boxes[0]: "13 pears"})
    for lang, end in product(("en", "fr"), ("", "?whole")):
        page = class_.browser(MAX, lang).get(f"/lessons/{LESSON}{end}").text
        form = next(
            one for one in re.findall(r'<form class="blanks".*?</form>', page, re.DOTALL) if "13 pears" in one
        )
        assert "pears" in form.partition('class="told"')[2]
        assert page.count('value="13 pears"') == 1
    assert "13 pears" not in class_.browser(ZOE).get(f"/lessons/{LESSON}").text
    mine.post(f"/lessons/{LESSON}", data={"_seal": mine.seal, "example": number, boxes[0]: ""})
    assert "data-checked" not in mine.get(f"/lessons/{LESSON}").text


@each_row("example", ["0", "1", "-1", "9999", "x", "١", "", "4" * 300])
def test_a_form_marks_no_variant_but_those_of_the_lesson(zoe, example):
    form = {"_seal": zoe.seal, "example": example, "exercise": "grashof", "seed": "1", "blank-a": "1"}
    assert zoe.post(f"/lessons/{LESSON}", data=form).status_code == 400


def test_what_else_a_form_names_changes_nothing_that_is_marked(zoe):
    number, boxes = blanks(zoe.get(f"/lessons/{LESSON}?whole").text)[0]
    form = {"_seal": zoe.seal, "example": number, boxes[0]: "12"}
    script = {"hx-request": "true"}
    plain = zoe.post(f"/lessons/{LESSON}", data=form, headers=script).text
    more = {"exercise": "slotted_mechanism", "seed": "8", "level": "4", "parts": "rA", "blank-rA": "1"}
    assert zoe.post(f"/lessons/{LESSON}", data=form | more, headers=script).text == plain


# ------------------------------------------------------------------------ what leads to lessons


def test_an_exercise_its_hints_and_its_mistakes_lead_to_the_sections_that_help(class_, zoe):
    one = Practising(class_, zoe, "four_bar_positions")
    links = re.compile(r'href="/lessons/(\w+)\?whole#section-(\d+)"')
    head = one.page().partition('<form id="sheet"')[0]
    lesson, *_ = taught_by(COURSE.folder, "four_bar_positions", "en")
    assert set(links.findall(head)) == {(lesson.name, number) for number, _ in lesson.places}
    part = next(part for part in one.variant.parts if part.quantity == "theta4_open")
    hinted = one.send({}, hint=part.id).text
    hints = hinted.partition(f'<div id="hints-{BOX}{part.id}"')[2].partition("</li>\n<li>")[0]
    assert set(links.findall(hints)) == {(lesson.name, number) for number, _ in lesson.places}
    wrong = dict(one.variant.key.wrong_ways("theta4_open"))["notes_c_sign"]
    page = one.send({part.id: f"{wrong:.3f}"}, check=part.id).text
    told = re.search(rf'<div id="told-{BOX}{part.id}".*?</div>', page, re.DOTALL)[0]
    name, number = explained_mistakes(COURSE, "en")["four_bar_positions", "notes_c_sign"]
    assert links.findall(told) == [(name, str(number))] == [("positions", "12")]


def test_feedback_leads_to_the_lessons_of_what_lost_points(tmp_path):
    site = Filled(f"sqlite:///{tmp_path}/site.db")
    page = site.browser(ZOE).get(f"/assignments/{site.number}/feedback").text
    again = page.partition("<h2>To read again</h2>")[2].partition("</section>")[0]
    taught = taught_by(COURSE.folder, EXERCISE, "en")
    assert set(re.findall(r'href="/lessons/(\w+)\?whole#section-(\d+)"', again)) == {
        (lesson.name, number) for lesson in taught for number, _ in lesson.places
    }


@pytest.mark.parametrize("lang", COURSE.folder.languages)
def test_mistakes_that_lessons_explain_are_found_where_they_stand(lang):
    found = explained_mistakes(COURSE, lang)
    source = {
        n: (COURSE.folder.lesson_place / f"{n}.{lang}.md").read_text("utf-8") for n in COURSE.folder.lessons
    }
    assert len(found) > 40
    for (exercise, mistake), (lesson, section) in found.items():
        parts = re.split(r"^## ", source[lesson], flags=re.MULTILINE)
        text = next(part for part in parts if part.startswith(f"{section}."))
        assert f'"{exercise}"' in text
        assert f'"{mistake}"' in text
        assert mistake in COURSE[exercise].solution.mistakes


# ------------------------------------------------------------------------ the course page


def test_the_course_page_shows_chapters_with_figure_lessons_and_what_is_done(class_):
    browser = class_.browser(MAX)
    page = browser.get("/practice").text
    cards = re.findall(r'<details class="chapter".*?</details>', page, re.DOTALL)
    chapters = COURSE.folder.chapters
    assert [tuple(re.findall(r'href="/lessons/(\w+)"', card)) for card in cards] == [
        c.lessons for c in chapters
    ]
    assert [tuple(re.findall(r'href="/practice/(\w+)"', card)) for card in cards] == [
        c.exercises for c in chapters
    ]
    for card, chapter in zip(cards, chapters, strict=True):
        drawn = re.search(r'chapter-figure" aria-hidden="true">(.*?)</span>', card, re.DOTALL)[1]
        assert bool(drawn) == bool(chapter.exercises)
        assert len(drawn) < 5000
    assert page.count('<span class="visually-hidden">not begun') == len(COURSE.folder.in_order)


def test_who_has_all_right_is_told_what_was_learned_what_comes_and_how_far_the_chapter_is(class_):
    one = Practising(class_, class_.browser(MAX), "two_circles")
    page = one.send({p.id: right_answer(one.variant, p) for p in one.variant.parts}, check="").text
    summary = words_of(re.search(r'<section id="summary".*?</section>', page, re.DOTALL)[0])
    title = one.variant.text.title
    assert f"You can now solve “{title}”." in unescape(summary)
    chapter = next(c for c in COURSE.folder.chapters if "two_circles" in c.exercises)
    assert f"{chapter.title('en')} : done: 1 of {len(chapter.exercises)}" in summary
    order = list(COURSE.folder.study_order)
    follows = order[1 + order.index("two_circles")]  # though nothing of the first chapter was begun
    assert f'<a class="button main" href="/practice/{follows}">Next exercise' in page
    card = re.search(
        rf'id="chapter-{chapter.number}".*?</summary>', class_.browser(MAX).get("/practice").text, re.DOTALL
    )[0]
    assert 'value="1"' in card
    assert f"done: 1 of {len(chapter.exercises)}" in card
    assert "next: " in card


def test_a_place_in_a_lesson_is_kept_with_the_account_and_the_latest_counts(class_):
    address = f"/lessons/{LESSON}"
    first, second, other = class_.browser(ZOE), class_.browser(ZOE), class_.browser(MAX)
    assert first.fill(address, {"place": "7/46/2000"}).status_code == 204
    assert (
        second.fill(address, {"place": "3/46/1000"}).status_code == 204
    )  # of a telephone that had no network
    page = second.get("/practice").text
    assert f'data-place-of="{LESSON}" data-place="7/46/2000"' in page
    assert page.count('data-place=""') > 5
    assert "7/46" not in other.get("/practice").text
    assert second.fill(address, {"place": "8/46/3000"}).status_code == 204
    assert f'data-lesson="{LESSON}" data-place="8/46/3000"' in first.get(address).text
    for wrong in ("", "0/46/1", "8/46", "8/46/1/2", '"><b>', "8/46/" + "9" * 16):
        assert first.fill(address, {"place": wrong}).status_code == 400
    assert first.fill("/lessons/none", {"place": "1/2/3"}).status_code == 404
    assert first.post(address, data={"place": "9/46/9000"}).status_code == 403  # from another site
    assert "8/46/3000" in first.get("/practice").text
