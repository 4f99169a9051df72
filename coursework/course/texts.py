r"""Texts of an exercise in one language: one Markdown file of named sections, through Jinja2.

``exercises/NAME.LANG.md.j2``::

    # Title of the exercise

    The statement, in Markdown with $LaTeX$. {{ r1 }} prints a given value with its unit.

    ## rA
    What part rA asks.

    ## guide
    Does the guide oscillate?
    - oscillates: it oscillates
    - rotates: it turns fully

    ## figure
    What the figure shows, for those who cannot see it.

``solutions/NAME.LANG.md.j2`` has the same form: opening words, a section a quantity (words before its
formula), ``## mistake NAME`` sections (what to tell a student who made it) and, where the solution draws its
own figure, ``## figure``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any
from weakref import WeakSet

from coursework.course.folder import Folder
from coursework.errors import BadCourse, BadStatement
from coursework.language.words import languages

if TYPE_CHECKING:
    pass

_HEADING = re.compile(r"^(#{1,2})\s+(.+?)\s*$", re.MULTILINE)
_ENCODING = "utf-8-sig"  #: a mark of the byte order, which some editors write, is not a part of the text
_TELLING = 15  #: characters by which a line of a text is found again
_LABEL = re.compile(r"^- ([A-Za-z][\w-]*): (.+)$", re.MULTILINE)


@dataclass(frozen=True)
class TextSection:
    """A piece of text and the labels of cases listed in it."""

    text: str = ""
    labels: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class RenderedText:
    """The sections of one file, rendered."""

    title: str
    opening: str
    sections: Mapping[str, TextSection]
    source: str  #: the file, for messages

    def section(self, name: str) -> TextSection:
        """Return the section of this name; a clear error if the file has none."""
        if name not in self.sections:
            is_there = f"{self.source} has no" if self.title else f"{self.source} is missing, and with it the"
            raise BadStatement(f"{is_there} section '## {name}'")
        return self.sections[name]

    def label(self, quantity: str, case: str) -> str:
        """Return the label of a case of a quantity in this language."""
        labels = self.section(quantity).labels
        if case not in labels:
            raise BadStatement(f"{self.source}: section '## {quantity}' has no line '- {case}: …'")
        return labels[case]


def parse(markdown: str, source: str) -> RenderedText:
    """Split a rendered text into its sections.

    Raises
    ------
    BadStatement
        No title, or a section twice.
    """
    marks = list(_HEADING.finditer(markdown))
    if not marks or marks[0].group(1) != "#":
        raise BadStatement(f"{source} must begin with its title: '# …'")
    pieces: dict[str, str] = {}
    for mark, following in zip(marks, [*marks[1:], None], strict=True):
        body = markdown[mark.end() : following.start() if following else len(markdown)].strip()
        name = mark.group(2)
        if mark is not marks[0] and mark.group(1) == "#":
            raise BadStatement(f"{source} has a second title '# {name}'; sections begin with '##'")
        if name in pieces:
            raise BadStatement(f"{source} has two sections '## {name}'")
        pieces[name] = body
    title = marks[0].group(2)
    opening = pieces.pop(title)
    sections = {
        name: TextSection(_LABEL.sub("", body).strip(), dict(_LABEL.findall(body)))
        for name, body in pieces.items()
    }
    return RenderedText(title, opening, sections, source)


def render(
    path: Path, folders: tuple[Path, ...], variables: Mapping[str, object], source: str
) -> RenderedText:
    """Render a text file with the variables of a variant; ``source`` is what messages call the file.

    Raises
    ------
    BadStatement
        Unknown variable, broken template, a dollar without its partner, a formula that cannot be read: says
        the file and, where it is known, the line.
    """
    template = _template(path, path.stat().st_mtime_ns, folders, source)
    if isinstance(template, RenderedText):
        return template
    if isinstance(template, _Filled) and template.names <= variables.keys():
        markdown = template.render(variables)
    else:
        markdown = _rendered(path, folders, variables, source)
    text = _text(markdown, path, source, formulas=template not in _proofread)
    _proofread.add(template)
    return text


def _rendered(path: Path, folders: tuple[Path, ...], variables: Mapping[str, object], source: str) -> str:
    """Return a text through Jinja2, which is loaded for those that need it."""
    import jinja2

    try:
        return str(_jinja(path, path.stat().st_mtime_ns, folders, source).render(variables))
    except jinja2.UndefinedError as fault:
        names = ", ".join(sorted(variables))
        raise BadStatement(f"{source}: {fault.message}; a text may use: {names}") from fault
    except jinja2.TemplateError as fault:
        raise BadStatement(f"{source}: {fault}") from fault
    except (TypeError, ValueError, ArithmeticError, LookupError, AttributeError) as fault:
        raise BadStatement(f"{source}: an expression fails: {fault}") from fault


def _text(markdown: str, path: Path, source: str, *, formulas: bool) -> RenderedText:
    """Return the sections of a rendered text, once it is proofread; its formulas only on request."""
    from coursework.markup.proofreading import pair_dollars, read_formulas

    def place(piece: str) -> str:
        first = piece.split("\n")[0]
        lines = path.read_text(_ENCODING).split("\n")
        matches = [n for n, line in enumerate(lines, 1) if first in line]
        # A value stands further on.
        begun = [n for n, line in enumerate(lines, 1) if first[:_TELLING] in line]
        line_number = matches[0] if matches else begun[0] if len(begun) == 1 else None
        return f"{source}, line {line_number}" if line_number else source

    pair_dollars(markdown, place)
    if formulas:
        read_formulas(markdown, place)
    return parse(markdown, source)


#: Templates whose formulas were read as the first variant has them; those of others are read as they are
#: printed.
_proofread: WeakSet[object] = WeakSet()


@dataclass(frozen=True)
class Constants:
    """Parts of a text that hold no variable, and so are the same for every variant."""

    texts: Mapping[str, str]  #: by section
    labels: Mapping[tuple[str, str], str]  #: by section and case


def constants(path: Path) -> Constants:
    """Return the parts of a file that need no variant to be read; empty where there is no file."""
    source = path.read_text(_ENCODING) if path.exists() else ""
    if not source or not all(map(_stands_alone, source.split("\n## "))):
        return Constants({}, {})  # a block that holds whole sections may repeat or leave out some of them
    sections = parse(source, path.name).sections
    # A label is part of its section: a block may stand round it.
    return Constants(
        {name: section.text for name, section in sections.items() if not _TAG.search(section.text)},
        {
            (name, case): label
            for name, section in sections.items()
            for case, label in section.labels.items()
            if not _TAG.search(label) and "{%" not in section.text
        },
    )


_TAG = re.compile(r"\{[{%#]")


def _stands_alone(section: str) -> bool:
    """Return whether the blocks that begin in a section end in it."""
    import jinja2

    if "{%" not in section and "{#" not in section:
        return True
    try:
        jinja2.Environment().parse(section)
    except jinja2.TemplateSyntaxError:
        return False
    return True


_HOLE = re.compile(r"\{\{ *([A-Za-z_]\w*) *\}\}")
_CONSTANTS = {"true", "false", "none", "True", "False", "None"}  #: names that Jinja2 reads as values


class _Filled:
    """A text in which variables alone stand, ``{{ r1 }}``: to fill them in is all that Jinja2 would do."""

    def __init__(self, text: str):
        self.pieces = _HOLE.split(text)
        self.names = frozenset(self.pieces[1::2])

    @staticmethod
    def fits(text: str) -> bool:
        """Return whether a text can be filled in without a template engine."""
        rest = _HOLE.split(text)
        return "{{{" not in text and not _TAG.search("".join(rest[::2])) and not _CONSTANTS & {*rest[1::2]}

    def render(self, variables: Mapping[str, object]) -> str:
        filled = self.pieces.copy()
        filled[1::2] = [str(variables[name]) for name in self.pieces[1::2]]
        return "".join(filled)


_templates: dict[tuple, Any] = {}


def _template(path: Path, changed: int, folders: tuple[Path, ...], source: str) -> Any:
    """Return a text to render; one without a variable in it is the same for every variant."""
    key = (path, changed, folders)
    if key not in _templates:
        try:
            text = path.read_text(_ENCODING)
        except UnicodeDecodeError as fault:
            raise BadStatement(f"{source} is not UTF-8: {fault.reason} at byte {fault.start}") from fault
        if not _TAG.search(text):
            _templates[key] = _text(text, path, source, formulas=True)
        elif _Filled.fits(text):
            _templates[key] = _Filled(text)
        else:
            _templates[key] = _jinja(path, changed, folders, source)
    return _templates[key]


@lru_cache(maxsize=1024)
def _jinja(path: Path, changed: int, folders: tuple[Path, ...], source: str) -> Any:
    """Return a template of Jinja2; it may include others, from the folders too."""
    import jinja2

    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader([path.parent, *folders], encoding=_ENCODING),
        undefined=jinja2.StrictUndefined,
        autoescape=False,
        keep_trailing_newline=True,
    )
    try:
        return environment.get_template(path.name)
    except jinja2.TemplateSyntaxError as fault:
        raise BadStatement(f"{source}, line {fault.lineno}: {fault.message}") from fault
    except UnicodeDecodeError as fault:
        raise BadStatement(f"{source} is not UTF-8: {fault.reason} at byte {fault.start}") from fault


@lru_cache(maxsize=1024)
def _names(path: Path, changed: int, folders: tuple[Path, ...], source: str) -> frozenset[str]:
    """Return the variables of a text and of those that it includes by name; what cannot be read is reported
    where it is rendered."""
    template = _template(path, changed, folders, source)
    if isinstance(template, RenderedText):
        return frozenset()
    if isinstance(template, _Filled):
        return template.names
    import jinja2
    from jinja2 import meta

    environment, names = template.environment, set[str]()
    waiting = [path.name]
    met = {*waiting}
    while waiting:
        with suppress(jinja2.TemplateError, UnicodeDecodeError):
            tree = environment.parse(environment.loader.get_source(environment, waiting.pop())[0])
            names |= meta.find_undeclared_variables(tree)
            included = {name for name in meta.find_referenced_templates(tree) if name} - met
            met |= included
            waiting += included
    return frozenset(names)


class ExerciseTexts:
    """The texts of one exercise, in every language: of the exercise itself (``exercises``) and of its
    solution (``solutions``)."""

    def __init__(self, folder: Folder, name: str):
        self.folder = folder
        self.name = name
        self._constants: dict[tuple[str, str], Constants] = {}
        self._labels: dict[tuple[str, str], dict[str, list[str]]] = {}

    @cached_property
    def languages(self) -> tuple[str, ...]:
        """The languages that the exercise has a statement in, among those that the course speaks."""
        spoken = sorted(self.folder.languages)
        return tuple(lang for lang in spoken if self.file("exercises", lang).exists())

    def file(self, kind: str, lang: str) -> Path:
        """Return the path of a text, whether it exists or not."""
        return self.folder.text_file(kind, self.name, lang)

    @property
    def unspoken(self) -> dict[str, Path]:
        """By language, a text in each that the engine does not speak: nothing reads it."""
        spoken = languages()
        return {
            lang: path
            for kind in ("solutions", "exercises")
            for lang, path in self.folder.texts(kind, self.name).items()
            if lang not in spoken
        }

    def title(self, lang: str) -> str:
        """Return the statement's title, where no variable stands in it; else, and where there is none,
        nothing."""
        path = self.file("exercises", lang)
        first = next(iter(path.read_text(_ENCODING).splitlines()), "") if path.exists() else ""
        return first[2:].strip() if first.startswith("# ") and not _TAG.search(first) else ""

    def text(self, kind: str, lang: str, variables: Mapping[str, object]) -> RenderedText:
        """Return a text, rendered. A solution need not have one: then every section is absent.

        Raises
        ------
        BadInput
            The course does not speak the language.
        BadCourse
            The exercise has none in this language.
        """
        self.folder.check_speaks(lang)
        path = self.file(kind, lang)
        source = self.folder.relative(path)
        if not path.exists() and kind == "solutions":
            return RenderedText("", "", {}, source)
        if not path.exists():
            raise BadCourse(f"{self.name} has no text in {lang!r}: {source} is missing")
        shared = (self.folder.root / kind, *self.folder.template_folders)
        return render(path, shared, variables, source)

    def names(self, kind: str, lang: str) -> frozenset[str]:
        """Return the variables in a text and in those that it includes; empty where there is no text.

        Raises
        ------
        BadStatement
            It cannot be read.
        """
        path = self.file(kind, lang)
        if not path.exists():
            return frozenset()
        shared = (self.folder.root / kind, *self.folder.template_folders)
        return _names(path, path.stat().st_mtime_ns, shared, self.folder.relative(path))

    def constants(self, kind: str, lang: str) -> Constants:
        """Return the parts of a text that are the same for every variant; read once."""
        if (kind, lang) not in self._constants:
            self._constants[kind, lang] = constants(self.file(kind, lang))
        return self._constants[kind, lang]

    def is_constant(self, quantity: str, case: str) -> bool:
        """Return whether the label of a case is the same in every variant, in all languages."""
        return all((quantity, case) in self.constants("exercises", lang).labels for lang in self.languages)

    def labels(
        self, part: str, cases: Sequence[str], lang: str, label_of: Callable[[str], Iterable[str]]
    ) -> dict[str, list[str]]:
        """Return the labels of each case of a part, by ``label_of``; computed once where they are the same
        for every variant."""
        key = (part, lang)
        if key not in self._labels:
            labels = {case: [*label_of(case)] for case in cases}
            if not all(self.is_constant(part, case) for case in cases):
                return labels
            self._labels[key] = labels
        return self._labels[key]
