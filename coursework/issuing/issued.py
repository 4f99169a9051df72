"""Record of issued variants, ``issued.json``, read back for marking."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from copy import copy
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.course.secrecy import Secret
from coursework.errors import BadInput
from coursework.issuing.identity import GROUP, Ids, ids_of, is_called, run_together, same_id, words_of
from coursework.issuing.students import folded, unaccented
from coursework.messages import Message
from coursework.system.json_files import json_of, read_json

if TYPE_CHECKING:
    from coursework.issuing.assignment import Assignment
    from coursework.issuing.issuing import Issuable, Issue

ISSUED_FORMAT = 1


class Issued:
    """Record of issued variants: by exercise and seed, and by student if there was a roster.

    Several students may share a record, as with versions, and a student may have an exercise in several
    sittings. The records of a pool belong to nobody: a platform draws, and every student may get any of them.

    As long as an assignment is anonymous, students go by their codes, unless the record is read ``by_name``;
    a name or an identifier still leads to its code.
    """

    def __init__(self, content: Mapping[str, Any], source: str, *, by_name: bool = False):
        records = content.get("issued") if isinstance(content, Mapping) else None
        if not isinstance(records, list) or not records:
            raise BadInput(
                "{source} is not a list of issued records; 'coursework build' writes issued.json",
                source=source,
            )
        if isinstance(content, Mapping) and _is_later(content.get("format")):
            raise BadInput(
                "{source} was written by a later version of coursework: update the package", source=source
            )
        self.has_roster = bool(content.get("roster"))
        self.is_pool = bool(content.get("pool"))
        self.assignment = _stated(content.get("assignment"), source)
        #: Columns of the roster that the summary repeats; None: all but private ones.
        self.carry: Sequence[str] | None = (self.assignment or {}).get("carry")
        self.columns: dict[str, Mapping[str, str]] = _columns(content.get("students"), source)
        self.records: dict[tuple[str, int], Mapping[str, Any]] = {}
        self.owners: dict[tuple[str, int], tuple[str, ...]] = {}
        self.versions: dict[tuple[str, int], str] = {}  #: letters by exercise and seed, if there are versions
        self.seeds: dict[tuple[str, str], int] = {}  #: of the latest sitting
        self._sittings: dict[tuple[str, str], dict[int, int]] = {}  #: seeds by sitting
        self._langs: dict[tuple[str, str, int], str] = {}  #: of owners with another language
        alike: dict[tuple[str, str], Any] = {}
        for number, item in enumerate(records, start=1):
            try:
                record, student, sitting = _record_of(item), item.get("student", ""), item.get("sitting", 1)
                key = (record["exercise"], record["seed"])
                # Records of an exercise have the same parts; one copy is enough.
                usual = alike.get((key[0], record["version"]))
                if usual is None or usual != record["parts"]:
                    _check_parts(record["parts"])
                    usual = alike.setdefault((key[0], record["version"]), record["parts"])
                if usual == record["parts"]:
                    record["parts"] = usual
            except _Unfit as fault:
                raise BadInput(
                    (
                        "{source}, item {number} of {count} is not an issued record: {problem}; "
                        "'coursework build' writes "
                        "them"
                    ),
                    source=source,
                    number=number,
                    count=len(records),
                    problem=fault,
                ) from fault
            first = self.records.setdefault(key, record)
            if item.get("version"):
                self.versions[key] = item["version"]
            if student:
                if first is not record and first.get("lang") != record.get("lang"):
                    self._langs[student, *key] = str(record.get("lang"))
                self._add_owner(student, key, sitting)
        self.exercises = tuple(dict.fromkeys(exercise for exercise, _ in self.records))
        listed = self.columns if self.is_pool and self.has_roster else ()
        self.students = tuple(dict.fromkeys((*(student for student, _ in self._sittings), *listed)))
        codes = _codes(content, source) or {
            s: cells[CODE] for s, cells in self.columns.items() if CODE in cells
        }
        self._codes = {code_key(code): name for name, code in codes.items()}
        self._shown: dict[str, str] = {}  #: codes in place of names
        self.has_sittings = any(max(seeds) > 1 for seeds in self._sittings.values())
        self._named = frozenset(self.students)
        self._known = {folded(s): s for s in self.students}
        self._people = _People(self.students, self.columns)
        if not by_name:
            self._show(codes_shown(content))

    def _show(self, codes: Mapping[str, str]) -> None:
        """Show codes in place of names everywhere, and of the columns of the roster the groups alone."""
        if not codes:
            return
        self._shown = dict(codes)
        self.owners = {key: tuple(codes.get(s, s) for s in names) for key, names in self.owners.items()}
        self.seeds = {(codes.get(s, s), e): seed for (s, e), seed in self.seeds.items()}
        self._sittings = {(codes.get(s, s), e): seeds for (s, e), seeds in self._sittings.items()}
        self._langs = {(codes.get(s, s), *key): lang for (s, *key), lang in self._langs.items()}  # type: ignore[misc]
        self.columns = {
            codes.get(s, s): {title: text for title, text in cells.items() if is_called(title, GROUP)}
            for s, cells in self.columns.items()
        }
        # In the order of the codes: that of the roster would tell who is who.
        self.students = tuple(sorted(codes.get(s, s) for s in self.students))
        self._named = frozenset(codes.values())

    def by_codes(self, codes: Mapping[str, str]) -> Issued:
        """Return the record with codes in place of names, by student."""
        coded = copy(self)
        coded._show(codes)
        return coded

    @property
    def is_anonymous(self) -> bool:
        """Return whether codes stand in place of names."""
        return bool(self._shown)

    def renamed(self, name: str) -> str:
        """Return a name or a code of an earlier table as the record shows the student now; any other text as
        it is."""
        return (self.student(name) or name) if self._codes and name else name

    def _add_owner(self, student: str, key: tuple[str, int], sitting: int) -> None:
        exercise, seed = key
        if student not in (owners := self.owners.get(key, ())):
            self.owners[key] = (*owners, student)
        seeds = self._sittings.setdefault((student, exercise), {})
        seeds[sitting] = seed
        self.seeds[student, exercise] = seeds[max(seeds)]

    @staticmethod
    def read(path: Path) -> Issued:
        """Read ``issued.json``.

        Raises
        ------
        BadInput
            The file is missing, or was not written by ``build``.
        """
        return Issued(read_json(path), str(path))

    @staticmethod
    def read_previous(path: Path) -> Mapping[str, Any]:
        """Return the content of an earlier ``issued.json`` before more variants are issued.

        Raises
        ------
        BadInput
            The file was not written by ``build``.
        """
        content: Mapping[str, Any] = read_json(path)
        try:
            Issued(content, str(path))
        except BadInput as fault:
            raise BadInput(
                "{problem}; choose another --out, or --overwrite to replace it", problem=fault
            ) from fault
        return content

    @staticmethod
    def of(data: bytes, source: str, *, by_name: bool = False) -> Issued:
        """Return the record of the bytes of an ``issued.json``.

        Raises
        ------
        BadInput
            They were not written by ``build``.
        """
        return Issued(json_of(data, source), source, by_name=by_name)

    def student(self, name: str, ids: Ids | None = None) -> str | None:
        """Return the student's name as issued, or, without a roster, as first seen; None for a name that is
        not on the roster.

        ``ids`` are the identifiers from a platform; they take precedence over the name, whose words may then
        be in any order.
        """
        if self._shown and name in self._named:
            return name
        if self._codes and (coded := self._codes.get(code_key(name))):
            return self._shown.get(coded, coded)
        return self._as_shown(self._found(name, ids))

    def _found(self, name: str, ids: Ids | None) -> str | None:
        if ids and (match := self._people.of_ids(ids)):
            return match
        if name in self._named:
            return name
        if not self.has_roster:
            return self._newcomer(name, ids) if ids else self._known.setdefault(folded(name), name)
        return (
            self._known.get(folded(name))
            or self._people.without_accents(name)
            or (None if ids is None else self._people.with_words(name))
        )

    def account(self, names: Sequence[str]) -> str | None:
        """Return the student of the roster for a platform's account: by number, e-mail or its part before @,
        login or name; None if there is none."""
        matches = (
            self._people.of_ids([("", n)])
            or self._known.get(folded(n))
            or self._people.without_accents(n)
            or self._people.with_words(n)
            or self._people.of_mailbox(n)
            for n in names
            if n
        )
        return self._as_shown(next(filter(None, matches), None) if self.has_roster else None)

    def _as_shown(self, name: str | None) -> str | None:
        return name and self._shown.get(name, name)

    def _newcomer(self, name: str, ids: Ids) -> str:
        """Return the name of a student without a roster; people of the same name are distinguished by an
        identifier."""
        known_name = self._known.setdefault(folded(name), name)
        if self.columns.setdefault(known_name, dict(ids)) != dict(ids):
            known_name = f"{name} ({ids[0][1]})"
            self.columns[known_name] = dict(ids)
        self._people.add(known_name, dict(ids))
        return known_name

    def issued_to(self, student: str, sitting: int | None = None) -> dict[str, int]:
        """Return the seeds issued to a student of the roster, by exercise: of a sitting, else of the latest
        one."""
        if sitting is None:
            return {e: self.seeds[student, e] for e in self.exercises if (student, e) in self.seeds}
        by_exercise = {e: self._sittings.get((student, e), {}) for e in self.exercises}
        return {e: seeds[sitting] for e, seeds in by_exercise.items() if sitting in seeds}

    def seeds_of(self, student: str, exercise: str) -> tuple[int, ...]:
        """Return the seeds of an exercise issued to a student of the roster, sitting by sitting."""
        seeds = self._sittings.get((student, exercise), {})
        return tuple(seeds[sitting] for sitting in sorted(seeds))

    def sitting_of(self, student: str, exercise: str, seed: int) -> int:
        """Return the sitting in which a student has a variant: the latest if there are several; 1 without a
        roster."""
        seeds = self._sittings.get((student, exercise), {})
        return max((sitting for sitting, issued_seed in seeds.items() if issued_seed == seed), default=1)

    def of_student(self, student: str) -> Issued:
        """Return the part of the record for one student: the issued variants, and one record of each other
        exercise."""
        keys = [(e, seed) for e in self.exercises for seed in self.seeds_of(student, e)]
        mine = dict.fromkeys(e for e, _ in keys)
        record_keys = (*keys, *(key for e, key in self._first.items() if e not in mine))
        part = copy(self)
        part.records = {key: self.records[key] for key in record_keys}
        part.owners = dict.fromkeys(keys, (student,))
        part.versions = {key: self.versions[key] for key in keys if key in self.versions}
        part.seeds = {(student, e): self.seeds[student, e] for e in mine}
        part._sittings = {(student, e): self._sittings[student, e] for e in mine}
        part._langs = {
            owner_key: lang for key in keys if (lang := self._langs.get(owner_key := (student, *key)))
        }
        part.columns = {student: self.columns[student]} if student in self.columns else {}
        part.students, part._named = (student,), frozenset({student})
        part._known, part._people = {folded(student): student}, _People((student,), part.columns)
        return part

    def among(self, students: Collection[str]) -> Issued:
        """Return the record as it is for some of the students: all variants, and nothing else of the
        others."""
        part = copy(self)
        part.has_roster = True
        part.students = tuple(student for student in self.students if student in students)
        part._named, part._known = frozenset(part.students), {folded(s): s for s in part.students}
        part.columns = {
            student: self.columns[student] for student in part.students if student in self.columns
        }
        part._people = _People(part.students, part.columns)
        part.owners = {
            key: mine
            for key, owners in self.owners.items()
            if (mine := tuple(student for student in owners if student in part._named))
        }
        part.seeds = {key: seed for key, seed in self.seeds.items() if key[0] in part._named}
        part._sittings = {key: seeds for key, seeds in self._sittings.items() if key[0] in part._named}
        return part

    @cached_property
    def _first(self) -> dict[str, tuple[str, int]]:
        """Return a variant of each exercise."""
        return {exercise: (exercise, seed) for exercise, seed in reversed(self.records)}

    def record_of(self, student: str, exercise: str, seed: int) -> Mapping[str, Any]:
        """Return the record of a variant, in the student's language."""
        record = self.records[exercise, seed]
        lang = self._langs.get((student, exercise, seed))
        return record if lang is None else {**record, "lang": lang}


class _People:
    """Students by their identifiers on platforms; an identifier that two students share identifies nobody."""

    def __init__(self, students: Iterable[str], columns: Mapping[str, Mapping[str, str]]):
        self._by_id: dict[str, str | None] = {}
        self._by_words: dict[tuple[str, ...], str | None] = {}
        self._together: dict[str, str | None] = {}
        self._by_mailbox: dict[str, str | None] = {}
        self._unaccented: dict[str, str | None] = {}
        for student in students:
            self.add(student, columns.get(student, {}))
            _enter(self._by_words, words_of(student), student)
            _enter(self._unaccented, unaccented(student), student)
            for name in run_together(student):
                _enter(self._together, name, student)

    def add(self, student: str, columns: Mapping[str, str]) -> None:
        for identifier in ids_of(columns):
            _enter(self._by_id, identifier, student)
            if "@" in identifier:
                _enter(self._by_mailbox, identifier.partition("@")[0], student)

    def of_ids(self, ids: Ids) -> str | None:
        return next(filter(None, (self._by_id.get(same_id(value)) for _, value in ids if value)), None)

    def of_mailbox(self, name: str) -> str | None:
        """Return the student whose e-mail has this part before the @."""
        return self._by_mailbox.get(same_id(name))

    def without_accents(self, name: str) -> str | None:
        """Return the only student whose name differs in accents alone."""
        return self._unaccented.get(unaccented(name))

    def with_words(self, name: str) -> str | None:
        """Return the student whose name has these words in another order or without spaces."""
        return self._by_words.get(words_of(name)) or self._together.get(folded(name))


def _enter(students: dict[Any, str | None], key: Any, student: str) -> None:
    students[key] = student if students.get(key, student) == student else None


class _Unfit(ValueError):
    """Error of content that is not an issued record."""


#: Fields of an item and of its record, with their types; those of an item are optional.
_ITEM = {"student": str, "sitting": int, "version": str}
_RECORD = {"exercise": str, "seed": int, "version": int, "parts": list, "given": dict, "lang": str}
_KIND_NAMES = {
    str: Message("a text"),
    int: Message("a whole number, 0 or more"),
    list: Message("a list"),
    dict: Message("an object"),
}


def _record_of(item: Any) -> dict[str, Any]:
    """Return the record of an item, after checking both. Raises _Unfit: one is not."""
    record = item.get("record") if isinstance(item, dict) else None
    if not isinstance(record, dict):
        raise _Unfit(Message("it has no record"))
    for name, kind in _ITEM.items():
        if name in item:
            _check_kind(name, item[name], kind)
    for name, kind in _RECORD.items():
        if name in record or name != "lang":
            _check_kind(name, record.get(name), kind)
    return record


def _check_kind(name: str, value: Any, kind: type) -> None:
    if type(value) is not kind or (isinstance(value, int) and value < 0):
        text = Message("nothing") if value is None else repr(value)[:40]
        raise _Unfit(
            Message("{name} is {kind}; found {found}", name=name, kind=_KIND_NAMES[kind], found=text)
        )


def _check_parts(parts: Sequence[Any]) -> None:
    """Raise if parts lack ids or points, or if choices are not texts."""
    met = set()
    for part in parts:
        if not isinstance(part, dict):
            raise _Unfit(Message("a part is an object; found {found!r}", found=str(part)[:40]))
        _check_kind("id of a part", part.get("id"), str)
        if part["id"] in met:
            raise _Unfit(Message("it has the part {part!r} twice", part=part["id"][:40]))
        met.add(part["id"])
        if not _is_size(part.get("points")):
            raise _Unfit(
                Message(
                    "points of {part!r} are a number above 0; found {found!r}",
                    part=part["id"][:40],
                    found=str(part.get("points"))[:40],
                )
            )
        choices = part.get("choices", [])
        if not isinstance(choices, list) or not all(isinstance(c, str) for c in choices):
            raise _Unfit(
                Message(
                    "choices of {part!r} are texts; found {found!r}",
                    part=part["id"][:40],
                    found=str(choices)[:40],
                )
            )


def _is_later(written: Any) -> bool:
    return isinstance(written, int) and written > ISSUED_FORMAT


def _stated(content: Any, source: str) -> Mapping[str, Any] | None:
    """Return the assignment's fields; None for a build of single exercises."""
    if content is None:
        return None
    fits = isinstance(content, Mapping) and isinstance(content.get("exercises"), list)
    mark = content.get("mark") if fits else None
    if mark is not None:
        fits = isinstance(mark, Mapping) and all(_is_size(mark.get(n)) for n in ("of", "step"))
    if not fits:
        raise BadInput(
            "{source}: the assignment in it is not valid; 'coursework build FILE.toml' writes it",
            source=source,
        )
    return dict(content)


def _is_size(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and 0 < value < math.inf


def _columns(content: Any, source: str) -> dict[str, Mapping[str, str]]:
    """Return the columns of the roster, by student."""
    if content is None:
        return {}
    if not isinstance(content, Mapping) or not all(isinstance(row, Mapping) for row in content.values()):
        raise BadInput(
            "{source}: the students in it have no columns by name; 'coursework build' writes them",
            source=source,
        )
    return {str(s): {str(c): str(v) for c, v in row.items()} for s, row in content.items()}


CODES = "codes"  #: key of the codes that stand on anonymous papers, by student
CODE = "anonymous code"  #: column of the roster in a database that holds the code of a student
LIFTED = "lifted"  #: key of the day on which names took their place again


def code_key(code: str) -> str:
    """Return a code as it is compared: without case, spaces and dashes."""
    return re.sub(r"[\W_]", "", code).upper()


def codes_shown(content: Mapping[str, Any]) -> Mapping[str, str]:
    """Return the codes by student that stand in place of names; none once anonymity is lifted."""
    return {} if content.get(LIFTED) else content.get(CODES) or {}


def _codes(content: Mapping[str, Any], source: str) -> Mapping[str, str]:
    codes = content.get(CODES) or {}
    if not isinstance(codes, Mapping) or not all(isinstance(code, str) for code in codes.values()):
        raise BadInput(
            "{source}: the codes in it are not texts by student; 'coursework build' writes them",
            source=source,
        )
    return codes


SECRET = "secret"  #: key of the assignment's secret in an instructor's ``issued.json``


def secret_of(content: Mapping[str, Any] | None, source: str = "what was issued") -> Secret | None:
    """Return the secret that an ``issued.json`` holds; None where it holds none.

    Raises
    ------
    BadInput
        It holds something else; the message does not quote it.
    """
    text = (content or {}).get(SECRET)
    try:
        return None if text is None else Secret.of(text)
    except ValueError as fault:
        raise BadInput(
            "{source}: {problem}; restore the line from a copy of the file", source=source, problem=fault
        ) from None


def without_secret(content: Mapping[str, Any]) -> dict[str, Any]:
    """Return an ``issued.json`` without the secret and the codes, for marking."""
    return {key: value for key, value in content.items() if key not in (SECRET, CODES, LIFTED)}


def issued_content(
    issues: Sequence[Issue],
    assignment: Assignment | None = None,
    secret: Secret | None = None,
    lifted: str = "",
) -> dict[str, Any]:
    """Return the content of ``issued.json``: the record of each student, without answers. With a ``secret``,
    or with codes, the file is for the instructor only; ``lifted`` is the day on which names took the place of
    codes."""
    codes = {i.student: i.code for i in issues if i.code}
    columns = {i.student: dict(i.columns) for i in issues if i.student and i.columns}
    return {
        "format": ISSUED_FORMAT,
        "roster": any(i.student for i in issues),
        **({} if assignment is None else {"assignment": assignment.stated()}),
        **({} if secret is None else {SECRET: secret.text}),
        **({CODES: codes} if codes else {}),
        **({LIFTED: lifted} if lifted else {}),
        **({"students": columns} if columns else {}),
        "issued": [_item(i) for i in issues],
    }


def _item(issue: Issue) -> dict[str, Any]:
    """Return one record with its student."""
    sitting = {} if issue.sitting == 1 else {"sitting": issue.sitting}
    version = {"version": issue.version} if issue.version else {}
    return {"student": issue.student, **sitting, **version, "record": issue.variant.record}


def items_of_papers(content: Mapping[str, Any]) -> list[list[Mapping[str, Any]]]:
    """Return the items of an ``issued.json`` paper by paper: an exercise alone if there is no assignment.

    Papers without a name follow each other, each with the exercises of the assignment.
    """
    exercises = (content.get("assignment") or {}).get("exercises")
    papers: dict[tuple[Any, ...], list[Mapping[str, Any]]] = {}
    for number, item in enumerate(content["issued"]):
        owner = str(item.get("student", "")), int(item.get("sitting", 1))
        one = number if exercises is None else -1 if owner[0] else number // max(1, len(exercises))
        papers.setdefault((*owner, one), []).append(item)
    return list(papers.values())


def plain_value(value: Any) -> Any:
    """Return a quantity as JSON: an array as lists, a complex number as the text ``3+4j``, which is also a
    valid answer."""
    if isinstance(value, (complex, np.complexfloating)):
        return str(complex(value)).strip("()")
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def _as_it_is(value: Any, margin: float | None = None) -> Any:
    return value


def record_with_answers(variant: Issuable, rounded: Callable[..., Any] = _as_it_is) -> dict[str, Any]:
    """Return the record and, by part, the reference answer with its unit and accepted half-width.

    ``rounded`` maps a number and its half-width to the number to write; full precision by default.

    Raises
    ------
    NoSolution
        The course folder has no solutions.
    """
    key = variant.key
    answers = {}
    for part in variant.parts:
        value = None if part.sort.is_open else key.reference[part.quantity]
        width = key.half_width(part) if part.has_margin else None
        answers[part.id] = {
            "value": plain_value(rounded(value, width)),
            "unit": part.unit,
            "tolerance": plain_value(rounded(width)),
        }
    return {**variant.record, "answers": answers}


#: Significant digits of a number in the key, counted from the largest component of its answer, or from its
#: margin if that is larger. Further digits differ between processors.
KEY_DIGITS = 10


def key_content(issues: Iterable[Issue]) -> list[dict[str, Any]]:
    """Return the content of ``key.json``: the issued records with their answers, to :data:`KEY_DIGITS`."""
    return [{"student": i.shown, **record_with_answers(i.variant, _in_key)} for i in by_code(issues)]


def _in_key(value: Any, margin: float | None = None) -> Any:
    """Return a number or an array rounded to the digits of the key; other values as they are."""
    if not isinstance(value, (float, complex, np.inexact, np.ndarray)):
        return value
    array = np.asarray(value)
    if array.dtype.kind not in "fc":
        return value
    numbers = np.atleast_1d(array).ravel().view(float)
    size = max([margin or 0.0, *np.abs(numbers[np.isfinite(numbers)]).tolist()])
    if not size:
        return value
    decimals = KEY_DIGITS - 1 - math.floor(math.log10(size))
    rounded = np.array([round(number, decimals) + 0.0 for number in numbers.tolist()]).view(array.dtype)
    return rounded[0].item() if array.ndim == 0 else rounded.reshape(array.shape)


def key_rows(key: Iterable[Mapping[str, Any]]) -> Iterator[dict[str, Any]]:
    """Yield the rows of ``key.csv``."""
    for record in key:
        for part, answer in record["answers"].items():
            value = answer["value"]
            text = "; ".join(f"{v!r}" for v in value) if isinstance(value, list) else value
            yield {
                "student": record["student"],
                "exercise": record["exercise"],
                "seed": record["seed"],
                "part": part,
                "value": "" if text is None else text,
                "unit": answer["unit"],
                "tolerance": "" if answer["tolerance"] is None else answer["tolerance"],
            }


def by_code(issues: Iterable[Issue]) -> list[Issue]:
    """Return the issued variants in the order of the codes, which tells nothing of the names; as they are
    without codes."""
    return sorted(issues, key=lambda issue: (issue.code, issue.sitting if issue.code else 0))


def form_rows(issues: Iterable[Issue]) -> Iterator[dict[str, Any]]:
    """Yield the rows of ``answers.csv``, an empty form."""
    for issued in by_code(issues):
        for part in issued.variant.parts:
            yield {
                "student": issued.shown,
                "exercise": issued.variant.exercise.name,
                "seed": issued.variant.seed,
                "part": part.id,
                "answer": "",
            }


COLUMNS = ("student", "exercise", "seed", "part", "answer")
NOT_ASKED = "—"  #: in a table with a column for each question, what a paper does not ask
