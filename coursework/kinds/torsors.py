"""Base of twists and wrenches: two columns, each judged by its own largest component, and their exchange.

A torsor is an array of six: the resultant in the basis of the question before the moment at its point. A
plane one, in the plane xy, is an array of three: ``(vx, vy, wz)`` of a twist, ``(X, Y, N)`` of a wrench.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, ClassVar

import numpy as np

from coursework.kinds.kind import AnswerSpelling, Asking, ComponentBox, Kind, Stated, Tick
from coursework.kinds.nearness import in_half_widths, offset
from coursework.kinds.ticks import share_of_named
from coursework.language.numbers import significant
from coursework.language.words import listed, words
from coursework.parsing.reading import Reading
from coursework.parsing.torsors import TorsorForm, component_place, read_pattern, read_torsor

_UNITS = (1e-3, 1e3)  #: metres for millimetres
_PARALLEL = 1e-9  #: of what is square to the resultant but for rounding


class Torsor(Kind):
    """Components at a point, right where each is within the half-width of its own column.

    The half-width of a column is the larger of ``atol`` and ``rtol`` times the largest component of the
    reference there; that of the moments is the envelope where that is wider. ``unit`` is that of the moments,
    ``of_resultant`` goes with it.
    """

    is_followed = of_largest = share_stands = has_cells = True
    rank = 1
    box = "line"
    family = "torsor"
    faults: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("unknown_symbol", "two_values", "not_a_number", "wrong_count", "wrong_shape", "wrong_torsor"),
        "not_torsor",
    )
    form: ClassVar[TorsorForm]

    def of_resultant(self, unit: str) -> str:
        """Return the unit of the resultant where ``unit`` is that of the moments."""
        raise NotImplementedError

    def units(self, unit: str) -> tuple[str, ...]:
        return self.of_resultant(unit), unit

    def units_asked(self, part: Stated, asking: Asking) -> tuple[int, ...]:
        names = self._names(len(asking.reference(part.quantity)))
        return tuple(dict.fromkeys(self._column(name) for name in names))

    def cells(self, part: Stated, asking: Asking) -> tuple[tuple[ComponentBox, ...], ...]:
        """Return a group for each column; one for a plane torsor."""
        names, units = self._names(len(asking.reference(part.quantity))), self.units(part.unit)
        cells = tuple(ComponentBox(_symbol(name), units[self._column(name)]) for name in names)
        return (cells,) if len(cells) == 3 else (cells[:3], cells[3:])

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        units = (self.of_resultant(part.unit), part.unit)
        return read_torsor(answer, self.form, units, len(asking.reference(part.quantity)))

    # ------------------------------------------------------------------ judging

    def _places(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the indices of the resultant and of the moments in an array of 6, or of 3."""
        order = np.array(self.form.plane if count == 3 else range(6))
        return np.flatnonzero(order < 3), np.flatnonzero(order >= 3)

    def _gaps(self, part: Stated, value: Any, reference: Any, envelope: float) -> np.ndarray:
        """Return the deviation of each component, in half-widths of its column."""
        reference = np.asarray(reference, dtype=float)
        gaps = None if np.shape(value) != reference.shape else offset(value, reference)
        if gaps is None:
            return np.full(reference.shape, math.inf)
        scaled, largest = np.zeros(reference.shape), float(np.max(np.abs(reference)))
        for places, room in zip(self._places(len(reference)), (0.0, envelope), strict=True):
            size = float(np.max(np.abs(reference[places])))
            width = max(part.half_width(size), room)
            scaled[places] = [in_half_widths(abs(float(g)), width, size or largest) for g in gaps[places]]
        return scaled

    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        return float(np.max(self._gaps(part, value, reference, envelope)))

    def size(self, reference: Any) -> float:
        """Return the largest moment: the margin that is printed is that of the second column; of a torsor
        without moments, the resultant."""
        absolute = np.abs(np.asarray(reference, dtype=float))
        return float(np.max(absolute[self._places(len(absolute))[1]])) or float(np.max(absolute))

    def is_trivial(self, value: Any) -> bool:
        return not np.any(value)

    def share(self, part: Stated, value: Any, reference: Any) -> float:
        """Return the share of components that are right, noughts too; none where nothing that is not 0 is
        right."""
        right = self._gaps(part, value, reference, 0.0) <= 1
        return float(np.mean(right)) if np.any(right & (np.asarray(reference) != 0)) else 0.0

    def remarks(self, part: Stated, value: Any, reference: Any, lang: str) -> Iterator[tuple[str, str]]:
        wrong = self._gaps(part, value, reference, 0.0) > 1
        if self.share(part, value, reference) and np.any(wrong):
            names = itertools.compress(self._names(len(reference)), wrong)
            yield words(lang)["marking"]["components"], listed([f"${_symbol(name)}$" for name in names], lang)

    def slips(self, part: Stated, value: Any, reference: Any, numbers: Mapping[str, float]) -> Iterator[str]:
        value, reference = np.asarray(value, dtype=float), np.asarray(reference, dtype=float)
        if value.shape != reference.shape or not np.all(np.abs(value) < math.sqrt(np.finfo(float).max)):
            return
        for name, wrong in self._wrong(reference):
            if self.distance(part, wrong, reference) > 1 and self.distance(part, value, wrong) <= 1:
                yield name
                return
        if self._is_at_another_point(part, value, reference):
            yield "other_point"

    def _wrong(self, reference: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
        yield "sign", -reference
        moment = self._places(len(reference))[1]
        turned = reference.copy()
        turned[moment] *= -1
        yield "moment_sign", turned
        if len(reference) == 6:
            yield "columns", np.roll(reference, 3)
        for factor in _UNITS:
            scaled = reference.copy()
            scaled[moment] *= factor
            yield "unit", scaled

    def _is_at_another_point(self, part: Stated, value: np.ndarray, reference: np.ndarray) -> bool:
        """Return whether the answer is the same torsor at some other point: its resultant is right, and the
        moments differ perpendicularly to it."""
        (resultant, moment), (_, moved) = self._vectors(reference), self._vectors(value)
        size = float(np.linalg.norm(resultant))
        places = self._places(len(reference))[0]
        if not size or np.any(self._gaps(part, value, reference, 0.0)[places] > 1):
            return False
        change = moved - moment
        along = abs(float(change @ resultant)) / size
        width = part.half_width(float(np.max(np.abs(np.concatenate((moment, moved))))))
        return along <= max(width, _PARALLEL * float(np.linalg.norm(change)))

    def _vectors(self, value: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Resultant and moment in space."""
        spatial = value
        if len(value) == 3:
            spatial = np.zeros(6)
            spatial[list(self.form.plane)] = value
        return spatial[:3], spatial[3:]

    def others(self, part: Stated, value: Any, half_width: float) -> tuple[Any, ...]:
        just_off = np.array(value, dtype=float)
        moments = self._places(len(just_off))[1]
        just_off[moments[0]] += 1.3 * (
            part.half_width(float(np.max(np.abs(just_off[moments])))) or half_width or 1.0
        )
        return just_off, 1.13 * np.asarray(value)

    # ----------------------------------------------------------------- printing

    def formula(self, value: np.ndarray, number: Callable[[float], str]) -> str:
        cells: list[str] = ["-"] * 6
        for index, component in zip(
            self.form.plane if len(value) == 3 else range(6), value.tolist(), strict=True
        ):
            cells[index] = number(component)
        return _table(cells)

    # ------------------------------------------------- paper that is read back

    def coordinates(self, part: Stated, asking: Asking) -> tuple[str, ...]:
        return tuple(_symbol(name) for name in self._names(len(asking.reference(part.quantity))))

    def _names(self, count: int) -> tuple[str, ...]:
        """Return the components of an array of 6, or of a plane one of 3."""
        return tuple(self.form.names[index] for index in (self.form.plane if count == 3 else range(6)))

    def _column(self, name: str) -> int:
        """Return 0 for a component of the resultant, 1 for one of the moment."""
        return self.form.names.index(name) // 3

    def joined(self, texts: Sequence[str], part: Stated, asking: Asking) -> str:
        """Components by name: in ``1,5; 2,5; 3,5`` each row might hold two."""
        return "; ".join(
            f"{name} = {text}" for name, text in zip(self._names(len(texts)), texts, strict=True)
        )

    def from_paper(self, texts: Sequence[str], part: Stated, asking: Asking, *, unit: bool = False) -> str:
        """Components by name; the ticked unit is that of both columns, and stands behind each of them."""
        units = self.units(part.unit) if unit else ("", "")
        names = zip(self._names(len(texts)), texts, strict=True)
        return self.joined(
            [f"{text} {units[self._column(name)]}".strip() for name, text in names], part, asking
        )

    # ----------------------------------------------------------------- students

    def written(self, value: Any, digits: int, label: Callable[[str], str]) -> str:
        numbers = [significant(v, digits) for v in np.asarray(value).tolist()]
        if len(numbers) == 3:
            return "(" + " ; ".join(numbers) + ")"
        return "{" + "; ".join(f"{a} {b}" for a, b in zip(numbers[:3], numbers[3:], strict=True)) + "}"

    def spellings(self, part: Stated, value: Any, label: Callable[[str], str]) -> Iterator[AnswerSpelling]:
        yield from super().spellings(part, value, label)
        plain = np.asarray(value).tolist()
        if len(plain) == 6:
            first, second = plain[:3], plain[3:]
            yield AnswerSpelling("lists", [first, second])
            yield AnswerSpelling("rows", [list(row) for row in zip(first, second, strict=True)])
            yield AnswerSpelling(
                "columns", f"{{{' '.join(map(repr, first))} | {' '.join(map(repr, second))}}}"
            )
            inner = r" \\ ".join(f"{a!r} & {b!r}" for a, b in zip(first, second, strict=True))
            yield AnswerSpelling("latex", rf"\begin{{Bmatrix}} {inner} \end{{Bmatrix}}")
        else:
            names = self._names(3)
            yield AnswerSpelling(
                "named", "; ".join(f"{n} = {v!r}" for n, v in zip(names, plain, strict=True))
            )


class Pattern(Kind):
    """Components of a torsor that may differ from zero: right where exactly those are named.

    The solution gives their names in one text, ``"wz vx"``; ``"0"`` where all vanish.
    """

    is_exact = is_text = has_rule = share_stands = True
    has_symbol = is_called_by_symbol = False
    box = "line"
    family = "pattern"
    field = "ticks"
    has_several_ticks = True
    wrong = "wrong_case"
    faults: ClassVar[Mapping[str, str]] = {"wrong_torsor": "not_pattern", "unknown_symbol": "not_pattern"}
    form: ClassVar[TorsorForm]

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        return read_pattern(answer, self.form)

    def keys(self, part: Stated) -> tuple[str, ...]:
        return self.form.names

    def kept(self, read_as: str) -> Any:
        return self.components(read_as)

    def ticks(self, part: Stated, asking: Asking) -> tuple[Tick, ...]:
        return (*(Tick(name, f"${_symbol(name)}$") for name in self.form.names), Tick("0", ""))

    def from_paper(self, boxes: Sequence[str], part: Stated, asking: Asking, *, unit: bool = False) -> str:
        return ", ".join(boxes)

    def components(self, value: Any) -> frozenset[str]:
        """Return the names that a reference holds, ``"wz vx"``, or a set of them."""
        if isinstance(value, (set, frozenset, tuple, list)):
            return frozenset(map(str, value))
        names = str(value).replace(",", " ").replace(";", " ").split()
        places = {component_place(name, self.form) for name in names if name != "0"}
        return frozenset(self.form.names[index] for index in places if index is not None)

    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        return 0.0 if self.components(value) == self.components(reference) else math.inf

    def share(self, part: Stated, value: Any, reference: Any) -> float:
        return share_of_named(self.components(value), self.components(reference), len(self.form.names))

    def slips(self, part: Stated, value: Any, reference: Any, numbers: Mapping[str, float]) -> Iterator[str]:
        right, named = self.components(reference), self.components(value)
        names = self.form.names
        if named != right and named == {names[(names.index(name) + 3) % 6] for name in right}:
            yield "columns"
        elif named != right and named == set(names) - right:
            yield "complement"

    def others(self, part: Stated, value: Any, half_width: float) -> tuple[Any, ...]:
        return (" ".join(sorted(self.components(value) ^ {self.form.names[0]})) or "0",)

    def latex(self, value: str, symbols: Mapping[str, str]) -> str:
        components = self.components(value)
        return _table([_symbol(name) if name in components else "0" for name in self.form.names])

    def written(self, value: Any, digits: int, label: Callable[[str], str]) -> str:
        components = self.components(value)
        cells = [name if name in components else "0" for name in self.form.names]
        return "{" + "; ".join(f"{a} {b}" for a, b in zip(cells[:3], cells[3:], strict=True)) + "}"

    def spellings(self, part: Stated, value: Any, label: Callable[[str], str]) -> Iterator[AnswerSpelling]:
        components = self.components(value)
        marks = [int(name in components) for name in self.form.names]
        yield AnswerSpelling("exact", ", ".join(sorted(components)) or "0")
        yield AnswerSpelling("printed", self.written(value, 4, label))
        yield AnswerSpelling("marks", [marks[:3], marks[3:]])


def _table(cells: list[str]) -> str:
    rows = r" \\ ".join(f"{a} & {b}" for a, b in zip(cells[:3], cells[3:], strict=True))
    return rf"\left\{{\begin{{matrix}} {rows} \end{{matrix}}\right\}}"


def _symbol(name: str) -> str:
    stem, axis = r"\omega" if name[0] == "w" else name[0], name[1:]
    return f"{stem}_{axis}" if axis else stem
