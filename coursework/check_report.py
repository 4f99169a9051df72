"""What a check of exercises found, and how it is told."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

RESIDUAL = 1e-9  #: largest relative residual of the governing equations
KEPT_DIGITS = (3, 4, 5)  #: of simulated students who round at every step


@dataclass
class Report:
    """What the check of one exercise found."""

    name: str
    variants: int = 0
    counts: Counter[str] = field(default_factory=Counter)
    failures: list[str] = field(default_factory=list)
    mistakes: dict[str, Counter[str]] = field(default_factory=dict)  #: shown, murky, hidden, by mistake
    refused: Counter[str] = field(default_factory=Counter)  #: variants not worth issuing, by their first flaw
    acceptance: float = math.nan
    conditioning: tuple[float, float] = (math.nan, math.nan)  #: median and largest, of what may be issued
    cases: dict[str, Counter[str]] = field(default_factory=dict)  #: branches that students met, by quantity

    @property
    def passed(self) -> bool:
        return not self.failures

    def fail(self, what: str) -> None:
        """A promise is broken: how, in one line."""
        self.failures.append(what)

    def as_json(self) -> dict[str, Any]:
        """What ``coursework check --json`` prints of it."""
        return {
            "exercise": self.name,
            "variants": self.variants,
            "acceptance": self.acceptance if self.variants else None,
            "counts": dict(self.counts),
            "mistakes": {n: dict(t) for n, t in self.mistakes.items()},
            "refused": dict(self.refused),
            "conditioning": dict(zip(("median", "largest"), self.conditioning, strict=True)),
            "cases": {n: dict(c) for n, c in self.cases.items()},
            "failures": self.failures,
        }


def table(reports: Sequence[Report]) -> list[Mapping[str, Any]]:
    """A line an exercise, for printing."""
    return [
        {
            "exercise": r.name,
            "variants": r.variants,
            "draws kept": f"{100 * r.acceptance:.0f} %" if r.variants else "",
            "worth issuing": _share_worthy(r),
            "right answers": r.counts["right answers"],
            "rounded": sum(r.counts[f"rounding to {d}"] for d in KEPT_DIGITS),
            "mistakes": r.counts["mistakes recognised"],
            "slips": r.counts["slips recognised"],
            "loops": r.counts["loops told"],
            "followed": r.counts["follow-through"],
            "nonsense": r.counts["nonsense"],
            "failures": len(r.failures),
        }
        for r in reports
    ]


def notes(reports: Sequence[Report]) -> list[str]:
    """What the variants are like: what refuses most draws, conditioning, and the branches met."""
    lines = []
    for r in reports:
        if not r.variants:
            continue
        median, largest = r.conditioning
        line = f"{r.name}: rounding takes {100 * median:.0f} % of what a variant may have, {100 * largest:.0f} % at most"
        for name, cases in r.cases.items():
            if len(cases) == 1 and cases.total() < r.variants:
                continue  # a question of a bank: its answer is the same wherever it is asked
            told = ", ".join(f"{case} {100 * n / r.variants:.0f} %" for case, n in cases.most_common())
            line += f"; {name}: {told}"
        flaws = ", ".join(f"{flaw} ({n})" for flaw, n in r.refused.most_common(3))
        lines.append(line + (f"; passed over most for {flaws}" if flaws else ""))
    return lines


def _share_worthy(report: Report) -> str:
    tried = report.variants + sum(report.refused.values())
    return f"{100 * report.variants / tried:.0f} %" if tried else ""
