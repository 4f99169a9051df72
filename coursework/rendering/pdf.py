"""Sheets as PDF, through Typst."""

from __future__ import annotations

import json
import re
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import lru_cache, partial
from itertools import count
from pathlib import Path
from typing import Any

from jinja2 import Environment
from markupsafe import Markup

from coursework.errors import BadStatement, bare_letters
from coursework.figures import Beginning, Figure, Picture
from coursework.figures.text import SIZE
from coursework.figures.writing import Letters
from coursework.language.numbers import rounded
from coursework.markup import markdown as markup
from coursework.markup.spoken import spoken
from coursework.markup.typst import to_typst
from coursework.rendering import answer_pages, feedback, views
from coursework.rendering.environment import environment, render
from coursework.sheets.sheet import AnswerSheet, FeedbackSheet
from coursework.system.memory import little_memory

_LOCAL = threading.local()
_TAGGED: Mapping[str, Any] = {"format": "pdf", "pdf_standards": ["a-2a", "ua-1"], "timestamp": 0}
#: Where a block begins that moves to where there is room.
_MOVING = re.compile(r"#(?:in-room|lesson-figure)\(")
_SETTLED = re.compile(r"^#let settled = .*$", re.MULTILINE)
_GUESSED = re.compile(r"^#let guessed = .*$", re.MULTILINE)
_PART = "\n//#\n"  #: above each part of a document that begins on a page of its own
_UNLINKED = "\n#let link(place, body) = body"  #: in a part alone: what it links to may stand in another
_LAYOUTS = 4  #: of a part whose blocks move
_FORGETTING = 40  #: documents, a third of a millisecond each


def source(folders: Sequence[Path], sheets: Sequence[views.Sheet], paper: str = "a4") -> str:
    """Return the Typst source of one document that holds these sheets, each from an odd page on.

    Feedback is read on a screen: its sheets follow one another without a blank page.
    """
    contexts = [_context(folders, sheet) for sheet in sheets]
    bodies = [
        Markup(
            render(
                environment_of(tuple(folders), names["lang"]), f"{views.TEMPLATES[type(sheet)]}.typ.j2", names
            )
        )
        for sheet, names in zip(sheets, contexts, strict=True)
    ]
    printed = not isinstance(sheets[0], FeedbackSheet)
    page = contexts[0] | {"bodies": bodies, "paper": paper, "printed": printed}
    if any(isinstance(sheet, FeedbackSheet) for sheet in sheets):
        page["answer_mm"] = feedback.ANSWER_MM
    return render(environment_of(tuple(folders), page["lang"]), "parts/page.typ.j2", page)


def _context(folders: Sequence[Path], sheet: views.Sheet) -> dict[str, Any]:
    """Return the names that a sheet's template sees."""
    env = environment_of(tuple(folders), views.handout_of(sheet).lang)
    if isinstance(sheet, FeedbackSheet):
        return feedback.context(sheet, "typ.j2", partial(render, env))
    if isinstance(sheet, AnswerSheet):
        return views.context(sheet)
    names = answer_pages.names([sheet], sheet.title, sheet.student, sheet.lang, partial(render, env))
    return views.context(sheet) | names


# ------------------------------------------------------------------------ fonts


def fonts_of(folders: Sequence[Path]) -> tuple[str, ...]:
    """Return the folders of fonts that a course brings, ``fonts`` in its templates: for letters that the
    typesetter's own fonts lack. The system's fonts are never asked, so that a sheet is the same
    everywhere."""
    return tuple(str(folder / "fonts") for folder in folders if (folder / "fonts").is_dir())


def drawn(typst_source: str, folders: Sequence[Path]) -> str:
    """Return the source with a square for each character that no font at hand draws."""
    return markup.drawable(typst_source, partial(_has_glyph, fonts_of(folders)))


def undrawn(text: str, folders: Sequence[Path]) -> list[str]:
    """Return the characters of a text that no font at hand draws, each once."""
    return markup.undrawn(text, partial(_has_glyph, fonts_of(folders)))


@lru_cache(maxsize=16_384)
def _has_glyph(fonts: tuple[str, ...], char: str) -> bool:
    """Return whether a course's fonts draw a character: the standard of the PDF refuses one that has no
    glyph."""
    import typst

    if not fonts or not char.isprintable():
        return False
    page = f'#set document(title: "-")\n#set text(lang: "en")\n#"\\u{{{ord(char):x}}}"'
    try:
        _compiler(fonts).compile(input=page.encode(), format="pdf", pdf_standards=["ua-1"], timestamp=0)
    except typst.TypstError:
        return False
    return True


def _compiler(fonts: tuple[str, ...]) -> Any:
    """Return the compiler of this thread, which is kept since it reads the fonts once."""
    import typst

    compilers = _LOCAL.__dict__.setdefault("compilers", {})
    if fonts not in compilers:
        compilers[fonts] = typst.Compiler(font_paths=list(fonts), ignore_system_fonts=True)
    return compilers[fonts]


_DEFINITIONS_END = "\n//=\n"
_PIECE_START, _PIECE_END = "//(\n", "\n//)\n"
_EMPTY = "//)\n"  #: where a piece starts with its end


def files(typst_source: str) -> dict[str, bytes]:
    """Return a source cut into files: ``main.typ``, the definitions, and the pieces that main includes.

    What the typesetter remembers of a layout holds for one place in one file: of one file, nothing would be
    remembered below the first place where two sheets differ.
    """
    definitions, cut, rest = typst_source.partition(_DEFINITIONS_END)
    if not cut:
        return {"main.typ": typst_source.encode()}
    opening = '#import "definitions.typ": *\n'
    sources = {"definitions.typ": definitions.encode()}
    first, *marked = rest.split(_PIECE_START)
    main = [opening, first]
    for figure in marked:
        if figure.startswith(_EMPTY):
            main.append(figure.removeprefix(_EMPTY))
            continue
        piece, _, after = figure.partition(_PIECE_END)
        name = f"{len(sources)}.typ"
        sources[name] = (opening + piece).encode()
        main += [f'#include "{name}"\n', after]
    sources["main.typ"] = "".join(main).encode()
    return sources


def compile_pdf(typst_source: str, folders: Sequence[Path] = ()) -> bytes:
    """Return the tagged PDF (PDF/UA-1 and PDF/A-2a) of a Typst source; the same bytes for the same source and
    fonts.

    ``folders`` of templates bring fonts of their own; a character that no font draws is a square.

    What the course's own template may have got wrong is said as :class:`BadStatement`.
    """
    with _complaints():
        return _written(_compiler(fonts_of(folders)), files(drawn(typst_source, folders)))


def compile_settled(typst_source: str, folders: Sequence[Path] = ()) -> bytes:
    """Return the PDF of a source whose blocks move to the next page where they find no room, as
    :func:`compile_pdf` does.

    Where blocks move is chosen from layouts of each part alone, so that a change in one moves nothing in
    another. Then the whole is laid out with these choices, and only its page numbers have to settle.

    Raises BadStatement as :func:`compile_pdf` does, and where page numbers do not settle though no block
    moves any more.
    """
    counter = count(1)
    numbered = _MOVING.sub(lambda call: f'{call[0]}number: "{next(counter)}", ', drawn(typst_source, folders))
    start, *parts = numbered.split(_PART)
    start = start.replace(_DEFINITIONS_END, _UNLINKED + _DEFINITIONS_END)
    drafts = [start + part for part in parts if _MOVING.search(part)] if parts else [numbered]
    with _complaints():
        chosen = "".join(_choices(draft, folders) for draft in drafts)
        document, is_settled = _laid_out(files(_told(_SETTLED, chosen, numbered)), folders, **_TAGGED)
    if not is_settled:
        raise BadStatement(
            "the pages do not settle, so references would name wrong pages; change what moves about: "
            "the last figures of"
            " a chapter, or a template of the course"
        )
    return document


def _choices(draft: str, folders: Sequence[Path]) -> str:
    """Return what a source chooses for each of its blocks that move, as entries of the typesetter's
    dictionary.

    What is moved moves what comes after it, so the typesetter's attempts may end before a layout agrees with
    its choices: the next ones begin with these. Blocks that go to and fro are left where they were last.
    """
    chosen = ""
    for _ in range(_LAYOUTS):
        written = files(_told(_GUESSED, chosen, draft))
        # It is laid out once: what the query has laid out is remembered.
        found = json.loads(_opened(written, folders).query("<chosen>", field="value"))
        before, chosen = (
            chosen,
            "".join(f'"{k}": ({str(kept).lower()}, {left:.3f}mm), ' for k, kept, left in found),
        )
        if chosen == before or _laid_out(written, folders, format="pdf")[1]:
            break
    return chosen


def _told(line: re.Pattern[str], chosen: str, typst_source: str) -> str:
    """Return the source with choices in a line of its definitions."""
    return line.sub(lambda found: f"{found[0].partition('=')[0]}= ({chosen or ':'})", typst_source)


def _laid_out(written: Mapping[str, bytes], folders: Sequence[Path], **options: Any) -> tuple[bytes, bool]:
    """Return the document of files by name, and whether its pages settled."""
    document, warnings = _opened(written, folders).compile_with_warnings(input=written, **options)
    return document, not any("converge" in str(warning) for warning in warnings)


def compile_pictures(typst_source: str, folders: Sequence[Path], ppi: float) -> list[bytes]:
    """Return the pages of a source as PNG, of so many pixels an inch.

    Raises BadStatement as :func:`compile_pdf` does.
    """
    sources = files(drawn(typst_source, folders))
    with _complaints():
        made = _compiler(fonts_of(folders)).compile(input=sources, format="png", ppi=float(ppi), timestamp=0)
    return [made] if isinstance(made, bytes) else list(made)


def compile_booklet(
    typst_source: str, folders: Sequence[Path] = ()
) -> tuple[bytes, tuple[tuple[int, int], ...]]:
    """Return the PDF of a source of several sheets, and the first and last page of each.

    Raises BadStatement as :func:`compile_pdf` does.
    """

    written = files(drawn(typst_source, folders))
    with _complaints(), little_memory():
        # Asked of the compiler that then writes the file, the pages are laid out once.
        compiler = _opened(written, folders)
        ends = json.loads(compiler.query("<sheet-last>", field="value"))
        document = _written(compiler, written)
        # The typesetter remembers what the last documents were made of, and a booklet is large: small
        # documents make it forget.
        for _ in range(_FORGETTING):
            compiler.compile(input=b"", format="pdf", timestamp=0)
    starts = [1, *(end + 1 + end % 2 for end in ends[:-1])]
    return document, tuple(zip(starts, ends, strict=True))


def _opened(sources: Mapping[str, bytes], folders: Sequence[Path]) -> Any:
    """Return a compiler of files by name, which can be asked as well."""
    import typst

    opened: Any = typst.Compiler  # takes the files by name as well, which its types do not say
    return opened(input=sources, font_paths=list(fonts_of(folders)), ignore_system_fonts=True)


def _written(compiler: Any, sources: Mapping[str, bytes]) -> bytes:
    """Return the tagged PDF that a compiler makes of files by name."""
    return compiler.compile(input=sources, **_TAGGED)


@contextmanager
def _complaints() -> Iterator[None]:
    """Raise errors of the typesetter, a query's plain error among them, as :class:`BadStatement`."""
    import typst

    try:
        yield
    except (typst.TypstError, RuntimeError) as wrong:
        raise BadStatement(f"the sheet does not compile: {wrong}") from wrong


@lru_cache(maxsize=32)
def environment_of(folders: tuple[Path, ...], lang: str) -> Environment:
    filters: dict[str, Callable[..., str]] = {
        "markup": lambda text: markup.to_typst_markup(text, lang),
        "value": lambda text: markup.typst_value(text, lang),
        "math": lambda tex: markup.typst_formula(tex, lang),
        "display": lambda tex: markup.typst_formula(tex, lang, display=True),
        "raw_math": lambda tex: to_typst(tex, lang),
        "spoken_literal": lambda tex: markup.typst_string(spoken(tex, lang)),
        "literal": lambda text: markup.typst_string(str(text)),
        "sort_key": lambda text: bare_letters(str(text)),
        "typed": markup.typst_typed,
        "drawing": _drawing,
    }
    env = environment(folders, lang, markup.typst_text, filters | answer_pages.filters())
    env.filters.update(answer_pages.queries())
    return env


def _drawing(figure: Figure | Picture | Beginning, alt: str, room: tuple[float, float] | None = None) -> str:
    """Return the figure inside the source, which so stands alone: an SVG without letters, its size, and the
    letters; and by how much it is made smaller for a room of so many mm that it was not laid out for."""
    width, height = figure.size_mm
    listed = json.dumps([_letters(letter, width) for letter in figure.letters()], ensure_ascii=False)
    svg, letters, words = map(markup.typst_string, (figure.bare_svg(), listed, alt))
    ratio = min(room[0] / width, room[1] / height) if room else 1
    smaller = f", ratio: {ratio:.4f}" if ratio < 1 else ""
    return f"bytes({svg}), size: ({width}mm, {height}mm), letters: {letters}, alt: {words}{smaller}"


def _letters(label: Letters, width: float) -> tuple[object, ...]:
    """Return a label for the typesetter, mm: the middle of its baseline from the middle of the upper edge,
    and its runs, each with its size, how far it stands below the baseline, and how far it goes back to where
    it starts."""
    runs = [
        (run.text, run.italic, *(round(x * SIZE, 2) for x in (run.size, -run.rise, run.back)))
        for run in label.runs
    ]
    return rounded(label.x - width / 2, 2), rounded(label.y, 2), runs
