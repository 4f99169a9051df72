"""Report of a check of exercises, and its printed form."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

RESIDUAL = 1e-9  #: largest relative residual of the governing equations
USUAL = ("usual errors explained", "usual errors explained otherwise", "usual errors among many")
KEPT_DIGITS = (3, 4, 5)  #: of simulated students who round at every step


@dataclass
class CheckReport:
    """Results of the check of one exercise."""

    name: str
    variants: int = 0
    counts: Counter[str] = field(default_factory=Counter)
    failures: list[str] = field(default_factory=list)
    mistakes: dict[str, Counter[str]] = field(default_factory=dict)  #: shown, murky, hidden, by mistake
    refused: Counter[str] = field(default_factory=Counter)  #: variants not worth issuing, by their first flaw
    acceptance: float = math.nan
    conditioning: tuple[float, float] = (math.nan, math.nan)  #: median and largest, of what may be issued
    cases: dict[str, Counter[str]] = field(default_factory=dict)  #: branches that students met, by quantity
    #: Why a step's formula proves nothing, by quantity.
    unproved: dict[str, str] = field(default_factory=dict)
    unproved_units: dict[str, str] = field(default_factory=dict)  #: why a unit is not proved, by quantity

    #: By quantity and kind, the share of the variants on which a usual error in its formula may go unseen.
    unprotected: dict[str, dict[str, float]] = field(default_factory=dict)
    #: Asked numbers whose formula is not one that errors are made of.
    unmade: set[str] = field(default_factory=set)

    by_person: set[str] = field(default_factory=set)  #: parts that a person marks, and no check can try

    @property
    def passed(self) -> bool:
        return not self.failures

    def fail(self, message: str) -> None:
        """Record a broken promise in one line; once, however often it is met."""
        message = message.removeprefix(f"{self.name}: ")  # whoever prints it says whose it is
        if message not in self.failures:
            self.failures.append(message)

    def add(self, later: CheckReport) -> None:
        """Add what was tried after this, by another process say."""
        self.counts.update(later.counts)
        for failure in later.failures:
            self.fail(failure)
        for name, tally in later.mistakes.items():
            self.mistakes.setdefault(name, Counter()).update(tally)
        self.unproved |= later.unproved
        self.unproved_units |= later.unproved_units
        self.unprotected |= later.unprotected
        self.unmade |= later.unmade
        self.by_person |= later.by_person

    def as_json(self) -> dict[str, Any]:
        """Return the report as ``coursework check --json`` prints it."""
        return {
            "exercise": self.name,
            "variants": self.variants,
            "acceptance": self.acceptance if self.variants else None,
            "counts": dict(self.counts),
            "mistakes": {n: dict(t) for n, t in self.mistakes.items()},
            "refused": dict(self.refused),
            "conditioning": {
                name: value if math.isfinite(value) else None
                for name, value in zip(("median", "largest"), self.conditioning, strict=True)
            },
            "cases": {n: dict(c) for n, c in self.cases.items()},
            "unproved": self.unproved,
            **({"by_person": sorted(self.by_person)} if self.by_person else {}),
            "unproved_units": self.unproved_units,
            "unprotected": self.unprotected,
            "unmade": sorted(self.unmade),
            "failures": self.failures,
        }


def table(reports: Sequence[CheckReport]) -> list[Mapping[str, Any]]:
    """Return a line an exercise, for printing: narrow enough for 80 columns."""
    return [
        {
            "exercise": r.name,
            "variants": r.variants,
            "draws\nkept": f"{100 * r.acceptance:.0f} %" if r.variants else "",
            "worth\nissuing": _share_worthy(r),
            "tried": sum(_tried(r).values()),
            "failures": len(r.failures),
        }
        for r in reports
    ]


def _tried(report: CheckReport) -> dict[str, int]:
    """Return the number of marked answers by sort; sorts that the exercise does not have are left out."""
    counts = report.counts
    kinds = {
        "right answers": counts["right answers"],
        "rounded": sum(counts[f"rounding to {d}"] for d in KEPT_DIGITS),
        "mistakes": counts["mistakes recognised"],
        "usual errors": sum(counts[kind] for kind in USUAL),
        "slips": counts["slips recognised"],
        "loops": counts["loops explained"],
        "followed": counts["follow-through"],
        "nonsense": counts["nonsense"],
        "formulas": counts["formulas proved"],
    }
    return {kind: count for kind, count in kinds.items() if count}


def notes(reports: Sequence[CheckReport]) -> list[str]:
    """Return the counts of trials, and the properties of the variants: conditioning, branches met,
    constraints that refuse most draws."""
    lines = []
    for r in reports:
        if not r.variants:
            continue
        sentences = (
            [f"tried {', '.join(f'{count} {kind}' for kind, count in _tried(r).items())}"]
            if _tried(r)
            else []
        )
        median, largest = r.conditioning
        if math.isfinite(median):
            sentences.append(
                f"rounding takes {100 * median:.0f} % of what a variant may have, {100 * largest:.0f} "
                "% at most"
            )
        for name, cases in r.cases.items():
            if len(cases) == 1 and cases.total() < r.variants:
                continue  # a question of a bank: its answer is the same wherever it is asked
            met = ", ".join(f"{case} {100 * n / r.variants:.0f} %" for case, n in cases.most_common())
            sentences.append(f"{name}: {met}")
        if r.unproved:
            sentences.append(f"formulas not proved: {_by_reason(r.unproved)}")
        if r.by_person:
            sentences.append(f"marked by a person: {', '.join(sorted(r.by_person))}")
        if r.counts["units proved"]:
            sentences.append(f"units proved: {r.counts['units proved']}")
        if r.unproved_units:
            sentences.append(f"units not proved: {_by_reason(r.unproved_units)}")
        if r.unprotected:
            shares = (
                f"{q} ({', '.join(f'{k} {100 * s:.0f} %' for k, s in kinds.items())})"
                for q, kinds in r.unprotected.items()
            )
            sentences.append(f"unseen on some variants: {', '.join(shares)}")
        if r.unmade:
            sentences.append(f"no usual errors are made of: {', '.join(sorted(r.unmade))}")
        if r.refused:
            flaws = ", ".join(f"{flaw} ({n})" for flaw, n in r.refused.most_common(3))
            sentences.append(f"passed over most for {flaws}")
        if sentences:
            lines.append(f"{r.name}: {'; '.join(sentences)}")
    return lines


def _by_reason(unproved: Mapping[str, str]) -> str:
    """``ka, p (explained in words), q (r has no value)``."""
    names: dict[str, list[str]] = {}
    for name, why in unproved.items():
        names.setdefault(why, []).append(name)
    return ", ".join(f"{', '.join(those)} ({why})" for why, those in names.items())


def _share_worthy(report: CheckReport) -> str:
    tried = report.variants + sum(report.refused.values())
    return f"{100 * report.variants / tried:.0f} %" if tried else ""
