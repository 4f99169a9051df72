"""Closed loops of a mechanism: their equations as texts in any form, and the usual errors in them.

A solution states its loops once, as ``LOOPS = {"loop_1": (Vector("r2", "theta2"), …)}``: vectors
``sign * length * e^{i (angle + turn)}`` that add up to nothing. The quantities ``loop_1_x``, ``loop_1_y``
(projections) and ``loop_1_complex`` follow, and with ``_dot`` and ``_ddot`` their derivatives in time.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from coursework.errors import BadCourse, nearest
from coursework.kinematics.chains import Vector

#: Endings of the quantities' names, by order of derivation.
ORDERS = ("", "_dot", "_ddot")

#: What is missed by who errs, in the order in which explanations are tried.
FAULTS = (
    "link_sign",
    "link_missing",
    "link_term",
    "link_turn",
    "link_axis",
    "link_angle",
    "frame_missing",
)

_Pieces = list[tuple[int, str]]  #: signed factors, to be multiplied by a sine, a cosine or e^(i…)


@dataclass(frozen=True)
class LoopLink:
    """Vector of a loop as a student may write it, right by default.

    ``swapped``: sine and cosine are exchanged. ``turned``: the sign before the added angle, 0 where it is
    left out. ``slips``: signs before the terms of its derivative, 0 where one is left out. ``coriolis``: the
    factor of that term.
    """

    vector: Vector
    swapped: bool = False
    turned: int = 1
    slips: tuple[int, ...] = ()
    coriolis: int = 2

    @property
    def name(self) -> str:
        """Name of the link: its length, or its direction where the length is a number."""
        length, angle = self.vector.length, self.vector.angle
        return length if isinstance(length, str) else str(angle)

    def projection(self, axis: str, pieces: tuple[_Pieces, _Pieces]) -> _Pieces:
        """Return the signed terms of a projection; ``pieces`` are the radial and the transverse ones."""
        radial, transverse = pieces
        on_x = (axis == "x") != self.swapped
        return [
            *_times(radial, *self._function("cos" if on_x else "sin"), 1),
            *_times(transverse, *self._function("sin" if on_x else "cos"), -1 if on_x else 1),
        ]

    def complex_terms(self, pieces: tuple[_Pieces, _Pieces]) -> _Pieces:
        """Return the signed terms of the complex form."""
        radial, transverse = pieces
        sign, unit = 1, ""
        if isinstance(self._angle, str):
            unit = f"e^(i*{_bracketed(self._angle)})"
        elif (quarter := _quarters(self._angle)) is not None:
            sign, unit = ((1, ""), (1, "i"), (-1, ""), (-1, "i"))[quarter]
        else:
            unit = f"e^(i*{math.degrees(self._angle):.12g}°)"
        terms = _times(radial, sign, unit, 1)
        if unit == "i":  # i times i
            return [*terms, *_times(transverse, -sign, "", 1)]
        return [*terms, *_times(transverse, sign, f"i*{unit}" if unit else "i", 1)]

    @property
    def _angle(self) -> str | float:
        angle, turn = self.vector.angle, self.vector.turn
        if isinstance(turn, str) or isinstance(angle, str):
            if not self.turned or turn == 0:
                return angle
            sign = "+" if self.turned > 0 else "-"
            displayed = turn if isinstance(turn, str) else f"{math.degrees(turn):.12g}°"
            first = angle if isinstance(angle, str) else f"{math.degrees(angle):.12g}°"
            return f"{first} {sign} {displayed}"
        return angle + turn

    def _function(self, function: str) -> tuple[int, str]:
        """Return the sign and text of the sine or cosine of the link's angle; sign 0 where it vanishes."""
        angle = self._angle
        if isinstance(angle, str):
            return 1, f"{function}({angle})"
        quarter = _quarters(angle)
        if quarter is None:
            return 1, f"{function}({math.degrees(angle):.12g}°)"
        return (((1, 0, -1, 0) if function == "cos" else (0, 1, 0, -1))[quarter], "")


def _quarters(angle: float) -> int | None:
    """Return an angle in whole quarter turns; None where it is none."""
    quarters = angle / (math.pi / 2)
    return round(quarters) % 4 if abs(quarters - round(quarters)) < 1e-12 else None


def _bracketed(angle: str) -> str:
    return f"({angle})" if " " in angle else angle


def _times(pieces: _Pieces, sign: int, factor: str, more: int) -> _Pieces:
    return [(s * sign * more, "*".join(filter(None, (text, factor)))) for s, text in pieces if s * sign]


@dataclass(frozen=True)
class LoopFault:
    """Wrong way to write a loop: the kind of error, the names, and the resulting loop."""

    kind: str
    names: tuple[str, ...]
    loop: Loop


@dataclass(frozen=True)
class Loop:
    """Closed loop.

    ``rates`` gives the first and the second derivative of what varies, by name; none is ''. ``known`` is how
    often the loop can be derived in names that the solution has.
    """

    links: tuple[LoopLink, ...]
    rates: Mapping[str, tuple[str, str]]
    known: int = 0

    @staticmethod
    def of(vectors: Sequence[Vector], rates: Mapping[str, tuple[str, str]]) -> Loop:
        return Loop(tuple(LoopLink(v) for v in vectors), rates)

    @property
    def names(self) -> tuple[str, ...]:
        """Lengths, angles and added angles, in order of appearance."""
        result = (n for link in self.links for n in (*link.vector[:2], link.vector.turn))
        return tuple(dict.fromkeys(n for n in result if isinstance(n, str)))

    @property
    def lengths(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(k.vector.length for k in self.links if isinstance(k.vector.length, str)))

    @property
    def angles(self) -> frozenset[str]:
        """The names that are angles."""
        return frozenset(self.names) - set(self.lengths)

    def highest(self, order: int) -> tuple[str, ...]:
        """Return the names in which the equation of an order is linear: lengths, or rates of that order."""
        if not order:
            return self.lengths
        return tuple(r[order - 1] for n, r in self.rates.items() if n in self.names and r[order - 1])

    def equation(self, form: str, order: int = 0) -> str:
        """Return the closure equation as text: ``x`` or ``y`` projection or ``complex``, differentiated
        ``order`` times."""
        terms: _Pieces = []
        for link in self.links:
            pieces = self._pieces(link, order)
            sign = link.vector.sign
            own_terms = link.complex_terms(pieces) if form == "complex" else link.projection(form, pieces)
            terms += [(sign * s, text) for s, text in own_terms]
        left = [text for sign, text in terms if sign > 0]
        right = [text for sign, text in terms if sign < 0]
        return f"{' + '.join(left) or '0'} = {' + '.join(right) or '0'}"

    def _rates_of(self, name: str | float) -> tuple[str, str]:
        return self.rates.get(name, ("", "")) if isinstance(name, str) else ("", "")

    def _pieces(self, link: LoopLink, order: int) -> tuple[_Pieces, _Pieces]:
        """Return the radial and transverse factors of the derivative of a link."""
        v = link.vector
        length = v.length if isinstance(v.length, str) else f"{v.length:.12g}"
        slide, turn = self._rates_of(v.length), self._rates_of(v.angle)
        if order == 0:
            radial, transverse = [(1, length)], []
        elif order == 1:
            radial, transverse = [(1, slide[0])], [(1, turn[0] and f"{length}*{turn[0]}")]
        else:
            both = slide[0] and turn[0]
            factor = "2*" if link.coriolis == 2 else ""
            radial = [(1, slide[1]), (-1, turn[0] and f"{length}*{turn[0]}^2")]
            transverse = [
                (1, both and f"{factor}{slide[0]}*{turn[0]}"),
                (1, turn[1] and f"{length}*{turn[1]}"),
            ]
        radial, transverse = ([p for p in pieces if p[1]] for pieces in (radial, transverse))
        slips = iter(link.slips)
        radial, transverse = (
            [(s * next(slips, 1), text) for s, text in pieces] for pieces in (radial, transverse)
        )
        return [p for p in radial if p[0]], [p for p in transverse if p[0]]

    def moves(self, order: int) -> bool:
        """Return whether the derivative of this order is known and not trivial."""
        return order == 0 or (order <= self.known and bool(self.highest(order)))

    def faults(self, order: int = 0) -> Iterator[LoopFault]:
        """Yield the known errors, grouped by kind."""
        for kind in FAULTS:
            for names, links in getattr(self, f"_{kind}")(order):
                yield LoopFault(kind, names, replace(self, links=tuple(links)))

    def _changed(
        self, change: Callable[[LoopLink], Iterable[LoopLink]]
    ) -> Iterator[tuple[tuple[str, ...], list[LoopLink]]]:
        """Yield the loop with one link changed, for every link and every change."""
        for k, link in enumerate(self.links):
            for other in change(link):
                yield (link.name,), [*self.links[:k], other, *self.links[k + 1 :]]

    def _link_sign(self, order: int) -> Iterator:
        return self._changed(lambda k: [replace(k, vector=k.vector._replace(sign=-k.vector.sign))])

    def _link_missing(self, order: int) -> Iterator:
        for k, link in enumerate(self.links):
            yield (link.name,), [*self.links[:k], *self.links[k + 1 :]]

    def _link_term(self, order: int) -> Iterator:
        def wrong(link: LoopLink) -> Iterator[LoopLink]:
            count = sum(map(len, self._pieces(link, order))) if order else 0
            for term in range(count):
                for slip in (-1, 0):
                    yield replace(link, slips=tuple(slip if j == term else 1 for j in range(count)))
            if order == 2 and self._rates_of(link.vector.length)[0] and self._rates_of(link.vector.angle)[0]:
                yield replace(link, coriolis=1)

        return self._changed(wrong)

    def _link_turn(self, order: int) -> Iterator:
        def wrong(link: LoopLink) -> list[LoopLink]:
            return [replace(link, turned=t) for t in (0, -1)] if link.vector.turn else []

        return self._changed(wrong)

    def _link_axis(self, order: int) -> Iterator:
        return self._changed(lambda link: [replace(link, swapped=True)])

    def _link_angle(self, order: int) -> Iterator:
        named = [k.vector.angle for k in self.links if isinstance(k.vector.angle, str)]

        def wrong(link: LoopLink) -> list[LoopLink]:
            angle = link.vector.angle
            others = dict.fromkeys(a for a in named if a != angle)
            return [replace(link, vector=link.vector._replace(angle=a)) for a in others]

        return self._changed(wrong)

    def _frame_missing(self, order: int) -> Iterator:
        fixed = [k for k in self.links if not isinstance(k.vector.angle, str)]
        if len(fixed) > 1 and len(self.links) - len(fixed) > 1 and not order:
            yield tuple(k.name for k in fixed), [k for k in self.links if k not in fixed]


def stated(
    source: str,
    loops: object,
    rates: Mapping[str, tuple[str, str]],
    computed: Collection[str],
    given: Collection[str],
) -> dict[str, Loop]:
    """Return the loops that a solution states, with the derivatives of their variables.

    The angle ``theta3`` has ``omega3`` and ``alpha3``, another quantity ``r6`` has ``r6_dot`` and
    ``r6_ddot``, as far as the solution knows them; ``rates`` names those that are called otherwise. A given
    quantity without a derivative is constant; where one is ``computed`` from what moves, the loop is
    derived no further.

    Raises
    ------
    BadCourse
        No mapping of names to vectors, or a vector of names that the solution does not know.
    """
    if not isinstance(loops, Mapping):
        raise BadCourse(f'{source}: LOOPS maps names to vectors: {{"loop_1": (Vector("r2", "theta2"), …)}}')
    names = {*computed, *given}
    results = {}
    for name, vectors in loops.items():
        if not vectors or not all(isinstance(v, Vector) for v in vectors):
            raise BadCourse(f"{source}: the loop {name!r} is a sequence of Vector(length, angle, sign, turn)")
        loop = Loop.of(vectors, {})
        for item in loop.names:
            if item not in names:
                raise BadCourse(
                    f"{source}: the loop {name!r} names no quantity by {item!r}{nearest(item, names)}"
                )
        rate_names = {n: rates.get(n) or usual_rates(n, names) for n in loop.names}
        first = all(r[0] or n not in computed for n, r in rate_names.items())
        second = first and all(r[1] or r[0] not in computed for r in rate_names.values())
        results[name] = replace(
            loop, rates={n: r for n, r in rate_names.items() if r[0]}, known=first + second
        )
    return results


def moving_quantities(
    needs: Mapping[str, Collection[str]], given: Collection[str], rates: Mapping[str, tuple[str, str]]
) -> set[str]:
    """Return the computed quantities that a given one moves, one with a derivative; all where none has any.

    Parameters
    ----------
    needs
        By computed quantity, what its function takes.
    given
        The other quantities.
    rates
        Names of derivatives that are not the usual ones, by quantity.
    """
    names = {*needs, *given}
    moved = {n for n in given if any(rates.get(n) or usual_rates(n, names))}
    if not moved:
        return {*needs}
    grows = True
    while grows:
        more = {n for n, own in needs.items() if n not in moved and not moved.isdisjoint(own)}
        moved, grows = moved | more, bool(more)
    return moved - {*given}


def usual_rates(name: str, names: Collection[str]) -> tuple[str, str]:
    """Return the names of the first and second derivative of a quantity; '' for one that does not exist."""
    stem = name.removeprefix("theta")
    first, second = (f"omega{stem}", f"alpha{stem}") if stem != name else (f"{name}_dot", f"{name}_ddot")
    return first if first in names else "", second if second in names else ""


def quantities(loops: Mapping[str, Loop]) -> dict[str, Callable[[], str]]:
    """Return constant functions that give the equations, by the names of their quantities."""
    return {
        f"{name}_{form}{ending}": _constant(f"{name}_{form}{ending}", loop.equation(form, order))
        for name, loop in loops.items()
        for order, ending in enumerate(ORDERS)
        if loop.moves(order)
        for form in ("x", "y", "complex")
    }


def _constant(name: str, text: str) -> Callable[[], str]:
    def equation() -> str:
        return text

    equation.__name__ = name
    equation.__formula__ = ""  # type: ignore[attr-defined]  # marks a function
    return equation
