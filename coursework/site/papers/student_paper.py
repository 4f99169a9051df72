"""Paper issued to a student, as the pages show it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from json import dumps
from typing import Any, NamedTuple

from markupsafe import Markup, escape
from sqlalchemy import Connection

from coursework.course.course import Course
from coursework.database.assignments import issued_content, sheet_content
from coursework.database.prepared import PreparedPieces
from coursework.database.publication import StudentAssignment
from coursework.database.states import page_state
from coursework.gradebook.feedback_sheets import heading_of
from coursework.issuing.assignment import text_in
from coursework.issuing.issued import Issued
from coursework.language.words import words
from coursework.marking.answers import read
from coursework.marking.feedback import say_not_read
from coursework.markup.markdown import html_inline, plain_line
from coursework.model import Part
from coursework.rendering import papers
from coursework.rendering.environment import render
from coursework.rendering.html import environment_of
from coursework.rendering.surface import kind_of_surface
from coursework.selfstudy.attempt import read_back as readings
from coursework.sheets.cells import answer_in, cell_names, form_of, is_incomplete
from coursework.sheets.paper import FeedbackPaper, Paper, PaperHeading
from coursework.site.frame.drafts import DRAWING, LONGEST, longest
from coursework.site.frame.lru_cache import LRUCache
from coursework.site.frame.requests import FormData, HTTPException

_VARIANTS = 100  #: items of the cache of one paper
Texts = Mapping[str, str]  #: texts of the boxes, by name


class BoxRecord(NamedTuple):
    """Box of a paper, known from the record of its variant without drawing the variant."""

    exercise: str
    seed: int
    part: str
    lang: str


class PaperBox(NamedTuple):
    """Question of a paper with the box of its answer."""

    name: str  #: on the page
    number: str  #: of the question, 2.1
    exercise: str  #: its title
    variant: Any
    part: Part


class ReadBack(NamedTuple):
    """Reading of a text."""

    status: str  #: ``read``, ``waits`` for a person, ``missing``, ``unreadable`` or ``wrong_unit``
    message: str  #: plain text; empty for an empty box
    typeset: Markup = Markup("")  #: the same as it is printed; empty where that is no different

    @property
    def html(self) -> Markup:
        """Message as a piece of a page."""
        return self.typeset or escape(self.message)

    @property
    def is_in_doubt(self) -> bool:
        return self.status in ("unreadable", "wrong_unit")


def read_back(variant: Any, part: Part, text: str) -> ReadBack:
    """Return the reading of an answer, or the reason for which it cannot be read. Two plausible readings are
    both returned: the choice between them depends on the reference, which is not used here."""
    reading, texts = read(variant, part, text), words(variant.lang, "site")["read_back"]
    if reading.status == "missing":
        return ReadBack("missing", "")
    if reading.status != "read":
        markdown, plain = say_not_read(variant, part, reading).texts(variant.lang)
        return ReadBack(reading.status, plain, Markup(html_inline(markdown, variant.lang)))
    if part.sort.is_open:
        return ReadBack("waits", texts["waits"])
    lines = readings(variant, part, text)[1]
    form = texts["two"] if len(lines) > 1 else texts["read_as"]
    plain = form.format(*(plain_line(line, variant.lang) for line in lines))
    typeset = html_inline(form.format(*lines), variant.lang) if "$" in "".join(lines) else ""
    return ReadBack("read", plain, Markup(typeset))


@dataclass(frozen=True)
class StudentPaper:
    """Paper of a student: a variant of each exercise, in one language."""

    course: Course[Any]
    content: Mapping[str, Any]  #: content of ``issued.json`` for the student
    student: str
    lang: str
    instructions: Mapping[str, str]
    cache: LRUCache = field(default_factory=lambda: LRUCache(_VARIANTS))  #: cache of the variants

    @cached_property
    def issued(self) -> Issued:
        return Issued(self.content, "what was issued")

    @cached_property
    def state(self) -> str:
        """Digest of everything that determines the page, except the drafts."""
        exercises = {str(item["record"]["exercise"]) for item in self.content["issued"]}
        content = self.content, self.student, self.lang, dict(self.instructions)
        return page_state(self.course, sorted(exercises), *content)

    @cached_property
    def seeds(self) -> Mapping[str, int]:
        """Seeds by exercise, in the order of the paper; those of the make-up if there is one."""
        seeds = self.issued.issued_to(self.student)
        stated = (self.issued.assignment or {}).get("exercises") or self.issued.exercises
        return {exercise: seeds[exercise] for exercise in map(str, stated) if exercise in seeds} or seeds

    @property
    def sitting(self) -> int:
        """Number of the paper: 2 for a make-up."""
        return max(self.issued.sitting_of(self.student, e, seed) for e, seed in self.seeds.items())

    @cached_property
    def variants(self) -> tuple[Any, ...]:
        return tuple(self._variant(exercise, seed) for exercise, seed in self.seeds.items())

    def _variant(self, exercise: str, seed: int) -> Any:
        loaded, record = self.course[exercise], self.issued.record_of(self.student, exercise, seed)
        full_record = {**record, "lang": self._spoken(exercise)}
        return self.cache.get(
            ("issued", dumps(full_record, sort_keys=True)), lambda: loaded.from_record(full_record)
        )

    def _spoken(self, exercise: str) -> str:
        """Return the language of an exercise on this paper."""
        spoken = self.course[exercise].languages
        return self.lang if self.lang in spoken else spoken[0]

    @cached_property
    def fields(self) -> dict[str, BoxRecord]:
        """Boxes by name, for storage, without the variants."""
        fields = {}
        for index, (exercise, seed) in enumerate(self.seeds.items(), 1):
            record, lang = self.issued.record_of(self.student, exercise, seed), self._spoken(exercise)
            for part in record["parts"]:
                fields[f"e{index}-{part['id']}"] = BoxRecord(exercise, seed, str(part["id"]), lang)
        return fields

    @cached_property
    def _surfaces(self) -> Mapping[str, str]:
        """Kinds of the surfaces to draw on, by exercise."""
        kinds = (
            (exercise, kind_of_surface(self.course[exercise].spec, record))
            for exercise, seed in self.seeds.items()
            for record in [self.issued.record_of(self.student, exercise, seed)]
        )
        return {exercise: kind for exercise, kind in kinds if kind}

    @property
    def draws(self) -> tuple[str, ...]:
        """Kinds of the surfaces on the paper."""
        return tuple(sorted(set(self._surfaces.values())))

    @cached_property
    def drawn(self) -> Mapping[str, str]:
        """Exercises with a surface to draw on, by the name of the box of the drawing."""
        return {
            f"e{index}-{DRAWING}": exercise
            for index, exercise in enumerate(self.seeds, 1)
            if exercise in self._surfaces
        }

    @cached_property
    def boxes(self) -> dict[str, PaperBox]:
        """Boxes of the page by name, in order."""
        return {box.name: box for box in self._boxes()}

    def _boxes(self) -> Iterator[PaperBox]:
        for index, variant in enumerate(self.variants, 1):
            title = variant.exercise.title(variant.lang)
            for number, part in enumerate(variant.parts, 1):
                yield PaperBox(f"e{index}-{part.id}", f"{index}.{number}", title, variant, part)

    @cached_property
    def heading(self) -> PaperHeading:
        """Heading of the paper."""
        printed = heading_of(self.course, self.issued, self.student, self.sitting, self.lang)
        return replace(printed, instructions=text_in(self.instructions, self.lang))

    @cached_property
    def paper(self) -> Paper:
        """Printable paper."""
        return Paper(self.heading, tuple(variant.handout(self.student) for variant in self.variants))

    def read(self, name: str, text: str) -> ReadBack:
        """Return the reading of a text in a box."""
        box = self.boxes[name]
        if is_incomplete(text, form_of(box.variant, box.part)):
            return ReadBack("unreadable", words(box.variant.lang, "site")["read_back"]["incomplete"])
        return read_back(box.variant, box.part, text)

    def texts_of(self, answers: Mapping[tuple[str, str, str], str]) -> dict[str, str]:
        """Return the texts of answers, by exercise, seed and part, for each box of the page."""
        return {
            name: answers.get((field.exercise, str(field.seed), field.part), "")
            for name, field in self.fields.items()
        }

    def texts(self, form: FormData) -> dict[str, str]:
        """Return the answers in a form of the page, by box; ticks of one box are joined.

        Raises
        ------
        HTTPException
            A field is not a box of the paper, or its text is too long.
        """
        others = [
            name
            for name in form.texts
            if name not in {*self.fields, *self.drawn} and not name.startswith("_")
        ]
        cells = [name for name in others if name.rpartition("-")[0] in self.fields]
        forms = dict.fromkeys(name.rpartition("-")[0] for name in cells)
        for name in forms:
            forms[name] = form_of(self.boxes[name].variant, self.boxes[name].part)
        if strange := {*others} - {cell for name in forms for cell in cell_names(name, forms[name] or "")}:
            raise HTTPException("bad_request", 400, len(strange))
        answers = {name: answer_in(form.texts, name, forms.get(name) or "") for name in self.fields}
        if any(len(text) > LONGEST for text in answers.values()):
            raise HTTPException("too_large", 413, LONGEST)
        return answers

    def drawing_texts(self, form: FormData) -> dict[str, str]:
        """Return the drawings in a form of the page, by box; a longer text than a drawing may have is cut,
        and then is none."""
        return {name: form.text(name)[: longest(name)] for name in self.drawn if name in form.texts}

    def pieces(self) -> PreparedPieces:
        """Return the parts of its page, with empty boxes."""
        names, env = (
            self.template_names(self.paper),
            environment_of(self.course.folder.template_folders, self.lang),
        )
        return PreparedPieces(
            render(env, "paper/_head.html.j2", names), render(env, "paper/_body.html.j2", names)
        )

    def template_names(self, document: Paper | FeedbackPaper) -> dict[str, Any]:
        """Return the names for the template of a paper, or of its feedback."""
        env = environment_of(self.course.folder.template_folders, self.lang)
        if isinstance(document, Paper):
            names = papers.drawing_context(document, env)
        else:
            names = papers.context(document, "html.j2", partial(render, env))
        return {**names, "image": papers.image, "keeping": ""}


def student_paper(
    connection: Connection,
    course: Course[Any],
    assignment: StudentAssignment,
    person: int,
    lang: str,
    cache: LRUCache | None = None,
    *,
    heads: bool = True,
    content: Mapping[str, Any] | None = None,
) -> StudentPaper:
    """Return the paper of a person; its variants are cached in ``cache``, if given.

    The roster's columns, which only the heading needs, are loaded if ``heads``; for a large class they are
    long. Nothing is loaded if the ``content`` is given.
    """
    if content is not None:
        pass
    elif heads:
        content = issued_content(connection, assignment.id, person)
    else:
        content = sheet_content(connection, assignment.id, person, assignment.stated)
    stated = assignment.file_statement.get("instructions") or {}
    instructions = {"": stated} if isinstance(stated, str) else stated
    variants = LRUCache(_VARIANTS) if cache is None else cache
    return StudentPaper(course, content, assignment.student, lang, instructions, variants)


def read_lines(paper: StudentPaper, texts: Texts) -> list[tuple[PaperBox, str, ReadBack]]:
    """Return each question with its text and the reading of the text."""
    return [
        (box, texts.get(name, ""), paper.read(name, texts.get(name, ""))) for name, box in paper.boxes.items()
    ]


def counts(lines: Sequence[tuple[PaperBox, str, ReadBack]]) -> dict[str, int]:
    """Return the number of answered, doubtful, blank, and all questions."""
    doubt = sum(reading.is_in_doubt for _, _, reading in lines)
    blank = sum(reading.status == "missing" for _, _, reading in lines)
    return {"answered": len(lines) - doubt - blank, "doubt": doubt, "blank": blank, "all": len(lines)}
