"""An equation in the exercise's symbols, up to a factor: judged by the points that it holds at, never by its
spelling."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar

from coursework.kinds.kind import AnswerSpelling, Asking, Kind, Stated

if TYPE_CHECKING:
    from coursework.parsing.equations import Equation as Read
    from coursework.parsing.reading import Reading


class EquationKind(Kind):
    name = "equation"
    goes_with = ("variables",)
    is_exact = is_text = True
    disproves = False  # a mistake about a quantity may well leave its equation right
    has_symbol = is_called_by_symbol = False
    box = "line"
    field = "written"
    family = "equation"
    wrong = "wrong_equation"
    quoted = ("unknown_unit", "unknown_symbol")
    faults: ClassVar[Mapping[str, str]] = {
        "not_a_number": "not_an_equation",
        "two_equals_signs": "not_an_equation",
    }

    def keys(self, part: Stated) -> tuple[str, ...]:
        return *part.variables, "=", "+", "-", "*", "(", ")", "^", "√(", "cos(", "sin("

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        from coursework.parsing.equations import read_equation

        return read_equation(answer, part.variables)

    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        return 0.0 if _same(value, reference, part.variables, part.parameters) else math.inf

    def apart(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        return self.distance(part, _parsed(value, part.variables), reference)

    def slips(self, part: Stated, value: Any, reference: Any, numbers: Mapping[str, float]) -> Iterator[str]:
        from coursework.parsing.equations import parse_equation
        from coursework.parsing.equivalence import same_equation

        reference_equation = parse_equation(reference, part.variables)
        put_in = {
            n: float(numbers[n]) for n in reference_equation.variables - value.variables if n in numbers
        }
        if put_in and same_equation(
            value, reference_equation.with_numbers(put_in), parameters=part.parameters
        ):
            yield "numbers"

    def latex(self, value: str, symbols: Mapping[str, str]) -> str:
        from coursework.kinds.equation_latex import latex_of_equation

        return latex_of_equation(value, symbols)

    def written(self, value: Any, digits: int, label: Callable[[str], str]) -> str:
        return str(value)

    def spellings(self, part: Stated, value: Any, label: Callable[[str], str]) -> Iterator[AnswerSpelling]:
        left, _, right = str(value).partition("=")
        yield AnswerSpelling("exact", str(value))
        yield AnswerSpelling("printed", f"2*({right}) - 2*({left}) = 0")


@lru_cache(maxsize=4096)
def _same(value: Read, reference: str, variables: tuple[str, ...], parameters: tuple[str, ...]) -> bool:
    """Equations are dear to compare, and many students write the same."""
    from coursework.parsing.equivalence import same_equation

    reference_equation = _parsed(reference, variables)
    opened = value.without_inverse()
    return same_equation(value, reference_equation, parameters=parameters) or (
        opened is not None and same_equation(opened, reference_equation, parameters=parameters)
    )


@lru_cache(maxsize=1024)
def _parsed(text: str, variables: tuple[str, ...]) -> Read:
    """Return a reference equation, or a mistaken one, read once."""
    from coursework.parsing.equations import parse_equation

    return parse_equation(text, variables)
