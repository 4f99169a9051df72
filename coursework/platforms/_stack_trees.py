"""What STACK does with an answer: the nodes of a tree of potential responses, in Maxima, and what they come to here."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from coursework.course.variant import Variant
from coursework.language.numbers import settled
from coursework.model import Part
from coursework.platforms._maxima import Unprintable, number, text
from coursework.platforms._stack_following import Following, following, follows
from coursework.platforms.posed import CHOICE, CHOICES, COLLECTED, NUMBER, Interval, Posed
from coursework.reading.units import DIMENSIONS, find_unit

_SLACK = 1e-12  #: of an end: it belongs to the margin whatever the last bit
EMPTY = "empty"  #: the verdict of a box that is left so, which costs no penalty
_LONGEST = 200  #: characters of what a node asks; Moodle has room for 255
_ATTEMPT = 100  #: an earlier answer is gone on from within this factor of the right one
#: Units that students may write with a number, and what STACK is told of them.
_UNITS = tuple("mm cm dm m km um s ms h g kg N kN mN daN J kJ W kW mW Pa kPa MPa rad mrad deg rpm".split())
_BASES = {"length": "m", "mass": "kg", "time": "s"}
_NUMBERS = ("angle", "cycle")  #: what has a unit and is a number

#: Functions of every question. ``x`` is an answer, ``u`` the unit asked, in base units; intervals hold their ends.
FUNCTIONS = """\
co_number(x,u) := block([w], if is(x=EMPTYANSWER) then return(false),
  w: if emptyp(listofvars(x)) then ev(float(x),simp) else ev(float(subst(co_units,x)/(u)),simp),
  if numberp(w) then w else false);
co_in(v,a,b) := if numberp(v) then is(a<=v and v<=b) else false;
co_turned(v,a,b,t) := if numberp(v) then is(abs(v-(a+b)/2-t*round((v-(a+b)/2)/t))<=(b-a)/2) else false;
co_tried(v,r) := is(abs(v)<=%d*abs(r) and %d*abs(v)>=abs(r));
co_units: [%s];
co_pair(x) := if atom(x) then false elseif is(op(x)="-") or is(op(x)="/") then co_pair(first(args(x)))
  else is(op(x)="*") and is(length(sublist(args(x),numberp))>1);
co_valid(x,u,other,grouped) := if is(x=EMPTYANSWER) or numberp(x) then ""
  elseif co_pair(x) then grouped
  elseif emptyp(listofvars(x)) then ""
  elseif numberp(ev(float(subst(co_units,x)/(u)),simp)) then "" else other;
"""


def functions() -> str:
    """What the question variables of every question begin with."""
    known = ",".join(f"{name}={in_base_units(name)}" for name in _UNITS if name not in _BASES.values())
    return FUNCTIONS % (_ATTEMPT, _ATTEMPT, known)


def in_base_units(unit: str) -> str:
    """A unit as a factor and base units; angles are numbers."""
    found = find_unit(unit)
    if found is None:
        raise Unprintable(unit)
    powers = dict(zip(DIMENSIONS, found.dimension, strict=True))
    if any(power and name not in (*_BASES, *_NUMBERS) for name, power in powers.items()):
        raise Unprintable(unit)
    bases = "".join(
        f"*{_BASES[name]}^({power})" for name, power in powers.items() if name in _BASES and power
    )
    return number(found.factor) + bases


@dataclass(frozen=True)
class Node:
    """One test of an answer: where it holds, nothing after it counts."""

    maxima: str  #: true where it holds
    holds: Callable[[object, Mapping[int, float]], bool]  #: of an answer, and the earlier ones by number
    share: float
    says: str = ""  #: Markdown
    verdict: str = "correct"


@dataclass(frozen=True)
class Tree:
    """What becomes of one part's answer."""

    place: int  #: of the part, from 1
    posed: Posed
    nodes: tuple[Node, ...]
    following: Following | None = None
    unit: str = "1"  #: as Maxima is told it
    may_be_empty: bool = False

    @property
    def variables(self) -> str:
        """What the nodes speak of: the answer and the earlier ones as numbers, and what is too long for a node."""
        return "\n".join((*self._numbers, *self._long))

    @property
    def _long(self) -> Iterator[str]:
        for at, node in enumerate(self.nodes):
            if len(node.maxima) > _LONGEST:
                yield f"t{at}: {node.maxima};"

    def test(self, at: int) -> str:
        """What a node asks."""
        return f"t{at}" if len(self.nodes[at].maxima) > _LONGEST else self.nodes[at].maxima

    @property
    def _numbers(self) -> list[str]:
        if self.posed.kind != NUMBER:
            return []
        lines = [f"v{self.place}: co_number(ans{self.place},co_u{self.place});"]
        for place in self.following.earlier if self.following else ():
            known = f"co_number(ans{place},co_u{place})"
            lines.append(f"w{place}: {known};")
            lines.append(f"v{place}: if numberp(w{place}) then w{place} else co_r{place}[3];")
        if self.following:
            lines.append(f"f{self.place}: float({self.following.maxima});")
        return lines

    def share(self, answer: object, own: Mapping[int, float]) -> tuple[float, int]:
        """What an answer is worth, and the number of the node that says so; -1 where none does."""
        for place, node in enumerate(self.nodes):
            if node.holds(answer, own):
                return node.share, place
        return 0.0, -1


def trees(variant: Variant, questions: Sequence[Posed]) -> tuple[Tree, ...]:
    """The trees of the questions that STACK can judge."""
    asked = zip(questions, variant.parts, strict=True)
    found = [
        _tree(variant, place, posed, part)
        for place, (posed, part) in enumerate(asked, start=1)
        if posed.kind != COLLECTED
    ]
    goes_on = {place for tree in found if tree.following for place in tree.following.earlier}
    return tuple(_may_be_empty(tree) if tree.place in goes_on else tree for tree in found)


def _may_be_empty(tree: Tree) -> Tree:
    """A tree whose answer others follow from: they are judged without it, too, so its box may stay empty."""
    nothing = Node(f"is(ans{tree.place}=EMPTYANSWER)", lambda answer, own: answer is None, 0.0, verdict=EMPTY)
    return replace(tree, nodes=(nothing, *tree.nodes), may_be_empty=True)


def _tree(variant: Variant, place: int, posed: Posed, part: Part) -> Tree:
    if posed.kind == CHOICE:
        return Tree(place, posed, tuple(_cases(place, posed)))
    if posed.kind == CHOICES:
        return Tree(place, posed, tuple(_several(place, posed)))
    found = following(variant, part)
    right, *wrong = _intervals(posed)
    nodes = [_of_interval(place, right, part.sort.turn)]
    if found is not None:
        nodes.append(_of_following(variant, place, part, found))
    nodes += [_of_interval(place, one, part.sort.turn if _turns(one, posed) else 0.0) for one in wrong]
    return Tree(place, posed, tuple(nodes), found, unit_of(part))


def unit_of(part: Part) -> str:
    """The unit of a part in base units; of one that STACK cannot be told, one that nothing can be written in."""
    try:
        return in_base_units(part.unit)
    except Unprintable:
        return "co_unit"


def _intervals(posed: Posed) -> Iterator[Interval]:
    return (interval for interval in posed.intervals if not interval.turns)


def _turns(interval: Interval, posed: Posed) -> bool:
    """Whether whole turns more or fewer are taken for the same."""
    verdicts = (one.verdict for one in posed.intervals if one.turns and math.isclose(one.half, interval.half))
    return interval.verdict in verdicts


def _ends(interval: Interval) -> tuple[float, float]:
    slack = _SLACK * max(abs(interval.low), abs(interval.high))
    return interval.low - slack, interval.high + slack


def _of_interval(place: int, interval: Interval, turn: float) -> Node:
    low, high = _ends(interval)
    holds = _within(low, high, turn)
    ends = f"v{place},{number(low)},{number(high)}"
    maxima = f"co_turned({ends},{number(turn)})" if turn else f"co_in({ends})"
    return Node(maxima, lambda answer, own: holds(answer), interval.share, interval.says, interval.verdict)


def _within(low: float, high: float, turn: float) -> Callable[[object], bool]:
    def holds(answer: object) -> bool:
        if not isinstance(answer, (float, int)):
            return False
        if not turn:
            return low <= answer <= high
        middle = (low + high) / 2
        return abs(answer - middle - turn * round((answer - middle) / turn)) <= (high - low) / 2

    return holds


def _of_following(variant: Variant, place: int, part: Part, found: Following) -> Node:
    """The node of a right method from earlier answers, at least one of which is not right but tried."""
    key = variant.key
    least = max(part.atol, key.envelope.get(part.quantity, 0.0)) if part.has_margin else 0.0
    share = part.rtol if part.has_margin else 0.0
    half = f"max({number(settled(least))},{number(float(share))}*abs(f{place}))+{number(1e-9)}*abs(f{place})"
    earlier = {one: variant.parts[one - 1] for one in found.earlier}
    wrong = " or ".join(f"not {_right(one, p)}" for one, p in earlier.items())
    tried = "".join(
        f" and ({_right(one, p)} or co_tried(v{one},co_r{one}[3]))"
        for one, p in earlier.items()
        if not p.sort.turn
    )
    apart = f" and is(abs(f{place})>{half})" if part.has_margin and not part.sort.turn else ""
    ends = f"v{place},f{place}-({half}),f{place}+({half})"
    turn = part.sort.turn
    near = f"co_turned({ends},{number(turn)})" if turn else f"co_in({ends})"
    maxima = f"if numberp(f{place}) then (({wrong}){tried}{apart} and {near}) else false"

    def holds(answer: object, own: Mapping[int, float]) -> bool:
        whole = {one: own.get(one, float(key.reference[p.quantity])) for one, p in earlier.items()}
        wrong = [one for one, value in whole.items() if not _is_right(variant, earlier[one], value)]
        untried = any(not _is_tried(variant, earlier[one], whole[one]) for one in wrong)
        value = follows(variant, part, whole)
        if not wrong or untried or value is None or not math.isfinite(value):
            return False
        width = max(least, share * abs(value)) + 1e-9 * abs(value)
        if apart and abs(value) <= width:
            return False
        return _within(value - width, value + width, part.sort.turn)(answer)

    return Node(maxima, holds, key.rules.follow_through, verdict="follow_through")


def _right(place: int, part: Part) -> str:
    ends = f"v{place},co_r{place}[1],co_r{place}[2]"
    return f"co_turned({ends},{number(part.sort.turn)})" if part.sort.turn else f"co_in({ends})"


def _is_right(variant: Variant, part: Part, value: float) -> bool:
    reference, half = float(variant.key.reference[part.quantity]), variant.key.half_width(part)
    slack = _SLACK * max(abs(reference - half), abs(reference + half))
    return _within(reference - half - slack, reference + half + slack, part.sort.turn)(value)


def _is_tried(variant: Variant, part: Part, value: float) -> bool:
    """Whether a wrong answer is near enough to the right one to be gone on from; a direction always is."""
    reference = abs(float(variant.key.reference[part.quantity]))
    return bool(part.sort.turn) or reference / _ATTEMPT <= abs(value) <= _ATTEMPT * reference


def _cases(place: int, posed: Posed) -> Iterator[Node]:
    """What each case is worth: the right one first."""
    for at, option in sorted(enumerate(posed.options), key=lambda one: -one[1].share):
        if option.share > 0 or option.says:
            name = case_name(posed, at)
            yield Node(
                f"is(ans{place}={text(name)})",
                lambda answer, own, name=name: answer == name,  # type: ignore[misc]
                option.share,
                option.says,
                "correct" if option.share == 1 else f"case {name}",
            )


def _several(place: int, posed: Posed) -> Iterator[Node]:
    """One node for each number of cases too few or too many, since a share hangs on nothing else."""
    right = right_cases(posed)
    listed = ",".join(map(text, right))
    chosen = f"ans{place}"
    score = f"(2*length(sublist({chosen},lambda([c],member(c,[{listed}]))))-length({chosen}))"
    for count in range(len(right), 0, -1):

        def holds(answer: object, own: Mapping[int, float], count: int = count) -> bool:
            chosen = set(answer) if isinstance(answer, (list, tuple, set)) else set()
            return 2 * len(chosen & set(right)) - len(chosen) == count

        verdict = "correct" if count == len(right) else f"{count} of {len(right)}"
        yield Node(f"is({score}={count})", holds, count / len(right), verdict=verdict)


def case_name(posed: Posed, place: int) -> str:
    """What a case is called in answers: its letter, as printed, else its number."""
    return posed.options[place].letter or str(place + 1)


def right_cases(posed: Posed) -> tuple[str, ...]:
    """The cases that a right answer names."""
    least = 1.0 if posed.kind == CHOICE else 0.0
    return tuple(
        case_name(posed, at)
        for at, option in enumerate(posed.options)
        if option.share > 0 and option.share >= least
    )
