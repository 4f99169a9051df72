"""Records of variants: what is issued, stored and marked against; no answer is in one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from coursework.errors import BadInput
from coursework.model import Part
from coursework.variant import Variant

if TYPE_CHECKING:
    from coursework.exercise import CourseExercise


class Records:
    """Reads records of one exercise; remembers which parts they ask, since records of one build ask the same."""

    def __init__(self, exercise: CourseExercise):
        self.exercise = exercise
        self._parts: dict[tuple[tuple[tuple[str, float], ...], bool], tuple[Part, ...]] = {}

    def variant(self, record: Mapping[str, Any]) -> Variant:
        """The variant that a record issued; see :meth:`~coursework.exercise.CourseExercise.from_record`."""
        name, current = self.exercise.name, self.exercise.version
        if record.get("exercise") != name:
            raise BadInput(f"a record of {record.get('exercise')!r} was given to {name!r}")
        version = record.get("version")
        if not isinstance(version, int) or version > current:
            raise BadInput(
                f"{name}: the record is of version {version}, the course has version {current}; "
                "mark it with the course it was issued from"
            )
        try:
            given = {n: record["given"][n]["value"] for n in self.exercise.spec.given}
            seed = int(record["seed"])
            asked = {str(part["id"]): float(part["points"]) for part in record["parts"]}
        except (KeyError, TypeError, ValueError) as fault:
            raise BadInput(f"{name}: a record lacks {fault}") from fault
        for quantity, value in given.items():
            self._check_recorded(quantity, value)
        parts = self._parts_of(tuple(asked.items()), version < current)
        variant = Variant(self.exercise, seed, given, str(record.get("lang", "fr")), parts)
        if version < current:
            variant.__dict__["record"] = dict(record)
        return variant

    def _parts_of(self, asked: tuple[tuple[str, float], ...], older: bool) -> tuple[Part, ...]:
        """The parts that a record asks, by id; those of an older version are worth what they were then."""
        if (asked, older) not in self._parts:
            points = dict(asked)
            gone = [i for i in points if self.exercise.spec.part(i) is None]
            if gone:
                raise BadInput(
                    f"{self.exercise.name}: a record of {'an older' if older else 'this'} version asks {gone[0]!r}, which the "
                    f"course {'no longer has' if older else 'does not have'}; mark it with the course it was issued from"
                )
            found = tuple(p for p in self.exercise.spec.parts if p.id in points)
            if older:
                found = tuple(replace(p, points=points[p.id]) for p in found)
            self._parts[asked, older] = found
        return self._parts[asked, older]

    def _check_recorded(self, name: str, value: Any) -> None:
        spec = self.exercise.spec.given[name]
        fits = value in spec.choices if spec.is_choice else isinstance(value, (int, float))
        if not fits or isinstance(value, bool):
            raise BadInput(
                f"{self.exercise.name}: a record gives {name} = {value!r}, which is no value of it"
            )
