"""A complex number: right within a margin about its reference, by its distance in the plane."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, ClassVar

from coursework.kinds.kind import AnswerSpelling, Asking, Kind, Stated
from coursework.kinds.nearness import in_half_widths
from coursework.language.numbers import significant
from coursework.parsing.complexes import read_complex
from coursework.parsing.reading import Reading


class Complex(Kind):
    name = "complex"
    is_followed = True
    box = "wide"
    family = "complex"
    faults: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("unknown_symbol", "two_values", "not_a_number", "mixed_units"), "not_complex"
    )

    def keys(self, part: Stated) -> tuple[str, ...]:
        return *super().keys(part), "i", "∠", "°"

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        return read_complex(answer, part.unit)

    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        size = abs(reference)
        gap = math.hypot(value.real - reference.real, value.imag - reference.imag)
        return in_half_widths(gap, max(part.half_width(size), envelope), size)

    def size(self, reference: Any) -> float:
        return float(abs(reference))

    def slips(self, part: Stated, value: Any, reference: Any, numbers: Mapping[str, float]) -> Iterator[str]:
        modulus, angle = cmath.polar(complex(reference))
        wrong = (
            ("sign", -reference),
            ("conjugate", complex(reference).conjugate()),
            # An angle in degrees where radians stand, and the other way round.
            ("radians", cmath.rect(modulus, math.degrees(angle))),
            ("radians", cmath.rect(modulus, math.radians(angle))),
        )
        slips = (slip for slip, other in wrong if self.distance(part, value, other) <= 1)
        yield from dict.fromkeys(slips)

    def others(self, part: Stated, value: Any, half_width: float) -> tuple[Any, ...]:
        return value + 1.3 * half_width, 1.13 * value

    def coordinates(self, part: Stated, asking: Asking) -> tuple[str, ...]:
        return r"\mathrm{Re}", r"\mathrm{Im}"

    def joined(self, texts: Sequence[str], part: Stated, asking: Asking) -> str:
        sign = "-" if texts[1].startswith("-") else "+"
        return f"({texts[0]} {sign} {texts[1].removeprefix('-')}i)"

    def written(self, value: Any, digits: int, label: Callable[[str], str]) -> str:
        value = complex(value)
        imaginary = significant(value.imag, digits)
        sign = "-" if imaginary.startswith("-") else "+"
        return f"{significant(value.real, digits)} {sign} {imaginary.removeprefix('-')}i"

    def spellings(self, part: Stated, value: Any, label: Callable[[str], str]) -> Iterator[AnswerSpelling]:
        unit = "" if part.unit == "1" else f" {part.unit}"
        yield from super().spellings(part, complex(value), label)
        modulus, angle = cmath.polar(complex(value))
        degrees = significant(math.degrees(angle), 7)
        yield AnswerSpelling("polar", f"{significant(modulus, 7)}{unit} ∠ {degrees}°")
        yield AnswerSpelling("exponential", f"{modulus!r} e^(i*({angle!r})){unit}")
