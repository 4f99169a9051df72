"""What a platform does not do with a question that our marking does, and what it does instead.

The words for it, ``[platforms.lost.NAME]`` of each language, are the table: a feature that a platform has no word for is kept.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from coursework.errors import BadCourse
from coursework.language.words import words
from coursework.platforms.items import Pool
from coursework.platforms.posed import COLLECTED

COLUMNS = ("exercise", "part", "feature", "instead")
#: Features of a question that stand behind another: a question that is collected is judged by nobody on the platform.
_OF_JUDGED = (
    "comma",
    "unit_written",
    "unit_refused",
    "turns",
    "unreadable",
    "mistakes",
    "usual_errors",
    "partial",
    "counted_once",
)
#: What every pool has: a variant for each student, all of its questions together; our marks of another try.
_OF_POOLS = ("one_variant", "corrected")


class Loss(NamedTuple):
    """What is lost of a part, or of a whole exercise, where the part is empty."""

    exercise: str
    part: str
    feature: str  #: a key of ``[platforms.features]``
    instead: str  #: what the platform does, in words

    def row(self, lang: str) -> dict[str, str]:
        """A line of ``lost.csv``."""
        return {**self._asdict(), "feature": feature_words(self.feature, lang)}


def feature_words(feature: str, lang: str) -> str:
    """What a feature is called."""
    features = words(lang)["platforms"]["features"]
    if feature not in features:
        raise BadCourse(f"no words for the feature {feature!r}; there is: {', '.join(features)}")
    return str(features[feature])


def lost_words(platform: str, lang: str) -> Mapping[str, str]:
    """What a platform does instead, by feature; one platform may say that it does as another."""
    table = words(lang)["platforms"]["lost"]
    found: Mapping[str, str] | str = table[platform]
    return table[found] if isinstance(found, str) else found


def losses(pool: Pool, platform: str, more: Iterable[Loss] = ()) -> list[Loss]:
    """Everything that a platform does not keep of a pool, a line a part and feature; ``more`` is what its files alone tell."""
    lost = lost_words(platform, pool.lang)
    found = {
        (exercise, part, feature): Loss(exercise, part, feature, str(lost[feature]))
        for exercise, part, feature in _features(pool)
        if feature in lost
    }
    found |= {(loss.exercise, loss.part, loss.feature): loss for loss in more}
    return list(found.values())


def _features(pool: Pool) -> Iterator[tuple[str, str, str]]:
    for section in pool.sections:
        for feature in _OF_POOLS:
            yield section.exercise, "", feature
        if any(item.handout.drawing_mm for item in section.items):
            yield section.exercise, "", "drawing_paper"
        for item in section.items:
            for posed in item.questions:
                for feature in sorted(posed.features):
                    if posed.kind != COLLECTED or feature not in _OF_JUDGED:
                        yield section.exercise, posed.question.id, feature


def told(lost: Sequence[Loss], lang: str) -> Iterator[str]:
    """One plain line a feature: of how many parts of how many exercises it is lost, and what happens instead."""
    by_feature: dict[tuple[str, str], list[Loss]] = {}
    for loss in lost:
        by_feature.setdefault((loss.feature, loss.instead), []).append(loss)
    said = words(lang)["platforms"]
    for (feature, instead), some in by_feature.items():
        exercises, parts = {one.exercise for one in some}, [one for one in some if one.part]
        where = said["where_parts" if parts else "where"].format(parts=len(parts), exercises=len(exercises))
        yield said["line"].format(feature=feature_words(feature, lang), where=where, instead=instead)
