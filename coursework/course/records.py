"""Records of variants: what is issued, stored and marked against; no answer is in one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

from coursework.errors import BadInput
from coursework.model import Exercise, Part


class Recorded(NamedTuple):
    """Content of a variant's record."""

    seed: int
    given: dict[str, Any]
    lang: str
    parts: tuple[Part, ...]
    record: dict[str, Any] | None  #: as it was issued, where the exercise has a later version now
    orders: dict[str, tuple[str, ...]]  #: of choices, by part; a sheet printed letters where there is one


class Records:
    """Reads records of one exercise; remembers which parts they ask, since records of one build ask the
    same."""

    def __init__(self, name: str, spec: Exercise):
        self.name = name
        self.spec = spec
        self._parts: dict[tuple[tuple[tuple[str, float], ...], bool], tuple[Part, ...]] = {}

    def read(self, record: Mapping[str, Any]) -> Recorded:
        """Return the content of a record that was issued.

        Raises
        ------
        BadInput
            The record is of another exercise or a later version, lacks a given quantity, or asks a
            part that is no more.
        """
        name, current = self.name, self.spec.version
        if record.get("exercise") != name:
            raise BadInput("a record of {get!r} was given to {name!r}", get=record.get("exercise"), name=name)
        version = record.get("version")
        if not isinstance(version, int) or version > current:
            raise BadInput(
                "{name}: the record is of version {version}, the course has version {current}; mark it "
                "with the course it was issued from",
                name=name,
                version=version,
                current=current,
            )
        try:
            given = {n: self._recorded(record["given"], n, version < current) for n in self.spec.given}
            seed = int(record["seed"])
            points = {str(part["id"]): _points(part["points"]) for part in record["parts"]}
            orders = {
                str(part["id"]): tuple(part["choices"]) for part in record["parts"] if "choices" in part
            }
        except (KeyError, TypeError, ValueError) as fault:
            raise BadInput("{name}: a record lacks {fault}", name=name, fault=fault) from fault
        for quantity, value in given.items():
            self._check_recorded(quantity, value)
        parts = self._parts_of(tuple(points.items()), version < current)
        for part in parts:
            self._check_order(part, orders.get(part.id, ()))
        issued = dict(record) if version < current else None
        return Recorded(seed, given, str(record.get("lang", "fr")), parts, issued, orders)

    def _recorded(self, given: Mapping[str, Any], name: str, older: bool) -> Any:
        """Return a given value as issued; what an older version did not have yet is its default."""
        default = self.spec.given[name].default
        if older and name not in given and default is not None:
            return default
        return given[name]["value"]

    def _parts_of(self, points_asked: tuple[tuple[str, float], ...], older: bool) -> tuple[Part, ...]:
        """Return the parts that a record asks, by id, worth what it says: an assignment may say so, or an
        older version."""
        if (points_asked, older) not in self._parts:
            points = dict(points_asked)
            gone = [i for i in points if self.spec.part(i) is None]
            if gone:
                template = (
                    "{name}: a record of an older version asks {gone!r}, which the course no longer "
                    "has; mark it with the course it was issued from"
                    if older
                    else "{name}: a record of this version asks {gone!r}, which the course does not have; "
                    "mark it with the course it was issued from"
                )
                raise BadInput(template, name=self.name, gone=gone[0])
            # A record asks what it lists, in its order, whatever the exercise asks of these values now.
            by_id = {p.id: p for p in self.spec.parts}
            parts = tuple(
                p
                if p.points == points[p.id] and p.when is None
                else replace(p, points=points[p.id], when=None)
                for p in map(by_id.__getitem__, points)
            )
            self._parts[points_asked, older] = parts
        return self._parts[points_asked, older]

    def _check_order(self, part: Part, order: tuple[str, ...]) -> None:
        strangers = [case for case in order if case not in part.choices]
        if strangers:
            raise BadInput(
                "{name}: a record offers {case!r} for {part!r}, whose choices are {choices}; mark it "
                "with the course it was issued from",
                name=self.name,
                case=strangers[0],
                part=part.id,
                choices=", ".join(part.choices),
            )
        if len(set(order)) < len(order):
            raise BadInput(
                "{name}: a record offers a case twice for {part!r}; mark it with the course it was "
                "issued from",
                name=self.name,
                part=part.id,
            )

    def _check_recorded(self, name: str, value: Any) -> None:
        spec = self.spec.given[name]
        fits = value in spec.choices if spec.is_choice else isinstance(value, (int, float))
        if not fits or isinstance(value, bool):
            raise BadInput(
                "{name}: a record states {name_2} = {value!r}, which is not one of its values",
                name=self.name,
                name_2=name,
                value=value,
            )


def _points(value: Any) -> float:
    """Return points as a record has them: a whole number stays one, so that the record is written as it was
    read."""
    return value if isinstance(value, int) and not isinstance(value, bool) else float(value)
