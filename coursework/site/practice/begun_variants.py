"""Variants that a person has begun to practise, the last used first."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime
from typing import TYPE_CHECKING, NamedTuple

from coursework.database.drafts import sheets
from coursework.selfstudy.mastery import RIGHT
from coursework.selfstudy.progress import ANSWER, EXAMPLE, Progress, date_of

if TYPE_CHECKING:
    from coursework.site.frame.requests import Request


class BegunVariant(NamedTuple):
    """Variant that was begun and is not finished."""

    exercise: str
    seed: int
    right: int
    questions: int

    @property
    def address(self) -> str:
        return f"/practice/{self.exercise}/{self.seed}"


def begun(request: Request, progress: Progress, exercise: str = "") -> Iterator[BegunVariant]:
    """Yield the variants to continue with, of one exercise if given."""
    for name, seed in _touched(request, progress, exercise):
        if name not in request.site.course or not request.site.pool.holds(name, seed):
            continue
        variant = _standing(request, progress, name, seed)
        if variant is not None and variant.right < variant.questions:
            yield variant


def _touched(request: Request, progress: Progress, exercise: str) -> list[tuple[str, int]]:
    with request.site.store.reading() as connection:
        typed = sheets(connection, request.user.id, f"practice/{exercise}/" if exercise else "practice/")
    when: dict[tuple[str, int], datetime] = {}
    for sheet, changed in typed.items():
        _, name, seed = sheet.split("/")
        when[name, int(seed)] = changed
    for entry in progress:
        if exercise in ("", entry["exercise"]):
            variant = str(entry["exercise"]), int(entry["seed"])
            when[variant] = max(when.get(variant, date_of(entry)), date_of(entry))
    return sorted(when, key=lambda variant: when[variant], reverse=True)


def _standing(request: Request, progress: Progress, exercise: str, seed: int) -> BegunVariant | None:
    """Return the progress on a variant; None if it was shown with its solution."""
    mine = [e for e in progress.of(exercise) if e["seed"] == seed]
    if any(e["what"] == EXAMPLE for e in mine):
        return None
    last = {e["part"]: e.get("verdict") for e in mine if e["what"] == ANSWER}
    variant = request.site.variant(exercise, seed, request.lang)
    questions = [part.id for part in variant.parts if not part.sort.is_open]
    return BegunVariant(exercise, seed, sum(last.get(name) in RIGHT for name in questions), len(questions))
