"""Content of a preview, made in a separate process that opens the course only once."""

from __future__ import annotations

import sys
import traceback
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, NamedTuple

from coursework.api import open_course
from coursework.authoring import check_report, checks
from coursework.errors import CourseworkError
from coursework.messages import Message, as_message
from coursework.rendering.renderer import builtin_renderer, renderer_of
from coursework.sheets.answer_sheet import answer_sheet
from coursework.sheets.handout import handout
from coursework.sheets.sheet import AnswerSheet, Handout
from coursework.system.ending import follow_parent

_MOST_FAILURES = 20  #: failures shown of one check


class ViewRequest(NamedTuple):
    """Request of a view: ``about``, ``sheet`` or ``solution`` (as a page or ``pdf``), ``key``, or
    ``check``."""

    view: str
    seed: int = 0
    lang: str = ""
    form: str = "html"
    variants: int = 0  #: number of variants of a check


class ViewResult(NamedTuple):
    """Requested content, or the reason in one line for which it cannot be shown."""

    content: Any = None
    fault: str = ""


def work(pipe: Connection, folder: str | None, exercise: str) -> None:
    """Answer requests from a pipe with views of an exercise; the first request opens the course."""
    follow_parent()
    _warm_up()
    while True:
        try:
            request = pipe.recv()
        except (EOFError, KeyboardInterrupt):
            return
        pipe.send(_result(folder, exercise, request))


def _warm_up() -> None:
    """Import what every view needs; then let Python ignore compiled files, which miss a second save within
    one second."""

    builtin_renderer().undrawn("a")
    sys.dont_write_bytecode = True
    sys.pycache_prefix = str(Path(__file__).parent / "no such folder")


def _result(folder: str | None, exercise: str, request: ViewRequest) -> ViewResult:
    try:
        return ViewResult(_VIEWS[request.view](folder, exercise, request))
    except CourseworkError as fault:
        return ViewResult(fault=as_message(fault))
    except Exception as fault:  # an author's slip in a function of the course
        return ViewResult(fault=_fault_text(fault, folder))


def _fault_text(fault: Exception, folder: str | None) -> Message:
    problem = Message("{kind}: {problem}", kind=type(fault).__name__, problem=fault)
    root = open_course(folder).folder.root
    frames = [f for f in traceback.extract_tb(fault.__traceback__) if f.filename.startswith(str(root))]
    if not frames:
        return problem
    return Message(
        "{file}, line {line}: {problem}",
        file=Path(frames[-1].filename).relative_to(root).as_posix(),
        line=frames[-1].lineno,
        problem=problem,
    )


def _about(folder: str | None, exercise: str, request: ViewRequest) -> Any:
    loaded = open_course(folder)[exercise]
    return {"languages": list(loaded.languages), "version": loaded.spec.version}


def _sheet(folder: str | None, exercise: str, request: ViewRequest) -> Any:
    return _printed(folder, handout(_variant(folder, exercise, request)), request)


def _solution(folder: str | None, exercise: str, request: ViewRequest) -> Any:
    return _printed(folder, answer_sheet(_variant(folder, exercise, request)), request)


def _printed(folder: str | None, sheet: Handout | AnswerSheet, request: ViewRequest) -> bytes:
    renderer = renderer_of(open_course(folder).folder)
    return renderer.pdf(sheet) if request.form == "pdf" else renderer.html(sheet).encode()


def _variant(folder: str | None, exercise: str, request: ViewRequest) -> Any:
    loaded = open_course(folder)[exercise]
    return loaded.variant(
        request.seed, request.lang if request.lang in loaded.languages else loaded.languages[0]
    )


def _key(folder: str | None, exercise: str, request: ViewRequest) -> Any:
    """Return the given values, the answer of each part, and the result of each known mistake."""
    variant = _variant(folder, exercise, request)
    key = variant.key
    return {
        "given": [
            (name, repr(value), variant.record["given"][name]["unit"])
            for name, value in variant.given.items()
        ],
        "parts": [
            (p.id, p.quantity, str(key.reference[p.quantity]), p.unit, p.kind, p.points)
            for p in variant.parts
        ],
        "mistakes": [
            (name, part.id, str(values[part.quantity]))
            for name, values in key.wrong.items()
            for part in variant.parts
            if values.get(part.quantity) is not None
        ],
    }


def _check(folder: str | None, exercise: str, request: ViewRequest) -> Any:
    report = checks.check(open_course(folder)[exercise], request.variants)
    (row,) = check_report.table([report])
    notes = [str(note) for note in check_report.notes([report])]
    return {
        "passed": report.passed,
        "failures": report.failures[:_MOST_FAILURES],
        "more": max(0, len(report.failures) - _MOST_FAILURES),
        "row": {k: str(v) for k, v in row.items()},
        "notes": notes,
    }


_VIEWS = {"about": _about, "sheet": _sheet, "solution": _solution, "key": _key, "check": _check}
