"""What was issued: ``issued.json``, read back to mark against."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from copy import copy
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from coursework.course.secrecy import Secret
from coursework.errors import BadInput
from coursework.making.identity import Ids, ids_of, run_together, same_id, words_of
from coursework.making.students import folded, unaccented
from coursework.system.json_files import json_of, read_json

if TYPE_CHECKING:
    from coursework.making.assignment import Assignment
    from coursework.making.issuing import Issuable, Issue

ISSUED_FORMAT = 1


class Issued:
    """What was issued: records by exercise and seed, and to whom when there was a roster.

    A record may be of several students, as versions are, and a student may have an exercise in several sittings. Those of
    a pool belong to nobody: a platform draws, and whoever is on the roster may have any.
    """

    def __init__(self, content: Mapping[str, Any], source: str):
        records = content.get("issued") if isinstance(content, Mapping) else None
        if not isinstance(records, list) or not records:
            raise BadInput(f"{source} is no list of issued records; 'coursework build' writes issued.json")
        if isinstance(content, Mapping) and _is_later(content.get("format")):
            raise BadInput(f"{source} was written by a later version of coursework: update the package")
        self.has_roster = bool(content.get("roster"))
        self.is_pool = bool(content.get("pool"))
        self.assignment = _stated(content.get("assignment"), source)
        self.columns: dict[str, Mapping[str, str]] = _columns(content.get("students"), source)
        self.records: dict[tuple[str, int], Mapping[str, Any]] = {}
        self.owners: dict[tuple[str, int], tuple[str, ...]] = {}
        self.versions: dict[
            tuple[str, int], str
        ] = {}  #: letters by exercise and seed, where versions were dealt
        self.seeds: dict[tuple[str, str], int] = {}  #: of the latest sitting
        self._sittings: dict[tuple[str, str], dict[int, int]] = {}  #: seeds by sitting
        self._langs: dict[tuple[str, str, int], str] = {}  #: where another owner reads another language
        alike: dict[tuple[str, str], Any] = {}
        for number, item in enumerate(records, start=1):
            try:
                record, student, sitting = _record_of(item), item.get("student", ""), item.get("sitting", 1)
                key = (record["exercise"], record["seed"])
                # Records of an exercise ask the same; once is enough for all of them.
                usual = alike.get((key[0], record["version"]))
                if usual is None or usual != record["parts"]:
                    _check_parts(record["parts"])
                    usual = alike.setdefault((key[0], record["version"]), record["parts"])
                if usual == record["parts"]:
                    record["parts"] = usual
            except _Unfit as fault:
                raise BadInput(
                    f"{source}, item {number} of {len(records)}: no issued record: {fault}; 'coursework build' writes them"
                ) from fault
            first = self.records.setdefault(key, record)
            if item.get("version"):
                self.versions[key] = item["version"]
            if student:
                if first is not record and first.get("lang") != record.get("lang"):
                    self._langs[student, *key] = str(record.get("lang"))
                self._own(student, key, sitting)
        self.exercises = tuple(dict.fromkeys(exercise for exercise, _ in self.records))
        listed = self.columns if self.is_pool and self.has_roster else ()
        self.students = tuple(dict.fromkeys((*(student for student, _ in self._sittings), *listed)))
        self.has_sittings = any(max(own) > 1 for own in self._sittings.values())
        self._named = frozenset(self.students)
        self._known = {folded(s): s for s in self.students}
        self._people = _People(self.students, self.columns)

    def _own(self, student: str, key: tuple[str, int], sitting: int) -> None:
        exercise, seed = key
        if student not in (owners := self.owners.get(key, ())):
            self.owners[key] = (*owners, student)
        own = self._sittings.setdefault((student, exercise), {})
        own[sitting] = seed
        self.seeds[student, exercise] = own[max(own)]

    @staticmethod
    def read(path: Path) -> Issued:
        """Read ``issued.json``.

        Raises
        ------
        BadInput
            The file is not there, or is not what ``build`` writes.
        """
        return Issued(read_json(path), str(path))

    @staticmethod
    def stood(path: Path) -> Mapping[str, Any]:
        """What an earlier ``issued.json`` says, where others are to be issued.

        Raises
        ------
        BadInput
            The file is not what ``build`` writes.
        """
        content: Mapping[str, Any] = read_json(path)
        try:
            Issued(content, str(path))
        except BadInput as fault:
            raise BadInput(f"{fault}; choose another --out, or --overwrite to replace it") from fault
        return content

    @staticmethod
    def of(data: bytes, source: str) -> Issued:
        """What the bytes of an ``issued.json`` say.

        Raises
        ------
        BadInput
            They are not what ``build`` writes.
        """
        return Issued(json_of(data, source), source)

    def student(self, name: str, ids: Ids | None = None) -> str | None:
        """The student's name as issued, or without a roster as it came first; None for a stranger to the roster.

        ``ids`` are what a platform tells of them: these go before the name, whose words are then in any order.
        """
        if ids and (known := self._people.of_ids(ids)):
            return known
        if name in self._named:
            return name
        if not self.has_roster:
            return self._met(name, ids) if ids else self._known.setdefault(folded(name), name)
        return (
            self._known.get(folded(name))
            or self._people.without_accents(name)
            or (None if ids is None else self._people.called(name))
        )

    def account(self, names: Sequence[str]) -> str | None:
        """The student of the roster whom a platform calls so, by a number, an e-mail or what stands before its @, a login or
        a name; None for a stranger."""
        told = (
            self._people.of_ids([("", n)])
            or self._known.get(folded(n))
            or self._people.without_accents(n)
            or self._people.called(n)
            or self._people.of_mailbox(n)
            for n in names
            if n
        )
        return next(filter(None, told), None) if self.has_roster else None

    def _met(self, name: str, ids: Ids) -> str:
        """Somebody whom no roster names; two of one name are told apart by what identifies them."""
        found = self._known.setdefault(folded(name), name)
        if self.columns.setdefault(found, dict(ids)) != dict(ids):
            found = f"{name} ({ids[0][1]})"
            self.columns[found] = dict(ids)
        self._people.add(found, dict(ids))
        return found

    def issued_to(self, student: str, sitting: int | None = None) -> dict[str, int]:
        """The seeds that a student of the roster was issued, by exercise: of a sitting, else the latest of each."""
        if sitting is None:
            return {e: self.seeds[student, e] for e in self.exercises if (student, e) in self.seeds}
        own = {e: self._sittings.get((student, e), {}) for e in self.exercises}
        return {e: seeds[sitting] for e, seeds in own.items() if sitting in seeds}

    def seeds_of(self, student: str, exercise: str) -> tuple[int, ...]:
        """The seeds of an exercise that a student of the roster was issued, sitting by sitting."""
        own = self._sittings.get((student, exercise), {})
        return tuple(own[sitting] for sitting in sorted(own))

    def sitting_of(self, student: str, exercise: str, seed: int) -> int:
        """In which sitting a student has a variant: the latest, where several have the same one; 1 without a roster."""
        own = self._sittings.get((student, exercise), {})
        return max((sitting for sitting, one in own.items() if one == seed), default=1)

    def of_student(self, student: str) -> Issued:
        """What bears on the sheets of one student alone: what they were issued, and a record of each other exercise."""
        keys = [(e, seed) for e in self.exercises for seed in self.seeds_of(student, e)]
        mine = dict.fromkeys(e for e, _ in keys)
        kept = (*keys, *(key for e, key in self._first.items() if e not in mine))
        own = copy(self)
        own.records = {key: self.records[key] for key in kept}
        own.owners = dict.fromkeys(keys, (student,))
        own.versions = {key: self.versions[key] for key in keys if key in self.versions}
        own.seeds = {(student, e): self.seeds[student, e] for e in mine}
        own._sittings = {(student, e): self._sittings[student, e] for e in mine}
        own._langs = {place: lang for key in keys if (lang := self._langs.get(place := (student, *key)))}
        own.columns = {student: self.columns[student]} if student in self.columns else {}
        own.students, own._named = (student,), frozenset({student})
        own._known, own._people = {folded(student): student}, _People((student,), own.columns)
        return own

    @cached_property
    def _first(self) -> dict[str, tuple[str, int]]:
        """A variant of each exercise."""
        return {exercise: (exercise, seed) for exercise, seed in reversed(self.records)}

    def record_of(self, student: str, exercise: str, seed: int) -> Mapping[str, Any]:
        """The record of a variant, in the student's language."""
        record = self.records[exercise, seed]
        lang = self._langs.get((student, exercise, seed))
        return record if lang is None else {**record, "lang": lang}


class _People:
    """Students by what platforms tell of them; what two of them have in common tells nobody."""

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
        for one in ids_of(columns):
            _enter(self._by_id, one, student)
            if "@" in one:
                _enter(self._by_mailbox, one.partition("@")[0], student)

    def of_ids(self, ids: Ids) -> str | None:
        return next(filter(None, (self._by_id.get(same_id(value)) for _, value in ids if value)), None)

    def of_mailbox(self, name: str) -> str | None:
        """The student whose e-mail begins so, before its @."""
        return self._by_mailbox.get(same_id(name))

    def without_accents(self, name: str) -> str | None:
        """Return the only student whose name differs in accents alone."""
        return self._unaccented.get(unaccented(name))

    def called(self, name: str) -> str | None:
        """The student of a name whose words are in another order, or run together."""
        return self._by_words.get(words_of(name)) or self._together.get(folded(name))


def _enter(found: dict[Any, str | None], key: Any, student: str) -> None:
    found[key] = student if found.get(key, student) == student else None


class _Unfit(ValueError):
    """What is no issued record."""


#: What stands in an item and in its record, and what it is; of an item nothing need be there.
_ITEM = {"student": str, "sitting": int, "version": str}
_RECORD = {"exercise": str, "seed": int, "version": int, "parts": list, "given": dict, "lang": str}
_CALLED = {str: "a text", int: "a whole number, 0 or more", list: "a list", dict: "an object"}


def _record_of(item: Any) -> dict[str, Any]:
    """The record of an item, both of the shape that a build gives them.

    Raises
    ------
    _Unfit
        One is not.
    """
    record = item.get("record") if isinstance(item, dict) else None
    if not isinstance(record, dict):
        raise _Unfit("it has no record")
    for name, kind in _ITEM.items():
        if name in item:
            _check_kind(name, item[name], kind)
    for name, kind in _RECORD.items():
        if name in record or name != "lang":
            _check_kind(name, record.get(name), kind)
    return record


def _check_kind(name: str, value: Any, kind: type) -> None:
    if type(value) is not kind or (isinstance(value, int) and value < 0):
        found = "nothing" if value is None else repr(value)[:40]
        raise _Unfit(f"{name} is {_CALLED[kind]}; found {found}")


def _check_parts(parts: Sequence[Any]) -> None:
    """Parts have ids, points, and, of choices, their order."""
    met = set()
    for part in parts:
        if not isinstance(part, dict):
            raise _Unfit(f"a part is an object; found {str(part)[:40]!r}")
        _check_kind("id of a part", part.get("id"), str)
        if part["id"] in met:
            raise _Unfit(f"it has the part {part['id'][:40]!r} twice")
        met.add(part["id"])
        if not _is_size(part.get("points")):
            raise _Unfit(
                f"points of {part['id'][:40]!r} are a number above 0; found {str(part.get('points'))[:40]!r}"
            )
        choices = part.get("choices", [])
        if not isinstance(choices, list) or not all(isinstance(c, str) for c in choices):
            raise _Unfit(f"choices of {part['id'][:40]!r} are texts; found {str(choices)[:40]!r}")


def _is_later(written: Any) -> bool:
    return isinstance(written, int) and written > ISSUED_FORMAT


def _stated(content: Any, source: str) -> Mapping[str, Any] | None:
    """What the file says of its assignment; None for a build of exercises alone."""
    if content is None:
        return None
    fits = isinstance(content, Mapping) and isinstance(content.get("exercises"), list)
    mark = content.get("mark") if fits else None
    if mark is not None:
        fits = isinstance(mark, Mapping) and all(_is_size(mark.get(n)) for n in ("of", "step"))
    if not fits:
        raise BadInput(f"{source}: its assignment is none; 'coursework build FILE.toml' writes it")
    return dict(content)


def _is_size(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and 0 < value < math.inf


def _columns(content: Any, source: str) -> dict[str, Mapping[str, str]]:
    """The columns of the roster, by student."""
    if content is None:
        return {}
    if not isinstance(content, Mapping) or not all(isinstance(own, Mapping) for own in content.values()):
        raise BadInput(f"{source}: its students are no columns by name; 'coursework build' writes them")
    return {str(s): {str(c): str(v) for c, v in own.items()} for s, own in content.items()}


SECRET = "secret"  #: under which an instructor's ``issued.json`` holds that of its assignment


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
        raise BadInput(f"{source}: {fault}; restore the line from a copy of the file") from None


def without_secret(content: Mapping[str, Any]) -> dict[str, Any]:
    """Return what an ``issued.json`` says to whoever only marks."""
    return {key: value for key, value in content.items() if key != SECRET}


def issued_content(
    issues: Sequence[Issue], assignment: Assignment | None = None, secret: Secret | None = None
) -> dict[str, Any]:
    """What ``issued.json`` says: who got which record. No answers. With a ``secret``, it is the instructor's alone."""
    columns = {i.student: dict(i.columns) for i in issues if i.student and i.columns}
    return {
        "format": ISSUED_FORMAT,
        "roster": any(i.student for i in issues),
        **({} if assignment is None else {"assignment": assignment.stated()}),
        **({} if secret is None else {SECRET: secret.text}),
        **({"students": columns} if columns else {}),
        "issued": [_item(i) for i in issues],
    }


def _item(issue: Issue) -> dict[str, Any]:
    """One record, and whose it is."""
    sitting = {} if issue.sitting == 1 else {"sitting": issue.sitting}
    version = {"version": issue.version} if issue.version else {}
    return {"student": issue.student, **sitting, **version, "record": issue.variant.record}


def plain_value(value: Any) -> Any:
    """A quantity as JSON holds it: an array as lists, a complex number as the text ``3+4j``, which is an answer too."""
    if isinstance(value, (complex, np.complexfloating)):
        return str(complex(value)).strip("()")
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def _as_it_is(value: Any, margin: float | None = None) -> Any:
    return value


def record_with_answers(variant: Issuable, told: Callable[..., Any] = _as_it_is) -> dict[str, Any]:
    """The record and, by part, the reference answer with its unit and accepted half-width.

    ``told`` gives a number as it is to be told, of a reference and its half-width; full precision unless told.

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
            "value": plain_value(told(value, width)),
            "unit": part.unit,
            "tolerance": plain_value(told(width)),
        }
    return {**variant.record, "answers": answers}


#: Of a number in the key, significant ones: counted from the largest component of its answer, or from its margin where
#: that is larger. Those behind them differ from one processor to another.
KEY_DIGITS = 10


def key_content(issues: Iterable[Issue]) -> list[dict[str, Any]]:
    """What ``key.json`` says: the issued records with their answers, to :data:`KEY_DIGITS`."""
    return [{"student": i.student, **record_with_answers(i.variant, _in_key)} for i in issues]


def _in_key(value: Any, margin: float | None = None) -> Any:
    """A number of an answer, or an array of them, to the digits of the key; anything else as it is."""
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
    kept = np.array([round(number, decimals) + 0.0 for number in numbers.tolist()]).view(array.dtype)
    return kept[0].item() if array.ndim == 0 else kept.reshape(array.shape)


def key_rows(key: Iterable[Mapping[str, Any]]) -> Iterator[dict[str, Any]]:
    """The lines of ``key.csv``."""
    for record in key:
        for part, answer in record["answers"].items():
            value = answer["value"]
            shown = "; ".join(f"{v!r}" for v in value) if isinstance(value, list) else value
            yield {
                "student": record["student"],
                "exercise": record["exercise"],
                "seed": record["seed"],
                "part": part,
                "value": "" if shown is None else shown,
                "unit": answer["unit"],
                "tolerance": "" if answer["tolerance"] is None else answer["tolerance"],
            }


def form_rows(issues: Iterable[Issue]) -> Iterator[dict[str, Any]]:
    """The lines of ``answers.csv``: an empty form to fill."""
    for issued in issues:
        for part in issued.variant.parts:
            yield {
                "student": issued.student,
                "exercise": issued.variant.exercise.name,
                "seed": issued.variant.seed,
                "part": part.id,
                "answer": "",
            }


COLUMNS = ("student", "exercise", "seed", "part", "answer")
