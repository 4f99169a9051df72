"""Equations of loops judged for what they say, not for how they are written.

The poses of a mechanism form a surface in the space of its symbols, and the equations of a loop are a basis
of what holds there. An equation is right for the loop when it holds at every pose and its gradient there is a
combination of the gradients of the reference equations: moved sides, another axis of projection, a factor,
one unknown eliminated, a complex form, all at once. Two answers about one loop are right together when their
combinations are independent. An equation whose gradient vanishes at the poses (a square) says nothing there,
and is not right.

Poses are those of the exercise's own first variants, so that a form that holds on the mechanism's branch is
right. What is wrong is looked up among the faults of :mod:`coursework.quantities.loops`: each has poses of
its own, at which whoever made it has an equation that holds.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from coursework.errors import BadCourse, CourseworkError
from coursework.marking.judges import Verdict
from coursework.parsing.equations import Equation, parse_equation, value_or_nan
from coursework.parsing.equivalence import same_equation
from coursework.parsing.reading import Reading
from coursework.parsing.trees import Expression, Operation
from coursework.quantities.loops import Loop, LoopFault
from coursework.solution import Judged

if TYPE_CHECKING:
    from coursework.course.exercise import CourseExercise
    from coursework.course.variant import Variant
    from coursework.model import Part


_VARIANTS = 12
_STEP = 1e-5
_ZERO = 1e-8  #: of an equation's usual size
_ROUNDING = 1e-12  #: of the size of an equation's sides
_NONE = 1e-5  #: of a gradient, and of what leaves a combination
_OFF = 2  #: points off the surface for each pose
_NEWTON = 12  #: steps
_FAULTY = 4  #: poses of a fault


class Finding(NamedTuple):
    """Judgement of one equation of a loop.

    ``rank``: how many independent equations of the loop it holds; 0 when it is not right. ``rows``: their
    coefficients on the reference equations at each pose, shape (poses, 2, 2). ``fault`` and ``names``: what
    is missed and about which symbols, where it is known.
    """

    rank: int
    rows: np.ndarray | None = None
    fault: str = ""
    names: tuple[str, ...] = ()


@dataclass(frozen=True)
class _Points:
    """Places in the space of the symbols, by name; angles in radians."""

    values: Mapping[str, np.ndarray]
    count: int

    def gap(self, equation: Equation) -> np.ndarray:
        return equation.gap(self.values, self.count)[0]

    def scaled(self, names: frozenset[str], factor: float) -> _Points:
        """With some values multiplied: angles as numbers of degrees."""
        return _Points({n: v * factor if n in names else v for n, v in self.values.items()}, self.count)


class LoopJudge:
    """Judges equations in given symbols against one loop of an exercise, or its derivative of an order."""

    def __init__(self, exercise: CourseExercise, loop: str, order: int, symbols: Sequence[str]) -> None:
        solution = exercise.solution
        self.loop: Loop = solution.loops[loop]
        self.order, self.symbols = order, tuple(symbols)
        self.angles = frozenset(n for other in solution.loops.values() for n in other.angles)
        given = exercise.spec.given
        fixed = {n for n in self.symbols if n in given and given[n].is_fixed}
        self._free = tuple(n for n in self.symbols if n not in fixed)
        self._poses = self._found_poses(exercise)
        self._sizes = {
            n: np.float64(1.0) if n in self.angles else np.sqrt(np.mean(v**2)) or np.float64(1.0)
            for n, v in self._poses.values.items()
        }
        self.finding = lru_cache(maxsize=4096)(self._finding)

    def _found_poses(self, exercise: CourseExercise) -> _Points:
        """Return the first variants of the exercise, solved."""
        variants = exercise.variants(range(_VARIANTS))
        names = [n for n in exercise.spec.given if n in exercise.quantity_names]
        given = {n: np.array([v.given[n] for v in variants]) for n in names}
        columns_found = exercise.solve(**given, only=self.symbols, effects=exercise.spec.effects)
        columns = {
            n: np.broadcast_to(np.asarray(v, dtype=float), (_VARIANTS,)) for n, v in columns_found.items()
        }
        finite = np.all([np.isfinite(v) for v in columns.values()], axis=0)
        if not finite.any():
            raise BadCourse(f"{exercise.name}: no loop closes in its first {_VARIANTS} variants")
        return _Points(
            {n: np.radians(v[finite]) if n in self.angles else v[finite] for n, v in columns.items()},
            int(finite.sum()),
        )

    @cached_property
    def _near(self) -> _Points:
        """The poses, then places off the surface beside each."""
        rng = np.random.default_rng(1)
        return self._joined([self._poses.values, *(self._off(rng) for _ in range(_OFF))])

    @cached_property
    def _steps(self) -> _Points:
        """From each pose a step forward along each free symbol, then a step back."""
        poses = self._poses.values
        return self._joined(
            [
                {**poses, name: poses[name] + sign * _STEP * self._sizes[name]}
                for sign in (1, -1)
                for name in self._free
            ]
        )

    def _joined(self, blocks: Sequence[Mapping[str, np.ndarray]]) -> _Points:
        values = {n: np.concatenate([b[n] for b in blocks]) for n in self.symbols}
        return _Points(values, len(values[self.symbols[0]]))

    def _off(self, rng: np.random.Generator) -> dict[str, np.ndarray]:
        moved = dict(self._poses.values)
        for name in self._free:
            share = rng.uniform(0.1, 0.4, self._poses.count) * rng.choice((-1, 1), self._poses.count)
            moved[name] = moved[name] + share * self._sizes[name]
        return moved

    @cached_property
    def _in_degrees(self) -> tuple[_Points, _Points]:
        """The places with angles as numbers of degrees."""
        degrees = 180 / math.pi
        return self._near.scaled(self.angles, degrees), self._steps.scaled(self.angles, degrees)

    @cached_property
    def _converted(self) -> _Points:
        return self._poses.scaled(self.angles, math.pi / 180)

    def _gradient(self, equation: Equation, steps: _Points) -> np.ndarray:
        """Shape (poses, free symbols), each symbol counted in its usual size."""
        forward, backward = steps.gap(equation).reshape(2, len(self._free), self._poses.count)
        return ((forward - backward) / (2 * _STEP)).T

    @cached_property
    def _basis(self) -> tuple[np.ndarray, np.ndarray]:
        """Gradients of the reference equations up to this order, of unit length, and their pseudo-inverse."""
        rows = [
            self._gradient(parse_equation(self.loop.equation(form, order), self.symbols), self._steps)
            for order in range(self.order + 1)
            for form in ("x", "y")
        ]
        basis = np.stack(rows, axis=1)
        basis = basis / np.linalg.norm(basis, axis=2, keepdims=True)
        return basis, np.linalg.pinv(basis)

    def _finding(self, equation: Equation) -> Finding:
        with np.errstate(all="ignore"):  # what overflows is not an answer
            return self._found(equation)

    def _found(self, equation: Equation) -> Finding:
        usual, in_degrees = (self._near, self._steps), self._in_degrees
        best = self._as_it_stands(equation, *usual)
        if best.rank:
            return Finding(0, fault="wrapped") if self._is_wrapped(equation) else best
        if best.fault:
            return best
        # Symbols of angles may stand for numbers of degrees, as the data print them.
        read = equation.in_degrees()
        for other, places in ((equation, in_degrees), (read, usual)):
            if other is not None and (finding := self._as_it_stands(other, *places)).rank:
                return finding
        missed = self._missed(equation)
        return missed if missed.fault or read is None else self._missed(read)

    def _as_it_stands(self, equation: Equation, near: _Points, steps: _Points) -> Finding:
        values, sides = (v.reshape(1 + _OFF, -1) for v in equation.gap(near.values, near.count))
        finite = np.isfinite(values)
        off = np.where(finite[1:], np.abs(values[1:]), 0.0)
        if finite.all() and np.all(off <= _ROUNDING * sides[1:]):
            return Finding(0, fault="says_nothing")
        values, size = values[0], np.max(off, axis=0)
        usable = np.isfinite(values) & (size > 0)
        if usable.sum() < 0.75 * self._poses.count or np.any(np.abs(values[usable]) > _ZERO * size[usable]):
            return Finding(0)
        gradient = self._gradient(equation, steps) / np.where(size > 0, size, 1.0)[:, None]
        usable &= np.all(np.isfinite(gradient), axis=1)
        if usable.sum() < 0.75 * self._poses.count:
            return Finding(0)
        length = np.linalg.norm(gradient, axis=1)
        is_informative = usable & (length > _NONE)
        if is_informative.sum() < 0.5 * self._poses.count:
            return Finding(0, fault="squared")
        basis, inverse = self._basis
        gradient = (
            np.where(is_informative[:, None], gradient, 0.0) / np.where(is_informative, length, 1.0)[:, None]
        )
        share = np.einsum("pn,pnm->pm", gradient, inverse)
        rest = np.linalg.norm(gradient - np.einsum("pm,pmn->pn", share, basis), axis=1)
        if np.any(rest > 10 * _NONE):
            return Finding(0, fault="other_loop")
        newest = share[:, -2:]
        rows = np.stack([newest.real, newest.imag], axis=1)
        rank = _rank(rows)
        return Finding(rank, rows) if rank else Finding(0, fault="not_derived")

    def _is_wrapped(self, equation: Equation) -> bool:
        """Return whether a function is put about the whole of a right equation: ``exp(l - r) = 1``,
        ``atan(l) = atan(r)``.

        Whoever takes the function off has the equation itself. So does no angle that is solved for, nor a
        complex form.
        """
        left, right = equation.left.root, equation.right.root
        inner = []
        if left.kind == right.kind == "call" and left.name == right.name:
            inner.append((left.args[0], right.args[0]))
        for node in (*left.walk(), *right.walk()):
            if node.kind not in ("call", "power"):
                continue
            for inside in (arg for arg in node.args if not arg.constant):
                value = value_or_nan(Expression(equation.text, inside), self._poses.values)
                at_first = complex(np.ravel(value)[0]).real
                inner.append((inside, Operation("number", repr(at_first))))
        sides = ((Expression(equation.text, a), Expression(equation.text, b)) for a, b in inner)
        return any(
            self._as_it_stands(Equation(equation.text, a, b), self._near, self._steps).rank for a, b in sides
        )

    def holds_with_numbers(self, equation: Equation, variant: Variant) -> bool:
        """Return whether an equation holds for one variant alone: its numbers stand in place of their
        symbols."""
        exercise = variant.exercise
        try:
            solved = exercise.solve(**variant.used, only=self.symbols, effects=variant.effects)
        except CourseworkError:
            return False
        pose = {n: math.radians(v) if n in self.angles else v for n, v in solved.items()}
        factors = 1 + np.array([0.0, 0.1, -0.1, 0.2])
        values = {n: v * factors + (self._sizes[n] * (factors - 1)) for n, v in pose.items()}
        gap = np.abs(equation.gap(values, factors.size)[0])
        usual = float(np.max(gap[1:], where=np.isfinite(gap[1:]), initial=0.0))
        return bool(usual > 0 and gap[0] <= _ZERO * usual)

    def are_alike(self, first: str, other: str) -> bool:
        """Return whether two equations are the same, sides exchanged at most, where fixed quantities have
        their values."""
        a, b = (self._near.gap(parse_equation(text, self.symbols)) for text in (first, other))
        size = np.max(np.abs(b))
        return any(bool(np.all(np.abs(a - sign * b) <= _ZERO * size)) for sign in (1, -1))

    # ------------------------------------------------------------------ what is missed

    def _missed(self, equation: Equation) -> Finding:
        """Return the first kind of fault that explains an equation, with every name that it may be about."""
        usual = float(np.median(np.abs(self._near.gap(equation)[self._poses.count :])))
        if not 0 < usual < math.inf:
            return Finding(0)
        if self._holds(self._converted.gap(equation), usual):
            return Finding(0, fault="angle_unit")
        faults, points, compared = self._faulty
        values = points.gap(equation).reshape(len(faults), _FAULTY) if faults else ()
        holds = [f for f, value in zip(faults, values, strict=True) if self._holds(value, usual)]
        if not holds:
            holds = [fault for fault, other in compared if same_equation(equation, other)]
        if len({fault.kind for fault in holds}) > 1:
            # An equation that falls into factors holds at the places of several: the one written is meant.
            written = [f for f in holds if any(same_equation(equation, e) for e in self._equations(f.loop))]
            holds = written or holds
        if not holds:
            return Finding(0)
        names = (n for f in holds if f.kind == holds[0].kind for n in f.names)
        return Finding(0, fault=holds[0].kind, names=tuple(dict.fromkeys(names)))

    @staticmethod
    def _holds(values: np.ndarray, usual: float) -> bool:
        return bool(np.all(np.isfinite(values)) and np.all(np.abs(values) <= 10 * _ZERO * usual))

    @cached_property
    def _faulty(self) -> tuple[list[LoopFault], _Points, list[tuple[LoopFault, Equation]]]:
        """The faults; places at which the equations of each hold; those that have none, with their equations.

        Where both equations together have no places, each has some of its own.
        """
        faults, blocks, compared = [], [], []
        for fault in self.loop.faults(self.order):
            x, y, both = self._equations(fault.loop)
            places = self._solved((x, y), fault.loop)
            if places is None and not self.order:
                places = self._approached((x, y), fault.loop)
            if places is not None:
                faults.append(fault)
                blocks.append(places)
                continue
            compared.append((fault, both))
            for equation in (x, y):
                places = self._solved((equation,), fault.loop)
                if places is None:
                    compared.append((fault, equation))
                else:
                    faults.append(fault)
                    blocks.append(places)
        return faults, self._joined(blocks) if blocks else _Points({}, 0), compared

    def _equations(self, loop: Loop) -> tuple[Equation, ...]:
        """Both projections and the complex form."""
        forms = ("x", "y", "complex")
        return tuple(parse_equation(loop.equation(form, self.order), self.symbols) for form in forms)

    def _solved(self, equations: Sequence[Equation], loop: Loop) -> dict[str, np.ndarray] | None:
        """Places at which equations hold, as many symbols in which they are linear being solved for.

        None where the equations fix no such symbols, or hold only where one of these vanishes.
        """
        names = [n for n in loop.highest(self.order) if n in self._free]
        start = self._poses.values if self.order else self._off(np.random.default_rng(2))
        values = {n: np.array(v[:_FAULTY]) for n, v in start.items()}

        def gaps(**changed: np.ndarray) -> np.ndarray:
            """Shape (places, equations)."""
            return np.array([e.gap({**values, **changed}, _FAULTY)[0] for e in equations]).T

        zero = np.zeros(_FAULTY)
        columns = {n: gaps(**{n: zero + self._sizes[n]}) - gaps(**{n: zero}) for n in names}
        largest = max((float(np.max(np.abs(c))) for c in columns.values()), default=0.0)
        best = 1e-3
        chosen: tuple[str, ...] = ()
        for some in itertools.combinations(names, len(equations)):
            # Side by side, in the largest column: how far the symbols are from one direction, or from none.
            apart = float(np.min(np.abs(np.linalg.det(np.stack([columns[n] for n in some], axis=2)))))
            if largest and (apart := apart / largest ** len(some)) > best:
                best, chosen = apart, some
        if not chosen:
            return None
        matrix = np.stack([columns[n] for n in chosen], axis=2)
        right = gaps(**dict.fromkeys(chosen, zero))
        shares = np.linalg.solve(matrix, -right[..., None])[..., 0]
        if np.any(np.abs(shares) < 1e-9):
            return None
        return {**values, **{n: shares[:, k] * self._sizes[n] for k, n in enumerate(chosen)}}

    def _approached(self, equations: Sequence[Equation], loop: Loop) -> dict[str, np.ndarray] | None:
        """Places at which equations hold, by Newton's method from the poses on all symbols of the loop.

        For two vectors that add up to nothing: they are opposite, and no length has to vanish.
        """
        names = [n for n in loop.names if n in self._free]
        values, count = dict(self._poses.values), self._poses.count
        sizes = np.array([self._sizes[n] for n in names])

        def gaps(at: Mapping[str, np.ndarray]) -> np.ndarray:
            return np.array([e.gap(at, count)[0] for e in equations]).T

        for _ in range(_NEWTON):
            slopes = [
                (gaps({**values, n: values[n] + h}) - gaps({**values, n: values[n] - h})) / (2 * _STEP)
                for n, h in zip(names, _STEP * sizes, strict=True)
            ]
            step = np.linalg.pinv(np.stack(slopes, axis=2)) @ gaps(values)[..., None]
            values |= {n: values[n] - step[:, k, 0] * sizes[k] for k, n in enumerate(names)}
        shares = [np.abs(values[n]) / self._sizes[n] for n in names if n not in self.angles]
        left = np.max(np.abs(gaps(values)), axis=1)
        holds = left <= _ZERO * np.max(sizes)
        good = np.flatnonzero(holds & (np.min(shares, axis=0) > 0.05) if shares else holds)
        if good.size < _FAULTY:
            return None
        return {n: v[good[:_FAULTY]] for n, v in values.items()}


def _rank(rows: np.ndarray) -> int:
    """Return the number of independent equations that the rows of coefficients hold at half of the poses or
    more."""
    sizes = np.linalg.svd(rows, compute_uv=False)
    if np.mean(sizes[:, 0] > 1e-4) < 0.5:
        return 0
    return 2 if np.mean(sizes[:, 1] > _NONE * sizes[:, 0]) >= 0.5 else 1


def judge_of(exercise: CourseExercise, part: Part) -> LoopJudge:
    """Return the judge of a part about a loop; parts of one loop, order and set of symbols share it."""
    _, order = part.loop_form
    key = part.loop, order, part.variables
    judges = _judges.setdefault(exercise, {})
    if key not in judges:
        judges[key] = LoopJudge(exercise, *key)
    return judges[key]


#: Judges by exercise, made when the first answer about a loop is marked.
_judges: WeakKeyDictionary[CourseExercise, dict[tuple[str, int, tuple[str, ...]], LoopJudge]] = (
    WeakKeyDictionary()
)


def loop_verdicts(variant: Variant, readings: Mapping[str, Reading]) -> dict[str, Verdict]:
    """Return the verdicts on the answers about loops by part id, those of one loop judged together; only for
    answers that were read."""
    verdicts: dict[str, Verdict] = {}
    before: dict[tuple[str, int], list[np.ndarray]] = {}
    for part in variant.parts:
        reading = readings.get(part.id)
        if part.loop and reading is not None and reading.status == "read":
            form, order = part.loop_form
            judge, equation = judge_of(variant.exercise, part), reading.values[0]
            finding = judge.finding(equation)
            if finding.rank == 0 and not finding.fault and judge.holds_with_numbers(equation, variant):
                finding = Finding(0, fault="numbers" if _has_numbers(equation, variant) else "some_positions")
            others = before.setdefault((part.loop, order), []) if form != "complex" else []
            missed, about = _missed_beside(finding, others, 2 if form == "complex" else 1)
            right = finding.rank > 0 and not missed
            verdicts[part.id] = Verdict(0, Judged(float(right)), slip=missed, about=about)
            if right and finding.rows is not None:
                others.append(finding.rows)
    return verdicts


#: Numbers that an equation of symbols has of its own: factors, powers, parts of a turn.
_OF_SYMBOLS = frozenset({0, 0.5, 1, 2, 3, 4, 45, 60, 90, 120, 180, 270, 360})


def _has_numbers(equation: Equation, variant: Variant) -> bool:
    """Return whether an equation holds numbers in place of symbols: values of the variant, or others that no
    formula has."""
    values = {abs(v) for v in variant.given.values() if not isinstance(v, str)} - {0, 1}
    written = {
        float(node.name)
        for side in (equation.left, equation.right)
        for node in side.root.walk()
        if node.kind == "number"
    }
    return bool(written - _OF_SYMBOLS or written & values)


def _missed_beside(
    finding: Finding, others: Sequence[np.ndarray], wanted: int
) -> tuple[str, tuple[str, ...]]:
    """Return what an equation lacks beside the right ones before it, and the symbols concerned; empty where
    it is right, or where the fault is unknown."""
    if finding.rank == 0:
        return finding.fault, finding.names
    if finding.rank < wanted:
        return "one_projection", ()
    if others and _rank(np.concatenate([*others, finding.rows], axis=1)) < 2:
        return "repeated_equation", ()
    return "", ()


def fault_answers(exercise: CourseExercise, part: Part) -> Iterator[tuple[LoopFault, str]]:
    """Each known way to err with the answer that it gives to a part."""
    form, order = part.loop_form
    for fault in exercise.solution.loops[part.loop].faults(order):
        yield fault, fault.loop.equation(form, order)
