"""Measures of a build that is not written, on some of its papers: pages, white space, points, and variants
that are left."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from coursework.course.course import Course
from coursework.issuing.assignment import Assignment
from coursework.issuing.issuing import Issue
from coursework.issuing.papers import IssuedPaper, papers
from coursework.rendering.renderer import renderer_of

SAMPLE = 8  #: papers at most that are typeset
WHITE = 0.25  #: share of a page that is worth a word


@dataclass(frozen=True)
class DryRun:
    """Measures of a build that is not written."""

    papers: int
    measured: int  #: papers that were typeset
    pages: tuple[int, ...]  #: of each of these
    total_pages: int  #: of all papers, estimated from these
    total_sheets: int  #: of paper, printed on both sides
    #: By page, the largest white share of its height, where it is above :data:`WHITE`.
    white: Mapping[int, float]
    points: Mapping[str, tuple[float, float]]  #: by exercise, the fewest and the most
    left: Mapping[str, tuple[int, int | None]]  #: by exercise, variants used and left; None: very many

    @property
    def total_points(self) -> tuple[float, float]:
        return sum(low for low, _ in self.points.values()), sum(high for _, high in self.points.values())


def dry_run(
    course: Course[Any], issues: Sequence[Issue], assignment: Assignment | None, *, paper: str, scan: bool
) -> DryRun:
    """Return the measures of a build; at most :data:`SAMPLE` papers are typeset, of different versions and
    languages first."""
    all_papers = papers(assignment, issues, polygons=False, scan=paper if scan else "")
    printed = [(issued_paper, lang) for issued_paper in all_papers for lang in issued_paper.first.langs]
    alike: dict[tuple[Any, ...], list[tuple[IssuedPaper, str]]] = {}
    for issued_paper, lang in printed:
        key = (issued_paper.first.version or issued_paper.first.stem, issued_paper.folder, lang)
        alike.setdefault(key, []).append((issued_paper, lang))
    groups = list(alike.values())
    sample = groups[:: max(1, -(-len(groups) // SAMPLE))]
    renderer = renderer_of(course.folder).on(paper)
    pages, white, weighted, sheets = [], dict[int, float](), 0, 0
    for group in sample:
        issued_paper, lang = group[0]
        shares = renderer.white_shares(issued_paper.printed(lang))
        pages.append(len(shares))
        weighted += len(group) * len(shares)
        sheets += len(group) * ((len(shares) + 1) // 2)
        for number, share in enumerate(shares, 1):
            white[number] = max(share, white.get(number, 0.0))
    covered = sum(map(len, sample))
    covers = int(assignment is not None and assignment.cover)  # a cover bears its table alone
    points: dict[str, list[float]] = {}
    used: dict[str, set[tuple[Any, ...]]] = {}
    for issue in issues:
        name = issue.variant.exercise.name
        points.setdefault(name, []).append(sum(part.points for part in issue.variant.parts))
        used.setdefault(name, set()).add(_given(issue))
    return DryRun(
        len(printed),
        len(sample),
        tuple(pages),
        round(weighted * len(printed) / covered),
        round(sheets * len(printed) / covered),
        {number: share for number, share in white.items() if share > WHITE and number > covers},
        {name: (min(each), max(each)) for name, each in points.items()},
        {name: (len(values), _left(course, name, len(values))) for name, values in used.items()},
    )


def _given(issue: Issue) -> tuple[Any, ...]:
    return tuple(sorted((name, str(value)) for name, value in issue.variant.record["given"].items()))


def _left(course: Course[Any], name: str, used: int) -> int | None:
    population = course[name].draws.population()
    return None if population is None else max(0, population - used)
