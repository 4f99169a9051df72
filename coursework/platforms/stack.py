"""STACK: Moodle's XML with a question per variant, which asks all parts and has self-tests."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import Any, ClassVar
from xml.etree import ElementTree as ET

from coursework.language.words import words
from coursework.platforms._maxima import number, text
from coursework.platforms._stack_following import following
from coursework.platforms._stack_trees import EMPTY, Tree, case_name, functions, right_cases, trees
from coursework.platforms._stack_trials import Trial, trials
from coursework.platforms._xml import below, inner_bytes
from coursework.platforms.items import Item, Loss, Pool
from coursework.platforms.pieces import Image, PagePieces, with_files
from coursework.platforms.platform import Platform
from coursework.platforms.posed import CHOICE, CHOICES, COLLECTED, NUMBER, Posed
from coursework.system.writing import File

_VERSION = "2026010500"  #: of STACK, with which all this was tried
_BOX = "\N{OBJECT REPLACEMENT CHARACTER}"  #: placeholder of a box
_SHOWN = 6  #: figures of an answer shown to students
_SIGNS = {",": ("fr",)}  #: decimal signs other than the point, with the languages that write them
_TYPES = {NUMBER: "algebraic", CHOICE: "radio", CHOICES: "checkbox", COLLECTED: "string"}
_STARS = "4"  #: a space, or nothing, between a number and its unit is a product
_BRIEFLY = "3"  #: how an answer was read, on a line
_ALLOWED = "rad"  #: a unit whose name Maxima uses otherwise
_SIZES = {NUMBER: "15", COLLECTED: "40"}
#: A block without content. STACK hands a text with a file to Maxima as one string, for which Maxima takes
#: more than half a minute if it is long; of a text that a block divides, it hands over placeholders.
_DIVIDER = '[[if test="true"]][[/if]]'
_NO_ANSWER = "?"  #: right answer of a box that is not judged; never shown


class Stack(Platform):
    """Export for STACK, one file per language: ``stack.LANG.xml``."""

    name: ClassVar[str] = "stack"

    def content(self, item: Item, pieces: PagePieces) -> bytes:
        root = ET.Element("quiz")
        _Question(root, pieces, item).write()
        return zlib.compress(inner_bytes(root))

    def files(self, pool: Pool) -> Iterator[File]:
        yield File(Path(f"stack.{pool.lang}.xml"), partial(_quiz, pool))

    def item_losses(self, item: Item) -> Iterable[Loss]:
        """Return the parts whose answers may follow from others without an expression in Maxima."""
        instead = words(item.handout.lang)["platforms"]["stack"]["not_followed"]
        for posed, part in zip(item.questions, item.variant.parts, strict=True):
            may = posed.kind == NUMBER and "follow_through" in posed.features
            if may and following(item.variant, part) is None:
                yield Loss(item.handout.exercise, part.id, "follow_through", instead)


def _quiz(pool: Pool) -> Iterator[bytes]:
    """Yield the file to import, question by question."""
    yield b"<?xml version='1.0' encoding='utf-8'?>\n<quiz>"
    for section in pool.sections:
        yield _category(pool.title, f"{section.title} ({section.exercise}, {pool.lang})")
        for item in section.items:
            yield zlib.decompress(item.content)
    yield b"\n</quiz>\n"


def _category(*path: str) -> bytes:
    root = ET.Element("quiz")
    question = below(root, "question", type="category")
    path_text = "/".join(("$course$", "top", *(piece.replace("/", "//") for piece in path)))
    below(below(question, "category"), "text", path_text)
    return inner_bytes(root)


class _Question:
    """Question of STACK for one variant."""

    def __init__(self, root: ET.Element, pieces: PagePieces, item: Item):
        self._root, self._pieces, self._item, self._variant = root, pieces, item, item.variant
        self._words = words(item.handout.lang)["platforms"]["stack"]
        self._trees = trees(item.variant, item.questions)
        self._images: dict[str, Image] = {}

    def write(self) -> None:
        question = below(self._root, "question", type="stack")
        below(below(question, "name"), "text", self._item.label)
        self._text(question)
        self._html(question, "generalfeedback", "")
        judged = sum(tree.posed.points for tree in self._trees)
        below(question, "defaultgrade", f"{judged or self._item.points:g}")
        below(question, "penalty", "0.1")
        below(question, "hidden", "0")
        below(question, "idnumber", f"{self._item.identifier[:94]}.stack")
        below(below(question, "stackversion"), "text", _VERSION)
        below(below(question, "questionvariables"), "text", self._variables())
        self._html(question, "specificfeedback", "")
        self._html(question, "questionnote", _without_commands(self._item.label))
        self._html(question, "questiondescription", "")
        self._options(question)
        for part_number, posed in enumerate(self._item.questions, start=1):
            self._input(question, part_number, posed)
        for tree in self._trees:
            self._tree(question, tree)
        for part_number, trial in enumerate(trials(self._variant, self._trees), start=1):
            self._trial(question, part_number, trial)

    # ------------------------------------------------------------------- text

    def _text(self, question: ET.Element) -> None:
        pieces = [self._page_piece(self._pieces.opening(self._item))]
        for part_number, posed in enumerate(self._item.questions, start=1):
            box = "" if posed.kind in (CHOICE, CHOICES) else _BOX
            html = self._page_piece(self._pieces.prompt(posed, box=box)).replace(
                _BOX, f"[[input:ans{part_number}]]"
            )
            pieces.append(html if box else f"{html}<div>[[input:ans{part_number}]]</div>")
            pieces.append(f"<div>[[validation:ans{part_number}]]</div>")
            pieces.append(f"<div>[[feedback:prt{part_number}]]</div>" if posed.kind != COLLECTED else "")
        if self._images:
            pieces.append(_DIVIDER)
        where = self._html(question, "questiontext", "".join(pieces))
        for image in self._images.values():
            data = base64.b64encode(image.data).decode()
            below(where, "file", data, name=image.name, path="/", encoding="base64")

    def _page_piece(self, html: str) -> str:
        """Return a piece with its pictures as files, without text that STACK would run."""
        page, images = with_files(html, "@@PLUGINFILE@@/{}")
        self._images |= {image.name: image for image in images}
        return _without_commands(page)

    @staticmethod
    def _html(parent: ET.Element, tag: str, html: str) -> ET.Element:
        element = below(parent, tag, format="html")
        below(element, "text", html)
        return element

    # ---------------------------------------------------------------- options

    def _options(self, question: ET.Element) -> None:
        sign = next((sign for sign, langs in _SIGNS.items() if self._item.handout.lang in langs), ".")
        fields = {
            "questionsimplify": "1",
            "assumepositive": "0",
            "assumereal": "0",
            "decimals": sign,
            "scientificnotation": "*10",
            "multiplicationsign": "dot",
            "sqrtsign": "1",
            "complexno": "i",
            "inversetrig": "cos-1",
            "logicsymbol": "lang",
            "matrixparens": "[",
            "isbroken": "0",
            "variantsselectionseed": "",
        }
        for name, value in fields.items():
            below(question, name, value)
        for name, text_name in (
            ("prtcorrect", "right"),
            ("prtpartiallycorrect", "partly"),
            ("prtincorrect", "wrong"),
        ):
            self._html(question, name, f"<p>{self._words[text_name]}</p>")

    def _variables(self) -> str:
        """Return the question variables: the functions of every question, and the right values: low end, high
        end, value."""
        lines = [functions()]
        for tree in self._trees:
            if tree.posed.kind == NUMBER:
                right = tree.posed.intervals[0]
                ends = ",".join(map(number, (right.low, right.high, right.value)))
                lines.append(f"co_u{tree.part_number}: {tree.unit};")
                lines.append(f"co_r{tree.part_number}: [{ends}];")
                unit_message = self._words["other_unit"].format(unit=tree.posed.question.unit or "1")
                messages = f"{text(unit_message)},{text(self._words['grouped'])}"
                lines.append(f"co_check{tree.part_number}(x) := co_valid(x,{tree.unit},{messages});")
            else:
                lines.append(f"co_a{tree.part_number}: {self._cases(tree.posed)};")
        return "\n".join(lines) + "\n"

    # ----------------------------------------------------------------- inputs

    def _input(self, question: ET.Element, part_number: int, posed: Posed) -> None:
        box = below(question, "input")
        fields = {
            "name": f"ans{part_number}",
            "type": _TYPES[posed.kind],
            "tans": self._answer(part_number, posed),
            "boxsize": _SIZES.get(posed.kind, "15"),
            "strictsyntax": "1",
            "insertstars": _STARS if posed.kind == NUMBER else "0",
            "syntaxhint": "",
            "syntaxattribute": "0",
            "forbidwords": "",
            "allowwords": _ALLOWED if posed.kind == NUMBER else "",
            "forbidfloat": "0",
            "requirelowestterms": "0",
            "checkanswertype": "0",
            "mustverify": "1" if posed.kind == NUMBER else "0",
            "showvalidation": _BRIEFLY if posed.kind == NUMBER else "0",
            "options": ",".join(self._extra(part_number, posed)),
        }
        for name, value in fields.items():
            below(box, name, value)

    def _extra(self, part_number: int, posed: Posed) -> Iterator[str]:
        if posed.kind == NUMBER:
            yield f"validator:co_check{part_number}"
            if any(tree.may_be_empty and tree.part_number == part_number for tree in self._trees):
                yield "allowempty"
        if posed.kind == COLLECTED:
            yield "hideanswer"

    def _answer(self, part_number: int, posed: Posed) -> str:
        if posed.kind == NUMBER:
            right = posed.intervals[0]
            rounded = float(f"{right.value:.{_SHOWN}g}")
            return number(rounded if right.low <= rounded <= right.high else right.value)
        if posed.kind == COLLECTED:
            return text(_NO_ANSWER)
        return f"co_a{part_number}"

    def _cases(self, posed: Posed) -> str:
        """Return the options of a choice in STACK's syntax."""
        right = right_cases(posed)
        cases = (
            f"[{text(name)},{str(name in right).lower()},{text(self._option(posed, at))}]"
            for at, name in ((at, case_name(posed, at)) for at in range(len(posed.options)))
        )
        return f"[{','.join(cases)}]"

    def _option(self, posed: Posed, part_number: int) -> str:
        return self._page_piece(self._pieces.option(posed.options[part_number])).strip()

    # ------------------------------------------------------------------ trees

    def _tree(self, question: ET.Element, tree: Tree) -> None:
        element = below(question, "prt")
        below(element, "name", f"prt{tree.part_number}")
        below(element, "value", f"{tree.posed.points:g}")
        below(element, "autosimplify", "1")
        below(element, "feedbackstyle", "1")
        below(below(element, "feedbackvariables"), "text", tree.variables)
        for at, node in enumerate(tree.nodes):
            last = at + 1 == len(tree.nodes)
            feedback = self._page_piece(self._pieces.inline(node.message)) if node.message else ""
            if node.verdict == "follow_through":
                feedback = f"<p>{self._words['follows']}</p>"
            fields = {
                "name": str(at),
                "description": node.verdict,
                "answertest": "AlgEquiv",
                "sans": tree.test(at),
                "tans": "true",
                "testoptions": "",
                "quiet": "1",
            }
            node_element = below(element, "node")
            for name, value in fields.items():
                below(node_element, name, value)
            penalty = "0" if node.verdict == EMPTY else ""
            self._branch(node_element, "true", node.share, "-1", note(tree, at), feedback, penalty)
            self._branch(
                node_element, "false", 0.0, "-1" if last else str(at + 1), note(tree, at, holds=False), "", ""
            )

    def _branch(
        self,
        node: ET.Element,
        outcome: str,
        share: float,
        following: str,
        noted: str,
        feedback: str,
        penalty: str,
    ) -> None:
        below(node, f"{outcome}scoremode", "=")
        below(node, f"{outcome}score", f"{share:.7g}")
        below(node, f"{outcome}penalty", penalty)
        below(node, f"{outcome}nextnode", following)
        below(node, f"{outcome}answernote", noted)
        self._html(node, f"{outcome}feedback", feedback)

    # ----------------------------------------------------------------- trials

    def _trial(self, question: ET.Element, part_number: int, trial: Trial) -> None:
        test = below(question, "qtest")
        below(test, "testcase", str(part_number))
        below(test, "description", trial.message)
        for at, posed in enumerate(self._item.questions, start=1):
            input_element = below(test, "testinput")
            below(input_element, "name", f"ans{at}")
            below(input_element, "value", _typed(trial.answers.get(at), posed))
        for tree in self._trees:
            share, node = trial.expected[tree.part_number]
            input_element = below(test, "expected")
            last = len(tree.nodes) - 1
            noted = note(tree, node) if node >= 0 else note(tree, last, holds=False)
            below(input_element, "name", f"prt{tree.part_number}")
            below(input_element, "expectedscore", f"{share:.7g}")
            below(input_element, "expectedpenalty", "0" if share == 1 else "0.1")
            below(input_element, "expectedanswernote", noted)


def note(tree: Tree, node: int, *, holds: bool = True) -> str:
    """Return the answer note of a node's branch in STACK's reports."""
    verdict = tree.nodes[node].verdict if holds else "none"
    return f"prt{tree.part_number}-{node + 1}-{verdict}" if holds else f"prt{tree.part_number}-{node + 1}-F"


def _typed(answer: Any, posed: Posed) -> str:
    if posed.kind == NUMBER:
        return "" if answer is None else number(answer)
    if posed.kind == COLLECTED:
        return text(_NO_ANSWER)
    if isinstance(answer, (list, tuple)):
        return f"[{','.join(map(text, answer))}]"
    return text(str(answer))


def _without_commands(html: str) -> str:
    """Return the text without anything that STACK would take for a command."""
    return html.replace("[[", "&#91;&#91;").replace("{@", "&#123;@").replace("{#", "&#123;#")


PLATFORM = Stack()
