"""Reading what comes back: CSV, JSON and notebooks of answers. Answers are data: nothing is run.

Every row of every file comes out, as a :class:`Row` or as a :class:`Rejected` with its reason.
"""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from coursework.errors import BadInput, closest
from coursework.tables import as_written, decode, delimiter_of, record

COLUMNS = ("student", "exercise", "seed", "part", "answer")
ENDINGS = (".csv", ".json", ".ipynb", ".parquet")
MAX_BYTES = 1_000_000_000  #: of one file of answers


class Row(NamedTuple):
    """One answer as it came."""

    student: str
    exercise: str
    seed: str
    part: str
    answer: Any  #: a text, a number, or None
    source: str  #: file and place, for reports
    warning: str = ""
    lang: str = ""  #: of the sheet that it was written on, where that is told


@dataclass(frozen=True)
class Rejected:
    """One row, or one file, that cannot be marked, and why."""

    source: str
    reason: str
    row: dict[str, str] = field(default_factory=dict)


def find(paths: Iterable[Path]) -> Iterator[Path | Rejected]:
    """The files to read, folders walked in name order.

    Raises
    ------
    BadInput
        One of the paths is not there.
    """
    paths = tuple(paths)
    for path in paths:
        if not path.exists():
            raise BadInput(f"no such file or folder: {path}{_beside(path)}")
    for path in paths:
        if path.is_dir():
            files = sorted(p for p in path.rglob("*") if p.is_file() and not _is_hidden(p, path))
            yield from (p if p.suffix.lower() in ENDINGS else _odd_file(p) for p in files)
            if not files:
                yield Rejected(str(path), "the folder holds no file")
        elif path.suffix.lower() not in ENDINGS:
            yield _odd_file(path)
        else:
            yield path


def _beside(path: Path) -> str:
    """The file or folder that may have been meant, if one of nearly that name is there."""
    names = [p.name for p in path.parent.iterdir()] if path.parent.is_dir() else []
    near = closest(path.name, names)
    if near is None:
        return ""
    meant = path.with_name(near)
    return f" (did you mean {meant}{'/' if meant.is_dir() else ''}?)"


def _is_hidden(path: Path, below: Path) -> bool:
    return any(part.startswith(".") for part in path.relative_to(below).parts)


def _odd_file(path: Path) -> Rejected:
    return Rejected(str(path), f"answers come as {', '.join(ENDINGS)}; found {path.suffix or 'no ending'}")


def read_file(path: Path) -> Iterator[Row | Rejected]:
    """The rows of one file; a file that cannot be read is one rejected row."""
    if path.suffix.lower() == ".parquet":
        yield from _read_parquet(path)
        return
    reader = {".csv": _read_csv, ".json": _read_json, ".ipynb": _read_notebook}[path.suffix.lower()]
    try:
        size = path.stat().st_size
        if size > MAX_BYTES:
            yield Rejected(str(path), f"{size:,} bytes are too many for answers; the limit is {MAX_BYTES:,}")
            return
        data = path.read_bytes()
    except OSError as fault:
        yield Rejected(str(path), f"cannot be read: {fault.strerror}")
        return
    yield from reader(data, str(path))


def _decoded(data: bytes, source: str) -> tuple[str, str]:
    """The text, and a warning that names its file."""
    text, warning = decode(data)
    return text, f"{source}: {warning}" if warning else ""


def _whole(text: str) -> str:
    """The text without halves of characters, which no file can hold."""
    return text.encode("utf-8", "replace").decode("utf-8")


# ------------------------------------------------------------------------- text


def _read_csv(data: bytes, source: str) -> Iterator[Row | Rejected]:
    if not data.strip():
        yield Rejected(source, "the file is empty")
        return
    text, warning = _decoded(data, source)
    if "\0" in text:
        yield Rejected(source, "the file holds NUL bytes: it is not a CSV of answers")
        return
    lines = re.split(r"\r\n|\n|\r", text)
    del text
    delimiter = delimiter_of(lines[0])
    header: list[str] = []
    columns: list[int] = []
    number = 0
    while number < len(lines):
        place = f"{source}, line {number + 1}"
        cells, taken = record(lines, number, delimiter, len(header))
        number += taken
        if not any(c.strip() for c in cells):
            continue  # a blank line is no row
        if header:
            yield from _csv_row(header, cells, delimiter, place, warning)
            # Lines that are plain, as nearly all are, without more ado.
            while number < len(lines) and '"' not in lines[number]:
                cells = lines[number].split(delimiter)
                if len(cells) != len(header):
                    break
                number += 1
                if any(map(str.strip, cells)):
                    yield _row_of(cells, columns, f"{source}, line {number}", warning)
            continue
        header = [c.strip().casefold() for c in cells]
        missing = [c for c in COLUMNS if c not in header]
        if missing:
            found = ", ".join(c for c in header if c) or "nothing"
            wanted = f"the header must name {', '.join(COLUMNS)}; {', '.join(missing)} missing, found {found}"
            yield Rejected(place, wanted)
            return
        columns = [header.index(c) for c in COLUMNS]


def _row_of(cells: Sequence[str], columns: Sequence[int], place: str, warning: str) -> Row:
    student, exercise, seed, part, answer = (cells[i] for i in columns)
    if "'" in (student[:1], answer[:1]):
        student, answer = as_written(student), as_written(answer)
    return Row(student.strip(), exercise.strip(), seed.strip(), part.strip(), answer, place, warning)


def _read_parquet(path: Path) -> Iterator[Row | Rejected]:
    """The rows of a Parquet file with the columns of the CSV; the seed and the answer may be numbers."""
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError:
        yield Rejected(
            str(path), "Parquet needs pyarrow, which is not installed: pip install 'coursework[parquet]'"
        )
        return
    try:
        file = parquet.ParquetFile(path)
        missing = [c for c in COLUMNS if c not in file.schema_arrow.names]
        if missing:
            wanted = f"a Parquet file has the columns {', '.join(COLUMNS)}; {', '.join(missing)} missing"
            yield Rejected(str(path), wanted)
            return
        number = 0
        for batch in file.iter_batches(columns=list(COLUMNS)):
            for student, exercise, seed, part, answer in zip(
                *(batch.column(c).to_pylist() for c in COLUMNS), strict=True
            ):
                number += 1
                names = (_name(student), _name(exercise), _name(seed), _name(part))
                yield Row(*names, _as_answer(answer), f"{path}, row {number}")
    except (OSError, pyarrow.ArrowException) as fault:
        yield Rejected(str(path), f"not a Parquet file: {_short(fault)}")


def _csv_row(
    header: list[str], cells: list[str], delimiter: str, place: str, warning: str
) -> Iterator[Row | Rejected]:
    row = dict(zip(header, cells, strict=False))
    if len(cells) != len(header):
        kept = {c: row.get(c, "") for c in COLUMNS}
        reason = f"{len(cells)} cells where the header has {len(header)}"
        if delimiter == "," and len(cells) > len(header):
            reason += "; put an answer with a comma between quotation marks, or semicolons between all cells"
        yield Rejected(place, reason, kept)
        return
    yield _row_of([row[c] for c in COLUMNS], range(len(COLUMNS)), place, warning)


# ------------------------------------------------------------------------- JSON


def _read_json(data: bytes, source: str) -> Iterator[Row | Rejected]:
    text, warning = _decoded(data, source)
    try:
        content = _load_json(text)
    except (ValueError, RecursionError) as fault:
        yield Rejected(source, f"not JSON: {_short(fault)}")
        return
    sheets = content if isinstance(content, list) else [content]
    if not sheets:
        yield Rejected(source, "the file holds no answers")
    for number, sheet in enumerate(sheets, start=1):
        place = f"{source}, item {number}" if isinstance(content, list) else source
        if not isinstance(sheet, dict) or not isinstance(sheet.get("answers"), dict):
            yield Rejected(place, 'an item is {"student", "exercise", "seed", "answers": {part: text}}')
            continue
        yield from _sheet_rows(sheet, sheet["answers"], place, warning)


class _Repeated(dict):
    """A JSON object and the pairs that repeat a key of it."""

    repeats: tuple[tuple[Any, Any], ...] = ()


def _load_json(text: str) -> Any:
    """JSON whose objects remember the keys that they repeat; numbers of absurd length stay texts."""
    return json.loads(text, object_pairs_hook=_object, parse_int=_whole_number)


def _whole_number(digits: str) -> Any:
    return int(digits) if len(digits) < 400 else digits


def _object(pairs: list[tuple[Any, Any]]) -> dict[Any, Any]:
    first: dict[Any, Any] = {}
    repeats = []
    for key, value in pairs:
        if key in first:
            repeats.append((key, value))
        else:
            first[key] = value
    if not repeats:
        return first
    found = _Repeated(first)
    found.repeats = tuple(repeats)
    return found


def _sheet_rows(
    about: dict[str, Any], answers: dict[Any, Any], place: str, warning: str
) -> Iterator[Row | Rejected]:
    names = {c: _name(about.get(c)) for c in ("student", "exercise", "seed")}
    if not answers:
        yield Rejected(place, "the sheet holds no answer", {**names, "part": "", "answer": ""})
    for key, value in [*answers.items(), *getattr(answers, "repeats", ())]:
        part, answer = _name(key), _as_answer(value)
        where = f"{place}, part {part[:40]}"
        if isinstance(answer, (dict, set, bytes)):
            row = {**names, "part": part, "answer": _text_of(answer)[:200]}
            yield Rejected(where, "an answer is a text or a number", row)
            continue
        lang = _name(about.get("lang"))
        yield Row(**names, part=part, answer=answer, source=where, warning=warning, lang=lang)


def _as_answer(answer: Any) -> Any:
    """An answer as it is marked: coordinates joined, numbers too long for any reader as texts."""
    if isinstance(answer, (list, tuple)):
        return "; ".join(_text_of(a) for a in answer)
    if isinstance(answer, str):
        return _whole(answer)
    if isinstance(answer, int) and not isinstance(answer, bool) and abs(answer) >= 10**400:
        return _text_of(answer)
    return answer


def _text_of(value: Any) -> str:
    try:
        return _whole(str(value))
    except ValueError:  # an integer of too many digits
        return "a number of very many digits"


def _name(value: Any) -> str:
    return "" if value is None else _text_of(value).strip()


def _short(fault: BaseException) -> str:
    return str(fault).split("\n")[0][:120]


# --------------------------------------------------------------------- notebook


def _read_notebook(data: bytes, source: str) -> Iterator[Row | Rejected]:
    text, warning = _decoded(data, source)
    try:
        notebook = _load_json(text)
    except (ValueError, RecursionError) as fault:
        yield Rejected(source, f"not a notebook: {_short(fault)}")
        return
    about = notebook.get("metadata", {}) if isinstance(notebook, dict) else {}
    about = about.get("coursework") if isinstance(about, dict) else None
    cells = notebook.get("cells") if isinstance(notebook, dict) else None
    if not isinstance(about, dict) or not isinstance(cells, list):
        yield Rejected(source, "not a notebook of ours: its metadata names no exercise")
        return
    tagged = [c for c in cells if isinstance(c, dict) and "answers" in _tags(c)]
    if len(tagged) != 1:
        found = "\n".join(_code(c) for c in cells if isinstance(c, dict) and c.get("cell_type") == "code")
        row = _about(about, source) | {"answer": found.strip()[:200]}
        yield Rejected(source, f"one cell must be tagged 'answers'; found {len(tagged)}", row)
        return
    code = _code(tagged[0])
    answers = literal_answers(code)
    if isinstance(answers, str):
        yield Rejected(source, answers, _about(about, source) | {"answer": code[:200]})
        return
    about, warning = _with_name(about, answers, source, warning)
    yield from _sheet_rows(about, answers, source, warning)


def _with_name(
    about: dict[str, Any], answers: dict[Any, Any], source: str, warning: str
) -> tuple[dict[str, Any], str]:
    """A notebook that was nobody's: the name its reader wrote among the answers, or else the file's."""
    written = _name(answers.pop("student", None))
    if _name(about.get("student")):
        return about, warning
    if written:
        return {**about, "student": written}, warning
    note = "a notebook holds no name; its file's name stands for it"
    return {**about, "student": Path(source).stem}, warning or note


def _about(about: dict[str, Any], source: str) -> dict[str, str]:
    """What a notebook says of itself; one that was nobody's is called as its file."""
    named = {c: _name(about.get(c)) for c in ("student", "exercise", "seed")}
    return {**named, "student": named["student"] or Path(source).stem, "part": "", "answer": ""}


def _code(cell: dict[str, Any]) -> str:
    code = cell.get("source", "")
    return "".join(map(str, code)) if isinstance(code, list) else str(code)


def _tags(cell: dict[str, Any]) -> list[Any]:
    metadata = cell.get("metadata")
    tags = metadata.get("tags") if isinstance(metadata, dict) else None
    return tags if isinstance(tags, list) else []


def literal_answers(code: str) -> dict[Any, Any] | str:
    """The dict that an answers cell holds, or what is wrong with the cell. Nothing is run.

    ``answers = {…}`` or a bare ``{…}`` of texts, numbers, None, and lists or tuples of these. A value that is none of
    them is the text that stands there; a cell that is no Python is read line by line.
    """
    if len(code) > 200_000:
        return "the answers cell is too long to be read"
    code = re.sub(r"\r\n?", "\n", code)
    try:
        statements = ast.parse(code).body
    except _NO_PYTHON:
        return _answers_by_line(code)
    if len(statements) != 1:
        return f"the answers cell must hold one dict and nothing else; found {len(statements)} statements"
    statement = statements[0]
    value = statement.value if isinstance(statement, (ast.Assign, ast.AnnAssign, ast.Expr)) else None
    if not isinstance(value, ast.Dict):
        return "the answers cell must hold one dict and nothing else; found code, which is never run"
    try:
        return _object(_pairs(value, code))
    except _NO_PYTHON:
        return "the answers cell must hold texts and numbers only; found code, which is never run"


_NO_PYTHON = (SyntaxError, ValueError, TypeError, RecursionError, MemoryError)


def _pairs(found: ast.Dict, code: str) -> list[tuple[Any, Any]]:
    lines = [line.encode("utf-8", "replace") for line in code.split("\n")]

    def value(node: ast.expr) -> Any:
        try:
            return ast.literal_eval(node)
        except _NO_PYTHON:
            taken = lines[node.lineno - 1 : node.end_lineno]
            taken[-1] = taken[-1][: node.end_col_offset]
            taken[0] = taken[0][node.col_offset :]
            return b"\n".join(taken).decode("utf-8", "replace")

    if None in found.keys:
        raise ValueError("** is code")
    return [(value(key), value(item)) for key, item in zip(found.keys, found.values, strict=True)]


_OPENS = re.compile(r"(?:\w+\s*=\s*)?\{\s*")
_KEY = re.compile(r"""(["'])([^"']+)\1\s*:\s*""")
_QUOTED = re.compile(r"""(["'])([^"']*)\1""")


def _answers_by_line(code: str) -> dict[Any, Any] | str:
    """The answers of a cell that is no Python, each on its line as in the notebook, or which line is not."""
    pairs: list[tuple[Any, Any]] = []
    is_open = is_closed = False
    line = number = 0
    for number, line in enumerate(map(str.strip, code.split("\n")), start=1):
        text = line
        if not is_open and (opening := _OPENS.match(text)):
            is_open, text = True, text[opening.end() :]
        if not text or text.startswith("#"):
            continue
        found = None if is_closed or not is_open else _pairs_of_line(text)
        if found is None and is_open and not is_closed and text.endswith("}"):
            is_closed, text = True, text[:-1].rstrip()
            found = _pairs_of_line(text) if text else []
        if found is None:
            return _not_as_written(number, line)
        pairs += found
    return _object(pairs) if pairs else _not_as_written(number, str(line))


def _pairs_of_line(line: str) -> list[tuple[Any, Any]] | None:
    """The answers of a line; None where they cannot be told apart."""
    code = f"{{{line}\n}}"
    with suppress(*_NO_PYTHON):
        found = ast.parse(code, mode="eval").body
        return _pairs(found, code) if isinstance(found, ast.Dict) else None
    key = _KEY.match(line)
    if key is None:
        return None
    quoted = _QUOTED.match(line, key.end())
    rest = line[quoted.end() if quoted else key.end() :].partition("#")[0].strip().removesuffix(",").rstrip()
    if quoted:
        return [(key[2], quoted[2])] if not rest else None
    bare = rest[1:] if rest[:1] in ("'", '"') else rest
    bare = bare[:-1] if bare[-1:] in ("'", '"') else bare
    return [(key[2], bare.strip())] if not set(bare) & set("\"'{}:") else None


def _not_as_written(number: int, line: str) -> str:
    key = _KEY.match(line)
    part = f", part {key[2][:40]}" if key else ""
    return (
        f"the answers cell, line {number}{part}, is not written as in the notebook: quotes around text, "
        f"a comma after each answer; found {line[:40]!r}"
    )
