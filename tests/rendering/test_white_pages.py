"""No page of a paper but the last is white by more than a quarter of its height, and no data stand before
their exercise."""

import random
import re

import numpy as np
import pypdfium2
import pytest
from paper_samples import COURSE, heading, paper, solution
from pdf_links import wrong_references

from coursework.errors import BadStatement
from coursework.language.words import words
from coursework.rendering import pdf, views
from coursework.rendering.renderer import renderer_of
from coursework.selfstudy.workbook.binding import bound

RENDERER = renderer_of(COURSE.folder)
MOST = 0.25


def white(page) -> float:
    """The largest share of a page's height without any ink."""
    grey = page.render(scale=0.8, grayscale=True).to_numpy()
    inked = np.flatnonzero((grey.reshape(grey.shape[:2]) < 252).any(axis=1))
    return float(np.diff(inked).max() / len(grey)) if len(inked) > 1 else 1.0


def covered(page) -> int:
    """How many letters have no ink in the lower third of their height, since something white lies on them."""
    scale, height, text = 2, page.get_height(), page.get_textpage()
    ink = page.render(scale=scale, grayscale=True).to_numpy()
    ink = ink.reshape(ink.shape[:2]) < 200
    count = 0
    for at in range(text.count_chars()):
        left, foot, right, top = text.get_charbox(at)
        if text.get_text_range(at, 1) not in "aeuonrtmscdhbil" or right - left < 1.5 or top - foot < 3:
            continue
        upper, lower = (int(scale * (height - y)) for y in (foot + (top - foot) / 3, foot))
        count += not ink[upper : lower + 1, int(scale * left) : int(scale * right) + 1].any()
    return count


def places(pages, said: str) -> list[tuple[int, float]]:
    """Where a text stands: its page, and how far up its foot is, counted downwards."""
    found = []
    for number, page in enumerate(pages):
        text = page.get_textpage()
        search = text.search(said, match_case=True)
        while (at := search.get_next()) is not None:
            found.append((number, -text.get_charbox(at[0])[1]))
    return found


@pytest.mark.parametrize(
    "seed",
    [pytest.param(k, marks=() if k in (1, 4, 16, 25) else pytest.mark.slow) for k in range(40)],
)
def test_no_page_but_the_last_is_white_by_more_than_a_quarter(seed):
    names = tuple(random.Random(seed).sample(COURSE.names, 4))
    made = paper(heading(("fr", "en")[seed % 2]), names, seed=seed)
    pages = list(pypdfium2.PdfDocument(RENDERER.pdf(made)))
    assert {n: share for n, page in enumerate(pages[:-1], 1) if (share := white(page)) > MOST} == {}, names
    said = words(made.heading.lang)
    heads = [
        place
        for number, sheet in enumerate(made.handouts, 1)
        for place in places(pages, said["paper"]["numbered"].format(number, ""))
        if sheet.given
    ]
    data = places(pages, said["sheet"]["data"])
    assert len(data) == len(heads)
    assert all(head < place for head, place in zip(heads, sorted(data), strict=True)), names


#: Pages of the book that are white by more than a quarter: of the students' volume and of the solutions.
#: Before questions of solutions could be cut and summaries shared a page there were 19 and 15 in English, 17
#: and 22 in French. The title page is one, and the end of the contents may be.
WHITE = {"en": (6, 7), "fr": (7, 9)}


@pytest.mark.slow
@pytest.mark.parametrize("lang", WHITE)
def test_the_whole_book_has_few_white_pages_and_each_reference_names_its_page(lang):
    book = bound(COURSE, lang, solved=False, answers="odd")
    volumes = [RENDERER.book_pdf(book, apart=apart) for apart in (False, True)]
    wrong, count = wrong_references(volumes[0])
    assert (wrong, count > 1000) == ([], True)
    assert list(out_of_turn(volumes[0])) == []
    if lang == "en":
        texts = [page.get_textpage().get_text_bounded() for page in pypdfium2.PdfDocument(volumes[0])]
        assert list(led_astray(texts)) == []
    assert {
        n: letters
        for volume in volumes
        for n, page in enumerate(pypdfium2.PdfDocument(volume), 1)
        if (letters := covered(page)) > 1
    } == {}
    found = [sum(white(page) > MOST for page in pypdfium2.PdfDocument(volume)) for volume in volumes]
    assert all(count <= most for count, most in zip(found, WHITE[lang], strict=True)), found


def test_a_drawing_to_scale_lies_on_none_of_the_words_before_it(monkeypatch):
    """As solutions of a book print it, where it may move to the next page."""
    context = views.context
    monkeypatch.setattr(views, "context", lambda *of, **how: context(*of, **how) | {"moving": "-"})
    solved = solution(heading("fr"), ("velocity_polygon", "four_bar_motion"))
    pages = pypdfium2.PdfDocument(RENDERER.pdf(solved))
    assert {n: letters for n, page in enumerate(pages, 1) if (letters := covered(page)) > 1} == {}


def out_of_turn(volume):
    """The figures of lessons that stand above one with a smaller number, with their page."""
    last = {}
    for number, page in enumerate(pypdfium2.PdfDocument(volume), 1):
        told = re.findall(r"^Figure (\d+)\.(\d+)\.", page.get_textpage().get_text_range(), re.MULTILINE)
        stand = sorted((places([page], f"Figure {lesson}.{k}.")[0][1], lesson, int(k)) for lesson, k in told)
        for _, lesson, k in stand:
            if k < last.get(lesson, 0):
                yield number, f"{lesson}.{k}"
            last[lesson] = k


def led_astray(texts):
    """The references to lessons, sections and exercises that name a page on which their heading does not
    stand."""
    heads = [{" ".join(line.split()) for line in text.splitlines()} for text in texts]
    references = re.findall(r"\((lesson|exercise) ([\d.]+)(?: §(\d+))?,\s+p\.\s+(\d+)\)", "\n".join(texts))
    assert len(references) > 100
    for sort, number, section, page in references:
        head = f"{section}. " if section else f"{sort.capitalize()} {number}. "
        if not any(line.startswith(head) for line in heads[int(page) - 1]):
            yield sort, number, section, page


UNSETTLED = """
#let settled = (:)
#let depth() = query(<told>).map(one => one.location().position().y).at(0, default: 0pt)
#let in-room(number: none) = context {
  let kept = if number in settled { settled.at(number).first() } else { depth() > 200pt }
  [#metadata((number, kept, 0.0))<chosen>]
  if not kept { v(200pt) }
}
//=
#set document(title: "-")
#set text(lang: "en")
#in-room()
#context [#metadata(none)<told> at #depth().pt()]
"""


def test_what_a_page_says_of_a_place_is_so_where_layouts_do_not_settle():
    """What moves since it stands high, and back since it stands low, is left where it was last."""
    page = pypdfium2.PdfDocument(pdf.compile_settled(UNSETTLED))[0]
    text = page.get_textpage()
    told = float(text.get_text_range().removeprefix("at "))
    assert page.get_height() - text.get_charbox(0)[3] == pytest.approx(told, abs=12)


def test_what_a_part_of_a_document_chooses_hangs_on_no_other():
    """A block that would move since another part has a mark stays where it is: each part chooses alone."""
    start = UNSETTLED.partition("#in-room()")[0]
    start = start.replace("depth() > 200pt", "query(<told>).len() < 2").replace("200pt", "300pt")
    part = (
        "\n//#\n#pagebreak(weak: true)\n#in-room()\n#context [#metadata(none)<told> at "
        "#here().position().y.pt()]"
    )
    pages = [
        [page.get_textpage().get_text_range() for page in pypdfium2.PdfDocument(pdf.compile_settled(source))]
        for source in (start + part, start + part + part)
    ]
    assert pages[1] == 2 * pages[0]


NEVER_SETTLED = (
    UNSETTLED.partition("//=")[0]
    + """
//=
#set document(title: "-")
#set text(lang: "en")
#context if query(<told>) == () [#metadata(none)<told>]
"""
)


def test_a_document_whose_references_never_settle_is_refused():
    """What stands there since it does not stand there has no place that a reference could name."""
    with pytest.raises(BadStatement, match="references would name wrong pages"):
        pdf.compile_settled(NEVER_SETTLED)
