"""STACK: Moodle's XML with a question a variant, which asks all parts and tests itself."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import Any, ClassVar
from xml.etree import ElementTree as ET

from coursework.language.words import words
from coursework.platforms._maxima import number, text
from coursework.platforms._stack_following import following
from coursework.platforms._stack_trees import (
    EMPTY,
    Tree,
    case_name,
    functions,
    right_cases,
    trees,
)
from coursework.platforms._stack_trials import Trial, trials
from coursework.platforms._xml import below, xml_bytes
from coursework.platforms.items import Item, Pool
from coursework.platforms.losses import Loss
from coursework.platforms.pieces import Image, Pieces, with_files
from coursework.platforms.platform import Platform
from coursework.platforms.posed import CHOICE, CHOICES, COLLECTED, NUMBER, Posed
from coursework.system.writing import File

_VERSION = "2026010500"  #: of STACK, with which all this was tried
_BOX = "\N{OBJECT REPLACEMENT CHARACTER}"  #: where a box is to stand
_SHOWN = 6  #: figures of an answer, which students are shown
_SIGNS = {",": ("fr",)}  #: decimal signs other than the point, with the languages that write them
_TYPES = {NUMBER: "algebraic", CHOICE: "radio", CHOICES: "checkbox", COLLECTED: "string"}
_STARS = "4"  #: a space, or nothing, between a number and its unit is a product
_BRIEFLY = "3"  #: how an answer was read, on a line
_ALLOWED = "rad"  #: a unit whose name Maxima has for something else
_SIZES = {NUMBER: "15", COLLECTED: "40"}
_NO_ANSWER = "?"  #: what stands as the right answer of a box that nobody judges; it is never shown


class Stack(Platform):
    """A file a language: ``stack.LANG.xml``."""

    name: ClassVar[str] = "stack"

    def files(self, pool: Pool) -> Iterator[File]:
        yield File(Path(f"stack.{pool.lang}.xml"), partial(_quiz, pool))

    def losses(self, pool: Pool) -> Iterable[Loss]:
        """The answers that may follow from others by no line of Maxima."""
        instead = words(pool.lang)["platforms"]["stack"]["not_followed"]
        for item, variant in _with_variants(pool):
            for posed, part in zip(item.questions, variant.parts, strict=True):
                may = posed.kind == NUMBER and "follow_through" in posed.features
                if may and following(variant, part) is None:
                    yield Loss(variant.exercise.name, part.id, "follow_through", instead)


def _quiz(pool: Pool) -> bytes:
    root = ET.Element("quiz")
    pieces = Pieces(pool.folders, pool.lang)
    variants = {item.identifier: variant for item, variant in _with_variants(pool)}
    for section in pool.sections:
        _category(root, pool.title, f"{section.title} ({section.exercise}, {pool.lang})")
        for item in section.items:
            _Question(root, pieces, item, variants[item.identifier]).write()
    return xml_bytes(root)


def _with_variants(pool: Pool) -> Iterator[tuple[Item, Any]]:
    """Each item, with its variant in the language of the pool."""
    variants = {
        (issue.variant.exercise.name, issue.variant.seed): issue.variant.in_language(pool.lang)
        for issue in pool.issues
    }
    for item in pool.items:
        yield item, variants[item.handout.exercise, item.handout.seed]


def _category(root: ET.Element, *path: str) -> None:
    question = below(root, "question", type="category")
    whole = "/".join(("$course$", "top", *(piece.replace("/", "//") for piece in path)))
    below(below(question, "category"), "text", whole)


class _Question:
    """One variant as a question of STACK."""

    def __init__(self, root: ET.Element, pieces: Pieces, item: Item, variant: Any):
        self._root, self._pieces, self._item, self._variant = root, pieces, item, variant
        self._words = words(item.handout.lang)["platforms"]["stack"]
        self._trees = trees(variant, item.questions)
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
        self._html(question, "questionnote", _shown(self._item.label))
        self._html(question, "questiondescription", "")
        self._options(question)
        for place, posed in enumerate(self._item.questions, start=1):
            self._input(question, place, posed)
        for tree in self._trees:
            self._tree(question, tree)
        for place, trial in enumerate(trials(self._variant, self._trees), start=1):
            self._trial(question, place, trial)

    # ------------------------------------------------------------------- text

    def _text(self, question: ET.Element) -> None:
        said = [self._shown(self._pieces.opening(self._item))]
        for place, posed in enumerate(self._item.questions, start=1):
            box = "" if posed.kind in (CHOICE, CHOICES) else _BOX
            html = self._shown(self._pieces.prompt(posed, box=box)).replace(_BOX, f"[[input:ans{place}]]")
            said.append(html if box else f"{html}<div>[[input:ans{place}]]</div>")
            said.append(f"<div>[[validation:ans{place}]]</div>")
            said.append(f"<div>[[feedback:prt{place}]]</div>" if posed.kind != COLLECTED else "")
        where = self._html(question, "questiontext", "".join(said))
        for image in self._images.values():
            data = base64.b64encode(image.data).decode()
            below(where, "file", data, name=image.name, path="/", encoding="base64")

    def _shown(self, html: str) -> str:
        """A piece with its pictures as files, and nothing in it that STACK would run."""
        found, images = with_files(html, "@@PLUGINFILE@@/{}")
        self._images |= {image.name: image for image in images}
        return _shown(found)

    @staticmethod
    def _html(parent: ET.Element, tag: str, html: str) -> ET.Element:
        place = below(parent, tag, format="html")
        below(place, "text", html)
        return place

    # ---------------------------------------------------------------- options

    def _options(self, question: ET.Element) -> None:
        sign = next((sign for sign, langs in _SIGNS.items() if self._item.handout.lang in langs), ".")
        told = {
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
        for name, value in told.items():
            below(question, name, value)
        for name, said in (
            ("prtcorrect", "right"),
            ("prtpartiallycorrect", "partly"),
            ("prtincorrect", "wrong"),
        ):
            self._html(question, name, f"<p>{self._words[said]}</p>")

    def _variables(self) -> str:
        """The functions of every question, and what is right: low end, high end, value."""
        lines = [functions()]
        for tree in self._trees:
            if tree.posed.kind == NUMBER:
                right = tree.posed.intervals[0]
                ends = ",".join(map(number, (right.low, right.high, right.value)))
                lines.append(f"co_u{tree.place}: {tree.unit};")
                lines.append(f"co_r{tree.place}: [{ends}];")
                said = self._words["other_unit"].format(unit=tree.posed.question.unit or "1")
                told = f"{text(said)},{text(self._words['grouped'])}"
                lines.append(f"co_check{tree.place}(x) := co_valid(x,{tree.unit},{told});")
            else:
                lines.append(f"co_a{tree.place}: {self._cases(tree.posed)};")
        return "\n".join(lines) + "\n"

    # ----------------------------------------------------------------- inputs

    def _input(self, question: ET.Element, place: int, posed: Posed) -> None:
        box = below(question, "input")
        told = {
            "name": f"ans{place}",
            "type": _TYPES[posed.kind],
            "tans": self._answer(place, posed),
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
            "options": ",".join(self._extra(place, posed)),
        }
        for name, value in told.items():
            below(box, name, value)

    def _extra(self, place: int, posed: Posed) -> Iterator[str]:
        if posed.kind == NUMBER:
            yield f"validator:co_check{place}"
            if any(tree.may_be_empty and tree.place == place for tree in self._trees):
                yield "allowempty"
        if posed.kind == COLLECTED:
            yield "hideanswer"

    def _answer(self, place: int, posed: Posed) -> str:
        if posed.kind == NUMBER:
            right = posed.intervals[0]
            shown = float(f"{right.value:.{_SHOWN}g}")
            return number(shown if right.low <= shown <= right.high else right.value)
        if posed.kind == COLLECTED:
            return text(_NO_ANSWER)
        return f"co_a{place}"

    def _cases(self, posed: Posed) -> str:
        """What is offered, as STACK is told it."""
        right = right_cases(posed)
        cases = (
            f"[{text(name)},{str(name in right).lower()},{text(self._option(posed, at))}]"
            for at, name in ((at, case_name(posed, at)) for at in range(len(posed.options)))
        )
        return f"[{','.join(cases)}]"

    def _option(self, posed: Posed, place: int) -> str:
        return self._shown(self._pieces.option(posed.options[place])).strip()

    # ------------------------------------------------------------------ trees

    def _tree(self, question: ET.Element, tree: Tree) -> None:
        place = below(question, "prt")
        below(place, "name", f"prt{tree.place}")
        below(place, "value", f"{tree.posed.points:g}")
        below(place, "autosimplify", "1")
        below(place, "feedbackstyle", "1")
        below(below(place, "feedbackvariables"), "text", tree.variables)
        for at, node in enumerate(tree.nodes):
            last = at + 1 == len(tree.nodes)
            says = self._shown(self._pieces.inline(node.says)) if node.says else ""
            if node.verdict == "follow_through":
                says = f"<p>{self._words['follows']}</p>"
            told = {
                "name": str(at),
                "description": node.verdict,
                "answertest": "AlgEquiv",
                "sans": tree.test(at),
                "tans": "true",
                "testoptions": "",
                "quiet": "1",
            }
            one = below(place, "node")
            for name, value in told.items():
                below(one, name, value)
            penalty = "0" if node.verdict == EMPTY else ""
            self._branch(one, "true", node.share, "-1", note(tree, at), says, penalty)
            self._branch(
                one, "false", 0.0, "-1" if last else str(at + 1), note(tree, at, holds=False), "", ""
            )

    def _branch(
        self, node: ET.Element, way: str, share: float, following: str, noted: str, says: str, penalty: str
    ) -> None:
        below(node, f"{way}scoremode", "=")
        below(node, f"{way}score", f"{share:.7g}")
        below(node, f"{way}penalty", penalty)
        below(node, f"{way}nextnode", following)
        below(node, f"{way}answernote", noted)
        self._html(node, f"{way}feedback", says)

    # ----------------------------------------------------------------- trials

    def _trial(self, question: ET.Element, place: int, trial: Trial) -> None:
        test = below(question, "qtest")
        below(test, "testcase", str(place))
        below(test, "description", trial.says)
        for at, posed in enumerate(self._item.questions, start=1):
            told = below(test, "testinput")
            below(told, "name", f"ans{at}")
            below(told, "value", _typed(trial.answers.get(at), posed))
        for tree in self._trees:
            share, node = trial.expected[tree.place]
            told = below(test, "expected")
            last = len(tree.nodes) - 1
            noted = note(tree, node) if node >= 0 else note(tree, last, holds=False)
            below(told, "name", f"prt{tree.place}")
            below(told, "expectedscore", f"{share:.7g}")
            below(told, "expectedpenalty", "0" if share == 1 else "0.1")
            below(told, "expectedanswernote", noted)


def note(tree: Tree, node: int, *, holds: bool = True) -> str:
    """What STACK's reports call the way out of a node."""
    verdict = tree.nodes[node].verdict if holds else "none"
    return f"prt{tree.place}-{node + 1}-{verdict}" if holds else f"prt{tree.place}-{node + 1}-F"


def _typed(answer: Any, posed: Posed) -> str:
    if posed.kind == NUMBER:
        return "" if answer is None else number(answer)
    if posed.kind == COLLECTED:
        return text(_NO_ANSWER)
    if isinstance(answer, (list, tuple)):
        return f"[{','.join(map(text, answer))}]"
    return text(str(answer))


def _shown(html: str) -> str:
    """The same with nothing in it that STACK would take for a command."""
    return html.replace("[[", "&#91;&#91;").replace("{@", "&#123;@").replace("{#", "&#123;#")


PLATFORM = Stack()
