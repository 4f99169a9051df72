"""Potential response trees of STACK: the nodes in Maxima, and their results computed here."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from coursework.course.variant import Variant
from coursework.language.numbers import settled
from coursework.model import Part
from coursework.parsing.units import DIMENSIONS, find_unit
from coursework.platforms._maxima import Unprintable, number, text
from coursework.platforms._stack_following import Following, following, follows
from coursework.platforms.posed import CHOICE, CHOICES, COLLECTED, NUMBER, Interval, Posed

_SLACK = 1e-12  #: relative; an end belongs to the margin whatever its last bit
EMPTY = "empty"  #: the verdict of a box that is left so, which costs no penalty
_LONGEST = 200  #: characters of a node's test; Moodle allows 255
_ATTEMPT = 100  #: an earlier answer is gone on from within this factor of the right one
#: Units that students may write with a number, in STACK's syntax.
_UNITS = tuple("mm cm dm m km um s ms h g kg N kN mN daN J kJ W kW mW Pa kPa MPa rad mrad deg rpm".split())
_BASES = {"length": "m", "mass": "kg", "time": "s"}
_NUMBERS = ("angle", "cycle")  #: units that are numbers

#: Functions of every question. ``x`` is an answer, ``u`` the unit asked, in base units; intervals hold their
#: ends.
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
    """Return the first lines of the question variables of every question."""
    factors = ",".join(f"{name}={in_base_units(name)}" for name in _UNITS if name not in _BASES.values())
    return FUNCTIONS % (_ATTEMPT, _ATTEMPT, factors)


def in_base_units(unit: str) -> str:
    """Return a unit as a factor and base units; angles are numbers."""
    factor = find_unit(unit)
    if factor is None:
        raise Unprintable(unit)
    powers = dict(zip(DIMENSIONS, factor.dimension, strict=True))
    if any(power and name not in (*_BASES, *_NUMBERS) for name, power in powers.items()):
        raise Unprintable(unit)
    bases = "".join(
        f"*{_BASES[name]}^({power})" for name, power in powers.items() if name in _BASES and power
    )
    return number(factor.factor) + bases


@dataclass(frozen=True)
class Node:
    """Test of an answer; the first node that holds decides."""

    maxima: str  #: condition
    holds: Callable[[object, Mapping[int, float]], bool]  #: of an answer, and the earlier ones by number
    share: float
    message: str = ""  #: Markdown
    verdict: str = "correct"


@dataclass(frozen=True)
class Tree:
    """Marking of one part's answer."""

    part_number: int  #: of the part, from 1
    posed: Posed
    nodes: tuple[Node, ...]
    following: Following | None = None
    unit: str = "1"  #: in Maxima's syntax
    may_be_empty: bool = False

    @property
    def variables(self) -> str:
        """Return the variables of the nodes: the answer and the earlier ones as numbers, and expressions too
        long for a node."""
        return "\n".join((*self._numbers, *self._long))

    @property
    def _long(self) -> Iterator[str]:
        for at, node in enumerate(self.nodes):
            if len(node.maxima) > _LONGEST:
                yield f"t{at}: {node.maxima};"

    def test(self, at: int) -> str:
        """Return the test of a node."""
        return f"t{at}" if len(self.nodes[at].maxima) > _LONGEST else self.nodes[at].maxima

    @property
    def _numbers(self) -> list[str]:
        if self.posed.kind != NUMBER:
            return []
        lines = [f"v{self.part_number}: co_number(ans{self.part_number},co_u{self.part_number});"]
        for part_number in self.following.earlier if self.following else ():
            as_number = f"co_number(ans{part_number},co_u{part_number})"
            lines.append(f"w{part_number}: {as_number};")
            lines.append(
                f"v{part_number}: if numberp(w{part_number}) then w{part_number} else co_r{part_number}[3];"
            )
        if self.following:
            lines.append(f"f{self.part_number}: float({self.following.maxima});")
        return lines

    def share(self, answer: object, answers: Mapping[int, float]) -> tuple[float, int]:
        """Return the share of the points of an answer, and the number of the deciding node; -1 if there is
        none."""
        for index, node in enumerate(self.nodes):
            if node.holds(answer, answers):
                return node.share, index
        return 0.0, -1


def trees(variant: Variant, questions: Sequence[Posed]) -> tuple[Tree, ...]:
    """Return the trees of the questions that STACK can judge."""
    pairs = zip(questions, variant.parts, strict=True)
    result = [
        _tree(variant, part_number, posed, part)
        for part_number, (posed, part) in enumerate(pairs, start=1)
        if posed.kind != COLLECTED
    ]
    goes_on = {part_number for tree in result if tree.following for part_number in tree.following.earlier}
    return tuple(_may_be_empty(tree) if tree.part_number in goes_on else tree for tree in result)


def _may_be_empty(tree: Tree) -> Tree:
    """Return a tree whose answer may stay empty, since others depend on it and are judged without it too."""
    nothing = Node(
        f"is(ans{tree.part_number}=EMPTYANSWER)", lambda answer, answers: answer is None, 0.0, verdict=EMPTY
    )
    return replace(tree, nodes=(nothing, *tree.nodes), may_be_empty=True)


def _tree(variant: Variant, part_number: int, posed: Posed, part: Part) -> Tree:
    if posed.kind == CHOICE:
        return Tree(part_number, posed, tuple(_cases(part_number, posed)))
    if posed.kind == CHOICES:
        return Tree(part_number, posed, tuple(_several(part_number, posed)))
    earlier_answers = following(variant, part)
    right, *wrong = (interval for interval in posed.intervals if not interval.turns)
    nodes = [_of_interval(part_number, right, part.sort.turn)]
    if earlier_answers is not None:
        nodes.append(_of_following(variant, part_number, part, earlier_answers))
    nodes += [
        _of_interval(part_number, interval, part.sort.turn if _turns(interval, posed) else 0.0)
        for interval in wrong
    ]
    return Tree(part_number, posed, tuple(nodes), earlier_answers, unit_of(part))


def unit_of(part: Part) -> str:
    """Return the unit of a part in base units; for a unit that STACK does not know, one that no answer can
    have."""
    try:
        return in_base_units(part.unit)
    except Unprintable:
        return "co_unit"


def _turns(interval: Interval, posed: Posed) -> bool:
    """Return whether whole turns more or fewer are accepted."""
    verdicts = (
        turned.verdict
        for turned in posed.intervals
        if turned.turns and math.isclose(turned.half, interval.half)
    )
    return interval.verdict in verdicts


def _ends(interval: Interval) -> tuple[float, float]:
    slack = _SLACK * max(abs(interval.low), abs(interval.high))
    return interval.low - slack, interval.high + slack


def _of_interval(part_number: int, interval: Interval, turn: float) -> Node:
    low, high = _ends(interval)
    holds = _within(low, high, turn)
    ends = f"v{part_number},{number(low)},{number(high)}"
    maxima = f"co_turned({ends},{number(turn)})" if turn else f"co_in({ends})"
    return Node(
        maxima, lambda answer, answers: holds(answer), interval.share, interval.message, interval.verdict
    )


def _within(low: float, high: float, turn: float) -> Callable[[object], bool]:
    def holds(answer: object) -> bool:
        if not isinstance(answer, (float, int)):
            return False
        if not turn:
            return low <= answer <= high
        middle = (low + high) / 2
        return abs(answer - middle - turn * round((answer - middle) / turn)) <= (high - low) / 2

    return holds


def _of_following(variant: Variant, part_number: int, part: Part, result: Following) -> Node:
    """Return the node of a right method from earlier answers, at least one of which is a plausible wrong
    one."""
    key = variant.key
    least = max(part.atol, key.envelope.get(part.quantity, 0.0)) if part.has_margin else 0.0
    share = part.rtol if part.has_margin else 0.0
    half = (
        f"max({number(settled(least))},{number(float(share))}*abs(f{part_number}))"
        f"+{number(1e-9)}*abs(f{part_number})"
    )
    earlier = {earlier_number: variant.parts[earlier_number - 1] for earlier_number in result.earlier}
    wrong = " or ".join(f"not {_right(earlier_number, p)}" for earlier_number, p in earlier.items())
    tried = "".join(
        f" and ({_right(earlier_number, p)} or co_tried(v{earlier_number},co_r{earlier_number}[3]))"
        for earlier_number, p in earlier.items()
        if not p.sort.turn
    )
    apart = f" and is(abs(f{part_number})>{half})" if part.has_margin and not part.sort.turn else ""
    ends = f"v{part_number},f{part_number}-({half}),f{part_number}+({half})"
    turn = part.sort.turn
    near = f"co_turned({ends},{number(turn)})" if turn else f"co_in({ends})"
    maxima = f"if numberp(f{part_number}) then (({wrong}){tried}{apart} and {near}) else false"

    def holds(answer: object, answers: Mapping[int, float]) -> bool:
        complete = {
            earlier_number: answers.get(earlier_number, float(key.reference[p.quantity]))
            for earlier_number, p in earlier.items()
        }
        wrong = [
            earlier_number
            for earlier_number, value in complete.items()
            if not _is_right(variant, earlier[earlier_number], value)
        ]
        untried = any(
            not _is_tried(variant, earlier[earlier_number], complete[earlier_number])
            for earlier_number in wrong
        )
        value = follows(variant, part, complete)
        if not wrong or untried or value is None or not math.isfinite(value):
            return False
        width = max(least, share * abs(value)) + 1e-9 * abs(value)
        if apart and abs(value) <= width:
            return False
        return _within(value - width, value + width, part.sort.turn)(answer)

    return Node(maxima, holds, key.rules.follow_through, verdict="follow_through")


def _right(part_number: int, part: Part) -> str:
    ends = f"v{part_number},co_r{part_number}[1],co_r{part_number}[2]"
    return f"co_turned({ends},{number(part.sort.turn)})" if part.sort.turn else f"co_in({ends})"


def _is_right(variant: Variant, part: Part, value: float) -> bool:
    reference, half = float(variant.key.reference[part.quantity]), variant.key.half_width(part)
    slack = _SLACK * max(abs(reference - half), abs(reference + half))
    return _within(reference - half - slack, reference + half + slack, part.sort.turn)(value)


def _is_tried(variant: Variant, part: Part, value: float) -> bool:
    """Return whether a wrong answer is close enough to the right one to continue from; a direction always
    is."""
    reference = abs(float(variant.key.reference[part.quantity]))
    return bool(part.sort.turn) or reference / _ATTEMPT <= abs(value) <= _ATTEMPT * reference


def _cases(part_number: int, posed: Posed) -> Iterator[Node]:
    """Return the share of each case, the right one first."""
    for at, option in sorted(enumerate(posed.options), key=lambda case: -case[1].share):
        if option.share > 0 or option.message:
            name = case_name(posed, at)
            yield Node(
                f"is(ans{part_number}={text(name)})",
                lambda answer, answers, name=name: answer == name,  # type: ignore[misc]
                option.share,
                option.message,
                "correct" if option.share == 1 else f"case {name}",
            )


def _several(part_number: int, posed: Posed) -> Iterator[Node]:
    """Return one node for each number of cases too few or too many: the share depends on nothing else."""
    right = right_cases(posed)
    listed = ",".join(map(text, right))
    chosen = f"ans{part_number}"
    score = f"(2*length(sublist({chosen},lambda([c],member(c,[{listed}]))))-length({chosen}))"
    for count in range(len(right), 0, -1):

        def holds(answer: object, answers: Mapping[int, float], count: int = count) -> bool:
            chosen = set(answer) if isinstance(answer, (list, tuple, set)) else set()
            return 2 * len(chosen & set(right)) - len(chosen) == count

        verdict = "correct" if count == len(right) else f"{count} of {len(right)}"
        yield Node(f"is({score}={count})", holds, count / len(right), verdict=verdict)


def case_name(posed: Posed, part_number: int) -> str:
    """Return the name of a case in answers: its printed letter, else its number."""
    return posed.options[part_number].letter or str(part_number + 1)


def right_cases(posed: Posed) -> tuple[str, ...]:
    """Return the cases of a right answer."""
    least = 1.0 if posed.kind == CHOICE else 0.0
    return tuple(
        case_name(posed, at)
        for at, option in enumerate(posed.options)
        if option.share > 0 and option.share >= least
    )
